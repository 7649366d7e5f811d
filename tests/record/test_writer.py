"""The writer of a record where a system has no locks, a disk fails at the end, or the processor has no name."""

from __future__ import annotations

import errno
import fcntl
import platform
import time

import pytest

from hypcheck.errors import InputError
from hypcheck.record import read
from hypcheck.record.fields import Unsigned, decoded
from hypcheck.record.lines import DriftLine, GroupLine, NotStartedLine
from hypcheck.record.writer import FolderInUseError, GrowingFile, Recorder, folder_locked, is_result, processor_name
from tests.record.test_removed import PROGRESS
from tests.support.records import GrowingText


def test_folder_is_used_without_a_lock_on_systems_without_file_locks(monkeypatch, tmp_path):
    def without(place, how):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(fcntl, "flock", without)
    with folder_locked(tmp_path), folder_locked(tmp_path):
        (tmp_path / "file").touch()


def test_a_folder_is_locked_for_one_run_at_a_time_and_free_again_after_it(tmp_path):
    for _ in range(2):
        with folder_locked(tmp_path):
            with (
                pytest.raises(FolderInUseError, match="another run is writing its record there"),
                folder_locked(tmp_path),
            ):
                pass
            (tmp_path / "file").touch()


def test_a_growing_file_replaces_what_a_killed_run_left_beside_it(tmp_path):
    path = tmp_path / "record.jsonl"
    (tmp_path / "record.jsonl.new").write_bytes(b"half of a line")
    with GrowingFile(path) as file:
        file.renew(b"whole")
        file.write(b", and more")
        assert path.read_bytes() == b"whole, and more"
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


def test_a_growing_file_that_cannot_be_replaced_leaves_nothing_beside_it(tmp_path):
    path = tmp_path / "record.jsonl"
    (path / "in the way").mkdir(parents=True)
    with GrowingFile(path) as file, pytest.raises(IsADirectoryError):
        file.renew(b"whole")
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


def test_a_recorder_of_a_resumed_run_writes_the_earlier_lines_first_and_the_progress_after_them(tmp_path):
    drift, path = DriftLine(sentence="it moved"), tmp_path / "record.jsonl"
    with GrowingFile(path) as file:
        recorder = Recorder(file, {}, carried=[drift, PROGRESS])
        assert recorder.lines == (drift,)
        assert read(path).lines == (drift, PROGRESS)
        recorder.close(0)
    assert read(path).lines == (drift,)


def test_a_record_can_be_resumed_once_it_has_one_implementation_or_progress():
    not_started = NotStartedLine(spec="python:mine:f", name="mine", trouble="no such module")
    for carried, goes_on in (([], False), ([DriftLine(sentence="it moved")], False), ([not_started], True)):
        assert Recorder(GrowingText(), {}, carried=carried).goes_on is goes_on
    assert Recorder(GrowingText(), {}, carried=[PROGRESS]).goes_on


def test_the_footer_holds_the_seconds_since_the_recorder_was_made(monkeypatch):
    now = 1000.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    recorder = Recorder(GrowingText(), {})
    now = 1002.5
    assert recorder.close(0).footer.seconds == 2.5


def test_error_while_closing_a_growing_file_is_reported_unless_another_error_is_raised(monkeypatch, tmp_path):
    class Failing:
        def close(self):
            raise OSError(errno.ENOSPC, "no space left on device")

    growing = GrowingFile(tmp_path / "record.jsonl")
    growing._file = Failing()
    with pytest.raises(InputError, match=r"cannot write .*record\.jsonl: no space left"):
        growing.__exit__(None, None, None)
    growing.__exit__(KeyError, KeyError("other"), None)


def test_growing_file_refuses_additions_before_its_first_content(tmp_path):
    with pytest.raises(ValueError, match="must be renewed before anything is added"):
        GrowingFile(tmp_path / "record.jsonl").write("a line\n")


def test_processor_name_is_that_of_the_first_processor_that_the_system_lists_or_python_gives(tmp_path):
    listed = "processor\t: 0\nmodel\t\t: 6\nmodel name\t: One of 2 GHz\nprocessor\t: 1\nmodel name\t: Two\n"
    (tmp_path / "cpuinfo").write_text(listed)
    assert processor_name(tmp_path / "cpuinfo") == "One of 2 GHz"
    assert processor_name(tmp_path / "none") == (platform.processor() or "unknown")


def test_a_number_of_a_record_that_must_not_be_negative_is_refused_below_0():
    assert decoded("inf", Unsigned) == float("inf")
    with pytest.raises(Exception, match='Expected `float` >= 0 or "inf"'):
        decoded(-1.0, Unsigned)


def test_a_group_line_is_a_result_only_if_at_least_one_case_was_tested():
    names = {"method": "m", "title": "m", "exact": False, "question": "position", "precision": "float64", "family": "f"}
    counts = {"counts": {}, "mistakes": {}, "octaves": {}, "place_bins": [], "size_bins": [], "worst": []}
    for asked in (0, 1):
        line = decoded({"type": "group", **names, **counts, "asked": asked}, GroupLine)
        assert is_result(line) == bool(asked)
