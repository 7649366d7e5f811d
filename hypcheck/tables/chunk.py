"""A chunk of a table: its rows and their answers, the names of its columns, and the place of an invalid value.

Chunks of some thousand rows pass from a table's reader to the process that answers and on to the writer. Readers check
a chunk as a whole; if that fails, `read_values` reads it value by value and names the one that is wrong.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from itertools import chain, repeat
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry import pair
from hypcheck.geometry.rows import PAIRS, SWEEPS, Floats, Layout, Positions, Rows, invalid
from hypcheck.tables.numbers import shown

ADDED = ("position", "label", "tangent", "clearance")
WITH_MARGIN = "position_with_margin"
ADDED_TO_SWEEPS = ("hit", "label", "first_lower", "first_upper")
"""The names of the columns that are added to a table of pairs, and to one of sweeps."""

_GIVEN = frozenset((*pair.COLUMNS, *pair.END, *pair.AXIS, *pair.HEIGHTS))
_MOST_COMPARED = 200
_ALSO_CALLED = {"α": "alpha", "γ": "gamma", "x0": "x", "y0": "y", "z0": "z", "xc": "x", "yc": "y", "zc": "z"}


def check_names(names: Sequence[str], where: str, noun: str = "column") -> None:
    """Raise InputError if a column of `columns_of` is missing, or a name is duplicate or that of an added column.

    Other names are allowed, and only the empty one may occur twice. The message begins with `where`, and calls a name
    `noun`.
    """
    double = first_double([name for name in names if name])
    if double is not None:
        raise InputError(f"{where}: duplicate {noun} {shown(double)}")
    columns = columns_of(names)
    for name in added_to(columns):
        if name in names:
            raise InputError(
                f"{where}: {noun} {name!r} has the name of a {noun} that the output adds; rename or remove it"
            )
    missing = [name for name in columns if name not in names]
    if missing:
        nouns = noun if len(missing) == 1 else f"{noun}s"
        verb = "is" if len(missing) == 1 else "are"
        raise InputError(f"{where}: {nouns} {', '.join(missing)} {verb} missing; {_advice(names, missing)}")


def columns_of(names: Iterable[str]) -> tuple[str, ...]:
    """Return the columns that a table with these names must have: seven, and all of an end or axis if one is present.

    The columns of heights are those that are present: a missing one means no end, or an open end.
    """
    folded = {name.casefold() for name in names}
    heights = tuple(name for name in pair.HEIGHTS if name in folded)
    return (
        pair.COLUMNS
        + (pair.END if folded & set(pair.END) else ())
        + (pair.AXIS if folded & set(pair.AXIS) else ())
        + heights
    )


def layout_of(columns: Sequence[str]) -> Layout:
    """Return the layout of rows of these columns."""
    return SWEEPS if pair.END[0] in columns else PAIRS


def valid_rows(numbers: Floats, columns: Sequence[str], layout: Layout) -> Rows | None:
    """Make rows of numbers that follow each other row by row, in these columns; None unless all rows are valid.

    Rows with heights get all columns of such rows; missing ones are filled in.
    """
    rows = _in_layout(numbers.reshape(-1, len(columns)), columns, layout)
    return None if not np.isfinite(numbers).all() or invalid(rows, layout).any() else rows


def _in_layout(numbers: Rows, columns: Sequence[str], layout: Layout) -> Rows:
    """Give rows with heights all columns of such rows, with defaults for missing ones; leave other rows alone."""
    if frozenset(pair.HEIGHTS).isdisjoint(columns):
        return numbers
    base = len(layout.upright)
    rows = np.empty((len(numbers), len(layout.ended)))
    rows[:, :base] = numbers[:, :base]
    for place, (name, otherwise) in enumerate(
        zip((*pair.AXIS, *pair.HEIGHTS), (*pair.UPRIGHT, *pair.WITHOUT_ENDS), strict=True)
    ):
        rows[:, base + place] = numbers[:, columns.index(name)] if name in columns else otherwise
    return rows


def added_to(columns: Sequence[str]) -> tuple[str, ...]:
    """Return the names of all columns that may be added to rows of these columns; the table must not have them."""
    return ADDED_TO_SWEEPS if pair.END[0] in columns else (*ADDED, WITH_MARGIN)


def first_double(names: Sequence[str]) -> str | None:
    """Return the first name that occurs more than once; None if there is none."""
    for name, count in Counter(names).items():
        if count > 1:
            return name
    return None


def _advice(names: Sequence[str], missing: Sequence[str]) -> str:
    """Give advice about missing columns, for a message: the name that is probably meant, or what is needed."""
    others = [name for name in names if name not in _GIVEN][:_MOST_COMPARED]
    for wanted in missing:
        for name in others:
            if _ALSO_CALLED.get(name.casefold(), name.casefold()) == wanted:
                return f"{shown(name)} must be written {wanted}"
        near = get_close_matches(wanted, others, n=1)
        if near:
            return f"{shown(near[0])} must be written {wanted}, if that is what it means"
    if len(names) == 1 and any(mark in names[0] for mark in ";\t"):
        return "columns are separated by commas"
    if set(missing) <= set(pair.AXIS):
        return f"an axis needs {', '.join(pair.AXIS)}, in any order"
    if set(missing) <= set(pair.HEIGHTS):
        return f"heights are written {', '.join(pair.HEIGHTS)}"
    if set(missing) <= set(pair.END):
        return f"the end of a sweep needs {', '.join(pair.END)}, in any order"
    return f"it needs {', '.join(pair.COLUMNS)}, in any order"


CHUNK = 8192
"""The number of rows of a chunk, at most: memory stays flat, and a chunk fits into the cache."""

LABELS = {int(position): position.label for position in pair.Position} | {pair.REFUSED: "refused"}


@dataclass(frozen=True, slots=True)
class TableChunk:
    """Some rows of a table.

    rows: float64 in the columns of the layout; all have an axis if one row has one. The numbers of a refused row mean
    nothing.
    refused: bool (n,), the rows that are no valid query; all False unless invalid rows are to be marked.
    texts: the text of each row without its line end; None if the table is not text.
    layout: SWEEPS where rows have an end.
    """

    rows: Rows
    refused: NDArray[np.bool_]
    texts: list[str] | None
    layout: Layout = PAIRS


UnreadChunk: TypeAlias = Callable[[], TableChunk]
"""A function that reads the values of a chunk when it is called, in any process. Raises InputError about a row."""


@dataclass(frozen=True, slots=True)
class Table:
    """A table to be read.

    chunks: the parts of the table, in order.
    header, line_end: the header of a CSV file and the end of its lines, as they were written.
    columns: the columns that are read; of JSON lines, whose rows may have more, the seven.
    margin: whether answers have a position with a margin.
    """

    chunks: Iterator[UnreadChunk]
    header: str | None = None
    line_end: str = "\n"
    columns: tuple[str, ...] = pair.COLUMNS
    margin: bool = False

    @property
    def added(self) -> tuple[str, ...]:
        """The names of the cells that are added to a row."""
        return tuple(name for name in added_to(self.columns) if name != WITH_MARGIN or self.margin)


Cell: TypeAlias = float | str | bool | None
"""A value that is added to a row in one column; None for an empty one."""


@dataclass(frozen=True, slots=True)
class TableAnswers:
    """The answers about a chunk of pairs, (n,) each.

    positions: exact, int8; 127 marks a refused row, which has no tangency and no clearance.
    tangent: whether the surfaces touch without crossing.
    clearance: in spheroid radii.
    with_margin: the positions where a pair counts as contact unless a clearance of at least the margin is proved; None
    without a margin.
    """

    positions: Positions
    tangent: NDArray[np.bool_]
    clearance: NDArray[np.float64]
    with_margin: Positions | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the columns."""
        return ADDED if self.with_margin is None else (*ADDED, WITH_MARGIN)

    @property
    def integers(self) -> Positions:
        """The one integer of each row: its position, with the margin if one is given."""
        return self.positions if self.with_margin is None else self.with_margin

    @property
    def heads(self) -> Iterable[tuple[Cell, ...]]:
        """Position, label, tangency."""
        return map(_HEADS.__getitem__, zip(self.positions.tolist(), self.tangent.tolist(), strict=True))

    @property
    def numbers(self) -> tuple[NDArray[np.float64], ...]:
        """The clearance."""
        return (self.clearance,)


_HEADS: dict[tuple[int, bool], tuple[Cell, ...]] = {
    (position, tangent): (position, label, None if position == pair.REFUSED else tangent)
    for position, label in LABELS.items()
    for tangent in (False, True)
}


@dataclass(frozen=True, slots=True)
class SweepAnswers:
    """The answers about a chunk of sweeps, straight motions, (n,) each.

    hits: 1 for contact somewhere on the sweep, its ends included, 0 for none, int8; 127 marks a refused row.
    first_lower, first_upper: float64 that the time of the first contact lies between, from 0 to 1; NaN without contact.
    """

    hits: Positions
    first_lower: NDArray[np.float64]
    first_upper: NDArray[np.float64]
    names: tuple[str, ...] = ADDED_TO_SWEEPS
    with_margin: None = None

    @property
    def integers(self) -> Positions:
        """The one integer of each row: whether it hits."""
        return self.hits

    @property
    def heads(self) -> Iterable[tuple[Cell, ...]]:
        """Whether it hits, and the label."""
        return ((hit, SWEEP_LABELS[hit]) for hit in self.hits.tolist())

    @property
    def numbers(self) -> tuple[NDArray[np.float64], ...]:
        """The bounds of the time."""
        return self.first_lower, self.first_upper


Answers: TypeAlias = TableAnswers | SweepAnswers
"""The answers about a chunk as the writers of tables take them.

`names` are the names of the columns that are added. `heads` are the first cells of each row, of which few differ. Then
`numbers` follow, a column each, NaN where there is none, and at last the position with a margin, if one is given.
`integers` are what a .npy file has: one integer for each row.
"""


def with_answers(
    texts: Iterable[str], answers: Answers, cell_text: Callable[[Cell], str], marks: Sequence[str], end: str
) -> bytes:
    """Write the text of each row, then the added cells, each after its mark, and then `end`."""

    @cache
    def head_text(head: tuple[Cell, ...]) -> str:
        return "".join(mark + cell_text(cell) for mark, cell in zip(marks, head, strict=False))

    columns = []
    for column in answers.numbers:
        columns.append(list(map(repr, column.tolist())))
        for index in np.flatnonzero(~np.isfinite(column)).tolist():
            columns[-1][index] = cell_text(None if np.isnan(column[index]) else float(column[index]))
    if answers.with_margin is not None:
        columns.append(list(map(str, answers.with_margin.tolist())))
    marked = (part for pair in zip(map(repeat, marks[-len(columns) :]), columns, strict=True) for part in pair)
    rows = zip(texts, map(head_text, answers.heads), *marked, repeat(end), strict=False)
    return "".join(chain.from_iterable(rows)).encode()


SWEEP_LABELS = {1: "contact", 0: "clear", pair.REFUSED: "refused"}


@dataclass(frozen=True, slots=True)
class Sink:
    """A table that is being written.

    render: makes bytes of a chunk and its answers, in any process.
    add: writes these bytes. Raises InputError.
    """

    render: Callable[[TableChunk, Answers], bytes]
    add: Callable[[bytes], object]


Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class RowPlaces:
    """The places of a chunk's rows: the file, the number of rows before them, and the line of each, from 1."""

    name: str
    rows_before: int
    lines: Sequence[int]

    def of(self, index: int) -> str:
        """Return the place of a row of the chunk, as a message names it."""
        return f"{self.name}, row {self.rows_before + index + 1} (line {self.lines[index]})"


def read_values(
    values: Iterable[Mapping[str, Value]],
    number_of: Callable[[str, Value], float],
    places: RowPlaces,
    *,
    mark: bool,
    layout: Layout = PAIRS,
) -> tuple[Rows, NDArray[np.bool_]]:
    """Make rows of values by column; return them and a mask of the refused ones, (n,).

    If one row has an axis or heights, all get them; the others are upright, or have no ends.
    `number_of(column, value)` raises ValueError with the end of a sentence about a value that is wrong. Without `mark`
    the first such row raises InputError; with it the row is refused, and NaN stands in it.
    """
    rows: list[list[float]] = []
    refused: list[bool] = []
    for index, row in enumerate(values):
        try:
            rows.append(_numbers(row, number_of, layout))
            refused.append(False)
        except ValueError as trouble:  # noqa: PERF203 - each row has its own
            if not mark:
                raise InputError(f"{places.of(index)}: {trouble}") from None
            rows.append([math.nan] * len(layout.upright))
            refused.append(True)
    width = max(map(len, rows), default=len(layout.upright))
    filling = (*pair.UPRIGHT, *pair.WITHOUT_ENDS)
    wide = [[*row, *filling[len(row) - len(layout.upright) : width - len(layout.upright)]] for row in rows]
    return np.array(wide, dtype=np.float64).reshape(len(wide), width), np.array(refused, dtype=np.bool_)


def _numbers(values: Mapping[str, Value], number_of: Callable[[str, Value], float], layout: Layout) -> list[float]:
    """Make the row of these values. Raises ValueError as `number_of` does, or if the row is not valid."""
    numbers = {name: number_of(name, value) for name, value in values.items()}
    row = [numbers[name] for name in layout.base]
    ended = not frozenset(pair.HEIGHTS).isdisjoint(numbers)
    if ended or pair.AXIS[0] in numbers:
        row += [numbers.get(name, value) for name, value in zip(pair.AXIS, pair.UPRIGHT, strict=True)]
    if ended:
        row += [numbers.get(name, value) for name, value in zip(pair.HEIGHTS, pair.WITHOUT_ENDS, strict=True)]
    trouble = pair.trouble_with_row(row, layout.base)
    if trouble is not None:
        raise ValueError(trouble)
    return row
