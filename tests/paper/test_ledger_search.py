"""The space of small pairs: its facts are right, its witnesses the simplest, and every introduced mistake has one."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest
import sympy

from hypcheck.derivation.root_chains import PATTERNS
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger import statements as say
from hypcheck.paper.ledger.points import (
    Point,
    PointWitness,
    Statement,
    counterexample,
    facts,
    facts_in_order,
    first_point,
    numbers,
    rational,
    root,
    space,
    strata,
    witness,
)
from tests.support.fractions_truth import exact_position
from tests.support.inside import Certificate, classify_by_roots

LAMBDA = sympy.Symbol("lambda")


@cache
def everything():
    return tuple(facts_in_order())


@cache
def sample():
    return (*everything()[::83], *[each for each in everything() if each.delta == 0][::8])


def cubic(each):
    """g from its definition, by hand: (A+λ)(B−λ)(P+Q−1−λ) − A P (B−λ) − B Q (A+λ)."""
    a, c, r, z = (sympy.Rational(value) for value in (each.point.a, each.point.c, each.point.r, each.point.z))
    A, B, P, Q = a**2, c**2, r**2, z**2
    at = LAMBDA
    return sympy.Poly((A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at), LAMBDA), A, B


def test_facts_of_a_point_equal_coefficients_slopes_and_roots_of_the_cubic_by_sympy():
    for each in sample()[::3]:
        g, A, B = cubic(each)
        _, c2, c1, c0 = g.all_coeffs()
        assert (each.c2, each.c1, each.c0) == (c2, c1, c0)
        assert each.delta == g.discriminant()
        assert (each.slope_at_B, each.slope_at_minus_A) == (g.diff().eval(B), g.diff().eval(-A))
        assert each.negative_roots == sum(bool(zero < 0) for zero in sympy.real_roots(g))


def test_pattern_of_roots_determines_the_position():
    """The table that the case splits of the propositions go through, against roots counted by Sturm's theorem."""
    assert {pattern_of(each) for each in sample()} == set(PATTERNS)
    for each in sample():
        assert pattern_of(each).position == each.position


def pattern_of(each):
    """The one pattern that a pair has; count_roots leaves multiple roots single, which Δ tells apart."""
    g, A, B = cubic(each)
    sign = (each.delta > 0) - (each.delta < 0)
    if sign <= 0:
        crowded = False
    elif each.negative_roots:
        crowded = g.count_roots(-sympy.oo, -A) == 2
    else:
        crowded = g.count_roots(0, B) < 2
    signs = (sign, each.c2 < 0 and each.c1 > 0, crowded, say.ring(each))
    (found,) = (p for p in PATTERNS if (p.delta, p.all_positive, p.crowded, p.ring) == signs)
    return found


def test_positions_of_search_points_agree_with_the_roots_oracle_and_exact_arithmetic():
    for each in sample():
        assert classify_by_roots(each.point.pair).position is each.position
        assert exact_position(each.point.pair.row) == each.position


def test_every_point_of_the_search_space_is_exact_in_float64():
    for each in sample():
        alpha, gamma, b, d, x, y, z = map(Fraction, each.point.pair.row)
        assert (alpha / b, gamma / d, x / b, z / d, y) == (each.point.a, each.point.c, each.point.r, each.point.z, 0)


def test_search_space_is_ordered_by_cost_without_duplicate_points():
    costs = [point.cost for point in space()]
    assert costs == sorted(set(costs))
    assert len(costs) > 10_000
    for stratum in strata():
        assert set(stratum.points()) <= set(space())


def test_search_points_of_each_stratum_have_the_property_that_its_name_says():
    conditions = {
        "the waist, z = 0": lambda each: each.point.z == 0,
        "the axis, r = 0": lambda each: each.point.r == 0,
        "a = 1": lambda each: each.point.a == 1,
        "c² = a": lambda each: each.B == each.point.a,
        "a narrow throat, a and c at most 1/4": lambda each: max(each.point.a, each.point.c) <= Fraction(1, 4),
        "c1 = 0": lambda each: each.c1 == 0,
        "c2 = 0": lambda each: each.c2 == 0,
        "g'(B) = 0 at the waist": lambda each: each.slope_at_B == 0 and each.point.z == 0,
        "g'(−A) = 0": lambda each: each.slope_at_minus_A == 0,
        "double roots": lambda each: each.delta == 0,
    }
    for stratum in strata():
        points = list(stratum.points())
        assert len(points) >= 10
        holds = conditions.get(stratum.name, lambda _: True)
        assert all(holds(facts(point)) for point in points[:: max(1, len(points) // 40)]), stratum.name
    assert {stratum.name for stratum in strata()} == {"anywhere", *conditions}


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (say.PROPOSITION_3_1, (1, 2, Fraction(5, 2), 0)),
        (say.PROPOSITION_5_2, (7, 7, 10, 0)),
        (say.ALL_POSITIVE, (1, 1, 1, 0)),
        (say.PROPOSITION_5_1_WITH_C1, (3, 1, 1, 0)),
    ],
)
def test_the_witness_of_a_false_statement_is_its_simplest_counterexample(statement, expected):
    found = counterexample(statement).found
    assert found.point == Point(*map(Fraction, expected))
    others = [each for each in everything() if statement.where(each) and not statement.says(each)]
    assert found.point.cost == min(each.point.cost for each in others)


def beyond_B(each):
    return each.c2 < -3 * each.B and each.slope_at_B > 0


def outside(each, *, ring=True):
    """The rule of all sizes for exterior, with the ring or without it."""
    return (each.delta > 0 and say.three_positive(each) and not beyond_B(each)) or (ring and say.ring(each))


def two_negative(each):
    return each.delta > 0 and not say.three_positive(each)


MISTAKES = {
    "without the ring": lambda each: say.exterior(each) == outside(each, ring=False),
    "the ring with A = B²": lambda each: (
        say.exterior(each) == (outside(each) or (each.Q == 0 and each.slope_at_B == 0 and each.A == each.B**2))
    ),
    "c2 ≥ −3B alone": lambda each: (
        say.exterior(each)
        == ((each.delta > 0 and say.three_positive(each) and each.c2 >= -3 * each.B) or say.ring(each))
    ),
    "g'(B) ≤ 0 alone": lambda each: (
        say.exterior(each) == ((each.delta > 0 and say.three_positive(each) and each.slope_at_B <= 0) or say.ring(each))
    ),
    "c2 < 3A alone": lambda each: say.interior(each) == (two_negative(each) and each.c2 < 3 * each.A),
    "g'(−A) > 0 alone": lambda each: say.interior(each) == (two_negative(each) and each.slope_at_minus_A > 0),
    "Δ ≥ 0": lambda each: (
        say.interior(each)
        == (each.delta >= 0 and not say.three_positive(each) and each.c2 < 3 * each.A and each.slope_at_minus_A > 0)
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_search_space_has_a_counterexample_to_every_known_wrong_rule_for_all_sizes(name):
    """Each condition of the repaired rule is needed, and the space shows it: its silence about the rule counts."""
    search = counterexample(Statement(name, lambda _: True, MISTAKES[name]))
    assert search.found is not None
    assert witness(search.found, name).holds


def test_repaired_propositions_have_counterexamples_outside_their_regime():
    for statement in (say.REPAIRED_3, say.REPAIRED_5):
        found = counterexample(Statement(statement.text, lambda _: True, statement.says)).found
        assert found is not None
        assert not statement.where(found)


def test_counterexample_search_counts_the_points_that_it_tried():
    assert first_point(lambda _: False).tried == len(everything())
    assert first_point(lambda _: True).tried == 1
    tall = first_point(lambda _: False, say.tall).tried
    assert 0 < tall < len(everything())


def test_a_witness_with_a_wrong_position_or_certificate_does_not_hold():
    found = counterexample(say.PROPOSITION_3_1).found
    right = witness(found, "the ring")
    assert right.holds
    for position in (Position.INTERIOR, Position.CONTACT):
        assert not PointWitness(replace(found, position=position), right.certificate, "").holds
        assert not PointWitness(found, replace(right.certificate, position=position), "").holds
    assert not PointWitness(found, Certificate(Position.EXTERIOR, multiplier=Fraction(9)), "").holds


def test_search_numbers_are_all_small_fractions_and_their_square_roots_are_exact_or_none():
    assert numbers(3) == tuple(map(Fraction, ("1", "1/2", "1/3", "2", "2/3", "3", "3/2")))
    assert root(Fraction(9, 4)) == Fraction(3, 2)
    assert root(Fraction(2)) is None
    assert root(Fraction(-4)) is None
    with pytest.raises(ValueError, match="not a whole number"):
        rational((LAMBDA,), LAMBDA / 2)
