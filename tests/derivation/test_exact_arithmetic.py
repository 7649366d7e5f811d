"""Numbers p + q√h: the laws of a field, signs against 200 digits, and undefined values."""

from __future__ import annotations

import operator
from decimal import Decimal, localcontext
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import EXACT, UNDEFINED, square_root
from hypcheck.geometry.arithmetic import QuadraticSurd, surd

rationals = st.fractions(min_value=-1000, max_value=1000, max_denominator=1000)
roots = st.sampled_from([Fraction(2), Fraction(3, 7), Fraction(10**12 + 1), Fraction(1, 10**9 + 7)])
comparisons = st.sampled_from([operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne])


def decimal_of(number):
    """The number to 200 digits, by decimal square root."""
    with localcontext() as context:
        context.prec = 200
        if isinstance(number, QuadraticSurd):
            root = (Decimal(number.h.numerator) / number.h.denominator).sqrt()
            return decimal_of(number.p) + decimal_of(number.q) * root
        return Decimal(number.numerator) / number.denominator


@st.composite
def triples(draw):
    h = draw(roots)
    return tuple(surd(draw(rationals), draw(rationals), h) for _ in range(3))


@pytest.mark.slow
@given(triples())
def test_surds_obey_the_laws_of_a_field(numbers):
    x, y, z = numbers
    assert x + y == y + x
    assert x * y == y * x
    assert (x + y) * z == x * z + y * z
    assert (x * y) * z == x * (y * z)
    assert x - y == -(y - x)
    assert x + -x == 0
    if y != 0:
        assert x / y * y == x
        assert 1 / y == EXACT.operations["div"](Fraction(1), y)
        assert y * (1 / y) == 1


@pytest.mark.slow
@given(triples(), rationals, comparisons)
def test_comparisons_of_surds_agree_with_a_computation_to_200_digits(numbers, rational, compare):
    x, y, _ = numbers
    assert compare(x, y) == compare(decimal_of(x), decimal_of(y))
    assert compare(x, rational) == compare(decimal_of(x), decimal_of(rational))
    assert compare(rational, x) == compare(decimal_of(rational), decimal_of(x))


def test_tiny_surds_with_huge_coefficients_have_the_right_sign():
    # (√2 − 1)ⁿ = p − q√2 with p² − 2q² = ±1 is tiny, while p and q are huge.
    power = Fraction(1)
    for _ in range(400):
        power = power * surd(Fraction(-1), Fraction(1), Fraction(2))
    assert power > 0
    assert power < Fraction(1, 10**150)
    assert abs(-power) == power
    assert float(power.p + power.q * Fraction(2**0.5)) != pytest.approx(0)


def test_square_root_gives_a_fraction_for_squares_and_a_surd_otherwise():
    assert square_root(Fraction(49, 4)) == Fraction(7, 2)
    assert isinstance(square_root(Fraction(49, 4)), Fraction)
    assert isinstance(square_root(Fraction(50, 4)), QuadraticSurd)
    assert square_root(Fraction(50, 4)) * square_root(Fraction(50, 4)) == Fraction(25, 2)
    assert square_root(Fraction(0)) == 0


def test_equal_surds_are_one_element_of_a_set():
    first, second = (square_root(Fraction(2)) * factor for factor in (Fraction(3), Fraction(6, 2)))
    assert len({first, second, first + 1}) == 2
    assert len({UNDEFINED, EXACT.operations["div"](first, Fraction(0)), first}) == 2


def test_surds_of_two_different_roots_cannot_be_added():
    with pytest.raises(ValueError, match="one quadratic field"):
        square_root(Fraction(2)) + square_root(Fraction(3))
    with pytest.raises(TypeError):
        square_root(square_root(Fraction(2)))


@pytest.mark.parametrize("other", [Fraction(3), surd(Fraction(1), Fraction(1), Fraction(2)), UNDEFINED])
def test_operations_with_an_undefined_value_are_undefined_and_comparisons_false(other):
    for name in ("add", "sub", "mul", "div"):
        assert EXACT.operations[name](UNDEFINED, other) is UNDEFINED
        assert EXACT.operations[name](other, UNDEFINED) is UNDEFINED
    for name in ("gt", "lt", "ge", "le", "eq"):
        assert EXACT.operations[name](UNDEFINED, other) is False
        assert EXACT.operations[name](other, UNDEFINED) is False
    assert EXACT.operations["ne"](UNDEFINED, other) is True
    assert EXACT.operations["ne"](other, UNDEFINED) is True


def test_division_by_zero_and_roots_of_negative_numbers_are_undefined():
    assert EXACT.operations["div"](Fraction(1), Fraction(0)) is UNDEFINED
    assert EXACT.operations["div"](square_root(Fraction(2)), Fraction(0)) is UNDEFINED
    assert EXACT.operations["sqrt"](Fraction(-1)) is UNDEFINED
    assert EXACT.operations["sqrt"](UNDEFINED) is UNDEFINED
    assert -UNDEFINED is UNDEFINED
    assert abs(UNDEFINED) is UNDEFINED
    assert EXACT.operations["select"](False, UNDEFINED, Fraction(1)) == 1


def test_exact_arithmetic_takes_floats_at_their_exact_value():
    assert EXACT.convert(0.1) == Fraction(3602879701896397, 2**55)
