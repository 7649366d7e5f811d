"""What passes between a table's reader, the one who answers, and its writer: a few thousand rows at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from hypcheck.pairs import REFUSED, Position
from hypcheck.rows import Positions, Rows

CHUNK = 8192
"""Rows at a time: memory stays flat, and the work on a chunk in the cache."""

LABELS = {int(position): position.label for position in Position} | {REFUSED: "refused"}


@dataclass(frozen=True, slots=True)
class Chunk:
    """Rows of a table, float64 (n, 7), and the text of each without its line end (None where the table has no text).

    `refused`, bool (n,), marks rows that are no valid query, whatever numbers stand in them; all False unless marking
    was asked for.
    """

    rows: Rows
    refused: NDArray[np.bool_]
    texts: list[str] | None


Unread: TypeAlias = Callable[[], Chunk]
"""A chunk whose values are still to be read, here or in another process. Raises InputError about a row."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table to be read: its chunks, and for text its header (None where it has none) and the end of its lines."""

    chunks: Iterator[Unread]
    header: str | None = None
    line_end: str = "\n"


@dataclass(frozen=True, slots=True)
class Answers:
    """The answers about a chunk, (n,) each: exact positions int8 (127 marks a refused row), tangency, and clearance.

    Clearance is in spheroid radii; it and tangency mean nothing in a refused row.
    """

    positions: Positions
    tangent: NDArray[np.bool_]
    clearance: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Sink:
    """What a table's writer offers while its block lasts.

    `render` makes bytes of a chunk and its answers, here or in another process; `add` writes them. Raises InputError.
    """

    render: Callable[[Chunk, Answers], bytes]
    add: Callable[[bytes], object]
