"""An older run in a folder is never taken for the newer one that began there and has not finished."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.cli.running import recording
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
