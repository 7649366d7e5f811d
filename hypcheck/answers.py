"""A whole table classified: read, answered and written a chunk at a time, a long one by several processes.

Answers about many rows: the same as about each pair alone, without the proofs.

The formats of tables by name, and a table opened for reading beside the one that its answers go to.

A whole table classified: read, answered and written a chunk at a time, a long one by several processes.

One process reads the lines and writes the answers, in order; what lies between is done by whoever is free.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np

from hypcheck.answer import require_agreement
from hypcheck.errors import InputError
from hypcheck.geometry.pair import REFUSED, Pair
from hypcheck.geometry.rows import Rows
from hypcheck.processes import in_order, usable_processors
from hypcheck.tables.chunk import Sink, Table, TableAnswers, TableChunk, Unread
from hypcheck.tables.csv_table import read_csv, write_csv
from hypcheck.tables.jsonl_table import read_jsonl, write_jsonl
from hypcheck.tables.npy_table import read_npy, write_npy
from hypcheck.tables.streams import Reader, Route, Writer, reading, same_file, writing
from hypcheck.truth import exact, float_filter, nearest


def answers(rows: Rows) -> TableAnswers:
    """Position, tangency and clearance of every row (n, 7); float64 (n, 7) in, (n,) each out.

    Raises InputError about the first invalid row, DisagreementError where two oracles contradict each other.
    """
    measured = nearest.clearances(rows)
    # What the filter proves is never a tangency: λ proves a gap, and two points of the spheroid strictly on either side
    # of the hyperboloid prove that it passes through the spheroid's inside.
    positions = float_filter.filtered(rows)
    tangent = np.zeros(len(rows), dtype=np.bool_)
    for index in np.flatnonzero(positions == float_filter.UNDECIDED).tolist():
        decision = exact.decide(Pair.from_row(rows[index].tolist()).lengths)
        positions[index], tangent[index] = decision.position, decision.tangent
    doubtful = (measured.position != positions) | ((measured.clearance == 0) != tangent)
    for index in np.flatnonzero(doubtful).tolist():
        require_agreement(
            tuple(rows[index].tolist()),
            (int(positions[index]), bool(tangent[index])),
            (int(measured.position[index]), float(measured.clearance[index])),
        )
    return TableAnswers(positions, tangent, measured.clearance)


def answers_of_chunk(chunk: TableChunk) -> TableAnswers:
    """The answers about a chunk of a table, 127 for its refused rows. Raises DisagreementError as answers."""
    if not chunk.refused.any():
        return answers(chunk.rows)
    asked = ~chunk.refused
    found = answers(chunk.rows[asked])
    count = len(chunk.rows)
    marked = TableAnswers(
        np.full(count, REFUSED, dtype=np.int8), np.zeros(count, dtype=np.bool_), np.full(count, np.nan)
    )
    marked.positions[asked], marked.tangent[asked] = found.positions, found.tangent
    marked.clearance[asked] = found.clearance
    return marked


class _Read(Protocol):
    def __call__(self, reader: Reader, *, mark: bool) -> Table: ...


class _Open(Protocol):
    def __call__(self, writer: Writer, table: Table, /) -> AbstractContextManager[Sink]: ...


@dataclass(frozen=True, slots=True)
class _Format:
    read: _Read
    write: _Open


_FORMATS = {
    "csv": _Format(read_csv, write_csv),
    "jsonl": _Format(read_jsonl, write_jsonl),
    "npy": _Format(read_npy, write_npy),
}


@contextmanager
def opened(route: Route, *, mark: bool) -> Iterator[tuple[Reader, Table, Sink]]:
    """What is read at one end of `route`, the table in it, and where its answers go at the other.

    The output takes its place when the block ends well; after an error nothing of it is left. Raises InputError where
    either cannot be opened, NothingJudgedError (while its chunks are read) where the table has no rows.
    """
    if same_file(route.source, route.target):
        raise InputError(f"--output {route.target} is the input itself; name another file")
    with reading(route.source) as reader:
        table = _FORMATS[route.source_format].read(reader, mark=mark)
        with writing(route.target) as writer, _FORMATS[route.target_format].write(writer, table) as sink:
            yield reader, table, sink


MOST, ALONE = 4, 64
"""Processes at most, so that memory stays small on any machine, and chunks that are done before they are worth it."""

Advance = Callable[[int, int], object]
"""Told of bytes that were read and of rows that were answered."""


@contextmanager
def _no_progress(_size: int | None) -> Iterator[Advance]:
    yield lambda _bytes, _rows: None


def classify_table(
    route: Route, *, mark: bool, watch: Callable[[int | None], AbstractContextManager[Advance]] = _no_progress
) -> None:
    """Write the answers about every row of the table at `route.source` to `route.target`.

    `watch` is given the bytes to be read (None of a stream), and what it yields is told how far it is.

    A row that is no valid query raises InputError, or with `mark` is marked as refused (127). After any error nothing
    is left at the target but what stood there before. Raises what opened() and answers() raise.
    """
    workers = min(MOST, usable_processors())
    with (
        opened(route, mark=mark) as (reader, table, sink),
        watch(reader.size()) as advance,
        closing(in_order(partial(_answer_chunk, sink.render), table.chunks, workers, ALONE)) as done,
    ):
        told = 0
        for data, rows in done:
            sink.add(data)
            advance(reader.taken - told, rows)
            told = reader.taken


def _answer_chunk(render: Callable[[TableChunk, TableAnswers], bytes], unread: Unread) -> tuple[bytes, int]:
    """What is written of a chunk, and how many rows it has."""
    chunk = unread()
    return render(chunk, answers_of_chunk(chunk)), len(chunk.rows)
