"""What is tilted in a scene: the frames of hyperboloids, and the places of the parts of a mover."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin, sqrt

import numpy as np

from hypcheck.geometry.pair import UPRIGHT
from hypcheck.geometry.rows import Floats
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
    lean = np.flatnonzero((axes[:, :2] != 0).any(axis=1))
    along = axes[lean] / np.abs(axes[lean]).max(axis=1, keepdims=True)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    least = np.eye(3)[np.abs(along).argmin(axis=1)]  # the coordinate axis that is farthest from it
    across = np.cross(least, along)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    frames[lean] = np.stack([across, np.cross(along, across), along], axis=1)
    return frames


def turned(frames: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3) in frames (n, 3, 3)."""
    found: Floats = np.einsum("nij,nj->ni", frames, vectors)
    return found


def turned_axes(frames: Floats, axes: Floats | None) -> Floats:
    """The axes (n, 3) of a mover, None: it is upright, in frames. They are made about 1 long: none is rounded to 0."""
    if axes is None:
        return turned(frames, np.broadcast_to(UPRIGHT, (len(frames), 3)))
    return turned(frames, axes / np.abs(axes).max(axis=1, keepdims=True))


def places_of_parts(
    parts: Sequence[MoverPart], centre: Sequence[float], heading: float, axis: Sequence[float]
) -> list[Point]:
    """The centres of a mover's parts, rounded.

    A mover that leans is turned from upright about a horizontal line, the shortest way, to the axis u = v/|v| or −u,
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
