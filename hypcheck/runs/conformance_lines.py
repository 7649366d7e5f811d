"""The lines of a conformance run in its record: made from its state, and checked for consistency when it is resumed.

What a run came to, as lines of the record, and what it means for the exit code.

Whether what a record says of a run can be true: its numbers against each other, and against what was planned.

The checksums of a record are no protection from whoever edits it. So nothing that is read back is taken for more than a
claim: each number is bounded before it is used, sums must agree, and every case that was planned must be tallied.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import islice

import numpy as np
from msgspec import UNSET

from hypcheck.errors import Exit, HypcheckError, NothingJudgedError, RunOutcome
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import Description, allowed
from hypcheck.implementations.implementation import FAULTS
from hypcheck.implementations.session import HANGS, Outcome
from hypcheck.record import Recorder, RecordLine, lines
from hypcheck.record.fields import decoded
from hypcheck.record.lines import DriftLine, GroupLine, ImplementationLine, NotStartedLine
from hypcheck.runs import judge, tally
from hypcheck.runs.cases import EXPONENTS_OF, CaseChunk
from hypcheck.runs.judge import UNANSWERED, Mistake, Status
from hypcheck.runs.known_failures import no_longer_failing
from hypcheck.runs.plan import ConformancePlan, planned_cases
from hypcheck.runs.results import CasesResult, InvalidRows, JudgingRules, PendingRetest, merged_result
from hypcheck.runs.retest import result_without_retest
from hypcheck.runs.schedule import RunState, Step
from hypcheck.runs.tally import FAULTS_KEPT, WORST_KEPT, Tally, WorstCase
from hypcheck.truth import float_filter
from hypcheck.vectors import families, frozen


def recorded_description(description: Description) -> lines.DescriptionPart:
    """What an implementation says of itself, as the record has it."""
    return decoded(asdict(description), lines.DescriptionPart)


def outcome_of(recorded: Iterable[RecordLine], outcome: RunOutcome) -> None:
    """Add the reasons that the lines of a run tell, which are all that there are.

    Raises NothingJudgedError where not one case was judged, which proves nothing.
    """
    judged = 0
    not_started, failed = outcome.because[Exit.NOT_STARTED], outcome.because[Exit.WRONG]
    for line in recorded:
        if isinstance(line, GroupLine):
            judged += line.asked
            failed += [f"{line.method} on {line.family}: {status}" for status in line.failing or ()]
        elif isinstance(line, DriftLine):
            failed.append(line.sentence)
        elif isinstance(line, NotStartedLine):
            not_started.append(line.trouble)
        elif isinstance(line, ImplementationLine):
            if line.broke_protocol_throughout:
                not_started.append(f"{line.spec} broke the protocol throughout")
            failed += line.troubles
    if not judged and not not_started:
        raise NothingJudgedError(
            "no case was judged: every one lies outside the domain, or cannot be written in the declared precision"
        )


@dataclass(frozen=True)
class ImplementationLines:
    """Makes the lines about one implementation, which was opened by `spec` and judged by the rules."""

    plan: ConformancePlan
    spec: str
    declared: Description
    used: Description
    rules: JudgingRules

    def add(self, state: RunState, recorder: Recorder, *, finished: bool) -> None:
        """Record the state; where the run is not finished, open cases are judged as they were answered."""
        total = merged_result([replace(state.total, open=()), result_without_retest(state.total.open, self.rules)])
        found = [self._group(family, tallied) for family, tallied in total.tallies.items()]
        for line in found:
            recorder.add(line)
        if finished:
            for sentence in no_longer_failing(self.rules.known, total.excusing, {*total.tallies, *total.named}):
                recorder.add(DriftLine(sentence=f"{self.used.name}: {sentence}"))
        self._conclude(state, total, found, recorder, finished=finished)

    def _group(self, family: str, tallied: Tally) -> GroupLine:
        wrong_fails = self.plan.fail_on == "wrong" or tallied.dangerous > 0 or family == frozen.INVALID_NAME
        grave = (Status.WRONG, *UNANSWERED) if wrong_fails else UNANSWERED
        failing = [status.value for status in grave if tallied.counts.get(status.value)]
        name = self.used.name
        return tally.group_line(
            tallied, family, self.rules.criterion, method=name, title=name, spec=self.spec, failing=failing
        )

    def _conclude(
        self, state: RunState, total: CasesResult, found: Sequence[GroupLine], recorder: Recorder, *, finished: bool
    ) -> None:
        """The line about the implementation as a whole."""
        recorder.add(
            ImplementationLine(
                spec=self.spec,
                name=self.used.name,
                declared=recorded_description(self.declared),
                used=recorded_description(self.used),
                restarts=self.plan.limits.restarts - state.left.restarts,
                again=total.again,
                broke_protocol_throughout=total.broke_protocol_throughout,
                troubles=list(self._troubles(total, found)),
                finished=UNSET if finished else False,
            )
        )

    def _troubles(self, total: CasesResult, found: Sequence[GroupLine]) -> Iterator[str]:
        """What fails an implementation as a whole and no family of its own."""
        abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in found)
        if abstained > self.plan.max_abstained:
            allowed = f"at most {self.plan.max_abstained} are allowed"
            yield f"{self.used.name} abstained from {abstained} cases; {allowed}"
        if self.plan.deterministic and total.again.within:
            changed = f"changed {total.again.within} answers within the tolerance"
            yield f"{self.used.name} {changed} when asked again"


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


def require_lines(lines: Sequence[RecordLine], whole: ImplementationLine, plan: ConformancePlan) -> None:
    """Raise ValueError where the lines about an implementation that was asked to its end cannot be true.

    `whole` is the one about the implementation as a whole.
    """
    groups = [line for line in lines if isinstance(line, GroupLine)]
    told = {line.family: sum(line.counts.values()) for line in groups}
    if len(told) < len(groups):
        raise ValueError("a family has two lines")
    of_its_own = {family: plan.count for family in told if families.MARK in family and not plan.filtered}
    refuses = frozen.INVALID_NAME in told
    trouble = _difference(told, planned_cases(plan, refuses=refuses) | of_its_own)
    for line in groups:
        trouble = trouble or _of_sums(line.family, _Sums.of_line(line)) or _of_failing(line, plan)
    if trouble or _lacks_trouble(whole, groups, plan):
        raise ValueError(trouble or "it abstained, or changed answers, more than it may, and nothing says so")


def _lacks_trouble(whole: ImplementationLine, groups: Sequence[GroupLine], plan: ConformancePlan) -> bool:
    """Whether what fails the implementation as a whole is missing from its line."""
    abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in groups) > plan.max_abstained
    changed = plan.deterministic and whole.again.within > 0
    return bool(abstained or changed) and not whole.troubles


def _of_failing(line: GroupLine, plan: ConformancePlan) -> str:
    """What a group says that fails the run must be what its counts say, as far as they tell."""
    must = {name for name in _UNANSWERED if line.counts.get(name)}
    may = must | ({str(Status.WRONG.value)} if line.counts.get(Status.WRONG.value) else set())
    if plan.fail_on == "wrong" or line.family == frozen.INVALID_NAME:
        must = may
    failing = line.failing or []
    if not must <= set(failing) <= may:
        return f"{line.family} fails for {sorted(failing)}, and its counts say {sorted(must)}"
    return ""


def require_state(state: RunState, steps: Iterable[Step], plan: ConformancePlan, rules: JudgingRules) -> None:
    """Raise ValueError where no run that does these steps can be in this state."""
    total = state.total
    waiting = _require_steps(state, steps)
    for trouble in (
        _of_allowance(state, plan),
        *(_of_open(each, waiting, rules) for each in total.open),
        *(_of_tally(family, each, rules) for family, each in total.tallies.items()),
        _of_result(total, rules),
    ):
        if trouble:
            raise ValueError(trouble)
    places = [(each.chunk.family, each.chunk.seed, each.chunk.start) for each in total.open]
    if len(set(places)) < len(places):
        raise ValueError("cases of one chunk are open twice")


def _require_steps(state: RunState, steps: Iterable[Step]) -> list[CaseChunk]:
    """The chunks whose cases may be open after the steps that are done, whose other cases must all be tallied."""
    told = Counter({family: sum(tally.counts.values()) for family, tally in state.total.tallies.items()})
    for each in state.total.open:
        told[each.chunk.family] += len(each.indices)
    done: Counter[str] = Counter()
    waiting: list[CaseChunk] = []
    number = 0
    for step in islice(steps, state.done):
        number += 1
        if isinstance(step, CaseChunk):
            done[step.family] += len(step)
            waiting.append(step)
            if done[step.family] > told[step.family]:  # so that no more steps are counted than were done
                break
        elif isinstance(step, InvalidRows):
            done[frozen.INVALID_NAME] += len(frozen.load_invalid_rows().rows)
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


def _of_allowance(state: RunState, plan: ConformancePlan) -> str:
    left = state.left
    hangs = left.hangs is None or 0 <= left.hangs <= HANGS
    if not (0 <= left.restarts <= plan.limits.restarts and 0 <= left.faults <= FAULTS and hangs):
        return f"it may cost {left.restarts} restarts, {left.faults} faults and {left.hangs} hangs more"
    stopped = any(tally.counts.get(Status.NOT_RUN.value) for tally in state.total.tallies.values())
    return "cases were not asked, though it may be asked" if stopped and not left.over else ""


def _of_open(each: PendingRetest, waiting: Sequence[CaseChunk], rules: JudgingRules) -> str:
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
    def of_line(cls, line: GroupLine) -> _Sums:
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
    if family == frozen.INVALID_NAME:
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
            and measured.total() <= EXPONENTS_OF
            and len(sums.worst) == min(WORST_KEPT, off)
            and sums.worst.count(Status.WRONG.value) == min(WORST_KEPT, wrong)
        )
    return "" if asked and agree else f"{family} has counts, mistakes, bins and worst cases that contradict each other"


def _of_tally(family: str, tally: Tally, rules: JudgingRules) -> str:
    counts = Counter(tally.counts)
    trouble = _of_sums(family, _Sums.of_tally(tally))
    if trouble:
        return trouble
    if tally.dangerous > min(counts[Status.WRONG.value], tally.mistakes.get(Mistake.FALSE_CLEAR.value, 0)):
        return f"{family} has {tally.dangerous} false clears beyond the tolerance, more than wrong answers"
    faults = _UNANSWERED | ({Status.WRONG.value} if family == frozen.INVALID_NAME else set())
    kept = Counter(fault.status for fault in tally.faults)
    if kept != Counter({name: min(FAULTS_KEPT, counts[name]) for name in faults if counts[name]}):
        return f"{family} has cases without an answer that its counts do not have"
    for case in tally.worst:
        if not _is_so(case, rules):
            return f"{family} has a wrong answer to {case.case} that is another one when it is judged"
    return ""


def _is_so(case: WorstCase, rules: JudgingRules) -> bool:
    """Whether a worst case is judged now as the record has it."""
    rows, answers = np.array([case.row]), np.array([case.answer], dtype=np.int8)
    truth = float_filter.positions(rows)
    for judged in judge.wrong_cases(rows, truth, answers, rules.criterion):
        status = Status.WRONG if case.status == Status.EXCUSED else Status(case.status)
        told = (case.truth, case.mistake, status, case.error)
        error = judge.measured(judged, rules.criterion.question)
        return told == (int(judged.truth), judged.mistake.value, judged.status, error)
    return False


def _of_result(total: CasesResult, rules: JudgingRules) -> str:
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
