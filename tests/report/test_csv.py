"""measurements.csv has every measurement, each on a line of its own, and nothing that a spreadsheet would run."""

from __future__ import annotations

import csv
import io

import pytest

from hypcheck.report.csv import HEAD, render
from tests.report import bench_lines, record_samples
from tests.report.bench_lines import bench_record

MEASURING = {"oracle", "finding", "group", "map", "timing", "accuracy", "speed", "noise", "memory", "stability"}
MEASURING |= {"places", "convergence", "bounding", "cost", "kernel", "forest", "scene", "comparison"}
"""The types of lines that have measurements."""


def rows(record):
    return list(csv.DictReader(io.StringIO(render(record).decode("utf-8"))))


def test_every_line_of_the_csv_report_has_every_column():
    for row in rows(bench_record()):
        assert list(row) == list(HEAD)
        assert None not in row.values()


def test_csv_report_has_every_type_of_line_with_measurements():
    told = {row["kind"] for row in rows(record_samples.record([*record_samples.lines(), *bench_lines.lines()]))}
    assert told == MEASURING


@pytest.mark.parametrize("name", ["=1+1", "@SUM(A1)", "-2+3", "+x", '"quoted", with commas', "two\nlines"])
def test_csv_report_escapes_foreign_names_that_look_like_formulas(name):
    body = record_samples.rewritten(bench_lines.lines(), "foreign-adapter", name)
    names = {row["method"] for row in rows(bench_record(body))}
    assert not any(each[:1] in "=+-@" for each in names if each)
    assert any(name.replace("\n", " ") in each for each in names)
