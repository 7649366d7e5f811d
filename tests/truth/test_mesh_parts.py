"""The parts of the mesh oracle: cells that enclose the arc, a window that loses nothing, FCL's distance to a ribbon."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair
from hypcheck.truth import mesh
from hypcheck.truth.mesh import (
    REACH,
    UNIT,
    _facets,
    cell_of,
    distance_to_mesh,
    halves,
    meridian_of,
    ribbon,
    window_of,
)
from tests.support.fractions_truth import everyday, rows_of


@pytest.mark.slow
@settings(max_examples=200)
@given(rows_of(*everyday(-3, 3)), st.integers(0, 12), st.integers(0, 4095))
def test_mesh_cell_lies_on_one_side_and_its_triangle_holds_the_arc(row, level, path):
    meridian = meridian_of(Pair(*row[:5], 0.0, row[6]))
    window = window_of(meridian)
    assume(window is not None)
    cell = cell_of(meridian, *window)
    for depth in range(level):
        cell = halves(meridian, cell)[path >> depth & 1]
    a, c, e, f = meridian.a, meridian.c, Fraction(cell.low, meridian.one), Fraction(cell.high, meridian.one)
    p, q, corner = ((a * (g * h + 1) / (g + h), c * (g * h - 1) / (g + h)) for g, h in ((e, e), (f, f), (e, f)))
    for point, seen in ((p, cell.start), (q, cell.end), (corner, cell.corner)):
        center = (abs(Fraction(row[4])) / Fraction(row[2]), abs(Fraction(row[6])) / Fraction(row[3]))
        known = Fraction(1, 2**53) + Fraction(1, 2**96)  # one rounding, and the centre to 2⁻⁹⁶
        assert all(abs(s - (v - w)) <= known for s, v, w in zip(seen, point, center, strict=True))
        assert max(map(abs, seen)) <= 1.25 + 2**-50

    def level_of(point):
        return point[0] ** 2 / a**2 - point[1] ** 2 / c**2 - 1

    def between(s, t, share):
        return tuple(v + share * (w - v) for v, w in zip(s, t, strict=True))

    assert level_of(p) == level_of(q) == 0
    for share in (Fraction(1, 7), Fraction(1, 2), Fraction(5, 6)):
        assert level_of(between(p, q, share)) >= 0
        assert level_of(between(p, corner, share)) <= 0
        assert level_of(between(corner, q, share)) <= 0


@pytest.mark.slow
@settings(max_examples=200)
@given(rows_of(*everyday(-3, 3)), st.fractions(0, 1))
def test_window_of_the_meridian_holds_every_point_within_reach(row, share):
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


@pytest.mark.slow
@settings(max_examples=200)
@given(
    st.lists(st.tuples(*[st.floats(-1.25, 1.25)] * 2).map(tuple), min_size=2, max_size=20),
    st.sampled_from([1.0, 1e-4, 1e-9]),
)
def test_fcl_measures_a_ribbon_as_exact_arithmetic_does(points, scale):
    pytest.importorskip("fcl", reason="python-fcl has no wheel here")
    about = points[0]
    corners = [about, *((about[0] + scale * (u - about[0]), about[1] + scale * (v - about[1])) for u, v in points[1:])]
    segments = [pair for pair in pairwise(corners) if math.dist(*pair) > 1e-70]  # and the lattice has no shorter ones
    assume(segments)

    def squared(segment):
        (px, pz), (qx, qz) = (tuple(map(Fraction, end)) for end in segment)
        ex, ez = qx - px, qz - pz
        s = min(max(-(px * ex + pz * ez) / (ex * ex + ez * ez), Fraction(0)), Fraction(1))
        return (px + s * ex) ** 2 + (pz + s * ez) ** 2

    assert distance_to_mesh(*ribbon(segments)) == pytest.approx(
        math.sqrt(min(map(squared, segments))), rel=0, abs=1e-14
    )


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
def test_the_nearest_point_of_a_segment_is_at_its_foot_or_at_an_end(ends, nearest):
    assert mesh._nearest_on(*ends) == nearest


def test_facets_are_the_chords_of_cells_or_else_their_tangents():
    cells = [SimpleNamespace(chord=("chord", n), tangents=("tangent", n, n)) for n in (1, 2)]
    assert _facets(cells, chords=True) == ("chord", 1, "chord", 2)
    assert _facets(cells, chords=False) == ("tangent", 1, 1, "tangent", 2, 2)
