"""A worker process that ends costs its task a retry; a case that kills every worker ends as a crash."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import nullcontext, suppress
from dataclasses import replace

import pytest

from hypcheck.implementations.session import Limits
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from hypcheck.runs import cases, executors
from hypcheck.runs.executors import Watch, WorkerPool, execution_in_pool
from hypcheck.runs.resume import saved_state
from hypcheck.runs.schedule import ImplementationOpener, RunState, WorkersLostError, perform_steps
from tests.runs.crashing import ENVIRONMENT, KILLS, here, require_one_crash, rules_of, steps_of, without_culprit
from tests.support.without_drawing import COMMAND

RIGHT = ImplementationOpener("builtin:table-2-float32", Limits())


def started(performing):
    """The processes of a pool, once all of them are started."""
    while len(performing.executor.processes) < performing.workers:
        pass
    return list(performing.executor.processes)


PACE = cases.Pace(chunk_rows=1024, retest_after=3000, single_rows=60)
"""Chunks and rounds small enough that a test has many."""


def test_only_cases_that_kill_their_worker_end_as_crashes(monkeypatch):
    some = steps_of(["uniform", "tower-body"], 2600, PACE)
    culprit, others = without_culprit(some)
    expected = here(KILLS, others).total
    for name, value in ENVIRONMENT.items():
        monkeypatch.setenv(name, value)
    with KILLS.open() as it, execution_in_pool(2, KILLS, rules_of(it), it) as performing:
        *_, (_, state) = perform_steps(some, performing, RunState(it.allowance))
    require_one_crash(state.total, expected, culprit, "3 processes of hypcheck ended while they asked these cases")
    assert state.left == replace(it.allowance, hangs=None)  # it has answered


def test_run_ends_with_an_error_if_worker_processes_cannot_start(monkeypatch, tmp_path):
    """Nothing is known of any case then, so that none may be called a crash."""
    ends = "import os, sys\nif '--multiprocessing-fork' in sys.orig_argv:\n    os._exit(9)\n"
    (tmp_path / "sitecustomize.py").write_text(ends)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    some = steps_of(["uniform"], 2000, PACE)
    with (
        KILLS.open() as it,
        pytest.raises(
            WorkersLostError, match=r"3 processes of hypcheck ended before they had asked a case, .* status 9"
        ),
        execution_in_pool(2, KILLS, rules_of(it), it) as performing,
    ):
        list(perform_steps(some, performing, RunState(it.allowance)))


def test_pool_of_one_worker_survives_the_end_of_its_process(tmp_path):
    """Who asks for one has it in a process of its own, so that the run does not end with it."""
    words = ["verify", KILLS.spec, "--families", "uniform", "--count", "2501", "--workers", "1", "--out", str(tmp_path)]
    command = [*COMMAND, *words, "--isolate", "off"]  # isolated, it could not kill the process that asks it
    done = subprocess.run(command, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    (group,) = read(tmp_path / "record.jsonl").of(GroupLine)
    assert group.counts["crash"] == 2501
    assert "3 processes of hypcheck ended while they asked these cases" in group.faults[0].reason


STOPS = pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells us who was stopped")


@STOPS
def test_stopped_worker_is_killed_and_its_task_retried():
    some = steps_of(["uniform"], 6000, PACE)
    expected = here(RIGHT, some)
    with RIGHT.open() as it, execution_in_pool(2, RIGHT, rules_of(it), it, Watch(0.01, 3)) as performing:
        found = perform_steps(some, performing, RunState(it.allowance))
        next(found)
        first = started(performing)
        for process in first:
            os.kill(process.pid, signal.SIGSTOP)
        *_, (_, state) = found  # one that has no task when it is stopped is ended with the pool
    assert [process.exitcode for process in first] == [-signal.SIGKILL] * 2
    assert saved_state(state) == saved_state(expected)


@STOPS
def test_stopped_worker_that_is_continued_in_time_is_not_killed():
    """Looks that find it stopped are counted from the beginning when one finds it running."""
    with WorkerPool(1, nullcontext, Watch(0.1, 8)) as running:
        future = running.submit(time.sleep, 2.5)
        while not running.processes:
            time.sleep(0.01)
        (process,) = running.processes
        for _ in range(3):
            os.kill(process.pid, signal.SIGSTOP)
            time.sleep(0.4)
            os.kill(process.pid, signal.SIGCONT)
            time.sleep(0.3)
        future.result()
        assert process.is_alive()


@STOPS
def test_is_stopped_returns_true_for_a_stopped_process():
    with WorkerPool(1, nullcontext) as running:
        assert running.submit(os.getpid).result() == running.processes[0].pid
        for number in (signal.SIGSTOP, signal.SIGCONT):
            os.kill(running.processes[0].pid, number)
            while executors.is_stopped(running.processes[0]) != (number == signal.SIGSTOP):
                pass


@STOPS
def test_interrupted_run_does_not_wait_for_a_stopped_worker():
    with RIGHT.open() as it, suppress(KeyboardInterrupt), execution_in_pool(2, RIGHT, rules_of(it), it) as performing:
        processes = started(performing)
        for process in processes:
            os.kill(process.pid, signal.SIGSTOP)
        raise KeyboardInterrupt
    assert [process.exitcode for process in processes] == [-signal.SIGKILL] * 2
