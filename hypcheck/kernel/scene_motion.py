"""One straight motion of an upright mover among upright hyperboloids, at the price of a few steps.

A planner asks for one motion at a time, and arrays of one number each cost it twenty times what the answer does. Here
the bounds of scene_index.py and scene_sweeps.py are asked with numbers of Python, and the kernel once or twice for all
hyperboloids that are near: about a mover that is larger by what the differences of centres have lost, and about one
that is smaller. The larger one meets whatever the true one meets, and the true one whatever the smaller one meets: at
each time the touched wall, rim or end lies in the larger spheroid, which has a point on either side of it or on it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite

import numpy as np

from hypcheck.geometry.pair import UPRIGHT
from hypcheck.geometry.rows import Floats
from hypcheck.kernel.in_use import kernel
from hypcheck.kernel.scene_index import LEAST_OF_WAYS, LONGEST_SQUARE, OUTWARD, PAD, Bodies, PlaneGrid
from hypcheck.kernel.scene_pairs import GREATEST, LEAST, MARGIN, ROUNDED
from hypcheck.scene.model import Mover

Place = tuple[float, float, float]

Near = tuple[Place, float, tuple[float, float], tuple[float, float], tuple[float, float, float]]
"""Of a hyperboloid: its centre, its reach, the heights of a mover's centre in the scene between which it can be
touched, α and γ, and z_min, z_max and solid.
"""


def near_of(bodies: Bodies, reaches: Floats, limits: Floats, index: int) -> Near:
    """A hyperboloid's numbers; `reaches` and `limits` are those of scene_index and scene_ends for the scene's mover."""
    low, high, *_ = limits[index].tolist()
    x, y, z = bodies.origins[index].tolist()
    alpha, gamma = bodies.shapes[index].tolist()
    z_min, z_max = bodies.spans[index].tolist()
    return (x, y, z), float(reaches[index]), (low, high), (alpha, gamma), (z_min, z_max, float(bodies.solid[index]))


def point_at_once(given: object) -> Place | None:
    """Three finite numbers in a list, a tuple or an array, and None for everything else that may be a point."""
    values = given.tolist() if type(given) is np.ndarray and given.shape == (3,) else given
    if not isinstance(values, (list, tuple)) or len(values) != 3:
        return None
    if not all(isinstance(value, float) or type(value) is int for value in values):
        return None
    x, y, z = (float(value) if abs(value) < GREATEST else inf for value in values)
    return (x, y, z) if isfinite(x) and isfinite(y) and isfinite(z) else None


def hit_at_once(grid: PlaneGrid, near: Callable[[int], Near], mover: Mover, start: Place, end: Place) -> bool | None:
    """Whether the mover itself has contact on its way, and None where bounds do not tell."""
    candidates = grid.near_way(start[0], start[1], end[0], end[1])
    if candidates is None:
        return None
    beside, most = [], 0.0
    for index in _passed(candidates, near, start, end):
        centre, _, _, shape, ends = near(index)
        begin, lost_at_start = _differences(start, centre)
        finish, lost_at_end = _differences(end, centre)
        beside.append((shape, (*begin, *finish, *UPRIGHT, *ends)))
        lost = sum(map(max, lost_at_start, lost_at_end))
        if not lost < GREATEST:
            return None
        most = max(most, lost)
    if not beside:
        return False
    if not (min(mover.b, mover.d) > LEAST and max(mover.b, mover.d) < GREATEST):
        return None
    stretch = most / min(mover.b, mover.d) * (1 + MARGIN) + ROUNDED if most else 0.0
    larger = _hits(beside, mover, 1 + stretch)
    if not any(larger):
        return False
    if stretch == 0:
        return True if 1 in larger else None
    touched = [numbers for numbers, hit in zip(beside, larger, strict=True) if hit]
    return True if stretch < 1 and 1 in _hits(touched, mover, 1 - stretch) else None


def _hits(beside: Sequence[tuple[tuple[float, float], tuple[float, ...]]], mover: Mover, scale: float) -> list[int]:
    """What the kernel says of the mover, larger or smaller by a factor, beside each."""
    semi_axes = mover.b * scale, mover.d * scale
    hits: list[int] = kernel().answer_ways(np.array([(*shape, *semi_axes, *way) for shape, way in beside]))[0].tolist()
    return hits


def _differences(point: Place, centre: Place) -> tuple[Place, Place]:
    """The differences of coordinates, rounded, and how much each has lost, by TwoSum; NaN where that is not known."""
    (x, y, z), (u, v, w) = point, centre
    across, along, up = x - u, y - v, z - w
    back_x, back_y, back_z = across + u, along + v, up + w
    return (across, along, up), (
        abs((x - back_x) - (u - (back_x - across))),
        abs((y - back_y) - (v - (back_y - along))),
        abs((z - back_z) - (w - (back_z - up))),
    )


def _passed(candidates: set[int], near: Callable[[int], Near], start: Place, end: Place) -> list[int]:
    """Those that the way comes as near to as they reach: scene_index.passed, with numbers."""
    (x, y, z), (x_end, y_end, z_end) = start, end
    lowest, highest = (z, z_end) if z < z_end else (z_end, z)
    across, along = x_end - x, y_end - y
    length = across * across + along * along
    size = abs(x) + abs(y) + abs(x_end) + abs(y_end)
    found = []
    for index in candidates:
        (u, v, _), reach, (low, high), _, _ = near(index)
        if highest < low or lowest > high:  # beyond an end
            continue
        most = reach * OUTWARD + (PAD * (size + abs(u) + abs(v)) + LEAST_OF_WAYS)
        u, v = u - x, v - y
        time = (across * u + along * v) / length if length else 0.0
        time = min(time, 1.0) if time > 0 else 0.0
        u, v = u - time * across, v - time * along
        if not (u * u + v * v > most * most and length < LONGEST_SQUARE):
            found.append(index)
    return found
