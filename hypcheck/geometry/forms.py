"""The forms of pairs and sweeps in a call: rows, a table of columns by name, or sizes and points; all broadcast.

    (rows)  (table)  (sizes, points)  (sizes, x, y, z)  (alpha, gamma, b, d, points)  (alpha, gamma, b, d, x, y, z)
    (rows)  (table)  (sizes, start, end)  (alpha, gamma, b, d, start, end)

`points`, `start` and `end` are one point (3,) or many (n, 3); each other value is a number or a column (n,). The last
points may be named: center, start, end. So is the rest: `axis`, one (3,) or an axis for each row (n, 3); `z_min`,
`z_max`, `solid`; and in place of any of these the columns themselves. No value is given twice.

A query about a scene is a centre or a sweep, a heading and an axis: the functions at the end check these.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.pair import (
    ALL_GROUPS,
    AXIS,
    CENTER,
    END,
    HEIGHTS,
    NO_DIRECTION,
    SIZES,
    START,
    WITHOUT_ENDS,
    trouble_with,
    trouble_with_row,
)
from hypcheck.geometry.rows import PAIRS, Floats, Layout, Rows, as_columns, as_numbers, as_rows, names_of, require_valid
from hypcheck.messages import counted, escaped

Argument: TypeAlias = Any
"""A number, a column (n,), points, rows or a table, as the module's docstring says."""

Answers: TypeAlias = Any
"""An array with an answer for each pair, or a number for one pair of numbers."""


@dataclass(frozen=True)
class CallForm:
    """The form of one kind of question: the layout of its rows, the points after the sizes, a sentence for messages.

    `points` are the names of points in order, each with its three columns. `apart` are the columns that may be given in
    place of the points. `other_names` are second names of columns, each with the name that the layout has.
    """

    layout: Layout
    points: Mapping[str, Sequence[str]]
    apart: Sequence[str]
    sentence: str
    other_names: Mapping[str, str] = field(default_factory=dict)

    @property
    def named(self) -> Mapping[str, Sequence[str]]:
        """The names of arguments that give three columns at once: one point (3,) or points (n, 3)."""
        return {**self.points, "axis": AXIS}


PAIR = CallForm(
    PAIRS,
    {"center": CENTER},
    CENTER,
    "it takes rows, a table of columns by name, or sizes and centres: (sizes, points), (sizes, x, y, z), "
    "(alpha, gamma, b, d, points) or (alpha, gamma, b, d, x, y, z)",
)

SWEEP = CallForm(
    Layout(SIZES + CENTER + END),
    {"start": CENTER, "end": END},
    (),
    "passage takes (sizes, start, end), (alpha, gamma, b, d, start, end), rows or a table",
    dict(zip(START, CENTER, strict=True)),
)
"""Sweeps as rows and tables have them: the centre at the start is x, y, z; the protocol calls it x0, y0, z0."""


@dataclass(frozen=True)
class Questions:
    """The pairs or sweeps of a call: a value for each name of a column, or else `given`, an array of rows."""

    columns: Mapping[str, Argument]
    given: Rows | None = None
    form: CallForm = PAIR

    @cached_property
    def single(self) -> bool:
        """Whether all values are numbers: one pair, which is answered by one value."""
        return self.given is None and all(np.ndim(value) == 0 for value in self.columns.values())

    @property
    def scene(self) -> bool:
        """Whether the sizes are numbers, the same for all, and no heights are given."""
        sizes = [self.columns.get(name) for name in SIZES]
        return (
            self.given is None
            and not any(name in self.columns for name in HEIGHTS)
            and all(value is not None and np.ndim(value) == 0 for value in sizes)
            and all(name in self.columns for name in CENTER)
        )

    def rows(self) -> Rows:
        """Make the rows, float64, of any width that the layout has. Raises InputError; their values are not checked."""
        if self.given is not None:
            return self.given
        return as_rows(self.columns, ALL_GROUPS, self.form.layout)

    def require_valid(self, rows: Rows) -> None:
        """Raise InputError about the first invalid row; for a single question the message has no index."""
        layout = self.form.layout
        trouble = trouble_with_row(rows[0].tolist(), layout.upright) if self.single else None
        if trouble is not None:
            raise InputError(trouble)
        require_valid(rows, layout=layout)


def questions_of(
    arguments: Sequence[Argument],
    named: Mapping[str, Argument],
    axis: ArrayLike | None = None,
    heights: Sequence[Argument] = WITHOUT_ENDS,
    form: CallForm = PAIR,
) -> Questions:
    """Read the pairs or sweeps of a call. Raises InputError for a wrong number of arguments, or a value given twice."""
    columns: dict[str, Argument] = {}
    _require_known(named, form)
    _add(columns, _by_position(arguments, named, form))
    _add(columns, _spread(named, form))
    if axis is not None:
        _add(columns, named_points("axis", axis, AXIS))
    if not mean_no_ends(heights):
        _add(columns, dict(zip(HEIGHTS, heights, strict=True)))
    if not columns:
        raise InputError(f"there are no arguments: {form.sentence}")
    rows = columns.pop("rows", None)
    if rows is None:
        return Questions(columns, form=form)
    if not columns:
        return Questions({}, rows, form)
    whole = dict(zip(form.layout.columns(rows.shape[1]), rows.T, strict=True))
    _add(whole, columns)
    return Questions(whole, form=form)


def _require_known(named: Mapping[str, Argument], form: CallForm) -> None:
    """Raise InputError about a name that no argument has."""
    known = (*form.layout.ended, *form.points)
    for name in named:
        if name not in known and name not in form.other_names:
            raise InputError(f"there is no argument {escaped(repr(name), 60)} here; the names are {', '.join(known)}")


def _spread(named: Mapping[str, Argument], form: CallForm) -> dict[str, Argument]:
    """Return values by names of columns; some names mean three columns. Raises InputError for a column given twice."""
    columns: dict[str, Argument] = {}
    for keyword, value in named.items():
        name = form.other_names.get(keyword, keyword)
        _add(columns, named_points(name, value, form.named[name]) if name in form.named else {name: value})
    return columns


def mean_no_ends(heights: Sequence[Argument]) -> bool:
    """Decide whether z_min, z_max and solid are the numbers that a hyperboloid without ends has."""
    low, high, solid = heights
    return all(np.ndim(height) == 0 for height in heights) and low == -math.inf and high == math.inf and not solid


def _add(columns: dict[str, Argument], others: Mapping[str, Argument]) -> None:
    """Add columns to `columns`. Raises InputError if one is there already."""
    for name, value in others.items():
        if name in columns:
            raise InputError(f"{name} is given twice; it must be given once")
        columns[name] = value


def _by_position(arguments: Sequence[Argument], named: Mapping[str, Argument], form: CallForm) -> dict[str, Argument]:
    """Return the columns of the arguments without names; the last points may be among `named`. Raises InputError."""
    count, unnamed = len(arguments), tuple(takewhile(lambda name: name not in named, form.points))
    if count == 0:
        return {}
    if count == 1 and (len(unnamed) == len(form.points) or names_of(arguments[0]) is not None):
        return _whole(arguments[0], form)
    if len(unnamed) < len(form.points) and count - len(form.points) in (1, len(SIZES)):
        raise InputError(f"{next(name for name in form.points if name in named)} is given twice; it must be given once")
    missing = [name for name in form.points if name not in named and name not in unnamed]
    if missing:
        raise InputError(f"{form.sentence}; {missing[0]} is missing")
    for places in (unnamed,) if len(unnamed) < len(form.points) else (unnamed, form.apart):
        sizes, points = arguments[: count - len(places)], arguments[count - len(places) :]
        if len(sizes) in (1, len(SIZES)):
            columns = sizes_of(sizes[0]) if len(sizes) == 1 else dict(zip(SIZES, sizes, strict=True))
            for name, value in zip(places, points, strict=True):
                subject = "the centre" if name == "center" else name
                columns |= named_points(subject, value, form.points[name]) if name in form.points else {name: value}
            return columns
    raise InputError(f"{counted(count, 'argument')}: {form.sentence}")


def _whole(value: Argument, form: CallForm) -> dict[str, Argument]:
    """Read one argument that is a table or one row, by columns, or an array of rows, under the name rows."""
    names = names_of(value)
    if names is not None:
        return _spread({name: value[name] for name in names}, form)
    if not isinstance(value, np.ndarray) and not isinstance(value, str) and isinstance(value, Sequence):
        flat = value and not isinstance(value[0], (Sequence, np.ndarray))
    else:
        flat = isinstance(value, np.ndarray) and value.ndim == 1
    layout = form.layout
    if flat and len(value):
        wanted = f"it must be {len(layout.upright)} numbers, {', '.join(layout.upright)}, or rows of them"
        row = as_numbers("the row is", value, wanted)
        rows = as_rows(row[None], ALL_GROUPS, layout)
        return dict(zip(layout.columns(rows.shape[1]), rows[0].tolist(), strict=True))
    return {"rows": as_rows(value, ALL_GROUPS, layout)}


def sizes_of(sizes: Argument) -> dict[str, Argument]:
    """Read sizes by name: four numbers or columns, or an array (n, 4) whose rows are sizes. Raises InputError."""
    wanted = f"they must be four: {', '.join(SIZES)}, numbers or columns (n,), or an array (n, 4) of numbers"
    if isinstance(sizes, (str, bytes)) or not isinstance(sizes, (Sequence, np.ndarray)):
        raise InputError(f"the sizes are {escaped(reprlib.repr(sizes), 60)}; {wanted}")
    columns: Argument = sizes
    if isinstance(sizes, np.ndarray) and sizes.ndim > 1:  # rows, as points (n, 3) are
        if sizes.ndim != 2 or sizes.shape[1] != len(SIZES):
            raise InputError(f"the sizes are of shape {sizes.shape}; {wanted}")
        columns = sizes.T
    elif len(columns) != len(SIZES):
        raise InputError(f"the sizes are {len(columns)}; {wanted}")
    return dict(zip(SIZES, columns, strict=True))


def named_points(subject: str, points: ArrayLike, names: Sequence[str] = CENTER) -> dict[str, Argument]:
    """Return one point (3,), or points (n, 3), as values of three columns; an empty list has no points."""
    wanted = f"it must be three numbers, {', '.join(names)}, or an array (n, 3) of them"
    numbers = as_numbers(f"{subject} is", points, wanted)
    if numbers.shape == (0,) and names == CENTER:
        numbers = numbers.reshape(0, len(names))
    if numbers.ndim not in (1, 2) or numbers.shape[-1] != len(names):
        raise InputError(f"{subject} is of shape {numbers.shape}; {wanted}")
    values = numbers.tolist() if numbers.ndim == 1 else list(numbers.T)
    return dict(zip(names, values, strict=True))


def points_or_columns(x: ArrayLike, y: ArrayLike | None, z: ArrayLike | None) -> tuple[Any, Any, Any]:
    """Return three columns: the arguments, or those of the points `x` if y and z are None. Raises InputError."""
    if y is None and z is None:
        x, y, z = named_points("the centre", x).values()
    if y is None or z is None:
        raise InputError(f"{'y' if y is None else 'z'} is not given; there must be x, y and z, or only points (n, 3)")
    return x, y, z


POINTS = f"it must be three numbers, {', '.join(CENTER)}, or an array (n, 3) of them"


def are_one(center: Sequence[ArrayLike], heading: ArrayLike, axis: ArrayLike | None) -> bool:
    """Decide whether a query is one centre given as numbers; then its answer is a number, too."""
    return not any(map(np.ndim, (*center, heading))) and np.ndim(() if axis is None else axis) == 1


def sweeps_of(start: ArrayLike, end: ArrayLike, heading: ArrayLike, axes: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """Return starts and ends of sweeps, (n, 3) each, headings (n,), and the columns of axes. Raises InputError."""
    points = []
    for name, value in (("start", start), ("end", end)):
        point = as_numbers(f"{name} is", value, POINTS)
        if point.ndim not in (1, 2) or point.shape[-1] != len(CENTER):
            raise InputError(f"{name} is of shape {point.shape}; {POINTS}")
        points.append(point.reshape(-1, len(CENTER)).T)
    names = (
        *(f"{letter} of the start" for letter in CENTER),
        *(f"{letter} of the end" for letter in CENTER),
        "heading",
    )
    columns = finite_columns((*names, *AXIS[: len(axes)]), (*points[0], *points[1], heading, *axes))
    return np.stack(columns[:3], axis=1), np.stack(columns[3:6], axis=1), *columns[6:]


def finite_columns(names: Sequence[str], arguments: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """Return columns as as_columns makes them. Raises InputError about the first number that is not finite."""
    columns = as_columns(names, arguments)
    for name, values in zip(names, columns, strict=True):
        finite = np.isfinite(values)
        if not finite.all():
            index = int(np.argmin(finite))
            raise InputError(f"row {index}: {name} is {float(values[index])!r}; it must be finite")
    return columns


def directions(columns: Sequence[Floats]) -> Floats:
    """Return the axes as (n, 3). Raises InputError about the first that is 0, 0, 0."""
    axes = np.stack(columns, axis=1)
    nowhere = np.flatnonzero(~(axes != 0).any(axis=1))
    if len(nowhere):
        raise InputError(f"row {int(nowhere[0])}: {NO_DIRECTION}")
    return axes


def finite_numbers(x: object, y: object, z: object, heading: object) -> tuple[float, float, float, float]:
    """Return the four values as finite float64. Raises InputError about anything else."""
    if (
        type(x) is type(y) is type(z) is type(heading) is float
        and (math.isfinite(x) and math.isfinite(y) and math.isfinite(z) and math.isfinite(heading))
    ):  # fmt: skip
        return x, y, z, heading
    x, y, z, heading = map(_number_of, (*CENTER, "heading"), (x, y, z, heading))
    return x, y, z, heading


def _number_of(name: str, value: object) -> float:
    """Return the value as a finite float64. Raises InputError about anything else."""
    if not isinstance(value, (int, float)):
        array = as_numbers(f"{name} is", value, "it must be a number")
        if array.size != 1:
            raise InputError(f"{name} is of shape {array.shape}; it must be a number (classify takes arrays)")
        value = float(array.item())
    trouble = trouble_with(name, value)
    if trouble is not None:
        raise InputError(trouble)
    return float(value)
