"""A conformance run: it opens each implementation, performs its tasks, and writes the results to the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hypcheck.errors import RunOutcome
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import StartError
from hypcheck.processes import Advance, interrupts_deferred
from hypcheck.record import Recorder
from hypcheck.record.lines import NotStartedLine
from hypcheck.runs.cases import CaseChunk
from hypcheck.runs.cluster import cluster_client
from hypcheck.runs.conformance_lines import ImplementationLines, outcome_of, recorded_description, require_all_tallied
from hypcheck.runs.executors import execution_here, execution_in_pool, keep_freed_memory
from hypcheck.runs.known_failures import KnownFailure
from hypcheck.runs.plan import ConformancePlan, known_failures_of, planned_cases, planned_size, rules_of, steps_of
from hypcheck.runs.results import JudgingRules
from hypcheck.runs.resume import ProgressWriter
from hypcheck.runs.schedule import ImplementationOpener, RunState, Step, TaskExecution, perform_steps

if TYPE_CHECKING:
    from distributed import Client


def run_conformance(
    plan: ConformancePlan, recorder: Recorder, outcome: RunOutcome, advance: Advance, state: RunState | None = None
) -> None:
    """Gate the implementations of the plan; `advance` is told how many cases have been asked.

    Those whose lines the recorder begins with are not asked again, and the next one goes on from `state`; `advance`
    is told of neither. Interrupted, it records what was finished. Raises NothingJudgedError where not one case was
    judged, which proves nothing.
    """
    listed, cases = known_failures_of(plan), planned_size(plan)
    keep_freed_memory()
    with cluster_client(plan.cluster) if plan.cluster else nullcontext() as client:
        for number in range(recorder.concluded, len(plan.specs)):
            try:
                with _gating(plan, number, listed, recorder, state, client) as gating:
                    for step, after in perform_steps(gating.steps, gating.performing, gating.state):
                        gating.state = after
                        advance(_cases_of(step))
                        gating.keeper.offer(after)
            except StartError as error:
                spec = plan.specs[number]
                recorder.add(NotStartedLine(spec=spec, name=spec, trouble=str(error)))
                advance(cases)
            state = None
    outcome_of(recorder.lines, outcome)


@dataclass
class _Gating:
    """An implementation that is being asked: the steps, what performs them, and how far it is."""

    steps: Iterable[Step]
    performing: TaskExecution
    keeper: ProgressWriter
    state: RunState


@contextmanager
def _gating(
    plan: ConformancePlan,
    number: int,
    listed: tuple[KnownFailure, ...],
    recorder: Recorder,
    begun: RunState | None,
    client: Client | None,
) -> Iterator[_Gating]:
    """The implementation of that number, from its beginning or from the state; its lines are recorded when it ends.

    Where it is interrupted, how far it is is kept too. Raises StartError where it cannot be started.
    """
    opening = plan.opening(number)
    with opening.open() as implementation:
        used = implementation.description
        rules = rules_of(plan, used, listed)
        lines = ImplementationLines(plan, opening.spec, implementation.declared, used, rules)
        declared = recorded_description(implementation.declared)
        keeper = ProgressWriter(recorder, number, declared, planned_size(plan))
        begun = begun or RunState(implementation.allowance)
        with _task_execution(implementation, opening, plan, rules, client) as performing:
            gating = _Gating(steps_of(plan, used), performing, keeper, begun)
            try:
                yield gating
            except StartError:
                raise
            except BaseException:
                with interrupts_deferred(), suppress(OSError):  # of a full disk: what was kept last is gone on from
                    keeper.keep(gating.state)
                lines.add(gating.state, recorder, finished=False)
                raise
        tallies = gating.state.total.tallies
        require_all_tallied(tallies, planned_cases(plan, used.domain, refuses=used.refuses))
        lines.add(gating.state, recorder, finished=True)


def _cases_of(step: Step) -> int:
    return len(step) if isinstance(step, CaseChunk) else 0


def _task_execution(
    implementation: Implementation,
    opening: ImplementationOpener,
    plan: ConformancePlan,
    rules: JudgingRules,
    client: Client | None,
) -> AbstractContextManager[TaskExecution]:
    """What performs the tasks: this process; for large runs others, or a cluster: then nothing is asked here."""
    count = plan.processes(planned_size(plan))
    if client is None and count is None:
        return execution_here(implementation, rules)
    implementation.close()
    if count is not None and client is None:
        return execution_in_pool(count, opening, rules, implementation)
    from hypcheck.runs.dask_executor import execution_on_cluster  # noqa: PLC0415 - loads dask.distributed, which no other run needs

    return execution_on_cluster(client, opening, rules, implementation)
