"""hypcheck.position: exact for one pair, compiled or not, and one sentence for an invalid pair."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from tests.support.inside import exact_position

FUNCTIONS = pytest.mark.parametrize("function", [hypcheck.position, exact_position], ids=["public", "plain-python"])


@FUNCTIONS
def test_position_takes_integers_and_other_numbers_at_their_value(function):
    assert function(1, 2, 1, 1, 2.5, 0, 0) == 1
    assert function(*np.float64([4, 4, 1, 1, 0, 0, 0])) == -1
    assert function(1.0, 2.0, 1.0, 1.0, -2.0, 0.0, -0.0) == 0


@FUNCTIONS
@pytest.mark.parametrize(
    ("row", "sentence"),
    [
        ((1, 2, 1, -1.0, 2.5, 0, 0), "d is -1.0; a semi-axis must be greater than 0"),
        ((1.0, float("nan"), 1.0, 1.0, 2.5, 0.0, 0.0), "gamma is nan; it must be finite"),
        ((1.0, 2.0, 1.0, 1.0, 2.5, 0.0, float("inf")), "z is inf; it must be finite"),
        ((-0.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0), "alpha is -0.0; a semi-axis must be greater than 0"),
        ((1, 2, 1, 1, "2.5", 0, 0), "x is '2.5'; it must be a number"),
        ((1, 2, 1, 1, True, 0, 0), "x is True; it must be a number"),
        ((1, 2, 1, 1, 10**400, 0, 0), "x is an integer too large for float64"),
    ],
)
def test_position_raises_an_error_naming_the_invalid_number(function, row, sentence):
    with pytest.raises(InputError, match=sentence):
        function(*row)
