"""The derivation in symbols against determinants and roots computed in plain rationals."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import permutations

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck.derivation import pencil
from hypcheck.derivation.links import identities, vanishes
from hypcheck.derivation.pencil import plain, read, symbol

positive = st.fractions(Fraction(1, 8), 8, max_denominator=8)
coordinate = st.fractions(-8, 8, max_denominator=8)


def determinant(matrix):
    """The determinant by its definition, a signed sum over permutations."""
    size = len(matrix)
    total = Fraction(0)
    for order in permutations(range(size)):
        inversions = sum(order[i] > order[j] for i in range(size) for j in range(i + 1, size))
        product = Fraction((-1) ** inversions)
        for row, column in enumerate(order):
            product *= matrix[row][column]
        total += product
    return total


@pytest.mark.slow
@settings(max_examples=6)
@given(positive, positive, positive, positive, coordinate, coordinate, coordinate, coordinate)
def test_the_polynomial_f_is_the_determinant_of_the_pencil(alpha, gamma, b, d, x, y, z, at):
    a, c, xc, yc, zc = alpha / b, gamma / d, x / b, y / b, z / d
    matrix = [
        [at / a**2 + 1, 0, 0, -xc],
        [0, at / a**2 + 1, 0, -yc],
        [0, 0, 1 - at / c**2, -zc],
        [-xc, -yc, -zc, xc**2 + yc**2 + zc**2 - 1 - at],
    ]
    here = dict(zip(pencil.SEVEN, map(sympy.Rational, (alpha, gamma, b, d, x, y, z)), strict=True))
    value = pencil.cubic_in_seven().f.subs({**here, pencil.LAMBDA: sympy.Rational(at)})
    assert sympy.Rational(determinant(matrix)) == value


def test_the_coefficients_of_the_cubic_are_those_derived_by_hand():
    # (A+λ)(B−λ)(P+Q−1−λ) − AP(B−λ) − BQ(A+λ), multiplied out on paper.
    cubic = pencil.cubic()
    assert plain(cubic.c0) == "−A·B"
    assert vanishes(cubic.c1 - read("−A·B + A − B + B·P − A·Q"))
    assert vanishes(cubic.c2 - read("A − B + 1 − P − Q"))
    assert vanishes(cubic.f - read("A + λ") * cubic.g / read("A²·B"))


@pytest.mark.parametrize("roots", [(1, 2, 4), (-3, -1, 2), (5, 5, -1), (2, 2, 2)])
def test_the_discriminant_is_the_product_of_squared_differences_of_the_roots(roots):
    first, second, third = roots
    values = {
        symbol("c2"): -(first + second + third),
        symbol("c1"): first * second + second * third + third * first,
        symbol("c0"): -first * second * third,
    }
    expected = ((first - second) * (second - third) * (third - first)) ** 2
    assert pencil.discriminant_of_cubic().subs(values) == expected


def test_the_cubics_derived_in_sizes_in_seven_numbers_and_scaled_agree():
    scaled, seven = pencil.scaled_cubic(), pencil.cubic_in_seven()
    for name in ("c0", "c1", "c2", "f"):
        in_sizes = getattr(pencil.cubic(), name).subs(pencil.IN_SEVEN)
        assert vanishes(in_sizes - getattr(seven, name)), name
        assert vanishes(getattr(scaled, name).subs(pencil.SCALED) - getattr(seven, name)), name


def test_each_identity_of_the_derivation_holds_and_fails_with_an_added_term():
    for statement, gap in identities().items():
        assert vanishes(gap), statement
        assert not vanishes(gap + read("A·B/1000")), statement


def test_the_derivation_raises_an_error_for_a_surface_that_is_not_one_of_revolution():
    (hyperboloid, sphere), scaled = pencil.scaled_matrices(), pencil.scaled_cubic()
    with pytest.raises(ArithmeticError, match="more than A, B, P and Q"):
        pencil.in_invariants(replace(scaled, c2=scaled.c2 + pencil.YC))
    elliptic = hyperboloid + sympy.diag(1, 0, 0, 0)  # no surface of revolution: −a² is no root of its pencil
    with pytest.raises(ArithmeticError, match="times a cubic"):
        pencil.cubic_of(elliptic, sphere)


def test_a_formula_in_plain_text_is_read_as_its_expression_and_written_back():
    alpha, lambda_, c1 = symbol("alpha"), symbol("lambda"), symbol("c1")
    assert read("−(α/b)²·λ³ + c1(g_i)/2 − √2") == -((alpha / symbol("b")) ** 2) * lambda_**3 + c1 / 2 - sympy.sqrt(2)
    assert read("diag(1/α², −1)") == sympy.diag(1 / alpha**2, -1)
    assert plain(lambda_**10 - 2 * alpha) == "−2·α + λ¹⁰"
    for text in ("x_c² + 1", "(a + λ)·g/(a⁴·c²)", "√2·l/2"):
        assert read(plain(read(text))) == read(text)
