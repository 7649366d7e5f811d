"""Tilted scenes: exact answers against fractions, heights along an axis, and who may name an axis."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.scene.model import (
    FREE,
    QUESTIONS,
    UPRIGHT,
    Hyperboloid,
    Mover,
    MoverPart,
    Region,
    SceneModel,
    Span,
)
from tests.support import scenes
from tests.support.inside import Scene
from tests.support.tilted_fractions import exact_position

CONTACT, EXTERIOR, INTERIOR = 0, 1, -1


def truth_beside(body, mover, axis, centre):
    """The position beside a hyperboloid: without ends in fractions, with its own axis; else as the truth has it."""
    if body.height is not None:
        return scenes.truth_beside(body, (mover.b, mover.d), axis, centre)
    offset = [Fraction(there) - Fraction(here) for there, here in zip(centre, body.center, strict=True)]
    return exact_position((body.alpha, body.gamma, mover.b, mover.d, *offset, *axis), body.axis)


def truth(scene, centre, axis):
    said = {truth_beside(body, scene.mover, axis, centre) for body in scene.hyperboloids}
    return next(position for position in (CONTACT, INTERIOR, EXTERIOR) if position in said)


def direction(draw, most=3):
    while True:
        axis = tuple(float(draw.randint(-most, most)) for _ in range(3))
        if any(axis):
            return axis


def tilted_forest(count, seed, unit=1.0):
    """Hyperboloids of which two in three are tilted, one as the mover may, with sizes and places of few bits."""
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    mover = Mover(
        unit * draw.randint(1, 6) / 8,
        unit * draw.randint(1, 6) / 8,
        axis=draw.choice([UPRIGHT, (1.0, -2.0, 3.0), FREE]),
    )
    trees = []
    for number in range(count):
        place = tuple(unit * draw.randint(-24, 24) / 4 for _ in range(3))
        span = Span(-unit * draw.randint(1, 9) / 2, unit * draw.randint(1, 9) / 2) if draw.random() < 0.7 else None
        axis = UPRIGHT if number % 3 == 0 else (2.0, -4.0, 6.0) if number == 1 else direction(draw)
        sizes = unit * draw.randint(1, 8) / 8, unit * draw.randint(2, 16) / 4
        trees.append(Hyperboloid(f"tree {number}", *sizes, place, span, axis))
    return SceneModel("forest", "position", tuple(trees), mover, Region(z=Span(-8.0 * unit, 8.0 * unit)))


@pytest.mark.parametrize("seed", range(10))
def test_scene_classify_of_a_tilted_forest_answers_as_exact_fractions_about_each_tree(seed):
    """In units of any size, for each question, with centres where trees stand and beyond the region."""
    unit, question = (1.0, 2.0**-300, 2.0**300)[seed % 3], QUESTIONS[seed % 4]
    scene = tilted_forest(6, seed, unit)
    free, draw = scene.mover.axis == FREE, random.Random(seed + 100)  # noqa: S311 - nothing is secret
    centres = [tuple(unit * draw.randint(-80, 80) / 8 for _ in range(3)) for _ in range(16)]
    centres += [tuple(at + unit * draw.randint(-8, 8) / 8 for at in tree.center) for tree in scene.hyperboloids]
    axes = [direction(draw) if free else scene.mover.axis for _ in centres]
    expected = [truth(scene, centre, axis) for centre, axis in zip(centres, axes, strict=True)]
    assert len(set(expected)) > 1
    if question != "position":
        yes = {"exterior": EXTERIOR, "interior": INTERIOR, "contact": CONTACT}[question]
        expected = [int(said == yes) for said in expected]
    asked = Scene(replace(scene, question=question))
    for scale in (1.0, -(2.0**500)):  # the length and the sense of an axis say nothing
        turned = scale * np.array(axes)
        found = asked.classify(*np.array(centres).T, **({"axis": turned} if free else {}))
        assert found.tolist() == expected
    given = [{"axis": axis} if free else {} for axis in axes]
    assert [asked.position(*at, **axis) for at, axis in zip(centres, given, strict=True)] == expected


def turned(quaternion):
    """The rotation by whole numbers, and the number by which its rows are too long."""
    a, b, c, d = quaternion
    rows = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )
    return rows, a * a + b * b + c * c + d * d


def test_a_tilted_scene_is_exact_if_the_difference_of_centres_is_rounded():
    """At 2^52 a difference is wrong by halves: more than any clearance here."""
    far = 2.0**52
    draw = random.Random(3)  # noqa: S311 - nothing is secret
    for axis in (UPRIGHT, (1.0, 2.0, 2.0)):
        body = Hyperboloid("far", 2.0, 3.0, (far, 0.25, -far), None, axis)
        scene = SceneModel("s", "position", (body,), Mover(1.0, 0.5, axis=(1.0, 1.0, 3.0)))
        for _ in range(30):
            centre = (far + draw.randint(-5, 5), draw.randint(-20, 20) / 8, -far + draw.randint(-5, 5))
            assert Scene(scene).position(*centre) == truth(scene, centre, scene.mover.axis)
        near = (1 / 3, -1e-17, 2.0**-60)
        moved = replace(scene, hyperboloids=(replace(body, center=(3.0, 0.1, -1e-3)),))
        assert Scene(moved).position(*near) == truth(moved, near, scene.mover.axis)


@pytest.mark.parametrize("unit", [1.0, 2.0**-300, 2.0**300])
@pytest.mark.parametrize(("shift", "expected"), [(-(2.0**-60), EXTERIOR), (0.0, CONTACT), (2.0**-60, CONTACT)])
def test_a_tilted_scene_is_right_about_a_clearance_that_rounding_the_difference_of_centres_would_lose(
    shift, expected, unit
):
    """A spheroid along y touches the waist of α = 1 at x = 2 from outside; 2 + 2^-60 is 2 once it is rounded."""
    body = Hyperboloid("waist", unit, 4 * unit, (shift * unit, 0.0, 0.0))
    scene = Scene(SceneModel("s", "position", (body,), Mover(unit, 0.5 * unit, axis=(0.0, 1.0, 0.0))))
    assert scene.classify(2 * unit, 0.0, 0.0) == expected
    assert scene.position(2 * unit, 0.0, 0.0) == expected
    assert truth(scene.model, (2 * unit, 0.0, 0.0), (0.0, 1.0, 0.0)) == expected


ROOT_3 = 1.7320508075688774
"""The float above √3; the float before it is below √3."""


@pytest.mark.parametrize(
    ("axis", "span", "centre", "inside"),
    [
        ((3.0, 0.0, 4.0), (-5.0, 5.0), (3.0, 7.0, 4.0), True),  # 25/5 along the axis
        ((3.0, 0.0, 4.0), (-5.0, 5.0), (float(np.nextafter(3.0, 4.0)), 7.0, 4.0), False),
        ((3.0, 0.0, 4.0), (-5.0, 5.0), (-3.0, 7.0, -4.0), True),
        ((3.0, 0.0, 4.0), (-5.0, 5.0), (-3.0, 7.0, float(np.nextafter(-4.0, -5.0))), False),
        ((1.0, 1.0, 1.0), (0.0, ROOT_3), (1.0, 1.0, 1.0), True),
        ((1.0, 1.0, 1.0), (0.0, float(np.nextafter(ROOT_3, 1.0))), (1.0, 1.0, 1.0), False),
        ((-1.0, -1.0, -1.0), (-ROOT_3, 0.0), (1.0, 1.0, 1.0), True),
        ((0.0, 0.0, 5.0), (-1.0, 2.0), (9.0, 0.0, 2.0), True),
        ((0.0, 0.0, -5.0), (-1.0, 2.0), (9.0, 0.0, 2.0), False),
        ((0.0, 0.0, -5.0), (-1.0, 2.0), (9.0, 0.0, -2.0), True),
    ],
)
def test_an_open_hyperboloid_ends_exactly_at_heights_in_the_direction_of_its_axis(axis, span, centre, inside):
    """A small mover, far from the wall of an open hyperboloid, is inside of it up to the ends, and outside beyond."""
    body = Hyperboloid("b", 100.0, 100.0, (0.0, 0.0, 0.0), Span(*span), axis)
    scene = Scene(SceneModel("s", "position", (body,), Mover(0.25, 0.25)))
    assert scene.position(*centre) == (INTERIOR if inside else EXTERIOR)
    assert scene.classify(*centre) == scene.position(*centre)


def test_the_scene_index_finds_a_tilted_tower_at_its_top():
    """Its foot is 10 m away from where a mover meets it."""
    tower = Hyperboloid("tower", 1.0, 20.0, (0.0, 0.0, 0.0), Span(0.0, 20.0), (3.0, 0.0, 4.0))
    trees = tuple(Hyperboloid(f"tree {k}", 0.25, 4.0, (3.0 * k, 30.0, 0.0)) for k in range(12))
    scene = Scene(SceneModel("s", "position", (tower, *trees), Mover(0.25, 0.5), Region(z=Span(0.0, 20.0))))
    assert scene.position(12.0, 0.0, 16.0) == INTERIOR
    assert scene.position(0.0, 0.0, 16.0) == EXTERIOR
    wall = 1.0 * np.hypot(1, 1.0) / 0.8
    assert scene.position(12.0 - wall, 0.0, 16.0) == CONTACT


def test_parts_of_an_upright_mover_are_tested_near_a_tilted_hyperboloid():
    body = Hyperboloid("wall", 4.0, 4.0, (0.0, 0.0, 0.0), None, (0.0, 1.0, 0.0))
    part = MoverPart(0.125, 0.125, 0.5)
    mover = Mover(1.0, 0.25, (part,))
    scene = Scene(SceneModel("s", "position", (body,), mover))
    assert Scene(SceneModel("s", "position", (body,), replace(mover, parts=()))).position(3.5, 0.0, 0.0) == CONTACT
    assert scene.position(3.5, 0.0, 0.0, heading=180.0) == INTERIOR
    assert scene.position(3.5, 0.0, 0.0, heading=0.0) == CONTACT


FREELY = SceneModel("s", "position", (Hyperboloid("h", 1.0, 1.0),), Mover(0.5, 0.25, axis=FREE))
FIXED = replace(FREELY, mover=Mover(0.5, 0.25, axis=(1.0, 0.0, 2.0)))
UPSTANDING = replace(FREELY, mover=Mover(0.5, 0.25))


@pytest.mark.parametrize(
    ("scene", "axis", "message"),
    [
        (
            FREELY,
            None,
            "no axis is given, and the scene leaves the mover's free; it must be three numbers, or an array",
        ),
        (FREELY, (0.0, 0.0, 0.0), "axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction"),
        (FREELY, (0.0, np.nan, 1.0), "axis_y is nan; it must be finite"),
        (FREELY, (0.0, 1.0), r"axis is of shape \(2,\); it must be three numbers, or an array"),
        (FREELY, "up", "axis is 'up'; it must be three numbers"),
        (FIXED, (1.0, 0.0, 2.0), r"axis is given, but the scene fixes it: \[1.0, 0.0, 2.0\]; give one only if"),
        (
            UPSTANDING,
            (0.0, 0.0, 1.0),
            r"the scene fixes it: \[0.0, 0.0, 1.0\]; give one only if \[mover\] has axis = ",
        ),
    ],
)
def test_scene_refuses_an_invalid_or_unexpected_axis(scene, axis, message):
    for ask in (Scene(scene).position, Scene(scene).classify):
        with pytest.raises(InputError, match=message):
            ask(1.0, 2.0, 3.0, axis=axis)


def test_scene_classify_takes_one_axis_for_all_centres_or_one_for_each():
    axes = [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]
    scene = Scene(FREELY)
    each = scene.classify([1.4, 1.4, 1.4], 0.0, 0.0, axis=axes).tolist()
    assert each == [scene.position(1.4, 0.0, 0.0, axis=axis) for axis in axes]
    assert scene.classify([1.4, 1.4], 0.0, 0.0, axis=axes[1]).tolist() == [each[1]] * 2
    assert len(set(each)) > 1


def test_scene_position_answers_several_axes_with_an_array():
    axes = [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)]
    found = Scene(FREELY).position(1.4, 0.0, 0.0, axis=axes)
    assert found.tolist() == [Scene(FREELY).position(1.4, 0.0, 0.0, axis=axis) for axis in axes]


def test_scene_classify_names_the_row_of_an_invalid_axis():
    for bad, message in (
        ((0.0, -0.0, 0.0), "row 1: axis_x, axis_y, axis_z are 0, 0, 0"),
        ((0, np.inf, 1), "row 1: axis_y is inf"),
    ):
        with pytest.raises(InputError, match=message):
            Scene(FREELY).classify(1.0, 2.0, 3.0, axis=[(0.0, 0.0, 1.0), bad])


def test_axes_of_a_scene_made_in_python_must_have_a_direction():
    with pytest.raises(
        InputError, match="the mover: axis_x, axis_y, axis_z are 0, 0, 0; an axis must have a direction"
    ):
        Scene(replace(FREELY, mover=Mover(0.5, 0.25, axis=(0.0, 0.0, 0.0))))
    for axis, message in (((0.0, 0.0, 0.0), "are 0, 0, 0"), ((0.0, np.nan, 1.0), "axis_y is nan; it must be finite")):
        scene = Scene(replace(UPSTANDING, hyperboloids=(Hyperboloid("h", 1.0, 1.0, axis=axis),)))
        with pytest.raises(InputError, match=f"the hyperboloid 'h': .*{message}"):
            scene.position(1.0, 2.0, 3.0)


def turned_places(parts, centre, heading, axis):
    """Where the parts of a mover stand that is turned about e_z × v, by Rodrigues' formula."""
    v = np.array(axis, dtype=float) * (-1 if axis[2] < 0 else 1)
    v /= np.linalg.norm(v)
    line = np.cross((0.0, 0.0, 1.0), v)
    sine, cosine = np.linalg.norm(line), v[2]
    line = line / sine if sine else line
    for part in parts:
        turn = math.radians(heading + part.angle)
        arm = part.arm * np.array([math.cos(turn), math.sin(turn), 0.0])
        yield centre + arm * cosine + np.cross(line, arm) * sine + line * (line @ arm) * (1 - cosine)


def truth_with_parts(scene, centre, heading, axis):
    """The same of a mover with parts: where it has contact, they are asked, and agree or are in contact."""
    found = set()
    for body in scene.hyperboloids:
        said = truth_beside(body, scene.mover, axis, centre)
        if said == CONTACT:
            places = turned_places(scene.mover.parts, np.array(centre), heading, axis)
            parts = {
                truth_beside(body, part, axis, place.tolist())
                for part, place in zip(scene.mover.parts, places, strict=True)
            }
            said = parts.pop() if len(parts) == 1 else CONTACT
        found.add(said)
    return next(position for position in (CONTACT, INTERIOR, EXTERIOR) if position in found)


ROTORS = tuple(MoverPart(0.2, 0.1, 0.6, angle) for angle in (45.0, 135.0, 225.0, 315.0))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("axis", [FREE, (1.0, 0.0, 2.0), (0.0, -3.0, -1.0), (2.0, 1.0, 0.0)])
def test_parts_of_a_tilted_mover_are_turned_with_it(axis, seed):
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    model = replace(tilted_forest(3, seed), question="position", mover=Mover(1.0, 0.5, ROTORS, axis))
    scene, said = Scene(model), set()
    for _ in range(60):
        centre = tuple(draw.uniform(-4, 4) for _ in range(3))
        heading, direct = draw.uniform(-180, 180), axis if axis != FREE else direction(draw)
        given = {"axis": direct} if axis == FREE else {}
        expected = truth_with_parts(model, centre, heading, direct)
        assert scene.position(*centre, heading, **given) == expected, (centre, heading, direct)
        assert scene.classify(*centre, heading, **given) == expected
        said.add(expected)
    assert len(said) > 1


def test_a_tilted_ring_of_parts_lets_a_tree_through_where_the_upright_one_does_not():
    tree = Hyperboloid("tree", 0.25, 4.0, (0.5, 0.0, 0.0))
    upright, pitched = (
        Scene(SceneModel("s", "position", (tree,), Mover(1.0, 0.5, (MoverPart(0.3, 0.2, 0.6),), axis)))
        for axis in (UPRIGHT, (1.0, 0.0, 0.0))
    )
    centre = (-0.2, 0.0, 0.0)  # the part is at the tree, or turned down by 90 degrees beside it
    assert upright.position(*centre) == CONTACT
    assert pitched.position(*centre) == EXTERIOR
    assert pitched.passage(centre, (-0.3, 0.0, 0.0)).hit == 0
    assert pitched.passage(centre, (0.3, 0.0, 0.0)).hit == 1


@pytest.mark.parametrize("seed", range(3))
def test_sweep_of_a_tilted_mover_with_parts_hits_if_a_sampled_position_has_contact(seed):
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    bodies = [body for body in tilted_forest(8, seed).hyperboloids if body.axis[0] == body.axis[1] == 0]
    model = SceneModel("s", "position", tuple(bodies), Mover(1.0, 0.5, ROTORS, (1.0, 2.0, 3.0)))
    scene, hits = Scene(model), []
    for _ in range(40):
        start, end = (tuple(draw.uniform(-4, 4) for _ in range(3)) for _ in range(2))
        heading = draw.uniform(-180, 180)
        hits.append(scene.passage(start, end, heading).hit)
        times = np.linspace(0, 1, 60)[:, None]
        x, y, z = (np.array(start) + times * (np.array(end) - np.array(start))).T
        touched = (scene.classify(x, y, z, heading) == CONTACT).any()
        assert hits[-1] == 1 or not touched
    assert set(hits) == {0, 1}


def test_a_ball_within_the_wide_part_of_a_tilted_hyperboloid_touches_its_narrow_part():
    """In the plane of the axis it is 1 along and 1 beside it; the wall is 0.76 away where it is 0.25 along."""
    along, across = (0.6, 0.0, 0.8), (0.8, 0.0, -0.6)
    horn = Hyperboloid("horn", 1.0, 0.5, axis=along)
    there = [a + b for a, b in zip(along, across, strict=True)]
    for radius, expected in ((0.5, INTERIOR), (0.8, CONTACT)):
        ball = Scene(SceneModel("s", "position", (horn,), Mover(radius, radius)))
        assert ball.classify([there]).tolist() == [expected]
        assert ball.position(there) == expected
