"""hypcheck.passage: one straight sweep exactly and without numpy, or many of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, overload

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.pair import SIZES
from hypcheck.truth import swept

if TYPE_CHECKING:  # it loads numpy, and one sweep does without
    from hypcheck.geometry.forms import Argument
    from hypcheck.kernel.passages import Passages


@overload
def passage(
    sizes: Sequence[swept.Rational],
    start: Sequence[swept.Rational],
    end: Sequence[swept.Rational],
    /,
    axis: Sequence[swept.Rational] | None = None,
    upward: Sequence[swept.Rational] | None = None,
    *,
    z_min: float = -math.inf,
    z_max: float = math.inf,
    solid: float = False,
) -> swept.Passage: ...


@overload
def passage(
    *sweeps: Argument,
    axis: Argument = None,
    upward: Argument = None,
    z_min: Argument = -math.inf,
    z_max: Argument = math.inf,
    solid: Argument = False,
    **columns: Argument,
) -> swept.Passage | Passages: ...


@in_default_environment
def passage(
    *sweeps: Argument,
    axis: Argument = None,
    upward: Argument = None,
    z_min: Argument = -math.inf,
    z_max: Argument = math.inf,
    solid: Argument = False,
    **columns: Argument,
) -> swept.Passage | Passages:
    """Whether a spheroid that moves straight from one centre to another has contact, also at its two ends, and when.

    Sweeps are written (sizes, start, end) or (alpha, gamma, b, d, start, end): sizes are numbers or columns (n,), start
    and end are points (3,) or (n, 3) from the hyperboloid's centre, in one unit, and each may be named; or rows (n,
    10), (n, 13), (n, 16), or a table of columns: alpha, gamma, b, d, x, y, z at the start, x1, y1, z1 at the end.
    `axis`, (3,) or (n, 3), is any vector along the spheroid's axis of revolution, which keeps its direction during the
    sweep; by default it is vertical. The hyperboloid ends at the heights `z_min` and `z_max` along its axis; with
    `solid`, flat ends belong to it.

    The answer has `.hit`, `.first_lower` and `.first_upper`, floats between which the time of the first contact lies, 0
    at the start and 1 at the end, NaN where there is none, and `.first`, the same as exact fractions or None; for many
    sweeps these are arrays. One sweep may have fractions for numbers, and an `upward`, any vector along the
    hyperboloid's axis; its answer also has `.start`, `.end`, `.grazes`. Exact for every valid value; where the
    hyperboloid ends, a miss by less than 2^−240 of the spheroid's size counts as contact. Raises InputError where a
    size is not finite and > 0, a coordinate not finite, an axis without direction, or z_min not less than z_max.

    >>> passage((1, 2, 1, 1), (4, 0, 0), (0, 0, 0)).hit  # half of the way to the axis
    True
    """
    if columns:
        sweeps, columns = _by_position(sweeps, columns)
    sizes_and_points: tuple[Argument, ...] = (sweeps[:4], *sweeps[4:]) if len(sweeps) == 6 else sweeps
    heights = tuple(map(_of_python, (z_min, z_max, solid)))
    single = 3 <= len(sizes_and_points) <= 5 and not columns and not any(isinstance(end, list) for end in heights)
    if single and not any(map(_has_rows, (*sizes_and_points, axis))):
        sizes, start, end, *axes = map(_of_python, sizes_and_points)
        for name, twice in (("axis", axes and axis is not None), ("upward", axes[1:] and upward is not None)):
            if twice:
                raise InputError(f"{name} is given twice; it must be given once")
        direction = axes[0] if axes else _of_python(axis)
        tower, (low, high, flat) = axes[1] if axes[1:] else _of_python(upward), heights
        return swept.passage(sizes, start, end, direction, tower, z_min=low, z_max=high, solid=flat)
    from hypcheck.kernel.passages import passages  # noqa: PLC0415 - it loads numpy, and one sweep does without

    if upward is not None:
        raise InputError("upward is given, and the sweeps are many; a scene has tilted hyperboloids")
    return passages(sweeps, columns, axis, (z_min, z_max, solid))


def _of_python(value: Argument) -> Any:  # noqa: ANN401 - whatever it is
    """Return numbers of numpy as numbers of Python, in sequences too, and arrays as lists; a tuple is a list then."""
    if isinstance(value, (list, tuple)):
        return [_of_python(part) for part in value]
    return value.tolist() if hasattr(value, "tolist") else value


def _by_position(
    sweeps: tuple[Argument, ...], columns: dict[str, Argument]
) -> tuple[tuple[Argument, ...], dict[str, Argument]]:
    """Return named arguments in order of position, if these are all sizes, a start and an end."""
    first = SIZES if len(sweeps) in (0, 4, 5) else ("sizes",)
    names = (*first, "start", "end")[len(sweeps) :]
    if set(columns) != set(names):
        return sweeps, columns
    return (*sweeps, *(columns[name] for name in names)), {}


def _has_rows(value: object) -> bool:
    """Whether a value contains many sweeps: neither a number nor a sequence of numbers."""
    dimensions = getattr(value, "ndim", None)
    if dimensions is not None:
        return bool(dimensions > 1)
    return hasattr(value, "keys") or (
        isinstance(value, (list, tuple))
        and (not value or any(isinstance(part, (list, tuple)) or getattr(part, "ndim", 0) for part in value))
    )
