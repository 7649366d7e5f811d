"""A method: a name, a domain, and a function from rows to answers; and a formula as a method in numpy.

What everything under test looks like: a name, what it claims, and a function from rows to answers.

A formula as a method in numpy: chunk by chunk, and, for one scene, with what depends on sizes alone computed once.

A program's names are looked up once, so that what is timed is the arithmetic and little else.

A formula without divisions by what the sizes fix: products with reciprocals that are computed once, before the loop.

They round once more than the division does, so this is another formula with other answers, next to touching.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.costs import hoist, split
from hypcheck.derivation.evaluation import Evaluator
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.program import Program, Step
from hypcheck.geometry.pair import COLUMNS, SIZES, Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.description import Domain

Answers = NDArray[np.int8]


@dataclass(frozen=True)
class Method:
    """One way to answer, under test.

    `question` and `precision` are those of judge.Criterion; `domain` is where the method claims to be right; `answer`
    maps valid rows, float64 (n, 7), to answers, int8 (n,): +1, 0, −1 for a position, 1 and 0 for yes and no.
    `exact` marks a method that promises never to be wrong; `most` limits a slow one's rows of each family. `measured`
    marks one that `verify` leaves to `bench`: it stands beside the paper's methods, and its errors are no finding.
    """

    name: str
    title: str
    question: str
    precision: str
    answer: Callable[[Rows], Answers] = field(repr=False)
    domain: Domain
    exact: bool = False
    max_rows: int | None = None
    measured: bool = False


CHUNK = 8192
"""Rows at a time: the temporaries of one chunk stay in the cache."""

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


def with_reciprocals(formula: Formula, fixed: Collection[str]) -> Formula:
    """The formula with 1/divisor before the loop, for each divisor that depends on the `fixed` inputs alone."""
    program = formula.program
    known = {*fixed, *(step.name for step in hoist(program, fixed).outside)}
    steps = tuple(each for step in program.steps for each in _changed(step, known))
    return replace(formula, name=f"{formula.name}-reciprocal", program=Program(program.name, program.inputs, steps))


def _changed(step: Step, known: Collection[str]) -> Iterator[Step]:
    dividend, divisor = step.arguments if step.operation == "div" else ("", "")
    if step.operation != "div" or divisor not in known or step.name in known:
        yield step
        return
    yield Step(f"per_{step.name}", "div", (1, divisor))
    yield Step(step.name, "mul", (dividend, f"per_{step.name}"))


RECIPROCAL = with_reciprocals(FORMULAS["table-2"], SIZES)
"""Table 2 with additions and products alone in its loop."""
