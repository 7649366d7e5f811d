"""Fresh rows: of a seed that nobody knew, they find an implementation that knows the other rows by heart."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from hypcheck.cli import verify
from hypcheck.cli.main import main
from hypcheck.implementations.description import Description
from hypcheck.kernel.classify import classify
from hypcheck.runs.cases import FRESH_SEEDS
from hypcheck.runs.plan import ConformancePlan, planned_cases, planned_size
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.frozen import load

SEED = FRESH_SEEDS + 77

KNOWS_BY_HEART = """
import json
import numpy as np
with open({path!r}) as file:
    KNOWN = json.load(file)
def classify(rows):
    return np.array([KNOWN.get(row.tobytes().hex(), 0) for row in rows], dtype=np.int8)
"""


@pytest.fixture
def by_heart(tmp_path, monkeypatch):
    """The SPEC of a function that knows the frozen vectors of `uniform`, the rows of the usual seed, and no others."""
    monkeypatch.chdir(tmp_path)
    rows = np.vstack([load("uniform").rows, FAMILIES["uniform"].rows(1, 300)])
    known = {row.tobytes().hex(): int(answer) for row, answer in zip(rows, classify(rows), strict=True)}
    (tmp_path / "known.json").write_text(json.dumps(known))
    (tmp_path / "by_heart.py").write_text(KNOWS_BY_HEART.format(path=str(tmp_path / "known.json")))
    return "python:by_heart.py:classify"


def test_implementation_that_memorised_the_usual_rows_fails_only_on_fresh_rows(by_heart, text_reports, capsys):
    words = ["verify", by_heart, "--families", "uniform", "--count", "20", "--out", "out"]
    assert main(words) == 0
    assert main([*words, "--fresh", str(SEED)]) == 1
    assert f"; as many fresh rows, of seed {SEED}" in capsys.readouterr().err
    header, *lines = map(json.loads, Path("out/record.jsonl").read_text().splitlines())
    assert header["options"]["fresh"] == SEED
    (group,) = (line for line in lines if line["type"] == "group")
    assert {case["case"].split("/")[2] for case in group["worst"]} == {str(SEED)}
    report = Path("out/report.md").read_text()
    assert re.search(rf"hypcheck replay uniform/\d+/{SEED}/\d+ {by_heart}", report)


def test_fresh_seed_is_random_in_ci_and_absent_elsewhere_unless_an_option_sets_it(monkeypatch):
    assert verify._fresh_seed(None, None) is None
    monkeypatch.setenv("CI", "true")
    seeds = {verify._fresh_seed(None, None) for _ in range(9)}
    assert len(seeds) == 9
    assert all(FRESH_SEEDS <= seed < 2 * FRESH_SEEDS for seed in seeds)
    assert verify._fresh_seed("off", None) is None
    assert verify._fresh_seed("5", None) == 5


def test_family_with_a_known_failure_gets_no_fresh_rows(tmp_path):
    known = tmp_path / "known.toml"
    entries = ('family = "ring"', 'case = "axis-0003"')
    known.write_text("".join(f'[[known_failure]]\n{entry}\nreason = "x"\n' for entry in entries))
    usual = ConformancePlan(("builtin:fast",), ("ring", "axis", "uniform"), count=7, known_failures=known)
    fresh = ConformancePlan(("builtin:fast",), ("ring", "axis", "uniform"), count=7, known_failures=known, fresh=SEED)
    before, after = (planned_cases(plan, Description("any")) for plan in (usual, fresh))
    assert {name: after[name] - before[name] for name in after} == {"ring": 0, "axis": 0, "uniform": 7}
    assert planned_size(fresh) == planned_size(usual) + 7
