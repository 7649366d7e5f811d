"""A chunk of a table: the names of its columns, its rows and their answers, and where a value is invalid.

The names of a table's columns: the seven that are read, the four that are added, and what is wrong with a header.

What passes between a table's reader, the one who answers, and its writer: a few thousand rows at a time.

The slow and thorough reading of a chunk's values, for when the fast one found something amiss.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, REFUSED, Position
from hypcheck.geometry.rows import Positions, Rows
from hypcheck.tables.numbers import shown

ADDED = ("position", "label", "tangent", "clearance")
_MOST_COMPARED = 200
_ALSO_CALLED = {"α": "alpha", "γ": "gamma", "x0": "x", "y0": "y", "z0": "z", "xc": "x", "yc": "y", "zc": "z"}


def check_names(names: Sequence[str], where: str, noun: str = "column") -> None:
    """Raise InputError, beginning with `where`, unless the seven columns are there, once, and none of the added ones.

    Other names are allowed and passed through, as long as none but the empty one stands twice.
    """
    double = first_double([name for name in names if name])
    if double is not None:
        raise InputError(f"{where}: {noun} {double}")
    for name in ADDED:
        if name in names:
            raise InputError(f"{where}: {noun} {name!r} is there already and would be added; rename or remove it")
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        nouns = noun if len(missing) == 1 else f"{noun}s"
        verb = "is" if len(missing) == 1 else "are"
        raise InputError(f"{where}: {nouns} {', '.join(missing)} {verb} missing; {_advice(names, missing)}")


def first_double(names: Sequence[str]) -> str | None:
    """The end of a sentence about the first name that stands more than once, or None."""
    for name, count in Counter(names).items():
        if count > 1:
            return f"{shown(name)} stands {'twice' if count == 2 else f'{count} times'}; it must stand once"
    return None


def _advice(names: Sequence[str], missing: Sequence[str]) -> str:
    """What would be right, with the name that was meant where one is near."""
    others = [name for name in names if name not in COLUMNS][:_MOST_COMPARED]
    for wanted in missing:
        for name in others:
            if _ALSO_CALLED.get(name.casefold(), name.casefold()) == wanted:
                return f"{shown(name)} must be written {wanted}"
        near = get_close_matches(wanted, others, n=1)
        if near:
            return f"{shown(near[0])} must be written {wanted}, if that is what it means"
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        return "columns are separated by commas"
    return f"it needs {', '.join(COLUMNS)}, in any order"


CHUNK = 8192
"""Rows at a time: memory stays flat, and the work on a chunk in the cache."""

LABELS = {int(position): position.label for position in Position} | {REFUSED: "refused"}


@dataclass(frozen=True, slots=True)
class TableChunk:
    """Rows of a table, float64 (n, 7), and the text of each without its line end (None where the table has no text).

    `refused`, bool (n,), marks rows that are no valid query, whatever numbers stand in them; all False unless marking
    was asked for.
    """

    rows: Rows
    refused: NDArray[np.bool_]
    texts: list[str] | None


Unread: TypeAlias = Callable[[], TableChunk]
"""A chunk whose values are still to be read, here or in another process. Raises InputError about a row."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table to be read: its chunks, and for text its header (None where it has none) and the end of its lines."""

    chunks: Iterator[Unread]
    header: str | None = None
    line_end: str = "\n"


@dataclass(frozen=True, slots=True)
class TableAnswers:
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

    render: Callable[[TableChunk, TableAnswers], bytes]
    add: Callable[[bytes], object]


Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class RowPlaces:
    """Where the rows of a chunk stand: in which file, after how many rows, on which of its lines (from 1)."""

    name: str
    rows_before: int
    lines: Sequence[int]

    def of(self, index: int) -> str:
        """How a message names a row of the chunk."""
        return f"{self.name}, row {self.rows_before + index + 1} (line {self.lines[index]})"


def examine(
    values: Iterable[Sequence[Value]],
    number_of: Callable[[str, Value], float],
    places: RowPlaces,
    *,
    mark: bool,
) -> tuple[Rows, NDArray[np.bool_]]:
    """The rows (n, 7), and which of them are refused, (n,).

    `number_of(column, value)` raises ValueError with the end of a sentence that begins with the row's place. Without
    `mark` the first such row raises InputError; with it the row becomes NaN and is refused.
    """
    rows: list[list[float]] = []
    refused: list[bool] = []
    for index, row in enumerate(values):
        try:
            rows.append([number_of(name, value) for name, value in zip(COLUMNS, row, strict=True)])
            refused.append(False)
        except ValueError as trouble:  # noqa: PERF203 - each row has its own
            if not mark:
                raise InputError(f"{places.of(index)}: {trouble}") from None
            rows.append([math.nan] * len(COLUMNS))
            refused.append(True)
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(COLUMNS)), np.array(refused, dtype=np.bool_)
