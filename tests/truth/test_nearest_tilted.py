"""The nearest-point oracle about tilted pairs against the exact decision and known clearances."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair, Position
from tests.support.corpus import questions
from tests.support.inside import NearestStage, clearances
from tests.support.inside import position as exact_position
from tests.support.inside import truth_nearest as nearest
from tests.truth.tilted_cases import SYMMETRIC, TANGENT, in_floats

FLOAT_TANGENT = [(found, side) for row, side in TANGENT if (found := in_floats(row)) is not None]


def test_clearance_of_a_tangent_spheroid_shrunk_to_a_half_is_1():
    assert len(FLOAT_TANGENT) >= 10
    known = [(row, side) for row, position, side in SYMMETRIC if side is not None] + FLOAT_TANGENT
    for row, side in known:
        alpha, gamma, b, d, *rest = row
        assert nearest.nearest(Pair.from_row(row)).clearance == 0
        found = nearest.nearest(Pair(alpha, gamma, b / 2, d / 2, *rest))
        assert found.position is side
        assert found.clearance == 1
        grown = nearest.nearest(Pair(alpha, gamma, b * 2, d * 2, *rest))
        assert (grown.position, grown.clearance) == (Position.CONTACT, -0.5)


def test_tilted_nearest_oracle_raises_its_precision_to_decide_a_near_tangency():
    row, side = FLOAT_TANGENT[0]
    step = 2.0**-52
    for factor, position in ((1 - step, side), (1 + step, Position.CONTACT)):
        found = nearest.nearest(Pair(*row[:2], row[2] * factor, row[3] * factor, *row[4:]))
        assert found.position is position
        assert 0 < abs(found.clearance) < 2 * step


def test_tilted_nearest_oracle_does_not_claim_tangency_from_a_nearby_rational():
    row, _ = FLOAT_TANGENT[0]
    off = [*row[:6], math.nextafter(row[6], math.inf), *row[7:]]
    found = nearest.nearest(Pair.from_row(off))
    assert not found.tangent
    assert found.position is exact_position(Pair.from_row(off).lengths)
    assert Fraction(found.clearance) != 0


SPECIAL = {
    "": [
        [0.084381103515625, 0.30859375, 0.132598876953125, 0.30859375, -0.35595703125, -0.18457031250000003, 2.015625]
    ],
    "axis": [[1, 2, 0.5, 0.25, 0.5, 3, 1, 1, 1, 4], [1, 2, 0.5, 0.75, 2, 1, 0, 1, 1, 1]],
}
"""A position that is sooner certain than the last digit of its clearance; pairs with b = x or an axis of ones."""


@pytest.mark.parametrize("groups", SPECIAL)
def test_clearances_of_many_tilted_rows_equal_those_of_single_pairs_for_axes_of_any_length(groups):
    """Few of them ask for more than double-double arithmetic."""
    rows = np.concatenate([questions(groups).rows[::60], SPECIAL[groups]])
    found = clearances(rows)
    assert np.mean(found.stage == NearestStage.DOUBLE_DOUBLE) > 0.55
    for place, row in enumerate(rows.tolist()):
        alone = nearest.nearest(Pair.from_row(row))
        assert (found.clearance[place], found.position[place]) == (alone.clearance, alone.position), row
    for factor in (2.0**600, -(2.0**-500)) if groups else ():
        with np.errstate(over="ignore"):
            axes = rows[:, 7:] * factor
        exact = np.isfinite(axes).all(axis=1) & (axes / factor == rows[:, 7:]).all(axis=1)
        again = clearances(np.column_stack([rows[:, :7], axes])[exact])
        assert exact.sum() > 50
        assert (again.clearance == found.clearance[exact]).all()
        assert (again.stage == found.stage[exact]).all()


def test_tangent_is_true_for_a_nearest_point_only_if_the_surfaces_touch_without_crossing():
    for x, tangent in ((4, True), (math.nextafter(4, 5), False), (3.5, False)):
        assert nearest.nearest(Pair(1, 1, 3, 1, x, 0, 0)).tangent is tangent
