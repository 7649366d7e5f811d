"""Roots of an integer polynomial between 0 and 1, enclosed exactly.

Descartes' rule first: most polynomials that are asked have no root there, and their coefficients say so. Sturm's
theorem counts where that rule is not sharp.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import zip_longest

from hypcheck.truth.roots_isolation import Interval, Polynomial, divided_by_root, sturm_chain, value, variations

RELATIVE_WIDTH_BITS = 60
"""`narrowed` goes on until an enclosure is at most 2^−60 of its root: one float64, or two neighbours, hold it."""


def added(*terms: Sequence[int]) -> Polynomial:
    """The sum of polynomials, the highest power first; leading zeros are kept."""
    columns = zip_longest(*(term[::-1] for term in terms), fillvalue=0)
    return tuple(map(sum, columns))[::-1]


def squarefree(f: Polynomial) -> Polynomial:
    """The primitive polynomial with the roots of a primitive f, each of them simple."""
    if len(f) == 1:
        return (1,)
    common = sturm_chain(f)[-1]
    return f if len(common) == 1 else _quotient(f, common)


def _quotient(f: Polynomial, g: Polynomial) -> Polynomial:
    """f over one of its factors, both primitive; in integers, by Gauss's lemma."""
    rest, quotient = list(f), []
    for _ in range(len(f) - len(g) + 1):
        factor, remainder = divmod(rest[0], g[0])
        if remainder:
            raise AssertionError("a polynomial that is no factor was to be divided out")
        quotient.append(factor)
        tail = [*g[1:], *[0] * (len(rest) - len(g))]
        rest = [a - factor * b for a, b in zip(rest[1:], tail, strict=True)]
    return tuple(quotient)


def roots_from_0_to_1(f: Polynomial) -> list[Interval]:
    """Disjoint enclosures of the roots of a primitive f in [0, 1], in order: open intervals, or (x, x) where x is met.

    Neither end of an open interval is a root. Raises AssertionError for f = 0.
    """
    if not f:
        raise AssertionError("a polynomial is 0 that cannot be: every number is a root of it")
    if _none_by_descartes(f):
        return []
    f = squarefree(f)
    ends = [Fraction(time) for time in (0, 1) if value(f, Fraction(time)) == 0]
    for end in ends:
        f = divided_by_root(f, end)
    return sorted([*((end, end) for end in ends), *(_away(f, *found, ends) for found in _isolated(f))])


def _isolated(f: Polynomial) -> Iterator[Interval]:
    """Open intervals with one root each of a squarefree f, f(0) and f(1) not 0; all roots in (0, 1) are in one."""
    if len(f) == 1:
        return
    chain = sturm_chain(f)
    pending = [(Fraction(0), variations(chain, Fraction(0)), Fraction(1), variations(chain, Fraction(1)))]
    while pending:
        low, left, high, right = pending.pop()
        if left - right == 1:
            yield low, high
        elif left > right:
            middle = _no_root_between(f, low, high)
            count = variations(chain, middle)
            pending += [(low, left, middle, count), (middle, count, high, right)]


def _away(f: Polynomial, low: Fraction, high: Fraction, ends: Sequence[Fraction]) -> Interval:
    """The enclosure of one root, narrowed until it leaves out those ends of [0, 1] that are roots themselves."""
    while low != high and (low in ends or high in ends):
        low, high = _halved(f, low, high)
    return low, high


def _no_root_between(f: Polynomial, low: Fraction, high: Fraction) -> Fraction:
    """A number near the middle that is no root: of as many as f has roots, and one more, one is none."""
    middle, step = (low + high) / 2, (high - low) / 32
    return next(x for x in (middle + k * step for k in range(len(f))) if value(f, x))


def _none_by_descartes(f: Polynomial) -> bool:
    """Whether the rule of signs excludes a root in [0, 1]; it says nothing otherwise.

    t = 1/(1 + s) takes s in (0, ∞) to t in (0, 1): (1+s)^n f(1/(1+s)) has as coefficients, from the highest power of s,
    f(0) to f(1), and where no two of them differ in sign, and neither end is 0, there is no root.
    """
    shifted = list(f[::-1])
    for last in range(len(shifted) - 1, 0, -1):  # Horner's scheme, from powers of 1 + s to powers of s
        for place in range(1, last + 1):
            shifted[place] += shifted[place - 1]
    if not shifted[0] or not shifted[-1]:
        return False
    return min(shifted) >= 0 or max(shifted) <= 0


def narrowed(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """An enclosure that roots_from_0_to_1 gave of a root of f, narrowed; (x, x) where the root x is met."""
    f = squarefree(f)
    while (high - low) * 2**RELATIVE_WIDTH_BITS > low:
        low, high = _halved(f, low, high)
    return low, high


def _halved(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """The half that holds the one root, a simple one, of an open interval; (x, x) where it is the middle x."""
    middle = (low + high) / 2
    sign = value(f, middle)
    if sign == 0:
        return middle, middle
    return (low, middle) if (sign > 0) == (value(f, high) > 0) else (middle, high)
