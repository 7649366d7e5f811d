"""A gating run: each implementation is asked everything, then some of it again; lines of the record come of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from hypcheck import groups, judge
from hypcheck.casebook import vectors
from hypcheck.casebook.families import select
from hypcheck.casebook.family import Family
from hypcheck.casebook.frozen import refusals
from hypcheck.errors import NothingJudgedError
from hypcheck.gate.cases import found_by_search, pieces
from hypcheck.gate.known_failures import KnownFailure, no_longer_failing, read_known_failures
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.trial import FAULTS_KEPT, Again, Judge, Sample, Tally, ask, ask_again
from hypcheck.judge import Criterion, Mistake, Status
from hypcheck.methods.description import Description
from hypcheck.methods.faults import Outcome, StartError
from hypcheck.methods.implementation import Implementation
from hypcheck.methods.opening import open_implementation
from hypcheck.pairs import REFUSED
from hypcheck.record import Recorder

OCTAVES_OF = 2000
"""Rows of a family whose own distance to the nearest other position is recorded; of those beyond, only wrong ones'."""

FATAL = (Status.ERROR, Status.CRASH, Status.TIMEOUT, Status.PROTOCOL, Status.NONDETERMINISTIC, Status.NOT_RUN)

Advance = Callable[[int], object]


@dataclass
class GateOutcome:
    """What decides how the run ends: reasons for the exit codes 5 and 1, and how many cases were judged at all."""

    not_started: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    judged: int = 0

    @property
    def exit_code(self) -> int:
        """5 where an implementation could not be started or broke the protocol throughout, 1 where one failed."""
        if self.not_started:
            return 5
        return 1 if self.failed else 0


def chosen(plan: GatePlan) -> tuple[Family, ...]:
    """The families of the plan. Raises InputError naming one that does not exist."""
    return select(plan.families)


def run(plan: GatePlan, recorder: Recorder, outcome: GateOutcome, advance: Advance) -> None:
    """Gate every implementation of the plan; `advance` is told each family that is finished.

    Raises NothingJudgedError where not one case was judged, which proves nothing.
    """
    families, listed = chosen(plan), _known(plan)
    for spec in plan.specs:
        try:
            implementation = open_implementation(
                spec, plan.limits, precision=plan.precision, question=plan.question, domain=plan.domain
            )
        except StartError as error:
            recorder.add("implementation", spec=spec, name=spec, started=False, trouble=str(error))
            outcome.not_started.append(str(error))
            advance(len(families))
            continue
        with implementation:
            _gate(implementation, plan, families, listed, recorder, outcome, advance)
    if not outcome.judged and not outcome.not_started:
        raise NothingJudgedError(
            "no case was judged: every one lies outside the domain, or cannot be written in the declared precision"
        )


def _known(plan: GatePlan) -> tuple[KnownFailure, ...]:
    return read_known_failures(plan.known_failures) if plan.known_failures is not None else ()


def _gate(
    implementation: Implementation,
    plan: GatePlan,
    families: Sequence[Family],
    listed: Sequence[KnownFailure],
    recorder: Recorder,
    outcome: GateOutcome,
    advance: Advance,
) -> None:
    description = implementation.description
    criterion = Criterion(description.question, description.precision, plan.tolerance)
    rules, sample, tallies = Judge(criterion, description.domain, listed), Sample(), []
    asked: set[str] = set()
    for family in families:
        tally = Tally(family.name)
        for piece in pieces(family, plan.seed, plan.count):
            ask(implementation, piece, rules, tally, sample)
        tallies.append(tally)
        asked.add(family.name)
        advance(1)
    for piece in () if plan.filtered else found_by_search():
        tally = Tally(piece.family)
        ask(implementation, piece, rules, tally, sample)
        tallies.append(tally)
        asked.add(piece.family)
    named = {entry.case for entry in listed if entry.case is not None}
    asked |= named & _names(tallies) if named else set()
    again = ask_again(implementation, sample, rules, plan.seed)
    lines = [_line(tally, criterion, plan) for tally in tallies]
    spec = implementation.spec.text
    if description.refuses:
        lines.append(_refusals(implementation, criterion))
    for line in lines:
        recorder.add(
            "group",
            method=description.name,
            spec=spec,
            title=description.name,
            exact=False,
            **line,
        )
    for sentence in no_longer_failing(listed, rules.used, asked):
        recorder.add("drift", sentence=f"{description.name}: {sentence}")
        outcome.failed.append(sentence)
    _conclude(implementation, description, lines, again, plan, recorder, outcome)


def _names(tallies: Sequence[Tally]) -> set[str]:
    """The ids of all cases that were asked."""
    return {piece.name(int(place)) for tally in tallies for piece, places, _, _ in tally.parts for place in places}


def _line(tally: Tally, criterion: Criterion, plan: GatePlan) -> dict[str, Any]:
    """One line of the record of all parts of a family."""
    offsets = np.cumsum([0, *(len(part[1]) for part in tally.parts)]).tolist()
    rows = np.concatenate([piece.rows[places] for piece, places, _, _ in tally.parts] or [np.empty((0, 7))])
    status = np.concatenate([part[2] for part in tally.parts] or [np.empty(0, dtype=object)])
    wrong = []
    for offset, (_, _, part_status, cases) in zip(offsets, tally.parts, strict=False):
        for case in cases:
            ended = Status(part_status[case.index])  # a known failure is excused, a changed answer no longer wrong
            if ended is not Status.NONDETERMINISTIC:
                wrong.append(replace(case, index=case.index + offset, status=ended))

    def name(index: int) -> str:
        part = int(np.searchsorted(offsets, index, side="right")) - 1
        piece, places, _, _ = tally.parts[part]
        return piece.name(int(places[index - offsets[part]]))

    kept = min(len(rows), OCTAVES_OF)
    octaves = judge.flip_octaves(rows[:kept])
    judged = groups.Judged(tally.family, rows, status, tuple(wrong), tally.skipped, name)
    fields = groups.line(judged, octaves, criterion)
    dangerous = any(case.status is Status.WRONG and case.mistake is Mistake.FALSE_CLEAR for case in wrong)
    failing = _failing(fields["counts"], wrong_fails=plan.fail_on == "wrong" or dangerous)
    return {**fields, "faults": tally.faults, "failing": failing}


def _refusals(implementation: Implementation, criterion: Criterion) -> dict[str, Any]:
    """The line about the invalid rows, for an implementation that says it refuses them: each must be answered 127."""
    file = vectors.load_refusals()
    answered = implementation.classify(file.rows)
    labels, faults = [], []
    for index, case in enumerate(file.cases):
        outcome, answer = Outcome(int(answered.status[index])), int(answered.answers[index])
        if outcome is not Outcome.ANSWERED:
            label, reason = outcome.label, answered.reasons.get(index, "")
        elif answer == REFUSED:
            label, reason = Status.REFUSED.value, ""
        else:
            label = Status.WRONG.value
            reason = f"answered {answer}; a row with an invalid {' and '.join(case.columns)} must be refused: {REFUSED}"
        labels.append(label)
        if reason:
            faults.append(
                {"case": case.id, "row": [float(v).hex() for v in case.row], "status": label, "reason": reason}
            )
    counts = {name: labels.count(name) for name in sorted(set(labels))}
    empty: dict[str, Any] = {"mistakes": {}, "octaves": {}, "size_bins": [], "place_bins": [], "worst": []}
    failing = {"failing": _failing(counts, wrong_fails=True)}
    told = {"question": criterion.question, "precision": criterion.precision, "family": refusals.NAME}
    return {**told, "asked": len(labels), "counts": counts, **empty, "faults": faults[:FAULTS_KEPT], **failing}


def _failing(counts: Mapping[str, int], *, wrong_fails: bool) -> list[str]:
    """The statuses of a family's cases that fail the run."""
    grave = (Status.WRONG, *FATAL) if wrong_fails else FATAL
    return [status.value for status in grave if counts.get(status.value)]


def _conclude(
    implementation: Implementation,
    description: Description,
    lines: Sequence[dict[str, Any]],
    again: Again,
    plan: GatePlan,
    recorder: Recorder,
    outcome: GateOutcome,
) -> None:
    """The line about the implementation as a whole, and what it means for the exit code."""
    name, spec = description.name, implementation.spec.text
    troubles = list(_troubles(name, lines, again, plan))
    if implementation.broke_protocol_throughout:
        outcome.not_started.append(f"{spec} broke the protocol throughout")
    outcome.failed += [f"{name} on {line['family']}: {status}" for line in lines for status in line["failing"]]
    outcome.failed += troubles
    outcome.judged += sum(line["asked"] for line in lines)
    recorder.add(
        "implementation",
        spec=spec,
        name=name,
        started=True,
        declared=asdict(implementation.declared),
        used=asdict(description),
        restarts=implementation.restarts,
        again=asdict(again),
        broke_protocol_throughout=implementation.broke_protocol_throughout,
        troubles=troubles,
    )


def _troubles(name: str, lines: Sequence[dict[str, Any]], again: Again, plan: GatePlan) -> Iterator[str]:
    """What fails an implementation as a whole and no family of its own."""
    abstained = sum(line["counts"].get(Status.ABSTAINED.value, 0) for line in lines)
    if abstained > plan.max_abstained:
        yield f"{name} abstained from {abstained} cases; at most {plan.max_abstained} are allowed"
    if plan.deterministic and again.within:
        yield f"{name} changed {again.within} answers within the tolerance when asked again"
