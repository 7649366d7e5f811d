"""Who performs the steps of a run: the workers of a cluster.

A worker that ends costs nothing: dask gives its tasks to others. Dask blames every task that was with a worker when it
ended, and gives up one that was blamed too often; that one is then tried alone, so that none is blamed for another.
Where that, too, costs the workers their lives, its cases end as crashes, and the run goes on.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import queue
import uuid
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING

from distributed import KilledWorker

from hypcheck.errors import InputError
from hypcheck.gate.cluster import CLOSE, CONNECT
from hypcheck.gate.conformance import Rules
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.patience import within
from hypcheck.gate.results import Performed
from hypcheck.gate.shipped import files_to_ship, module_sha256
from hypcheck.gate.station import Job, Station, perform_at_station
from hypcheck.gate.work import Opening, Task, perform
from hypcheck.gate.workers import AHEAD
from hypcheck.methods.implementation import Crashed, Implementation
from hypcheck.methods.runs import Allowance

if TYPE_CHECKING:
    from distributed import Client, Future

FIRST = 10
"""dask's priority of tasks that others wait for."""

TICK = 1.0
PATIENCE = 60
"""Seconds without a result between two looks at the cluster, and looks in turn that may find no worker there."""

SILENCES = 6
"""Looks in turn to which the scheduler may say nothing within the seconds of CONNECT."""

_CANCELLED = (asyncio.CancelledError, concurrent.futures.CancelledError)


class Afar:
    """A context manager. Raises what a worker cannot begin with, and InputError where the cluster is lost."""

    def __init__(self, client: Client, opening: Opening, rules: Rules, implementation: Implementation) -> None:
        self._client = client
        self._address = client.scheduler.address if client.scheduler else "?"
        self._rules = rules
        self._most = implementation.most
        self._name = f"hypcheck-{uuid.uuid4().hex}"
        files, module = files_to_ship(opening.spec), module_sha256(opening.spec)
        self._job = Job(self._name, opening, rules, implementation.declared, files, module, own_sha256())
        self.ahead = AHEAD * max(1, sum(client.nthreads().values()))
        self._tasks: dict[int, tuple[Task, Allowance]] = {}
        self._urgent: set[int] = set()
        self._waiting: deque[int] = deque()
        self._running: dict[int, Future] = {}
        self._suspects: deque[int] = deque()
        self._finished: queue.SimpleQueue[int] = queue.SimpleQueue()
        self._done: dict[int, Performed] = {}
        self._count = 0
        self._alone = self._silent = 0

    def __enter__(self) -> Afar:
        try:
            within(CONNECT, lambda: self._client.register_plugin(Station(self._job)))
        except TimeoutError:
            raise self._lost(f"it said nothing within {CONNECT} s") from None
        return self

    def __exit__(self, *_: object) -> None:
        self._running.clear()
        if self._client.status == "running":
            with suppress(Exception):  # it is lost meanwhile, and workers close what is idle by themselves
                within(CLOSE, lambda: self._client.unregister_worker_plugin(self._name))

    def submit(self, task: Task, allowance: Allowance, *, first: bool = False) -> int:
        """Put a task in line, before all others if it is `first`."""
        self._count += 1
        self._tasks[self._count] = task, allowance
        if first:
            self._urgent.add(self._count)
        (self._waiting.appendleft if first else self._waiting.append)(self._count)
        self._go_on()
        return self._count

    def result(self, number: int) -> Performed:
        """Wait for a task's result."""
        while number not in self._done:
            self._hear()
            self._go_on()
        return self._done.pop(number)

    def _go_on(self) -> None:
        """Send what waits; where a task is suspected, that one alone, when nothing else is there any more."""
        if not self._suspects:
            while self._waiting:
                self._send(self._waiting.popleft())
        elif not self._running:
            self._send(self._suspects[0])

    def _send(self, number: int) -> None:
        task, allowance = self._tasks[number]
        priority = FIRST if number in self._urgent else 0
        future = self._client.submit(
            perform_at_station, self._name, task, allowance, key=f"{self._name}-{uuid.uuid4().hex}", priority=priority
        )
        self._running[number] = future
        future.add_done_callback(lambda _: self._finished.put(number))

    def _hear(self) -> None:
        """Take the next result, whosever it is."""
        try:
            number = self._finished.get(timeout=TICK)
        except queue.Empty:
            self._require_workers()
            return
        future = self._running[number]
        try:
            performed = future.result(timeout=TICK)
        except KilledWorker as killed:
            self._suspect(number, killed.allowed_failures + 1)
            return
        except (*_CANCELLED, asyncio.TimeoutError, OSError) as error:
            if future.status == "error":  # what the task itself ended with
                raise
            if not isinstance(error, asyncio.TimeoutError):
                raise self._lost("its scheduler is not there any more") from None
            self._finished.put(number)  # it was computed, but its worker is gone with it: it is computed again
            self._require_workers()
            return
        self._alone = self._silent = 0
        self._finish(number, performed)

    def _finish(self, number: int, performed: Performed) -> None:
        self._done[number] = performed
        del self._running[number], self._tasks[number]
        self._urgent.discard(number)
        if self._suspects and self._suspects[0] == number:
            self._suspects.popleft()

    def _suspect(self, number: int, deaths: int) -> None:
        """Try a task alone that workers ended with; where it was alone already, its cases crash."""
        if not self._suspects or self._suspects[0] != number:
            del self._running[number]
            self._suspects.append(number)
            return
        task, allowance = self._tasks[number]
        reason = f"{deaths} workers of the cluster ended, one after the other, while they had nothing but these cases"
        self._finish(number, perform(task, Crashed(self._most, reason, allowance), self._rules, allowance))

    def _require_workers(self) -> None:
        """Raise InputError where the scheduler is gone or silent, or has been without workers for too long."""
        try:
            workers = within(CONNECT, self._client.nthreads)
        except TimeoutError:
            self._silent += 1
            if self._silent == SILENCES:
                raise self._lost(f"its scheduler has said nothing for {SILENCES * CONNECT} s") from None
            return
        except Exception:  # noqa: BLE001 - dask raises whatever its broken connection leads to
            raise self._lost("its scheduler is not there any more") from None
        self._silent = 0
        self._alone = 0 if workers else self._alone + 1
        if self._alone > PATIENCE:
            raise self._lost(f"it has had no worker for {PATIENCE} s")

    def _lost(self, why: str) -> InputError:
        kept = "what was finished is in the record"
        return InputError(f"--cluster {self._address}: the cluster was lost: {why}; {kept}")
