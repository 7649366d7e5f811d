"""Flights flown many at once equal slow flights, one at a time and with exact positions."""

from __future__ import annotations

import math
import random
from dataclasses import asdict, replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.paper.flights import LANES, fly
from hypcheck.paper.quadcopter import craft_of
from hypcheck.scene.model import Span
from hypcheck.scene.reading import read_scene
from hypcheck.vectors.draw import Draw
from tests.paper.scalar_flight import Quadcopter

SCENES = {name: read_scene(name) for name in ("tower", "tower-simplest")}
SCENES["tower-obeyed"] = replace(SCENES["tower"], flight=replace(SCENES["tower"].flight, turn="obeyed"))


def words_of(draw):
    """The words of each lane, in the order in which a flight takes them."""
    return (draw.words(LANES) for _ in iter(int, 1))


def scalar(scene, step, moves, draw, lane):
    """One lane of a block, from its words."""
    craft, words = Quadcopter(scene), words_of(draw)
    height, share, around, heading = (int(next(words)[lane]) for _ in range(4))
    angles = [(2 * (word >> 11) * 2.0**-53 - 1) * math.pi / 4 + (word & 3) * math.pi / 2 for word in (around, heading)]

    def choose():
        first, second = (int(next(words)[lane]) for _ in range(2))
        forth, left = 1 - 2 * (first & 1), first & 2 == 0
        return (first >> 11) * 2.0**-53, forth, left, (second >> 11) * 2.0**-53

    state = craft.begin((height >> 11) * 2.0**-53, (share >> 11) * 2.0**-53, *angles)
    return craft.fly(state, step, moves, choose), state


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("step", [0.5, 3.0])
def test_flights_simulated_in_a_block_equal_flights_simulated_one_by_one(name, step):
    scene, lanes, moves = SCENES[name], 6, 40
    ends = np.zeros((3, lanes))

    def observe(seen):
        for place, lane in enumerate(seen.lane):
            ends[:, lane] = [
                (there if seen.accepted[place] else here)[place]
                for here, there in zip(seen.start, seen.end, strict=True)
            ]

    many = fly(craft_of(scene), scene.flight, step, moves, Draw("t", step), lanes, observe)
    for lane in range(lanes):
        count, state = scalar(scene, step, moves, Draw("t", step), lane)
        assert asdict(count) == {key: int(values[lane]) for key, values in asdict(many).items()}
        assert state[:3] == pytest.approx(ends[:, lane].tolist(), abs=1e-9)


@pytest.mark.parametrize("name", SCENES)
def test_mean_share_of_touching_positions_agrees_with_scalar_flights_with_other_random_numbers(name):
    """Executions with Δ ≤ 0 in percent, within 4 standard errors of the difference."""
    scene, step, moves, dice = SCENES[name], 1.0, 20, random.Random(5)  # noqa: S311 - dice, not secrets
    craft = Quadcopter(scene)

    def choose():
        return dice.random(), dice.choice([1, -1]), dice.random() < 0.5, dice.random()

    slow = []
    for _ in range(60):
        start = craft.begin(dice.random(), dice.random(), dice.uniform(0, 7), dice.uniform(-math.pi, math.pi))
        count = craft.fly(start, step, moves, choose)
        slow.append(100 * count.touching / count.executions)
    many = fly(craft_of(scene), scene.flight, step, moves, Draw("statistics"), LANES)
    fast = 100 * many.touching / many.executions
    error = math.sqrt(np.var(slow, ddof=1) / len(slow) + np.var(fast, ddof=1) / len(fast))
    assert abs(np.mean(slow) - np.mean(fast)) < 4 * error
    assert error < 2  # or the test could not fail


def test_result_of_a_flight_does_not_depend_on_the_number_of_flights():
    scene = SCENES["tower"]
    few, many = (fly(craft_of(scene), scene.flight, 1.5, 15, Draw("few"), lanes) for lanes in (7, LANES))
    for name, values in asdict(few).items():
        assert values.tolist() == asdict(many)[name][:7].tolist()


def test_a_flight_that_cannot_move_is_reported_as_stuck():
    scene = SCENES["tower-simplest"]
    still = replace(scene.flight, vertical=0.0, straight=1.0, start=replace(scene.flight.start, radius=0.0))
    with pytest.raises(InputError, match=r"steps of 9.0 is stuck: 2000 draws in a row led to no accepted move"):
        fly(craft_of(scene), replace(still, start=replace(still.start, z=Span(0.0, 0.0))), 9.0, 1, Draw("s"), 1)


def test_vertical_move_beyond_the_tower_height_is_drawn_again():
    scene = SCENES["tower"]
    seen = []
    fly(craft_of(scene), scene.flight, 3.0, 30, Draw("h"), 50, seen.append)
    heights = np.concatenate([moves.end[2][moves.accepted] for moves in seen])
    assert abs(heights).max() <= 17.8
    assert any((moves.vertical & ~moves.executed).any() for moves in seen)
    free = replace(scene, hyperboloids=(replace(scene.hyperboloids[0], height=None),))
    beyond = []
    fly(craft_of(free), scene.flight, 3.0, 30, Draw("h"), 50, beyond.append)
    assert max(abs(moves.end[2]).max() for moves in beyond) > 17.8
