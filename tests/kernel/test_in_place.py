"""Programs over buffers in numpy: every step the same to the bit, in as few buffers as possible."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.derivation.evaluation import evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.program import program_of
from hypcheck.kernel.printing.modules import in_place_statements
from tests.kernel.printing_samples import PROGRAMS, columns

WITHOUT_CHOICES = {
    name: program for name, program in PROGRAMS.items() if not any(step.operation == "select" for step in program.steps)
}


def run(program, wanted, inputs):
    """The wanted values, from statements run in buffers that begin with rubbish."""
    printed = in_place_statements(program, wanted)
    shape = next(iter(inputs.values())).shape
    names = {f"n{k}": np.full(shape, np.pi) for k in range(printed.numbers)}
    names |= {f"t{k}": np.ones(shape, bool) for k in range(printed.truths)}
    with np.errstate(all="ignore"):
        exec("\n".join(printed.statements), {"np": np}, names | inputs)  # noqa: S102 - what was printed is to be run
    return {name: names[printed.place[name]] for name in wanted}, printed


@pytest.mark.parametrize("program", WITHOUT_CHOICES.values(), ids=WITHOUT_CHOICES)
@pytest.mark.parametrize("alone", [True, False], ids=["one-by-one", "all-at-once"])
def test_every_step_printed_in_place_gives_the_same_bits_as_its_program(program, alone):
    inputs = dict(zip(program.inputs, columns(program, "float64"), strict=True))
    before = {name: value.copy() for name, value in inputs.items()}
    expected = evaluate(program, float_arithmetic("float64"), inputs)
    steps = tuple(step.name for step in program.steps)
    for wanted in [(step,) for step in steps] if alone else [steps]:
        found, _ = run(program, wanted, inputs)
        for name in wanted:
            right = np.broadcast_to(expected[name], found[name].shape)
            assert np.array_equal(found[name], right, equal_nan=right.dtype != bool), name
    assert all(np.array_equal(inputs[name], before[name], equal_nan=True) for name in inputs)


def test_in_place_statements_reuse_a_buffer_after_its_last_read():
    program = program_of("chain", ("x",), "a = x + 1\nb = a * a\nc = b + x\nd = c - -2\np = d > 0\nq = not p")
    printed = in_place_statements(program, ("q",))
    assert (printed.numbers, printed.truths) == (1, 1)
    assert printed.statements[:2] == ("np.add(x, 1.0, n0)  # a = x + 1", "np.multiply(n0, n0, n0)  # b = a * a")
    assert printed.statements[3] == "np.subtract(n0, -2.0, n0)  # d = c - -2"


def test_in_place_statements_round_copied_inputs_and_do_not_change_them():
    program = program_of("norm", ("x", "y", "k"), "xx = x * x\nyy = y * y\nr = xx + yy\np = r > k")
    printed = in_place_statements(program, ("r", "p"), copied=("x", "y"))
    assert (printed.numbers, printed.truths) == (2, 1)
    x, y = np.random.default_rng(1).uniform(-1, 1, (2, 100))
    before = x.copy(), y.copy()
    names = {"x": x, "y": y, "k": 0.5, "t0": np.ones(100, bool)} | {
        f"n{k}": np.full(100, np.float32(7)) for k in (0, 1)
    }
    exec("\n".join(printed.statements), {"np": np}, names)  # noqa: S102 - what was printed is to be run
    of_x, of_y = x.astype(np.float32), y.astype(np.float32)
    assert np.array_equal(names[printed.place["r"]], of_x * of_x + of_y * of_y)
    assert np.array_equal(names[printed.place["p"]], names[printed.place["r"]] > 0.5)
    assert np.array_equal((x, y), before)


def test_in_place_statements_raise_an_error_for_a_selection():
    with pytest.raises(ValueError, match="step y: there is no ufunc in place for select"):
        in_place_statements(program_of("choice", ("x",), "p = x > 0\ny = p ? x : 1"), ("y",))
