"""Hyperboloids that end: rows of thirteen numbers, with the traps of rims, openings, discs and thin slabs.

Every other row has a solid body. Most rows are made for the upper end, and half of these are mirrored at z = 0. A rim
at height w has the radius r = α √(1 + w²/γ²); a spheroid whose centre is X + Σ N/√(NᵀΣN), Σ its matrix of squared
semi-axes, touches the plane through X across N, and so the rim if X lies on it and N points away from the wall there.
Exact touches have w/γ, the direction of N and the azimuth from Pythagorean triples.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS
from hypcheck.geometry.rows import Floats, Rows, with_axis
from hypcheck.vectors import random_pairs, tilted
from hypcheck.vectors.draw import Draw, Integers, Maker, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import Sizes, all_regimes, by_sixteenths, changed_in_turn, repeated, sizes
from hypcheck.vectors.tilted import Vectors, anywhere

TRIPLES = np.array([(3, 4, 5), (4, 3, 5), (5, 12, 13), (12, 5, 13), (8, 15, 17), (15, 8, 17), (0, 1, 1)])
_ALONG = np.array([(3, 4, 5), (4, 3, 5), (5, 12, 13), (12, 5, 13), (0, 1, 1), (-3, 4, 5), (-4, 3, 5), (-5, 12, 13)])


def _rows(draw: Draw, rows: Rows, low: Floats, high: Floats, *, solid: Integers | None = None) -> Rows:
    """The rows with these ends, and with an axis if they have none; every other row is solid, and half are mirrored."""
    n, rows = len(rows), with_axis(rows)
    heights = np.stack([low, high, turns(n, 0, 1) if solid is None else solid], axis=1)
    ended_rows = np.concatenate([rows, heights], axis=1)
    down = draw.signs(n) < 0
    ended_rows[down, 6] *= -1
    if rows[:, 7:9].any():
        ended_rows[down, 9] *= -1
    ended_rows[down, 10], ended_rows[down, 11] = -ended_rows[down, 11], -ended_rows[down, 10]
    return np.asarray(ended_rows + 0.0)


def _lower(draw: Draw, high: Floats, unit: Floats) -> Floats:
    """A lower end some units below the upper one, or no lower end."""
    n = len(high)
    return np.asarray(np.where(turns(n, True, False, False), -np.inf, high - unit * draw.log_uniform(n, -3, 6)))


def _ordinary(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Sizes of every regime, and heights of a rim in γ."""
    return sizes(draw, *all_regimes(draw, n)), draw.signs(n) * draw.log_uniform(n, -6, 1)


def _hair(draw: Draw, n: int) -> Floats:
    """Factors of 1, or a little more or less."""
    return np.asarray(1 + draw.signs(n) * draw.log_uniform(n, -50, -3))


def uniform(beside: Maker = random_pairs.uniform, sizes: Sequence[int] = (3,)) -> Maker:
    """Rows in all regimes and places, with the upper end within one and a half radii of the centre's height.

    A radius is the largest of the numbers in these places of a row.
    """

    def make(draw: Draw, n: int) -> Rows:
        rows = beside(draw, n)
        unit = rows[:, sizes].max(axis=1)
        high = rows[:, 6] + unit * draw.between(n, -1.5, 1.5)
        return _rows(draw, rows, _lower(draw, high, unit), high)

    return make


def _at_rim(draw: Draw, size: Sizes, height: Floats, axis: Vectors) -> Rows:
    """Rows near contact with a rim at this height in γ, above it, outside or inside."""
    n = len(height)
    cosine, sine = draw.circle(n)
    out, up = draw.circle(n)
    radius, up = size.alpha * np.sqrt(1 + height * height), np.abs(up)
    point = (radius * cosine, radius * sine, size.gamma * height)
    rows = tilted.touching(size, axis, point, (out * cosine, out * sine, up), _hair(draw, n))
    high = size.gamma * height
    return _rows(draw, rows, _lower(draw, high, size.d), high)


Axes = Callable[[Draw, int], Vectors]


def _upward(_: Draw, n: int) -> Vectors:
    return np.zeros(n), np.zeros(n), np.ones(n)


def rim(axes: Axes = _upward) -> Maker:
    """Rows 2⁻⁵⁰ to 2⁻³ radii from contact with a rim: above, beside and within it."""

    def make(draw: Draw, n: int) -> Rows:
        size, height = _ordinary(draw, n)
        return _at_rim(draw, size, height, axes(draw, n))

    return make


CHANGED = (0, 1, 2, 3, 4, 5, 6, 10, 11, 12)
"""The columns that one_number_changed changes: an upright axis does not."""


def one_number_changed(draw: Draw, n: int) -> Rows:
    """As in random_pairs, near contact with a rim; the two heights and `solid` change too."""
    pairs = -(-n // (2 * len(CHANGED)))
    size, height = _ordinary(draw, pairs)
    return with_one_number_changed(draw, _at_rim(draw, size, height, _upward(draw, pairs)), CHANGED, n)


def with_one_number_changed(draw: Draw, pairs: Rows, columns: Sequence[int], n: int) -> Rows:
    """n rows: each pair repeated, with one number changed from row to row; infinite ends are made finite before."""
    rows = repeated(pairs, columns, n, centres=pairs.shape[1] - 10)
    low, high, solid = rows[:, -3:].T
    low = np.where(low == -np.inf, high - 4 * rows[:, 3], low)
    high = np.where(high == np.inf, low + 4 * rows[:, 3], high)
    rows[:, -3:-1] = np.stack([low, high], axis=1)
    others, part = by_sixteenths(draw, rows), (high - low) * draw.signs(n) * draw.log_uniform(n, -4, -1)
    others[:, -3:] = np.stack([low + part, high - part, 1 - solid], axis=1)
    return changed_in_turn(rows, others, columns)


def stiff(draw: Draw, n: int) -> Rows:
    """Rows near contact with a rim, with ratios of sizes up to 2²⁷."""
    size = sizes(draw, draw.log_uniform(n, -13, 13), draw.log_uniform(n, -13, 13), units=(-12, 12))
    return _at_rim(draw, size, draw.signs(n) * draw.log_uniform(n, -18, 3), _upward(draw, n))


def rim_tangent(draw: Draw, n: int) -> Rows:
    """The rim touched exactly: whole numbers times one power of two."""
    rise, leg, hypotenuse = TRIPLES[draw.integers(n, 0, len(TRIPLES) - 1)].T
    out, up, radius = _ALONG[draw.integers(n, 0, len(_ALONG) - 1)].T
    p, q, turn = TRIPLES[draw.integers(n, 0, len(TRIPLES) - 1)].T
    wide, tall, b, d = (draw.integers(n, 1, 40) for _ in range(4))
    center = hypotenuse * wide + out * b
    whole = [leg * wide * turn, leg * tall, radius * b * turn, radius * d, center * p, center * q, rise * tall + up * d]
    unit = ldexp(np.ones(n), draw.integers(n, -9, 2))
    rows = np.stack(whole, axis=1).astype(np.float64) * unit[:, None]
    high = (rise * tall).astype(np.float64) * unit
    return _rows(draw, rows, _lower(draw, high, rows[:, 3]), high)


def rim_neighbourhood(draw: Draw, n: int) -> Rows:
    """Exact touches of a rim, one number moved by one to four ulps."""
    rows = rim_tangent(draw, n)
    column = np.asarray([0, 1, 2, 3, 4, 5, 6, 11])[draw.integers(n, 0, 7)]
    here = np.arange(n)
    column = np.where(np.isfinite(rows[here, column]), column, 6)
    steps = draw.integers(n, 1, 4) * draw.signs(n).astype(np.int64)
    rows[here, column] = stepped(rows[here, column], steps)
    return rows


def opening(draw: Draw, n: int) -> Rows:
    """Spheroids narrower than the opening, at several heights in it: the side changes, with contact or without."""
    size = sizes(draw, draw.log_uniform(n, 0, 4), draw.log_uniform(n, -2, 5))
    height = draw.log_uniform(n, -4, 1)
    radius = size.alpha * np.sqrt(1 + height * height)
    cosine, sine = draw.circle(n)
    across = np.where(turns(n, True, False, False), 0.0, radius * draw.between(n, 0, 1))
    high = size.gamma * height
    z = np.where(turns(n, True, False, False, False), high, high + size.d * draw.between(n, -1.5, 1.5))
    rows = random_pairs.stack(size, across * cosine, across * sine, z)
    return _rows(draw, rows, _lower(draw, high, size.d), high)


def thin(beside: Maker = random_pairs.uniform) -> Maker:
    """Rows near contact with the surface, of which only a thin slab within the spheroid's reach is left."""

    def make(draw: Draw, n: int) -> Rows:
        rows, shift = beside(draw, n), draw.between(n, -1.2, 1.2)
        unit = rows[:, 3]
        low = rows[:, 6] + unit * shift
        high = low + np.maximum(unit * draw.log_uniform(n, -30, -1), np.abs(low) * 2.0**-50)
        return _rows(draw, rows, low, high)

    return make


def swallowed(draw: Draw, n: int) -> Rows:
    """A thin wall that lies completely or almost completely within the spheroid."""
    size = sizes(draw, draw.log_uniform(n, -6, 0), draw.log_uniform(n, -6, 2))
    cosine, sine = draw.circle(n)
    across, z = size.b * draw.between(n, 0, 1.2), size.d * draw.between(n, -1, 1)
    rows = random_pairs.stack(size, across * cosine, across * sine, z)
    low = z - size.d * draw.between(n, 0, 1.1)
    return _rows(draw, rows, low, low + size.d * draw.log_uniform(n, -8, 0))


def disc(axes: Axes = _upward) -> Maker:
    """Spheroids above an end, with the lowest point nearly or exactly at it, over the opening or the flat end."""

    def make(draw: Draw, n: int) -> Rows:
        size, height = _ordinary(draw, n)
        axis, (cosine, sine) = axes(draw, n), draw.circle(n)
        across = size.alpha * np.sqrt(1 + height * height) * draw.between(n, 0, 1.05)
        high = size.gamma * height
        share = np.where(turns(n, True, False, False), 1.0, _hair(draw, n))
        point = (across * cosine, across * sine, high)
        rows = tilted.touching(size, axis, point, (np.zeros(n), np.zeros(n), np.ones(n)), share)
        return _rows(draw, rows, _lower(draw, high, size.d), high, solid=turns(n, 1, 1, 0))

    return make


def groove(draw: Draw, n: int) -> Rows:
    """Spheres that nearly rest on both flanks of the groove, of which the ends leave one, both or none.

    The normal at height ζ of the hyperboloid a, c meets the plane of the waist at c² times the normal's length.
    """
    a, c, zeta = draw.log_uniform(n, 0, 4), draw.log_uniform(n, -3, 0), draw.log_uniform(n, -4, 1)
    flank = a * np.sqrt(1 + (zeta / c) * (zeta / c))
    out, up = flank / (a * a), zeta / (c * c)
    ball = c * c * np.sqrt(out * out + up * up)
    size = sizes(draw, a / ball, c / ball)
    cosine, sine = draw.circle(n)
    across = size.b * (flank + c * c * flank / (a * a)) / ball * _hair(draw, n)
    rows = random_pairs.stack(size, across * cosine, across * sine, np.zeros(n))
    shares = [np.asarray(turns(n, *values)) for values in ((0.5, 1.0, 2.0, 0.9, np.inf), (2.0, 0.5, 1.0))]
    high, low = (size.d * zeta / ball * share * _hair(draw, n) for share in shares)
    return _rows(draw, rows, -low, high)


def waist(draw: Draw, n: int) -> Rows:
    """An end exactly at the waist, or very near to it."""
    size, _ = _ordinary(draw, n)
    height = np.where(turns(n, True, False), 0.0, draw.signs(n) * draw.log_uniform(n, -40, -8))
    return _at_rim(draw, size, height, _upward(draw, n))


def far(draw: Draw, n: int) -> Rows:
    """Rows near contact, with ends so far away or infinite that they do not matter."""
    size, _ = _ordinary(draw, n)
    rows = random_pairs.beside(draw, size, random_pairs.heights(draw, size.c), draw.signs(n) * _hair(draw, n))
    unit = rows[:, 1] + np.maximum(rows[:, 2], rows[:, 3])
    reach = unit * draw.log_uniform(n, 5, 40)
    low = np.where(turns(n, True, False, False, False), -np.inf, rows[:, 6] - reach)
    high = np.where(turns(n, False, True, True), np.inf, rows[:, 6] + reach)
    return _rows(draw, rows, low, high)


def integers(columns: Sequence[str] = COLUMNS) -> Maker:
    """Whole numbers as a person types them, the axis too where there are columns of it."""

    def make(draw: Draw, n: int) -> Rows:
        rows = tilted.small_integers(draw, n)[:, : len(columns)]
        high = (rows[:, 6] + draw.integers(n, -6, 6)).astype(np.float64)
        low = np.where(turns(n, True, False, False), -np.inf, high - draw.integers(n, 1, 12))
        return _rows(draw, rows, low, high)

    return make


FAMILIES: dict[str, tuple[Maker, int]] = {
    "ended-uniform": (uniform(), 48),
    "ended-rim": (rim(), 60),
    "ended-rim-tangent": (rim_tangent, 60),
    "ended-rim-neighbourhood": (rim_neighbourhood, 60),
    "ended-opening": (opening, 48),
    "ended-thin": (thin(), 48),
    "ended-swallowed": (swallowed, 48),
    "ended-disc": (disc(), 48),
    "ended-groove": (groove, 60),
    "ended-waist": (waist, 40),
    "ended-far": (far, 40),
    "ended-stiff": (stiff, 40),
    "ended-small-integers": (integers(), 48),
    "ended-one-number-changed": (one_number_changed, 0),
}
TILTED: dict[str, tuple[Maker, int]] = {
    "tilted-ended-uniform": (uniform(tilted.uniform, (2, 3)), 48),
    "tilted-ended-rim": (rim(anywhere), 48),
    "tilted-ended-thin": (thin(tilted.near_contact), 40),
    "tilted-ended-disc": (disc(anywhere), 48),
    "tilted-ended-small-integers": (integers(TILTED_COLUMNS), 60),
}
"""The generators by the names of their families, upright and tilted, each with how many rows are frozen."""
