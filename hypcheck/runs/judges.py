"""The judge of each question: what is true about its rows, which answers are wrong, and by how much.

Scores, retests, hunts and reports ask it, and so need not know what a question is about.

Answers about sweeps are judged by the spheroid's size and by the first contact. A wrong answer is measured by the least
relative change of b and d together that makes it right (truth/passage_error.py). A time is right from the first contact
of the spheroid grown by the tolerance to that of the spheroid shrunk by it; a wrong one is measured by the way between
it and the first contact, in spheroid radii: of an upright spheroid, (Δx² + Δy²)/b² + Δz²/d² is the square of the whole
sweep.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import UPRIGHT, Position
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, SWEEPS, Floats, Indices, Layout, Mask, Positions, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.ways import rough_exponents
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Mistake, Status, WrongCase
from hypcheck.truth import passage_error
from hypcheck.truth.swept import Passage

Row = tuple[float, ...]

_REMEMBERED = 1 << 16
_TOGETHER = 256
"""Wrong answers whose size errors are estimated at a time."""

CLEAR, HIT = 0, 1
LABELS = {CLEAR: "clear on the sweep", HIT: "in contact on the sweep"}


@lru_cache(_REMEMBERED)
def passage_of(row: Row) -> Passage:
    """What happens on a sweep; remembered, since the truth is asked for before and after the answers."""
    return passage_error.scaled_passage(row)


@lru_cache(_REMEMBERED)
def _window(row: Row, change: Fraction) -> tuple[Fraction | None, Fraction | None]:
    return passage_error.time_window(row, change)


class Judge:
    """How the answers to a question about positions are judged; PassageJudge has the same methods about sweeps.

    Answers are allowed ones or CANNOT_SAY, which is never wrong.
    """

    def __init__(self, question: str) -> None:
        self._question = question

    def truth(self, rows: Rows) -> Positions:
        """The positions."""
        return judge.exact_positions(rows)

    def right(self, truth: Positions) -> NDArray[np.int8]:
        """The right answers (n,) where this is true."""
        return judge.expected(truth, self._question)

    def is_wrong(
        self,
        rows: Rows,  # noqa: ARG002 - the truth is enough
        truth: Positions,
        answers: NDArray[np.int8],
        times: Floats | None,  # noqa: ARG002 - there are none
        criterion: Criterion,  # noqa: ARG002 - the same for all
    ) -> Mask:
        """A mask (n,) of the wrong answers."""
        return judge.is_wrong(truth, answers, self._question)

    def judged(
        self,
        rows: Rows,
        answers: NDArray[np.int8],
        times: Floats | None,  # noqa: ARG002 - there are none
        wrong: Indices,
        criterion: Criterion,
    ) -> Iterator[WrongCase]:
        """The wrong answers at these indices, judged in order."""
        return judge.judged(rows, answers, wrong, criterion)

    def measured(self, case: WrongCase, criterion: Criterion) -> float:
        """The backward error."""
        return judge.measured(case, criterion.question)

    def mistake(self, truth: int, answer: int) -> Mistake:
        """The kind of mistake."""
        return judge.mistake_of(Position(truth), answer, self._question)

    def truth_in_words(self, truth: int) -> str:
        """The position."""
        return Position(truth).label

    def in_words(self, answer: int) -> str:
        """The position, or yes or no to the question."""
        return judge.in_words(answer, self._question)


class PassageJudge(Judge):
    """How answers to the question passage are judged."""

    def truth(self, rows: Rows) -> Positions:
        """1 for contact on the sweep, 0 for none: int8 (n,)."""
        return np.array([passage_of(tuple(row)).hit for row in rows.tolist()], dtype=np.int8)

    def right(self, truth: Positions) -> NDArray[np.int8]:
        """The same: 1 for contact on the sweep, 0 for none."""
        return truth

    def is_wrong(
        self, rows: Rows, truth: Positions, answers: NDArray[np.int8], times: Floats | None, criterion: Criterion
    ) -> Mask:
        """A mask (n,) of the wrong answers, and of the right ones with a time that is not."""
        wrong = np.asarray((answers != truth) & (answers != CANNOT_SAY))
        if times is not None:
            for place in np.flatnonzero((answers == HIT) & (truth == HIT)).tolist():
                wrong[place] = not time_is_right(tuple(rows[place].tolist()), float(times[place]), criterion)
        return wrong

    def judged(
        self, rows: Rows, answers: NDArray[np.int8], times: Floats | None, wrong: Indices, criterion: Criterion
    ) -> Iterator[WrongCase]:
        """The wrong answers at these indices, judged in order."""
        for start in range(0, len(wrong), _TOGETHER):
            part = wrong[start : start + _TOGETHER]
            some = np.ascontiguousarray(rows[part])
            for index, numbers, near in zip(part.tolist(), some.tolist(), rough_exponents(some).tolist(), strict=True):
                row, answer = tuple(numbers), int(answers[index])
                if passage_of(row).hit == bool(answer) and times is not None:
                    yield _wrong_time(index, row, float(times[index]))
                else:
                    yield _wrong_hit(index, row, answer, criterion, near)

    def measured(self, case: WrongCase, criterion: Criterion) -> float:  # noqa: ARG002 - the same in all
        """The size error of a wrong answer, to 1 %: a lower end unless it is tolerated; of a wrong time, radii."""
        if case.time is not None:
            return radii_off(case.row, case.time)
        error = passage_error.size_error(case.row, bool(case.answer))
        return error.lower if case.status in (Status.WRONG, Status.EXCUSED) else error.upper

    def mistake(self, truth: int, answer: int) -> Mistake:  # noqa: ARG002 - the answer says it
        """The kind of mistake of an answer that is wrong about contact."""
        return Mistake.FALSE_CONTACT if answer == HIT else Mistake.FALSE_CLEAR

    def truth_in_words(self, truth: int) -> str:
        """The truth in words."""
        return LABELS[truth]

    def in_words(self, answer: int) -> str:
        """An answer in words, or its number if it is none."""
        return LABELS.get(answer, str(answer))


def time_is_right(row: Row, time: float, criterion: Criterion) -> bool:
    """Whether a time of first contact, from 0 to 1, is right within the tolerance, on a sweep with contact."""
    passage = passage_of(row)
    if passage.first_lower <= time <= passage.first_upper:
        return True
    change = passage_error.tolerance(row, criterion.tolerance, criterion.unit)
    if not change:
        return False
    earliest, latest = _window(row, change)
    exact = Fraction(time)
    return earliest is not None and earliest <= exact and (latest is None or exact <= latest)


def first_contact(row: Row) -> tuple[float, float]:
    """Bounds of the time of the first contact."""
    passage = passage_of(row)
    return passage.first_lower, passage.first_upper


def radii_off(row: Row, time: float) -> float:
    """The sweep between a time and the first contact, in spheroid radii."""
    lower, upper = first_contact(row)
    return max(lower - time, time - upper, 0.0) * sweep_in_radii(row)


def sweep_in_radii(row: Row) -> float:
    """The length of the sweep in spheroid radii, those along the spheroid's axis and across it each in their own."""
    b, d = row[2:4]
    step = [end - start for start, end in zip(row[4:7], row[7:10], strict=True)]
    given = row[len(SWEEPS.upright) : len(SWEEPS.tilted)]
    largest = max(map(abs, given), default=0.0)
    axis = [component / largest for component in given] or UPRIGHT
    length = math.hypot(*axis)
    along = sum(component / length * part for component, part in zip(axis, step, strict=True))
    across = [part - along * component / length for component, part in zip(axis, step, strict=True)]
    return math.hypot(*(part / b for part in across), along / d)


def _wrong_time(index: int, row: Row, time: float) -> WrongCase:
    mistake = Mistake.LATE if time > first_contact(row)[1] else Mistake.EARLY
    off = radii_off(row, time)
    exponent = math.floor(math.log2(off)) if 0 < off < math.inf else (-math.inf if not off else math.inf)
    return WrongCase(index, row, HIT, HIT, mistake, Status.WRONG, exponent, time)


def _wrong_hit(index: int, row: Row, answer: int, criterion: Criterion, near: float) -> WrongCase:
    change = passage_error.tolerance(row, criterion.tolerance, criterion.unit)
    within = bool(change) and (passage_of(row).grazes or passage_error.is_tolerated(row, bool(answer), change))
    mistake = Mistake.FALSE_CONTACT if answer else Mistake.FALSE_CLEAR
    status = Status.TOLERATED if within else Status.WRONG
    return WrongCase(index, row, 1 - answer, answer, mistake, status, near)


_JUDGES: dict[Layout, type[Judge]] = {PAIRS: Judge, SWEEPS: PassageJudge}


@cache
def judge_of(question: str) -> Judge:
    """The judge of a question, one of QUESTIONS."""
    return _JUDGES[QUESTIONS[question].layout](question)


def truth_of(rows: Rows, layout: Layout) -> Positions:
    """What is true about valid rows of that layout: positions, or hits on sweeps."""
    return next(judge_of(name) for name, question in QUESTIONS.items() if question.layout == layout).truth(rows)
