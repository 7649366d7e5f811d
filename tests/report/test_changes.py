"""What changed between two records: statuses, errors and ratios, and never two machines' times."""

from __future__ import annotations

import dataclasses
import json

import pytest

from hypcheck.record.fields import as_json, decoded
from hypcheck.record.lines import HeaderLine
from hypcheck.report import markdown, terminal
from hypcheck.report.changes import (
    FASTER,
    SLOWER,
    UNCLEAR,
    accuracy_changes,
    conditions,
    only_in_one,
    ratio_changes,
    status_changes,
)
from hypcheck.report.drawings import ReportContext
from hypcheck.report.messages import figure
from hypcheck.report.model import worst_u
from tests.report import bench_lines, record_samples


def changed(body, kind, change, **named):
    """The lines with the first of a kind and of these values updated."""
    copy = json.loads(json.dumps(body))
    line = next(line for line in copy if line["type"] == kind and all(line[k] == v for k, v in named.items()))
    line.update(change)
    return copy


BEFORE = record_samples.record()
WORSE = record_samples.record(
    changed(
        record_samples.lines(),
        "group",
        {"counts": {"right": 17, "wrong": 3}, "worst": [record_samples.worst("tower-body/1/1/5", "wrong", 40.0)]},
        method="table-2-float32",
        family="tower-body",
    )
)
BENCH = bench_lines.bench_record()


def test_comparison_of_a_record_with_itself_shows_no_change():
    for record in (BEFORE, BENCH):
        assert status_changes(record, record) == []
        assert accuracy_changes(record, record) == []
        assert {change.verdict for change in ratio_changes(record, record)} <= {UNCLEAR}
        assert [*conditions(record, record), *only_in_one(record, record)] == []
    assert "No case ended otherwise." in markdown.render(BEFORE, ReportContext(against=BEFORE)).decode()


def test_status_changes_list_a_family_that_got_worse_before_one_that_got_better():
    (worse,) = status_changes(BEFORE, WORSE)
    assert (worse.implementation, worse.family, worse.worse) == ("table-2-float32", "tower-body", True)
    assert (worst_u(worse.before), worst_u(worse.after)) == (2.5, 40.0)
    (better,) = status_changes(WORSE, BEFORE)
    assert not better.worse


def test_a_family_is_worse_by_its_share_of_wrong_answers_and_not_by_their_number():
    many = changed(
        record_samples.lines(),
        "group",
        {"counts": {"right": 90, "wrong": 8, "tolerated": 2}},
        method="table-2-float32",
        family="ring",
    )
    (change,) = status_changes(BEFORE, record_samples.record(many))  # 10 of 19 before, 10 of 100 now
    assert not change.worse


@pytest.mark.parametrize(
    ("interval", "verdict"),
    [([0.2, 0.3], FASTER), ([0.9, 1.2], SLOWER), ([0.5, 0.9], UNCLEAR), (None, UNCLEAR)],
)
def test_ratios_of_two_records_differ_if_their_intervals_do_not_overlap(interval, verdict):
    body = [bench_lines.speed("m", "uniform", "batch", 60.0, 100.0)]  # 0.576 to 0.624
    after = changed(body, "speed", {"ratio_ci95": interval})
    (change,) = ratio_changes(record_samples.record(body), record_samples.record(after))
    assert change.verdict == verdict


def test_different_times_with_equal_ratios_are_no_change():
    """A machine that is ten times as slow has other times and the same ratios."""
    slow = json.loads(json.dumps(bench_lines.lines()))
    for line in slow:
        if line["type"] == "speed":
            line["median_ns"] *= 10
            line["samples_ns"] = [[10 * sample for sample in process] for process in line["samples_ns"]]
    other = record_samples.record(slow)
    assert {change.verdict for change in ratio_changes(BENCH, other)} == {UNCLEAR}
    section = (
        markdown.render(other, ReportContext(against=BENCH))
        .decode()
        .partition("## What changed")[2]
        .partition("\n## ")[0]
    )
    assert " ns" not in section


def test_changed_errors_of_a_benchmark_are_listed_by_method_and_workload():
    after = changed(bench_lines.lines(), "accuracy", {"wrong": 7, "reliable_above": 0.25}, method="dual-numpy-float32")
    (change,) = accuracy_changes(BENCH, record_samples.record(after))
    assert (change.after.method, change.after.workload, change.after.wrong, change.after.reliable_above) == (
        "dual-numpy-float32",
        "uniform",
        7,
        0.25,
    )


def test_other_differences_of_two_runs_are_reported():
    header = as_json(BEFORE.header)
    header["machine"]["processor"] = "another"
    header["options"]["seed"] = 2
    header["hypcheck"] = "9.9.9"
    other = dataclasses.replace(BEFORE, header=decoded(header, HeaderLine), footer=None)
    said = list(conditions(BEFORE, other))
    assert any(each.startswith("another machine: processor") for each in said)
    assert "option seed 1, now 2" in said
    assert any("now 9.9.9" in each for each in said)
    assert any("truncated" in each for each in said)


def test_methods_that_one_record_lacks_are_named_and_not_compared():
    fewer = [line for line in record_samples.lines() if line.get("method") != "table-2-float64"]
    fewer = [line for line in fewer if (line.get("method"), line.get("family")) != ("fast", "ring")]
    other = record_samples.record(fewer)
    assert status_changes(BEFORE, other) == []
    assert list(only_in_one(BEFORE, other)) == [
        "methods in the other record alone: table-2-float64",
        "families in the other record alone: ring",
    ]
    assert [each.replace("this", "the other") for each in only_in_one(other, BEFORE)] == list(
        only_in_one(BEFORE, other)
    )


def test_reports_show_changes_after_failures():
    text = markdown.render(WORSE, ReportContext(against=BEFORE)).decode()
    assert text.index("## What changed") < text.index("## The oracles")
    assert "| `table-2-float32` | `tower-body` | 19 right and 1 tolerated | 17 right and 3 wrong | 2.5 | 40 |" in text
    lines = terminal.render(WORSE, ReportContext(against=BEFORE)).decode()
    assert "1 family of a method changed, worse: table-2-float32 on tower-body" in lines


def test_a_table_of_changed_errors_shows_shares_and_reliability_before_and_after():
    after = changed(bench_lines.lines(), "accuracy", {"wrong": 7, "reliable_above": 0.25}, method="dual-numpy-float32")
    other = record_samples.record(after)
    (change,) = accuracy_changes(BENCH, other)
    text = markdown.render(other, ReportContext(against=BENCH)).decode().partition("## What changed")[2]
    row = next(line for line in text.splitlines() if line.startswith("| `dual-numpy-float32` | uniform |"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    before, after = change.before, change.after
    shares = [f"{before.wrong} of {before.asked:,}", f"7 of {after.asked:,}"]
    assert cells[2:] == [*shares, figure(float(before.reliable_above)), "0.25"]
    assert "No case ended otherwise." not in text
    said = "\n".join(terminal.summary_lines(other, [], against=BENCH))
    assert "  errors: dual-numpy-float32 on uniform changed" in said


def test_versions_of_libraries_that_differ_are_reported():
    header = as_json(BEFORE.header)
    name, old = next(iter(header["versions"].items()))
    header["versions"][name] = "0.0.1"
    other = dataclasses.replace(BEFORE, header=decoded(header, HeaderLine))
    assert list(conditions(BEFORE, other)) == [f"{name} {old}, now 0.0.1"]


def test_the_terminal_counts_differences_of_two_runs_beyond_a_few():
    header = as_json(BEFORE.header)
    header["versions"] = dict.fromkeys(header["versions"], "0.0.1")
    header["machine"] |= {"processor": "another", "architecture": "another", "system": "another", "cores": 77}
    other = dataclasses.replace(BEFORE, header=decoded(header, HeaderLine))
    count = len([*conditions(BEFORE, other), *only_in_one(BEFORE, other)])
    said = "\n".join(terminal.summary_lines(other, [], against=BEFORE))
    assert count > terminal.MOST_CONDITIONS + 1
    assert f"  and {count - terminal.MOST_CONDITIONS} more differences between the runs themselves" in said
