"""A replay of one case with one implementation: the truth, the answer, its error, and the wrong step of its formula.

CASE on the command line is the id of a case, the numbers of a position or a sweep, or a case that a record has kept.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hypcheck.answer import proved
from hypcheck.errors import InputError
from hypcheck.geometry.pair import (
    AXIS,
    COLUMNS,
    END,
    HEIGHTS,
    REFUSED,
    Pair,
    Position,
    trouble_with_row,
)
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, SWEEPS, Layout, Row, layout_with
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import representable
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.spec import begins_as_spec
from hypcheck.record import read
from hypcheck.record.fields import layout_of, numbers_of
from hypcheck.record.reader import file_of, recorded_cases
from hypcheck.runs import judge
from hypcheck.runs.causes import AnsweredRows, Cause, Scope
from hypcheck.runs.intermediates import FormulaChoice, choose_formula
from hypcheck.runs.judge import Criterion, Mistake, Status, WrongCase
from hypcheck.runs.place_causes import PLACES, WIDER_ROUNDINGS
from hypcheck.runs.score import Score, score, status_of
from hypcheck.runs.tally import STATUSES
from hypcheck.tables.numbers import number_of_text
from hypcheck.truth import backward_error, exact
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.kinds import Kind
from hypcheck.truth.passage_error import HIT, passage_of, radii_off
from hypcheck.truth.swept import Passage
from hypcheck.vectors.draw import MARK
from hypcheck.vectors.families import is_extreme, parse_case_id
from hypcheck.vectors.invalid_rows import columns_at_fault
from hypcheck.vectors.showing import case_named

_RECORDED = re.compile(r"(.+):([0-9]+)", re.ASCII | re.DOTALL)
_HEXADECIMAL = re.compile(r"[ \t]*[+-]?0x", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class ReplayCase:
    """A row to replay and its name; the row may be invalid. `layout` is its layout, None if the text leaves it open."""

    name: str
    row: Row
    layout: Layout | None = None

    @property
    def at_fault(self) -> tuple[str, ...]:
        """The columns that make the row invalid, so that it must be refused; empty for a valid row."""
        return columns_at_fault(self.row, (self.layout or PAIRS).columns(len(self.row)))


def case_of(text: str) -> ReplayCase:
    """Return the case that `text` names: ring-0007, ring/1/42/7, "2,5,1,1,3,0,0" in decimals or 0x1p+1 …, or RECORD:N.

    RECORD:N is the N-th case of a record.jsonl or of its folder, as reports number them (recorded_cases). The row is as
    it was asked: a zero keeps its sign. Raises InputError with the error in the text.
    """
    if begins_as_spec(text):
        raise InputError(f"CASE is {text!r}, which is a SPEC; the order is replay CASE SPEC and minimise SPEC CASE")
    recorded = _RECORDED.fullmatch(text)
    if recorded is not None:
        return _from_record(Path(recorded[1]), int(recorded[2][:19]))
    if "," in text and MARK not in text:  # the names of families with fixed sizes have commas
        return ReplayCase("the given row", _given_row(text))
    if "/" in text:
        case = parse_case_id(text)
        return ReplayCase(text, case.family.row(case.seed, case.index), case.family.layout)
    vector, content = case_named(text)
    return ReplayCase(text, vector.row, layout_with(content.groups))


def _from_record(path: Path, number: int) -> ReplayCase:
    """Return the case with this number in a record. Raises InputError if there is none."""
    cases = recorded_cases(read(file_of(path)))
    if not 1 <= number <= len(cases):
        there = f"they are 1 to {len(cases)}" if cases else "it has none"
        raise InputError(f"{path} has no case {number}; {there}")
    case = cases[number - 1].case
    try:
        row = tuple(map(float.fromhex, numbers_of(case)))
    except OverflowError:
        raise InputError(f"{path}: case {number} has a number that is too large for float64") from None
    return ReplayCase(case.case, row, layout_of(case))


def _given_row(text: str) -> Row:
    """Read a row: 7, 10 or 13 numbers of a pair, or 10, 13 or 16 of a sweep, decimal or hexadecimal.

    of_question checks them together. If one of thirteen numbers is infinite, the last three are heights.
    """
    parts = text.split(",")
    if len(parts) not in (*PAIRS.widths, *SWEEPS.widths):
        wanted = (
            f"7: {', '.join(COLUMNS)}; or 10, with {', '.join(AXIS)}; "
            f"or 13, with {', '.join(HEIGHTS)} behind these; "
            f"a sweep has {', '.join(END)} after z, so it has 10, 13 with an axis, or 16 with heights too"
        )
        raise InputError(f"the row {text!r} has {len(parts)} numbers; it must have {wanted}")
    ended = any(part.strip().lower().lstrip("+-").startswith("inf") for part in parts)
    layout = SWEEPS if PAIRS.has_heights(parts) and (SWEEPS.has_heights(parts) or not ended) else PAIRS
    return tuple(_number(name, part) for name, part in zip(layout.columns(len(parts)), parts, strict=True))


def _number(name: str, text: str) -> float:
    """Read a number, decimal or hexadecimal. Raises InputError that names the column."""
    try:
        return float.fromhex(text) if _HEXADECIMAL.match(text) else number_of_text(name, text)
    except OverflowError:
        raise InputError(f"{name} is {text.strip()!r}, which is too large for float64") from None
    except ValueError as trouble:
        why = f"{name} is {text!r}; it must be a number such as 2.5 or 0x1.4p+1"
        raise InputError(why if _HEXADECIMAL.match(text) else str(trouble)) from None


REPEATED_ROWS = 33
"""The number of copies of the row in a batch, after a test of the row alone; odd, so that vector loops have a tail."""


@dataclass(frozen=True, slots=True)
class ProvedTruth:
    """The exact decision about a pair, its proof, and the flip distance to each other position.

    A flip distance is the least relative change of the inputs that leads to that position. For a tilted spheroid it is
    given by two proved bounds.
    """

    pair: Pair
    decision: Decision
    certificate: Certificate
    flips: Mapping[Position, float | tuple[float, float]]

    @property
    def kind(self) -> Kind | None:
        """The kind of its roots; None if the spheroid is tilted."""
        return self.decision.kind


@dataclass(frozen=True, slots=True)
class ReplayJudgement:
    """The status of the case. `answer` is None if there was none; `reason` then says why, or explains the status.

    `mistake`, `error` (the backward error) and `error_u` (the same in units u) describe a wrong answer, tolerated or
    not; otherwise they are None, 0 and 0. `time` is the answered time of a sweep's first contact, if there is one, and
    `radii` is its error in spheroid radii of the sweep.
    """

    status: Status
    answer: int | None
    reason: str = ""
    mistake: Mistake | None = None
    error: float = 0.0
    error_u: float = 0.0
    time: float | None = None
    radii: float = 0.0

    @property
    def passes(self) -> bool:
        """Whether it is right or within the tolerance."""
        return self.status in (Status.RIGHT, Status.TOLERATED, Status.REFUSED)


@dataclass(frozen=True, slots=True)
class Replay:
    """The result of a replay; `truth` is None for an invalid row, and `choice` is None if no formula takes the row.

    `skipped` says why a conformance run would not ask the row. `causes` are those about places that explain a wrong
    answer about an upright spheroid.
    """

    case: ReplayCase
    spec: str
    declared: Description
    used: Description
    criterion: Criterion
    truth: ProvedTruth | Passage | None
    judgement: ReplayJudgement
    skipped: str | None = None
    choice: FormulaChoice | None = None
    causes: tuple[Cause, ...] = ()


def replay(case: ReplayCase, implementation: Implementation, criterion: Criterion, formula: str | None) -> Replay:
    """Test a case, judge the answer, and compare it with a formula.

    Raises InputError if the row has not the question's layout, or no formula takes it.

    An invalid row is tested if it is a frozen vector, and the implementation promises to refuse invalid rows. Raises
    DisagreementError if the proof of the truth does not hold.
    """
    declared, used = implementation.declared, implementation.description
    case = of_question(case, used)
    layout = used.asked.layout
    require_taken(case, used)
    known = (case, str(implementation.spec), declared, used, criterion)
    if case.at_fault:
        return Replay(*known, None, _refused(case, implementation))
    truth = passage_of(case.row) if layout.has_end else truth_of(Pair.from_row(case.row))
    judgement = _judged(implementation, case.row, truth, criterion)
    choice, causes = None, tuple[Cause, ...]()
    if isinstance(truth, ProvedTruth) and truth.pair.is_upright and not truth.pair.has_ends:
        causes = _causes(truth, judgement, criterion)
        answered = None if judgement.answer == CANNOT_SAY else judgement.answer
        choice = choose_formula(implementation, answered, truth.pair.row, truth.decision.position, formula)
    elif formula is not None:
        ended = isinstance(truth, ProvedTruth) and truth.pair.has_ends
        about = "a sweep" if layout.has_end else "a hyperboloid that ends" if ended else "a tilted spheroid"
        raise InputError(f"--formula is {formula!r}, but {case.name} is about {about}, which no formula takes")
    return Replay(*known, truth, judgement, _skipped(case, used, criterion), choice, causes)


def of_question(case: ReplayCase, used: Description) -> ReplayCase:
    """Return the case with the question's layout.

    Raises InputError if it has another layout, or a given row is invalid.
    """
    layout = used.asked.layout
    if case.layout not in (None, layout) or len(case.row) not in layout.widths:
        this = "a position" if layout.has_end else "a sweep between two positions"
        raise InputError(f"{case.name} is {this}, and {used.name} answers {used.question!r}")
    if case.layout is None and (trouble := trouble_with_row(case.row, layout.upright)) is not None:
        raise InputError(trouble)
    return replace(case, layout=layout)


def require_taken(case: ReplayCase, used: Description) -> None:
    """Raise InputError if the row of a case has an axis or heights that an implementation does not take."""
    layout = used.asked.layout
    if layout.has_heights(case.row):
        if not used.heights:
            raise InputError(
                f"{case.name} has heights at which the hyperboloid ends, and {used.name} takes none; its description "
                'must have "takes": ["heights"]'
            )
    elif layout.has_axis(case.row) and not used.tilt:
        raise InputError(
            f"{case.name} has an axis, but {used.name} takes only upright spheroids; its description must have "
            '"tilt": true'
        )


def _causes(truth: ProvedTruth, judgement: ReplayJudgement, criterion: Criterion) -> tuple[Cause, ...]:
    """Return the causes about places whose rules give this wrong answer.

    They are all those that are wrong in exact arithmetic; if there is none, the first one about rounding.
    """
    if judgement.answer is None or judgement.mistake is None:
        return ()
    truths, answers = (np.array([value], dtype=np.int8) for value in (truth.decision.position, judgement.answer))
    answered = AnsweredRows(np.array([truth.pair.row]), truths, answers, criterion)
    causes = [cause for cause in (*PLACES, *WIDER_ROUNDINGS) if cause.rule(answered)[0] == judgement.answer]
    exactly = [cause for cause in causes if cause.scope is Scope.PLACE]
    return tuple(exactly or causes[:1])


def truth_of(pair: Pair) -> ProvedTruth:
    """Decide a pair, prove the decision, and check the proof. Raises DisagreementError if the proof does not hold."""
    pair = pair.upright if pair.is_upright else pair
    decision = exact.decide(pair.lengths)
    others = [other for other in Position if other is not decision.position]
    return ProvedTruth(
        pair, decision, proved(pair, decision), {other: _flip(pair, decision, other) for other in others}
    )


def _flip(pair: Pair, decision: Decision, other: Position) -> float | tuple[float, float]:
    """Return the flip distance to another position; for a tilted spheroid its two bounds."""
    ends = backward_error.quick_bracket(pair, decision, other)
    return ends.upper if pair.is_upright else (ends.lower, ends.upper)


def _judged(
    implementation: Implementation, row: Row, truth: ProvedTruth | Passage, criterion: Criterion
) -> ReplayJudgement:
    """Test and judge the row alone; the status is NONDETERMINISTIC if the answer changes in a batch of copies."""
    rows = np.array([row])
    right = np.array([truth.decision.position if isinstance(truth, ProvedTruth) else truth.hit], dtype=np.int8)
    scored = score(rows, right, implementation.classify(rows, batch=1), criterion)
    alone = _alone(scored, truth)
    if alone.answer is None:
        return alone
    again = implementation.classify(np.repeat(rows, REPEATED_ROWS, axis=0), batch=REPEATED_ROWS)
    changed = np.flatnonzero(~again.answered | (again.answers != alone.answer))
    if not len(changed):
        return alone
    place = int(changed[0])
    otherwise = again.reasons.get(place, f"it answers {int(again.answers[place])}")
    reason = (
        f"answers {alone.answer} to the row alone; among {REPEATED_ROWS} copies of it, at place {place + 1}: "
        f"{otherwise}"
    )
    return replace(alone, status=Status.NONDETERMINISTIC, reason=reason)


def _alone(scored: Score, truth: ProvedTruth | Passage) -> ReplayJudgement:
    """Judge the one row of a score."""
    status, answer = STATUSES[scored.status[0]], int(scored.answers[0])
    if not scored.answered[0]:
        return ReplayJudgement(status, None, scored.reasons.get(0, ""))
    judgement = ReplayJudgement(status, answer)
    if scored.times is not None and answer == HIT:
        row, time = tuple(scored.rows[0].tolist()), float(scored.times[0])
        judgement = replace(judgement, time=time, radii=radii_off(row, time) if scored.truth[0] == HIT else 0.0)
    for case in scored.judged():
        error = _error(case, truth, scored.criterion)
        in_units = judge.in_units(error, scored.criterion.unit)
        judgement = replace(judgement, status=case.status, mistake=case.mistake, error=error, error_u=in_units)
    return judgement


def _error(case: WrongCase, truth: ProvedTruth | Passage, criterion: Criterion) -> float:
    """Return the error of a wrong answer; for a tilted spheroid the bound in `truth.flips` that decides its status."""
    if isinstance(truth, ProvedTruth) and not truth.pair.is_upright:
        targets = judge.right_positions(Position(case.truth), case.answer, criterion.question)
        ends = [flip for target in targets if isinstance(flip := truth.flips[target], tuple)]
        return min(low if case.status is Status.WRONG else high for low, high in ends)
    return judge.measured(case, criterion.question)


def _refused(case: ReplayCase, implementation: Implementation) -> ReplayJudgement:
    """Test an invalid row, and judge whether it is refused.

    Raises InputError if the implementation does not promise to refuse such rows.
    """
    used = implementation.description
    if not used.refuses:
        raise InputError(
            f"{case.name} is an invalid row ({', '.join(case.at_fault)}), and {used.name} does not declare that it "
            "refuses such rows"
        )
    answered = implementation.classify(np.array([case.row]), batch=1)
    status, answer = STATUSES[status_of(answered)[0]], int(answered.answers[0])
    if not answered.answered[0]:
        return ReplayJudgement(status, None, answered.reasons.get(0, ""))
    if answer == REFUSED:
        return ReplayJudgement(Status.REFUSED, answer)
    return ReplayJudgement(Status.WRONG, answer, f"an invalid row must be refused with {REFUSED}")


def _skipped(case: ReplayCase, used: Description, criterion: Criterion) -> str | None:
    """Return the reason why a conformance run would skip the row; None if it would test it."""
    rows = np.array([case.row])
    if not representable(rows, criterion.precision)[0]:
        return f"a number of the row is neither zero nor normal in {criterion.precision}"
    with np.errstate(all="ignore"):
        inside = used.domain.holds(rows, extreme=is_extreme(case.name), layout=used.asked.layout)[0]
    return None if inside else "the row lies outside the implementation's domain"
