"""Bringing rows to the border of contact, where wrong answers are small, and leaving it by steps of known size.

The position is monotone in every input (docs/mathematics.md, "Monotone in every input"), so along a factor on one
length, or on x and y together, it changes twice at most, and a change is found by bisection on exact positions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.draw import Draw, Floats, Integers, ldexp, stepped
from hypcheck.rows import Positions, Rows
from hypcheck.truth import batch

Mask = NDArray[np.bool_]

MOVERS: dict[str, tuple[int, ...]] = {
    "radius": (4, 5),
    "height": (6,),
    "alpha": (0,),
    "gamma": (1,),
    "b": (2,),
    "d": (3,),
}
"""What can be multiplied by one factor to reach the border, with its columns: the unknowns of a pair."""

REACH = 2.0**12
"""Factors from 1/REACH to REACH are looked at."""

OCTAVES = 46
"""Rows are put up to 2^(OCTAVES − 1) ulp of the factor away from the border."""

RUNGS = 4 ** np.arange(OCTAVES // 2, dtype=np.int64)
"""The rungs of a ladder, in ulp of the factor."""


def columns_of(movers: NDArray[np.str_]) -> Mask:
    """The columns that the named movers multiply, as a mask (n, 7)."""
    mask = np.zeros((len(movers), 7), dtype=np.bool_)
    for name, columns in MOVERS.items():
        mask[np.ix_(movers == name, columns)] = True
    return mask


def moved(rows: Rows, mask: Mask, factor: Floats) -> Rows:
    """The rows with the masked columns multiplied by each row's factor; what is beyond float64 becomes infinite."""
    with np.errstate(all="ignore"):
        return np.where(mask, rows * factor[:, None], rows)


def border_factors(rows: Rows, mask: Mask, far: Mask) -> Floats:
    """The factor just before the position changes, (n,); NaN where it does not change within REACH.

    Of two changes the one at the greater factor is taken where `far` says so.
    """
    low, high = np.full(len(rows), 1 / REACH), np.full(len(rows), REACH)
    at_low, at_high = _positions(moved(rows, mask, low)), _positions(moved(rows, mask, high))
    changes = (at_low != at_high) & (at_low != UNUSABLE) & (at_high != UNUSABLE)
    rows, mask, far = rows[changes], mask[changes], far[changes]
    at_low, at_high = at_low[changes], at_high[changes]
    # Halving bit patterns is halving the logarithm at first and the factor itself at the end.
    below, above = low[changes].view(np.int64), high[changes].view(np.int64)
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        position = _positions(moved(rows, mask, middle.view(np.float64)))
        before = np.where(far, position != at_high, position == at_low)
        below, above = np.where(before, middle, below), np.where(before, above, middle)
    factors = np.full(len(changes), np.nan)
    factors[changes] = below.view(np.float64)
    return factors


UNUSABLE = 3


def _positions(rows: Rows) -> Positions:
    """Exact positions, and UNUSABLE where a length left the range of float64."""
    usable = np.isfinite(rows).all(axis=1) & (rows[:, :4] > 0).all(axis=1)
    found = np.full(len(rows), UNUSABLE, dtype=np.int8)
    found[usable] = batch.positions(rows[usable])
    return found


def beside_border(draw: Draw, rows: Rows, movers: NDArray[np.str_]) -> Rows:
    """Each row brought to a border by its mover and off again by a random rung; rows without a border are left out."""
    mask = columns_of(movers)
    factors = border_factors(rows, mask, draw.signs(len(rows)) > 0)
    rungs = ldexp(draw.signs(len(rows)), draw.integers(len(rows), 0, OCTAVES - 1)).astype(np.int64)
    found = np.isfinite(factors)
    return moved(rows[found], mask[found], stepped(factors[found], rungs[found]))


def ladders(rows: Rows, mask: Mask, factors: Floats) -> tuple[Rows, Integers]:
    """All rungs of every row that has a border, and the number of the ladder that each belongs to.

    Ladder 2i leads outwards from the border of row i, ladder 2i + 1 inwards; rungs follow each other away from it.
    """
    owners = np.repeat(np.flatnonzero(np.isfinite(factors)), 2 * len(RUNGS))
    steps = np.tile(np.concatenate([RUNGS, -RUNGS]), len(owners) // (2 * len(RUNGS)))
    side = np.arange(len(owners)) // len(RUNGS) % 2
    return moved(rows[owners], mask[owners], stepped(factors[owners], steps)), 2 * owners + side
