"""The exact decision against hand-worked pairs, against proofs, and against what must hold of any right answer."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given

from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import decide
from tests.support.inside import exact_cubic as cubic
from tests.support.pairs import KINDS, WITNESSES, pairs


@pytest.mark.parametrize(("row", "position", "clearance", "why"), WITNESSES)
def test_exact_decisions_of_known_witnesses_are_right(row, position, clearance, why):
    decision = decide(Pair.from_row(row).lengths)
    assert decision.position is position, why
    assert decision.tangent == (clearance == 0), why


@pytest.mark.parametrize(("row", "kind"), KINDS)
def test_exact_kinds_of_known_witnesses_are_right(row, kind):
    assert decide(Pair.from_row(row).lengths).kind is kind


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
    decision = decide(Pair(2.0, 5.0, 1.0, 1.0, x, 0.0, 0.0).lengths)
    assert decision.tangent == (ulps == 0)
    assert decision.position is (Position.EXTERIOR if ulps > 0 else Position.CONTACT)
