"""Sweeps through a scene: against the exact decision about every hyperboloid, whatever grid and floats leave out."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import cos, radians, sin

import numpy as np
import pytest

from hypcheck import passage
from hypcheck.errors import InputError
from hypcheck.geometry.pair import WITHOUT_ENDS, Position
from hypcheck.scene.model import FREE, UPRIGHT, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from tests.support.inside import Scene, scene_index


def forest(count, seed, height=None, **changes):
    """Trees on a square of 12 m, of places that differences round."""
    random = np.random.default_rng(seed)
    trees = tuple(
        Hyperboloid(f"tree {number}", *shape, (x, y, z), height)
        for number, (shape, (x, y), z) in enumerate(
            zip(
                random.uniform((0.2, 1.0), (0.8, 4.0), (count, 2)).tolist(),
                random.uniform(-6, 6, (count, 2)).tolist(),
                random.uniform(-1, 1, count).tolist(),
                strict=True,
            )
        )
    )
    scene = SceneModel("forest", "position", trees, Mover(0.3, 0.9), Region(z=Span(-2.0, 2.0)))
    return replace(scene, **changes)


def sweeps(count, seed, step=2.0, rise=1.0):
    """Starts on the square, and ends some steps farther."""
    random = np.random.default_rng(seed)
    starts = random.uniform((-6, -6, -2), (6, 6, 2), (count, 3))
    return starts, starts + random.normal(size=(count, 3)) * (step, step, rise)


def passage_beside(body, semi_axes, start, end, axis=None):
    """What happens on a sweep beside a hyperboloid and its ends, exactly."""
    ends = (
        [Fraction(there) - Fraction(here) for there, here in zip(point, body.center, strict=True)]
        for point in (start, end)
    )
    low, high = WITHOUT_ENDS[:2] if body.height is None else body.height.ends
    return passage(
        (body.alpha, body.gamma, *semi_axes), *ends, axis, body.axis, z_min=low, z_max=high, solid=body.solid
    )


def brute_force(scene, start, end, axis=None):
    """The answer by the exact decision about every hyperboloid."""
    semi_axes = scene.mover.b, scene.mover.d
    return int(any(passage_beside(body, semi_axes, start, end, axis).hit for body in scene.hyperboloids))


NEAR = Hyperboloid("near", 1.0, 2.0, (0.0, 0.0, 0.0), Span(-2.0, 2.0))
FAR = Hyperboloid("far", 1.0, 2.0, (1e80, 1e80, 1e80), Span(-1.0, 1.0))


@pytest.mark.parametrize(
    ("body", "semi_axes", "start", "end", "hit"),
    [
        (NEAR, (1e-70, 1e-70), (3.0, 0.0, 0.0), (1.0, 0.0, 0.0), True),
        (NEAR, (1e-70, 1e-70), (3.0, 0.0, 0.0), (1 + 2**-50, 0.0, 0.0), False),
        (FAR, (1.45e80, 5e80), (1.5e60, 1.5e60, 1.5e60), (1e60, 1.5e60, -1.5e60), True),
        (FAR, (1.45e80, 1e80), (1.5e60, 1.5e60, 1.5e60), (1e60, 1.5e60, -1.5e60), False),
    ],
)
def test_a_sweep_whose_sizes_are_beyond_the_range_of_the_bounds_is_decided_exactly(body, semi_axes, start, end, hit):
    """A mover of no size, or a centre so far away that the difference of coordinates loses the mover's place."""
    scene = SceneModel("one", "position", (body,), Mover(*semi_axes), Region())
    assert brute_force(scene, start, end) == hit
    assert Scene(scene).passage(start, end).hit == hit


def test_a_sweep_that_begins_with_a_part_in_contact_has_its_first_contact_at_time_0():
    """The part reaches from 0.85 to 1.05 at the start, and the wall is at 1."""
    mover = Mover(0.4, 0.2, (MoverPart(0.1, 0.1, 0.2, 0.0),))
    scene = Scene(SceneModel("one", "position", (replace(NEAR, height=None),), mover, Region()))
    found = scene.passage((0.75, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert (found.hit, found.first) == (True, (0, 0))


def expected(scene, starts, ends, axis=None):
    return [brute_force(scene, *sweep, axis) for sweep in zip(starts.tolist(), ends.tolist(), strict=True)]


@pytest.mark.parametrize(
    "scene",
    [
        forest(8, 1),
        forest(6, 2, region=Region()),  # without end, so that each is always asked
        forest(8, 3, Span(-0.5, 0.75), region=Region()),
        forest(6, 4, Span(-1.5, 1.75), mover=Mover(1e-9, 2e-9)),  # much smaller than the trees
    ],
    ids=["forest", "no-region", "heights", "small"],
)
def test_scene_passage_answers_as_the_exact_decision_about_every_hyperboloid(scene):
    starts, ends = sweeps(24, 5)
    found = Scene(scene).passage(starts, ends)
    assert found.hit.tolist() == expected(scene, starts, ends)
    alone = [Scene(scene).passage(*sweep) for sweep in zip(starts, ends, strict=True)]
    assert [sweep.hit for sweep in alone] == found.hit.tolist()
    for place in [place for place, sweep in enumerate(alone) if sweep.hit][:4]:  # a time takes milliseconds
        sweep = starts[place].tolist(), ends[place].tolist()
        firsts = [passage_beside(tree, (scene.mover.b, scene.mover.d), *sweep).first for tree in scene.hyperboloids]
        first, index = min((first, index) for index, first in enumerate(firsts) if first is not None)
        assert (alone[place].first, alone[place].index) == (first, index)
        many = Scene(scene).passage(starts[[place]], ends[[place]])
        assert (many.first, many.index.tolist()) == ([first], [index])
    assert found.hit.dtype == np.bool_
    assert len({*found.hit.tolist()}) > 1


def test_scene_passage_answers_long_and_short_sweeps_in_one_call_as_in_separate_calls():
    scene, (starts, ends) = Scene(forest(60, 6)), sweeps(40, 7)
    ends = starts + (ends - starts) * np.repeat([1e-9, 1.0, 3.0, 1e3], 10)[:, None] * (1, 1, 0)
    found = scene.passage(starts, ends)
    assert found.hit.tolist() == [int(scene.passage(*sweep).hit) for sweep in zip(starts, ends, strict=True)]
    assert found.hit.tolist() == scene.passage(ends, starts).hit.tolist()
    looks = starts + np.linspace(0, 1, 65)[:, None, None] * (ends - starts)
    seen = np.array([scene.classify(*places.T) == 0 for places in looks]).any(axis=0)
    assert found.hit[seen].all()
    assert 0 < seen.sum() < found.hit.sum() < 40


def test_scene_passage_of_a_tilted_mover_is_exact_with_its_fixed_axis():
    axis = (1.0, 0.5, 2.0)
    scene = forest(5, 8, mover=Mover(0.3, 0.9, axis=axis))
    starts, ends = sweeps(16, 9)
    assert Scene(scene).passage(starts, ends).hit.tolist() == expected(scene, starts, ends, axis)


def test_scene_passage_finds_the_first_contact_above_the_region_where_a_tree_reaches_farther():
    """At the height 9 the second tree is 4.5 wide, and within the region, up to 1, it is 0.7 wide at most."""
    trees = (Hyperboloid("thin", 0.2, 50.0, (6.0, 0.0, 0.0)), Hyperboloid("wide", 0.5, 1.0, (7.0, 4.0, 0.0)))
    scene = SceneModel("two", "position", trees, Mover(0.1, 0.1), Region(z=Span(-1.0, 1.0)))
    sweep = (0.0, 0.0, 9.0), (10.0, 0.0, 9.0)
    thin, wide = (passage_beside(tree, (0.1, 0.1), *sweep) for tree in trees)
    assert wide.first_upper < thin.first_lower
    for found in (Scene(scene).passage(*sweep), Scene(scene).first_contact(sweep)):
        assert found.index == 1
    assert Scene(scene).passage(*sweep).first == wide.first


TREE = Hyperboloid("tree", 2.0, 3.0)


def test_scene_passage_is_exact_if_the_difference_of_centres_is_rounded():
    """3.1 − 0.1 is more than the float 3.0, at which the spheroid would touch."""
    scene = Scene(SceneModel("tree", "position", (replace(TREE, center=(0.0, 0.1, 0.0)),), Mover(1.0, 1.0), Region()))
    ends = [(0.0, 3.1, 0.0), (0.0, 3.0999999999999996, 0.0)]
    assert scene.passage((0.0, 5.0, 0.0), ends).hit.tolist() == [0, 1]
    assert [scene.passage((0.0, 5.0, 0.0), end).hit for end in ends] == [False, True]


@pytest.mark.parametrize(
    ("start", "end", "hit"),
    [
        ((-4.0, 3.0, 0.0), (4.0, 3.0, 0.0), 1),  # touched for an instant
        ((-4.0, 3.0000000000000004, 0.0), (4.0, 3.0000000000000004, 0.0), 0),
        ((-1e200, 0.0, 0.0), (2.0, 0.0, 0.0), 1),
        ((-1e160, 0.0, 0.0), (2.0, 0.0, 0.0), 1),
        ((-20.0, 6.3, 9.0), (20.0, 6.3, 9.0), 1),  # above the region, where the tree is wider
        ((-1e200, 4.0, 0.0), (1e200, 4.0, 0.0), 0),
        ((1e200, 0.0, 0.0), (1.5e200, 0.0, 0.0), 0),
        ((-1e9, 0.0, 0.0), (1e9, 5.0, 0.0), 1),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0),
        ((3.0, 0.0, 0.0), (3.0, 0.0, 0.0), 1),
    ],
)
def test_scene_passage_decides_exact_tangencies_and_very_long_sweeps(start, end, hit):
    for center in ((0.0, 0.0, 0.0), (0.0, 0.0, 0.1)):
        trees = (replace(TREE, center=center),)
        scene = SceneModel("tree", "exterior", trees, Mover(1.0, 1.0), Region(z=Span(-1, 1)))
        up = (0.0, 0.0, center[2])
        assert Scene(scene).passage(np.add(start, up), np.add(end, up)).hit == hit


def test_scene_passage_beyond_an_end_is_clear_up_to_the_rim():
    """α is 2, γ 3: the rim at the height 1 is 2.108 from the axis; the mover is a ball of radius 1."""
    scene = Scene(SceneModel("tree", "contact", (replace(TREE, height=Span(-1.0, 1.0)),), Mover(1.0, 1.0), Region()))
    through = [(2.0, 0.0, 2.0), (2.0, 0.0, 1.5)], [(2.0, 0.0, -2.0), (2.0, 0.0, 1.0000001)]
    assert scene.passage(*through).hit.tolist() == [1, 1]
    assert scene.passage((2.0, 0.0, 3.0), [(2.0, 0.0, 1.995), (2.0, 0.0, 1.99)]).hit.tolist() == [0, 1]
    assert scene.passage((9.0, 0.0, 2.0), (9.0, 0.0, 1.0)).hit == 0
    assert scene.passage((0.0, 0.0, 3.0), (0.0, 0.0, 1.0)).hit == 0


ROTORS = tuple(MoverPart(0.2, 0.1, 0.75, angle) for angle in (0.0, 180.0))


def test_scene_passage_tests_the_parts_of_a_mover_where_the_whole_has_contact():
    body, mover = replace(TREE, alpha=0.5, gamma=4.0, height=Span(-2.0, 2.0)), Mover(1.0, 0.5, ROTORS)
    scene = Scene(SceneModel("tree", "position", (body,), mover, Region()))
    random = np.random.default_rng(10)
    starts, ends = random.normal(size=(2, 24, 3)) * 0.8
    headings = random.uniform(0, 360, 24)

    def hit(start, end, heading):
        if not passage_beside(body, (1.0, 0.5), start, end).hit:
            return 0
        said = set()
        for part in ROTORS:
            turn = radians(heading + part.angle)
            moved = [(x + part.arm * cos(turn), y + part.arm * sin(turn), z) for x, y, z in (start, end)]
            found = passage_beside(body, (part.b, part.d), *moved)
            said.add(Position.CONTACT if found.hit else found.start)
        return int(said not in ({Position.EXTERIOR}, {Position.INTERIOR}))

    found = scene.passage(starts, ends, headings).hit.tolist()
    assert found == [hit(*sweep) for sweep in zip(starts.tolist(), ends.tolist(), headings.tolist(), strict=True)]
    without = Scene(replace(scene.model, mover=Mover(1.0, 0.5))).passage(starts, ends).hit.tolist()
    assert sum(found) < sum(without)


def around(points):
    """x, y, z turned into y, z, x: the vertical becomes the direction of x, without a rounding."""
    return np.roll(points, 1, axis=-1)


@pytest.mark.parametrize("height", [None, Span(-1.0, 0.75)])
@pytest.mark.parametrize("axis", [UPRIGHT, (1.0, -2.0, 3.0)])
def test_sweeps_in_a_turned_scene_are_answered_as_in_the_upright_one(height, axis):
    scene = forest(6, 4, height, mover=Mover(0.3, 0.9, axis=axis), region=Region())
    bodies = [
        replace(body, center=tuple(around(body.center).tolist()), axis=(1.0, 0.0, 0.0)) for body in scene.hyperboloids
    ]
    other = replace(scene, hyperboloids=tuple(bodies), mover=Mover(0.3, 0.9, axis=tuple(around(axis).tolist())))
    starts, ends = sweeps(80, 3, step=3.0)
    said = Scene(scene).passage(starts, ends)
    assert set(said.hit.tolist()) == {0, 1}
    assert Scene(other).passage(around(starts), around(ends)).hit.tolist() == said.hit.tolist()
    free = Scene(replace(other, mover=Mover(0.3, 0.9, axis=FREE)))
    axes = np.tile(around(axis), (80, 1)) * np.random.default_rng(1).uniform(0.5, 2, (80, 1))
    assert free.passage(around(starts), around(ends), axis=around(axis)).hit.tolist() == said.hit.tolist()
    assert (
        free.passage(around(starts), around(ends), axis=axes).hit == said.hit
    ).mean() > 0.9  # a rounded axis is another


@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (0, 2))])
def test_sweep_beside_tilted_hyperboloids_hits_exactly_if_its_least_distance_is_0(seed):
    """Euclidean distance changes no faster than the centre, so that samples bound it from both sides."""
    scene = forest(5, seed, mover=Mover(0.3, 0.6, axis=FREE), region=Region())
    draw = np.random.default_rng(seed)
    bodies = [replace(body, axis=tuple(draw.normal(size=3).tolist())) for body in scene.hyperboloids]
    scene = Scene(replace(scene, hyperboloids=tuple(bodies)))
    starts, ends = sweeps(8, seed, step=3.0)
    axes = draw.normal(size=(8, 3))
    said = scene.passage(starts, ends, axis=axes).hit.astype(int)
    assert set(said.tolist()) == {0, 1}
    times = np.linspace(0, 1, 100)[:, None]
    for start, end, axis, hit in zip(starts, ends, axes, said.tolist(), strict=True):
        found = scene.nearest(*(start + times * (end - start)).T, axis=axis)
        if (found.distance_upper == 0).any():
            assert hit == 1
        if hit == 1:
            assert found.distance_lower.min() <= np.linalg.norm(end - start) / 198 + 1e-9


def test_sweep_along_the_axis_of_a_tilted_trunk_meets_its_end_at_an_irrational_time():
    """|w| = √2: the end at the height 1 along (1, 0, 1) is where x + z = √2, with floats on both sides."""
    trunk = Hyperboloid("fir", 0.25, 4.0, (0.0, 0.0, 0.0), Span(1.0, 3.0), (1.0, 0.0, 1.0), solid=True)
    scene = Scene(SceneModel("tree", "position", (trunk,), Mover(2.0**-60, 2.0**-60)))
    half = 0.5**0.5
    assert Fraction(2 * half) ** 2 > 2 > Fraction(2 * float(np.nextafter(half, 0))) ** 2
    ends = [(x, 0.0, x) for x in (half, float(np.nextafter(half, 0)))]
    assert scene.passage((0.0, 0.0, 0.0), ends).hit.tolist() == [1, 0]
    assert scene.passage(ends, (2.0, 0.0, 2.0)).hit.tolist() == [0, 1]  # one begins inside
    ends = [(1.5, 0.0, 1.0), (0.75, 1.0, 0.75), (9.0, 0.0, 0.75)]
    assert scene.passage((0.75, 0.0, 0.75), ends).hit.tolist() == [1, 1, 1]


def test_scene_passage_refuses_a_missing_or_superfluous_axis():
    scene = SceneModel("tree", "position", (TREE,), Mover(1.0, 1.0), Region())
    with pytest.raises(InputError, match="no axis is given, and the scene leaves the mover's free"):
        Scene(replace(scene, mover=Mover(1, 1, axis=FREE))).passage((0, 0, 0), (1, 0, 0))
    with pytest.raises(InputError, match="axis is given, but the scene fixes it"):
        Scene(scene).passage((0, 0, 0), (1, 0, 0), axis=(1, 0, 0))


@pytest.mark.parametrize(
    ("start", "end", "said"),
    [
        ((0, 0), (1, 0, 0), "start is of shape (2,); it must be three numbers, x, y, z, or an array (n, 3) of them"),
        ((0, 0, 0), [(1, 0, 0), (1, float("nan"), 0)], "row 1: y of the end is nan; it must be finite"),
        ("way", (1, 0, 0), "start is 'way'; it must be three numbers, x, y, z, or an array (n, 3) of them"),
    ],
)
def test_scene_passage_refuses_invalid_ends_in_one_sentence(start, end, said):
    scene = Scene(SceneModel("tree", "position", (TREE,), Mover(1.0, 1.0), Region()))
    with pytest.raises(InputError) as caught:
        scene.passage(start, end)
    assert str(caught.value) == said


def test_scene_passage_of_no_sweeps_is_an_empty_array():
    scene = Scene(forest(3, 1))
    assert scene.passage(np.empty((0, 3)), np.empty((0, 3))).hit.tolist() == []


def test_passed_is_true_exactly_for_sweeps_within_the_reach_of_an_axis():
    """To ask about more is slow, and shows in no answer."""
    starts, ends = np.array([[-9.0, 0.0, 0.0], [-1.0, 1.0, 0.0]]), np.array([[9.0, 0.0, 0.0], [1.0, -1.0, 0.0]])
    origins = np.array([[0.0, 1.5, 0.0], [0.0, 1.0, 0.0], [3.0, 3.0, 0.0], [2.0, -2.0, 0.0]])
    query, reach = np.array([0, 0, 1, 1]), np.array([1.0, 1.0, 2.0, 2.0])
    assert scene_index.passed(starts, ends, query, origins, reach).tolist() == [False, True, False, True]


def test_sweeps_so_far_out_that_coordinates_round_by_more_than_a_grid_cell_are_answered_rightly():
    """Padded for their rounding they would overlap billions of cells."""
    far = 1.7976931348623157e308
    bodies = (Hyperboloid("near", 1.0, 1.0), Hyperboloid("far", 1.0, 1.0, (far, 0.0, 0.0)))
    trees = Scene(SceneModel("trees", "position", bodies, Mover(0.5, 0.5)))
    ends = np.array([[far, 0.0, 0.0], [far, 1e300, 0.0], [1e30, 1.0, 0.0], [1.0, 0.0, 0.0]])
    assert trees.passage(ends, ends).hit.tolist() == [0, 0, 0, 1]
    assert trees.classify(*ends.T).tolist() == [-1, 1, 1, 0]


def test_sweeps_beside_a_hyperboloid_whose_axis_points_down_are_those_beside_the_upright_one():
    starts, ends = np.random.default_rng(1).uniform(-3, 3, (2, 400, 3))
    said = [
        Scene(SceneModel("tree", "position", (body,), Mover(0.2, 0.2))).passage(starts, ends).hit.tolist()
        for body in (
            Hyperboloid("up", 0.5, 2.0, (0.0, 0.0, 0.0), Span(-2.0, 1.0)),
            Hyperboloid("down", 0.5, 2.0, (0.0, 0.0, 0.0), Span(-1.0, 2.0), (0.0, 0.0, -1.0)),
            Hyperboloid("far down", 0.5, 2.0, (0.0, 0.0, 0.0), Span(-1.0, 2.0), (0.0, 0.0, -3e-320)),
        )
    ]
    assert said[1] == said[2] == said[0]
    assert set(said[0]) == {0, 1}


@pytest.mark.parametrize("scale", [5e-324, 1e-300, 5.9e307])
def test_answers_beside_a_tilted_hyperboloid_do_not_depend_on_the_length_of_the_axis(scale):
    draw = np.random.default_rng(1)
    starts, ends = draw.uniform(-3, 3, (2, 300, 3))
    axes = draw.integers(-3, 4, (300, 3)).astype(float)
    axes[(axes == 0).all(axis=1)] = 1.0
    tree = Hyperboloid("fir", 0.5, 2.0, (0.0, 0.0, 0.0), None, (1.0, 2.0, 4.0))
    scene = Scene(SceneModel("tree", "position", (tree,), Mover(0.6, 0.1, axis=FREE)))
    scaled = scene.passage(starts, ends, axis=axes * scale)
    assert scaled.hit.tolist() == scene.passage(starts, ends, axis=axes).hit.tolist()
    assert set(scaled.hit.tolist()) == {0, 1}
    found, other = scene.nearest(*starts.T, axis=axes), scene.nearest(*starts.T, axis=axes * scale)
    assert np.allclose(other.distance_upper, found.distance_upper, rtol=0, atol=1e-9)


def ball_over(*bodies):
    return Scene(SceneModel("s", "position", bodies, Mover(1.0, 1.0)))


def test_a_ball_that_slides_on_a_flat_end_touches_it():
    end = Hyperboloid("end", 5.0, 4.0, (0.0, 0.0, 0.0), Span(-3.0, 1.0), solid=True)
    starts, ends = [[0.0, 0.0, 2.0], [0.0, 0.0, 2.0 + 2.0**-50]], [[0.5, 0.0, 2.0], [0.5, 0.0, 2.0 + 2.0**-50]]
    assert ball_over(end).passage(starts, ends).hit.tolist() == [True, False]


def test_a_sweep_away_from_an_edge_is_clear_even_if_rounding_hides_the_gap_at_its_start():
    """What a rounding hides at the start is decided on the sweep alone, not behind its start."""
    end = Hyperboloid("end", 5.0, 4.0, (2.0**-60, 0.0, 0.0), Span(-3.0, 1.0), solid=True)
    start, up = [[1.0, 0.0, 2.0 + 2.0**-50]], [[1.0, 0.0, 9.0]]
    assert ball_over(end).passage(start, up).hit.tolist() == [False]
    wall = Hyperboloid("wall", 5.0, 4.0, (2.0**-60, 0.0, 0.0), Span(-3.0, 0.5))
    start, away = [[6.0 + 2.0**-50, 0.0, 0.0]], [[9.0, 0.0, 0.0]]
    assert ball_over(wall).passage(start, away).hit.tolist() == [False]


def test_the_first_hyperboloid_touched_is_found_even_if_the_sweep_passes_beside_its_axis():
    """The way passes 1 beside the axis of one, which is touched first, and through that of the other."""
    one = Hyperboloid("beside", 1.0, 10.0, (0.0, 1.0, 0.0), Span(-1.0, 1.0))
    other = Hyperboloid("ahead", 1.0, 10.0, (0.75, 0.0, 0.0), Span(-1.0, 1.0))
    both = Scene(SceneModel("s", "position", (other, one), Mover(0.25, 0.25)))
    found = both.passage([[-10.0, 0.0, 0.0]], [[10.0, 0.0, 0.0]])
    assert found.index.tolist() == [1]
    assert found.first_lower[0] == pytest.approx((10 - 0.75) / 20, abs=1e-3)


def test_scene_passage_refuses_centres_that_are_not_finite_even_far_from_every_hyperboloid():
    end = Hyperboloid("end", 5.0, 4.0, (0.0, 0.0, 0.0), Span(-3.0, 1.0))
    for place in ((0.0, 0.0, float("nan")), (99.0, 0.0, float("nan")), (0.0, 0.0, float("inf"))):
        with pytest.raises(InputError, match="must be finite"):
            ball_over(end).passage(place, place)
