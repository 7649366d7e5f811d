"""Arrays of rows: which values are accepted, and which row an error names."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import (
    SWEEPS,
    FixedSizes,
    as_rows,
    first_trouble,
    invalid,
    require_valid,
    scenes_of,
    upright_mask,
    with_axis,
    within,
)

GOOD = [1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0]
WAY = [1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0, 0.0, 0.0, 4.0]
AXIS = [3.0, 4.0, 12.0]


@pytest.mark.parametrize(
    "values", [[GOOD], np.array([GOOD]), np.array([[1, 2, 1, 1, 2, 0, 0]]), np.array([GOOD], "f4")]
)
def test_as_rows_takes_seven_numbers_of_any_array_type(values):
    rows = as_rows(values)
    assert rows.dtype == np.float64
    assert rows.shape == (1, 7)
    assert rows.flags.c_contiguous


def test_as_rows_refuses_masked_numbers_and_takes_an_array_that_masks_none():
    rows = np.ma.masked_array([GOOD, GOOD], mask=False)
    assert as_rows(rows).tolist() == [GOOD, GOOD]
    rows[0, 4] = rows[1, 6] = np.ma.masked
    with pytest.raises(InputError, match="the rows are masked in 2 places; fill these, with nan or a number"):
        as_rows(rows)


def test_as_rows_does_not_copy_contiguous_float64_rows():
    rows = np.array([GOOD, GOOD])
    assert as_rows(rows) is rows


@pytest.mark.parametrize(
    ("values", "why"),
    [
        (GOOD, "shape"),
        ([GOOD[:6]], "shape"),
        ([GOOD, GOOD[:6]], r"the rows are \[\[.*; they must be an array \(n, 7\) of numbers: alpha, "),
        ([["1"] * 7], "the rows are"),
        ([[True] * 7], "the rows are"),
        ([[1j] * 7], "the rows are"),
        ([[None] * 7], "the rows are"),
        ([[10**400] * 7], "the rows are"),
    ],
)
def test_as_rows_refuses_values_that_are_no_rows_of_seven_numbers(values, why):
    with pytest.raises(InputError, match=why):
        as_rows(values)


@pytest.mark.parametrize(("column", "value"), [(0, 0.0), (3, -1.0), (2, math.nan), (4, math.inf), (6, -math.inf)])
def test_the_error_about_invalid_rows_names_the_first_of_them(column, value):
    rows = np.array([GOOD, GOOD, GOOD])
    rows[1, column] = value
    rows[2, 0] = -1.0
    assert invalid(rows).tolist() == [False, True, True]
    assert first_trouble(rows, 1).startswith("row 2: ")
    with pytest.raises(InputError, match=r"^row 1: "):
        require_valid(rows)


def test_valid_rows_give_no_error_message():
    assert first_trouble(np.array([GOOD])) is None


def test_as_rows_of_sweeps_takes_ten_numbers_or_thirteen_with_an_axis():
    assert as_rows([WAY], layout=SWEEPS).shape == (1, 10)
    assert as_rows([WAY + AXIS], frozenset({"axis"}), SWEEPS).shape == (1, 13)
    with pytest.raises(
        InputError, match=r"shape \(1, 13\); it must be \(n, 10\): alpha, gamma, b, d, x0, y0, z0, x1, y1, z1$"
    ):
        as_rows([WAY + AXIS], layout=SWEEPS)


@pytest.mark.parametrize(
    ("place", "value", "trouble"),
    [
        (3, 0.0, "d is 0.0; a semi-axis must be greater than 0"),
        (6, math.nan, "z0 is nan; it must be finite"),
        (7, math.inf, "x1 is inf; it must be finite"),
        (11, -math.inf, "axis_y is -inf; it must be finite"),
    ],
)
def test_the_error_about_an_invalid_sweep_names_its_row_and_number(place, value, trouble):
    rows = np.array([WAY + AXIS, WAY + AXIS])
    rows[1, place] = value
    assert first_trouble(rows, layout=SWEEPS) == f"row 1: {trouble}"


def test_a_sweep_may_end_at_the_origin_but_its_axis_must_have_a_direction():
    assert not invalid(np.array([WAY[:7] + [0.0] * 3]), SWEEPS).any()
    assert invalid(np.array([WAY + [0.0] * 3]), SWEEPS).all()


def test_with_axis_gives_an_upright_sweep_the_axis_0_0_1():
    assert with_axis(np.array([WAY]), SWEEPS).tolist() == [[*WAY, 0.0, 0.0, 1.0]]


def test_a_domain_limits_both_ends_of_a_sweep_and_not_its_axis():
    far = [*WAY[:8], 1e9, 4.0, 0.0, 1e20, 0.0]
    near = [*WAY, 0.0, 1e20, 0.0]
    assert within(np.array([near, far]), layout=SWEEPS).tolist() == [True, False]
    setting = FixedSizes((1.0, 2.0, 1.0, 1.0), z=(0.0, 3.0))
    assert setting.holds(np.array([WAY, [*WAY[:9], 2.0]]), SWEEPS).tolist() == [False, True]


def test_within_includes_the_ends_of_the_ranges_of_ratios_and_magnitudes():
    row = [2.0, 8.0, 4.0, 1.0, -32.0, 0.0, 1e-9]  # α/b = 1/2, γ/d = 8
    inside = {"ratio": (0.5, 8.0), "magnitude": (1.0, 32.0)}
    assert within(np.array([row]), **inside).tolist() == [True]
    for name, ends in (("ratio", (0.51, 8.0)), ("ratio", (0.5, 7.9)), ("magnitude", (1.1, 32)), ("magnitude", (1, 31))):
        assert within(np.array([row]), **(inside | {name: ends})).tolist() == [False], (name, ends)


def test_fixed_sizes_include_the_ends_of_their_spans_and_refuse_other_sizes():
    setting = FixedSizes(tuple(GOOD[:4]), x=(2.5, 3.0), y=(-1.0, 0.0))
    rows = np.array([GOOD, [*GOOD[:4], 3.0, -1.0, 7.0], [*GOOD[:4], 3.1, 0.0, 0.0], [*GOOD[:4], 2.5, 0.1, 0.0]])
    assert setting.holds(rows).tolist() == [True, True, False, False]
    for place in range(4):
        other = [*GOOD]
        other[place] += 1
        assert setting.holds(np.array([GOOD, other])).tolist() == [True, False]


def test_fixed_sizes_hold_rows_with_their_axis_or_with_any_if_it_is_free():
    upright, leaning = [*GOOD, 0.0, 0.0, 1.0], [*GOOD, *AXIS]
    rows = np.array([upright, leaning])
    for axis, expected in ((None, [True, False]), (tuple(AXIS), [False, True]), ("free", [True, True])):
        assert FixedSizes(tuple(GOOD[:4]), axis=axis).holds(rows).tolist() == expected


@pytest.mark.parametrize("place", [4, 5, 6])
def test_rows_of_one_scene_differ_in_their_centres_alone(place):
    rows = np.tile([2.0, 3.0, 1.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (5, 1))
    rows[:, place] = [4.0, 5.0, 6.0, 7.0, 8.0]
    rows[3, 9] = 2.0
    assert [part.tolist() for part in scenes_of(rows)] == [[0, 1, 2, 4], [3]]
    assert scenes_of(rows[:0]) == []


def test_a_row_is_tilted_by_its_axis_and_unlike_semi_axes_wherever_its_centre_is():
    b, d = 0.5, 0.25
    rows = np.array(
        [[2.0, 3.0, b, size, x, 0.0, 0.0, *axis] for axis in ((1, 0, 1), (0, 0, 1)) for size in (d, b) for x in (b, d)]
    )
    assert (~upright_mask(rows)).tolist() == [True, True, False, False, False, False, False, False]
    assert upright_mask(rows[:, :7]).all()
