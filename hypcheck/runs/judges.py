"""The judge of each question: what is true about its rows, which answers are wrong, and by how much.

Scores, retests, hunts and reports ask it, and so need not know what a question is about.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import PAIRS, WAYS, Floats, Indices, Layout, Mask, Positions, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Mistake, WrongCase
from hypcheck.runs.passages import PassageJudge


class Judge(Protocol):
    """How the answers to a question are judged. Answers are allowed ones or CANNOT_SAY, which is never wrong."""

    def truth(self, rows: Rows) -> Positions:
        """What is true about valid rows, int8 (n,): positions, or hits."""
        ...

    def is_wrong(
        self, rows: Rows, truth: Positions, answers: NDArray[np.int8], times: Floats | None, criterion: Criterion
    ) -> Mask:
        """A mask (n,) of the wrong answers."""
        ...

    def judged(
        self, rows: Rows, answers: NDArray[np.int8], times: Floats | None, wrong: Indices, criterion: Criterion
    ) -> Iterator[WrongCase]:
        """The wrong answers at these indices, judged in order."""
        ...

    def measured(self, case: WrongCase, criterion: Criterion) -> float:
        """How wrong an answer is, as a number."""
        ...

    def mistake(self, truth: int, answer: int) -> Mistake:
        """The kind of mistake that an answer is which is not the truth."""
        ...

    def truth_in_words(self, truth: int) -> str:
        """The truth in words."""
        ...

    def in_words(self, answer: int) -> str:
        """An answer in words."""
        ...


class PositionJudge:
    """How answers about one position are judged: judge.py, for one of its questions."""

    def __init__(self, question: str) -> None:
        self._question = question

    def truth(self, rows: Rows) -> Positions:
        """The positions."""
        return judge.exact_positions(rows)

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


@cache
def judge_of(question: str) -> Judge:
    """The judge of a question, one of QUESTIONS."""
    return PassageJudge() if QUESTIONS[question].layout is WAYS else PositionJudge(question)


def truth_of(rows: Rows, layout: Layout) -> Positions:
    """What is true about valid rows of that layout: positions, or hits on ways."""
    return judge.exact_positions(rows) if layout is PAIRS else judge_of("passage").truth(rows)
