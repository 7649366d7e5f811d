"""The least value: the distance of the wall and the end discs from the spheroid's centre, in spheroid radii.

With M the spheroid's matrix let n(X) = √((X − C)ᵀ M (X − C)). The spheroid meets the wall if and only if n ≤ 1
somewhere on it, and 1 + clearance is the least n on the wall, or on the whole border of a solid body. In an end disc n
is least at the rim or, where the ellipse of the spheroid's own height there has its centre in the disc, |z_end − z|
over the half height of the spheroid: rational numbers of the row, compared exactly.

On the wall X(w, θ) = (r cos θ, r sin θ, w), r = α √(1 + w²/γ²), branch and bound. A cell holds angles within k of θ₀
and heights from `below` to `above`, cut off at the ends, beyond which there is no wall. w₀ is the height in the middle
or, if a cell reaches an end, that end; all heights are within h of it. By Taylor's formula at (w₀, θ₀), for n² = q,

    q ≥ q₀ + min(q_w (below − w₀), q_w (above − w₀)) − |q_θ| k − ½ (K_ww h² + 2 K_wθ h k + K_θθ k²),

since a linear function of the height is least at one of its ends; K are the largest second derivatives in the cell.
Where q falls towards a rim with a slope, it falls as far as there and no farther. With m = min(b, d), |V|_M ≤ |V|/m,
and N the greatest n in the cell,

    K_ww ≤ 2 (1 + r'²)/m² + 2 N r''/m,   K_wθ ≤ 2 r r'/m² + 2 N r'/m,   K_θθ ≤ 2 r²/m² + 2 N r/m,

where r' ≤ α/γ, r'' ≤ α²/(γ² r) at the least r of the cell, and N ≤ n₀ + e, e = (√(1 + r'²) h + r k)/m. Cells whose
bound is above the value at some point are dropped and the others are cut, so that few cells are left around each
minimum.

Roundings; u = 2⁻⁵³. Each coordinate of X − C, and of its parts along and across the axis, is within 32u S,
S = |X| + |C|, so that n is within 64u S/m, besides 16u of itself. The slopes are within 128u S/m² in any direction, so
that they are off by 128u (S/m) e in a cell. If e ≤ 2n, that is no more than q is off by where n is off by 128u S/m; if
e > 2n, the term of second order alone, e²/2 or more, is above q, so that the bound is below 0 and says nothing. n is
said to be within 256u S/m, which covers both. Cells overlap by more than the roundings of their middles. n² − 1 is
looked at, whose sign decides, with 256u for the subtraction.

If these roundings loosen the bound of a cell more than its width does, and few cells are left, they are evaluated in
double-double: u is 2⁻¹⁰² then, and θ is the angle of the point (cos θ, sin θ) as float64 has it, drawn to the unit
circle, which cells overlap by, too. Slopes stay in float64 there, of an X − C that is rounded last, so that they are
within 128u |X − C|/m², u = 2⁻⁵³: what they are off by is small with the cell. Where no length is much larger than m,
10⁻²⁰ radii between the spheroid and contact are seen. An exact touch stays undecided: the bound is below 1 and the
value at a point is above. No polynomial of the pair and no multiplier is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from hypcheck.geometry.arithmetic import rounded_toward
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats
from hypcheck.truth import double_double
from hypcheck.truth.double_double import DoubleDouble

_SLACK = 256 * 2.0**-53
_FINE_SLACK = 256 * double_double.ERROR
_OVERLAP = 2.0**-49
"""How far cells overlap. Roundings of a middle angle up to 2π, and of its cosine and sine, are less than half of it."""
_MOST_CELLS, _MOST_FINE_CELLS, _ROUNDS = 60_000, 20_000, 60
_ALIKE = 4
"""A cell is cut across height and angle if neither loosens the bound more than this factor times the other."""
_RANGE = (2.0**-200, 2.0**200)
_WIDTH = 2.0**-40


@dataclass(frozen=True, slots=True)
class LeastValue:
    """The least n: `below` ≤ n² − 1 ≤ `above`, and a point (3,) near the minimum; −1 and inf if there are no bounds."""

    below: float
    above: float
    point: tuple[float, float, float]

    @property
    def lower(self) -> float:
        """A lower bound of n."""
        return math.sqrt(max(0.0, 1 + self.below)) * (1 - 2.0**-51)

    @property
    def upper(self) -> float:
        """An upper bound of n."""
        return math.sqrt(max(0.0, 1 + self.above)) * (1 + 2.0**-51)

    @property
    def meets(self) -> bool | None:
        """Whether the closed spheroid meets the border (n ≤ 1); None if the bounds do not decide."""
        return True if self.above < 0 else False if self.below > 0 else None


_NOWHERE = (math.nan, math.nan, math.nan)
NOTHING = LeastValue(-1.0, math.inf, _NOWHERE)
_ELSEWHERE = LeastValue(math.inf, math.inf, _NOWHERE)


def position(pair: Pair) -> Position | None:
    """Return the position of a pair; None if the bounds do not decide."""
    meets = to_border(pair, side_alone=True).meets
    if meets is None:
        return None
    if meets:
        return Position.CONTACT
    inside = _is_within(pair.alpha, pair.gamma, Fraction(pair.x), Fraction(pair.y), Fraction(pair.z))
    return Position.INTERIOR if inside and pair.z_min <= pair.z <= pair.z_max else Position.EXTERIOR


def _is_within(alpha: float, gamma: float, x: Fraction, y: Fraction, w: Fraction) -> bool:
    """Decide exactly whether the point (x, y, w) lies inside the hyperboloid without ends, or on it."""
    return (x * x + y * y) * Fraction(gamma) ** 2 <= Fraction(alpha) ** 2 * (Fraction(gamma) ** 2 + w * w)


@np.errstate(over="ignore", invalid="ignore")  # an overflow gives no bound: _bounds
def to_border(pair: Pair, *, side_alone: bool = False, width: float = _WIDTH) -> LeastValue:
    """Enclose the least n on the wall and, for a solid, on the discs, within `width` of n².

    With `side_alone`, only until it is known whether n is above 1.
    """
    lengths = [abs(number) for number in (*pair.row[:7], pair.z_min, pair.z_max) if number and math.isfinite(number)]
    if not (min(lengths) > _RANGE[0] and max(lengths) < _RANGE[1]):
        return NOTHING
    nearest = _to_wall(pair, side_alone=side_alone, width=width)
    for end in (pair.z_min, pair.z_max) if pair.solid else ():
        disc = _to_disc(pair, end)
        nearer = disc if disc.above < nearest.above else nearest
        nearest = LeastValue(min(nearest.below, disc.below), nearer.above, nearer.point)
    return nearest


def _to_disc(pair: Pair, end: float) -> LeastValue:
    """Enclose the least n in an end disc; infinite if it is at the rim, which the wall includes."""
    if not math.isfinite(end):
        return _ELSEWHERE
    b2, d2, x, y, height = (Fraction(number) for number in (pair.b, pair.d, pair.x, pair.y, end))
    v = [Fraction(part) for part in pair.axis]
    b2, d2, rise = b2 * b2, d2 * d2, height - Fraction(pair.z)
    half = b2 * (v[0] * v[0] + v[1] * v[1]) + d2 * v[2] * v[2]
    turn = (d2 - b2) * v[2] / half * rise
    x, y = x + turn * v[0], y + turn * v[1]
    if not _is_within(pair.alpha, pair.gamma, x, y, height):
        return _ELSEWHERE
    least = rise * rise * sum(part * part for part in v) / half - 1
    return LeastValue(
        rounded_toward(least, -math.inf), rounded_toward(least, math.inf), (float(x), float(y), float(end))
    )


def _to_wall(pair: Pair, *, side_alone: bool, width: float) -> LeastValue:
    """Enclose the least n on the wall by branch and bound, in double-double once roundings of float64 matter."""
    cells, at, most = _first_cells(pair), _at, _MOST_CELLS
    above, point, below = math.inf, _NOWHERE, -1.0
    for _ in range(_ROUNDS):
        bounds = _bounds(pair, cells, at)
        place = int(np.argmin(bounds.above))
        if bounds.above[place] < above:
            above, point = float(bounds.above[place]), tuple(bounds.X[:, place].tolist())
        keep = bounds.below <= above
        below = max(below, float(bounds.below[keep].min()))
        settled = not below <= 0 <= above if side_alone else above - below <= width * (1 + above)
        if settled or keep.sum() > most:
            break
        nearest = int(np.argmin(bounds.below))
        cells = cells[:, keep]
        if bounds.error[nearest] <= bounds.loose[nearest]:
            cells = _cut(cells, bounds.shares[:, keep])
        elif at is _at and keep.sum() <= _MOST_FINE_CELLS:
            at, most = _at_finely, _MOST_FINE_CELLS
        else:
            break
    return LeastValue(below, above, point)


@dataclass(frozen=True, slots=True)
class _Bounds:
    """Bounds of the least q − 1 in each of n cells, and points (3, n) of the wall in them with q − 1 below `above`.

    `below` is loosened by the error of q at that point, and by the term of second order, `loose`; `shares` (2, n) are
    the parts of `loose` that come only from the height and only from the angle.
    """

    below: Floats
    above: Floats
    X: Floats
    error: Floats
    loose: Floats
    shares: Floats


def _bounds(pair: Pair, cells: Floats, at: Callable[[Pair, Floats, Floats], _Values]) -> _Bounds:
    """Compute bounds in cells, from a value and slopes in the middle of each, or at the end of the wall it reaches."""
    w, t, half, k = cells
    below, level, above = (np.clip(height, pair.z_min, pair.z_max) for height in (w - half, w, w + half))
    level = np.where(below == pair.z_min, below, np.where(above == pair.z_max, above, level))
    h = np.maximum(level - below, above - level)
    values = at(pair, level, t)
    q, r, m = values.excess + 1, np.hypot(*values.X[:2]), min(pair.b, pair.d)
    rise = min(pair.alpha / pair.gamma, 2.0**400)
    least_r = pair.alpha * np.hypot(1, np.maximum(np.abs(level) - h, 0) / pair.gamma)
    most_r = r + rise * h
    away = (math.hypot(1, rise) * h + most_r * k) / m
    n = np.sqrt(np.maximum(q + values.error, 0)) + away
    kww = 2 * (1 + rise * rise) / m**2 + 2 * n * (rise * rise / least_r) / m
    kwt, ktt = 2 * most_r * rise / m**2 + 2 * n * rise / m, 2 * most_r**2 / m**2 + 2 * n * most_r / m
    shares = np.stack([kww * h * h, ktt * k * k])
    loose = shares.sum(axis=0) / 2 + kwt * h * k
    fall = np.minimum(values.qw * (below - level), values.qw * (above - level)) - np.abs(values.qt) * k
    bound = values.excess - values.error + (fall - values.blur * away - loose) * (1 + _SLACK)
    return _Bounds(
        np.nan_to_num(bound, nan=-np.inf, posinf=np.inf, neginf=-np.inf),
        np.nan_to_num(values.excess + values.error, nan=np.inf, posinf=np.inf),
        values.X,
        values.error,
        loose,
        shares,
    )


def _first_cells(pair: Pair) -> Floats:
    """Make cells that cover the part of the wall that can be nearest: middles w, θ and their half widths, (4, n)."""
    reach = pair.alpha * math.hypot(1, min(max(pair.z, pair.z_min), pair.z_max) / pair.gamma)
    center = math.hypot(pair.x, pair.y)
    level = min(max(pair.z, pair.z_min), pair.z_max)
    # The wall's point at this level and azimuth has this distance; points farther up or down are farther away.
    far = (math.hypot(abs(center - reach), level - pair.z) / min(pair.b, pair.d)) * (1 + 1e-9) * max(pair.b, pair.d)
    low, high = max(pair.z_min, pair.z - far), min(pair.z_max, pair.z + far)
    if not low < high:
        low, high = level, level
    edges = np.linspace(low, high, 17)
    w, t = np.meshgrid((edges[:-1] + edges[1:]) / 2, (np.arange(32) + 0.5) / 32 * 2 * math.pi)
    half = (edges[1:] - edges[:-1]).max() / 2 * (1 + 1e-12) + max(abs(low), abs(high)) * _OVERLAP
    return np.stack([w.ravel(), t.ravel(), np.full(w.size, half), np.full(w.size, math.pi / 32 * (1 + 1e-12))])


@dataclass(frozen=True, slots=True)
class _Values:
    """At n points X (3, n) of the wall: q − 1, a bound of its error, and the slopes of q by height and by angle.

    q is n² of the module's docstring. To a point e radii away q changes by the slopes, within `blur` e, and within
    `error`.
    """

    excess: Floats
    error: Floats
    qw: Floats
    qt: Floats
    blur: Floats
    X: Floats


def _at(pair: Pair, w: Floats, t: Floats) -> _Values:
    """Compute the values, in float64, at the points of height w and angle t."""
    r = pair.alpha * np.hypot(1, w / pair.gamma)
    turn = np.stack([np.cos(t), np.sin(t)])
    X = np.concatenate([r * turn, w[None]])
    v = np.array(pair.axis) / max(map(abs, pair.axis))
    v /= np.sqrt(v @ v)
    q, qw, qt = _slopes(pair, v, X - _center(pair), r, turn, w)
    return _Values(q - 1, _error(pair, X, q, _SLACK), qw, qt, np.zeros_like(q), X)


def _center(pair: Pair) -> Floats:
    """Return the spheroid's centre as a column, (3, 1)."""
    return np.array([[pair.x], [pair.y], [pair.z]])


def _error(pair: Pair, X: Floats, q: Floats, slack: float) -> Floats:
    """Return the error of q − 1, if n has an error of slack (|X| + |C|)/m, and the subtraction one of slack."""
    size = np.abs(X) + np.abs(_center(pair))
    off = slack * np.sqrt((size * size).sum(axis=0)) / min(pair.b, pair.d)
    return np.asarray(off * (2 * np.sqrt(q) + off) + slack)


def _slopes(pair: Pair, v: Floats, D: Floats, r: Floats, turn: Floats, w: Floats) -> tuple[Floats, Floats, Floats]:
    """Compute q for D = X − C, and its slopes by height and by angle, in float64."""
    along = v @ D
    across = D - along * v[:, None]
    q = (across * across).sum(axis=0) / pair.b**2 + (along / pair.d) ** 2
    grad = 2 * (across / pair.b**2 + along / pair.d**2 * v[:, None])
    slope = (pair.alpha / pair.gamma) ** 2 * w / r
    return q, (grad[:2] * turn).sum(axis=0) * slope + grad[2], r * (grad[1] * turn[0] - grad[0] * turn[1])


def _at_finely(pair: Pair, w: Floats, t: Floats) -> _Values:
    """Compute the values as _at does, with q − 1 in double-double."""
    ratio = double_double.quotient_of_floats(w, np.array([pair.gamma]))
    stretch = double_double.square_root(double_double.add_float(double_double.square(ratio), 1.0))
    r = double_double.multiply(stretch, _number(pair.alpha))
    turn = _unit([np.cos(t), np.sin(t)])
    X = [*(double_double.multiply(r, part) for part in turn), (w, np.zeros_like(w))]
    D = [double_double.add_float(part, -center) for part, center in zip(X, pair.row[4:7], strict=True)]
    scale = -math.frexp(max(map(abs, pair.axis)))[1]
    v = _unit([np.array([math.ldexp(part, scale)]) for part in pair.axis])
    along = double_double.sum_of([double_double.multiply(part, axis) for part, axis in zip(D, v, strict=True)])
    across = [double_double.subtract(p, double_double.multiply(along, axis)) for p, axis in zip(D, v, strict=True)]
    sides = [*((part, pair.b) for part in across), (along, pair.d)]
    q = double_double.sum_of([double_double.square(double_double.divide(part, _number(size))) for part, size in sides])
    excess = double_double.add_float(q, -1.0)[0]
    nearby = _rounded(D)
    _, qw, qt = _slopes(pair, _rounded(v)[:, 0], nearby, r[0], _rounded(turn), w)
    error = _error(pair, _rounded(X), q[0], _FINE_SLACK) + 2.0**-51 * np.abs(excess)
    blur = _SLACK * np.sqrt((nearby * nearby).sum(axis=0)) / min(pair.b, pair.d)
    return _Values(excess, error, qw, qt, blur, _rounded(X))


def _number(number: float) -> DoubleDouble:
    """Return a float64 as one double-double number, (1,)."""
    return np.array([number]), np.zeros(1)


def _unit(parts: list[Floats]) -> list[DoubleDouble]:
    """Scale a vector to length 1, in double-double."""
    norm = double_double.square_root(double_double.sum_of([double_double.two_square(part) for part in parts]))
    return [double_double.divide((part, np.zeros_like(part)), norm) for part in parts]


def _rounded(parts: list[DoubleDouble]) -> Floats:
    """Round a vector in double-double to float64, (3, n)."""
    return np.stack([high for high, _ in parts])


def _cut(cells: Floats, shares: Floats) -> Floats:
    """Cut each cell in two across the direction that loosens its bound most, or in four; the parts overlap."""
    for row in (0, 1):
        wide = shares[row] * _ALIKE >= shares[1 - row]
        room = (np.abs(cells[0]) + cells[2] if row == 0 else 1.0) * _OVERLAP
        step = np.where(wide, cells[2 + row] / 2, 0)
        parts = cells.copy()
        parts[row] -= step
        parts[2 + row] = np.where(wide, step + room, parts[2 + row])
        others = parts[:, wide]
        others[row] += 2 * step[wide]
        cells, shares = np.concatenate([parts, others], axis=1), np.concatenate([shares, shares[:, wide]], axis=1)
    return cells
