"""Reports are written whole or not at all, each on its own, and missing ones have a reason."""

from __future__ import annotations

import os
import sys
from concurrent.futures.process import BrokenProcessPool

import pytest

from hypcheck.errors import InputError
from hypcheck.processes import fresh
from hypcheck.record import read
from hypcheck.record.lines import MapLine
from hypcheck.report import REPORTS, drawings, kept_formats, write
from hypcheck.report.write import render, write_reports
from tests.report import bench_lines, record_samples
from tests.support.without_drawing import draw_nothing

FILES = {
    *("summary.json", "junit.xml", "map.svg", "report.md", "report.html", "measurements.csv"),
    *("results.sarif", "gl-code-quality-report.json", "badge.json"),
}
DRAWN = {"map.svg", "report.html"}
TEXTS = ("json", "junit", "markdown", "csv")


def test_a_record_read_from_its_file_makes_the_reports_of_the_record(tmp_path):
    text, record = record_samples.text_and_record()
    (tmp_path / "record.jsonl").write_text(text, encoding="utf-8")
    assert read(tmp_path) == record
    written = write_reports(read(tmp_path), tmp_path / "a" / "b")
    assert {each.path.name for each in written} == FILES == set(os.listdir(tmp_path / "a" / "b"))
    assert {each.skipped for each in written} == {None}
    for name in (*TEXTS, "sarif", "gitlab", "badge", "map"):
        if name != "markdown":  # which refers to the map
            assert (tmp_path / "a" / "b" / REPORTS[name].file).read_bytes() == render(name, record)


def test_a_truncated_record_makes_reports_that_say_so(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    text, _ = record_samples.text_and_record(exit_code=None)
    path = tmp_path / "record.jsonl"
    path.write_text(text, encoding="utf-8")
    for each in write_reports(read(path), tmp_path, set(kept_formats()) - {"map"}):
        assert each.skipped is None
        if each.path.suffix != ".csv":
            said = "unfinished" if each.path.name == "badge.json" else "TRUNCATED"
            assert said in each.path.read_text(encoding="utf-8")


@pytest.mark.parametrize("kept", range(len(record_samples.lines()) + 1))
def test_reports_are_written_for_a_run_interrupted_at_any_line(kept, tmp_path):
    record = record_samples.record(record_samples.lines()[:kept], exit_code=None)
    written = write_reports(record, tmp_path, [*TEXTS, *(["map", "html"] if kept % 6 == 0 else [])])
    assert not [each.path.name for each in written if each.skipped]
    assert ("map.svg" in os.listdir(tmp_path)) == (kept % 6 == 0 and bool(record.of(MapLine)))


def test_without_matplotlib_and_jinja2_reports_are_written_without_plots_and_page(tmp_path, monkeypatch):
    for name in DRAWN:
        (tmp_path / name).write_text("of an earlier run", encoding="utf-8")
    draw_nothing(monkeypatch)
    written = {each.path.name: each.skipped for each in write_reports(record_samples.record(), tmp_path)}
    skipped = {name: reason for name, reason in written.items() if reason}
    assert set(skipped) == DRAWN == FILES - set(os.listdir(tmp_path))
    for name, module in (("map.svg", "matplotlib"), ("report.html", "jinja2")):
        assert skipped[name].startswith(f"{module} cannot be imported")
        assert "pip install 'hypcheck[report]'" in skipped[name]
    assert "map.svg" not in (tmp_path / "report.md").read_text(encoding="utf-8")


def test_write_reports_raises_an_error_naming_a_report_that_it_cannot_write(tmp_path):
    (tmp_path / "junit.xml").mkdir()
    with pytest.raises(InputError, match=r"cannot write .*junit\.xml"):
        write_reports(record_samples.record(), tmp_path, TEXTS)
    assert not [name for name in os.listdir(tmp_path) if name.startswith(".")]


def test_write_reports_raises_an_error_naming_a_folder_that_it_cannot_make(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match=r"cannot make the folder .*file"):
        write_reports(record_samples.record(), tmp_path / "file" / "reports", TEXTS)


def test_error_while_a_report_is_rendered_leaves_the_old_report(tmp_path, monkeypatch):
    (tmp_path / "summary.json").write_text("old", encoding="utf-8")

    def broken(record):
        raise RuntimeError("a defect")

    monkeypatch.setitem(write.FOR_PROGRAMS, "junit", broken)
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
    """In one other process, since each loads matplotlib for a second."""
    monkeypatch.setattr(drawings, "processes", lambda _: fresh(1))
    record = bench_lines.bench_record()
    assert drawings.draw_ahead(record) == {}
    ahead = drawings.draw_ahead(record, least=1, names=("stability", "places"))
    assert set(ahead) == {"stability", "places"}
    assert ahead["places"]
    for name, plots in ahead.items():
        assert plots == drawings.drawn_plots(name, record, {})


def test_plots_are_not_drawn_ahead_if_they_cannot_be_or_a_drawing_process_is_killed(monkeypatch):
    def killed(*_):
        raise BrokenProcessPool

    with monkeypatch.context() as patched:
        patched.setattr(drawings, "perform", killed)
        assert drawings.draw_ahead(record_samples.record(), least=0) == {}
    draw_nothing(monkeypatch)
    assert drawings.draw_ahead(record_samples.record(), least=0) == {}
