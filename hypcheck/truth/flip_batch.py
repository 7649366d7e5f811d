"""How far many rows are from another position: the octave of each by exact decisions of changed float64 rows.

flip.py decides at the corner of the box of relative changes 2^k, which floats do not hold. Here a corner a little
inside of that box and one a little outside are asked instead: a flip at the inner one is a flip at 2^k, and no flip at
the outer one is none at 2^k, since flips are monotone in every change (docs/mathematics.md, "Monotone in every input").
The changes asked for are 2^k (1 ∓ 2⁻⁸); each product is rounded once, by 2⁻⁵³ of itself at most, so that for k ≥ LEAST
every change comes out on its side of 2^k. What lies between the two, one row in a hundred, and what is nearer than
2^LEAST, is left to flip.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.pairs import Position
from hypcheck.rows import Positions, Rows
from hypcheck.truth import batch

LEAST = -44
INNER, OUTER = 1 - 2.0**-8, 1 + 2.0**-8
SMALLEST, LARGEST = 2.0**-90, 2.0**90
"""Lengths that no change brings out of the range in which floats decide."""

TOWARD_EXTERIOR = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
"""Which way α, γ, b, d, x, y, z change: the sizes of the spheroid fall for either clear position, the others turn."""
TOWARD_INTERIOR = np.array([1.0, -1.0, -1.0, -1.0, -1.0, -1.0, 1.0])

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]


def octaves(rows: Rows, positions: Positions) -> Floats:
    """floor(log2) of each row's distance to the nearest other position, (n,); NaN where flip.py has to be asked.

    `positions` are the exact positions of the rows.
    """
    lengths = np.abs(rows)
    within = ((lengths >= SMALLEST) & (lengths <= LARGEST) | (lengths == 0)).all(axis=1)
    found = np.full(len(rows), np.nan)
    places = np.flatnonzero(within)
    places = places[~_flipped(rows[places], positions[places], np.full(len(places), LEAST), OUTER)]
    low: NDArray[np.int64] = np.full(len(places), LEAST)
    high: NDArray[np.int64] = np.zeros(len(places), dtype=np.int64)
    while len(places):
        done = high - low == 1
        found[places[done]] = low[done]
        places, low, high = (each[~done] for each in (places, low, high))
        middle = (low + high) // 2
        nearer = _flipped(rows[places], positions[places], middle, INNER)
        farther = ~nearer
        farther[farther] = ~_flipped(rows[places[farther]], positions[places[farther]], middle[farther], OUTER)
        told = nearer | farther
        high, low = np.where(nearer, middle, high)[told], np.where(farther, middle, low)[told]
        places = places[told]
    return found


def _flipped(rows: Rows, positions: Positions, exponents: NDArray[np.int64], factor: float) -> Mask:
    """Whether changes of 2^exponent · factor bring each row to another position, (n,)."""
    change = np.ldexp(factor, exponents)[:, None]
    clear, side = positions != Position.CONTACT, (positions == Position.INTERIOR)[:, None]
    # A clear row is changed away from where it is, and has flipped once it is there no more.
    away = np.where(side, -TOWARD_INTERIOR, -TOWARD_EXTERIOR)
    flipped = np.zeros(len(rows), dtype=np.bool_)
    flipped[clear] = _changed(rows[clear], away[clear], change[clear]) != positions[clear]
    for toward, position in ((TOWARD_EXTERIOR, Position.EXTERIOR), (TOWARD_INTERIOR, Position.INTERIOR)):
        rest = np.flatnonzero(~clear & ~flipped)
        flipped[rest] = _changed(rows[rest], toward, change[rest]) == position
    return flipped


def _changed(rows: Rows, direction: Floats, change: Floats) -> Positions:
    return batch.positions(rows * (1 + direction * change))
