"""Places of rows in words; each row was made by hand, or by a construction that names its place."""

from __future__ import annotations

import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.runs.hunt_surfaces import OPEN, place_of
from hypcheck.vectors.families import FAMILIES


@pytest.mark.parametrize(
    ("row", "kind", "words"),
    [
        ((1, 2, 1, 1, 2.5, 0, 0), "the ring", "z = 0 and Δ = 0 (the ring), a = 1"),
        ((7, 7, 1, 1, 10, 0, 0), "the ring", "z = 0 and Δ = 0 (the ring)"),
        ((7, 7, 1, 1, 10.001, 0, 0), "next to the ring", "1.0e-03 radii from the ring, z = 0"),
        ((7, 7, 1, 1, 10, 0, 0.01), "next to the ring", "1.0e-02 radii from the ring, z ≈ 0"),
        ((7, 7, 1, 1, 11, 0, 0), "z = 0", "z = 0"),
        ((4, 1, 1, 1, 1, 0, 0), "c1 = 0", "c1 = 0, c² < a, z = 0"),
        ((3, 3, 1, 1, 1, 0, 0), "c2 = 0", "c2 = 0, z = 0"),
        ((2, 0.5, 1, 1, 4, 0, 0), "c² < a", "c² < a, z = 0"),
        ((0.5, 2, 1, 1, 0, 0, 9), "a < 1", "a < 1, r = 0"),
        ((2, 5, 1, 1, 3, 0, 0), "exactly tangent", "exactly tangent (exterior-tangent-point), z = 0"),
        ((1 + 2**-30, 5, 1, 1, 0, 0, 0.5), "a = 1", "a ≈ 1 (a − 1 = 9.3e-10), r = 0"),
        ((4, 2 + 2**-20, 1, 1, 9, 0, 5), "c² = a", "c² ≈ a (c²/a − 1 = 9.5e-07)"),
        # The ring's border with contact: no ring of its own.
        ((4, 2 + 2**-20, 1, 1, 5 + 2**-41, 0, 0), "c² = a", "c² ≈ a (c²/a − 1 = 9.5e-07), z = 0"),
        ((3e6, 2e7, 1, 1, 4e6, 0, 5e7), "a long ratio", "a = 3.0e+06, c = 2.0e+07"),
        ((3, 4, 1, 1, 6, 0, 5), OPEN, OPEN),
    ],
)
def test_place_of_a_row_is_named_after_the_special_surface_that_explains_most(row, kind, words):
    place = place_of(Pair.from_row(row))
    assert place.kind == kind
    assert place.words.startswith(words)


@pytest.mark.parametrize(
    ("family", "kind"),
    [("ring", "the ring"), ("tangent", "exactly tangent"), ("degenerate-crossing", "Δ = 0 without a tangency")],
)
def test_place_of_a_constructed_row_is_recognised_at_any_size(family, kind):
    assert {place_of(Pair.from_row(row)).kind for row in FAMILIES[family].rows(3, 60).tolist()} == {kind}


def test_extreme_rows_have_a_place_in_words():
    for family in ("extreme-float64", "extreme-subnormal", "extreme-magnitude"):
        for row in FAMILIES[family].rows(1, 40).tolist():
            assert place_of(Pair.from_row(row)).words


def test_cause_of_a_row_is_the_same_on_and_near_the_ring_and_differs_by_regime():
    def cause(*row):
        return place_of(Pair.from_row(row)).cause

    assert cause(7, 7, 1, 1, 10, 0, 0) == cause(7, 7, 1, 1, 10.001, 0, 0) == cause(1, 2, 1, 1, 2.5, 0, 0)
    assert cause(3, 4, 1, 1, 6, 0, 5) == cause(3, 4, 1, 1, 6, 0, 0)
    assert len({cause(3, 4, 1, 1, 6, 0, 5), cause(3, 1, 1, 1, 6, 0, 5), cause(0.5, 4, 1, 1, 6, 0, 5)}) == 3
