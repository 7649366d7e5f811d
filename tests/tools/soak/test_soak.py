"""Verify against flaky implementations leaves nothing behind, in a short form; any leftover is found."""

from __future__ import annotations

import contextlib
import mmap
import os
import subprocess
import sys
import tempfile
import threading

import pytest

from tests.tools.soak import running
from tests.tools.soak.measuring import Sample, faults
from tests.tools.soak.running import SHORT, run

MIB = 1 << 20


def test_some_rounds_of_the_soak_find_no_fault(monkeypatch):
    """Without pictures, which take longer than all else; the long form has them."""
    for name in ("matplotlib", "jinja2"):
        monkeypatch.setitem(sys.modules, name, None)
    course = run(0.0, seed=5, least=4, size=SHORT)
    assert not course.faults, course.faults
    assert not course.not_started
    assert course.statuses["right"] > 100
    assert len([status for status, count in course.statuses.items() if count]) > 4, course.statuses


def test_soak_finds_growth_of_memory_handles_threads_children_and_files(monkeypatch):
    monkeypatch.setattr(running, "_round", lambda *_: None)
    kept = []
    with contextlib.ExitStack() as stack:

        def leak(_):
            memory = mmap.mmap(-1, 16 * MIB)  # bytes may lie where this process had others before
            memory.write(b"\1" * (16 * MIB))
            kept.append(memory)
            _leave(stack)

        found = run(0.0, seed=1, least=4, after=leak).faults
    for words in ("resident memory grows", "handles grow", "threads grow", "children grow", "left in a folder"):
        assert any(words in fault for fault in found), found


def _leave(stack):
    """A handle, a file in the folder for them, a process and a thread, until the stack is left."""
    number, _ = tempfile.mkstemp()
    stack.callback(os.close, number)
    child = stack.enter_context(subprocess.Popen(["sleep", "60"]))  # noqa: S607
    stack.callback(child.kill)
    done = threading.Event()
    thread = threading.Thread(target=done.wait)
    thread.start()
    stack.callback(thread.join)
    stack.callback(done.set)


def _samples(**each):
    base = {"resident": 90 * MIB, "handles": 8, "threads": 2, "children": 1, "strays": (), "files": ()}
    return [Sample(**{**base, **{name: values[i] for name, values in each.items()}}) for i in range(12)]


def test_soak_does_not_report_one_time_loads_and_returned_memory_as_growth():
    warming = [number * MIB for number in (20, 60, 90, 91, 90, 91, 91, 140, 91, 90, 91, 91)]
    assert not faults(_samples(resident=warming, handles=[4, 8, 8, 8, 8, 12, 8, 8, 8, 8, 8, 8]))


@pytest.mark.parametrize("name", ["handles", "threads", "children"])
def test_soak_reports_one_more_thread_or_child_that_stays_as_growth(name):
    assert [fault for fault in faults(_samples(**{name: [3] * 9 + [4] * 3})) if f"{name} grow from 3 to 4" in fault]


def test_soak_reports_what_a_single_run_leaves_behind():
    strays = [()] * 5 + [("sleep 60",)] + [()] * 6
    assert faults(_samples(strays=strays)) == ["left after a round: sleep 60"]


def test_soak_with_too_few_samples_says_that_it_cannot_tell():
    assert faults(_samples()[:2]) == ["2 samples after warming up; at least 3 are needed to tell"]


def test_soak_command_ends_with_1_if_something_grows(monkeypatch):
    from click.testing import CliRunner

    from tests.tools.soak import __main__
    from tests.tools.soak.running import Course

    for strays, code in (((), 0), (("sleep 60",), 1)):
        course = Course(rounds=12, samples=_samples(strays=[strays] * 12))
        monkeypatch.setattr(__main__, "run", lambda *_, course=course, **__: course)
        ended = CliRunner().invoke(__main__.main, [])
        assert ended.exit_code == code
        assert ("sleep 60" in ended.output) == bool(code)
