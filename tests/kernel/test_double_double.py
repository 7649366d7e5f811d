"""Double-double, in which kernels for tilted spheroids compute: errors against rationals, as tilted.py counts."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.routines import run
from hypcheck.kernel.specialise.double_double import DIFFERENCE, PRODUCT, QUOTIENT, ROOT, SIZE, SUM

UNIT = Fraction(1, 2**53)

SIZES = st.floats(2.0**-60, 2.0**60)
HIGHS = st.builds(lambda size, sign: sign * size, SIZES, st.sampled_from([-1.0, 1.0]))
PAIRS = st.builds(lambda high, share: (high, high * share * 2.0**-53), HIGHS, st.floats(-0.5, 0.5))


def exact(pair):
    return sum(map(Fraction, pair))


def computed(routine, **pairs):
    high, low = (float(each) for each in run(routine, float_arithmetic("float64"), pairs))
    assert high + low == high
    return Fraction(high) + Fraction(low)


@given(one=PAIRS, other=PAIRS)
def test_sums_and_differences_are_within_3_squared_units(one, other):
    for routine, true in ((SUM, exact(one) + exact(other)), (DIFFERENCE, exact(one) - exact(other))):
        assert abs(computed(routine, one=one, other=other) - true) <= 3 * UNIT**2 * (1 + 4 * UNIT) * abs(true)


@given(one=PAIRS, other=PAIRS)
def test_products_are_within_8_and_quotients_within_15_squared_units(one, other):
    product, quotient = exact(one) * exact(other), exact(one) / exact(other)
    assert abs(computed(PRODUCT, one=one, other=other) - product) <= 8 * UNIT**2 * abs(product)
    assert abs(computed(QUOTIENT, one=one, other=other) - quotient) <= 16 * UNIT**2 * abs(quotient)


@given(value=PAIRS)
def test_the_square_root_squared_is_its_number_and_the_magnitude_is_never_negative(value):
    """The root r of n is off by a relative e where r² is off by 2e + e²."""
    number = abs(exact(value))
    assert computed(SIZE, value=value) == number
    positive = tuple(math.copysign(1, value[0]) * each for each in value)
    root = computed(ROOT, value=positive)
    assert root > 0
    assert abs(root * root - number) <= 2 * 16 * UNIT**2 * number


@pytest.mark.parametrize("value", [(0.0, 0.0), (-1.0, 0.0)])
def test_the_square_root_of_a_number_not_above_0_is_0(value):
    assert computed(ROOT, value=value) == 0
