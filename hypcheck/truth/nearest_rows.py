"""The nearest-point oracle for many rows: in double-double arithmetic if this can decide, else exactly.

upright_distances.py answers upright rows, distances.py other rows; nearest.py answers the rows that error bounds leave
undecided, pair by pair. Both round the clearance to the same float64.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Pair
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows, require_valid, upright_mask
from hypcheck.truth import distances, upright_distances
from hypcheck.truth.nearest import NearestStage, nearest

_CHUNK = 4096
"""Rows whose intermediate arrays fit in a core's second-level cache."""


@dataclass(frozen=True, slots=True)
class NearestBatch:
    """For n rows: clearances as in NearestPoint (n,), positions (n,), and the NearestStage of each, uint8 (n,)."""

    clearance: Floats
    position: Positions
    stage: NDArray[np.uint8]

    @property
    def tangent(self) -> Mask:
        """A mask (n,) of the tangent pairs."""
        return np.asarray(self.clearance == 0.0)


def positions(rows: Rows) -> NearestBatch:
    """The positions and tangencies of rows (n, 7) or (n, 10). Raises InputError about the first invalid row.

    Clearances are only right within a factor, and 0 if tangent.
    """
    return _run(rows, clearances_wanted=False)


def clearances(rows: Rows) -> NearestBatch:
    """The clearances and positions of rows (n, 7) or (n, 10). Raises InputError about the first invalid row."""
    return _run(rows, clearances_wanted=True)


def _run(rows: Rows, *, clearances_wanted: bool) -> NearestBatch:
    require_valid(rows)
    count = len(rows)
    batch = NearestBatch(
        np.empty(count), np.empty(count, np.int8), np.full(count, NearestStage.DOUBLE_DOUBLE, np.uint8)
    )
    upright = upright_mask(rows)
    for places, decide, width in (
        (np.flatnonzero(upright), upright_distances.decide, len(COLUMNS)),
        (np.flatnonzero(~upright), distances.decide, rows.shape[1]),
    ):
        for begin in range(0, len(places), _CHUNK):
            chunk = places[begin : begin + _CHUNK]
            decided = decide(rows[chunk, :width])
            batch.clearance[chunk], batch.position[chunk] = decided.clearance, decided.position
            certain = decided.clearance_certain if clearances_wanted else decided.position_certain
            for index in chunk[~certain].tolist():
                result = nearest(Pair.from_row(rows[index].tolist()))
                batch.clearance[index], batch.position[index] = result.clearance, result.position
                batch.stage[index] = result.stage
    return batch
