"""Points that prove a crossing: the centre, and a point of the spheroid on the hyperboloid's other side.

For an upright pair all candidates lie in the plane through the axis: first simple points, then points nearer and nearer
to the best one. For a tilted pair they follow φ(λ) (exact.py): if its maximum is < 0, X(λ) = (M + λD)⁻¹ M C tends to a
point of the hyperboloid within the spheroid, and a little beyond this point the side changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from hypcheck.geometry.arithmetic import (
    adjugate,
    dot,
    exponent_of,
    floor_root,
    last,
    power_of_two,
    precisions,
    root_of,
    sign_of,
    times,
)
from hypcheck.geometry.pair import Lengths, over_one_denominator
from hypcheck.truth.certificate import Point, Query
from hypcheck.truth.pencil import Quartic, inside, quartic, toward_maximum

Vector = list[int]
Matrix = list[list[int]]
Homogeneous = tuple[Vector, int]


def points(pair: Query, lengths: Lengths) -> tuple[Point, ...]:
    """Return the centre and a point of the spheroid on the other side of the hyperboloid (or the centre alone, on it).

    The other point of an upright pair may lie on the hyperboloid. For a tilted pair it is strictly on the other side,
    which also excludes tangency; such points always exist, because X(λ) tends to a point within the spheroid or beyond.
    """
    forms = Forms(pair)
    center = (forms.center, 1)
    side = sign_of(forms.hyperboloid(center))
    if side == 0:
        return (forms.fraction(center),)
    candidates: Iterator[Homogeneous]
    if lengths.is_upright:
        most, candidates = 0, map(forms.homogeneous, _upright_candidates(pair, lengths, outward=side < 0))
    else:
        most, candidates = -1, _tilted_candidates(forms, quartic(lengths))
    for candidate in candidates:
        if forms.hyperboloid(candidate) * side <= most and forms.in_spheroid(candidate):
            return (forms.fraction(center), forms.fraction(candidate))
    raise AssertionError("unreachable: the candidates do not end")


def _upright_candidates(pair: Query, lengths: Lengths, outward: bool) -> Iterator[Point]:
    """Yield points of the spheroid in the plane through the axis: first simple ones, then some that near the best."""
    _, _, b, d, x, y, z = (Fraction(number) for number in pair.row[:7])
    radius = root_of(x * x + y * y, 30, upward=True)

    def moved(across: Fraction, along: Fraction) -> Point:
        """Return the centre moved by these parts of b and d: away from the axis and to the waist, or opposite."""
        to_waist = min(abs(z), along * d) if outward else -along * d
        height = z - to_waist if z >= 0 else z + to_waist
        if not radius:
            return (across * b, Fraction(0), height)
        stretch = 1 + across * b / radius if outward else max(1 - across * b / radius, Fraction(0))
        return (x * stretch, y * stretch, height)

    for fifths in ((5, 0), (0, 5), (4, 3), (3, 4)):  # Pythagorean triples: on the spheroid, or within
        yield moved(Fraction(fifths[0], 5), Fraction(fifths[1], 5))
    if outward and abs(z) < d:  # horizontally outward: a spheroid a little too wide for the throat crosses it there
        yield moved(1 - (z / d) ** 2, Fraction(1))
    for bits in precisions(start=8):
        near = _near_surface(lengths, bits)
        if near is None:
            continue
        stretch, height = near
        # From the centre through the nearest point, and beyond it by smaller and smaller shares of the distance.
        for beyond in (Fraction(1, 1 << bits // 2), Fraction(1, 1 << bits)):
            along = 1 + beyond
            w = z + d * (height - z / d) * along
            widened = 1 + (stretch - 1) * along
            yield (x * widened, y * widened, w) if radius else (b * stretch * along, Fraction(0), w)


def _near_surface(lengths: Lengths, bits: int) -> tuple[Fraction, Fraction] | None:
    """Find approximately the hyperboloid's nearest point to the centre, in spheroid radii: its radius and its height.

    The radius is given as a multiple of the centre's, except on the axis. None if `bits` is too small.
    """
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    A, B, z = Fraction(p, q), Fraction(s, t), Fraction(lengths.z, lengths.d)
    P = Fraction(lengths.x**2 + lengths.y**2, q)
    if P == 0:  # a circle of nearest points
        height = B * z / (A + B)
        return root_of(A * (1 + height * height / B), bits), height
    if z == 0 and A * P >= (A + B) ** 2:  # two nearest points, one above and one below
        return A / (A + B), root_of(B * (A * P / (A + B) ** 2 - 1), bits)
    at = _multiplier_of_nearest(lengths, bits)
    return (A / (A + at), z * B / (B - at)) if at is not None else None


def _multiplier_of_nearest(lengths: Lengths, bits: int) -> Fraction | None:
    """Return the root of F(t) = A P/(A+t)² − B Q/(B−t)² − 1 to `bits` bits of its distance to 0 and to the nearer pole.

    With t = −A m/n or t = B m/n, 0 ≤ m < n, the sign of F is that of a difference of integers.
    """
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    R, S = lengths.x**2 + lengths.y**2, lengths.z**2

    def falls_toward_A(m: int, n: int) -> bool:
        other = s * q * n + p * t * m
        return R * (n * other) ** 2 <= p * (n - m) ** 2 * (other * other + s * S * (q * n) ** 2)

    def falls_toward_B(m: int, n: int) -> bool:
        other = p * t * n + s * q * m
        return p * R * s * (t * n * (n - m)) ** 2 <= other * other * (s * (n - m) ** 2 + S * n * n)

    inside = falls_toward_A(0, 1)

    def too_far(share: Fraction) -> bool:
        m, n = share.numerator, share.denominator
        return not falls_toward_A(m, n) if inside else falls_toward_B(m, n)

    # First the ratio of the share's distances from 0 and from 1, as a power of 2; then the share between two of these.
    step, low = 1, 0
    direction = -1 if too_far(_odds(0)) else 1
    while too_far(_odds(low + direction * step)) is (direction < 0):
        low += direction * step
        step *= 2
        if step > 64 * bits:
            return None
    low, high = sorted((low, low + direction * step))
    low = last(lambda exponent: not too_far(_odds(exponent)), low, high)
    share = _bisect(too_far, _odds(low), _odds(low + 1), bits)
    return share * (Fraction(-p, q) if inside else Fraction(s, t))


def _odds(exponent: int) -> Fraction:
    """Return the number between 0 and 1 that is 2^exponent times as far from 0 as from 1."""
    odds = Fraction(2) ** exponent
    return odds / (odds + 1)


def _bisect(too_far: Callable[[Fraction], bool], low: Fraction, high: Fraction, steps: int) -> Fraction:
    """Halve the interval `steps` times toward the place where `too_far` becomes true; return its middle."""
    for _ in range(steps):
        middle = (low + high) / 2
        low, high = (low, middle) if too_far(middle) else (middle, high)
    return (low + high) / 2


class Forms:
    """The two surfaces' equations in integers, and the data for the pencil.

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

    def in_spheroid(self, point: Homogeneous) -> bool:
        """Decide whether (X − C)ᵀ M (X − C) ≤ 1."""
        X, w = point
        offset = [a - w * b for a, b in zip(X, self.center, strict=True)]
        return bool(dot(offset, times(self.M, offset)) <= w * w * self.under_M)

    def hyperboloid(self, point: Homogeneous) -> int:
        """Return Xᵀ D X − 1, times w² p s."""
        X, w = point
        return int(dot(X, self.gradient(X)) - w * w * self.under_D)

    def gradient(self, vector: Vector) -> Vector:
        """Return D times a vector, times p s."""
        return [a * b for a, b in zip(self.D, vector, strict=True)]

    def pencil(self, at: Fraction) -> tuple[Matrix, int]:
        """Return M + λD times a positive integer, and that integer."""
        n, k = at.numerator, at.denominator
        whole, part = self.under_D * k, n * self.under_M
        matrix = [[self.M[i][j] * whole + (i == j) * part * self.D[i] for j in range(3)] for i in range(3)]
        return matrix, self.under_M * whole

    def homogeneous(self, point: Point) -> Homogeneous:
        """Convert a point from the caller's coordinates."""
        numbers, under = over_one_denominator(point)
        return [number * self.unit for number in numbers], under

    def fraction(self, point: Homogeneous) -> Point:
        """Convert a point to the caller's coordinates."""
        (x, y, z), w = point
        under = w * self.unit
        return (Fraction(x, under), Fraction(y, under), Fraction(z, under))


def _tilted_candidates(forms: Forms, F: Quartic) -> Iterator[Homogeneous]:
    """Yield points that tend to the best one: first the steepest direction from the centre, X(λ), then X at a pole."""
    gradient = forms.gradient(forms.center)
    steepest, under = times(forms.inverse, gradient), forms.V * forms.under_D
    square = Fraction(dot(steepest, gradient), under * forms.under_D)
    for bits in (4, 60) if square else ():
        yield _plus((forms.center, 1), (steepest, under), -F.side * floor_root(1 / square, bits))
    for steps, at in enumerate(toward_maximum(F)):
        if not inside(F, at):
            continue
        matrix, scale = forms.pencil(at * F.side)
        # At a pole the adjugate has rank one, and any column spans the kernel.
        adjoint = adjugate(matrix)
        scaled = times(adjoint, times(forms.M, forms.center))
        whole = scale // forms.under_M
        point = ([part * whole for part in scaled], dot(matrix[0], adjoint[0]))
        yield point
        yield from _across_the_pole(forms, F, (adjoint, scale), point, 40 + steps)


def _across_the_pole(
    forms: Forms, F: Quartic, adjoint: tuple[Matrix, int], point: Homogeneous, bits: int
) -> Iterator[Homogeneous]:
    """Yield points a little beyond the hyperboloid, from one on the centre's side, in the pole's null direction.

    The step beyond is so small that only `bits` bits distinguish it from the hyperboloid: near tangency there is little
    room.
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
    reach = floor_root(root, bits + 24) * (1 + Fraction(1, 1 << bits))
    for sign in (1, -1):
        yield _plus(point, ([length * part for part in direction], square), sign * reach - slope)


def shortened(offset: Sequence[Fraction], bits: int, most: int) -> Iterator[tuple[Fraction, Fraction, Fraction]]:
    """Yield an offset, a little shorter so that it stays in the spheroid, with `bits` bits and more, below `most`."""
    longest = max(map(abs, offset))
    unit = power_of_two(exponent_of(longest))
    while bits < most:
        step, share = unit / (1 << bits), 1 - Fraction(1, 1 << bits)
        x, y, z = (round(part * share / step) * step for part in offset)
        yield x, y, z
        bits += 1 + bits // 4


def _plus(point: Homogeneous, direction: Homogeneous, factor: Fraction) -> Homogeneous:
    """Add a multiple of a direction to a point; both are given over their denominators."""
    (X, w), (offset, under) = point, direction
    n, k = factor.numerator * w, factor.denominator * under
    return [a * k + n * b for a, b in zip(X, offset, strict=True)], w * k
