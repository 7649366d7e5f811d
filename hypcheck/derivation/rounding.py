"""Bounds of rounding errors, counted from a program.

Let u be the unit roundoff, and F_k the interval [(1−u)^k, (1−u)^−k]. Every operation rounded to nearest, without
overflow or underflow, returns the exact result of its operands times some 1+δ, |δ| ≤ u, which lies in F_1 because
1+u ≤ 1/(1−u). Products of members of F_j and F_k lie in F_(j+k), reciprocals stay in F_k, and so do weighted means.

Claim: for every step, with v its exact value written as a sum of terms t_j (monomials in the inputs, divided by
denominators where there are some), the computed value is the sum of t_j f_j with every f_j in F_k, k being its count.
Hence |computed − v| ≤ ((1−u)^−k − 1) M ≤ γ_k M with M = Σ|t_j| and γ_k = ku/(1−ku), for ku < 1. By induction:

    input        k = 0 where it is a number of the format, 1 where it is rounded on entry;  M = |input|
    constant     k = 0;  M = |constant|
    −a, |a|      k = k_a, no rounding;  M = M_a. For |a| a sum of terms of different signs has no such form: refused.
    a ± b        each f_j gains one factor of F_1: k = max(k_a, k_b) + 1;  M = M_a + M_b
    a · b        terms and factors multiply, one rounding more: k = k_a + k_b + 1;  M = M_a M_b
    2^n · a      rounds nothing: k = k_a;  M = 2^n M_a
    a / b        b must be a sum of terms of one sign. Then the computed b is b times a weighted mean of the f_j, so b
                 times a member of F_(k_b), and its reciprocal too: k = k_a + k_b + 1;  M = M_a / M_b, as |b| = M_b
    √a           a likewise of one sign, and positive: √f lies in F_(⌈k/2⌉): k = ⌈k_a/2⌉ + 1;  M = √M_a

M is itself a program: the same operations on |inputs| with every subtraction an addition. It has no cancellation, and
its steps round no more often, so in floating point M is known up to a factor in F_k, and |computed − v| is at most
((1−u)^−k − 1)(1−u)^−k ≤ ku/(1−ku)² times the *computed* M. FMA only removes roundings, so it is allowed, not needed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.program import BOOLEAN, NUMBER, Argument, Program, Step, kind_of, needed
from hypcheck.geometry.pair import SIZES

POSITIVE_INPUTS = frozenset({*SIZES, "b_s", "d_s", "l"})
"""Inputs that are lengths of bodies, hence > 0."""


@dataclass(frozen=True, slots=True)
class ErrorCounts:
    """The bound |computed − exact| ≤ γ_k · M of each covered step whose result is a number.

    By the name of the step, `counts` has k, and `magnitudes` has the name of M in `program`, or M itself if it is an
    integer.
    """

    program: Program
    counts: dict[str, int]
    magnitudes: dict[str, Argument]


@dataclass(frozen=True, slots=True)
class _Term:
    """Facts about a value: its count of roundings k, its magnitude M, and the common sign of its terms.

    `magnitude` is the name of M, or M itself if it is an integer. `one_signed` is true if all terms have the same sign.
    `sign` is that sign, +1 or −1, or None if it is not known beforehand, as that of a coordinate.
    """

    count: int
    magnitude: Argument
    one_signed: bool
    sign: int | None = None


def relative_error_counts(
    program: Program,
    wanted: Iterable[str],
    positive: Collection[str] = POSITIVE_INPUTS,
    input_roundings: int = 0,
) -> ErrorCounts:
    """Derive the error bound of the wanted steps and of all number steps that they depend on.

    `positive` names the inputs that are always > 0; `input_roundings` is 1 where inputs are rounded on entry.
    Raises ValueError for a step that the claim above does not cover: a division by or a root of what may be a sum of
    terms of different signs, its absolute value, and selection.
    """
    steps = needed(program, tuple(wanted))
    terms: dict[str, _Term] = {}
    written: list[Step] = []
    for name in program.inputs:
        known = name in positive
        magnitude = name if known else f"magnitude_{name}"
        if not known:
            written.append(Step(magnitude, "abs", (name,)))
        terms[name] = _Term(input_roundings, magnitude, one_signed=True, sign=1 if known else None)
    kinds = dict.fromkeys(program.inputs, NUMBER)
    for step in steps:
        kinds[step.name] = kind_of(step, kinds)
        if kinds[step.name] == BOOLEAN:
            continue
        terms[step.name] = _term_of(step, terms, written)
    return ErrorCounts(
        Program(f"{program.name}-magnitudes", program.inputs, tuple(written)),
        {name: term.count for name, term in terms.items()},
        {name: term.magnitude for name, term in terms.items()},
    )


def gamma(count: int, unit_roundoff: Fraction) -> Fraction:
    """Return γ_k = ku/(1−ku), exactly, for the `count` k. Raises ValueError if ku ≥ 1: then the claim says nothing."""
    product = count * unit_roundoff
    if product >= 1:
        raise ValueError(f"{count} roundings of up to {unit_roundoff} bound nothing")
    return product / (1 - product)


def _term_of(step: Step, terms: dict[str, _Term], written: list[Step]) -> _Term:
    """Return the facts about the step's result.

    `terms` has the facts about earlier values by name. If a step is needed to compute the magnitude, it is appended to
    `written`.
    """
    rule = RULES.get(step.operation)
    if rule is None:
        raise ValueError(f"step {step.name}: no bound is derived for {step.operation}")
    arguments = [_argument(argument, terms) for argument in step.arguments]
    try:
        count, one_signed, sign = rule(step, arguments)
    except ValueError as error:
        raise ValueError(f"step {step.name}: {error}") from None
    if step.operation in {"neg", "abs"}:
        return _Term(count, arguments[0].magnitude, one_signed, sign)
    name = f"magnitude_{step.name}"
    operation = "add" if step.operation == "sub" else step.operation
    written.append(Step(name, operation, tuple(term.magnitude for term in arguments)))
    return _Term(count, name, one_signed, sign)


def _argument(argument: Argument, terms: dict[str, _Term]) -> _Term:
    """Return the facts about an argument: of a name those found before, of a constant its own."""
    if isinstance(argument, str):
        return terms[argument]
    return _Term(0, abs(argument), one_signed=True, sign=-1 if argument < 0 else 1)


_Rule = tuple[int, bool, int | None]
"""Of a step's result k, whether all terms have one sign, and that sign, None if it is not known."""


def _sum(step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for a sum or a difference."""
    left, right = terms
    right_sign = _flipped(right.sign) if step.operation == "sub" else right.sign
    shared = left.sign is not None and left.sign == right_sign
    alike = left.one_signed and right.one_signed and shared
    return max(left.count, right.count) + 1, alike, left.sign if alike else None


def _product(step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for a product."""
    left, right = terms
    exact = any(_is_power_of_two(argument) for argument in step.arguments)
    one_signed = left.one_signed and right.one_signed
    is_square = step.arguments[0] == step.arguments[1]
    sign = 1 if is_square else _times(left.sign, right.sign)
    return left.count + right.count + (0 if exact else 1), one_signed, sign if one_signed else None


def _quotient(_step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for a quotient. Raises ValueError if the terms of the divisor may have different signs."""
    left, right = terms
    if not right.one_signed:
        raise ValueError("the divisor may be a sum of terms of different signs")
    one_signed = left.one_signed
    return left.count + right.count + 1, one_signed, _times(left.sign, right.sign) if one_signed else None


def _root(_step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for a root. Raises ValueError if the terms of the argument may have different signs."""
    (term,) = terms
    if not term.one_signed or term.sign != 1:
        raise ValueError("the root's argument may be a sum of terms of different signs, or negative")
    return -(-term.count // 2) + 1, True, 1


def _negated(_step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for a change of sign."""
    (term,) = terms
    return term.count, term.one_signed, _flipped(term.sign)


def _absolute(_step: Step, terms: list[_Term]) -> _Rule:
    """Apply the rule for the absolute value. Raises ValueError if the terms may have different signs."""
    (term,) = terms
    if not term.one_signed:
        raise ValueError("the absolute value's argument may be a sum of terms of different signs")
    return term.count, True, 1


RULES = {
    "add": _sum,
    "sub": _sum,
    "mul": _product,
    "div": _quotient,
    "sqrt": _root,
    "neg": _negated,
    "abs": _absolute,
}


def _flipped(sign: int | None) -> int | None:
    """Return the opposite sign, None if it is not known."""
    return None if sign is None else -sign


def _times(left: int | None, right: int | None) -> int | None:
    """Return the sign of a product of two signs, None if one is not known."""
    return None if left is None or right is None else left * right


def _is_power_of_two(argument: Argument) -> bool:
    """Decide whether an argument is a constant ±2^n, with which a product is exact."""
    return isinstance(argument, int) and argument != 0 and abs(argument) & (abs(argument) - 1) == 0
