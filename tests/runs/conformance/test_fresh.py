"""Fresh rows: of a seed that nobody knew, they find an implementation that knows the other rows by heart."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from hypcheck import classify
from hypcheck.cli import verify
from hypcheck.cli.main import main
from hypcheck.implementations.description import Description
from hypcheck.runs.cases import FRESH_SEEDS, cases_of_chunk, fresh_chunks
from hypcheck.runs.plan import ConformancePlan, planned_cases, planned_size
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.frozen import load

SEED = FRESH_SEEDS + 77


def groups_in(out):
    """The lines about families of a run."""
    lines = map(json.loads, (Path(out) / "record.jsonl").read_text().splitlines())
    return [line for line in lines if line["type"] == "group"]


@pytest.fixture
def known(tmp_path, monkeypatch):
    """The answers to the frozen vectors of `uniform` and to the rows of the usual seed."""
    monkeypatch.chdir(tmp_path)
    rows = np.vstack([load("uniform").rows, FAMILIES["uniform"].rows(1, 180)])
    return {row.tobytes(): int(answer) for row, answer in zip(rows, classify(rows), strict=True)}


@pytest.fixture
def spec(known, built_in):
    """The SPEC of a function that knows them by heart, and no others."""

    def by_heart(rows):
        return np.array([known.get(row.tobytes(), 0) for row in rows], dtype=np.int8)

    return built_in(by_heart)


def test_implementation_that_memorised_the_usual_rows_fails_only_on_fresh_rows(spec, text_reports, capsys):
    words = ["verify", spec, "--families", "uniform", "--count", "20", "--out", "out"]
    assert main(words) == 0
    assert main([*words, "--fresh", str(SEED)]) == 1
    said = capsys.readouterr()
    assert "HELD: by_heart: 180 judged: 180 right; worst backward error 0 u; no fresh rows" in said.out
    assert f"; 20 fresh rows of each family, of seed {SEED}" in said.err
    header, *lines = map(json.loads, Path("out/record.jsonl").read_text().splitlines())
    assert header["options"]["fresh"] == SEED
    (group,) = (line for line in lines if line["type"] == "group")
    assert {case["case"].split("/")[2] for case in group["worst"]} == {str(SEED)}
    report = Path("out/report.md").read_text()
    assert re.search(rf"hypcheck replay uniform/\d+/{SEED}/\d+ {spec}", report)


def test_fresh_seed_is_random_in_ci_and_absent_elsewhere_unless_an_option_sets_it(monkeypatch):
    assert verify._fresh_seed(None, None) is None
    monkeypatch.setenv("CI", "true")
    seeds = {verify._fresh_seed(None, None) for _ in range(9)}
    assert len(seeds) == 9
    assert all(FRESH_SEEDS <= seed < 2 * FRESH_SEEDS for seed in seeds)
    assert verify._fresh_seed("off", None) is None
    assert verify._fresh_seed("5", None) == 5


def test_every_family_gets_fresh_rows_whatever_known_failures_say(tmp_path):
    known = tmp_path / "known.toml"
    entries = ('family = "ring"', 'case = "axis-0003"', 'cause = "ring"\nmax_u = inf')
    known.write_text("".join(f'[[known_failure]]\n{entry}\nreason = "x"\n' for entry in entries))
    usual = ConformancePlan(("builtin:fast",), ("ring", "axis", "uniform"), count=7, known_failures=known)
    fresh = ConformancePlan(("builtin:fast",), ("ring", "axis", "uniform"), count=7, known_failures=known, fresh=SEED)
    before, after = (planned_cases(plan, Description("any")) for plan in (usual, fresh))
    assert {name: after[name] - before[name] for name in after} == {"ring": 7, "axis": 7, "uniform": 7}
    assert planned_size(fresh) == planned_size(usual) + 3 * 7


def excusing(path, *entries):
    """The options that excuse these."""
    path.write_text("".join(f'[[known_failure]]\n{entry}\nreason = "x"\n' for entry in entries))
    return ["--known-failures", str(path)]


def test_known_failure_of_a_family_excuses_none_of_its_fresh_rows(spec, known, text_reports, tmp_path):
    known.popitem()
    words = ["verify", spec, "--families", "uniform", "--count", "180", "--out", "out"]
    excused = excusing(tmp_path / "known.toml", 'family = "uniform"')
    assert main([*words, *excused]) == 0
    assert main([*words, *excused, "--fresh", str(SEED)]) == 1
    (group,) = groups_in("out")
    assert group["counts"]["excused"] >= 1
    assert {case["case"].split("/")[2] for case in group["worst"]} == {str(SEED)}


def test_known_failure_of_a_cause_excuses_fresh_rows_that_its_rule_explains_up_to_max_u(tmp_path, text_reports):
    words = ["verify", "builtin:table-2-float64", "--families", "ring", "--count", "4", "--fresh", str(SEED)]
    out = str(tmp_path / "out")
    assert main([*words, "--out", out, *excusing(tmp_path / "known.toml", 'cause = "ring"\nmax_u = inf')]) == 0
    (group,) = groups_in(out)
    assert (group["fresh"], group["counts"]["excused"] > 100) == (4, True)
    assert main([*words, "--out", out, *excusing(tmp_path / "known.toml", 'cause = "ring"\nmax_u = 9')]) == 1
    assert main([*words, "--out", out, *excusing(tmp_path / "known.toml", 'cause = "groove"\nmax_u = inf')]) == 1


@pytest.mark.usefixtures("few_families")
def test_known_failure_of_a_cause_that_no_longer_occurs_fails_a_run_of_all_families(tmp_path, text_reports, capsys):
    words = ["verify", "builtin:fast", "--count", "0", "--out", str(tmp_path / "out")]
    entries = ('cause = "ring"\nmax_u = inf', 'cause = "between-positions"\nmax_u = inf')
    known = excusing(tmp_path / "known.toml", *entries)
    assert main([*words, "--families", "axis", *known]) == 0
    assert main([*words, *known]) == 1
    said = capsys.readouterr().out
    assert "the cause ring no longer fails" in said
    assert "between-positions no longer" not in said  # about ways, which were not asked


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (
            'case = "ring-99999"',
            "there is no case 'ring-99999'; those of ring are ring-0000 to ring-0239; did you mean",
        ),
        ('case = "rung-0003"', "there is no case 'rung-0003'; did you mean ring"),
        ('case = "ring/9/1/3"', "case 'ring/9/1/3': this version of hypcheck has generator 1 of ring"),
        ('case = "rung/1/1/3"', "there is no family 'rung'; did you mean ring"),
        ('case = "invalid-0001"', "there is no case 'invalid-0001'"),
        ('family = "rings"', "there is no family 'rings'; did you mean ring"),
        ('cause = "rings"\nmax_u = inf', "there is no cause 'rings' that may be known; did you mean ring"),
        ('cause = "always-0"\nmax_u = inf', "the cause 'always-0' is about every row"),
        ('cause = "ring"', "names a cause and has no max_u"),
    ],
)
def test_known_failure_that_names_nothing_is_refused_with_file_and_line(tmp_path, capsys, entry, said):
    known = excusing(tmp_path / "known.toml", 'case = "ring-0001"', entry)
    out = tmp_path / "out"
    assert main(["verify", "builtin:fast", "--families", "ring", "--count", "0", "--out", str(out), *known]) == 2
    error = capsys.readouterr().err
    line = 4 if "max_u" in said else 5
    assert f"{tmp_path / 'known.toml'}, line {line}: known failure 2" in error
    assert said in error
    assert not (out / "record.jsonl").exists()


def test_fresh_seed_that_is_the_seed_of_the_run_is_refused(capsys):
    assert main(["verify", "builtin:fast", "--families", "ring", "--fresh", "1"]) == 2
    assert "--fresh is 1, which is --seed too" in capsys.readouterr().err


def test_fresh_rows_of_a_small_seed_are_no_frozen_vectors():
    known = {row.tobytes() for row in load("uniform").rows}
    (chunk,) = fresh_chunks(FAMILIES["uniform"], 1, 50)
    assert not known & {row.tobytes() for row in cases_of_chunk(chunk).rows}
