"""Answers about a scene at its limits: heights, far centres, axes of any length, values that are no numbers, arrays."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.scene import model
from hypcheck.scene.model import Hyperboloid, Mover, Region, Span
from tests.kernel.test_scene_index import truth_about
from tests.support.inside import Scene

HILLS = (
    Hyperboloid("low", 0.5, 4.0, (0.0, 0.0, 0.0), Span(-1.0, 5.0)),
    Hyperboloid("high", 0.5, 4.0, (40.0, 0.0, 10.0), Span(-1.0, 5.0)),
)


def both(scene, centre):
    """What a batch and a step say, which is one."""
    answer = scene.classify(*centre)
    assert type(answer) is int
    assert scene.position(*centre) == answer
    assert scene.classify([centre]).tolist() == [answer]
    return answer


def test_scene_answers_exterior_far_from_every_tree_and_above_them():
    for region in (Region(), Region(z=Span(-2.0, 30.0)), Region(z=Span(0.0, 1.0))):
        scene = Scene(model.SceneModel("hills", "position", HILLS, Mover(0.3, 0.9), region))
        for x in (0.0, 20.0, 40.0, 1e9):
            assert both(scene, (x, 3.0, 12.0)) == 1
            assert both(scene, (x, 3.0, 2.0)) == 1
            assert both(scene, (x, 3.0, 7.0)) == 1
            assert both(scene, (x, 3.0, -1.5)) == 1
        assert both(scene, (0.0, 0.0, 12.0)) == 1
        assert both(scene, (0.6, 0.0, 5.0)) == 0
        assert both(scene, (0.6, 0.0, math.nextafter(5.0, 6.0))) == 0
        assert both(scene, (0.6, 0.0, 5.9)) == 1


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


@pytest.mark.parametrize(
    ("centre", "sentence"),
    [
        (("a", 0, 0), "x is 'a'; it must be a number"),
        ((0, 1j, 0), "y is 1j; it must be a number"),
        ((0, 0, [[1], [2, 3]]), r"z is \[\[1\], \[2, 3\]\]; it must be a number"),
        ((10**400, 0, 0), "x is (1000000|an integer too large for float64)"),
        (([0, 1], [0, 1, 2], 0), r"x \(2,\), y \(3,\), z \(1,\), heading \(1,\) have shapes that do not fit together"),
        ((0, 0, None), "z is not given"),
        (("1.5", 0, 0), "x is '1.5'; it must be a number"),
        ((0, b"1.5", 0), "y is b'1.5'; it must be a number"),
        ((True, 0, 0), "x is True; it must be a number"),
        ((0, 0, 0, math.inf), "heading is inf; it must be finite"),
        ((math.inf, 0, 0), "x is inf; it must be finite"),
    ],
)
def test_scene_position_refuses_an_invalid_centre_in_one_sentence(centre, sentence):
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    with pytest.raises(InputError, match=sentence):
        scene.classify(*centre)
    with pytest.raises(InputError, match="row 1: y is nan"):
        scene.classify(0, [0, math.nan], 0)
    if not any(isinstance(each, list) for each in centre):
        with pytest.raises(InputError, match=f"^{sentence}"):
            scene.position(*centre)


def test_scene_position_takes_every_type_of_number_and_arrays():
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    for one in (0, 0.0, np.float32(0), np.int64(0), np.array(0.0), np.array([0.0])):
        assert scene.position(one, 0, 0) == -1  # the mover is narrower than the waist
    points = np.array([[0.0, 0.0, 0.0], [0.0, 9.0, 0.0]])
    assert scene.position(points).tolist() == scene.position(*points.T).tolist() == [-1, 1]
    assert scene.position(0.0, [0.0, 9.0], 0.0).tolist() == [-1, 1]
    with pytest.raises(InputError, match=r"heading is of shape \(2,\); it must be a number \(classify takes arrays\)"):
        scene.position(1.0, 2.0, 0.0, [1.0, 2.0])


def test_scene_classify_takes_empty_arrays_and_arrays_of_any_layout():
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    assert scene.classify([], [], []).tolist() == []
    wide = np.arange(8.0)[::2]
    assert scene.classify(wide, 0, 0).tolist() == scene.classify(wide.astype(np.float32), [0.0], 0.0).tolist()


def test_a_scene_without_hyperboloids_raises_an_error():
    with pytest.raises(InputError, match="the scene has no hyperboloid"):
        Scene(replace(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)), hyperboloids=()))


def test_scene_position_of_many_centres_or_axes_is_that_of_classify():
    scene = Scene(model.SceneModel("s", "position", HILLS, Mover(0.3, 0.9)))
    assert scene.position(0.0, 0.0, [0.0, 1.0]).tolist() == scene.classify(0.0, 0.0, [0.0, 1.0]).tolist()
    free = Scene(replace(scene.model, mover=Mover(0.3, 0.9, axis=model.FREE)))
    axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    assert free.position(0.5, 0.0, 0.0, axis=axes).tolist() == free.classify(0.5, 0.0, 0.0, axis=axes).tolist()
    with pytest.raises(InputError, match="x is True; it must be a number"):
        scene.position(True, False, 0.0)
    with pytest.raises(InputError, match="x is an integer too large for float64"):
        scene.position(10**400, 10**400, 0.0)


def test_a_hyperboloid_outside_the_numbered_cells_of_the_grid_is_still_tested():
    far = 2.0**45
    bodies = [Hyperboloid("here", 1.0, 9.0), *(Hyperboloid(f"far {k}", 1.0, 9.0, (far, 8.0 * k, 0.0)) for k in (1, 2))]
    scene = Scene(model.SceneModel("s", "position", tuple(bodies), Mover(0.25, 0.25), model.Region(z=Span(-1.0, 1.0))))
    for k in (1, 2):
        assert both(scene, (far + 1.0, 8.0 * k, 0.0)) == 0
        assert scene.passage((far + 4.0, 8.0 * k, 0.0), (far, 8.0 * k, 0.0)).hit


def test_scene_position_beside_a_hyperboloid_farther_out_than_cells_are_numbered_is_contact():
    far = 2.0**45
    bodies = tuple(Hyperboloid(name, 1.0, 9.0, (x, 0.0, 0.0)) for name, x in (("here", 0.0), ("far", far)))
    scene = Scene(model.SceneModel("s", "position", bodies, Mover(0.25, 0.25), Region(z=Span(-1.0, 1.0))))
    assert scene.position(far + 1.0, 0.0, 0.0) == 0


@pytest.mark.parametrize("span", [None, Span(-1.0, 1.0)], ids=["without ends", "with ends"])
@pytest.mark.parametrize("length", [5e-324, 1e-308, 1e308])
def test_the_length_of_a_hyperboloids_axis_changes_no_position_and_raises_no_error(length, span):
    """The sum of three components of 1e308 is no float64, and a subnormal one has no precise reciprocal."""

    def answers(component):
        body = Hyperboloid("tilted", 1.0, 2.0, (0.0, 0.0, 0.0), height=span, axis=(component,) * 3)
        scene = Scene(model.SceneModel("length", "position", (body,), Mover(0.3, 0.9)))
        points = [(x, 0.3, z) for x in (0.1, 1.5, 5.0) for z in (0.0, 0.9, 3.0)]
        return [scene.position(*point) for point in points], scene.classify(*np.transpose(points)).tolist()

    one_by_one, together = answers(length)
    assert one_by_one == together
    assert (one_by_one, together) == answers(1.0)


def test_a_hyperboloid_whose_axis_has_components_of_very_different_sizes_ends_where_an_almost_parallel_one_does():
    """As whole numbers without a common factor its components are beyond float64."""

    def answers(axis):
        body = Hyperboloid("tilted", 1.0, 2.0, (0.0, 0.0, 0.0), height=Span(-1.0, 1.0), axis=axis)
        scene = Scene(model.SceneModel("sizes", "position", (body,), Mover(0.3, 0.9)))
        return [scene.position(x, y, 0.5) for x in (-2.5, -1.5, 0.1, 1.5) for y in (0.0, 0.8, 1.2)]

    assert answers((3.3e300, 3.9, 0.0)) == answers((1.0, 0.0, 0.0))
    assert answers((-3.3e300, -3.9, 0.0)) == answers((-1.0, 0.0, 0.0))
