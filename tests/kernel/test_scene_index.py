"""Answers about a whole scene are exact against rational arithmetic, whatever the grid leaves out."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.geometry.pair import Lengths, Position
from hypcheck.kernel.scene_pairs import position_beside, positions_beside, tilted_position, tilted_positions
from hypcheck.scene import model
from hypcheck.scene.model import Hyperboloid, Mover, MoverPart, Region, Span
from tests.support import inside
from tests.support.inside import Scene


def truth_about(body, mover, centre):
    """The exact position of one spheroid, its centre given in the scene's coordinates."""
    offset = [Fraction(there) - Fraction(here) for there, here in zip(centre, body.center, strict=True)]
    radial = integers(body.alpha, mover.b, *offset[:2])
    axial = integers(body.gamma, mover.d, offset[2])
    return inside.position(Lengths(*radial, *axial))


def integers(*values):
    exactly = [Fraction(value) for value in values]
    unit = max(value.denominator for value in exactly)
    return [int(value * unit) for value in exactly]


def whole(scene, centre):
    """The answer about all hyperboloids, each asked."""
    said = [truth_about(body, scene.mover, centre) for body in scene.hyperboloids]
    for position in (Position.CONTACT, Position.INTERIOR):
        if position in said:
            return position
    return Position.EXTERIOR


def forest(count, seed, side=30.0):
    draw = random.Random(seed)  # noqa: S311 - nothing is secret
    trees = tuple(
        Hyperboloid(
            f"tree {number}",
            draw.uniform(0.2, 0.8),
            draw.uniform(1, 4),
            (draw.uniform(-side, side), draw.uniform(-side, side), draw.choice([0.0, 0.1, draw.uniform(-1, 1)])),
        )
        for number in range(count)
    )
    return model.SceneModel("forest", "position", trees, Mover(0.3, 0.9), Region(z=Span(-2.0, 2.0)))


def centres_about(scene, count, seed):
    """Half anywhere, half a radius off some tree, nearly."""
    draw = np.random.default_rng(seed)
    centres = draw.uniform([-32, -32, -2], [32, 32, 2], (count, 3))
    for place in range(0, count, 2):
        tree = scene.hyperboloids[draw.integers(len(scene.hyperboloids))]
        turn, level = draw.uniform(0, 2 * np.pi), draw.uniform(-0.5, 0.5)
        distance = tree.alpha + 0.3 * (1 + draw.choice([-1, 1]) * 10.0 ** draw.uniform(-17, 0))
        centres[place] = np.add(tree.center, (distance * np.cos(turn), distance * np.sin(turn), level * (place % 4)))
    return np.clip(centres, [-40, -40, -2], [40, 40, 2])


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(4))
def test_scene_classify_of_a_forest_answers_as_exact_arithmetic_about_every_tree(seed):
    scene = forest(60, seed)
    centres = centres_about(scene, 120, seed)
    asked = Scene(scene)
    found = asked.classify(*centres.T)
    assert found.dtype == np.int8
    assert [asked.position(*centre) for centre in centres.tolist()] == found.tolist()
    for centre, answer in zip(centres.tolist(), found.tolist(), strict=True):
        assert answer == whole(scene, centre), centre


def test_scene_classify_is_exact_if_the_difference_of_two_centres_is_rounded():
    """One unit of the last place of a far centre is more than the clearance."""
    tree = Hyperboloid("tree", 1.0, 4.0, (2.0**60, 0.0, 0.0))
    scene = model.SceneModel("s", "position", (tree,), Mover(1.0, 1.0))
    for x in (2.0**60 + 512, 2.0**60 - 256):
        assert Scene(scene).classify(x, 0.0, 0.0) == truth_about(tree, scene.mover, (x, 0.0, 0.0))
        assert Scene(scene).position(x, 0.0, 0.0) == truth_about(tree, scene.mover, (x, 0.0, 0.0))
    near = replace(tree, center=(1.0, 0.0, 0.0))
    for x in (3 + 2.0**-51, 3.0, -1.0, -1 - 2.0**-52, 1e-30):
        scene = model.SceneModel("s", "position", (near,), Mover(1.0, 1.0))
        assert Scene(scene).classify(x, 1e-200, 0.0) == truth_about(near, scene.mover, (x, 1e-200, 0.0))


def test_scene_classify_is_exact_for_a_tower_wider_than_the_grid_and_a_region_without_end():
    trees = forest(40, 1)
    tower = Hyperboloid("tower", 20.0, 30.0, (0.0, 0.0, 0.0))
    scene = replace(trees, hyperboloids=(*trees.hyperboloids, tower))
    assert Scene(scene).classify(20.0, 0.0, 0.0) == 0
    assert Scene(scene).classify(25.0, 0.0, 1.0) == whole(scene, (25.0, 0.0, 1.0))
    endless = replace(scene, region=Region())
    assert Scene(endless).classify(0.0, 0.0, 50.0) == whole(endless, (0.0, 0.0, 50.0))


def test_scene_classify_is_exact_for_centres_outside_the_region():
    scene = replace(forest(30, 2), region=Region(z=Span(-0.01, 0.01)))
    asked, centres = Scene(scene), centres_about(scene, 60, 3)
    expected = [whole(scene, centre) for centre in centres.tolist()]
    assert asked.classify(*centres.T).tolist() == [asked.position(*each) for each in centres.tolist()] == expected
    assert len(set(expected)) > 1
    for z in (-9.0, 2.5, 400.0):
        assert asked.classify(5.0, 5.0, z) == whole(scene, (5.0, 5.0, z))


def test_scene_classify_tests_the_parts_of_a_mover_that_is_in_contact():
    tree = Hyperboloid("tower", 2.0, 17.8)
    rotors = tuple(MoverPart(0.1, 0.05, 0.135, angle) for angle in (0.0, 90.0, 180.0, 270.0))
    body = model.SceneModel("s", "position", (tree,), Mover(0.25, 0.15))
    parted = replace(body, mover=Mover(0.25, 0.15, rotors))
    assert Scene(body).classify(1.76, 0.0, 0.0) == 0
    assert Scene(parted).classify(1.76, 0.0, 0.0, heading=45.0) == -1
    assert Scene(parted).classify(1.80, 0.0, 0.0, heading=0.0) == 0
    assert Scene(parted).classify(3.0, 0.0, 0.0) == 1


def test_scene_classify_answers_exterior_beyond_the_top_of_an_open_hyperboloid():
    tree = Hyperboloid("stump", 1.0, 2.0, (0.0, 0.0, 1.0), Span(-1.0, 1.0))
    scene = Scene(model.SceneModel("s", "position", (tree,), Mover(0.5, 0.5)))
    assert scene.classify([0.0, 1.2, 0.0], 0.0, [2.0, 1.0, 2.5]).tolist() == [-1, 0, 1]
    assert [scene.position(x, 0.0, z) for x, z in ((0.0, 2.0), (1.2, 1.0), (0.0, 2.5))] == [-1, 0, 1]
    other = Hyperboloid("post", 1.0, 2.0)
    both = Scene(model.SceneModel("s", "contact", (tree, other), Mover(0.5, 0.5)))
    assert both.classify(1.2, 0.0, -0.1) == 1


@pytest.mark.parametrize(
    ("question", "answers"), [("exterior", [1, 0, 0]), ("interior", [0, 0, 1]), ("contact", [0, 1, 0])]
)
def test_scene_classify_answers_a_yes_or_no_question_with_1_or_0(question, answers):
    scene = model.SceneModel("s", question, (Hyperboloid("h", 2.0, 4.0),), Mover(0.5, 0.5))
    asked = Scene(scene)
    assert asked.classify([9.0, 2.0, 0.0], 0.0, 0.0).tolist() == answers
    assert [asked.position(x, 0.0, 0.0) for x in (9.0, 2.0, 0.0)] == answers


def test_scene_from_toml_reads_a_file_or_a_shipped_name(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text('name = "s"\n[[hyperboloid]]\nalpha = 2\ngamma = 4\n[mover]\nb = 1\nd = 1\n', encoding="utf-8")
    assert hypcheck.Scene.from_toml(file).classify(9.0, 0.0, 0.0) == 1
    assert hypcheck.Scene.from_toml("tower").classify([0.0], [0.0], [0.0]).tolist() == [1]


TWO_60 = 2.0**-60


@pytest.mark.parametrize(
    ("sizes", "centre", "axis", "outwards"),
    [
        ((1.0, 4.0, 1.0, 1.0), (2.0, 0.0, 0.0), 0, -1),  # α + b from the axis, at the waist
        ((1.0, 4.0, 1.0, 1.0), (0.0, 2.0, 0.0), 1, -1),
        ((1.0, 1.0, 0.3125, 0.390625), (1.5, 0.0, 0.515625), 2, 1),  # it touches at (5/4, 3/4)
    ],
)
def test_a_tangency_that_rounding_of_the_difference_moves_keeps_its_exact_position(sizes, centre, axis, outwards):
    """2⁻⁶⁰ towards one side is exterior, towards the other contact, and the rounded difference is the tangency."""
    alpha, gamma, b, d = sizes
    for side, expected in ((outwards, Position.EXTERIOR), (-outwards, Position.CONTACT)):
        origin = [0.0, 0.0, 0.0]
        origin[axis] = side * TWO_60
        assert centre[axis] - origin[axis] == centre[axis]
        found = positions_beside(np.array([sizes]), np.array([centre]), np.array([origin]))
        assert found.tolist() == [expected]
        assert position_beside((alpha, gamma), origin, b, d, *centre) == expected


@pytest.mark.parametrize(("x", "expected"), [(0.25, Position.INTERIOR), (0.0625, Position.CONTACT)])
def test_a_difference_whose_rounding_exceeds_the_spheroid_is_decided_exactly(x, expected):
    """The rounded difference is on the surface; the exact one is 1/4 inside of it, or 1/16, and the radius is 1/8."""
    far = 2.0**53
    sizes, centre, origin = (far, far, 0.125, 0.125), (far, 0.0, 0.0), (x, 0.0, 0.0)
    assert far - x == far
    assert position_beside((far, far), origin, 0.125, 0.125, *centre) == expected
    assert positions_beside(np.array([sizes]), np.array([centre]), np.array([origin])).tolist() == [expected]


def test_scene_position_converts_every_type_of_number_to_float_and_refuses_other_values():
    scene = Scene(model.SceneModel("s", "position", (Hyperboloid("h", 2.0, 4.0),), Mover(0.5, 0.5)))
    assert [scene.position(x, np.float32(0), [0]) for x in (9, 2, 0)] == [1, 0, -1]
    assert scene.position(2**53 + 1, 2**53 + 1, 0.0) == 1
    for x in ("9", 1j, np.inf):
        with pytest.raises(hypcheck.InputError, match="x is"):
            scene.position(x, x, 0.0)


def test_scene_position_of_one_centre_takes_an_axis_for_each_answer():
    tower = Hyperboloid("tower", 2.0, 4.0)
    disk = Scene(model.SceneModel("s", "position", (tower,), Mover(1.0, 0.25, axis=model.FREE)))
    axes = [(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]
    assert [disk.position(2.5, 0.0, 0.0, axis=axis) for axis in axes] == [1, 0]
    assert disk.position(2.5, 0.0, 0.0, axis=axes).tolist() == [1, 0]


def test_scene_position_tests_the_parts_only_where_the_mover_has_contact():
    """Rotors on either side of a thin tree, of a mover that is far off, and on the tree."""
    tree, mover = Hyperboloid("tree", 0.125, 9.0), Mover(1.0, 0.5, (MoverPart(0.125, 0.125, 0.75),))
    scene = Scene(model.SceneModel("s", "position", (tree,), mover))
    for x, expected in ((0.0, 1), (9.0, 1), (-0.75, 0), (-0.9, 0), (1.125, 1)):
        assert scene.position(x, 0.0, 0.0) == expected, x
        assert scene.classify([x], 0.0, 0.0).tolist() == [expected], x


def test_a_clear_mover_is_exterior_even_if_the_rounded_place_of_a_part_reaches_beyond_it():
    """At 2**20 the place of the part is rounded: it reaches 2**-34 beyond the mover, which is clear by 2**-35."""
    far, more = 2.0**20, 3 * 2.0**-34
    trees = (
        Hyperboloid("beside", 1 - 2.0**-35, 2.0**30, (far, 0.0, 0.0)),
        Hyperboloid("tilted", 1.0, 9.0, axis=(1, 0, 1)),
    )
    mover = Mover(1.0, 1.0, (MoverPart(0.25 - more, 0.25 - more, 0.75 + more),))
    scene = Scene(model.SceneModel("s", "position", trees, mover))
    assert scene.classify([far + 2], 0.0, 0.0, 180.0).tolist() == [Position.EXTERIOR]
    assert scene.position(far + 2, 0.0, 0.0, 180.0) == Position.EXTERIOR


def test_positions_beside_a_tilted_hyperboloid_count_contact_with_its_narrower_wall_below_the_mover():
    """At the height 1 the wall is √5 from its axis, and 1 at its waist: a ball of 0.8 there touches it lower down."""
    along, centre = (0.6, 0.0, 0.8), (1.4, 0.0, 0.2)
    upright, origin = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
    for radius, expected in ((0.5, Position.INTERIOR), (0.8, Position.CONTACT)):
        sizes = (1.0, 0.5, radius, radius)
        columns = (np.array([part]) for part in (sizes, centre, origin, upright, along))
        assert tilted_positions(*columns).tolist() == [expected]
        assert tilted_position(sizes, centre, origin, upright, along) == expected


def test_scene_position_of_two_floats_and_a_column_of_heights_answers_as_classify():
    scene, heights = Scene(forest(3, seed=1)), [0.0, 0.5]
    assert scene.position(1.0, 2.0, heights).tolist() == scene.classify(1.0, 2.0, heights).tolist()
