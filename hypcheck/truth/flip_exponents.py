"""The distance of many rows to the nearest other position, as floor(log2) of the least relative change.

Of upright rows by exact positions of changed float64 rows: positions are monotone in every number (changes.py), so that
one known corner of the box of changes is best. Floats do not hold the corner of the box of relative changes 2^k. So a
corner a little inside of that box and one a little outside are asked: a flip at the inner one is a flip at 2^k, and no
flip at the outer one is none at 2^k, since flips are monotone in every change. The changes asked for are 2^k (1 ∓ 2⁻⁸);
each product is rounded once, by 2⁻⁵³ of itself at most, so that for k ≥ LEAST every change comes out on its side of
2^k. What lies between the two, one row in a hundred, and what is nearer than 2^LEAST, is left to exact numbers.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows
from hypcheck.truth import exact, float_filter
from hypcheck.truth.backward_error import exponent
from hypcheck.truth.nearest_rows import upright_mask

LEAST = -44
INNER, OUTER = 1 - 2.0**-8, 1 + 2.0**-8
SMALLEST, LARGEST = 2.0**-90, 2.0**90
"""Lengths that no change brings out of the range in which floats decide."""

TOWARD_EXTERIOR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Which way α, γ, b, d, x, y, z change: the sizes of the spheroid fall for either clear position, the others turn."""
TOWARD_INTERIOR = np.array([1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 1.0])


def flip_exponents(rows: Rows) -> Floats:
    """floor(log2) of each row's distance to the nearest other position, (n,); −inf for a tangency.

    Of a pair that is not upright that of an estimate: to prove it takes too long.
    """
    octaves = np.full(len(rows), np.nan)
    upright = upright_mask(rows)
    columns = rows[upright, : len(COLUMNS)]
    octaves[upright] = distance_exponents(columns, float_filter.positions(columns))
    for index in np.flatnonzero(np.isnan(octaves)):
        pair = Pair.from_row(rows[index].tolist())
        truth = exact.decide(pair.lengths)
        others = set(Position) - {truth.position} if truth.position is Position.CONTACT else {Position.CONTACT}
        nearest = min(exponent(pair, truth, other) for other in others)
        octaves[index] = math.floor(nearest) if math.isfinite(nearest) else nearest
    return octaves


def distance_exponents(rows: Rows, positions: Positions) -> Floats:
    """flip_exponents of upright rows (n, 7) with these exact positions; NaN where floats cannot tell."""
    lengths = np.abs(rows)
    within = ((lengths >= SMALLEST) & (lengths <= LARGEST) | (lengths == 0)).all(axis=1)
    octaves = np.full(len(rows), np.nan)
    places = np.flatnonzero(within)
    places = places[~_changes_position(rows[places], positions[places], np.full(len(places), LEAST), OUTER)]
    low: NDArray[np.int64] = np.full(len(places), LEAST)
    high: NDArray[np.int64] = np.zeros(len(places), dtype=np.int64)
    while len(places):
        done = high - low == 1
        octaves[places[done]] = low[done]
        places, low, high = places[~done], low[~done], high[~done]
        middle = (low + high) // 2
        nearer = _changes_position(rows[places], positions[places], middle, INNER)
        farther = ~nearer
        farther[farther] = ~_changes_position(rows[places[farther]], positions[places[farther]], middle[farther], OUTER)
        known = nearer | farther
        high, low = np.where(nearer, middle, high)[known], np.where(farther, middle, low)[known]
        places = places[known]
    return octaves


def _changes_position(rows: Rows, positions: Positions, exponents: NDArray[np.int64], factor: float) -> Mask:
    """Whether changes of 2^exponent · factor bring each row to another position, (n,)."""
    change = np.ldexp(factor, exponents)[:, None]
    clear, side = positions != Position.CONTACT, (positions == Position.INTERIOR)[:, None]
    # A clear row is changed away from where it is, and has flipped once it is there no more.
    away = np.where(side, -TOWARD_INTERIOR, -TOWARD_EXTERIOR)
    flipped = np.zeros(len(rows), dtype=np.bool_)
    flipped[clear] = _positions_of_changed(rows[clear], away[clear], change[clear]) != positions[clear]
    for toward, position in ((TOWARD_EXTERIOR, Position.EXTERIOR), (TOWARD_INTERIOR, Position.INTERIOR)):
        rest = np.flatnonzero(~clear & ~flipped)
        flipped[rest] = _positions_of_changed(rows[rest], toward, change[rest]) == position
    return flipped


def _positions_of_changed(rows: Rows, direction: Floats, change: Floats) -> Positions:
    return float_filter.positions(rows * (1 + direction * change))
