"""Who performs the steps of a run: this process, or several, each of which holds an implementation of its own.

A process of ours that ends costs nothing: another one takes its task. Cases that go on ending whoever asks them end as
crashes, and the run goes on.
"""

from __future__ import annotations

import os
import sys
import time
import traceback
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import connection, get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess

import numpy as np

from hypcheck.errors import Exit, HypcheckError, limit_reached
from hypcheck.gate.conformance import Rules
from hypcheck.gate.frozen import read_here, take
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.results import Performed
from hypcheck.gate.work import Opening, Task, perform
from hypcheck.methods.description import Description
from hypcheck.methods.faults import StartError
from hypcheck.methods.implementation import Crashed, Implementation
from hypcheck.methods.runs import Allowance
from hypcheck.processes import end_with_parent, interrupts_held

AHEAD = 32
"""Tasks in hand for each process, so that none is idle while cases are asked again."""

DEATHS = 3
"""Processes of ours that one task may cost, and that may end one after the other before they have asked anything."""

LOOK = 1.0
STOPPED = 60
"""Seconds between two looks at our processes, and looks in turn that may find one stopped before it is ended.

A machine that sleeps stops whoever looks, too, so that the time does not count.
"""

_KEPT = 24 << 20
_PATIENCE = 5.0


class Here:
    """Performs tasks in this process, when their results are asked for."""

    ahead = 1

    def __init__(self, implementation: Implementation, rules: Rules) -> None:
        self._implementation = implementation
        self._rules = rules
        self._tasks: dict[int, tuple[Task, Allowance]] = {}
        self._count = 0

    def submit(self, task: Task, allowance: Allowance, *, first: bool = False) -> int:  # noqa: ARG002 - asked in order
        """Put a task in line."""
        self._count += 1
        self._tasks[self._count] = task, allowance
        return self._count

    def result(self, number: int) -> Performed:
        """Perform it."""
        task, allowance = self._tasks.pop(number)
        return perform(task, self._implementation, self._rules, allowance)


class LostError(HypcheckError):
    """Processes of ours ended, one after the other, before they had asked anything, or are not of this program."""

    exit_code = Exit.INTERNAL


@dataclass
class _Worker:
    process: SpawnProcess
    line: Connection
    ready: bool = False
    task: int | None = None
    stopped: int = 0


class Workers:
    """Performs tasks in processes of our own; a context manager. Raises what a worker cannot begin with or ends with.

    The implementation must say of itself in each of them what it says here.
    """

    def __init__(self, count: int, opening: Opening, rules: Rules, implementation: Implementation) -> None:
        self.ahead = AHEAD * count
        self._rules = rules
        self._most = implementation.most
        self._what = opening, rules, implementation.declared, own_sha256()
        self._tasks: dict[int, tuple[Task, Allowance]] = {}
        self._deaths: dict[int, int] = {}
        self._unborn = 0
        self._begun = False
        self._next_look = 0.0
        self._first: deque[int] = deque()
        self._waiting: deque[int] = deque()
        self._done: dict[int, Performed] = {}
        self._workers: list[_Worker] = []
        self._count = 0
        try:
            for _ in range(count):
                self._workers.append(self._begin())
        except BaseException:
            self._kill()
            raise

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            for worker in self._workers:
                with suppress(OSError):  # it has ended
                    worker.line.send(None)
            for worker in self._workers:
                worker.process.join(_PATIENCE)
        self._kill()

    def submit(self, task: Task, allowance: Allowance, *, first: bool = False) -> int:
        """Put a task in line, before those that are not if it is `first`."""
        self._count += 1
        self._tasks[self._count] = task, allowance
        (self._first if first else self._waiting).append(self._count)
        self._hand_out()
        return self._count

    def result(self, number: int) -> Performed:
        """Wait for a task's result."""
        while number not in self._done:
            lines = {worker.line: worker for worker in self._workers}
            for line in connection.wait(lines, LOOK):
                self._hear(lines[line])  # type: ignore[index]
            self._look()
            self._hand_out()
        return self._done.pop(number)

    def _look(self) -> None:
        """End who stands still by a signal and is not sent on, as another process ended: its line tells of that."""
        now = time.monotonic()
        if now < self._next_look:
            return
        self._next_look = now + LOOK
        for worker in self._workers:
            worker.stopped = worker.stopped + 1 if is_stopped(worker.process) else 0
            if worker.stopped == STOPPED:
                worker.process.kill()

    def _hand_out(self) -> None:
        """Give tasks to whoever has none; at first not before all are ready, from whom it would take the processors."""
        self._begun = self._begun or all(worker.ready for worker in self._workers)
        for worker in self._workers if self._begun else ():
            line = self._first or self._waiting
            if worker.ready and worker.task is None and line:
                worker.task = line.popleft()
                try:
                    worker.line.send(self._tasks[worker.task])
                except OSError:  # it has ended, which its line will tell
                    return

    def _hear(self, worker: _Worker) -> None:
        try:
            said = worker.line.recv()
        except (EOFError, OSError):
            self._replace(worker)
            return
        if isinstance(said, BaseException):
            raise said
        if worker.task is None:
            with suppress(OSError):  # it has ended
                worker.line.send(read_here())
            worker.ready, self._unborn = True, 0
        else:
            self._finish(worker.task, said)
            worker.task = None

    def _finish(self, number: int, performed: Performed) -> None:
        del self._tasks[number]
        self._deaths.pop(number, None)
        self._done[number] = performed

    def _replace(self, worker: _Worker) -> None:
        """Begin another process in place of one that has ended, which had no reason of its own to."""
        self._workers.remove(worker)
        worker.process.join()
        if not worker.ready:
            self._unborn += 1
            if self._unborn == DEATHS:
                last = f"the last with status {worker.process.exitcode}"
                raise LostError(f"{DEATHS} processes of hypcheck ended before they had asked anything, {last}")
        elif worker.task is not None:
            self._blame(worker.task, worker.process.exitcode)
        self._workers.append(self._begin())

    def _blame(self, number: int, status: int | None) -> None:
        """Let another process try a task that one ended with; where it has cost as many as it may, its cases crash."""
        self._deaths[number] = self._deaths.get(number, 0) + 1
        if self._deaths[number] < DEATHS:
            self._first.appendleft(number)
            return
        task, allowance = self._tasks[number]
        reason = f"{DEATHS} processes of hypcheck ended while they asked these cases, the last with status {status}"
        self._finish(number, perform(task, Crashed(self._most, reason, allowance), self._rules, allowance))

    def _begin(self) -> _Worker:
        context = get_context("spawn")  # forking would copy locks, threads and open pipes
        ours, theirs = context.Pipe()
        process = context.Process(target=_serve, args=(theirs, *self._what), daemon=True)
        with interrupts_held():
            process.start()
        theirs.close()
        return _Worker(process, ours)

    def _kill(self) -> None:
        """End them all now; whoever guards the implementations ends these with them."""
        for worker in self._workers:
            worker.line.close()
            worker.process.kill()  # who was stopped would not hear that it is to end
        for worker in self._workers:
            worker.process.join()


def _serve(line: Connection, opening: Opening, rules: Rules, declared: Description, program: str) -> None:
    """What a worker does: perform the tasks that come, until there are no more or the parent is gone."""
    end_with_parent()
    keep_memory()
    try:
        _require_same_program(program)
        with opening.open() as implementation:
            require_same_description(implementation, declared)
            line.send(None)
            take(line.recv())
            while (task := line.recv()) is not None:
                line.send(perform(task[0], implementation, rules, task[1]))
        os._exit(0)  # Python takes a tenth of a second to clear what ends with the process anyway
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return
    except HypcheckError as error:
        line.send(error)
    except Exception as error:  # noqa: BLE001 - whatever it is, the parent tells it
        line.send(limit_reached(error) or RuntimeError(f"{type(error).__name__}: {error}\n{traceback.format_exc()}"))


def _require_same_program(program: str) -> None:
    """Raise LostError where this process was made of other files than the one that began the run."""
    if own_sha256() != program:
        raise LostError("hypcheck's own files were changed while an implementation was asked")


def is_stopped(process: SpawnProcess) -> bool:
    """Whether a child of ours was stopped by a signal, as by kill -STOP, where the system tells."""
    if sys.platform != "linux" or process.pid is None:
        return False
    try:
        return os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is not None
    except ChildProcessError:  # it has ended
        return False


def require_same_description(implementation: Implementation, declared: Description) -> None:
    """Raise StartError where it says something else of itself than it is declared to."""
    if implementation.declared != declared:
        raise StartError(f"{implementation.spec} describes itself otherwise in each process")


def keep_memory() -> None:
    """Let the C library keep what numpy frees.

    glibc gives memory back to the system at once, and clears it again when it is asked for the next time, unless so
    large a piece was freed before; arrays that come and go would cost more time so than what is computed in them.
    """
    np.empty(_KEPT, dtype=np.uint8)
