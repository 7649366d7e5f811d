"""Long work: its stages, fresh processes of our own that do it, and interrupts that end it as they should."""

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
"""Takes note of so many steps that are done."""


@dataclass(frozen=True)
class Stage:
    """A part of a long run: its title for the progress bar, how many steps it has, and what does them."""

    title: str
    steps: int
    run: Callable[[Advance], None]


UNWINDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""The signals that end a run in good order."""


def usable_processors() -> int:
    """The processors this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


@contextmanager
def processes(workers: int) -> Iterator[ProcessPoolExecutor | None]:
    """As many processes; none where one worker is asked for. Fresh ones: forking copies locks and threads.

    Where the block is left by an exception they are ended, and what they were to do is not done.
    """
    if workers <= 1:
        yield None
        return
    with fresh(workers) as executor:
        yield executor


@contextmanager
def fresh(workers: int) -> Iterator[ProcessPoolExecutor]:
    """The same, with a process of its own for a single worker too."""
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
    """Raise SystemLimitError where processes cannot be given work, since the system makes no semaphores.

    They are in shared memory, which may be full, missing or read-only.
    """
    _prepare_children()  # the first semaphore starts the process that looks after them
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
    """Each task with its result, as they are finished; without an executor, here and in order."""
    if executor is None:
        for task in tasks:
            yield task, function(task)
        return
    with interrupts_held():
        running: dict[Future[Result], Task] = {executor.submit(function, task): task for task in tasks}
    for future in as_completed(running):
        yield running[future], future.result()


def in_order(
    function: Callable[[Task], Result], tasks: Iterable[Task], workers: int, alone: int
) -> Generator[Result, None, None]:
    """The result of each task, in order: of the first few, `alone`, done here, and of the others by so many processes.

    Tasks are taken ahead of their turn, and what goes wrong is told in its turn. What a process was killed over is done
    here. To be closed where it is left early.
    """
    coming = iter(tasks)
    yield from map(function, islice(coming, alone))
    if workers <= 1:
        yield from map(function, coming)
        return
    for first in coming:
        with fresh(workers) as executor:
            line: deque[tuple[Task | _Trouble, Future[Result] | None]] = deque()
            for task in _troubles_in_turn(chain([first], coming)):
                line.append((task, _begun(function, task, executor)))
                if len(line) == 2 * workers:
                    yield _finished(function, *line.popleft())
            while line:
                yield _finished(function, *line.popleft())


@dataclass(frozen=True, slots=True)
class _Trouble:
    """What stands in place of the tasks that it ended."""

    error: Exception


def _troubles_in_turn(tasks: Iterable[Task]) -> Iterator[Task | _Trouble]:
    try:
        yield from tasks
    except Exception as error:  # noqa: BLE001 - whatever it is, it is told behind the results before it
        yield _Trouble(error)


def _begun(function: Callable[[Task], Result], task: Task | _Trouble, executor: Executor) -> Future[Result] | None:
    if isinstance(task, _Trouble):
        return None
    try:
        with interrupts_held():
            return executor.submit(function, task)
    except BrokenExecutor:
        return None


def _finished(function: Callable[[Task], Result], task: Task | _Trouble, future: Future[Result] | None) -> Result:
    if isinstance(task, _Trouble):
        raise task.error
    with suppress(BrokenExecutor):
        if future is not None:
            return future.result()
    return function(task)


def one_each(function: Callable[[Task], Result], tasks: Iterable[Task], workers: int) -> Iterator[tuple[Task, Result]]:
    """Each task with its result, in order, done by a process that has done nothing before; `workers` at a time."""
    todo = list(tasks)
    require_semaphores()
    with interrupts_held():  # the thread that starts further processes holds them as long as it lives
        pool = get_context("spawn").Pool(max(1, workers), initializer=end_with_parent, maxtasksperchild=1)
    with pool:
        yield from zip(todo, pool.imap(function, todo, chunksize=1), strict=True)


def end_with_parent() -> None:
    """From here on this process ends at once, whatever it is at, when the one that started it is gone.

    That one may have been killed, which its processes would not see: those of a pool wait for ever for what they are to
    do, and others would first finish what nobody asks for any more.
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
    """Interrupts wait, and the processes started meanwhile never get those from the keyboard.

    A terminal sends them to every process; the parent deals with them, and a worker would only print where it was. So
    would one whose parent was interrupted before it had told it what to do.
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
    """Before a process of ours is started."""
    _keep_working_directory_off_their_path()
    _begin_resource_tracker()


@lru_cache
def _keep_working_directory_off_their_path() -> None:
    """From here on, no Python process that multiprocessing starts takes a module from its working directory.

    Each begins as `python -c`, which has that folder first on its path: a types.py or socket.py that lies there would
    run in place of Python's own. Once it has begun, multiprocessing gives it the path of its parent. -P does the same
    from Python 3.11 on only, and the variable PYTHONSAFEPATH would also reach the programs that are tested.
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
    """Start Python's process that removes what a killed one leaves; it is to do so without a word.

    Started with the first process of ours, it would let interrupts through again. It is to outlive all of us, for which
    Python lets it ignore every signal but the one that a closed terminal sends.
    """
    if not hasattr(signal, "pthread_sigmask"):
        return
    quiet = "ignore:resource_tracker:UserWarning"
    sys.warnoptions.append(quiet)  # with which it starts, as with what is blocked here
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGHUP})
    try:
        resource_tracker.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        sys.warnoptions.remove(quiet)


@contextmanager
def interrupts_deferred() -> Iterator[None]:
    """Ctrl-C and the like wait until the block is done, and then do what they would have done.

    A mask would not do: Python runs their handlers here whichever thread the system gave them to.
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # which no handler interrupts
        return
    came: list[int] = []
    before: dict[signal.Signals, Any] = {}
    try:
        for each in UNWINDING:
            before[each] = signal.getsignal(each)
            if callable(before[each]):
                signal.signal(each, lambda number, _: came.append(number))
        yield
    finally:
        for each, handler in before.items():
            if callable(handler):
                signal.signal(each, handler)
        for caught in dict.fromkeys(came):
            signal.raise_signal(caught)
