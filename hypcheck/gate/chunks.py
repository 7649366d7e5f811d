"""What an implementation is asked, cut into chunks: frozen vectors of a family, or a stretch of its generated rows.

A chunk is a name for cases that can be made anywhere; who asks them, and in which order, makes no difference.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.casebook import fixed_sizes, vectors
from hypcheck.casebook.families import FAMILIES, case_id
from hypcheck.casebook.family import BLOCK, Family
from hypcheck.gate.frozen import frozen
from hypcheck.rows import Positions, Rows
from hypcheck.tally import Place
from hypcheck.truth import batch

SIZE = 64 * BLOCK
"""Generated rows of a chunk: as many as a question in binary may have."""

OCTAVES_OF = 2000
"""Cases of a family whose own distance to the nearest other position is recorded: the first ones."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """Cases `start` to `stop` − 1 of a family: generated rows of a seed, or frozen vectors, where `seed` is None.

    Of the first `measured` of them the distance to the nearest other position is recorded.
    """

    family: str
    seed: int | None
    start: int
    stop: int
    measured: int = 0

    def __len__(self) -> int:
        return self.stop - self.start

    def between(self, first: int, last: int) -> Chunk:
        """Its cases `first` to `last` − 1 as a chunk of their own."""
        measured = min(max(self.measured - first, 0), last - first)
        return Chunk(self.family, self.seed, self.start + first, self.start + last, measured)

    @property
    def movement(self) -> int:
        """So many consecutive cases follow one object from moment to moment; 1 where none do."""
        return 1 if self.seed is None else _family(self.family).movement

    @property
    def part(self) -> int:
        """In which part of a round its cases are asked again: 0 at the beginning of a family, then 1 and 2 in turn."""
        number = 0 if self.seed is None else self.start // SIZE
        return 1 + number % 2 if number else 0

    def place(self, index: int) -> Place:
        """Where its case stands in the family."""
        return int(self.seed is not None), self.start + index

    def name(self, index: int) -> str:
        """The id of its case."""
        if self.seed is None:
            return frozen(self.family).ids[self.start + index]
        return case_id(_family(self.family), self.seed, self.start + index)

    def find(self, name: str) -> int | None:
        """Which of its cases has that id; None where none has."""
        if self.seed is None:
            ids = frozen(self.family).ids[self.start : self.stop]
            return ids.index(name) if name in ids else None
        stem, _, number = name.rpartition("/")
        if stem != self.name(0).rpartition("/")[0] or not number.isdecimal():
            return None
        return int(number) - self.start if self.start <= int(number) < self.stop else None


@dataclass(frozen=True)
class Cases:
    """The cases of a chunk: rows (n, 7), the same column by column (7, n), and the exact positions, int8 (n,)."""

    chunk: Chunk
    rows: Rows
    columns: NDArray[np.float64]
    positions: Positions

    @property
    def by_column(self) -> Rows:
        """The rows, each column of which lies in memory as a whole: what works on columns is faster with it."""
        return self.columns.T


def chunks(family: Family, seed: int, count: int) -> Iterator[Chunk]:
    """The frozen vectors of a family, then `count` generated rows, beginning after those that were frozen."""
    measured = OCTAVES_OF
    known = frozen_cases(family.name)
    if known:
        yield Chunk(family.name, None, 0, known, min(known, measured))
        measured = max(0, measured - known)
    start = first_unfrozen(family, seed)
    stop = start + count
    while start < stop:
        end = min(stop, (start // SIZE + 1) * SIZE)
        yield Chunk(family.name, seed, start, end, min(measured, end - start))
        start, measured = end, 0


def frozen_cases(name: str) -> int:
    """How many vectors of a family are frozen."""
    return len(frozen(name).rows) if name in vectors.NAMES else 0


def found_by_search() -> Iterator[Chunk]:
    """The frozen vectors that no family generates: the worst cancellations, which a search has found."""
    for name in vectors.NAMES:
        if name not in FAMILIES:
            known = len(frozen(name).rows)
            yield Chunk(name, None, 0, known, min(known, OCTAVES_OF))


def cases(chunk: Chunk) -> Cases:
    """Its rows with the positions that they are certified with, or that are decided here."""
    return cases_of((chunk,))[0]


def cases_of(some: Iterable[Chunk]) -> tuple[Cases, ...]:
    """The cases of each of these chunks; decided together, which takes less time where each has few."""
    made = [(chunk, _columns(chunk)) for chunk in some]
    drawn = [columns for chunk, columns in made if chunk.seed is not None]
    decided = batch.positions(np.concatenate(drawn, axis=1).T if len(drawn) > 1 else drawn[0].T) if drawn else None
    found, start = [], 0
    for chunk, columns in made:
        if chunk.seed is None or decided is None:
            known, part = frozen(chunk.family), slice(chunk.start, chunk.stop)
            found.append(Cases(chunk, known.rows[part], columns, known.positions[part]))
        else:
            stop = start + len(chunk)
            found.append(Cases(chunk, np.ascontiguousarray(columns.T), columns, decided[start:stop]))
            start = stop
    return tuple(found)


def _columns(chunk: Chunk) -> NDArray[np.float64]:
    if chunk.seed is None:
        return np.ascontiguousarray(frozen(chunk.family).rows[chunk.start : chunk.stop].T)
    return _family(chunk.family).columns_between(chunk.seed, chunk.start, chunk.stop)


@lru_cache
def first_unfrozen(family: Family, seed: int) -> int:
    """How many rows a seed begins with that are all among the frozen vectors."""
    if family.name not in vectors.NAMES:
        return 0
    known = {row.tobytes() for row in frozen(family.name).rows}
    start = 0
    while all(row.tobytes() in known for row in family.block(seed, start // BLOCK)):
        start += BLOCK
    return start + next(
        place for place, row in enumerate(family.block(seed, start // BLOCK)) if row.tobytes() not in known
    )


def octaves(made: Cases, indices: NDArray[np.intp]) -> NDArray[np.float64]:
    """floor(log2) of the distance to the nearest other position, of those of the (ascending) indices it is recorded of.

    A frozen vector says it itself.
    """
    chunk, measured = made.chunk, indices[indices < made.chunk.measured]
    if not len(measured):
        return np.empty(0)
    if chunk.seed is not None:
        return judge.flip_octaves(made.rows[measured])
    flips = frozen(chunk.family).octaves[chunk.start + measured]
    unknown = np.flatnonzero(np.isnan(flips))
    flips[unknown] = judge.flip_octaves(made.rows[measured[unknown]])
    return flips


@lru_cache
def _family(name: str) -> Family:
    return fixed_sizes.family_at(name) if fixed_sizes.MARK in name else FAMILIES[name]
