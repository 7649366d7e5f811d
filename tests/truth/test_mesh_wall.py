"""The mesh oracle for any axis and any ends: its meshes hold the wall between them; it is right or undecided."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import mp, mpf

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import mesh_oracle as wall
from hypcheck.truth.mesh_oracle import refine
from tests.support.inside import MeshOutcome, availability, distance_to_mesh, verdict
from tests.support.tilted_fractions import exact_position
from tests.tools.oracle_agreement import main
from tests.truth.tilted_cases import SYMMETRIC

pytestmark = pytest.mark.skipif(availability() is not None, reason="python-fcl is not installed")
TREE = (0.2, 1.0, 0.3, 0.2)
"""The trunk's and the drone's sizes in the two trees: the trunk ends at z = 2, its rim is at r = 0.2 √5."""
RIM = 0.2 * math.sqrt(5)
TILTED = (1.0, 4.0, 0.125, 0.25, 1.5, 0.0, 0.0, 0.0, 1.0, 1.0)


def asked(x, z, *heights, axis=(0, 0, 1), sizes=TREE):
    return verdict(Pair.from_row((*sizes, x, 0, z, *axis, *heights)))


@pytest.mark.parametrize("solid", [0, 1])
@pytest.mark.parametrize("axis", [(0, 0, 1), (1e-9, 0, 1)])
def test_mesh_oracle_says_contact_on_the_rim_of_a_tree_that_ends_and_exterior_above_it(axis, solid):
    assert asked(RIM, 2.01, -1, 2, solid, axis=axis).position is Position.CONTACT
    assert asked(RIM, 2.2001, -1, 2, solid, axis=axis).position is Position.EXTERIOR
    assert asked(RIM, 2.1999, -1, 2, solid, axis=axis).position is Position.CONTACT
    assert asked(RIM, -1.21, -1, 2, solid, axis=axis).position is Position.EXTERIOR
    assert asked(RIM, 2.2001, -1, math.inf, solid, axis=axis).position is Position.CONTACT


def test_mesh_oracle_counts_the_disc_of_a_solid_body_and_not_the_opening_of_an_open_one():
    inside = (5.0, 5.0, 0.5, 0.5)
    for solid, position in ((0, Position.INTERIOR), (1, Position.CONTACT)):
        assert asked(0.0, 1.0, -3, 1.2, solid, sizes=inside).position is position
    for z, position in ((-3, Position.INTERIOR), (1, Position.INTERIOR), (1.1, Position.EXTERIOR)):  # in a mouth
        assert asked(0.0, z, -3, 1.0, 0, sizes=inside).position is position
    assert asked(0.0, 1.6, -3, 1.0, 1, sizes=inside).position is Position.EXTERIOR
    assert asked(0.0, 1.0, -3, 3.0, 1, sizes=inside).position is Position.INTERIOR
    assert asked(0.0, 1.0, -3, 1.5, 1, sizes=inside).position is None  # it touches the disc


@pytest.mark.parametrize("side", [1, -1])
def test_mesh_oracle_finds_a_wall_above_or_below_the_center_of_a_disk_that_stands_on_its_edge(side):
    disk = {"axis": (1, 0, 0), "sizes": (0.2, 1.0, 3.0, 0.2)}
    low, high = sorted((side, 2 * side))
    assert asked(0.3, 0.0, low, high, 0, **disk).position is Position.CONTACT
    assert asked(0.3, -2.1 * side, low, high, 0, **disk).position is Position.EXTERIOR


def test_mesh_oracle_says_contact_if_a_short_wall_lies_wholly_within_the_spheroid():
    assert asked(0.0, 0.0, -0.01, 0.01, 0, sizes=(0.5, 1.0, 2.0, 2.0)).position is Position.CONTACT
    assert asked(0.0, 0.0, -0.01, 0.01, 0, sizes=(0.5, 1.0, 0.4, 0.4)).position is Position.INTERIOR


@pytest.mark.parametrize("solid", [0, 1])
@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.3, 0.4, 0.5)])
def test_the_mesh_that_fcl_checks_for_a_clear_pair_separates_the_wall_and_discs_from_the_spheroid(solid, axis):
    """The bodies that FCL is asked about hold the wall: they are beyond the ball, and as near as any of its points."""
    b, d, x, z, top = 0.5, 0.25, 1.55, 0.35, 0.5
    pair = Pair.from_row((1.0, 2.0, b, d, x, 0.0, z, *axis, -1.0, top, solid))
    search = refine(pair)
    assert search.outcome is MeshOutcome.CLEAR
    ((vertices, triangles),) = search.meshes
    w, t = (part.ravel() for part in np.meshgrid(np.linspace(-1, top, 801), np.linspace(-math.pi, math.pi, 1601)))
    r = np.hypot(1, w / 2)
    unit = np.array(axis) / np.linalg.norm(axis)
    way = np.stack([r * np.cos(t) - x, r * np.sin(t), w - z])
    along = unit @ way
    least = math.sqrt((((way * way).sum(axis=0) - along**2) / b**2 + (along / d) ** 2).min())
    assert 1 < distance_to_mesh(vertices, triangles) <= least * (1 + 1e-12)


@pytest.mark.parametrize("x", [0.4, 1.6])
def test_contact_beside_ends_is_shown_by_one_mesh_inside_and_one_outside_both_between_the_ends(x):
    draw = np.random.default_rng(2)
    search = refine(Pair.from_row((1.0, 2.0, 1.0, 1.0, x, 0.3, 0.5, 0, 0, 1, -1.0, 0.75, 0)))
    assert search.outcome is MeshOutcome.CONTACT
    for side, (vertices, triangles) in zip((-1, 1), search.meshes, strict=True):
        assert len(vertices) == 9  # of one cell, though others are within as well
        for triangle in triangles:
            px, py, pz = (draw.dirichlet([1, 1, 1], 20) @ vertices[triangle] + (x, 0.3, 0.5)).T
            assert (side * (px * px + py * py - pz * pz / 4 - 1) >= -1e-12).all()
            assert (np.abs(pz + 0.125) <= 0.875 + 1e-12).all()


def test_mesh_oracle_is_undecided_where_fcl_does_not_confirm_what_it_found_about_an_end():
    for z in (2.01, 2.2001):
        pair = Pair.from_row((*TREE, RIM, 0, z, 0, 0, 1, -1, 2, 0))
        assert verdict(pair).position is not None
        assert verdict(pair, lambda *_: 1.0).position is None


def test_mesh_oracle_leaves_extreme_ratios_of_lengths_beside_an_end_undecided():
    assert refine(Pair.from_row((1, 1, 1e-300, 1e-290, 2, 0, 0, 1, 2, 3, -1, 1, 0))).levels == 0
    assert verdict(Pair.from_row((1, 1, 1e-300, 1e-290, 2, 0, 0, 1, 2, 3, -1, 1, 0))).position is None
    assert verdict(Pair.from_row((1e300, 1, 1e-300, 1, 2, 0, 0, 0, 0, 1, -1, 1, 0))).position is None


def test_mesh_oracle_is_never_wrong_about_random_rows_beside_ends(capsys):
    assert main(["mesh", "--rows", "120", "--families", "ended,rim,disc,slab"]) == 0
    assert "0 disagreements" in capsys.readouterr().out


def test_tilted_mesh_oracle_leaves_tangencies_undecided_and_calls_rings_clear():
    for row, position, limit_of in SYMMETRIC:
        found = verdict(Pair.from_row(row)).position
        assert found == (None if limit_of is not None else position)


def test_tilted_mesh_oracle_is_undecided_where_fcl_does_not_confirm_it():
    assert verdict(Pair.from_row(TILTED)).position is Position.EXTERIOR
    assert verdict(Pair.from_row(TILTED), lambda *_: 1.0).position is None
    touching = (*TILTED[:4], 1.0625, *TILTED[5:])
    assert exact_position(touching) == 0
    assert verdict(Pair.from_row(touching)).position is Position.CONTACT
    assert verdict(Pair.from_row(touching), lambda *_: 1.0).position is None


def test_tilted_mesh_oracle_leaves_extreme_ratios_of_lengths_undecided():
    assert verdict(Pair.from_row((1, 1, 1e-300, 1e-290, 2, 0, 0, 1, 2, 3))).position is None


def test_tilted_mesh_oracle_says_contact_after_one_level_if_the_centre_is_on_the_surface():
    found = verdict(Pair.from_row((1.0, 4.0, 0.125, 0.25, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0)))
    assert (found.position, found.levels) == (Position.CONTACT, 1)


@pytest.mark.parametrize("row", [TILTED, (*TREE, RIM, 0, 2.2001, 0, 0, 1, -1, 2, 0)])
def test_computed_corners_of_cells_are_within_their_stated_error_of_the_exact_ones(row):
    pair = Pair.from_row(row)
    scene = wall.scene_of(pair)
    cells = scene.whole()[:40]
    with mp.workprec(200):
        points, slack = scene.corners(cells)
        for cell, corners, allowed in zip(cells.tolist(), points.tolist(), slack.tolist(), strict=True):
            for place, corner in enumerate(corners):
                way = [p - c for p, c in zip(exact_corner(scene, cell, place), scene.centre.tolist(), strict=True)]
                exact = [sum(w * mpf(r) for w, r in zip(way, column, strict=True)) for column in scene.root.T.tolist()]
                assert all(abs(mpf(x) - y) <= allowed for x, y in zip(corner, exact, strict=True))


def exact_corner(scene, cell, place):
    """Start, corner of the tangents or end of the meridian, in the direction of the start, the corner or the end."""
    _, low, high, start, end = map(mpf, cell)
    meridian, direction = divmod(place, 3)
    s, shrink = [(low, 1), ((low + high) / 2, mp.cosh((high - low) / 2)), (high, 1)][meridian]
    angle, wide = [(start, 1), ((start + end) / 2, mp.cos((end - start) / 2)), (end, 1)][direction]
    r, z = scene.alpha * mp.cosh(s) / shrink, scene.gamma * mp.sinh(s) / shrink
    return r * mp.cos(angle) / wide, r * mp.sin(angle) / wide, z


@pytest.mark.parametrize("axis", [(3.0, 0.0, 4.0), (4.0, 0.0, -3.0), (0.0, 1.0, 0.0)])
@pytest.mark.parametrize(("b", "d"), [(1.0, 0.25), (0.25, 1.0)])
def test_the_mesh_covers_the_heights_of_the_spheroid_and_less_than_half_as_much_more(axis, b, d):
    """With the axis v these are √(b² (1 − v_z²) + d² v_z²) above and below its centre."""
    scene = wall.scene_of(Pair(2.0, 3.0, b, d, 1.0, 0.5, 0.25, *axis, -9.0, 9.0))
    share = axis[2] ** 2 / sum(part * part for part in axis)
    half = math.sqrt(b * b * (1 - share) + d * d * share) * scene.alpha / 2.0
    for reach in (scene.centre[2] - scene.low, scene.high - scene.centre[2]):
        assert half < reach < 1.5 * half
