"""The cases an implementation is asked: the frozen vectors of each family, then generated rows, piece by piece."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from hypcheck.casebook import vectors
from hypcheck.casebook.families import FAMILIES, case_id
from hypcheck.casebook.family import BLOCK, Family
from hypcheck.rows import Positions, Rows
from hypcheck.truth import batch

PIECE = 65_536
"""Generated rows at a time, so that memory does not grow with their number."""


@dataclass(frozen=True)
class Piece:
    """Some cases of one family: rows (n, 7), the exact positions, int8 (n,), and the id of each place."""

    family: str
    rows: Rows
    positions: Positions
    name: Callable[[int], str]


def pieces(family: Family, seed: int, count: int) -> Iterator[Piece]:
    """The frozen vectors of a family, with the labels they are certified with; then `count` rows, decided exactly."""
    if family.name in vectors.NAMES:
        frozen = vectors.frozen_rows(family.name)
        yield Piece(family.name, frozen.rows, frozen.positions, frozen.ids.__getitem__)
    for start in range(0, count, PIECE):
        yield _generated(family, seed, start, min(count, start + PIECE))


def found_by_search() -> Iterator[Piece]:
    """The frozen vectors that no family generates: the worst cancellations, which a search has found."""
    for name in vectors.NAMES:
        if name not in FAMILIES:
            frozen = vectors.frozen_rows(name)
            yield Piece(name, frozen.rows, frozen.positions, frozen.ids.__getitem__)


def _generated(family: Family, seed: int, start: int, stop: int) -> Piece:
    blocks = [family.block(seed, number) for number in range(start // BLOCK, -(-stop // BLOCK))]
    rows = np.ascontiguousarray(np.concatenate(blocks)[: stop - start])
    return Piece(family.name, rows, batch.positions(rows), lambda place: case_id(family, seed, start + place))
