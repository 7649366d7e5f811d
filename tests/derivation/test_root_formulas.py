"""The roots' way finds the roots, and a slip in it is not proved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.derivation.evaluation import EXACT, evaluate, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import APPROXIMATIONS, FORMULAS, ROOTS_TRIGONOMETRIC, SWEEP, answers
from hypcheck.derivation.program import line_of, steps_of
from hypcheck.derivation.proofs import prove
from hypcheck.geometry.pair import COLUMNS
from hypcheck.vectors.families import FAMILIES

FLOAT64 = float_arithmetic("float64")


def rows():
    return FAMILIES["tower-body"].block(3, 0)[:200]


def test_the_trigonometric_formula_is_proved():
    assert all(proof.holds for proof in prove(ROOTS_TRIGONOMETRIC))


@pytest.mark.parametrize(
    "line",
    [
        "nine_c1 = 8 * c1",
        "w = w_of_c2 + c0_27",
        "h1_cubed_4 = 3 * h1_cubed",
        "root = sqrt h1_squared",
        "cubed_root = root * h1",
        "theta = three_theta / 2",
        "third_of_turn = cos minus_half",
        "theta_3 = theta + third_of_turn",
        "cosine_2 = cos theta",
        "three_r2 = t_2 + c2",
        "r3 = three_r3 / 2",
        "distinct = delta_27 >= 0",
        "r2_positive = r1 > 0",
        "valid = distinct or all_positive",
    ],
)
def test_the_trigonometric_formula_with_one_wrong_step_is_not_proved(line):
    (wrong,) = steps_of(line)
    steps = tuple(wrong if step.name == wrong.name else step for step in ROOTS_TRIGONOMETRIC.program.steps)
    program = replace(ROOTS_TRIGONOMETRIC.program, steps=steps)
    assert program != ROOTS_TRIGONOMETRIC.program
    assert not all(proof.holds for proof in prove(replace(ROOTS_TRIGONOMETRIC, program=program)))


def test_roots_of_the_trigonometric_formula_are_those_of_the_cubic():
    columns = dict(zip(COLUMNS, rows().T, strict=True))
    values = evaluate(ROOTS_TRIGONOMETRIC.program, FLOAT64, columns)
    three_real = np.flatnonzero(values["delta_27"] > 1e-6 * values["h1_cubed_4"])
    assert len(three_real) > 50
    for place in three_real:
        found = np.sort([values[name][place] for name in ("r1", "r2", "r3")])
        expected = np.sort(np.roots([1, *(values[name][place] for name in ("c2", "c1", "c0"))]).real)
        assert np.allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())


def test_the_trigonometric_formula_answers_as_procedure_1_as_printed():
    columns = dict(zip(COLUMNS, rows().T, strict=True))
    by_roots = answers(ROOTS_TRIGONOMETRIC, FLOAT64, columns)
    assert 0 < np.count_nonzero(by_roots) < len(by_roots)
    assert np.array_equal(by_roots, answers(FORMULAS["procedure-1"], FLOAT64, columns))


@pytest.mark.parametrize("wanted", [(1, 2, 5), (-3, -1, 4), (2 + 1j, 2 - 1j, 3), (1e-3, 1, 1e3)])
def test_repeated_iterations_of_the_root_finder_converge_to_the_roots(wanted):
    c2, c1, c0 = np.poly(wanted)[1:].real
    starts = [(0.4 + 0.9j) ** power for power in range(3)]
    state = {
        name: value
        for z, x, y in zip(starts, APPROXIMATIONS[::2], APPROXIMATIONS[1::2], strict=True)
        for name, value in ((x, z.real), (y, z.imag))
    }
    for _ in range(60):
        new = outputs(
            SWEEP, FLOAT64, {"c2": c2, "c1": c1, "c0": c0, **state}, [f"new_{name}" for name in APPROXIMATIONS]
        )
        state = dict(zip(APPROXIMATIONS, map(float, new), strict=True))
    found = [complex(state[x], state[y]) for x, y in zip(APPROXIMATIONS[::2], APPROXIMATIONS[1::2], strict=True)]
    for root in wanted:
        assert min(abs(root - each) for each in found) < 1e-8 * max(1, abs(root))


def test_evaluating_the_trigonometric_formula_in_exact_arithmetic_raises_an_error():
    with pytest.raises(ValueError, match="exact arithmetic has no arccos"):
        answers(ROOTS_TRIGONOMETRIC, EXACT, dict(zip(COLUMNS, (1, 2, 1, 1, 3, 0, 0), strict=True)))


def test_steps_with_cosines_are_written_in_a_listing_and_read_back():
    lines = list(map(line_of, ROOTS_TRIGONOMETRIC.program.steps))
    assert "cosine_2 = cos theta_2" in lines
    assert steps_of("\n".join(lines)) == ROOTS_TRIGONOMETRIC.program.steps
