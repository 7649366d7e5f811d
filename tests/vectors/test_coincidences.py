"""Tangencies, other double roots, the ring and the borders of regimes are met exactly, and by rows beside them."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.vectors import coincidences, double_roots
from hypcheck.vectors.double_roots import gather
from hypcheck.vectors.draw import BLOCK, Draw
from hypcheck.vectors.families import FAMILIES, SWEEP_FAMILIES
from hypcheck.vectors.sweeps import more_than_a_radius_away, ring_attempt
from tests.support import inside
from tests.support.inside import Kind, cubic, hits_at_size
from tests.vectors.case_rows import COUNT, fractions, kinds, lengths_of, ratios

EXTERIOR, CONTACT, INTERIOR = Position


def test_tangent_family_is_tangent_and_has_every_kind_of_tangency() -> None:
    found = kinds(FAMILIES["tangent"].rows(0, 400))
    assert set(found) == {kind for kind in Kind if kind.tangent}
    assert min(found.values()) >= 40


def test_degenerate_crossings_are_of_every_kind_with_a_double_root_and_no_tangency() -> None:
    found = kinds(FAMILIES["degenerate-crossing"].rows(0, 400))
    assert set(found) == {
        Kind.CROSSING_THROAT_NODE,
        Kind.CROSSING_GROOVE_NODE,
        Kind.CROSSING_GROOVE_ISOLATED_POINT,
        Kind.CROSSING_GROOVE_CUSP,
    }
    assert min(found.values()) >= 40


def test_rows_beside_degenerate_crossings_cross_in_one_curve_and_in_two_curves_of_either_kind() -> None:
    rows = FAMILIES["degenerate-neighbourhood"].rows(0, 400)
    found = kinds(rows)
    assert {Kind.CROSSING_ONE_CURVE, Kind.CROSSING_GROOVE_TWO_CURVES, Kind.CROSSING_THROAT_TWO_CURVES} <= set(found)


@pytest.mark.parametrize("construct", [double_roots.by_ratios, double_roots.by_angle])
def test_tangency_and_side_of_constructed_tangencies_are_those_of_the_exact_decision(construct: type) -> None:
    found = construct(Draw("construction"), 600)
    usable = found.usable
    assert usable.mean() > 0.5
    for row, outer, tangent in zip(found.rows[usable], found.outer[usable], found.tangent[usable], strict=True):
        decision = inside.decide(Pair.from_row(row.tolist()).lengths)
        assert decision.tangent == tangent
        if tangent:
            assert decision.kind.limit_of is (EXTERIOR if outer else INTERIOR)
        else:
            assert (decision.kind is Kind.CROSSING_THROAT_NODE) != outer


@pytest.mark.parametrize("construct", [double_roots.by_ratios, double_roots.by_angle])
def test_sine_of_a_tangency_construction_agrees_with_the_exact_normal(construct: type) -> None:
    """a² cos² − c² sin² = m², with the double root m taken from the exact cubic."""
    found = construct(Draw("sine"), 300)
    for row, sine in zip(found.rows[found.usable], found.sine[found.usable].tolist(), strict=True):
        g = cubic(Pair.from_row(row.tolist()).lengths)
        m = Fraction(9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * (g.n2 * g.n2 - 3 * g.n3 * g.n1))
        A, B = Fraction(g.p, g.q), Fraction(g.s, g.t)
        exact_square = (A - m * m) / (A + B)
        assert abs(Fraction(sine) ** 2 - exact_square) <= exact_square * Fraction(1, 2**50)


def test_ring_family_is_clear_with_a_vanishing_discriminant() -> None:
    assert set(kinds(FAMILIES["ring"].rows(0, 600))) == {Kind.EXTERIOR_RING}


def test_rows_of_ring_neighbourhood_are_from_1e_12_to_1e_2_radii_away_from_a_ring() -> None:
    rows = FAMILIES["ring-neighbourhood"].rows(0, 2000)
    distances = []
    for alpha, gamma, b, d, x, y, z in fractions(rows):
        A, B = (alpha / b) ** 2, (gamma / d) ** 2
        on_ring = (B + 1) * (A + B) / B
        square = (x * x + y * y) / (b * b)
        radial = float((square - on_ring) / (2 * on_ring)) * float(on_ring) ** 0.5
        distances.append(max(abs(radial), abs(float(z / d))))
        assert B * B > A, "c² > a, or the root is a tangency"
    assert np.max(distances) < 0.04
    octaves = np.floor(np.log2(np.maximum(distances, 1e-13)))
    assert set(range(-38, -5)) <= set(octaves.astype(int).tolist())
    assert np.mean(rows[:, 6] == 0) > 0.5
    assert any(abs(float(a) - 8) < 1e-12 and abs(float(c) - 356 / 3) < 1e-9 for a, c in ratios(rows))


def test_near_tangent_rows_are_near_a_tangency() -> None:
    """A change of every length by a relative 2⁻⁸ is enough to turn each into the other position."""
    for name, clear in (("near-tangent-outside", EXTERIOR), ("near-tangent-inside", INTERIOR)):
        for lengths in lengths_of(FAMILIES[name].rows(0, 300)):
            spheroids = [
                Lengths(
                    **{key: getattr(lengths, key) * 256 for key in ("alpha", "x", "y", "gamma", "z")},
                    b=lengths.b * k,
                    d=lengths.d * k,
                )
                for k in (246, 266)
            ]
            assert [inside.position(changed) for changed in spheroids] == [clear, CONTACT]


def test_near_tangent_rows_reach_down_to_one_ulp() -> None:
    """Among the rows moved by ulps a few are tangent again when one length is moved back by one ulp."""
    steps = Counter()
    for name in ("near-tangent-outside", "near-tangent-inside"):
        for row in FAMILIES[name].rows(0, 400).tolist():
            for column in range(7):
                for toward in (np.inf, -np.inf):
                    back = [*row]
                    back[column] = float(np.nextafter(row[column], toward))
                    if back[column] and row[column] and inside.decide(Pair.from_row(back).lengths).tangent:
                        steps[name] += 1
    assert min(steps.values()) >= 3
    assert len(steps) == 2


def test_rows_constructed_for_a_vanishing_coefficient_have_it_exactly_0() -> None:
    for construct, vanishing in (
        (coincidences.second_coefficient_zero, {"n2"}),
        (coincidences.first_coefficient_zero, {"n1"}),
        (coincidences.first_coefficient_zero_for_any_waist, {"n1"}),
        (coincidences.both_coefficients_zero, {"n1", "n2"}),
    ):
        rows = construct(Draw("zero"), 200)
        cubics = [cubic(lengths) for lengths in lengths_of(rows)]
        assert all(getattr(g, name) == 0 for g in cubics for name in vanishing)
    whole = [cubic(lengths) for lengths in lengths_of(FAMILIES["coefficient-zero"].rows(0, 400))]
    assert all(g.n1 == 0 or g.n2 == 0 for g in whole)


def test_interior_positions_with_a_vanishing_coefficient_and_a_waist_above_one_occur() -> None:
    """What Proposition 5 as printed leaves out: Δ > 0, a > 1, interior, c2 = 0 or c1 = 0."""
    left_out = Counter()
    rows = FAMILIES["coefficient-zero"].rows(0, 400)
    for lengths, (a, _) in zip(lengths_of(rows), ratios(rows), strict=True):
        g = cubic(lengths)
        if a > 1 and inside.position(lengths) is INTERIOR:
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


def test_generated_sweeps_across_a_ring_are_clear_where_rings_beside_the_surface_were_replaced() -> None:
    rows = SWEEP_FAMILIES["way-ring"].rows(1, BLOCK)
    before = gather(Draw("way-ring", 1, 1, 0), BLOCK, ring_attempt)
    replaced = (rows != before).any(axis=1)
    assert 0 < replaced.sum() < 0.05 * BLOCK
    assert all(hits_at_size(row) for row in before[replaced].tolist())
    assert not any(hits_at_size(row) for row in rows[:64].tolist())
    near = ~more_than_a_radius_away(rows)
    assert near.any()
    assert not any(hits_at_size(row) for row in rows[near].tolist())
