"""The naive FCL methods: right where a plain mesh can be, and wrong where the documentation says they are."""

from __future__ import annotations

import sys
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np
import pytest

from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations import meshes
from hypcheck.implementations.meshes import FCL, PAIRINGS, naive_fcl, shared_meshes
from hypcheck.vectors.families import FAMILIES
from tests.support.fractions_truth import exact_position, near_contact_rows, tangent_row
from tests.support.inside import verdict

pytest.importorskip("fcl", reason="python-fcl has no wheel here")

METHODS = [partial(naive_fcl, pairing=pairing) for pairing in PAIRINGS]

CLEAR_OF_DOUBT = np.array(
    [
        (2, 3, 1, 1, 4.0, 0, 0),
        (2, 3, 1, 1, 0, -4.0, 1),
        (2, 3, 1, 1, 2.2, 0, 0),
        (2, 3, 1, 1, 0, -1.6, -1),
        (2, 3, 1, 1, 0.3, 0, 0),
        (2, 3, 1, 1, 0, 0.2, 5),
        (2, 3, 0.5, 1, 20, 1, 0),
        (5, 1, 1, 1, 0, 0, 0),
        (0.5, 1, 1, 1, 0, 0, 0),
    ]
)


@pytest.mark.parametrize("method", METHODS)
def test_naive_fcl_is_right_far_from_contact(method):
    assert method(CLEAR_OF_DOUBT).tolist() == [exact_position(row) for row in CLEAR_OF_DOUBT]


def rows_at_gap(gap, flatness):
    """Rows with b = 1 and d = `flatness` whose clearance is about ± `gap` radii, and their positions."""
    rows = []
    for k in (Fraction(1, 4), Fraction(2)):
        for v in (Fraction(1, 2), Fraction(1), Fraction(3), Fraction(5), Fraction(9)):
            for steps in (1 + gap, 1 - gap, -1 - gap, -1 + gap):
                found = tangent_row(Fraction(4, 5), Fraction(3, 5), k, v, steps)
                if found is not None:
                    alpha, gamma, b, d, x, y, z = found[0]
                    rows.append((alpha / b, gamma / d * flatness, 1.0, flatness, x / b, y / b, z / d * flatness))
    return np.array(rows), np.array([exact_position(row) for row in rows])


@pytest.mark.parametrize("method", METHODS)
def test_naive_fcl_is_wrong_near_contact_where_the_certified_mesh_is_right(method):
    known = near_contact_rows(60)
    rows, positions = np.array([row for row, _ in known]), np.array([position for _, position in known])
    answers = method(rows, triangles=500)
    assert np.any((answers == 0) & (positions != 0)) or np.any((answers != 0) & (positions == 0))
    assert [verdict(Pair(*row)).position for row in rows] == positions.tolist()


def test_naive_fcl_with_more_triangles_has_fewer_errors_but_some():
    rows, positions = rows_at_gap(Fraction(1, 2**16), 1.0)
    wrong = [np.count_nonzero(naive_fcl(rows, "point", triangles) != positions) for triangles in (50, 5000)]
    assert wrong[0] > wrong[1] > 0


def test_naive_fcl_with_ellipsoids_misses_contacts_of_flat_spheroids():
    missed = {}
    for flatness in (1.0, 2.0**-20):
        rows, positions = rows_at_gap(Fraction(1, 2**4), flatness)
        assert naive_fcl(rows, "sphere").tolist() == positions.tolist()
        missed[flatness] = np.count_nonzero((naive_fcl(rows, "ellipsoid") != 0) & (positions == 0))
    assert missed[1.0] == 0
    assert missed[2.0**-20] >= np.count_nonzero(positions == 0) / 2


@pytest.mark.parametrize("method", METHODS)
def test_naive_fcl_answers_cannot_say_for_numbers_beyond_its_range(method):
    huge = np.array([(1e200, 1e-150, 1e200, 1e200, 1e200, 0, 0), (1e-200, 1e-200, 1e200, 1e-300, 1e300, 0, 1e300)])
    assert method(huge).tolist() == [CANNOT_SAY, CANNOT_SAY]


@pytest.mark.parametrize("method", METHODS)
def test_naive_fcl_accepts_an_empty_array_and_reports_a_missing_fcl(method, monkeypatch):
    assert method(np.empty((0, 7))).shape == (0,)
    monkeypatch.setitem(sys.modules, "fcl", None)
    with pytest.raises(UnavailableError, match="not available"):
        method(CLEAR_OF_DOUBT)


def test_naive_fcl_shares_meshes_only_within_shared_meshes_and_gives_the_same_answers(monkeypatch):
    rows = FAMILIES["uniform"].rows(3, 12)
    expected = {pairing: naive_fcl(rows, pairing).tolist() for pairing in PAIRINGS}
    built = []
    monkeypatch.setattr(meshes, "FCL", replace(FCL, mesh=lambda *mesh: built.append(mesh) or FCL.mesh(*mesh)))
    with shared_meshes():
        assert {pairing: naive_fcl(rows, pairing).tolist() for pairing in PAIRINGS} == expected
        shared = len(built)
    assert naive_fcl(rows, "point").tolist() == expected["point"]
    once = len(built) - shared
    assert once > 0
    assert shared == 2 * once  # the sphere and the point have the scaled mesh, the ellipsoid the other
