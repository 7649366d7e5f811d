"""Traps of several columns in one row: of axis, heights and sweep, coordinates nearly zero, the ends of the domain.

The other modules have the traps of each group beside ordinary values of the others. A program may be right for all of
these and wrong where two of them meet, such as an axis that is not normalised beside an end, or a sweep of length 0
there. The makers here take rows of the other modules and give them what these lack.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import SWEEPS, Floats, Mask, Rows, with_axis, within
from hypcheck.vectors import crossed, ended, extremes, sweeps, tilted
from hypcheck.vectors.double_roots import gathered
from hypcheck.vectors.draw import Draw, Maker, in_turn, turns
from hypcheck.vectors.random_pairs import Sizes, all_regimes, beside_surface, heights, offsets, sizes, stack
from hypcheck.vectors.tilted import Vectors, anywhere

_START, _END = 6, 9
"""The columns of z, of a pair or the start of a sweep, and of a sweep's end."""


def _beside_ends(rows: Rows, level: Floats, draw: Draw) -> Rows:
    """The rows, with an axis, beside hyperboloids of which one end is within one and a half radii of the level.

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


def ended_pairs(rows_of: Maker) -> Maker:
    """Pairs beside an end that is near the height of the centre."""

    def make(draw: Draw, n: int) -> Rows:
        rows = with_axis(rows_of(draw, n))
        return _beside_ends(rows, rows[:, _START], draw)

    return make


def ended_sweeps(rows_of: Maker) -> Maker:
    """Sweeps beside an end that is near the height of the start, of the middle or of the end of the sweep."""

    def make(draw: Draw, n: int) -> Rows:
        rows = with_axis(rows_of(draw, n), SWEEPS)
        share = draw.integers(n, 0, 2) / 2
        return _beside_ends(rows, rows[:, _START] + share * (rows[:, _END] - rows[:, _START]), draw)

    return make


def _in_the_domain(draw: Draw, n: int) -> tuple[Rows, Mask]:
    """As extremes.whole_domain, of tilted spheroids."""
    upright = extremes.whole_domain(draw, n)
    size = Sizes(*upright[:, :4].T)
    hair = draw.signs(n) * (1 + draw.signs(n) * draw.log_uniform(n, -40, -3))
    offset = np.where(turns(n, True, False), offsets(draw, n), hair)
    rows = tilted.beside(draw, size, upright[:, _START] / size.gamma, anywhere(draw, n), offset)
    return rows, within(rows)


tilted_domain = gathered(_in_the_domain)
"""Ratios and sizes of tilted spheroids log-uniform over the ordinary ranges."""


def _nearly_along(draw: Draw, n: int) -> Vectors:
    """Axes of length 1 to 3 that are horizontal, or differ by 2⁻⁶⁰ to 1 from the horizontal or the vertical."""
    cosine, sine = draw.circle(n)
    little, flat = draw.log_uniform(n, -60, 0), turns(n, True, True, False)
    across = np.where(flat, 1.0, little) * draw.integers(n, 1, 3)
    up = np.where(flat, np.where(turns(n, True, False), 0.0, little), 1.0) * draw.signs(n)
    return across * cosine, across * sine, up


def _little(draw: Draw, n: int) -> Floats:
    """Shares from 2⁻¹⁰⁰⁰ to 2⁻²⁰ of either sign, half of them above 2⁻⁶⁰, as rounding errors of an angle are."""
    deep = draw.signs(n) > 0
    return draw.signs(n) * np.where(deep, draw.log_uniform(n, -1000, -60), draw.log_uniform(n, -60, -20))


NEARLY_ZERO = ("x", "y", "z", "xz", "yz", "xy")


def nearly_zero(draw: Draw, n: int) -> Rows:
    """Pairs of which one or two coordinates, those of NEARLY_ZERO in turn, are nearly zero beside the sizes."""
    x_is, y_is, z_is = (turns(n, *(axis in axes for axes in NEARLY_ZERO)) for axis in "xyz")
    a, c = all_regimes(draw, n)
    a = np.where(x_is & y_is, 1 + draw.signs(n) * draw.log_uniform(n, -20, -1), a)
    size = sizes(draw, a, c)
    hair = draw.signs(n) * (1 + draw.signs(n) * draw.log_uniform(n, -40, -3))
    offset = np.where(draw.signs(n) > 0, offsets(draw, n), hair)
    radius, height = beside_surface(size.a, size.c, np.where(z_is, 0.0, heights(draw, size.c)), offset)
    cosine, sine = draw.circle(n)
    x = np.where(x_is, _little(draw, n), radius * np.where(y_is, draw.signs(n), cosine))
    y = np.where(y_is, _little(draw, n), radius * np.where(x_is, draw.signs(n), sine))
    z = np.where(z_is, _little(draw, n), height * draw.signs(n))
    return stack(size, size.b * x, size.b * y, size.d * z)


def tilted_nearly_zero(draw: Draw, n: int) -> Rows:
    """The same places, with axes in every direction."""
    return np.concatenate([nearly_zero(draw, n), np.stack(anywhere(draw, n), axis=1)], axis=1) + 0.0


TILTS = (tilted.slight, tilted.any_length, tilted.spheres, tilted.upright, tilted.stiff, tilted_domain)
"""Traps of the axis, and of sizes, as rows of ten numbers."""

ended_domain = ended_pairs(extremes.whole_domain)
ended_nearly_zero, tilted_ended_nearly_zero = ended_pairs(nearly_zero), ended_pairs(tilted_nearly_zero)
ended_tilts = in_turn(*map(ended_pairs, TILTS), ended.rim(_nearly_along), ended.disc(_nearly_along))
ended_coincidences = ended_pairs(crossed.crossed("tilted-coincidences"))

sweep_domain = sweeps.beside_rows(extremes.whole_domain)
sweep_nearly_zero = sweeps.beside_rows(nearly_zero)
sweep_tilts = in_turn(*map(sweeps.beside_rows, TILTS))

ended_lengths = in_turn(*map(ended_sweeps, (sweeps.still, sweeps.very_short, sweeps.very_long, sweep_domain)))
ended_sweep_coincidences = ended_sweeps(crossed.crossed("way-coincidences"))
ended_sweep_tilts = ended_sweeps(sweep_tilts)
ended_tilted_sweep_coincidences = ended_sweeps(crossed.crossed("tilted-way-coincidences"))
