"""Asking again finds what one question at a time, in one order and of one size, does not show."""

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


def test_answers_carried_over_from_moment_to_moment_are_found(tmp_path):
    code, record = gate(tmp_path, "carries_over", "--families", "flight")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "nondeterministic"}
    assert "when asked again, in another order and batch" in line.faults[0].reason
    assert gate(tmp_path, "carries_over", "--families", "flight", "--count", "0")[0] == 0  # nothing moves


@pytest.mark.parametrize(("name", "code"), [("loses_the_second_thread", 1), ("slowly_loses_the_second_thread", 0)])
def test_a_question_as_large_as_it_stands_is_asked_by_default(tmp_path, name, code):
    count = ("--count", "4000" if code else "1")  # enough questions to grow, though the machine be busy
    ended, record = gate(tmp_path, name, "--families", "tower-body", *count)
    assert ended == code
    assert counts(record)["tower-body"].get("nondeterministic", 0) == record.of(ImplementationLine)[0].again.beyond
    assert FULL_QUESTION > 4096


@pytest.mark.parametrize("name", ["forgets_what_comes_again", "forgets_twins"])
def test_a_small_run_asks_the_same_row_again_too(tmp_path, name):
    code, record = gate(tmp_path, name, "--families", "tower-body", "--count", "40")
    assert code == 1
    assert record.of(GroupLine)[0].counts["nondeterministic"] > 0


def test_one_case_in_a_hundred_is_asked_again_of_many(tmp_path):
    code, record = gate(tmp_path, "exact", "--families", "tower-body,ring", "--count", "20000")
    assert code == 0
    (line,) = record.of(ImplementationLine)
    asked = sum(each.asked for each in record.of(GroupLine))
    assert asked / 100 < line.again.asked < asked / 50
    assert line.again.within == line.again.beyond == 0


def test_a_change_that_rounding_explains_fails_those_alone_who_must_not_change(tmp_path):
    families = ("--families", "tangent,tower-body")
    code, record = gate(tmp_path, "forgets_a_little", *families)
    assert record.of(ImplementationLine)[0].again.within > 0
    assert set(counts(record)["tangent"]) == {"right", "tolerated"}
    assert code == 0
    assert gate(tmp_path, "forgets_a_little", *families, "--deterministic")[0] == 1


def test_who_fails_when_asked_again_is_told_with_the_reason(tmp_path):
    code, record = gate(tmp_path, "raises_when_asked_alone", "--families", "tower-body")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "error"}
    assert line.faults[0].reason.startswith("when asked again: it raised ValueError: one is not enough")
