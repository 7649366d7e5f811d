"""Causes about every row of tilted spheroids: the axis ignored, read, normalised or turned wrongly; other bodies.

Each is answered exactly after what its sentence says was done to the row.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.runs.causes import Rule, Standing
from hypcheck.runs.slips import Changed, causes_told, put, swapped


def _axis(compute: Callable[[Floats, Floats, Floats], tuple[Floats, Floats, Floats]]) -> Changed:
    """The rows with another axis; upright where that has no direction."""

    def change(rows: Rows) -> Rows:
        x, y, z = compute(*rows[:, 7:].T.copy())
        rows[:, 7:] = np.column_stack([x, y, z])
        rows[~rows[:, 7:].any(axis=1), 7:] = (0.0, 0.0, 1.0)
        return rows

    return Changed(change)


def _angle(turn: Callable[[Floats], Floats]) -> Changed:
    """The rows with the axis at another angle from the vertical, in radians."""

    def compute(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
        across = np.hypot(x, y)
        angle = turn(np.arctan2(across, z))
        scale = np.sin(angle) / np.where(across == 0, 1, across)
        return x * scale, y * scale, np.cos(angle)

    return _axis(compute)


def _in_float32(values: Floats) -> Floats:
    return values.astype(np.float32).astype(np.float64)


def _direction_in_float32(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    length = np.sqrt(x * x + y * y + z * z)
    return _in_float32(x / length), _in_float32(y / length), _in_float32(z / length)


def _along(factor: Callable[[Rows], Floats]) -> Changed:
    """M = I/b² + (1/d² − 1/b²) f v vᵀ/(v·v): the spheroid that a factor f of 1 would leave as it is."""

    def change(rows: Rows) -> Rows:
        b, d = rows[:, 2], rows[:, 3]
        square = 1 / b**2 + (1 / d**2 - 1 / b**2) * factor(rows[:, 7:])
        rows[:, 3] = 1 / np.sqrt(np.where(square > 0, square, 1e-12))
        return rows

    return Changed(change)


_UNIT_AXIS = "divide the axis by √(axis·axis)"
_AXIS = "the axis is the spheroid's own, (axis_x, axis_y, axis_z), its z up"

_TILTED: tuple[tuple[str, str, str, Rule], ...] = (
    (
        "axis-ignored",
        "it answers as if each spheroid stood upright",
        _AXIS,
        _axis(lambda x, y, z: (0 * x, 0 * y, 1 + 0 * z)),
    ),
    ("axis-level", "it answers as if what leans lay flat", _AXIS, _axis(lambda x, y, z: (x, y, 0 * z))),
    (
        "axis-towards-x",
        "it answers as if the axis always leant towards x",
        _AXIS,
        _axis(lambda x, y, z: (np.hypot(x, y), 0 * y, z)),
    ),
    (
        "axis-turned-back",
        "it answers as if the axis leant the other way (a rotation transposed)",
        _AXIS,
        _axis(lambda x, y, z: (-x, -y, z)),
    ),
    (
        "axis-y-negated",
        "it answers as if axis_y had the other sign (a left-handed frame)",
        _AXIS,
        _axis(lambda x, y, z: (x, -y, z)),
    ),
    ("axis-x-y", "it answers as if axis_x and axis_y changed places", _AXIS, _axis(lambda x, y, z: (y, x, z))),
    ("axis-y-z", "it answers as if axis_y and axis_z changed places (y up)", _AXIS, _axis(lambda x, y, z: (x, z, y))),
    ("axis-x-z", "it answers as if the axis were read as z, y, x", _AXIS, _axis(lambda x, y, z: (z, y, x))),
    (
        "axis-sign",
        "it answers as if the z of the axis had no sign, but x and y had",
        "negate the whole axis or nothing",
        _axis(lambda x, y, z: (x, y, np.abs(z))),
    ),
    (
        "axis-down",
        "it answers as if an axis that points down stood upright",
        "an axis and its negative mean one spheroid",
        _axis(lambda x, y, z: (np.where(z > 0, x, 0), np.where(z > 0, y, 0), np.where(z > 0, z, 1))),
    ),
    ("degrees-as-radians", "it takes the lean in degrees for radians", "the sine takes radians", _angle(np.degrees)),
    ("radians-as-degrees", "it takes the lean in radians for degrees", "the sine takes radians", _angle(np.radians)),
    ("half-angle", "it leans by half the angle", "a quaternion has the half angle", _angle(lambda angle: angle / 2)),
    ("double-angle", "it leans by twice the angle", "turn once", _angle(lambda angle: 2 * angle)),
    (
        "angle-from-the-plane",
        "it takes the angle from the vertical for that from the horizontal",
        _AXIS,
        _angle(lambda angle: np.pi / 2 - angle),
    ),
    ("small-angle", "it takes sin θ for θ and cos θ for 1", "compute sine and cosine", _angle(np.arctan)),
    ("axis-not-normalised", "it does not divide v vᵀ by v·v", _UNIT_AXIS, _along(lambda v: (v * v).sum(axis=1))),
    (
        "axis-over-length",
        "it divides v vᵀ by |v|, not by v·v",
        _UNIT_AXIS,
        _along(lambda v: np.sqrt((v * v).sum(axis=1))),
    ),
    (
        "axis-over-sum",
        "it divides the axis by the sum of its numbers",
        _UNIT_AXIS,
        _along(lambda v: (v * v).sum(axis=1) / np.abs(v).sum(axis=1) ** 2),
    ),
    (
        "axis-over-greatest",
        "it divides the axis by its greatest number",
        _UNIT_AXIS,
        _along(lambda v: (v * v).sum(axis=1) / np.abs(v).max(axis=1) ** 2),
    ),
    (
        "axis-in-float32",
        "it rounds the axis to float32",
        "keep the axis in float64",
        _axis(lambda x, y, z: (_in_float32(x), _in_float32(y), _in_float32(z))),
    ),
    (
        "direction-in-float32",
        "it rounds the unit axis to float32",
        "keep the axis in float64",
        _axis(_direction_in_float32),
    ),
    (
        "axis-is-d",
        "it takes the length of the axis for d",
        "the length of the axis means nothing",
        put(d=lambda c: np.sqrt(c["axis_x"] ** 2 + c["axis_y"] ** 2 + c["axis_z"] ** 2)),
    ),
    ("tilted-b-d", "it puts b along the axis and d across", "d is the semi-axis along the axis", swapped("b", "d")),
    (
        "tilted-ball-around",
        "it answers for the smallest ball around the spheroid",
        "use both semi-axes",
        put(b=lambda c: np.maximum(c["b"], c["d"]), d=lambda c: np.maximum(c["b"], c["d"])),
    ),
    (
        "tilted-ball-within",
        "it answers for the largest ball in the spheroid",
        "use both semi-axes",
        put(b=lambda c: np.minimum(c["b"], c["d"]), d=lambda c: np.minimum(c["b"], c["d"])),
    ),
)


TILTED_SLIPS = causes_told(_TILTED, "tilted", Standing.EVERYWHERE)
"""The simplest first."""
