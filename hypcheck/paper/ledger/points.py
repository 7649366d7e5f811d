"""Small rational points, the facts of each, and the search for counterexamples and examples among them.

A point is an exact pair with small numbers; its facts are the values that a statement about pairs can use: Δ, the
coefficients, the position. Statements are tested everywhere and on thin sets, where a sign that a statement tests is 0:
there statements fail. Each thin set is a stratum: its points come from the derivation's polynomials, solved for one
number of the point, and are kept if that number is rational. The space is finite and ordered, the simplest point first.
So a search that finds a counterexample finds the simplest one, and a search that finds none has tried every point.
Every point found gets a certificate.

The last part searches for the simplest pairs whose position changes when the spheroid's axis is not vertical.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise, product
from math import gcd, isqrt, lcm
from typing import Generic, TypeVar

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.pencil import C0, C1, C2, GENERIC_CUBIC, LAMBDA, A, B, P, Q
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.prove import prove

Rational = Callable[..., Fraction]


@dataclass(frozen=True, slots=True)
class Point:
    """The unit sphere about (r, 0, z) and the hyperboloid with semi-axes a, c: Theorem 1 reduces every pair to it."""

    a: Fraction
    c: Fraction
    r: Fraction
    z: Fraction

    @property
    def cost(self) -> tuple[Fraction | int, ...]:
        """A key, less for smaller numbers: the sum of all numerators and denominators, the largest, the numbers."""
        numbers = (self.a, self.c, self.r, self.z)
        sizes = [abs(number.numerator) + number.denominator for number in numbers]
        return (sum(sizes), max(sizes), *numbers)

    @property
    def pair(self) -> Pair:
        """The pair in whole numbers that float64 holds; radial and axial lengths have separate units."""
        b, d = lcm(self.a.denominator, self.r.denominator), lcm(self.c.denominator, self.z.denominator)
        return Pair(*map(float, (self.a * b, self.c * d, b, d, self.r * b, 0, self.z * d)))


@dataclass(frozen=True, slots=True)
class PointFacts:
    """The facts of a point. `position` is the exact oracle's; the others are from the derivation's polynomials."""

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
        """The number of real roots of g below 0, with multiplicity.

        By Descartes' rule, which is exact if all roots are real; if Δ < 0, the only real root is at least B.
        """
        if self.delta < 0:
            return 0
        signs = [number > 0 for number in (Fraction(-1), self.c2, -self.c1, self.c0) if number]
        return sum(one != other for one, other in pairwise(signs))


@dataclass(frozen=True, slots=True)
class SquaredRatios:
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


def coefficients(pair: SquaredRatios) -> tuple[Fraction, Fraction, Fraction]:
    """Compute c2, c1 and c0 of a pair's g, by the derivation's polynomials."""
    c2, c1, c0 = (_polynomials()[name](pair.A, pair.B, pair.P, pair.Q) for name in ("c2", "c1", "c0"))
    return c2, c1, c0


def discriminant(pair: SquaredRatios) -> Fraction:
    """Compute Δ of a pair's g."""
    return _polynomials()["delta"](*coefficients(pair))


def facts(point: Point) -> PointFacts:
    """Compute the facts of a point."""
    A, B, P, Q = point.a**2, point.c**2, point.r**2, point.z**2
    c0, c1, c2 = (_polynomials()[name](A, B, P, Q) for name in ("c0", "c1", "c2"))
    pair = Lengths.of((point.a, point.c, 1, 1, point.r, 0, point.z))
    return _of_coefficients(point, c0, c1, c2, exact.position(pair))


def with_c2(facts: PointFacts, c2: Fraction) -> PointFacts:
    """Return the facts with another c2; the position is unchanged."""
    return _of_coefficients(facts.point, facts.c0, facts.c1, c2, facts.position)


def _of_coefficients(point: Point, c0: Fraction, c1: Fraction, c2: Fraction, position: Position) -> PointFacts:
    A, B, evaluate = point.a**2, point.c**2, _polynomials()
    delta = evaluate["delta"](c2, c1, c0)
    at_B, at_minus_A = evaluate["slope"](c2, c1, B), evaluate["slope"](c2, c1, -A)
    return PointFacts(point, A, B, point.z**2, c0, c1, c2, delta, at_B, at_minus_A, position)


@cache
def _polynomials() -> dict[str, Rational]:
    """Return functions for c0, c1, c2, Δ and g' by name, from the derivation's polynomials."""
    derived = pencil.cubic()
    polynomials = {
        name: rational((pencil.A, pencil.B, pencil.P, pencil.Q), getattr(derived, name)) for name in ("c0", "c1", "c2")
    }
    polynomials["delta"] = rational((C2, C1, C0), pencil.discriminant_of_cubic())
    polynomials["slope"] = rational((C2, C1, LAMBDA), GENERIC_CUBIC.diff(LAMBDA))
    return polynomials


def rational(letters: tuple[sympy.Symbol, ...], expression: sympy.Expr) -> Rational:
    """Return a function that computes an expression in these letters exactly, from Fractions.

    Raises ValueError for coefficients that are not whole, which would become floats.
    """
    if any(not number.is_Integer for number in expression.atoms(sympy.Number)):
        raise ValueError(f"{expression} has a coefficient that is not a whole number")
    return sympy.lambdify(letters, expression, modules=[{}])  # type: ignore[no-any-return]


ZERO = Fraction(0)


@dataclass(frozen=True, slots=True)
class PointStratum:
    """A set of points with a name that describes their special property."""

    name: str
    points: Callable[[], Iterable[Point]]


def numbers(height: int) -> tuple[Fraction, ...]:
    """Return the positive rationals in lowest terms whose numerator and denominator are at most `height`."""
    sizes = range(1, height + 1)
    return tuple(Fraction(top, bottom) for top, bottom in product(sizes, sizes) if gcd(top, bottom) == 1)


def strata() -> tuple[PointStratum, ...]:
    """Return all strata."""
    return (
        PointStratum("anywhere", lambda: _grid(numbers(3), numbers(3), _with_0(3), _with_0(3))),
        PointStratum("the waist, z = 0", lambda: _grid(numbers(4), numbers(4), _with_0(6), (ZERO,))),
        PointStratum("the axis, r = 0", lambda: _grid(numbers(4), numbers(4), (ZERO,), _with_0(6))),
        PointStratum("a = 1", lambda: _grid((Fraction(1),), numbers(4), _with_0(4), _with_0(4))),
        PointStratum(
            "c² = a", lambda: (Point(c**2, c, r, z) for c, r, z in product(numbers(4), _with_0(4), _with_0(4)))
        ),
        PointStratum(
            "a narrow throat, a and c at most 1/4", lambda: _grid(_parts(8), _parts(10), _with_0(4), _with_0(2))
        ),
        PointStratum("c1 = 0", lambda: _solved(pencil.cubic().c1)),
        PointStratum("c2 = 0", lambda: _solved(pencil.cubic().c2)),
        PointStratum("g'(B) = 0 at the waist", lambda: _solved(_slope().subs(LAMBDA, B), 12, (ZERO,))),
        PointStratum("g'(−A) = 0", lambda: _solved(_slope().subs(LAMBDA, -A))),
        PointStratum("double roots", _double_roots),
    )


@cache
def space() -> tuple[Point, ...]:
    """Return the points of all strata, each once, the simplest first."""
    return tuple(sorted({point for stratum in strata() for point in stratum.points()}, key=lambda point: point.cost))


def facts_in_order() -> Iterator[PointFacts]:
    """Yield the facts of every point of the space, the simplest first; each is found once in a process."""
    for place, point in enumerate(space()):
        if place == len(_FOUND):
            _FOUND.append(facts(point))
        yield _FOUND[place]


_FOUND: list[PointFacts] = []


def _slope() -> sympy.Expr:
    return pencil.cubic().g.diff(LAMBDA)


def _with_0(height: int) -> tuple[Fraction, ...]:
    """Return 0 and the numbers up to `height`."""
    return (ZERO, *numbers(height))


def _parts(most: int) -> tuple[Fraction, ...]:
    """Return the fractions 1/4, 1/5, … 1/`most`."""
    return tuple(Fraction(1, parts) for parts in range(4, most + 1))


def _grid(*values: Iterable[Fraction]) -> Iterator[Point]:
    """Return the points with all combinations of these values of a, c, r and z."""
    return (Point(*point) for point in product(*values))


def _solved(condition: sympy.Expr, height: int = 4, heights: Iterable[Fraction] = ()) -> Iterator[Point]:
    """Yield the points at which the expression in A, B, P and Q, which is linear in P, vanishes."""
    (solution,) = sympy.solve(condition, P)
    value = rational((A, B, Q), solution)
    for a, c, z in product(numbers(height), numbers(height), heights or _with_0(height)):
        radius = root(value(a**2, c**2, z**2))
        if radius is not None:
            yield Point(a, c, radius, z)


def _double_roots() -> Iterator[Point]:
    """Yield points whose g has a double root m, from g(m) = g'(m) = 0, which is linear in P and Q."""
    g = pencil.cubic().g
    solution = sympy.solve([g, g.diff(LAMBDA)], [P, Q], dict=True)[0]
    radius, height = (rational((A, B, LAMBDA), solution[letter]) for letter in (P, Q))
    poles = [sign * number for number in numbers(4) for sign in (1, -1)]
    for a, c, m in product(numbers(3), numbers(3), poles):
        if m in (-(a**2), c**2):
            continue
        r, z = root(radius(a**2, c**2, m)), root(height(a**2, c**2, m))
        if r is not None and z is not None:
            yield Point(a, c, r, z)


def root(value: Fraction) -> Fraction | None:
    """Return the square root of a rational if it is rational, else None."""
    if value < 0:
        return None
    candidate = Fraction(isqrt(value.numerator), isqrt(value.denominator))
    return candidate if candidate * candidate == value else None


Condition = Callable[[PointFacts], bool]


@dataclass(frozen=True)
class Statement:
    """The claim that `says` holds for every pair for which `where` holds. `text` is the claim in words."""

    text: str
    where: Condition
    says: Condition


@dataclass(frozen=True, slots=True)
class PointWitness:
    """A point that shows a fact, with a certificate of its position; `shows` is the fact in words."""

    facts: PointFacts
    certificate: Certificate
    shows: str

    @property
    def holds(self) -> bool:
        """Whether the certificate proves the position that the facts name, by rational arithmetic of its own."""
        claimed = self.certificate.position is self.facts.position
        return claimed and check_certificate(self.facts.point.pair, self.certificate)


Found = TypeVar("Found")


@dataclass(frozen=True)
class Search(Generic[Found]):
    """The result of a search: the number of tried points of the regime, and the first matching point, if any."""

    tried: int
    found: Found | None


def counterexample(statement: Statement) -> Search[PointFacts]:
    """Return the simplest point of the space at which the statement is false."""
    return first_point(lambda facts: not statement.says(facts), statement.where)


def first_point(wanted: Condition, where: Condition = lambda _: True) -> Search[PointFacts]:
    """Return the simplest point with `wanted` of those for which `where` holds; `tried` counts these up to it."""
    tried = 0
    for facts in facts_in_order():
        if where(facts):
            tried += 1
            if wanted(facts):
                return Search(tried, facts)
    return Search(tried, None)


def witness(facts: PointFacts, shows: str) -> PointWitness:
    """Return the point with a certificate of its position."""
    return PointWitness(facts, prove(facts.point.pair), shows)


LARGEST = 6
"""Sizes and coordinates of the pairs that are tried are whole numbers up to this one."""

AXES = tuple(
    (float(x), 0.0, float(z))
    for total in range(2, 8)
    for x, z in ((sign * x, total - x) for x in range(1, total) for sign in (1, -1))
    if abs(x) <= z and gcd(x, z) == 1
)
"""Axes tilted by 45 degrees at most, towards the hyperboloid's axis or away from it, the simplest first."""


@dataclass(frozen=True, slots=True)
class TiltedWitness:
    """A pair with the certificates of two positions: tilted and upright; `shows` is the shown fact in words."""

    pair: Pair
    certificate: Certificate
    vertical: Certificate
    shows: str

    @property
    def upright(self) -> Pair:
        """The pair with a vertical axis."""
        return Pair(*self.pair.row[:7])

    @property
    def holds(self) -> bool:
        """Whether both certificates prove their positions, by rational arithmetic of their own, and these differ."""
        differ = self.certificate.position is not self.vertical.position
        proved = check_certificate(self.pair, self.certificate)
        return differ and proved and check_certificate(self.upright, self.vertical)

    @property
    def text(self) -> str:
        """The pair and its positions: "α = 2, γ = 1, b = 2, d = 1, C = (1, 0, 2): interior; with the axis …"."""
        axis = ", ".join(f"{number:g}" for number in self.pair.axis)
        words = (
            f"{sizes_and_centre(self.pair)}: {self.vertical.position.label} upright, "
            f"{self.certificate.position.label} with the axis ({axis})"
        )
        return words.replace("-", "−")


def sizes_and_centre(pair: Pair) -> str:
    """Return the first seven numbers of a pair in words: "α = 3, γ = 1, b = 3, d = 2, C = (1, 0, 1)"."""
    alpha, gamma, b, d, *center = (f"{number:g}" for number in pair.row[:7])
    return f"α = {alpha}, γ = {gamma}, b = {b}, d = {d}, C = ({', '.join(center)})".replace("-", "−")


def first_change(before: Position, after: Position, shows: str, largest: int = LARGEST) -> Search[TiltedWitness]:
    """Return the simplest pair with the position `before` upright and `after` tilted, both proved."""
    tried = 0
    for numbers in quadcopter_pairs(largest):
        vertical = Pair.from_row(numbers)
        if exact.position(vertical.lengths) is not before:
            continue
        for axis in AXES:
            tried += 1
            pair = Pair.from_row((*numbers, *axis))
            if exact.position(pair.lengths) is after:
                return Search(tried, TiltedWitness(pair, prove(pair), prove(vertical), shows))
    return Search(tried, None)


def quadcopter_pairs(largest: int) -> Iterator[tuple[float, ...]]:
    """Yield α, γ, b, d, x, 0 and z in whole numbers up to `largest`, the simplest first.

    α ≥ b is the regime of Procedures 2.a and 2.b, and b > d is the shape of a quadcopter.
    """
    sizes = range(1, largest + 1)
    whole = (numbers for numbers in product(sizes, repeat=6) if numbers[0] >= numbers[2] > numbers[3])
    for alpha, gamma, b, d, x, z in sorted(whole, key=lambda numbers: (sum(numbers), max(numbers), numbers)):
        yield (*map(float, (alpha, gamma, b, d, x)), 0.0, float(z))
