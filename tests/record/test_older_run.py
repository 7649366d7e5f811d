"""An older run in a folder is never taken for the newer one that began there and has not finished."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.cli.recording import recording
from hypcheck.record import Recorder
from hypcheck.record.lines import DriftLine
from hypcheck.record.reader import FILE, GROWING
from hypcheck.record.writer import GrowingFile

pytestmark = pytest.mark.usefixtures("text_reports")


@pytest.fixture
def held(tmp_path):
    """The folder of a run that held."""
    out = tmp_path / "out"
    words = ["verify", "builtin:fast", "--families", "tower-body", "--count", "2", "--out", str(out)]
    assert main(words) == 0
    return out


def test_the_first_result_of_a_new_run_removes_reports_of_the_earlier_run_and_keeps_its_record(held):
    before = (held / FILE).read_bytes()
    (held / "notes.txt").write_text("of the user")
    assert '"passed": true' in (held / "summary.json").read_text()
    with recording(held, {}) as running:
        assert {"summary.json", "report.md"} < {each.name for each in held.iterdir()}
        running.recorder.add(DriftLine(sentence="a result"))
        found = {each.name: each.read_bytes() for each in held.iterdir()}
    assert set(found) == {FILE, GROWING, "notes.txt"}
    assert found[FILE] == before


@pytest.fixture
def killed(held):
    """The same folder, in which a newer run was killed."""
    with GrowingFile(held / GROWING) as growing:
        Recorder(growing, {"specs": ["builtin:fast"], "max_abstained": 0})
    return held


@pytest.mark.parametrize("named", ["", FILE])
def test_record_check_ends_1_if_a_newer_run_has_not_finished(killed, capsys, named):
    assert main(["record", "check", str(killed / named)]) == 1
    first, second = capsys.readouterr().out.splitlines()
    assert first.endswith("it is complete, of a run that ended with 0")
    assert second.startswith(f"this is an older run: {killed / GROWING} is of a newer run")


def test_report_of_an_older_run_says_so_and_how_to_resume_the_newer(killed, capsys):
    assert main(["report", str(killed)]) == 0
    said = capsys.readouterr()
    assert said.out.startswith("HELD")
    (line,) = said.err.splitlines()
    assert line.startswith(f"hypcheck: note: this is an older run: {killed / GROWING} is of a newer run")
    assert f"--resume {killed} continues it" in line


@pytest.mark.parametrize("words", [["report"], ["record", "check"]])
def test_report_and_record_check_refuse_a_folder_that_has_only_an_unfinished_run(killed, capsys, words):
    (killed / FILE).unlink()
    assert main([*words, str(killed)]) == 2
    assert f"{FILE} is not there; {killed / GROWING} is of a newer run" in capsys.readouterr().err


@pytest.mark.parametrize("out", ["", "-"])
@pytest.mark.parametrize(
    "words",
    [
        ["verify", "builtin:fast"],
        ["bench"],
        ["report", "nowhere"],
        ["hunt", "builtin:fast"],
        ["simulate", "forest"],
        ["simulate", "tower"],
    ],
)
def test_every_command_refuses_an_out_that_is_empty_or_a_stream(tmp_path, monkeypatch, capsys, words, out):
    monkeypatch.chdir(tmp_path)
    assert main([*words, "--out", out]) == 2
    assert f"'--out': {out!r} names neither a file nor a folder" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_record_repair_writes_to_standard_output_and_refuses_an_empty_out(held, monkeypatch, capsysbinary):
    monkeypatch.chdir(held)
    before = sorted(held.iterdir())
    assert main(["record", "repair", FILE, "--out", ""]) == 2
    capsysbinary.readouterr()
    assert main(["record", "repair", FILE, "--out", "-"]) == 0
    assert capsysbinary.readouterr().out == (held / FILE).read_bytes()
    assert sorted(held.iterdir()) == before
