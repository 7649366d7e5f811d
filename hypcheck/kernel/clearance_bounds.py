"""Clearances, distances and nearest points of many pairs, with proved lower and upper bounds.

Floats only guess (clearance_points.py). Exact decisions of the kernel about other rows prove the returned bounds:

- If a spheroid f times as large, rounded outward, is clear, then clearance ≥ f − 1. If it is rounded inward and in
  contact, then clearance ≤ f − 1.
- Let n be a unit vector and v = √(nᵀQn) the spheroid's half width along it, with Q its matrix of squared semi-axes. For
  any v > 0 and δ > 0 the spheroid with the semi-axes √((v + δ)(b²/v + δ)) and √((v + δ)(d²/v + δ)) contains all points
  within δ of the given one: its matrix is (1 + δ/v) Q + (1 + v/δ) δ² I, and (p + q)² ≤ (1 + t) p² + (1 + 1/t) q² for
  the support functions p and q and any t > 0. If it is clear, the distance is at least δ. In the direction n it is no
  larger than necessary.
- A point of the hyperboloid and one of the spheroid are no nearer than their bodies, except for the rounding below.
- The two measures are related: clearance · min(b, d) ≤ distance ≤ clearance · max(b, d).

Where a guess cannot be proved, the same decisions halve the interval. Only these bounds of rounding errors are used:

Points. Each coordinate of an end of the gap takes fewer than 16 roundings of terms below |X| or |C| + max(b, d), where
an axis is tilted times (max/min of b, d)²; _POINTS = 2⁻⁴⁶ holds that for both ends, and for |X − Y|. OUTWARD covers
the 12 roundings of a semi-axis. Both hold for lengths in 2^±300, which are asked for.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import COLUMNS, REFUSED
from hypcheck.geometry.rows import PAIRS, Floats, Indices, Integers, Mask, Positions, Rows, invalid, upright_mask
from hypcheck.kernel import clearance_points as points
from hypcheck.kernel import compiled_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.in_use import kernel

CHUNK = 1 << 14
GUESS = 2.0**-32
"""The distance from a guess at which a proof is tried first, in units of 1 or of the guess, if that is greater."""

WIDTH = 2.0**-30
"""An interval of f, or of δ in units of δ + v, is halved if it is wider than this."""

_LARGEST = sys.float_info.max
OUTWARD = 1 + 2.0**-48
_POINTS = 2.0**-46
RANGE = (2.0**-300, 2.0**300)
_HALVINGS = 120
_SUBNORMAL = 2.0**-900
_ORDINARY = 60

CONSTANTS = {
    "guess": GUESS,
    "width": WIDTH,
    "outward": OUTWARD,
    "inward": 1 - 2.0**-48,
    "points": _POINTS,
    "least_grown": 2.0**-900,
    "greatest_grown": 2.0**900,
    "less_than": 1 - 2.0**-40,
    **points.CONSTANTS,
}
"""The constants of the same steps in C (core/parts/near.h). Products from least_grown to greatest_grown are rounded
well."""

Question = Callable[[Indices, Floats], Mask]
"""A function from the numbers of rows and factors or lengths to a mask of the rows with the wanted property."""


@dataclass(frozen=True)
class Clearance:
    """The result of clearance() for n rows; every array is of shape (n,), or (n, 3) for points. One pair has numbers.

    `position`: the exact position, as classify has it; `contact` says where that is contact.

    `distance_lower` ≤ distance ≤ `distance_upper`: the Euclidean distance between the two bodies, in the unit of the
    row; 0 in contact. For a sphere it is the clearance times the radius, else it is not.

    `nearest`: a point of the hyperboloid whose distance from the spheroid is `distance_upper` at most, except for the
    rounding of its coordinates; where no gap could be measured it is `touch`. `normal`: the unit vector from there to
    the spheroid, which is the gradient of the distance with respect to the centre; NaN in contact; its error has no
    proved bound. `tie`: another point is as near, by a symmetry of both bodies; then `nearest` is one of them.

    `lower` ≤ clearance ≤ `upper`: the clearance in spheroid radii. The spheroid, 1 + clearance times as large about its
    centre, first touches the hyperboloid; it is negative in contact, 0 in a tangency, −1 for a centre on the surface.
    The signs agree with `position`: lower ≥ 0 where it is clear, upper ≤ 0 in contact.

    `touch`: the place where that spheroid first touches; if there are several, the one towards +x or +z. The exact
    place is at most `touch_error` away, which is inf if there is no proved bound.
    """

    position: Positions
    distance_lower: Floats
    distance_upper: Floats
    nearest: Floats
    lower: Floats
    upper: Floats
    touch: Floats
    touch_error: Floats
    rows: Rows = field(repr=False)
    """The pairs, as rows."""

    @classmethod
    def empty(cls, rows: Rows) -> Clearance:
        """Return room for these rows, of which nothing is known."""
        count = len(rows)
        distance_lower, distance_upper, lower, upper, touch_error = (np.full(count, np.nan) for _ in range(5))
        nearest, touch = (np.full((count, 3), np.nan) for _ in range(2))
        position = np.full(count, 127, np.int8)
        return cls(position, distance_lower, distance_upper, nearest, lower, upper, touch, touch_error, rows)

    @property
    def contact(self) -> Mask:
        """Whether the two are in contact."""
        touching: Mask = self.position == 0  # of one pair True or False
        return touching

    @cached_property
    @in_default_environment
    def normal(self) -> Floats:
        """The unit vectors from `nearest` to the spheroids."""
        vectors = points.normals(self.rows, np.atleast_2d(self.nearest), np.atleast_1d(self.position))
        return vectors if np.ndim(self.position) else vectors[0]

    @cached_property
    @in_default_environment
    def tie(self) -> Mask:
        """Whether another point is as near, by a symmetry of both bodies."""
        tied = points.ties(self.rows, np.atleast_2d(self.nearest), np.atleast_1d(self.position))
        one: Any = bool(tied[0])
        return tied if np.ndim(self.position) else one

    @property
    def one(self) -> Clearance:
        """The first row, with numbers instead of arrays (n,)."""
        first = {name: getattr(self, name)[0] for name in _MEASURED}
        numbers: dict[str, Any] = {name: value if np.ndim(value) else value.item() for name, value in first.items()}
        return replace(self, **numbers | {"rows": self.rows[:1]})


_MEASURED = tuple(part.name for part in fields(Clearance) if part.name != "rows")


def clearances_without_ends(queries: Rows, threads: int | None = None) -> Clearance:
    """Return the result of clearance() for rows (n, 7) or (n, 10).

    Invalid ones have the position 127 and NaN everywhere.
    """
    upright = not PAIRS.has_axis(queries)
    compiled = upright and choice().kernel == "compiled"
    result = _compiled(queries, threads) if compiled else Clearance.empty(queries)
    refused = result.position == REFUSED if compiled else invalid(queries)
    places = np.flatnonzero(~refused & (np.isnan(result.lower) | np.isinf(result.touch_error)))
    with np.errstate(all="ignore"):
        for start in range(0, len(places), CHUNK):
            _fill(result, places[start : start + CHUNK], queries, threads)
        _fill_ties(result, queries, threads)
    return result


_SHIFT = 2.0**-36
"""How far a spheroid on the axis is shifted, in units of α."""


def _fill_ties(result: Clearance, queries: Rows, threads: int | None) -> None:
    """Fill in nearest points where a tilted spheroid is on the axis and has no direction: those of one beside it.

    A distance changes by no more than the centre moves, so the bounds hold with twice the shift, which covers its
    rounding. Of the shifts along x and y the better counts.
    """
    unknown = np.isnan(result.nearest).any(axis=1)
    if not unknown.any():
        return
    lost = np.flatnonzero(unknown & (np.abs(result.position) == 1))
    for column in (4, 5) if len(lost) else ():
        rows, shift = queries[lost].copy(), _SHIFT * queries[lost, 0]
        rows[:, column] += shift
        beside = Clearance.empty(rows)
        _fill(beside, np.arange(len(rows)), rows, threads)
        high = np.nextafter(beside.distance_upper + 2 * shift, np.inf)
        low = np.nextafter(np.fmax(beside.distance_lower - 2 * shift, 0), 0)
        known = (beside.position == result.position[lost]) & np.isfinite(beside.nearest).all(axis=1)
        better = known & (np.isnan(result.nearest[lost]).any(axis=1) | (high < result.distance_upper[lost]))
        result.distance_lower[lost[known]] = np.fmax(result.distance_lower[lost], low)[known]
        result.distance_upper[lost[better]] = np.fmin(result.distance_upper[lost], high)[better]
        result.nearest[lost[better]], result.touch[lost[better]] = beside.nearest[better], beside.touch[better]


def _compiled(rows: Rows, threads: int | None) -> Clearance:
    """Return the result of the compiled kernel for rows (n, 7), by the same steps.

    touch_error is inf if it has no bound.
    """
    position, numbers = compiled_kernel.near_rows(rows, threads)
    lower, upper, error, least, most = numbers[:, :5].T
    error[error == _LARGEST] = np.inf
    return Clearance(position, least, most, numbers[:, 8:], lower, upper, numbers[:, 5:8], error, rows)


def _fill(result: Clearance, places: Indices, queries: Rows, threads: int | None) -> None:
    """Fill in the answers about valid rows: the tilted rows in one call, the upright ones in another."""
    some = queries[places]
    upright = upright_mask(some)
    for chosen in (~upright, upright):
        if chosen.any():
            rows = np.ascontiguousarray(some[chosen, : len(COLUMNS)] if chosen is upright else some[chosen])
            answers = _answers(rows, threads)
            for name in _MEASURED:
                getattr(result, name)[places[chosen]] = getattr(answers, name)


def _answers(rows: Rows, threads: int | None) -> Clearance:
    """Return the answers about rows that are all tilted, (n, 10), or that are all upright, (n, 7)."""
    rows, shift = scaled(rows)
    has_axis = PAIRS.has_axis(rows)
    position = _positions(rows, threads)
    touches = points.tilted_touches(rows) if has_axis else points.upright_touches(rows)
    low, high = _factors(rows, position, touches.factor, threads)
    lower, upper = np.maximum(_less_one(low, -np.inf), -1.0), _less_one(high, np.inf)
    lengths = rows[:, 2:4]
    least = np.nextafter(np.maximum(lower, 0) * lengths.min(axis=1), 0)
    most = np.where(position == 0, 0.0, np.nextafter(upper * lengths.max(axis=1), np.inf))
    nearest = touches.point.copy()
    clear = np.flatnonzero(position)
    if len(clear):
        ask = points.tilted_gaps if has_axis else points.upright_gaps
        gaps = ask(rows[clear], position[clear], touches.point[clear])
        usual = _usual(rows[clear])
        measured = np.where(usual, _measured(rows[clear], gaps), np.inf)
        shorter = measured <= most[clear]
        most[clear[shorter]], nearest[clear[shorter]] = measured[shorter], gaps.there[shorter]
        least[clear] = _separated(rows[clear], gaps, usual, least[clear], most[clear], threads)
    least = _lowered(least, shift, 0.0)
    most = _lowered(most, shift, np.inf)
    touch, nearest = (np.ldexp(place, -shift[:, None]) for place in (touches.point, nearest))
    error = _lowered(touches.error, shift, np.inf)
    return Clearance(position, least, most, nearest, lower, upper, touch, error, rows)


def scaled(rows: Rows) -> tuple[Rows, Integers]:
    """Return the rows with all lengths times 2^shift: the longest about 1, or longer if b or d would be subnormal.

    The shift is 0 where the longest is ordinary, and where a length would be rounded.
    """
    lengths = rows[:, : len(COLUMNS)]
    _, exponents = np.frexp(np.abs(lengths).max(axis=1))
    shift = np.where(np.abs(exponents) > _ORDINARY, -exponents, 0)
    small = np.ldexp(rows[:, 2:4].min(axis=1), shift) < _SUBNORMAL
    shift = np.where(small, 900 - exponents, shift)
    moved = np.ldexp(lengths, shift[:, None])
    shift = np.where((np.ldexp(moved, -shift[:, None]) == lengths).all(axis=1), shift, 0)
    result = rows.copy()
    result[:, : len(COLUMNS)] = np.where(shift[:, None] == 0, lengths, moved)
    return result, shift


def _lowered(length: Floats, shift: Integers, towards: float) -> Floats:
    """Return the lengths times 2^−shift, rounded towards a side."""
    return np.where((shift != 0) & (length > 0), np.nextafter(np.ldexp(length, -shift), towards), length)


def _positions(rows: Rows, threads: int | None) -> Positions:
    """Return the exact positions of rows."""
    return kernel().answer_rows(np.ascontiguousarray(rows), "position", threads)[0]


def _less_one(factor: Floats, towards: float) -> Floats:
    """Return factor − 1, which is exact from 1/2 to 2, and else rounded towards a side."""
    return np.where((factor >= 0.5) & (factor <= 2), factor - 1, np.nextafter(factor - 1, towards))


def _enlarged(rows: Rows, factor: Floats, towards: float) -> Rows:
    """Return the rows with b and d times a factor, rounded towards a side; times 1 they are as they were."""
    grown = rows.copy()
    product = rows[:, 2:4] * factor[:, None]
    grown[:, 2:4] = np.where(factor[:, None] == 1, product, np.nextafter(product, towards))
    return grown


def _factors(rows: Rows, position: Positions, guess: Floats, threads: int | None) -> tuple[Floats, Floats]:
    """Return factors by which the spheroid, grown, is clear and is in contact: low < 1 + clearance ≤ high, proved."""

    def clear(some: Indices, factor: Floats) -> Mask:
        return np.isin(_positions(_enlarged(rows[some], factor, np.inf), threads), (-1, 1))

    def meets(some: Indices, factor: Floats) -> Mask:
        return np.asarray(_positions(_enlarged(rows[some], factor, 0.0), threads) == 0)

    low, high = np.where(position == 0, 0.0, 1.0), np.where(position == 0, 1.0, np.inf)
    scale = np.maximum(guess, 1)
    tried = guess - GUESS * scale
    some = np.flatnonzero((tried > low) & (tried < high))
    low[some] = np.where(clear(some, tried[some]), tried[some], low[some])
    tried = guess + GUESS * scale
    some = np.flatnonzero((tried < high) & (tried > low) & np.isfinite(tried))
    high[some] = np.where(meets(some, tried[some]), tried[some], high[some])
    _halve(rows, low, high, clear, meets)
    return low, high


def _halve(rows: Rows, low: Floats, high: Floats, clear: Question, meets: Question) -> None:
    """Halve intervals wider than WIDTH, in logarithms if they span more than a factor of 2, until no half is proved."""
    largest = np.minimum(np.finfo(np.float64).max / rows[:, 2:4].max(axis=1) / 2, 2.0**1000)
    some = np.arange(len(rows))
    for _ in range(_HALVINGS):
        some = some[high[some] - low[some] > WIDTH * np.maximum(1, low[some])]
        if not len(some):
            return
        above, below = np.minimum(high[some], largest[some]), np.maximum(low[some], WIDTH / 2)
        middle = np.where(above > 2 * below, np.sqrt(below) * np.sqrt(above), below + (above - below) / 2)
        inside = (middle > low[some]) & (middle < high[some])
        some, middle = some[inside], middle[inside]
        is_clear = clear(some, middle)
        low[some[is_clear]] = middle[is_clear]
        rest, middle = some[~is_clear], middle[~is_clear]
        met = meets(rest, middle)
        high[rest[met]] = middle[met]
        some = np.concatenate([some[is_clear], rest[met]])


def _usual(rows: Rows) -> Mask:
    """Return a mask of the rows with lengths within the range of the bounds; coordinates may be smaller."""
    size = np.abs(rows[:, : len(COLUMNS)])
    return np.asarray((size <= RANGE[1]).all(axis=1) & (size[:, :4] >= RANGE[0]).all(axis=1))


def _measured(rows: Rows, gaps: points.PointGaps) -> Floats:
    """Return the length of each gap, and more than the error of its ends."""
    b, d = rows[:, 2], rows[:, 3]
    largest = np.maximum(b, d)
    if PAIRS.has_axis(rows):
        largest = largest * (largest / np.minimum(b, d)) ** 2
    offset = gaps.there - gaps.here
    length = np.sqrt((offset * offset).sum(axis=1))
    terms = np.abs(gaps.there).sum(axis=1) + np.abs(rows[:, 4:7]).sum(axis=1) + largest
    return np.asarray(length + _POINTS * (length + terms))


def _separated(
    rows: Rows, gaps: points.PointGaps, usual: Mask, least: Floats, most: Floats, threads: int | None
) -> Floats:
    """Return the distances that are proved by larger spheroids that contain all points within them.

    They are at least `least`.
    """
    v = gaps.support

    def clear(some: Indices, length: Floats) -> Mask:
        grown = rows[some]
        for column, size in zip((2, 3), points.reaching(grown[:, 2], grown[:, 3], v[some], length), strict=True):
            grown[:, column] = size * OUTWARD
        return np.isin(_positions(grown, threads), (-1, 1))

    low, high = least.copy(), most.copy()
    tried = np.minimum(gaps.length, most) - GUESS * (gaps.length + v)
    fair = usual & (v >= RANGE[0]) & (v <= RANGE[1]) & (tried <= RANGE[1])
    some = np.flatnonzero(fair & (tried > low))
    proved = clear(some, tried[some])
    low[some[proved]] = tried[some[proved]]
    some = some[~proved]
    for _ in range(_HALVINGS):
        some = some[np.isfinite(high[some]) & (high[some] - low[some] > WIDTH * (low[some] + v[some]))]
        if not len(some):
            break
        middle = low[some] + (high[some] - low[some]) / 2
        proved = clear(some, middle)
        low[some[proved]], high[some[~proved]] = middle[proved], middle[~proved]
    return low
