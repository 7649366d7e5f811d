"""The unit normal at a nearest point, and whether other points are as near: by floats, nothing is proved of either.

Where p is nearest to a spheroid, the nearest point s of the spheroid is p's foot on it, and the gradient of the
distance with respect to the centre is the unit vector from p to s: the spheroid's inward normal at s. It is found
without the difference of p and s, which cancels near contact. With p at (u, w) across and along the axis from the
centre, s is (b² u/(b² + t), d² w/(d² + t)) for the t ≥ 0 at which it lies on the spheroid, and its normal
(u/(b² + t), w/(d² + t)). That equation is convex and decreasing in t: Newton's method from below finds it without fail.

Other points are as near where a symmetry of both bodies moves p. Symmetries are mirrors at z = 0 and at the vertical
plane through the centre, or through the axis, and turns about z by any angle, or by half of one.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import PAIRS, Floats, Mask, Positions, Rows, parts_of, with_heights

_TURNS, _SETTLED = 100, 2.0**-50
_OFF = 2.0**-20
"""How far from a mirror, in units of the greatest coordinate, a point has to be to be moved by it."""


def normals(rows: Rows, nearest: Rows, position: Positions) -> Rows:
    """Unit vectors (n, 3) from nearest points to the spheroids of rows of any width; NaN in contact."""
    with np.errstate(all="ignore"):
        axis = _unit(with_heights(rows)[:, 7:10])
        size = rows[:, 2:4].max(axis=1)
        way = (nearest - rows[:, 4:7]) / size[:, None]
        b2, d2 = (rows[:, 2:4] / size[:, None]).T ** 2
        w = (way * axis).sum(axis=1)
        across = way - w[:, None] * axis
        u = np.sqrt((across * across).sum(axis=1))
        t = _foot(b2, d2, u, np.abs(w))
        normal = 0.0 - _unit(across / (b2 + t)[:, None] + axis * (w / (d2 + t))[:, None])
    normal[(position == 0) | (position == REFUSED)] = np.nan
    return normal


def _foot(b2: Floats, d2: Floats, u: Floats, w: Floats) -> Floats:
    """The t of points (u, w) outside spheroids of these squared semi-axes, to about 2⁻⁴⁸ of themselves."""
    t = np.maximum(np.maximum(np.sqrt(b2) * u - b2, np.sqrt(d2) * w - d2), 0)
    for _ in range(_TURNS):
        p, q = b2 + t, d2 + t
        first, second = b2 * (u / p) ** 2, d2 * (w / q) ** 2
        step = np.fmax((first + second - 1) / (2 * (first / p + second / q)), 0)
        t = t + step
        if not (step > _SETTLED * (t + b2 + d2)).any():
            break
    return np.asarray(t)


def _unit(vectors: Rows) -> Rows:
    scaled = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    return np.asarray(scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True)))


def ties(rows: Rows, nearest: Rows, position: Positions) -> Mask:
    """Whether a symmetry of both bodies, which floats see, moves the nearest point; False in contact, (n,)."""
    _, axis, heights = parts_of(with_heights(rows), PAIRS)
    x, y, z = rows[:, 4:7].T
    ax, ay, az = axis.T
    sphere = rows[:, 2] == rows[:, 3]
    vertical, horizontal = sphere | ((ax == 0) & (ay == 0)), sphere | (az == 0)
    centred, level = (x == 0) & (y == 0), (z == 0) & (heights[:, 0] == -heights[:, 1])
    with np.errstate(all="ignore"):
        scale = _OFF * np.abs(np.hstack([nearest, rows[:, 4:7]])).max(axis=1)
        mirror = np.where(centred[:, None], axis[:, :2], rows[:, 4:6])
        mirror = mirror / np.hypot(mirror[:, 0], mirror[:, 1])[:, None]
        beside = np.abs(mirror[:, 0] * nearest[:, 1] - mirror[:, 1] * nearest[:, 0]) > scale
        upright_plane = vertical | (x * ay == y * ax) | ((az == 0) & (x * ax + y * ay == 0))
        off_level = np.abs(nearest[:, 2]) > scale
        off_axis = np.hypot(nearest[:, 0], nearest[:, 1]) > scale
    tied = level & (vertical | horizontal) & off_level
    tied |= upright_plane & beside
    tied |= centred & (vertical | horizontal) & off_axis
    tied |= centred & level
    return np.asarray(tied & (position != 0) & (position != REFUSED))
