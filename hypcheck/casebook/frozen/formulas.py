"""What the formulas of the derivation answer about rows: exactly, in a float format, and how far off they are there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.frozen.model import Row
from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.pairs import COLUMNS, Position
from hypcheck.rows import Rows

Mask = NDArray[np.bool_]


def exactly_right(formula: str, row: Row, truth: Position) -> bool:
    """Whether the formula, evaluated in rationals, answers its question about the row rightly."""
    given = answers(FORMULAS[formula], EXACT, dict(zip(COLUMNS, row, strict=True)))
    return int(given) == _right_answer(formula, truth)


def wrong_answers(formula: str, precision: str, rows: Rows, truths: Sequence[Position]) -> dict[int, Position]:
    """The rows in the format's range that the formula answers wrongly in it, each with the nearest excuse.

    That is the position of which the answer would be right: the answer itself, or, where the formula says "no" to a
    clear position, contact, which lies on the way to the other one.
    """
    given: NDArray[np.int8] = answers(
        FORMULAS[formula], float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True))
    )
    right = np.asarray([_right_answer(formula, truth) for truth in truths], dtype=np.int8)
    places: list[int] = np.flatnonzero(in_range(rows, precision) & (given != right)).tolist()
    return {place: _excuse(formula, int(given[place])) for place in places}


def in_range(rows: Rows, precision: str) -> Mask:
    """A mask (n,) of the rows whose every number is 0 or in the range of the format's normal numbers."""
    limits = np.finfo(np.dtype(precision))
    lengths = np.abs(rows)
    normal = (lengths >= float(limits.tiny)) & (lengths <= float(limits.max))
    return np.asarray((normal | (lengths == 0)).all(axis=1))


def leaves_range(formula: str, precision: str, rows: Rows) -> tuple[Mask, Mask]:
    """Which rows meet an infinity, and which a product or quotient of numbers ≠ 0 below the normal numbers.

    A NaN by itself is the root of a negative number and no overflow; differences of infinities come after these. Sums
    and differences do not underflow: where they are subnormal, they are exact.
    """
    program = FORMULAS[formula].program
    values = evaluate(program, float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True)))
    least = np.finfo(np.dtype(precision)).tiny
    overflow, underflow = np.zeros(len(rows), dtype=np.bool_), np.zeros(len(rows), dtype=np.bool_)
    for step in program.steps:
        value = values[step.name]
        if value.dtype == np.bool_:
            continue
        overflow |= np.isinf(value)
        if step.operation in ("mul", "div"):
            nonzero = np.ones(len(rows), dtype=np.bool_)
            for name in step.reads:
                nonzero &= values[name] != 0
            underflow |= nonzero & (np.abs(value) < least)
    return overflow, underflow


def _right_answer(formula: str, truth: Position) -> int:
    question = FORMULAS[formula].question
    return int(truth) if question == "position" else int(truth is Position[question.upper()])


def _excuse(formula: str, answer: int) -> Position:
    question = FORMULAS[formula].question
    if question == "position":
        return Position(answer)
    return Position[question.upper()] if answer else Position.CONTACT
