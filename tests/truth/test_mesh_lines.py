"""The mesh oracle for tilted spheroids: its meshes are one-sided, and what it says is right or nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import mp, mpf

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import mesh_lines as mesh
from tests.support.inside import availability, verdict
from tests.support.tilted_fractions import exact_position
from tests.truth.tilted_cases import SYMMETRIC

pytestmark = pytest.mark.skipif(availability() is not None, reason="python-fcl is not installed")
CLEAR = (1.0, 4.0, 0.125, 0.25, 1.5, 0.0, 0.0, 0.0, 1.0, 1.0)


def test_diagonal_of_a_cell_around_the_axis_lies_inside_the_hyperboloid_and_the_other_outside():
    draw = np.random.default_rng(3)
    for _ in range(50):
        a, b = draw.uniform(0, 6), draw.uniform(0, 0.5, 2)
        tau = draw.uniform(-1, 1)
        cell = (a + tau, a + tau + b[0], a - tau, a - tau + b[1])

        def at(one, other):
            theta, half = (one + other) / 2, (one - other) / 2
            return np.array([math.cos(theta), math.sin(theta), math.sin(half)]) / math.cos(half)

        corners = [at(cell[i], cell[j]) for i in (0, 1) for j in (2, 3)]
        for triangles, side in ((mesh.INNER, -1), (mesh.OUTER, 1)):
            for triangle in triangles:
                shares = draw.dirichlet([1, 1, 1])
                x, y, z = sum(share * corners[corner] for share, corner in zip(shares, triangle, strict=True))
                assert side * (x * x + y * y - z * z - 1) >= -1e-12


def test_tilted_mesh_oracle_leaves_tangencies_undecided_and_calls_rings_clear():
    for row, position, limit_of in SYMMETRIC:
        found = verdict(Pair.from_row(row)).position
        assert found == (None if limit_of is not None else position)


def test_tilted_mesh_oracle_is_undecided_where_fcl_does_not_confirm_it():
    assert verdict(Pair.from_row(CLEAR)).position is Position.EXTERIOR
    assert verdict(Pair.from_row(CLEAR), lambda *_: 1.0).position is None
    touching = (*CLEAR[:4], 1.0625, *CLEAR[5:])
    assert exact_position(touching) == 0
    assert verdict(Pair.from_row(touching)).position is Position.CONTACT
    assert verdict(Pair.from_row(touching), lambda *_: 1.0).position is None


def test_tilted_mesh_oracle_leaves_extreme_ratios_of_lengths_undecided():
    assert verdict(Pair.from_row((1, 1, 1e-300, 1e-290, 2, 0, 0, 1, 2, 3))).position is None


def test_tilted_mesh_oracle_says_contact_at_once_where_the_centre_is_on_the_surface():
    found = verdict(Pair.from_row((1.0, 4.0, 0.125, 0.25, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0)))
    assert (found.position, found.levels) == (Position.CONTACT, 1)


def test_corners_of_cells_are_within_their_slack_of_the_exact_ones():
    """Also near the end of a line, where the tangent turns a rounding of its angle into much."""
    scene = mesh._Scene(Pair.from_row(CLEAR))
    for beside in (1.0, 1e-3, 1e-6):
        tau = math.pi / 2 - beside
        cells = np.array([[theta + tau, theta + tau + beside / 4, theta - tau, theta - tau + beside / 4] for theta in
                          np.linspace(0.1, 6, 40)])  # fmt: skip
        corners, slack = scene.corners(cells)
        alpha, gamma, centre = scene.alpha, scene.gamma, scene.centre
        with mp.workprec(200):
            for cell, found, allowed in zip(cells.tolist(), corners.tolist(), slack.tolist(), strict=True):
                for corner, (i, j) in zip(found, ((0, 2), (0, 3), (1, 2), (1, 3)), strict=True):
                    a, b = mpf(cell[i]), mpf(cell[j])
                    theta, half = (a + b) / 2, (a - b) / 2
                    point = [alpha * mp.cos(theta) / mp.cos(half), alpha * mp.sin(theta) / mp.cos(half)]
                    way = [p - c for p, c in zip([*point, gamma * mp.tan(half)], centre.tolist(), strict=True)]
                    exact = [
                        sum(w * mpf(r) for w, r in zip(way, column, strict=True)) for column in scene.root.T.tolist()
                    ]
                    assert all(abs(mpf(x) - y) <= allowed for x, y in zip(corner, exact, strict=True))
