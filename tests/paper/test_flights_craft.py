"""The quadcopter of a scene, Procedures 2.a and 2.b in floats, and directions without a library's sine."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.paper.motion import valid
from hypcheck.paper.quadcopter import EIGHTH, Craft, Procedures, any_angle, craft_of, quarter_turns, small_angle, turned
from hypcheck.scene.model import Span, Start
from hypcheck.scene.reading import read_scene
from hypcheck.vectors.draw import Draw

SCENES = {name: read_scene(name) for name in ("tower", "tower-simplest")}


def test_rotor_centres_match_equation_15_of_the_paper():
    for scene in SCENES.values():
        craft, heading = craft_of(scene), 0.3
        x, y, z = craft.rotors(
            (np.array([1.0]), np.array([2.0]), np.array([3.0])), (np.cos([heading]), np.sin([heading]))
        )
        g1 = heading + math.radians(scene.mover.parts[0].angle - 45)
        for rotor in range(4):
            g = g1 + rotor * math.pi / 2
            half = craft.arm * math.sqrt(2) / 2
            assert x[rotor] == pytest.approx(1 + half * (math.cos(g) - math.sin(g)), abs=1e-12)
            assert y[rotor] == pytest.approx(2 + half * (math.cos(g) + math.sin(g)), abs=1e-12)
            assert z[rotor] == 3.0


def test_procedure_2b_agrees_with_exact_positions():
    for scene in SCENES.values():
        craft, draw = craft_of(scene), Draw("craft")
        at = (draw.between(4000, -2.2, 2.2), draw.between(4000, -2.2, 2.2), draw.between(4000, -17, 17))
        heading = small_angle(draw.between(4000, -EIGHTH, EIGHTH))
        answers, touching = Procedures(craft).ask(at, heading)
        assert answers.tolist() == valid(craft, at, heading).tolist()
        assert 500 < touching.sum() < 3500
        assert (answers & touching).any()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"parts": ()}, "four equal rotors"),
        ({"parts": 3}, "four equal rotors"),
        ({"parts": 4, "angle": 91.0}, "four equal rotors"),
        ({"parts": 4, "arm": 0.1}, "four equal rotors"),
        ({"b": 2.5}, "alpha/b >= 1"),
        ({"b": 1e-7}, "a simulation takes lengths from 1e-06 to 1e\\+06"),
    ],
)
def test_flight_simulation_refuses_scenes_outside_the_scope_of_the_procedures(change, message):
    scene = SCENES["tower"]
    mover = scene.mover
    if change.get("parts") == ():
        mover = replace(mover, parts=())
    elif "parts" in change:
        kept = list(mover.parts[: change["parts"]])
        kept[-1] = replace(kept[-1], **{key: value for key, value in change.items() if key != "parts"})
        mover = replace(mover, parts=tuple(kept))
    else:
        mover = replace(mover, **change)
    with pytest.raises(InputError, match=message):
        craft_of(replace(scene, mover=mover))


def test_flight_simulation_refuses_a_scene_with_two_towers():
    scene = SCENES["tower"]
    with pytest.raises(InputError, match="has 2 hyperboloids; it must have one, the tower"):
        craft_of(replace(scene, hyperboloids=scene.hyperboloids * 2))


def test_any_angle_returns_the_cosine_and_sine_of_degrees():
    degrees = np.linspace(-360, 360, 20001)
    cosine, sine = any_angle(degrees)
    assert abs(cosine - np.cos(np.radians(degrees))).max() < 1e-15
    assert abs(sine - np.sin(np.radians(degrees))).max() < 1e-15
    assert any_angle(np.array([0.0, 90, 180, -90]))[0].tolist() == [1, 0, -1, 0]
    assert any_angle(np.array([0.0, 90, 180, -90]))[1].tolist() == [0, 1, 0, -1]


def test_small_angle_returns_cosine_and_sine_within_1_5_ulp():
    angles = np.linspace(-EIGHTH, EIGHTH, 2001)
    for mine, exact in zip(small_angle(angles), (math.cos, math.sin), strict=True):
        expected = np.array([exact(angle) for angle in angles])
        assert (abs(mine - expected) <= 1.5 * np.spacing(abs(expected))).all()


def test_repeated_rotations_add_up_and_keep_the_direction_a_unit_vector():
    start, quarter = small_angle(np.array([0.1, -0.7])), quarter_turns(np.ones(2), np.zeros(2), np.array([1, 3]))
    direction = start
    for _ in range(4):
        direction = turned(direction, quarter)
    assert np.allclose(direction, start, atol=1e-15)
    for _ in range(1000):
        direction = turned(direction, small_angle(np.array([0.3, -0.3])))
    assert np.allclose(np.hypot(*direction), 1, atol=1e-15)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            lambda tower: {"hyperboloids": (replace(tower.hyperboloids[0], center=(0.0, -1e300, 0.0)),)},
            "centre of 'tower'",
        ),
        (
            lambda tower: {"hyperboloids": (replace(tower.hyperboloids[0], height=Span(0.0, 1e13)),)},
            "height of 'tower'",
        ),
        (lambda tower: {"region": replace(tower.region, z=Span(-1e308, 0.0))}, "the region is at -1e\\+308"),
        (lambda tower: {"flight": replace(tower.flight, start=Start(Span(0.0, 1e308), 1.0))}, "start is at 1e\\+308"),
        (lambda tower: {"flight": replace(tower.flight, start=Start(Span(0.0, 1.0), 1e20))}, "start is at 1e\\+20"),
    ],
)
def test_flight_simulation_refuses_places_whose_squares_overflow(changed, message):
    tower = SCENES["tower"]
    with pytest.raises(InputError, match=message):
        craft_of(replace(tower, **changed(tower)))


def test_repaired_procedure_2b_allows_an_interior_hull_with_a_zero_coefficient_that_the_printed_one_refuses():
    """The ledger's witness against Table 4: c2 = 0 at the first place, and nothing vanishes at the second."""
    craft = Craft((1.0, 1.0, 1.0, 1.0), (1.0, 1.0, 0.25, 0.25), 0.5, 45.0, None)
    at, heading = (np.zeros(2), np.zeros(2), np.array([1.0, 1.25])), (np.ones(2), np.zeros(2))
    assert valid(craft, at, heading).tolist() == [True, True]
    assert Procedures(craft).ask(at, heading)[0].tolist() == [False, True]
    assert Procedures(craft, repaired=True).ask(at, heading)[0].tolist() == [True, True]
