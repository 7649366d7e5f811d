"""Judging answers: the truth about rows, which answers are right, and the error of a wrong answer as one number.

There is one judge for all questions. Their differences are data: `Question` has the answers and the columns of the
rows, and _SUBJECTS has for each layout of rows its truths and the measure of a wrong answer.

**A position.** The backward error of a wrong answer is the infimum of all ε for which a relative change of each input
by at most ε makes that answer right (truth/backward_error.py). It is counted in units u of the declared precision. For
a tilted spheroid two proved bounds enclose it: the answer is wrong if the lower bound exceeds the tolerance, tolerated
if the upper bound does not, and undecided otherwise.

**A sweep.** A wrong answer is measured by the least relative change of b and d together that makes it right. A time is
right if it lies between the first contact of the spheroid grown by the tolerance and the first contact of the spheroid
shrunk by it. A wrong time is measured by the part of the sweep between it and the first contact, in spheroid radii
(truth/passage_error.py).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, SWEEPS, Floats, Indices, Layout, Mask, Positions, Row, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import PRECISIONS, UNIT_ROUNDOFF
from hypcheck.implementations.sweeps import rough_exponents
from hypcheck.truth import backward_error, exact, float_filter, passage_error
from hypcheck.truth.exact import Decision
from hypcheck.truth.passage_error import CLEAR, HIT, SWEEP_ANSWERS, passage_of

DEFAULT_TOLERANCE = Fraction(8)
"""The backward error in units u that a run tolerates by default."""


class Status(str, Enum):
    """The outcome of a case."""

    RIGHT = "right"
    TOLERATED = "tolerated"
    WRONG = "wrong"
    UNDECIDED = "undecided"
    EXCUSED = "excused"
    ABSTAINED = "abstained"
    SKIPPED = "skipped"
    REFUSED = "refused"
    ERROR = "error"
    CRASH = "crash"
    TIMEOUT = "timeout"
    PROTOCOL = "protocol"
    NONDETERMINISTIC = "nondeterministic"
    NOT_RUN = "not-run"


UNANSWERED = (
    Status.ERROR,
    Status.CRASH,
    Status.TIMEOUT,
    Status.PROTOCOL,
    Status.NONDETERMINISTIC,
    Status.NOT_RUN,
)
"""The statuses of cases without a valid answer; each fails a run."""


class Mistake(str, Enum):
    """The kinds of wrong answers, by their consequences."""

    FALSE_CLEAR = "false-clear"  # dangerous: there is contact
    FALSE_CONTACT = "false-contact"  # contact is reported where there is none
    WRONG_SIDE = "wrong-side"
    LATE = "late"  # a wrong time; dangerous: contact was earlier
    EARLY = "early"


DANGEROUS = (Mistake.FALSE_CLEAR, Mistake.LATE)
"""Mistakes after which a program goes on although something is touched."""


@dataclass(frozen=True, slots=True)
class Criterion:
    """The criterion for answers: the question (of QUESTIONS), the precision (of PRECISIONS), and the tolerance in u."""

    question: str = "position"
    precision: str = "float64"
    tolerance: Fraction = DEFAULT_TOLERANCE

    def __post_init__(self) -> None:
        if self.question not in QUESTIONS:
            raise InputError(f"the question is {self.question!r}; it must be one of {', '.join(QUESTIONS)}")
        if self.precision not in PRECISIONS:
            raise InputError(f"the precision is {self.precision!r}; it must be one of {', '.join(PRECISIONS)}")
        if self.tolerance < 0:
            raise InputError(f"the tolerance is {float(self.tolerance)}; it must be 0 or more")

    @property
    def unit(self) -> Fraction:
        """The unit u of the precision."""
        return UNIT_ROUNDOFF[self.precision]

    @property
    def layout(self) -> Layout:
        """The columns of the rows that the question is about."""
        return QUESTIONS[self.question].layout


@dataclass(frozen=True, slots=True)
class WrongCase:
    """A wrong answer: its index in the batch, the row, the truth, the answer, the kind of mistake, and its size.

    `exponent` is floor(log2) of the backward error (−inf: the error is 0; inf: no change is enough). For a tilted
    spheroid it is log2 of `least`, a proved lower bound, or of an estimate if `least` is 0. measured() gives the error
    itself. `time` is the answered time of a sweep's first contact, if the time is wrong.
    """

    index: int
    row: Row
    truth: int
    answer: int
    mistake: Mistake
    status: Status
    exponent: float
    time: float | None = None
    least: float = 0.0


def exact_positions(rows: Rows) -> Positions:
    """Decide the exact positions of valid rows, (n, 7), (n, 10) or (n, 13): int8 (n,)."""
    return float_filter.positions(rows)


def truth_of(rows: Rows, layout: Layout) -> Positions:
    """Decide valid rows of this layout exactly, int8 (n,): positions of pairs; for sweeps 1 for contact, else 0."""
    return _SUBJECTS[layout].truth(rows)


def expected(truth: Positions, question: str) -> NDArray[np.int8]:
    """Return the right answers to a question, int8 (n,): the truth, or 1 for yes and 0 for no."""
    position = QUESTIONS[question].position
    return truth if position is None else np.asarray(truth == position, dtype=np.int8)


def is_wrong(truth: Positions, answers: NDArray[np.int8], question: str) -> Mask:
    """Return a mask (n,) of the wrong answers. `answers` hold allowed values and CANNOT_SAY, which is not wrong."""
    return np.asarray((answers != expected(truth, question)) & (answers != CANNOT_SAY))


def is_amiss(
    rows: Rows, truth: Positions, answers: NDArray[np.int8], times: Floats | None, criterion: Criterion
) -> Mask:
    """Return a mask (n,) of the wrong answers, and of the right ones with a time that is not right."""
    wrong = is_wrong(truth, answers, criterion.question)
    if times is not None:
        for place in np.flatnonzero((answers == HIT) & (truth == HIT)).tolist():
            wrong[place] = not time_is_right(tuple(rows[place].tolist()), float(times[place]), criterion)
    return wrong


def time_is_right(row: Row, time: float, criterion: Criterion) -> bool:
    """Return whether a time of first contact, from 0 to 1, is right within the tolerance, on a sweep with contact."""
    return passage_error.time_is_tolerated(row, time, criterion.tolerance, criterion.unit)


def judged(
    rows: Rows, answers: NDArray[np.int8], wrong: Indices, criterion: Criterion, times: Floats | None = None
) -> Iterator[WrongCase]:
    """Yield the wrong answers at these indices of a batch, judged in order."""
    return _SUBJECTS[criterion.layout].judged(rows, answers, wrong, criterion, times)


def _judged_positions(
    rows: Rows,
    answers: NDArray[np.int8],
    wrong: Indices,
    criterion: Criterion,
    times: Floats | None,  # noqa: ARG001 - a position has none
) -> Iterator[WrongCase]:
    """Judge positions: by float64 where this proves an error beyond the tolerance, elsewhere with more bits.

    Yield the wrong answers in order.
    """
    pairs = [Pair.from_row(row) for row in rows[wrong].tolist()]
    truths = [exact.decide(pair.lengths) for pair in pairs]
    given_answers = [int(answers[index]) for index in wrong.tolist()]
    targets = [
        right_positions(truth.position, answer, criterion.question)
        for truth, answer in zip(truths, given_answers, strict=True)
    ]
    ends = backward_error.lower_ends(pairs, truths, targets)
    for index, pair, truth, answer, end in zip(wrong.tolist(), pairs, truths, given_answers, ends, strict=True):
        if end > criterion.tolerance * criterion.unit:
            mistake, exponent = mistake_of(truth.position, answer, criterion.question), math.log2(end)
            case = WrongCase(index, pair.row, truth.position, answer, mistake, Status.WRONG, exponent, least=end)
        else:
            case = _judged(index, pair, truth, answer, criterion)
        yield replace(case, row=tuple(rows[index].tolist()))


def _judged(index: int, pair: Pair, truth: Decision, answer: int, criterion: Criterion) -> WrongCase:
    """Judge a wrong answer; it is UNDECIDED if the tolerance lies between the two bounds of its error."""
    targets = right_positions(truth.position, answer, criterion.question)
    within = backward_error.tolerated(pair, truth, targets, criterion.tolerance * criterion.unit)
    status = Status.UNDECIDED if within is None else Status.TOLERATED if within else Status.WRONG
    mistake = mistake_of(truth.position, answer, criterion.question)
    exponent = _exponent(pair, truth, answer, criterion.question)
    return WrongCase(index, pair.row, truth.position, answer, mistake, status, exponent)


def measured(case: WrongCase, question: str) -> float:
    """Return the error of a wrong answer: a proved bound if only bounds are known; for a wrong time, in spheroid radii.

    The bound is the lower one if it exceeds the tolerance, which is then proved, else the upper one. A backward error
    has 4 significant digits; the error of a sweep's size is within 1 %.
    """
    return _SUBJECTS[QUESTIONS[question].layout].measured(case, question)


def _measured_position(case: WrongCase, question: str) -> float:
    """Return the error of a wrong position."""
    if case.least:
        return case.least
    return _measured(Pair.from_row(case.row), case.answer, question, case.status in (Status.WRONG, Status.EXCUSED))


KEPT = 4096
"""The number of cached errors: methods that are judged on the same rows often make the same mistakes."""


@lru_cache(KEPT)
def _measured(pair: Pair, answer: int, question: str, beyond: bool) -> float:
    """Return the error of an answer: its proved lower bound if `beyond` (the tolerance), else an upper bound."""
    truth = exact.decide(pair.lengths)
    targets = right_positions(truth.position, answer, question)
    if beyond:
        return min(backward_error.lower_end(pair, truth, target) for target in targets)
    return min(backward_error.quick_bracket(pair, truth, target).upper for target in targets)


def about_error_of(row: Sequence[float], answer: int, question: str) -> float:
    """Return the backward error of an answer to a row, right or wrong, to 4 significant digits.

    For a tilted spheroid it is an estimate, because a proof takes much longer.
    """
    pair = Pair.from_row(row)
    truth = exact.decide(pair.lengths)
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.estimate(pair, truth, target) for target in targets)


@lru_cache(KEPT)
def _exponent(pair: Pair, truth: Decision, answer: int, question: str) -> float:
    """Compute about log2 of the least backward error that makes the answer right."""
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.exponent(pair, truth, target) for target in targets)


def right_positions(truth: Position, answer: int, question: str) -> tuple[Position, ...]:
    """Return the positions other than the truth for which a wrong answer would be right.

    "No" to a question about one position is right for two positions; contact is nearer to a clear position than the
    other.
    """
    position = QUESTIONS[question].position
    if position is None:
        return (Position(answer),)
    if answer:
        return (position,)
    if truth is Position.CONTACT:
        return (Position.EXTERIOR, Position.INTERIOR)
    return (Position.CONTACT,)


def in_units(error: float, unit: Fraction) -> float:
    """Return a backward error in units u; inf for the precision "exact", where rounding excuses no wrong answer."""
    if error in (0, math.inf):
        return error
    return error / float(unit) if unit else math.inf


def in_words(answer: int, question: str) -> str:
    """Return an answer in words: the stated position or hit, or yes or no; any other answer as its number."""
    facts = QUESTIONS[question]
    labels = _SUBJECTS[facts.layout].labels if facts.position is None else _YES_OR_NO
    return labels.get(answer, str(answer)).format(question)


_YES_OR_NO = {1: "{}: yes", 0: "{}: no"}


def truth_in_words(truth: int, question: str) -> str:
    """Return the truth about a row, in words."""
    return _SUBJECTS[QUESTIONS[question].layout].labels[truth]


def mistake_of(truth: int, answer: int, question: str) -> Mistake:
    """Return the mistake of an answer that is neither right nor CANNOT_SAY."""
    facts = QUESTIONS[question]
    if answer == facts.contact:
        return Mistake.FALSE_CONTACT
    return Mistake.FALSE_CLEAR if truth == _SUBJECTS[facts.layout].contact else Mistake.WRONG_SIDE


_TOGETHER = 256
"""The number of wrong answers about sweeps whose size errors are estimated at a time."""


def _judged_sweeps(
    rows: Rows, answers: NDArray[np.int8], wrong: Indices, criterion: Criterion, times: Floats | None
) -> Iterator[WrongCase]:
    """Judge wrong answers about sweeps, and right hits with a wrong time; yield them in order."""
    for start in range(0, len(wrong), _TOGETHER):
        some = {index: tuple(rows[index].tolist()) for index in wrong[start : start + _TOGETHER].tolist()}
        wrong_hits = [
            index for index, row in some.items() if times is None or passage_of(row).hit != bool(answers[index])
        ]
        near = dict(zip(wrong_hits, rough_exponents(rows[wrong_hits]).tolist(), strict=True))
        for index, row in some.items():
            if times is None or index in near:
                yield _wrong_hit(index, row, int(answers[index]), criterion, near[index])
            else:
                yield _wrong_time(index, row, float(times[index]))


def _wrong_time(index: int, row: Row, time: float) -> WrongCase:
    """Judge a right hit with a wrong time."""
    mistake = Mistake.LATE if time > passage_of(row).first_upper else Mistake.EARLY
    off = passage_error.radii_off(row, time)
    exponent = math.floor(math.log2(off)) if 0 < off < math.inf else (-math.inf if not off else math.inf)
    return WrongCase(index, row, HIT, HIT, mistake, Status.WRONG, exponent, time)


def _wrong_hit(index: int, row: Row, answer: int, criterion: Criterion, near: float) -> WrongCase:
    """Judge a wrong answer about contact on a sweep. `near` is the rough exponent of its size error."""
    change = passage_error.tolerance(row, criterion.tolerance, criterion.unit)
    within = bool(change) and (passage_of(row).grazes or passage_error.is_tolerated(row, bool(answer), change))
    status, truth = Status.TOLERATED if within else Status.WRONG, CLEAR if answer else HIT
    return WrongCase(index, row, truth, answer, mistake_of(truth, answer, criterion.question), status, near)


def _measured_sweep(case: WrongCase, question: str) -> float:  # noqa: ARG001 - one question is about sweeps
    """Return the error of a wrong answer about a sweep: that of its time in spheroid radii, or its size error."""
    if case.time is not None:
        return passage_error.radii_off(case.row, case.time)
    error = passage_error.size_error(case.row, bool(case.answer))
    return error.lower if case.status in (Status.WRONG, Status.EXCUSED) else error.upper


@dataclass(frozen=True, slots=True)
class _Subject:
    """How one layout of rows (pairs or sweeps) is judged.

    `truth` decides rows exactly, `labels` are the words for its values, and `contact` is the value for contact.
    `judged` judges wrong answers, and `measured` gives the error of one.
    """

    truth: Callable[[Rows], Positions]
    labels: Mapping[int, str]
    contact: int
    judged: Callable[[Rows, NDArray[np.int8], Indices, Criterion, Floats | None], Iterator[WrongCase]]
    measured: Callable[[WrongCase, str], float]


_SUBJECTS: Mapping[Layout, _Subject] = {
    PAIRS: _Subject(
        exact_positions,
        {position.value: position.label for position in Position},
        Position.CONTACT,
        _judged_positions,
        _measured_position,
    ),
    SWEEPS: _Subject(passage_error.hits, SWEEP_ANSWERS, HIT, _judged_sweeps, _measured_sweep),
}
