"""The table of root patterns itself: complete by parity, and right against geometry that knows nothing of the pencil.

The independent decision: let H be the scaled hyperboloid and the ball's centre be (r, 0, z). The points of H at height
ζ form a circle of radius ρ, ρ² = A (1 + ζ²/B); the one at azimuth θ is on the sphere when K(ζ) = 2 r ρ cos θ with
K = ρ² + P + (ζ − z)² − 1. So the common points lie at the heights where W = K² − 4 P ρ² ≤ 0, a quartic in ζ, and its
real roots and their multiplicities tell the whole contact set: an interval of W < 0 is a closed curve, an isolated
root of even multiplicity a point, one inside an interval a node, one of multiplicity 3 a cusp. When r = 0 the roots of
K alone are whole circles. Nothing in common means clear, and then the centre's own side of H says which way.
"""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction

import sympy
from sympy.abc import w

from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger.checks import admissible
from tests.support.inside import COMPLEX, KIND_OF, PATTERNS, Invariants, Kind, classify_invariants

# Multiplicities of the real roots of W in ascending order, for each contact set off the axis …
CONTACT_SETS = {
    "nothing": [()],
    "1 point": [(2,), (4,)],
    "2 points": [(2, 2)],
    "1 curve": [(1, 1)],
    "2 curves": [(1, 1, 1, 1)],
    "1 curve with a node": [(1, 2, 1)],
    "1 curve and 1 isolated point": [(2, 1, 1), (1, 1, 2)],
    "1 curve with a cusp": [(1, 3), (3, 1)],
}
# … and of K, on it.
CIRCLES = {"nothing": [()], "1 circle": [(2,)], "2 curves": [(1, 1)]}


def _poly(*coefficients):
    return sympy.Poly([sympy.Rational(c.numerator, c.denominator) for c in coefficients], w)


def meridian(pair):
    """W and K in the unknown w = ζ/z, or ζ where z = 0; either way their coefficients are rational."""
    A, B, P, Q = pair.A, pair.B, pair.P, pair.Q
    square = Q if Q else Fraction(1)  # ζ² = square w²
    K = _poly(square * (A / B + 1), -2 * Q, Q + A + P - 1)
    return K**2 - _poly(4 * P * A * square / B, Fraction(0), 4 * P * A), K


def _side(pair):
    on_which_side = pair.P / pair.A - pair.Q / pair.B - 1
    assert on_which_side != 0
    return Position.EXTERIOR if on_which_side > 0 else Position.INTERIOR


def check_against_geometry(pair):
    """Assert that the kind's position and contact set are those of the geometry; return the kind."""
    report = classify_invariants(pair)
    kind = report.kind
    W, K = meridian(pair)
    roots = (W if pair.P else K).intervals()
    found = tuple(multiplicity for _, multiplicity in roots)
    assert found in (CONTACT_SETS if pair.P else CIRCLES).get(kind.contact_set, []), (pair, kind, found)
    assert (found == (4,)) == (kind is Kind.EXTERIOR_TANGENT_OSCULATING)
    assert kind.position is (Position.CONTACT if found else _side(pair)), (pair, kind)
    if kind.tangent:
        assert kind.limit_of is _side(pair), (pair, kind)
    if kind in (Kind.CROSSING_THROAT_TWO_CURVES, Kind.CROSSING_GROOVE_TWO_CURVES) and pair.P:
        # At the end of an interval cos θ = ±1 is the sign of K; a curve goes round the axis if its ends differ.
        ends = [_sign_at_root(W, K, interval) for interval, _ in roots]
        round_the_axis = kind is Kind.CROSSING_THROAT_TWO_CURVES
        assert (ends[0] != ends[1]) == (ends[2] != ends[3]) == round_the_axis, (pair, kind, ends)
    assert kind in report.literal_kinds
    assert report.literal in (None, kind.position)
    return kind


def _sign_at_root(W, K, interval):
    lower, upper = interval
    while K.count_roots(lower, upper):
        lower, upper = W.refine_root(lower, upper, steps=4)
    return K.eval(lower) > 0


def _rational(rng, top=12):
    return Fraction(rng.randint(1, top), rng.randint(1, 6))


def _sizes(rng):
    """A and B: all four regimes, and their borders a = 1 and c² = a."""
    A, B = _rational(rng), _rational(rng)
    one = Fraction(1)
    return rng.choice([(A, B), (A, B), (one, B), (B * B, B), (one, one), (A, B / 8), (A / 8, B)])


def _root(rng, A, B):
    near = Fraction(rng.randint(1, 9), 8)
    return rng.choice([-A, B, -A * near, B * near, -A * (1 + near), B * (1 + near), _rational(rng), -_rational(rng)])


def _pairs(rng, wanted):
    """Pairs by prescribed roots (see test_truth_roots), simple, double and triple; a hair off these; and at random."""
    while wanted:
        A, B = _sizes(rng)
        first = _root(rng, A, B)
        second = rng.choice([first, first, _root(rng, A, B)])
        if rng.random() < 0.1:
            first = second = abs(first)
            A = first**3 / B  # then the third root is the same
        third = A * B / (first * second)
        P, Q = (-(x - first) * (x - second) * (x - third) / (mark * (A + B)) for x, mark in ((-A, A), (B, B)))
        hair = 1 + Fraction(rng.choice([1, -1]), 10 ** rng.randint(1, 12))
        P, Q = rng.choice([(P, Q), (P, Q), (P * hair, Q), (P, Q * hair), (_rational(rng), _rational(rng))])
        P, Q = rng.choice([(P, Q)] * 6 + [(Fraction(0), Q), (P, Fraction(0))])
        if P >= 0 and Q >= 0:
            wanted -= 1
            yield Invariants(A, B, P, Q)


def _sign(number):
    return (number > 0) - (number < 0)


def test_table_of_root_patterns_agrees_with_geometry():
    """Every kind, all four regimes and their borders; a pair outside the table would raise."""
    counts, regimes = Counter(), set()
    for pair in _pairs(random.Random(20), 3000):  # noqa: S311
        counts[check_against_geometry(pair)] += 1
        regimes.add((_sign(pair.A - 1), _sign(pair.B**2 - pair.A)))
    assert all(counts[kind] >= 5 for kind in Kind), counts
    assert len(regimes) == 9


def test_table_of_root_patterns_lists_each_admissible_pattern_once():
    listed = [pattern for patterns in PATTERNS.values() for pattern in patterns]
    assert sorted(listed) == sorted(admissible())
    assert len(KIND_OF) == len(listed)
    assert any(COMPLEX in pattern for pattern in listed)
