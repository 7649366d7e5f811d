"""Where statements about pairs are tried: small rational points, everywhere and on thin sets.

On a thin set some sign that a statement asks for is 0, and there statements fail. Each is a stratum: its points come
from the derivation's polynomials, solved for the number that puts them there, and are kept where that number is
rational. The space is finite and has an order, the simplest point first, so a search that finds a counterexample finds
the least one, and one that finds none has tried every point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import product
from math import gcd, isqrt

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.pencil import LAMBDA, A, B, P, Q
from hypcheck.paper.ledger.facts import Facts, Point, facts, rational

ZERO = Fraction(0)


@dataclass(frozen=True, slots=True)
class Stratum:
    """A set of points with a name that says what is special about them."""

    name: str
    points: Callable[[], Iterable[Point]]


def numbers(height: int) -> tuple[Fraction, ...]:
    """The positive rationals in lowest terms whose numerator and denominator are at most `height`."""
    sizes = range(1, height + 1)
    return tuple(Fraction(top, bottom) for top, bottom in product(sizes, sizes) if gcd(top, bottom) == 1)


def strata() -> tuple[Stratum, ...]:
    """All of them."""
    return (
        Stratum("anywhere", lambda: _grid(numbers(3), numbers(3), _with_0(3), _with_0(3))),
        Stratum("the waist, z = 0", lambda: _grid(numbers(4), numbers(4), _with_0(6), (ZERO,))),
        Stratum("the axis, r = 0", lambda: _grid(numbers(4), numbers(4), (ZERO,), _with_0(6))),
        Stratum("a = 1", lambda: _grid((Fraction(1),), numbers(4), _with_0(4), _with_0(4))),
        Stratum("c² = a", lambda: (Point(c**2, c, r, z) for c, r, z in product(numbers(4), _with_0(4), _with_0(4)))),
        Stratum("a narrow throat, a and c at most 1/4", lambda: _grid(_parts(8), _parts(10), _with_0(4), _with_0(2))),
        Stratum("c1 = 0", lambda: _solved(pencil.cubic().c1)),
        Stratum("c2 = 0", lambda: _solved(pencil.cubic().c2)),
        Stratum("g'(B) = 0 at the waist", lambda: _solved(_slope().subs(LAMBDA, B), 12, (ZERO,))),
        Stratum("g'(−A) = 0", lambda: _solved(_slope().subs(LAMBDA, -A))),
        Stratum("double roots", _double_roots),
    )


@cache
def space() -> tuple[Point, ...]:
    """The points of all strata, each once, the simplest first."""
    return tuple(sorted({point for stratum in strata() for point in stratum.points()}, key=lambda point: point.cost))


def facts_in_order() -> Iterator[Facts]:
    """The facts of every point of the space, the simplest first; each is found once in a process."""
    for place, point in enumerate(space()):
        if place == len(_FOUND):
            _FOUND.append(facts(point))
        yield _FOUND[place]


_FOUND: list[Facts] = []


def _slope() -> sympy.Expr:
    return pencil.cubic().g.diff(LAMBDA)


def _with_0(height: int) -> tuple[Fraction, ...]:
    return (ZERO, *numbers(height))


def _parts(most: int) -> tuple[Fraction, ...]:
    """1/4, 1/5, … down to one part in `most`."""
    return tuple(Fraction(1, parts) for parts in range(4, most + 1))


def _grid(*values: Iterable[Fraction]) -> Iterator[Point]:
    return (Point(*point) for point in product(*values))


def _solved(condition: sympy.Expr, height: int = 4, heights: Iterable[Fraction] = ()) -> Iterator[Point]:
    """The points where the expression in A, B, P and Q vanishes; it is linear in P."""
    (solution,) = sympy.solve(condition, P)
    value = rational((A, B, Q), solution)
    for a, c, z in product(numbers(height), numbers(height), heights or _with_0(height)):
        radius = root(value(a**2, c**2, z**2))
        if radius is not None:
            yield Point(a, c, radius, z)


def _double_roots() -> Iterator[Point]:
    """Pairs whose g has the double root m: g(m) = g'(m) = 0 is linear in P and Q."""
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
    """The root of a rational, where that is a rational."""
    if value < 0:
        return None
    found = Fraction(isqrt(value.numerator), isqrt(value.denominator))
    return found if found * found == value else None
