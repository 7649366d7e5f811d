"""Tilted pairs whose position is known without the project: worked by hand, or built around a rational point."""

from __future__ import annotations

import itertools
import math
import random
from fractions import Fraction

from hypcheck.geometry.pair import Position

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR


def random_rows(count, seed=0):
    """Rows of random_row."""
    rng = random.Random(seed)  # noqa: S311
    return [random_row(rng) for _ in range(count)]


def random_row(rng):
    """Ten floats, sizes and distances of one order, any axis; near the surface about as often as far from it."""
    sizes = [rng.uniform(0.3, 4.0) for _ in range(4)]
    return [*sizes, *(rng.uniform(-6.0, 6.0) for _ in range(3)), *(rng.gauss(0.0, 1.0) for _ in range(3))]


def grown(row, factor):
    """The row with its spheroid grown about its centre."""
    numbers = [Fraction(each) for each in row]
    return [*numbers[:2], numbers[2] * factor, numbers[3] * factor, *numbers[4:]]


def tangent_row(cosine, sine, k, v, azimuth, lean, turn, side, swap=False, unit=Fraction(1, 10), beyond=False):
    """A row of rationals whose spheroid touches the hyperboloid, and the position of which it is the limit; or None.

    With `beyond`, rows whose spheroid touches there as well, and crosses elsewhere: larger ones.

    Each pair (cosine, sine), azimuth, lean and turn is a rational point of the unit circle. The point of touch has the
    unit normal n = (cosine·e_r, −sine·e_z) and the gradient k n (the recipe of docs/mathematics.md for upright pairs).
    The axis is lean[0] n + lean[1] m with m perpendicular to n. With b lean[1] = 3, d lean[0] = 4 (or swapped) the
    spheroid's half width along n is 5, so that its centre lies 5 k′ beyond the point of touch along M⁻¹ n.
    """
    u = 1 / (k * k * v)
    u, v = min(u, v), max(u, v)
    if u == v or 0 in lean:
        return None
    alpha, gamma = (u + v) / (2 * cosine), (v - u) / (2 * sine)
    (ce, se), (ct, st) = azimuth, turn
    normal = (cosine * ce, cosine * se, -sine)
    along = (sine * ce, sine * se, cosine)
    across = (-se, ce, Fraction(0))
    beside = [ct * p + st * q for p, q in zip(along, across, strict=True)]
    axis = [lean[0] * n + lean[1] * m for n, m in zip(normal, beside, strict=True)]
    wide, tall = (4, 3) if swap else (3, 4)
    b, d = unit * wide / abs(lean[1]), unit * tall / abs(lean[0])
    touch = (alpha * alpha * k * cosine * ce, alpha * alpha * k * cosine * se, gamma * gamma * k * sine)
    # M⁻¹ n = b² n + (d² − b²)(axis·n) axis, axis·n = lean[0], and nᵀ M⁻¹ n = (5 unit)²
    reach = [(b * b * n + (d * d - b * b) * lean[0] * a) / (5 * unit) for n, a in zip(normal, axis, strict=True)]
    center = [t + side * r for t, r in zip(touch, reach, strict=True)]
    multiplier = side / (k * 5 * unit)
    if b == d or _positive_definite(alpha, gamma, b, d, axis, multiplier) is beyond:
        return None
    return [alpha, gamma, b, d, *center, *axis], EXTERIOR if side > 0 else INTERIOR


def in_floats(row):
    """The same pair in integers that float64 holds, or None."""
    integers = []
    for group in (row[:7], row[7:]):
        unit = math.lcm(*(Fraction(each).denominator for each in group))
        integers += [each * unit for each in group]
    return [float(each) for each in integers] if all(abs(each) < 2**53 for each in integers) else None


def _positive_definite(alpha, gamma, b, d, axis, multiplier):
    """Whether M + multiplier · D is, by the signs of its leading minors; then the point of touch is the nearest one."""
    D = (1 / alpha**2, 1 / alpha**2, -1 / gamma**2)
    m = [
        [(i == j) * (1 / b**2 + multiplier * D[i]) + (1 / d**2 - 1 / b**2) * axis[i] * axis[j] for j in range(3)]
        for i in range(3)
    ]
    two = m[0][0] * m[1][1] - m[0][1] ** 2
    three = (
        m[2][2] * two
        - m[1][2] * (m[0][0] * m[1][2] - m[0][1] * m[0][2])
        + m[0][2] * (m[0][1] * m[1][2] - m[1][1] * m[0][2])
    )
    return m[0][0] > 0 and two > 0 and three > 0


def circle_point(m, n):
    """A rational point of the unit circle."""
    return Fraction(m * m - n * n, m * m + n * n), Fraction(2 * m * n, m * m + n * n)


_CIRCLE = [circle_point(2, 1), circle_point(3, 2), circle_point(4, 1)]
_SPREAD = itertools.product(
    _CIRCLE, (Fraction(1, 2), Fraction(2)), (Fraction(1, 3), Fraction(3)), _CIRCLE[:2], _CIRCLE, _CIRCLE[1:], (1, -1)
)
TANGENT = [
    found
    for (cosine, sine), k, v, azimuth, lean, turn, side in itertools.islice(_SPREAD, 0, None, 7)
    if (found := tangent_row(cosine, sine, k, v, azimuth, lean, turn, side)) is not None
]

_FEW = itertools.product(
    _CIRCLE, (Fraction(1, 2), Fraction(2)), _CIRCLE[:2], _CIRCLE[1:], (1, -1), (Fraction(1), Fraction(8))
)
TOUCHING_AND_CROSSING = [
    found[0]
    for (cosine, sine), k, lean, turn, side, unit in _FEW
    if (found := tangent_row(cosine, sine, k, Fraction(3), _CIRCLE[0], lean, turn, side, unit=unit, beyond=True))
]

TINY = math.ulp(0.0)
WITNESSES = [
    # A needle (b = 1/8, d = 4) beside the hyperboloid x² + y² − z² = 1 with its centre at (3, 0, 0).
    ([1, 1, 0.125, 4, 3, 0, 0, 0, 0, 1], CONTACT, "upright, it reaches (3, 0, ±4), where the surface has radius √17"),
    ([1, 1, 0.125, 4, 3, 0, 0, 1, 0, 0], CONTACT, "along x it reaches the axis"),
    ([1, 1, 0.125, 4, 3, 0, 0, 0, 1, 0], EXTERIOR, "along y it stays beyond radius 3 − 1/8 at |z| ≤ 1/8"),
    ([1, 1, 0.125, 4, 3, 0, 0, 0, -(2.0**1000), 0], EXTERIOR, "the axis has no length"),
    ([1, 1, 0.125, 4, 3, 0, 0, 0, TINY, 0], EXTERIOR, "not even the least"),
    # Inside the same hyperboloid.
    ([1, 1, 0.125, 0.99, 0, 0, 0, 1, 0, 0], INTERIOR, "across, it ends 0.01 from the throat"),
    ([1, 1, 0.125, 1, 0, 0, 0, 1, 0, 0], CONTACT, "across, it touches the throat at both ends"),
    ([1, 1, 0.125, 1, 0, 0, 0, 3, 4, 0], CONTACT, "in any direction"),
    ([1, 1, 0.125, 64, 0, 0, 0, 0, 0, 1], INTERIOR, "along the axis any length fits"),
    ([1, 1, 0.125, 64, 0, 0, 0, 1, 0, 1], CONTACT, "along the asymptote it leaves the cone's inside at some end"),
    ([1, 1, 0.125, 64, 0, 0, 0, 1, 0, 3], INTERIOR, "steeper than the asymptote, and thin enough, it stays"),
    # A disc (b = 4, d = 1/8).
    ([1, 1, 4, 0.125, 3, 0, 0, 1, 0, 0], CONTACT, "facing the axis it reaches (3, 0, ±4)"),
    ([1, 1, 4, 0.125, 8, 0, 0, 1, 0, 0], EXTERIOR, "from further away it does not: √(1 + 4²) < 7"),
    ([1, 1, 4, 0.125, 0, 0, 5, 0, 0, 1], INTERIOR, "flat over the waist: √(1 + 4²) > 4 at every height from 4.875"),
    # Centres on the surface, and out of all proportion.
    ([1, 1, 1e-300, 1e-290, 1, 0, 0, 1, 2, 3], CONTACT, "the centre lies on the surface"),
    ([1, 1, 1e-300, 1e-290, 1.0 + 2.0**-52, 0, 0, 1, 2, 3], EXTERIOR, "one unit beyond it"),
    ([1, 1, 1e-300, 1e-290, 1.0 - 2.0**-53, 0, 0, 1, 2, 3], INTERIOR, "one unit within it"),
    ([TINY, TINY, TINY, 2 * TINY, 8 * TINY, 0, 0, 1.0, TINY, 0], EXTERIOR, "the least numbers of float64"),
    ([1e308, 1e308, 1e307, 1e306, 0, 0, 0, 1, 1, 1], INTERIOR, "the largest"),
]

SYMMETRIC = [
    # The centre on a plane of symmetry of both, so that the double root of the quartic is a pole. In the eigenbasis of
    # the pencil the spheroid is the unit ball, the hyperboloid x²/A1 + y²/A2 − z²/B = 1 and the centre (r, 0, 0) with
    # r² = (A1 + B)(1 + B)/B: in the plane of x and z the points nearest to it are at distance 1. They are nearest in
    # space, and two, unless φ′(B) = A1 r²/(A1 + B)² − 1 < 0.
    ([1, 1, 2, 1, 0, 3, 0, 1, 0, 1], CONTACT, EXTERIOR),
    ([2, 2, 1, 2, 0, 3, 0, 1, 0, 1], CONTACT, EXTERIOR),
    ([1, 1, 1, 4, 0, 2.5, 0, 1, 0, 1], CONTACT, EXTERIOR),
    ([2, 6, 5, 2, 0, 9, 0, 3, 0, 1], EXTERIOR, None),
    ([5, 5, 2, 1, 0, 9, 0, 1, 0, 1], EXTERIOR, None),
    ([2, 4, 5, 2, 0, 10.5, 0, 1, 0, 2], EXTERIOR, None),
    # Inside, where A1 < A2, the centre is (0, r, 0) with r² = (A2 − A1)(A1 − 1)/A1: two points touch, unless A1² > A2.
    ([5, 5, 4, 2, -2.25, 0, 0.75, 1, 0, 1], CONTACT, INTERIOR),
    ([35, 35, 25, 10, -21, 0, 9, 1, 0, 1], CONTACT, INTERIOR),
    ([8, 8, 4, 1, -7.5, 0, 4.5, 1, 0, 1], CONTACT, INTERIOR),
    ([35, 35, 25, 15, -16, 0, 4, 1, 0, 1], INTERIOR, None),
    ([8, 8, 4, 3, -3.5, 0, 0.5, 1, 0, 1], INTERIOR, None),
]


def near_contact(row, decide):
    """Two rows next to each other in float64 between which the position changes as the spheroid grows; or None.

    `decide` is asked for the positions; the rows are good for tests that prove the answers.
    """
    here = decide(row)
    low, high = 1.0, 64.0
    if here is CONTACT or decide(_stretched(row, high)) is not CONTACT:
        return None
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if decide(_stretched(row, middle)) is here else (low, middle)
    return _stretched(row, low), _stretched(row, high)


def _stretched(row, factor):
    return [*row[:2], row[2] * factor, row[3] * factor, *row[4:]]


def phi(row, at):
    """min over X of s(X) + λ h(X), by Cramer's rule; None where M + λD is not positive definite."""
    alpha, gamma, b, d, *rest = map(Fraction, row)
    centre, v = rest[:3], rest[3:]
    D = (1 / alpha**2, 1 / alpha**2, -1 / gamma**2)
    square = sum(each * each for each in v)
    M = [[(i == j) / b**2 + (1 / d**2 - 1 / b**2) * v[i] * v[j] / square for j in range(3)] for i in range(3)]
    G = [[M[i][j] + (i == j) * at * D[i] for j in range(3)] for i in range(3)]
    pulled = [sum(M[i][j] * centre[j] for j in range(3)) for i in range(3)]
    whole = determinant(G)
    if not (G[0][0] > 0 and G[0][0] * G[1][1] > G[0][1] ** 2 and whole > 0):
        return None
    nearest = []
    for column in range(3):
        replaced = [[pulled[i] if j == column else G[i][j] for j in range(3)] for i in range(3)]
        nearest.append(determinant(replaced) / whole)
    along = sum(pulled[i] * (centre[i] - nearest[i]) for i in range(3))
    return along - 1 - at


def determinant(m):
    return (
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    )
