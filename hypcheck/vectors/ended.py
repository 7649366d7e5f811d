"""Hyperboloids that end: pairs of thirteen numbers and sweeps of sixteen, with the traps of rims and openings.

Every other row has a solid body. Most rows are made for the upper end, and half of these are mirrored at z = 0. A rim
at height w has the radius r = α √(1 + w²/γ²); a spheroid whose centre is X + Σ N/√(NᵀΣN), Σ its matrix of squared
semi-axes, touches the plane through X at right angles to N, and so the rim if X lies on it and N points away from the
wall there.
Exact touches have w/γ, the direction of N and the azimuth from Pythagorean triples. A sweep goes through the centre of
such a pair, ends at it, or begins there; beside exact touches its ends are whole numbers times one power of two, too.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import SWEEPS, Floats, Rows, with_axis
from hypcheck.vectors import random_pairs, tilted
from hypcheck.vectors.draw import Draw, Integers, Maker, in_turn, ldexp, stepped, turns
from hypcheck.vectors.random_pairs import Sizes, by_sixteenths, changed_in_turn, repeated, sizes, sizes_of_all_regimes
from hypcheck.vectors.sweeps import CENTRE, between
from hypcheck.vectors.tilted import Axes, Vectors, vertical

TRIPLES = np.array([(3, 4, 5), (4, 3, 5), (5, 12, 13), (12, 5, 13), (8, 15, 17), (15, 8, 17), (0, 1, 1)])
_ALONG = np.array([(3, 4, 5), (4, 3, 5), (5, 12, 13), (12, 5, 13), (0, 1, 1), (-3, 4, 5), (-4, 3, 5), (-5, 12, 13)])


def _rows(draw: Draw, rows: Rows, low: Floats, high: Floats, *, solid: Integers | None = None) -> Rows:
    """Give the rows the ends `low` and `high`, and an axis if they have none.

    Every other row is solid, unless `solid` says which, and half are mirrored at z = 0.
    """
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
    """Draw lower ends, 2⁻³ to 2⁶ units below the upper ones, or −∞ for no lower end."""
    n = len(high)
    return np.asarray(np.where(turns(n, True, False, False), -np.inf, high - unit * draw.log_uniform(n, -3, 6)))


def _ordinary(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Draw sizes of every regime, and heights of a rim in γ."""
    return sizes_of_all_regimes(draw, n), draw.signed(n, -6, 1)


def _near_1(draw: Draw, n: int) -> Floats:
    """Draw factors that differ from 1 by 2⁻⁵⁰ to 2⁻³, up or down."""
    return np.asarray(1 + draw.signed(n, -50, -3))


def uniform(beside: Maker = random_pairs.uniform, sizes: Sequence[int] = (3,)) -> Maker:
    """Return the generator of rows whose upper end is within one and a half radii of the centre's height.

    `beside` makes the pairs. A radius is the largest number of a row's columns `sizes`.
    """

    def make(draw: Draw, n: int) -> Rows:
        rows = beside(draw, n)
        unit = rows[:, sizes].max(axis=1)
        high = rows[:, 6] + unit * draw.between(n, -1.5, 1.5)
        return _rows(draw, rows, _lower(draw, high, unit), high)

    return make


def _at_rim(draw: Draw, size: Sizes, height: Floats, axis: Vectors) -> Rows:
    """Make rows near contact with a rim at this height in γ: the spheroid is above the rim, outside or inside."""
    n = len(height)
    cosine, sine = draw.circle(n)
    out, up = draw.circle(n)
    radius, up = size.alpha * np.sqrt(1 + height * height), np.abs(up)
    point = (radius * cosine, radius * sine, size.gamma * height)
    rows = tilted.touching(size, axis, point, (out * cosine, out * sine, up), _near_1(draw, n))
    high = size.gamma * height
    return _rows(draw, rows, _lower(draw, high, size.d), high)


def rim(axes: Axes = vertical) -> Maker:
    """Return the generator of rows 2⁻⁵⁰ to 2⁻³ radii from contact with a rim: above, beside and within it."""

    def make(draw: Draw, n: int) -> Rows:
        size, height = _ordinary(draw, n)
        return _at_rim(draw, size, height, axes(draw, n))

    return make


CHANGED = (0, 1, 2, 3, 4, 5, 6, 10, 11, 12)
"""The columns that one_number_changed changes: an upright axis does not."""


def one_number_changed(draw: Draw, n: int) -> Rows:
    """Make rows as in random_pairs, near contact with a rim; the two heights and `solid` change too."""
    pairs = -(-n // (2 * len(CHANGED)))
    size, height = _ordinary(draw, pairs)
    return with_one_number_changed(draw, _at_rim(draw, size, height, vertical(draw, pairs)), CHANGED, n)


def with_one_number_changed(draw: Draw, pairs: Rows, columns: Sequence[int], n: int) -> Rows:
    """Repeat each pair, and change one number from row to row, n rows in all; infinite ends are made finite before."""
    rows = repeated(pairs, columns, n, centres=pairs.shape[1] - 10)
    low, high, solid = rows[:, -3:].T
    low = np.where(low == -np.inf, high - 4 * rows[:, 3], low)
    high = np.where(high == np.inf, low + 4 * rows[:, 3], high)
    rows[:, -3:-1] = np.stack([low, high], axis=1)
    others, part = by_sixteenths(draw, rows), (high - low) * draw.signed(n, -4, -1)
    others[:, -3:] = np.stack([low + part, high - part, 1 - solid], axis=1)
    return changed_in_turn(rows, others, columns)


def stiff(draw: Draw, n: int) -> Rows:
    """Make rows near contact with a rim, with α/b and γ/d from 2⁻¹³ to 2¹³."""
    size = sizes(draw, draw.log_uniform(n, -13, 13), draw.log_uniform(n, -13, 13), units=(-12, 12))
    return _at_rim(draw, size, draw.signed(n, -18, 3), vertical(draw, n))


def rim_tangent(draw: Draw, n: int) -> Rows:
    """Make rows that touch the rim exactly: whole numbers times one power of two."""
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
    """Make rows that touch a rim exactly, and move one number of each by one to four ulps."""
    rows = rim_tangent(draw, n)
    column = np.asarray([0, 1, 2, 3, 4, 5, 6, 11])[draw.integers(n, 0, 7)]
    here = np.arange(n)
    column = np.where(np.isfinite(rows[here, column]), column, 6)
    steps = draw.integers(n, 1, 4) * draw.signs(n).astype(np.int64)
    rows[here, column] = stepped(rows[here, column], steps)
    return rows


def opening(draw: Draw, n: int) -> Rows:
    """Make rows at several heights in an opening wider than the spheroid: clear on either side, or in contact."""
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
    """Return the generator of rows of `beside` whose surface is only a thin slab near the height of the centre."""

    def make(draw: Draw, n: int) -> Rows:
        rows, shift = beside(draw, n), draw.between(n, -1.2, 1.2)
        unit = rows[:, 3]
        low = rows[:, 6] + unit * shift
        high = low + np.maximum(unit * draw.log_uniform(n, -30, -1), np.abs(low) * 2.0**-50)
        return _rows(draw, rows, low, high)

    return make


def swallowed(draw: Draw, n: int) -> Rows:
    """Make rows with a low wall that lies completely or almost completely within the spheroid."""
    size = sizes(draw, draw.log_uniform(n, -6, 0), draw.log_uniform(n, -6, 2))
    cosine, sine = draw.circle(n)
    across, z = size.b * draw.between(n, 0, 1.2), size.d * draw.between(n, -1, 1)
    rows = random_pairs.stack(size, across * cosine, across * sine, z)
    low = z - size.d * draw.between(n, 0, 1.1)
    return _rows(draw, rows, low, low + size.d * draw.log_uniform(n, -8, 0))


def disc(axes: Axes = vertical) -> Maker:
    """Return the generator of spheroids that stand on the plane of an end, over the opening or over the flat end.

    The lowest point is at the height of the end, up to roundings, or up to 2⁻³ of the spheroid's half height off it.
    """

    def make(draw: Draw, n: int) -> Rows:
        size, height = _ordinary(draw, n)
        axis, (cosine, sine) = axes(draw, n), draw.circle(n)
        across = size.alpha * np.sqrt(1 + height * height) * draw.between(n, 0, 1.05)
        high = size.gamma * height
        factor = np.where(turns(n, True, False, False), 1.0, _near_1(draw, n))
        point = (across * cosine, across * sine, high)
        rows = tilted.touching(size, axis, point, (np.zeros(n), np.zeros(n), np.ones(n)), factor)
        return _rows(draw, rows, _lower(draw, high, size.d), high, solid=turns(n, 1, 1, 0))

    return make


def groove(draw: Draw, n: int) -> Rows:
    """Make balls in the plane of the waist that nearly touch both sides of the groove, the hollow about the waist.

    The ends leave both, one or none of the places that the ball touches. Here a and c are the semi-axes of a
    hyperboloid in any unit. From its point at height ζ the normal (ρ/a², −ζ/c²), ρ the radius there, reaches the plane
    of the waist after c² times its length.
    """
    a, c, zeta = draw.log_uniform(n, 0, 4), draw.log_uniform(n, -3, 0), draw.log_uniform(n, -4, 1)
    flank = a * np.sqrt(1 + (zeta / c) * (zeta / c))
    out, up = flank / (a * a), zeta / (c * c)
    ball = c * c * np.sqrt(out * out + up * up)
    size = sizes(draw, a / ball, c / ball)
    cosine, sine = draw.circle(n)
    across = size.b * (flank + c * c * flank / (a * a)) / ball * _near_1(draw, n)
    rows = random_pairs.stack(size, across * cosine, across * sine, np.zeros(n))
    shares = [np.asarray(turns(n, *values)) for values in ((0.5, 1.0, 2.0, 0.9, np.inf), (2.0, 0.5, 1.0))]
    high, low = (size.d * zeta / ball * share * _near_1(draw, n) for share in shares)
    return _rows(draw, rows, -low, high)


def waist(draw: Draw, n: int) -> Rows:
    """Make rows near contact with a rim that is exactly at the waist, or very near to it."""
    size, _ = _ordinary(draw, n)
    height = np.where(turns(n, True, False), 0.0, draw.signed(n, -40, -8))
    return _at_rim(draw, size, height, vertical(draw, n))


def far(draw: Draw, n: int) -> Rows:
    """Make rows near contact whose ends are infinite, or so far away that they do not matter."""
    size, _ = _ordinary(draw, n)
    rows = random_pairs.beside(draw, size, random_pairs.heights(draw, size.c), draw.signs(n) * _near_1(draw, n))
    unit = rows[:, 1] + np.maximum(rows[:, 2], rows[:, 3])
    reach = unit * draw.log_uniform(n, 5, 40)
    low = np.where(turns(n, True, False, False, False), -np.inf, rows[:, 6] - reach)
    high = np.where(turns(n, False, True, True), np.inf, rows[:, 6] + reach)
    return _rows(draw, rows, low, high)


def integers(width: int = len(COLUMNS)) -> Maker:
    """Return the generator of rows of whole numbers, as a person types them.

    `width` is how many numbers are before the ends, 7 without an axis, 10 with one.
    """

    def make(draw: Draw, n: int) -> Rows:
        rows = tilted.small_integers(draw, n)[:, :width]
        high = (rows[:, 6] + draw.integers(n, -6, 6)).astype(np.float64)
        low = np.where(turns(n, True, False, False), -np.inf, high - draw.integers(n, 1, 12))
        return _rows(draw, rows, low, high)

    return make


def _through(draw: Draw, rows: Rows, step: Rows) -> Rows:
    """Make sweeps by these steps through the centres of rows; a centre can be anywhere on its sweep."""
    share, centre = draw.between(len(rows), 0, 1)[:, None], rows[:, CENTRE]
    return between(rows, centre + (1 - share) * step, centre - share * step)


def _any_step(draw: Draw, rows: Rows) -> Rows:
    """Draw steps in every direction, up to 2⁻³ … 2⁴ times the semi-axes long."""
    n, length = len(rows), draw.log_uniform(len(rows), -3, 4)
    parts = [rows[:, column] * length * draw.between(n, -1, 1) for column in (2, 2, 3)]
    return np.stack(parts, axis=1)


def _around(rows: Rows) -> Rows:
    """Return horizontal directions along the rim: at right angles to that from the hyperboloid's axis to the centre."""
    return np.stack([-rows[:, 5], rows[:, 4], np.zeros(len(rows))], axis=1)


def sweeps_about(rows_of: Maker) -> Maker:
    """Return the generator of sweeps in any direction from the centres of rows, which lie near an end."""

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        return between(rows, rows[:, CENTRE] + _any_step(draw, rows))

    return make


def sweeps_over(rows_of: Maker) -> Maker:
    """Return the generator of sweeps through the centres of rows: along the rim, across it, or in any direction."""

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        length = draw.signed(n, -3, 3)
        radial = np.stack([rows[:, 4], rows[:, 5], np.zeros(n)], axis=1)
        reach = np.sqrt(rows[:, 4] * rows[:, 4] + rows[:, 5] * rows[:, 5])
        distance = np.maximum(reach, rows[:, 2] * 2.0**-40)
        direction = np.where(turns(n, True, False)[:, None], _around(rows), radial)
        level = direction * (rows[:, 2] * length / distance)[:, None]
        return _through(draw, rows, np.where(turns(n, True, True, False)[:, None], level, _any_step(draw, rows)))

    return make


def sweeps_landing(rows_of: Maker) -> Maker:
    """Return the generator of vertical sweeps to the centres of rows, which are near contact with an end.

    A sweep begins outside the end that is nearer to the spheroid; every third sweep goes on beyond the row's centre.
    """

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        nearer = np.abs(rows[:, 6] - rows[:, 10]) < np.abs(rows[:, 6] - rows[:, 11])
        away = np.where(nearer, -1.0, 1.0) * rows[:, 3] * draw.log_uniform(n, -4, 5)
        start, end = rows[:, CENTRE].copy(), rows[:, CENTRE].copy()
        start[:, 2] += away
        end[:, 2] -= np.where(turns(n, True, False, False), away, 0.0)
        return between(rows, end, start)

    return make


SWEEP_CHANGED = (*range(10), 13, 14, 15)
"""The columns that sweeps_with_one_number_changed changes: an upright axis does not."""


def sweeps_with_one_number_changed(draw: Draw, n: int) -> Rows:
    """Make vertical sweeps to places near contact with a rim or a flat end, and change one number from row to row."""
    pairs = in_turn(sweeps_landing(rim()), sweeps_landing(disc()))(draw, -(-n // (2 * len(SWEEP_CHANGED))))
    return with_one_number_changed(draw, pairs, SWEEP_CHANGED, n)


def sweeps_through_opening(draw: Draw, n: int) -> Rows:
    """Make sweeps out through an opening or in; many are without contact if the body is open."""
    rows = opening(draw, n)
    step = _any_step(draw, rows) * draw.log_uniform(n, -8, 0)[:, None]
    step[:, 2] = rows[:, 3] * draw.signed(n, -1, 3)
    return _through(draw, rows, step)


def sweeps_through_thin(draw: Draw, n: int) -> Rows:
    """Make sweeps through a place near contact with a surface of which only a thin slab exists."""
    rows = thin()(draw, n)
    return _through(draw, rows, _any_step(draw, rows))


def sweeps_touching(draw: Draw, n: int) -> Rows:
    """Make sweeps through a place that touches a rim exactly, or from it: along the rim, away from it, or upwards."""
    rows = rim_tangent(draw, n)
    away = np.where(turns(n, True, False)[:, None], [[0.0, 0.0, 1.0]], rows[:, CENTRE] * [1, 1, 0])
    step = np.where(turns(n, True, True, False)[:, None], _around(rows), away)
    step = step * np.where(turns(n, False, False, True), rows[:, 3], 1.0)[:, None]
    centre, back = rows[:, CENTRE], np.where(turns(n, 1.0, 1.0, 1.0, 0.0), 1.0, 0.0)[:, None]
    return between(rows, centre + step, centre - step * back)


def _beside_ends(rows: Rows, level: Floats, draw: Draw) -> Rows:
    """Give the rows, which have an axis, a hyperboloid with an end within one and a half radii of the height `level`.

    One end in eight is exactly at the level. A third of the bodies have one end, half of all are solid; both are drawn,
    since the rows may come in turns.
    """
    n, unit = len(rows), rows[:, 2:4].max(axis=1)
    end = level + unit * np.where(draw.integers(n, 0, 7) == 0, 0.0, draw.between(n, -1.5, 1.5))
    height = np.maximum(unit * draw.log_uniform(n, -3, 6), np.abs(end) * 2.0**-50)
    height = np.where(draw.integers(n, 0, 2) == 0, np.inf, height)
    upper = draw.signs(n) > 0
    low, high = np.where(upper, end - height, end), np.where(upper, end, end + height)
    return np.concatenate([rows, np.stack([low, high, draw.integers(n, 0, 1)], axis=1)], axis=1) + 0.0


def given_ends(rows_of: Maker) -> Maker:
    """Return the generator of pairs beside an end that is near the height of the centre."""

    def make(draw: Draw, n: int) -> Rows:
        rows = with_axis(rows_of(draw, n))
        return _beside_ends(rows, rows[:, 6], draw)

    return make


def sweeps_given_ends(rows_of: Maker) -> Maker:
    """Return the generator of sweeps beside an end near the height of the start, the middle or the end of the sweep."""

    def make(draw: Draw, n: int) -> Rows:
        rows = with_axis(rows_of(draw, n), SWEEPS)
        share = draw.integers(n, 0, 2) / 2
        return _beside_ends(rows, rows[:, 6] + share * (rows[:, 9] - rows[:, 6]), draw)

    return make
