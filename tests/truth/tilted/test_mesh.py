"""The mesh oracle for tilted spheroids: its meshes are one-sided, and what it says is right or nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.truth.mesh import availability
from hypcheck.truth.tilted import mesh
from hypcheck.truth.tilted.pair import TiltedPair
from tests.support.tilted_fractions import exact_position
from tests.tools.tilted_agreement import rows
from tests.truth.tilted.cases import SYMMETRIC

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


def test_first_cells_of_the_tilted_mesh_cover_the_surface():
    """X(a, b) stays where it is when a or b grows by a whole turn."""
    draw, turn = np.random.default_rng(4), 2 * math.pi
    cells = mesh._whole()
    for _ in range(300):
        theta, tau = draw.uniform(0, turn), draw.uniform(-1, 1) * math.pi / 2
        held = [
            (cells[:, 0] <= a) & (a <= cells[:, 1]) & (cells[:, 2] <= b) & (b <= cells[:, 3])
            for a in (theta + tau + turn * k for k in (-1, 0, 1))
            for b in (theta - tau + turn * k for k in (-2, -1, 0, 1, 2))
        ]
        assert np.any(held), (theta, tau)


def test_tilted_mesh_oracle_is_never_wrong_and_decides_most_rows():
    decided = 0
    some = list(rows(["uniform", "near", "symmetric", "grid"], 40, seed=21))
    for family, row in some:
        found = mesh.position(TiltedPair.from_row(row))
        assert found in (None, exact_position(row)), (family, row)
        decided += found is not None
    assert decided > 0.7 * len(some)


def test_tilted_mesh_oracle_leaves_tangencies_undecided_and_calls_rings_clear():
    for row, position, limit_of in SYMMETRIC:
        found = mesh.position(TiltedPair.from_row(row))
        assert found == (None if limit_of is not None else position)


def test_tilted_mesh_oracle_is_undecided_where_fcl_does_not_confirm_it(monkeypatch):
    assert mesh.position(TiltedPair.from_row(CLEAR)) is Position.EXTERIOR
    monkeypatch.setattr(mesh, "distance_to_mesh", lambda *_: 1.0)
    assert mesh.position(TiltedPair.from_row(CLEAR)) is None
    touching = (*CLEAR[:4], 1.0625, *CLEAR[5:])
    assert exact_position(touching) == 0
    assert mesh.position(TiltedPair.from_row(touching)) is None


def test_tilted_mesh_oracle_leaves_extreme_ratios_of_lengths_undecided():
    assert mesh.position(TiltedPair.from_row((1, 1, 1e-300, 1e-290, 2, 0, 0, 1, 2, 3))) is None
