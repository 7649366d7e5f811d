"""Defines methods: a name, a domain, and a function from rows to answers; and makes formulas methods in numpy.

A formula is evaluated chunk by chunk. For a scene, the steps that depend on sizes only are evaluated once. Names of a
program are looked up once, so that a timing measures little besides the arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import Evaluator
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.program import Program, Step, hoist, split
from hypcheck.geometry.pair import COLUMNS, SIZES, Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.domain import ORDINARY, Domain

Answers = NDArray[np.int8]


@dataclass(frozen=True)
class MethodClaims:
    """A method's name, title and claims, for `verify` and `bench`.

    `question` and `precision` are those of judge.Criterion. `domain` is where the method claims to be right. `exact`
    marks a method that is never wrong. `needs` names the software that may be absent here, or is empty.
    """

    name: str
    title: str
    _: KW_ONLY
    question: str = "position"
    precision: str = "float64"
    domain: Domain = ORDINARY
    exact: bool = False
    needs: str = ""


@dataclass(frozen=True)
class Method(MethodClaims):
    """A method in this process.

    `answer` maps valid rows, float64 (n, 7) or of sweeps (n, 10), to answers, int8 (n,): +1, 0, −1 for a position, 1
    and 0 for yes and no; with `tilt` its rows have an axis. `max_rows` limits the rows of each family for a slow one.
    `measured` marks a method that only `bench` uses: its errors are no finding of `verify`. `timed` stands in the place
    of `answer` where a method also gives the times of hits. `scene` is the function for rows that share their sizes,
    and their axis if they have one: it takes the sizes, the columns of the centres, and the axis; without it such rows
    are as any others.
    """

    answer: Callable[[Rows], Answers] = field(repr=False)
    _: KW_ONLY
    max_rows: int | None = None
    measured: bool = False
    tilt: bool = False
    timed: Callable[[Rows], tuple[Answers, Floats]] | None = field(default=None, repr=False)
    scene: Callable[..., Answers] | None = field(default=None, repr=False)


CHUNK = 8192
"""How many rows are computed at a time: their temporary arrays stay in the cache."""

ByColumns = Callable[[Mapping[str, Any]], NDArray[Any]]
"""A function from the seven columns by name, (n,) each or a number for a size, to answers (n,)."""

ByRows = Callable[[Rows], Answers]
ByScene = Callable[[Sizes, Floats, Floats, Floats], Answers]


def on_rows(answer: ByColumns) -> ByRows:
    """Return the function on rows (n, 7), a chunk at a time."""
    return lambda rows: in_chunks(len(rows), lambda part: answer(dict(zip(COLUMNS, rows[part].T, strict=True))))


def on_scene(answer: ByColumns, before: Callable[[Mapping[str, Any]], Mapping[str, Any]] = dict) -> ByScene:
    """Return the function on many centres and one α, γ, b, d; it gets the results of `before`, computed once a call."""

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        known = before(dict(zip(SIZES, sizes, strict=True)))
        return in_chunks(len(x), lambda part: answer({**known, "x": x[part], "y": y[part], "z": z[part]}))

    return answers


def by_rows(formula: Formula, format_name: str) -> ByRows:
    """Return the formula on rows in one float format: a function to answers, int8 (n,)."""
    ready = Evaluator(formula.program, float_arithmetic(format_name), (formula.answer,))
    return on_rows(lambda columns: ready(columns)[0])


def by_scene(formula: Formula, format_name: str) -> ByScene:
    """Return the formula for many centres and one α, γ, b, d.

    Steps that depend on these only are evaluated once a call.

    The first call makes the evaluators, which take longer than a run without scenes needs to list its methods.
    """

    @cache
    def ready() -> ByScene:
        first, then = parts(formula)
        arithmetic, names = float_arithmetic(format_name), tuple(step.name for step in first.steps)
        outside, inside = Evaluator(first, arithmetic, names), Evaluator(then, arithmetic, (formula.answer,))
        return on_scene(
            lambda columns: inside(columns)[0], lambda sizes: {**sizes, **dict(zip(names, outside(sizes), strict=True))}
        )

    def answers(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
        return ready()(sizes, x, y, z)

    return answers


@cache
def parts(formula: Formula) -> tuple[Program, Program]:
    """Return the formula's program in two parts: the steps that depend on sizes only, and the rest."""
    return split(formula.program, (formula.answer,), SIZES)


def in_chunks(count: int, answer: Callable[[slice], Any]) -> Answers:
    """Return the answers of `count` rows, CHUNK at a time; int8 (n,)."""
    answers = np.empty(count, dtype=np.int8)
    for start in range(0, count, CHUNK):
        part = slice(start, start + CHUNK)
        answers[part] = answer(part)
    return answers


def with_reciprocals(formula: Formula, fixed: Collection[str]) -> Formula:
    """Return the formula with 1/divisor before the loop, for each divisor that depends on the `fixed` inputs only.

    The products round once more than the division, so this is another formula with other answers near contact.
    """
    program = formula.program
    known = {*fixed, *(step.name for step in hoist(program, fixed).outside)}
    steps = tuple(part for step in program.steps for part in _changed(step, known))
    return replace(formula, name=f"{formula.name}-reciprocal", program=Program(program.name, program.inputs, steps))


def _changed(step: Step, known: Collection[str]) -> Iterator[Step]:
    """Yield the step, or two for it: the reciprocal of its divisor, and the product with that."""
    dividend, divisor = step.arguments if step.operation == "div" else ("", "")
    if step.operation != "div" or divisor not in known or step.name in known:
        yield step
        return
    yield Step(f"per_{step.name}", "div", (1, divisor))
    yield Step(step.name, "mul", (dividend, f"per_{step.name}"))


RECIPROCAL = with_reciprocals(FORMULAS["table-2"], SIZES)
"""Table 2 with only additions and products in its loop."""
