"""A record that somebody removes while its run goes on is not lost with what it holds."""

from __future__ import annotations

import contextlib
import shutil

import pytest

from hypcheck.cli.recording import Part, record_and_report
from hypcheck.errors import NothingJudgedError
from hypcheck.record import read
from hypcheck.record.reading import FILE, GROWING


@pytest.mark.parametrize("end", [None, KeyboardInterrupt, NothingJudgedError("nothing")])
@pytest.mark.parametrize("gone", ["folder", "file", "another"])
def test_a_record_that_somebody_removed_meanwhile_is_written_again(tmp_path, gone, end):
    out = tmp_path / "out"

    def removes(_):
        if gone == "folder":
            shutil.rmtree(out)
        else:
            (out / GROWING).unlink()
        if gone == "another":
            (out / GROWING).write_text("of another run")
        if end:
            raise end

    def parts(recorder):
        recorder.add("unavailable", oracle="mesh", reason="before")
        return [Part("", 1, removes)]

    with contextlib.suppress(KeyboardInterrupt, NothingJudgedError):
        record_and_report(out, {}, parts, lambda: 0)
    assert not (out / GROWING).exists()
    if not isinstance(end, NothingJudgedError):
        record = read(out / FILE)
        assert [line["reason"] for line in record.lines] == ["before"]
        assert bool(record.footer) is (end is None)
