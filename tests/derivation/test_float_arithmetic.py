"""Float arithmetic: one correctly rounded operation a step, in one format from the inputs to the answer."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.float_arithmetic import FORMATS, float_arithmetic, unit_roundoff
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.derivation.program import program_of
from hypcheck.geometry.pair import COLUMNS

DIGITS = {"float16": 11, "float32": 24, "float64": 53}
ROW = {"alpha": 3.1, "gamma": 5.3, "b": 0.7, "d": 0.9, "x": 2.2, "y": -1.1, "z": 0.6}
ALL_INPUTS = {**ROW, "b_s": 0.3, "d_s": 0.2, "l": 0.4, "cosine": 0.6, "sine": 0.8, "lambda_": 0.25}


def nearest(exact: Fraction, digits: int) -> Fraction:
    """The exact value rounded to that many binary digits, ties to even, exponent unlimited."""
    if exact == 0:
        return exact
    exponent = exact.numerator.bit_length() - exact.denominator.bit_length() - digits
    unit = Fraction(2) ** exponent
    while abs(exact) / unit >= 2**digits:
        unit *= 2
    while abs(exact) / unit < 2 ** (digits - 1):
        unit /= 2
    return round(exact / unit) * unit  # round() of a Fraction takes ties to even


def nearest_root(square: Fraction, digits: int) -> Fraction:
    """√square rounded to that many binary digits, by an integer root with digits to spare (an exact tie cannot be)."""
    scale = 4**200
    return nearest(Fraction(math.isqrt(square.numerator * scale // square.denominator), 2**200), digits)


numbers = st.floats(0.0625, 16, width=16).flatmap(lambda value: st.sampled_from([value, -value]))


@pytest.mark.parametrize("format_name", DIGITS)
@given(left=st.tuples(numbers, numbers), right=st.tuples(numbers, numbers))
def test_each_operation_of_float_arithmetic_is_rounded_once_to_nearest(format_name, left, right):
    digits = DIGITS[format_name]
    operations = float_arithmetic(format_name).operations
    # Sums of two short numbers fill the format's digits, so that operations on them have something to round.
    x, y = (nearest(Fraction(a) + Fraction(b) / 2 ** (digits - 6), digits) for a, b in (left, right))
    here = np.dtype(format_name).type
    exact = {"add": x + y, "sub": x - y, "mul": x * y, "div": x / y if y else None}
    for name, value in exact.items():
        if value is not None:
            assert Fraction(float(operations[name](here(float(x)), here(float(y))))) == nearest(value, digits)
    assert Fraction(float(operations["sqrt"](here(float(abs(x)))))) == nearest_root(abs(x), digits)


@given(st.floats(-60000, 60000, allow_subnormal=False).filter(lambda value: abs(value) > 0.001))
def test_float_arithmetic_rounds_an_input_to_nearest_when_it_converts_it(value):
    for format_name in ("float16", "float32"):
        converted = float_arithmetic(format_name).convert(value)
        assert Fraction(float(converted)) == nearest(Fraction(value), DIGITS[format_name])


@pytest.mark.parametrize("as_array", [False, True], ids=["scalars", "arrays"])
@pytest.mark.parametrize("format_name", FORMATS)
def test_every_intermediate_value_of_a_formula_has_the_chosen_float_format(format_name, as_array):
    inputs = {name: np.array([value, -value, 1e300]) for name, value in ALL_INPUTS.items()} if as_array else ALL_INPUTS
    for formula in FORMULAS.values():
        for name, value in evaluate(formula.program, float_arithmetic(format_name), inputs).items():
            assert np.asarray(value).dtype in (np.dtype(format_name), np.dtype(bool)), (formula.name, name)
        answer = answers(formula, float_arithmetic(format_name), inputs)
        assert answer.dtype == np.int8
        assert answer.shape == ((3,) if as_array else ())


@pytest.mark.parametrize("formula", [f for f in FORMULAS.values() if f.classifies_pairs], ids=lambda f: f.name)
def test_formulas_answer_alike_with_scalar_sizes_and_with_sizes_repeated_in_arrays(formula):
    random = np.random.default_rng(7)
    centres = {name: random.uniform(-9, 9, 500) for name in ("x", "y", "z")}
    sizes = {name: ROW[name] for name in ("alpha", "gamma", "b", "d")}
    together = answers(formula, float_arithmetic("float32"), {**sizes, **centres})
    filled = {**{name: np.full(500, value) for name, value in sizes.items()}, **centres}
    assert np.array_equal(together, answers(formula, float_arithmetic("float32"), filled))
    for index in range(0, 500, 50):
        row = {**sizes, **{name: values[index] for name, values in centres.items()}}
        assert answers(formula, float_arithmetic("float32"), row) == together[index]
    assert len(set(together.tolist())) > 1


def test_table_2_answers_0_without_a_warning_if_the_discriminant_is_nan():
    huge = dict(zip(COLUMNS, (30.0, 65.0, 0.001, 0.001, 20.0, 0.0, 1.0), strict=True))
    values = evaluate(FORMULAS["table-2"].program, float_arithmetic("float32"), huge)
    assert np.isnan(values["delta"])
    assert answers(FORMULAS["table-2"], float_arithmetic("float32"), huge) == 0


@pytest.mark.parametrize("name", ["procedure-2a-spheroid", "procedure-2b-spheroid"])
def test_procedures_2_as_printed_call_a_movement_valid_if_the_discriminant_is_nan(name):
    # "if Δ ≤ 0 … else": NaN is not ≤ 0. A body of radius 0.01 at distance 29.995 from the axis reaches through the
    # waist of radius 30, and in binary32 the printed procedure lets it.
    row = dict(zip(COLUMNS, (30.0, 70.0, 0.01, 0.005, 29.995, 0.0, 0.0), strict=True))
    assert np.isnan(evaluate(FORMULAS[name].program, float_arithmetic("float32"), row)["delta"])
    assert answers(FORMULAS[name], float_arithmetic("float32"), row) == 1
    assert answers(FORMULAS[name], float_arithmetic("float64"), row) == 0


def test_float_arithmetic_does_not_copy_arrays_of_its_format():
    array = np.arange(3, dtype=np.float32)
    assert float_arithmetic("float32").convert(array) is array


def test_integer_constants_in_a_program_get_the_float_format():
    program = program_of("p", ("x",), "y = x * 18\nz = 27 / y\np = z > 1\nw = p ? 1 : z")
    values = evaluate(program, float_arithmetic("float16"), {"x": np.ones(2)})
    assert [values[name].dtype.name for name in "xyzw"] == ["float16"] * 4


def test_unit_roundoff_is_half_the_gap_after_one():
    for format_name, digits in DIGITS.items():
        assert unit_roundoff(format_name) == 2.0**-digits


def test_float_arithmetic_refuses_an_unknown_format():
    with pytest.raises(ValueError, match="not one of the formats float16, float32, float64, longdouble"):
        float_arithmetic("bfloat16")
