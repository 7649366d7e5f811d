"""Signs of quadratics at each other's roots, against sympy's real roots."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.arithmetic import exact_root
from tests.support.inside import polynomial_product, sign_at, sign_at_root
from tests.support.quadrics import isolate

X = sympy.Symbol("x")
SMALL = st.integers(-6, 6)


def rationals(numbers):
    return [Fraction(number) for number in numbers]


def expected(f, g, low, high):
    """The sign of g at the root of f between the two, None where there are two roots or an end is one."""
    f, g = (sympy.Poly(numbers, X) for numbers in (f, g))
    if f.degree() < 1:
        return 0
    roots = [root for root in set(sympy.real_roots(f)) if low <= root <= high]
    if len(roots) > 1 or any(root in (low, high) for root in roots):
        return None
    return int(sympy.sign(sympy.expand(g.as_expr().subs(X, roots[0])))) if roots else 0


@given(st.tuples(SMALL, SMALL, SMALL).filter(any), st.tuples(SMALL, SMALL, SMALL), SMALL, st.integers(1, 8))
def test_sign_of_a_quadratic_at_the_one_root_of_another_is_that_at_sympys_root(f, g, low, width):
    right = expected(f, g, low, low + width)
    if right is not None:
        assert sign_at_root(rationals(f), rationals(g), Fraction(low), Fraction(low + width)) == right


@given(st.integers(1, 9), st.integers(-9, 9), st.integers(1, 5))
def test_sign_at_root_is_0_for_a_quadratic_with_the_same_root(square, shift, factor):
    """The root is shift + √square."""
    f = (1, -2 * shift, shift * shift - square)
    low = Fraction(shift)
    assert sign_at_root(rationals(f), rationals([factor * number for number in f]), low, low + 4) == 0
    for other in (-1, 1):
        beside = [factor * number for number in f]
        beside[2] += other
        assert sign_at_root(rationals(f), rationals(beside), low, low + 4) == other


def test_the_sign_of_a_polynomial_at_its_own_root_is_0():
    for root in (Fraction(0), Fraction(2), Fraction(-3, 7)):
        beside = (root.denominator, -root.numerator)
        assert sign_at(beside, root) == 0
        assert (sign_at(beside, root + 1), sign_at(beside, root - 1)) == (1, -1)


@pytest.mark.parametrize("gap", [Fraction(1, 3), Fraction(1, 1 << 60), Fraction(1 << 90)])
@pytest.mark.parametrize("sign", [-1, 1])
def test_two_roots_have_disjoint_enclosures_however_near_or_far_apart_they_are(gap, sign):
    first = Fraction(5, 3)
    roots = sorted((sign * first, sign * (first + gap)))
    factors = [(root.denominator, -root.numerator) for root in roots]
    found = isolate(polynomial_product(*factors))
    assert len(found) == 2
    assert all(low < root < high for root, (low, high) in zip(roots, found, strict=True))


def test_two_roots_between_neighbouring_powers_of_two_have_disjoint_enclosures():
    """There a power of two in the middle of the exponents would be an end."""
    below, above = isolate(polynomial_product((1, -9), (1, -15)))
    assert below[0] < 9 < below[1] <= above[0] < 15 < above[1]


@pytest.mark.parametrize(("w", "rational"), [(2, False), (16, True), (Fraction(9, 4), True), (Fraction(4, 3), False)])
def test_exact_root_squared_is_its_radicand_and_is_a_fraction_if_the_radicand_is_a_square(w, rational):
    root = exact_root(Fraction(w))
    assert root * root == w
    assert root > 0
    assert isinstance(root, Fraction) == rational
