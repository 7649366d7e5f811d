"""The nearest point for arrays of tilted spheroids: the clearance rounded to float64, if an error bound allows it.

nearest.py answers a pair exactly; here any λ and any point X near the nearest one, both found in float64 and taken
as given, enclose the same distance. With s(X) = (X − C)ᵀM(X − C) − 1, G = M + λD ≥ μ > 0, r = G X − M C and L = s(X) +
λ h(X), which is a convex function of X with the minimum φ(λ) at X̂ = X − G⁻¹r:

    sup φ ≥ φ(λ) = L − rᵀG⁻¹r ≥ L − |r|²/μ
    sup φ ≤ s(X′) = φ(λ) + (X′ − X̂)ᵀG(X′ − X̂) ≤ L + tr(G) (|h|/|n| + |r|/μ)²

for a point X′ of the hyperboloid with |X′ − X| ≤ |h|/|n|. There is one on the line along n = D X where |h| max|D| <
|n|²: h(X − (h/|n|²) n) has not the sign of h. Both ends are off by squares of small numbers, so that L, in
double-double, is the distance to some thirty digits. G ≥ μ is shown by Sylvester's minors of G − 2μ.

Rounding (η = double_double.ERROR bounds an operation, u = 2⁻⁵³):
    v × w within 5η|v||w|, v·w within 4η|v||w|, their squares within 14η|v|²|w|², v² within 3η, so with three more
    operations s + 1 = |v × w|²/(v² b²) + (v·w)²/(v² d²) within 20η|w|²(1/b² + 1/d²);
    h within 7η(1 + X²/α² + Y²/α² + Z²/γ²); L one operation for each of two sums and a product more: 32 η covers it all;
    r in float64: M w within 24u|w|(1/b² + 1/d²), λ D X within 4u|λ||D X|, their sum one more: 32 u;
    an entry of G within 10u of 1/b² + 1/d² + |λ|(1/α² + 1/γ²), so G within 30u of it, 64 u with that of G − 2μ;
    the minors within 4u and 16u of the same expressions with all signs +.
Lengths lie in 2^±100 or are 0, so that nothing overflows and no underflow matters.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.arithmetic import cross, dot
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows
from hypcheck.truth import double_double
from hypcheck.truth.double_double import DoubleDouble

_RANGE = (2.0**-100, 2.0**100)
_U = 2.0**-53
_STEPS = 3
_LEAST_SQUARE = 2.0**-10
"""The least square of a distance, in radii, that is decided: below it a bound of φ says too little of √(1 + φ)."""

_ROUNDED = 2.0**-90
"""More than the relative error of L, 32 η = 2⁻⁹⁷ of the sum of its terms."""

Triple = tuple[Floats, Floats, Floats]


@dataclass(frozen=True, slots=True)
class Decided:
    """For each of n rows the clearance and the position, each with a mask of the rows where it is proved.

    A clearance is proved if it is correctly rounded.
    """

    clearance: Floats
    clearance_certain: Mask
    position: Positions
    position_certain: Mask


def decide(rows: Rows) -> Decided:
    """Compute clearance and position of valid rows (n, 10) as far as double-double arithmetic can decide.

    The position is certain where the clearance is, and a tangency never is.
    """
    clearance, position = np.zeros(len(rows)), np.zeros(len(rows), np.int8)
    certain = np.zeros(len(rows), np.bool_)
    places = np.flatnonzero(_inside(rows))
    if len(places):
        with np.errstate(all="ignore"):
            clearance[places], position[places], certain[places] = _decided(rows[places])
    return Decided(clearance, certain, position, certain)


def _inside(rows: Rows) -> Mask:
    """Return a mask of the rows whose lengths are within the limits, and whose axis can be scaled exactly."""
    size = np.abs(rows)
    lengths = np.where(size[:, :7] > 0, size[:, :7], 1.0)
    axis = np.where(size[:, 7:] > 0, size[:, 7:], size[:, 7:].max(axis=1, keepdims=True))
    ordinary = (lengths >= _RANGE[0]) & (lengths <= _RANGE[1])
    return np.asarray(ordinary.all(axis=1) & (axis.min(axis=1) >= 2.0**-100 * axis.max(axis=1)))


@dataclass(frozen=True, slots=True)
class _Pairs:
    """The columns of rows: `sizes` are α, γ, b, d, (4, n), `thick` is 1/b², `long` is 1/d², `D` is 1/α², 1/α², −1/γ².

    The axis is scaled so that its largest number is in [1/2, 1).
    """

    sizes: Floats
    centre: Triple
    axis: Triple
    thick: Floats
    long: Floats
    D: Triple

    @classmethod
    def of(cls, rows: Rows) -> _Pairs:
        """Make the columns of rows (n, 10)."""
        alpha, gamma, b, d, x, y, z, *axis = np.ascontiguousarray(rows.T)
        exponents = np.frexp(np.max(np.abs(axis), axis=0))[1]
        v_x, v_y, v_z = (np.ldexp(part, -exponents) for part in axis)
        across, up = 1 / (alpha * alpha), 1 / (gamma * gamma)
        sizes = np.stack([alpha, gamma, b, d])
        return cls(sizes, (x, y, z), (v_x, v_y, v_z), 1 / (b * b), 1 / (d * d), (across, across, -up))


def _decided(rows: Rows) -> tuple[Floats, Positions, Mask]:
    """Compute the clearance and the position of rows, and a mask of the rows where both are proved."""
    pairs = _Pairs.of(rows)
    X, at = _polished(pairs, *_start(pairs))
    L, below, above = _enclosed(pairs, X, at)
    clear, contact = L[0] - 1.001 * below > 0, L[0] + 1.001 * above < 0
    position = np.where(clear, np.sign(at), 0).astype(np.int8)
    squared = double_double.add_float(L, 1.0)
    divisor = double_double.add_float(double_double.square_root(squared), 1.0)
    high, low = double_double.divide(L, divisor)
    error = np.maximum(below, above) / np.sqrt(squared[0]) + 8 * double_double.ERROR * np.abs(high)
    certain = (clear | contact) & double_double.rounds_to_high((high, low), error)
    return high, position, certain & (squared[0] > _LEAST_SQUARE)


def _start(pairs: _Pairs) -> tuple[Triple, Floats]:
    """Find X and λ near the best ones, a hint without a proof: r = 0 at this λ."""
    at = multipliers(pairs.sizes, pairs.centre, pairs.axis)
    adjugate, determinant = _adjugate(_matrix(pairs, at))
    zero = np.zeros_like(at)
    residual, _ = _residual(pairs, (zero, zero, zero), at)
    x, y, z = (-part / determinant for part in _times(adjugate, residual))
    return (x, y, z), at


def multipliers(sizes: Floats, centre: Iterable[Floats], axis: Iterable[Floats]) -> Floats:
    """Find approximately the λ at which φ is largest, (n,): the root of its slope, by bisection between its poles.

    A hint without a proof, from sizes (4, n) and the columns of centres and axes.
    """
    (alpha, gamma, b, d), (x, y, z), (v_x, v_y, v_z) = sizes, centre, axis
    horizontal = np.hypot(v_x, v_y)
    length = np.hypot(horizontal, v_z)
    safe = np.where(horizontal == 0, 1.0, horizontal)
    ahead, aside = np.where(horizontal == 0, (x, y), ((x * v_x + y * v_y) / safe, (y * v_x - x * v_y) / safe))
    sine, cosine, radial, axial = horizontal / length, v_z / length, 1 / alpha**2, 1 / gamma**2
    e, g = d**2 * (sine**2 * radial - cosine**2 * axial), b**2 * (cosine**2 * radial - sine**2 * axial)
    f = b * d * sine * cosine * (radial + axial)
    half, trace = (e - g) / 2, (e + g) / 2
    root, minus_det = np.hypot(half, f), (b * d / (alpha * gamma)) ** 2
    size = np.sqrt(trace**2 + minus_det)
    positive = np.where(trace > 0, trace + size, minus_det / (size - trace))
    one, two = np.where(half > 0, (root + half, f), (f, root - half))
    one = np.where((one == 0) & (two == 0), 1.0, one)
    along, across_it = (ahead * sine + z * cosine) / d, (ahead * cosine - z * sine) / b
    square = one**2 + two**2
    P1, P2, Q = (
        (aside / b) ** 2,
        (along * one + across_it * two) ** 2 / square,
        (across_it * one - along * two) ** 2 / square,
    )
    return _root((alpha / b) ** 2, 1 / positive, positive / minus_det, P1, P2, Q)


def _root(A1: Floats, A2: Floats, B: Floats, P1: Floats, P2: Floats, Q: Floats) -> Floats:
    """Find by bisection the λ from −min(A1, A2) to B at which φ's slope is 0, for each row, (n,).

    The slope is A1 P1/(A1 + λ)² + A2 P2/(A2 + λ)² − B Q/(B − λ)² − 1. The ratio of λ's distance from 0 to its distance
    from the end of the interval is searched, by its logarithm.
    """
    least = np.minimum(A1, A2)
    outside = P1 / A1 + P2 / A2 - Q / B - 1 > 0
    end = np.where(outside, B, least)
    low, high = np.full(len(A1), -300.0), np.full(len(A1), 60.0)
    for _ in range(40):
        middle = (low + high) / 2
        ratio = np.exp2(middle)
        left = end / (1 + ratio)
        gone = left * ratio
        one, two, three = np.where(
            outside, (A1 + gone, A2 + gone, left), (A1 - least + left, A2 - least + left, B + gone)
        )
        reached = (A1 * P1 / one**2 + A2 * P2 / two**2 - B * Q / three**2 - 1 > 0) != outside
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    ratio = np.exp2(low)
    return np.asarray(np.where(outside, B, -least) * ratio / (1 + ratio))


def _polished(pairs: _Pairs, X: Triple, at: Floats) -> tuple[Triple, Floats]:
    """Improve the hint X, λ = `at` by Newton's steps for r = 0 and h = 0 in float64."""
    for _ in range(_STEPS):
        residual, n = _residual(pairs, X, at)
        adjugate, determinant = _adjugate(_matrix(pairs, at))
        of_n, of_r = _times(adjugate, n), _times(adjugate, residual)
        height = _height(pairs, X)[0][0]
        step = (determinant * height / 2 - dot(n, of_r)) / dot(n, of_n)
        x, y, z = (x - (r + step * k) / determinant for x, r, k in zip(X, of_r, of_n, strict=True))
        X, at = (x, y, z), at + step
    return X, at


def _enclosed(pairs: _Pairs, X: Triple, at: Floats) -> tuple[DoubleDouble, Floats, Floats]:
    """Compute L at X and λ = `at`, and how far below and above it the supremum of φ can be; inf if nothing is proved.

    L and φ are those of the module's docstring: sup φ is the squared distance of the hyperboloid, in radii, less 1.
    """
    _, _, b, d = pairs.sizes
    height, terms = _height(pairs, X)
    w = tuple(_subtracted(x, c) for x, c in zip(X, pairs.centre, strict=True))
    v = tuple((component, np.zeros_like(component)) for component in pairs.axis)
    across = _sum_of_squares([_cross(v, w, k) for k in range(3)])
    along = double_double.square(
        double_double.sum_of([double_double.multiply(p, q) for p, q in zip(v, w, strict=True)])
    )
    axis_square = _sum_of_squares(v)
    parts = [
        double_double.divide(part, double_double.multiply(axis_square, double_double.two_square(size)))
        for part, size in ((across, b), (along, d))
    ]
    by_height = double_double.multiply((at, np.zeros_like(at)), height)
    L = double_double.add(double_double.add_float(double_double.sum_of(parts), -1.0), by_height)

    residual, n = _residual(pairs, X, at)
    size = np.sqrt(sum(component[0] * component[0] for component in w))
    stretch, tilt = pairs.thick + pairs.long, np.abs(at)
    length = np.sqrt(dot(n, n))
    rounded = _ROUNDED * (size * size * stretch + 1 + tilt * terms)
    off = np.sqrt(dot(residual, residual)) + 32 * _U * (size * stretch + tilt * length)
    least = _least_eigenvalue(pairs, at)
    trace = 2 * stretch + tilt * (2 * pairs.D[0] - pairs.D[2])
    beside = 1.001 * (np.abs(height[0]) + _ROUNDED * terms) / length
    meets = 1.01 * beside * np.maximum(pairs.D[0], -pairs.D[2]) < length
    below = rounded + 1.01 * off * off / least
    above = rounded + 1.01 * trace * (beside + off / least) ** 2
    return L, np.where(least > 0, below, np.inf), np.where((least > 0) & meets, above, np.inf)


def _least_eigenvalue(pairs: _Pairs, at: Floats) -> Floats:
    """Return a lower bound of the eigenvalues of M + λD, from the minors of a smaller matrix; 0 if these give none."""
    matrix = _matrix(pairs, at)
    scale = pairs.thick + pairs.long + np.abs(at) * (pairs.D[0] - pairs.D[2])
    adjugate, determinant = _adjugate(matrix)
    guess = determinant / (adjugate[0] + adjugate[3] + adjugate[5])  # from a third of the least eigenvalue up to it
    g00, g01, g02, g11, g12, g22 = matrix
    g00, g11, g22 = (entry - guess / 2 for entry in (g00, g11, g22))
    minor, minor_terms = g00 * g11 - g01 * g01, np.abs(g00 * g11) + g01 * g01
    _, determinant = _adjugate((g00, g01, g02, g11, g12, g22))
    terms = (
        np.abs(g00) * (np.abs(g11 * g22) + g12 * g12)
        + np.abs(g01) * (np.abs(g01 * g22) + np.abs(g12 * g02))
        + np.abs(g02) * (np.abs(g01 * g12) + np.abs(g11 * g02))
    )
    definite = (g00 > 0) & (minor > 4 * _U * minor_terms) & (determinant > 16 * _U * terms)
    return np.where(definite & (guess > 256 * _U * scale), guess / 4, 0.0)


def _matrix(pairs: _Pairs, at: Floats) -> tuple[Floats, ...]:
    """Return the upper half of M + λD: 00, 01, 02, 11, 12, 22."""
    v = pairs.axis
    excess, own = (pairs.long - pairs.thick) / dot(v, v), [pairs.thick + at * D for D in pairs.D]
    return tuple(excess * v[i] * v[j] + (own[i] if i == j else 0.0) for i in range(3) for j in range(i, 3))


def _adjugate(matrix: tuple[Floats, ...]) -> tuple[tuple[Floats, ...], Floats]:
    """Return the upper half of a symmetric matrix's adjugate, and its determinant."""
    g00, g01, g02, g11, g12, g22 = matrix
    a00, a01, a02 = g11 * g22 - g12 * g12, g02 * g12 - g01 * g22, g01 * g12 - g02 * g11
    adjugate = (a00, a01, a02, g00 * g22 - g02 * g02, g01 * g02 - g00 * g12, g00 * g11 - g01 * g01)
    return adjugate, g00 * a00 + g01 * a01 + g02 * a02


def _times(matrix: tuple[Floats, ...], q: Triple) -> Triple:
    """Return the product of a symmetric matrix, given by its upper half, and a vector."""
    m00, m01, m02, m11, m12, m22 = matrix
    return dot((m00, m01, m02), q), dot((m01, m11, m12), q), dot((m02, m12, m22), q)


def _residual(pairs: _Pairs, X: Triple, at: Floats) -> tuple[Triple, Triple]:
    """Return r = M (X − C) + λ D X and n = D X."""
    offset, v = [x - c for x, c in zip(X, pairs.centre, strict=True)], pairs.axis
    square, along = dot(v, v), dot(v, offset)
    across = cross(v, cross(offset, v))
    n0, n1, n2 = (D * x for D, x in zip(pairs.D, X, strict=True))
    r0, r1, r2 = (
        (part * pairs.thick + own * along * pairs.long) / square + at * n
        for part, own, n in zip(across, v, (n0, n1, n2), strict=True)
    )
    return (r0, r1, r2), (n0, n1, n2)


def _height(pairs: _Pairs, X: Triple) -> tuple[DoubleDouble, Floats]:
    """Return h(X), and the sum of the magnitudes of its terms."""
    alpha, gamma = pairs.sizes[0], pairs.sizes[1]
    x, y, z = (
        double_double.square(double_double.quotient_of_floats(coordinate, size))
        for coordinate, size in zip(X, (alpha, alpha, gamma), strict=True)
    )
    value = double_double.add_float(double_double.subtract(double_double.add(x, y), z), -1.0)
    return value, x[0] + y[0] + z[0] + 1.0


def _subtracted(first: Floats, second: Floats) -> DoubleDouble:
    """Return the difference of two float64, exactly."""
    zero = np.zeros_like(first)
    return double_double.subtract((first, zero), (second, zero))


def _cross(v: tuple[DoubleDouble, ...], w: tuple[DoubleDouble, ...], k: int) -> DoubleDouble:
    """Return a component of v × w."""
    i, j = (k + 1) % 3, (k + 2) % 3
    return double_double.subtract(double_double.multiply(v[i], w[j]), double_double.multiply(v[j], w[i]))


def _sum_of_squares(numbers: list[DoubleDouble] | tuple[DoubleDouble, ...]) -> DoubleDouble:
    """Return the sum of the squares of numbers."""
    return double_double.sum_of([double_double.square(number) for number in numbers])
