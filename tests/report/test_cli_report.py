"""`hypcheck report`: the report that each option writes, and options that are refused before anything is written."""

from __future__ import annotations

import json
import os
import sys

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.report import REPORTS, kept_formats
from hypcheck.report.write import render
from tests.report import record_samples


@pytest.fixture
def run(tmp_path):
    """A folder with a record and nothing else."""
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "record.jsonl").write_text(record_samples.text_and_record()[0], encoding="utf-8")
    return folder


def test_report_without_options_prints_the_summary(run, capsys):
    assert main(["report", str(run)]) == 0
    assert capsys.readouterr().out.splitlines()[0] == record_samples.HELD
    assert os.listdir(run) == ["record.jsonl"]


OF_OTHER_RUNS = ("errors", "pareto", "front", "ways")


@pytest.mark.parametrize("name", [*OF_OTHER_RUNS, "map"])
def test_report_refuses_a_picture_that_the_record_has_no_lines_for(run, name, tmp_path, capsys):
    (run / "record.jsonl").write_text(record_samples.text_and_record([])[0], encoding="utf-8")
    assert main(["report", str(run), "--format", name, "--out", str(tmp_path / "a.svg")]) == 2
    assert "hypcheck: error: the record has no " in capsys.readouterr().err
    assert not (tmp_path / "a.svg").exists()


@pytest.mark.parametrize("name", [name for name in REPORTS if name not in OF_OTHER_RUNS])
def test_report_with_one_format_writes_it_to_standard_output(run, name, capfdbinary, monkeypatch):
    if name == "html":  # its plots take a second
        monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["report", str(run / "record.jsonl"), "--format", name]) == 0
    assert capfdbinary.readouterr().out == render(name, read(run))


def test_report_with_a_folder_writes_the_reports_of_a_run(run, tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["report", str(run), "--out", str(tmp_path / "new")]) == 0
    written = [name for name in kept_formats() if name not in (*OF_OTHER_RUNS, "map")]
    assert set(os.listdir(tmp_path / "new")) == {REPORTS[name].file for name in written}
    assert "no map.svg: matplotlib cannot be imported" in capsys.readouterr().out
    assert main(["report", str(run), "--out", str(tmp_path / "two"), "--format", "json", "--format", "terminal"]) == 0
    assert set(os.listdir(tmp_path / "two")) == {"summary.json", "report.txt"}


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("a.md", "markdown"),
        ("b.xml", "junit"),
        ("c.json", "json"),
        ("e.sarif", "sarif"),
        ("badge.json", "badge"),
        ("d.txt", "terminal"),
    ],
)
def test_report_with_a_file_writes_the_format_of_its_name(run, tmp_path, file, name):
    assert main(["report", str(run), "--out", str(tmp_path / file)]) == 0
    assert (tmp_path / file).read_bytes() == render(name, read(run))


def test_report_with_a_format_writes_a_file_of_any_name(run, tmp_path):
    assert main(["report", str(run), "--out", str(tmp_path / "a.dat"), "--format", "json"]) == 0
    assert json.loads((tmp_path / "a.dat").read_bytes())["passed"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--out", "a.dat"], "its name does not say which report it is"),
        (["--format", "json", "--format", "junit"], "2 formats need a folder: --out FOLDER"),
        (["--format", "junit", "--against", "record.jsonl"], "--against is shown only by terminal, markdown"),
        (["--against", "nowhere.jsonl"], "cannot read nowhere.jsonl: no such file"),
        (["--out", "record.jsonl", "--format", "json"], "is a record that is being read"),
    ],
)
def test_report_options_that_do_not_fit_are_refused(run, monkeypatch, capsys, words, said):
    monkeypatch.chdir(run)
    before = (run / "record.jsonl").read_bytes()
    assert main(["report", "record.jsonl", *words]) == 2
    assert said in capsys.readouterr().err
    assert os.listdir(run) == ["record.jsonl"]
    assert (run / "record.jsonl").read_bytes() == before


def test_report_of_a_truncated_record_begins_with_truncated(run, capsys):
    (run / "record.jsonl").write_text(record_samples.text_and_record(exit_code=None)[0], encoding="utf-8")
    assert main(["report", str(run)]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("TRUNCATED")
    assert "hypcheck: note: the record has no end" in err


def test_report_of_a_file_that_is_not_a_record_is_refused_in_one_sentence(run, capsys):
    (run / "record.jsonl").write_bytes(b"\xff\xfe\x00")
    assert main(["report", str(run)]) == 2
    assert "is not a record" in capsys.readouterr().err


def test_report_refers_to_pictures_only_if_it_is_written_to_their_folder(run, tmp_path):
    (run / "map.svg").write_text("<svg/>", encoding="utf-8")
    (tmp_path / "map.svg").write_text("of another run", encoding="utf-8")
    for folder, refers in ((run, True), (tmp_path, False)):
        assert main(["report", str(run), "--format", "overview", "--out", str(folder / "README.md")]) == 0
        assert ("](map.svg)" in (folder / "README.md").read_text(encoding="utf-8")) == refers
