"""Right for the rows that were thought of: for one range, one regime or one octant, and contact elsewhere."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import lengths, position, terms
from tests.tools.mutants.expectation import wrong

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


@wrong()
def prolate_spheroid(rows):
    """Right for d ≥ b."""
    return _only(rows, rows[:, D] >= rows[:, B])


@wrong()
def flat_hyperboloid(rows):
    """Right for γ ≤ α."""
    return _only(rows, rows[:, GAMMA] <= rows[:, ALPHA])


@wrong()
def seven_octants(rows):
    """Right unless x, y and z are negative."""
    return _only(rows, ~(rows[:, X:] < 0).all(axis=1))


@wrong()
def three_regimes(rows):
    """Right unless a < 1 and c² < a."""
    a, c = rows[:, ALPHA] / rows[:, B], rows[:, GAMMA] / rows[:, D]
    return _only(rows, (a >= 1) | (c * c >= a))


@wrong()
def off_the_diagonals(rows):
    """Right unless |x| = |y| > 0."""
    return _only(rows, (np.abs(rows[:, X]) != np.abs(rows[:, Y])) | (rows[:, X] == 0))


@wrong()
def off_the_cylinder(rows):
    """Right unless r = α, where a division by r − α gives NaN."""
    t = terms(lengths(rows))
    return _only(rows, np.asarray(t.P != t.A, dtype=bool))


@wrong()
def waist_and_flare_differ(rows):
    """Right unless α = γ, where a division by α − γ gives NaN."""
    return _only(rows, rows[:, ALPHA] != rows[:, GAMMA])


@wrong()
def ratios_differ(rows):
    """Right unless a = c, where a division by A − B gives NaN."""
    t = terms(lengths(rows))
    return _only(rows, np.asarray(t.A != t.B, dtype=bool))


@wrong()
def no_powers_of_two(rows):
    """Right unless α, γ, b and d are powers of two, for which there is a shortcut."""
    return _only(rows, (np.frexp(rows[:, :X])[0] != 0.5).any(axis=1))


@wrong()
def waists_to_a_hundred_kilometres(rows):
    """Right for α and γ up to 1e5; the domain it leaves undeclared goes on to 1e6."""
    return _only(rows, (rows[:, :B] <= 1e5).all(axis=1))


@wrong()
def coordinates_to_five_hundred_kilometres(rows):
    """Right for coordinates up to 5e5; the domain it leaves undeclared goes on to 1e6."""
    return _only(rows, (np.abs(rows[:, X:]) <= 5e5).all(axis=1))


@wrong()
def short_of_the_ends(rows):
    """Right unless a semi-axis is exactly 1e-6 or 1e6, the ends of the domain it leaves undeclared."""
    return _only(rows, ((rows[:, :X] > 1e-6) & (rows[:, :X] < 1e6)).all(axis=1))


@wrong()
def heights_to_a_thousand(rows):
    """Right for |z| ≤ 1000 γ."""
    return _only(rows, np.abs(rows[:, Z]) <= 1000 * rows[:, GAMMA])


@wrong(claim=("--domain", '{"ratio": [1e-12, 1e12]}'))
def ratios_to_a_billion(rows):
    """Claims ratios to 1e12, and is right up to 1e9."""
    return _only(rows, (rows[:, :B] <= 1e9 * rows[:, B:X]).all(axis=1))


@wrong()
def height_of_negative_zero(rows):
    """Right unless z is −0.0, which is taken to lie below the waist and has no height there."""
    return _only(rows, ~((rows[:, Z] == 0) & np.signbit(rows[:, Z])))


@wrong()
def not_all_sizes_1(rows):
    """Right unless α, γ, b and d are 1, the unit case that has a formula of its own."""
    return _only(rows, (rows[:, :X] != 1).any(axis=1))


@wrong()
def not_all_sizes_equal(rows):
    """Right unless α, γ, b and d are equal."""
    return _only(rows, (rows[:, :X] != rows[:, :1]).any(axis=1))


@wrong()
def float32_in_a_hundredth_of_the_height(rows):
    """Inputs rounded to float32 where |z|/γ is between 0.5 and 0.51."""
    height = np.abs(rows[:, Z]) / rows[:, GAMMA]
    narrow = ((height > 0.5) & (height < 0.51))[:, None]
    return position(np.where(narrow, rows.astype(np.float32).astype(np.float64), rows))


@wrong()
def grown_in_a_corner(rows):
    """Sizes grown by 1e-9 where c/a is between 200 and 1000, |x| > 3|y| > 0 and |z| > γ."""
    alpha, gamma, b, d, x, y, z = rows.T
    slope = (gamma / d) / (alpha / b)
    corner = (slope > 200) & (slope < 1000) & (np.abs(x) > 3 * np.abs(y)) & (y != 0) & (np.abs(z) > gamma)
    changed = rows.copy()
    changed[:, B : D + 1] *= np.where(corner, 1 + 1e-9, 1)[:, None]
    return position(changed)
