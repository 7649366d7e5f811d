"""The intermediate values of a formula on one row, in floats and exactly, to compare with an implementation.

The formula is the implementation's own, the requested one, or one that gives the implementation's answer. Values are
shown with a few digits, and every digit is right.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic, unit_roundoff
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.program import BOOLEAN, OPERATIONS, Program, Step, cut, line_of, steps_of
from hypcheck.errors import InputError
from hypcheck.geometry.arithmetic import QuadraticSurd, root_of
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.geometry.rows import Row
from hypcheck.implementations.alternatives import DISTANCES, searched
from hypcheck.implementations.description import Description
from hypcheck.implementations.implementation import Implementation

DIGITS = 8
_GUARD = 8

Number = Fraction | QuadraticSurd


def number_of(value: Any) -> bool | float | Fraction:  # noqa: ANN401 - any scalar of numpy
    """Return a machine value as a truth value, the exact value of a finite number, or an infinity or NaN as a float."""
    scalar: Any = np.asarray(value)[()]
    if isinstance(scalar, np.bool_):
        return bool(scalar)
    if not np.isfinite(scalar):
        return float(scalar)
    return Fraction(*scalar.as_integer_ratio())


def rational(value: Number, bits: int = 64) -> Fraction:
    """Return a rational within a relative 2^−bits of the value; the value itself if it is rational."""
    if not isinstance(value, QuadraticSurd):
        return value
    # p and q√h of equal sign cannot cancel. Else p + q√h = (p² − q²h)/(p − q√h), and p, −q√h have equal sign.
    if value.p * value.q < 0:
        return (value.p**2 - value.q**2 * value.h) / rational(QuadraticSurd(value.p, -value.q, value.h), bits + 1)
    # root_of rounds √h down to a multiple of 2^−s, and √h > 2^(bits + 1 − s): the error is below 2^−(bits + 1) · √h.
    return value.p + value.q * root_of(value.h, bits + 1)


def number_text(value: object, digits: int = DIGITS) -> str:
    """Return the text of a value: yes or no, "undefined", inf or nan, or a number with `digits` digits."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (Fraction, QuadraticSurd)):
        return _decimal(rational(value, 4 * digits + _GUARD), digits)
    return str(value)


def _decimal(value: Fraction, digits: int) -> str:
    """Return a rational with that many digits, without an exponent if that is short, without zeros at the end."""
    context = Context(prec=digits, Emin=-(10**9), Emax=10**9)
    rounded = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    if not rounded:
        return "0"
    exponent = rounded.adjusted()
    if -4 <= exponent < digits:
        return _trimmed(f"{rounded:f}")
    return f"{_trimmed(f'{rounded.scaleb(-exponent, context):f}')}e{exponent}"


def _trimmed(text: str) -> str:
    """Remove zeros, and then the point, at the end of a decimal text with a point."""
    return text.rstrip("0").rstrip(".") if "." in text else text


def relative_error(value: object, exact: object) -> float | None:
    """Compute |value − exact|/|exact|: 0 if both are equal, inf if `exact` is 0 or `value` is not finite.

    None if they are not numbers.
    """
    if isinstance(value, bool) or not isinstance(exact, (Fraction, QuadraticSurd)):
        return None
    if not isinstance(value, Fraction):
        return math.inf
    if exact == 0:
        return 0.0 if value == 0 else math.inf
    error = abs(rational(exact - value) / rational(exact))
    try:
        return float(error) or (math.ulp(0.0) if error else 0.0)
    except OverflowError:
        return math.inf


_DUAL = cut(FORMULAS["dual"].program, DISTANCES, ("above_zero", "positive"))
_DUAL_DECIDED = Program(
    _DUAL.name, _DUAL.inputs, (*_DUAL.steps, *steps_of("side = positive ? 1 : -1\n position = above_zero ? side : 0"))
)
"""The program that the method "dual" evaluates once it has found its λ: the sign of φ, on the side of λ."""


@dataclass(frozen=True, slots=True)
class Intermediate:
    """One value of a program: its name, its operation, its value in the machine's format, and its exact value.

    `value` is a truth value, a Fraction, or a float that is not finite; `exact` is a truth value, a Fraction, a
    QuadraticSurd or UNDEFINED. `error_u` is the relative error in units u of the format. It is None for a decision,
    which is a truth value or one of several constants, and for values that are undefined in exact arithmetic.
    """

    name: str
    operation: str
    value: object
    exact: object
    error_u: float | None
    decision: bool

    @property
    def decided_otherwise(self) -> bool:
        """Whether exact arithmetic gives the opposite decision."""
        return self.decision and self.value != self.exact


@dataclass(frozen=True, slots=True)
class FormulaComparison:
    """All values of a formula on one row, by name; `format` is the machine's.

    `answer` and `exact_answer` are the two results. `first_wrong` names the first decision (a comparison) that differs
    from exact arithmetic, or is None; `culprit` names the number in that decision with the greatest absolute error.
    """

    formula: Formula
    format: str
    values: Mapping[str, Intermediate]
    answer: int
    exact_answer: int
    first_wrong: str | None
    culprit: str | None


def compare_formula(formula: Formula, format_name: str, row: Row) -> FormulaComparison | None:
    """Evaluate a formula on a valid row, in a format of float_arithmetic and exactly.

    The dual form is evaluated at the λ that its method finds in that format. The result is None if that λ is not
    finite.
    """
    program, machine_inputs, exact_inputs = _dual(format_name, row) if formula.name == "dual" else _plain(formula, row)
    if not exact_inputs:
        return None
    machine = evaluate(program, float_arithmetic(format_name), machine_inputs)
    exact = evaluate(program, EXACT, exact_inputs)
    unit = unit_roundoff(format_name)
    meanings = {
        name: f"read as {format_name}" if name in COLUMNS else "from the search for λ" for name in program.inputs
    }
    meanings |= {step.name: line_of(step).partition(" = ")[2] for step in program.steps}
    decisions = _decisions(program)
    values = {
        name: _intermediate(name, meanings[name], machine[name], exact[name], None if name in decisions else unit)
        for name in machine
    }
    answer = "position" if formula.name == "dual" else formula.answer
    wrong = next((step for step in program.steps if values[step.name].decided_otherwise), None)
    return FormulaComparison(
        formula=formula,
        format=format_name,
        values=values,
        answer=int(machine[answer]),
        exact_answer=int(exact[answer]),
        first_wrong=wrong.name if wrong else None,
        culprit=_culprit(wrong, values) if wrong else None,
    )


Prepared = tuple[Program, Mapping[str, Any], Mapping[str, Any]]


def _plain(formula: Formula, row: Row) -> Prepared:
    """Return the program of a formula, and its inputs for floats and for exact arithmetic."""
    columns = dict(zip(COLUMNS, row, strict=True))
    return formula.program, columns, columns


def _dual(format_name: str, row: Row) -> Prepared:
    """Return the program of the dual form, and its inputs at the λ that its search finds, in floats and exactly.

    There are no exact inputs if that λ is not finite.
    """
    numbers = {
        name: values[0]
        for name, values in searched(dict(zip(COLUMNS, np.array([row]).T, strict=True)), format_name).items()
    }
    if not all(np.isfinite(numbers[name]) for name in DISTANCES):
        return _DUAL_DECIDED, numbers, {}
    columns = dict(zip(COLUMNS, map(Fraction, row), strict=True))
    at = number_of(numbers["lambda_"])
    A, B = (columns["alpha"] / columns["b"]) ** 2, (columns["gamma"] / columns["d"]) ** 2
    return _DUAL_DECIDED, numbers, {**columns, **dict(zip(DISTANCES, (at, A + at, B - at), strict=True))}


def _decisions(program: Program) -> set[str]:
    """Return the names of the steps that give truth values, or select one of several constants by a truth value."""
    names: set[str] = set()
    for step in program.steps:
        chosen = step.arguments[1:] if step.operation == "select" else ()
        of_constants = bool(chosen) and all(isinstance(argument, int) or argument in names for argument in chosen)
        if OPERATIONS[step.operation].gives == BOOLEAN or of_constants:
            names.add(step.name)
    return names


def _intermediate(name: str, operation: str, machine: Any, exact: object, unit: float | None) -> Intermediate:  # noqa: ANN401
    """Return one value of a program. `unit` is u, for its error; None for a decision, which has no error."""
    value = number_of(machine)
    error = None if unit is None else relative_error(value, exact)
    return Intermediate(
        name, operation, value, exact, None if error is None or unit is None else error / unit, unit is None
    )


def _culprit(wrong: Step, values: Mapping[str, Intermediate]) -> str | None:
    """Return the name of the number with the greatest absolute error in a wrong decision; None if it reads none."""
    numbers = [values[name] for name in wrong.reads]
    return max(numbers, key=_absolute_error).name if numbers else None


def _absolute_error(intermediate: Intermediate) -> tuple[int, Fraction]:
    """Return a key that sorts by error; numbers that are not finite, or undefined in exact arithmetic, come last."""
    if not isinstance(intermediate.value, Fraction) or not isinstance(intermediate.exact, (Fraction, QuadraticSurd)):
        return (1, Fraction(0))
    return (0, abs(rational(intermediate.exact - intermediate.value)))


SHOWN_FORMULAS = tuple(name for name, formula in FORMULAS.items() if formula.classifies_pairs or name == "dual")
"""The formulas that can be shown: those that take a pair only, and the dual form at the λ that it finds."""

PREFERRED_FORMULA = "table-2"

_MANTISSA = {"x87": 63, "binary128": 112}


@dataclass(frozen=True, slots=True)
class FormulaChoice:
    """A formula's values on the row, and why it was chosen; `comparison` is None if there are no values.

    `own` says that the implementation evaluates this formula. Errors of another formula say nothing about it.
    """

    comparison: FormulaComparison | None
    why: str
    own: bool = False


def require_formula(name: str | None) -> None:
    """Raise InputError if a formula with that name cannot be shown."""
    if name is not None and name not in SHOWN_FORMULAS:
        raise InputError(f"there is no formula {name!r} that takes a pair; there are {', '.join(SHOWN_FORMULAS)}")


def choose_formula(
    implementation: Implementation, answer: int | None, row: Row, truth: Position, name: str | None
) -> FormulaChoice:
    """Return the formula to show for a valid row: the one with that name, or else the nearest to the implementation.

    `answer` is the implementation's, None if there is none. A built-in formula is shown in its own precision; other
    formulas in the precision of the description in use.
    """
    own = _of_builtin(implementation)
    format_name, instead = format_of((implementation.declared if own else implementation.description).precision)
    formula = FORMULAS[name] if name is not None else own
    if formula is None:
        return _nearest(implementation.description, answer, row, truth, format_name, instead)
    comparison = compare_formula(formula, format_name, row)
    if comparison is None:
        return FormulaChoice(None, f"the search of {formula.name} finds no finite λ in {format_name}", formula is own)
    why = "as --formula asks" if name is not None else f"which is what {implementation.spec} evaluates"
    return FormulaChoice(comparison, why + instead, formula is own)


def format_of(precision: str) -> tuple[str, str]:
    """Return the numpy format for a declared precision, and a note ("" if the format has exactly that precision)."""
    if precision in ("float16", "float32", "float64"):
        return precision, ""
    if np.finfo(np.longdouble).nmant == _MANTISSA.get(precision):
        return "longdouble", ""
    instead = {"bfloat16": "float32", "exact": "float64"}.get(precision, "longdouble")
    return instead, f"; numpy has no {precision}, so {instead} is used"


def _of_builtin(implementation: Implementation) -> Formula | None:
    """Return the formula that a built-in implementation evaluates; None for any other."""
    if implementation.spec.kind != "builtin":
        return None
    return FORMULAS.get(implementation.spec.words[0].removesuffix(f"-{implementation.declared.precision}"))


def _nearest(
    used: Description, answer: int | None, row: Row, truth: Position, format_name: str, instead: str
) -> FormulaChoice:
    """Return a formula whose answer is as right or wrong as the implementation's; PREFERRED_FORMULA is tried first.

    Only formulas about a comparable question are tried. A formula with the same error explains a wrong answer. An
    answer "no" that leaves several positions possible would explain nothing.
    """
    comparable = _comparable(used.question)
    comparisons = [compared for formula in comparable if (compared := compare_formula(formula, format_name, row))]
    if answer is None:
        return FormulaChoice(comparisons[0], f"there being no answer to compare formulas with{instead}")
    right = _positions(answer, used.question)
    errs = truth not in right
    for compared in comparisons:
        left = _positions(compared.answer, compared.formula.question)
        if right & left and (truth not in left) is errs:
            return FormulaChoice(compared, f"which in {format_name} answers as {used.name} does{instead}")
    return FormulaChoice(comparisons[0], f"though no formula in {format_name} answers as {used.name} does{instead}")


def _comparable(question: str) -> Iterator[Formula]:
    """Yield formulas whose answers can be compared with answers to the question, the preferred one first."""
    names = sorted(SHOWN_FORMULAS, key=lambda name: name != PREFERRED_FORMULA)
    for formula in (FORMULAS[name] for name in names if FORMULAS[name].classifies_pairs):
        if formula.question == question or "position" in (formula.question, question):
            yield formula


def _positions(answer: int, question: str) -> set[Position]:
    """Return the positions for which the answer to the question is right."""
    if question == "position":
        return {Position(answer)}
    position = Position[question.upper()]
    return {position} if answer else set(Position) - {position}
