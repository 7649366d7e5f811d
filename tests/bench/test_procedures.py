"""The quadcopter's procedures in numpy evaluate the listed programs, and ask the rotors only if necessary."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.bench.claims import flight_of
from hypcheck.bench.procedures import PROCEDURES, rotors_at
from hypcheck.derivation.evaluation import outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED


@pytest.fixture(scope="module")
def flight():
    return flight_of(3, 3000)


@pytest.mark.parametrize("name", ["procedure-2a", "procedure-2b", "procedure-2a-repaired", "procedure-2b-repaired"])
def test_each_numpy_procedure_answers_as_the_program_of_its_formula(name, flight):
    inputs = {**flight.craft, **flight.columns}
    (right,) = outputs({**FORMULAS, **REPAIRED}[name].program, float_arithmetic("float64"), inputs, ("valid",))
    assert (PROCEDURES[name](flight) == right).all()
    assert 0 < right.sum() < len(right)


def test_the_certified_procedure_agrees_with_procedure_2b_along_a_flight(flight):
    ours, second = PROCEDURES["certified"](flight), PROCEDURES["procedure-2b"](flight)
    assert np.count_nonzero(ours != second) <= 2  # along a flight nothing is near enough to matter


def test_rotors_at_returns_four_rotors_at_the_arm_length_a_quarter_turn_apart(flight):
    ends = rotors_at(flight.cosine, flight.sine, 0.135)
    assert len(ends) == 4
    for (x, y), (u, v) in zip(ends, ends[1:] + ends[:1], strict=True):
        assert np.allclose(np.hypot(x, y), 0.135)
        assert np.allclose((-y, x), (u, v))
