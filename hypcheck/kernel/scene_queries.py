"""The forms of a query about a scene: numbers and columns, points, sweeps, axes; each is checked.

First what is tilted in a scene: the frames of hyperboloids, and the places of the parts of a mover.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, isfinite, radians, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, CENTER, NO_DIRECTION, UPRIGHT, trouble_with
from hypcheck.geometry.rows import Floats, as_columns, as_numbers
from hypcheck.scene.model import MoverPart, Point

TURNING = 128 * 2.0**-53
"""Of what is turned into a hyperboloid's frame, in units of the sum of all coordinates: see frames_of."""


def frames_of(axes: Floats) -> Floats:
    """Frames (n, 3, 3): the rows are two unit vectors across an axis and one along it; I where that is vertical.

    The numbers of the first two rows are within 6 u of those of an exact frame, so that those of their cross product
    are within 20 u. With three products and two sums in floats, each number of a turned vector is off by 24 u of the
    sum of the vector's numbers, and the vector by √3 times that; an axis, of which that sum is √3 lengths at most, by
    an angle of 72 u. TURNING is more than all of these.
    """
    frames = np.tile(np.eye(3), (len(axes), 1, 1))
    tilted = np.flatnonzero((axes[:, :2] != 0).any(axis=1))
    along = axes[tilted] / np.abs(axes[tilted]).max(axis=1, keepdims=True)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    least = np.eye(3)[np.abs(along).argmin(axis=1)]  # the coordinate axis that is farthest from it
    across = np.cross(least, along)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    frames[tilted] = np.stack([across, np.cross(along, across), along], axis=1)
    return frames


def turned(frames: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3) in frames (n, 3, 3)."""
    result: Floats = np.einsum("nij,nj->ni", frames, vectors)
    return result


def turned_axes(frames: Floats, axes: Floats | None) -> Floats:
    """The axes (n, 3) of a mover, None: it is upright, in frames. They are made about 1 long: none is rounded to 0."""
    if axes is None:
        return turned(frames, np.broadcast_to(UPRIGHT, (len(frames), 3)))
    return turned(frames, axes / np.abs(axes).max(axis=1, keepdims=True))


def places_of_parts(
    parts: Sequence[MoverPart], centre: Sequence[float], heading: float, axis: Sequence[float]
) -> list[Point]:
    """The centres of a mover's parts, rounded.

    A tilted mover is turned from upright about a horizontal line, the shortest way, to the axis u = v/|v| or −u,
    whichever does not point down. That takes a horizontal p to p − (p·u)/(1 + u_z) (u_x, u_y, 0) − (p·u) e_z.
    """
    x, y, z = centre
    turns = [(part.arm, radians(heading + part.angle)) for part in parts]
    arms = [(arm * cos(turn), arm * sin(turn)) for arm, turn in turns]
    if axis[0] == axis[1] == 0:
        return [(x + across, y + along, z) for across, along in arms]
    largest = max(map(abs, axis)) * (-1 if axis[2] < 0 else 1)
    u, v, w = (part / largest for part in axis)
    norm = sqrt(u * u + v * v + w * w)
    u, v, w = u / norm, v / norm, w / norm
    places = []
    for across, along in arms:
        sink = across * u + along * v
        back = sink / (1 + w)
        places.append((x + (across - back * u), y + (along - back * v), z - sink))
    return places


POINTS = f"it must be three numbers, {', '.join(CENTER)}, or an array (n, 3) of them"


def are_one(center: Sequence[ArrayLike], heading: ArrayLike, axis: ArrayLike | None) -> bool:
    """Whether a query is one centre given as numbers; its answer then is a number, too."""
    return not any(map(np.ndim, (*center, heading))) and np.ndim(() if axis is None else axis) == 1


def sweeps_of(start: ArrayLike, end: ArrayLike, heading: ArrayLike, axes: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """The ends of sweeps, (n, 3) each, headings (n,), and the numbers of axes. Raises InputError where they are not."""
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
    """The columns as as_columns makes them. Raises InputError about the first number that is not finite."""
    columns = as_columns(names, arguments)
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
