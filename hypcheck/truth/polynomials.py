"""Polynomials with integer coefficients: their arithmetic, and their real roots from 0 to 1.

A polynomial is a tuple of integers, the highest power first; () is 0. Nothing here is approximated: signs are signs of
integers, and intervals shrink by bisection. Descartes' rule of signs separates the roots from 0 to 1, because halving a
polynomial's interval costs only additions; Sturm's theorem multiplies long integers.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache

from hypcheck.geometry.arithmetic import changes_of_sign, sign_of

Polynomial = tuple[int, ...]
Interval = tuple[Fraction, Fraction]


def value(f: Sequence[int], x: Fraction) -> int:
    """Return f(x) times a positive number, the denominator of x to the power of f's degree."""
    numerator, denominator = x.as_integer_ratio()
    result, scale = 0, 1
    for coefficient in f:
        result = result * numerator + coefficient * scale
        scale *= denominator
    return result


def sign_at(f: Sequence[int], x: Fraction) -> int:
    """Return the sign of f at x."""
    return sign_of(value(f, x))


def trimmed(f: Sequence[int]) -> Polynomial:
    """Return the polynomial without leading zeros; () for 0."""
    first = next((place for place, coefficient in enumerate(f) if coefficient), len(f))
    return tuple(f[first:])


def primitive(f: Sequence[int]) -> Polynomial:
    """Return the polynomial without leading zeros and over the gcd of its coefficients, signs kept; () for 0."""
    content = math.gcd(*f)  # never negative
    return tuple([coefficient // content for coefficient in trimmed(f)])


def polynomial_sum(*terms: Sequence[int]) -> Polynomial:
    """Return the sum of polynomials; leading zeros are kept."""
    columns = itertools.zip_longest(*(term[::-1] for term in terms), fillvalue=0)
    return tuple(map(sum, columns))[::-1]


def scaled(factor: int, f: Sequence[int]) -> Polynomial:
    """Return the polynomial times a number."""
    return tuple([factor * coefficient for coefficient in f])


def difference(f: Sequence[int], g: Sequence[int]) -> Polynomial:
    """Return f − g; both have as many coefficients."""
    return tuple([a - b for a, b in zip(f, g, strict=True)])


def polynomial_product(f: Sequence[int], g: Sequence[int]) -> Polynomial:
    """Return the product of two polynomials."""
    if not f or not g:
        return ()
    result = [0] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for j, b in enumerate(g):
            result[i + j] += a * b
    return tuple(result)


def derivative(f: Sequence[int]) -> Polynomial:
    """Return the derivative."""
    return tuple([part * power for part, power in zip(f, range(len(f) - 1, 0, -1), strict=False)])


def remainder(f: Sequence[int], g: Sequence[int]) -> Polynomial:
    """Return the remainder of f by g ≠ 0, times a positive number that leaves the coefficients coprime; () for 0."""
    lead, sign = abs(g[0]), 1 if g[0] > 0 else -1
    rest = list(f)
    while len(rest) >= len(g):
        factor = sign * rest[0]
        tail = [*g[1:], *[0] * (len(rest) - len(g))]
        rest = [lead * a - factor * b for a, b in zip(rest[1:], tail, strict=True)]
    return primitive(rest)


def signed_chain(f: Polynomial, g: Polynomial) -> list[Polynomial]:
    """Return f, g and the negated remainders of Euclid's algorithm, each up to a positive factor."""
    chain = [f]
    while g:
        chain.append(primitive(g))
        g = scaled(-1, remainder(chain[-2], chain[-1]))
    return chain


@lru_cache(maxsize=16)  # the roots of one polynomial are needed in several intervals
def sturm_chain(f: Polynomial) -> tuple[Polynomial, ...]:
    """Return f, f′ and the negated remainders of Euclid's algorithm, up to positive factors; the last is gcd(f, f′)."""
    return tuple(signed_chain(primitive(f), derivative(f)))


def common_divisor(f: Polynomial, g: Polynomial) -> Polynomial:
    """Return the greatest common divisor of two polynomials, up to a constant factor; () of twice 0."""
    while g:
        f, g = g, remainder(f, g)
    return f


def quotient(f: Polynomial, g: Polynomial) -> Polynomial:
    """Divide f by one of its factors g, both primitive; in integers, by Gauss's lemma."""
    rest, quotient = list(f), []
    while len(rest) >= len(g):
        factor, left = divmod(rest[0], g[0])
        if left:
            break
        quotient.append(factor)
        tail = [*g[1:], *[0] * (len(rest) - len(g))]
        rest = [a - factor * b for a, b in zip(rest[1:], tail, strict=True)]
    if any(rest):
        raise AssertionError("a polynomial that is not a factor was to be divided out")
    return tuple(quotient)


@lru_cache(maxsize=16)  # the roots of a polynomial are needed more than once
def squarefree(f: Polynomial) -> Polynomial:
    """Return the primitive polynomial with the roots of f, each of them simple."""
    f = primitive(f)
    if _coprime_in_a_field(f, derivative(f)):
        return f
    common = primitive(common_divisor(f, derivative(f)))
    return quotient(f, common) if len(common) > 1 else f


_PRIME = 2**61 - 1


def _coprime_in_a_field(f: Polynomial, g: Polynomial) -> bool:
    """Decide whether f and g have no common factor modulo a prime that does not divide f's first coefficient.

    They have none in integers then: a common factor's first coefficient divides f's, so that it keeps its degree modulo
    the prime. The integers of Euclid's algorithm stay short here, however long the coefficients are.
    """
    p = _PRIME
    if not f or not f[0] % p:
        return False
    f, g = (trimmed([number % p for number in h]) for h in (f, g))
    while len(g) > 1:
        inverse, rest = pow(g[0], -1, p), list(f)
        while len(rest) >= len(g):
            factor = rest[0] * inverse % p
            tail = [*g[1:], *[0] * (len(rest) - len(g))]
            rest = [(a - factor * b) % p for a, b in zip(rest[1:], tail, strict=True)]
        f, g = g, trimmed(rest)
    return len(g) == 1


def linear_factor(root: Fraction) -> Polynomial:
    """Return the primitive linear polynomial with this root."""
    return (root.denominator, -root.numerator)


def shifted_by_one(f: Sequence[int]) -> list[int]:
    """Return the coefficients of f(s + 1), by Horner's scheme."""
    shifted = list(f)
    for last in range(len(shifted) - 1, 0, -1):
        for place in range(1, last + 1):
            shifted[place] += shifted[place - 1]
    return shifted


def changes_between(g: Sequence[int]) -> int:
    """Return the number of changes of sign in the coefficients of (1+s)^n g(1/(1+s)).

    t = 1/(1 + s) takes s in (0, ∞) to t in (0, 1). So by Descartes' rule g has this number of roots in (0, 1), or an
    even number fewer.
    """
    return changes_of_sign(shifted_by_one(g[::-1]))


def halves(g: Sequence[int]) -> tuple[list[int], list[int]]:
    """Return g between 0 and 1/2, and between 1/2 and 1, each as a polynomial on (0, 1)."""
    left = [number << power for power, number in enumerate(g)]
    return left, shifted_by_one(left)


def separated(f: Sequence[int], most: int | None = None) -> Iterator[tuple[Fraction, Fraction, int]]:
    """Yield intervals (low, high, count) that hold all roots of f in [0, 1], unordered, by halving (Collins, Akritas).

    An open interval with one root, and without a root at its ends, has the count 1. A root x that is met is (x, x, 0).
    Intervals are halved `most` times at most: such a small one has the roots that the rule of signs counts, or an even
    number fewer, and an end may be a root. Without `most` the halving ends only where f has simple roots alone.
    """
    yield from ((end, end, 0) for end in (Fraction(0), Fraction(1)) if not value(f, end))
    pending = [(0, 0, list(f))]  # the interval (place, place + 1)/2^depth, and f on it as a polynomial on (0, 1)
    while pending:
        place, depth, g = pending.pop()
        changes = changes_between(g)
        if not changes:
            continue
        if depth == most or (changes == 1 and g[-1] and sum(g)):
            yield Fraction(place, 1 << depth), Fraction(place + 1, 1 << depth), changes
            continue
        left, right = halves(g)
        if not right[-1]:
            middle = Fraction(2 * place + 1, 2 << depth)
            yield middle, middle, 0
        pending += [(2 * place, depth + 1, left), (2 * place + 1, depth + 1, right)]


def roots_from_0_to_1(f: Polynomial) -> list[Interval]:
    """Enclose the roots of a primitive f in [0, 1], in order: disjoint open intervals, or (x, x) where x is met.

    Neither end of an open interval is a root. Raises AssertionError for f = 0.
    """
    if not f:
        raise AssertionError("a polynomial is 0 that cannot be: every number is a root of it")
    if _none_by_descartes(f):
        return []
    return sorted((low, high) for low, high, _ in separated(squarefree(f)))


def _none_by_descartes(f: Polynomial) -> bool:
    """Decide whether the rule of signs excludes a root in [0, 1]; False is undecided."""
    return bool(f[-1]) and bool(sum(f)) and not changes_between(f)


def enclosures(f: Polynomial, bits: int) -> Iterator[Interval]:
    """Closed intervals, 2^−bits wide at most and in any order, that hold all roots of f in [0, 1]; f is not 0.

    f need not be squarefree. A multiple root is not distinguished from several near roots, or from no root.
    """
    for *ends, _ in separated(f, bits):
        low, high = ends
        while (high - low) * 2**bits > 1:
            low, high = _halved(f, low, high)
        yield low, high


UNIT_INTERVAL_WIDTH_BITS = 60
"""`narrowed` goes on until an enclosure is at most 2^−60 of its root: one float64, or two neighbours, hold it."""


def narrowed(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """Return an enclosure that roots_from_0_to_1 gave of a root of f, narrowed; (x, x) where the root x is met."""
    f = squarefree(f)
    while (high - low) * 2**UNIT_INTERVAL_WIDTH_BITS > low:
        low, high = _halved(f, low, high)
    return low, high


def _halved(f: Polynomial, low: Fraction, high: Fraction) -> Interval:
    """Return the half that holds the one root, a simple one, of an open interval; (x, x) where it is the middle x."""
    middle = (low + high) / 2
    sign = value(f, middle)
    if sign == 0:
        return middle, middle
    return (low, middle) if (sign > 0) == (value(f, high) > 0) else (middle, high)
