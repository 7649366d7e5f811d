"""A formula as a method in numpy: chunk by chunk, and, for one scene, with what depends on sizes alone computed once.

A program's names are looked up once, so that what is timed is the arithmetic and little else.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import Evaluator
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import Formula
from hypcheck.derivation.hoisting import split
from hypcheck.derivation.program import Program
from hypcheck.methods.method import Answers
from hypcheck.pairs import COLUMNS, SIZES
from hypcheck.rows import Rows

CHUNK = 8192
"""Rows at a time: the temporaries of one chunk stay in the cache."""

Floats = NDArray[np.float64]
Sizes = tuple[float, float, float, float]
ByRows = Callable[[Rows], Answers]
ByScene = Callable[[Sizes, Floats, Floats, Floats], Answers]


def by_rows(formula: Formula, format_name: str) -> ByRows:
    """The formula on rows, everything in one float format: a function to answers, int8 (n,)."""
    ready = Evaluator(formula.program, float_arithmetic(format_name), (formula.answer,))
    return lambda rows: in_chunks(len(rows), lambda part: ready(dict(zip(COLUMNS, rows[part].T, strict=True)))[0])


def by_scene(formula: Formula, format_name: str) -> ByScene:
    """The same for many centres and one α, γ, b, d: what these alone decide is evaluated once a call."""
    first, then = parts(formula)
    arithmetic = float_arithmetic(format_name)
    outside, inside = Evaluator(first, arithmetic, _numbers(first)), Evaluator(then, arithmetic, (formula.answer,))

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        fixed = dict(zip(SIZES, sizes, strict=True))
        known = {**fixed, **dict(zip(_numbers(first), outside(fixed), strict=True))}
        return in_chunks(len(x), lambda part: inside({**known, "x": x[part], "y": y[part], "z": z[part]})[0])

    return answers


@cache
def parts(formula: Formula) -> tuple[Program, Program]:
    """The formula's program in two: what sizes alone decide, and what is left for each centre."""
    return split(formula.program, (formula.answer,), SIZES)


def _numbers(outside: Program) -> tuple[str, ...]:
    return tuple(step.name for step in outside.steps)


def in_chunks(count: int, answer: Callable[[slice], Any]) -> Answers:
    """The answers of `count` rows, CHUNK at a time; int8 (n,)."""
    found = np.empty(count, dtype=np.int8)
    for start in range(0, count, CHUNK):
        part = slice(start, start + CHUNK)
        found[part] = answer(part)
    return found
