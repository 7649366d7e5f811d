"""The family razor: the last float before contact and the first in it, for sizes of any scale, found in few steps."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import FixedSizes
from hypcheck.truth import exact
from hypcheck.vectors import fixed_sizes

SIDES = (Position.EXTERIOR, Position.INTERIOR)
SIZES = (
    (2.0, 17.8, 0.25, 0.15),
    (2.0, 17.8, 0.25, 1.1e307),
    (1e-300, 1e300, 1e-308, 5e-324),
    (1e300, 1e-300, 1e290, 1e-10),
)


def position(sizes, x, z):
    return exact.position(Pair(*sizes, x, 0.0, z).lengths)


@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize("z", [0.0, -1.0, 17.8])
def test_edge_for_fixed_sizes_is_the_last_float_before_the_position_changes(sizes, z):
    for side in SIDES:
        x = fixed_sizes._edge(sizes, z, side)
        assert is_beyond(sizes, x, z, side) or (
            x == fixed_sizes.FARTHEST and not is_beyond(sizes, sys.float_info.max, z, side)
        )
        assert x == 0.0 or not is_beyond(sizes, math.nextafter(x, 0.0), z, side)


def is_beyond(sizes, x, z, side):
    """Whether it is exterior, or no longer interior."""
    return (position(sizes, x, z) is side) == (side is Position.EXTERIOR)


@pytest.mark.parametrize("sizes", SIZES)
def test_edge_for_fixed_sizes_is_found_in_at_most_65_exact_decisions(sizes, monkeypatch):
    asked = []

    def counted(lengths):
        asked.append(lengths)
        return decide(lengths)

    decide = exact.position
    monkeypatch.setattr(fixed_sizes.exact, "position", counted)
    for side in SIDES:
        asked.clear()
        fixed_sizes._edge(sizes, 1.0, side)
        assert len(asked) <= 65


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


@given(st.floats(0.0, sys.float_info.max))
def test_float_at_inverts_ordinal(x):
    ordinal = fixed_sizes._ordinal(x)
    assert fixed_sizes._float_at(ordinal) == x
    assert ordinal == 0 or fixed_sizes._float_at(ordinal - 1) == math.nextafter(x, 0.0)


@pytest.mark.parametrize(
    "sizes", [(5e-324, 5e-324, 5e-324, 5e-324), (1e-300, 1e-300, 1e-300, 1e-300), (1.0, 1e150, 1.0, 1.0)]
)
def test_razor_rows_for_subnormal_sizes_are_finite_with_nonzero_centres_below_1e_300(sizes):
    (razor,) = (each for each in fixed_sizes.families_for((FixedSizes(sizes),)) if each.name.startswith("razor"))
    rows = razor.rows(1, 300)
    assert np.isfinite(rows).all()
    assert 0 < np.abs(rows[:, 4][rows[:, 4] != 0]).min() < 1e-300
