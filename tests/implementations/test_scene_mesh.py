"""A mesh of the whole surface: inscribed, as near to the surface as it says, and right beyond that distance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hypcheck
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.meshes import (
    COAL,
    FCL,
    PAIRINGS,
    MeshGrid,
    grid_of,
    height_of,
    rows_by_sizes,
    scene_mesh,
    turns_of,
)
from hypcheck.vectors.families import TILTED_FAMILIES
from tests.support import inside
from tests.support.inside import clearances, nearest

TOWER = (2.0, 17.8, 0.25, 0.15)
ENGINES = [
    pytest.param(FCL, marks=pytest.mark.skipif(FCL.trouble() is not None, reason="python-fcl has no wheel here")),
    pytest.param(COAL, marks=pytest.mark.skipif(COAL.trouble() is not None, reason="coal is not installed")),
]


@pytest.mark.parametrize(
    "grid", [MeshGrid(8.0, 118.7, 140.0, 13, 4), MeshGrid(0.5, 2.0, 9.0, 40, 12), grid_of(5, 2, 3, 300)]
)
def test_a_scene_mesh_is_inscribed_and_deviates_no_more_than_it_states(grid):
    vertices, triangles = grid.mesh()
    assert len(triangles) == grid.triangles
    assert set(triangles.ravel().tolist()) == set(range(len(vertices)))
    x, y, z = vertices.T
    assert np.allclose(np.hypot(x, y), grid.a * np.hypot(1, z / grid.c), rtol=1e-12)
    weights = np.random.default_rng(1).dirichlet(np.ones(3), (len(triangles), 40))
    points = np.einsum("tkv,tvx->tkx", weights, vertices[triangles]).reshape(-1, 3)
    off = np.hypot(points[:, 0], points[:, 1]) - grid.a * np.hypot(1, points[:, 2] / grid.c)
    assert np.abs(off).max() <= grid.deviation * (1 + 1e-9)
    assert np.abs(off).max() >= grid.deviation / 3  # the bound is of some use
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert np.count_nonzero(uses == 1) == 2 * grid.around  # the two rims alone


def test_grid_of_has_about_the_wanted_triangles_and_deviates_less_than_a_coarser_grid():
    for triangles in (100, 1000, 10_000):
        grid = grid_of(8.0, 118.7, 140.0, triangles)
        assert grid.triangles == pytest.approx(triangles, rel=0.1)
        coarser = MeshGrid(grid.a, grid.c, grid.height, grid.around * 2, max(1, grid.along // 2))
        assert grid.deviation < coarser.deviation


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("pairing", PAIRINGS)
def test_scene_mesh_answers_rightly_farther_from_contact_than_its_deviation(engine, pairing):
    rows = WORKLOADS["uniform"].rows(1, 400)
    mesh = scene_mesh(engine, pairing, TOWER, height_of(TOWER, rows), 3000)
    doubtful = np.abs(clearances(rows).clearance) <= mesh.deviation
    answers, truth = mesh.answers(rows), inside.positions(rows)
    assert (answers[~doubtful] == truth[~doubtful]).all()
    assert set(answers.tolist()) == {-1, 0, 1}


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
def test_scene_mesh_answers_rightly_about_tilted_ellipsoids_away_from_contact(engine):
    rows = TILTED_FAMILIES["tilted-tower"].rows(1, 400)
    mesh = scene_mesh(engine, "ellipsoid", TOWER, height_of(TOWER, rows), 20_000)
    far = np.array([abs(nearest(Pair.from_row(row)).clearance) for row in rows.tolist()]) > 3 * mesh.deviation
    answers, truth = mesh.answers(rows), hypcheck.classify(rows)
    assert far.sum() > 250
    assert (answers[far] == truth[far]).all()
    assert (mesh.answers(rows[:, :7])[far] != truth[far]).sum() > 10  # as if it stood upright


def test_turns_of_returns_rotations_that_take_the_z_axis_to_each_axis():
    axes = np.array([[0.0, 0.0, 2.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [1.0, -2.0, 3.0]])
    turns = turns_of(axes)
    assert np.allclose(turns @ np.swapaxes(turns, 1, 2), np.eye(3), atol=1e-15)
    assert np.allclose(np.linalg.det(turns), 1)
    assert np.allclose(turns[:, :, 2], axes / np.linalg.norm(axes, axis=1, keepdims=True))


@pytest.mark.parametrize("engine", ENGINES)
def test_scene_mesh_with_more_triangles_has_fewer_errors_near_contact(engine):
    rows = WORKLOADS["near-contact"].rows(1, 1800)[::6]
    truth, height = inside.positions(rows), height_of(TOWER, rows)
    wrong = [
        np.count_nonzero(scene_mesh(engine, "point", TOWER, height, n).answers(rows) != truth) for n in (100, 10_000)
    ]
    assert wrong[1] < wrong[0]


def test_scene_mesh_answers_cannot_say_if_the_engine_refuses_the_mesh():
    refusing = replace(FCL, mesh=lambda *_: None)
    rows = WORKLOADS["uniform"].rows(1, 3)
    assert scene_mesh(refusing, "point", TOWER, 25.0, 100).answers(rows).tolist() == [CANNOT_SAY] * 3


def test_rows_by_sizes_groups_rows_of_the_same_four_sizes():
    rows = WORKLOADS["near-contact"].rows(1, 60)
    found = dict(rows_by_sizes(rows))
    assert len(found) == 6
    assert sorted(np.concatenate(list(found.values())).tolist()) == list(range(60))
    for sizes, places in found.items():
        assert (rows[places, :4] == sizes).all()


def test_the_mesh_is_made_higher_for_a_row_whose_centre_is_above_its_usual_height():
    rows = WORKLOADS["uniform"].rows(1, 3)
    rows[1, 6] = 90.0
    assert height_of(TOWER, rows) == pytest.approx(90.0 + 1.1 * 0.15)
    assert height_of(TOWER, rows[:1]) == pytest.approx(1.2 * 17.8 + 1.1 * 0.15)
