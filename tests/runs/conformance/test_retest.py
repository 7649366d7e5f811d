"""The retest finds errors that a single batch in one order and of one size does not show."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.runs.retest import FULL_QUESTION

pytestmark = pytest.mark.usefixtures("text_reports")


def gate(tmp_path, name, *options):
    out = tmp_path / "out"
    code = main(["verify", f"python:tests.runs.faulty:{name}", "--out", str(out), *options])
    return code, read(out / "record.jsonl")


def counts(record):
    return {line.family: line.counts for line in record.of(GroupLine)}


def test_retest_finds_answers_that_depend_on_the_previous_moment_of_a_flight(tmp_path):
    code, record = gate(tmp_path, "carries_over", "--families", "flight")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "nondeterministic"}
    assert "when asked again, in another order and batch" in line.faults[0].reason
    assert gate(tmp_path, "carries_over", "--families", "flight", "--count", "0")[0] == 0  # nothing moves


@pytest.mark.parametrize(("name", "code"), [("loses_the_second_thread", 1), ("slowly_loses_the_second_thread", 0)])
def test_retest_asks_the_largest_proven_batch(tmp_path, name, code):
    count = ("--count", "4000" if code else "1")  # enough questions to grow, though the machine be busy
    ended, record = gate(tmp_path, name, "--families", "tower-body", *count)
    assert ended == code
    assert counts(record)["tower-body"].get("nondeterministic", 0) == record.of(ImplementationLine)[0].again.beyond
    assert FULL_QUESTION > 4096


@pytest.mark.parametrize("name", ["forgets_what_comes_again", "forgets_twins"])
def test_small_run_retests_rows_too(tmp_path, name):
    code, record = gate(tmp_path, name, "--families", "tower-body", "--count", "40")
    assert code == 1
    assert record.of(GroupLine)[0].counts["nondeterministic"] > 0


def test_one_case_in_a_hundred_of_a_large_family_is_retested(tmp_path):
    code, record = gate(tmp_path, "exact", "--families", "tower-body,ring", "--count", "20000")
    assert code == 0
    (line,) = record.of(ImplementationLine)
    asked = sum(each.asked for each in record.of(GroupLine))
    assert asked / 100 < line.again.asked < asked / 50
    assert line.again.within == line.again.beyond == 0


@pytest.mark.thorough
def test_answer_that_changes_within_the_tolerance_fails_only_with_deterministic(tmp_path):
    families = ("--families", "tangent,tower-body")
    code, record = gate(tmp_path, "forgets_a_little", *families)
    assert record.of(ImplementationLine)[0].again.within > 0
    assert set(counts(record)["tangent"]) == {"right", "tolerated"}
    assert code == 0
    assert gate(tmp_path, "forgets_a_little", *families, "--deterministic")[0] == 1


def test_fault_during_the_retest_is_recorded_with_its_reason(tmp_path):
    code, record = gate(tmp_path, "raises_when_asked_alone", "--families", "tower-body")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "error"}
    assert line.faults[0].reason.startswith("when asked again: it raised ValueError: one is not enough")
