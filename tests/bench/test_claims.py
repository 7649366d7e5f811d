"""The paper's claims about cost: the comparisons are those of the claims, and verdicts follow from ratios and noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.bench import claims, speed
from hypcheck.bench.c_library import compiled
from hypcheck.bench.claims import (
    BODIES,
    COST_OF,
    FIRST_AGAIN,
    OURS,
    PRINTED,
    PRINTED_A,
    PRINTED_B,
    RECIPROCALS,
    REPAIRED_1,
    REPAIRED_A,
    REPAIRED_B,
    TRIGONOMETRIC,
)
from hypcheck.bench.plan import QUICK, BenchPlan
from hypcheck.bench.speed import Measurement, MeasuringSession, _compared
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.program import count
from hypcheck.geometry.pair import Position
from hypcheck.implementations.method import RECIPROCAL, by_rows
from hypcheck.runs.timing import Estimate, Samples
from hypcheck.vectors.families import FAMILIES
from tests.support import inside
from tests.support.inside import flip_exponents

FEW = replace(QUICK, bodies=600, timed=600)


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    return BenchPlan(amounts=FEW, compiled=compiled(tmp_path_factory.mktemp("c"))[0])


@pytest.fixture(scope="module")
def answers(plan):
    return {
        (claim.name, claim.tier): {name: ready.answers().copy() for name, ready in claim.compared(plan).items()}
        for claim in claims.cost_claims(plan)
    }


def test_the_papers_procedures_in_c_answer_as_those_in_numpy(answers):
    for name in BODIES:
        assert (answers["procedures", "C"][name] == answers["procedures", "numpy"][name]).all()


def test_methods_compared_in_cost_claims_answer_alike_in_c_and_in_numpy(answers):
    for name in (PRINTED, RECIPROCALS, REPAIRED_1):
        assert (answers["divisions", "C"][name] == answers["divisions", "numpy"][name]).all()
    assert (answers["roots", "C"][PRINTED] == answers["roots", "numpy"][PRINTED]).all()
    by_cosines = answers["roots", "numpy"][TRIGONOMETRIC]
    assert ((answers["roots", "C"][TRIGONOMETRIC] == 1) == (by_cosines == 1)).all()


def test_share_touching_is_the_share_of_flight_rows_in_contact():
    rows = FAMILIES["flight"].rows(1, 4000)
    touching = inside.positions(rows) == Position.CONTACT
    assert 100 < np.count_nonzero(touching) < 2000
    assert claims.share_touching(claims.flight_of(1, 4000)) == np.mean(touching)


def test_table_2_with_reciprocals_divides_outside_the_loop_and_differs_only_near_contact():
    assert count(RECIPROCAL.program.steps).divisions == count(FORMULAS["table-2"].program.steps).divisions
    claim = next(each for each in claims.cost_claims(BenchPlan()) if each.name == "divisions")
    printed, changed = claim.operations[PRINTED], claim.operations[RECIPROCALS]
    assert (printed.divisions, changed.divisions) == (2, 0)
    assert changed.multiplications == printed.multiplications + 2
    rows = np.concatenate([FAMILIES[name].rows(1, 400) for name in ("uniform", "tower-body", "tangent-ladder")])
    one, other = (by_rows(formula, "float64")(rows) for formula in (FORMULAS["table-2"], RECIPROCAL))
    assert (flip_exponents(rows[one != other]) < -40).all()


def test_cost_claims_use_numpy_without_a_compiler_and_are_left_out_if_methods_are_chosen():
    assert {claim.tier for claim in claims.cost_claims(BenchPlan())} == {"numpy"}
    assert claims.cost_claims(BenchPlan(methods=("fast-numpy",))) == []


@pytest.mark.parametrize(
    ("low", "high", "noise", "is_cheaper", "is_dearer"),
    [
        (0.2, 0.3, 1.1, "holds", "does not hold"),
        (3.0, 4.0, 1.1, "does not hold", "holds"),
        (0.9, 0.95, 1.1, "inconclusive", "inconclusive"),
        (0.9, 1.2, 1.0, "inconclusive", "inconclusive"),
        (1.05, 1.08, 1.1, "inconclusive", "inconclusive"),
    ],
)
def test_a_cost_ratio_is_cheaper_or_dearer_only_if_its_interval_lies_beyond_the_noise(
    low, high, noise, is_cheaper, is_dearer
):
    ratio = Estimate((low + high) / 2, low, high)
    assert claims.cheaper(ratio, noise) == is_cheaper
    assert claims.dearer(ratio, noise) == is_dearer


def measured(times):
    """As processes would have measured these times, by claim and way."""

    def parts(key, time):
        jitter = [[time * (1 + (r + p) / 1000) for r in range(3)] for p in range(2)]
        return [Measurement(key, Samples(key[0], 10, 1, 0, part), 0.0, "process") for part in jitter]

    return {
        (name, f"{COST_OF}{claim}", "batch"): parts((name, f"{COST_OF}{claim}", "batch"), time)
        for claim, ways in times.items()
        for name, time in ways.items()
    }


def test_cost_lines_hold_ratios_verdicts_and_operation_counts_of_each_claim():
    times = {
        "procedures-numpy": {
            PRINTED_A: 90.0,
            PRINTED_B: 30.0,
            OURS: 45.0,
            REPAIRED_A: 90.0,
            REPAIRED_B: 36.0,
            FIRST_AGAIN: 90.0,
        },
        "divisions-numpy": {PRINTED: 10.0, RECIPROCALS: 8.0, REPAIRED_1: 11.0, FIRST_AGAIN: 10.0},
        "roots-numpy": {PRINTED: 10.0, TRIGONOMETRIC: 25.0, claims.EIGENVALUES: 2e4, FIRST_AGAIN: 10.0},
    }
    lines = list(speed.cost_lines(BenchPlan(amounts=FEW), measured(times)))
    assert [line.verdict for line in lines] == ["holds", "does not hold", "holds"]
    assert [each.ratio for each in lines[0].compared] == pytest.approx([1.0, 1 / 3, 1 / 2, 1.0, 0.4], rel=0.01)
    assert FIRST_AGAIN not in {each.name for line in lines for each in line.compared}
    assert lines[0].compared[0].operations["multiplications"] > 50
    assert "2 divisions a position" in lines[1].says
    assert "a position for the roots, none for the coefficients" in lines[2].says
    noisy = {**times["procedures-numpy"], FIRST_AGAIN: 360.0}
    found = measured({**times, "procedures-numpy": noisy})
    assert next(speed.cost_lines(BenchPlan(amounts=FEW), found)).verdict == "inconclusive"


def test_bench_times_the_first_alternative_of_a_cost_claim_twice_to_measure_the_noise(plan):
    claim = claims.cost_claims(plan)[0]
    together = _compared(MeasuringSession(plan, 0, {}, {}), claim)
    *names, again = together.ready
    assert names == list(claim.compared(plan))
    assert again == FIRST_AGAIN
    assert together.ready[again] is together.ready[names[0]]
