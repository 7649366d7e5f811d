"""Sweeps beside hyperboloids that end: rows of sixteen numbers, with the traps of a rim, an opening or a flat end.

Each sweep goes through the centre of a row of ended.py, ends at it, or begins there. Rows about touches are whole
numbers times one power of two, and so are the ends of their sweeps.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Rows
from hypcheck.vectors import ended
from hypcheck.vectors.draw import Draw, Maker, in_turn, turns
from hypcheck.vectors.sweeps import CENTRE, between


def _through(draw: Draw, rows: Rows, step: Rows) -> Rows:
    """Sweeps through the centres of rows; a centre can be anywhere on its sweep."""
    share, centre = draw.between(len(rows), 0, 1)[:, None], rows[:, CENTRE]
    return between(rows, centre + (1 - share) * step, centre - share * step)


def _any_step(draw: Draw, rows: Rows) -> Rows:
    """Steps in every direction, 2⁻³ to 2⁴ times as long as the spheroid's size."""
    n, length = len(rows), draw.log_uniform(len(rows), -3, 4)
    parts = [rows[:, column] * length * draw.between(n, -1, 1) for column in (2, 2, 3)]
    return np.stack(parts, axis=1)


def _around(rows: Rows) -> Rows:
    """Horizontal directions at right angles to that of the axis: along the rim."""
    return np.stack([-rows[:, 5], rows[:, 4], np.zeros(len(rows))], axis=1)


def uniform(rows_of: Maker) -> Maker:
    """Both ends anywhere about the end of a hyperboloid of any regime."""

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        return between(rows, rows[:, CENTRE] + _any_step(draw, rows))

    return make


def over(rows_of: Maker) -> Maker:
    """Sweeps through a place near a rim, 2⁻⁵⁰ to 2⁻³ radii off contact: along the rim, across it, or anywhere."""

    def make(draw: Draw, n: int) -> Rows:
        rows = rows_of(draw, n)
        length = draw.signs(n) * draw.log_uniform(n, -3, 3)
        radial = np.stack([rows[:, 4], rows[:, 5], np.zeros(n)], axis=1)
        reach = np.sqrt(rows[:, 4] * rows[:, 4] + rows[:, 5] * rows[:, 5])
        distance = np.maximum(reach, rows[:, 2] * 2.0**-40)
        direction = np.where(turns(n, True, False)[:, None], _around(rows), radial)
        level = direction * (rows[:, 2] * length / distance)[:, None]
        return _through(draw, rows, np.where(turns(n, True, True, False)[:, None], level, _any_step(draw, rows)))

    return make


def landing(rows_of: Maker) -> Maker:
    """Straight down, or up from below, to a place that is nearly in contact with a rim, a flat end or an opening.

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


CHANGED = (*range(10), 13, 14, 15)
"""The columns that one_number_changed changes: an upright axis does not."""


def one_number_changed(draw: Draw, n: int) -> Rows:
    """As in random_pairs, of sweeps to a place nearly in contact with a rim, or with a flat end or an opening."""
    pairs = in_turn(landing(ended.rim()), landing(ended.disc()))(draw, -(-n // (2 * len(CHANGED))))
    return ended.with_one_number_changed(draw, pairs, CHANGED, n)


def opening(draw: Draw, n: int) -> Rows:
    """Sweeps out through an opening or in, without contact if the body is open."""
    rows = ended.opening(draw, n)
    step = _any_step(draw, rows) * draw.log_uniform(n, -8, 0)[:, None]
    step[:, 2] = rows[:, 3] * draw.signs(n) * draw.log_uniform(n, -1, 3)
    return _through(draw, rows, step)


def thin(draw: Draw, n: int) -> Rows:
    """Sweeps through a place near contact with a surface of which only a thin slab exists."""
    rows = ended.thin()(draw, n)
    return _through(draw, rows, _any_step(draw, rows))


def touch(draw: Draw, n: int) -> Rows:
    """Sweeps through an exact touch of a rim: along the rim, away from it, or upwards; or sweeps that end there."""
    rows = ended.rim_tangent(draw, n)
    away = np.where(turns(n, True, False)[:, None], [[0.0, 0.0, 1.0]], rows[:, CENTRE] * [1, 1, 0])
    step = np.where(turns(n, True, True, False)[:, None], _around(rows), away)
    step = step * np.where(turns(n, False, False, True), rows[:, 3], 1.0)[:, None]
    centre, back = rows[:, CENTRE], np.where(turns(n, 1.0, 1.0, 1.0, 0.0), 1.0, 0.0)[:, None]
    return between(rows, centre + step, centre - step * back)


FAMILIES: dict[str, tuple[Maker, int]] = {
    "ended-way-uniform": (uniform(ended.uniform()), 16),
    "ended-way-over": (over(ended.rim()), 20),
    "ended-way-landing": (landing(ended.rim()), 16),
    "ended-way-disc": (landing(ended.disc()), 16),
    "ended-way-opening": (opening, 16),
    "ended-way-thin": (thin, 12),
    "ended-way-touch": (touch, 20),
    "ended-way-one-number-changed": (one_number_changed, 0),
}
TILTED: dict[str, tuple[Maker, int]] = {
    "tilted-ended-way-uniform": (uniform(ended.TILTED["tilted-ended-uniform"][0]), 12),
    "tilted-ended-way-over": (over(ended.TILTED["tilted-ended-rim"][0]), 12),
}
"""The generators by the names of their families, upright and tilted, each with how many rows are frozen."""
