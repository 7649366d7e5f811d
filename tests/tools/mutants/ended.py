"""Hyperboloids that end: ends, rims and discs forgotten or taken for others; and some right ones.

Each answers rows of thirteen numbers exactly, after what its sentence says was done to the row; so it is wrong because
of that alone.
"""

from __future__ import annotations

import numpy as np

from hypcheck import classify
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

hypcheck = {"takes": ["axis", "heights"]}

ENDED = ("--families", "*ended-*", "--count", "0")
"""What most of them are asked, which is enough to reject them."""


def _answered(rows):
    """The right answers to these rows; contact to what is no row."""
    answers = classify(np.ascontiguousarray(rows), on_invalid="flag")
    return np.where(answers == 127, 0, answers).astype(np.int8)


def _without_ends(rows):
    return _answered(rows[:, :10])


def _with(rows, **columns):
    """The answers to rows with other numbers in some columns."""
    changed = rows.copy()
    names = ("alpha", "gamma", "b", "d", "x", "y", "z", "axis_x", "axis_y", "axis_z", "z_min", "z_max", "solid")
    for name, values in columns.items():
        changed[:, names.index(name)] = values
    return _answered(changed)


def _beyond(rows):
    """Whether the centre lies below or above both ends."""
    return (rows[:, 6] < rows[:, 10]) | (rows[:, 6] > rows[:, 11])


@wrong(claim=ENDED)
def height_of_the_centre_alone(rows):
    """Exterior where the centre is beyond an end, else the answer without ends."""
    return np.where(_beyond(rows), 1, _without_ends(rows)).astype(np.int8)


@wrong(claim=ENDED)
def ends_ignored(rows):
    """The answer without ends."""
    return _without_ends(rows)


@wrong(claim=ENDED)
def discs_ignored(rows):
    """A solid body has no flat ends."""
    return _with(rows, solid=0.0)


@wrong(claim=ENDED)
def closed_for_open(rows):
    """Every body has flat ends."""
    return _with(rows, solid=1.0)


@wrong(claim=ENDED)
def rim_forgotten(rows):
    """The wall is looked for strictly between the ends, a millionth of a radius away from them."""
    inside = 1e-6 * rows[:, 3]
    low, high = rows[:, 10] + inside, rows[:, 11] - inside
    return np.where(low < high, _with(rows, z_min=np.where(low < high, low, rows[:, 10]), z_max=high), 1).astype(
        np.int8
    )


@wrong(claim=ENDED)
def lower_end_with_the_other_sign(rows):
    """z_min is how far the body goes down, so that its sign is turned."""
    return _with(rows, z_min=np.minimum(-rows[:, 10], rows[:, 11] - 1e-3 * rows[:, 3]))


@wrong(claim=ENDED)
def ends_along_the_axis_of_the_spheroid(rows):
    """Ends are measured along the spheroid's axis."""
    length = np.sqrt((rows[:, 7:10] ** 2).sum(axis=1))
    along = np.maximum(np.abs(rows[:, 9]) / length, 1e-3)
    return _with(rows, z_min=rows[:, 10] / along, z_max=rows[:, 11] / along)


@wrong(claim=ENDED)
def radius_of_the_waist_at_the_rim(rows):
    """Where the spheroid reaches beyond an end, the wall is a cylinder as wide as the waist."""
    reach = np.maximum(rows[:, 2], rows[:, 3])
    straddles = (np.abs(rows[:, 6] - rows[:, 10]) < reach) | (np.abs(rows[:, 6] - rows[:, 11]) < reach)
    return _with(rows, gamma=np.where(straddles, 1e6 * rows[:, 1], rows[:, 1]))


@wrong(claim=ENDED)
def swallowed_wall_is_clear(rows):
    """A wall within the spheroid does not cross its surface: no contact."""
    return np.where(_swallowed(rows), 1, _answered(rows)).astype(np.int8)


def _swallowed(rows):
    """Whether points all around both rims, and between, lie inside the spheroid."""
    alpha, gamma, b, d = rows[:, :4].T
    axis = rows[:, 7:10] / np.sqrt((rows[:, 7:10] ** 2).sum(axis=1))[:, None]
    within = np.isfinite(rows[:, 10:12]).all(axis=1)
    low, high = np.where(within, rows[:, 10:12].T, 0.0)
    for share in (0.0, 0.5, 1.0):
        w = low + share * (high - low)
        for angle in np.arange(16) * np.pi / 8:
            r = alpha * np.hypot(1, w / gamma)
            off = np.stack([r * np.cos(angle), r * np.sin(angle), w], axis=1) - rows[:, 4:7]
            along = (off * axis).sum(axis=1)
            within &= ((off * off).sum(axis=1) - along**2) / b**2 + along**2 / d**2 < 1
    return within


@wrong(claim=ENDED)
def inside_for_ever(rows):
    """What leaves through an opening without contact stays interior."""
    answers = _answered(rows)
    return np.where((answers == 1) & (_without_ends(rows) == -1), -1, answers).astype(np.int8)


@wrong(claim=ENDED)
def leaving_is_contact(rows):
    """The mouth of an open wall is closed by contact: a centre within a radius of it cannot be clear of it."""
    near = np.abs(rows[:, 6] - rows[:, 11]) < rows[:, 3]
    return np.where(near & (_without_ends(rows) == -1), 0, _answered(rows)).astype(np.int8)


@wrong(claim=ENDED)
def lowest_point_d_below(rows):
    """The spheroid ends d below and above its centre, however it is tilted: beyond that it is exterior."""
    apart = (rows[:, 6] - rows[:, 3] > rows[:, 11]) | (rows[:, 6] + rows[:, 3] < rows[:, 10])
    return np.where(apart, 1, _answered(rows)).astype(np.int8)


@right(claim=ENDED, asked=NO_TOLERANCE)
def kernel(rows):
    """What the wrong ones are made of: the fast path."""
    return _answered(rows)


@right(claim=ENDED, asked=NO_TOLERANCE)
def mirrored_below_the_waist(rows):
    """Everything mirrored at z = 0: centre, axis, and the ends exchanged."""
    return _with(rows, z=-rows[:, 6], axis_z=-rows[:, 9], z_min=-rows[:, 11], z_max=-rows[:, 10])
