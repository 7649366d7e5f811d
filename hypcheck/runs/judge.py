"""Judging answers: right or wrong, and the size of the error in one number for every precision.

The backward error of a wrong answer is the infimum of all ε for which a relative change of each input by at most ε
makes that answer right (truth/backward_error.py). It is counted in units u of the declared precision. For a tilted
spheroid it is bracketed by two proved ends: the answer is wrong if the lower end exceeds the tolerance, tolerated if
the upper end does not, and undecided otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import CANNOT_SAY, Layout, Positions, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import PRECISIONS, UNIT_ROUNDOFF
from hypcheck.truth import backward_error, exact, float_filter
from hypcheck.truth.exact import Decision

DEFAULT_TOLERANCE = Fraction(8)
"""The backward error in units u that a run tolerates by default."""


class Status(str, Enum):
    """How a case ended."""

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
    """The kinds of wrong answers, by their consequence."""

    FALSE_CLEAR = "false-clear"  # dangerous: something is touched
    FALSE_CONTACT = "false-contact"  # an invisible wall
    WRONG_SIDE = "wrong-side"
    LATE = "late"  # of a time: dangerous, the contact was before
    EARLY = "early"


DANGEROUS = (Mistake.FALSE_CLEAR, Mistake.LATE)
"""Mistakes after which a program goes on although something is touched."""


@dataclass(frozen=True, slots=True)
class Criterion:
    """How answers are judged: the question (of QUESTIONS), the precision (of PRECISIONS), and the tolerance in u."""

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

    `exponent` is floor(log2) of the backward error (−inf: it is 0; inf: no change is enough). For a tilted spheroid it
    is log2 of `least`, a lower end that is proved, or of an estimate where `least` is 0. measured() gives the number.
    `time` is that of a sweep's first contact, if it is what is wrong.
    """

    index: int
    row: tuple[float, ...]
    truth: int
    answer: int
    mistake: Mistake
    status: Status
    exponent: float
    time: float | None = None
    least: float = 0.0


def expected(positions: Positions, question: str) -> NDArray[np.int8]:
    """The right answers to a question, int8 (n,): the position itself, or 1 for yes and 0 for no."""
    if question == "position":
        return positions
    return np.asarray(positions == Position[question.upper()], dtype=np.int8)


def is_wrong(truth: Positions, answers: NDArray[np.int8], question: str) -> NDArray[np.bool_]:
    """A mask (n,) of the wrong answers. `answers` hold allowed values and CANNOT_SAY, which is not wrong."""
    return np.asarray((answers != expected(truth, question)) & (answers != CANNOT_SAY))


def exact_positions(rows: Rows) -> Positions:
    """The exact positions of valid rows, (n, 7) or (n, 10): int8 (n,)."""
    return float_filter.positions(rows)


def judged(rows: Rows, answers: NDArray[np.int8], wrong: NDArray[np.intp], criterion: Criterion) -> Iterator[WrongCase]:
    """The wrong answers at these indices of a batch, judged in order.

    Where float64 proves a lower end of the error beyond the tolerance, that end is enough; more bits are for the rest.
    """
    pairs = [Pair.from_row(row) for row in rows[wrong].tolist()]
    truths = [exact.decide(pair.lengths) for pair in pairs]
    given = [int(answers[index]) for index in wrong.tolist()]
    targets = [
        right_positions(truth.position, answer, criterion.question) for truth, answer in zip(truths, given, strict=True)
    ]
    ends = backward_error.lower_ends(pairs, truths, targets)
    for index, pair, truth, answer, end in zip(wrong.tolist(), pairs, truths, given, ends, strict=True):
        if end > criterion.tolerance * criterion.unit:
            mistake, exponent = mistake_of(truth.position, answer, criterion.question), math.log2(end)
            case = WrongCase(index, pair.row, truth.position, answer, mistake, Status.WRONG, exponent, least=end)
        else:
            case = _judged(index, pair, truth, answer, criterion)
        yield replace(case, row=tuple(rows[index].tolist()))


def _judged(index: int, pair: Pair, truth: Decision, answer: int, criterion: Criterion) -> WrongCase:
    """A wrong answer; UNDECIDED where the tolerance lies between the two ends of the error."""
    targets = right_positions(truth.position, answer, criterion.question)
    within = backward_error.tolerated(pair, truth, targets, criterion.tolerance * criterion.unit)
    status = Status.UNDECIDED if within is None else Status.TOLERATED if within else Status.WRONG
    mistake = mistake_of(truth.position, answer, criterion.question)
    exponent = _exponent(pair, truth, answer, criterion.question)
    return WrongCase(index, pair.row, truth.position, answer, mistake, status, exponent)


def measured(case: WrongCase, question: str) -> float:
    """The backward error of a wrong answer, to 4 significant digits; of a tilted spheroid one of two ends.

    The lower where it is more than tolerated, so that what is said is proved, else the upper.
    """
    if case.least:
        return case.least
    return _measured(Pair.from_row(case.row), case.answer, question, case.status in (Status.WRONG, Status.EXCUSED))


KEPT = 4096
"""So many errors are kept: methods that are judged on the same rows often err alike."""


@lru_cache(KEPT)
def _measured(pair: Pair, answer: int, question: str, beyond: bool) -> float:
    truth = exact.decide(pair.lengths)
    targets = right_positions(truth.position, answer, question)
    if beyond:
        return min(backward_error.lower_end(pair, truth, target) for target in targets)
    return min(backward_error.quick_bracket(pair, truth, target).upper for target in targets)


def about_error_of(row: Sequence[float], answer: int, question: str) -> float:
    """The backward error of an answer to a row, right or wrong, to 4 significant digits.

    Of a tilted spheroid an estimate, which takes a small part of the time of a proof.
    """
    pair = Pair.from_row(row)
    truth = exact.decide(pair.lengths)
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.estimate(pair, truth, target) for target in targets)


@lru_cache(KEPT)
def _exponent(pair: Pair, truth: Decision, answer: int, question: str) -> float:
    """log2 of about the error."""
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.exponent(pair, truth, target) for target in targets)


def right_positions(truth: Position, answer: int, question: str) -> tuple[Position, ...]:
    """The positions other than the truth for which a wrong answer would be right.

    "No" to a question about one position is right for two; from a clear one, contact is nearer than the other.
    """
    if question == "position":
        return (Position(answer),)
    position = Position[question.upper()]
    if answer:
        return (position,)
    if truth is Position.CONTACT:
        return (Position.EXTERIOR, Position.INTERIOR)
    return (Position.CONTACT,)


def in_units(error: float, unit: Fraction) -> float:
    """A backward error in units u; inf for the precision "exact", where rounding excuses no wrong answer."""
    if error in (0, math.inf):
        return error
    return error / float(unit) if unit else math.inf


def in_words(answer: int, question: str) -> str:
    """An answer in words: the position, or yes or no to the question; any other answer as its number."""
    meanings = {position.value: position.label for position in Position}
    if question != "position":
        meanings = {1: f"{question}: yes", 0: f"{question}: no"}
    return meanings.get(answer, str(answer))


def mistake_of(truth: Position, answer: int, question: str) -> Mistake:
    """The kind of a wrong answer, which is neither right nor CANNOT_SAY."""
    if question == "position":
        if truth is Position.CONTACT:
            return Mistake.FALSE_CLEAR
        return Mistake.FALSE_CONTACT if answer == Position.CONTACT else Mistake.WRONG_SIDE
    claims_clear = bool(answer) is not (question == "contact")
    if not claims_clear:
        return Mistake.FALSE_CONTACT
    return Mistake.FALSE_CLEAR if truth is Position.CONTACT else Mistake.WRONG_SIDE
