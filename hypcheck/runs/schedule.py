"""The steps of a conformance run in order: chunks, retests, searches, the invalid rows; their tasks and merged results.

An executor performs the tasks. Each task starts with the full limits, and its result has the rest that is left. When
results are merged, in the order of the steps, the sum over all tasks is checked: the step that exceeds the limits is
the last that counts, and the cases of later steps are not tested. Therefore the state after each step does not depend
on the executor or on the number of workers.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, field, replace
from itertools import islice, takewhile

from hypcheck.errors import Exit, HypcheckError
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.implementation import Crashed, Implementation, open_implementation
from hypcheck.implementations.session import Allowance, Limits, StartError
from hypcheck.runs import results
from hypcheck.runs.border_search import SearchStep, ask_search
from hypcheck.runs.cases import PACE, CaseChunk, Pace
from hypcheck.runs.retest import RetestStep, retest

Step = CaseChunk | RetestStep | SearchStep | results.InvalidRows


@dataclass(frozen=True, slots=True)
class ImplementationOpener:
    """What is needed to open an implementation: its SPEC, its limits, and values that replace what it declares.

    `declared` is the description that it must declare, if it was opened before in another process.
    """

    spec: str
    limits: Limits
    precision: str | None = None
    question: str | None = None
    domain: Domain | None = None
    declared: Description | None = None

    def open(self) -> Implementation:
        """Open the implementation, and return it. Raises InputError and StartError as open_implementation does.

        It also raises StartError if the description differs from the earlier one.
        """
        implementation = open_implementation(
            self.spec, self.limits, precision=self.precision, question=self.question, domain=self.domain
        )
        if self.declared not in (None, implementation.declared):
            implementation.kill()
            raise StartError(f"{implementation.spec} declares another description in each process")
        return implementation


@dataclass(frozen=True)
class TaskResult:
    """The result of a task, and the rest of the allowance with which it began."""

    result: results.CasesResult
    left: Allowance


def perform_task(
    task: Step, implementation: Implementation | Crashed, rules: results.JudgingRules, allowance: Allowance
) -> TaskResult:
    """Perform a task within the allowance. The result depends only on the answers and the allowance."""
    implementation.allowance = allowance
    if isinstance(task, CaseChunk):
        result = results.ask_chunk(task, implementation, rules)
    elif isinstance(task, RetestStep):
        result = retest(task, implementation, rules)
    elif isinstance(task, SearchStep):
        result = ask_search(task, implementation, rules)
    else:
        result = results.ask_invalid_rows(task, implementation, rules)
    return TaskResult(result, implementation.allowance)


STEPS_AHEAD = 32
"""The most results for each worker that may wait to be merged. With fewer, workers would be idle during a retest."""

TASKS_PER_WORKER = 2
"""The most submitted tasks for each worker: the one that it performs, and the next. All others wait here in order."""

MAX_WORKERS_LOST = 3
"""A task that has killed this many workers is given up; so is a run in which so many in a row died before they
began."""

_TICK = 1.0


@dataclass(frozen=True)
class RunState:
    """The state of a run: the rest of the limits, the number of finished steps, and their merged result.

    From a state and the same steps, the run continues as if it had never paused.
    """

    left: Allowance
    done: int = 0
    total: results.CasesResult = field(default_factory=results.CasesResult)

    def allowance(self, limits: Allowance) -> Allowance:
        """Return the allowance of the next task: the full limits, unless the implementation was given up."""
        return replace(limits, over=self.left.over, hangs=self.left.hangs)

    def after(self, step: Step, result: TaskResult, limits: Allowance) -> RunState:
        """Return the state after one more step, whose task started with the full limits."""
        before = self.total
        if isinstance(step, RetestStep):
            before = replace(
                before, pending=tuple(pending for pending in before.pending if not step.asks(pending.chunk))
            )
        return RunState(
            self.left.after(result.left, limits), self.done + 1, results.merged_result([before, result.result])
        )


class WorkerLost(Exception):  # noqa: N818 - it is an event that does not fail the run
    """A worker ended while it performed a task; every executor raises this.

    `workers` names the kind of workers, and `last` says how the last one ended. `deaths` workers have ended during the
    task; 0 if the worker ended before it was ready, because then no task caused it.
    """

    def __init__(self, workers: str, last: str = "", deaths: int = 1) -> None:
        super().__init__(workers, last, deaths)
        self.workers = workers
        self.last = last
        self.deaths = deaths


class WorkersLostError(HypcheckError):
    """Several workers in a row ended before they were ready, or had different files of hypcheck."""

    exit_code = Exit.INTERNAL


@dataclass(frozen=True)
class TaskExecution:
    """An executor, and what it needs to perform tasks.

    It calls `function` with a `task` and its `allowance` in `workers` processes; 0 means this process. `limits` are the
    allowance of one task. `max_rows` and `rules` make the result of a task that no worker survives.
    """

    executor: Executor
    function: Callable[..., TaskResult]
    workers: int
    limits: Allowance
    max_rows: int | None
    rules: results.JudgingRules

    def crashed(self, task: Step, allowance: Allowance, reason: str) -> TaskResult:
        """Return the result of a task if all of its cases crash."""
        return perform_task(task, Crashed(self.max_rows, reason, allowance), self.rules, allowance)


def steps_of_chunks(
    chunks: Iterable[CaseChunk], last: Iterable[SearchStep | results.InvalidRows] = (), pace: Pace = PACE
) -> Iterator[Step]:
    """Yield the steps that test these chunks, with their retests, and then the steps `last`."""
    rows, rounds, parts = 0, 0, set[int]()
    for chunk in chunks:
        yield chunk
        rows += len(chunk)
        parts.add(chunk.part(pace.chunk_rows))
        if rows >= pace.retest_after:
            yield from _retest_steps(rounds, parts, pace)
            rows, rounds, parts = 0, rounds + 1, set()
    yield from _retest_steps(rounds, parts, pace)
    yield from last


def _retest_steps(number: int, parts: set[int], pace: Pace) -> Iterator[RetestStep]:
    """Yield a round's retests.

    Part 0, the longest in the first round, comes last, so that the other parts run meanwhile.
    """
    return (RetestStep(number, part, pace=pace) for part in (1, 2, 0) if part in parts)


def perform_steps(some: Iterable[Step], execution: TaskExecution, state: RunState) -> Iterator[tuple[Step, RunState]]:
    """Perform the steps that the state lacks; yield each with the state after it.

    Raises WorkersLostError if workers end before they are ready, and whatever a task raises.
    """
    queue = _TaskQueue(islice(some, state.done, None), execution)
    while queue.look_ahead(state):
        for entry in queue.due(state):
            allowance = state.allowance(execution.limits)
            entry.future = execution.executor.submit(execution.function, task=entry.step, allowance=allowance)
        if (finished := queue.take()) is None:
            queue.wait()
            continue
        step, result = finished
        given_up = state.left.over
        state = state.after(step, result, execution.limits)
        if state.left.over and not given_up:
            queue.drop()
        yield step, state


@dataclass
class _QueuedStep:
    """A step whose result is not merged yet.

    `ready` says that the step can be submitted; a retest can be when its cases are known. `future` is None until the
    step is submitted. `deaths` is the number of workers that died while they performed it; a step with deaths is a
    suspect. `alone` says that it was submitted as the only step.
    """

    step: Step
    ready: bool
    future: Future[TaskResult] | None = None
    deaths: int = 0
    alone: bool = False


class _TaskQueue:
    """The next steps in order. Decides which tasks are submitted, and which are retried or given up.

    A task whose worker ended is a suspect and runs alone, so that no task is blamed for another. A task of which
    MAX_WORKERS_LOST workers have died, the last while it ran alone, is given up: its cases end as CRASH.
    """

    def __init__(self, coming: Iterator[Step], execution: TaskExecution) -> None:
        self._coming = coming
        self._execution = execution
        self._entries: deque[_QueuedStep] = deque()
        self._unready = 0

    def take(self) -> tuple[Step, TaskResult] | None:
        """Return the next step with its result, or None if there is no result yet. Raises what the task raised."""
        future = self._entries[0].future
        if future is None or not future.done() or isinstance(future.exception(), WorkerLost):
            return None
        return self._entries.popleft().step, future.result()

    def wait(self) -> None:
        """Wait until a submitted task is done, or for a moment."""
        wait(self._running, _TICK, FIRST_COMPLETED)

    def drop(self) -> None:
        """Cancel all submitted tasks, because the implementation was given up."""
        for entry in self._entries:
            if entry.future is not None:
                entry.future.cancel()
            entry.future, entry.deaths = None, 0

    def look_ahead(self, state: RunState) -> bool:
        """Check submitted tasks, and queue the steps that can be performed next. False if none is left."""
        self._settle(state.allowance(self._execution.limits))
        steps = 1 if self._one_by_one(state) else self._execution.workers * STEPS_AHEAD
        while len(self._entries) < steps and (step := next(self._coming, None)) is not None:
            self._entries.append(_QueuedStep(step, not isinstance(step, RetestStep)))
        for entry in takewhile(lambda queued: isinstance(queued.step, RetestStep), self._entries):
            if isinstance(entry.step, RetestStep) and not entry.ready:  # only now are all its cases known
                entry.step, entry.ready = entry.step.of(state.total.pending), True
        return bool(self._entries)

    def due(self, state: RunState) -> list[_QueuedStep]:
        """Return the entries whose tasks can be submitted now, in order; a suspect only if no other task runs."""
        suspects = [entry for entry in self._entries if entry.deaths]
        most = 1 if suspects or self._one_by_one(state) else self._execution.workers * TASKS_PER_WORKER
        ready = [entry for entry in suspects[:1] or self._entries if entry.future is None and entry.ready]
        due = ready[: max(0, most - len(self._running))]
        for entry in due:
            entry.alone = bool(suspects)
        return due

    def _one_by_one(self, state: RunState) -> bool:
        """Return whether only one task may run at a time."""
        return not self._execution.workers or state.left.hangs is not None  # hangs are counted in order

    @property
    def _running(self) -> list[Future[TaskResult]]:
        """The futures of tasks that are not done."""
        futures = (entry.future for entry in self._entries)
        return [future for future in futures if future is not None and not future.done()]

    def _settle(self, allowance: Allowance) -> None:
        """Retry tasks whose worker was lost, and clear suspects that succeeded."""
        for entry in self._entries:
            if entry.future is not None and entry.future.done():
                lost = entry.future.exception()
                if isinstance(lost, WorkerLost):
                    self._retry(entry, lost, allowance)
                else:
                    entry.deaths = self._unready = 0

    def _retry(self, entry: _QueuedStep, lost: WorkerLost, allowance: Allowance) -> None:
        """Submit the task of a lost worker again later, or give it up if it has killed MAX_WORKERS_LOST workers."""
        entry.future = None
        if not lost.deaths:
            self._unready += 1
            if self._unready == MAX_WORKERS_LOST:
                raise WorkersLostError(
                    f"{MAX_WORKERS_LOST} {lost.workers} ended before they had asked a case, {lost.last}"
                )
            return
        entry.deaths += lost.deaths
        if entry.alone and entry.deaths >= MAX_WORKERS_LOST:
            last = f", {lost.last}" if lost.last else ""
            reason = f"{entry.deaths} {lost.workers} ended while they asked these cases{last}"
            entry.future = Future()
            entry.future.set_result(self._execution.crashed(entry.step, allowance, reason))
            entry.deaths = 0
