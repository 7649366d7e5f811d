"""The exact decision against hand-worked pairs, against proofs, and against what must hold of any right answer."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.certificate import check_certificate
from hypcheck.truth.exact import cubic
from hypcheck.truth.kinds import Kind
from hypcheck.truth.prove import prove
from tests.support.pairs import KINDS, WITNESSES, pairs


@pytest.mark.parametrize(("row", "position", "clearance", "why"), WITNESSES)
def test_exact_decisions_of_known_witnesses_are_right(row, position, clearance, why):
    decision = exact.decide(Pair.from_row(row).lengths)
    assert decision.position is position, why
    assert decision.tangent == (clearance == 0), why


@pytest.mark.parametrize(("row", "kind"), KINDS)
def test_exact_kinds_of_known_witnesses_are_right(row, kind):
    assert exact.decide(Pair.from_row(row).lengths).kind is kind


@pytest.mark.slow
@given(pairs)
def test_every_exact_answer_gets_a_certificate(pair):
    decision = exact.decide(pair.lengths)
    certificate = prove(pair, decision)
    assert certificate.position is decision.position
    assert check_certificate(pair, certificate)
    assert (certificate.double_root is not None) == decision.tangent


@given(pairs)
def test_kind_of_an_exact_decision_agrees_with_its_position_and_tangency(pair):
    decision = exact.decide(pair.lengths)
    assert decision.kind.position is decision.position
    assert decision.kind.tangent == decision.tangent


@given(pairs)
def test_position_and_decide_give_the_same_position(pair):
    assert exact.position(pair.lengths) is exact.decide(pair.lengths).position


@given(pairs, st.integers(-3, 3), st.integers(-3, 3))
def test_exact_decision_does_not_change_if_radial_or_axial_lengths_are_scaled(pair, radial, axial):
    lengths = pair.lengths
    scaled = type(lengths)(
        *(value * 2 ** (3 + radial) for value in (lengths.alpha, lengths.b, lengths.x, lengths.y)),
        *(value * 2 ** (3 + axial) for value in (lengths.gamma, lengths.d, lengths.z)),
    )
    assert exact.decide(scaled) == exact.decide(lengths)


@given(pairs)
def test_exact_decision_is_the_same_for_mirrored_and_rotated_pairs(pair):
    row = pair.row
    mirrored = Pair(*row[:4], -pair.y, pair.x, -pair.z)
    assert exact.decide(mirrored.lengths) == exact.decide(pair.lengths)


@given(pairs)
def test_the_exact_cubic_is_the_determinant_of_the_pencil(pair):
    """g at the poles and at 0, from the definition of the two quadrics, over N = b² d²."""
    g = cubic(pair.lengths)
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / b**2, (z / d) ** 2

    def at(t: Fraction) -> Fraction:
        return ((g.n3 * t + g.n2) * t + g.n1) * t + g.n0

    assert at(Fraction(0)) == -A * B * g.n3
    assert at(-A) == -A * P * (A + B) * g.n3
    assert at(B) == -B * Q * (A + B) * g.n3


@pytest.mark.parametrize("ulps", [-1, 0, 1])
def test_pairs_one_ulp_from_a_tangency_are_decided_rightly(ulps):
    """r − a = 1 is a tangency from outside; one ulp of x to either side is contact, or clear."""
    x = 3.0 + ulps * 2.0**-51
    decision = exact.decide(Pair(2.0, 5.0, 1.0, 1.0, x, 0.0, 0.0).lengths)
    assert decision.tangent == (ulps == 0)
    assert decision.position is (Position.EXTERIOR if ulps > 0 else Position.CONTACT)


@pytest.mark.parametrize("bottom", [1, 2, 9])
@pytest.mark.parametrize(("double", "simple"), [(3, 5), (3, 2), (4, 5), (4, 3), (7, 30)])
def test_kind_of_a_double_root_beyond_both_poles_is_told_by_the_place_of_the_simple_root(double, simple, bottom):
    """g = (x − m)² (x − n) and B = 1 < m, with m as a fraction of any denominator."""
    g = SimpleNamespace(n3=1, n2=-(2 * double + simple), s=1, t=1)
    found = exact._outer_tangency(g, double * bottom, bottom)
    beyond = simple > double
    assert found is (Kind.CROSSING_GROOVE_ISOLATED_POINT if beyond else Kind.CROSSING_GROOVE_NODE)
