"""A hunt finds known errors without hints, finds none in right implementations, and ends by its budget."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY, FixedSizes
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Answered, Outcome
from hypcheck.runs import hunt_search
from hypcheck.runs.hunt import Hunt, HuntPlan, target_of
from hypcheck.runs.hunt_search import neighbours, run_hunt
from hypcheck.runs.judge import Mistake, Status
from hypcheck.vectors.draw import Draw
from tests.support import inside
from tests.support.fractions_truth import exact_position
from tests.support.inside import flip_exponents


class Double:
    """An implementation that answers by a function, and notes what it was asked."""

    def __init__(self, answer, status=Outcome.ANSWERED, **claims):
        self.description = Description(name="double", **claims)
        self.rows = []
        self._answer, self._status = answer, status

    def classify(self, rows):
        """What becomes of rows: all of them the same."""
        self.rows.append(rows)
        status = np.full(len(rows), self._status, dtype=np.int8)
        reasons = {} if self._status is Outcome.ANSWERED else dict.fromkeys(range(len(rows)), "it left")
        return Answered(self._answer(rows).astype(np.int8), status, reasons)


def hunted(spec, queries, seed=1, everywhere=None, **claims):
    with open_implementation(f"builtin:{spec}") as implementation:
        run = Hunt(target_of(spec, implementation, **claims), HuntPlan(None, queries, seed))
        run_hunt(run, everywhere=everywhere)
    return run


def kinds(run):
    """The worst error in units of each kind of wrong answers beyond tolerance."""
    return {
        (cluster.worst.case.mistake, cluster.worst.case.truth, cluster.worst.place.kind): cluster.worst.error_u
        for cluster in run.worst_first()
    }


@pytest.mark.parametrize(
    ("spec", "queries", "errors"),
    [
        ("table-2-float64", 2500, {(Position.EXTERIOR, "the ring"): 1e14}),
        (
            "procedure-2a-spheroid-float64",
            4000,
            {(Position.INTERIOR, "c1 = 0"): 1e14, (Position.INTERIOR, "c2 = 0"): 1e14},
        ),
        ("local-maximum-float64", 8000, {(Position.INTERIOR, "a = 1"): 3e6, (Position.EXTERIOR, "c² = a"): 1e4}),
    ],
)
def test_hunt_finds_the_known_errors_of_a_formula_where_they_are(spec, queries, errors):
    found = kinds(hunted(spec, queries))
    for place, error in errors.items():
        assert found[(Mistake.FALSE_CONTACT, *place)] > error


def test_hunt_finds_unsafe_answers_of_procedure_1_outside_its_regimes():
    asked_all = kinds(hunted("procedure-1-float64", 3000, regimes=()))
    assert asked_all[Mistake.FALSE_CLEAR, Position.CONTACT, "c² < a"] > 1e14
    inside = kinds(hunted("procedure-1-float64", 3000))
    assert "c² < a" not in {place for _, _, place in inside}


def test_local_search_grows_from_ordinary_near_misses_to_large_errors():
    ordinary = tuple(each for each in hunt_search.strata() if "near-tangent" in each.name)
    assert len(ordinary) == 2
    first = hunted("local-maximum-float64", 2 * hunt_search.FIRST_LOOK, everywhere=ordinary)
    assert max((cluster.worst.error_u for cluster in first.clusters.values()), default=0) < 100
    grown = hunted("local-maximum-float64", 25_000, everywhere=ordinary)
    worst = grown.worst_first()[0].worst
    assert worst.error_u > 1e7
    assert worst.source.startswith("local search")


def test_local_search_halves_its_step_until_it_rests_if_it_finds_nothing_worse():
    """Wrong on the row (1, 2, 1, 1, 2.5, 0, 0) alone: γ of the rows beside it shows each step."""
    ring = np.array([1, 2, 1, 1, 2.5, 0, 0])
    block = np.concatenate([[ring], np.tile((2.0, 5.0, 1.0, 1.0, 4.0, 0.0, 0.0), (1000, 1))])
    double = Double(lambda rows: np.where((rows == ring).all(axis=1), 0, inside.positions(rows)))
    run = Hunt(target_of("double", double), HuntPlan(None, 85_000))
    run_hunt(run, everywhere=[hunt_search.HuntStratum("one row", lambda seed, number: block)])
    rows = np.concatenate(double.rows)
    beside = rows[(rows[:, [0, 2, 3, 4, 5, 6]] == ring[[0, 2, 3, 4, 5, 6]]).all(axis=1) & (rows[:, 1] > 2)]
    steps = sorted({step for step in (beside[:, 1] / 2 - 1).tolist() if step in {2.0**-power for power in range(53)}})
    assert steps == [2.0**-power for power in range(44, 0, -1)]
    (cluster,) = run.worst_first()
    assert cluster.worst.case.row == tuple(ring)


def test_local_search_restarts_with_the_first_step_at_a_worse_answer():
    """Exterior rows are called contact: the farther off, the worse. Beside each row that is the worst, α times 1.5."""
    clear, crossing = (3.0, 40.0, 1.0, 1.0, 4.125, 1.0, 5.0), (3.0, 40.0, 1.0, 1.0, 3.0, 0.0, 5.0)
    block, worst = np.array([clear, *[crossing] * 1000]), []
    double = Double(lambda rows: np.minimum(inside.positions(rows), 0))
    run = Hunt(target_of("double", double), HuntPlan(None, 9_000))
    run_hunt(
        run,
        lambda run: worst.append(run.worst_first()[0].worst.case.row),
        [hunt_search.HuntStratum("one clear row", lambda seed, number: block)],
    )
    *passed, _ = dict.fromkeys(worst)
    assert passed[0] == clear
    assert len(passed) > 2
    asked = set(map(tuple, np.concatenate(double.rows).tolist()))
    assert {(alpha * 1.5, *others) for alpha, *others in passed} <= asked


def test_hunt_neighbours_are_one_step_away_or_on_a_surface_and_their_ladders_leave_contact():
    row = (3.0, 4.0, 1.5, 2.0, 7.0, 1.0, 5.0)
    around = neighbours(Draw("test"), [hunt_search.Climber(row, 1.0, 0.25)])
    single = np.bincount(around.ladders)[around.ladders] == 1
    factors = around.rows[single] / np.array(row)
    stepped = np.isclose(factors[..., None], (1.25, 0.8), rtol=1e-15).any(axis=2)
    one_length = (stepped | (factors == 1)).all(axis=1) & (stepped.sum(axis=1) == 1)
    assert one_length.sum() == 10  # α, γ, b, d, z up and down; x and y go together
    surfaces = around.rows[single][-4:]
    assert (surfaces[0, 4:6] == 0).all()
    assert surfaces[1, 6] == 0
    assert surfaces[2, 0] == surfaces[2, 2]
    assert (surfaces[3, 1] / surfaces[3, 3]) ** 2 == pytest.approx(surfaces[3, 0] / surfaces[3, 2], rel=1e-15)
    for number in set(around.ladders[~single].tolist()):
        rungs = flip_exponents(around.rows[around.ladders == number])
        assert rungs[0] < -40
        assert rungs[-1] > -20
    assert set(around.owners.tolist()) == {0}


@pytest.mark.parametrize(("spec", "claims"), [("fast", {"tolerance": Fraction(0)}), ("dual-float64", {})])
def test_hunt_finds_nothing_in_an_exact_implementation(spec, claims):
    run = hunted(spec, 5_000, **claims)
    assert run.worst_first() == []
    assert run.asked == run.answered == 5_000


def test_hunt_findings_are_really_wrong_and_sorted_by_error():
    run = hunted("table-2-float32", 3000)
    found = run.worst_first()
    assert len(found) > 3
    errors = [cluster.worst.error for cluster in found]
    assert errors == sorted(errors, reverse=True)
    for cluster in found:
        case = cluster.worst.case
        assert case.status is Status.WRONG
        assert exact_position(case.row) == case.truth
        assert case.answer == (0 if case.truth == 1 else 1)
        assert run.target.claimed(np.array([case.row])).tolist() == [0]


def test_hunt_with_a_budget_of_queries_keeps_it_and_is_repeatable():
    def summary(run):
        return [
            (cluster.beyond, cluster.tolerated, cluster.worst.case.row, cluster.worst.error)
            for cluster in run.worst_first()
        ]

    one, two = hunted("shared-float64", 6500), hunted("shared-float64", 6500)
    assert one.asked == two.asked == 6500
    assert any(cluster.worst.source.startswith("local search") for cluster in one.worst_first())
    assert summary(one) == summary(two)
    assert summary(hunted("shared-float64", 3000, seed=2)) != summary(hunted("shared-float64", 3000))


def test_a_budget_of_seconds_ends_the_hunt():
    run = Hunt(target_of("double", Double(inside.positions)), HuntPlan(0.3))
    run_hunt(run)
    assert run.over
    assert 0.3 <= run.seconds < 5
    assert run.asked > 100


def test_hunt_tests_only_rows_in_the_declared_regimes_and_precision():
    double = Double(inside.positions, precision="float32")
    target = target_of("double", double, regimes=("a>=1", "c2>=a"))
    run_hunt(Hunt(target, HuntPlan(None, 3000)))
    rows = np.concatenate(double.rows)
    assert len(rows) == 3000
    assert (rows[:, 0] >= rows[:, 2]).all()
    assert (np.abs(rows[rows != 0]) >= 2.0**-126).all()
    assert len(target.claimed(rows)) == len(rows)


def test_implementation_that_always_answers_contact_has_every_kind_of_false_contact():
    run = Hunt(target_of("double", Double(lambda rows: np.zeros(len(rows)))), HuntPlan(None, 3000))
    run_hunt(run)
    worst = {(cluster.worst.case.mistake, cluster.worst.case.truth) for cluster in run.worst_first()}
    assert worst == {(Mistake.FALSE_CONTACT, Position.EXTERIOR), (Mistake.FALSE_CONTACT, Position.INTERIOR)}


def test_hunt_ranks_an_answer_with_an_infinite_error_first():
    run = Hunt(target_of("double", Double(lambda rows: np.ones(len(rows)))), HuntPlan(None, 3500))
    run_hunt(run)
    worst = run.worst_first()[0].worst
    assert worst.error == math.inf
    assert worst.case.row[4:6] == (0, 0)


def test_hunt_counts_cannot_say_as_abstained_and_never_as_wrong():
    run = Hunt(target_of("double", Double(lambda rows: np.full(len(rows), CANNOT_SAY))), HuntPlan(None, 1000))
    run_hunt(run)
    assert (run.asked, run.counts) == (1000, {"abstained": 1000})
    assert run.clusters == {}


def test_hunt_keeps_the_first_row_of_a_fault_and_ends_if_the_implementation_is_lost():
    nothing = lambda rows: np.full(len(rows), CANNOT_SAY)  # noqa: E731
    crashing = Hunt(target_of("double", Double(nothing, Outcome.CRASH)), HuntPlan(None, 1000))
    run_hunt(crashing)
    assert crashing.counts == {"crash": 1000}
    assert crashing.unanswered[Status.CRASH].reason == "it left"
    assert crashing.answered == 0
    lost = Hunt(target_of("double", Double(nothing, Outcome.NOT_RUN)), HuntPlan(None, 1000))
    run_hunt(lost)
    assert lost.asked < 1000


ONE_SCENE = Domain(settings=(FixedSizes((2.5, 9.0, 0.5, 0.25), z=(-4.0, 4.0)),))


def test_hunt_tests_a_kernel_for_one_scene_only_on_its_sizes():
    double = Double(lambda rows: np.zeros(len(rows)), domain=ONE_SCENE)
    run = Hunt(target_of("double", double), HuntPlan(None, 4000))
    run_hunt(run)
    asked = np.concatenate(double.rows)
    assert ONE_SCENE.holds(asked).all()
    assert len(asked) == 4000
    assert {cluster.worst.case.mistake for cluster in run.worst_first()} == {Mistake.FALSE_CONTACT}


def test_hunt_finds_errors_near_contact_for_fixed_sizes():
    def grown(rows):
        rows = rows * [1, 1, 1 + 2.0**-44, 1 + 2.0**-44, 1, 1, 1]
        return inside.positions(rows)

    run = Hunt(target_of("double", Double(grown, domain=ONE_SCENE)), HuntPlan(None, 20_000))
    run_hunt(run)
    assert run.worst_first()
