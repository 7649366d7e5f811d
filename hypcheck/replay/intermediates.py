"""A formula evaluated twice on one row, in a machine format and exactly, and where the two part ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.exact_arithmetic import EXACT, Surd
from hypcheck.derivation.float_arithmetic import float_arithmetic, unit_roundoff
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.listing import line_of, steps_of
from hypcheck.derivation.program import BOOLEAN, OPERATIONS, Program, Step, cut
from hypcheck.methods.dual import DISTANCES, searched
from hypcheck.pairs import COLUMNS
from hypcheck.replay.numbers import number_of, rational, relative_error

_DUAL = cut(FORMULAS["dual"].program, DISTANCES, ("above_zero", "positive"))
_DUAL_DECIDED = Program(
    _DUAL.name, _DUAL.inputs, (*_DUAL.steps, *steps_of("side = positive ? 1 : -1\n position = above_zero ? side : 0"))
)
"""What the method of that name evaluates once it has found its λ: the sign of φ, on the side where λ is."""


@dataclass(frozen=True, slots=True)
class Intermediate:
    """One value of a program: what it is computed as, what it is in the machine's format and what it is exactly.

    `value` is a truth value, a Fraction, or a float that is not finite; `exact` is a truth value, a Fraction, a Surd or
    UNDEFINED. `error_u` is the relative error in units u of the format; None of a decision, which is a truth value or
    one of several constants, and of what is undefined in exact arithmetic.
    """

    name: str
    operation: str
    value: object
    exact: object
    error_u: float | None
    decision: bool

    @property
    def decided_otherwise(self) -> bool:
        """Whether it is a decision that exact arithmetic takes otherwise."""
        return self.decision and self.value != self.exact


@dataclass(frozen=True, slots=True)
class Comparison:
    """All values of a formula on one row. `format` is the machine's, `answer` and `exact_answer` what comes out.

    `first_wrong` names the first decision (a comparison) that exact arithmetic takes otherwise, None where there is
    none; `culprit` the number it was taken from whose absolute error is the greatest.
    """

    formula: Formula
    format: str
    values: tuple[Intermediate, ...]
    answer: int
    exact_answer: int
    first_wrong: str | None
    culprit: str | None

    def __getitem__(self, name: str) -> Intermediate:
        """The value of that name; raises KeyError where there is none."""
        for each in self.values:
            if each.name == name:
                return each
        raise KeyError(name)


def compare(formula: Formula, format_name: str, row: tuple[float, ...]) -> Comparison | None:
    """The formula on a valid row in a format of float_arithmetic and exactly.

    The dual form is evaluated at the λ that its method finds in that format; None where that finds no finite one.
    """
    program, machine_inputs, exact_inputs = _dual(format_name, row) if formula.name == "dual" else _plain(formula, row)
    if not exact_inputs:
        return None
    machine = evaluate(program, float_arithmetic(format_name), machine_inputs)
    exact = evaluate(program, EXACT, exact_inputs)
    unit = unit_roundoff(format_name)
    said = {name: f"read as {format_name}" if name in COLUMNS else "from the search for λ" for name in program.inputs}
    said |= {step.name: line_of(step).partition(" = ")[2] for step in program.steps}
    decisions = _decisions(program)
    values = tuple(
        _intermediate(name, said[name], machine[name], exact[name], None if name in decisions else unit)
        for name in machine
    )
    answer = "position" if formula.name == "dual" else formula.answer
    by_name = {each.name: each for each in values}
    wrong = next((step for step in program.steps if by_name[step.name].decided_otherwise), None)
    return Comparison(
        formula=formula,
        format=format_name,
        values=values,
        answer=int(machine[answer]),
        exact_answer=int(exact[answer]),
        first_wrong=wrong.name if wrong else None,
        culprit=_culprit(wrong, by_name) if wrong else None,
    )


Prepared = tuple[Program, Mapping[str, Any], Mapping[str, Any]]


def _plain(formula: Formula, row: tuple[float, ...]) -> Prepared:
    columns = dict(zip(COLUMNS, row, strict=True))
    return formula.program, columns, columns


def _dual(format_name: str, row: tuple[float, ...]) -> Prepared:
    found = {name: values[0] for name, values in searched(np.array([row]), format_name).items()}
    if not all(np.isfinite(found[name]) for name in DISTANCES):
        return _DUAL_DECIDED, found, {}
    columns = dict(zip(COLUMNS, map(Fraction, row), strict=True))
    at = number_of(found["lambda_"])
    A, B = (columns["alpha"] / columns["b"]) ** 2, (columns["gamma"] / columns["d"]) ** 2
    return _DUAL_DECIDED, found, {**columns, **dict(zip(DISTANCES, (at, A + at, B - at), strict=True))}


def _decisions(program: Program) -> set[str]:
    """The names of truth values, and of what chooses between constants by them."""
    found: set[str] = set()
    for step in program.steps:
        chosen = step.arguments[1:] if step.operation == "select" else ()
        of_constants = bool(chosen) and all(isinstance(each, int) or each in found for each in chosen)
        if OPERATIONS[step.operation].gives == BOOLEAN or of_constants:
            found.add(step.name)
    return found


def _intermediate(name: str, said: str, machine: Any, exact: object, unit: float | None) -> Intermediate:  # noqa: ANN401
    value = number_of(machine)
    error = None if unit is None else relative_error(value, exact)
    return Intermediate(name, said, value, exact, None if error is None or unit is None else error / unit, unit is None)


def _culprit(wrong: Step, values: Mapping[str, Intermediate]) -> str | None:
    """Of the numbers that a decision compares, the one whose absolute error is the greatest."""
    numbers = [values[name] for name in wrong.reads]
    return max(numbers, key=_absolute_error).name if numbers else None


def _absolute_error(each: Intermediate) -> tuple[int, Fraction]:
    """Ordered as the error is: what is not finite, or undefined in exact arithmetic, before all others."""
    if not isinstance(each.value, Fraction) or not isinstance(each.exact, (Fraction, Surd)):
        return (1, Fraction(0))
    return (0, abs(rational(each.exact - each.value)))
