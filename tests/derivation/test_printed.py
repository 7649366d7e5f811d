"""The check of the paper's formulas finds the known misprints and any other that is introduced."""

from __future__ import annotations

import pytest
import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.pencil import difference, read, symbol
from hypcheck.derivation.printed_equations import PrintedClaim, check, check_equations, equality, printed_claims

NUMBERS = [*map(str, range(1, 22)), "A.1", "A.2a", "A.2b", "A.3", "A.4", "A.5", "A.6", "22", "23"]
MISPRINTS = {
    "11": (
        "the right side is a² times the left: the denominator a²·c² must be a⁴·c², and the roots stay the same",
        "f(λ) = g·(a² + λ)/(a⁴·c²)",
    ),
    "12": ("right − left = λ²·z_c²: the coefficient of λ² lacks − z_c²", None),
    "A.2b": ("right − left = γ²·l/(b_s²·d_s²): the sum l² + l + x0² + y0² has a stray + l", None),
}


def test_check_equations_has_every_numbered_formula_in_the_order_of_the_paper():
    assert [equation.number for equation in check_equations()] == NUMBERS


@pytest.mark.parametrize("number", NUMBERS)
def test_each_printed_formula_has_the_expected_verdict(number):
    (equation,) = (equation for equation in check_equations() if equation.number == number)
    assert equation.holds == (equation.number not in MISPRINTS)
    assert equation.verdict == ("holds" if equation.holds else "misprint")
    if not equation.holds:
        finding, correction = MISPRINTS[equation.number]
        assert equation.finding == finding
        assert correction in (None, equation.correction)
    else:
        assert (equation.finding, equation.correction) == ("right − left = 0", "")


@pytest.mark.parametrize("number", MISPRINTS)
def test_the_correction_of_each_misprint_holds(number):
    (claim,) = (claim for claim in printed_claims() if claim.number == number)
    (equation,) = (equation for equation in check_equations() if equation.number == number)
    corrected = read(equation.correction.partition("=")[2]).subs(claim.meanings)
    assert difference(corrected, claim.pairs[0][1]) == 0


CUBIC = "g(λ) = λ³ + (a² − c² + 1 − x_c² − y_c² − z_c²)·λ² − (a²·c² − a² + c² − c²·x_c² − c²·y_c² + a²·z_c²)·λ − a²·c²"


@pytest.mark.parametrize(
    ("printed", "misprinted", "finding"),
    [
        ("− z_c²)·λ²", "+ z_c²)·λ²", "the coefficient of λ² lacks − 2·z_c²"),
        ("+ c² − c²·x_c²", "− c²·x_c²", "the coefficient of λ lacks + c²"),
        ("(a² − c² + 1", "(a² − c² + 1 + a", "the coefficient of λ² has a stray + a"),
        ("λ³", "2·λ³", "lacks − λ³"),
        ("− a²·c²", "", "lacks − a²·c²"),
        ("λ³", "λ³ + λ²·λ²", "has a stray + λ⁴"),
    ],
)
def test_a_misprint_planted_in_the_cubic_is_found_and_corrected(printed, misprinted, finding):
    before, found, after = CUBIC.rpartition(printed)
    assert found
    g = pencil.scaled_cubic().g
    result = check((equality("12", before + misprinted + after, g=g),))
    assert result.verdict == "misprint"
    assert finding in result.finding
    assert difference(read(result.correction.partition("=")[2]), g) == 0
    assert check((equality("12", CUBIC, g=g),)).holds


def test_check_calls_a_formula_false_if_no_change_of_one_term_repairs_it():
    result = check((equality("0", "g(λ) = λ³ + a·λ² + c", g=pencil.scaled_cubic().g),))
    assert (result.holds, result.verdict) == (False, "false")


def test_check_reports_a_stray_term_in_a_formula_that_should_be_zero():
    result = check((PrintedClaim("0", "H = diag(1, 1, 1)", ((symbol("a"), sympy.Integer(0)),), {}),))
    assert result.finding == "right − left = a: the sum a has a stray + a"


def test_check_reports_a_wrong_factor_that_adds_a_root():
    right = read("(a² + λ)·g")
    result = check((PrintedClaim("0", "f = λ·(a² + λ)·g", ((symbol("lambda") * right, right),), {}),))
    assert result.finding == "the right side is λ times the left"


@pytest.mark.parametrize(
    "number",
    [pytest.param(each, marks=[pytest.mark.thorough] * (place % 4 > 0)) for place, each in enumerate(NUMBERS)],
)
def test_each_printed_claim_fails_if_it_is_changed(number):
    """The first pair of each number is changed in tests/paper/test_ledger_verdicts.py, too."""
    for claim in printed_claims():
        if claim.number == number:
            for index, (printed, derived) in enumerate(claim.pairs):
                broken = list(claim.pairs)
                broken[index] = (printed + symbol("x0") ** 2 / 7, derived)
                assert not check((PrintedClaim(number, claim.statement, tuple(broken), claim.meanings),)).holds


def test_difference_of_formulas_uses_that_cosine_and_sine_lie_on_the_unit_circle():
    cosine, sine = symbol("cosine"), symbol("sine")
    assert difference(cosine**2 + sine**2, sympy.Integer(1)) == 0
    assert difference(cosine**2 - sine**2, sympy.Integer(1)) != 0
