"""Parts of the mesh oracle: a window that loses nothing, and the nearest point of a segment."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair
from hypcheck.truth import mesh_meridian
from hypcheck.truth.mesh_meridian import REACH, UNIT, meridian_of, window_of
from tests.support.examples import examples
from tests.support.fractions_truth import everyday, rows_of
from tests.support.inside import MeshOutcome


@pytest.mark.slow
@examples(100)
@given(rows_of(*everyday(-3, 3)), st.fractions(0, 1))
def test_window_of_the_meridian_contains_every_point_within_the_search_distance(row, share):
    meridian = meridian_of(Pair(*row[:5], 0.0, row[6]))
    center = (abs(Fraction(row[4])) / Fraction(row[2]), abs(Fraction(row[6])) / Fraction(row[3]))
    window = window_of(meridian)
    reach = Fraction(REACH, UNIT)

    def within(e):
        point = (meridian.a * (e + 1 / e) / 2, meridian.c * (e - 1 / e) / 2)
        return all(abs(v - w) <= reach for v, w in zip(point, center, strict=True))

    if window is None:
        first, last = Fraction(1), 2 * (center[0] + reach) / meridian.a + 1
        assert not within(first + share * (last - first))
    else:
        first, last = (Fraction(e, meridian.one) for e in window)
        assert first == 1 or not within(1 + share * (first - 1))
        assert not within(last + share)


@pytest.mark.parametrize(
    ("ends", "nearest"),
    [
        (((1.0, -1.0), (1.0, 3.0)), (1.0, 0.0)),
        (((3.0, 1.0), (-1.0, 1.0)), (0.0, 1.0)),
        (((2.0, 0.0), (0.0, 2.0)), (1.0, 1.0)),
        (((1.0, 2.0), (3.0, 4.0)), (1.0, 2.0)),
        (((3.0, 4.0), (1.0, 2.0)), (1.0, 2.0)),
        (((1.0, 2.0), (1.0, 2.0)), (1.0, 2.0)),
    ],
)
def test_the_nearest_point_of_a_segment_is_the_foot_of_the_perpendicular_or_an_end(ends, nearest):
    assert mesh_meridian._nearest_on(*ends) == nearest


def test_a_ribbon_omits_a_segment_without_length_and_has_two_triangles_for_another_segment():
    vertices, triangles = mesh_meridian.ribbon([((1.0, 2.0), (1.0, 2.0)), ((3.0, 5.0), (3.0, 9.0))])
    assert vertices.tolist() == [[3, -2, 5], [3, 2, 5], [3, 2, 9], [3, -2, 9]]
    assert triangles.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize(
    ("row", "outside", "clear"),
    [
        ((1, 1, 1, 1, 2.14, 0, 0), True, True),
        ((1, 1, 1, 1, 1.9, 0, 0), True, False),
        ((4, 4, 1, 1, 2.9, 0, 0), False, True),
        ((4, 4, 1, 1, 3.1, 0, 0), False, False),
    ],
)
def test_a_mesh_of_a_clear_pair_is_nearer_than_the_wall_and_a_mesh_of_a_pair_in_contact_farther(row, outside, clear):
    """Chords have their ends on the wall; tangents meet within it."""
    search = mesh_meridian.refine(Pair(*map(float, row)))
    x, _, z = (search.meshes[0][0] + (row[4], 0, 0)).T
    level = (x * x / row[0] ** 2 - z * z / row[1] ** 2) - 1
    assert (search.outcome is MeshOutcome.CLEAR) == clear
    assert (level < 1e-9).all()
    assert (level > -1e-9).all() == (outside == clear)
