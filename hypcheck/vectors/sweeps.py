"""Sweeps: rows of ten numbers, or of thirteen with an axis, with traps between the two ends of a sweep.

First sweeps that touch: through a place where the surfaces touch, across a ring, and from or to a tangency. These touch
exactly: places come from the constructions of tangencies and rings, and both ends of a sweep are checked to have no
rounding. The other sweeps are not exact.
"""

from __future__ import annotations

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.truth.passage_error import hits_at_size
from hypcheck.vectors import double_roots, random_pairs, tilted
from hypcheck.vectors.coincidences import tangent
from hypcheck.vectors.double_roots import gather, gathered, in_metres
from hypcheck.vectors.draw import Draw, Maker, in_turn, ldexp, turns
from hypcheck.vectors.random_pairs import BODY, TOWER, Sizes, heights, offsets, sizes, sizes_of_all_regimes

CENTRE = slice(4, 7)
"""The columns of the centre, or of the start of a sweep."""


def between(rows: Rows, ends: Rows, starts: Rows | None = None) -> Rows:
    """Make sweeps from the centres of rows, or from `starts`, to `ends`, (n, 3) each: three columns more, no −0.0."""
    starts = rows[:, CENTRE] if starts is None else starts
    return np.concatenate([rows[:, :4], starts, ends, rows[:, 7:]], axis=1) + 0.0


def through(rows: Rows, steps: Rows, after: Floats) -> tuple[Rows, Mask]:
    """Make sweeps through the centres of rows, from one step before them to `after` steps beyond.

    Returns a mask (n,), too, of the sweeps that move and whose start and end were computed without rounding.
    """
    centres = rows[:, CENTRE]
    (start, lost), (end, missed) = two_sum(centres, -steps), two_sum(centres, steps * after[:, None])
    moved = (start != end).any(axis=1)
    return between(rows, end, start), np.asarray((lost == 0).all(axis=1) & (missed == 0).all(axis=1) & moved)


@gathered
def _exterior_graze(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make sweeps through an outer tangency, horizontal and along the surface, whose section curves away from them."""
    tangencies = double_roots.by_ratios(draw, n)
    rows = in_metres(draw, np.where(tangencies.usable[:, None], tangencies.rows, 1.0))
    share = ldexp(draw.signs(n), draw.integers(n, -6, 2))
    steps = np.stack([-rows[:, 5] * share, rows[:, 4] * share, np.zeros(n)], axis=1)
    sweeps, exact = through(rows, steps, turns(n, 1.0, 3.0, 0.5))
    return sweeps, exact & tangencies.usable & tangencies.outer & tangencies.tangent


@gathered
def _interior_graze(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make sweeps up or down through an inner tangency at the waist, the narrowest place."""
    rows = in_metres(draw, gather(draw, n, double_roots.waist_points))
    radius = np.sqrt(rows[:, 4] * rows[:, 4] + rows[:, 5] * rows[:, 5])
    steps = np.zeros((n, 3))
    steps[:, 2] = rows[:, 1] * ldexp(draw.signs(n), draw.integers(n, -6, 3))
    sweeps, exact = through(rows, steps, turns(n, 1.0, 3.0, 0.5))
    return sweeps, exact & (radius < rows[:, 0])


grazing = in_turn(_exterior_graze, _interior_graze)
"""The generator of sweeps with an exact tangency at one time, clear before and after, outside and inside."""


def near_graze(draw: Draw, n: int) -> Rows:
    """Make sweeps as `grazing` does, with the spheroid enlarged or reduced by a relative 2⁻⁵⁰ to 2⁻³."""
    rows = grazing(draw, n)
    factor = 1 + ldexp(draw.signs(n), -3 - draw.places(n) % 48)
    rows[:, 2] *= factor
    rows[:, 3] *= factor
    return rows


def _ring_place(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Draw rows with centres on the ring; return them and a mask of the usable ones."""
    rows, usable = double_roots.waist_roots(draw, n, ring=True)
    return in_metres(draw, np.where(usable[:, None], rows, 1.0)), usable


def ring_attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make sweeps across rings; return them and a mask of those with exact ends. Some begin in contact."""
    rows, usable = _ring_place(draw, n)
    share = ldexp(np.ones(n), draw.integers(n, -30, -5))
    pick = draw.integers(n, 0, 3)
    zero = np.zeros(n)
    x, y = rows[:, 4], rows[:, 5]
    steps = np.select(
        [(pick == choice)[:, None] for choice in range(4)],
        [
            np.stack([x * share, y * share, zero], axis=1),
            np.stack([zero, zero, rows[:, 3] * share], axis=1),
            np.stack([-y * share, x * share, zero], axis=1),
            np.stack([x * share, y * share, rows[:, 3] * share], axis=1),
        ],
    )
    sweeps, exact = through(rows, steps, turns(n, 1.0, 2.0))
    return sweeps, exact & usable


def ring(draw: Draw, n: int) -> Rows:
    """Make sweeps across the ring, where the discriminant is 0 without contact: along the ring, upwards and outwards.

    A ring may be so near to the surface that a sweep across it begins in contact. Other sweeps replace these.
    """
    sweeps = gather(draw, n, ring_attempt)
    near = np.flatnonzero(~more_than_a_radius_away(sweeps))
    touching = [place for place in near.tolist() if hits_at_size(sweeps[place].tolist())]
    sweeps[touching] = gather(draw, len(touching), _clear_ring_attempt)
    return sweeps


def _clear_ring_attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Make sweeps across rings as ring_attempt does; the mask excludes those that may touch."""
    sweeps, usable = ring_attempt(draw, n)
    return sweeps, usable & more_than_a_radius_away(sweeps)


def more_than_a_radius_away(sweeps: Rows) -> Mask:
    """Return a mask of the sweeps across a ring that are certainly clear everywhere, by their distance from the waist.

    In the space where the spheroid is the unit ball, a = α/b is the radius of the waist. There a centre in the plane of
    the waist, at the distance r from the axis and between waist and ring, is r − a away from the surface, and one that
    is z above the plane is farther than r − a − z. The margin 2⁻⁴⁰ is far more than the rounding error of r.
    """
    alpha, _, b, d = sweeps[:, :4].T
    x, y, end_x, end_y = sweeps[:, [4, 5, 7, 8]].T
    step_x, step_y = end_x - x, end_y - y
    passing = (x * step_x + y * step_y < 0) & (end_x * step_x + end_y * step_y > 0)
    with np.errstate(invalid="ignore"):  # a sweep without motion does not cross the ring
        foot = np.abs(x * step_y - y * step_x) / np.sqrt(step_x * step_x + step_y * step_y)
    nearest = np.where(passing, foot, np.sqrt(np.minimum(x * x + y * y, end_x * end_x + end_y * end_y))) / b
    rise = np.abs(sweeps[:, [6, 9]]).max(axis=1) / d
    return np.asarray(nearest * (1 - 2.0**-40) - alpha / b - rise > 1)


def at_an_end(draw: Draw, n: int) -> Rows:
    """Make sweeps with contact only at t = 1, or only at t = 0: one end is a tangency, the other is off the surface."""
    rows = tangent(draw, n)
    alpha, gamma, _, _, x, y, z = rows.T
    height = z / gamma
    outside = (x * x + y * y) / (alpha * alpha) > 1 + height * height
    factor = np.where(outside, draw.between(n, 1.25, 4), draw.between(n, -0.5, 0.75))
    away = np.stack([x * factor, y * factor, z], axis=1)
    away[:, 2] = np.where(outside, z * draw.unit(n), z * draw.between(n, 1, 4))
    sweeps = between(rows, away)
    backward = turns(n, False, True)
    sweeps[backward, 4:7], sweeps[backward, 7:10] = away[backward] + 0.0, rows[backward, CENTRE]
    return sweeps


def tilted_end(draw: Draw, n: int) -> Rows:
    """Make sweeps with a tangency at t = 0 or at t = 1, the other end twice as far from the origin, or half as far."""
    rows = tilted.tangent(draw, n)
    sweeps = between(rows, rows[:, CENTRE] * turns(n, 2.0, 0.5)[:, None])
    backward = turns(n, False, False, True, True)
    sweeps[backward, 4:7], sweeps[backward, 7:10] = sweeps[backward, 7:10], sweeps[backward, 4:7]
    return sweeps


def one_number_changed(ends: Maker, columns: int) -> Maker:
    """Return the generator of sweeps of `ends`, repeated with one number changed from row to row.

    `columns` is the number of columns that change.
    """

    def make(draw: Draw, n: int) -> Rows:
        sweeps = ends(draw, -(-n // (2 * columns)))
        return random_pairs.each_with_one_number_changed(draw, sweeps, range(columns), n)

    return make


def tilted_ring(draw: Draw, n: int) -> Rows:
    """Make sweeps across the ring of a tilted spheroid, or through a place beside it."""
    rows = tilted.ring(draw, n)
    steps = rows[:, 2:3] * ldexp(draw.signs(n), draw.integers(n, -30, -9))[:, None] * _directions(draw, n)
    return through(rows, steps, np.ones(n))[0]


def _directions(draw: Draw, n: int) -> Rows:
    """Draw directions whose coordinates are −1, 0 or 1."""
    return np.stack([draw.integers(n, -1, 1) for _ in range(3)], axis=1).astype(np.float64)


def _beside(draw: Draw, size: Sizes) -> Rows:
    """Make rows all around the surface."""
    return random_pairs.beside(draw, size, heights(draw, size.c), offsets(draw, len(size.b)))


def _ends(draw: Draw, size: Sizes, start: Rows) -> Rows:
    """Draw ends of sweeps: two in five all around the surface, the others within three radii of the start."""
    far, near = _beside(draw, size)[:, CENTRE], start[:, CENTRE].copy()
    for place, reach in enumerate((size.b, size.b, size.d)):
        near[:, place] += 3 * reach * draw.between(len(near), -1, 1)
    return np.where(turns(len(near), True, True, False, False, False)[:, None], far, near)


def _about_the_waist(draw: Draw, n: int) -> tuple[Floats, Floats, Floats, Floats]:
    """Draw α, γ, b, d: α and γ from 1 to 32, b and d from 1/256 of α and γ to twice as large."""
    alpha, gamma = draw.log_uniform(n, 0, 5), draw.log_uniform(n, 0, 5)
    return alpha, gamma, alpha * draw.log_uniform(n, -8, 1), gamma * draw.log_uniform(n, -8, 1)


def anywhere(draw: Draw, n: int) -> Rows:
    """Make sweeps with both ends uniform in a box about the waist."""
    alpha, gamma, b, d = _about_the_waist(draw, n)
    across, along = 2 * (alpha + b), 2 * (gamma + d)
    ends = [draw.between(n, -reach, reach) for _ in range(2) for reach in (across, across, along)]
    return np.stack([alpha, gamma, b, d, *ends], axis=1)


def tunnelling(draw: Draw, n: int) -> Rows:
    """Make sweeps through the wall from outside to inside, or through the whole waist from one side to the other."""
    alpha, gamma, b, d = _about_the_waist(draw, n)
    b, d = np.minimum(b, alpha / 8), np.minimum(d, gamma / 8)
    cosine, sine = draw.circle(n)
    aside = draw.between(n, -0.5, 0.5) * alpha
    first = alpha * draw.between(n, 1.5, 4.0) + 2 * b
    last = turns(n, 0.0, -1.0) * alpha * draw.between(n, 1.5, 4.0)
    z0, z1 = (gamma * draw.between(n, -0.5, 0.5) for _ in range(2))
    start = (first * cosine - aside * sine, first * sine + aside * cosine, z0)
    end = (last * cosine - aside * sine, last * sine + aside * cosine, z1)
    return np.stack([alpha, gamma, b, d, *start, *end], axis=1) + 0.0


def uniform(draw: Draw, n: int) -> Rows:
    """Make sweeps in all regimes, with both ends all around the surface, or near to each other."""
    size = sizes_of_all_regimes(draw, n)
    start = random_pairs.beside(draw, size, heights(draw, size.c), 2 * offsets(draw, n))
    return between(start, _ends(draw, size, start))


def tower(draw: Draw, n: int) -> Rows:
    """Make sweeps of the paper's body in its tower, down through the waist and out, close to the wall."""
    size = Sizes(*(np.full(n, value) for value in TOWER + BODY))
    cosine, sine = draw.circle(n)
    radius = draw.between(n, 1.5, 1.9)
    top, bottom = draw.between(n, 4, 18), draw.between(n, -18, -4)
    rows = random_pairs.stack(size, radius * cosine, radius * sine, top)
    aside = draw.between(n, -0.25, 0.25)
    end = np.stack([radius * cosine - aside * sine, radius * sine + aside * cosine, bottom], axis=1)
    return between(rows, end)


def across(draw: Draw, n: int) -> Rows:
    """Make steps that are too long: both ends outside, or inside above and below the waist; the surface is between."""
    size = sizes_of_all_regimes(draw, n)
    cosine, sine = draw.circle(n)
    reach = size.alpha * draw.log_uniform(n, 0, 5) + size.b * draw.between(n, 1, 3)
    height = size.gamma * draw.between(n, -0.5, 0.5)
    rows = random_pairs.stack(size, reach * cosine, reach * sine, height)
    beyond = np.stack([-rows[:, 4], -rows[:, 5], rows[:, 6] + size.d * draw.between(n, -1, 1)], axis=1)
    tall = size.gamma * draw.log_uniform(n, 4, 8) * (1 + size.b / size.alpha) + 4 * size.d
    narrow = size.alpha * draw.unit(n)
    down = np.stack([narrow * cosine, narrow * sine, -tall], axis=1)
    inner = turns(n, False, False, True)[:, None]
    rows[:, CENTRE] = np.where(inner, down * [1, 1, -1], rows[:, CENTRE])
    return between(rows, np.where(inner, down, beyond))


def begun_in_contact(draw: Draw, n: int) -> Rows:
    """Make sweeps that start in contact: the first contact is at t = 0, wherever the sweep leads."""
    size = sizes_of_all_regimes(draw, n)
    start = random_pairs.beside(draw, size, heights(draw, size.c), draw.between(n, -0.9, 0.9))
    return between(start, _beside(draw, size)[:, CENTRE])


def still(draw: Draw, n: int) -> Rows:
    """Make sweeps whose two ends are one point: anywhere, at a tangency, on the ring."""
    rows = in_turn(random_pairs.uniform, tangent, gathered(_ring_place))(draw, n)
    return between(rows, rows[:, CENTRE])


def along_a_line(draw: Draw, n: int) -> Rows:
    """Make sweeps along a straight line of the surface, or up to 2.5 radii beside one: the distance hardly changes."""
    size = sizes_of_all_regimes(draw, n)
    cosine, sine = draw.circle(n)
    first, last = draw.between(n, -3, 0), draw.between(n, 0, 3)
    radius = size.alpha + size.b * turns(n, 0.0, 1.0, -1.0) * draw.between(n, 0.5, 2.5)
    turn, up = draw.signs(n), size.gamma

    def at(share: Floats) -> tuple[Floats, Floats, Floats]:
        aside = turn * share * size.alpha
        return radius * cosine - aside * sine, radius * sine + aside * cosine, share * up

    return between(random_pairs.stack(size, *at(first)), np.stack(at(last), axis=1))


def vertical(draw: Draw, n: int) -> Rows:
    """Make sweeps parallel to the hyperboloid's axis, or on it: x and y do not change."""
    size = sizes_of_all_regimes(draw, n)
    rows = _beside(draw, size)
    rows[:, 4:6] *= turns(n, 1.0, 1.0, 1.0, 0.0)[:, None]
    end = rows[:, CENTRE].copy()
    end[:, 2] = draw.signs(n) * size.d * draw.between(n, 0, 2) * heights(draw, size.c)
    return between(rows, end)


def horizontal(draw: Draw, n: int) -> Rows:
    """Make sweeps at constant height; every third one is in the plane of the waist."""
    size = sizes_of_all_regimes(draw, n)
    rows, end = _beside(draw, size), _beside(draw, size)[:, CENTRE]
    rows[:, 6] *= turns(n, 1.0, 1.0, 0.0)
    end[:, 2] = rows[:, 6]
    return between(rows, end)


def very_long(draw: Draw, n: int) -> Rows:
    """Make sweeps past the surface, 2¹⁰ to 2⁴⁰ times as long as the spheroid: contact is very short."""
    size = sizes_of_all_regimes(draw, n)
    rows = _beside(draw, size)
    cosine, sine = draw.circle(n)
    reach = draw.log_uniform(n, 10, 40)
    step = np.stack([size.b * cosine * reach, size.b * sine * reach, size.d * draw.between(n, -1, 1) * reach], axis=1)
    share = draw.unit(n)[:, None]
    return between(rows, rows[:, CENTRE] + (1 - share) * step, rows[:, CENTRE] - share * step)


def very_short(draw: Draw, n: int) -> Rows:
    """Make sweeps whose ends nearly coincide, from a place about 2⁻⁵⁰ to 2⁻²⁰ radii off contact.

    Their length is 2⁻⁵⁰ to 2⁻¹⁰ of the distance from the origin.
    """
    size = sizes_of_all_regimes(draw, n)
    offset = draw.signs(n) + ldexp(draw.signs(n), draw.integers(n, -50, -20))
    rows = random_pairs.beside(draw, size, heights(draw, size.c), offset)
    return between(rows, rows[:, CENTRE] * (1 + ldexp(draw.signs(n), draw.integers(n, -50, -10)))[:, None])


def stiff(draw: Draw, n: int) -> Rows:
    """Make sweeps with ratios of sizes up to 2²⁶ and both ends beside the surface."""
    a = np.where(turns(n, True, False), draw.log_uniform(n, 12, 26), draw.log_uniform(n, -12, 12))
    c = np.where(turns(n, False, True, True), draw.log_uniform(n, 12, 26), draw.log_uniform(n, -12, 12))
    size = sizes(draw, a, c)
    start = _beside(draw, size)
    return between(start, _ends(draw, size, start))


def small_integers(draw: Draw, n: int) -> Rows:
    """Make sweeps of whole numbers, as a person types them."""
    columns = [draw.integers(n, 1, 7) for _ in range(4)] + [draw.integers(n, -9, 9) for _ in range(6)]
    return np.stack(columns, axis=1).astype(np.float64) + 0.0


def beside_rows(rows_of: Maker) -> Maker:
    """Return the generator of sweeps from the centres of rows to ends all around the surface or near the start."""

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        return between(rows, _ends(draw, Sizes(*rows[:, :4].T), rows))

    return make


tilted_uniform = beside_rows(tilted.uniform)
"""The generator of sweeps of all regimes and axes in all directions, with ends all around the surface."""


def tilted_integers(draw: Draw, n: int) -> Rows:
    """Make tilted sweeps of whole numbers, among them vertical axes and spheres, which are upright sweeps."""
    axis = np.stack([draw.integers(n, -2, 2), draw.integers(n, -2, 2), draw.integers(n, 1, 3)], axis=1)
    return np.concatenate([small_integers(draw, n), axis.astype(np.float64) + 0.0], axis=1)
