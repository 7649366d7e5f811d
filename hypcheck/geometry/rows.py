"""Many pairs at once: the types of arrays, rows that are checked, and ranges of rows.

Rows are float64 arrays of shape (n, 7), their columns in the order of pair.COLUMNS, or (n, 10) of tilted spheroids,
in the order of pair.TILTED_COLUMNS, or (n, 13) where hyperboloids end, with pair.HEIGHTS behind. Rows about a sweep
have (n, 10), (n, 13) or (n, 16): a Layout says what columns mean.
First the types and the functions that make rows from what a caller passes, then the check of their values, then the
ranges of ratios and of lengths on which an implementation is judged.
"""

from __future__ import annotations

import math
import reprlib
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import (
    AXIS,
    COLUMNS,
    END,
    HEIGHTS,
    NO_GROUPS,
    SIZES,
    SWEEP_COLUMNS,
    TILTED_COLUMNS,
    UPRIGHT,
    WITHOUT_ENDS,
    Groups,
    Sizes,
    trouble_with_row,
)
from hypcheck.messages import counted, escaped

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
Rows = NDArray[np.float64]
"""Rows of numbers, of shape (n, 7) unless a function says otherwise."""

Row = tuple[float, ...]
"""The numbers of one row."""

Positions = NDArray[np.int8]
"""Shape (n,): +1 exterior, 0 contact, −1 interior, or one of the codes REFUSED and CANNOT_SAY."""

Columns = tuple[Floats, Floats, Floats]
"""x, y, z of shape (n,), with any strides."""

CANNOT_SAY = 2
"""The answer code of a row that a method cannot decide."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The columns of rows: `upright` are the names for upright spheroids; for tilted ones, AXIS follows them.

    Where hyperboloids end, HEIGHTS are behind AXIS, which is there for upright spheroids too. `subjects` are words for
    what rows with none, with one or with both of these groups are about.
    """

    upright: tuple[str, ...]
    subjects: tuple[str, str, str] = ("upright", "tilted", "ended")

    @property
    def widths(self) -> tuple[int, int, int]:
        """The numbers of columns that rows can have: upright, with an axis, with an axis and heights."""
        return len(self.upright), len(self.tilted), len(self.ended)

    def groups(self, rows: Rows | Sequence[object]) -> Groups:
        """Return the groups of columns that the rows, or one row, have."""
        there = {"end": self.has_end, "axis": self.has_axis(rows), "heights": self.has_heights(rows)}
        return frozenset(name for name, has in there.items() if has)

    def subject(self, rows: Rows | Sequence[object]) -> str:
        """Return the word of `subjects` for the rows, or for one row."""
        return self.subjects[self.has_axis(rows) + self.has_heights(rows)]

    @property
    def has_end(self) -> bool:
        """Whether rows have the end of a sweep."""
        return END[0] in self.upright

    @property
    def base(self) -> tuple[str, ...]:
        """The names of the columns before an axis and heights as tables have them: x, y, z are where a sweep begins."""
        return COLUMNS + END if self.has_end else COLUMNS

    @property
    def tilted(self) -> tuple[str, ...]:
        """The names of the columns of tilted spheroids."""
        return self.upright + AXIS

    @property
    def ended(self) -> tuple[str, ...]:
        """The names of the columns of rows whose hyperboloids end."""
        return self.tilted + HEIGHTS

    def columns(self, width: int) -> tuple[str, ...]:
        """Return the names of the columns of a row with that many numbers."""
        return self.ended[:width]

    def split(self, row: Sequence[Any]) -> tuple[Sequence[Any], Sequence[Any], Sequence[Any]]:
        """Split a row into three parts: sizes and centres, the axis, the heights; a missing part is empty."""
        upright, tilted = len(self.upright), len(self.tilted)
        return row[:upright], row[upright:tilted], row[tilted:]

    def has_axis(self, rows: Rows | Sequence[object]) -> bool:
        """Decide whether the rows, or one row, have the columns of an axis."""
        return _width_of(rows) > len(self.upright)

    def has_heights(self, rows: Rows | Sequence[object]) -> bool:
        """Decide whether the rows, or one row, have the columns of heights."""
        return _width_of(rows) > len(self.tilted)


def _width_of(rows: Rows | Sequence[object]) -> int:
    """Return the number of columns of rows, or of one row."""
    return rows.shape[-1] if isinstance(rows, np.ndarray) else len(rows)


PAIRS = Layout(COLUMNS)
"""The layout of pairs: (n, 7), (n, 10) with an axis, or (n, 13) with an axis and heights."""

SWEEPS = Layout(SWEEP_COLUMNS, ("way", "way", "way"))
"""The layout of sweeps: (n, 10), (n, 13) with an axis, or (n, 16) with an axis and heights."""


def layout_with(groups: Groups) -> Layout:
    """Return the layout of rows with these groups."""
    return SWEEPS if "end" in groups else PAIRS


def columns_with(groups: Groups) -> tuple[str, ...]:
    """Return the names of the columns of rows with these groups; rows with heights also have an axis."""
    layout = layout_with(groups)
    return layout.ended if "heights" in groups else layout.tilted if "axis" in groups else layout.upright


def fits(groups: Groups, taken: Groups) -> bool:
    """Decide whether an implementation that takes the groups `taken` can answer rows with these groups."""
    return groups <= taken and layout_with(groups) == layout_with(taken)


def as_rows(values: Table | ArrayLike, taken: Groups = NO_GROUPS, layout: Layout = PAIRS) -> Rows:
    """Return `values` as a float64 array (n, 7), or also (n, 10) if an axis is taken, (n, 13) if heights are.

    Contiguous float64 input is not copied. With another layout, the widths are those of its columns. `values` may also
    be a table of the columns by name: a dict, a data frame, a structured array, or whatever else has names and gives a
    column for each; columns and numbers are broadcast, and where heights are given what is missing of them and of an
    axis is filled in. Raises InputError if the shape or the type is another, a name is unknown or missing, or values
    are masked. It does not check the values.
    """
    wide = {"axis": layout.tilted, "heights": layout.ended}
    allowed = (layout.upright, *(columns for name, columns in wide.items() if name in taken))
    table_names = names_of(values)
    if table_names is not None:
        return _rows_of_table(cast("Table", values), table_names, layout, allowed[-1])
    names = {len(columns): ", ".join(columns) for columns in allowed}
    wanted = ", or ".join(f"(n, {width}) of numbers: {columns}" for width, columns in names.items())
    rows = np.ascontiguousarray(as_numbers("the rows are", values, f"they must be an array {wanted}"))
    if rows.ndim != 2 or rows.shape[1] not in names:
        shapes = ", or ".join(f"(n, {width}): {columns}" for width, columns in names.items())
        raise InputError(f"the rows have shape {rows.shape}; it must be {shapes}")
    return rows


Table = Mapping[str, ArrayLike]
"""Columns by name: anything with names and [name], as a dict, a data frame and a structured array have them."""


def names_of(values: object) -> list[str] | None:
    """Return the names of a table's columns; None if the value is not a table."""
    if isinstance(values, np.ndarray):
        return None if values.dtype.names is None else list(values.dtype.names)
    names = getattr(values, "keys", None)
    return list(names()) if callable(names) and hasattr(values, "__getitem__") else None


def _rows_of_table(table: Table, names: Sequence[object], layout: Layout, known: tuple[str, ...]) -> Rows:
    """Make the rows of a table of these columns; those of an axis and of heights may be missing. Raises InputError."""
    for name in names:
        if name not in known:
            raise InputError(f"there is no column {escaped(repr(name), 60)}; the columns are {', '.join(known)}")
    ended, tilted = (not set(group).isdisjoint(names) for group in (HEIGHTS, AXIS))
    wanted = layout.tilted if tilted else layout.upright
    missing = [name for name in wanted if name not in names]
    if missing:
        nouns, verb = ("column", "is") if len(missing) == 1 else ("columns", "are")
        raise InputError(f"the {nouns} {', '.join(missing)} {verb} missing; a row needs {', '.join(wanted)}")
    columns = layout.ended if ended else wanted
    values = [table[name] if name in names else _DEFAULTS[name] for name in columns]
    return np.stack(as_columns(columns, values), axis=1)


_DEFAULTS: Mapping[str, float] = dict(zip((*AXIS, *HEIGHTS), (*UPRIGHT, *WITHOUT_ENDS), strict=True))
"""The values of missing columns."""


def as_columns(names: Sequence[str], arguments: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """Return values, each a number or an array (n,), as float64 columns of one length n.

    Raises InputError naming the value that is neither, or the shapes that do not fit together.
    """
    wanted = "it must be a number or an array (n,) of numbers"
    values = [
        truth_values_as_numbers(value) if name == "solid" else value
        for name, value in zip(names, arguments, strict=True)
    ]
    columns = [
        np.atleast_1d(as_numbers(f"{name} is", value, wanted)) for name, value in zip(names, values, strict=True)
    ]
    try:
        shape = np.broadcast_shapes(*(column.shape for column in columns))
    except ValueError:
        shape = ()
    if len(shape) != 1:
        shapes = ", ".join(f"{name} {column.shape}" for name, column in zip(names, columns, strict=True))
        raise InputError(f"{shapes} have shapes that do not fit together; each must be (n,) or a number")
    return tuple(np.broadcast_to(column, shape) for column in columns)


def tilted_rows(sizes: Sizes, center: Columns, axis: Sequence[float | Floats]) -> Rows:
    """Make rows (n, 10) of one spheroid at many centres; each number of the axis is (n,) or one for all."""
    rows = np.empty((len(center[0]), len(TILTED_COLUMNS)))
    for column, value in enumerate((*sizes, *center, *axis)):
        rows[:, column] = value
    return rows


def as_numbers(subject: str, values: object, wanted: str) -> Floats:
    """Return `values` as float64 of their own shape. Raises InputError, "<subject> …; <wanted>", unless all are real.

    A number beyond the range of float64 becomes infinite. Texts, truth values and masked values are not numbers.
    """
    require_unmasked(subject, values)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):  # of several lengths
        array = np.empty(0, dtype=np.object_)
    if array.dtype.kind not in "iuf":
        description = (
            f"an array of {values.dtype}" if isinstance(values, np.ndarray) else escaped(reprlib.repr(values), 60)
        )
        raise InputError(f"{subject} {description}; {wanted}")
    with np.errstate(over="ignore"):
        return array.astype(np.float64, copy=False)


def truth_values_as_numbers(values: ArrayLike) -> ArrayLike:
    """Return `values`, with 1 and 0 for true and false."""
    array = np.asarray(values)
    return array.astype(np.float64) if array.dtype == np.bool_ else values


def require_unmasked(subject: str, values: object) -> None:
    """Raise InputError for an array with masked values: without the mask they would be taken for ordinary ones."""
    ma = sys.modules.get("numpy.ma")  # until something imports it nothing can be masked; importing it here costs time
    if ma is not None and isinstance(values, ma.MaskedArray) and (count := int(ma.getmaskarray(values).sum())):
        these = "it" if count == 1 else "these"
        raise InputError(f"{subject} masked in {counted(count, 'place')}; fill {these}, with nan or a number")


def invalid(rows: Rows, layout: Layout = PAIRS) -> Mask:
    """Return a mask (n,) of the invalid rows; pair.Pair says what is valid."""
    others, axis, heights = parts_of(rows, layout)
    valid = np.isfinite(rows[:, : len(layout.tilted)]).all(axis=1) & (others[:, : len(SIZES)] > 0).all(axis=1)
    if layout.has_axis(rows):
        valid &= (axis != 0).any(axis=1)
    if layout.has_heights(rows):
        low, high, solid = heights.T
        valid &= (low < high) & ((solid == 0) | (solid == 1))
    return np.asarray(~valid)


def parts_of(rows: Rows, layout: Layout = PAIRS) -> tuple[Rows, Rows, Rows]:
    """Split columns of rows into three parts: sizes and centres, the axis, the heights; a missing part is (n, 0)."""
    places = len(layout.upright), len(layout.tilted)
    return rows[:, : places[0]], rows[:, places[0] : places[1]], rows[:, places[1] :]


def with_axis(rows: Rows, layout: Layout = PAIRS) -> Rows:
    """Give rows without an axis the axis 0, 0, 1; return other rows as they are."""
    return _widened(rows, len(layout.tilted), layout)


def with_heights(rows: Rows, layout: Layout = PAIRS) -> Rows:
    """Give rows without an axis or heights those that mean upright and without ends."""
    return _widened(rows, len(layout.ended), layout)


def as_wide(parts: Sequence[Rows], layout: Layout = PAIRS) -> list[Rows]:
    """Give all parts the same columns: heights if one of them has heights, an axis if one has an axis."""
    widest = max((part.shape[1] for part in parts), default=0)
    return [_widened(part, widest, layout) for part in parts]


def _widened(rows: Rows, width: int, layout: Layout) -> Rows:
    """Give rows at least that many columns, contiguous; missing ones get their defaults."""
    missing = [_DEFAULTS[name] for name in layout.ended[rows.shape[1] : width]]
    if not missing:
        return rows
    return np.ascontiguousarray(np.hstack([rows, np.broadcast_to(missing, (len(rows), len(missing)))]))


def upright_mask(rows: Rows) -> Mask:
    """Return a mask (n,) of the pairs whose spheroid is upright: the axis is vertical, or b = d."""
    if not PAIRS.has_axis(rows):
        return np.ones(len(rows), dtype=np.bool_)
    return np.asarray((rows[:, 7:9] == 0).all(axis=1) | (rows[:, 2] == rows[:, 3]))


def scenes_of(rows: Rows) -> list[Indices]:
    """Group rows that differ only in their centres; return the indices of each group, the largest group first."""
    fixed = np.delete(rows, (4, 5, 6), axis=1)
    _, scene = np.unique(fixed, axis=0, return_inverse=True)
    order = np.argsort(scene.reshape(-1), kind="stable")
    parts = np.split(order, np.cumsum(np.bincount(scene.reshape(-1)))[:-1]) if len(rows) else []
    return sorted(parts, key=len, reverse=True)


def first_trouble(rows: Rows, first_number: int = 0, layout: Layout = PAIRS) -> str | None:
    """Return a sentence about the first invalid row, counted from `first_number`, or None if all rows are valid."""
    bad = np.flatnonzero(invalid(rows, layout))
    if not len(bad):
        return None
    index = int(bad[0])
    return f"row {first_number + index}: {trouble_with_row(rows[index].tolist(), layout.upright)}"


def require_valid(rows: Rows, first_number: int = 0, layout: Layout = PAIRS) -> None:
    """Raise InputError about the first invalid row, if there is one."""
    trouble = first_trouble(rows, first_number, layout)
    if trouble is not None:
        raise InputError(trouble)


Range = tuple[float, float]

ORDINARY_RATIO: Range = (1e-8, 1e8)
ORDINARY_MAGNITUDE: Range = (1e-6, 1e6)
"""The ranges on which an implementation is judged if it declares none: any two bodies between insect and island."""

UNBOUNDED: Range = (0.0, math.inf)


def within(
    rows: Rows, ratio: Range = ORDINARY_RATIO, magnitude: Range = ORDINARY_MAGNITUDE, layout: Layout = PAIRS
) -> Mask:
    """Return a mask (n,) of the rows with α/b and γ/d in `ratio` and lengths in `magnitude`, bounds included.

    The lower limit of magnitudes applies only to semi-axes: a coordinate may be arbitrarily near 0, since a centre
    close to the axis or to the waist is ordinary, and so may an end, which may also be infinite. The axis of a spheroid
    may have any length, since it is not a length of a body.
    """
    alpha, gamma, b, d = rows[:, :4].T
    with np.errstate(over="ignore", under="ignore"):
        ratios = np.stack([alpha / b, gamma / d], axis=1)
    inside = ((ratios >= ratio[0]) & (ratios <= ratio[1])).all(axis=1)
    others, _, heights = parts_of(rows, layout)
    lengths = np.abs(np.hstack([others, heights[:, :2]]))
    fitting = (lengths <= magnitude[1]) | (np.isinf(lengths) & (np.arange(lengths.shape[1]) >= others.shape[1]))
    inside &= (rows[:, :4] >= magnitude[0]).all(axis=1) & fitting.all(axis=1)
    return np.asarray(inside)


@dataclass(frozen=True, slots=True)
class FixedSizes:
    """Rows of one spheroid beside one hyperboloid: α, γ, b, d, and closed spans of x, y, z; None means any value.

    `axis` is that of the spheroid in rows of ten numbers, "free" where it may be any; None: the spheroid is upright.
    """

    sizes: Sizes
    x: Range | None = None
    y: Range | None = None
    z: Range | None = None
    axis: tuple[float, float, float] | Literal["free"] | None = None

    @property
    def spans(self) -> tuple[Range | None, Range | None, Range | None]:
        """The spans in order."""
        return self.x, self.y, self.z

    def holds(self, rows: Rows, layout: Layout = PAIRS) -> Mask:
        """Return a mask (n,) of the rows with these sizes, this axis and the centre (of a sweep both) in the spans."""
        inside = (rows[:, :4] == self.sizes).all(axis=1)
        if not inside.any():  # the usual case where a scene has many sizes
            return np.asarray(inside)
        if self.axis != "free":
            axes = with_axis(rows, layout)[:, len(layout.upright) :]
            inside &= (axes == (self.axis or UPRIGHT)).all(axis=1)
        for place in range(len(SIZES), len(layout.upright)):
            span = self.spans[(place - len(SIZES)) % len(self.spans)]
            if span is not None:
                inside &= (rows[:, place] >= span[0]) & (rows[:, place] <= span[1])
        return np.asarray(inside)
