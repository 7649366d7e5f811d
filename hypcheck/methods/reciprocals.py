"""A formula without divisions by what the sizes fix: products with reciprocals that are computed once, before the loop.

They round once more than the division does, so this is another formula with other answers, next to touching.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.hoisting import hoist
from hypcheck.derivation.program import Program, Step
from hypcheck.pairs import SIZES


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
