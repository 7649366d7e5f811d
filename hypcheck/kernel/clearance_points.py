"""The point where an enlarged spheroid first touches, and the shortest gap, in floats. Only `error` is proved.

**Upright touches.** In lengths scaled by b and d, with p = a r, q = c z and W = A + B (docs/mathematics.md), τ = A + λ
and σ = B − λ at the dual's maximum satisfy τ/p = σ/√(σ² + q²). The left side less the right one is convex and increases
with λ, and is linear except for where σ ~ q: Newton's method needs few turns from any start.

Their error. Let the smaller of τ and σ be exact: that says what λ is. The other is W less it, at least W/2 and within
12u (u = 2⁻⁵²), so that ρ = A r/τ and ζ = B z/σ are within 16u. For every X on the hyperboloid, the exact place X* too,
|X − C|² − D(λ) = (X₁ − ρ)² τ/A + (X₂ − ζ)² σ/B. At X* it is the least, so any other X bounds it by some Γ: those of the
height ζ and of the radius ρ. Hence |ρ* − ρ| ≤ √(Γ A/τ) and |ζ* − ζ| ≤ √(Γ B/σ), and as X* is on the hyperboloid
the other coordinate follows: A ζ/(B ρ) is its slope, and ζ*² = B (ρ*²/A − 1). In C the
roundings are 38 for 16, as quotients are shared. _ROUNDED = 64u holds each coordinate.

**Tilted touches.** The multiplier is that of the kernel's second stage (numpy_kernel.py), the point X solves a linear
system; next to a pole, where that is singular, as about the hyperboloid's axis, _at_a_pole finds it. With G = M + λD ≥
μ, r = G X − M C and n = D X there is a point of the hyperboloid within |h|/|n| of X where |h| max|D| < |n|² (h changes
its sign on the way along n), and X − G⁻¹r is where |X − C|² + λ h is least. So the exact place is within |r|/μ + √(tr
G/μ) (|h|/|n| + |r|/μ). Elimination shows μ: where G − shift has positive pivots in floats, μ ≥ shift − 8·_ROUNDED·(the
terms of G). The terms of r and of h take fewer than 16 roundings each.

Both hold for lengths in 2^±100, coordinates that may be smaller, and b/d in 2^±20; elsewhere `error` is inf.

**The gap.** In the meridian plane of the centre the tangent of the hyperbola at the height ζ has the slope
s = αζ/(γ√(γ² + ζ²)), and the spheroid's parallel tangent is at the distance

    G = (c (r − s z − w) − v)/n,   w = α²/ρ, ρ the radius at ζ,   v² = b² + d² s²,   n² = 1 + s²,

c = 1 outside and −1 inside. The least G outside, and the greatest inside, is the distance of the bodies: outside the
hyperboloid a meridian plane is convex, and inside it the far side is. G' = 0 says ζ − z = c s (d²/v + G/n).

**The unit normal.** Where p is nearest to a spheroid, the nearest point s of the spheroid is p's foot on it, and the
gradient of the distance with respect to the centre is the unit vector from p to s: the spheroid's inward normal at s.
It is found without the difference of p and s, which cancels near contact. With p at (u, w) across and along the axis
from the centre, s is (b² u/(b² + t), d² w/(d² + t)) for the t ≥ 0 at which it lies on the spheroid, and its normal
(u/(b² + t), w/(d² + t)). That equation is convex and decreasing in t: Newton's method from below finds it without fail.

**Ties.** Other points are as near where a symmetry of both bodies moves p. Symmetries are mirrors at z = 0 and at the
vertical plane through the centre, or through the axis, and turns about z by any angle, or by half of one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import PAIRS, Floats, Mask, Positions, Rows, parts_of, with_heights
from hypcheck.kernel import numpy_kernel

TURNS = 12
GAP_TURNS = 12
_SETTLED = 2.0**-18
_TOUCH_SETTLED = 2.0**-26
POLISHED = 2

_ROUNDED = 2.0**-46
_MORE = 1 + 2.0**-30
_LEAST_SHARE = 2.0**-70
"""The least share of σ: a σ of 0 would not determine the height, where two nearest points nearly coincide."""

_OFF = 2.0**-20
"""A mirror moves a point that is farther from it than this, in units of the greatest coordinate."""

_POLE_HALVINGS = 100
_LARGEST = 2.0**200
"""The largest of the numbers next to a pole, so that their squares do not overflow."""

_RANGE = (2.0**-100, 2.0**100)
_RATIO = 20

_LEAST = 2.0**-500
"""Takes the place of 0 where Newton's method divides."""

CONSTANTS = {
    "rounded": _ROUNDED,
    "tiny": _LEAST,
    "least_tau": 2.0**-1000,
    "least_share": _LEAST_SHARE,
    "touch_settled": _TOUCH_SETTLED,
    "gap_settled": _SETTLED,
    "least_offset": 2.0**-1000,
}
"""The constants that the same steps in C read (core/parts/near_level.h)."""


@dataclass(frozen=True, slots=True)
class Touches:
    """Approximately where the grown spheroid first touches: the factor of its size (n,), the point (n, 3).

    The exact point is not farther than `error` away, (n,); inf where that is not known.
    """

    factor: Floats
    point: Floats
    error: Floats


@dataclass(frozen=True, slots=True)
class PointGaps:
    """Approximately the shortest gap: its length, `support`, half the spheroid's width along it, (n,), and its ends.

    `there` (n, 3) is on the hyperboloid, `here` (n, 3) on the spheroid.
    """

    length: Floats
    support: Floats
    there: Floats
    here: Floats


def poles(A: Floats, B: Floats, p: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Return τ and σ, by Newton's method from λ = 0."""
    W = A + B
    p, q = np.maximum(p, _LEAST), np.maximum(q, _LEAST)
    tau, sigma = A.copy(), B.copy()
    slope = 1 / p
    for _ in range(TURNS):
        cone = np.sqrt(sigma * sigma + q * q)
        step = (sigma / cone - tau * slope) / (slope + (q / cone) ** 2 / cone)
        tau = np.minimum(tau + step, W)
        sigma = np.maximum(sigma - step, 0)
        if (np.abs(step) <= _TOUCH_SETTLED * np.minimum(tau, sigma)).all():
            break
    return np.maximum(tau, 2.0**-1000), np.maximum(sigma, _LEAST_SHARE * W)


Poles = Callable[[Floats, Floats, Floats, Floats], tuple[Floats, Floats]]
"""A function that finds τ and σ from A, B, a r and c h."""


def upright_touches(rows: Rows, *, poles_of: Poles = poles, rounding: float = _ROUNDED) -> Touches:
    """Return the touches of valid rows (n, 7).

    Their error holds for any τ and σ that `poles_of` finds, if what is computed is off by less than `rounding` of it.
    """
    alpha, gamma, b, d, x, y, z = np.ascontiguousarray(rows.T)
    a, c, r, h = alpha / b, gamma / d, np.hypot(x, y) / b, np.abs(z) / d
    A, B = a * a, c * c
    tau, sigma = poles_of(A, B, a * r, c * h)
    lesser = tau < sigma
    tau, sigma = np.where(lesser, tau, A + B - sigma), np.where(lesser, A + B - tau, sigma)
    radius, height = A * r / tau, B * h / sigma
    low, high = a * np.sqrt(1 + (height / c) ** 2), c * np.sqrt(np.maximum((radius / a) ** 2 - 1, 0))
    rounded = rounding * B * (radius / a) ** 2 / high
    by_low = (np.abs(low - radius) + rounding * (low + radius)) ** 2 * (tau / A)
    by_high = (np.abs(high - height) + rounding * (high + height) + rounded) ** 2 * (sigma / B)
    least = np.fmin(by_low, by_high)
    across, up = np.sqrt(least * (A / tau)), np.sqrt(least * (B / sigma))
    off_low = d * up + b * (A * (height + up) / (B * low)) * up
    off_high = b * across + d * ((B / A) * (2 * radius + across) * across / high + rounded)
    other = off_high < off_low
    radius, height = np.where(other, radius, low), np.where(other, high, height)
    point = _placed(rows, radius * b, height * d)
    error = _MORE * (np.fmin(off_low, off_high) + rounding * np.abs(point).sum(axis=1))
    return Touches(np.hypot(radius - r, height - h), point, _known(rows, error))


def _known(rows: Rows, error: Floats) -> Floats:
    """Return the errors where their bounds hold, else inf."""
    size = np.abs(rows[:, :7])
    usual = (size <= _RANGE[1]).all(axis=1) & (size[:, :4] >= _RANGE[0]).all(axis=1)
    usual &= np.abs(np.log2(rows[:, 2] / rows[:, 3])) <= _RATIO
    return np.where(usual & (error >= 0), error, np.inf)


def _placed(rows: Rows, radius: Floats, height: Floats) -> Floats:
    """Return the points (n, 3) with these radii in each centre's meridian plane; heights count towards the centre."""
    x, y, z = rows[:, 4], rows[:, 5], rows[:, 6]
    scale = np.maximum(np.abs(x), np.abs(y))  # the direction of subnormal numbers is exact so
    off = scale > 0
    cos, sin = (np.divide(part, scale, out=np.full_like(part, axis), where=off) for part, axis in ((x, 1.0), (y, 0.0)))
    length = np.sqrt(cos * cos + sin * sin)
    cos, sin = cos / length, sin / length
    return np.stack([radius * cos, radius * sin, np.where(z < 0, -height, height)], axis=1)


def upright_gaps(rows: Rows, position: Positions, touch: Floats) -> PointGaps:
    """Return hints for valid rows (n, 7) that are clear, from the places where they first touch, (n, 3)."""
    alpha, gamma, b, d, x, y, z = np.ascontiguousarray(rows.T)
    r, level, side = np.hypot(x, y), np.abs(z), position.astype(np.float64)
    height = np.abs(touch[:, 2])
    lowest, highest = np.zeros_like(height), np.where(side > 0, np.inf, level)
    settled = False
    for turn in range(GAP_TURNS + 1):
        share = height / gamma
        cone = np.sqrt(1 + share * share)
        slope = alpha / gamma * (share / cone)
        v, n = np.sqrt(b * b + (d * slope) ** 2), np.sqrt(1 + slope * slope)
        gap = (side * (r - slope * level - alpha / cone) - v) / n
        if settled or turn == GAP_TURNS:
            break
        off = height - level - side * slope * (d * d / v + gap / n)
        lowest, highest = np.where(off > 0, lowest, height), np.where(off > 0, height, highest)
        bend = 1 - side * alpha / (gamma * gamma * cone**3) * ((b * d) ** 2 / v**3 + gap / n**3)
        moved = height - off / bend
        settled = bool((np.abs(moved - height) <= _SETTLED * height).all())
        inside = (moved >= lowest) & (moved <= highest) & (bend > 0)
        height = np.where(inside, moved, np.minimum((lowest + highest) / 2, 2 * height + level))
    there = _placed(rows, alpha * cone, share * gamma)
    here = _placed(rows, r - side * b * (b / v), level + side * slope * (d * d / v))
    return PointGaps(gap, v / n, there, here)


def tilted_touches(rows: Rows, at: Floats | None = None) -> Touches:
    """Return the touches of valid rows (n, 10) whose axis is tilted.

    Their error holds for any multipliers λ (n,) that are given as `at`; else they are found here.
    """
    alpha, gamma, b, d = np.ascontiguousarray(rows[:, :4].T)
    unit, centre = unit_vectors(rows[:, 7:]), rows[:, 4:7] / b[:, None]
    stretch = (b / d) ** 2 - 1
    turns = POLISHED if at is None else 0
    if at is None:
        at = np.concatenate([numpy_kernel.multipliers(rows[k : k + _CHUNK]) for k in range(0, len(rows), _CHUNK)])
    form = np.stack([(b / alpha) ** 2, (b / alpha) ** 2, -((b / gamma) ** 2)], axis=1)
    outer = stretch[:, None, None] * (unit[:, :, None] * unit[:, None, :])
    own = centre + (stretch * (unit * centre).sum(axis=1))[:, None] * unit
    for turn in range(turns + 1):
        matrix = np.eye(3) * (1 + at[:, None, None] * form[:, None, :]) + outer
        adjugate, determinant = _adjugate(matrix)
        place = (adjugate * own[:, :, None]).sum(axis=1) / determinant[:, None]
        if turn == turns:
            break
        normal = form * place
        bend = ((adjugate * normal[:, :, None]).sum(axis=1) * normal).sum(axis=1) / determinant
        step = ((normal * place).sum(axis=1) - 1) / (2 * bend)
        at = np.where(np.abs(step) < 2.0**-10 * np.abs(at), at + step, at)
    squares = form * place * place
    lost = np.flatnonzero(~(np.abs(squares.sum(axis=1) - 1) <= _OFF * (1 + np.abs(squares).sum(axis=1))))
    if turns and len(lost):
        others = _at_a_pole(form[lost], unit[lost], (b / d)[lost], centre[lost])
        place[lost] = np.where(np.isfinite(others).all(axis=1, keepdims=True), others, place[lost])
    error = _error(rows, unit, at, form, place, matrix, determinant / np.trace(adjugate, axis1=1, axis2=2))
    x, y, z = (place * b[:, None]).T
    radius = np.hypot(x, y)
    low = alpha * np.sqrt(1 + (z / gamma) ** 2) / radius
    high = np.copysign(gamma * np.sqrt(np.maximum((radius / alpha) ** 2 - 1, 0)), z)
    points = np.stack([x * low, y * low, z], axis=1), np.stack([x, y, high], axis=1)
    by_low, by_high = (_factor(rows, unit, point) for point in points)
    other = (by_high < by_low) & (radius >= alpha)
    point = np.where(other[:, None], points[1], points[0])
    moved = np.sqrt(((point - place * b[:, None]) ** 2).sum(axis=1)) + _ROUNDED * np.abs(point).sum(axis=1)
    return Touches(np.where(other, by_high, by_low), point, _known(rows, _MORE * (b * error + moved)))


def _at_a_pole(form: Floats, unit: Floats, ratio: Floats, centre: Floats) -> Floats:
    """Return the points, (n, 3), of XᵀDX = 1 with the least |X − C|², if the multiplier is at a pole or next to it.

    In the principal axes of D beside the spheroid, whose eigenvalues are e, X is g/(1 + λe) there. At the pole λ = −1/e
    one g is 0, as where the centre is on the hyperboloid's axis: then XᵀDX = 1 says how long that part of X is, and
    both signs are right. The multiplier is halved to between the poles; only its share at each pole matters.
    """
    stretch = unit[:, :, None] * unit[:, None, :]
    inward = np.eye(3) + (1 / ratio - 1)[:, None, None] * stretch
    outward = np.eye(3) + (ratio - 1)[:, None, None] * stretch
    matrix = inward @ (form[:, :, None] * inward)
    known = np.abs(np.concatenate([matrix.reshape(-1, 9), outward.reshape(-1, 9), centre], axis=1))
    usable: Mask = np.asarray((known <= _LARGEST).all(axis=1))
    matrix = np.where(usable[:, None, None], (matrix + matrix.transpose(0, 2, 1)) / 2, np.eye(3) * (1.0, 1.0, -1.0))
    values, vectors = np.linalg.eigh(matrix)
    across = np.swapaxes(vectors, 1, 2)
    own = (across @ (outward @ centre[:, :, None]))[:, :, 0]
    below, above = -1 / values[:, 2], -1 / values[:, 0]
    for _ in range(_POLE_HALVINGS):
        middle = (below + above) / 2
        parts = own / (1 + middle[:, None] * values)
        outside = (values * parts * parts).sum(axis=1) > 1
        below, above = np.where(outside, middle, below), np.where(outside, above, middle)
    shares = np.abs(1 + below[:, None] * values)
    chosen = np.arange(len(values)), np.argmin(shares, axis=1)
    parts = np.where(own == 0, 0.0, own / (1 + below[:, None] * values))
    parts[chosen] = 0
    rest = (1 - (values * parts * parts).sum(axis=1)) / values[chosen]
    parts[chosen] = np.copysign(np.sqrt(np.maximum(rest, 0)), own[chosen])
    mirrored = parts.copy()
    mirrored[chosen] *= -1
    here, there = ((inward @ vectors @ some[:, :, None])[:, :, 0] for some in (parts, mirrored))
    tied = np.abs(own[chosen]) <= _ROUNDED * (1 + np.abs(own).sum(axis=1))
    return np.where(usable[:, None], np.where((tied & _is_before(there, here))[:, None], there, here), np.nan)


def _is_before(place: Floats, other: Floats) -> Mask:
    """Return a mask of the places that are farther towards +x (if equal: +z, then +y) than the other ones."""
    offset = (place - other)[:, (0, 2, 1)]
    clear = np.abs(offset) > _OFF * np.abs(place).max(axis=1, keepdims=True)
    return np.asarray(clear.any(axis=1) & (offset[np.arange(len(offset)), np.argmax(clear, axis=1)] > 0))


def _error(rows: Rows, unit: Floats, at: Floats, form: Floats, place: Floats, matrix: Floats, least: Floats) -> Floats:
    """Return a bound of the distance from a computed place to the exact one, in units of b; NaN if no bound is known.

    `least` is a guess of half the least eigenvalue of the matrix M + λD.
    """
    stretch, size = (rows[:, 2] / rows[:, 3]) ** 2 + 2, np.abs(at)
    centre = rows[:, 4:7] / rows[:, 2:3]
    offset, normal = place - centre, form * place
    left = offset + ((stretch - 3) * (unit * offset).sum(axis=1))[:, None] * unit + at[:, None] * normal
    terms = stretch * (np.abs(place).sum(axis=1) + np.abs(centre).sum(axis=1)) + size * np.abs(normal).sum(axis=1)
    off = np.sqrt((left * left).sum(axis=1)) + _ROUNDED * terms
    squares = form * place * place
    height = np.abs(squares.sum(axis=1) - 1) + _ROUNDED * (1 + np.abs(squares).sum(axis=1))
    length = np.sqrt((normal * normal).sum(axis=1)) * (1 - _ROUNDED)
    whole = 3 * stretch + size * np.abs(form).sum(axis=1)
    shift = least / 2
    mu = np.where(_has_positive_pivots(matrix - shift[:, None, None] * np.eye(3)), shift - 8 * _ROUNDED * whole, np.nan)
    beside = height / length
    holds = (mu > 0) & (_MORE * beside * np.abs(form).max(axis=1) < length)
    return np.where(holds, off / mu + np.sqrt(whole / mu) * (beside + off / mu), np.nan)


def _has_positive_pivots(matrix: Floats) -> Mask:
    """Whether elimination finds three positive pivots in each symmetric matrix (n, 3, 3)."""
    first = matrix[:, 0, 0]
    p, q = matrix[:, 0, 1] / first, matrix[:, 0, 2] / first
    second = matrix[:, 1, 1] - p * matrix[:, 0, 1]
    off = matrix[:, 1, 2] - p * matrix[:, 0, 2]
    third = matrix[:, 2, 2] - q * matrix[:, 0, 2] - off / second * off
    return np.asarray((first > 0) & (second > 0) & (third > 0))


_CHUNK = 2048


def _adjugate(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the adjugates of symmetric matrices (n, 3, 3), row by row, and the determinants (n,)."""
    rows = np.moveaxis(matrix, 1, 0)
    adjugate = np.stack([np.cross(rows[(k + 1) % 3], rows[(k + 2) % 3]) for k in range(3)], axis=1)
    return adjugate, (rows[0] * adjugate[:, 0]).sum(axis=1)


def _factor(rows: Rows, unit: Floats, point: Floats) -> Floats:
    """Return the factor by which the spheroid must grow to reach the point."""
    offset = point - rows[:, 4:7]
    along = (unit * offset).sum(axis=1)
    across = offset - along[:, None] * unit
    return np.asarray(np.sqrt((across * across).sum(axis=1) / rows[:, 2] ** 2 + (along / rows[:, 3]) ** 2))


def reaching(b: Floats, d: Floats, v: Floats, length: Floats) -> tuple[Floats, Floats]:
    """Return semi-axes, (n,) each, of spheroids that contain all points within a length of those of semi-axes b and d.

    They are no larger than necessary in the directions in which the given ones are `v` wide: clearance_bounds.py proves
    it, but for roundings.
    """
    wide, tall = (np.sqrt((v + length) * (size * size / v + length)) for size in (b, d))
    return wide, tall


def tilted_gaps(rows: Rows, position: Positions, touch: Floats) -> PointGaps:
    """Return hints for valid rows (n, 10) that are clear, from the places where they first touch, (n, 3).

    A spheroid that contains all points within some length of the given one, and no more of them in the direction of the
    gap, first touches where the gap is.
    """
    unit, grown = unit_vectors(rows[:, 7:]), rows.copy()
    b, d = rows[:, 2], rows[:, 3]
    for turn in range(GAP_TURNS):
        normal = touch / np.stack([rows[:, 0], rows[:, 0], rows[:, 1]], axis=1) ** 2 * (1.0, 1.0, -1.0)
        normal *= -position[:, None] / np.sqrt((normal * normal).sum(axis=1, keepdims=True))
        along = (normal * unit).sum(axis=1)
        half = (b * b)[:, None] * normal + ((d * d - b * b) * along)[:, None] * unit
        v = np.sqrt((half * normal).sum(axis=1))
        here = rows[:, 4:7] + half / v[:, None]
        gap = ((touch - here) * normal).sum(axis=1)
        if turn < GAP_TURNS - 1:
            grown[:, 2], grown[:, 3] = reaching(b, d, v, gap)
            touch = tilted_touches(grown).point  # its error is made in vain, for short arrays
    return PointGaps(gap, v, touch, here)


_TURNS, _FOOT_SETTLED = 100, 2.0**-50


def normals(rows: Rows, nearest: Rows, position: Positions) -> Rows:
    """Return unit vectors (n, 3) from nearest points to the spheroids of rows of any width; NaN in contact."""
    with np.errstate(all="ignore"):
        axis = unit_vectors(with_heights(rows)[:, 7:10])
        size = rows[:, 2:4].max(axis=1)
        offset = (nearest - rows[:, 4:7]) / size[:, None]
        b2, d2 = (rows[:, 2:4] / size[:, None]).T ** 2
        w = (offset * axis).sum(axis=1)
        across = offset - w[:, None] * axis
        u = np.sqrt((across * across).sum(axis=1))
        t = _foot(b2, d2, u, np.abs(w))
        normal = 0.0 - unit_vectors(across / (b2 + t)[:, None] + axis * (w / (d2 + t))[:, None])
    normal[(position == 0) | (position == REFUSED)] = np.nan
    return normal


def _foot(b2: Floats, d2: Floats, u: Floats, w: Floats) -> Floats:
    """Return the t of points (u, w) outside spheroids of these squared semi-axes, to about 2⁻⁴⁸ of themselves."""
    t = np.maximum(np.maximum(np.sqrt(b2) * u - b2, np.sqrt(d2) * w - d2), 0)
    for _ in range(_TURNS):
        p, q = b2 + t, d2 + t
        first, second = b2 * (u / p) ** 2, d2 * (w / q) ** 2
        step = np.fmax((first + second - 1) / (2 * (first / p + second / q)), 0)
        t = t + step
        if not (step > _FOOT_SETTLED * (t + b2 + d2)).any():
            break
    return np.asarray(t)


def unit_vectors(vectors: Rows) -> Rows:
    """Return vectors (n, 3), of any lengths, divided by their lengths."""
    scaled = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    return np.asarray(scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True)))


def ties(rows: Rows, nearest: Rows, position: Positions) -> Mask:
    """Whether a symmetry of both bodies, which floats see, moves the nearest point; False in contact, (n,)."""
    _, axis, heights = parts_of(with_heights(rows), PAIRS)
    x, y, z = rows[:, 4:7].T
    ax, ay, az = axis.T
    sphere = rows[:, 2] == rows[:, 3]
    vertical, horizontal = sphere | ((ax == 0) & (ay == 0)), sphere | (az == 0)
    centred, level = (x == 0) & (y == 0), (z == 0) & (heights[:, 0] == -heights[:, 1])
    with np.errstate(all="ignore"):
        scale = _OFF * np.abs(np.hstack([nearest, rows[:, 4:7]])).max(axis=1)
        mirror = np.where(centred[:, None], axis[:, :2], rows[:, 4:6])
        mirror = mirror / np.hypot(mirror[:, 0], mirror[:, 1])[:, None]
        beside = np.abs(mirror[:, 0] * nearest[:, 1] - mirror[:, 1] * nearest[:, 0]) > scale
        upright_plane = vertical | (x * ay == y * ax) | ((az == 0) & (x * ax + y * ay == 0))
        off_level = np.abs(nearest[:, 2]) > scale
        off_axis = np.hypot(nearest[:, 0], nearest[:, 1]) > scale
    tied = level & (vertical | horizontal) & off_level
    tied |= upright_plane & beside
    tied |= centred & (vertical | horizontal) & off_axis
    tied |= centred & level
    return np.asarray(tied & (position != 0) & (position != REFUSED))
