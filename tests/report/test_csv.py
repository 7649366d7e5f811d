"""measurements.csv has every measurement, each on a line of its own, and nothing that a spreadsheet would run."""

from __future__ import annotations

import csv
import io

import pytest

from hypcheck.report.csv import HEAD, MEASUREMENTS, render
from tests.report import bench_lines, record_samples
from tests.report.bench_lines import bench_record


def rows(record):
    return list(csv.DictReader(io.StringIO(render(record).decode("utf-8"))))


def values(found, **wanted):
    return [row["value"] for row in found if all(row[name] == value for name, value in wanted.items())]


def test_every_line_of_the_csv_report_has_every_column():
    for row in rows(bench_record()):
        assert list(row) == list(HEAD)
        assert None not in row.values()


@pytest.mark.slow
def test_csv_report_has_every_sample_of_a_timing():
    found = rows(bench_record())
    speeds = [line for line in bench_lines.lines() if line["type"] == "speed"]
    for line in speeds:
        here = {"kind": "speed", "method": line["method"], "workload": line["workload"], "quantity": "ns"}
        for process, rounds in enumerate(line["samples_ns"]):
            for number, sample in enumerate(rounds):
                detail = f"{line['mode']}, process {process}, round {number}"
                assert values(found, detail=detail, **here) == [str(sample)]
    (ratio,) = [
        row
        for row in found
        if (row["method"], row["workload"], row["detail"], row["quantity"]) == ("fast", "flight", "batch", "ratio")
    ]
    line = next(each for each in speeds if (each["method"], each["workload"]) == ("fast", "flight"))
    assert [float(ratio[name]) for name in ("value", "low", "high")] == [line["ratio"], *line["ratio_ci95"]]


def test_wrong_answers_by_distance_exponent_in_the_csv_add_up():
    found = rows(bench_record())
    for line in (line for line in bench_lines.lines() if line["type"] == "accuracy"):
        here = {"kind": "accuracy", "method": line["method"], "workload": line["workload"]}
        assert values(found, quantity="wrong", detail="", **here) == [str(line["wrong"])]
        octaves = [
            row for row in found if row["detail"].startswith("octave") and all(row[k] == v for k, v in here.items())
        ]
        assert sum(int(row["value"]) for row in octaves if row["quantity"] == "asked") == line["asked"]


def test_csv_report_of_a_verification_has_its_counts():
    found = rows(record_samples.record())
    assert values(found, kind="group", method="table-2-float32", workload="ring", detail="", quantity="wrong") == ["6"]
    assert values(found, kind="oracle", method="roots", workload="ring", quantity="undecided") == ["2"]
    assert values(found, kind="timing", method="fast path", detail="round 1") == ["90.0"]


def test_csv_report_has_every_type_of_line_with_measurements():
    measuring = {kind.__struct_config__.tag for kind in MEASUREMENTS}
    assert {
        row["kind"] for row in rows(record_samples.record([*record_samples.lines(), *bench_lines.lines()]))
    } == measuring


@pytest.mark.parametrize("name", ["=1+1", "@SUM(A1)", "-2+3", "+x", '"quoted", with commas', "two\nlines"])
def test_csv_report_escapes_foreign_names_that_look_like_formulas(name):
    body = record_samples.rewritten(bench_lines.lines(), "foreign-adapter", name)
    names = {row["method"] for row in rows(bench_record(body))}
    assert not any(each[:1] in "=+-@" for each in names if each)
    assert any(name.replace("\n", " ") in each for each in names)
