"""Rows and families that are not asked: how many there are and why is in the verdict, the record and every report."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from hypcheck import classify
from hypcheck.cli.main import main
from hypcheck.implementations import domain as domains
from hypcheck.implementations.description import parse_domain
from hypcheck.implementations.domain import Domain
from hypcheck.record import read
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.vectors.frozen import load

pytestmark = pytest.mark.usefixtures("text_reports")


def flushes(rows):
    """Answers 0 to every row with a subnormal number."""
    small = ((rows != 0) & (abs(rows) < 2.0**-1022)).any(axis=1)
    return np.where(small, 0, classify(rows)).astype(np.int8)


def gate(*words):
    return main(["verify", *words, "--out", "out"])


def subnormal_rows():
    """The numbers of frozen rows with a number that is subnormal in float64, by family; none in others."""
    found = {}
    for name in ("extreme-subnormal", "extreme-float64", "extreme-magnitude", "extreme-hair"):
        rows = np.abs(load(name).rows)
        found[name] = int(((rows != 0) & (rows < 2.0**-1022)).any(axis=1).sum())
    return found


def test_subnormal_rows_that_a_pattern_names_are_counted_in_every_report(built_in, capsys):
    expected = subnormal_rows()
    assert gate(built_in(flushes), "--families", "extreme", "--count", "0") == 0
    rows = sum(expected.values())
    said = capsys.readouterr().out
    sentence = f"; no fresh rows; skipped: {rows:,} rows not zero or normal in its precision; not asked: "
    assert said.startswith("HELD: flushes: ")
    assert sentence in said.splitlines()[0]
    record = read(Path("out"))
    found = {line.family: line.not_asked.get("precision", 0) for line in record.of(GroupLine)}
    assert {name: found[name] for name in expected} == expected
    summary = json.loads(Path("out/summary.json").read_text())
    (whole,) = summary["implementations"]
    assert whole["not_asked"] == {"precision": rows}
    assert whole["fresh"] == 0
    assert whole["families"]["extreme-subnormal"]["not_asked"] == {"precision": expected["extreme-subnormal"]}
    assert sentence in summary["verdict"]
    assert sentence in Path("out/report.md").read_text()
    sarif = json.loads(Path("out/results.sarif").read_text())
    assert sentence in sarif["runs"][0]["invocations"][0]["exitCodeDescription"]
    cases = {case.get("name"): case for case in Xml.fromstring(Path("out/junit.xml").read_text()).iter("testcase")}  # noqa: S314
    skipped = expected["extreme-subnormal"]
    told = f"skipped: {skipped} of 120 cases: {skipped} rows not zero or normal in its precision"
    assert told in cases["extreme-subnormal"].find("system-out").text
    lines = Path("out/measurements.csv").read_text()
    assert f"extreme-subnormal,builtin:flushes,not asked: precision,{expected['extreme-subnormal']}" in lines


def test_verdict_names_a_family_of_which_no_row_was_tested(capsys):
    options = ("--families", "tower-body,extreme-float6*", "--precision", "float16", "--count", "0")
    assert gate("builtin:fast", *options) == 0
    head = capsys.readouterr().out.splitlines()[0]
    assert "; skipped: 180 rows not zero or normal in its precision, all of extreme-float64; not asked: " in head
    cases = {case.get("name"): case for case in Xml.fromstring(Path("out/junit.xml").read_text()).iter("testcase")}  # noqa: S314
    message = cases["extreme-float64"].find("skipped").get("message")
    assert message == "all 180 cases were not asked: 180 rows not zero or normal in its precision"


NARROW = '{"ratio": [0.67, 1.5], "magnitude": [0.5, 2]}'
WIDE = '{"ratio": [0.1, 10], "magnitude": [0.1, 10]}'


@pytest.mark.parametrize(
    ("domain", "families", "code"),
    [(NARROW, "small-integers,ring,near-axis", 4), (WIDE, "forest-type-*", 0), ("{}", "extreme-hair", 0)],
    ids=["narrow", "wide", "small family"],
)
def test_run_is_inconclusive_where_the_domain_leaves_few_of_many_rows(domain, families, code, capsys):
    """A domain of 7 of 400 rows proves nothing; a small family of which all rows are asked proves what it asks."""
    assert gate("builtin:fast", "--families", families, "--count", "0", "--domain", domain) == code
    head = capsys.readouterr().out.splitlines()[0]
    groups = read(Path("out")).of(GroupLine)
    judged, skipped = sum(line.judged for line in groups), sum(line.skipped for line in groups)
    assert ("HELD: " if code == 0 else "INCONCLUSIVE, exit code 4: too few rows: ") in head
    assert f"fast: {judged:,} judged: {judged:,} right; " in head
    assert ("; skipped: " in head) == bool(skipped)
    assert "; not asked: " in head
    summary = json.loads(Path("out/summary.json").read_text())
    assert (summary["exit_code"], summary["verdict"]) == (code, head)
    assert (judged < 100) == (domain != WIDE)


@pytest.mark.parametrize(
    ("judged", "skipped", "few"),
    [(9, 24_000, True), (99, 100, True), (99, 98, False), (100, 9_900, False), (100, 10_001, True), (5, 0, False)],
)
def test_fewer_than_a_hundred_rows_or_one_in_a_hundred_are_too_few_where_most_are_skipped(judged, skipped, few):
    assert domains.too_few(judged, skipped) is few


def test_run_that_fails_lists_untested_rows_on_the_terminal(capsys):
    assert gate("builtin:table-2-float32", "--families", "extreme", "--count", "0") == 1
    told = [line.not_asked for line in read(Path("out")).of(GroupLine)]
    small, outside = (sum(each.get(reason, 0) for each in told) for reason in ("precision", "regime"))
    assert min(small, outside) > 100
    expected = f"{small} rows not zero or normal in its precision and {outside} rows outside the regimes of its domain"
    said = [line for line in capsys.readouterr().out.splitlines() if line.startswith("table-2-float32: not asked: ")]
    assert len(said) == 1
    assert said[0].endswith(f"; {expected}")


def test_family_of_subnormal_rows_is_tested_if_it_is_named(built_in, capsys):
    assert gate(built_in(flushes), "--families", "extreme-subnormal", "--count", "0") == 1
    (group,) = read(Path("out")).of(GroupLine)
    assert group.counts["wrong"] == 18
    assert "skipped" not in group.counts
    assert gate("builtin:fast", "--families", "extreme-subnormal", "--count", "0") == 0


def test_subnormal_numbers_are_representable_only_if_the_precision_holds_them_exactly():
    step = 2.0**-149
    rows = np.array([[2.0, 1, 1, 1, 3, 0, step], [2.0, 1, 1, 1, 3, 0, 1.5 * step], [2.0, 1, 1, 1, 3, 0, 2.0**-126]])
    from hypcheck.implementations.domain import representable

    assert representable(rows, "float32").tolist() == [False, False, True]
    assert representable(rows, "float32", subnormal=True).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("domain", "reason"),
    [
        ('{"regimes": ["c2>=a"]}', "regime"),
        ('{"ratio": [1, 8]}', "ratio"),
        ('{"magnitude": [0.3, 1e6]}', "magnitude"),
        ('{"settings": [{"sizes": [2, 17.8, 0.25, 0.15]}]}', "sizes"),
    ],
)
def test_every_row_that_is_not_tested_has_one_reason(domain, reason):
    rows, claims = load("uniform").rows, parse_domain(domain)
    outside = rows[~claims.holds(rows)]
    assert 0 < len(outside)
    found = domains.reasons(outside, claims, "float64", extreme=False, subnormal=False)
    assert found == {reason: len(outside)}
    assert domains.reasons(rows[:0], Domain(), "float64", extreme=False, subnormal=False) == {}


@pytest.mark.parametrize("domain", ['{"regimes": ["a>=1", "c2>=a"], "ratio": [0.01, 99], "magnitude": [0.01, 30]}'])
def test_reasons_add_up_to_the_skipped_rows_of_each_family(domain):
    assert gate("builtin:fast", "--families", "uniform,ring,small-integers", "--domain", domain, "--count", "50") == 0
    for line in read(Path("out")).of(GroupLine):
        assert sum(line.not_asked.values()) == line.counts.get("skipped", 0)
        assert line.asked + line.counts.get("skipped", 0) == sum(line.counts.values())


def test_verdict_names_a_pattern_that_selects_only_untested_families(capsys):
    assert gate("builtin:table-2-float64", "--families", "tower-body,tilted-*", "--count", "0") == 0
    head = capsys.readouterr().out.splitlines()[0]
    assert "17 families of tilted spheroids (it takes none)" in head
    assert "7 families about another question" in head  # tilted-way-… and tilted-ended-way-…
    assert "families left out by --families" in head
    (line,) = read(Path("out")).of(ImplementationLine)
    assert {"tilted-uniform", "tilted-ring"} <= set(line.not_asked["tilt"])
    assert "uniform" in line.not_asked["filter"]
    summary = json.loads(Path("out/summary.json").read_text())
    assert set(summary["implementations"][0]["families_not_asked"]) == {"filter", "tilt", "question", "heights"}


@pytest.mark.usefixtures("few_families")
def test_run_of_all_families_records_the_families_that_run_only_on_request(capsys):
    assert gate("builtin:fast", "--count", "0") == 0
    assert "families" not in capsys.readouterr().out.splitlines()[0]
    (line,) = read(Path("out")).of(ImplementationLine)
    assert "extreme-float64" in line.not_asked["extreme"]
    assert "filter" not in line.not_asked


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
