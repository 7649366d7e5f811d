"""Progress of a long run: a line now and then in a log, in place on a terminal."""

from __future__ import annotations

import sys

from tests.tools.progress_line import progress_line


def test_progress_line_is_written_to_a_log_only_after_the_interval(capsys):
    tell = progress_line("{} of 9".format, every=3600.0)
    tell(1)
    assert capsys.readouterr().err == ""
    tell = progress_line("{} of 9".format, every=0.0)
    tell(2)
    assert capsys.readouterr().err == "0 s: 2 of 9\n"


def test_progress_line_is_written_to_a_terminal_at_once(capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    progress_line("{} of 9".format, every=3600.0)(3)
    assert capsys.readouterr().err == "\r3 of 9 "
