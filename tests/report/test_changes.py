"""What changed between two records: statuses, errors and ratios, and never two machines' times.

The goldens of runs that are compared show what reports say of it.
"""

from __future__ import annotations

import dataclasses

import pytest

from hypcheck.report import markdown, terminal
from hypcheck.report.changes import FASTER, SLOWER, UNCLEAR, ratio_changes, status_changes
from hypcheck.report.drawings import ReportContext
from tests.report import bench_lines, record_samples


def with_group(family, counts, *worst):
    """The record in which a family of table-2-float32 ended with these counts."""
    body = [
        line if (line.get("method"), line.get("family")) != ("table-2-float32", family) else
        {**line, "counts": counts, "worst": [*worst]}
        for line in record_samples.lines()
    ]  # fmt: skip
    return record_samples.record(body)


BEFORE = record_samples.record()
WORSE = with_group("tower-body", {"right": 17, "wrong": 3}, record_samples.worst("tower-body/1/1/5", "wrong", 40.0))
BENCH = bench_lines.bench_record()


def compared(record, against):
    """The section about changes."""
    text = markdown.render(record, ReportContext(against=against)).decode()
    return text.partition("## What changed")[2].partition("\n## ")[0]


@pytest.mark.parametrize("record", [BEFORE, BENCH])
def test_comparison_of_a_record_with_itself_shows_no_change(record):
    section = compared(record, record)
    assert "No case ended otherwise." in section
    assert not any(line.startswith("- ") for line in section.splitlines())
    assert {change.verdict for change in ratio_changes(record, record)} <= {UNCLEAR}


def test_status_changes_state_the_name_of_a_family_that_became_worse():
    (worse,) = status_changes(BEFORE, WORSE)
    assert (worse.implementation, worse.family, worse.worse) == ("table-2-float32", "tower-body", True)
    assert not status_changes(WORSE, BEFORE)[0].worse
    lines = terminal.summary_lines(WORSE, (), against=BEFORE)
    assert "  statuses: 1 family of a method changed, worse: table-2-float32 on tower-body" in lines


@pytest.mark.parametrize(
    "counts",
    [
        {"right": 90, "wrong": 8, "tolerated": 2},  # 10 of 19 before, 10 of 100 now
        {"right": 9, "skipped": 1, "tolerated": 6, "wrong": 4},  # as many as before, and less wrong
    ],
)
def test_a_family_is_worse_by_its_share_of_wrong_answers_and_not_by_their_number(counts):
    (change,) = status_changes(BEFORE, with_group("ring", counts, record_samples.worst("ring/1/1/7", "wrong", "inf")))
    assert not change.worse


@pytest.mark.parametrize(
    ("interval", "verdict"),
    [([0.2, 0.3], FASTER), ([0.9, 1.2], SLOWER), ([0.5, 0.9], UNCLEAR), (None, UNCLEAR)],
)
def test_ratios_of_two_records_differ_if_their_intervals_do_not_overlap(interval, verdict):
    line = bench_lines.speed("m", "uniform", "batch", 60.0, 100.0)  # 0.576 to 0.624
    before, after = (record_samples.record([each]) for each in (line, {**line, "ratio_ci95": interval}))
    (change,) = ratio_changes(before, after)
    assert change.verdict == verdict


def test_different_times_with_equal_ratios_are_no_change():
    """A machine that is ten times as slow has other times and the same ratios."""
    slow = bench_lines.lines()
    for line in slow:
        if line["type"] == "speed":
            line["median_ns"] *= 10
            line["samples_ns"] = [[10 * sample for sample in process] for process in line["samples_ns"]]
    section = compared(bench_lines.bench_record(slow), BENCH)
    assert section == compared(BENCH, BENCH)
    assert " ns" not in section


def test_comparison_with_a_truncated_record_mentions_the_truncation():
    assert "the other record is truncated" in compared(BEFORE, dataclasses.replace(BEFORE, footer=None))
    assert "this record is truncated" in compared(dataclasses.replace(BEFORE, footer=None), BEFORE)
