"""`verify SPEC`: which implementations pass, exit codes of those that fail, and the lines of the record."""

from __future__ import annotations

import json

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from tests.runs import faulty

pytestmark = pytest.mark.usefixtures("text_reports")


def gate(tmp_path, spec, *options, count="40"):
    out = tmp_path / "out"
    code = main(["verify", spec, "--out", str(out), "--count", count, *options])
    return code, (read(out / "record.jsonl") if (out / "record.jsonl").exists() else None)


def subject(name):
    return f"python:tests.runs.faulty:{name}"


def statuses(record):
    total = {}
    for line in record.of(GroupLine):
        for status, number in line.counts.items():
            total[status] = total.get(status, 0) + number
    return total


@pytest.mark.thorough
def test_verify_passes_an_exact_implementation_with_tolerance_0(tmp_path):
    code, record = gate(tmp_path, subject("exact"), "--tolerance", "0", "--families", "extreme,*", count="10")
    assert code == 0
    assert set(statuses(record)) <= {"right", "skipped"}


def test_table_2_fails_on_the_ring_and_passes_on_the_scenes_of_the_paper(tmp_path):
    assert gate(tmp_path, "builtin:table-2-float64", "--families", "ring", count="4")[0] == 1
    assert gate(tmp_path, "builtin:table-2-float64", "--families", "forest-type-1,forest-type-2", count="4")[0] == 0


def test_implementation_with_a_constant_answer_fails(tmp_path, built_in):
    code, record = gate(tmp_path, built_in(faulty.contact_everywhere), "--families", "uniform", count="0")
    assert code == 1
    assert statuses(record)["wrong"] > 60


def test_option_fail_on_false_clear_passes_other_wrong_answers(tmp_path, built_in):
    families = ["--families", "near-tangent-outside"]
    wall, gap = built_in(faulty.never_clear_by_a_little), built_in(faulty.too_clear)
    assert gate(tmp_path, wall, *families, count="0")[0] == 1
    assert gate(tmp_path, wall, *families, "--fail-on", "false-clear", count="0")[0] == 0
    assert gate(tmp_path, gap, *families, "--fail-on", "false-clear", count="0")[0] == 1


def test_run_passes_with_at_most_max_abstained_abstentions(tmp_path, built_in):
    spec, *families = built_in(faulty.cannot_say_above), "--families", "tower-body"
    code, record = gate(tmp_path, spec, *families, count="4")
    assert code == 1
    number = statuses(record)["abstained"]
    assert gate(tmp_path, spec, *families, "--max-abstained", str(number - 1), count="4")[0] == 1
    assert gate(tmp_path, spec, *families, "--max-abstained", str(number), count="4")[0] == 0


def test_implementation_of_which_nothing_is_judged_fails_a_run_of_several(tmp_path, built_in):
    options = ("--families", "tower-body", "--max-abstained", "100000")
    code, record = gate(tmp_path, built_in(faulty.cannot_say), "builtin:fast", *options)
    assert code == 2
    assert statuses(record)["right"] == 160  # of the other, which is recorded all the same
    domain = '{"settings": [{"sizes": [1, 1, 1, 1]}]}'
    code, _ = gate(tmp_path, "builtin:fast", "--families", "tower-bod*", "--domain", domain)
    assert code == 2


def test_implementation_with_changing_answers_fails(tmp_path, built_in, monkeypatch):
    monkeypatch.setattr(faulty, "_CALLS", [0])
    code, record = gate(tmp_path, built_in(faulty.forgetful), "--families", "tower-body", "--tolerance", "0")
    assert code == 1
    assert statuses(record).get("nondeterministic", 0) + statuses(record).get("wrong", 0) > 0


@pytest.mark.parametrize(
    ("name", "status", "families"),
    [("dies_on_the_axis", "crash", "extreme-hair,tower-body"), ("raises_at_the_waist", "error", "waist,tower-body")],
)
def test_fault_of_an_implementation_affects_only_the_cases_that_cause_it(tmp_path, name, status, families):
    code, record = gate(tmp_path, subject(name), "--families", families, "--restarts", "200", count="0")
    assert code == 1
    found = {line.family: line for line in record.of(GroupLine)}
    assert found["tower-body"].counts.get("right", 0) > 100
    (other,) = set(found) - {"tower-body"}
    assert found[other].counts[status] > 0
    assert found[other].faults[0].reason


def test_invalid_rows_are_tested_only_if_refuses_is_declared(tmp_path, built_in):
    specs = [built_in(function, refuses=True) for function in (faulty.refuses, faulty.answers_bad_rows)]
    code, record = gate(tmp_path, *specs, "builtin:fast", "--families", "tower-body", count="0")
    assert code == 1
    keeps, lies = (line for line in record.of(GroupLine) if line.family == "invalid")
    assert (keeps.spec, lies.spec) == tuple(specs)
    assert (keeps.failing, lies.failing) == ([], ["wrong"])
    assert keeps.counts == {"refused": keeps.asked}
    assert keeps.asked > 50
    assert lies.counts["wrong"] > 50


LIST = """
[[known_failure]]
family = "ring"
reason = "the discriminant vanishes there"
[[known_failure]]
family = "ring-neighbourhood"
max_u = 1e17
reason = "likewise"
"""


def test_known_failures_excuse_cases_and_fail_the_run_when_they_no_longer_occur(tmp_path, capsys):
    path = tmp_path / "known.toml"
    path.write_text(LIST, encoding="utf-8")
    table_2 = ("builtin:table-2-float64", "--known-failures", str(path), "--families")
    code, record = gate(tmp_path, *table_2, "ring,ring-neighbourhood")
    assert code == 0
    assert statuses(record)["excused"] > 50
    exact = ("builtin:fast", "--known-failures", str(path), "--families")
    assert gate(tmp_path, *exact, "ring")[0] == 1
    assert "no longer fails" in capsys.readouterr().out
    assert gate(tmp_path, *exact, "tower-body")[0] == 0  # the entries' families were not asked
    path.write_text(LIST.replace("1e17", "8.5"), encoding="utf-8")
    assert gate(tmp_path, *table_2, "ring-neighbourhood")[0] == 1  # further off than what is excused


@pytest.mark.usefixtures("few_families")
def test_known_failures_are_updated_only_from_a_run_of_all_families(tmp_path, capsys):
    path = tmp_path / "known.toml"
    update = ["--known-failures", str(path), "--update"]
    assert gate(tmp_path, "builtin:table-2-float64", *update, "--families", "ring")[0] == 2
    assert not path.exists()
    assert gate(tmp_path, "builtin:table-2-float64", *update, count="0")[0] == 1
    assert 'cause = "ring"' in path.read_text(encoding="utf-8")
    assert gate(tmp_path, "builtin:table-2-float64", "--known-failures", str(path), count="0")[0] == 0
    right, wrong = "tower-body", "ring"
    entries = [f'[[known_failure]]\nfamily = "{name}"\nreason = "mine"\n' for name in (right, wrong)]
    path.write_text("".join(entries) + path.read_text(encoding="utf-8"), encoding="utf-8")
    assert gate(tmp_path, "builtin:table-2-float64", *update, count="0")[0] == 1
    text = path.read_text(encoding="utf-8")
    assert 'family = "ring"\nreason = "mine"' in text
    assert "tower-body" not in text
    assert text.count('cause = "ring"') == 1


def test_summary_json_of_verify_has_its_documented_counts_and_families(tmp_path):
    gate(tmp_path, "builtin:table-2-float32", "--families", "ring,tower-body")
    (found,) = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["implementations"]
    assert found["spec"] == "builtin:table-2-float32"
    assert found["asked"] == found["right"] + found["tolerated"] + found["wrong"] + found["excused"]
    assert found["worst_backward_error_u"] > 1e6
    assert set(found["families"]) == {"ring", "tower-body"}


@pytest.mark.thorough
def test_worst_cancellations_are_tested_if_no_families_are_chosen(tmp_path):
    _, record = gate(tmp_path, "builtin:local-maximum-float64", count="1")
    asked = {line.family: line for line in record.of(GroupLine)}
    assert asked["worst-cancellation"].counts["wrong"] > 10


def test_distances_are_recorded_of_the_first_cases_of_a_large_family_only(tmp_path):
    code, record = gate(tmp_path, "builtin:fast", "--families", "tower-body", count="70000")
    assert code == 0
    (line,) = record.of(GroupLine)
    assert line.asked == line.counts["right"] > 70000
    assert sum(number for counts in line.octaves.values() for number in counts.values()) == 2000
    assert sum(cell[2] for cell in line.size_bins) == line.asked
