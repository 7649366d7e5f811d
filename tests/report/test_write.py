"""Reports are written whole or not at all, each on its own, and missing ones have a reason."""

from __future__ import annotations

import os
from concurrent.futures.process import BrokenProcessPool

import pytest

from hypcheck.errors import InputError, UnavailableError
from hypcheck.record import read
from hypcheck.record.lines import MapLine
from hypcheck.report import csv, drawings, html, junit, markdown, summary, write
from hypcheck.report.drawings import ReportContext
from hypcheck.report.formats import REPORTS
from hypcheck.report.plots import pictures
from hypcheck.report.write import render, write_reports
from tests.report import bench_lines, record_samples

CODE = {"sarif": "results.sarif", "gitlab": "gl-code-quality-report.json", "badge": "badge.json"}
FILES = {"summary.json", "junit.xml", "map.svg", "report.md", "report.html", "measurements.csv", *CODE.values()}
TEXTS = ("json", "junit", "markdown", "csv")


def test_write_reports_writes_every_format(tmp_path):
    record = record_samples.record()
    written = write_reports(record, tmp_path / "a" / "b")
    assert {each.path.name for each in written} == FILES == set(os.listdir(tmp_path / "a" / "b"))
    assert {each.skipped for each in written} == {None}
    contents = {each.path.name: each.path.read_bytes() for each in written}
    assert contents == {
        "summary.json": summary.render(record),
        "junit.xml": junit.render(record),
        "map.svg": pictures.render_map(record),
        "report.md": markdown.render(record, ReportContext(["map.svg"])),
        "report.html": html.render(record),
        "measurements.csv": csv.render(record),
        **{file: render(name, record) for name, file in CODE.items()},
    }
    assert b"](map.svg)" in contents["report.md"]


def test_reports_of_a_record_read_from_its_file_are_the_same(tmp_path):
    text, record = record_samples.text_and_record()
    path = tmp_path / "record.jsonl"
    path.write_text(text, encoding="utf-8")
    kinds = {line.type for line in record.lines}
    here = {name: report for name, report in REPORTS.items() if not report.ways}  # without that of ways
    shown = {name: report for name, report in here.items() if report.shows in (None, *kinds)}
    assert len(shown) == len(here) - 3  # the pictures of a benchmark
    for name in shown:
        assert render(name, read(path)) == render(name, record), name


def test_a_truncated_record_makes_reports_that_say_so(tmp_path):
    text, _ = record_samples.text_and_record(exit_code=None)
    path = tmp_path / "record.jsonl"
    path.write_text(text, encoding="utf-8")
    for each in write_reports(read(path), tmp_path):
        assert each.skipped is None
        if each.path.suffix not in (".svg", ".csv"):
            said = "unfinished" if each.path.name == "badge.json" else "TRUNCATED"
            assert said in each.path.read_text(encoding="utf-8")


@pytest.mark.parametrize("kept", range(len(record_samples.lines()) + 1))
def test_reports_are_written_for_a_run_interrupted_at_any_line(kept, tmp_path):
    record = record_samples.record(record_samples.lines()[:kept], exit_code=None)
    written = write_reports(record, tmp_path, [*TEXTS, *(["map", "html"] if kept % 6 == 0 else [])])
    assert not [each.path.name for each in written if each.skipped]
    assert ("map.svg" in os.listdir(tmp_path)) == (kept % 6 == 0 and bool(record.of(MapLine)))


def test_write_reports_without_matplotlib_writes_all_reports_without_plots(tmp_path, monkeypatch):
    def unavailable(*_):
        raise UnavailableError("matplotlib is not here")

    write_reports(record_samples.record(), tmp_path)
    monkeypatch.setattr(pictures, "render_map", unavailable)
    monkeypatch.setattr(html, "render", unavailable)
    written = {each.path.name: each.skipped for each in write_reports(record_samples.record(), tmp_path)}
    gone = {"map.svg", "report.html"}  # those of an earlier run would be of another record
    assert {name for name, reason in written.items() if reason == "matplotlib is not here"} == gone
    assert set(os.listdir(tmp_path)) == FILES - gone
    assert "map.svg" not in (tmp_path / "report.md").read_text(encoding="utf-8")


def test_plots_are_drawn_in_the_main_process_if_a_drawing_process_is_killed(monkeypatch):
    def killed(*_):
        raise BrokenProcessPool

    monkeypatch.setattr(drawings, "MANY", 0)
    monkeypatch.setattr(drawings, "perform", killed)
    assert drawings.draw_ahead(record_samples.record()) == {}


def test_write_reports_raises_an_error_naming_a_report_that_it_cannot_write(tmp_path):
    (tmp_path / "junit.xml").mkdir()
    with pytest.raises(InputError, match=r"cannot write .*junit\.xml"):
        write_reports(record_samples.record(), tmp_path)
    assert not [name for name in os.listdir(tmp_path) if name.startswith(".")]


def test_write_reports_raises_an_error_naming_a_folder_that_it_cannot_make(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match=r"cannot make the folder .*file"):
        write_reports(record_samples.record(), tmp_path / "file" / "reports")


def test_error_while_a_report_is_rendered_leaves_the_old_report(tmp_path, monkeypatch):
    (tmp_path / "summary.json").write_text("old", encoding="utf-8")

    def broken(record):
        raise RuntimeError("a defect")

    monkeypatch.setattr(write, "FOR_PROGRAMS", {**write.FOR_PROGRAMS, "json": broken})
    with pytest.raises(RuntimeError):
        write_reports(record_samples.record(), tmp_path)
    assert (tmp_path / "summary.json").read_text(encoding="utf-8") == "old"
    assert os.listdir(tmp_path) == ["summary.json"]


def test_write_reports_raises_an_error_naming_an_old_report_that_it_cannot_remove(tmp_path):
    (tmp_path / "map.svg").mkdir()
    without = [line for line in record_samples.lines() if line["type"] != "map"]
    with pytest.raises(InputError, match=r"cannot remove .*map\.svg: is a directory"):
        write_reports(record_samples.record(without), tmp_path, ["map"])


def test_plots_of_a_large_record_drawn_ahead_equal_plots_drawn_later(monkeypatch):
    record = bench_lines.bench_record()
    assert drawings.draw_ahead(record) == {}
    monkeypatch.setattr(drawings, "MANY", 1)
    monkeypatch.setattr(drawings, "usable_processors", lambda: 1)
    monkeypatch.setattr(pictures, "PLOTS", {name: pictures.PLOTS[name] for name in ("errors", "stability")})
    ahead = drawings.draw_ahead(record)
    assert set(ahead) == {"errors", "stability"}
    assert ahead["errors"]
    for name, plots in ahead.items():
        assert plots == drawings.drawn_plots(name, record, {})

    def unavailable():
        raise UnavailableError("matplotlib is not here")

    monkeypatch.setattr(drawings, "pictures", unavailable)
    assert drawings.draw_ahead(record) == {}
