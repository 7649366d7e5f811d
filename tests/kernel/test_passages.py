"""Many straight sweeps at once, of pairs and of scenes: hits, first times, and which hyperboloid."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import hypcheck
from hypcheck.errors import InputError
from tests.support.inside import passage

SIZES = (2.0, 17.8, 0.25, 0.15)
STARTS = np.array([[1.5, 0.0, 9.0], [0.0, 0.0, 30.0], [3.0, 0.0, 0.0], [5.0, 1.0, 0.0], [2.1, 0.0, 0.0]])
ENDS = np.array([[1.5, 0.0, -9.0], [5.0, 0.0, 30.0], [0.0, 0.0, 0.0], [5.0, -1.0, 2.0], [9.0, 0.0, 0.0]])


def alone(sizes, start, end, **more):
    return passage(sizes, start, end, **more)


@pytest.mark.parametrize(
    "more",
    [{}, {"axis": (0.3, 0.1, 0.9)}, {"z_min": -1.0, "z_max": 20.0}, {"z_min": -20.0, "z_max": 8.5, "solid": True}],
)
def test_many_sweeps_are_answered_as_the_exact_decision_about_each(more):
    found = hypcheck.passage(SIZES, STARTS, ENDS, **more)
    each = [alone(SIZES, start, end, **more) for start, end in zip(STARTS.tolist(), ENDS.tolist(), strict=True)]
    assert found.hit.tolist() == [sweep.hit for sweep in each]
    assert len({*found.hit.tolist()}) == 2
    assert found.first == [sweep.first for sweep in each]
    assert np.array_equal(found.first_lower, [sweep.first_lower for sweep in each], equal_nan=True)
    assert np.array_equal(found.first_upper, [sweep.first_upper for sweep in each], equal_nan=True)
    assert found.index.tolist() == [0 if sweep.hit else -1 for sweep in each]


def test_passage_gives_the_same_answers_for_every_form_of_the_same_sweeps():
    expected = [alone(SIZES, *sweep).hit for sweep in zip(STARTS.tolist(), ENDS.tolist(), strict=True)]
    names = dict(zip(("alpha", "gamma", "b", "d"), SIZES, strict=True))
    table = names | dict(zip(("x", "y", "z", "x1", "y1", "z1"), np.hstack([STARTS, ENDS]).T, strict=True))
    rows = np.hstack([np.tile(SIZES, (5, 1)), STARTS, ENDS])
    for sweeps in (
        (SIZES, STARTS, ENDS),
        (*SIZES, STARTS, ENDS.tolist()),
        (table,),
        (rows,),
        (np.hstack([rows, [[0, 0, 2]] * 5]),),
    ):
        assert hypcheck.passage(*sweeps).hit.tolist() == expected
    assert hypcheck.passage(SIZES, STARTS, ENDS, axis=[[0, 0, 1]] * 5).hit.tolist() == expected


def test_the_result_for_one_sweep_has_numbers_and_an_exact_time_instead_of_arrays():
    for sweep in ((SIZES, (3, 0, 0), (0, 0, 0)), (*SIZES, (3, 0, 0), (0, 0, 0))):
        found = hypcheck.passage(*sweep)
        assert found.hit is True
        assert found.first_lower <= 0.25 <= found.first_upper
        assert found.first_upper - found.first_lower < 1e-15
        assert found.index == 0
        assert isinstance(found.first[0], Fraction)
    clear = hypcheck.passage(SIZES, (9, 0, 0), (9, 9, 0))
    assert not clear.hit
    assert math.isnan(clear.first_lower)
    assert (clear.first, clear.index) == (None, -1)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((SIZES, STARTS), "2 arguments: passage takes .sizes, start, end., "),
        ((SIZES[:3], STARTS, ENDS), "the sizes are 3; they must be four"),
        ((SIZES, STARTS, ENDS[:2]), "have shapes that do not fit together"),
        ((SIZES, STARTS, ENDS * np.nan), "row 0: x1 is nan; it must be finite"),
        ((SIZES, STARTS[:, :2], ENDS), r"start is of shape \(5, 2\); it must be three numbers, x, y, z"),
    ],
)
def test_passage_refuses_arguments_that_do_not_describe_a_sweep(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        hypcheck.passage(*arguments)


@pytest.mark.parametrize("sweep", [((3, 0, 0), (0, 0, 0)), (STARTS, ENDS)], ids=["one", "many"])
def test_passage_refuses_z_min_that_is_not_less_than_z_max(sweep):
    with pytest.raises(InputError, match="z_min must be less than z_max"):
        hypcheck.passage(SIZES, *sweep, z_min=2.0, z_max=1.0)


def test_many_sweeps_with_an_axis_of_the_hyperboloid_are_refused():
    with pytest.raises(InputError, match="upward is given, and the sweeps are many; a scene has tilted hyperboloids"):
        hypcheck.passage(SIZES, STARTS, ENDS, upward=(0, 1, 1))


TREES = """
name = "two trees"
[[hyperboloid]]
name = "near"
alpha = 1
gamma = 3
center = [4, 0, 0]
height = [-5, 5]
[[hyperboloid]]
name = "far"
alpha = 1
gamma = 3
center = [12, 0, 0]
[mover]
b = 0.5
d = 0.5
"""


def test_a_scene_says_which_tree_is_hit_first_and_when():
    scene = hypcheck.Scene.from_text(TREES)
    one = scene.passage((0, 0, 0), (10, 0, 0))  # its wall is at 3: the mover touches at 2.5
    assert (one.hit, one.index) == (True, 0)
    assert one.first_lower <= 0.25 <= one.first_upper
    assert one.first_upper - one.first_lower < 1e-12
    back = scene.passage([(20, 0, 0), (20, 0, 0), (0, 9, 0)], [(0, 0, 0), (14, 0, 0), (10, 9, 0)])
    assert back.hit.tolist() == [True, False, False]
    assert back.index.tolist() == [1, -1, -1]
    assert back.first_lower[0] <= 6.5 / 20 <= back.first_upper[0]
    assert np.isnan(back.first_lower[1:]).all()
    above = scene.passage((4, 0, 9), (4, 0, 0))  # in through the mouth of an open tree
    assert not above.hit


def test_a_scene_with_parts_says_when_a_part_is_hit_first():
    parts = TREES + "[[mover.part]]\nb = 0.1\nd = 0.1\narm = 0.25\nangle = 0\n"
    scene = hypcheck.Scene.from_text(parts)
    found = scene.passage((0, 0, 0), (10, 0, 0))  # the part is at 0.25 ahead: it touches at 2.65
    assert found.hit
    assert found.first_lower <= 0.265 <= found.first_upper
    assert found.first_upper - found.first_lower < 1e-12


def test_one_sweep_given_as_arrays_or_by_name_has_the_same_result_as_one_given_as_numbers():
    expected = passage(SIZES, (3.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    named = dict(zip(("alpha", "gamma", "b", "d"), SIZES, strict=True))
    start, end = np.array([3.0, 0.0, 0.0]), np.zeros(3)
    for found in (
        hypcheck.passage(SIZES, start, end),
        hypcheck.passage(np.array(SIZES), start, end),
        hypcheck.passage(**named, start=start, end=end),
        hypcheck.passage(*SIZES, start=start, end=end),
        hypcheck.passage(SIZES, start=start, end=end),
    ):
        assert type(found) is type(expected)
        assert found == expected
