"""Processes of ours may end: it costs nothing, or the cases that go on ending them, or the run where none begins."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from dataclasses import replace

import pytest

from hypcheck.gate import chunks, schedule, workers
from hypcheck.gate.saved import saved
from hypcheck.gate.schedule import State, states
from hypcheck.gate.work import Opening
from hypcheck.gate.workers import LostError, Workers
from hypcheck.methods.limits import Limits
from hypcheck.record import read
from hypcheck.record.lines import Group
from tests.gate.killing import ENVIRONMENT, KILLS, here, require_one_crash, rules_of, steps_of, without_culprit
from tests.undrawn import COMMAND

RIGHT = Opening("builtin:table-2-float32", Limits())


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """Chunks and rounds small enough that a test has many."""
    monkeypatch.setattr(chunks, "SIZE", 1024)
    monkeypatch.setattr(schedule, "ROUND", 3000)


def test_cases_that_kill_whoever_asks_end_as_crashes_and_no_others(monkeypatch):
    some = steps_of(["uniform", "tower-body"], 4000)
    culprit, others = without_culprit(some)
    expected = here(KILLS, others).total
    for name, value in ENVIRONMENT.items():
        monkeypatch.setenv(name, value)
    with KILLS.open() as it, Workers(2, KILLS, rules_of(it), it) as crew:
        *_, (_, state) = states(some, crew, State(it.allowance))
    require_one_crash(state.total, expected, culprit, "3 processes of hypcheck ended while they asked these cases")
    assert state.left == replace(it.allowance, hangs=None)  # it has answered


def _ends_at_once(*_):
    os._exit(9)


def test_processes_that_cannot_begin_end_the_run(monkeypatch):
    """Nothing is known of any case then, so that none may be called a crash."""
    monkeypatch.setattr(workers, "_serve", _ends_at_once)
    some = steps_of(["uniform"], 2000)
    with (
        KILLS.open() as it,
        pytest.raises(LostError, match=r"3 processes of hypcheck ended before they had asked anything, .* status 9"),
        Workers(2, KILLS, rules_of(it), it) as crew,
    ):
        list(states(some, crew, State(it.allowance)))


def test_one_worker_may_end_as_well(tmp_path):
    """Who asks for one has it in a process of its own, so that the run does not end with it."""
    words = ["verify", KILLS.spec, "--families", "uniform", "--count", "2501", "--workers", "1", "--out", str(tmp_path)]
    command = [*COMMAND, *words]
    done = subprocess.run(command, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, check=False)
    assert done.returncode == 1, done.stderr
    (group,) = read(tmp_path / "record.jsonl").of(Group)
    assert group.counts["crash"] == 2501
    assert "3 processes of hypcheck ended while they asked these cases" in group.faults[0].reason


STOPS = pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells us who was stopped")


@STOPS
def test_who_was_stopped_is_ended_and_costs_nothing(monkeypatch):
    monkeypatch.setattr(workers, "LOOK", 0.01)
    monkeypatch.setattr(workers, "STOPPED", 3)
    some = steps_of(["uniform"], 6000)
    expected = here(RIGHT, some)
    with RIGHT.open() as it, Workers(2, RIGHT, rules_of(it), it) as crew:
        found = states(some, crew, State(it.allowance))
        next(found)
        first = [worker.process for worker in crew._workers]
        for process in first:
            os.kill(process.pid, signal.SIGSTOP)
        *_, (_, state) = found
        assert [process.exitcode for process in first] == [-signal.SIGKILL] * 2
    assert saved(state) == saved(expected)


@STOPS
def test_who_is_sent_on_in_time_goes_on(monkeypatch):
    monkeypatch.setattr(workers, "LOOK", 0)
    with RIGHT.open() as it, Workers(1, RIGHT, rules_of(it), it) as crew:
        (worker,) = crew._workers
        for signals in (signal.SIGSTOP, signal.SIGCONT):
            os.kill(worker.process.pid, signals)
            while workers.is_stopped(worker.process) != (signals == signal.SIGSTOP):
                pass
            crew._look()
            assert worker.stopped == (signals == signal.SIGSTOP)
        assert worker.process.is_alive()


@STOPS
def test_a_run_that_is_interrupted_does_not_wait_for_who_was_stopped():
    with RIGHT.open() as it, suppress(KeyboardInterrupt), Workers(2, RIGHT, rules_of(it), it) as crew:
        processes = [worker.process for worker in crew._workers]
        for process in processes:
            os.kill(process.pid, signal.SIGSTOP)
        raise KeyboardInterrupt
    assert [process.exitcode for process in processes] == [-signal.SIGKILL] * 2
