"""A conformance run: it opens each implementation, performs its tasks, and writes the lines of its record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from msgspec import UNSET

from hypcheck.errors import Exit, NothingJudgedError, RunOutcome, UnavailableError
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import too_few
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import StartError
from hypcheck.messages import counted
from hypcheck.processes import Advance, interrupts_deferred
from hypcheck.record import Recorder, RecordLine
from hypcheck.record.lines import UNEXPLAINED, CauseLine, DriftLine, GroupLine, ImplementationLine, NotStartedLine
from hypcheck.record.progress import Tally
from hypcheck.runs import spread, tally
from hypcheck.runs.consistency import require_all_tallied
from hypcheck.runs.diagnosis import causes_of, measured_worst
from hypcheck.runs.executors import execution_here, execution_in_pool, keep_freed_memory
from hypcheck.runs.judge import UNANSWERED, Status
from hypcheck.runs.known_failures import no_longer_failing
from hypcheck.runs.plan import (
    ConformancePlan,
    chosen_families,
    families_not_asked,
    known_failures_of,
    planned_cases,
    planned_size,
    require_named,
    rules_of,
    steps_of,
)
from hypcheck.runs.results import CasesResult, JudgingRules, merged_result
from hypcheck.runs.resume import ProgressWriter, recorded_description
from hypcheck.runs.retest import RetestStep, result_without_retest
from hypcheck.runs.schedule import ImplementationOpener, RunState, TaskExecution, perform_steps
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

if TYPE_CHECKING:
    from distributed import Client


def run_conformance(
    plan: ConformancePlan,
    recorder: Recorder,
    outcome: RunOutcome,
    advance: Advance,
    state: RunState | None = None,
    expect: Advance = lambda _: None,
) -> None:
    """Test the implementations of the plan, and call `advance` with the number of cases tested in each step.

    `expect` is called with the number of cases of an implementation beyond planned_size. A resumed run skips
    implementations that its record has finished, and continues the next one from `state`; `advance` is not called for
    either. An interrupted run records the finished part. Raises NothingJudgedError if no case was judged, because such
    a run proves nothing.
    """
    known_failures_of(plan)  # a file that cannot be read is refused before any case is tested
    cases = planned_size(plan)
    keep_freed_memory()
    with _cluster_client(plan.cluster) if plan.cluster else nullcontext() as client:
        for number in range(recorder.concluded, len(plan.specs)):
            try:
                _run_implementation(plan, number, recorder, state, client, advance, expect)
            except StartError as error:
                spec = plan.specs[number]
                recorder.add(NotStartedLine(spec=spec, name=spec, trouble=str(error)))
                advance(cases)
            state = None
    add_exit_codes(recorder.lines, outcome)


def _cluster_client(address: str) -> AbstractContextManager[Client]:
    """Return a context that gives a client of the cluster. Raises UnavailableError if dask is not installed."""
    try:
        from hypcheck.runs.cluster import cluster_client  # noqa: PLC0415 - loads dask, an extra that is slow to load
    except ModuleNotFoundError as error:
        raise UnavailableError(
            f"--cluster needs dask.distributed ({error.name} is not installed): pip install 'hypcheck[cluster]'"
        ) from None
    return cluster_client(address)


def _run_implementation(
    plan: ConformancePlan,
    number: int,
    recorder: Recorder,
    resumed: RunState | None,
    client: Client | None,
    advance: Advance,
    expect: Advance,
) -> None:
    """Test the implementation with this number, and record the lines about it at the end.

    If the run is interrupted, its progress is recorded too. Raises StartError if the implementation does not start.
    """
    opener, size = plan.opener(number), planned_size(plan)
    with opener.open() as implementation:
        used = implementation.description
        require_named(plan, used)
        rules, planned = rules_of(plan, used), planned_cases(plan, used)
        lines = ImplementationLines(plan, opener.spec, implementation.declared, used, rules)
        progress = ProgressWriter(recorder, number, implementation.declared, size, plan.pace)
        state = begun = resumed or RunState(implementation.allowance)
        steps = steps_of(plan, used)
        expect(sum(planned.values()) - size)
        with _task_execution(implementation, opener, plan, rules, client) as execution:
            try:
                for step, state in perform_steps(steps, execution, begun):
                    advance(0 if isinstance(step, RetestStep) else len(step))
                    progress.offer(state)
            except StartError:
                raise
            except BaseException:
                with interrupts_deferred(), suppress(OSError):  # the disk is full: the earlier progress line stays
                    progress.keep(state)
                lines.add(state, recorder, finished=False)
                raise
        require_all_tallied(state.total.tallies, planned)
        lines.add(state, recorder, finished=True)


def _task_execution(
    implementation: Implementation,
    opener: ImplementationOpener,
    plan: ConformancePlan,
    rules: JudgingRules,
    client: Client | None,
) -> AbstractContextManager[TaskExecution]:
    """Return a context that gives the executor of the tasks: this process, a pool, or a cluster.

    The processes of a pool or a cluster open the implementation themselves, so it is closed here.
    """
    workers = plan.pool_workers
    if client is None and workers is None:
        return execution_here(implementation, rules)
    implementation.close()
    if client is None and workers is not None:
        return execution_in_pool(workers, opener, rules, implementation)
    from hypcheck.runs.dask_executor import execution_on_cluster  # noqa: PLC0415 - loads dask

    return execution_on_cluster(client, opener, rules, implementation)


def add_exit_codes(recorded: Iterable[RecordLine], outcome: RunOutcome) -> None:
    """Add to the outcome the exit codes that the lines of a run give reasons for.

    The code is Exit.USAGE if no row of some implementation was judged, and Exit.INCONCLUSIVE if too few rows of one
    were judged. Raises NothingJudgedError if no case was tested, because such a run proves nothing.
    """
    cases, judged, skipped = 0, 0, 0
    for line in recorded:
        if isinstance(line, GroupLine):
            cases += line.asked
            judged += line.judged
            skipped += line.skipped
            undecided = Status.UNDECIDED.value
            outcome.codes |= {Exit.INCONCLUSIVE if status == undecided else Exit.WRONG for status in line.failing or ()}
        elif isinstance(line, DriftLine):
            outcome.codes.add(Exit.WRONG)
        elif isinstance(line, NotStartedLine):
            outcome.codes.add(Exit.NOT_STARTED)
        elif isinstance(line, ImplementationLine):
            outcome.codes |= {Exit.NOT_STARTED} if line.broke_protocol_throughout else set()
            outcome.codes |= {Exit.WRONG} if line.troubles else set()
            if line.finished is not False:
                outcome.codes |= set() if judged else {Exit.USAGE}
                outcome.codes |= {Exit.INCONCLUSIVE} if too_few(judged, skipped) else set()
            judged, skipped = 0, 0
    if not cases and Exit.NOT_STARTED not in outcome.codes:
        raise NothingJudgedError(
            "no case was judged: every case is outside the domain, or the declared precision cannot hold its numbers"
        )


_NOT_ASKED = {Status.SKIPPED.value}

_NO_CAUSE = (UNEXPLAINED, "no known cause gives these answers", "look at the worst of them with replay", "")
"""The name, sentence, remedy and claim of the line about wrong answers that no cause explains."""


@dataclass(frozen=True)
class ImplementationLines:
    """Makes the lines about one implementation: its SPEC, its description as declared and as used, and the rules."""

    plan: ConformancePlan
    spec: str
    declared: Description
    used: Description
    rules: JudgingRules

    def add(self, state: RunState, recorder: Recorder, *, finished: bool) -> None:
        """Record the state. In an unfinished run pending cases are judged by their first answers."""
        total = merged_result(
            [replace(state.total, pending=()), result_without_retest(state.total.pending, self.rules)]
        )
        groups = [self._group(family, tallied) for family, tallied in total.tallies.items()]
        for line in [*groups, *self._causes(total.tallies)]:
            recorder.add(line)
        if finished:
            for sentence in no_longer_failing(
                self.rules.known, total.excusing, {*total.tallies, *total.named}, self._subjects()
            ):
                recorder.add(DriftLine(sentence=f"{self.used.name}: {sentence}"))
        all_asked = finished and not state.left.over
        recorder.add(
            ImplementationLine(
                spec=self.spec,
                name=self.used.name,
                declared=recorded_description(self.declared),
                used=recorded_description(self.used),
                restarts=self.plan.limits.restarts - state.left.restarts,
                retest=total.retest,
                broke_protocol_throughout=total.broke_protocol_throughout,
                troubles=list(self._troubles(total, groups, finished=finished)),
                not_asked=families_not_asked(self.plan, self.used),
                slices=spread.slices_of(self.plan, self.used, self.rules) or UNSET if all_asked else UNSET,
                crossed=spread.crossed_of(self.plan, self.used) or UNSET if all_asked else UNSET,
                finished=UNSET if finished else False,
            )
        )

    def _subjects(self) -> set[str]:
        """Return the subjects ("upright", "tilted" or "way") of all tested families; none if only some were tested."""
        families = () if self.plan.filtered else chosen_families(self.plan, self.used)
        return {family.layout.subject(family.columns) for family in families}

    def _group(self, family: str, tallied: Tally) -> GroupLine:
        """Make the line about a family, with the statuses for which the family fails the run."""
        wrong_fails = self.plan.fail_on == "wrong" or tallied.dangerous > 0 or family in INVALID_CONTENTS
        grave = (*((Status.WRONG,) if wrong_fails else ()), Status.UNDECIDED, *UNANSWERED)
        failing = [status.value for status in grave if tallied.counts.get(status.value)]
        name = self.used.name
        return tally.group_line(
            tallied, family, self.rules.criterion, method=name, title=name, spec=self.spec, failing=failing
        )

    def _causes(self, tallies: Mapping[str, Tally]) -> Iterator[CauseLine]:
        """Yield a line for each accepted cause of its wrong answers.

        Families with only right answers show which causes the implementation does not have.
        """
        clean = [
            family for family, tallied in tallies.items() if {Status.RIGHT.value} == tallied.counts.keys() - _NOT_ASKED
        ]
        for counted_cause in causes_of(tallies, clean, self.rules.criterion, self.rules.domain):
            worst = measured_worst(counted_cause.worst, self.rules.criterion.question)
            name, sentence, remedy, claim = _NO_CAUSE
            if (cause := counted_cause.cause) is not None:
                remedy = cause.remedy_in(self.used.language)
                name, sentence, claim = cause.name, cause.sentence, cause.claim
            yield CauseLine(
                spec=self.spec,
                method=self.used.name,
                cause=name,
                sentence=sentence,
                remedy=remedy,
                claim=claim,
                cases=counted_cause.cases,
                families=dict(counted_cause.families),
                worst=tally.worst_line(worst, self.rules.criterion),
            )

    def _troubles(self, total: CasesResult, groups: Sequence[GroupLine], *, finished: bool) -> Iterator[str]:
        """Yield reasons why the implementation fails as a whole, not in one family."""
        nothing_judged = finished and not any(group.judged for group in groups)
        if nothing_judged:
            cases = sum(line.asked for line in groups)
            why = f"it abstained from all {cases:,} cases" if cases else "it was asked none of them"
            yield f"no case of {self.used.name} was judged: {why}"
        abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in groups)
        if abstained > self.plan.max_abstained and not nothing_judged:
            allowed = f"at most {self.plan.max_abstained:,} are allowed"
            yield f"{self.used.name} abstained from {counted(abstained, 'case')}; {allowed}"
        if self.plan.deterministic and total.retest.within:
            changed = f"changed {total.retest.within} answers within the tolerance"
            yield f"{self.used.name} {changed} when asked again"
