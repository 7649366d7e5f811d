"""Time limits on a busy machine: what other programs take of the processors is not counted."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import contextmanager

import numpy as np
import pytest

from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits, Outcome

WORKS = """
import time
def classify(rows):
    until = time.process_time() + SECONDS
    while time.process_time() < until:
        pass
    return [0] * len(rows)
"""

pytestmark = pytest.mark.skipif(not os.path.exists("/proc/self/schedstat"), reason="the system does not tell how long")


@contextmanager
def one_processor():
    """This process, and what it starts, on one processor."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


@contextmanager
def busy_programs():
    """They work without end, each in a session of its own: some systems share a processor out by sessions."""
    endless = [sys.executable, "-I", "-S", "-c", "while True: pass"]
    busy = [subprocess.Popen(endless, start_new_session=True) for _ in range(2)]
    try:
        yield
    finally:
        for program in busy:
            program.kill()
            program.wait()


def answered_beside_others(tmp_path, seconds):
    """What a function that works for so many seconds of a processor answers, where the time limit is 0.6 seconds."""
    (tmp_path / "works.py").write_text(WORKS.replace("SECONDS", str(seconds)))
    limits = Limits(timeout=0.6, startup_timeout=60.0, restarts=0)
    spec = f"python:{tmp_path / 'works.py'}:classify"
    with one_processor(), open_implementation(spec, limits) as it, busy_programs():
        began = time.monotonic()
        answered = it.classify(np.ones((1, 7)))
        return answered, time.monotonic() - began


def test_implementation_within_its_time_limit_of_a_processor_passes_on_a_busy_machine(tmp_path):
    answered, seconds = answered_beside_others(tmp_path, 0.45)
    assert seconds > 0.6  # or the machine was not busy
    assert answered.answered.all(), answered.reasons


@pytest.mark.thorough  # on an idle machine many tests see one ended
def test_implementation_that_works_without_end_is_ended_on_a_busy_machine(tmp_path):
    answered, seconds = answered_beside_others(tmp_path, 1e9)
    assert Outcome(int(answered.status[0])) is Outcome.TIMEOUT
    assert "within 0.6 s" in answered.reasons[0]
    assert seconds < 12
