"""Real roots of integer polynomials, all of them or those between 0 and 1, enclosed by exact arithmetic alone.

A polynomial has the form of polynomials.py, with a first coefficient ≠ 0. Nothing here is approximated: signs are signs
of integers, roots are counted by Sturm's theorem, and intervals shrink by bisection.

Roots in [0, 1] are counted by Descartes' rule of signs instead: halving a polynomial's interval costs only additions,
where Sturm's theorem multiplies long integers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache

from hypcheck.geometry.arithmetic import changes_of_sign
from hypcheck.truth.polynomials import (
    Polynomial,
    changes_between,
    derivative,
    divided_by_root,
    halves,
    primitive,
    signed_chain,
    squarefree,
    value,
)
from hypcheck.truth.rationals import power_near, power_of_two

Interval = tuple[Fraction, Fraction]


@lru_cache(maxsize=16)  # the roots of one polynomial are needed in several intervals
def sturm_chain(f: Polynomial) -> tuple[Polynomial, ...]:
    """f, f′ and the negated remainders of Euclid's algorithm, each up to a positive factor; the last is gcd(f, f′)."""
    return tuple(signed_chain(primitive(f), derivative(f)))


def variations(chain: Sequence[Polynomial], x: Fraction) -> int:
    """The changes of sign in the values of a Sturm chain at x, which is not a root of its first polynomial."""
    return changes_of_sign(value(f, x) for f in chain)


def isolate(f: Polynomial) -> list[Interval]:
    """Open intervals with one root of f each, in order, all real roots covered; no 0 inside any.

    f is squarefree and is not 0 at 0.
    """
    near, far = (power_of_two(exponent) for exponent in root_exponents(f))
    mirrored = tuple(-number if place % 2 else number for place, number in enumerate(f))
    below = ((-high, -low) for low, high in _isolated(mirrored, near, far))
    return sorted([*below, *_isolated(f, near, far)])


def root_exponents(f: Polynomial) -> tuple[int, int]:
    """Exponents near, far with 2^near < |root| < 2^far for all roots of f, f(0) ≠ 0.

    Cauchy: |root| < 1 + max |f_i / f_0| < 2 max(1, max |f_i / f_0|), and the same for 1/root with the order reversed.
    With n bits for the largest coefficient, m for the end one, the quotient is below 2^(n − m + 1).
    """
    largest = max(coefficient.bit_length() for coefficient in f)
    return f[-1].bit_length() - largest - 2, largest - f[0].bit_length() + 2


UNIT_INTERVAL_WIDTH_BITS = 60
"""`narrowed` goes on until an enclosure is at most 2^−60 of its root: one float64, or two neighbours, hold it."""


def roots_from_0_to_1(f: Polynomial) -> list[Interval]:
    """Disjoint enclosures of the roots of a primitive f in [0, 1], in order: open intervals, or (x, x) where x is met.

    Neither end of an open interval is a root. Raises AssertionError for f = 0.
    """
    if not f:
        raise AssertionError("a polynomial is 0 that cannot be: every number is a root of it")
    if _none_by_descartes(f):
        return []
    f = squarefree(f)
    met, enclosed = _isolated_by_descartes(f)
    for root in met:
        f = divided_by_root(f, root)
    return sorted([*((root, root) for root in met), *(_away(f, *interval, met) for interval in enclosed)])


def _isolated_by_descartes(f: Polynomial) -> tuple[list[Fraction], list[Interval]]:
    """Roots of a squarefree f in [0, 1]: the exact roots that were met, and open intervals with one other root each.

    Intervals are halved until the rule of signs finds one root or none in each (Collins and Akritas), which happens
    since f has simple roots alone. A met root may be the end of an interval.
    """
    met = [end for end in (Fraction(0), Fraction(1)) if not value(f, end)]
    enclosed: list[Interval] = []
    pending = [(0, 0, list(f))]  # the interval (place, place + 1)/2^depth, and f on it as a polynomial on (0, 1)
    while pending:
        place, depth, g = pending.pop()
        changes = changes_between(g)
        if changes == 1:
            enclosed.append((Fraction(place, 1 << depth), Fraction(place + 1, 1 << depth)))
        elif changes:
            left, right = halves(g)
            if not right[-1]:
                met.append(Fraction(2 * place + 1, 2 << depth))
            pending += [(2 * place, depth + 1, left), (2 * place + 1, depth + 1, right)]
    return met, enclosed


def _isolated(f: Polynomial, low: Fraction, high: Fraction) -> Iterator[Interval]:
    """Open intervals with one root each of a squarefree f, for all roots from low to high; 0 ≤ low < high are no roots.

    Sturm's theorem counts them.
    """
    chain = sturm_chain(f)
    pending = [(low, variations(chain, low), high, variations(chain, high))]
    while pending:
        low, left, high, right = pending.pop()
        if left - right == 1:
            yield low, high
        elif left > right:
            middle = _no_root_between(f, low, high)
            count = variations(chain, middle)
            pending += [(low, left, middle, count), (middle, count, high, right)]


def _away(f: Polynomial, low: Fraction, high: Fraction, met: Sequence[Fraction]) -> Interval:
    """The enclosure of a root, narrowed until no end is one of the met roots, which were divided out of f."""
    while low != high and (low in met or high in met):
        low, high = _halved(f, low, high)
    return low, high


def _no_root_between(f: Polynomial, low: Fraction, high: Fraction) -> Fraction:
    """A number near the middle, or near the middle of their exponents, that is not a root.

    Among more numbers than f has roots, one is not a root.
    """
    middle = power_near(low, high) if 0 < 4 * low < high else (low + high) / 2
    step = min(middle - low, high - middle) / 16
    return next(x for x in (middle + k * step for k in range(len(f))) if value(f, x))


def _none_by_descartes(f: Polynomial) -> bool:
    """Whether the rule of signs excludes a root in [0, 1]; False is undecided."""
    return bool(f[-1]) and bool(sum(f)) and not changes_between(f)


def enclosures(f: Polynomial, bits: int) -> Iterator[Interval]:
    """Closed intervals, 2^−bits wide at most and in any order, that hold all roots of f in [0, 1]; f is not 0.

    By Descartes' rule, halving intervals that may hold roots (Collins and Akritas): f need not be squarefree. A
    multiple root is not distinguished from several near roots, or from no root.
    """
    yield from ((end, end) for end in (Fraction(0), Fraction(1)) if not value(f, end))
    pending = [(0, 0, list(f))]  # the interval (place, place + 1)/2^depth, and f on it as a polynomial on (0, 1)
    while pending:
        place, depth, g = pending.pop()
        changes = changes_between(g)
        if not changes:
            continue
        low, high = Fraction(place, 1 << depth), Fraction(place + 1, 1 << depth)
        if depth >= bits:
            yield low, high
        elif changes == 1 and value(f, low) and value(f, high):
            while (high - low) * 2**bits > 1 and low != high:
                low, high = _halved(f, low, high)
            yield low, high
        else:
            left, right = halves(g)
            if not right[-1]:
                yield (low + high) / 2, (low + high) / 2
            pending += [(2 * place, depth + 1, left), (2 * place + 1, depth + 1, right)]


def narrowed(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """An enclosure that roots_from_0_to_1 gave of a root of f, narrowed; (x, x) where the root x is met."""
    f = squarefree(f)
    while (high - low) * 2**UNIT_INTERVAL_WIDTH_BITS > low:
        low, high = _halved(f, low, high)
    return low, high


def _halved(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """The half that holds the one root, a simple one, of an open interval; (x, x) where it is the middle x."""
    middle = (low + high) / 2
    sign = value(f, middle)
    if sign == 0:
        return middle, middle
    return (low, middle) if (sign > 0) == (value(f, high) > 0) else (middle, high)
