"""Judging answers: right or wrong, and the size of the error in one number for every precision.

The backward error of a wrong answer is the infimum of all ε for which a relative change of each input by at most ε
makes that answer right (truth/backward_error.py). It is counted in units u of the declared precision. For a tilted
spheroid it is bracketed by two proved ends (truth/tilted/backward_error.py): the answer is wrong if the lower end
exceeds the tolerance, tolerated if the upper end does not, and undecided otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Lengths, Pair, Position
from hypcheck.geometry.rows import CANNOT_SAY, Layout, Positions, Rows
from hypcheck.implementations.description import PRECISIONS, QUESTIONS, UNIT_ROUNDOFF
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
    `time` is that of a way's first contact, if it is what is wrong.
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
    """The wrong answers at these indices of a batch, judged in order."""
    proved = _proved_ends(rows, answers, wrong, criterion)
    for index in wrong.tolist():
        row, answer = rows[index].tolist(), int(answers[index])
        if index in proved:
            truth, least = proved[index]
            mistake = mistake_of(truth, answer, criterion.question)
            yield WrongCase(index, tuple(row), truth, answer, mistake, Status.WRONG, math.log2(least), least=least)
        else:
            yield _judged(index, row, answer, criterion)


def measured(case: WrongCase, question: str) -> float:
    """The backward error of a wrong answer, to 4 significant digits; of a tilted spheroid one of two ends.

    The lower where it is more than tolerated, so that what is said is proved, else the upper.
    """
    if case.least:
        return case.least
    lengths = Lengths.of(case.row)
    if lengths.is_upright:
        return _error(lengths, case.answer, question)
    from hypcheck.truth.tilted import backward_error as tilted_error  # noqa: PLC0415 - loads mpmath

    truth = exact.decide(lengths)
    targets = right_positions(truth.position, case.answer, question)
    if case.status in (Status.WRONG, Status.EXCUSED):
        return min(tilted_error.lower_end(case.row, truth, target) for target in targets)
    return min(tilted_error.quick_bracket(case.row, truth, target).upper for target in targets)


def about_error_of(row: Sequence[float], answer: int, question: str) -> float:
    """The backward error of an answer to a row, right or wrong, to 4 significant digits.

    Of a tilted spheroid an estimate, which takes a small part of the time of a proof.
    """
    lengths = Lengths.of(row)
    if lengths.is_upright:
        return _error(lengths, answer, question)
    return _estimate(lengths, row, answer, question)


def _estimate(lengths: Lengths, row: Sequence[float], answer: int, question: str) -> float:
    from hypcheck.truth.tilted import backward_error as tilted_error  # noqa: PLC0415 - loads mpmath

    truth = exact.decide(lengths)
    targets = right_positions(truth.position, answer, question)
    return min(tilted_error.estimate(row, truth, target) for target in targets)


def flip_exponents(rows: Rows) -> NDArray[np.float64]:
    """floor(log2) of each row's distance to the nearest other position, (n,); −inf for a tangency.

    Of a tilted spheroid that of an estimate: to prove it takes too long.
    """
    if rows.shape[1] > len(COLUMNS):
        return np.array([_exponent_of_ten(row) for row in rows.tolist()])
    octaves = backward_error.distance_exponents(rows, float_filter.positions(rows))
    for index in np.flatnonzero(np.isnan(octaves)):
        lengths = Pair.from_row(rows[index].tolist()).lengths
        octaves[index] = _exponent(lengths, 0, exact.decide(lengths).position.name.lower())
    return octaves


def _proved_ends(
    rows: Rows, answers: NDArray[np.int8], wrong: NDArray[np.intp], criterion: Criterion
) -> dict[int, tuple[Position, float]]:
    """Of wrong answers about tilted spheroids, by index, the truth and a lower end of the error beyond the tolerance.

    What is missing there is to be decided one by one, with more bits.
    """
    if rows.shape[1] == len(COLUMNS):
        return {}
    from hypcheck.truth.tilted import backward_error as tilted_error  # noqa: PLC0415 - loads mpmath

    pairs = ((index, Lengths.of(rows[index].tolist())) for index in wrong.tolist())
    tilted = [(index, lengths) for index, lengths in pairs if not lengths.is_upright]
    truths = [exact.decide(lengths) for _, lengths in tilted]
    targets = [
        right_positions(truth.position, int(answers[index]), criterion.question)
        for (index, _), truth in zip(tilted, truths, strict=True)
    ]
    ends = tilted_error.lower_ends([rows[index].tolist() for index, _ in tilted], truths, targets)
    tolerance = criterion.tolerance * criterion.unit
    return {
        index: (truth.position, end)
        for (index, _), truth, end in zip(tilted, truths, ends, strict=True)
        if end > tolerance
    }


def _exponent_of_ten(row: list[float]) -> float:
    lengths = Lengths.of(row)
    if lengths.is_upright:
        return float(flip_exponents(np.array([row[: len(COLUMNS)]]))[0])
    distance = _estimate(lengths, row, 0, exact.position(lengths).name.lower())
    return math.floor(math.log2(distance)) if distance else -math.inf


KEPT = 4096
"""So many errors of upright spheroids are kept: methods that are judged on the same rows often err alike."""


@lru_cache(KEPT)
def _error(lengths: Lengths, answer: int, question: str) -> float:
    """The backward error of an answer about an upright spheroid, to 4 significant digits."""
    truth = exact.decide(lengths)
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.backward_error(lengths, truth, target) for target in targets)


@lru_cache(KEPT)
def _exponent(lengths: Lengths, answer: int, question: str) -> float:
    """floor(log2) of that error, which takes a third of the decisions."""
    truth = exact.decide(lengths)
    targets = right_positions(truth.position, answer, question)
    return min(backward_error.backward_error_exponent(lengths, truth, target) for target in targets)


def _judged(index: int, row: list[float], answer: int, criterion: Criterion) -> WrongCase:
    lengths = Lengths.of(row)
    position, status, exponent = (
        _status_of_upright(lengths, answer, criterion)
        if lengths.is_upright
        else _status_of_tilted(lengths, row, answer, criterion)
    )
    mistake = mistake_of(position, answer, criterion.question)
    return WrongCase(index, tuple(row), position, answer, mistake, status, exponent)


def _status_of_upright(lengths: Lengths, answer: int, criterion: Criterion) -> tuple[Position, Status, float]:
    """The truth, whether a wrong answer is within the tolerance, and floor(log2) of its backward error."""
    truth = exact.decide(lengths)
    targets = right_positions(truth.position, answer, criterion.question)
    within = tolerated(lengths, truth, targets, criterion)
    status = Status.TOLERATED if within else Status.WRONG
    return truth.position, status, _exponent(lengths, answer, criterion.question)


def _status_of_tilted(
    lengths: Lengths, row: Sequence[float], answer: int, criterion: Criterion
) -> tuple[Position, Status, float]:
    """The same of a tilted spheroid; UNDECIDED where the tolerance lies between the two ends of the error."""
    from hypcheck.truth.tilted import backward_error as tilted_error  # noqa: PLC0415 - loads mpmath

    truth = exact.decide(lengths)
    targets = right_positions(truth.position, answer, criterion.question)
    within = tilted_error.tolerated(row, truth, targets, criterion.tolerance * criterion.unit)
    status = Status.UNDECIDED if within is None else Status.TOLERATED if within else Status.WRONG
    near = min(tilted_error.estimate(row, truth, target) for target in targets)
    return truth.position, status, math.log2(near) if near else -math.inf


def right_positions(truth: Position, answer: int, question: str) -> tuple[Position, ...]:
    """The positions other than the truth for which a wrong answer would be right.

    "No" to a question about one position is right for two; from a clear one, contact is nearer than the other.
    """
    if question == "position":
        return (Position(answer),)
    asked = Position[question.upper()]
    if answer:
        return (asked,)
    if truth is Position.CONTACT:
        return (Position.EXTERIOR, Position.INTERIOR)
    return (Position.CONTACT,)


def tolerated(lengths: Lengths, truth: Decision, targets: Iterable[Position], criterion: Criterion) -> bool:
    """Whether a change of at most T units u makes one of the targets true, by one exact decision for each target."""
    change = criterion.tolerance * criterion.unit
    if change == 0:
        return False
    if change >= 1:
        return any(backward_error.backward_error(lengths, truth, target) <= 1 for target in targets)
    return any(
        truth.limit_of is target or backward_error.makes_right(lengths, truth.position, target, change)
        for target in targets
    )


def in_units(error: float, unit: Fraction) -> float:
    """A backward error in units u; inf for the precision "exact", where rounding excuses no wrong answer."""
    if error in (0, math.inf):
        return error
    return error / float(unit) if unit else math.inf


def in_words(answer: int, question: str) -> str:
    """An answer in words: the position, or yes or no to the question; any other answer as its number."""
    meanings = {each.value: each.label for each in Position}
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
