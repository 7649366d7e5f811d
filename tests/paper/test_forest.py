"""`simulate forest` as numbers: each step, line, phantom and way against single exact decisions."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.errors import InputError
from hypcheck.paper.forest import ForestPlan, Procedure1, judged, simulate_forest, walk
from hypcheck.paper.trees import Trees
from hypcheck.scene.model import Hyperboloid, Region, Span
from hypcheck.scene.reading import read_scene
from hypcheck.vectors.draw import Draw
from tests.support.fractions_truth import exact_position
from tests.support.inside import passage

FOREST = read_scene("forest")
TREES = Trees(FOREST)


def simulated(seed=3, steps=300, scene=FOREST, continuous=False):
    return simulate_forest(ForestPlan(scene, seed, steps, continuous))


def near(tree, z=0.0):
    """Places about a tree, on and off its ring."""
    draw = Draw("near", tree)
    x, y, _ = TREES.centers[tree]
    reach = 2.0
    return np.stack([x + draw.between(40, -reach, reach), y + draw.between(40, -reach, reach), np.full(40, z)], axis=1)


def test_exterior_tests_of_trees_are_exact_for_any_tree_centre():
    for tree in (0, 8, 17):
        at = near(tree, 0.1)
        found = TREES.exterior(at)
        for place in range(0, 40, 4):
            for other in range(0, len(FOREST.hyperboloids), 9):
                offset = [Fraction(a) - Fraction(b) for a, b in zip(at[place], TREES.centers[other], strict=True)]
                row = (*TREES.sizes[other].tolist(), *offset)
                assert found[place, other] == (exact_position(row) == 1)


def test_lines_prove_only_exterior_positions_and_nearly_all_of_them():
    at = np.concatenate([near(tree) for tree in range(0, 64, 5)])
    line, exterior = TREES.proved_by_line(at), TREES.exterior(at)
    assert not (line & ~exterior).any()
    assert (exterior & ~line).sum() < 0.01 * exterior.sum()
    assert exterior.any()
    assert not exterior.all()


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_table_2_with_its_constants_taken_out_answers_as_table_2_does(precision):
    at = np.concatenate([near(tree) for tree in range(0, 64, 7)])
    found = Procedure1(TREES, precision).valid(at)
    x, y, z = TREES.offsets(at)
    for tree in range(0, 64, 6):
        sizes = dict(zip(("alpha", "gamma", "b", "d"), TREES.sizes[tree].tolist(), strict=True))
        inputs = {**sizes, "x": x[:, tree], "y": y[:, tree], "z": z[:, tree]}
        expected = answers(FORMULAS["table-2"], float_arithmetic(precision), inputs)
        assert found[:, tree].tolist() == (expected == 1).tolist()


def test_walk_refuses_a_step_only_at_the_region_edge_or_where_table_2_in_float32_says_contact():
    steps = walk(TREES, FOREST.walk, FOREST.region, 400, 3)
    assert steps.refused.any()
    assert steps.edge.any()
    verdicts = judged(TREES, steps.end)
    allowed = verdicts.by_all(verdicts.printed["float32"])
    inside = (abs(steps.end[:, :2]) <= 20).all(axis=1)
    assert steps.edge.tolist() == (~inside).tolist()
    assert steps.refused.tolist() == (inside & ~allowed).tolist()
    for step in range(1, 400):
        assert steps.start[step].tolist() == (steps.end if steps.made[step - 1] else steps.start)[step - 1].tolist()
    assert np.allclose(np.linalg.norm(steps.end - steps.start, axis=1), 0.25)


def test_walker_turns_by_the_angles_that_the_scene_sets():
    steps = walk(TREES, FOREST.walk, FOREST.region, 400, 3)
    way = steps.end - steps.start
    heading = np.degrees(np.unwrap(np.arctan2(way[:, 1], way[:, 0])))
    turns, stopped = np.diff(heading), ~steps.made[:-1]
    assert abs(turns[~stopped]).max() <= 15.0 + 1e-9
    assert (abs(abs(turns[stopped]) - 60.0) <= 15.0 + 1e-9).all()
    assert (turns[stopped] > 0).any()
    assert (turns[stopped] < 0).any()


def test_walker_is_never_stuck_for_100_steps():
    """Turned by nothing but 60 degrees she would try the same six ways again and again; seed 1 met such a place."""
    made = np.flatnonzero(walk(TREES, FOREST.walk, FOREST.region, 5000, 1).made)
    assert np.diff(made).max() < 100
    assert made[-1] > 4900


def test_counts_of_made_and_refused_steps_add_up_to_the_tried_steps():
    result = simulated(steps=1000)
    steps, questions = result["steps"], result["questions"]
    assert steps["tried"] == 1000 == steps["made"] + steps["edge"] + steps["contact"] + steps["phantom"]
    assert len(result["path"]) == steps["made"] + 1
    assert questions["asked"] == 64 * (1000 - steps["edge"])
    assert 0.99 < questions["line"] / questions["asked"] < 1
    kinds = [stop["kind"] for stop in result["stops"]]
    assert (kinds.count("contact"), kinds.count("phantom")) == (steps["contact"], steps["phantom"])
    assert result["phantoms"]["float32"] == steps["phantom"]
    assert result["outside_stated_regime"] == []


def test_phantom_contact_is_reported_only_on_the_ring_of_a_tree_that_is_exterior():
    """Seed 3 meets some; each is on the ring of the tree that stopped her, and a line would have let her pass."""
    result = simulated(steps=4000)
    phantoms = [stop for stop in result["stops"] if stop["kind"] == "phantom"]
    assert phantoms
    trees = {tree["name"]: tree for tree in result["trees"]}
    for stop in phantoms:
        for name in stop["trees"]:
            tree = trees[name]
            offset = [Fraction(a) - Fraction(b) for a, b in zip(stop["tried"], tree["center"], strict=True)]
            assert exact_position((tree["alpha"], tree["gamma"], 0.3, 0.9, *offset)) == 1
            assert math.hypot(*map(float, offset[:2])) == pytest.approx(tree["ring"], abs=0.02)
            assert tree["phantom"]
        assert stop["gap"] > 0.5
    assert result["phantoms"]["float64"] == result["phantoms"]["float32_after_line"] == 0
    assert result["steps"]["wrongly_allowed"] == 0


def test_wall_map_is_centred_on_a_phantom_contact_and_counts_its_wrong_points():
    wall = simulated(steps=4000)["wall"]
    letters = "".join(wall["lines"])
    assert set(letters) == {"e", "E"}
    assert wall["wrong"] == letters.count("E") > 20
    assert wall["points"] == len(letters)
    assert wall["lines"][60][60] == "E"  # the middle is the place itself


def test_result_has_no_wall_map_if_no_phantom_contact_occurred():
    result = simulated(steps=10)
    assert result["steps"]["phantom"] == 0
    assert result["wall"] is None


def test_ring_exists_only_for_a_tree_at_the_walker_height_and_in_the_stated_regime():
    for place, tree in enumerate(FOREST.hyperboloids):
        ring = TREES.ring(place, 0.0)
        assert (ring is None) == (tree.center[2] != 0)
        if ring is not None:
            a, c = Fraction(tree.alpha) / Fraction(0.3), Fraction(tree.gamma) / Fraction(0.9)
            assert ring**2 == pytest.approx(float(Fraction(0.3) ** 2 * (c * c + 1) * (a * a + c * c) / (c * c)))
    wide = replace(FOREST, hyperboloids=(Hyperboloid("wide", 2.0, 0.9),))
    assert Trees(wide).ring(0, 0.0) is None
    assert Trees(wide).outside_regime == ["wide"]


def test_tree_is_not_tested_outside_its_height_span():
    stump = replace(FOREST.hyperboloids[8], height=Span(-0.9, -0.5))
    scene = replace(FOREST, hyperboloids=(*FOREST.hyperboloids[:8], stump, *FOREST.hyperboloids[9:]))
    assert Trees(scene).modelled(np.array([[0.0, 0.0, 0.0]]))[0].tolist() == [place != 8 for place in range(64)]
    result = simulated(scene=scene)
    assert result["questions"]["outside_height"] == result["steps"]["tried"] - result["steps"]["edge"]
    x, y, _ = stump.center
    through = replace(scene, walk=replace(scene.walk, start=(x - 1.0, y, 0.0), largest_turn=0.0))
    path = np.array(simulated(scene=through, steps=8)["path"])
    assert len(path) == 9  # straight over it


def test_steps_with_contact_equal_those_found_tree_by_tree():
    """In a thicket with long steps, so that some pass through a trunk and end in the open."""
    trunks = tuple(replace(tree, alpha=0.1) for tree in FOREST.hyperboloids[:16])
    scene = replace(
        FOREST,
        hyperboloids=tuple(
            replace(tree, center=(2.0 * (place % 4) - 3.0, 2.0 * (place // 4) - 3.0, 0.0))
            for place, tree in enumerate(trunks)
        ),
        walk=replace(FOREST.walk, step=1.5, largest_turn=180.0),
        region=Region(Span(-4.0, 4.0), Span(-4.0, 4.0), None),
    )
    found = simulated(scene=scene, steps=120, continuous=True)
    path = found["path"]
    touching, contacts = 0, []
    for start, end in itertools.pairwise(path):
        ways = []
        for tree in scene.hyperboloids:
            here, there = (
                [Fraction(a) - Fraction(b) for a, b in zip(at, tree.center, strict=True)] for at in (start, end)
            )
            ways.append(passage((tree.alpha, tree.gamma, 0.3, 0.9), here, there))
        if not all(way.clear and way.start == 1 for way in ways):
            touching += 1
            first, place = min((way.first_lower, place) for place, way in enumerate(ways) if way.hit)
            contacts.append((start, end, scene.hyperboloids[place].name, first, ways[place].first_upper))
    told = found["ways"].pop("contacts")
    assert found["ways"] == {"made": len(path) - 1, "touching": touching}
    assert [tuple(contact.values()) for contact in told] == contacts[:12]
    assert 0 < touching < len(path) - 1


def test_forest_simulation_with_the_same_seed_gives_the_same_result():
    assert json.dumps(simulated()) == json.dumps(simulated())
    assert simulated(seed=4)["path"] != simulated()["path"]
    assert simulated(steps=300)["path"][:50] == simulated(steps=60)["path"][:50]


def test_number_of_steps_comes_from_the_scene_if_the_plan_has_none():
    scene = replace(FOREST, walk=replace(FOREST.walk, steps=12))
    assert simulate_forest(ForestPlan(scene, 1, None, continuous=False))["steps"]["tried"] == 12
    assert simulated(steps=0)["path"] == [[0.0, 0.0, 0.0]]


@pytest.mark.parametrize(
    ("scene", "steps", "message"),
    [
        (replace(FOREST, walk=None), 5, r"has no \[walk\]"),
        (FOREST, 10**7, "10,000,000 steps are too many; the limit is 1,000,000"),
        (replace(FOREST, mover=replace(FOREST.mover, b=1e-9)), 5, "a simulation takes lengths from 1e-06"),
        (replace(FOREST, walk=replace(FOREST.walk, start=(0.0, 30.0, 0.0))), 5, "outside the scene's region"),
        (replace(FOREST, walk=replace(FOREST.walk, start=(0.0, 1e308, 0.0))), 5, "the walk's start is at 1e\\+308"),
    ],
)
def test_simulate_forest_refuses_invalid_scenes_and_step_counts(scene, steps, message):
    with pytest.raises(InputError, match=message):
        simulated(scene=scene, steps=steps)


def test_repaired_procedure_1_allows_every_phantom_and_agrees_on_all_other_steps():
    result = simulate_forest(ForestPlan(read_scene("forest"), 3, 4000, continuous=False))
    phantoms = result["phantoms"]
    assert phantoms["float32"] == 5
    assert phantoms["float32_repaired"] == phantoms["float64_repaired"] == 0
    assert result["repaired"] == {"float32_differs": 5, "float64_differs": 0}
