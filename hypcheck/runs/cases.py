"""The cases of a conformance run, in chunks: frozen vectors of a family, or a range of its generated rows.

A chunk names its cases, and any process can compute their rows. The result depends neither on the process nor on the
order. Frozen vectors are read once; the processes of a pool get them from their parent process.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.geometry.rows import Positions, Rows
from hypcheck.record.progress import Place
from hypcheck.runs.judge import truth_of
from hypcheck.truth.backward_error import flip_exponents
from hypcheck.vectors import frozen as vectors
from hypcheck.vectors.cases import Vector
from hypcheck.vectors.draw import BLOCK, Family
from hypcheck.vectors.families import FAMILIES, case_id, family_of

_SMALLEST = 1e-300
"""If the distance in a frozen vector is below this number, it is computed again: the float is too inaccurate."""

_MEASURED = frozenset({*vectors.NAMES, *vectors.TILTED_NAMES})
"""The files whose vectors hold distances to other positions."""


@dataclass(frozen=True, slots=True)
class FrozenVectors:
    """The vectors of a family: ids, rows, positions or hits, int8 (n,), and exponents, float64 (n,).

    An exponent is floor(log2) of the distance to the nearest other position; NaN if the vector's float is too small.
    """

    ids: tuple[str, ...]
    rows: Rows
    positions: Positions
    exponents: NDArray[np.float64]


_LOADED: dict[str, FrozenVectors] = {}


def frozen_vectors(name: str) -> FrozenVectors:
    """Return the vectors of a family. Raises InputError if it has none."""
    if name not in _LOADED:
        vectors_of_family = vectors.load(name)
        exponents = np.full(len(vectors_of_family.rows), math.nan)
        if name in _MEASURED:
            upright = name in vectors.NAMES
            exponents = np.array([_exponent(vector, upright=upright) for vector in vectors_of_family.cases])
        _LOADED[name] = FrozenVectors(
            vectors_of_family.ids, vectors_of_family.rows, vectors_of_family.positions, exponents
        )
    return _LOADED[name]


def loaded_vectors() -> dict[str, FrozenVectors]:
    """Return all vectors that this process has read. Another process gets them, because reading a file is slow."""
    return dict(_LOADED)


def keep_loaded(some: Mapping[str, FrozenVectors]) -> None:
    """Use these vectors instead of reading their files."""
    _LOADED.update(some)


def _exponent(vector: Vector, *, upright: bool) -> float:
    """Return the exponent of the distance to the nearest other position; −inf for a tangency.

    Upright distances are rounded up, so the exponent k is that of a distance above 2^k, and at most 2^(k+1); it is NaN
    below _SMALLEST. Tilted distances have two bounds: the exponent is that of the lower one, or of the upper one if the
    lower is 0.
    """
    clear = vector.position is not Position.CONTACT
    ends = [vector.flips[Position.CONTACT]] if clear else list(vector.flips.values())
    least = 0.0 if upright else min(end.lower for end in ends)
    nearest = least or min(end.upper for end in ends)
    if nearest == 0 or math.isinf(nearest):
        return nearest or -math.inf
    if upright and nearest < _SMALLEST:
        return math.nan
    mantissa, exponent = math.frexp(nearest)
    return exponent - (2 if upright and mantissa == 0.5 else 1)


CHUNK_ROWS = 64 * BLOCK
"""The number of generated rows of a chunk: the most rows that one message in binary may have."""


@dataclass(frozen=True, slots=True)
class Pace:
    """The numbers of rows that a run sends at once and repeats in a retest, and how often it writes its progress.

    Generated rows are divided into chunks of `chunk_rows`, a multiple of 64. After `retest_after` rows their pending
    cases are retested, which bounds the number of pending cases: a retest holds all of them in memory, and twice as
    many would cost each process about 8 MB more. The first retest sends up to `single_rows` questions of one row,
    enough to overflow a counter of 8 or 10 bits. It stops sending such questions after `single_s` seconds: few
    implementations need more than one second, and the limit protects those that need many milliseconds for a row. An
    implementation that answers full batches within `soon_s` seconds also gets the longest batches, which then take
    about a second. Progress is written every `progress_s` seconds; a killed run may lose that much. Writing takes at
    most one part in `progress_share` of the time.
    """

    chunk_rows: int = CHUNK_ROWS
    retest_after: int = 64 * CHUNK_ROWS
    single_rows: int = 1100
    single_s: float = 4.0
    soon_s: float = 0.05
    progress_s: float = 10.0
    progress_share: int = 100


PACE = Pace()
"""The pace of a run of the command line."""

EXPONENTS_OF = 2000
"""The number of first cases of a family for which the distance to the nearest other position is recorded."""


FRESH_SEEDS = 1 << 32
"""The least seed of fresh rows. Other seeds are smaller, so a fresh row never has the place of another row
(place())."""


@dataclass(frozen=True, slots=True)
class CaseChunk:
    """Cases `start` to `stop` − 1 of a family: generated rows of a seed, or frozen vectors if `seed` is None.

    For the first `measured` cases the distance to the nearest other position is recorded.
    """

    family: str
    seed: int | None
    start: int
    stop: int
    measured: int = 0

    def __len__(self) -> int:
        return self.stop - self.start

    def between(self, first: int, last: int) -> CaseChunk:
        """Return the cases `first` to `last` − 1 of this chunk as a chunk."""
        measured = min(max(self.measured - first, 0), last - first)
        return CaseChunk(self.family, self.seed, self.start + first, self.start + last, measured)

    @property
    def movement(self) -> int:
        """The number of consecutive cases that follow one object from moment to moment; 1 if cases are independent."""
        return 1 if self.seed is None else family_of(self.family).movement

    def part(self, chunk_rows: int = CHUNK_ROWS) -> int:
        """Return the part (0, 1 or 2) of a retest that tests its cases again.

        It is 0 for the first chunk of a family and for frozen vectors, then 1 and 2 in turn.
        """
        number = 0 if self.seed is None else self.start // chunk_rows
        return 1 + number % 2 if number else 0

    def place(self, index: int) -> Place:
        """Return the place of a case in the family: its group and its number there.

        The groups are 0 for frozen vectors, 1 for rows of the run's own seed, and 2 for fresh rows.
        """
        return 0 if self.seed is None else 1 + (self.seed >= FRESH_SEEDS), self.start + index

    def name(self, index: int) -> str:
        """Return the id of a case."""
        if self.seed is None:
            return frozen_vectors(self.family).ids[self.start + index]
        return case_id(family_of(self.family), self.seed, self.start + index)

    def find(self, name: str) -> int | None:
        """Return the index of the case with that id, or None."""
        if self.seed is None:
            ids = frozen_vectors(self.family).ids[self.start : self.stop]
            return ids.index(name) if name in ids else None
        stem, _, number = name.rpartition("/")
        if stem != self.name(0).rpartition("/")[0] or not number.isdecimal():
            return None
        return int(number) - self.start if self.start <= int(number) < self.stop else None


@dataclass(frozen=True)
class ChunkCases:
    """The cases of a chunk: rows (n, k), the same numbers as columns (k, n), and exact positions or hits, int8 (n,)."""

    chunk: CaseChunk
    rows: Rows
    columns: NDArray[np.float64]
    positions: Positions

    @property
    def by_column(self) -> Rows:
        """The rows with each column contiguous in memory, which is faster for work on columns."""
        return self.columns.T


def family_chunks(family: Family, seed: int, count: int, chunk_rows: int = CHUNK_ROWS) -> Iterator[CaseChunk]:
    """Yield the chunks of a family's frozen vectors, then of the `count` generated rows that follow the frozen ones."""
    measured = EXPONENTS_OF
    known = frozen_count(family.name)
    if known:
        yield CaseChunk(family.name, None, 0, known, min(known, measured))
        measured = max(0, measured - known)
    for start, stop in _generated_chunks(first_unfrozen(family, seed), count, chunk_rows):
        yield CaseChunk(family.name, seed, start, stop, min(measured, stop - start))
        measured = 0


def fresh_chunks(family: Family, seed: int, count: int, chunk_rows: int = CHUNK_ROWS) -> Iterator[CaseChunk]:
    """Yield the chunks of `count` rows of a seed that was not known before the run; none of them is a frozen vector."""
    first = first_unfrozen(family, seed) if seed < FRESH_SEEDS else 0
    for start, stop in _generated_chunks(first, count, chunk_rows):
        yield CaseChunk(family.name, seed, start, stop)


def _generated_chunks(start: int, count: int, chunk_rows: int) -> Iterator[tuple[int, int]]:
    """Divide `count` rows from `start` on into chunks; yield the first row of each and the one after its last."""
    stop = start + count
    while start < stop:
        end = min(stop, (start // chunk_rows + 1) * chunk_rows)
        yield start, end
        start = end


def frozen_count(name: str) -> int:
    """Return the number of frozen vectors of a family."""
    return vectors.count_of(name) if name in vectors.ALL_NAMES else 0


def searched_chunks() -> Iterator[CaseChunk]:
    """Yield the frozen vectors that no family generates: the worst cancellations, which a search found."""
    for name in vectors.NAMES:
        if name not in FAMILIES:
            known = frozen_count(name)
            yield CaseChunk(name, None, 0, known, min(known, EXPONENTS_OF))


def cases_of_chunk(chunk: CaseChunk) -> ChunkCases:
    """Return the rows of a chunk with their truths: stored ones of frozen vectors, exact decisions about other rows."""
    if chunk.seed is None:
        known, part = frozen_vectors(chunk.family), slice(chunk.start, chunk.stop)
        return ChunkCases(chunk, known.rows[part], np.ascontiguousarray(known.rows[part].T), known.positions[part])
    family = family_of(chunk.family)
    columns = family.columns_between(chunk.seed, chunk.start, chunk.stop)
    return ChunkCases(chunk, np.ascontiguousarray(columns.T), columns, truth_of(columns.T, family.layout))


@lru_cache
def first_unfrozen(family: Family, seed: int) -> int:
    """Return the number of rows at the start of a seed's sequence that are frozen vectors."""
    if not frozen_count(family.name):
        return 0
    known = {row.tobytes() for row in frozen_vectors(family.name).rows}
    start = 0
    while all(row.tobytes() in known for row in family.block(seed, start // BLOCK)):
        start += BLOCK
    return start + next(
        place for place, row in enumerate(family.block(seed, start // BLOCK)) if row.tobytes() not in known
    )


def flip_exponents_of(made: ChunkCases, indices: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return floor(log2) of the distance to the nearest other position for the first of these cases.

    `indices` are ascending; the first of them, below `measured` of the chunk, have such a distance. Frozen vectors hold
    their distance. It is not recorded for sweeps. It is not recorded for generated rows of tilted spheroids either,
    because its proof would take longer than the rest of the run.
    """
    chunk, measured = made.chunk, indices[indices < made.chunk.measured]
    frozen = chunk.seed is None and chunk.family in _MEASURED
    if not len(measured) or not (frozen or len(made.columns) == len(COLUMNS)):
        return np.empty(0)
    if chunk.seed is not None:
        return flip_exponents(made.rows[measured])
    flips = frozen_vectors(chunk.family).exponents[chunk.start + measured]
    unknown = np.flatnonzero(np.isnan(flips))
    if len(unknown):  # none of tilted spheroids
        flips[unknown] = flip_exponents(made.rows[measured[unknown]])
    return flips
