"""Ways that touch exactly: through a place where the surfaces touch, across a ring, and from or to a tangency.

What is said to touch does so exactly: places come from the constructions of tangencies and rings, and both ends of a
way are checked to be without rounding.
"""

from __future__ import annotations

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.truth.passage_error import hits_at_size
from hypcheck.vectors import double_roots
from hypcheck.vectors.double_roots import gather, in_metres
from hypcheck.vectors.draw import Draw, in_turn, ldexp, turns
from hypcheck.vectors.tangency import tangent
from hypcheck.vectors.tilted import coincidences

CENTRE = slice(4, 7)
"""The columns of the centre, or of the first end of a way."""


def between(rows: Rows, ends: Rows) -> Rows:
    """The ways from the centres of rows (n, 7 or 10) to those of `ends`, (n, 3): (n, 10 or 13), no negative zeros."""
    return np.concatenate([rows[:, :7], ends, rows[:, 7:]], axis=1) + 0.0


def through(rows: Rows, steps: Rows, after: Floats) -> tuple[Rows, Mask]:
    """Ways through the centres of rows, a step before and `after` steps behind, and which have exact ends."""
    centres, ways = rows[:, CENTRE], rows.copy()
    (start, lost), (end, missed) = two_sum(centres, -steps), two_sum(centres, steps * after[:, None])
    ways[:, CENTRE] = start
    moved = (start != end).any(axis=1)
    return between(ways, end), np.asarray((lost == 0).all(axis=1) & (missed == 0).all(axis=1) & moved)


def _exterior_graze(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Through an outer tangency along the surface's horizontal section, which bends away."""
    found = double_roots.by_ratios(draw, n)
    rows = in_metres(draw, np.where(found.usable[:, None], found.rows, 1.0))
    share = ldexp(draw.signs(n), draw.integers(n, -6, 2))
    steps = np.stack([-rows[:, 5] * share, rows[:, 4] * share, np.zeros(n)], axis=1)
    ways, exact = through(rows, steps, turns(n, 1.0, 3.0, 0.5))
    return ways, exact & found.usable & found.outer & found.tangent


def _interior_graze(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Up or down through an inner tangency at the waist, which is the narrowest place."""
    rows = gather(draw, n, double_roots.waist_points)
    rows = in_metres(draw, rows)
    radius = np.sqrt(rows[:, 4] ** 2 + rows[:, 5] ** 2)
    steps = np.zeros((n, 3))
    steps[:, 2] = rows[:, 1] * ldexp(draw.signs(n), draw.integers(n, -6, 3))
    ways, exact = through(rows, steps, turns(n, 1.0, 3.0, 0.5))
    return ways, exact & (radius < rows[:, 0])


def grazing(draw: Draw, n: int) -> Rows:
    """Exact tangency at one instant, clear before and after, outside and inside."""
    return in_turn(
        lambda own, some: gather(own, some, _exterior_graze), lambda own, some: gather(own, some, _interior_graze)
    )(draw, n)


def near_graze(draw: Draw, n: int) -> Rows:
    """The same, the spheroid larger or smaller by 2⁻⁵⁰ to 2⁻³."""
    rows = grazing(draw, n)
    factor = 1 + ldexp(draw.signs(n), -3 - draw.places(n) % 48)
    rows[:, 2] *= factor
    rows[:, 3] *= factor
    return rows


def ring_attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Ways across rings, and which of them have exact ends; some begin in contact, where the ring is near."""
    rows, usable = double_roots.waist_roots(draw, n, ring=True)
    rows = in_metres(draw, np.where(usable[:, None], rows, 1.0))
    share = ldexp(np.ones(n), draw.integers(n, -30, -5))
    pick = draw.integers(n, 0, 3)
    zero = np.zeros(n)
    x, y = rows[:, 4], rows[:, 5]
    steps = np.select(
        [(pick == each)[:, None] for each in range(4)],
        [
            np.stack([x * share, y * share, zero], axis=1),
            np.stack([zero, zero, rows[:, 3] * share], axis=1),
            np.stack([-y * share, x * share, zero], axis=1),
            np.stack([x * share, y * share, rows[:, 3] * share], axis=1),
        ],
    )
    ways, exact = through(rows, steps, turns(n, 1.0, 2.0))
    return ways, exact & usable


def ring(draw: Draw, n: int) -> Rows:
    """Across the ring, where the discriminant is 0 in free air, along, up and out.

    A ring may be so near to the surface that a way across it begins in contact. Others take the places of such ways.
    """
    ways = gather(draw, n, ring_attempt)
    near = np.flatnonzero(~more_than_a_radius_away(ways))
    touching = [place for place in near.tolist() if hits_at_size(ways[place].tolist())]
    ways[touching] = gather(draw, len(touching), _clear_ring_attempt)
    return ways


def _clear_ring_attempt(draw: Draw, n: int) -> tuple[Rows, Mask]:
    ways, usable = ring_attempt(draw, n)
    return ways, usable & more_than_a_radius_away(ways)


def more_than_a_radius_away(ways: Rows) -> Mask:
    """Ways about a ring that are clear all along, as the waist shows.

    In radii, a centre in the plane of the waist between the waist and the ring is r − a away from the surface, and one
    that is z above it is farther than r − a − z. The margin is far more than what r is rounded by.
    """
    alpha, _, b, d = ways[:, :4].T
    x, y, end_x, end_y = ways[:, [4, 5, 7, 8]].T
    step_x, step_y = end_x - x, end_y - y
    passing = (x * step_x + y * step_y < 0) & (end_x * step_x + end_y * step_y > 0)
    with np.errstate(invalid="ignore"):  # a way that leads nowhere does not pass
        foot = np.abs(x * step_y - y * step_x) / np.sqrt(step_x**2 + step_y**2)
    nearest = np.where(passing, foot, np.sqrt(np.minimum(x**2 + y**2, end_x**2 + end_y**2))) / b
    rise = np.abs(ways[:, [6, 9]]).max(axis=1) / d
    return np.asarray(nearest * (1 - 2.0**-40) - alpha / b - rise > 1)


def at_an_end(draw: Draw, n: int) -> Rows:
    """Contact at t = 1 alone, or at t = 0 alone: a tangency at an end, the other end away from the surface."""
    rows = tangent(draw, n)
    alpha, z = rows[:, 0], rows[:, 6]
    outside = (rows[:, 4] ** 2 + rows[:, 5] ** 2) / alpha**2 > 1 + (z / rows[:, 1]) ** 2
    factor = np.where(outside, draw.between(n, 1.25, 4), draw.between(n, -0.5, 0.75))
    away = np.stack([rows[:, 4] * factor, rows[:, 5] * factor, z], axis=1)
    away[:, 2] = np.where(outside, z * draw.unit(n), z * draw.between(n, 1, 4))
    ways = between(rows, away)
    backward = turns(n, False, True)
    ways[backward, 4:7], ways[backward, 7:10] = away[backward] + 0.0, rows[backward, CENTRE]
    return ways


def ring_place(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """Places on the ring at the waist, and which of them are usable."""
    rows, usable = double_roots.waist_roots(draw, n, ring=True)
    return in_metres(draw, np.where(usable[:, None], rows, 1.0)), usable


def tilted_end(draw: Draw, n: int) -> Rows:
    """A tangency at t = 0 or at t = 1, the other end twice as far from the origin, or half as far."""
    rows = coincidences.tangent(draw, n)
    ways = between(rows, rows[:, CENTRE] * turns(n, 2.0, 0.5)[:, None])
    backward = turns(n, False, False, True, True)
    ways[backward, 4:7], ways[backward, 7:10] = ways[backward, 7:10], ways[backward, 4:7]
    return ways


def tilted_ring(draw: Draw, n: int) -> Rows:
    """Across the ring of a spheroid that leans, or through a neighbour of it."""
    rows = coincidences.ring(draw, n)
    steps = rows[:, 2:3] * ldexp(draw.signs(n), draw.integers(n, -30, -9))[:, None] * _directions(draw, n)
    return through(rows, steps, np.ones(n))[0]


def _directions(draw: Draw, n: int) -> Rows:
    return np.stack([draw.integers(n, -1, 1) for _ in range(3)], axis=1).astype(np.float64)
