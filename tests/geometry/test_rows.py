"""Arrays of rows: which values are accepted, and which row an error names."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import as_rows, first_trouble, invalid, require_valid

GOOD = [1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0]


@pytest.mark.parametrize(
    "values", [[GOOD], np.array([GOOD]), np.array([[1, 2, 1, 1, 2, 0, 0]]), np.array([GOOD], "f4")]
)
def test_numbers_in_seven_columns_are_rows(values):
    rows = as_rows(values)
    assert rows.dtype == np.float64
    assert rows.shape == (1, 7)
    assert rows.flags.c_contiguous


def test_contiguous_float64_rows_are_not_copied():
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
def test_values_that_are_no_rows_of_seven_numbers_raise_an_error(values, why):
    with pytest.raises(InputError, match=why):
        as_rows(values)


@pytest.mark.parametrize(("column", "value"), [(0, 0.0), (3, -1.0), (2, math.nan), (4, math.inf), (6, -math.inf)])
def test_the_first_bad_row_is_named(column, value):
    rows = np.array([GOOD, GOOD, GOOD])
    rows[1, column] = value
    rows[2, 0] = -1.0
    assert invalid(rows).tolist() == [False, True, True]
    assert first_trouble(rows, 1).startswith("row 2: ")
    with pytest.raises(InputError, match=r"^row 1: "):
        require_valid(rows)


def test_valid_rows_raise_no_error():
    assert first_trouble(np.array([GOOD])) is None
