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
from functools import partial
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from queue import Empty, SimpleQueue
from typing import Any, ParamSpec, TypeVar

import numpy as np

from hypcheck.errors import HypcheckError, limit_reached
from hypcheck.implementations.description import Description
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import Allowance, StartError
from hypcheck.processes import end_with_parent, interrupts_held
from hypcheck.runs.cases import FrozenVectors, keep_loaded, loaded_vectors
from hypcheck.runs.fingerprint import code_fingerprint
from hypcheck.runs.results import JudgingRules
from hypcheck.runs.schedule import (
    ImplementationOpener,
    Task,
    TaskExecution,
    TaskResult,
    WorkerLost,
    WorkersLostError,
    perform_task,
)

LOOK_S = 1.0
STOPPED_LOOKS = 60
"""Seconds between two looks at a process, and looks in turn that may find it stopped before it is ended.

While the machine sleeps this process does not look either, so that the time does not count.
"""

_KEPT = 24 << 20
_PATIENCE = 5.0

Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")
Initializer = Callable[[], AbstractContextManager[object]]


class SerialExecutor(Executor):
    """Calls each function in this process, when it is submitted."""

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """Call it; a future that is done."""
        future: Future[Result] = Future()
        try:
            future.set_result(function(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - it is raised where the result is asked for
            future.set_exception(error)
        return future


class WorkerPool(Executor):
    """Processes, each with a thread here that starts it, hands it one call after the other, and replaces it if it ends.

    A process begins by entering what `initializer` returns, and leaves that when it ends. A future raises WorkerLost
    where its process ended, and what a process could not begin with. Unlike the standard library's pool this one needs
    no semaphores, knows which task a process ended with, and ends processes that were stopped by a signal.
    """

    def __init__(self, workers: int, initializer: Initializer) -> None:
        self._initializer = initializer
        self._calls: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()
        self._lock = threading.Lock()
        self._over = False
        self.processes: list[SpawnProcess] = []
        self._threads = [threading.Thread(target=self._drive, daemon=True) for _ in range(workers)]
        with interrupts_held():  # threads hold them as long as they live, and so do the processes that they start
            for thread in self._threads:
                thread.start()

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self.shutdown(cancel_futures=kind is not None)

    def submit(
        self, function: Callable[Arguments, Result], /, *args: Arguments.args, **kwargs: Arguments.kwargs
    ) -> Future[Result]:
        """Put a call in line for the first process that is free."""
        future: Future[Result] = Future()
        self._calls.put((future, partial(function, *args, **kwargs)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let the processes leave once all calls are done; with `cancel_futures`, end them now."""
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
                process.kill()  # one that was stopped would not hear that it is to end
        for thread in self._threads:
            thread.join()

    def _drive(self) -> None:
        """Hand out calls to one process, and to others in its place, until there are no more."""
        worker = self._begun()
        while (call := self._calls.get()) is not None:
            future, function = call
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(worker.call(function))
                except BaseException as error:  # noqa: BLE001 - it is raised where the result is asked for
                    future.set_exception(error)
                    worker = self._begun()
        worker.leave()

    def _begun(self) -> _Worker:
        """A worker that is ready, or knows why it is not."""
        worker = _Worker()
        with self._lock:  # the threads share what multiprocessing knows of its children
            if not self._over:
                worker.start()
                self.processes += [] if worker.process is None else [worker.process]
        worker.prepare(self._initializer)
        return worker


class _Worker:
    """A process, and the line to it; or why there is none, which each call raises then."""

    def __init__(self) -> None:
        self.process: SpawnProcess | None = None
        self._trouble: BaseException = WorkersLostError("the pool has ended")

    def start(self) -> None:
        """Start the process."""
        context = get_context("spawn")  # forking would copy locks, threads and open pipes
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
        """Let the process begin."""
        try:
            self.call(initializer)
        except WorkerLost as lost:
            self._trouble, self.process = WorkerLost(lost.workers, lost.last, deaths=0), None
        except BaseException as error:  # noqa: BLE001 - calls raise it
            self._trouble, self.process = error, None

    def call(self, function: Callable[[], object]) -> object:
        """What the function returns in the process. Raises what it raises, and WorkerLost where the process ends."""
        if self.process is None:
            raise self._trouble
        try:
            self._line.send(function)
            self._wait(self.process)
            said = self._line.recv()
        except (EOFError, OSError):
            self.process.join()
            raise WorkerLost("processes of hypcheck", f"the last with status {self.process.exitcode}") from None
        if isinstance(said, BaseException):
            raise said
        return said

    def _wait(self, process: SpawnProcess) -> None:
        """Wait until it says something, or has ended; end it where it was stopped by a signal and is not continued."""
        stopped = 0
        while not self._line.poll(LOOK_S):
            stopped = stopped + 1 if is_stopped(process) else 0
            if stopped == STOPPED_LOOKS:
                process.kill()

    def leave(self) -> None:
        """Let the process end."""
        if self.process is not None:
            with suppress(OSError):  # it has ended
                self._line.send(None)
            self.process.join()


def _serve(line: Connection) -> None:
    """In a process of a pool: enter the first call's context, and answer others, until the parent is done or gone."""
    end_with_parent()
    try:
        with line.recv()():
            line.send(None)
            while (call := line.recv()) is not None:
                line.send(call())
        os._exit(0)  # Python takes a tenth of a second to clear what ends with the process anyway
    except (EOFError, BrokenPipeError, ConnectionResetError):
        return
    except HypcheckError as error:
        line.send(error)
    except Exception as error:  # noqa: BLE001 - whatever it is, the parent tells it
        line.send(limit_reached(error) or RuntimeError(f"{type(error).__name__}: {error}\n{traceback.format_exc()}"))


def is_stopped(process: SpawnProcess) -> bool:
    """Whether a child of this process was stopped by a signal, as by kill -STOP, where the system tells."""
    if sys.platform != "linux" or process.pid is None:
        return False
    try:
        return os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WNOHANG | os.WNOWAIT) is not None
    except ChildProcessError:  # it has ended
        return False


@contextmanager
def execution_here(implementation: Implementation, rules: JudgingRules) -> Iterator[TaskExecution]:
    """Performs tasks in this process."""
    function = partial(perform_task, implementation=implementation, rules=rules)
    yield TaskExecution(SerialExecutor(), function, 0, implementation.allowance, implementation.max_rows, rules)


@contextmanager
def execution_in_pool(
    workers: int, opening: ImplementationOpener, rules: JudgingRules, implementation: Implementation
) -> Iterator[TaskExecution]:
    """Performs tasks in so many processes, each of which opens the implementation for itself.

    Of itself it must say in each of them what it says here: tasks raise StartError otherwise.
    """
    setup = partial(_opened, opening, rules, implementation.declared, code_fingerprint(), dict(loaded_vectors()))
    limits, most = implementation.allowance, implementation.max_rows
    with WorkerPool(workers, setup) as executor:
        yield TaskExecution(executor, _perform_opened, workers, limits, most, rules)


_OPENED: ContextVar[tuple[Implementation, JudgingRules]] = ContextVar("held")
"""What a process of a pool holds."""


@contextmanager
def _opened(
    opening: ImplementationOpener,
    rules: JudgingRules,
    declared: Description,
    program: str,
    frozen: dict[str, FrozenVectors],
) -> Iterator[None]:
    keep_freed_memory()
    keep_loaded(frozen)
    if code_fingerprint() != program:
        raise WorkersLostError("hypcheck's own files were changed while an implementation was asked")
    with opening.open() as implementation:
        require_same_description(implementation, declared)
        _OPENED.set((implementation, rules))
        yield


def _perform_opened(task: Task, allowance: Allowance) -> TaskResult:
    return perform_task(task, *_OPENED.get(), allowance)


def require_same_description(implementation: Implementation, declared: Description) -> None:
    """Raise StartError where it says something else of itself than it is declared to."""
    if implementation.declared != declared:
        raise StartError(f"{implementation.spec} describes itself otherwise in each process")


def keep_freed_memory() -> None:
    """Let the C library keep what numpy frees.

    glibc gives memory back to the system at once, and clears it again when it is asked for the next time, unless so
    large a piece was freed before; arrays that come and go would cost more time so than what is computed in them.
    """
    np.empty(_KEPT, dtype=np.uint8)
