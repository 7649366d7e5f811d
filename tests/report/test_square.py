"""The square of truth against answer, which a failing run shows first."""

from __future__ import annotations

import re

import pytest

from hypcheck.report.terminal import summary_lines
from hypcheck.report.verdict import AMISS
from hypcheck.report.write import render
from tests.report import record_samples

ANSWERS = {"1": {"1": 5, "0": 2}, "0": {"0": 3, "2": 1}, "-1": {"-1": 4, "none": 1}}


def gated(answers, question="position", **others):
    """A line about an implementation under test of which two answers are wrong and one is tolerated."""
    worst = [record_samples.worst("ring/1/1/7", "wrong", 12.0)] * 3
    counts = {"right": 12, "wrong": 2, "tolerated": 1, "abstained": 1}
    failing = {"spec": "library:engine.so", "failing": ["wrong"], "faults": []}
    line = record_samples.group("mine", "float64", "ring", counts, worst, answers=answers, **failing, **others)
    return {**line, "question": question}


def summary(*lines, exit_code=1):
    return summary_lines(record_samples.record(list(lines), exit_code), ())


def test_the_summary_of_a_failing_run_begins_with_the_square_of_answers():
    head, *square = summary(gated(ANSWERS))[:6]
    assert head.startswith("FAILED with exit code 1: mine: 2 wrong of 16 cases")
    assert square == [
        "  mine            answered exterior  answered contact  answered interior  cannot say  no valid answer",
        f"  truth exterior                  5               2 {AMISS}                  0           0                0",
        f"  truth contact                   0                 3                  0         1 {AMISS}                0",
        f"  truth interior                  0                 0                  4           0              1 {AMISS}",
        f"  {AMISS} includes 1 answer within the tolerance",
    ]


@pytest.mark.parametrize(
    ("question", "answers", "rows"),
    [
        ("exterior", {"1": {"1": 2}, "0": {"1": 3, "0": 4}, "-1": {"0": 5}}, ["2 0", f"3 {AMISS} 4", "0 5"]),
        ("contact", {"1": {"0": 2}, "0": {"1": 3, "0": 4}}, ["0 2", f"3 4 {AMISS}"]),
        ("passage", {"1": {"1": 2, "0": 1}, "0": {"0": 3}}, [f"2 1 {AMISS}", "0 3"]),
    ],
)
def test_the_square_of_answers_marks_as_wrong_what_the_question_does_not_accept(question, answers, rows):
    lines = summary(gated(answers, question))[2 : 2 + len(rows)]
    assert [" ".join(line.split()[-len(row.split()) :]) for line, row in zip(lines, rows, strict=True)] == rows


def test_the_square_of_answers_has_separate_columns_for_contact_reported_too_late_and_too_early():
    late = {**gated({"1": {"1": 12}, "0": {"0": 4}}, "passage"), "mistakes": {"late": 2, "early": 1}}
    *titles, hits, clear = (re.split(r"  +", line.strip()) for line in summary(late)[1:4])
    assert titles[0][1:] == [*titles[0][1:3], "contact too late", "contact too early"]
    assert hits[1:] == ["9", "0", f"2 {AMISS}", f"1 {AMISS}"]
    assert clear[1:] == ["0", "4", "0", "0"]


def test_the_square_of_answers_is_the_sum_over_families_and_is_omitted_for_a_run_that_passed():
    two = summary(gated(ANSWERS), {**gated(ANSWERS), "family": "waist"})
    assert two[2].split()[:4] == ["truth", "exterior", "10", "4"]
    held = {**gated({"1": {"1": 16}}), "counts": {"right": 16}, "worst": [], "failing": []}
    assert not any("truth" in line for line in summary(held, exit_code=0))


def test_a_report_shows_the_square_of_answers_before_the_causes():
    page = render("markdown", record_samples.record([gated(ANSWERS)], 1)).decode()
    assert page.index("Answers against the truth") < page.index("What failed")
