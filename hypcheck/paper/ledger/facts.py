"""Exact pairs with small numbers, and what a statement about pairs may speak of: Δ, the coefficients, the position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import lcm

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.identities import GENERIC_CUBIC
from hypcheck.derivation.pencil import LAMBDA
from hypcheck.pairs import Pair, Position
from hypcheck.truth import exact

Rational = Callable[..., Fraction]


@dataclass(frozen=True, slots=True)
class Point:
    """The unit sphere about (r, 0, z) and the hyperboloid of semi-axes a and c: by Theorem 1 every pair is one."""

    a: Fraction
    c: Fraction
    r: Fraction
    z: Fraction

    @property
    def cost(self) -> tuple[Fraction | int, ...]:
        """What is less for smaller numbers: the sum of all numerators and denominators, the largest, the numbers."""
        numbers = (self.a, self.c, self.r, self.z)
        sizes = [abs(number.numerator) + number.denominator for number in numbers]
        return (sum(sizes), max(sizes), *numbers)

    @property
    def pair(self) -> Pair:
        """The same in whole numbers, which float64 holds: radial and axial lengths have a unit each."""
        b, d = lcm(self.a.denominator, self.r.denominator), lcm(self.c.denominator, self.z.denominator)
        return Pair(*map(float, (self.a * b, self.c * d, b, d, self.r * b, 0, self.z * d)))


@dataclass(frozen=True, slots=True)
class Facts:
    """What is true of one point. `position` is the exact oracle's, all else from the derivation's polynomials."""

    point: Point
    A: Fraction
    B: Fraction
    Q: Fraction
    c0: Fraction
    c1: Fraction
    c2: Fraction
    delta: Fraction
    slope_at_B: Fraction
    slope_at_minus_A: Fraction
    position: Position

    @property
    def negative_roots(self) -> int:
        """How many real roots of g are below 0, by multiplicity.

        By Descartes' rule, which is exact where all roots are real; where Δ < 0 the one real root is at least B.
        """
        if self.delta < 0:
            return 0
        signs = [number > 0 for number in (Fraction(-1), self.c2, -self.c1, self.c0) if number]
        return sum(one != other for one, other in pairwise(signs))


@dataclass(frozen=True, slots=True)
class Squares:
    """A = (α/b)², B = (γ/d)², P and Q of a pair, whose lengths may be irrational; made of texts like "12/5"."""

    A: Fraction
    B: Fraction
    P: Fraction
    Q: Fraction

    def __init__(self, *texts: str) -> None:
        for name, text in zip(("A", "B", "P", "Q"), texts, strict=True):
            object.__setattr__(self, name, Fraction(text))

    def __str__(self) -> str:
        return f"A = {self.A}, B = {self.B}, P = {self.P}, Q = {self.Q}"


def coefficients(pair: Squares) -> tuple[Fraction, Fraction, Fraction]:
    """c2, c1 and c0 of a pair's g, by the derivation's polynomials."""
    c2, c1, c0 = (_polynomials()[name](pair.A, pair.B, pair.P, pair.Q) for name in ("c2", "c1", "c0"))
    return c2, c1, c0


def discriminant(pair: Squares) -> Fraction:
    """Δ of a pair's g."""
    return _polynomials()["delta"](*coefficients(pair))


def facts(point: Point) -> Facts:
    """The facts of a point."""
    A, B, P, Q = point.a**2, point.c**2, point.r**2, point.z**2
    c0, c1, c2 = (_polynomials()[name](A, B, P, Q) for name in ("c0", "c1", "c2"))
    return _of_coefficients(point, c0, c1, c2, exact.position(point.pair.lengths))


def with_c2(facts: Facts, c2: Fraction) -> Facts:
    """What the facts would be if c2 were another; the position stays what it is."""
    return _of_coefficients(facts.point, facts.c0, facts.c1, c2, facts.position)


def _of_coefficients(point: Point, c0: Fraction, c1: Fraction, c2: Fraction, position: Position) -> Facts:
    A, B, evaluate = point.a**2, point.c**2, _polynomials()
    delta = evaluate["delta"](c2, c1, c0)
    at_B, at_minus_A = evaluate["slope"](c2, c1, B), evaluate["slope"](c2, c1, -A)
    return Facts(point, A, B, point.z**2, c0, c1, c2, delta, at_B, at_minus_A, position)


@cache
def _polynomials() -> dict[str, Rational]:
    derived = pencil.cubic()
    coefficients = tuple(sympy.symbols("c2 c1 c0", real=True))
    polynomials = {
        name: rational((pencil.A, pencil.B, pencil.P, pencil.Q), getattr(derived, name)) for name in ("c0", "c1", "c2")
    }
    polynomials["delta"] = rational(coefficients, pencil.discriminant_of_cubic())
    polynomials["slope"] = rational((*coefficients[:2], LAMBDA), GENERIC_CUBIC.diff(LAMBDA))
    return polynomials


def rational(letters: tuple[sympy.Symbol, ...], expression: sympy.Expr) -> Rational:
    """A function of rationals for an expression with whole coefficients; sums and products of Fractions are exact.

    Raises ValueError for other coefficients, which would be written as floats.
    """
    if any(not number.is_Integer for number in expression.atoms(sympy.Number)):
        raise ValueError(f"{expression} has a coefficient that is no whole number")
    return sympy.lambdify(letters, expression, modules=[{}])  # type: ignore[no-any-return]
