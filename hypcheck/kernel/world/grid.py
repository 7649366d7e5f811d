"""A grid over the plane, each cell with the hyperboloids that can be touched from within it.

Cells share the places of a table by a hash (Teschner et al. 2003, "Optimized spatial hashing for collision detection"):
what falls into a place from elsewhere is asked in vain, and nothing is left out. What reaches over too many cells, or
has no end, is kept aside and always asked: one tower among many trees.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from math import floor

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

MOST_CELLS = 64
"""Cells that one hyperboloid may stand in; above that it is asked always."""

WIDEST = 2**30
"""Cells are numbered from −WIDEST to WIDEST on either axis; what is farther out is asked always."""

ROOM = 2
"""Places of the table for each entry, at least."""

ACROSS, ALONG = 73856093, 19349663
"""The primes of the hash; a cell's number times one of them is below 2^57."""


@dataclass(frozen=True)
class Grid:
    """Place p of the table holds the `members` from `starts[p]` up to `starts[p + 1]`; its size is a power of two.

    `everywhere` are the hyperboloids that every centre is asked about.
    """

    side: float
    starts: array[int]
    members: array[int]
    everywhere: list[int]

    def near(self, x: float, y: float) -> Sequence[int]:
        """The hyperboloids that a mover with its centre at (x, y) can touch, and perhaps others."""
        across, along = x / self.side, y / self.side
        if not (-WIDEST < across < WIDEST and -WIDEST < along < WIDEST):
            return self.everywhere
        place = (floor(across) * ACROSS ^ floor(along) * ALONG) & (len(self.starts) - 2)
        inside = self.members[self.starts[place] : self.starts[place + 1]]
        return [*self.everywhere, *inside] if self.everywhere else inside

    def near_each(self, x: Floats, y: Floats) -> tuple[Indices, Indices]:
        """The same of many centres (n,): pairs of a centre's number and a hyperboloid's, centre by centre."""
        with np.errstate(over="ignore"):
            cells = np.floor(np.stack([x, y]) / self.side)
        inside = (np.abs(cells) < WIDEST).all(axis=0)
        column, row = np.where(inside, cells, 0.0).astype(np.int64)
        place = _hashed(column, row, len(self.starts) - 1)
        starts = np.frombuffer(self.starts, np.intc).astype(np.int64)
        first, counts = starts[place], np.where(inside, starts[place + 1] - starts[place], 0)
        query = np.repeat(np.arange(len(x)), counts)
        step = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        member = np.frombuffer(self.members, np.intc).astype(np.int64)[np.repeat(first, counts) + step]
        always = np.tile(np.array(self.everywhere, np.int64), len(x))
        return (
            np.concatenate([query, np.repeat(np.arange(len(x)), len(self.everywhere))]),
            np.concatenate([member, always]),
        )


def grid_of(x: Floats, y: Floats, reaches: Floats) -> Grid:
    """The grid of hyperboloids at (x, y) with these reaches, (m,) each; its cells are as wide as most reach."""
    finite = np.isfinite(reaches)
    side = float(2 * np.median(reaches[finite])) if finite.any() else 1.0
    with np.errstate(all="ignore"):
        low_x, high_x, low_y, high_y = (
            np.floor((centre + sign * reaches) / side) for centre in (x, y) for sign in (-1.0, 1.0)
        )
        few = (high_x - low_x + 1) * (high_y - low_y + 1) <= MOST_CELLS
        few &= (np.abs(np.stack([low_x, high_x, low_y, high_y])) < WIDEST).all(axis=0)
    columns, rows, members = _entries(low_x, high_x, low_y, high_y, np.flatnonzero(few))
    size = 1 << (ROOM * len(members)).bit_length()
    places = _hashed(columns, rows, size)
    order = np.lexsort((members, places))
    places, members = places[order], members[order]
    again = np.append(False, (np.diff(places) == 0) & (np.diff(members) == 0))[: len(places)]
    places, members = places[~again], members[~again]
    starts = np.searchsorted(places, np.arange(size + 1))
    return Grid(side, _packed(starts), _packed(members), np.flatnonzero(~few).tolist())


def _entries(
    low_x: Floats, high_x: Floats, low_y: Floats, high_y: Floats, chosen: Indices
) -> tuple[Indices, Indices, Indices]:
    """Column, row and hyperboloid for each cell that one of the chosen stands in."""
    across = (high_x - low_x)[chosen].astype(np.int64) + 1
    along = (high_y - low_y)[chosen].astype(np.int64) + 1
    counts = across * along
    place = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    wide = np.repeat(across, counts)
    column = np.repeat(low_x[chosen].astype(np.int64), counts) + place % wide
    row = np.repeat(low_y[chosen].astype(np.int64), counts) + place // wide
    return column, row, np.repeat(chosen, counts)


def _hashed(column: Indices, row: Indices, size: int) -> Indices:
    return np.asarray((column * ACROSS ^ row * ALONG) & (size - 1))


def _packed(numbers: Indices) -> array[int]:
    """The numbers as an array that Python indexes without making numpy's scalars of them."""
    return array("i", numbers.astype(np.intc).tobytes())
