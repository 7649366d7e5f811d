"""A worker process that ends costs its task a retry; a case that kills every worker ends as a crash."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import nullcontext, suppress
from dataclasses import replace

import pytest

from hypcheck.implementations.session import Limits
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from hypcheck.runs import cases, executors, schedule
from hypcheck.runs.executors import WorkerPool, execution_in_pool
from hypcheck.runs.resume import saved_state
from hypcheck.runs.schedule import ImplementationOpener, RunState, WorkerLost, WorkersLostError, perform_steps
from tests.runs.crashing import ENVIRONMENT, KILLS, here, require_one_crash, rules_of, steps_of, without_culprit
from tests.support.without_drawing import COMMAND

RIGHT = ImplementationOpener("builtin:table-2-float32", Limits())


def started(performing):
    """The processes of a pool, once all of them are started."""
    while len(performing.executor.processes) < performing.workers:
        pass
    return list(performing.executor.processes)


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Chunks and rounds small enough that a test has many."""
    monkeypatch.setattr(cases, "CHUNK_ROWS", 1024)
    monkeypatch.setattr(schedule, "RETEST_AFTER", 3000)


def test_only_cases_that_kill_their_worker_end_as_crashes(monkeypatch):
    some = steps_of(["uniform", "tower-body"], 2600)
    culprit, others = without_culprit(some)
    expected = here(KILLS, others).total
    for name, value in ENVIRONMENT.items():
        monkeypatch.setenv(name, value)
    with KILLS.open() as it, execution_in_pool(2, KILLS, rules_of(it), it) as performing:
        *_, (_, state) = perform_steps(some, performing, RunState(it.allowance))
    require_one_crash(state.total, expected, culprit, "3 processes of hypcheck ended while they asked these cases")
    assert state.left == replace(it.allowance, hangs=None)  # it has answered


def _ends_at_once(*_):
    os._exit(9)


def test_run_ends_with_an_error_if_worker_processes_cannot_start(monkeypatch):
    """Nothing is known of any case then, so that none may be called a crash."""
    monkeypatch.setattr(executors, "_serve", _ends_at_once)
    some = steps_of(["uniform"], 2000)
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
def test_stopped_worker_is_killed_and_its_task_retried(monkeypatch):
    monkeypatch.setattr(executors, "LOOK_S", 0.01)
    monkeypatch.setattr(executors, "STOPPED_LOOKS", 3)
    some = steps_of(["uniform"], 6000)
    expected = here(RIGHT, some)
    with RIGHT.open() as it, execution_in_pool(2, RIGHT, rules_of(it), it) as performing:
        found = perform_steps(some, performing, RunState(it.allowance))
        next(found)
        first = started(performing)
        for process in first:
            os.kill(process.pid, signal.SIGSTOP)
        *_, (_, state) = found  # one that has no task when it is stopped is ended with the pool
    assert [process.exitcode for process in first] == [-signal.SIGKILL] * 2
    assert saved_state(state) == saved_state(expected)


@STOPS
def test_stopped_worker_that_is_continued_in_time_is_not_killed(monkeypatch):
    """Looks that find it stopped are counted from the beginning when one finds it running."""
    looks = iter([True, True, False] * 3)
    done = []
    monkeypatch.setattr(executors, "LOOK_S", 0.01)
    monkeypatch.setattr(executors, "STOPPED_LOOKS", 3)
    monkeypatch.setattr(executors, "is_stopped", lambda _: next(looks, None) or done.append(None))
    with WorkerPool(1, nullcontext) as running:
        future = running.submit(signal.pause)
        while len(done) < 3:
            pass
        (process,) = running.processes
        assert process.is_alive()
        process.kill()
        with pytest.raises(WorkerLost):
            future.result()


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
