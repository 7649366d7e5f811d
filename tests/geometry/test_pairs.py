"""A pair accepts seven valid numbers and names an invalid one; its integers stand for the same pair."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from tests.support.pairs import pairs

GOOD = dict(zip(COLUMNS, (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0), strict=True))


@pytest.mark.parametrize("column", COLUMNS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "1", None, True, 10**400])
def test_pair_refuses_a_value_that_is_no_finite_number_and_names_its_column(column, value):
    with pytest.raises(InputError, match=rf"^{column} is "):
        Pair(**{**GOOD, column: value})


@pytest.mark.parametrize("column", ["alpha", "gamma", "b", "d"])
@pytest.mark.parametrize("value", [0.0, -0.0, -1.0])
def test_pair_refuses_a_size_that_is_not_positive(column, value):
    with pytest.raises(InputError, match=f"^{column} is .* greater than 0"):
        Pair(**{**GOOD, column: value})


@pytest.mark.parametrize("column", ["x", "y", "z"])
def test_pair_turns_negative_zero_into_zero(column):
    pair = Pair(**{**GOOD, column: -0.0})
    assert math.copysign(1, getattr(pair, column)) == 1


def test_position_values_sort_as_interior_contact_exterior():
    assert [position.label for position in sorted(Position)] == ["interior", "contact", "exterior"]


@given(pairs)
def test_integer_lengths_of_a_pair_keep_the_ratios_of_radial_and_of_axial_lengths(pair):
    lengths = pair.lengths
    for group in (("alpha", "b", "x", "y"), ("gamma", "d", "z")):
        first = group[0]
        for name in group:
            expected = Fraction(getattr(pair, name)) / Fraction(getattr(pair, first))
            assert Fraction(getattr(lengths, name), getattr(lengths, first)) == expected
