"""Collision engines asked about ways: what each solver sees, what it misses, and what it cannot be asked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import sweeps
from hypcheck.implementations.builtin import builtin
from hypcheck.implementations.meshes import COAL, FCL
from hypcheck.implementations.sweeps import SWEEP_SOLVERS, ball_mesh, height_of_sweeps, hits_and_times, sweep_mesh

HERE = [name for name, solver in SWEEP_SOLVERS.items() if solver.engine.trouble() is None]
NEEDS_FCL = pytest.mark.skipif(FCL.trouble() is not None, reason="python-fcl has no wheel here")

SIZES = (4.0, 6.0, 1.0, 0.5)
IN_CONTACT, THROUGH_A_WALL, BETWEEN, PAST, TUNNEL, NARROW = range(6)
ROWS = np.array(
    [
        (*SIZES, *start, *end)
        for start, end in (
            ((4, 0, 0), (9, 0, 0)),
            ((9, 0.5, 0), (0, 0.5, 0)),
            ((9, 0, 0), (7, 0, 1)),
            ((9, -6, 0), (9, 6, 0)),
            ((60, 1, 0.2), (-140, 1, 0.2)),
            ((3.5, 0, 9), (3.5, 0, -9)),
        )
    ]
)


@pytest.fixture(scope="module")
def found():
    """Hits and times of each solver that is here."""
    return {name: hits_and_times(SWEEP_SOLVERS[name], ROWS) for name in HERE}


@pytest.mark.parametrize("name", [name for name in HERE if name.endswith("-distance")])
def test_solvers_that_step_by_distance_find_each_contact_and_its_time(name, found):
    hits, times = sweeps.exact(ROWS)
    assert hits.tolist() == [1, 1, 0, 0, 1, 1]
    assert found[name][0].tolist() == hits.tolist()
    np.testing.assert_allclose(found[name][1], times, atol=0.02)


@NEEDS_FCL
def test_the_naive_sweep_solver_misses_a_contact_between_its_sample_times(found):
    assert found["passage-fcl-naive-10"][0].tolist() == [1, 1, 0, 0, 0, 1]
    assert found["passage-fcl-naive-100"][0].tolist() == [1, 1, 0, 0, 1, 1]
    times = found["passage-fcl-naive-10"][1]
    assert times[THROUGH_A_WALL] == pytest.approx(5 / 9)  # the first of its ten times behind 4/9


@NEEDS_FCL
def test_conservative_advancement_of_fcl_finds_contact_only_at_the_start_of_a_sweep(found):
    assert found["passage-fcl-advancement"][0].tolist() == [1, 0, 0, 0, 0, 0]


@NEEDS_FCL
def test_the_polynomial_solver_of_fcl_finds_contacts_and_gives_no_time(found):
    assert found["passage-fcl-polynomial"][0].tolist() == [1, 1, 0, 0, 1, 1]
    assert builtin("passage-fcl-polynomial").timed is None
    mesh = sweep_mesh(SWEEP_SOLVERS["passage-fcl-polynomial"], SIZES, height_of_sweeps(SIZES, ROWS))
    assert mesh.answers(np.concatenate([ROWS, ROWS])).tolist() == [1, 1, 0, 0, 1, 1] * 2  # no mesh stays moved


@pytest.mark.skipif(COAL.trouble() is not None, reason="coal is not installed")
def test_coal_exports_no_continuous_collision():
    import coal

    assert coal.Ellipsoid
    assert [name for name in dir(coal) if "continuous" in name.lower()] == []


@pytest.mark.skipif(COAL.trouble() is None, reason="coal is installed")
def test_a_sweep_method_whose_engine_is_missing_names_the_engine():
    with pytest.raises(InputError, match=r"^the built-in method 'passage-coal-distance' cannot be used: coal cannot"):
        builtin("passage-coal-distance")


@pytest.mark.parametrize("name", HERE)
def test_a_sweep_too_long_for_an_engine_is_answered_cannot_say(name):
    far = ROWS[:2].copy()
    far[0, 7] = 1e120
    assert sweep_mesh(SWEEP_SOLVERS[name], SIZES, height_of_sweeps(SIZES, far), 100).answers(far)[0] == CANNOT_SAY
    far[0, 9] = 1e120
    assert hits_and_times(SWEEP_SOLVERS[name], far[:1])[0].tolist() == [CANNOT_SAY]


def test_sweep_mesh_answers_cannot_say_if_the_engine_refuses_the_mesh():
    refusing = replace(SWEEP_SOLVERS["passage-fcl-naive-10"], engine=replace(FCL, mesh=lambda *_: None))
    assert sweep_mesh(refusing, SIZES, 20.0).answers(ROWS).tolist() == [CANNOT_SAY] * len(ROWS)


def test_ball_mesh_is_inscribed_and_closed():
    vertices, triangles = ball_mesh(500)
    assert 400 < len(triangles) < 600
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    assert set(uses.tolist()) == {2}
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert abs(volume) == pytest.approx(4 * np.pi / 3, rel=0.05)


def test_the_solver_by_distance_treats_rows_with_a_vertical_axis_as_upright_rows():
    some = ROWS[:, :10]
    upright, leaning = (
        sweeps.advanced(some),
        sweeps.advanced(np.hstack([some, np.tile((0.0, 0.0, -2.0), (len(some), 1))])),
    )
    assert upright[0].tolist() == leaning[0].tolist()
    assert {0, 1} <= {*upright[0].tolist()}
    np.testing.assert_allclose(upright[1], leaning[1], rtol=1e-9)
