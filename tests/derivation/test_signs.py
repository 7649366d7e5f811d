"""`has_sign` reads a sign off the form of an expression, and never a wrong one."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.derivation.links import RELATIONS, has_sign
from hypcheck.derivation.pencil import read, symbol

A, B, P, Q = (symbol(name) for name in "ABPQ")


@pytest.mark.parametrize(
    ("text", "relation", "positive", "nonnegative", "shown"),
    [
        ("A·B", ">", (A, B), (), True),
        ("A·P", ">", (A,), (P,), False),
        ("A·P", "≥", (A,), (P,), True),
        ("A + P", ">", (A,), (P,), True),
        ("−A·P·(A + B)", "≤", (A, B), (P,), True),
        ("−A − 1", "<", (A,), (), True),
        ("1/A − 1/(A + B)", ">", (A, B), (), True),
        ("P/Q", "≥", (), (P, Q), False),  # Q = 0 has no sign
        ("A/(−B)", "<", (A, B), (), True),
        ("A − B", ">", (A, B), (), False),
        ("A − B", "≥", (A, B), (), False),
        ("(A − B)²", "≥", (A, B), (), False),  # true, but the form does not show it
        ("A·Q", "≥", (A,), (), False),  # nothing is said about Q
        ("A·Q²", "≥", (A,), (), True),
        ("A + Q² + Q⁴", ">", (A,), (), True),
        ("A + Q²", ">", (), (A,), False),
        ("A + Q²·P", "≥", (A,), (), False),
        ("3", ">", (), (), True),
        ("−1", ">", (), (), False),
        ("0·A", "≥", (A,), (), True),
        ("0·A", ">", (A,), (), False),
        ("√2·A", ">", (A,), (), True),
        ("A²·P + B/A", ">", (A, B), (P,), True),
    ],
)
def test_has_sign_finds_the_sign_of_an_expression_from_its_form(text, relation, positive, nonnegative, shown):
    assert has_sign(read(text), relation, positive, nonnegative) is shown


def test_has_sign_is_false_for_a_factor_that_is_not_a_power_of_a_symbol():
    assert not has_sign(sympy.sin(A) + 2, ">", (A,), ())
    assert not has_sign(sympy.sqrt(A), ">", (A,), ())


def test_has_sign_raises_an_error_for_an_unknown_relation():
    with pytest.raises(ValueError, match="is not one of"):
        has_sign(A, "=", (A,), ())


terms = st.lists(
    st.tuples(st.integers(-3, 3), st.integers(0, 2), st.integers(0, 2), st.integers(0, 2)), min_size=1, max_size=4
)
values = st.fractions(Fraction(1, 9), 9)


@pytest.mark.slow
@given(terms, terms, values, st.fractions(-9, 9), st.one_of(st.just(Fraction(0)), values))
def test_signs_that_has_sign_finds_are_those_of_random_values(top, bottom, a, b, p):
    """A is above 0, P not below it, and of B nothing is said."""
    numerator, denominator = (
        sum((n * A**i * B**j * P**k for n, i, j, k in part), sympy.Integer(0)) for part in (top, bottom)
    )
    at = {A: sympy.Rational(a), B: sympy.Rational(b), P: sympy.Rational(p)}
    if denominator == 0 or denominator.subs(at) == 0:
        return
    value = (numerator / denominator).subs(at)
    true = {">": value > 0, "≥": value >= 0, "<": value < 0, "≤": value <= 0}
    for relation in RELATIONS:
        assert true[relation] or not has_sign(numerator / denominator, relation, (A,), (P,))
