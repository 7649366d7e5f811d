"""A scene with one hyperboloid more, less, or elsewhere: what was prepared is copied and patched, not made anew.

Numbers of hyperboloids are places in the scene: one that is added is the last, behind one that is removed all move up.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.scene_index import ROOM, Bodies, PlaneGrid, cells_of, hashed


def bodies_with(bodies: Bodies, other: Bodies, place: int | None = None) -> Bodies:
    """The columns with those of one other hyperboloid at a place, in the place of what is there; None: at the end."""
    columns = {}
    for part in fields(Bodies):
        column, one = getattr(bodies, part.name), getattr(other, part.name)
        if place is None:
            columns[part.name] = np.concatenate([column, one])
        else:
            columns[part.name] = column.copy()
            columns[part.name][place] = one[0]
    return Bodies(**columns)


def bodies_without(bodies: Bodies, place: int) -> Bodies:
    """The columns without those of one hyperboloid."""
    return Bodies(**{part.name: np.delete(getattr(bodies, part.name), place, axis=0) for part in fields(Bodies)})


def grid_with(grid: PlaneGrid, place: int, x: float, y: float, reach: float) -> PlaneGrid | None:
    """The grid with a hyperboloid of this number at (x, y); None where its table has become too small to be quick."""
    columns, rows, everywhere = cells_of(np.array([x]), np.array([y]), np.array([reach]), grid.side)
    if everywhere:
        return replace(grid, everywhere=sorted([*grid.everywhere, place]))
    size, members = len(grid.starts) - 1, np.frombuffer(grid.members, np.intc)
    if 2 * size < ROOM * (len(members) + len(columns)):
        return None
    places = np.unique(hashed(columns, rows, size))
    starts = np.frombuffer(grid.starts, np.intc)
    more = np.zeros(size + 1, np.intc)
    more[places + 1] = 1
    return replace(
        grid,
        starts=_packed(starts + np.cumsum(more, dtype=np.intc)),
        members=_packed(np.insert(members, starts[places + 1], place)),
    )


def grid_without(grid: PlaneGrid, place: int, *, renumbered: bool) -> PlaneGrid:
    """The grid without a hyperboloid; with `renumbered`, those behind it move up by one."""
    members, starts = np.frombuffer(grid.members, np.intc), np.frombuffer(grid.starts, np.intc)
    gone = np.flatnonzero(members == place)
    fewer = np.searchsorted(gone, starts).astype(np.intc)  # how many are gone before each start
    kept = np.delete(members, gone)
    everywhere: Sequence[int] = [number for number in grid.everywhere if number != place]
    if renumbered:
        kept = kept - (kept > place)
        everywhere = [number - (number > place) for number in everywhere]
    return replace(grid, starts=_packed(starts - fewer), members=_packed(kept), everywhere=list(everywhere))


def _packed(numbers: NDArray[np.intc]) -> array[int]:
    return array("i", numbers.astype(np.intc).tobytes())
