"""What the upright model gets wrong about a quadcopter that leans, against arithmetic in fractions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.paper.flights import Moves
from hypcheck.paper.pitch import PitchVerdicts, Tilt, near_wall, tilted_interior, valid_tilted
from hypcheck.paper.quadcopter import any_angle, craft_of
from hypcheck.paper.tower import ExactQuestions, TowerPlan, simulate_tower
from hypcheck.scene.reading import read_scene
from tests.support.tilted_fractions import exact_position

TOWER = read_scene("tower")
CRAFT = craft_of(TOWER)
SHORT = replace(TOWER, flight=replace(TOWER.flight, distance=3.0))


def near_the_wall(count, seed=5):
    random = np.random.default_rng(seed)
    z = random.uniform(-17.8, 17.8, count)
    angle = random.uniform(-180, 180, count)
    radius = 2 * np.sqrt(1 + (z / 17.8) ** 2) + random.uniform(-0.3, 0.0, count)
    cosine, sine = any_angle(angle)
    return (radius * cosine, radius * sine, z), any_angle(random.uniform(-180, 180, count))


@pytest.mark.parametrize("degrees", [0.0, 20.0, 45.0, 90.0])
def test_interior_test_of_a_tilted_spheroid_agrees_with_exact_fractions(degrees):
    at, toward = near_the_wall(16)
    axis = Tilt.by(degrees, toward).axis
    found = tilted_interior(CRAFT.sizes, at, axis)
    expected = [exact_position((*CRAFT.sizes, *row)) == -1 for row in zip(*at, *axis, strict=True)]
    assert found.tolist() == expected
    assert 0 < sum(expected) < 16


def test_axis_of_a_tilted_craft_has_the_pitch_angle_to_the_vertical_and_points_ahead():
    toward = any_angle(np.array([0.0, 30.0, 200.0]))
    x, y, z = Tilt.by(35.0, toward).axis
    assert np.allclose(x**2 + y**2 + z**2, 1)
    assert np.allclose(z, np.cos(np.radians(35)))
    assert np.allclose((x * toward[0] + y * toward[1]), np.sin(np.radians(35)))


def test_tilted_vectors_keep_their_length_and_stay_across_the_axis():
    toward = any_angle(np.linspace(-170, 170, 9))
    tilt = Tilt.by(25.0, toward)
    along, aside = any_angle(np.linspace(-100, 260, 9))
    way = tilt.tilted(along, aside)
    assert np.allclose(sum(each**2 for each in way), 1)
    assert np.allclose(sum(a * b for a, b in zip(way, tilt.axis, strict=True)), 0)
    ahead = tilt.tilted(*toward)
    assert np.allclose(ahead[2], -np.sin(np.radians(25)))  # tilted ahead, its front is lower
    beside = tilt.tilted(-toward[1], toward[0])
    assert np.allclose(beside, (-toward[1], toward[0], np.zeros(9)))


def test_tilted_craft_is_valid_where_its_body_or_all_its_rotors_are_interior():
    at, heading = near_the_wall(12)
    tilt = Tilt.by(30.0, heading)
    valid, body = valid_tilted(CRAFT, at, heading, tilt)
    arms = CRAFT.arms(heading)
    four = Tilt.by(30.0, tuple(np.tile(each, 4) for each in heading))
    ways = np.stack(four.tilted(CRAFT.arm * arms[0], CRAFT.arm * arms[1]))
    for place, centre in enumerate(zip(*at, strict=True)):
        axis = [float(each[place]) for each in tilt.axis]
        inside = exact_position((*CRAFT.sizes, *centre, *axis)) == -1
        places = [np.array(centre) + ways[:, place + 12 * rotor] for rotor in range(4)]
        rotors = [exact_position((*CRAFT.rotor, *map(float, each), *axis)) == -1 for each in places]
        assert body[place] == inside
        assert valid[place] == (inside or all(rotors))
    assert 0 < body.sum() <= valid.sum() < 12


def moves_at(at, heading, *, back, accepted):
    count = len(at[0])
    none = np.zeros(count, dtype=np.bool_)
    sign = np.where(back, -1.0, 1.0)
    start = at[0] - sign * heading[0], at[1] - sign * heading[1], at[2]
    return Moves(np.arange(count), start, at, heading, np.zeros(count), accepted, ~accepted, none, none, ~none, none)


def test_pitch_counts_equal_the_sum_of_single_exact_decisions():
    at, heading = near_the_wall(30)
    random = np.random.default_rng(1)
    back, accepted = random.random(30) < 0.5, random.random(30) < 0.5
    counts = PitchVerdicts()
    counts.watch(CRAFT, 40.0, moves_at(at, heading, back=back, accepted=accepted))
    toward = tuple(np.where(back, -each, each) for each in heading)
    valid, _ = valid_tilted(CRAFT, at, heading, Tilt.by(40.0, toward))
    assert counts.moves == 30
    assert counts.wrong == (valid != accepted).sum()
    assert counts.dangerous == (accepted & ~valid).sum()
    axis = Tilt.by(40.0, toward).axis
    rows = list(zip(*at, *axis, strict=True))
    tilted = np.array([exact_position((*CRAFT.sizes, *row)) == -1 for row in rows])
    upright = np.array([exact_position((*CRAFT.sizes, *row[:3], 0, 0, 1)) == -1 for row in rows])
    assert counts.body_wrong == (tilted != upright).sum() > 0
    assert counts.body_dangerous == (upright & ~tilted).sum()


def test_pitch_counts_omit_vertical_moves_and_turns():
    at, heading = near_the_wall(10)
    moves = moves_at(at, heading, back=np.zeros(10, np.bool_), accepted=np.ones(10, np.bool_))
    counts = PitchVerdicts()
    counts.watch(CRAFT, 40.0, replace(moves, vertical=np.ones(10, np.bool_)))
    counts.watch(CRAFT, 40.0, replace(moves, turning=np.ones(10, np.bool_)))
    assert counts == PitchVerdicts()


def test_craft_with_pitch_0_is_judged_as_the_upright_craft():
    at, heading = near_the_wall(100)
    moves = moves_at(at, heading, back=np.zeros(100, np.bool_), accepted=np.ones(100, np.bool_))
    counts = PitchVerdicts()
    counts.watch(CRAFT, 0.0, moves)
    assert counts.body_wrong == 0


def test_pitch_changes_more_answers_near_the_wall_if_the_craft_is_tilted_outward():
    found = near_wall(CRAFT, 45.0, 3, count=150)
    assert found["centres"] == 150
    assert found["outward"]["changed"] > found["anywhere"]["changed"] > 0
    assert found["outward"]["dangerous"] == found["anywhere"]["dangerous"] == 0


def test_pitch_totals_are_the_sums_over_all_cells_of_the_table():
    plan = TowerPlan(SHORT, 7, 5.0, 0.2, 2, ExactQuestions(pitch=35.0))
    told = simulate_tower(plan, None, lambda _: None)["pitch"]
    assert len(told["cells"]) == 24
    for name, total in told["total"].items():
        assert total == sum(cell[name] for cell in told["cells"])
    assert told["total"]["moves"] > 0
    assert simulate_tower(replace(plan, questions=ExactQuestions()), None, lambda _: None)["pitch"] is None
