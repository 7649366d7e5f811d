"""Meshes and how far bodies are from them, against plain samplings of triangles."""

import numpy as np
import pytest

from hypcheck.engines.placing import FAMILIES, drawn, placed
from hypcheck.engines.scene import HULL, ball_points, distances, rows_near, seen_from, surface_mesh, to_triangles


def test_the_distance_to_a_triangle_is_the_least_distance_to_its_points():
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(200, 3, 3))
    steps = np.linspace(0, 1, 60)
    shares = np.array([(i, j, 1 - i - j) for i in steps for j in steps if i + j <= 1])
    sampled = np.linalg.norm(np.einsum("sk,nkx->nsx", shares, corners), axis=2).min(axis=1)
    found = np.sqrt(to_triangles(corners))
    size = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    assert (found <= sampled + 1e-12).all()
    assert (sampled - found <= size / 59).all()


def test_distances_of_the_origin_to_four_triangles_are_those_worked_out_by_hand():
    corners = np.array(
        [
            [[-1, -1, 2], [3, -1, 2], [-1, 3, 2]],  # the origin is below its inside
            [[3, 4, 0], [3, 4, 5], [6, 8, 1]],  # nearest at the corner 3, 4, 0
            [[1, -1, 0], [1, 1, 0], [2, 0, 7]],  # nearest at the middle of an edge
            [[-1, -1, 0], [1, -1, 0], [0, 2, 0]],
        ],
        dtype=np.float64,
    )
    assert to_triangles(corners).tolist() == [4, 25, 1, 0]


@pytest.mark.parametrize("name", ["disc", "leaning"])
def test_distances_to_a_mesh_are_those_to_the_nearest_of_all_its_triangles(name):
    found = placed(FAMILIES[name], 2)
    mesh = surface_mesh(FAMILIES[name].sizes, 500)
    whole = [np.sqrt(to_triangles(seen_from(row, mesh.vertices)[mesh.triangles]).min()) for row in found.rows]
    assert distances(found.rows, mesh) == pytest.approx(whole, rel=1e-13)


def test_rows_placed_near_a_mesh_touch_it_if_their_gap_is_negative():
    family = FAMILIES["body"]
    mesh = surface_mesh(family.sizes, 500)
    spot, gap = drawn(family, 2)
    _, apart = rows_near(spot, gap, mesh)
    assert ((apart > 1) == (gap > 0)).mean() > 0.95
    assert np.median(np.abs(apart - 1 - gap / spot.half_width()) / np.abs(gap)) < 0.1


def test_the_largest_ball_in_the_hull_of_the_ball_mesh_has_the_claimed_radius_within_1_percent():
    points = ball_points()
    rng = np.random.default_rng(4)
    ways = rng.normal(size=(20000, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    support = (ways @ points.T).max(axis=1)
    assert support.min() >= HULL  # the hull holds a ball exactly if no half space that holds the hull cuts the ball
    assert support.min() < HULL * 1.01
    assert np.linalg.norm(points, axis=1) == pytest.approx(1)
