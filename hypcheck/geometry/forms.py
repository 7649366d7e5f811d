"""What a caller may write for pairs: rows, a table of columns by name, or sizes and centres; all are broadcast.

    (rows)  (table)  (sizes, points)  (sizes, x, y, z)  (alpha, gamma, b, d, points)  (alpha, gamma, b, d, x, y, z)

`points` is one point (3,) or many (n, 3); each other value is a number or a column (n,). The rest is named: `axis`, one
(3,) or an axis for each row (n, 3); `z_min`, `z_max`, `solid`; and in place of any of these the columns themselves.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, COLUMNS, HEIGHTS, SIZES, trouble_with_row
from hypcheck.geometry.rows import PAIRS, Rows, as_numbers, as_rows, names_of, require_valid
from hypcheck.messages import counted, escaped

Argument: TypeAlias = Any
"""A number, a column (n,), points, rows or a table, as said above."""

Answers: TypeAlias = Any
"""An array with an answer for each pair, or a number for one pair of numbers."""

_FORMS = (
    "it takes rows, a table of columns by name, or sizes and centres: (sizes, points), (sizes, x, y, z), "
    "(alpha, gamma, b, d, points) or (alpha, gamma, b, d, x, y, z)"
)


@dataclass(frozen=True)
class Pairs:
    """The pairs of a call: a value for each name of a column, or rows that were given whole."""

    columns: Mapping[str, Argument]
    given: Rows | None = None

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
        """The rows, float64 of 7, 10 or 13 columns. Raises InputError; their values are not checked."""
        if self.given is not None:
            return self.given
        return as_rows(self.columns, tilted=True, heights=True)

    def require_valid(self, rows: Rows) -> None:
        """Raise InputError about the first invalid row; for a single pair the message has no index."""
        trouble = trouble_with_row(rows[0].tolist()) if self.single else None
        if trouble is not None:
            raise InputError(trouble)
        require_valid(rows)


def pairs_of(
    arguments: Sequence[Argument],
    named: Mapping[str, Argument],
    axis: ArrayLike | None = None,
    heights: Sequence[Argument] = (-math.inf, math.inf, False),
) -> Pairs:
    """The pairs of a call. Raises InputError for other numbers of arguments, and for a column that is given twice."""
    columns: dict[str, Argument] = {}
    require_known(named, (*PAIRS.ended, "center"))
    _add(columns, _by_position(arguments))
    _add(columns, spread(named, _POINTS))
    if axis is not None:
        _add(columns, named_points("axis", axis, AXIS))
    if len(heights) == len(HEIGHTS) and not mean_no_ends(heights):
        _add(columns, dict(zip(HEIGHTS, heights, strict=True)))
    if not columns:
        raise InputError(f"there are no pairs: {_FORMS}")
    rows = columns.pop("rows", None)
    if rows is None:
        return Pairs(columns)
    if not columns:
        return Pairs({}, rows)
    whole = dict(zip(PAIRS.columns(rows.shape[1]), rows.T, strict=True))
    _add(whole, columns)
    return Pairs(whole)


_POINTS: Mapping[str, Sequence[str]] = {"center": CENTER, "axis": AXIS}
"""Names that stand for three columns, one point (3,) or points (n, 3)."""


def require_known(named: Mapping[str, Argument], known: Sequence[str]) -> None:
    """Raise InputError about a name that no argument has."""
    for name in named:
        if name not in known:
            columns = f"what pairs are written with is {', '.join(known)}"
            raise InputError(f"there is no argument {escaped(repr(name), 60)} here; {columns}")


def spread(named: Mapping[str, Argument], points: Mapping[str, Sequence[str]]) -> dict[str, Argument]:
    """Values by the names of columns; some names mean three columns. Raises InputError for a column given twice."""
    columns: dict[str, Argument] = {}
    for name, value in named.items():
        _add(columns, named_points(name, value, points[name]) if name in points else {name: value})
    return columns


def mean_no_ends(heights: Sequence[Argument]) -> bool:
    """Whether z_min, z_max and solid are the numbers that a hyperboloid without ends has."""
    low, high, solid = heights
    return all(np.ndim(height) == 0 for height in heights) and low == -math.inf and high == math.inf and not solid


def _add(columns: dict[str, Argument], others: Mapping[str, Argument]) -> None:
    for name, value in others.items():
        if name in columns:
            raise InputError(f"{name} is given twice; it must be given once")
        columns[name] = value


def _by_position(arguments: Sequence[Argument]) -> dict[str, Argument]:
    count = len(arguments)
    if count == 0:
        return {}
    if count == 1:
        return _whole(arguments[0])
    if count in (2, 4):
        sizes, center = sizes_of(arguments[0]), arguments[1:]
    elif count in (5, 7):
        sizes, center = dict(zip(SIZES, arguments, strict=False)), arguments[len(SIZES) :]
    else:
        raise InputError(f"{counted(count, 'argument')}: {_FORMS}")
    points = named_points("the centre", center[0]) if len(center) == 1 else dict(zip(CENTER, center, strict=True))
    return {**sizes, **points}


def _whole(value: Argument) -> dict[str, Argument]:
    """A table by its columns; an array of rows, or one row."""
    names = names_of(value)
    if names is not None:
        return spread({name: value[name] for name in names}, _POINTS)
    if not isinstance(value, np.ndarray) and not isinstance(value, str) and isinstance(value, Sequence):
        flat = value and not isinstance(value[0], (Sequence, np.ndarray))
    else:
        flat = isinstance(value, np.ndarray) and value.ndim == 1
    if flat and len(value):
        row = as_numbers(
            "the row is", value, f"it must be {len(COLUMNS)} numbers, {', '.join(COLUMNS)}, or rows of them"
        )
        rows = as_rows(row[None], tilted=True, heights=True)
        return dict(zip(PAIRS.columns(rows.shape[1]), rows[0].tolist(), strict=True))
    return {"rows": as_rows(value, tilted=True, heights=True)}


def sizes_of(sizes: Argument) -> dict[str, Argument]:
    """Four numbers or columns, or an array (n, 4), whose rows are sizes."""
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
    """One point (3,), or points (n, 3), as values of three columns; an empty list is no points."""
    wanted = f"it must be three numbers, {', '.join(names)}, or an array (n, 3) of them"
    numbers = as_numbers(f"{subject} is", points, wanted)
    if numbers.shape == (0,) and names == CENTER:
        numbers = numbers.reshape(0, len(names))
    if numbers.ndim not in (1, 2) or numbers.shape[-1] != len(names):
        raise InputError(f"{subject} is of shape {numbers.shape}; {wanted}")
    values = numbers.tolist() if numbers.ndim == 1 else list(numbers.T)
    return dict(zip(names, values, strict=True))


def points_or_columns(x: ArrayLike, y: ArrayLike | None, z: ArrayLike | None) -> tuple[Any, Any, Any]:
    """Three columns: the arguments, or the columns of points if only those are given."""
    if y is None and z is None:
        x, y, z = named_points("the centre", x).values()
    if y is None or z is None:
        raise InputError(f"{'y' if y is None else 'z'} is not given; there must be x, y and z, or only points (n, 3)")
    return x, y, z
