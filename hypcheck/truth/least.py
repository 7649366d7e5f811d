"""The least value: how far the wall and the end discs are from the spheroid's centre, in spheroid radii.

With M the spheroid's matrix let n(X) = √((X − C)ᵀ M (X − C)). The spheroid meets the wall if and only if n ≤ 1
somewhere on it, and 1 + clearance is the least n on the wall, or on the whole border of a solid body. In an end disc n
is least at the rim or, where the ellipse of the spheroid's own height there has its centre in the disc, |z_end − z|
over the half height of the spheroid.

On the wall X(w, θ) = (r cos θ, r sin θ, w), r = α √(1 + w²/γ²), branch and bound. In a cell of half widths h, k about
its middle, by Taylor's formula for n² = q,

    q ≥ q₀ − |q_w| h − |q_θ| k − ½ (K_ww h² + 2 K_wθ h k + K_θθ k²),

K the largest second derivatives in the cell. With m = min(b, d), |V|_M ≤ |V|/m, and N the greatest n in the cell,

    K_ww ≤ 2 (1 + r'²)/m² + 2 N r''/m,   K_wθ ≤ 2 r r'/m² + 2 N r'/m,   K_θθ ≤ 2 r²/m² + 2 N r/m,

where r' ≤ α/γ, r'' ≤ α²/(γ² r) at the least r of the cell, and N ≤ n₀ + (√(1 + r'²) h + r k)/m. Cells whose bound is
above what some point has are dropped, the others halved, so that few are left about each minimum. Each coordinate of
X − C, and of its parts along and across the axis, is within 32u (|X| + |C|), so that n is within 64u (|X| + |C|)/m,
besides 16u of itself; 256u covers both. Where roundings loosen the bound of a cell more than its width does, cells are
looked at in numpy's long double, if it is finer here. No polynomial of the pair and no multiplier is used.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats

_SLACK = 256 * 2.0**-53
_FINE = np.longdouble
_FINE_SLACK = 128 * float(np.finfo(_FINE).eps)
_MOST_CELLS, _ROUNDS = 60_000, 60
_RANGE = (2.0**-200, 2.0**200)
_WIDTH = 2.0**-40


@dataclass(frozen=True, slots=True)
class LeastValue:
    """The least n: `lower` ≤ n ≤ `upper`, and a point (3,) near which it is; (0, inf) where bounds tell nothing."""

    lower: float
    upper: float
    point: tuple[float, float, float]

    @property
    def meets(self) -> bool | None:
        """Whether the closed spheroid reaches that far; None where bounds do not tell."""
        return True if self.upper < 1 else False if self.lower > 1 else None


NOTHING = LeastValue(0.0, math.inf, (math.nan, math.nan, math.nan))


def position(pair: Pair) -> Position | None:
    """The position of a pair, None where bounds do not tell."""
    meets = to_border(pair, side_alone=True).meets
    if meets is None:
        return None
    if meets:
        return Position.CONTACT
    outside = _sign_of_center(pair)
    if outside is None:
        return None
    return Position.INTERIOR if outside < 0 and pair.z_min <= pair.z <= pair.z_max else Position.EXTERIOR


def _sign_of_center(pair: Pair) -> int | None:
    """The sign of the hyperboloid's equation at the centre, None near 0."""
    outward, along = (pair.x / pair.alpha) ** 2 + (pair.y / pair.alpha) ** 2, (pair.z / pair.gamma) ** 2 + 1
    if abs(outward - along) <= _SLACK * (outward + along):
        return None
    return 1 if outward > along else -1


def to_border(pair: Pair, *, side_alone: bool = False, width: float = _WIDTH) -> LeastValue:
    """The least n on the wall and, of a solid, on the discs, to `width` of n²; or until its side of 1 is known."""
    lengths = [abs(number) for number in (*pair.row[:7], pair.z_min, pair.z_max) if number and math.isfinite(number)]
    if not (min(lengths) > _RANGE[0] and max(lengths) < _RANGE[1]):
        return NOTHING
    nearest = _to_wall(pair, side_alone=side_alone, width=width)
    for end in (pair.z_min, pair.z_max) if pair.solid else ():
        disc = _to_disc(pair, end)
        if disc is None:
            return LeastValue(0.0, nearest.upper, nearest.point)
        nearer = disc if disc.upper < nearest.upper else nearest
        nearest = LeastValue(min(nearest.lower, disc.lower), nearer.upper, nearer.point)
    return nearest


def _unit(pair: Pair, number: type[np.floating[Any]] = np.float64) -> Floats:
    """The unit vector of the spheroid's axis."""
    v = np.array(pair.axis, dtype=number) / max(map(abs, pair.axis))
    return np.asarray(v / np.sqrt(v @ v))


def _to_disc(pair: Pair, end: float) -> LeastValue | None:
    """The least n in an end disc, infinite where it is at the rim; None where bounds do not tell which."""
    if not math.isfinite(end):
        return LeastValue(math.inf, math.inf, NOTHING.point)
    v = _unit(pair, _FINE)
    alpha, gamma, b, d, x, y, z = map(_FINE, pair.row[:7])
    b2, d2, height = b * b, d * d, _FINE(end)
    half = b2 * (v[0] * v[0] + v[1] * v[1]) + d2 * v[2] * v[2]
    rise = height - z
    across = (d2 - b2) * v[2] * v[:2] / half * rise + (x, y)
    radius = alpha * np.hypot(1, height / gamma)
    off = np.hypot(*across) - radius
    size = abs(rise) + abs(height) + abs(z)
    loose = _FINE_SLACK * (radius + abs(x) + abs(y) + size * max(b2, d2) / half)
    if off > loose:
        return LeastValue(math.inf, math.inf, NOTHING.point)
    least, error = abs(rise) / np.sqrt(half), _FINE_SLACK * size / np.sqrt(half)
    if off > -loose:
        return None
    return _least(least - error, least + error, (*across, height))


def _least(lower: np.floating[Any], upper: np.floating[Any], point: Iterable[np.floating[Any]]) -> LeastValue:
    """Bounds of any width in float64, rounded outwards."""
    first, second, third = map(float, point)
    return LeastValue(math.nextafter(float(lower), 0), math.nextafter(float(upper), math.inf), (first, second, third))


def _to_wall(pair: Pair, *, side_alone: bool, width: float) -> LeastValue:
    """Branch and bound over the wall, in long double from where the roundings of float64 matter."""
    cells = _first_cells(pair)
    slack = _SLACK
    best, point, lowest = math.inf, np.array(NOTHING.point), 0.0
    for _ in range(_ROUNDS):
        at_most, bound, loose, error, curvatures, X = _bounds(pair, cells, slack)
        place = int(np.argmin(at_most))
        if at_most[place] < best:
            best, point = at_most[place], X[:, place]
        keep = bound <= best
        lowest = max(lowest, bound[keep].min()) if keep.any() else best
        settled = not lowest <= 1 <= best if side_alone else best - lowest <= width * best
        if settled or keep.sum() > _MOST_CELLS:
            break
        nearest = int(np.argmin(bound))
        if error[nearest] > loose[nearest]:
            if slack == _FINE_SLACK or _FINE_SLACK >= _SLACK:
                break
            cells, slack = cells[:, keep].astype(_FINE), _FINE_SLACK
            continue
        cells = _halved(cells[:, keep], *curvatures[:, keep])
    return _least(np.sqrt(lowest) * (1 - slack), np.sqrt(best) * (1 + slack), point)


def _bounds(pair: Pair, cells: Floats, slack: float) -> tuple[Floats, ...]:
    """An upper bound of the least q in each cell, a lower bound, and the points (3, n) of the first.

    Between the two: the term of second order, the error of q₀, and K_ww and K_θθ (2, n).
    """
    w, _, h, k = cells
    number = cells.dtype.type
    alpha, gamma = number(pair.alpha), number(pair.gamma)
    edges = [np.clip(at, number(pair.z_min), number(pair.z_max)) for at in (w - h, w, w + h)]
    values, qw, qt, errors, r, X = _values(pair, np.concatenate(edges), np.tile(cells[1], 3), slack)
    middle = slice(len(w), 2 * len(w))
    q, qw, qt, error, r = values[middle], qw[middle], qt[middle], errors[middle], r[middle]
    lowest = (values + errors).reshape(3, -1).argmin(axis=0) * len(w) + np.arange(len(w))
    m = min(pair.b, pair.d)
    rise = min(alpha / gamma, 2.0**400)
    least_r = alpha * np.hypot(1, np.maximum(np.abs(w) - h, 0) / gamma)
    most_r = r + rise * h
    n = np.sqrt(q + error) + (np.hypot(1, rise) * h + most_r * k) / m
    kww = 2 * (1 + rise * rise) / m**2 + 2 * n * (rise * rise / least_r) / m
    kwt, ktt = 2 * most_r * rise / m**2 + 2 * n * rise / m, 2 * most_r**2 / m**2 + 2 * n * most_r / m
    loose = (kww * h * h + 2 * kwt * h * k + ktt * k * k) / 2 * (1 + slack)
    bound = q - error - (np.abs(qw) * h + np.abs(qt) * k) * (1 + slack) - loose
    return (values + errors)[lowest], bound, loose, error, np.stack([kww, ktt]), X[:, lowest]


def _first_cells(pair: Pair) -> Floats:
    """Cells (4, n) of middles w, θ and half widths that cover the part of the wall that can be nearest."""
    reach = pair.alpha * math.hypot(1, min(max(pair.z, pair.z_min), pair.z_max) / pair.gamma)
    center = math.hypot(pair.x, pair.y)
    level = min(max(pair.z, pair.z_min), pair.z_max)
    # The point of the wall at this level and azimuth is so near; what is farther up or down than that is farther.
    far = (math.hypot(abs(center - reach), level - pair.z) / min(pair.b, pair.d)) * (1 + 1e-9) * max(pair.b, pair.d)
    low, high = max(pair.z_min, pair.z - far), min(pair.z_max, pair.z + far)
    if not low < high:
        low, high = level, level
    edges = np.linspace(low, high, 17)
    w, t = np.meshgrid((edges[:-1] + edges[1:]) / 2, (np.arange(32) + 0.5) / 32 * 2 * math.pi)
    half = (edges[1:] - edges[:-1]).max() / 2 * (1 + 1e-12) + abs(high) * 1e-15
    return np.stack([w.ravel(), t.ravel(), np.full(w.size, half), np.full(w.size, math.pi / 32 * (1 + 1e-12))])


def _values(pair: Pair, w: Floats, t: Floats, slack: float) -> tuple[Floats, ...]:
    """q, its slopes, a bound of the error of q, r, and the points (3, n)."""
    number = w.dtype.type
    alpha, gamma, b, d, *center = map(number, pair.row[:7])
    v = _unit(pair, number)
    r = alpha * np.hypot(1, w / gamma)
    slope = (alpha / gamma) ** 2 * w / r
    cosine, sine = np.cos(t), np.sin(t)
    X = np.stack([r * cosine, r * sine, w])
    D = X - np.array(center)[:, None]
    along = v @ D
    across = D - along * v[:, None]
    q = (across * across).sum(axis=0) / b**2 + (along / d) ** 2
    grad = 2 * (across / b**2 + along / d**2 * v[:, None])
    qw = grad[0] * slope * cosine + grad[1] * slope * sine + grad[2]
    qt = r * (grad[1] * cosine - grad[0] * sine)
    size = np.abs(X) + np.abs([[pair.x], [pair.y], [pair.z]])
    m = min(pair.b, pair.d)
    off = slack * np.sqrt((size * size).sum(axis=0)) / m
    return q, qw, qt, off * (2 * np.sqrt(np.abs(q)) + off), r, X


def _halved(cells: Floats, kww: Floats, ktt: Floats) -> Floats:
    """Each cell cut in two across the direction that loosens its bound most."""
    w, t, h, k = cells
    tall = kww * h * h >= ktt * k * k
    h2, k2 = np.where(tall, h / 2, h), np.where(tall, k, k / 2)
    sides = [np.stack([w + s * np.where(tall, h2, 0), t + s * np.where(tall, 0, k2), h2, k2]) for s in (-1, 1)]
    return np.concatenate(sides, axis=1)
