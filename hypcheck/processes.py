"""Processes for long work: pools of fresh processes, stages with progress, and interrupts that end them in order."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain, islice
from multiprocessing import active_children, get_context, parent_process, resource_tracker, util
from typing import Any, TypeVar

from hypcheck.errors import SystemLimitError, limit_reached, system_reason

Task = TypeVar("Task")
Result = TypeVar("Result")

Advance = Callable[[int], object]
"""A function that is called with a number of steps that were finished."""


@dataclass(frozen=True)
class Stage:
    """A part of a long run: its title for the progress bar, the number of its steps, and the function that runs it."""

    title: str
    steps: int
    run: Callable[[Advance], None]


UNWINDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals after which a run removes half-written files and ends."""


def usable_processors() -> int:
    """Return the number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@contextmanager
def processes(workers: int) -> Iterator[ProcessPoolExecutor | None]:
    """Enter a block with a pool of `workers` fresh processes; None for one worker.

    Processes are not forked, because that would copy locks and threads. If an exception leaves the block, the processes
    are ended, and the rest of their work is not done.
    """
    if workers <= 1:
        yield None
        return
    with fresh(workers) as executor:
        yield executor


@contextmanager
def fresh(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Enter a block with a pool of `workers` fresh processes, as `processes` does; one worker is a process too."""
    require_semaphores()
    executor = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=end_with_parent)
    try:
        yield executor
    except BaseException:
        executor.shutdown(wait=False, cancel_futures=True)
        for worker in active_children():
            worker.terminate()
        raise
    executor.shutdown()


def require_semaphores() -> None:
    """Raise SystemLimitError if the system makes no semaphores, without which processes cannot be given work.

    They are in shared memory, which may be full, missing or read-only.
    """
    _prepare_children()  # the first semaphore starts the resource tracker
    try:
        get_context("spawn").Lock()
    except OSError as error:
        raise limit_reached(error) or SystemLimitError(
            "no process can be given work: the system makes no semaphore (on Linux in /dev/shm): "
            f"{system_reason(error)}"
        ) from None


def perform(
    function: Callable[[Task], Result], tasks: Iterable[Task], executor: Executor | None
) -> Iterator[tuple[Task, Result]]:
    """Yield each task with its result, in the order in which they finish; without an executor, here and in order."""
    if executor is None:
        for task in tasks:
            yield task, function(task)
        return
    with interrupts_held():
        running: dict[Future[Result], Task] = {executor.submit(function, task): task for task in tasks}
    for future in as_completed(running):
        yield running[future], future.result()


def in_order(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: int, alone: int, ahead: int = 2
) -> Generator[Result, None, None]:
    """Yield the result of each task, in order.

    This process does the first `alone` tasks, `workers` processes the others. Tasks are taken in advance, `ahead` for
    each worker, which has something to do while another's task takes long. An error is raised after the results before
    it. If a worker is killed, its task is done here. The caller closes the generator if it does not exhaust it.
    """
    coming = iter(tasks)
    yield from map(function, islice(coming, alone))
    if workers <= 1:
        yield from map(function, coming)
        return
    for first in coming:
        with fresh(workers) as executor:
            queue: deque[tuple[Task | _TaskError, Future[Result] | None]] = deque()
            for task in _tasks_then_error(chain([first], coming)):
                queue.append((task, _submitted(function, task, executor)))
                if len(queue) == ahead * workers:
                    yield _finished(function, *queue.popleft())
            while queue:
                yield _finished(function, *queue.popleft())


@dataclass(frozen=True, slots=True)
class _TaskError:
    """An error of the iterator of tasks; it replaces the tasks that it prevented."""

    error: Exception


def _tasks_then_error(tasks: Iterable[Task]) -> Iterator[Task | _TaskError]:
    """Yield the tasks; if their iterator raises an error, yield that last, as a _TaskError."""
    try:
        yield from tasks
    except Exception as error:  # noqa: BLE001 - every error is raised after the results before it
        yield _TaskError(error)


def _submitted(
    function: Callable[[Task], Result], task: Task | _TaskError, executor: Executor
) -> Future[Result] | None:
    """Submit a task, and return its future; None for a _TaskError, and if the pool is broken."""
    if isinstance(task, _TaskError):
        return None
    try:
        with interrupts_held():
            return executor.submit(function, task)
    except BrokenExecutor:
        return None


def _finished(function: Callable[[Task], Result], task: Task | _TaskError, future: Future[Result] | None) -> Result:
    """Wait for the result of a task; do the task here if its process is gone. Raises the error of a _TaskError."""
    if isinstance(task, _TaskError):
        raise task.error
    with suppress(BrokenExecutor):
        if future is not None:
            return future.result()
    return function(task)


def one_each(function: Callable[[Task], Result], tasks: Iterable[Task], workers: int) -> Iterator[tuple[Task, Result]]:
    """Yield each task with its result, in order, each done by a fresh process of its own; `workers` at a time."""
    todo = list(tasks)
    require_semaphores()
    with interrupts_held():  # for the thread that starts further processes, too
        pool = get_context("spawn").Pool(max(1, workers), initializer=end_with_parent, maxtasksperchild=1)
    with pool:
        yield from zip(todo, pool.imap(function, todo, chunksize=1), strict=True)


def end_with_parent() -> None:
    """End this process at once when its parent ends.

    Children do not notice that their parent was killed: those of a pool would wait for a task without end, and others
    would first finish work that nobody needs.
    """
    parent = parent_process()
    if parent is None:
        return

    def follow() -> None:
        parent.join()
        os._exit(1)

    threading.Thread(target=follow, name="hypcheck-parent", daemon=True).start()


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Defer interrupts within the block; processes started within it ignore those of the keyboard for ever.

    A terminal sends an interrupt to every process. The parent handles it; a worker would only print a traceback, also
    one that has no task yet.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    _prepare_children()
    with interrupts_deferred():
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _prepare_children() -> None:
    """Prepare this process for its first child: its path of modules, and the tracker of shared memory."""
    _keep_working_directory_off_their_path()
    _begin_resource_tracker()


@lru_cache
def _keep_working_directory_off_their_path() -> None:
    """Keep processes that multiprocessing starts from importing modules from their working directory.

    Each starts as `python -c`, which has that folder first on its path: a types.py or socket.py there would run in
    place of Python's own. Later, multiprocessing gives it the path of its parent. -P does the same only from Python
    3.11 on, and the variable PYTHONSAFEPATH would also reach the programs under test.
    """
    if not hasattr(util, "spawnv_passfds"):  # Windows
        return
    spawn = util.spawnv_passfds

    def with_safe_path(path: bytes, args: Sequence[Any], passfds: Sequence[int]) -> int:
        words = list(args)
        program = words.index("-c", 1) + 1
        words[program] = f"import sys; sys.path[:] = filter(None, sys.path); {words[program]}"
        return spawn(path, words, passfds)

    util.spawnv_passfds = with_safe_path


def _begin_resource_tracker() -> None:
    """Start Python's resource tracker, which removes what a killed process leaves, without its warnings.

    If it started with the first child, interrupts would not be blocked any more. It must outlive all processes: Python
    lets it ignore all signals except SIGHUP, which is blocked here.
    """
    if not hasattr(signal, "pthread_sigmask"):
        return
    quiet = "ignore:resource_tracker:UserWarning"
    sys.warnoptions.append(quiet)  # it inherits this, and the blocked signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGHUP})
    try:
        resource_tracker.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        sys.warnoptions.remove(quiet)


@contextmanager
def interrupts_deferred() -> Iterator[None]:
    """Let Ctrl-C and the like wait until the block is done, and then take effect.

    Blocking the signals is not enough: Python runs handlers in the main thread, whichever thread got the signal.
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # no handler interrupts another thread
        return
    received: list[int] = []
    before: dict[signal.Signals, Any] = {}
    try:
        for unwinding in UNWINDING:
            before[unwinding] = signal.getsignal(unwinding)
            if callable(before[unwinding]):
                signal.signal(unwinding, lambda number, _: received.append(number))
        yield
    finally:
        for number, handler in before.items():
            if callable(handler):
                signal.signal(number, handler)
        for caught in dict.fromkeys(received):
            signal.raise_signal(caught)
