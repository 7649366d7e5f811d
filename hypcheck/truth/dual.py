"""The Lagrange dual of a pair as a quotient of polynomials with integer coefficients: its formulas, in exact integers.

nearest.py defines the dual, and finds its supremum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.arithmetic import dot, sign_of, times
from hypcheck.geometry.pair import Lengths
from hypcheck.truth.polynomials import Polynomial, derivative, difference, polynomial_product, scaled, value


@dataclass(frozen=True, slots=True)
class Dual:
    """D = value/under in ν = λ/unit; the interval is where first = a ν + b > 0 and second > 0, of degree 2 at most.

    `slope` is value′ under − value under′, so that D′ = slope/under². The degree of `value` is one more than that of
    `under`, the degree of `slope` twice it.
    """

    value: Polynomial
    under: Polynomial
    slope: Polynomial
    first: tuple[int, int]
    second: tuple[int, int, int]
    unit: Fraction

    @classmethod
    def of(cls, lengths: Lengths) -> Dual:
        """The dual of a pair."""
        return _upright(lengths) if lengths.is_upright else _general(lengths)

    def inside(self, L: int, shift: int) -> bool:
        """Whether ν = L/2^shift lies in the interval."""
        return value_at(self.first, L, shift) > 0 and value_at(self.second, L, shift) > 0

    def direction(self, L: int, shift: int) -> int:
        """The sign of D′ at ν = L/2^shift; beyond an end of the interval the sign that points back to it."""
        if not self.inside(L, shift):
            return 1 if L < 0 else -1
        return sign_of(value_at(self.slope, L, shift))

    def end(self, side: int, shift: int) -> int:
        """The last multiple of 2^-shift in the interval on one side of 0, as a distance from 0."""
        a, b = self.first
        e2, e1, e0 = self.second
        e1 *= side
        ends = [((b << shift) - 1) // a] if side < 0 else []
        if e2:
            root = (e1 << shift) + math.isqrt((e1 * e1 - 4 * e0 * e2) << 2 * shift)
            ends.append(root // (-2 * e2))
        elif e1 < 0:
            ends.append(((e0 << shift) - 1) // -e1)
        last = min(ends)
        return last - (not self.inside(side * last, shift))

    def touches(self, at: Fraction) -> bool:
        """Whether D, rising up to ν = `at` in the closed interval from the side of 0, is 1 there: the surfaces touch.

        There value − under has a root, of a higher order than under, and is negative before it. Inside the interval,
        where under > 0, that is a root of order 2.
        """
        if at == 0 or min(value(self.first, at), value(self.second, at)) < 0:
            return False
        under, gap = self.under, difference(self.value, (0, *self.under))
        pole = root = 0
        while not value(under, at):
            under, pole = derivative(under), pole + 1
        while not (rest := value(gap, at)):
            gap, root = derivative(gap), root + 1
        return root > max(pole, 1) and rest * (-1 if root % 2 and at > 0 else 1) < 0


def _upright(lengths: Lengths) -> Dual:
    """The D of an upright pair; each group of lengths has its own unit."""
    p, q, R = _reduced(lengths.alpha**2, lengths.b**2, lengths.x**2 + lengths.y**2)
    s, t, Z = _reduced(lengths.gamma**2, lengths.d**2, lengths.z**2)
    under = (-q * t, q * s - p * t, p * s)
    return _quotient((-R * t - Z * q, R * s - Z * p), under, (q, p), (0, -t, s), (1, 1))


def _general(lengths: Lengths) -> Dual:
    """The D of any pair. With N = q t V M and Q = p s D in integers, M + λD = (N + νQ)/(q t V) for ν = λ q t V/(p s).

    The adjugate of N + νQ is that of N, plus ν times a mixed one, plus ν² times that of Q.
    """
    p, s, q, t = lengths.alpha**2, lengths.gamma**2, lengths.b**2, lengths.d**2
    v, C = lengths.axis, (lengths.x, lengths.y, lengths.z)
    V, Q = dot(v, v), (s, s, -p)
    N = [[(i == j) * t * V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
    left, right = [a * b for a, b in zip(Q, C, strict=True)], times(N, C)
    mixed = [[-N[i][j] * Q[3 - i - j] if i != j else 0 for j in range(3)] for i in range(3)]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        mixed[i][i] = Q[j] * N[k][k] + Q[k] * N[j][j]
    k3, k2 = -p * s * s, -p * s * (N[0][0] + N[1][1]) + s * s * N[2][2]
    e2, e0, horizontal = -p * s, q * t * V * V, t * V  # N + νQ has the determinant s ν + t V in that direction
    second = (e2, (k2 - horizontal * e2) // s, e0)
    under = (k3, k2, s * e0 + horizontal * second[1], horizontal * e0)
    over = (k3 * dot(C, right), dot(left, times(mixed, right)), under[3] * dot(left, C))
    return _quotient(over, under, (s, horizontal), second, (p * s, q * t * V))


def _quotient(
    over: Polynomial, under: Polynomial, first: tuple[int, int], second: tuple[int, int, int], unit: tuple[int, int]
) -> Dual:
    """D = ν (over/under − m)/n, where the unit is m/n."""
    m, n = unit
    value = (*difference((0, *over), scaled(m, under)), 0)
    under = scaled(n, under)
    content = math.gcd(*value, *under)
    value, under = (tuple(part // content for part in polynomial) for polynomial in (value, under))
    slope = difference(polynomial_product(derivative(value), under), polynomial_product(value, derivative(under)))
    return Dual(value, under, slope, first, second, Fraction(m, n))


def value_at(f: Polynomial, L: int, shift: int) -> int:
    """f(L/2^shift) times 2^shift to the power of f's degree."""
    total = scale = 0
    for coefficient in f:
        total = total * L + (coefficient << scale)
        scale += shift
    return total


def _reduced(*numbers: int) -> tuple[int, ...]:
    """The numbers divided by the largest power of two that divides all."""
    union = 0
    for number in numbers:
        union |= number
    shift = (union & -union).bit_length() - 1
    return tuple(number >> shift for number in numbers)
