"""Scenes from arrays, scenes with one hyperboloid more, less or elsewhere, and margins in scenes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError

MOVER = hypcheck.Mover(0.3, 0.5)


def arrays(count, seed=3):
    random = np.random.default_rng(seed)
    side = (9.0 * count) ** 0.5
    center = np.column_stack([random.uniform(0, side, (count, 2)), random.uniform(-1, 1, count)])
    return random.uniform(0.2, 0.6, count), random.uniform(1.0, 3.0, count), center, side


def scene_of(count, seed=3, **more):
    alpha, gamma, center, _ = arrays(count, seed)
    return hypcheck.Scene.from_arrays(alpha, gamma, center, mover=MOVER, z_min=-2.0, z_max=2.5, **more)


def centres(count, side, seed=5):
    random = np.random.default_rng(seed)
    return np.column_stack([random.uniform(0, side, (count, 2)), random.uniform(-3, 3, count)])


def test_a_scene_from_arrays_is_the_scene_of_a_file():
    body = "[[hyperboloid]]\nsolid = true\nalpha = 1\n"
    text = (
        'name = "s"\n[mover]\nb = 0.3\nd = 0.5\n'
        f'{body}name = "a"\ngamma = 2\ncenter = [1, 2, 3]\naxis = [0.1, 0, 1]\nheight = [-1, 2]\n'
        f'{body}name = "b"\ngamma = 4\ncenter = [5, 2, 3]\naxis = [0, 0, 1]\nheight = [-1, 3]\n'
    )
    made = hypcheck.Scene.from_arrays(
        1, [2, 4], [[1, 2, 3], [5, 2, 3]], [[0.1, 0, 1], [0, 0, 1]], mover=MOVER, z_min=-1, z_max=[2, 3], solid=True,
        names=["a", "b"], name="s",
    )  # fmt: skip
    assert made.model == hypcheck.Scene.from_text(text).model
    assert made.position(2.0, 2.0, 3.0) == made.position([2, 2, 3]) == 0


def same_answers(scene, other, side):
    points = centres(3000, side)
    expected = other.classify(points)
    assert len({*expected.tolist()}) > 1
    assert (scene.classify(points) == expected).all()
    assert [scene.position(*point) for point in points[:200].tolist()] == expected[:200].tolist()
    sweeps = points[:300], points[1:301]
    assert (scene.passage(*sweeps).hit == other.passage(*sweeps).hit).all()
    near, truth = scene.nearest(points[:50]), other.nearest(points[:50])
    assert near.index.tolist() == truth.index.tolist()
    assert near.distance_upper.tolist() == truth.distance_upper.tolist()


@pytest.mark.parametrize("count", [3, pytest.param(400, marks=pytest.mark.thorough)])
def test_scenes_with_one_hyperboloid_more_less_or_elsewhere_answer_as_new_ones(count):
    scene, (_, _, _, side) = scene_of(count), arrays(count)
    model, random = scene.model, np.random.default_rng(9)
    bodies = list(model.hyperboloids)
    for turn in range(12):
        if turn % 3 == 0:
            body = hypcheck.Hyperboloid(f"new {turn}", 0.5, 2.0, (*random.uniform(0, side, 2).tolist(), 0.0))
            scene, bodies = scene.with_hyperboloid(body), [*bodies, body]
        elif turn % 3 == 1:
            place = int(random.integers(0, len(bodies)))
            center = (*random.uniform(0, side, 2).tolist(), 0.25)
            scene = scene.moved(bodies[place].name if turn % 2 else place, center)
            bodies[place] = hypcheck.Hyperboloid(
                bodies[place].name, bodies[place].alpha, bodies[place].gamma, center, bodies[place].height
            )
        else:
            place = int(random.integers(0, len(bodies)))
            scene = scene.without(bodies.pop(place).name)
    assert scene.model.hyperboloids == tuple(bodies)
    new = hypcheck.Scene(hypcheck.SceneModel(model.name, model.question, tuple(bodies), MOVER))
    same_answers(scene, new, side)


def test_a_scene_that_grows_to_many_times_its_size_answers_as_a_new_one():
    """The table of its grid, made for three hyperboloids, is too small then and is made anew."""
    scene, (_, _, _, side) = scene_of(3), arrays(40)
    scene.classify(centres(3, side))
    for body in (bodies := scene_of(43).model.hyperboloids[3:]):
        scene = scene.with_hyperboloid(body)
    assert scene.model.hyperboloids[3:] == bodies
    same_answers(scene, hypcheck.Scene(scene.model), side)


def test_a_scene_does_not_change_when_other_scenes_are_derived_from_it():
    scene, (_, _, _, side) = scene_of(50), arrays(50)
    points = centres(1000, side)
    before = scene.classify(points).tolist()
    scene.moved(0, (0, 0, 0)), scene.without(3), scene.with_hyperboloid(hypcheck.Hyperboloid("x", 9.0, 9.0))
    assert scene.classify(points).tolist() == before
    assert len(scene.model.hyperboloids) == 50


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (
            lambda scene: scene.without("oak"),
            "there is no hyperboloid 'oak'; it must be a name, or a number from 0 to 2",
        ),
        (lambda scene: scene.without(3), "there is no hyperboloid 3"),
        (lambda scene: scene.without(2).without(1).without(0), "the scene has no hyperboloid; it must have one"),
        (lambda scene: scene.moved(0, (1, 2)), r"center is of shape \(2,\); it must be three numbers"),
        (lambda scene: scene.moved(0, [(1, 2, 3)] * 2), r"center is of shape \(2, 3\); it must be three numbers"),
        (lambda scene: scene.moved(0, (1, 2, np.nan)), "the hyperboloid 'hyperboloid 1': z is nan; it must be finite"),
        (lambda scene: scene.moved(0, (1, 2, 3), (0, 0, 0)), "axis_x, axis_y, axis_z are 0, 0, 0"),
        (lambda scene: scene.with_hyperboloid(hypcheck.Hyperboloid("new", -1.0, 1.0)), "'new': alpha is -1.0"),
        (
            lambda scene: scene.with_hyperboloid(hypcheck.Hyperboloid("new", 1, [1, 2])),
            r"'new': gamma is \[1, 2\]; it must be a number",
        ),
        (
            lambda scene: scene.with_hyperboloid(hypcheck.Hyperboloid("new", 1, 1, solid="yes")),
            "'new': solid is 'yes'; it must be a number",
        ),
        (
            lambda scene: scene.with_hyperboloid(hypcheck.Hyperboloid(7, 1, 1)),
            r"a hyperboloid's name is 7; it must be a text",
        ),
        (
            lambda scene: scene.with_hyperboloid(scene.model.hyperboloids[0]),
            "there is a hyperboloid 'hyperboloid 1' already",
        ),
        (
            lambda _: hypcheck.Scene.from_arrays([1, -1], 1, [[1, 2, 3]] * 2, mover=MOVER),
            "'hyperboloid 2': alpha is -1.0",
        ),
        (
            lambda _: hypcheck.Scene.from_arrays(1, 1, [[1, 2, 3]] * 2, mover=MOVER, names=["a"]),
            "there are 1 name for 2",
        ),
        (lambda _: hypcheck.Scene.from_arrays(1, 1, [[1, 2, 3]] * 2, mover=MOVER, names="aa"), "two hyperboloids 'a'"),
        (lambda _: hypcheck.Scene.from_arrays(1, 1, [[1, 2]], mover=MOVER), r"center is of shape \(1, 2\)"),
        (
            lambda _: hypcheck.Scene.from_arrays(1, 1, [1, 2, 3], mover=hypcheck.Mover(1.0, -1.0)),
            "the mover: d is -1.0",
        ),
        (
            lambda _: hypcheck.Scene.from_arrays(1, 1, [1, 2, 3], mover=(1, 2, 3)),
            r"the mover is \(1, 2, 3\); it must be a hypcheck.Mover, or its two semi-axes b, d",
        ),
        (
            lambda _: hypcheck.Scene.from_arrays(1, 1, [1, 2, 3], mover=MOVER, z_min=2, z_max=1),
            "z_min must be less than",
        ),
    ],
)
def test_a_value_that_is_not_a_hyperboloid_is_refused_by_its_name(change, sentence):
    with pytest.raises(InputError, match=sentence):
        change(scene_of(3))


@pytest.mark.parametrize("margin", [0.01, 0.4, 3.0])
def test_a_mover_nearer_to_a_hyperboloid_of_a_scene_than_the_margin_is_in_contact(margin):
    scene, (_, _, _, side) = scene_of(30), arrays(30)
    points = centres(120, side)
    found, near = scene.classify(points, margin=margin), scene.nearest(points)
    plain = scene.classify(points)
    sure = near.distance_lower >= margin
    assert (found[near.distance_upper < margin] == 0).all()
    assert (found[sure] == plain[sure]).all()
    assert [scene.position(*point, margin=margin) for point in points[:20].tolist()] == found[:20].tolist()


def test_a_margin_is_applied_to_the_parts_of_a_mover():
    parts = (hypcheck.MoverPart(0.1, 0.1, 0.2, 0.0), hypcheck.MoverPart(0.1, 0.1, 0.2, 180.0))
    mover = hypcheck.Mover(0.4, 0.2, parts)
    scene = hypcheck.Scene.from_arrays(1, 3, [0, 0, 0], mover=mover)
    # Its parts lie along the x axis; the wall is at x = 1, and the nearer part ends 0.3 from the mover's centre.
    assert scene.position(1.5, 0.0, 0.0, 0.0) == 1
    assert scene.position(1.5, 0.0, 0.0, 0.0, margin=0.15) == 1
    assert scene.position(1.5, 0.0, 0.0, 0.0, margin=0.25) == 0
    assert scene.position(1.5, 0.0, 0.0, 0.0, margin=5e-324) == 1


def test_a_margin_is_right_where_a_part_grown_by_it_extends_beyond_the_grown_mover():
    scene = hypcheck.Scene.from_arrays(
        2, 17.8, [0, 0, 0], mover=hypcheck.Mover(3, 1, (hypcheck.MoverPart(0.1, 0.7, 0),))
    )
    assert [scene.position(x, 0, 0, margin=1) for x in (20, 6.2, 3.2, 3)] == [1, 1, 1, 0]


@pytest.mark.parametrize(
    ("part", "trouble"),
    [
        (hypcheck.MoverPart(0.2, 0.1, 0.5), "part 1: it reaches beyond the mover"),
        (hypcheck.MoverPart(0.1, 0.1, -0.1), "part 1: arm is -0.1; it must be 0 or more"),
        (hypcheck.MoverPart(0.1, 0.1, float("nan")), "part 1: arm is nan"),
        (hypcheck.MoverPart(0.1, 0.1, 0.1, float("inf")), "part 1: angle is inf"),
    ],
)
def test_a_mover_from_python_is_refused_with_a_part_that_is_not_valid_or_reaches_beyond_it(part, trouble):
    with pytest.raises(InputError, match=trouble):
        hypcheck.Scene.from_arrays(2, 17.8, [0, 0, 0], mover=hypcheck.Mover(0.3, 0.3, (part,)))


@pytest.mark.parametrize(
    ("hyperboloid", "trouble"),
    [
        (hypcheck.Hyperboloid("a", 1, 1, (float("nan"), 0, 0)), "'a': x is nan; it must be finite"),
        (hypcheck.Hyperboloid("a", 1, 1, (0, 0)), r"center is of shape \(1, 2\)"),
        (hypcheck.Hyperboloid("a", 1, -1), "'a': gamma is -1.0; a semi-axis must be greater than 0"),
        (hypcheck.Hyperboloid("a", "x", 1), "'a': alpha is 'x'; it must be a number"),
        (hypcheck.Hyperboloid("a", 1, 1, height=(0, 1)), r"'a': height is \(0, 1\); it must be a Span\(low, high\)"),
        ((1, 1), "a hyperboloid is of type tuple; it must be a Hyperboloid"),
    ],
)
def test_a_scene_model_with_an_invalid_hyperboloid_is_refused(hyperboloid, trouble):
    model = hypcheck.SceneModel("s", "position", (hypcheck.Hyperboloid("good", 1, 1), hyperboloid), MOVER)
    with pytest.raises(InputError, match=trouble):
        hypcheck.Scene(model).classify((3, 0, 0))


@pytest.mark.parametrize("which", [0.5, None, True, -1])
def test_a_hyperboloid_is_not_found_by_a_value_other_than_a_text_or_a_whole_number(which):
    with pytest.raises(InputError, match="there is no hyperboloid"):
        scene_of(2).moved(which, (0, 0, 0))


@pytest.mark.parametrize("make", [lambda: hypcheck.Scene("tower"), lambda: hypcheck.Scene.from_text(b"name = 1")])
def test_a_value_that_is_not_a_scene_is_refused_by_its_type(make):
    with pytest.raises(InputError, match=r"is of type \w+; it must be a"):
        make()


@pytest.mark.parametrize(
    ("changes", "trouble"),
    [
        ({"region": hypcheck.Region(z=(1, 2))}, r"the region: z is \(1, 2\); it must be a Span\(low, high\), or None"),
        ({"region": hypcheck.Region(x=hypcheck.Span(2, 1))}, "the region: x is .*; low and high must be numbers"),
        (
            {"region": hypcheck.Region(y=hypcheck.Span(float("nan"), 1))},
            "the region: y is .* low not greater than high",
        ),
        ({"region": None}, r"the region is None; it must be a Region\(x, y, z\)"),
        ({"question": "near"}, "the question is 'near'; it must be position, exterior, interior or contact"),
        ({"mover": (0.3, 0.2)}, r"the mover is \(0.3, 0.2\); it must be a Mover\(b, d\)"),
        ({"mover": hypcheck.Mover(0.3, 0.2, ((0.1, 0.1, 0.1),))}, r"part 1 is \(.*\); it must be a MoverPart"),
        ({"mover": hypcheck.Mover(0.3, 0.2, None)}, "the mover's parts are None; they must be a tuple of MoverPart"),
        ({"hyperboloids": hypcheck.Hyperboloid("a", 1, 1)}, "hyperboloids are .*; they must be a tuple of Hyperboloid"),
    ],
)
def test_a_scene_model_with_a_value_of_another_type_is_refused_by_its_field(changes, trouble):
    model = hypcheck.SceneModel("s", "position", (hypcheck.Hyperboloid("a", 1, 1),), MOVER)
    with pytest.raises(InputError, match=trouble):
        hypcheck.Scene(replace(model, **changes))
