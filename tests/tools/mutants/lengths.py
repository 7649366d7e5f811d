"""Lengths confused, ignored or misread; the geometry behind them is right."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import wrong

ALPHA, GAMMA, B, D, X, Y, Z = range(7)


def _columns(rows, *order):
    """The rows with their columns taken in another order."""
    return np.ascontiguousarray(rows[:, order])


def _with(rows, **columns):
    """The rows with some columns replaced."""
    changed = np.array(rows)
    for name, values in columns.items():
        changed[:, ("alpha", "gamma", "b", "d", "x", "y", "z").index(name)] = values
    return changed


@wrong()
def alpha_and_gamma_swapped(rows):
    """α and γ change places."""
    return position(_columns(rows, GAMMA, ALPHA, B, D, X, Y, Z))


@wrong()
def b_and_d_swapped(rows):
    """b and d change places."""
    return position(_columns(rows, ALPHA, GAMMA, D, B, X, Y, Z))


@wrong()
def alpha_and_b_swapped(rows):
    """α and b change places."""
    return position(_columns(rows, B, GAMMA, ALPHA, D, X, Y, Z))


@wrong()
def gamma_and_d_swapped(rows):
    """γ and d change places."""
    return position(_columns(rows, ALPHA, D, B, GAMMA, X, Y, Z))


@wrong()
def x_and_z_swapped(rows):
    """The axis is x instead of z."""
    return position(_columns(rows, ALPHA, GAMMA, B, D, Z, Y, X))


@wrong()
def y_and_z_swapped(rows):
    """The axis is y instead of z, as in engines where y is up."""
    return position(_columns(rows, ALPHA, GAMMA, B, D, X, Z, Y))


@wrong()
def x_ignored(rows):
    """x is taken for 0."""
    return position(_with(rows, x=0))


@wrong()
def y_ignored(rows):
    """y is taken for 0."""
    return position(_with(rows, y=0))


@wrong()
def z_ignored(rows):
    """z is taken for 0."""
    return position(_with(rows, z=0))


@wrong()
def x_for_y(rows):
    """r² = x² + x²."""
    return position(_with(rows, y=rows[:, X]))


@wrong()
def x_less_y(rows):
    """r² = |x² − y²|."""
    return position(_with(rows, x=np.sqrt(np.abs(rows[:, X] ** 2 - rows[:, Y] ** 2)), y=0))


@wrong()
def city_block_radius(rows):
    """r = |x| + |y|."""
    return position(_with(rows, x=np.abs(rows[:, X]) + np.abs(rows[:, Y]), y=0))


@wrong()
def chessboard_radius(rows):
    """r = max(|x|, |y|)."""
    return position(_with(rows, x=np.maximum(np.abs(rows[:, X]), np.abs(rows[:, Y])), y=0))


@wrong()
def below_is_level(rows):
    """A centre below the waist is taken for one in its plane."""
    return position(_with(rows, z=np.maximum(rows[:, Z], 0)))


@wrong()
def left_is_middle(rows):
    """A centre with negative x is taken for one with x = 0."""
    return position(_with(rows, x=np.maximum(rows[:, X], 0)))


@wrong()
def b_for_d(rows):
    """The spheroid is a ball of radius b."""
    return position(_with(rows, d=rows[:, B]))


@wrong()
def d_for_b(rows):
    """The spheroid is a ball of radius d."""
    return position(_with(rows, b=rows[:, D]))


@wrong()
def bounding_ball(rows):
    """The spheroid is the smallest ball around it."""
    radius = np.maximum(rows[:, B], rows[:, D])
    return position(_with(rows, b=radius, d=radius))


@wrong()
def inscribed_ball(rows):
    """The spheroid is the largest ball in it."""
    radius = np.minimum(rows[:, B], rows[:, D])
    return position(_with(rows, b=radius, d=radius))


@wrong()
def diameters_for_radii(rows):
    """b and d are taken for diameters."""
    return position(_with(rows, b=rows[:, B] / 2, d=rows[:, D] / 2))


@wrong()
def waist_diameter(rows):
    """α is taken for the waist's diameter."""
    return position(_with(rows, alpha=rows[:, ALPHA] / 2))


@wrong()
def gamma_for_alpha(rows):
    """γ = α: every hyperboloid flares at 45 degrees."""
    return position(_with(rows, gamma=rows[:, ALPHA]))


@wrong()
def height_from_the_bottom(rows):
    """z is measured from γ below the waist, where the model was drawn."""
    return position(_with(rows, z=rows[:, Z] - rows[:, GAMMA]))


@wrong()
def rotation_with_a_wrong_sign(rows):
    """The centre is turned about the axis first, by a matrix with both sines of one sign."""
    x, y = 0.8 * rows[:, X] + 0.6 * rows[:, Y], 0.6 * rows[:, X] + 0.8 * rows[:, Y]
    return position(_with(rows, x=x, y=y))


@wrong()
def rule_of_thumb_radius(rows):
    """r is taken from a rule of thumb, 0.96 of the larger and 0.4 of the smaller coordinate."""
    x, y = np.abs(rows[:, X]), np.abs(rows[:, Y])
    return position(_with(rows, x=0.96 * np.maximum(x, y) + 0.4 * np.minimum(x, y), y=0))
