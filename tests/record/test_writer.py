"""The writer of a record where a system has no locks, a disk fails at the end, or the processor has no name."""

from __future__ import annotations

import errno
import fcntl
import platform

import pytest

from hypcheck.errors import InputError
from hypcheck.record import writer
from hypcheck.record.fields import Unsigned, decoded
from hypcheck.record.writer import GrowingFile, folder_locked


def test_folder_is_used_without_a_lock_on_systems_without_file_locks(monkeypatch, tmp_path):
    def without(place, how):
        raise OSError(errno.ENOLCK, "no locks available")

    monkeypatch.setattr(fcntl, "flock", without)
    with folder_locked(tmp_path), folder_locked(tmp_path):
        (tmp_path / "file").touch()


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


def test_processor_name_comes_from_python_if_the_system_gives_none(monkeypatch):
    def unreadable(*_, **__):
        raise OSError

    monkeypatch.setattr(writer.Path, "open", unreadable)
    monkeypatch.setattr(platform, "processor", lambda: "")
    assert writer._processor() == "unknown"
    monkeypatch.setattr(platform, "processor", lambda: "s390x")
    assert writer._processor() == "s390x"


def test_a_number_of_a_record_that_must_not_be_negative_is_refused_below_0():
    assert decoded("inf", Unsigned) == float("inf")
    with pytest.raises(Exception, match='Expected `float` >= 0 or "inf"'):
        decoded(-1.0, Unsigned)
