"""The nearest-point oracle about tilted pairs against the exact decision and known clearances."""

from __future__ import annotations

import math
from fractions import Fraction

from hypcheck.geometry.pair import Pair, Position
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
