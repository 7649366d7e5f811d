"""What a query about a scene may be written as: numbers and columns, points, ways, axes; each checked."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.forms import named_points
from hypcheck.geometry.pair import AXIS, CENTER, NO_DIRECTION, trouble_with
from hypcheck.geometry.rows import Floats, as_columns, as_numbers

POINTS = f"it must be three numbers, {', '.join(CENTER)}, or an array (n, 3) of them"


def points_or_columns(x: ArrayLike, y: ArrayLike | None, z: ArrayLike | None) -> tuple[Any, Any, Any]:
    """Three columns, as they are, or those of points, which stand alone."""
    if y is None and z is None:
        x, y, z = named_points("the centre", x).values()
    if y is None or z is None:
        raise InputError(f"{'y' if y is None else 'z'} is not given; there must be x, y and z, or points (n, 3) alone")
    return x, y, z


def are_one(center: Sequence[ArrayLike], heading: ArrayLike, axis: ArrayLike | None) -> bool:
    """Whether a query is about one centre, in numbers, which is answered by numbers."""
    return not any(map(np.ndim, (*center, heading))) and np.ndim(() if axis is None else axis) == 1


def ways_of(start: ArrayLike, end: ArrayLike, heading: ArrayLike, axes: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """The ends of ways, (n, 3) each, headings (n,), and the numbers of axes. Raises InputError where they are none."""
    points = []
    for name, given in (("start", start), ("end", end)):
        point = as_numbers(f"{name} is", given, POINTS)
        if point.ndim not in (1, 2) or point.shape[-1] != len(CENTER):
            raise InputError(f"{name} is of shape {point.shape}; {POINTS}")
        points.append(point.reshape(-1, len(CENTER)).T)
    names = (*(f"{each} of the start" for each in CENTER), *(f"{each} of the end" for each in CENTER), "heading")
    columns = finite_columns((*names, *AXIS[: len(axes)]), (*points[0], *points[1], heading, *axes))
    return np.stack(columns[:3], axis=1), np.stack(columns[3:6], axis=1), *columns[6:]


def finite_columns(names: Sequence[str], given: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """The columns as as_columns makes them. Raises InputError about the first number that is not finite."""
    columns = as_columns(names, given)
    for name, values in zip(names, columns, strict=True):
        finite = np.isfinite(values)
        if not finite.all():
            index = int(np.argmin(finite))
            raise InputError(f"row {index}: {name} is {float(values[index])!r}; it must be finite")
    return columns


def directions(columns: Sequence[Floats]) -> Floats:
    """The axes as (n, 3). Raises InputError about the first that is 0, 0, 0."""
    axes = np.stack(columns, axis=1)
    nowhere = np.flatnonzero(~(axes != 0).any(axis=1))
    if len(nowhere):
        raise InputError(f"row {int(nowhere[0])}: {NO_DIRECTION}")
    return axes


def finite_numbers(x: object, y: object, z: object, heading: object) -> tuple[float, float, float, float]:
    """The four as finite float64. Raises InputError about anything else."""
    if (
        type(x) is type(y) is type(z) is type(heading) is float
        and (isfinite(x) and isfinite(y) and isfinite(z) and isfinite(heading))
    ):  # fmt: skip
        return x, y, z, heading
    x, y, z, heading = map(_number_of, (*CENTER, "heading"), (x, y, z, heading))
    return x, y, z, heading


def _number_of(name: str, value: object) -> float:
    """The value as a finite float64; raises InputError about anything else."""
    if not isinstance(value, (int, float)):
        array = as_numbers(f"{name} is", value, "it must be a number")
        if array.size != 1:
            raise InputError(f"{name} is of shape {array.shape}; it must be a number (classify takes arrays)")
        value = float(array.item())
    trouble = trouble_with(name, value)
    if trouble is not None:
        raise InputError(trouble)
    return float(value)
