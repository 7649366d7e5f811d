"""The family razor: the last float before contact and the first in it, for sizes of any scale, found in few steps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import FixedSizes
from hypcheck.vectors import fixed_sizes
from tests.support import inside

SIDES = (Position.EXTERIOR, Position.INTERIOR)
SIZES = (
    (2.0, 17.8, 0.25, 0.15),
    (2.0, 17.8, 0.25, 1.1e307),
    (1e-300, 1e300, 1e-308, 5e-324),
    (1e300, 1e-300, 1e290, 1e-10),
)


def position(sizes, x, z):
    return inside.position(Pair(*sizes, x, 0.0, z).lengths)


@pytest.mark.parametrize("sizes", SIZES)
def test_razor_rows_lie_at_most_six_floats_from_the_first_one_after_the_position_changes(sizes):
    """They are drawn up to six to either side of it: about another float some would be seven away."""
    centres = np.abs(fixed_sizes.family_at(f"razor@{','.join(map(repr, sizes))}").rows(1, 300)[:, [4, 6]])
    moved = np.isclose(centres, fixed_sizes.FARTHEST, rtol=1e-14, atol=0)  # inwards, to what is asked at most
    inner = centres[~moved.any(axis=1)].tolist()
    for x, z in inner:
        outwards = [x]
        for _ in range(6):
            outwards = [math.nextafter(outwards[0], 0.0), *outwards, math.nextafter(outwards[-1], math.inf)]
        before = math.nextafter(outwards[0], 0.0)
        assert any(
            is_beyond(sizes, outwards[-1], z, side) and (before == 0.0 or not is_beyond(sizes, before, z, side))
            for side in SIDES
        ), (x, z)
    assert len(inner) > 50


def is_beyond(sizes, x, z, side):
    """Whether it is exterior, or no longer interior."""
    return (position(sizes, x, z) is side) == (side is Position.EXTERIOR)


@pytest.mark.parametrize("trap", fixed_sizes.TRAPS)
@pytest.mark.parametrize(
    "sizes",
    [
        (1e150, 1e-150, 1.0, 1.0),
        (1e-150, 1e150, 1.0, 1.0),
        (2.0, 1e-300, 0.25, 1e-150),
        (2.0, 17.8, 0.25, 1.1e307),
        (1e-93, 2e-84, 1.4e69, 8.8e-67),
        (1e307, 1e307, 5e-324, 5e-324),
        (5e-324, 5e-324, 1e307, 1e307),
        (5e-324, 1e307, 1e307, 5e-324),
        (1e307, 5e-324, 5e-324, 1e307),
    ],
)
def test_rows_for_fixed_sizes_are_finite_at_the_limits_of_float64(trap, sizes):
    rows = fixed_sizes.family_at(f"{trap}@{','.join(map(repr, sizes))}").block(1, 0)
    assert np.isfinite(rows).all()


@pytest.mark.parametrize(
    "sizes", [(5e-324, 5e-324, 5e-324, 5e-324), (1e-300, 1e-300, 1e-300, 1e-300), (1.0, 1e150, 1.0, 1.0)]
)
def test_razor_rows_for_subnormal_sizes_are_finite_with_nonzero_centres_below_1e_300(sizes):
    (razor,) = (each for each in fixed_sizes.families_for((FixedSizes(sizes),)) if each.name.startswith("razor"))
    rows = razor.rows(1, 300)
    assert np.isfinite(rows).all()
    assert 0 < np.abs(rows[:, 4][rows[:, 4] != 0]).min() < 1e-300
