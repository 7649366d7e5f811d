"""A whole table classified: read, answered and written a chunk at a time, a long one by several processes.

One process reads the lines and writes the answers, in order; what lies between is done by whoever is free.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from functools import partial

from hypcheck.classification.answers import answers_of_chunk
from hypcheck.processes import in_order, usable_processors
from hypcheck.tables.chunk import Answers, Chunk, Unread
from hypcheck.tables.formats import opened
from hypcheck.tables.route import Route

MOST, ALONE = 4, 64
"""Processes at most, so that memory stays small on any machine, and chunks that are done before they are worth it."""

Advance = Callable[[int, int], object]
"""Told of bytes that were read and of rows that were answered."""


@contextmanager
def _unwatched(_size: int | None) -> Iterator[Advance]:
    yield lambda _bytes, _rows: None


def classify_table(
    route: Route, *, mark: bool, watch: Callable[[int | None], AbstractContextManager[Advance]] = _unwatched
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
        closing(in_order(partial(_answered, sink.render), table.chunks, workers, ALONE)) as done,
    ):
        told = 0
        for data, rows in done:
            sink.add(data)
            advance(reader.taken - told, rows)
            told = reader.taken


def _answered(render: Callable[[Chunk, Answers], bytes], unread: Unread) -> tuple[bytes, int]:
    """What is written of a chunk, and how many rows it has."""
    chunk = unread()
    return render(chunk, answers_of_chunk(chunk)), len(chunk.rows)
