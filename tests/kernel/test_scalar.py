"""hypcheck.position: exact for one pair, compiled or not, and one sentence for an invalid pair."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from tests.support.inside import EXTENSION, exact_position

FUNCTIONS = pytest.mark.parametrize("function", [hypcheck.position, exact_position], ids=["public", "plain-python"])


@FUNCTIONS
def test_position_takes_integers_and_other_numbers_at_their_value(function):
    assert function(1, 2, 1, 1, 2.5, 0, 0) == 1
    assert function(*np.float64([4, 4, 1, 1, 0, 0, 0])) == -1
    assert function(1.0, 2.0, 1.0, 1.0, -2.0, 0.0, -0.0) == 0


@FUNCTIONS
def test_position_of_a_spheroid_wider_than_the_throat_is_contact(function):
    """Its centre lies outside, 2.5 from the axis, and the axis at the same height within it, of radius 4."""
    assert function(1.0, 1.0, 4.0, 8.0, -2.0, -1.5, 1.5) == 0


TOUCHING = (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0)
"""A ball that touches the wall at (1, 0, 0)."""
WITHIN = (4.0, 4.0, 1.0, 1.0, 0.0, 0.0, 0.0)
"""A ball in the middle of a wide throat."""


@FUNCTIONS
@pytest.mark.parametrize(
    ("row", "heights", "expected"),
    [
        (TOUCHING, {"z_min": -1.0}, 0),
        (TOUCHING, {"z_min": 0.5}, 1),  # at that height the wall has moved away
        (TOUCHING, {"z_min": 0.5, "axis": (1.0, 0.0, 1.0)}, 1),
        (TOUCHING, {"solid": True}, 0),  # without ends there is nothing flat
        (WITHIN, {"z_min": -2.0, "z_max": 2.0, "solid": True}, -1),
        (WITHIN, {"z_min": -0.5, "z_max": 2.0, "solid": True}, 0),
        (WITHIN, {"z_min": 2.0, "solid": True}, 1),
    ],
)
def test_position_of_one_pair_counts_only_the_wall_between_z_min_and_z_max(function, row, heights, expected):
    assert function(*row, **heights) == expected


@FUNCTIONS
def test_position_of_one_pair_refuses_z_min_that_is_not_less_than_z_max(function):
    with pytest.raises(InputError, match="z_min must be less than z_max"):
        function(*TOUCHING, z_min=1.0, z_max=1.0)


@pytest.mark.parametrize("kernel", ["compiled", "numpy"])
def test_position_takes_numbers_of_numpy_in_a_process_that_has_not_loaded_it_for_hypcheck(kernel):
    """Its compiled function knows them only after the first of them came."""
    code = (
        "import hypcheck, numpy; row = numpy.int32([4, 4, 1, 1, 0, 0, 0]);"
        "print([hypcheck.position(*row), hypcheck.position(*row)])"
    )
    environment = {**os.environ, "HYPCHECK_KERNEL": kernel if EXTENSION in sys.modules else "numpy"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "[-1, -1]\n"


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
