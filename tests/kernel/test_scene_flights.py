"""Scene.first_contact: flights against the exact passage of single pairs, values worked out by hand, and properties."""

from __future__ import annotations

import itertools
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck import InputError, Scene, passage
from hypcheck.kernel.scene_flights import shown_flight
from hypcheck.scene.model import FREE, UPRIGHT, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span

BALL, DRONE = Mover(1.0, 1.0), Mover(0.3, 0.15)
ANYWHERE = Region()


def scene(*bodies, mover=BALL, region=ANYWHERE):
    return Scene(SceneModel("trees", "position", bodies, mover, region))


def wood(seed, *, count=40, mover=DRONE, tilted=False):
    """Trees that end, some solid, on a square of 20 m; some tilted where that is wanted."""
    random = np.random.default_rng(seed)
    trees = []
    for number in range(count):
        alpha, gamma, x, y, z = random.uniform((0.1, 1, -10, -10, -1), (0.6, 4, 10, 10, 1)).tolist()
        height = [None, Span(-1.0, 2.5), Span(-3.0, 4.0)][number % 3]
        axis = (*random.uniform(-0.3, 0.3, 2).tolist(), 1.0) if tilted and number % 2 else UPRIGHT
        trees.append(Hyperboloid(f"t{number}", alpha, gamma, (x, y, z), height, axis, solid=number % 2 == 0))
    return scene(*trees, mover=mover)


def flight(seed, corners, step=1.0):
    random = np.random.default_rng(seed)
    start = random.uniform((-9, -9, -1), (9, 9, 3))
    moves = random.normal(size=(corners - 1, 3)) * (step, step, 0.3 * step)
    return start + np.vstack([np.zeros(3), np.cumsum(moves, axis=0)])


def single_passages(world, points, axis=None):
    """The first segment with contact by the exact decision about each pair alone, its time, and the hyperboloid."""
    mover = world.model.mover
    for segment, (here, there) in enumerate(itertools.pairwise(points.tolist())):
        contacts = []
        for number, body in enumerate(world.model.hyperboloids):
            ends = [[Fraction(p) - Fraction(c) for p, c in zip(at, body.center, strict=True)] for at in (here, there)]
            low, high = (-np.inf, np.inf) if body.height is None else body.height.ends
            found = passage(
                (body.alpha, body.gamma, mover.b, mover.d), *ends, axis or UPRIGHT, body.axis,
                z_min=low, z_max=high, solid=body.solid,
            )  # fmt: skip
            if found.hit:
                contacts.append((found.first, number))
        if contacts:
            return segment, *min(contacts)
    return None


@pytest.mark.parametrize("tilted", [False, True])
@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (2, 3))])
def test_the_first_contact_of_a_flight_is_the_first_of_the_exact_passages_of_its_pairs(seed, tilted):
    axis = (0.2, -0.1, 1.0) if tilted else None
    mover = Mover(0.3, 0.15, axis=axis or UPRIGHT)
    world, points = wood(seed, count=24, mover=mover, tilted=tilted), flight(seed + 10, 9)
    found, wanted = world.first_contact(points), single_passages(world, points, axis)
    assert found.hit == (wanted is not None)
    if wanted is None:
        assert found.segment == found.index == -1
        assert np.isnan(found.time_lower)
        assert np.isnan(found.center).all()
        return
    segment, (low, high), number = wanted
    assert (found.segment, found.index) == (segment, number)
    assert found.time_lower <= low <= high <= found.time_upper
    assert found.time_upper - found.time_lower < 1e-9


TOWER = Hyperboloid("tower", 2.0, 30.0)


def test_the_first_contact_of_a_ball_with_a_waist_is_where_it_was_worked_out():
    """The waist's radius is 2 and the ball's 1: at z = 0 contact begins 3 from the axis, at y = 0 when x = 3."""
    found = scene(TOWER).first_contact([[5, 9, 0], [5, 0, 0], [1, 0, 0]])
    assert (found.hit, found.segment, found.index) == (True, 1, 0)
    assert found.time_lower <= 0.5 <= found.time_upper
    assert found.center == pytest.approx((3, 0, 0))
    assert (found.least.distance_lower, found.least.distance_upper) == (0, 0)
    assert (found.least.segment, found.least.index) == (1, 0)


def test_the_least_distance_of_a_ball_from_a_waist_is_where_it_was_worked_out():
    """Past (0, 3.5, 0): 3.5 − 2 − 1 from the waist; γ is so large that no other point of the wall is nearer."""
    found = scene(TOWER).first_contact([[-4, 3.5, 0], [4, 3.5, 0], [4, 9, 0]])
    assert not found.hit
    assert found.least.distance_lower <= 0.5 <= found.least.distance_upper
    assert found.least.distance_upper - found.least.distance_lower < 1e-7
    assert (found.least.segment, found.least.index) == (0, 0)
    assert found.least.center == pytest.approx((0, 3.5, 0), abs=1e-3)


@pytest.mark.parametrize("far", [0.0, 2.0**30, 2.0**36, 2.0**40])
@pytest.mark.parametrize("share", [0.125, 0.40625, 0.75])
def test_the_bounds_of_the_least_distance_hold_far_from_the_origin_too(far, share):
    """Past a waist at a distance of 3.5 − 2 − 1, which the flight is nearest to at a share of its segment."""
    world = scene(Hyperboloid("tower", 2.0, 2.0**20, (far, 0.0, 0.0)))
    found = world.first_contact([[far - 16 * share, 3.5, 0], [far + 16 * (1 - share), 3.5, 0]])
    assert not found.hit
    assert found.least.distance_lower <= 0.5 <= found.least.distance_upper
    assert found.least.distance_upper - found.least.distance_lower < 1e-7 + 2.0**-37 * far


def test_the_least_distance_over_a_solid_top_is_that_to_its_disc_and_beside_an_open_one_that_to_its_rim():
    """The top is at 4 with radius 3 · √(1 + (4/3)²) = 5. The ball's centre passes 7 high through its axis."""
    solid = Hyperboloid("trunk", 3.0, 3.0, height=Span(-4.0, 4.0), solid=True)
    hollow = Hyperboloid("tube", 3.0, 3.0, height=Span(-4.0, 4.0))
    path = [[-20, 0, 7], [0, 0, 7], [0, 0, 12]]
    least = scene(solid).first_contact(path).least
    assert least.distance_lower <= 2 <= least.distance_upper < 2 + 1e-6
    least = scene(hollow).first_contact([[-20, 0, 7], [20, 0, 7]]).least
    assert least.distance_lower <= 2 <= least.distance_upper < 2 + 1e-6
    assert abs(least.center[0]) == pytest.approx(5, abs=1e-2)
    inside = scene(hollow).first_contact([[0, 0, 9], [0, 0, 6]]).least
    below = sqrt(27) - 1  # 9 + w² + (6 − w)² is least where w = 3, below the rim
    assert inside.distance_lower <= below <= inside.distance_upper < below + 1e-6


def test_the_least_distance_inside_a_solid_is_that_to_its_nearer_end():
    """The top is at 4, and the ball's centre rises from −1 to 1: 4 − 1 − 1. The wall is 19 away."""
    solid = Hyperboloid("trunk", 20.0, 90.0, height=Span(-9.0, 4.0), solid=True)
    least = scene(solid).first_contact([[0, 0, -1], [0, 0, 1]]).least
    assert least.distance_lower <= 2 <= least.distance_upper < 2 + 1e-6


def test_the_least_distance_inside_a_tower_is_that_to_its_wall():
    found = scene(Hyperboloid("tower", 8.0, 90.0)).first_contact([[0, 0, -30], [0, 2, 0], [0, 0, 30]])
    assert not found.hit
    assert found.least.distance_lower <= 8 - 2 - 1 <= found.least.distance_upper < 5 + 1e-6
    assert (found.least.segment, found.least.time) in ((0, pytest.approx(1, abs=1e-3)), (1, pytest.approx(0, abs=1e-3)))


@pytest.mark.parametrize("seed", [0, 1, pytest.param(2, marks=pytest.mark.thorough)])
def test_no_place_on_a_clear_flight_is_nearer_than_its_least_distance(seed):
    """Scene.nearest at 20 places of each segment, and at the place that was found."""
    tilted = seed % 2 == 1
    mover = Mover(0.3, 0.15, axis=(0.3, 0.0, 1.0) if tilted else UPRIGHT)
    world = wood(seed, count=9, mover=mover, tilted=tilted)
    paths = [flight(seed * 100 + number, 4, 0.5) for number in range(4)]
    found = world.first_contact(paths)
    for number in np.flatnonzero(~found.hit)[:2].tolist():
        path = paths[number]
        shares = np.linspace(0, 1, 20)[:, None, None]
        places = (path[:-1] + shares * (path[1:] - path[:-1])).reshape(-1, 3)
        near = world.nearest(places)
        lower, upper = found.least.distance_lower[number], found.least.distance_upper[number]
        assert 0 < upper - lower < 1e-7 * (1 + upper)
        assert lower <= near.distance_upper.min()
        here = world.nearest(found.least.center[number])
        assert here.distance_lower <= upper
        assert here.distance_upper >= lower
        assert upper <= near.distance_upper.min() + 1e-7 * (1 + upper)
        assert here.tied or here.index == found.least.index[number]


def test_several_flights_in_one_call_have_the_same_answers_as_each_in_its_own_call():
    world = wood(3)
    paths = [flight(seed, corners) for seed, corners in zip(range(12), [1, 2, 3, 6] * 3, strict=True)]
    together = world.first_contact(paths)
    assert 2 < together.hit.sum() < 12
    for number, path in enumerate(paths):
        alone = world.first_contact(path)
        assert (alone.hit, alone.segment, alone.index) == (
            together.hit[number], together.segment[number], together.index[number],
        )  # fmt: skip
        assert np.array_equal(alone.time_lower, together.time_lower[number], equal_nan=True)
        low, high = together.least.distance_lower[number], together.least.distance_upper[number]
        assert alone.least.distance_lower <= high
        assert low <= alone.least.distance_upper


def time_along(found, lengths):
    """The first contact as a share of the flight."""
    return None if not found.hit else (sum(lengths[: found.segment]) + found.time_lower * lengths[found.segment])


@given(st.integers(0, 10**6), st.integers(1, 7))
@settings(max_examples=4, deadline=None)
def test_a_flight_with_an_additional_corner_on_a_segment_has_the_same_answers(seed, eighths):
    """Numbers of few digits, so that the corner lies on the segment exactly."""
    world = wood(seed % 5)
    points = np.round(flight(seed, 4) * 64) / 64
    middle = points[1] + eighths / 8 * (points[2] - points[1])
    split = np.vstack([points[:2], middle, points[2:]])
    whole, parts = world.first_contact(points), world.first_contact(split)
    lengths = [1.0, 1.0, 1.0]
    shares = [1.0, eighths / 8, 1 - eighths / 8, 1.0]
    assert whole.hit == parts.hit
    if whole.hit:
        assert time_along(parts, shares) == pytest.approx(time_along(whole, lengths), abs=1e-9)
    assert whole.least.distance_lower <= parts.least.distance_upper
    assert parts.least.distance_lower <= whole.least.distance_upper


@given(st.integers(0, 10**6))
@settings(max_examples=4, deadline=None)
def test_a_reversed_flight_has_contact_where_the_flight_has_and_the_same_least_distance(seed):
    world, points = wood(seed % 5), flight(seed, 4)
    ahead, back = world.first_contact(points), world.first_contact(points[::-1])
    assert ahead.hit == back.hit
    assert ahead.least.distance_lower <= back.least.distance_upper
    assert back.least.distance_lower <= ahead.least.distance_upper


def test_a_flight_that_begins_in_contact_has_its_first_contact_at_once():
    found = scene(TOWER).first_contact([[2, 0, 0], [9, 0, 0], [2, 0, 0]])
    assert (found.segment, found.time_lower, found.time_upper, found.index) == (0, 0, 0, 0)
    assert tuple(found.center) == (2, 0, 0)


def test_a_flight_that_touches_only_at_a_corner_has_its_contact_at_the_end_of_the_segment_before_it():
    found = scene(TOWER).first_contact([[6, 1, 0], [3, 0, 0], [6, -1, 0]])
    assert (found.hit, found.segment) == (True, 0)
    assert found.time_lower <= 1 <= found.time_upper


def test_a_path_of_one_point_is_answered_as_a_mover_at_rest():
    assert scene(TOWER).first_contact([[3, 0, 0]]).hit
    found = scene(TOWER).first_contact([[4, 0, 0]])
    assert not found.hit
    assert found.least.distance_lower <= 1 <= found.least.distance_upper


def test_the_parts_decide_contact_but_the_least_distance_is_that_of_the_whole_mover():
    """Between two rotors the ball itself meets the wall's rim region, and its parts do not."""
    parts = tuple(MoverPart(0.1, 0.1, 0.85, angle) for angle in (90.0, -90.0))
    thin = Hyperboloid("pole", 0.05, 30.0, (1.5, 0.0, 0.0))
    world = scene(thin, mover=Mover(1.0, 1.0, parts))
    found = world.first_contact([[-3, 0, 0], [0.6, 0, 0]])
    assert not found.hit
    assert (found.least.distance_lower, found.least.distance_upper) == (0, 0)
    assert found.least.time == pytest.approx((3 + 0.45) / 3.6)


def test_the_least_distance_of_a_flight_nearest_at_its_end_is_at_exactly_its_last_point():
    """Rounded, start + (end − start) is another point."""
    start, end = (8.7, -3.7, 1.7), (3.4, -0.4, -0.9)
    assert all(a + (b - a) != b for a, b in zip(start, end, strict=True))
    least = scene(TOWER).first_contact([start, end]).least
    assert (least.time, tuple(least.center)) == (1.0, end)


def test_the_least_distance_of_a_tilted_mover_is_that_along_its_own_axis_on_each_segment():
    """A disk passes 4 and 4.25 from the axis of a wall of radius 2: it reaches 0.125 along its axis, 0.5 across it."""
    world = scene(Hyperboloid("tower", 2.0, 1e6), mover=Mover(0.5, 0.125, axis=FREE))
    level, upright = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    path = [[4.0, -6, 0], [4.0, 6, 0], [6, 6, 0], [6, 8, 0], [4.25, 8, 0], [4.25, -8, 0]]
    for first, last, distance, segment in (
        (level, level, 1.875, 0), (level, upright, 1.75, 4), (upright, level, 1.5, 0), (upright, upright, 1.5, 0)
    ):  # fmt: skip
        least = world.first_contact(path, axis=[first, first, first, last, last]).least
        assert distance - 1e-7 < least.distance_lower <= distance <= least.distance_upper < distance + 1e-8
        assert least.segment == segment


def test_an_axis_may_be_given_once_for_all_segments_or_once_for_each():
    world = scene(Hyperboloid("tower", 2.0, 30.0), mover=Mover(2.0, 0.5, axis=FREE))
    path = [[3.0, -9, 0], [3.0, 0, 0], [9, 0, 0]]
    flat, upright = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    assert world.first_contact(path, axis=upright).hit
    assert not world.first_contact(path[:2], axis=flat).hit
    assert world.first_contact(path, axis=[flat, upright]).segment == 1
    with pytest.raises(InputError, match="axis is given for 3 segments, and there are 2"):
        world.first_contact(path, axis=[flat, upright, flat])


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ([[0, 0], [1, 1]], r"the path is of shape \(2, 2\); it must be points \(T, 3\)"),
        ([], r"the path is of shape \(0,\)"),
        (np.zeros((0, 2, 3)), "there is no path"),
        ([[[0, 0, 0]], [[0, 0]]], r"path 1 is of shape \(1, 2\)"),
        ([[0, 0, 0], [0, np.nan, 0]], "the path, point 1: y is nan; it must be finite"),
        ([[[0, 0, 0]], [[0, 0, np.inf]]], "path 1, point 0: z is inf"),
        ("north", "the path is"),
        (np.zeros((2, 0, 3)), "one at least"),
        (3.0, "the path is of shape"),
    ],
)
def test_first_contact_refuses_a_value_that_is_not_a_path_in_one_sentence(path, says):
    with pytest.raises(InputError, match=says):
        scene(TOWER).first_contact(path)


@pytest.mark.parametrize("away", [30.0, 3e4, 1e9])
def test_the_least_distance_of_a_flight_far_from_all_trees_is_that_of_the_nearest_tree(away):
    """The trees' trunks are 0.1 wide at their feet at most 20 m away from each other: the nearest is in a corner."""
    world = wood(2)
    path = [[away, away, 0], [away + 1, away, 0]]
    least = world.first_contact(path).least
    near = world.nearest(path[0])
    assert least.distance_lower <= near.distance_upper
    assert least.distance_upper >= near.distance_lower - 1
    assert least.distance_upper - least.distance_lower < 1e-6 * away
    assert world.nearest(least.center).distance_upper >= least.distance_lower


@pytest.mark.parametrize("height", [None, 2.0**-30])
def test_a_least_distance_is_not_above_the_true_one_where_coordinates_are_large(height):
    """A ball stands half a unit beside the waist, 2**20 from the origin, and flies along it by less than a rounding."""
    far = 2.0**20
    span = None if height is None else Span(-height, height)
    scene = Scene(
        SceneModel("s", "position", (Hyperboloid("far", 1.0, 2.0**30, (far, 0.0, 0.0), span),), Mover(0.25, 0.25))
    )
    for path in ([(far + 1.75, 0.0, 0.0)], [(far + 1.75, 0.0, 0.0), (far + 1.75, 2.0**-33, 0.0)]):
        least = scene.first_contact(path).least
        assert least.distance_lower <= 0.5 <= least.distance_upper


def test_a_shown_flight_marks_the_contact_at_the_first_contact_of_its_segment():
    scene = Scene(SceneModel("s", "position", (TOWER,), Mover(0.25, 0.25)))
    path = [(9.0, 0.0, 0.0), (5.0, 0.0, 0.0), (-1.0, 0.5, 0.0)]
    found, (shown,) = scene.first_contact(path), shown_flight(scene, path).contacts
    assert (shown.segment, shown.index) == (found.segment, found.index) == (1, 0)
    assert shown.center == pytest.approx(found.center)


def test_least_distance_is_right_where_the_last_step_is_shorter_than_the_rounding_of_the_flight_length():
    """The steps before the last are 2³⁶ long: sums of lengths are rounded by more than the last step is long."""
    world = scene(Hyperboloid("tower", 1.0, 2.0**30), mover=Mover(0.25, 0.25))
    step = 2.0**-18
    least = world.first_contact([(2.0**36, 0, 0), (16.0, 0, 0), (4.0, 0, 0), (4 - step, 0, 0)]).least
    assert least.distance_lower <= 2.75 - step <= least.distance_upper
    assert least.distance_upper - least.distance_lower < 1e-7


@pytest.mark.parametrize("turn", [48, 49])
def test_the_lower_bound_of_the_least_distance_includes_the_rounding_of_large_coordinates(turn):
    """A ball passes a waist at the distance 1/2, 2²⁰ from the origin; the middle of its segment is a little beside."""
    far, beside = 2.0**20, turn * 2.0**-14
    world = scene(Hyperboloid("tower", 1.0, 2.0**30, (far, far, 0.0)), mover=Mover(0.25, 0.25))
    least = world.first_contact([(far + 1.75, far - 1 + beside, 0), (far + 1.75, far + 1 + beside, 0)]).least
    assert least.distance_lower <= 0.5 <= least.distance_upper
