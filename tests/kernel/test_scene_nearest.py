"""Scene.nearest: the least of the pairs' distances, ties, ends of trees, and what is refused."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hypcheck import Scene, clearance, passage
from hypcheck.errors import InputError
from hypcheck.kernel import scene_gaps, scene_nearest
from hypcheck.scene.model import Hyperboloid, Mover, SceneModel, Span
from tests.support.inside import scene_index

MOVER = Mover(0.3, 0.2)


def scene(*bodies, mover=MOVER):
    return Scene(SceneModel("trees", "position", bodies, mover))


def forest(height=None):
    rng = np.random.default_rng(3)
    return [
        Hyperboloid(
            f"tree {k}", *rng.uniform((0.2, 2), (1, 6)).tolist(), (*rng.uniform(-20, 20, 2).tolist(), 0.5), height
        )
        for k in range(30)
    ]


def test_scene_nearest_gives_the_least_distance_of_all_pairs():
    trees = forest()
    x, y, z = np.random.default_rng(4).uniform((-20, -20, -3), (20, 20, 3), (50, 3)).T
    found = scene(*trees).nearest(x, y, z)
    rows = [[t.alpha, t.gamma, 0.3, 0.2, *(np.array(c) - t.center)] for c in zip(x, y, z, strict=True) for t in trees]
    said = clearance(rows)
    lower, upper = (each.reshape(50, 30) for each in (said.distance_lower, said.distance_upper))
    assert np.allclose(found.distance_upper, upper.min(axis=1), rtol=0, atol=1e-10)
    assert np.allclose(found.distance_lower, lower.min(axis=1), rtol=0, atol=1e-10)
    apart = ~found.tied
    assert (found.index[apart] == upper.argmin(axis=1)[apart]).all()
    assert (found.tied == ((lower <= upper.min(axis=1, keepdims=True) + 1e-9).sum(axis=1) > 1)).all()
    assert apart.sum() > 40


def test_scene_nearest_marks_hyperboloids_at_equal_distance_as_tied():
    two = scene(Hyperboloid("a", 0.5, 4.0, (-3, 0, 0)), Hyperboloid("b", 0.5, 4.0, (3, 0, 0)))
    found = two.nearest([0, 0.5], 0, 0)
    assert found.tied.tolist() == [True, False]
    assert found.index[1] == 1
    assert found.distance_lower[1] <= 2.5 - 0.5 - 0.3 <= found.distance_upper[1]
    assert np.allclose(found.point[1], (2.5, 0, 0), atol=1e-8)


@pytest.mark.parametrize("gamma", [1e3, 1e8])
def test_distance_bounds_are_narrow_beside_a_steep_wall_too(gamma):
    found = scene(Hyperboloid("tower", 2.0, gamma), mover=Mover(0.5, 0.5)).nearest(4.0, 0, 0)
    assert found.distance_upper * (1 - 1e-9) <= found.distance_lower <= 1.5 <= found.distance_upper


@pytest.mark.parametrize("height", [None, Span(-0.8, 5.4)])
def test_scene_nearest_bounds_the_distance_closely_where_two_points_beside_the_plane_of_symmetry_are_nearest(height):
    wall = Hyperboloid("tower", 3.4, 3.5, height=height)
    found = scene(wall, mover=Mover(0.08, 0.8, axis=(1.0, 0.0, 0.0))).nearest(0.0, 1.27, 0.38)
    assert 0 < found.distance_upper - found.distance_lower < 1e-9
    offset = found.point + found.distance_upper * found.normal - (0.0, 1.27, 0.38)
    assert abs(np.hypot(offset[0] / 0.8, np.hypot(*offset[1:]) / 0.08) - 1) < 1e-6
    assert abs(found.point[0]) > 1


@pytest.mark.parametrize("number", range(6))
def test_the_distance_above_the_end_of_a_tree_is_that_to_the_end(number):
    rng = np.random.default_rng(number)
    tree = Hyperboloid("stump", 0.5, 2.0, (1, 2, 0.5), Span(-0.5, 1.5))
    centre = np.array((1, 2, 2.0)) + rng.uniform((-3, -3, 1), (3, 3, 4))
    found = scene(tree).nearest(*centre)
    z, angle = np.meshgrid(np.linspace(0, 2, 60), np.linspace(0, 2 * np.pi, 400))
    radius = 0.5 * np.sqrt(1 + ((z - 0.5) / 2) ** 2)
    way = np.stack([1 + radius * np.cos(angle), 2 + radius * np.sin(angle), z], axis=-1) - centre
    least = np.sqrt((way**2).sum(axis=-1)).min()
    assert found.distance_lower <= least - 0.2 + 1e-9
    assert found.distance_upper >= least - 0.3 - 1e-3
    assert 0 <= found.point[2] <= 2 + 1e-12


def test_scene_nearest_finds_the_nearest_of_trees_with_limited_heights():
    trees = forest(Span(-0.5, 4.0))[:12]
    x, y, z = np.random.default_rng(5).uniform((-20, -20, 0), (20, 20, 4), (40, 3)).T
    found = scene(*trees).nearest(x, y, z)
    for k, tree in enumerate(trees):
        one = scene(tree).nearest(x, y, z)
        assert (found.distance_lower <= one.distance_lower + 1e-9).all()
        assert (found.distance_upper <= one.distance_upper + 1e-9).all()
        same = found.index == k
        assert np.allclose(found.distance_upper[same], one.distance_upper[same], rtol=0, atol=1e-9)


def rotation(rng):
    """A rotation of space, the more usual ones among all."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


@pytest.mark.parametrize("height", [None, Span(-0.5, 4.0)])
@pytest.mark.parametrize("number", range(2))
def test_scene_nearest_of_a_turned_scene_is_the_turned_nearest(number, height):
    rng = np.random.default_rng(100 + number)
    turn, trees = rotation(rng), forest(height)[:12]
    tilted = [
        Hyperboloid(t.name, t.alpha, t.gamma, tuple((turn @ t.center).tolist()), height, tuple(turn[:, 2].tolist()))
        for t in trees
    ]
    centres = rng.uniform((-20, -20, -3), (20, 20, 6), (60, 3))
    before = scene(*trees).nearest(*centres.T)
    fixed = scene(*tilted, mover=Mover(0.3, 0.2, axis=tuple(turn[:, 2].tolist())))
    free = scene(*tilted, mover=Mover(0.3, 0.2, axis="free"))
    for after in (
        fixed.nearest(*(centres @ turn.T).T),
        free.nearest(*(centres @ turn.T).T, axis=np.tile(turn[:, 2], (60, 1))),
        free.nearest(*(centres @ turn.T).T, axis=-3 * turn[:, 2]),
    ):
        assert np.allclose(after.distance_upper, before.distance_upper, rtol=0, atol=1e-9)
        assert np.allclose(after.distance_lower, before.distance_lower, rtol=0, atol=1e-9)
        same = ~before.tied & ~after.tied & (before.distance_lower > 0)
        assert same.sum() > 40
        assert (after.index[same] == before.index[same]).all()
        if height is None:
            assert np.allclose(after.point[same], before.point[same] @ turn.T, rtol=0, atol=1e-6)


@pytest.mark.parametrize("number", range(3))
def test_scene_nearest_is_0_beside_a_tilted_hyperboloid_exactly_where_position_is_contact(number):
    rng = np.random.default_rng(number)
    bodies = [Hyperboloid("a", 0.5, 2.0, (0, 0, 0), None, (1, 2, 4)), Hyperboloid("b", 0.4, 1.0, (2, 0, 1))]
    both = scene(*bodies, mover=Mover(0.5, 0.25, axis="free"))
    x, y, z = rng.uniform(-3, 3, (3, 300))
    axes = rng.normal(size=(300, 3))
    found, said = both.nearest(x, y, z, axis=axes), both.classify(x, y, z, axis=axes)
    assert ((found.distance_upper == 0) == (said == 0)).all()
    assert 10 < (said == 0).sum() < 290
    apart = said != 0
    assert (found.distance_lower <= found.distance_upper).all()
    assert (found.distance_upper[apart] - found.distance_lower[apart] < 1e-9).all()


def test_scene_nearest_refuses_a_missing_or_superfluous_axis_and_invalid_centres():
    free = scene(Hyperboloid("a", 1, 1), mover=Mover(1, 2, (), "free"))
    with pytest.raises(InputError, match="no axis is given, and the scene leaves the mover's free"):
        free.nearest(0, 0, 0)
    with pytest.raises(InputError, match="row 0: axis_x, axis_y, axis_z are 0, 0, 0"):
        free.nearest(0, 0, 0, axis=(0, 0, 0))
    with pytest.raises(InputError, match="axis is given, but the scene fixes it"):
        scene(Hyperboloid("a", 1, 1)).nearest(0, 0, 0, axis=(0, 0, 1))
    with pytest.raises(InputError, match="row 1: y is nan"):
        scene(Hyperboloid("a", 1, 1)).nearest(0, [0, np.nan], 0)


def test_the_nearest_point_at_the_end_of_a_tree_is_on_its_surface_and_at_the_upper_distance():
    tree = Hyperboloid("stump", 0.5, 2.0, (1, 2, 0.5), Span(-0.5, 1.5))
    centres = np.random.default_rng(6).uniform((-2, -1, 2.5), (4, 5, 5), (30, 3))
    found = scene(tree, mover=Mover(0.3, 0.3)).nearest(*centres.T)
    beside = found.point - tree.center
    assert np.allclose(np.hypot(*beside[:, :2].T), 0.5 * np.sqrt(1 + (beside[:, 2] / 2) ** 2), rtol=1e-13, atol=0)
    assert np.allclose(found.distance_upper, np.linalg.norm(found.point - centres, axis=1) - 0.3, rtol=0, atol=1e-9)


def test_the_cylinder_about_a_tree_bounds_the_distance_from_below():
    """Of radius √2/2 from −1 to 1, or without end; the mover's longer semi-axis is 0.3.

    A bound that is too low asks about more trees, and shows in no answer.
    """
    bodies = scene_index.bodies_of([Hyperboloid("a", 0.5, 1.0, (0, 0, 0), Span(-1, 1)), Hyperboloid("b", 0.5, 1.0)])
    centres = np.array([[3.0, 4.0, 0.0], [1.2, 0.0, 0.5], [0.1, 0.0, 4.0], [0.1, 0.0, 0.5], [0.5**0.5 + 3, 0.0, 5.0]])
    expected = [5 - 0.5**0.5 - 0.3, 1.2 - 0.5**0.5 - 0.3, 3 - 0.3, 0, 5 - 0.3]
    found = scene_nearest.cylinder_bounds(bodies, slice(None), MOVER, centres.T[:, :, None])
    assert np.allclose(found[:, 0], expected, rtol=0, atol=1e-10)
    assert (found[:, 0] <= expected).all()
    assert not found[:, 1].any()


@pytest.mark.parametrize("mover", [Mover(0.5, 0.5), Mover(0.5, 0.5, axis=(0.3, -0.2, 1.0)), Mover(0.5, 0.2)])
@settings(max_examples=20)
@given(
    origin=st.floats(-100, 100),
    alpha=st.floats(0.1, 10),
    ulps=st.integers(-4, 4),
    side=st.sampled_from([-1, 1]),
)
def test_distance_beside_a_wide_waist_is_0_only_in_contact_and_its_interval_contains_the_exact_gap(
    mover, origin, alpha, ulps, side
):
    """A mover at the height of a wide waist touches it at its pole: the gap is a difference that rationals know."""
    x = origin + side * (alpha + mover.b)
    for _ in range(abs(ulps)):
        x = float(np.nextafter(x, np.inf if ulps > 0 else -np.inf))
    gap = abs(Fraction(x) - Fraction(origin)) - Fraction(alpha) - Fraction(mover.b)
    tree = scene(Hyperboloid("tree", alpha, 4 * alpha, (origin, 0.0, 0.0)), mover=mover)
    found = tree.nearest(x, 0.0, 0.0)
    assert tree.position(x, 0.0, 0.0) == (1 if gap > 0 else 0)
    assert (found.distance_upper == 0) == found.contact == (gap <= 0)
    assert Fraction(found.distance_lower) <= max(gap, 0) <= Fraction(found.distance_upper)


def sampled_distance(alpha, gamma, span, r, z):
    """From a point at radius r and height z to the surface within the span of heights, by many of its points."""
    away = np.geomspace(1e-13, 8, 20_001)
    height = np.concatenate([np.linspace(*span, 20_001), away, -away])
    height = height[(height >= span[0]) & (height <= span[1])]
    return float(np.hypot(r - alpha * np.hypot(1, height / gamma), z - height).min())


@pytest.mark.parametrize("exponent", [-1000, -400, 0, 560])
def test_scene_nearest_bounds_the_distance_from_a_wall_that_ends_at_any_magnitude_of_lengths(exponent):
    """Squares of such lengths leave float64; the same numbers about 1 say what is right."""
    draw = random.Random(exponent)  # noqa: S311
    for _ in range(8):
        alpha, gamma = draw.uniform(0.3, 3), draw.choice([draw.uniform(0.3, 5), 2.0 ** -draw.randint(3, 20)])
        low, above, radius = draw.uniform(-3, 1), draw.uniform(0, 3), draw.uniform(0.2, 2)
        x, z, level = draw.uniform(0, 8), draw.uniform(-6, 6), draw.choice([0.0, draw.uniform(-5, 5)])
        sizes = [
            float(np.ldexp(each, exponent)) for each in (alpha, gamma, radius, low, low + above, level, x, level + z)
        ]
        a, c, r, bottom, top, up, across, height = sizes
        true = max(sampled_distance(alpha, gamma, (low, low + above), x, z) - radius, 0)
        for axis in ((0.0, 0.0, 1.0), (1.0, 2.0, 3.0)):
            tree = Hyperboloid("tree", a, c, (0.0, 0.0, up), Span(bottom, top))
            found = scene(tree, mover=Mover(r, r, (), axis)).nearest(across, 0.0, height)
            least, most = (np.ldexp(each, -exponent) for each in (found.distance_lower, found.distance_upper))
            slack = 1e-3 * true + 1e-9 * (1 + alpha / gamma)
            assert least <= true + slack
            assert most >= true - slack
            assert np.isfinite(most)


def test_scene_nearest_of_centres_whose_difference_overflows_is_bounded_by_0_and_inf():
    largest = 1.7976931348623157e308
    found = scene(Hyperboloid("tree", 1.0, 4.0, (-largest, 0.0, 0.0))).nearest([largest, 1 - largest], 0.0, 0.0)
    assert found.index.tolist() == [0, 0]
    assert found.distance_lower.tolist() == [0, 0]
    assert found.distance_upper[0] == np.inf


_STEPS = st.tuples(*[st.integers(-2, 2)] * 3)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.3, -0.2, 1.0)])
@settings(max_examples=15)
@given(st.tuples(*[st.floats(-4, 4)] * 3), st.floats(0, 6.3), st.floats(-2, 2), st.integers(-1030, 1000), _STEPS)
def test_position_nearest_and_passage_agree_about_contact_a_few_floats_from_the_surface(
    axis, at, turn, z, exponent, ulps
):
    """Centres on both sides of the last that is in contact on a ray, and a few floats beside them."""
    alpha, gamma, b, d, *at = (float(np.ldexp(each, exponent)) for each in (1.0, 3.0, 0.7, 1.2, *at))
    tree = scene(Hyperboloid("tree", alpha, gamma, tuple(at)), mover=Mover(b, d, (), axis))

    def place(distance):
        way = (distance * np.cos(turn), distance * np.sin(turn), z)
        return [float(each + np.ldexp(step, exponent)) for each, step in zip(at, way, strict=True)]

    inner, outer = 1.0, 6.0
    for _ in range(60):
        middle = (inner + outer) / 2
        inner, outer = (middle, outer) if tree.position(*place(middle)) == 0 else (inner, middle)
    centres = np.array([place(inner), place(outer)])
    for column, number in enumerate(ulps):
        for _ in range(abs(number)):
            centres[:, column] = np.nextafter(centres[:, column], np.inf * number)
    position, found = tree.classify(*centres.T), tree.nearest(*centres.T)
    assert position.tolist() == [tree.position(*centre) for centre in centres.tolist()]
    assert ((found.distance_upper == 0) == (position == 0)).all()
    assert (found.distance_lower <= found.distance_upper).all()
    assert (tree.passage(centres, centres).hit == (position == 0)).all()


@pytest.mark.parametrize("solid", [False, True])
def test_the_normal_is_the_gradient_of_the_distance_wherever_bodies_are_tilted_and_end(solid):
    """By differences of distances, which know nothing of normals; a sum of proved bounds is good to 1e-8."""
    bodies = (
        Hyperboloid("a", 2.0, 5.0, (0, 0, 0), Span(-np.inf, 3.0), (0.2, 0.1, 1.0), solid),
        Hyperboloid("b", 1.0, 3.0, (9, 0, 0), None, (0.0, 0.0, 1.0)),
    )
    asked = scene(*bodies, mover=Mover(0.25, 0.6, axis=(1.0, 0.3, 0.2)))
    points, step = np.random.default_rng(7).normal(size=(30, 3)) * 6, 1e-4
    found = asked.nearest(points)
    sides = [[asked.nearest(points + sign * step * way).distance_upper for sign in (1, -1)] for way in np.eye(3)]
    gradient = np.stack([(ahead - behind) / (2 * step) for ahead, behind in sides], axis=1)
    clear = ~found.contact
    assert 15 < clear.sum() < 30
    assert np.isnan(found.normal[~clear]).all()
    assert np.abs(found.normal - gradient)[clear].max() < 1e-5
    one = asked.nearest(points[np.argmax(clear)])
    assert (one.contact, one.index) == (False, found.index[np.argmax(clear)])
    assert one.normal == pytest.approx(found.normal[np.argmax(clear)], abs=1e-12)


def test_the_upper_distance_bound_from_a_far_rim_covers_the_roundings_of_the_rim():
    rng = np.random.default_rng(4)
    for _ in range(40):
        alpha, gamma, b, end = rng.uniform(0.01, 2), 10 ** rng.uniform(-11, -1), 10 ** rng.uniform(-6, 0), -100.0
        center = (rng.uniform(-1, 1) * alpha / gamma, rng.uniform(-1, 1), end + rng.uniform(1, 200))
        wall = Hyperboloid("flat", alpha, gamma, height=Span(-np.inf, end))
        found = scene(wall, mover=Mover(b, b, axis=(1.0, 2.0, 3.0))).nearest(*center)
        radius = Fraction(b) + Fraction(found.distance_upper)
        assert passage((alpha, gamma, radius, radius), center, center, z_max=end).hit


@pytest.mark.parametrize("place", [(0.9, 0.7), (-0.9, 0.7), (0.3, -1.1), (0.0, 1.15), (2.0, -2.5)])
def test_the_gap_to_a_wall_between_two_heights_is_the_least_of_a_dense_sample(place):
    """The wall bends within one of the first cells, which are coarse, towards a ball inside."""
    heights = np.linspace(-0.5, 40.0, 400_001)
    for z in (-0.25, 0.0, 0.05, 0.5, 1.5):
        sizes, spans = np.array([(1.5, 0.75, 0.125, 0.125)]), np.array([(-0.5, 40.0)])
        found = scene_gaps.gaps(
            sizes, np.array([(*place, z)]), None, spans, np.zeros(1, np.bool_), np.full(1, 100.0)
        )  # fmt: skip
        least = np.hypot(1.5 * np.hypot(1, heights / 0.75) - np.hypot(*place), heights - z).min() - 0.125
        least = max(least, 0.0)
        assert least - 1e-7 <= found.upper[0] <= least + 1e-12
        assert found.upper[0] - 1e-11 <= found.lower[0] <= found.upper[0]


def test_the_distance_bounds_beside_a_very_wide_wall_are_narrow_relative_to_distance_and_mover():
    """The coordinates of a mover beside the wall are long, as the wall is wide, and its distance is not."""
    b = 0.61071
    found = scene(Hyperboloid("wide", 147.62, 0.108084), mover=Mover(b, 0.0035413)).nearest(140.696, 0.0, 0.99996)
    assert not found.contact
    assert found.distance_upper - found.distance_lower <= 2.0**-27 * (found.distance_upper + b)


@pytest.mark.parametrize(("b", "d"), [(0.5, 0.25), (0.25, 0.75), (3.0, 1.0)])
def test_the_gap_from_a_tilted_spheroid_to_a_flat_end_is_that_of_its_lowest_point(b, d):
    """With the axis v that point is √(b² (1 − v_z²) + d² v_z²) below the centre, and that divides its way aside."""
    axes = np.array([(3.0, 0.0, 4.0), (4.0, 0.0, 3.0), (0.0, 3.0, 4.0)]) / 5
    sizes, centres, spans = (np.tile(row, (3, 1)) for row in ((9.0, 40.0, b, d), (0.5, 0.25, 7.0), (-2.0, 3.0)))
    found = scene_gaps.gaps(sizes, centres, axes, spans, np.ones(3, np.bool_), np.full(3, 50.0))
    deep = np.sqrt(b * b * (1 - axes[:, 2] ** 2) + d * d * axes[:, 2] ** 2)
    aside = ((b * b - d * d) * axes[:, 2] / deep)[:, None] * axes[:, :2]
    assert found.upper == pytest.approx(4 - deep, rel=1e-12)
    assert found.lower == pytest.approx(4 - deep, rel=1e-12)
    assert (found.lower <= found.upper).all()
    assert found.point == pytest.approx(np.column_stack([centres[:, :2] + aside, np.full(3, 3.0)]), rel=1e-12)


def test_the_bounds_of_the_distance_to_a_rim_far_wider_than_all_other_lengths_cover_its_roundings():
    """A ball about the origin: the rim at the lower end is the nearest, α√(1 + w²) from the axis, w above the ball."""
    rng = np.random.default_rng(1)
    alpha, low = 2.0**20 * rng.uniform(1, 2, (2, 16))
    sizes, spans = np.column_stack([alpha, np.ones((16, 3))]), np.column_stack([low, 2 * low])
    found = scene_gaps.gaps(sizes, np.zeros((16, 3)), None, spans, np.zeros(16, np.bool_), np.full(16, 2.0**50))
    for row in range(16):
        a, w = Fraction(alpha[row].item()), Fraction(low[row].item())
        squared = a * a * (1 + w * w) + w * w
        assert (Fraction(found.lower[row].item()) + 1) ** 2 <= squared
        assert (Fraction(found.upper[row].item()) + 1) ** 2 >= squared * (1 - Fraction(1, 2**50))
