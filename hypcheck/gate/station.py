"""What a worker of a cluster holds of a run: the implementation, opened when it is first asked there.

It is closed when the run ends; and, should whoever runs it have gone without a word, when it was idle for a while.
"""

from __future__ import annotations

import shutil
import tempfile
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path

from distributed import Worker, WorkerPlugin, get_worker

from hypcheck.errors import HypcheckError, InputError, system_reason
from hypcheck.gate.cluster import OTHER_FILES
from hypcheck.gate.conformance import Rules
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.results import Performed
from hypcheck.gate.shipped import Shipped, module_sha256, require_same, spec_there
from hypcheck.gate.work import Opening, Task, perform
from hypcheck.gate.workers import keep_memory, require_same_description
from hypcheck.methods.description import Description
from hypcheck.methods.implementation import Implementation
from hypcheck.methods.runs import Allowance

IDLE = 60.0
"""Seconds after which an implementation that nobody asks is closed; it is opened again when somebody does."""


@dataclass(frozen=True)
class Job:
    """What every worker is told once: a name for the run, what to open and how to judge.

    `declared` is what the implementation must say of itself, `files` what its SPEC names, `module` the sha256 of its
    Python module, `ours` that of our own files.
    """

    name: str
    opening: Opening
    rules: Rules
    declared: Description
    files: tuple[Shipped, ...]
    module: str
    ours: str


class Station(WorkerPlugin):  # type: ignore[misc]  # of a package that is not checked
    """Given to the workers that there are and to those that come later."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.name = job.name

    def setup(self, worker: Worker) -> None:
        """Be ready; nothing is opened yet."""
        keep_memory()
        _HELD[self.name] = _Held(self.job, worker.address, Path(worker.local_directory))

    def teardown(self, worker: Worker) -> None:  # noqa: ARG002 - dask's signature
        """End what was opened."""
        held = _HELD.pop(self.name, None)
        if held is not None:
            held.close()


def perform_at_station(name: str, task: Task, allowance: Allowance) -> Performed:
    """Perform a task of the run of that name, on whichever worker this is.

    Raises InputError where the worker, which may have come later, has other files than where the run began.
    """
    if name not in _HELD:  # it could not be made ready
        raise InputError(f"worker {get_worker().address} {OTHER_FILES}")
    return _HELD[name].perform(task, allowance)


class _Held:
    """The implementations of one run on one worker, one for each task that is performed at the same time."""

    def __init__(self, job: Job, worker: str, home: Path) -> None:
        self._job = job
        self._worker = worker
        self._home = home
        self._folder: Path | None = None
        self._opening: Opening | None = None
        self._idle: list[tuple[float, Implementation]] = []
        self._lock = threading.Lock()
        self._over = threading.Event()
        threading.Thread(target=self._close_idle, name="hypcheck-idle", daemon=True).start()

    def perform(self, task: Task, allowance: Allowance) -> Performed:
        """Perform it with an implementation that is idle, or another one."""
        with self._lock:
            implementation = self._idle.pop()[1] if self._idle else None
            opening = self._opening = self._opening or self._opening_here()
        if implementation is None:
            implementation = self._open(opening)
        try:
            performed = perform(task, implementation, self._job.rules, allowance)
        except BaseException as error:
            implementation.__exit__(type(error), error, None)
            raise
        with self._lock:
            self._idle.append((time.monotonic(), implementation))
        if self._over.is_set():
            self.close()
        return performed

    def _open(self, opening: Opening) -> Implementation:
        implementation = opening.open()
        try:
            require_same_description(implementation, self._job.declared)
        except HypcheckError as error:
            implementation.__exit__(type(error), error, None)
            raise
        return implementation

    def _opening_here(self) -> Opening:
        job = self._job
        spec = job.opening.spec
        if own_sha256() != job.ours:
            raise InputError(f"worker {self._worker} {OTHER_FILES}")
        if job.module:
            require_same(f"the module of {spec}", job.module, module_sha256(spec), self._worker)
        try:
            self._folder = Path(tempfile.mkdtemp(prefix="hypcheck-", dir=self._home))
            return replace(job.opening, spec=spec_there(spec, job.files, self._worker, self._folder))
        except OSError as error:
            reason = system_reason(error)
            raise InputError(f"worker {self._worker} cannot write into its folder {self._home}: {reason}") from None

    def _close_idle(self) -> None:
        while not self._over.wait(IDLE / 4):
            with self._lock:
                old = [each for each in self._idle if time.monotonic() > each[0] + IDLE]
                self._idle = [each for each in self._idle if each not in old]
            for _, implementation in old:
                implementation.close()

    def close(self) -> None:
        """End them now, and remove the files that were put here."""
        self._over.set()
        with self._lock:
            idle, self._idle = self._idle, []
        for _, implementation in idle:
            implementation.kill()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)


_HELD: dict[str, _Held] = {}
"""By the name of the run: tasks come to whatever thread is free, and find here what their worker holds."""
