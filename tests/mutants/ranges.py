"""Right for the rows that were thought of: for one range, one regime or one octant, and contact elsewhere."""

from __future__ import annotations

import numpy as np

from tests.mutants.exactly import position
from tests.mutants.expectation import wrong

ALPHA, GAMMA, B, D, X, Y, Z = range(7)


def _only(rows, where):
    """The right answer where the mask holds, else contact."""
    return np.where(where, position(rows), 0).astype(np.int8)


@wrong()
def within_the_height(rows):
    """Right for |z| ≤ γ, as if the tower ended there."""
    return _only(rows, np.abs(rows[:, Z]) <= rows[:, GAMMA])


@wrong()
def wide_waist(rows):
    """Right for a ≥ 1."""
    return _only(rows, rows[:, ALPHA] >= rows[:, B])


@wrong()
def bent_waist(rows):
    """Right for c² ≥ a."""
    return _only(rows, (rows[:, GAMMA] / rows[:, D]) ** 2 >= rows[:, ALPHA] / rows[:, B])


@wrong()
def tall_hyperboloid(rows):
    """Right for γ ≥ α."""
    return _only(rows, rows[:, GAMMA] >= rows[:, ALPHA])


@wrong()
def oblate_spheroid(rows):
    """Right for d ≤ b."""
    return _only(rows, rows[:, D] <= rows[:, B])


@wrong()
def first_octant(rows):
    """Right for x, y, z ≥ 0."""
    return _only(rows, (rows[:, X:] >= 0).all(axis=1))


@wrong()
def no_negative_zero(rows):
    """Right unless a coordinate is −0.0, whose sign bit is taken for a negative number's."""
    return _only(rows, ~((rows == 0) & np.signbit(rows)).any(axis=1))


@wrong()
def within_a_kilometre(rows):
    """Right for coordinates up to 1000."""
    return _only(rows, (np.abs(rows[:, X:]) <= 1000).all(axis=1))


@wrong()
def ratios_to_a_thousand(rows):
    """Right for α/b and γ/d up to 1000."""
    return _only(rows, (rows[:, ALPHA] <= 1000 * rows[:, B]) & (rows[:, GAMMA] <= 1000 * rows[:, D]))


@wrong()
def ratios_from_a_hundredth(rows):
    """Right for α/b and γ/d down to 1/100."""
    return _only(rows, (rows[:, ALPHA] * 100 >= rows[:, B]) & (rows[:, GAMMA] * 100 >= rows[:, D]))


@wrong()
def ratios_from_a_hundred_thousandth(rows):
    """Right for α/b and γ/d down to 1e-5; the domain it leaves undeclared goes on to 1e-8."""
    return _only(rows, (rows[:, ALPHA] * 1e5 >= rows[:, B]) & (rows[:, GAMMA] * 1e5 >= rows[:, D]))


@wrong()
def spheroids_from_a_hundredth_of_a_millimetre(rows):
    """Right for b and d down to 1e-5; the domain it leaves undeclared goes on to 1e-6."""
    return _only(rows, (rows[:, B : D + 1] >= 1e-5).all(axis=1))


@wrong()
def spheroids_to_a_hundred_kilometres(rows):
    """Right for b and d up to 1e5; the domain it leaves undeclared goes on to 1e6."""
    return _only(rows, (rows[:, B : D + 1] <= 1e5).all(axis=1))


@wrong()
def off_the_axis(rows):
    """Right unless r = 0, where a division gives NaN."""
    return _only(rows, (rows[:, X] != 0) | (rows[:, Y] != 0))


@wrong()
def off_the_waist(rows):
    """Right unless z = 0, where a division gives NaN."""
    return _only(rows, rows[:, Z] != 0)


@wrong()
def off_the_planes(rows):
    """Right unless x = 0 or y = 0, but not both."""
    return _only(rows, (rows[:, X] == 0) == (rows[:, Y] == 0))


@wrong()
def a_is_not_1(rows):
    """Right unless α = b, where a division by a − 1 gives NaN."""
    return _only(rows, rows[:, ALPHA] != rows[:, B])


@wrong()
def c_is_not_1(rows):
    """Right unless γ = d."""
    return _only(rows, rows[:, GAMMA] != rows[:, D])


@wrong()
def paper_scenes_only(rows):
    """Right for the tower and its quadcopter alone."""
    return _only(rows, (rows[:, ALPHA] == 2) & (rows[:, GAMMA] == 17.8))


@wrong()
def unequal_axes(rows):
    """Right unless the spheroid is a ball, b = d."""
    return _only(rows, rows[:, B] != rows[:, D])
