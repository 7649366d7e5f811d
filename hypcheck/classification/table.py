"""A whole table classified: read, answered and written a chunk at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from hypcheck.classification.answers import answers_of_chunk
from hypcheck.tables.formats import opened
from hypcheck.tables.route import Route

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
    with opened(route, mark=mark) as (reader, table, write), watch(reader.size()) as advance:
        told = 0
        for chunk in table.chunks:
            write(chunk, answers_of_chunk(chunk))
            advance(reader.taken - told, len(chunk.rows))
            told = reader.taken
