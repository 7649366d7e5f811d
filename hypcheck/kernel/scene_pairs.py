"""One mover beside one hyperboloid, both in the scene's coordinates: exact positions.

A centre seen from another is x − x₀, which is usually not a float64. Its rounding error is one, and is known (TwoSum):
where it is 0 the difference is exact and the fast path answers.

**The hyperboloid is upright.** With the error e of the difference a spheroid whose semi-axes are ε = |e|/min(b, d)
longer contains the true one, and one with semi-axes that much shorter lies in it. The larger clear is clear, the
smaller in contact is contact; what is left is decided in integers from the exact difference. `positions_beside` does so
for arrays, `position_beside` for one step of a walk.

**The hyperboloid is tilted**, along w, and nothing is rotated: squares and products of its axis, the spheroid's and the
centre's difference are rational, and the position is decided from them (tilted_integers.squares_between_axes). Most
movers are nowhere near: with h and ϱ, the centre's height along w and its distance from the axis, the spheroid lies in
the ball of radius r = max(b, d) and is exterior where ϱ − r > ρ(|h| + r), interior where ϱ + r < ρ(|h| − r), with ρ the
surface's radius. In floats h and ϱ are formed from w/|w| and the centres with six roundings to a term, all on sums of
at most six terms: 64 u Σ|C| bounds what they are wrong by; ρ takes five roundings on positive terms.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import inf, sqrt

import numpy as np

from hypcheck.derivation.float_arithmetic import two_sum
from hypcheck.geometry.pair import UPRIGHT, Position
from hypcheck.geometry.rows import Floats, Indices, Mask, Positions, Rows
from hypcheck.kernel.classify import classify
from hypcheck.kernel.integers import position_of_squares, squares_between_axes
from hypcheck.kernel.scalar import position

Body = tuple[float, float, float, float, float]
"""α, γ, and the centre x, y, z, of a hyperboloid."""

ERROR = 64 * 2.0**-53
"""Of h and ϱ, in units of the sum of all coordinates."""

MARGIN = 2.0**-40
"""Of ρ and of |e|/min(b, d), relative; far more than they need."""

ROUNDED = 2.0**-50
"""More than the roundings of a semi-axis made longer or shorter, relative."""

LEAST, GREATEST = 2.0**-200, 2.0**200
"""Lengths, and coordinates that are not 0, whose squares and quotients neither overflow nor underflow."""


def positions_beside(sizes: Rows, centres: Rows, origins: Rows, movers: Rows | None = None) -> Positions:
    """The exact position of each mover beside an upright hyperboloid, int8 (n,).

    `sizes` are (n, 4), both centres (n, 3) in the scene's coordinates, the movers' axes (n, 3); None: all are upright.
    """
    with np.errstate(all="ignore"):
        offset, error = two_sum(centres, -origins)
    beyond = np.asarray(~np.isfinite(offset).all(axis=1))
    offset[beyond] = 0.0
    place = offset if movers is None else np.concatenate([offset, movers], axis=1)
    result: Positions = classify(np.concatenate([sizes, place], axis=1))
    some = np.flatnonzero(beyond | ~(error == 0).all(axis=1))
    if len(some):
        result[some], unsettled = _between(sizes[some], place[some], np.abs(error[some]).sum(axis=1))
        upright = np.broadcast_to(UPRIGHT, (len(sizes), 3))
        movers = upright if movers is None else movers
        _exactly(some[unsettled], result, sizes, centres, origins, movers, upright)
    return result


def _between(sizes: Rows, place: Rows, lost: Floats) -> tuple[Positions, Mask]:
    """The positions about rounded differences that lost so much, and a mask of those that it leaves open."""
    larger, smaller, fits = larger_and_smaller(sizes[:, 2:], lost)
    outer, inner = (
        classify(np.concatenate([sizes[fits, :2], semi_axes[fits], place[fits]], axis=1))
        for semi_axes in (larger, smaller)
    )
    positions, unsettled = np.zeros(len(sizes), np.int8), ~fits
    positions[fits], unsettled[fits] = outer, (outer == Position.CONTACT) & (inner != Position.CONTACT)
    return positions, unsettled


def larger_and_smaller(semi_axes: Rows, lost: Floats) -> tuple[Floats, Floats, Mask]:
    """The semi-axes (n, 2), longer and shorter by what differences of centres lost, and where both are as they must be.

    That is nowhere where a difference has overflowed: then nobody knows what it lost, which is NaN.
    """
    with np.errstate(all="ignore"):
        stretch = np.where(lost == 0, 0.0, lost / semi_axes.min(axis=1) * (1 + MARGIN) + ROUNDED)
        larger, smaller = semi_axes * (1 + stretch)[:, None], semi_axes * (1 - stretch)[:, None]
    return larger, smaller, np.asarray((smaller > LEAST).all(axis=1) & (larger < GREATEST).all(axis=1))


def position_beside(
    body: Body, b: float, d: float, x: float, y: float, z: float, axis: Sequence[float] | None = None
) -> int:
    """The exact position of a spheroid at (x, y, z): as positions_beside has it, of one pair."""
    alpha, gamma, there_x, there_y, there_z = body
    across, along, up = x - there_x, y - there_y, z - there_z
    # TwoSum: what the differences have lost together; 0 where they are exact, NaN where that is not known.
    back_x, back_y, back_z = across + there_x, along + there_y, up + there_z
    lost = (
        abs((x - back_x) - (there_x - (back_x - across)))
        + abs((y - back_y) - (there_y - (back_y - along)))
        + abs((z - back_z) - (there_z - (back_z - up)))
    )
    if lost == 0:
        return position(alpha, gamma, b, d, across, along, up, axis=axis)
    least = min(b, d)
    if LEAST < least and max(b, d) < GREATEST and lost < GREATEST:
        stretch = lost / least * (1 + MARGIN) + ROUNDED
        outer = position(alpha, gamma, b * (1 + stretch), d * (1 + stretch), across, along, up, axis=axis)
        if outer != Position.CONTACT:
            return outer
        if stretch < 1:
            inner = position(alpha, gamma, b * (1 - stretch), d * (1 - stretch), across, along, up, axis=axis)
            if inner == outer:
                return outer
    origin = (there_x, there_y, there_z)
    return _from_exact_difference((alpha, gamma, b, d), (x, y, z), origin, axis or UPRIGHT, UPRIGHT)


def tilted_positions(sizes: Rows, centres: Rows, origins: Rows, movers: Rows, axes: Rows) -> Positions:
    """The exact position of each mover, int8 (n,): sizes (n, 4), both centres and both axes (n, 3)."""
    tilted = (axes[:, :2] != 0).any(axis=1)
    result = np.empty(len(sizes), np.int8)
    result[~tilted] = positions_beside(*(column[~tilted] for column in (sizes, centres, origins, movers)))
    result[tilted] = _beside_tilted(*(column[tilted] for column in (sizes, centres, origins, movers, axes)))
    return result


def tilted_position(
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
) -> int:
    """As tilted_positions, for one pair."""
    if axis[0] == axis[1] == 0:
        (alpha, gamma, b, d), (x, y, z), (u, v, w) = sizes, centre, origin
        return position_beside((alpha, gamma, u, v, w), b, d, x, y, z, mover)
    position = _by_ball(sizes, centre, origin, axis)
    return _from_exact_difference(sizes, centre, origin, mover, axis) if position is None else int(position)


def _by_ball(
    sizes: Sequence[float], centre: Sequence[float], origin: Sequence[float], axis: Sequence[float]
) -> Position | None:
    """The position beside a tilted hyperboloid, where the spheroid's ball has one; as _beside_tilted."""
    alpha, gamma, b, d = sizes
    height, distance, error = height_and_distance(centre, origin, axis)
    if not (LEAST < min(sizes) and max(sizes) < GREATEST and error < GREATEST):
        return None
    longest = max(b, d) * (1 + MARGIN) + error
    above, below = (abs(height) + longest) / gamma, max(abs(height) - longest, 0.0) / gamma
    if distance - longest > alpha * sqrt(1 + above * above) * (1 + MARGIN):
        return Position.EXTERIOR
    if distance + longest < alpha * sqrt(1 + below * below) * (1 - MARGIN):
        return Position.INTERIOR
    return None


def height_and_distance(
    centre: Sequence[float], origin: Sequence[float], axis: Sequence[float]
) -> tuple[float, float, float]:
    """As along_and_across, of one pair; the bound of the error is inf where it is not known."""
    largest, size = max(map(abs, axis)), sum(map(abs, (*centre, *origin)))
    if not (LEAST < largest < GREATEST and size < GREATEST):
        return 0.0, 0.0, inf
    u, v, w = (part / largest for part in axis)
    norm = sqrt(u * u + v * v + w * w)
    u, v, w = u / norm, v / norm, w / norm
    x, y, z = (there - here for there, here in zip(centre, origin, strict=True))
    across = sqrt((v * z - w * y) ** 2 + (w * x - u * z) ** 2 + (u * y - v * x) ** 2)
    return u * x + v * y + w * z, across, ERROR * size + LEAST


def _from_exact_difference(
    sizes: Sequence[float],
    centre: Sequence[float],
    origin: Sequence[float],
    mover: Sequence[float],
    axis: Sequence[float],
) -> int:
    """As tilted_position, in integers."""
    difference = [Fraction(there) - Fraction(here) for there, here in zip(centre, origin, strict=True)]
    return int(position_of_squares(squares_between_axes(sizes, difference, mover, axis)))


def _exactly(those: Indices, result: Positions, *columns: Rows) -> None:
    """Decide some rows in integers."""
    for index in those.tolist():
        result[index] = _from_exact_difference(*(column[index].tolist() for column in columns))


def _beside_tilted(sizes: Rows, centres: Rows, origins: Rows, movers: Rows, axes: Rows) -> Positions:
    result = np.zeros(len(sizes), np.int8)
    with np.errstate(all="ignore"):
        height, distance, error = along_and_across(centres, origins, axes)
        alpha, gamma = sizes[:, 0], sizes[:, 1]
        longest = sizes[:, 2:].max(axis=1) * (1 + MARGIN) + error
        ordinary = (sizes > LEAST).all(axis=1) & (sizes < GREATEST).all(axis=1)
        above = (np.abs(height) + longest) / gamma
        below = np.maximum(np.abs(height) - longest, 0.0) / gamma
        outside = distance - longest > alpha * np.sqrt(1 + above * above) * (1 + MARGIN)
        inside = distance + longest < alpha * np.sqrt(1 + below * below) * (1 - MARGIN)
    result[outside & ordinary], result[inside & ordinary] = Position.EXTERIOR, Position.INTERIOR
    left = np.flatnonzero(~ordinary | ~(outside | inside))
    _exactly(left, result, sizes, centres, origins, movers, axes)
    return result


def along_and_across(centres: Rows, origins: Rows, axes: Rows) -> tuple[Floats, Floats, Floats]:
    """The centres' heights along the axes and distances from them, and a bound of the error of both; nan: not known."""
    largest = np.abs(axes).max(axis=1, keepdims=True)
    unit = axes / largest
    unit /= np.sqrt((unit * unit).sum(axis=1, keepdims=True))
    offset = centres - origins
    size = (np.abs(centres) + np.abs(origins)).sum(axis=1)
    ordinary = (largest[:, 0] > LEAST) & (largest[:, 0] < GREATEST) & (size < GREATEST)
    along = (unit * offset).sum(axis=1)
    across = np.cross(unit, offset)
    error = np.where(ordinary, ERROR * size + LEAST, np.nan)
    return along, np.sqrt((across * across).sum(axis=1)), error
