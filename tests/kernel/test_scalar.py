"""hypcheck.position: exact for one pair, compiled or not, and one sentence for an invalid pair."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

import hypcheck
from hypcheck.errors import InputError
from hypcheck.kernel.scalar import exact_position
from hypcheck.truth import exact, float_filter
from tests.support.pairs import pairs
from tests.tools.attack.places import near_contact, on_the_ring

FUNCTIONS = pytest.mark.parametrize("function", [hypcheck.position, exact_position], ids=["public", "plain-python"])


@FUNCTIONS
@given(pair=pairs)
def test_position_of_one_pair_of_any_sizes_is_exact(function, pair):
    assert function(*pair.row) == exact.position(pair.lengths)


@FUNCTIONS
def test_position_of_one_pair_is_exact_near_contact_and_on_the_ring(function):
    random = np.random.default_rng(6)
    rows = np.concatenate([near_contact(random, 3000), on_the_ring(random, 500)])
    assert [function(*row) for row in rows.tolist()] == float_filter.positions(rows).tolist()


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
