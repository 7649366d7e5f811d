"""The committed benchmark is complete, has all methods, and its reports and pictures match its record."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from hypcheck.bench.contenders import contenders
from hypcheck.bench.plan import BenchPlan
from hypcheck.record import SCHEMA, read
from hypcheck.record.measurements import AbsentLine, AccuracyLine, MethodLine
from hypcheck.report import REPORTS, markdown
from hypcheck.report.drawings import ReportContext
from hypcheck.report.write import render
from hypcheck.version import VERSION

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "reports" / "reference" / "bench"
PICTURES = ("errors", "front", "pareto")
AROUND = ReportContext([REPORTS[name].file for name in PICTURES])


@pytest.fixture(scope="module")
def record():
    return read(FOLDER / "record.jsonl")


def test_reference_benchmark_is_complete_of_this_version_and_without_failures_in_five_minutes(record):
    assert record.header.hypcheck == VERSION
    assert record.header.schema.partition(".")[0] == SCHEMA.partition(".")[0]
    assert (record.header.options["command"], record.header.options["quick"]) == ("bench", False)
    assert record.footer.exit_code == 0
    assert record.footer.seconds < 300


def test_the_reference_benchmark_judged_every_method(record):
    named = {line.method for line in record.of(MethodLine)}
    assert named == set(contenders(BenchPlan()))
    assert {line.method for line in record.of(AccuracyLine)} == named
    assert not record.of(AbsentLine)


def test_the_reference_pages_equal_those_made_from_the_record(record):
    assert (FOLDER / "README.md").read_bytes() == markdown.render_overview(record, AROUND)
    assert (FOLDER / "report.md").read_bytes() == markdown.render(record, AROUND)


@pytest.mark.parametrize("name", PICTURES)
def test_the_reference_pictures_show_the_texts_and_points_of_the_record(record, name):
    """Compares texts, tooltips and labels, but not their places, which depend on the version of matplotlib."""
    fresh, committed = render(name, record), (FOLDER / REPORTS[name].file).read_bytes()
    assert said(fresh) == said(committed)
    methods = {line.method for line in record.of(MethodLine)}
    assert lettered(fresh) - methods == lettered(committed) - methods  # a point is named where there is room for it
    assert len(said(committed)) > 50
    assert len(lettered(committed)) > 20


def said(picture):
    """All titles, descriptions and tooltips of a picture, in order."""
    return [text for tag, text in words(picture) if tag in ("title", "desc")]


def lettered(picture):
    """What can be read in it: names of axes, marks, points and curves."""
    return {text for tag, text in words(picture) if tag == "text"}


def words(picture):
    elements = ElementTree.fromstring(picture).iter()  # noqa: S314
    return [(each.tag.rpartition("}")[2], "".join(each.itertext()).strip()) for each in elements]


def test_readme_shows_the_picture_of_the_reference_benchmark():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "](reports/reference/bench/front.svg)" in text
    assert "](reports/reference/bench/README.md)" in text


def test_files_of_the_reference_benchmark_have_less_than_3_megabytes():
    assert sum(REPORTS[name].file in {path.name for path in FOLDER.iterdir()} for name in PICTURES) == len(PICTURES)
    kept = [FOLDER / name for name in ("record.jsonl", "README.md", "report.md", *(REPORTS[p].file for p in PICTURES))]
    assert sum(path.stat().st_size for path in kept) < 3_000_000
