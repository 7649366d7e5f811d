"""Taking constants out of a loop changes no bit of any answer."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hypcheck.derivation.evaluation import EXACT, loop_body, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.geometry.pair import COLUMNS, SIZES
from hypcheck.vectors.families import FAMILIES

NAMES = [name for name, formula in FORMULAS.items() if formula.classifies_pairs]
ROWS = np.concatenate([FAMILIES[name].rows(1, 50) for name in ("tower-body", "ring", "forest-type-2", "stiff-both")])


def inputs(rows):
    return dict(zip(COLUMNS, rows.T, strict=True))


def parts(values):
    constants = {name: values[name] for name in SIZES}
    return constants, {name: value for name, value in values.items() if name not in SIZES}


@pytest.mark.parametrize("precision", ["float16", "float32", "float64"])
def test_hoisting_changes_no_value_of_a_formula_in_floats(precision):
    values, arithmetic = inputs(ROWS), float_arithmetic(precision)
    constants, centre = parts(values)
    for formula in map(FORMULAS.get, NAMES):
        wanted = (formula.answer, "c1", "c2")
        whole = outputs(formula.program, arithmetic, values, wanted)
        for one, other in zip(whole, loop_body(formula.program, arithmetic, constants, wanted)(centre), strict=True):
            assert one.dtype == other.dtype, formula.name
            assert np.array_equal(one, other, equal_nan=one.dtype.kind == "f"), formula.name


def test_a_hoisted_loop_body_can_be_called_again_with_other_centres():
    program, arithmetic = FORMULAS["table-2"].program, float_arithmetic("float32")
    constants, centre = parts(inputs(ROWS))
    body = loop_body(program, arithmetic, constants, ("delta",))
    first = body(centre)[0].copy()
    moved = {name: value + 1 for name, value in centre.items()}
    assert not np.array_equal(body(moved)[0], first, equal_nan=True)
    assert np.array_equal(body(centre)[0], first, equal_nan=True)


def test_hoisting_changes_no_value_of_a_formula_in_exact_arithmetic():
    program = FORMULAS["procedure-2b-spheroid"].program
    values = {name: Fraction(value) for name, value in zip(COLUMNS, (2, 17.8, 0.25, 0.15, 1.5, 0.5, 3), strict=True)}
    constants, centre = parts(values)
    body = loop_body(program, EXACT, constants, ("delta", "valid"))
    assert body(centre) == outputs(program, EXACT, values, ("delta", "valid"))


def test_a_hoisted_loop_body_does_not_compute_constants_again():
    program, counted = FORMULAS["table-2"].program, []
    arithmetic = float_arithmetic("float64")
    counting = type(arithmetic)(
        "counting",
        arithmetic.convert,
        {
            name: (lambda *values, name=name: counted.append(name) or arithmetic.operations[name](*values))
            for name in arithmetic.operations
        },
    )
    body = loop_body(program, counting, dict(zip(SIZES, (2.0, 17.8, 0.25, 0.15), strict=True)), ("delta",))
    assert counted.count("div") == 2
    counted.clear()
    body({"x": 1.0, "y": 2.0, "z": 3.0})
    assert counted.count("div") == 2  # by b² and by d, as printed
    assert len(counted) == 28  # 12 for P, Q, c1 and c2, 16 for Δ without 27 c0²


def test_loop_body_raises_an_error_for_an_unknown_output_or_a_missing_input():
    program, arithmetic = FORMULAS["table-2"].program, float_arithmetic("float64")
    with pytest.raises(KeyError):
        loop_body(program, arithmetic, {}, ("nothing",))
    with pytest.raises(ValueError, match="needs a value for z"):
        loop_body(program, arithmetic, dict.fromkeys(SIZES, 1.0), ("delta",))({"x": 1.0, "y": 1.0})
