"""The nearest point for arrays of pairs: double-double arithmetic for most, exact enclosures where it cannot tell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.pairs import Pair
from hypcheck.rows import Positions, Rows, require_valid
from hypcheck.truth.nearest_double import Array
from hypcheck.truth.nearest_dual import Squares
from hypcheck.truth.nearest_float import Mask, decide
from hypcheck.truth.nearest_precise import Optimum, Stage, optimise

_CHUNK = 4096  # rows whose intermediate arrays fit in a core's second-level cache


@dataclass(frozen=True, slots=True)
class NearestPositions:
    """For n rows: the positions (n,), whether tangent, bool (n,), and the Stage that decided each, uint8 (n,)."""

    position: Positions
    tangent: Mask
    stage: NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class NearestBatch:
    """For n rows: clearances as in nearest_precise.Nearest (n,), positions (n,), and the Stage of each, uint8 (n,)."""

    clearance: Array
    position: Positions
    stage: NDArray[np.uint8]


def positions(rows: Rows) -> NearestPositions:
    """The positions and tangencies of rows (n, 7). Raises InputError about the first invalid row."""
    batch = _run(rows, clearances_wanted=False)
    return NearestPositions(batch.position, batch.clearance == 0.0, batch.stage)


def clearances(rows: Rows) -> NearestBatch:
    """The clearances and positions of rows (n, 7). Raises InputError about the first invalid row."""
    return _run(rows, clearances_wanted=True)


def _run(rows: Rows, *, clearances_wanted: bool) -> NearestBatch:
    """Chunk by chunk; where only positions are wanted, clearances are right to a factor alone, and 0 where tangent."""
    require_valid(rows)
    batch = NearestBatch(
        np.empty(len(rows)), np.empty(len(rows), np.int8), np.full(len(rows), Stage.DOUBLE_DOUBLE, np.uint8)
    )
    for begin in range(0, len(rows), _CHUNK):
        chunk = slice(begin, begin + _CHUNK)
        decided = decide(rows[chunk])
        batch.clearance[chunk] = decided.clearance
        batch.position[chunk] = decided.position
        certain: Mask = decided.clearance_certain if clearances_wanted else decided.position_certain
        for index in (begin + np.flatnonzero(~certain)).tolist():
            _store(batch, index, optimise(Squares.of(Pair.from_row(rows[index].tolist()))))
    return batch


def _store(batch: NearestBatch, index: int, optimum: Optimum) -> None:
    """Write one row's answer."""
    batch.clearance[index] = optimum.clearance
    batch.position[index] = optimum.position
    batch.stage[index] = optimum.stage
