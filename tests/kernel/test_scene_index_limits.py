"""Answers about a scene at its limits: heights, far centres, values that are no numbers, arrays of every layout."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.kernel.scene import Scene
from hypcheck.kernel.scene_index import WIDEST, bodies_of, grid_of, levels_of, reaches
from hypcheck.scene import model
from hypcheck.scene.model import UPRIGHT, Hyperboloid, Mover, Region, Span
from tests.kernel.test_scene_index import truth_about

HILLS = (
    Hyperboloid("low", 0.5, 4.0, (0.0, 0.0, 0.0), Span(-1.0, 5.0)),
    Hyperboloid("high", 0.5, 4.0, (40.0, 0.0, 10.0), Span(-1.0, 5.0)),
)


def both(scene, centre):
    """What a batch and a step say, which is one."""
    (answer,) = scene.classify(*centre).tolist()
    assert scene.position(*centre) == answer
    return answer


def test_scene_answers_exterior_far_from_every_tree_at_a_modelled_height():
    """Whether the tree that is near, or none, is modelled at that height does not matter."""
    for region in (Region(), Region(z=Span(-2.0, 30.0)), Region(z=Span(0.0, 1.0))):
        scene = Scene(model.SceneModel("hills", "position", HILLS, Mover(0.3, 0.9), region))
        for x in (0.0, 20.0, 40.0, 1e9):
            assert both(scene, (x, 3.0, 12.0)) == 1
            assert both(scene, (x, 3.0, 2.0)) == 1
            assert both(scene, (x, 3.0, 7.0)) == 2
            assert both(scene, (x, 3.0, -1.5)) == 2
        assert both(scene, (0.0, 0.0, 12.0)) == 1
        assert both(scene, (0.6, 0.0, 5.0)) == 0
        assert both(scene, (0.6, 0.0, math.nextafter(5.0, 6.0))) == 2


def test_the_modelled_height_of_a_tree_ends_at_the_exact_sum_of_its_base_and_height():
    draw = random.Random(4)  # noqa: S311 - nothing is secret
    trees = [
        Hyperboloid(
            str(k), 1.0, 1.0, (0, 0, draw.uniform(-1, 1) * 10 ** draw.uniform(-9, 9)), Span(-1.0, draw.random())
        )
        for k in range(200)
    ]
    for tree, (low, high) in zip(trees, bodies_of(trees).heights.tolist(), strict=True):
        bottom, top = (Fraction(tree.center[2]) + Fraction(end) for end in (tree.height.low, tree.height.high))
        assert math.nextafter(low, -math.inf) < bottom <= low
        assert high <= top < math.nextafter(high, math.inf)


def test_levels_of_gives_the_union_of_the_modelled_heights():
    draw = np.random.default_rng(2)
    spans = np.sort(draw.integers(0, 60, (12, 2)).astype(float), axis=1)
    levels = levels_of(spans)
    points = np.arange(-1, 62, 0.5)
    wanted = ((points[:, None] >= spans[:, 0]) & (points[:, None] <= spans[:, 1])).any(axis=1)
    assert [levels.hold(z) for z in points.tolist()] == wanted.tolist() == levels.hold_each(points).tolist()


def test_scene_answers_are_exact_if_a_difference_of_centres_overflows():
    far = Hyperboloid("far", 1.0, 2.0, (1e308, 0.0, -1e308))
    vast = Hyperboloid("vast", 1e308, 1e300, (-1.5e308, 0.0, 0.0))
    for body in (far, vast):
        scene = model.SceneModel("s", "position", (body,), Mover(1.0, 1.0))
        for centre in ((-1e308, 0.0, 1e308), (1.7e308, -1e308, 0.0), (-5e307, 0.0, 0.0)):
            assert both(Scene(scene), centre) == truth_about(body, scene.mover, centre)


def test_scene_answers_are_exact_for_the_smallest_subnormal_lengths():
    tiny = 5e-324
    body = Hyperboloid("tiny", tiny, tiny)
    for region in (Region(z=Span(-1, 1)), Region(z=Span(0, 0))):  # all are asked; cells of a grid are tiny
        scene = model.SceneModel("s", "position", (body,), Mover(tiny, tiny), region)
        for x in (0.0, tiny, 2 * tiny, 3 * tiny, 4 * tiny, 1.0, 1e308):
            for centre in ((x, 0.0, 0.0), (0.0, x, 0.0)):
                assert both(Scene(scene), centre) == truth_about(body, scene.mover, centre)


def test_the_grid_finds_the_same_hyperboloids_for_one_centre_as_for_a_batch():
    draw = np.random.default_rng(3)
    x, y = draw.uniform(-50, 50, (2, 300))
    reaches = np.where(draw.random(300) < 0.02, np.inf, draw.uniform(0.1, 3, 300))
    grid = grid_of(x, y, reaches)
    px, py = draw.uniform(-60, 60, (2, 200))
    px[:3] = 1e300, -1e300, 4.0 * WIDEST * grid.side
    query, member = grid.near_each(px, py)
    for place in range(200):
        step = sorted(grid.near(float(px[place]), float(py[place])))
        assert step == sorted(member[query == place].tolist())
        touched = np.flatnonzero(np.hypot(x - px[place], y - py[place]) <= reaches)
        assert set(touched.tolist()) <= set(step)


def test_scene_classify_outside_the_region_asks_only_hyperboloids_within_reach():
    count = 20_000
    trees = tuple(Hyperboloid(str(k), 0.4, 8.0, (5.0 * (k % 200), 5.0 * (k // 200), 0.0)) for k in range(count))
    scene = Scene(model.SceneModel("f", "contact", trees, Mover(0.3, 0.9), Region(z=Span(0.0, 0.0))))
    x, y = np.arange(40.0) + 0.5, np.full(40, 5.0)
    (pairs,) = {len(scene._pairs(np.stack([x, y, np.full(40, 0.5)], axis=1))[0])}
    assert pairs < 40 * 4
    assert scene.classify(x, y, 0.5).tolist() == [int(k % 5 in (0, 4)) for k in range(40)]


@pytest.mark.parametrize(
    ("centre", "sentence"),
    [
        (("a", 0, 0), "x is 'a'; it must be a number"),
        ((0, 1j, 0), "y is 1j; it must be a number"),
        ((0, 0, [[1], [2, 3]]), r"z is \[\[1\], \[2, 3\]\]; it must be a number"),
        ((10**400, 0, 0), "x is (1000000|an integer too large for float64)"),
        (([0, 1], [0, 1, 2], 0), r"x \(2,\), y \(3,\), z \(1,\), heading \(1,\) have shapes that do not fit together"),
        ((0, 0, None), "z is None; it must be a number"),
        (("1.5", 0, 0), "x is '1.5'; it must be a number"),
        ((0, b"1.5", 0), "y is b'1.5'; it must be a number"),
        ((True, 0, 0), "x is True; it must be a number"),
        ((0, 0, 0, math.inf), "heading is inf; it must be finite"),
    ],
)
def test_scene_position_refuses_an_invalid_centre_in_one_sentence(centre, sentence):
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    with pytest.raises(InputError, match=sentence):
        scene.classify(*centre)
    if not any(isinstance(each, list) for each in centre):
        with pytest.raises(InputError, match=f"^{sentence}"):
            scene.position(*centre)


def test_scene_position_takes_every_type_of_number_and_refuses_arrays_of_several():
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    for one in (0, 0.0, np.float32(0), np.int64(0), np.array(0.0), np.array([0.0])):
        assert scene.position(one, 0, 0) == -1  # the mover is narrower than the waist
    with pytest.raises(InputError, match=r"x is of shape \(2,\); it must be a number \(classify takes arrays\)"):
        scene.position(np.array([1.0, 2.0]), 0, 0)


def test_scene_classify_takes_empty_arrays_and_arrays_of_any_layout():
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    assert scene.classify([], [], []).tolist() == []
    wide = np.arange(8.0)[::2]
    assert scene.classify(wide, 0, 0).tolist() == scene.classify(wide.astype(np.float32), [0.0], 0.0).tolist()


def test_a_scene_without_hyperboloids_raises_an_error():
    with pytest.raises(InputError, match="the scene has no hyperboloid"):
        Scene(replace(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)), hyperboloids=()))


def test_levels_of_are_disjoint_where_spans_touch_or_overlap():
    spans = np.array([(0.0, 1.0), (1.0, 2.0), (5.0, 7.0), (6.0, 8.0), (9.0, 9.0)])
    levels = levels_of(spans)
    assert (levels.starts, levels.ends) == ([0.0, 5.0, 9.0], [2.0, 8.0, 9.0])


def test_a_hyperboloid_whose_axis_points_down_has_its_modelled_heights_turned():
    bodies = bodies_of([Hyperboloid("h", 1.0, 1.0, (0.0, 0.0, 8.0), Span(-1.0, 5.0), axis=(0.0, 0.0, -2.0))])
    assert bodies.heights.tolist() == [[3.0, 9.0]]
    assert bodies.spans.tolist() == [[-5.0, 1.0]]
    assert not bodies.leaning.any()


def test_a_hyperboloid_over_more_than_64_cells_is_kept_aside():
    """The median reach of 1/2 makes cells of side 1."""
    x, y = np.full(5, 0.5), np.full(5, 0.5)
    for reach, cells in ((3.25, 49), (4.25, 81)):  # 7 × 7, 9 × 9
        grid = grid_of(x, y, np.array([0.5, 0.5, 0.5, 0.5, reach]))
        assert grid.side == 1
        assert grid.everywhere == ([4] if cells > 64 else [])


@pytest.mark.parametrize(
    ("mover", "axis", "height", "expected"),
    [
        (Mover(0.5, 2.0), UPRIGHT, None, 3 * math.sqrt(1 + (10 / 4) ** 2) + 0.5),  # as tall as 8, and d
        (Mover(0.5, 2.0), UPRIGHT, Span(0.0, 1.0), 3 * math.sqrt(1 + (8 / 4) ** 2) + 0.5),  # 6 above its centre
        (Mover(0.5, 2.0, axis=(1.0, 0.0, 1.0)), UPRIGHT, None, 3 * math.sqrt(1 + (10 / 4) ** 2) + 2),
        (Mover(0.5, 2.0), (1.0, 0.0, 1.0), None, math.hypot(8, 3 * math.sqrt(1 + (10 / 4) ** 2) + 2)),
    ],
)
def test_the_reach_is_the_radius_at_the_mover_s_farther_end_and_its_width(mover, axis, height, expected):
    bodies = bodies_of([Hyperboloid("h", 3.0, 4.0, (0.0, 0.0, -5.0), Span(-8.0, 8.0), axis=axis)])
    assert reaches(bodies, mover, height) == pytest.approx(expected, rel=2.0**-37)
