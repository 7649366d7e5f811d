"""A gating run: chunks of cases are asked, judged and tallied; what that comes to are lines of the record."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hypcheck.errors import RunOutcome
from hypcheck.gate.chunks import Chunk
from hypcheck.gate.cluster import connected
from hypcheck.gate.conformance import Rules
from hypcheck.gate.consistency import require_all_tallied
from hypcheck.gate.executors import keep_memory, pool, serial
from hypcheck.gate.known_failures import KnownFailure
from hypcheck.gate.lines import Lines, as_recorded, outcome_of
from hypcheck.gate.plan import GatePlan, known_failures_of, planned, rules_of, size, steps_of
from hypcheck.gate.resume import Keeper
from hypcheck.gate.schedule import Performing, State, Step, states
from hypcheck.gate.tasks import Opening
from hypcheck.methods.faults import StartError
from hypcheck.methods.implementation import Implementation
from hypcheck.processes import interrupts_deferred
from hypcheck.record import Recorder
from hypcheck.record.lines import NotStarted

if TYPE_CHECKING:
    from distributed import Client

Advance = Callable[[int], object]


def run(plan: GatePlan, recorder: Recorder, outcome: RunOutcome, advance: Advance, state: State | None = None) -> None:
    """Gate the implementations of the plan; `advance` is told how many cases have been asked.

    Those whose lines the recorder begins with are not asked again, and the next one goes on from `state`; `advance`
    is told of neither. Interrupted, it records what was finished. Raises NothingJudgedError where not one case was
    judged, which proves nothing.
    """
    listed, cases = known_failures_of(plan), size(plan)
    keep_memory()
    with connected(plan.cluster) if plan.cluster else nullcontext() as client:
        for number in range(recorder.concluded, len(plan.specs)):
            try:
                with _gating(plan, number, listed, recorder, state, client) as gating:
                    for step, after in states(gating.steps, gating.performing, gating.state):
                        gating.state = after
                        advance(_cases_of(step))
                        gating.keeper.offer(after)
            except StartError as error:
                spec = plan.specs[number]
                recorder.add(NotStarted(spec=spec, name=spec, trouble=str(error)))
                advance(cases)
            state = None
    outcome_of(recorder.lines, outcome)


@dataclass
class _Gating:
    """An implementation that is being asked: the steps, what performs them, and how far it is."""

    steps: Iterable[Step]
    performing: Performing
    keeper: Keeper
    state: State


@contextmanager
def _gating(
    plan: GatePlan,
    number: int,
    listed: tuple[KnownFailure, ...],
    recorder: Recorder,
    begun: State | None,
    client: Client | None,
) -> Iterator[_Gating]:
    """The implementation of that number, from its beginning or from the state; its lines are recorded when it ends.

    Where it is interrupted, how far it is is kept too. Raises StartError where it cannot be started.
    """
    opening = plan.opening(number)
    with opening.open() as implementation:
        used = implementation.description
        rules = rules_of(plan, used, listed)
        lines = Lines(plan, opening.spec, implementation.declared, used, rules)
        declared = as_recorded(implementation.declared)
        keeper = Keeper(recorder, number=number, declared=declared, cases=size(plan))
        begun = begun or State(implementation.allowance)
        with _performing(implementation, opening, plan, rules, client) as performing:
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
        require_all_tallied(tallies, planned(plan, used.domain, refuses=used.refuses))
        lines.add(gating.state, recorder, finished=True)


def _cases_of(step: Step) -> int:
    return len(step) if isinstance(step, Chunk) else 0


def _performing(
    implementation: Implementation, opening: Opening, plan: GatePlan, rules: Rules, client: Client | None
) -> AbstractContextManager[Performing]:
    """What performs the tasks: this process; for large runs others, or a cluster: then nothing is asked here."""
    count = plan.processes(size(plan))
    if client is None and count is None:
        return serial(implementation, rules)
    implementation.close()
    if count is not None and client is None:
        return pool(count, opening, rules, implementation)
    from hypcheck.gate.dask_executor import on_cluster  # noqa: PLC0415 - loads dask.distributed, which no other run needs

    return on_cluster(client, opening, rules, implementation)
