"""What an exact decision about a way says of arguments that are no sizes, places or axes."""

from __future__ import annotations

from fractions import Fraction

import pytest

from hypcheck.errors import InputError
from hypcheck.truth.swept import passage

SIZES, START, END = (2, 3, Fraction(1, 4), Fraction(1, 8)), (5, 0, 0), (-5, 0, 0)


@pytest.mark.parametrize(
    ("sizes", "start", "end", "axis", "message"),
    [
        ((2, 3, Fraction(-1, 4), 1), START, END, None, "b is -1/4; a semi-axis must be greater than 0"),
        ((2, 3, Fraction(0), 1), START, END, None, "b is 0; a semi-axis must be greater than 0"),
        (SIZES, "here", END, None, "'here' is no sequence of numbers; there must be 3: x, y, z"),
        (SIZES, START, 7, None, "7 is no sequence of numbers; there must be 3: x, y, z"),
        (SIZES, START, END, (0, 0, 0), "axis"),
    ],
)
def test_arguments_that_describe_no_way_are_refused(sizes, start, end, axis, message):
    with pytest.raises(InputError, match=message):
        passage(sizes, start, end, axis=axis)
    assert passage(SIZES, START, END, axis=(0, 0, 1)).hit
