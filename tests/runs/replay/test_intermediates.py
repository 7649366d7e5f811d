"""A formula's values in a machine format and exactly, and the first decision that differs."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import given

from hypcheck.derivation.evaluation import UNDEFINED
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.arithmetic import QuadraticSurd
from hypcheck.geometry.pair import COLUMNS
from hypcheck.implementations.builtin import builtin
from hypcheck.runs.intermediates import SHOWN_FORMULAS, compare_formula
from tests.support.pairs import pairs

RING = (0.150390625, 0.109375, 2.8125, 0.375, -2.978515625, 0.0, 0.0)
"""Δ = 0 in the air; in float32 it comes out positive."""


def test_exact_intermediate_values_equal_their_definitions():
    found = compare_formula(FORMULAS["table-2"], "float32", RING)
    alpha, gamma, b, d, x, _, _ = map(Fraction, RING)
    A, B, P = (alpha / b) ** 2, (gamma / d) ** 2, (x / b) ** 2
    assert found.values["A"].exact == A
    assert found.values["c1"].exact == B * P + A - B - A * B
    single = np.float32(RING[0]) / np.float32(RING[2])
    assert found.values["A"].value == Fraction(float(single * single))
    error = abs(found.values["A"].value / A - 1) * 2**24
    assert found.values["A"].error_u == pytest.approx(float(error), rel=1e-12)
    assert 0 < found.values["A"].error_u < 3  # two roundings of a/b, one of the square


def test_comparison_names_the_first_wrong_decision_and_the_number_that_causes_it():
    found = compare_formula(FORMULAS["table-2"], "float32", RING)
    assert found.values["delta"].exact == 0 < found.values["delta"].value
    assert (found.first_wrong, found.culprit) == ("distinct", "delta")
    assert (found.answer, found.exact_answer) == (1, 0)
    assert [each.name for each in found.values.values() if each.decided_otherwise] == [
        "distinct",
        "distinct_and_c2",
        "valid",
    ]


def test_comparison_names_the_less_accurate_of_two_numbers_in_a_wrong_decision():
    """λm < B, where λm is a surd just above B = 16/49: it loses more digits than B's single rounding does."""
    found = compare_formula(FORMULAS["local-maximum"], "float16", (0.875, 0.5, 1.125, 0.875, -2.0, 0.625, -0.25))
    assert (found.first_wrong, found.culprit) == ("below_B", "lambda_m")
    assert isinstance(found.values["lambda_m"].exact, QuadraticSurd)
    assert found.values["B"].exact == Fraction(16, 49) < found.values["lambda_m"].exact
    assert found.values["lambda_m"].value < found.values["B"].value != found.values["B"].exact


def test_comparison_names_no_decision_if_all_agree():
    found = compare_formula(FORMULAS["table-2"], "float64", (1.0, 2.0, 1.0, 1.0, 5.0, 0.0, 0.0))
    assert (found.first_wrong, found.culprit) == (None, None)
    assert found.answer == found.exact_answer == 1


def test_comparison_names_a_decision_on_nan_after_overflow_as_wrong():
    """c1 > 0 is asked of inf − inf in float16."""
    row = (1.8, 4.4, 0.038, 0.2285, -10.86, 0.0, -26.15)
    found = compare_formula(FORMULAS["hessian"], "float16", row)
    assert (found.first_wrong, found.culprit) == ("c1_positive", "c1")
    assert found.values["c1"].error_u == float("inf")
    assert found.values["position"].error_u is None


def test_values_that_are_undefined_in_exact_arithmetic_are_shown_as_undefined():
    """h1 < 0: the root of a negative number, on which the answer does not depend."""
    found = compare_formula(FORMULAS["local-maximum"], "float64", (1.625, 0.25, 2.0, 1.0, 1.125, 1.25, -0.625))
    assert found.values["h1"].exact < 0
    assert found.values["root"].exact is UNDEFINED
    assert found.values["root"].error_u is None
    assert found.answer == found.exact_answer == 0


@pytest.mark.parametrize("name", [name for name in SHOWN_FORMULAS if name != "dual"])
def test_comparison_gives_the_answer_of_the_formula_in_each_format(name):
    rows = (RING, (2.0, 17.8, 0.25, 0.15, 1.2, -1.7, 0.3), (1.0, 2.0, 1.0, 1.0, 2.0, 0.0, 0.0))
    for format_name, row in product(("float16", "float32", "float64", "longdouble"), rows):
        found = compare_formula(FORMULAS[name], format_name, row)
        columns = dict(zip(COLUMNS, row, strict=True))
        assert found.answer == answers(FORMULAS[name], float_arithmetic(format_name), columns)


@pytest.mark.slow
@given(pairs)
def test_comparison_of_the_dual_form_gives_the_answer_of_its_built_in_method(pair):
    for precision in ("float32", "float64"):
        found = compare_formula(FORMULAS["dual"], precision, pair.row)
        if found is not None:
            method = builtin(f"dual-{precision}")
            assert found.answer == method.answer(np.array([pair.row]))[0]
            assert found.values["lambda_"].value == found.values["lambda_"].exact


def test_dual_form_without_a_finite_multiplier_has_no_values():
    assert compare_formula(FORMULAS["dual"], "float16", (1e5, 1.0, 1.0, 1.0, 1e5, 0.0, 0.0)) is None
