"""A grid over the plane, each cell with the hyperboloids that can be touched from within it.

What reaches over too many cells, or has no end, is kept aside and always asked: one tower among many trees.
"""

from __future__ import annotations

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


@dataclass(frozen=True)
class Grid:
    """`cells` maps a cell (two numbers in one key) to the start and end of its part of `members`.

    `everywhere` are the hyperboloids that every centre is asked about.
    """

    side: float
    cells: dict[int, tuple[int, int]]
    members: list[int]
    everywhere: list[int]

    def near(self, x: float, y: float) -> list[int]:
        """The hyperboloids that a mover with its centre at (x, y) can touch."""
        part = self.cells.get(_key(floor(x / self.side), floor(y / self.side)))
        if part is None:
            return self.everywhere
        inside = self.members[part[0] : part[1]]
        return self.everywhere + inside if self.everywhere else inside


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
    keys, members = _entries(low_x, high_x, low_y, high_y, np.flatnonzero(few))
    order = np.lexsort((members, keys))
    keys, members = keys[order], members[order]
    names, starts = np.unique(keys, return_index=True)
    ends = np.append(starts[1:], len(keys))[: len(starts)]  # where nobody is in a cell, there is no end either
    cells = dict(zip(names.tolist(), zip(starts.tolist(), ends.tolist(), strict=True), strict=True))
    return Grid(side, cells, members.tolist(), np.flatnonzero(~few).tolist())


def _entries(low_x: Floats, high_x: Floats, low_y: Floats, high_y: Floats, chosen: Indices) -> tuple[Indices, Indices]:
    """A key and a hyperboloid for each cell that one of the chosen stands in."""
    across = (high_x - low_x)[chosen].astype(np.int64) + 1
    along = (high_y - low_y)[chosen].astype(np.int64) + 1
    counts = across * along
    member = np.repeat(chosen, counts)
    place = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    wide = np.repeat(across, counts)
    column = np.repeat(low_x[chosen].astype(np.int64), counts) + place % wide
    row = np.repeat(low_y[chosen].astype(np.int64), counts) + place // wide
    return (column << 32) + row, member


def _key(column: int, row: int) -> int:
    return (column << 32) + row
