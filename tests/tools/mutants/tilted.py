"""Spheroids that lean: the axis read, normalised or turned wrongly, other bodies in its place; and some right ones.

Each answers rows of ten numbers exactly, after what its sentence says was done to the row; so it is wrong because of
that alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from hypcheck import classify
from hypcheck.geometry.pair import Lengths
from tests.support import inside
from tests.tools.mutants.dual import dual_positions
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

hypcheck = {"tilt": True}

UPRIGHT = (0.0, 0.0, 1.0)
LEANING = ("--families", "tilted-near-contact,tilted-small-integers,tilted-slight", "--count", "0")
"""What most of them are asked, which is enough to reject them; proving how wrong an answer is takes its time."""


def _answered(rows):
    """The right answers to these rows; contact to what is no row."""
    answers = classify(rows, on_invalid="flag")
    return np.where(answers == 127, 0, answers).astype(np.int8)


def _with_axis(rows, x, y, z):
    """The answers about spheroids with another axis, upright where that has no direction."""
    changed = rows.copy()
    changed[:, 7], changed[:, 8], changed[:, 9] = x, y, z
    changed[~changed[:, 7:].any(axis=1), 7:] = UPRIGHT
    return _answered(changed)


def _with_angle(rows, change: Callable[[Any], Any]):
    """The answers about spheroids that lean by another angle, in radians from the vertical."""
    x, y, z = rows[:, 7:].T
    across = np.hypot(x, y)
    angle = change(np.arctan2(across, z))
    scale = np.sin(angle) / np.where(across == 0, 1, across)
    return _with_axis(rows, x * scale, y * scale, np.cos(angle))


def _with_sizes(rows, b, d, *, upright=False):
    """The answers about spheroids with other semi-axes."""
    changed = rows.copy()
    changed[:, 2], changed[:, 3] = b, d
    if upright:
        changed[:, 7:] = UPRIGHT
    return _answered(changed)


def _lengths(rows):
    """The axis's length, and its part that is vertical, from 0 to 1."""
    x, y, z = rows[:, 7:].T
    length = np.sqrt(x * x + y * y + z * z)
    return length, np.abs(z) / length


def _along(rows, factor):
    """M = I/b² + (1/d² − 1/b²) f v vᵀ/(v·v): a spheroid with another d, as long as it can be where that is none."""
    b, d = rows[:, 2], rows[:, 3]
    square = 1 / b**2 + (1 / d**2 - 1 / b**2) * factor
    return _with_sizes(rows, b, 1 / np.sqrt(np.maximum(square, 1e-12)))


def _with_matrix(rows, change: Callable[[Any], Any]):
    """The answers about ellipsoids with another matrix M, wherever it makes a difference in floats."""
    others = dual_positions(rows, change)
    return np.where(others == dual_positions(rows, lambda M: M), _answered(rows), others).astype(np.int8)


def _off_diagonal(M, factors):
    """M with its cross terms xy, xz, yz multiplied."""
    changed = M.copy()
    for (i, j), factor in zip(((0, 1), (0, 2), (1, 2)), factors, strict=True):
        changed[:, i, j] *= factor
        changed[:, j, i] *= factor
    return changed


@wrong(claim=LEANING)
def axis_ignored(rows):
    """Each spheroid stands upright."""
    return _with_axis(rows, *UPRIGHT)


@wrong(claim=LEANING)
def only_yaw(rows):
    """Of the turn only the heading is taken: what leans lies flat."""
    return _with_axis(rows, rows[:, 7], rows[:, 8], 0.0)


@wrong(claim=LEANING)
def only_pitch(rows):
    """Of the turn only the angle from the vertical is taken, always towards x."""
    return _with_axis(rows, np.hypot(rows[:, 7], rows[:, 8]), 0.0, rows[:, 9])


@wrong(claim=LEANING)
def leans_towards_the_centre(rows):
    """The axis is taken to lie in the plane through the centre and the hyperboloid's axis."""
    x, y = rows[:, 4:6].T
    away = np.hypot(x, y)
    across = np.hypot(rows[:, 7], rows[:, 8]) / np.where(away == 0, 1, away)
    return _with_axis(rows, x * across, y * across, rows[:, 9])


@wrong(claim=LEANING)
def transposed_rotation(rows):
    """The least turn from the vertical to the axis, transposed: it leans the other way."""
    return _with_axis(rows, -rows[:, 7], -rows[:, 8], rows[:, 9])


@wrong(claim=LEANING)
def left_handed(rows):
    """The axis's y in a left-handed frame."""
    return _with_axis(rows, rows[:, 7], -rows[:, 8], rows[:, 9])


@wrong(claim=LEANING)
def x_and_y_exchanged(rows):
    """axis_x and axis_y exchanged."""
    return _with_axis(rows, rows[:, 8], rows[:, 7], rows[:, 9])


@wrong(claim=LEANING)
def y_is_up(rows):
    """axis_y and axis_z exchanged, as in engines where y is up."""
    return _with_axis(rows, rows[:, 7], rows[:, 9], rows[:, 8])


@wrong(claim=LEANING)
def last_is_first(rows):
    """The axis read as z, y, x."""
    return _with_axis(rows, *rows[:, :6:-1].T)


@wrong(claim=LEANING)
def degrees_for_radians(rows):
    """An angle in degrees goes to a sine that takes radians."""
    return _with_angle(rows, np.degrees)


@wrong(claim=LEANING)
def radians_for_degrees(rows):
    """An angle in radians goes to a sine that takes degrees: hardly anything leans."""
    return _with_angle(rows, np.radians)


@wrong(claim=LEANING)
def half_the_angle(rows):
    """The half angle of a quaternion, not doubled."""
    return _with_angle(rows, lambda angle: angle / 2)


@wrong(claim=LEANING)
def twice_the_angle(rows):
    """The angle, turned by twice."""
    return _with_angle(rows, lambda angle: 2 * angle)


@wrong(claim=LEANING)
def complement_of_the_angle(rows):
    """The angle from the horizontal in place of that from the vertical."""
    return _with_angle(rows, lambda angle: np.pi / 2 - angle)


@wrong(claim=LEANING)
def small_angles(rows):
    """sin θ ≈ θ and cos θ ≈ 1."""
    return _with_angle(rows, np.arctan)


@wrong(claim=LEANING)
def whole_degrees(rows):
    """The angle rounded to whole degrees."""
    return _with_angle(rows, lambda angle: np.radians(np.round(np.degrees(angle))))


@wrong(claim=LEANING)
def slight_tilts_are_none(rows):
    """An angle of less than five degrees is taken for none."""
    return _with_angle(rows, lambda angle: np.where(np.minimum(angle, np.pi - angle) < np.radians(5), 0, angle))


@wrong(claim=LEANING)
def at_most_45_degrees(rows):
    """A drone that leans farther is taken to lean by 45 degrees."""
    return _with_angle(rows, lambda angle: np.minimum(np.minimum(angle, np.pi - angle), np.pi / 4))


@wrong(claim=LEANING)
def not_normalised(rows):
    """v vᵀ without the division by v·v."""
    return _along(rows, _lengths(rows)[0] ** 2)


@wrong(claim=LEANING)
def divided_by_the_length(rows):
    """v vᵀ divided by |v| in place of v·v."""
    return _along(rows, _lengths(rows)[0])


@wrong(claim=LEANING)
def normalised_by_the_sum(rows):
    """The axis divided by the sum of its numbers' sizes."""
    return _along(rows, (_lengths(rows)[0] / np.abs(rows[:, 7:]).sum(axis=1)) ** 2)


@wrong(claim=LEANING)
def normalised_by_the_greatest(rows):
    """The axis divided by the greatest of its numbers."""
    return _along(rows, (_lengths(rows)[0] / np.abs(rows[:, 7:]).max(axis=1)) ** 2)


@wrong(claim=LEANING)
def length_of_the_axis_is_d(rows):
    """The axis is taken for a semi-axis: its length in place of d."""
    return _with_sizes(rows, rows[:, 2], _lengths(rows)[0])


@wrong(claim=LEANING)
def axis_in_float32(rows):
    """The axis goes through float32."""
    return _with_axis(rows, *rows[:, 7:].astype(np.float32).astype(np.float64).T)


@wrong(claim=LEANING)
def direction_in_float32(rows):
    """The axis is normalised, and its direction goes through float32."""
    direction = (rows[:, 7:].T / _lengths(rows)[0]).astype(np.float32)
    return _with_axis(rows, *direction.astype(np.float64))


@wrong(claim=LEANING)
def sign_of_the_axis_matters(rows):
    """An axis that points down is turned up by the sign of its z alone."""
    return _with_axis(rows, rows[:, 7], rows[:, 8], np.abs(rows[:, 9]))


@wrong(claim=LEANING)
def pointing_down_is_upright(rows):
    """Only an axis that points up leans."""
    return _with_axis(rows, *np.where(rows[:, 9:] > 0, rows[:, 7:], UPRIGHT).T)


@wrong(claim=LEANING)
def centre_turned(rows):
    """The centre is turned by the tilt, and the body stands upright."""
    changed = rows.copy()
    changed[:, 4:7] = _turned(rows[:, 4:7], rows[:, 7:])
    changed[:, 7:] = UPRIGHT
    return _answered(changed)


@wrong(claim=LEANING)
def body_and_centre_turned(rows):
    """The body leans, and the centre is turned with it."""
    changed = rows.copy()
    changed[:, 4:7] = _turned(rows[:, 4:7], rows[:, 7:])
    return _answered(changed)


def _turned(points, axes):
    """The points after the least turn that brings the vertical to the axis (Rodrigues' formula)."""
    axes = axes / np.sqrt((axes * axes).sum(axis=1, keepdims=True))
    axes = np.where(axes[:, 2:] < 0, -axes, axes)
    normal = np.cross(np.array(UPRIGHT), axes)
    across = np.cross(normal, points)
    return points + across + np.cross(normal, across) / (1 + axes[:, 2:])


@wrong(claim=LEANING)
def b_for_d(rows):
    """b along the axis, and d across."""
    return _with_sizes(rows, rows[:, 3], rows[:, 2])


@wrong(claim=LEANING)
def eigenvectors_out_of_order(rows):
    """Eigenvalues in ascending order, eigenvectors with the axis first: right where d is the greater."""
    x, y, _ = rows[:, 7:].T
    flat = rows[:, 3] < rows[:, 2]
    level = (x == 0) & (y == 0)
    return _with_axis(
        rows,
        np.where(flat, np.where(level, 1.0, -y), x),
        np.where(flat, np.where(level, 0.0, x), y),
        np.where(flat, 0.0, rows[:, 9]),
    )


@wrong(claim=LEANING)
def cross_term_xy_negated(rows):
    """M has −xy."""
    return _with_matrix(rows, lambda M: _off_diagonal(M, (-1, 1, 1)))


@wrong(claim=LEANING)
def cross_term_xz_negated(rows):
    """M has −xz."""
    return _with_matrix(rows, lambda M: _off_diagonal(M, (1, -1, 1)))


@wrong(claim=LEANING)
def cross_terms_twice(rows):
    """The cross terms, counted twice."""
    return _with_matrix(rows, lambda M: _off_diagonal(M, (2, 2, 2)))


@wrong(claim=LEANING)
def cross_terms_forgotten(rows):
    """The diagonal of M alone."""
    return _with_matrix(rows, lambda M: _off_diagonal(M, (0, 0, 0)))


@wrong(claim=LEANING)
def ends_of_the_axis(rows):
    """Clear where the centre and both ends of the axis are on one side."""
    tips = (rows[:, 3] / _lengths(rows)[0])[:, None] * rows[:, 7:]
    sides = [_side(rows, rows[:, 4:7] + sign * tips) for sign in (-1, 0, 1)]
    return np.where((sides[0] == sides[1]) & (sides[1] == sides[2]), sides[1], 0).astype(np.int8)


def _side(rows, points):
    alpha, gamma = rows[:, :2].T
    x, y, z = points.T
    return np.sign((x / alpha) ** 2 + (y / alpha) ** 2 - (z / gamma) ** 2 - 1)


@wrong(claim=LEANING)
def bounding_sphere(rows):
    """A ball about the spheroid in its place."""
    return _with_sizes(rows, *[rows[:, 2:4].max(axis=1)] * 2)


@wrong(claim=LEANING)
def inscribed_sphere(rows):
    """The ball within the spheroid in its place."""
    return _with_sizes(rows, *[rows[:, 2:4].min(axis=1)] * 2)


@wrong(claim=LEANING)
def upright_with_the_same_extent(rows):
    """An upright spheroid as high, and on average as wide."""
    b, d, vertical = rows[:, 2], rows[:, 3], _lengths(rows)[1]
    high = np.sqrt(b**2 + (d**2 - b**2) * vertical**2)
    wide = np.sqrt(b**2 + (d**2 - b**2) * (1 - vertical**2) / 2)
    return _with_sizes(rows, wide, high, upright=True)


@wrong(claim=LEANING)
def horizontal_is_contact(rows):
    """The tilt as a tangent, which a horizontal axis has not: contact."""
    return np.where(rows[:, 9] == 0, 0, _answered(rows)).astype(np.int8)


@wrong()
def contact_level_with_the_waist_and_along_or_across(rows):
    """Contact where the axis is horizontal, z = 0, and the axis is parallel or perpendicular to the centre."""
    level = (rows[:, 9] == 0) & (rows[:, 6] == 0)
    return np.where(level & _along_or_across(rows), 0, _answered(rows)).astype(np.int8)


@wrong()
def contact_on_the_axis_lying_flat(rows):
    """Contact where x = y = 0 and the axis is horizontal."""
    flat = (rows[:, 4:6] == 0).all(axis=1) & (rows[:, 9] == 0)
    return np.where(flat, 0, _answered(rows)).astype(np.int8)


@wrong()
def contact_inside_level_and_along_or_across(rows):
    """Contact where the spheroid is inside, z = 0, the axis horizontal, and parallel or perpendicular to the centre."""
    answers = _answered(rows)
    level = (rows[:, 9] == 0) & (rows[:, 6] == 0) & (rows[:, 4:6] != 0).any(axis=1) & (answers < 0)
    return np.where(level & _along_or_across(rows), 0, answers).astype(np.int8)


def _along_or_across(rows):
    """Whether the axis is parallel or at right angles to the centre, both taken level."""
    x, y, u, v = rows[:, [4, 5, 7, 8]].T
    return (x * v == y * u) | (x * u + y * v == 0)


@wrong(claim=LEANING)
def first_axis_for_all(rows):
    """The matrix of the first row's axis, for all rows of a question."""
    return _with_axis(rows, *rows[:1, 7:].T)


@right(asked=NO_TOLERANCE)
def kernel(rows):
    """What the wrong ones are made of: the fast path."""
    return _answered(rows)


@right(asked=NO_TOLERANCE)
def another_axis_of_the_same_direction(rows):
    """The axis doubled, and turned round."""
    return _with_axis(rows, *(-2 * rows[:, 7:] / 4).T)


@right(claim=LEANING, asked=NO_TOLERANCE)
def seen_from_the_side(rows):
    """Everything turned by a quarter about the hyperboloid's axis, and mirrored below its waist."""
    return [
        int(inside.position(Lengths.of((alpha, gamma, b, d, -y, x, -z, -axis_y, axis_x, -axis_z))))
        for alpha, gamma, b, d, x, y, z, axis_x, axis_y, axis_z in rows.tolist()
    ]
