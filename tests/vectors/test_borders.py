"""Borders of the regimes, planes of symmetry and vanishing coefficients are met exactly, and by rows beside them."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

from hypcheck.geometry.pair import Position
from hypcheck.truth import exact
from hypcheck.truth.kinds import Kind
from hypcheck.vectors import borders
from hypcheck.vectors.double_roots import gather
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import FAMILIES
from tests.vectors.case_rows import COUNT, fractions, kinds, lengths_of, ratios

EXTERIOR, CONTACT, INTERIOR = Position


def test_rows_constructed_for_a_vanishing_coefficient_have_it_exactly_0() -> None:
    for construct, vanishing in (
        (borders.second_coefficient_zero, {"n2"}),
        (borders.first_coefficient_zero, {"n1"}),
        (borders.first_coefficient_zero_for_any_waist, {"n1"}),
        (borders.both_coefficients_zero, {"n1", "n2"}),
    ):
        rows = gather(Draw("zero"), 200, construct)
        cubics = [exact.cubic(lengths) for lengths in lengths_of(rows)]
        assert all(getattr(g, name) == 0 for g in cubics for name in vanishing)
    whole = [exact.cubic(lengths) for lengths in lengths_of(FAMILIES["coefficient-zero"].rows(0, 400))]
    assert all(g.n1 == 0 or g.n2 == 0 for g in whole)


def test_interior_positions_with_a_vanishing_coefficient_and_a_waist_above_one_occur() -> None:
    """What Proposition 5 as printed leaves out: Δ > 0, a > 1, interior, c2 = 0 or c1 = 0."""
    left_out = Counter()
    rows = FAMILIES["coefficient-zero"].rows(0, 400)
    for lengths, (a, _) in zip(lengths_of(rows), ratios(rows), strict=True):
        g = exact.cubic(lengths)
        if a > 1 and exact.position(lengths) is INTERIOR:
            left_out["c2" if g.n2 == 0 else "c1"] += 1
    assert min(left_out["c1"], left_out["c2"]) > 20


def test_centres_of_axis_waist_and_on_surface_families_lie_there_exactly() -> None:
    assert (FAMILIES["axis"].rows(0, COUNT)[:, 4:6] == 0).all()
    assert (FAMILIES["axis"].rows(0, COUNT)[:, 6] == 0).any()
    assert (FAMILIES["waist"].rows(0, COUNT)[:, 6] == 0).all()
    for alpha, gamma, _, _, x, y, z in fractions(FAMILIES["on-surface"].rows(0, 300)):
        assert (x * x + y * y) / (alpha * alpha) - (z / gamma) ** 2 == 1


def test_regime_borders_family_has_rows_on_each_border_and_one_ulp_beside_it() -> None:
    sides = {"a = 1": Counter(), "c² = a": Counter()}
    for a, c in ratios(FAMILIES["regime-borders"].rows(0, 600)):
        offset, border = min((abs(a - 1), a - 1, "a = 1"), (abs(c * c / a - 1), c * c / a - 1, "c² = a"))[1:]
        assert abs(offset) < Fraction(1, 2**50)
        sides[border][(offset > 0) - (offset < 0)] += 1
    for counts in sides.values():
        assert min(counts[-1], counts[0], counts[1]) > 60


def test_crossings_in_two_curves_are_common_outside_the_regimes() -> None:
    rows = FAMILIES["out-of-regime"].rows(0, 600)
    assert all(a < 1 or c * c < a for a, c in ratios(rows))
    found = kinds(rows)
    assert found[Kind.CROSSING_GROOVE_TWO_CURVES] > 60
    assert found[Kind.CROSSING_THROAT_TWO_CURVES] > 60


def test_osculation_and_near_axis_families_approach_their_borders_from_both_sides() -> None:
    for name, gap in (("osculation", lambda a, c: c * c / a - 1), ("near-axis", lambda a, c: a - 1)):
        gaps = [gap(a, c) for a, c in ratios(FAMILIES[name].rows(0, 800))]
        assert max(map(abs, gaps)) < Fraction(1, 4)
        assert sum(0 < abs(value) < Fraction(1, 2**40) for value in gaps) > 80
        assert min(sum(value > 0 for value in gaps), sum(value < 0 for value in gaps)) > 200
