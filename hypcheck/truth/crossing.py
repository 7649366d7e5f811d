"""Points that prove a crossing: the centre, and a point of the spheroid on the hyperboloid's other side.

Candidates go along φ(λ) (exact.py): where its maximum is < 0, X(λ) = (M + λD)⁻¹ M C tends to a point of the hyperboloid
within the spheroid, and a little beyond it the sides have changed. Of an upright spheroid a few simple points come
first, since most crossings have one with few digits.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import chain

from hypcheck.geometry.pair import Lengths, over_one_denominator
from hypcheck.truth.certificate import Point, Query
from hypcheck.truth.pencil import Quartic, around_maximum, inside, quartic
from hypcheck.truth.rationals import adjugate, dot, floor_root, precisions, root_of, times

Vector = list[int]
Matrix = list[list[int]]
Homogeneous = tuple[Vector, int]


def points(pair: Query, lengths: Lengths) -> tuple[Point, ...]:
    """The centre and a point of the spheroid strictly on the hyperboloid's other side (or the centre alone, on it).

    Such points rule tangency out, too. There always are some: X(λ) tends to a point within the spheroid or beyond.
    """
    forms, F = _Forms(pair), quartic(lengths)
    if F.side == 0:
        return (forms.fraction((forms.center, 1)),)
    simple = _simple_candidates(pair, outward=F.side < 0) if lengths.is_upright else ()
    for candidate in chain(map(forms.point, simple), _candidates(forms, F)):
        if forms.hyperboloid(candidate) * F.side < 0 and forms.in_spheroid(candidate):
            return (forms.fraction((forms.center, 1)), forms.fraction(candidate))
    raise AssertionError("unreachable: the candidates do not end")


def _simple_candidates(pair: Query, outward: bool) -> Iterator[Point]:
    """Points of an upright spheroid's plane through the axis that have few digits."""
    _, _, b, d, x, y, z = (Fraction(number) for number in pair.row[:7])
    radius = root_of(x * x + y * y, 30, upward=True)

    def moved(across: Fraction, along: Fraction) -> Point:
        """The centre moved by these parts of b and d: away from the axis and to the waist, or the other way."""
        to_waist = min(abs(z), along * d) if outward else -along * d
        height = z - to_waist if z >= 0 else z + to_waist
        if not radius:
            return (across * b, Fraction(0), height)
        stretch = 1 + across * b / radius if outward else max(1 - across * b / radius, Fraction(0))
        return (x * stretch, y * stretch, height)

    for fifths in ((5, 0), (0, 5), (4, 3), (3, 4)):  # Pythagorean triples: on the spheroid, or within
        yield moved(Fraction(fifths[0], 5), Fraction(fifths[1], 5))
    if outward and abs(z) < d:  # right out from the waist, where a spheroid a little too wide for the throat sticks out
        yield moved(1 - (z / d) ** 2, Fraction(1))


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
        p, s, q, t = (length * length for length in lengths[:4])
        self.center = lengths[4:]
        self.V = dot(v, v)
        self.M = [[(i == j) * t * self.V + (q - t) * v[i] * v[j] for j in range(3)] for i in range(3)]
        self.inverse = [[(i == j) * q * self.V + (t - q) * v[i] * v[j] for j in range(3)] for i in range(3)]
        self.D = [s, s, -p]
        self.under_M, self.under_D = q * t * self.V, p * s

    def point(self, point: Point) -> Homogeneous:
        """A point in the caller's coordinates."""
        whole, under = over_one_denominator([self.unit * part for part in point])
        return whole, under

    def in_spheroid(self, point: Homogeneous) -> bool:
        """Whether (X − C)ᵀ M (X − C) ≤ 1."""
        X, w = point
        way = [a - w * b for a, b in zip(X, self.center, strict=True)]
        return bool(dot(way, times(self.M, way)) <= w * w * self.under_M)

    def hyperboloid(self, point: Homogeneous) -> int:
        """Xᵀ D X − 1, times w² p s."""
        X, w = point
        return int(dot(X, self.gradient(X)) - w * w * self.under_D)

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
    steepest, under = times(forms.inverse, gradient), forms.V * forms.under_D
    square = Fraction(dot(steepest, gradient), under * forms.under_D)
    for bits in (4, 60) if square else ():
        yield _plus((forms.center, 1), (steepest, under), -F.side * floor_root(1 / square, bits))
    for bits, (low, high) in zip(precisions(), around_maximum(F), strict=False):
        beyond = inside(F, high)
        matrix, scale = forms.pencil((high if beyond else low) * F.side)
        # At a pole the adjugate has rank one, and any column spans the kernel.
        adjoint = adjugate(matrix)
        scaled = times(adjoint, times(forms.M, forms.center))
        whole = scale // forms.under_M
        point = ([part * whole for part in scaled], dot(matrix[0], adjoint[0]))
        if beyond:
            yield point
        else:
            yield from _across_the_pole(forms, F, (adjoint, scale), point, 40 + bits)


def _across_the_pole(
    forms: _Forms, F: Quartic, adjoint: tuple[Matrix, int], point: Homogeneous, bits: int
) -> Iterator[Homogeneous]:
    """From a point on the centre's side to the hyperboloid, and a little on, along the direction that a pole leaves.

    So little that only `bits` bits tell it from the hyperboloid: the nearer to tangency, the less room there is.
    """
    matrix, scale = adjoint
    direction = max(matrix, key=lambda column: dot(column, column))
    gradient, (X, w) = forms.gradient(direction), point
    curvature, height = dot(direction, gradient), forms.hyperboloid(point)
    if curvature * F.side >= 0 or height * F.side <= 0:
        return
    # The direction is the adjugate's column in the caller's unit; curvature τ² + 2 slope τ + height = 0.
    square, length = scale * scale, forms.unit**5
    slope = Fraction(dot(gradient, X) * square, w * length * curvature)
    root = slope**2 - Fraction(height * square * square, w * w * length * length * curvature)
    way = floor_root(root, bits + 24) * (1 + Fraction(1, 1 << bits))
    for sign in (1, -1):
        yield _plus(point, ([length * part for part in direction], square), sign * way - slope)


def shortened(offset: Sequence[Fraction], bits: int, most: int) -> Iterator[tuple[Fraction, Fraction, Fraction]]:
    """An offset, a little shorter so that it stays in the spheroid, with `bits` bits and more, below `most`."""
    longest = max(map(abs, offset))
    unit = Fraction(2) ** (longest.numerator.bit_length() - longest.denominator.bit_length())
    while bits < most:
        step, share = unit / (1 << bits), 1 - Fraction(1, 1 << bits)
        x, y, z = (round(part * share / step) * step for part in offset)
        yield x, y, z
        bits += 1 + bits // 4


def _plus(point: Homogeneous, direction: Homogeneous, factor: Fraction) -> Homogeneous:
    """A point and a multiple of a direction, each over its denominator."""
    (X, w), (way, under) = point, direction
    n, k = factor.numerator * w, factor.denominator * under
    return [a * k + n * b for a, b in zip(X, way, strict=True)], w * k
