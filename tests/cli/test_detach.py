"""A run under nohup continues when its terminal closes; another run ends in good order."""

from __future__ import annotations

import os
import signal
import subprocess

import pytest

from hypcheck.record import read
from tests.support.without_drawing import COMMAND

pty = pytest.importorskip("pty", reason="a system without terminals of its own")


def in_terminal(words, *, nohup):
    """The process of a run whose controlling terminal shows a bar and then is closed."""
    ours, theirs = pty.openpty()

    def begin():
        os.login_tty(theirs) if hasattr(os, "login_tty") else _login(theirs)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        if nohup:
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

    process = subprocess.Popen([*COMMAND, *words], preexec_fn=begin)  # noqa: PLW1509
    os.close(theirs)
    shown = b""
    while b"a second" not in shown:
        shown += os.read(ours, 4096)
    os.close(ours)
    return process


def _login(terminal):
    import fcntl
    import termios

    os.setsid()
    fcntl.ioctl(terminal, termios.TIOCSCTTY, 0)
    for number in range(3):
        os.dup2(terminal, number)


@pytest.mark.parametrize(("nohup", "code"), [(True, 0), (False, 143)])
def test_verify_continues_under_nohup_if_its_terminal_closes_and_otherwise_ends_143(tmp_path, nohup, code):
    spec = "python:tests.runs.faulty:too_slow_for_a_glance"
    words = ["verify", spec, "--families", "uniform", "--count", "4000", "--out", str(tmp_path)]
    process = in_terminal(words, nohup=nohup)
    assert process.wait(timeout=120) == code
    assert bool(read(tmp_path / "record.jsonl").footer) is nohup
