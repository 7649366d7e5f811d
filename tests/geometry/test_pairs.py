"""A pair accepts seven valid numbers and names an invalid one; its integers stand for the same pair."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Lengths, Pair, Position, counted_along, trouble_with_row
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


@pytest.mark.parametrize("equal", [False, True])
@pytest.mark.parametrize(
    "axis", [(0, 0, 1), (0, 0, -3), (0, 1, 0), (1, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0), (1, 1, 1)]
)
def test_a_spheroid_is_upright_if_its_axis_is_vertical_or_if_it_is_a_sphere(axis, equal):
    pair = Pair(1.0, 2.0, 0.5, 0.5 if equal else 0.75, 3.0, 1.0, 0.25, *axis)
    upright = equal or axis[:2] == (0, 0)
    assert pair.is_upright == pair.lengths.is_upright == upright
    # alpha = 1, b = 1/2 and gamma = 2, d, z = 1/4: each group in its own unit, or all in quarters
    assert (pair.lengths.alpha, pair.lengths.gamma) == ((2, 8) if upright else (4, 8))
    assert pair.lengths.axis == ((0, 0, 1) if upright else axis)
    assert pair.lengths.upward == (0, 0, 1)


@pytest.mark.parametrize("upward", [(0, 1, 0), (1, 0, 0), (0, 2, 2), (1, 0, 1)])
def test_all_lengths_are_in_one_unit_where_the_hyperboloid_is_not_vertical(upward):
    for row in ((1.0, 2.0, 0.5, 0.5, 3.0, 1.0, 0.25), (1.0, 2.0, 0.5, 0.75, 3.0, 1.0, 0.25, 0.0, 0.0, 1.0)):
        lengths = Lengths.of(row, upward)
        assert (lengths.alpha, lengths.gamma, lengths.axis) == (4, 8, (0, 0, 1))
        assert lengths.upward == ((0, 1, 1) if 2 in upward else upward)


@pytest.mark.parametrize("solid", [0.0, 1.0, True])
@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0)])
@pytest.mark.parametrize(
    ("low", "high"), [(-math.inf, math.inf), (-math.inf, 1.5), (-2.25, math.inf), (-2.25, 1.5), (1.5, 3.0)]
)
def test_a_hyperboloid_ends_at_each_height_that_is_finite(low, high, axis, solid):
    pair = Pair(1.0, 2.0, 0.5, 0.75, 3.0, 1.0, 0.25, *axis, low, high, solid)
    ends = (low, high) != (-math.inf, math.inf)
    assert pair.has_ends == pair.lengths.has_ends == ends
    # 4 units are 1 along the axis
    assert pair.lengths.low == (None if math.isinf(low) else 4 * low)
    assert pair.lengths.high == (None if math.isinf(high) else 4 * high)
    assert pair.lengths.solid == (ends and bool(solid))
    down = Lengths.of((*pair.row[:7], *axis, low, high, solid), (0, 0, -2))
    assert (down.low, down.high) == (
        (pair.lengths.low, pair.lengths.high)
        if down.upward == (0, 0, -1)
        else (None if math.isinf(high) else -4 * high, None if math.isinf(low) else -4 * low)
    )
    assert down.upward == ((0, 0, -1) if axis[0] else (0, 0, 1))


@pytest.mark.parametrize(
    ("heights", "trouble"),
    [
        ((True, 1.0, 0.0), "z_min is True; it must be a number"),
        ((0.0, True, 0.0), "z_max is True; it must be a number"),
        ((math.nan, 1.0, 0.0), "z_min is nan; it must be a number or infinite"),
        ((0.0, "1", 0.0), "z_max is '1'; it must be a number"),
        ((1.0, 1.0, 0.0), "z_min is 1.0 and z_max is 1.0; z_min must be less than z_max"),
        ((math.inf, math.inf, 0.0), "z_min is inf and z_max is inf; z_min must be less than z_max"),
        ((0.0, 1.0, math.inf), "solid is inf; it must be finite"),
        ((0.0, 1.0, "yes"), "solid is 'yes'; it must be a number"),
        ((0.0, 1.0, 2.0), "solid is 2.0; it must be 0 or 1"),
    ],
)
def test_a_pair_refuses_heights_that_bound_nothing(heights, trouble):
    with pytest.raises(InputError) as refused:
        Pair(**GOOD, **dict(zip(("z_min", "z_max", "solid"), heights, strict=True)))
    assert str(refused.value) == trouble


@pytest.mark.parametrize("more", [(), (0.0, 3.0, 1.0), (0.0, 3.0, 1.0, -2.0, math.inf, 1.0)])
def test_a_valid_row_of_seven_ten_or_thirteen_numbers_has_no_trouble(more):
    assert trouble_with_row((*GOOD.values(), *more)) is None


@pytest.mark.parametrize("upward", [(1, 0, 0), (-1, 0, 0), (0, -1, -1), (1, -3, 0)])
@pytest.mark.parametrize("share", [1, 2, 0.25, -1, -2])
def test_heights_along_a_parallel_axis_are_counted_upside_down_if_it_points_the_other_way(upward, share):
    along = [part * share for part in upward]
    expected = (-5, 7) if share > 0 else (-7, 5)
    assert counted_along(along, upward, -5, 7) == expected
    assert counted_along(along, upward, None, 7) == ((None, 7) if share > 0 else (-7, None))
