"""The tasks of a conformance run in order: which are submitted, which are retried, and how their results are merged.

The tasks of a run, and the function that performs one wherever an implementation is open.

The steps of a run: chunks, retests, the invalid rows. An executor performs them, and results are merged in order.

Every task begins with all that the limits allow, and its result says what it spent. What tasks have spent together is
decided when their results are merged, in the order of the steps: the step in which the limits run out is the last
counted, and the implementation is not asked what lies behind it. So the state after each step is the same for any
executor and any number of workers.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, field, replace
from itertools import islice, takewhile

from hypcheck.errors import Exit, HypcheckError
from hypcheck.implementations.description import Domain
from hypcheck.implementations.implementation import Crashed, Implementation, open_implementation
from hypcheck.implementations.session import Allowance, Limits
from hypcheck.runs.cases import CHUNK_ROWS, CaseChunk
from hypcheck.runs.results import (
    CasesResult,
    InvalidRows,
    JudgingRules,
    PendingRetest,
    ask_chunk,
    ask_invalid_rows,
    merged_result,
)
from hypcheck.runs.retest import RetestTask, retest

Task = CaseChunk | RetestTask | InvalidRows


@dataclass(frozen=True, slots=True)
class ImplementationOpener:
    """How an implementation is opened: its SPEC, limits, and what stands for what it declares."""

    spec: str
    limits: Limits
    precision: str | None = None
    question: str | None = None
    domain: Domain | None = None

    def open(self) -> Implementation:
        """It, running. Raises InputError and StartError as open_implementation does."""
        return open_implementation(
            self.spec, self.limits, precision=self.precision, question=self.question, domain=self.domain
        )


@dataclass(frozen=True)
class TaskResult:
    """The result of a task, and what is left of the allowance with which it began."""

    result: CasesResult
    left: Allowance


def perform_task(
    task: Task, implementation: Implementation | Crashed, rules: JudgingRules, allowance: Allowance
) -> TaskResult:
    """Perform a task, which may spend the allowance; the result depends on nothing else but the answers."""
    implementation.allow(allowance)
    if isinstance(task, CaseChunk):
        result = ask_chunk(task, implementation, rules)
    elif isinstance(task, RetestTask):
        result = retest(task, implementation, rules)
    else:
        result = ask_invalid_rows(task, implementation)
    return TaskResult(result, implementation.allowance)


RETEST_AFTER = 64 * CHUNK_ROWS
"""Rows after which their open cases are asked again, so that no more than so many are ever kept.

A retest holds them all at once; twice as many would cost each process some 8 MB more.
"""

STEPS_AHEAD = 32
"""Steps for each worker whose results may wait to be merged, so that no worker is idle during a retest."""

TASKS_PER_WORKER = 2
"""Tasks for each worker that its executor holds: one that it performs, and the next. The others wait here in order."""

MAX_WORKERS_LOST = 3
"""Workers that one task may cost, and that may end one after the other before they are ready."""

_TICK = 1.0


@dataclass(frozen=True, slots=True)
class RetestStep:
    """A step that asks the open cases of the chunks since the last round again: those in one part of it.

    Part 0 is of the chunks that begin a family; with it everything is asked that is asked once a run. Parts 1 and 2 are
    of the others, so that two processes ask at the same time at the end, where nothing else is left to do.
    """

    number: int
    part: int = 0

    def of(self, some: tuple[PendingRetest, ...]) -> RetestTask:
        """Its task, where these are open."""
        return RetestTask(self.number, self.part, tuple(each for each in some if each.chunk.part == self.part))


Step = CaseChunk | RetestStep | InvalidRows


@dataclass(frozen=True)
class RunState:
    """A run so far: how many steps are done, their merged result, and what the implementation may still spend.

    From a state and the same steps the run goes on as if it had never paused.
    """

    left: Allowance
    done: int = 0
    total: CasesResult = field(default_factory=CasesResult)

    def allowance(self, limits: Allowance) -> Allowance:
        """What the next task may spend: all of the limits, unless the implementation is asked no more."""
        return replace(limits, over=self.left.over, hangs=self.left.hangs)

    def after(self, step: Step, done: TaskResult, limits: Allowance) -> RunState:
        """The state after one more step, whose task began with all of the limits."""
        before = self.total
        if isinstance(step, RetestStep):
            before = replace(before, pending=tuple(each for each in before.pending if each.chunk.part != step.part))
        return RunState(self.left.after(done.left, limits), self.done + 1, merged_result([before, done.result]))


class WorkerLost(Exception):  # noqa: N818 - it is an event, which costs the run nothing
    """A worker ended while it performed a task: what every executor raises for it.

    The text names the workers, and `last` says how the last one ended. The task has cost `deaths` of them; 0 where the
    worker ended before it was ready, which is no task's fault.
    """

    def __init__(self, workers: str, last: str = "", deaths: int = 1) -> None:
        super().__init__(workers, last, deaths)
        self.workers = workers
        self.last = last
        self.deaths = deaths


class WorkersLostError(HypcheckError):
    """Workers ended, one after the other, before they were ready, or are not of this program."""

    exit_code = Exit.INTERNAL


@dataclass(frozen=True)
class TaskExecution:
    """An executor, and what it needs to perform tasks.

    It calls `function` with a `task` and its `allowance`, in `workers` processes; 0 where it is this one.
    `limits` are what one task may spend. `max_rows` and `rules` make the result of a task that no worker survives.
    """

    executor: Executor
    function: Callable[..., TaskResult]
    workers: int
    limits: Allowance
    max_rows: int | None
    rules: JudgingRules

    def crashed(self, task: Task, allowance: Allowance, reason: str) -> TaskResult:
        """The result of a task all of whose cases crash."""
        return perform_task(task, Crashed(self.max_rows, reason, allowance), self.rules, allowance)


def steps_of_chunks(chunks: Iterable[CaseChunk], *, refuses: bool) -> Iterator[Step]:
    """The steps that ask these chunks; `refuses`: and the invalid rows."""
    rows, rounds, parts = 0, 0, set[int]()
    for chunk in chunks:
        yield chunk
        rows += len(chunk)
        parts.add(chunk.part)
        if rows >= RETEST_AFTER:
            yield from _retest_steps(rounds, parts)
            rows, rounds, parts = 0, rounds + 1, set()
    yield from _retest_steps(rounds, parts)
    if refuses:
        yield InvalidRows()


def _retest_steps(number: int, parts: set[int]) -> Iterator[RetestStep]:
    """Part 0, which takes the longest in the first round, stands last, so that the others are asked together."""
    return (RetestStep(number, part) for part in (1, 2, 0) if part in parts)


def perform_steps(some: Iterable[Step], performing: TaskExecution, state: RunState) -> Iterator[tuple[Step, RunState]]:
    """Perform the steps behind those that are done; each with the state after it.

    Raises LostError where workers end before they are ready, and whatever a task raises.
    """
    line = _TaskQueue(islice(some, state.done, None), performing)
    while line.look_ahead(state):
        for entry in line.due(state):
            allowance = state.allowance(performing.limits)
            entry.future = performing.executor.submit(performing.function, task=entry.task, allowance=allowance)
        if (found := line.take()) is None:
            line.wait()
            continue
        step, done = found
        stopped = state.left.over
        state = state.after(step, done, performing.limits)
        if state.left.over and not stopped:
            line.drop()
        yield step, state


@dataclass
class _QueuedStep:
    """A step whose result is not merged yet. `deaths` are the workers that it has cost, which makes it a suspect."""

    step: Step
    task: Task | None = None
    future: Future[TaskResult] | None = None
    deaths: int = 0
    alone: bool = False


class _TaskQueue:
    """The steps that are next, in order. Decides which tasks are submitted, and what becomes of those that are lost.

    A task whose worker ended is a suspect, and performed alone, so that none is blamed for another. One that has cost
    DEATHS workers, the last of them alone, is given up: its cases crash.
    """

    def __init__(self, coming: Iterator[Step], performing: TaskExecution) -> None:
        self._coming = coming
        self._performing = performing
        self._entries: deque[_QueuedStep] = deque()
        self._unready = 0

    def take(self) -> tuple[Step, TaskResult] | None:
        """The next step with its result; None where that is not there yet. Raises what the task raised."""
        future = self._entries[0].future
        if future is None or not future.done() or isinstance(future.exception(), WorkerLost):
            return None
        return self._entries.popleft().step, future.result()

    def wait(self) -> None:
        """Wait until something has come of a task that was submitted."""
        wait(self._running, _TICK, FIRST_COMPLETED)

    def drop(self) -> None:
        """Forget what was submitted: the implementation is to be asked no more."""
        for entry in self._entries:
            if entry.future is not None:
                entry.future.cancel()
            entry.future, entry.deaths = None, 0

    def look_ahead(self, state: RunState) -> bool:
        """See what became of the tasks, and take in steps that can be performed; whether any are left."""
        self._settle(state.allowance(self._performing.limits))
        steps = 1 if self._one_by_one(state) else self._performing.workers * STEPS_AHEAD
        while len(self._entries) < steps and (step := next(self._coming, None)) is not None:
            self._entries.append(_QueuedStep(step, None if isinstance(step, RetestStep) else step))
        for entry in takewhile(lambda each: isinstance(each.step, RetestStep), self._entries):
            if isinstance(entry.step, RetestStep) and entry.task is None:  # only now all of its cases are there
                entry.task = entry.step.of(state.total.pending)
        return bool(self._entries)

    def due(self, state: RunState) -> list[_QueuedStep]:
        """The earliest entries whose tasks can be submitted; a suspect alone, when no other is running."""
        suspects = [entry for entry in self._entries if entry.deaths]
        most = 1 if suspects or self._one_by_one(state) else self._performing.workers * TASKS_PER_WORKER
        ready = [entry for entry in suspects[:1] or self._entries if entry.future is None and entry.task is not None]
        due = ready[: max(0, most - len(self._running))]
        for entry in due:
            entry.alone = bool(suspects)
        return due

    def _one_by_one(self, state: RunState) -> bool:
        return not self._performing.workers or state.left.hangs is not None  # hangs are counted in order

    @property
    def _running(self) -> list[Future[TaskResult]]:
        futures = (entry.future for entry in self._entries)
        return [future for future in futures if future is not None and not future.done()]

    def _settle(self, allowance: Allowance) -> None:
        """See which tasks were lost, and which suspects are cleared."""
        for entry in self._entries:
            if entry.future is not None and entry.future.done():
                lost = entry.future.exception()
                if isinstance(lost, WorkerLost):
                    self._retry(entry, lost, allowance)
                else:
                    entry.deaths = self._unready = 0

    def _retry(self, entry: _QueuedStep, lost: WorkerLost, allowance: Allowance) -> None:
        entry.future = None
        if not lost.deaths:
            self._unready += 1
            if self._unready == MAX_WORKERS_LOST:
                raise WorkersLostError(
                    f"{MAX_WORKERS_LOST} {lost.workers} ended before they had asked anything, {lost.last}"
                )
            return
        entry.deaths += lost.deaths
        if entry.alone and entry.deaths >= MAX_WORKERS_LOST and entry.task is not None:
            last = f", {lost.last}" if lost.last else ""
            reason = f"{entry.deaths} {lost.workers} ended while they asked these cases{last}"
            entry.future = Future()
            entry.future.set_result(self._performing.crashed(entry.task, allowance, reason))
            entry.deaths = 0
