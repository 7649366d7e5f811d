"""Consistency of a resumed run: the numbers of its record are compared with each other and with the plan.

The checksums of a record do not protect it from a person who edits it. Therefore no number that is read back is
trusted: each is checked against its bounds before it is used, sums must agree, and every planned case must be tallied.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice

import numpy as np
from msgspec import UNSET

from hypcheck.errors import Exit, HypcheckError
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import QUESTIONS, Description
from hypcheck.implementations.implementation import MAX_FAULTS
from hypcheck.implementations.session import MAX_HANGS, Outcome
from hypcheck.record import RecordLine
from hypcheck.record.fields import row_of
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.record.progress import Tally, WorstCase
from hypcheck.runs import border_search, judge
from hypcheck.runs.border_search import SearchStep
from hypcheck.runs.cases import EXPONENTS_OF, CaseChunk
from hypcheck.runs.diagnosis import FAILING
from hypcheck.runs.judge import DANGEROUS, UNANSWERED, Mistake, Status
from hypcheck.runs.plan import ConformancePlan, planned_cases
from hypcheck.runs.results import CasesResult, InvalidRows, JudgingRules, PendingRetest
from hypcheck.runs.schedule import RunState, Step
from hypcheck.runs.tally import UNANSWERED_KEPT, WORST_KEPT
from hypcheck.vectors.border_lines import SEARCHED
from hypcheck.vectors.draw import MARK
from hypcheck.vectors.families import ALL, family_of
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS

_OFF = (Status.WRONG, Status.TOLERATED, Status.UNDECIDED, Status.EXCUSED)
_ENDED_AS = tuple(outcome for outcome in Outcome if outcome is not Outcome.ANSWERED)
_UNANSWERED = frozenset(status.value for status in UNANSWERED)


class MissingCasesError(HypcheckError):
    """The tallies of a run do not hold the planned cases, so the run proves nothing."""

    exit_code = Exit.INTERNAL


def require_all_tallied(tallies: Mapping[str, Tally], cases: Mapping[str, int]) -> None:
    """Raise MissingCasesError if the tallies of a finished run do not hold just these cases."""
    trouble = _difference({family: sum(tally.counts.values()) for family, tally in tallies.items()}, cases)
    if trouble:
        raise MissingCasesError(f"{trouble}; this run proves nothing")


def require_lines(lines: Sequence[RecordLine], whole: ImplementationLine, plan: ConformancePlan) -> None:
    """Raise ValueError if the lines about a finished implementation contradict each other or the plan.

    `whole` is the line about the implementation as a whole.
    """
    groups = [line for line in lines if isinstance(line, GroupLine)]
    tallied = {line.family: sum(line.counts.values()) for line in groups}
    if len(tallied) < len(groups):
        raise ValueError("a family has two lines")
    fixed_sizes = {family: plan.count for family in tallied if MARK in family and not plan.filtered}
    without_search = {family: 0 for family in SEARCHED if whole.used.domain.settings}
    question = whole.used.question
    refuses = not tallied.keys().isdisjoint(INVALID_CONTENTS)
    tilt, heights = whole.used.tilt is True, whole.used.heights is True
    used = Description(whole.used.name, question=question, refuses=refuses, tilt=tilt, heights=heights)
    planned = planned_cases(plan, used)
    trouble = _difference(tallied, planned | fixed_sizes | without_search)
    for line in groups:
        numbers = (line.octaves, (line.size_bins, line.place_bins))
        trouble = trouble or _of_sums(line.family, line, *numbers) or _of_failing(line, plan)
        trouble = trouble or _of_fresh(line.family, line, plan)
    if trouble or _lacks_trouble(whole, groups, plan):
        raise ValueError(
            trouble or "it abstained from more cases or changed more answers than allowed, and no line says that"
        )


def _lacks_trouble(whole: ImplementationLine, groups: Sequence[GroupLine], plan: ConformancePlan) -> bool:
    """Return whether the line lacks a reason why the implementation fails as a whole."""
    abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in groups) > plan.max_abstained
    changed = plan.deterministic and whole.retest.within > 0
    return bool(abstained or changed) and not whole.troubles


def _of_fresh(family: str, sums: GroupLine | Tally, plan: ConformancePlan, *, unfinished: bool = False) -> str:
    """Return what is wrong with a family's number of fresh rows; "" if nothing is.

    The fresh rows that were tested or skipped must be as many as planned; in an unfinished run at most as many.
    """
    generated = plan.fresh is not None and (family in ALL or family in SEARCHED or MARK in family)
    most = plan.count * family_of(family).times if generated else 0
    most = min(most, border_search.MOST) if family in SEARCHED else most
    least = 0 if unfinished else most - sums.counts.get(Status.SKIPPED.value, 0)
    return (
        "" if least <= (sums.fresh or 0) <= most else f"{family} has {sums.fresh} fresh rows, but {most} were planned"
    )


def _of_failing(line: GroupLine, plan: ConformancePlan) -> str:
    """Return how the statuses for which a group fails the run contradict its counts; "" if they do not.

    The counts do not decide about a wrong answer if only false clears fail the run.
    """
    must = {name for name in (*_UNANSWERED, Status.UNDECIDED.value) if line.counts.get(name)}
    may = must | ({str(Status.WRONG.value)} if line.counts.get(Status.WRONG.value) else set())
    if plan.fail_on == "wrong" or line.family in INVALID_CONTENTS:
        must = may
    failing = line.failing or []
    if not must <= set(failing) <= may:
        return f"{line.family} fails for {sorted(failing)}, but by its counts for {sorted(must)}"
    return ""


def require_state(state: RunState, steps: Iterable[Step], plan: ConformancePlan, rules: JudgingRules) -> None:
    """Raise ValueError if no run with these steps can be in this state."""
    total = state.total
    waiting = _require_steps(state, steps)
    for trouble in (
        _of_allowance(state, plan),
        *(_of_pending(pending, waiting, rules) for pending in total.pending),
        *(_of_tally(family, tally, rules) for family, tally in total.tallies.items()),
        *(_of_fresh(family, tally, plan, unfinished=True) for family, tally in total.tallies.items()),
        _of_result(total, rules),
    ):
        if trouble:
            raise ValueError(trouble)
    places = [(pending.chunk.family, pending.chunk.seed, pending.chunk.start) for pending in total.pending]
    if len(set(places)) < len(places):
        raise ValueError("cases of one chunk are pending twice")


def _require_steps(state: RunState, steps: Iterable[Step]) -> list[CaseChunk]:
    """Return the chunks whose cases may be pending after the steps that are done.

    Raises ValueError unless all other cases of these steps are tallied.
    """
    counted = Counter({family: sum(tally.counts.values()) for family, tally in state.total.tallies.items()})
    for pending in state.total.pending:
        counted[pending.chunk.family] += len(pending.indices)
    done: Counter[str] = Counter()
    waiting: list[CaseChunk] = []
    number = 0
    for step in islice(steps, state.done):
        number += 1
        if isinstance(step, CaseChunk):
            done[step.family] += len(step)
            waiting.append(step)
            if done[step.family] > counted[step.family]:  # no step beyond the performed ones is generated
                break
        elif isinstance(step, (SearchStep, InvalidRows)):
            done[step.family] += len(step)
        else:
            waiting = [chunk for chunk in waiting if not step.asks(chunk)]
    trouble = _difference(counted, done)
    if trouble or number < state.done:
        raise ValueError(trouble or f"{state.done} steps are done, but there are only {number}")
    return waiting


def _difference(tallied: Mapping[str, int], planned: Mapping[str, int]) -> str:
    """Return a sentence about the first family whose number of tallied cases is not the planned one; "" if none is."""
    for family in sorted({*tallied, *planned}):
        counted, expected = tallied.get(family, 0), planned.get(family, 0)
        if counted != expected:
            return f"{counted} cases of {family} are tallied, but it has {expected}"
    return ""


def _of_allowance(state: RunState, plan: ConformancePlan) -> str:
    """Return how the restarts, faults and hangs that are left contradict the plan or the rows; "" if they do not."""
    left = state.left
    hangs = left.hangs is None or 0 <= left.hangs <= MAX_HANGS
    if not (0 <= left.restarts <= plan.limits.restarts and 0 <= left.faults <= MAX_FAULTS and hangs):
        return f"{left.restarts} restarts, {left.faults} faults and {left.hangs} hangs are left, which is impossible"
    stopped = any(tally.counts.get(Status.NOT_RUN.value) for tally in state.total.tallies.values())
    return "cases were not asked, though the implementation was not given up" if stopped and not left.over else ""


def _of_pending(pending: PendingRetest, waiting: Sequence[CaseChunk], rules: JudgingRules) -> str:
    """Return what is wrong with pending cases; "" if nothing is.

    They must be part of a planned chunk, and each must have an answer that the question allows.
    """
    chunk, indices = pending.chunk, pending.indices
    known = (*QUESTIONS[rules.criterion.question].answers, CANNOT_SAY)
    whole = [
        part.between(chunk.start - part.start, chunk.stop - part.start)
        for part in waiting
        if (part.family, part.seed) == (chunk.family, chunk.seed)
        and part.start <= chunk.start < chunk.stop <= part.stop
    ]
    if chunk not in whole or int(indices[0]) != 0 or int(indices[-1]) != len(chunk) - 1:
        return f"{chunk.family} has pending cases from {chunk.start} to {chunk.stop} that no step leaves pending"
    if not np.isin(pending.answers, known).all():
        return f"{chunk.family} has pending cases with answers that do not exist"
    return ""


Bins = Sequence[Sequence[int]]


def _of_sums(
    family: str, sums: GroupLine | Tally, octaves: Mapping[str, Mapping[str, int]], bins: tuple[Bins, Bins]
) -> str:
    """Return how the numbers about one family in a line or a tally contradict each other; "" if they do not."""
    counts = Counter(sums.counts)
    if not {*counts} <= {name.value for name in Status} or not {*sums.mistakes} <= {name.value for name in Mistake}:
        return f"{family} has a status or a mistake that does not exist"
    off, wrong = sum(counts[status.value] for status in _OFF), counts[Status.WRONG.value]
    skipped = counts[Status.SKIPPED.value]
    asked_agree = sums.asked == sum(counts.values()) - skipped and (sums.fresh or 0) <= sums.asked
    asked_agree = asked_agree and (sums.not_asked is UNSET or sum(sums.not_asked.values()) == skipped)
    answers = [number for row in (sums.answers or {}).values() for number in row.values()]
    asked_agree = asked_agree and (not answers or sum(answers) == sums.asked) and min(answers, default=0) >= 0
    if family in INVALID_CONTENTS:
        agree = not (sums.mistakes or answers or octaves or any(bins) or sums.worst)
    else:
        measured: Counter[str] = Counter()
        for counted in octaves.values():
            measured.update(counted)
        binned = {(sum(row[2] for row in rows), sum(row[3] for row in rows)) for rows in bins}
        agree = (
            sum(sums.mistakes.values()) == off
            and binned == {(sums.asked, sums.asked - counts[Status.RIGHT.value])}
            and all(0 <= row[3] <= row[2] for rows in bins for row in rows)
            and measured <= counts
            and measured.total() <= EXPONENTS_OF
            and len(sums.worst) == min(WORST_KEPT, off)
            and sum(case.status == Status.WRONG for case in sums.worst) == min(WORST_KEPT, wrong)
        )
    return (
        ""
        if asked_agree and agree
        else f"{family} has counts, mistakes, bins and worst cases that contradict each other"
    )


def _of_tally(family: str, tally: Tally, rules: JudgingRules) -> str:
    """Return how the tally of a family contradicts itself or the judgement of its kept cases now; "" if it does not."""
    counts = Counter(tally.counts)
    trouble = _of_sums(family, tally, tally.octaves, (tally.size_bins.as_lists(), tally.place_bins.as_lists()))
    if trouble:
        return trouble
    if tally.dangerous > min(
        counts[Status.WRONG.value], sum(tally.mistakes.get(mistake.value, 0) for mistake in DANGEROUS)
    ):
        return f"{family} has {tally.dangerous} false clears beyond the tolerance, more than it has wrong answers"
    faults = _UNANSWERED | ({Status.WRONG.value} if family in INVALID_CONTENTS else set())
    diagnosed = sum(explained.cases for explained in tally.explained)
    if diagnosed != (0 if family in INVALID_CONTENTS else sum(counts[status.value] for status in FAILING)):
        return f"{family} has causes of {diagnosed} wrong answers, but another number of these"
    kept = Counter(fault.status for fault in tally.faults)
    if kept != Counter({name: min(UNANSWERED_KEPT, counts[name]) for name in faults if counts[name]}):
        return f"{family} lists cases without an answer that its counts do not have"
    for case in tally.worst:
        if not _is_judged_so(case, rules):
            return f"{family} has a wrong answer to {case.case} that is judged otherwise now"
    return ""


def _is_judged_so(case: WorstCase, rules: JudgingRules) -> bool:
    """Judge a worst case again, and return whether the judgement equals the one in the record."""
    rows, answers = np.array([row_of(case)]), np.array([case.answer], dtype=np.int8)
    criterion, times = rules.criterion, None if case.time is None else np.array([case.time])
    wrong = np.flatnonzero(judge.is_amiss(rows, judge.truth_of(rows, criterion.layout), answers, times, criterion))
    for judged in judge.judged(rows, answers, wrong, criterion, times):
        status = Status.WRONG if case.status == Status.EXCUSED else Status(case.status)
        error = judge.measured(judged, criterion.question)
        recorded = (case.truth, case.mistake, status, case.error)
        return recorded == (int(judged.truth), judged.mistake.value, judged.status, error)
    return False


def _of_result(total: CasesResult, rules: JudgingRules) -> str:
    """Return how the numbers about all families together contradict each other; "" if they do not."""
    counts: Counter[str] = sum((Counter(tally.counts) for tally in total.tallies.values()), Counter())
    retest, known = total.retest, rules.known
    answered = total.pending or any(counts[status.value] for status in (Status.RIGHT, *_OFF, Status.ABSTAINED))
    outcomes = {outcome for outcome in _ENDED_AS if counts[outcome.label]} | ({Outcome.ANSWERED} if answered else set())
    if not outcomes <= total.outcomes:
        return "cases have a status with which no question ended"
    if retest.within + retest.beyond > retest.asked or retest.asked > counts.total():
        return f"{retest.asked} cases were asked again, but there are only {counts.total()}"
    if retest.beyond != counts[Status.NONDETERMINISTIC.value]:
        return f"{retest.beyond} answers changed, but {counts[Status.NONDETERMINISTIC.value]} are counted"
    excused = counts[Status.EXCUSED.value] > 0
    if excused != bool(total.excusing) or not total.excusing <= {*range(len(known))}:
        return "known failures excused cases that they do not cover"
    if not total.named <= {entry.case for entry in known}:
        return "it lists cases of known failures that no known failure names"
    return ""
