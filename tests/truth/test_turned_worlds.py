"""Both bodies turned together keep their position, decided where the hyperboloid leans too; by rational rotations."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck import classify, passage
from hypcheck.geometry.pair import Lengths
from hypcheck.scene.model import Hyperboloid, Mover, Region, SceneModel, Span
from hypcheck.vectors.frozen import load
from tests.support.corpus import expected, questions
from tests.support.inside import Scene
from tests.support.inside import position as exact_position

TURNS = {
    "a cycle of the axes": np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]),
    "upside down": np.diag([1, -1, -1]),
    "thirds": np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]),
    "sevenths": np.array([[2, -6, 3], [3, -2, -6], [6, 3, 2]]),
}
"""Whole multiples of rotations: a row is as long as the first one."""

ROWS = [case for case in load("tilted-small-integers").cases if all(float(x).is_integer() for x in case.row)][:60]


def turned(turn, row):
    """Sizes, the centre and both axes, turned and as much longer as the matrix says."""
    scale = round(float(np.sqrt((turn[0] ** 2).sum())))
    place, axis = (turn @ np.array(part) for part in (row[4:7], row[7:10]))
    return [scale * size for size in row[:4]], place.tolist(), axis.tolist(), turn[:, 2].tolist()


def scene_of(sizes, axis, upward):
    alpha, gamma, b, d = sizes
    tree = Hyperboloid("tree", alpha, gamma, (0.0, 0.0, 0.0), axis=tuple(map(float, upward)))
    mover = Mover(b, d, axis=tuple(map(float, axis)))
    return Scene(SceneModel("turned", "position", (tree,), mover, Region(z=Span(-1e6, 1e6))))


@pytest.mark.parametrize("name", TURNS)
def test_a_turned_scene_has_the_position_of_the_frozen_label_of_the_unturned_pair(name):
    assert len(ROWS) == 60
    for case in ROWS:
        sizes, place, axis, upward = turned(TURNS[name], case.row)
        assert scene_of(sizes, axis, upward).position(*map(float, place)) == case.position


@pytest.mark.parametrize("name", TURNS)
def test_passage_of_a_turned_pair_hits_if_the_passage_of_the_unturned_pair_does(name):
    for case in ROWS[:20]:
        sizes, place, axis, upward = turned(TURNS[name], case.row)
        still = passage(sizes, place, place, axis, upward)
        assert still.hit == (case.position == 0)
        away = [Fraction(part) * 3 for part in place]
        row = [*map(Fraction, case.row[:4]), *map(Fraction, case.row[4:7])]
        straight = passage(row[:4], row[4:7], [3 * part for part in row[4:7]], list(case.row[7:10]))
        assert passage(sizes, place, away, axis, upward).hit == straight.hit


def test_axes_that_lie_across_the_hyperboloids_are_parallel_only_if_their_cross_product_is_0():
    """A long spheroid that leans by 18° meets the wall, whose slope is 14°, and a parallel one does not."""
    sizes, here, upward = (1.0, 4.0, 0.25, 8.0), (0.0, 0.0, 0.0), (1.0, 2.0, 0.0)
    for axis, position in (((1.0, 2.0, 0.0), -1), ((1.0, 1.0, 0.0), 0), ((-2.0, -4.0, 0.0), -1)):
        assert scene_of(sizes, axis, upward).position(*here) == position
        assert passage(sizes, here, here, axis, upward).hit == (position == 0)


@pytest.mark.parametrize("name", TURNS)
def test_passage_measures_z_min_and_z_max_along_the_given_axis_of_the_hyperboloid(name):
    ended, turn = questions("axis heights"), TURNS[name]
    whole = [k for k, row in enumerate(ended.rows) if (np.rint(row * 4) == row * 4)[np.isfinite(row)].all()]
    assert len(whole) > 100
    some = ended[whole[::3]]
    for case, row in zip(some.cases, some.rows.tolist(), strict=True):
        sizes, place, axis, upward = turned(turn, row)
        low, high, solid = row[10:]
        scale = sizes[0] / row[0]
        heights = {"z_min": scale * low, "z_max": scale * high, "solid": solid}
        for along in (axis, None) if axis[:2] == upward[:2] == [0, 0] else (axis,):
            assert passage(sizes, place, place, along, upward, **heights).hit == (expected(case) == 0)


@pytest.mark.parametrize("upward", [(1, 1, 0), (0, 1, -1), (1, 1, 1), (2, 1, 0), (1, -2, 1)])
def test_a_hyperboloid_axis_of_irrational_length_gives_the_answers_of_the_pair_turned_upright(upward):
    """Small integers, whose ends lie at irrational multiples of the axis; rows that a hair changes are left out."""
    draw = random.Random(str(upward))  # noqa: S311
    rows = [
        [draw.randint(1, 4) for _ in range(4)]
        + [draw.randint(-5, 5) for _ in range(3)]
        + draw.choice([[0, 0, 1], [1, 0, 0], [1, 1, 0], [1, -1, 0], [1, 1, 1], list(upward)])
        + draw.choice([[-np.inf, draw.randint(-4, 4)], [draw.randint(-4, 4), np.inf], [-2, draw.randint(-1, 5)]])
        + [draw.randint(0, 1)]
        for _ in range(160)
    ]
    along = np.array(upward) / np.linalg.norm(upward)
    turn = np.array([*np.linalg.svd([along])[2][1:], along])
    sizes, places, axes, heights = np.split(np.array(rows, dtype=float), [4, 7, 10], axis=1)
    answers = [
        classify(np.column_stack([sizes * [1, 1, hair, hair], places @ turn.T, axes @ turn.T, heights]))
        for hair in (1 - 1e-9, 1 + 1e-9)
    ]
    kept = np.flatnonzero(answers[0] == answers[1])
    assert len(kept) > 120
    assert {*answers[0][kept]} == {-1, 0, 1}
    for row, answer in zip([rows[k] for k in kept], answers[0][kept], strict=True):
        assert exact_position(Lengths.of(row, upward)) == answer, row


def test_an_upright_spheroid_passes_beyond_the_end_of_a_hyperboloid_that_points_down():
    """It stands above z = −1, where it is told to point down and to end 1 above its centre along that."""
    way = (0.9, 0.9, 0.25, 0.5), (9.0, 0.0, -3.0), (0.0, 0.0, -3.0)
    for upward, hit in (((0, 0, 1), True), ((0, 0, -1), False), ((0, 0, -3), False), ((1e-30, 0, -1), False)):
        for axis in (None, (0, 0, 1), (0, 0, -1)):
            assert passage(*way, axis, upward, z_max=1.0).hit == hit
            assert passage(*way, axis, upward, z_min=-1.0).hit != hit
