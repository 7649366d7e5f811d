"""Scenes whose hyperboloids end: position, nearest and passage agree with each other and with exact decisions."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import inf

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.kernel.scene_pairs import limits_of, meets_for_sure
from hypcheck.kernel.scene_sweeps import bounded_hits
from hypcheck.scene.model import FREE, UPRIGHT, Hyperboloid, Mover, MoverPart, Region, SceneModel, Span
from tests.support.inside import Scene, kernel_choice, passage, scene_index
from tests.support.scenes import truth_beside, truth_in

STUMP = Hyperboloid("stump", 0.2, 1.0, (0.0, 0.0, 0.0), Span(-1.0, 2.0))
DRONE = Mover(0.3, 0.2)


def scene(*bodies, mover=DRONE, **changes):
    return Scene(SceneModel("s", "position", bodies, mover, **changes))


def test_a_drone_on_the_rim_of_a_tree_is_in_contact_by_position_nearest_and_passage():
    """A second tree stands far off; the rim is 0.2 √5 from the axis."""
    rim, far = 0.2 * 5**0.5, Hyperboloid("far", 0.2, 1.0, (50.0, 0.0, 0.0), Span(-1.0, 2.0))
    trees = scene(STUMP, far)
    assert trees.position(rim, 0.0, 2.01) == Position.CONTACT
    assert trees.classify([rim, rim, 0.0], 0.0, [2.01, 2.25, 5.0]).tolist() == [0, 1, 1]
    assert trees.passage((rim, 0.0, 4.0), (rim, 0.0, 2.01)).hit == 1
    assert trees.passage((rim, 0.0, 4.0), (rim, 0.0, 2.25)).hit == 0
    found = trees.nearest([rim, rim], 0.0, [2.01, 2.25])
    assert (found.distance_upper == 0).tolist() == [True, False]
    assert found.index.tolist() == [0, 0]
    assert found.distance_lower[1] <= 0.05 <= found.distance_upper[1]
    assert found.distance_upper[1] - found.distance_lower[1] < 1e-12
    assert found.point[1] == pytest.approx((rim, 0.0, 2.0), abs=1e-6)


@pytest.mark.parametrize("solid", [False, True])
def test_a_small_drone_over_an_opening_is_clear_and_over_a_flat_end_touches(solid):
    wide = Hyperboloid("tower", 2.0, 4.0, (0.0, 0.0, 0.0), Span(-3.0, 1.0), solid=solid)
    tower = scene(wide)
    assert tower.classify(0.5, 0.0, [0.0, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 9.0]).tolist() == (
        [-1, -1, 0, 0, 0, 0, 0, 1, 1] if solid else [-1, -1, -1, -1, -1, 1, 1, 1, 1]
    )
    assert tower.passage((0.5, 0.0, 0.0), (0.5, 0.0, 9.0)).hit == int(solid)
    assert tower.passage((0.5, 0.0, 9.0), (0.5, 0.0, 1.25)).hit == 0
    found = tower.nearest(0.5, 0.0, [0.5, 1.5])
    if solid:
        assert (found.distance_lower <= 0.3 + 1e-15).all()
        assert (found.distance_upper >= [0.3 - 1e-15, 0.3 - 1e-15]).all()
        assert found.point == pytest.approx(np.array([(0.5, 0.0, 1.0)] * 2), abs=1e-9)
    else:
        assert (found.distance_lower > 1.0).all()


def random_body(draw, number, *, tilted):
    """A hyperboloid about a metre wide, anywhere near the origin, that ends somewhere, open or solid."""
    low = draw.choice([-inf, -draw.uniform(0.1, 1.5), draw.uniform(-0.5, 0.5)])
    high = low + draw.choice([draw.uniform(1e-3, 0.1), draw.uniform(0.2, 2)]) if low > -inf else draw.uniform(-1, 1)
    axis = tuple(draw.normal(size=3).tolist()) if tilted else UPRIGHT
    center = tuple(np.round(draw.uniform(-1, 1, 3), draw.choice([1, 12])).tolist())
    sizes = draw.uniform(0.2, 1.5, 2).tolist()
    return Hyperboloid(f"h {number}", *sizes, center, Span(float(low), float(high)), axis, bool(draw.random() < 0.5))


def frame(body):
    """A matrix whose rows are unit vectors across the axis, two, and along it."""
    along = np.array(body.axis) / np.linalg.norm(body.axis)
    across = np.cross(along, (1, 0, 0) if abs(along[0]) < 0.6 else (0, 1, 0))
    across /= np.linalg.norm(across)
    return np.stack([across, np.cross(along, across), along])


def near(draw, body, mover, axis):
    """A centre from which the mover nearly touches a rim, a disc or the wall, within 1e-9 or as floats fall."""
    end = draw.choice([height for height in body.height.ends if np.isfinite(height)])
    bottom = max(body.height.low, body.height.high - 2)
    where, turn = draw.choice(["rim", "rim", "disc", "wall"]), draw.uniform(0, 2 * np.pi)
    w = draw.uniform(bottom, body.height.high) if where == "wall" else end
    r = body.alpha * np.hypot(1, w / body.gamma)
    slope = body.alpha**2 * w / (body.gamma**2 * r)
    normal = {
        "rim": draw.normal(size=3),
        "disc": np.array([0, 0, draw.choice([-1.0, 1.0])]),
        "wall": draw.choice([-1, 1]) * np.array([np.cos(turn), np.sin(turn), -slope]),
    }[where]
    radius = r * (draw.uniform(0, 1) if where == "disc" else 1)
    point = frame(body).T @ (radius * np.cos(turn), radius * np.sin(turn), w) + body.center
    out = frame(body).T @ normal / np.linalg.norm(normal)
    v = np.array(axis) / np.linalg.norm(axis)
    half = mover.b**2 * out + (mover.d**2 - mover.b**2) * (out @ v) * v
    off = draw.choice([-1, 1]) * draw.choice([1e-9, 1e-12, 1e-16, 0.0])
    return (point + half / np.sqrt(out @ half) + off * out).tolist()


def random_rows(seed, count, *, tilted_bodies, tilted_mover):
    """A scene of three hyperboloids, and centres and axes of which half nearly touch one."""
    draw = np.random.default_rng(seed)
    bodies = tuple(random_body(draw, k, tilted=tilted_bodies and draw.random() < 0.7) for k in range(3))
    mover = Mover(*draw.uniform(0.05, 0.8, 2).tolist(), axis=FREE if tilted_mover else UPRIGHT)
    centres, axes = [], []
    for place in range(count):
        axis = draw.normal(size=3).tolist() if tilted_mover else list(UPRIGHT)
        body = bodies[draw.integers(3)]
        anywhere = (draw.normal(size=3) + body.center).tolist()
        centres.append(near(draw, body, mover, axis) if place % 2 else anywhere)
        axes.append(axis)
    return scene(*bodies, mover=mover), np.array(centres), np.array(axes)


@pytest.mark.parametrize("tilted_bodies", [False, True])
@pytest.mark.parametrize("tilted_mover", [False, True])
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.thorough)])
def test_position_nearest_and_passage_never_contradict_each_other_or_the_exact_position(
    seed, tilted_mover, tilted_bodies
):
    asked, centres, axes = random_rows(seed, 16, tilted_bodies=tilted_bodies, tilted_mover=tilted_mover)
    named = {"axis": axes} if tilted_mover else {}
    true = [truth_in(asked.model, centre, axis) for centre, axis in zip(centres.tolist(), axes.tolist(), strict=True)]
    found = asked.classify(*centres.T, **named)
    assert found.tolist() == true
    for centre, axis, position in zip(centres.tolist(), axes.tolist(), true, strict=True):
        assert asked.position(*centre, **({"axis": axis} if tilted_mover else {})) == position
    touching = found == Position.CONTACT
    assert 0 < touching.sum() < 16
    assert (asked.passage(centres, centres, **named).hit == touching).all()
    nearest = asked.nearest(*centres.T, **named)
    assert ((nearest.distance_upper == 0) == touching).all()
    assert (nearest.distance_lower[touching] == 0).all()
    assert (nearest.distance_upper - nearest.distance_lower < 1e-9 * (1 + nearest.distance_upper)).all()
    back = np.roll(centres, 1, axis=0)
    moved = asked.passage(centres, back, **named).hit
    assert (moved[touching] == 1).all()
    if not tilted_mover:
        assert (moved[np.roll(touching, 1)] == 1).all()


@pytest.mark.parametrize("semi_axes", [(0.5, 0.25), (0.25, 0.5), (0.5, 0.5)])
def test_the_distance_of_a_tilted_mover_from_a_flat_end_is_that_of_its_lowest_or_highest_point(semi_axes):
    """With Σ = b² + (d² − b²) v vᵀ that point is Σ e_z / √(e_zᵀ Σ e_z) from the centre."""
    b, d = semi_axes
    axis = np.array([3.0, 0.0, 4.0]) / 5
    pole = b * b * np.array([0, 0, 1]) + (d * d - b * b) * axis[2] * axis
    pole /= np.sqrt(pole[2])
    tower = Hyperboloid("tower", 9.0, 40.0, (0.0, 0.0, 0.0), Span(-2.0, 3.0), solid=True)
    for solid, sign, end in ((True, 1, 3.0), (True, -1, -2.0), (False, 1, 3.0)):
        asked = scene(replace(tower, solid=solid), mover=Mover(b, d, axis=tuple(axis)))
        near = asked.nearest([0.5], [0.25], [end + sign * 2.0])
        if not solid:
            assert near.distance_lower[0] > 7
            continue
        assert near.distance_lower[0] <= 2 - pole[2] <= near.distance_upper[0] < 2 - pole[2] + 1e-9
        assert near.point[0] == pytest.approx((0.5 - sign * pole[0], 0.25, end), abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_nearest_distance_is_the_least_over_points_of_the_remaining_surface(seed):
    """Balls, so that the distance to a point is known: that of the centre, less the radius."""
    draw = np.random.default_rng(seed)
    body = random_body(draw, 0, tilted=seed % 2 == 1)
    body = replace(body, height=Span(max(body.height.low, -2.0), body.height.high))
    asked, centres = scene(body, mover=Mover(0.1, 0.1)), draw.normal(size=(8, 3)) * 1.5
    w, turn = np.meshgrid(np.linspace(*body.height.ends, 400), np.linspace(0, 2 * np.pi, 400))
    r = body.alpha * np.hypot(1, w / body.gamma)
    walls = np.stack([r * np.cos(turn), r * np.sin(turn), w], axis=-1).reshape(-1, 3)
    if body.solid:
        share = np.linspace(0, 1, 400)
        for end in body.height.ends:
            r = body.alpha * np.hypot(1, end / body.gamma) * share[None, :]
            flat = np.stack([r * np.cos(turn), r * np.sin(turn), np.full(turn.shape, end)], axis=-1)
            walls = np.concatenate([walls, flat.reshape(-1, 3)])
    points = walls @ frame(body) + body.center
    spacing = np.abs(walls[:, :2]).max() * 2 * np.pi / 400 + 2 * (1 + body.alpha / body.gamma) / 200
    found = asked.nearest(*centres.T)
    for centre, lower, upper in zip(centres, found.distance_lower, found.distance_upper, strict=True):
        sampled = np.sqrt(((points - centre) ** 2).sum(axis=1).min()) - 0.1
        assert lower <= max(sampled, 0) + 1e-12
        assert upper >= sampled - spacing
    clear = found.distance_upper > 0
    assert clear.sum() > 2
    to_point = np.linalg.norm(found.point - centres, axis=1) - 0.1
    assert to_point[clear] == pytest.approx(found.distance_upper[clear], abs=1e-9)


@pytest.mark.parametrize("seed", [0, 2, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (4, 6))])
def test_passage_beside_ends_hits_if_a_sampled_position_has_contact_and_none_before_its_time_has(seed):
    """Exact positions at 17 times of each sweep; the first contact is enclosed within 2^-58 of the whole."""
    draw, hits = np.random.default_rng(seed), set()
    for number in range(7):
        body = random_body(draw, 0, tilted=number % 2 == 1)
        axis = draw.normal(size=3).tolist() if seed % 4 > 1 else list(UPRIGHT)
        mover = Mover(*draw.uniform(0.05, 0.8, 2).tolist(), axis=tuple(axis))
        asked = scene(body, mover=mover)
        start = near(draw, body, mover, axis) if draw.random() < 0.3 else (draw.normal(size=3) * 1.5).tolist()
        end = near(draw, body, mover, axis) if draw.random() < 0.3 else (draw.normal(size=3) * 1.5).tolist()
        hit = asked.passage(start, end).hit
        offsets = [[Fraction(a) - Fraction(b) for a, b in zip(p, body.center, strict=True)] for p in (start, end)]
        sizes, (low, high) = (body.alpha, body.gamma, mover.b, mover.d), body.height.ends
        found = passage(sizes, *offsets, axis, body.axis, z_min=low, z_max=high, solid=body.solid)
        assert found.hit == hit
        times = [Fraction(k, 16) for k in range(17)]
        sweep = [(Fraction(here), Fraction(there)) for here, there in zip(start, end, strict=True)]
        places = ([here + time * (there - here) for here, there in sweep] for time in times)
        said = [truth_beside(body, (mover.b, mover.d), axis, place) for place in places]
        touching = [time for time, position in zip(times, said, strict=True) if position is Position.CONTACT]
        if found.first is None:
            assert not touching
        else:
            low, high = found.first
            assert high - low <= Fraction(1, 2**58)
            assert found.first_lower <= low <= high <= found.first_upper
            assert not touching or low <= touching[0]
        hits.add(hit)
    assert hits == {False, True}


def test_passage_hits_if_it_grazes_a_rim_at_an_irrational_time_but_not_2_to_the_minus_40_higher():
    """A ball of radius 1/4 comes down and goes past (15/8, 0, 1), a point of the rim, along a line at distance 1/4."""
    body = Hyperboloid("tower", 1.125, 0.75, (0.0, 0.0, 0.0), Span(0.0, 1.0))
    rim = 1.875  # 9/8 · 5/3, as 1 + 16/9 = 25/9
    ball = scene(body, mover=Mover(0.25, 0.25))
    for lift, hit in ((0.0, 1), (2.0**-40, 0), (-(2.0**-40), 1)):
        level = 1.25 + lift
        assert ball.passage((rim, -1.0, level), (rim, np.pi, level)).hit == hit
        assert ball.passage((rim, -1.0, level), (rim, 1.0, level)).hit == hit
        exact = passage((1.125, 0.75, 0.25, 0.25), (rim, -1.0, level), (rim, np.pi, level), z_min=0.0, z_max=1.0)
        assert (exact.hit, exact.grazes) == (bool(hit), lift == 0)


def test_parts_of_a_mover_pass_through_an_opening_that_is_too_narrow_for_the_whole_mover():
    body = Hyperboloid("tower", 1.0, 4.0, (0.0, 0.0, 0.0), Span(-2.0, 1.0))
    rotors = tuple(MoverPart(0.1, 0.05, 0.8, angle) for angle in (0.0, 180.0))
    asked = scene(body, mover=Mover(1.1, 0.3, rotors))
    up = (0.0, 0.0, -1.0), (0.0, 0.0, 3.0)
    assert asked.classify(0.0, 0.0, [-1.0, 0.9, 1.1, 3.0]).tolist() == [-1, -1, 1, 1]
    assert [asked.position(0.0, 0.0, z) for z in (-1.0, 0.9, 1.1, 3.0)] == [-1, -1, 1, 1]
    assert asked.passage(*up).hit == 0
    wide = (replace(rotors[0], arm=0.95), rotors[1])
    touching = scene(body, mover=Mover(1.1, 0.3, wide))
    assert touching.passage(*up).hit == 1
    for z, position in ((-1.0, 0), (0.9, 0), (3.0, 1)):
        assert touching.position(0.0, 0.0, z) == position
        assert touching.passage((0.0, 0.0, z), (0.0, 0.0, z)).hit == int(position == 0)


def test_heights_of_a_hyperboloid_whose_axis_points_down_are_measured_downwards():
    for axis, span in ((UPRIGHT, Span(-1.0, 2.0)), ((0.0, 0.0, -5.0), Span(-2.0, 1.0))):
        tree = scene(replace(STUMP, axis=axis, height=span, solid=True))
        assert tree.classify(0.0, 0.0, [-1.25, -1.15, 0.0, 2.15, 2.25]).tolist() == [1, 0, 0, 0, 1]


def test_answers_outside_the_region_of_a_scene_respect_the_ends_of_its_hyperboloids():
    tree = scene(STUMP, region=Region(z=Span(0.0, 1.0)))
    assert [tree.position(0.3, 0.0, z) for z in (-9.0, 0.0, 2.1, 9.0)] == [1, 0, 0, 1]
    assert tree.classify(0.3, 0.0, [-9.0, 0.0, 2.1, 9.0]).tolist() == [1, 0, 0, 1]
    assert tree.passage([(0.3, 0.0, 9.0)] * 2, [(0.3, 0.0, 5.0), (0.3, 0.0, 2.1)]).hit.tolist() == [0, 1]


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
def test_an_axis_tilted_in_one_coordinate_is_not_taken_for_upright_beside_an_end(axis):
    """A disk on its edge reaches 0.5 up, and an upright one 0.5 along an axis that lies level."""
    tower = Hyperboloid("tower", 2.0, 4.0, (0.0, 0.0, 0.0), Span(-3.0, 1.0), solid=True)
    asked = scene(tower, mover=Mover(0.5, 0.01, axis=axis))
    assert [asked.position(0.0, 0.0, z) for z in (1.51, 1.49, 0.51, 0.49)] == [1, 0, 0, -1]
    asked = scene(replace(tower, axis=axis), mover=Mover(0.5, 0.01))
    places = [tuple(along * part for part in axis) for along in (1.51, 1.49, 0.51, 0.49)]
    assert [asked.position(*place) for place in places] == [1, 0, 0, -1]


def test_a_mover_that_would_meet_the_wall_only_beyond_an_end_is_clear():
    """The wall's radius is 2.7 to 3 between the ends, and 4.5 at a height of 2, which the mover reaches."""
    ring = Hyperboloid("ring", 2.0, 1.0, (0.0, 0.0, 0.0), Span(0.9, 1.1))
    tall = scene(ring, mover=Mover(0.6, 5.0))
    x = [1.5, 2.0, 2.5, 3.5, 3.6, 4.5]
    assert tall.classify(x, 0.0, 1.0).tolist() == [tall.position(each, 0.0, 1.0) for each in x] == [-1, -1, 0, 0, 1, 1]


def test_a_tilted_mover_touches_a_tree_at_the_distance_of_its_longer_semi_axis():
    trees = [Hyperboloid(f"tree {x}", 0.5, 9.0, (x, 0.0, 0.0), Span(-2.0, 2.0)) for x in (0.0, 40.0, 80.0)]
    level = Span(-1.0, 1.0)
    rod = scene(*trees, mover=Mover(0.125, 3.0, axis=(1.0, 0.0, 0.0)), region=Region(z=level))
    x = [3.375, 3.625, 43.375, 43.625]
    assert [rod.position(each, 0.0, 0.0) for each in x] == rod.classify(x, 0.0, 0.0).tolist() == [0, 1, 0, 1]
    sides = [((each, -1.0, 0.0), (each, 1.0, 0.0)) for each in x]
    assert [rod.passage(*ends).hit for ends in sides] == [True, False, True, False]


@pytest.fixture
def by_numpy(monkeypatch):
    """From its call on, the numpy kernel answers, which leaves most sweeps beside ends to bounds."""

    def choose():
        monkeypatch.setenv("HYPCHECK_KERNEL", "numpy")
        kernel_choice.choice.cache_clear()

    yield choose
    monkeypatch.undo()
    kernel_choice.choice.cache_clear()


@pytest.mark.parametrize("tilted_mover", [False, True])
@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.thorough)])
def test_passages_beside_ends_are_the_same_by_the_numpy_kernel(seed, tilted_mover, by_numpy):
    asked, centres, axes = random_rows(seed, 16, tilted_bodies=False, tilted_mover=tilted_mover)
    named = {"axis": axes} if tilted_mover else {}
    middle = (centres + np.roll(centres, 1, axis=0)) / 2
    sweeps = ((centres, middle), (middle, centres))
    expected = [asked.passage(*ends, **named).hit.tolist() for ends in sweeps]
    by_numpy()
    assert [asked.passage(*ends, **named).hit.tolist() for ends in sweeps] == expected


def test_a_sweep_that_stops_before_a_wall_is_clear_by_the_numpy_kernel_too(by_numpy):
    tower = scene(Hyperboloid("tower", 2.0, 4.0, height=Span(0.0, 3.0)), mover=Mover(0.25, 0.25))
    by_numpy()
    for end, hit in ((2.5, 0), (2.375, 0), (2.1875, 1)):
        assert tower.passage([(2.75, 0.0, 0.125)], [(end, 0.0, 0.125)]).hit == hit


def test_a_drone_that_meets_only_the_missing_part_above_an_end_is_clear():
    """Beside the wall of a whole hyperboloid it is in contact, above the height at which this one ends.

    At the drone's own height the radius is 1.345, 1.25 and 3; each drone reaches over another number near to that.
    """
    for (alpha, gamma, end), (b, reach, height) in (
        ((1.0, 1.0, 1.0), (0.2, 1.65, 0.9)),
        ((1.0, 1.2, 1.0), (0.2, 1.51, 0.9)),
        ((2.0, 1.0, 1.2), (0.4, 3.55, 1.118)),
    ):
        wall = Hyperboloid("wall", alpha, gamma, (0.0, 0.0, 0.0), Span(-3.0, end))
        whole, ended = (scene(body, mover=Mover(b, 1.5)) for body in (replace(wall, height=None), wall))
        assert whole.position(reach, 0.0, height) == Position.CONTACT, reach
        assert ended.position(reach, 0.0, height) == Position.EXTERIOR, reach
        assert ended.classify([reach], [0.0], [height]).tolist() == [Position.EXTERIOR], reach


def test_a_ball_just_above_a_flat_end_is_clear_even_where_the_difference_of_centres_is_rounded():
    """The difference of the centres loses 2**-60, and the ball is 2**-50 above the end."""
    wide = Hyperboloid("wide", 5.0, 4.0, (2.0**-60, 0.0, 0.0), Span(-3.0, 1.0), solid=True)
    tower = scene(wide, mover=Mover(1.0, 1.0))
    assert tower.classify([1.0, 1.0], 0.0, [2.0, 2.0 + 2.0**-50]).tolist() == [Position.CONTACT, Position.EXTERIOR]
    assert tower.position(1.0, 0.0, 2.0 + 2.0**-50) == Position.EXTERIOR


def test_a_tilted_disc_touches_a_flat_end_at_the_distance_of_its_longer_semi_axis():
    wide = Hyperboloid("wide", 5.0, 4.0, (0.0, 0.0, 0.0), Span(-3.0, 1.0), solid=True)
    tower = scene(wide, mover=Mover(2.0, 0.5, axis=(1.0, 0.0, 0.0)))
    heights = [2.75, 3.0, 3.25]
    assert tower.classify(0.0, 0.0, heights).tolist() == [Position.CONTACT, Position.CONTACT, Position.EXTERIOR]
    assert [tower.position(0.0, 0.0, height) for height in heights] == [0, 0, 1]


def test_meets_for_sure_is_true_exactly_where_a_mover_touches_the_wall_at_the_height_of_its_centre():
    """At the height 4 the wall is 2 √(1 + (4/3)²) = 10/3 from its axis; three other formulas give 4, 11/3 and more."""
    across = np.array([10 / 3 - 0.2, 10 / 3, 10 / 3 + 0.2, 10 / 3 - 0.3, 10 / 3 + 0.3, 50 / 9, 20.1])
    count = len(across)
    places = np.column_stack([across, np.zeros(count), np.full(count, 4.0)])
    shapes, spans = np.tile((2.0, 3.0), (count, 1)), np.tile((-1.0, 5.0), (count, 1))
    found = meets_for_sure(np.full(count, 0.25), shapes, spans, places, np.zeros(count))
    assert found.tolist() == [True, True, True, False, False, False, False]


def test_meets_for_sure_is_false_for_a_ball_that_barely_misses_a_flat_wall():
    """A ball at the waist, 2⁻³⁶ from a wall that rises so little that an error of the height moves it far aside."""
    count = 8
    away = 2.0 ** -np.arange(33.0, 33 + count)
    places = np.column_stack([1.25 + away, np.zeros(count), np.zeros(count)])
    shapes, spans = np.tile((1.0, 2.0**-10), (count, 1)), np.tile((-1.0, 5.0), (count, 1))
    assert not meets_for_sure(np.full(count, 0.25), shapes, spans, places, np.zeros(count)).any()


@pytest.mark.parametrize(("axis", "reach"), [(UPRIGHT, 0.5), ((1.0, 0.0, 0.0), 2.0), ((0.0, 1.0, 3.0), 2.0)])
def test_height_limits_are_widened_by_the_half_height_of_an_upright_disc_or_the_longer_semi_axis_of_a_tilted_one(
    axis, reach
):
    trunk = Hyperboloid("trunk", 5.0, 4.0, (0.0, 0.0, 10.0), Span(-3.0, 1.0))
    disc = Mover(2.0, 0.5, axis=axis)
    (limits,) = limits_of(scene_index.bodies_of([trunk]), disc)
    assert limits == pytest.approx([7 - reach, 11 + reach, 7 + reach, 11 - reach], abs=1e-9)
    assert limits[0] < 7 - reach < 11 + reach < limits[1]


@pytest.mark.parametrize("start", [4.0, 3.0, 0.0])
def test_a_sweep_whose_end_meets_a_wall_that_ends_is_proved_by_bounds_to_hit(start, by_numpy):
    """The numpy kernel leaves contact beside ends to bounds at five times of the sweep."""
    bodies = scene_index.bodies_of([Hyperboloid("tower", 2.0, 4.0, height=Span(0.0, 3.0))])
    by_numpy()
    starts, ends = np.array([(start, 0.0, 0.125)]), np.array([(2.125, 0.0, 0.125)])
    hits, undecided = bounded_hits(bodies, np.zeros(1, np.intp), np.array([(0.25, 0.25)]), starts, ends, None)
    assert (hits.tolist(), undecided.tolist()) == ([True], [False])
