"""A chunk of a table: its rows and their answers, the names of its columns, and where an invalid value stands.

Chunks of some thousand rows pass from a table's reader to the process that answers and on to the writer. Readers check
a chunk as a whole; if that fails, `read_values` reads it value by value and names the one that is wrong.
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
from hypcheck.geometry.pair import AXIS, COLUMNS, REFUSED, TILTED_COLUMNS, UPRIGHT, Position, trouble_with_row
from hypcheck.geometry.rows import Positions, Rows
from hypcheck.tables.numbers import shown

ADDED = ("position", "label", "tangent", "clearance")
_MOST_COMPARED = 200
_ALSO_CALLED = {"α": "alpha", "γ": "gamma", "x0": "x", "y0": "y", "z0": "z", "xc": "x", "yc": "y", "zc": "z"}


def check_names(names: Sequence[str], where: str, noun: str = "column") -> None:
    """Raise InputError, beginning with `where`, unless each column is there once (columns_of), and no added one.

    Other names are allowed and passed through; none but the empty one may stand twice.
    """
    double = first_double([name for name in names if name])
    if double is not None:
        raise InputError(f"{where}: {noun} {double}")
    for name in ADDED:
        if name in names:
            raise InputError(
                f"{where}: {noun} {name!r} has the name of a {noun} that the output adds; rename or remove it"
            )
    missing = [name for name in columns_of(names) if name not in names]
    if missing:
        nouns = noun if len(missing) == 1 else f"{noun}s"
        verb = "is" if len(missing) == 1 else "are"
        raise InputError(f"{where}: {nouns} {', '.join(missing)} {verb} missing; {_advice(names, missing)}")


def columns_of(names: Iterable[str]) -> tuple[str, ...]:
    """The columns that a table of these names must have: ten if an axis is among them, else seven."""
    return TILTED_COLUMNS if any(name.casefold() in AXIS for name in names) else COLUMNS


def first_double(names: Sequence[str]) -> str | None:
    """The end of a sentence about the first name that stands more than once; None if there is none."""
    for name, count in Counter(names).items():
        if count > 1:
            return f"{shown(name)} stands {'twice' if count == 2 else f'{count} times'}; it must stand once"
    return None


def _advice(names: Sequence[str], missing: Sequence[str]) -> str:
    """What would be right: the nearest name, if one is near."""
    others = [name for name in names if name not in TILTED_COLUMNS][:_MOST_COMPARED]
    for wanted in missing:
        for name in others:
            if _ALSO_CALLED.get(name.casefold(), name.casefold()) == wanted:
                return f"{shown(name)} must be written {wanted}"
        near = get_close_matches(wanted, others, n=1)
        if near:
            return f"{shown(near[0])} must be written {wanted}, if that is what it means"
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        return "columns are separated by commas"
    if set(missing) <= set(AXIS):
        return f"an axis needs {', '.join(AXIS)}, in any order"
    return f"it needs {', '.join(COLUMNS)}, in any order"


CHUNK = 8192
"""Rows at a time: memory stays flat, and a chunk fits into the cache."""

LABELS = {int(position): position.label for position in Position} | {REFUSED: "refused"}


@dataclass(frozen=True, slots=True)
class TableChunk:
    """Some rows of a table.

    rows: float64 (n, 7), or (n, 10) where a row has an axis; the numbers of a refused row mean nothing.
    refused: bool (n,), the rows that are no valid query; all False unless marking was asked for.
    texts: the text of each row without its line end; None if the table is no text.
    """

    rows: Rows
    refused: NDArray[np.bool_]
    texts: list[str] | None


UnreadChunk: TypeAlias = Callable[[], TableChunk]
"""Reads the values of a chunk when it is called, here or in another process. Raises InputError about a row."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table to be read.

    header, line_end: of CSV, as it was written.
    columns: the seven or ten that are read; of JSON lines, which may have either, seven.
    """

    chunks: Iterator[UnreadChunk]
    header: str | None = None
    line_end: str = "\n"
    columns: tuple[str, ...] = COLUMNS


@dataclass(frozen=True, slots=True)
class TableAnswers:
    """The answers about a chunk, (n,) each.

    positions: exact, int8; 127 marks a refused row, in which the other two mean nothing.
    tangent: whether the surfaces touch without crossing.
    clearance: in spheroid radii.
    """

    positions: Positions
    tangent: NDArray[np.bool_]
    clearance: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Sink:
    """A table that is being written.

    render: makes bytes of a chunk and its answers, here or in another process.
    add: writes these bytes. Raises InputError.
    """

    render: Callable[[TableChunk, TableAnswers], bytes]
    add: Callable[[bytes], object]


Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class RowPlaces:
    """The places of a chunk's rows: the file, how many rows stand before them, and the line of each, from 1."""

    name: str
    rows_before: int
    lines: Sequence[int]

    def of(self, index: int) -> str:
        """The place of a row of the chunk, as a message names it."""
        return f"{self.name}, row {self.rows_before + index + 1} (line {self.lines[index]})"


def read_values(
    values: Iterable[Sequence[Value]],
    number_of: Callable[[str, Value], float],
    places: RowPlaces,
    *,
    mark: bool,
) -> tuple[Rows, NDArray[np.bool_]]:
    """The rows of these values, seven or ten each, and which of them are refused, (n,).

    Where one has ten, the rows are (n, 10), and those of seven upright. `number_of(column, value)` raises ValueError
    with the end of a sentence about a value that is wrong. Without `mark` the first such row raises InputError; with it
    the row is refused, and NaN stands in it.
    """
    rows: list[list[float]] = []
    refused: list[bool] = []
    for index, row in enumerate(values):
        try:
            rows.append(_numbers(row, number_of))
            refused.append(False)
        except ValueError as trouble:  # noqa: PERF203 - each row has its own
            if not mark:
                raise InputError(f"{places.of(index)}: {trouble}") from None
            rows.append([math.nan] * len(row))
            refused.append(True)
    width = max(map(len, rows), default=len(COLUMNS))
    wide = [row if len(row) == width else [*row, *UPRIGHT] for row in rows]
    return np.array(wide, dtype=np.float64).reshape(len(wide), width), np.array(refused, dtype=np.bool_)


def _numbers(values: Sequence[Value], number_of: Callable[[str, Value], float]) -> list[float]:
    """The row of seven or ten values. Raises ValueError as `number_of`."""
    row = [number_of(name, value) for name, value in zip(TILTED_COLUMNS, values, strict=False)]
    trouble = trouble_with_row(row)
    if trouble is not None:
        raise ValueError(trouble)
    return row
