"""The repaired procedures answer as the exact oracle does in their regimes; a changed step is not proved."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.derivation.chain_book import proved
from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, answers
from hypcheck.derivation.proofs import proofs_of, prove
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.paper.ledger import statements
from hypcheck.paper.ledger.points import Point, facts, facts_in_order
from hypcheck.paper.ledger.statements import quadcopters
from tests.derivation.test_proofs import mutants
from tests.support import inside


@pytest.mark.parametrize("name", REPAIRED)
def test_each_repaired_formula_is_proved(name):
    assert proofs_of(REPAIRED[name])
    assert all(proof.holds for proof in proofs_of(REPAIRED[name]))


def test_the_proof_chain_of_repaired_procedure_1_holds():
    assert proved("Procedure 1, repaired")


def test_repaired_procedure_1_answers_rightly_on_every_pair_of_the_space_in_its_regime():
    asked = [each for each in facts_in_order() if statements.tall(each)]
    assert len(asked) > 5000
    wrong = 0
    for each in asked:
        row = dict(zip(COLUMNS, each.point.pair.row, strict=True))
        assert answers(REPAIRED["procedure-1-repaired"], EXACT, row) == statements.exterior(each), each.point
        wrong += answers(FORMULAS["table-2"], EXACT, row) != statements.exterior(each)
    assert wrong > 10  # the ring


def quadcopter_says(formula, each):
    hull = each.hull.point
    lengths = {"alpha": hull.a, "gamma": hull.c, "b": 1, "d": 1, "b_s": each.size, "d_s": each.size, "l": each.arm}
    inputs = {**lengths, "x": hull.r, "y": 0, "z": hull.z, "cosine": 1, "sine": 0}
    return bool(answers(formula, EXACT, {name: inputs[name] for name in formula.program.inputs}))


def test_repaired_procedure_2a_on_the_axis_accepts_if_all_four_rotors_are_interior():
    """All four rotors stand alike to the hyperboloid then: one unit sphere at r says it."""
    for each in facts_in_order():
        if statements.wide(each) and each.point.r**2 >= 2:
            point = each.point
            inputs = {"alpha": point.a, "gamma": point.c, "b_s": 1, "d_s": 1, "x": 0, "y": 0, "z": point.z}
            found = answers(REPAIRED["procedure-2a-repaired"], EXACT, {**inputs, "l": point.r, "cosine": 1, "sine": 0})
            assert bool(found) == statements.interior(each), point


def test_repaired_procedure_2b_accepts_interior_hulls_and_rotors_that_the_printed_one_refuses():
    """At hulls whose farthest rotor is interior, and at hulls that are; all with a zero coefficient, some others."""
    differ = 0
    for place, hull in enumerate(facts_in_order()):
        if not statements.wide(hull) or (hull.c1 and hull.c2 and place % 25):
            continue
        for each in quadcopters(hull)[:1]:
            rotors = inside.position(each.farthest.pair.lengths) is Position.INTERIOR
            if statements.interior(hull) or rotors:
                assert quadcopter_says(REPAIRED["procedure-2b-repaired"], each), hull.point
                differ += not each.answer
    assert differ > 10


def test_repaired_procedure_1_in_float32_answers_exterior_on_and_near_the_ring():
    """Table 2 in float32 says contact about some of these, the procedure put right about none."""
    beside = np.linspace(2.499, 2.501, 4001)
    row = dict(zip(COLUMNS, (1.0, 2.0, 1.0, 1.0, beside, 0.0, 0.0), strict=True))
    single = float_arithmetic("float32")
    assert (answers(REPAIRED["procedure-1-repaired"], single, row) == 1).all()
    assert (answers(FORMULAS["table-2"], single, row) == 0).any()
    assert facts(Point(*map(Fraction, (1, 2, 2.5, 0)))).position is Position.EXTERIOR


def test_repaired_procedure_1_with_one_step_changed_is_not_proved():
    formula = REPAIRED["procedure-1-repaired"]
    names = {"E", "EE", "four_A", "beyond", "wide_apart", "clear_at_waist", "answer", "P_minus_A"}
    for step, program in mutants(formula.program):
        if step.name in names:
            assert not all(proof.holds for proof in prove(replace(formula, program=program))), step
