"""Finding the witness that certificate.py checks, for a spheroid in general position.

All searches go along φ(λ), concave between −ℓ′ and ℓ (exact.py): its maximum is found by bisection with exact signs.
Where it is > 0, a λ near it is the witness; where it is < 0, X(λ) = (M + λD)⁻¹ M C tends to a point of the hyperboloid
within the spheroid, and a little beyond it the sides have changed. A witness always exists and every search narrows
until its claim holds exactly, so each one ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from hypcheck.geometry.pair import Position
from hypcheck.truth import prove as upright
from hypcheck.truth.certificate import Certificate, Point
from hypcheck.truth.polynomial_roots import polynomial_product
from hypcheck.truth.tilted import exact
from hypcheck.truth.tilted.certificate import Query
from hypcheck.truth.tilted.exact import Quartic, TiltedDecision
from hypcheck.truth.tilted.pair import TiltedPair, over_one_denominator

Vector = list[int]
Matrix = list[list[int]]
Homogeneous = tuple[Vector, int]


def prove(pair: TiltedPair, decision: TiltedDecision | None = None) -> Certificate:
    """A certificate for the exact answer about a pair (`decision`, where the caller has it already)."""
    vertical = pair.upright
    if vertical is not None:
        return upright.prove(vertical)
    lengths = pair.lengths
    decision = decision or exact.decide(lengths)
    F = exact.quartic(lengths)
    if decision.tangent:
        return Certificate(decision.position, double_root=exact.double_root(F) * F.side)
    if decision.position is Position.CONTACT:
        return Certificate(decision.position, points=points(pair, F))
    return Certificate(decision.position, multiplier=_multiplier(F))


def _multiplier(F: Quartic) -> Fraction:
    """A λ at which F is positive between 0 and ℓ, rounded to the fewest bits (a power of two of them) that will do."""
    found = next(at for at in _toward_maximum(F) if inside(F, at) and exact.sign_at(F.coefficients, at) > 0)
    for bits in upright.precisions():
        at = _round(found, bits)
        if inside(F, at) and exact.sign_at(F.coefficients, at) > 0:
            return at * F.side
    raise AssertionError("unreachable: the precisions do not end")


def slope_of_quotient(F: Quartic) -> tuple[int, ...]:
    """A polynomial that has the sign of φ′ on (0, ℓ), the highest power first.

    φ is F over the determinant of M + λD, up to a positive factor, so that its slope has the sign of
    F′ K − F K′, K = (p ± q μ)(e0 + e1 μ − e2 μ²).
    """
    signed = F.side * F.q
    K = (-signed * F.e2, signed * F.e1 - F.p * F.e2, signed * F.e0 + F.p * F.e1, F.p * F.e0)
    return _difference(polynomial_product(_derived(F.coefficients), K), polynomial_product(F.coefficients, _derived(K)))


def _toward_maximum(F: Quartic) -> Iterator[Fraction]:
    """Numbers μ > 0 that tend to where φ has its maximum on (0, ℓ], by bisection; not all of them are < ℓ."""
    slope = slope_of_quotient(F)
    largest = max(abs(each) for each in (*F.coefficients, *slope)).bit_length()
    low, high = Fraction(1, 2 << largest), Fraction(2 << largest)
    while True:
        middle = _power_near(low, high) if high > 4 * low else (low + high) / 2
        yield middle
        if inside(F, middle) and exact.sign_at(slope, middle) > 0:
            low = middle
        else:
            high = middle


def inside(F: Quartic, at: Fraction) -> bool:
    """Whether 0 < at < ℓ."""
    n, k = at.numerator, at.denominator
    before_first = F.side > 0 or F.q * n < F.p * k
    return n > 0 and before_first and F.e2 * n * n - F.e1 * n * k < F.e0 * k * k


def points(pair: Query, F: Quartic) -> tuple[Point, ...]:
    """The centre and a point of the spheroid strictly on the hyperboloid's other side (or the centre alone, on it).

    Such points rule tangency out, too. There always are some: X(λ) tends to a point within the spheroid or beyond.
    """
    forms = _Forms(pair)
    center = forms.fraction((forms.center, 1))
    if F.side == 0:
        return (center,)
    for candidate in _candidates(forms, F):
        if forms.hyperboloid(candidate) * F.side < 0 and forms.in_spheroid(candidate):
            return (center, forms.fraction(candidate))
    raise AssertionError("unreachable: the candidates do not end")


class _Forms:
    """The two surfaces' equations in integers, and what the pencil needs of them.

    Lengths are integers over their common denominator L, so that the unit is 1/L. With V = v·v, q = b², t = d², p = α²
    and s = γ², M is `M` over q t V, its inverse is `inverse` over V, and D is the diagonal `D` over p s. A point is
    (X, w), w ≠ 0: its coordinates are X/w. No fraction is reduced before the end, because that would take most of the
    time.
    """

    def __init__(self, pair: Query) -> None:
        lengths, self.unit = over_one_denominator(pair.row[:7])
        v, _ = over_one_denominator(pair.axis)
        p, s, q, t = (each * each for each in lengths[:4])
        self.center = lengths[4:]
        self.V = _dot(v, v)
        self.M = [[(i == j) * t * self.V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
        self.inverse = [[(i == j) * q * self.V + (t - q) * v[i] * v[j] for j in range(3)] for i in range(3)]
        self.D = [s, s, -p]
        self.under_M, self.under_D = q * t * self.V, p * s

    def in_spheroid(self, point: Homogeneous) -> bool:
        """Whether (X − C)ᵀ M (X − C) ≤ 1."""
        X, w = point
        way = [a - w * b for a, b in zip(X, self.center, strict=True)]
        return _dot(way, _times(self.M, way)) <= w * w * self.under_M

    def hyperboloid(self, point: Homogeneous) -> int:
        """Xᵀ D X − 1, times w² p s."""
        X, w = point
        return _dot(X, self.gradient(X)) - w * w * self.under_D

    def gradient(self, vector: Vector) -> Vector:
        """D times a vector, times p s."""
        return [a * b for a, b in zip(self.D, vector, strict=True)]

    def pencil(self, at: Fraction) -> tuple[Matrix, int]:
        """M + λD times a positive integer, and that integer."""
        n, k = at.numerator, at.denominator
        whole, part = self.under_D * k, n * self.under_M
        matrix = [[self.M[i][j] * whole + (i == j) * part * self.D[i] for j in range(3)] for i in range(3)]
        return matrix, self.under_M * whole

    def fraction(self, point: Homogeneous) -> Point:
        """A point in the caller's coordinates."""
        (x, y, z), w = point
        under = w * self.unit
        return (Fraction(x, under), Fraction(y, under), Fraction(z, under))


def _candidates(forms: _Forms, F: Quartic) -> Iterator[Homogeneous]:
    """Points ever nearer to the best one: first along the steepest way from the centre, then X(λ), then X at a pole."""
    gradient = forms.gradient(forms.center)
    steepest, under = _times(forms.inverse, gradient), forms.V * forms.under_D
    square = Fraction(_dot(steepest, gradient), under * forms.under_D)
    for bits in (4, 60) if square else ():
        yield _plus((forms.center, 1), (steepest, under), -F.side * _root(1 / square, bits))
    for steps, at in enumerate(_toward_maximum(F)):
        if not inside(F, at):
            continue
        matrix, scale = forms.pencil(at * F.side)
        # At a pole the adjugate has rank one, and any column spans the kernel.
        adjugate = [[_cofactor(matrix, j, i) for j in range(3)] for i in range(3)]
        scaled = _times(adjugate, _times(forms.M, forms.center))
        whole = scale // forms.under_M
        point = ([each * whole for each in scaled], _dot(matrix[0], [row[0] for row in adjugate]))
        yield point
        yield from _across_the_pole(forms, F, (adjugate, scale), point, 40 + steps)


def _across_the_pole(
    forms: _Forms, F: Quartic, adjugate: tuple[Matrix, int], point: Homogeneous, bits: int
) -> Iterator[Homogeneous]:
    """From a point on the centre's side to the hyperboloid, and a little on, along the direction that a pole leaves.

    So little that only `bits` bits tell it from the hyperboloid: the nearer to tangency, the less room there is.
    """
    matrix, scale = adjugate
    direction = max(matrix, key=lambda column: _dot(column, column))
    gradient, (X, w) = forms.gradient(direction), point
    curvature, height = _dot(direction, gradient), forms.hyperboloid(point)
    if curvature * F.side >= 0 or height * F.side <= 0:
        return
    # The direction is the adjugate's column in the caller's unit; curvature τ² + 2 slope τ + height = 0.
    square, length = scale * scale, forms.unit**5
    slope = Fraction(_dot(gradient, X) * square, w * length * curvature)
    root = slope**2 - Fraction(height * square * square, w * w * length * length * curvature)
    way = _root(root, bits + 24) * (1 + Fraction(1, 1 << bits))
    for sign in (1, -1):
        yield _plus(point, ([length * each for each in direction], square), sign * way - slope)


def _dot(a: Vector, b: Vector) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _times(matrix: Matrix, vector: Vector) -> Vector:
    return [_dot(row, vector) for row in matrix]


def _plus(point: Homogeneous, direction: Homogeneous, factor: Fraction) -> Homogeneous:
    """A point and a multiple of a direction, each over its denominator."""
    (X, w), (way, under) = point, direction
    n, k = factor.numerator * w, factor.denominator * under
    return [a * k + n * b for a, b in zip(X, way, strict=True)], w * k


def _cofactor(m: Matrix, i: int, j: int) -> int:
    (a, b), (c, d) = ([m[r][s] for s in range(3) if s != j] for r in range(3) if r != i)
    return (b * c - a * d) if (i + j) % 2 else (a * d - b * c)


def _derived(f: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(each * (len(f) - 1 - i) for i, each in enumerate(f[:-1]))


def _difference(f: tuple[int, ...], g: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(a - b for a, b in zip(f, g, strict=True))


def _exponent(value: Fraction) -> int:
    return value.numerator.bit_length() - value.denominator.bit_length()


def _power(exponent: int) -> Fraction:
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


def _power_near(low: Fraction, high: Fraction) -> Fraction:
    """A power of two about midway between two exponents, strictly between low and high > 4 low."""
    # 2^(e−1) < value < 2^(e+1) for the exponent e of a value: e(low) + 1 ≤ k ≤ e(high) − 1 is strictly between.
    first, last = _exponent(low) + 1, _exponent(high) - 1
    return _power((first + last) // 2)


def _root(square: Fraction, bits: int) -> Fraction:
    """√square rounded down to about `bits` bits."""
    shift = max(0, bits + (square.denominator.bit_length() - square.numerator.bit_length()) // 2 + 1)
    return Fraction(math.isqrt((square.numerator << 2 * shift) // square.denominator), 1 << shift)


def _round(value: Fraction, bits: int) -> Fraction:
    """`value` to `bits` significant bits."""
    unit = _power(_exponent(value) - bits)
    return Fraction(round(value / unit)) * unit
