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
besides 16u of itself; _SLACK covers both. No polynomial of the pair and no multiplier is used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats

_SLACK = 256 * 2.0**-53
_MOST_CELLS, _ROUNDS = 60_000, 60
_RANGE = (2.0**-200, 2.0**200)
_WIDTH = 2.0**-40


@dataclass(frozen=True, slots=True)
class Least:
    """The least n: `lower` ≤ n ≤ `upper`, and a point (3,) near which it is; (0, inf) where bounds tell nothing."""

    lower: float
    upper: float
    point: tuple[float, float, float]

    @property
    def meets(self) -> bool | None:
        """Whether the closed spheroid reaches that far; None where bounds do not tell."""
        return True if self.upper < 1 else False if self.lower > 1 else None


NOTHING = Least(0.0, math.inf, (math.nan, math.nan, math.nan))


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


def to_border(pair: Pair, *, side_alone: bool = False, width: float = _WIDTH) -> Least:
    """The least n on the wall and, of a solid, on the discs, to `width` of n²; or until its side of 1 is known."""
    lengths = [abs(number) for number in (*pair.row[:7], pair.z_min, pair.z_max) if number and math.isfinite(number)]
    if not (min(lengths) > _RANGE[0] and max(lengths) < _RANGE[1]):
        return NOTHING
    v = np.array(pair.axis) / max(map(abs, pair.axis))
    v /= math.sqrt(float(v @ v))
    found = _to_wall(pair, v, side_alone=side_alone, width=width)
    for end in (pair.z_min, pair.z_max) if pair.solid else ():
        disc = _to_disc(pair, v, end)
        if disc is None:
            return Least(0.0, found.upper, found.point)
        nearer = disc if disc.upper < found.upper else found
        found = Least(min(found.lower, disc.lower), nearer.upper, nearer.point)
    return found


def _to_disc(pair: Pair, v: Floats, end: float) -> Least | None:
    """The least n in an end disc, infinite where it is at the rim; None where bounds do not tell which."""
    if not math.isfinite(end):
        return Least(math.inf, math.inf, NOTHING.point)
    b2, d2 = pair.b * pair.b, pair.d * pair.d
    half = b2 * float(v[0] * v[0] + v[1] * v[1]) + d2 * float(v[2] * v[2])
    rise = end - pair.z
    across = (d2 - b2) * v[2] * v[:2] / half * rise + (pair.x, pair.y)
    radius = pair.alpha * math.hypot(1, end / pair.gamma)
    off = float(math.hypot(*across)) - radius
    size = abs(rise) + abs(end) + abs(pair.z)
    loose = _SLACK * (radius + abs(pair.x) + abs(pair.y) + size * max(b2, d2) / half)
    if off > loose:
        return Least(math.inf, math.inf, NOTHING.point)
    least, error = abs(rise) / math.sqrt(half), _SLACK * size / math.sqrt(half)
    if off > -loose:
        return None
    return Least(least - error, least + error, (float(across[0]), float(across[1]), end))


def _to_wall(pair: Pair, v: Floats, *, side_alone: bool, width: float) -> Least:
    """Branch and bound over the wall."""
    cells = _first_cells(pair)
    m = min(pair.b, pair.d)
    best, point, lowest = math.inf, NOTHING.point, math.inf
    for _ in range(_ROUNDS):
        w, t, h, k = cells
        q, qw, qt, error, r, X = _values(pair, v, w, t)
        place = int(np.argmin(q + error))
        if q[place] + error[place] < best:
            best, point = float(q[place] + error[place]), tuple(X[:, place].tolist())
        rise = min(pair.alpha / pair.gamma, 2.0**400)
        least_r = pair.alpha * np.hypot(1, np.maximum(np.abs(w) - h, 0) / pair.gamma)
        most_r = r + rise * h
        n = np.sqrt(q + error) + (math.hypot(1, rise) * h + most_r * k) / m
        kww = 2 * (1 + rise * rise) / m**2 + 2 * n * (rise * rise / least_r) / m
        kwt, ktt = 2 * most_r * rise / m**2 + 2 * n * rise / m, 2 * most_r**2 / m**2 + 2 * n * most_r / m
        bound = q - error - np.abs(qw) * h - np.abs(qt) * k - (kww * h * h + 2 * kwt * h * k + ktt * k * k) / 2
        bound -= _SLACK * (np.abs(qw) * h + np.abs(qt) * k)
        keep = bound <= best
        lowest = max(0.0, float(bound[keep].min())) if keep.any() else best
        if best - lowest <= width * best or keep.sum() > _MOST_CELLS or (side_alone and not lowest <= 1 <= best):
            break
        cells = _halved(cells[:, keep], kww[keep], ktt[keep])
    return Least(math.sqrt(lowest) * (1 - _SLACK), math.sqrt(best) * (1 + _SLACK), point)


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


def _values(pair: Pair, v: Floats, w: Floats, t: Floats) -> tuple[Floats, ...]:
    """q, its slopes, a bound of the error of q, r, and the points (3, n)."""
    r = pair.alpha * np.hypot(1, w / pair.gamma)
    slope = (pair.alpha / pair.gamma) ** 2 * w / r
    cosine, sine = np.cos(t), np.sin(t)
    X = np.stack([r * cosine, r * sine, w])
    D = X - np.array([[pair.x], [pair.y], [pair.z]])
    along = v @ D
    across = D - along * v[:, None]
    q = (across * across).sum(axis=0) / pair.b**2 + (along / pair.d) ** 2
    grad = 2 * (across / pair.b**2 + along / pair.d**2 * v[:, None])
    qw = grad[0] * slope * cosine + grad[1] * slope * sine + grad[2]
    qt = r * (grad[1] * cosine - grad[0] * sine)
    size = np.abs(X) + np.abs([[pair.x], [pair.y], [pair.z]])
    m = min(pair.b, pair.d)
    off = _SLACK * np.sqrt((size * size).sum(axis=0)) / m
    return q, qw, qt, off * (2 * np.sqrt(np.abs(q)) + off), r, X


def _halved(cells: Floats, kww: Floats, ktt: Floats) -> Floats:
    """Each cell cut in two across the direction that loosens its bound most."""
    w, t, h, k = cells
    tall = kww * h * h >= ktt * k * k
    h2, k2 = np.where(tall, h / 2, h), np.where(tall, k, k / 2)
    sides = [np.stack([w + s * np.where(tall, h2, 0), t + s * np.where(tall, 0, k2), h2, k2]) for s in (-1, 1)]
    return np.concatenate(sides, axis=1)
