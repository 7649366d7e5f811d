"""The pencil S + λH of a spheroid and a hyperboloid: its determinant as a polynomial in λ, in integers.

S and H are the two surfaces' 4×4 matrices, M and D their upper 3×3 parts. With p = α², s = γ², q = b², t = d².

**Upright.** The determinant has the known root −A and the cubic g of equation (14) of the paper is left. With
R = x² + y² and S = z², each group of lengths in its own unit, A = p/q, B = s/t, P = R/q, Q = S/t, and N = q t > 0 times
g is n3 λ³ + n2 λ² + n1 λ + n0.

**Tilted.** Let v be the axis, V = v·v, c = v_z², W = V − c. A horizontal n perpendicular to v splits the 3×3 pencil
into 1/q + λ/p along n and a 2×2 block. Up to positive factors their determinants are

    L = p + q λ     E = p s V + λ (s g1 − p g2) − λ² q t V,     g1 = t W + q c,  g2 = q W + t c,

and with R = x² + y², Z = z², N = x v_y − y v_x, T = (x v_x + y v_y) z v_z (expand det(S + λH); the tests do)

    p² q² s t V det(S + λH) = F = L G − (q − t) N² λ² (s − q λ)
    G = −(1 + λ) E + λ (R s − Z p) V − λ² (R g2 + Z g1 + 2 (q − t) T).

**A tilted hyperboloid**, along w, is not rotated: all these terms depend on squares and products of the centre C and
both axes, and with W = w·w those along w are Z = (C·w)²/W, c = (v·w)²/W, N² = det(C, v, w)²/W and T = (C·v −
(C·w)(v·w)/W) (C·w)(v·w)/W; R and V − c are the rests of C·C and v·v. p, s, q, t, R, Z and V, c are multiplied by W, N²
and T by W², so that all are integers and F keeps its sign.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

from hypcheck.geometry.arithmetic import cross, dot, power_near, sign_with_root
from hypcheck.geometry.pair import Lengths
from hypcheck.truth.polynomials import Polynomial, derivative, difference, polynomial_product, sign_at

Number: TypeAlias = Any
"""An integer, or a polynomial in time (sweep.py): whatever has +, −, · among its kind and with integers."""


@dataclass(frozen=True, slots=True)
class Cubic:
    """N g(λ) = n3 λ³ + n2 λ² + n1 λ + n0 and the poles −A = −p/q, B = s/t, all integers; n3, p, q, s, t > 0."""

    n3: int
    n2: int
    n1: int
    n0: int
    p: int
    q: int
    s: int
    t: int

    @property
    def coefficients(self) -> tuple[int, ...]:
        """n3, n2, n1, n0."""
        return (self.n3, self.n2, self.n1, self.n0)


def cubic(lengths: Lengths) -> Cubic:
    """Return the cubic of equation (14) of the paper over the common denominator b² d²."""
    p, s, q, t = _squares(lengths)
    n3, n2, n1, n0 = cubic_coefficients(lengths, lengths.x, lengths.y, lengths.z)
    return Cubic(n3, n2, n1, n0, p, q, s, t)


def cubic_coefficients(sizes: Lengths, x: Number, y: Number, z: Number) -> tuple[Number, ...]:
    """Return n3, n2, n1, n0 for these sizes and a centre whose coordinates are any kind of number."""
    p, s, q, t = _squares(sizes)
    radius, height = across_and_along(sizes, x, y, z)
    n2 = (p + q - radius) * t - (s + height) * q
    return q * t, n2, p * (t - s - height) + s * (radius - q), -p * s


def across_and_along(sizes: Lengths, x: Number, y: Number, z: Number) -> tuple[Number, Number]:
    """Return R and Z, the squares of a centre's parts across the hyperboloid's axis and along it."""
    if sizes.upward == _VERTICAL:
        return x * x + y * y, z * z
    center, along = (x, y, z), dot((x, y, z), sizes.upward)
    height = along * along
    return dot(center, center) * dot(sizes.upward, sizes.upward) - height, height


def side_of_center(lengths: Lengths) -> int:
    """Return the sign of the hyperboloid's equation at the spheroid's centre: 1 outside, −1 inside, 0 on it."""
    p, s, _, _ = _squares(lengths)
    R, Z = across_and_along(lengths, lengths.x, lengths.y, lengths.z)
    return sign_with_root(R * s - Z * p - p * s, 0, 0)


_VERTICAL = (0, 0, 1)


def local_maximum(g: Cubic, bits: int) -> tuple[int, int]:
    """Return the place of g's local maximum, which must exist, to about `bits` bits: top/bottom, bottom > 0."""
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    shift = max(0, bits + 8 - h.bit_length() // 2)
    root, n2 = math.isqrt(h << 2 * shift), g.n2 << shift
    # n1/(√h − n2) or −(n2 + √h)/(3 n3): the form that does not cancel
    return (g.n1 << shift, root - n2) if g.n2 < 0 else (-(n2 + root), 3 * g.n3 << shift)


@dataclass(frozen=True, slots=True)
class Quartic:
    """A positive multiple f4 μ⁴ + … + f0 of det(S + λH), λ = side · μ, where `side` is the sign of h; all integers.

    The factors of det(M + λD) are p + side · q μ and e0 + e1 μ − e2 μ², with p, q, e0, e2 > 0. The interval in which
    M + λD is positive definite ends at p/q if `at_first`, else at the positive root of the second factor.
    """

    f4: int
    f3: int
    f2: int
    f1: int
    f0: int
    p: int
    q: int
    e0: int
    e1: int
    e2: int
    side: int
    at_first: bool

    @property
    def coefficients(self) -> tuple[int, ...]:
        """f4, f3, f2, f1, f0."""
        return (self.f4, self.f3, self.f2, self.f1, self.f0)


def quartic(lengths: Lengths) -> Quartic:
    """Return the quartic of a pair whose spheroid is neither upright nor a sphere."""
    constants = _constants(lengths)
    p, s, q, *_, e0, e1, e2 = constants
    (f4, f3, f2, f1, f0), height = _quartic(lengths, constants, lengths.x, lengths.y, lengths.z)
    side = (height > p * s) - (height < p * s)
    at_first = side < 0 and lengths.b > lengths.d
    return Quartic(f4, side * f3, f2, side * f1, f0, p, q, e0, side * e1, e2, side, at_first)


def quartic_coefficients(sizes: Lengths, x: Number, y: Number, z: Number) -> tuple[Number, ...]:
    """Return the coefficients of F, for λ itself, for these sizes and this axis and a centre of any kind of number."""
    return _quartic(sizes, _constants(sizes), x, y, z)[0]


def second_factor(sizes: Lengths) -> tuple[int, int, int]:
    """Return e0, e1, e2 of det(M + λD)'s second factor E = e0 + e1 λ − e2 λ², for λ itself."""
    *_, e0, e1, e2 = _constants(sizes)
    return e0, e1, e2


_Constants = tuple[int, int, int, int, int, int, int, int, int, int]
"""p, s, q, t, V, g1, g2, e0, e1, e2."""


def _quartic(
    sizes: Lengths, constants: _Constants, x: Number, y: Number, z: Number
) -> tuple[tuple[Number, ...], Number]:
    """Return the coefficients, and p s times the hyperboloid's equation at the centre, except for its constant."""
    p, s, q, t, V, g1, g2, e0, e1, e2 = constants
    R, Z = across_and_along(sizes, x, y, z)
    N2, T = _products(sizes, x, y, z)
    height = R * s - Z * p
    G1 = height * V - e0 - e1
    G2 = e2 - e1 - R * g2 - Z * g1 - T * (2 * (q - t))
    off_plane = N2 * (q - t)
    f3, f2 = (G2 + off_plane) * q + p * e2, G2 * p + G1 * q - off_plane * s
    return (q * e2, f3, f2, G1 * p - q * e0, -p * e0), height


def _constants(sizes: Lengths) -> _Constants:
    """Compute the constants of F that do not depend on the centre."""
    p, s, q, t = _squares(sizes)
    W, c = across_and_along(sizes, *sizes.axis)
    V, g1, g2 = W + c, t * W + q * c, q * W + t * c
    return p, s, q, t, V, g1, g2, p * s * V, s * g1 - p * g2, q * t * V


def _squares(sizes: Lengths) -> tuple[int, int, int, int]:
    """Return p, s, q, t of the module's docstring, times w·w if the hyperboloid is tilted."""
    unit = dot(sizes.upward, sizes.upward)
    return sizes.alpha**2 * unit, sizes.gamma**2 * unit, sizes.b**2 * unit, sizes.d**2 * unit


def _products(sizes: Lengths, x: Number, y: Number, z: Number) -> tuple[Number, Number]:
    """Return N² and T of the module's docstring."""
    if sizes.upward == _VERTICAL:
        a, b, c = sizes.axis
        across = x * b - y * a
        return across * across, (x * a + y * b) * z * c
    center, axis, upward = (x, y, z), sizes.axis, sizes.upward
    unit, product = dot(upward, upward), dot(axis, upward)
    height, along = dot(center, upward), dot(center, axis)
    volume = dot(center, cross(axis, upward))
    return volume * volume * unit, (along * unit - height * product) * height * product


def slope_of_quotient(F: Quartic) -> Polynomial:
    """Return a polynomial that has the sign of φ′ on (0, ℓ), the highest power first.

    φ is F over the determinant of M + λD, up to a positive factor, so that its slope has the sign of
    F′ K − F K′, K = (p ± q μ)(e0 + e1 μ − e2 μ²).
    """
    signed = F.side * F.q
    K = (-signed * F.e2, signed * F.e1 - F.p * F.e2, signed * F.e0 + F.p * F.e1, F.p * F.e0)
    f = F.coefficients
    return difference(polynomial_product(derivative(f), K), polynomial_product(f, derivative(K)))


def toward_maximum(F: Quartic) -> Iterator[Fraction]:
    """Yield numbers μ > 0 that tend to the maximum of φ on (0, ℓ], by bisection; not all of them are < ℓ."""
    slope = slope_of_quotient(F)
    largest = max(abs(coefficient) for coefficient in (*F.coefficients, *slope)).bit_length()
    low, high = Fraction(1, 2 << largest), Fraction(2 << largest)
    while True:
        middle = power_near(low, high) if high > 4 * low else (low + high) / 2
        yield middle
        if rises(F, slope, middle):
            low = middle
        else:
            high = middle


def inside(F: Quartic, at: Fraction) -> bool:
    """Decide whether 0 < at < ℓ."""
    n, k = at.numerator, at.denominator
    before_first = F.side > 0 or F.q * n < F.p * k
    return n > 0 and before_first and F.e2 * n * n - F.e1 * n * k < F.e0 * k * k


def rises(F: Quartic, slope: Polynomial, at: Fraction) -> bool:
    """Decide whether `at` lies in (0, ℓ) before the maximum of φ, whose slope has this polynomial's sign."""
    return inside(F, at) and sign_at(slope, at) > 0
