"""Exact values as text: every shown digit is right at any size, and surds do not cancel."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import UNDEFINED
from hypcheck.geometry.arithmetic import QuadraticSurd
from hypcheck.runs.intermediates import number_of, number_text, rational, relative_error

FRACTIONS = st.fractions(min_value=-(10**6), max_value=10**6, max_denominator=10**6).filter(bool)
NOT_SQUARES = st.integers(2, 10**6).filter(lambda n: math.isqrt(n) ** 2 != n)


def decimal_of(surd):
    """A surd to 60 digits, by the decimal module's own root."""
    with localcontext() as context:
        context.prec = 120
        p, q, h = (Decimal(part.numerator) / Decimal(part.denominator) for part in (surd.p, surd.q, surd.h))
        return p + q * h.sqrt()


@given(FRACTIONS, FRACTIONS, NOT_SQUARES)
def test_rational_approximation_of_a_surd_is_within_its_precision(p, q, h):
    value = QuadraticSurd(p, q, Fraction(h))
    near, true = rational(value, 80), Fraction(decimal_of(value))
    assert abs(near - true) <= abs(true) / 2**79


def test_decimal_text_of_a_surd_that_nearly_cancels_is_right():
    close = Fraction(math.isqrt(2 * 10**80), 10**40)  # √2 to 40 digits
    value = QuadraticSurd(-close, Fraction(1), Fraction(2))
    true = Fraction(decimal_of(value))
    assert 0 < true < Fraction(1, 10**39)
    assert abs(rational(value, 60) - true) <= true / 2**59
    assert number_text(value) == f"{decimal_of(value):.8}".replace("E", "e")


def test_decimal_text_of_a_surd_with_a_tiny_root_is_right():
    value = QuadraticSurd(Fraction(0), Fraction(3), Fraction(1, 2**2001))
    true = Fraction(9, 2**2001)
    assert abs(rational(value, 64) ** 2 - true) < true / 2**62


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Fraction(0), "0"),
        (Fraction(1, 3), "0.33333333"),
        (Fraction(-2, 3), "-0.66666667"),
        (Fraction(300), "300"),
        (Fraction(10**7), "10000000"),
        (Fraction(10**8), "1e8"),
        (Fraction(123456789), "1.2345679e8"),
        (Fraction(1, 8), "0.125"),
        (Fraction(1, 2**20), "9.5367432e-7"),
        (Fraction(10) ** 1000 / 3, "3.3333333e999"),
        (QuadraticSurd(Fraction(0), Fraction(-1), Fraction(2)), "-1.4142136"),
        (UNDEFINED, "undefined"),
        (True, "yes"),
        (False, "no"),
        (float("nan"), "nan"),
        (float("-inf"), "-inf"),
    ],
)
def test_number_text_shows_exact_and_float_values(value, text):
    assert number_text(value) == text


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble])
def test_numpy_floats_are_converted_to_exact_numbers(kind):
    third = kind(1) / kind(3)
    assert number_of(np.asarray(third)) == Fraction(*third.as_integer_ratio())
    assert number_of(kind("inf")) == math.inf
    assert math.isnan(number_of(kind("nan")))
    assert number_of(np.asarray(third > 0)) is True


def test_relative_error_of_special_and_ordinary_values_is_right():
    assert relative_error(Fraction(3), Fraction(2)) == 0.5
    assert relative_error(Fraction(0), Fraction(0)) == 0
    assert relative_error(Fraction(1), Fraction(0)) == math.inf
    assert relative_error(float("nan"), Fraction(1)) == math.inf
    assert relative_error(Fraction(1), UNDEFINED) is None
    assert relative_error(True, False) is None
    root = Fraction(float(np.sqrt(np.float64(2))))
    expected = abs(Fraction(decimal_of(QuadraticSurd(Fraction(0), Fraction(1), Fraction(2)))) - root) / Fraction(2**0.5)
    assert relative_error(root, QuadraticSurd(Fraction(0), Fraction(1), Fraction(2))) == pytest.approx(
        float(expected), rel=1e-9
    )
