"""The executors of this machine: this process, or a pool of processes, each of which holds an implementation."""

from __future__ import annotations

import os
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import AbstractContextManager, contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from queue import Empty, SimpleQueue
from typing import Any, ParamSpec, TypeVar

import numpy as np

from hypcheck.errors import HypcheckError, limit_reached
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import Allowance
from hypcheck.processes import end_with_parent, interrupts_held
from hypcheck.runs import schedule
from hypcheck.runs.cases import FrozenVectors, keep_loaded, loaded_vectors
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.runs.results import JudgingRules


@dataclass(frozen=True, slots=True)
class Watch:
    """Seconds between two checks of a process, and how many checks in a row may find it stopped before it is killed.

    While the machine sleeps, this process makes no checks either, so that time does not count.
    """

    every_s: float = 1.0
    stopped: int = 60


WATCH = Watch()


_KEPT = 24 << 20
"""The largest piece of memory, in bytes, that the C library is told to keep."""

_PATIENCE = 5.0
"""Seconds that a pool at its end waits for its threads before it kills the processes."""

Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")
Initializer = Callable[[], AbstractContextManager[object]]


class SerialExecutor(Executor):
    """Calls each function in this process at once."""

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """Call the function now; return a future that already has its result or error."""
        future: Future[Result] = Future()
        try:
            future.set_result(function(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - future.result() raises it
            future.set_exception(error)
        return future


class WorkerPool(Executor):
    """A pool of processes. For each, a thread starts the process, sends it calls, and replaces it if it ends.

    A process starts by entering the context that `initializer` returns, and leaves the context at its end. A future
    raises WorkerLost if its process ended, and the error of a process that could not start. Unlike the pool of the
    standard library, this one needs no semaphores, knows the call with which a process ended, and kills processes that
    a signal has stopped.
    """

    def __init__(self, workers: int, initializer: Initializer, watch: Watch = WATCH) -> None:
        self._initializer, self._watch = initializer, watch
        self._calls: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._over = False
        self.processes: list[SpawnProcess] = []
        self._threads = [threading.Thread(target=self._drive, daemon=True) for _ in range(workers)]
        with interrupts_held():  # for the lifetime of the threads, and in the processes that they start
            for thread in self._threads:
                thread.start()

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self.shutdown(cancel_futures=kind is not None)

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """Queue a call for the first process that is free."""
        future: Future[Result] = Future()
        self._calls.put((future, partial(function, *args, **kwargs)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let the processes end once all calls are done; with `cancel_futures`, end them now."""
        with suppress(Empty):
            while cancel_futures:
                waiting = self._calls.get_nowait()
                _ = waiting and waiting[0].cancel()
        for _ in self._threads:
            self._calls.put(None)
        until = time.monotonic() + (_PATIENCE if wait and not cancel_futures else 0)
        for thread in self._threads:
            thread.join(max(0.0, until - time.monotonic()))
        with self._lock:
            self._over = True
            for process in self.processes:
                process.kill()  # a stopped process would not end by itself
        for thread in self._threads:
            thread.join()

    def _drive(self) -> None:
        """Send calls to one process, and to its replacements, until there are no more."""
        worker = self._begun()
        while (call := self._calls.get()) is not None:
            future, function = call
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(worker.call(function))
                except BaseException as error:  # noqa: BLE001 - future.result() raises it
                    future.set_exception(error)
                    worker = self._begun()
        worker.leave()

    def _begun(self) -> _Worker:
        """Start a worker and prepare it. Return it; if it is not ready, each call raises the reason."""
        worker = _Worker(self._watch)
        with self._lock:  # multiprocessing's list of children is shared by the threads
            if not self._over:
                worker.start()
                self.processes += [] if worker.process is None else [worker.process]
        worker.prepare(self._initializer)
        return worker


class _Worker:
    """A process and the connection to it; or the reason why there is no process: each call raises it."""

    def __init__(self, watch: Watch) -> None:
        self._watch = watch
        self.process: SpawnProcess | None = None
        self._trouble: BaseException = schedule.WorkersLostError("the pool has ended")

    def start(self) -> None:
        """Start the process."""
        context = get_context("spawn")  # a fork would copy locks and open pipes
        self._line, theirs = context.Pipe()
        process = context.Process(target=_serve, args=(theirs,), daemon=True)
        try:
            process.start()
            self.process = process
        except OSError as error:
            self._trouble = error
        finally:
            theirs.close()

    def prepare(self, initializer: Initializer) -> None:
        """Let the process enter its context."""
        try:
            self.call(initializer)
        except schedule.WorkerLost as lost:
            self._trouble, self.process = schedule.WorkerLost(lost.workers, lost.last, deaths=0), None
        except BaseException as error:  # noqa: BLE001 - calls raise it
            self._trouble, self.process = error, None

    def call(self, function: Callable[[], object]) -> object:
        """Call a function in the process, and return its result.

        Raises what the function raises, and WorkerLost if the process ends.
        """
        if self.process is None:
            raise self._trouble
        try:
            self._line.send(function)
            self._wait(self.process)
            result = self._line.recv()
        except (EOFError, OSError):
            self.process.join()
            raise schedule.WorkerLost(
                "processes of hypcheck", f"the last with status {self.process.exitcode}"
            ) from None
        if isinstance(result, BaseException):
            raise result
        return result

    def _wait(self, process: SpawnProcess) -> None:
        """Wait until the process replies or ends; kill it if a signal stopped it and it is not continued."""
        stopped = 0
        while not self._line.poll(self._watch.every_s):
            stopped = stopped + 1 if is_stopped(process) else 0
            if stopped == self._watch.stopped:
                process.kill()

    def leave(self) -> None:
        """Let the process end."""
        if self.process is not None:
            with suppress(OSError):  # the process has already ended
                self._line.send(None)
            self.process.join()


def _serve(line: Connection) -> None:
    """Run a process of the pool: enter a context, then perform calls until the parent is done or gone."""
    end_with_parent()
    try:
        with line.recv()():
            line.send(None)
            while (call := line.recv()) is not None:
                line.send(call())
        os._exit(0)  # Python's own exit takes a tenth of a second longer
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return
    except HypcheckError as error:
        line.send(error)
    except Exception as error:  # noqa: BLE001 - the parent reports any error
        line.send(limit_reached(error) or RuntimeError(f"{type(error).__name__}: {error}\n{traceback.format_exc()}"))


def is_stopped(process: SpawnProcess) -> bool:
    """Return whether a signal such as SIGSTOP has stopped a child of this process; False if the system cannot tell."""
    if sys.platform != "linux" or process.pid is None:
        return False
    try:
        return os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is not None
    except ChildProcessError:  # the process ended
        return False


@contextmanager
def execution_here(implementation: Implementation, rules: JudgingRules) -> Iterator[schedule.TaskExecution]:
    """Enter a block in which this process performs tasks."""
    function = partial(schedule.perform_task, implementation=implementation, rules=rules)
    yield schedule.TaskExecution(
        SerialExecutor(), function, 0, implementation.allowance, implementation.max_rows, rules
    )


@contextmanager
def execution_in_pool(
    workers: int,
    opener: schedule.ImplementationOpener,
    rules: JudgingRules,
    implementation: Implementation,
    watch: Watch = WATCH,
) -> Iterator[schedule.TaskExecution]:
    """Enter a block in which `workers` processes perform tasks; each opens the implementation.

    A task raises StartError if the implementation's description in its process differs from the one here.
    """
    opener = replace(opener, declared=implementation.declared)
    setup = partial(_opened, opener, rules, code_fingerprint(), loaded_vectors())
    with WorkerPool(workers, setup, watch) as executor:
        yield schedule.TaskExecution(
            executor, _perform_opened, workers, implementation.allowance, implementation.max_rows, rules
        )


_OPENED: ContextVar[tuple[Implementation, JudgingRules]] = ContextVar("opened")
"""The implementation that a process of a pool has opened, and the rules by which its answers are judged."""


@contextmanager
def _opened(
    opener: schedule.ImplementationOpener, rules: JudgingRules, fingerprint: str, frozen: dict[str, FrozenVectors]
) -> Iterator[None]:
    """Open the implementation in a process of a pool, and close it at the end of the process."""
    keep_freed_memory()
    keep_loaded(frozen)
    if code_fingerprint() != fingerprint:
        raise schedule.WorkersLostError("hypcheck's own files were changed while an implementation was asked")
    with opener.open() as implementation:
        _OPENED.set((implementation, rules))
        yield


def _perform_opened(task: schedule.Step, allowance: Allowance) -> schedule.TaskResult:
    """Perform a task in a process of the pool, with the implementation that the process has opened."""
    return schedule.perform_task(task, *_OPENED.get(), allowance)


def keep_freed_memory() -> None:
    """Let the C library keep memory that numpy frees.

    glibc returns large pieces of memory to the system at once, and the system clears them when they are allocated
    again. That would cost more time than the work on short-lived arrays. glibc keeps all pieces up to the size of the
    largest one that was ever freed.
    """
    np.empty(_KEPT, dtype=np.uint8)
