"""The neighbours of a way on which an answer is wrong, for local search.

One unknown is multiplied by 1 ± step, or the way is made a special one. Contact on a way is monotone in the spheroid's
size (truth/passage_error.py), so a way is brought to the border of contact by the size: bisection on exact decisions.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import WAYS, Floats, Mask, Rows
from hypcheck.truth.passage_error import hits_at_size
from hypcheck.vectors.draw import Draw

SIZE = (2, 3)
"""The columns of b and d, which are the size together."""

BROUGHT = 3
"""Neighbours that are brought to the border of contact at a time: each takes about 60 exact decisions."""

_MOVES = [
    *((column,) for column in range(4)),
    SIZE,
    (4, 5),  # the start, the end, and both
    (6,),
    (7, 8),
    (9,),
    (4, 5, 7, 8),
    (6, 9),
]
_UNITS = [(0, 2, 4, 5, 7, 8), (1, 3, 6, 9)]
_TILTED_MOVES = [tuple(range(10)), *((column,) for column in range(10, 13)), (10, 11, 12)]


def around_way(row: tuple[float, ...], step: float) -> Rows:
    """The row itself, its neighbours one step away, and special ways beside it."""
    tilted = len(row) == len(WAYS.tilted)
    moves = [*_MOVES, *(_TILTED_MOVES if tilted else _UNITS)]
    rows = np.repeat(np.array([row]), 1 + 2 * len(moves) + 7, axis=0)
    for number, columns in enumerate(moves):
        rows[1 + 2 * number, columns] *= 1 + step
        rows[2 + 2 * number, columns] /= 1 + step
    back, still, vertical, horizontal, waist, throat, groove = rows[-7:]
    back[4:7], back[7:10] = row[7:10], row[4:7]
    still[7:10] = row[4:7]
    vertical[7:9] = row[4:6]
    horizontal[9] = row[6]
    waist[[6, 9]] = 0
    throat[0] = throat[2]
    groove[1] = groove[3] * np.sqrt(groove[0] / groove[2])
    return rows


def size_mask(rows: Rows) -> Mask:
    """The columns of the size, as a mask of the rows."""
    mask = np.zeros(rows.shape, dtype=np.bool_)
    mask[:, SIZE] = True
    return mask


def size_factors(draw: Draw, rows: Rows, reach: float) -> Floats:
    """Of BROUGHT of these ways, the greatest factor of the size without contact, (n,); NaN of all others.

    NaN, too, where contact does not begin at a factor from 1/reach to reach.
    """
    factors = np.full(len(rows), np.nan)
    for place in draw.integers(min(BROUGHT, len(rows)), 0, len(rows) - 1).tolist():
        factors[place] = _border(rows[place].tolist(), reach)
    return factors


def _border(row: list[float], reach: float) -> float:
    if hits_at_size(row, 1 / reach) or not hits_at_size(row, reach):
        return np.nan
    # To halve bit patterns halves the logarithm at first, and the factor itself at the end.
    below, above = np.array([1 / reach, reach]).view(np.int64).tolist()
    while above - below > 1:
        middle = (below + above) // 2
        below, above = (below, middle) if hits_at_size(row, _float_of(middle)) else (middle, above)
    return _float_of(below)


def _float_of(bits: int) -> float:
    return float(np.int64(bits).view(np.float64))
