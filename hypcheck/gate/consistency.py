"""Whether what a record says of a run can be true: its numbers against each other, and against what was planned.

The checksums of a record are no protection from whoever edits it. So nothing that is read back is taken for more than a
claim: each number is bounded before it is used, sums must agree, and every case that was planned must be tallied.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from hypcheck import judge
from hypcheck.casebook import fixed_sizes, vectors
from hypcheck.casebook.frozen import refusals
from hypcheck.errors import Exit, HypcheckError
from hypcheck.gate.chunks import OCTAVES_OF, Chunk
from hypcheck.gate.conformance import Invalid, Rules
from hypcheck.gate.plan import GatePlan, planned
from hypcheck.gate.results import PendingRetest, Result
from hypcheck.gate.schedule import State, Step
from hypcheck.judge import UNANSWERED, Mistake, Status
from hypcheck.methods.faults import Outcome
from hypcheck.methods.implementation import FAULTS
from hypcheck.methods.questions import allowed
from hypcheck.methods.runs import HANGS
from hypcheck.record import Line
from hypcheck.record.lines import Group, Implementation
from hypcheck.rows import CANNOT_SAY
from hypcheck.tally import FAULTS_KEPT, WORST_KEPT, Tally, Worst
from hypcheck.truth import batch

_OFF = (Status.WRONG, Status.TOLERATED, Status.EXCUSED)
_ENDED_AS = tuple(outcome for outcome in Outcome if outcome is not Outcome.ANSWERED)
_UNANSWERED = frozenset(status.value for status in UNANSWERED)


class MissingCasesError(HypcheckError):
    """A run whose tallies do not hold the cases that were planned; it proves nothing, whatever they say."""

    exit_code = Exit.INTERNAL


def require_all_tallied(tallies: Mapping[str, Tally], cases: Mapping[str, int]) -> None:
    """Raise MissingCasesError where the tallies of a finished run do not hold just these cases."""
    told = {family: sum(tally.counts.values()) for family, tally in tallies.items()}
    trouble = _difference(told, cases)
    if trouble:
        raise MissingCasesError(f"{trouble}; this run proves nothing")


def require_lines(lines: Sequence[Line], whole: Implementation, plan: GatePlan) -> None:
    """Raise ValueError where the lines about an implementation that was asked to its end cannot be true.

    `whole` is the one about the implementation as a whole.
    """
    groups = [line for line in lines if isinstance(line, Group)]
    told = {line.family: sum(line.counts.values()) for line in groups}
    if len(told) < len(groups):
        raise ValueError("a family has two lines")
    of_its_own = {family: plan.count for family in told if fixed_sizes.MARK in family and not plan.filtered}
    refuses = refusals.NAME in told
    trouble = _difference(told, planned(plan, refuses=refuses) | of_its_own)
    for line in groups:
        trouble = trouble or _of_sums(line.family, _Sums.of_line(line)) or _of_failing(line, plan)
    if trouble or _lacks_trouble(whole, groups, plan):
        raise ValueError(trouble or "it abstained, or changed answers, more than it may, and nothing says so")


def _lacks_trouble(whole: Implementation, groups: Sequence[Group], plan: GatePlan) -> bool:
    """Whether what fails the implementation as a whole is missing from its line."""
    abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in groups) > plan.max_abstained
    changed = plan.deterministic and whole.again.within > 0
    return bool(abstained or changed) and not whole.troubles


def _of_failing(line: Group, plan: GatePlan) -> str:
    """What a group says that fails the run must be what its counts say, as far as they tell."""
    must = {name for name in _UNANSWERED if line.counts.get(name)}
    may = must | ({str(Status.WRONG.value)} if line.counts.get(Status.WRONG.value) else set())
    if plan.fail_on == "wrong" or line.family == refusals.NAME:
        must = may
    failing = line.failing or []
    if not must <= set(failing) <= may:
        return f"{line.family} fails for {sorted(failing)}, and its counts say {sorted(must)}"
    return ""


def require_state(state: State, steps: Iterable[Step], plan: GatePlan, rules: Rules) -> None:
    """Raise ValueError where no run that does these steps can be in this state."""
    total = state.total
    waiting = _require_steps(state, steps)
    for trouble in (
        _of_allowance(state, plan),
        *(_of_open(each, waiting, rules) for each in total.open),
        *(_of_tally(family, tally, rules) for family, tally in total.tallies.items()),
        _of_result(total, rules),
    ):
        if trouble:
            raise ValueError(trouble)
    places = [(each.chunk.family, each.chunk.seed, each.chunk.start) for each in total.open]
    if len(set(places)) < len(places):
        raise ValueError("cases of one chunk are open twice")


def _require_steps(state: State, steps: Iterable[Step]) -> list[Chunk]:
    """The chunks whose cases may be open after the steps that are done, whose other cases must all be tallied."""
    told = Counter({family: sum(tally.counts.values()) for family, tally in state.total.tallies.items()})
    for each in state.total.open:
        told[each.chunk.family] += len(each.indices)
    done: Counter[str] = Counter()
    waiting: list[Chunk] = []
    number = 0
    for step in islice(steps, state.done):
        number += 1
        if isinstance(step, Chunk):
            done[step.family] += len(step)
            waiting.append(step)
            if done[step.family] > told[step.family]:  # so that no more steps are counted than were done
                break
        elif isinstance(step, Invalid):
            done[refusals.NAME] += len(vectors.load_refusals().rows)
        else:
            waiting = [chunk for chunk in waiting if chunk.part != step.part]
    trouble = _difference(told, done)
    if trouble or number < state.done:
        raise ValueError(trouble or f"{state.done} steps are done, of {number} that there are")
    return waiting


def _difference(told: Mapping[str, int], cases: Mapping[str, int]) -> str:
    for family in sorted({*told, *cases}):
        if told.get(family, 0) != cases.get(family, 0):
            return f"{family} has {told.get(family, 0)} cases tallied, of {cases.get(family, 0)} that there are"
    return ""


def _of_allowance(state: State, plan: GatePlan) -> str:
    left = state.left
    hangs = left.hangs is None or 0 <= left.hangs <= HANGS
    if not (0 <= left.restarts <= plan.limits.restarts and 0 <= left.faults <= FAULTS and hangs):
        return f"it may cost {left.restarts} restarts, {left.faults} faults and {left.hangs} hangs more"
    stopped = any(tally.counts.get(Status.NOT_RUN.value) for tally in state.total.tallies.values())
    return "cases were not asked, though it may be asked" if stopped and not left.over else ""


def _of_open(each: PendingRetest, waiting: Sequence[Chunk], rules: Rules) -> str:
    """Of a planned chunk, trimmed to its open cases, each of which has an answer that the question allows."""
    chunk, indices = each.chunk, each.indices
    known = (*allowed(rules.criterion.question), CANNOT_SAY)
    whole = [
        part.between(chunk.start - part.start, chunk.stop - part.start)
        for part in waiting
        if (part.family, part.seed) == (chunk.family, chunk.seed)
        and part.start <= chunk.start < chunk.stop <= part.stop
    ]
    if chunk not in whole or int(indices[0]) != 0 or int(indices[-1]) != len(chunk) - 1:
        return f"{chunk.family} has open cases from {chunk.start} to {chunk.stop} that no step leaves open"
    if not np.isin(each.answers, known).all():
        return f"{chunk.family} has open cases with answers that do not exist"
    return ""


@dataclass(frozen=True)
class _Sums:
    """What a tally and a line about a family both have."""

    asked: int
    counts: Mapping[str, int]
    mistakes: Mapping[str, int]
    octaves: Mapping[str, Mapping[str, int]]
    bins: tuple[Sequence[Sequence[int]], ...]
    worst: tuple[str, ...]
    """The statuses of the worst cases."""

    @classmethod
    def of_line(cls, line: Group) -> _Sums:
        statuses = tuple(case.status for case in line.worst)
        bins = (line.size_bins, line.place_bins)
        return cls(line.asked, line.counts, line.mistakes, line.octaves, bins, statuses)

    @classmethod
    def of_tally(cls, tally: Tally) -> _Sums:
        statuses = tuple(case.status for case in tally.worst)
        bins = (tally.size_bins.as_lists(), tally.place_bins.as_lists())
        return cls(tally.asked, tally.counts, tally.mistakes, tally.octaves, bins, statuses)


def _of_sums(family: str, sums: _Sums) -> str:
    """Whether the numbers about one family agree with each other."""
    counts = Counter(sums.counts)
    if not {*counts} <= {each.value for each in Status} or not {*sums.mistakes} <= {each.value for each in Mistake}:
        return f"{family} has a status or a mistake that does not exist"
    off, wrong = sum(counts[each.value] for each in _OFF), counts[Status.WRONG.value]
    asked = sums.asked == sum(counts.values()) - counts[Status.SKIPPED.value]
    if family == refusals.NAME:
        agree = not (sums.mistakes or sums.octaves or any(sums.bins) or sums.worst)
    else:
        measured: Counter[str] = Counter()
        for octave in sums.octaves.values():
            measured.update(octave)
        binned = {(sum(row[2] for row in rows), sum(row[3] for row in rows)) for rows in sums.bins}
        agree = (
            sum(sums.mistakes.values()) == off
            and binned == {(sums.asked, sums.asked - counts[Status.RIGHT.value])}
            and all(0 <= row[3] <= row[2] for rows in sums.bins for row in rows)
            and measured <= counts
            and measured.total() <= OCTAVES_OF
            and len(sums.worst) == min(WORST_KEPT, off)
            and sums.worst.count(Status.WRONG.value) == min(WORST_KEPT, wrong)
        )
    return "" if asked and agree else f"{family} has counts, mistakes, bins and worst cases that contradict each other"


def _of_tally(family: str, tally: Tally, rules: Rules) -> str:
    counts = Counter(tally.counts)
    trouble = _of_sums(family, _Sums.of_tally(tally))
    if trouble:
        return trouble
    if tally.dangerous > min(counts[Status.WRONG.value], tally.mistakes.get(Mistake.FALSE_CLEAR.value, 0)):
        return f"{family} has {tally.dangerous} false clears beyond the tolerance, more than wrong answers"
    faults = _UNANSWERED | ({Status.WRONG.value} if family == refusals.NAME else set())
    kept = Counter(fault.status for fault in tally.faults)
    if kept != Counter({name: min(FAULTS_KEPT, counts[name]) for name in faults if counts[name]}):
        return f"{family} has cases without an answer that its counts do not have"
    for case in tally.worst:
        if not _is_so(case, rules):
            return f"{family} has a wrong answer to {case.case} that is another one when it is judged"
    return ""


def _is_so(case: Worst, rules: Rules) -> bool:
    """Whether a worst case is judged now as the record has it."""
    rows, answers = np.array([case.row]), np.array([case.answer], dtype=np.int8)
    truth = batch.positions(rows)
    for judged in judge.wrong_cases(rows, truth, answers, rules.criterion):
        status = Status.WRONG if case.status == Status.EXCUSED else Status(case.status)
        told = (case.truth, case.mistake, status, case.error)
        error = judge.measured(judged, rules.criterion.question)
        return told == (int(judged.truth), judged.mistake.value, judged.status, error)
    return False


def _of_result(total: Result, rules: Rules) -> str:
    """What is told of all families together."""
    counts: Counter[str] = sum((Counter(tally.counts) for tally in total.tallies.values()), Counter())
    again, known = total.again, rules.known
    answered = total.open or any(counts[each.value] for each in (Status.RIGHT, *_OFF, Status.ABSTAINED))
    outcomes = {outcome for outcome in _ENDED_AS if counts[outcome.label]} | ({Outcome.ANSWERED} if answered else set())
    if not outcomes <= total.outcomes:
        return "cases ended in a way in which no question ended"
    if again.within + again.beyond > again.asked or again.asked > counts.total():
        return f"{again.asked} cases were asked again, of {counts.total()}"
    if again.beyond != counts[Status.NONDETERMINISTIC.value]:
        return f"{again.beyond} answers changed, and {counts[Status.NONDETERMINISTIC.value]} are counted"
    excused = counts[Status.EXCUSED.value] > 0
    if excused != bool(total.excusing) or not total.excusing <= {*range(len(known))}:
        return "known failures excused what they do not cover"
    if not total.named <= {entry.case for entry in known}:
        return "known failures name cases that they do not name"
    return ""
