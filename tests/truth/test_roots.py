"""The roots oracle on witnesses worked out by hand, on prescribed roots, and with another table."""

from __future__ import annotations

import itertools
from fractions import Fraction

import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import (
    Invariants,
    Kind,
    RootPlace,
    _none_by_descartes,
    classify_by_roots,
    classify_invariants,
    coefficients,
    cubic,
    decide,
    linear_factor,
    polynomial_product,
    real_roots,
)
from tests.support.quadrics import isolate
from tests.truth.test_steps import discriminant

# Rows alpha, gamma, b, d, x, y, z. With z = 0 the cubic is (λ − B)(λ² − (P − 1 − A) λ + A); with r = 0 it is
# (λ + A)(λ² − (B + Q − 1) λ − B): roots, places and kinds below follow by hand.
WITNESSES = [
    ((3, 3, 1, 1, 1, 0, 0), Kind.INTERIOR),  # λ² + 9λ + 9: −7.9 and −1.1, −A = −9
    ((3, 3, 1, 1, 0, 0, 1), Kind.INTERIOR),  # −9 = −A, and λ² − 9λ − 9: −0.9
    ((3, 3, 1, 1, 2, 0, 0), Kind.INTERIOR_TANGENT_POINT),  # reaches (3, 0, 0): (λ + 3)²
    ((1, 1, 1, 1, 0, 0, 0), Kind.INTERIOR_TANGENT_CIRCLE),  # fits the throat: λ² − 1, −A = −1
    ((2, 4, 3, 3, 0, 0, 5), Kind.INTERIOR_TANGENT_CIRCLE),  # Q = (1 − A)(A + B)/A = 25/9
    ((0.25, 1, 1, 1, 0.5, 0, 0), Kind.CROSSING_THROAT_TWO_CURVES),  # λ² + 13/16 λ + 1/16: −0.73, −0.09; −A = −1/16
    ((0.5, 1, 1, 1, 0, 0, 0), Kind.CROSSING_THROAT_TWO_CURVES),  # −1 below −A = −1/4
    ((0.5, 1, 1, 1, 0.5, 0, 0), Kind.CROSSING_THROAT_NODE),  # reaches (−1/2, 0, 0): (λ + 1/2)², −A = −1/4
    ((1, 1, 1, 1, 1, 0, 0), Kind.CROSSING_ONE_CURVE),  # λ³ − 1
    ((1, 8, 1, 1, 4, 0, 0), Kind.EXTERIOR),  # λ² − 14λ + 1: 0.07 and 13.9 below B = 64
    ((1, 1, 1, 1, 4, 0, 0), Kind.EXTERIOR),  # the same, 13.9 above B = 1
    ((1, 2, 1, 1, 2.5, 0, 0), Kind.EXTERIOR_RING),  # λ² − 17/4 λ + 1: 1/4 and 4 = B
    ((7, 7, 1, 1, 6, 8, 0), Kind.EXTERIOR_RING),  # λ² − 50λ + 49: 1 and 49 = B
    ((1, 2, 1, 1, 2, 0, 0), Kind.EXTERIOR_TANGENT_POINT),  # reaches (1, 0, 0): (λ − 1)², B = 4
    ((1, 0.5, 1, 1, 2.5, 0, 0), Kind.EXTERIOR_TANGENT_TWO_POINTS),  # (2, 0, ±√3/4) at distance 1; 1/4 = B and 4
    ((4, 2, 1, 1, 5, 0, 0), Kind.EXTERIOR_TANGENT_OSCULATING),  # (λ − 4)³, B = 4
    ((2, 0.5, 1, 1, 4, 0, 0), Kind.CROSSING_GROOVE_TWO_CURVES),  # λ² − 11λ + 4: 0.38 and 10.6 above B = 1/4
    ((4, 1, 1, 1, 5, 0, 0), Kind.CROSSING_GROOVE_NODE),  # (λ − 4)² above B = 1
    # Off the axes, from the double root m and the third root n = A B/m² (P = (A + m)²(A + n)/(A(A + B)) and so on):
    ((51, 6, 27, 9, 74, 0, 4), Kind.CROSSING_GROOVE_ISOLATED_POINT),  # B = 4/9, m = 1, n = 1156/729
    ((5, 4, 3, 7, 3, 7, 3), Kind.CROSSING_GROOVE_NODE),  # B = 16/49, m = 4/3, n = 25/49
    ((1, 1, 27, 27, 4, 22, 16), Kind.CROSSING_GROOVE_CUSP),  # A = B = 1/729, m = n = 1/81
]


@pytest.mark.parametrize(("row", "kind"), WITNESSES)
def test_the_roots_oracle_is_right_on_each_known_witness(row, kind):
    report = classify_by_roots(Pair.from_row(row))
    assert report.kind is kind
    assert report.position is kind.position
    assert report.tangent is kind.tangent


def test_every_kind_has_a_witness_in_the_tests_of_roots():
    assert {kind for _, kind in WITNESSES} == set(Kind)


def test_cubic_of_the_roots_oracle_is_the_determinant_of_the_pencil():
    """det(λH + S) = (A + λ) g(λ)/(A² B), the matrices written out with the centre at azimuth 0."""
    lam = sympy.Symbol("lambda")
    for numbers in (("4", "9", "5", "2"), ("1/4", "3", "0", "7/5"), ("2", "1/3", "9/2", "0")):
        A, B, r, z = map(sympy.Rational, numbers)
        pair = Invariants(*map(Fraction, numbers[:2]), *(Fraction(number) ** 2 for number in numbers[2:]))
        hyperboloid = sympy.diag(1 / A, 1 / A, -1 / B, -1)
        sphere = sympy.Matrix([[1, 0, 0, -r], [0, 1, 0, 0], [0, 0, 1, -z], [-r, 0, -z, r**2 + z**2 - 1]])
        pencil = sympy.Poly((lam * hyperboloid + sphere).det() * A**2 * B, lam)
        g = sympy.Poly(coefficients(pair), lam)
        assert g.LC() > 0
        assert (pencil - sympy.Poly(A + lam, lam) * g.monic()).is_zero


small = st.builds(Fraction, st.integers(1, 40), st.integers(1, 12))


@st.composite
def prescribed(draw):
    """Invariants with three rational roots chosen beforehand, many of them at −A or B, repeated, or close together.

    A monic cubic with roots of product A B has g(0) = −A B; it is the g of P = −g(−A)/(A (A + B)) and
    Q = −g(B)/(B (A + B)) whenever these are ≥ 0.
    """
    B = draw(small)
    A = draw(st.one_of(small, st.just(Fraction(1)), st.just(B**2), small.map(lambda x: x / 40)))
    somewhere = st.one_of(
        st.sampled_from([-A, B]),
        small.map(lambda x: -A * x / 10),
        small.map(lambda x: B * x / 10),
    )
    first = draw(somewhere)
    close = st.sampled_from([first, first * (1 + Fraction(1, 2**60)), first * (1 + Fraction(1, 10**40))])
    second = draw(st.one_of(somewhere, close))
    roots = sorted((first, second, A * B / (first * second)))
    g_at = [(x - roots[0]) * (x - roots[1]) * (x - roots[2]) for x in (-A, B)]
    P, Q = -g_at[0] / (A * (A + B)), -g_at[1] / (B * (A + B))
    assume(P >= 0)
    assume(Q >= 0)
    return Invariants(A, B, P, Q), roots


@pytest.mark.slow
@given(prescribed())
def test_roots_oracle_finds_the_places_of_prescribed_roots_with_their_multiplicities(case):
    pair, roots = case
    expected = []
    for root in sorted(set(roots)):
        marks = [root < -pair.A, root == -pair.A, -pair.A < root < 0, 0 < root < pair.B, root == pair.B, root > pair.B]
        expected.append((list(RootPlace)[marks.index(True)], roots.count(root)))
    assert real_roots(pair) == expected
    assert not classify_invariants(pair).complex_pair


integers = st.integers(-(10**6), 10**6)
nonzero = integers.filter(bool)


@given(st.one_of(st.tuples(nonzero, integers, nonzero), st.tuples(nonzero, integers, integers, nonzero)))
def test_each_enclosure_of_a_root_contains_exactly_one_root_by_the_count_of_sympy(f):
    polynomial = sympy.Poly(f, sympy.Symbol("x"))
    assume(polynomial.discriminant() != 0)
    enclosures = isolate(f)
    assert len(enclosures) == polynomial.count_roots()
    assert all(polynomial.count_roots(low, high) == 1 for low, high in enclosures)


def test_roots_oracle_separates_two_roots_beside_a_tangency():
    """(1,1,3,1) at x = 4 touches; y = 1e-160 lifts it off, and the two roots are about 1e-160 apart."""
    assert classify_by_roots(Pair(1, 1, 3, 1, 4, 0, 0)).kind is Kind.EXTERIOR_TANGENT_POINT
    for y in (1e-160, 5e-324):
        assert classify_by_roots(Pair(1, 1, 3, 1, 4, y, 0)).kind is Kind.EXTERIOR


@pytest.mark.parametrize(
    ("row", "literal", "kinds"),
    [
        ((0.5, 1, 1, 1, 0, 0, 2), None, {Kind.INTERIOR, Kind.CROSSING_THROAT_TWO_CURVES}),
        ((0.25, 1, 1, 1, 0.5, 0, 0), None, {Kind.INTERIOR, Kind.CROSSING_THROAT_TWO_CURVES}),
        ((2, 1, 1, 1, 4, 0, 0), None, {Kind.EXTERIOR, Kind.CROSSING_GROOVE_TWO_CURVES}),
        ((2, 0.5, 1, 1, 4, 0, 0), None, {Kind.EXTERIOR, Kind.CROSSING_GROOVE_TWO_CURVES}),
        ((1, 2, 1, 1, 2.5, 0, 0), None, {Kind.EXTERIOR_RING, Kind.EXTERIOR_TANGENT_POINT}),
        ((1, 2, 1, 1, 2, 0, 0), None, {Kind.EXTERIOR_RING, Kind.EXTERIOR_TANGENT_POINT}),
        ((3, 3, 1, 1, 1, 0, 0), Position.INTERIOR, {Kind.INTERIOR}),
        ((1, 8, 1, 1, 4, 0, 0), Position.EXTERIOR, {Kind.EXTERIOR}),
        ((1, 1, 1, 1, 1, 0, 0), Position.CONTACT, {Kind.CROSSING_ONE_CURVE}),
        ((3, 3, 1, 1, 2, 0, 0), Position.CONTACT, {Kind.INTERIOR_TANGENT_POINT}),
        # At the borders a = 1 and c² = a, where kinds end, and a little beyond a = 1.
        ((1, 1, 1, 1, 0, 0, 5), Position.INTERIOR, {Kind.INTERIOR}),
        ((5, 5, 4, 4, 1, 0, 0), Position.CONTACT, {Kind.INTERIOR_TANGENT_POINT}),
        ((4, 2, 1, 1, 5, 0, 0), Position.CONTACT, {Kind.EXTERIOR_TANGENT_OSCULATING}),
        ((12, 6, 3, 3, 14, 7, 1), Position.CONTACT, {Kind.EXTERIOR_TANGENT_POINT}),  # A = 16, B = 4, m = 8/3, n = 9
    ],
)
def test_literal_kinds_are_those_that_signs_and_multiplicities_of_the_roots_allow(row, literal, kinds):
    """Signs and multiplicities alone: ambiguous for a < 1, for c² < a, and for a double positive root when c² > a."""
    report = classify_by_roots(Pair.from_row(row))
    assert report.literal is literal
    assert set(report.literal_kinds) == kinds


def test_a_triple_root_means_an_exterior_osculating_tangency_if_c_squared_equals_a():
    assert classify_by_roots(Pair(4, 2, 1, 1, 5, 0, 0)).literal_kinds == (Kind.EXTERIOR_TANGENT_OSCULATING,)


ROW = (1, 0.25, 1, 1, 2, 0, 0.5)  # three roots above B


def test_roots_oracle_raises_an_error_for_an_unlisted_or_impossible_pattern(monkeypatch):
    for table in ({}, {">B >B >B": Kind.EXTERIOR_RING}):
        monkeypatch.setattr("hypcheck.truth.roots.KIND_OF", table)
        with pytest.raises(AssertionError, match=r"not possible: >B >B >B, for Pair\(alpha=1.0"):
            classify_by_roots(Pair.from_row(ROW))


def test_double_roots_of_small_pairs_have_the_kinds_of_the_exact_decision():
    """Every pair of these integers whose discriminant is 0."""
    kinds = set()
    for row in itertools.product(range(1, 4), range(1, 4), range(1, 4), range(1, 4), range(7), (0,), range(4)):
        pair = Pair(*map(float, row))
        g = cubic(pair.lengths)
        if discriminant((g.n3, g.n2, g.n1, g.n0)) == 0:
            kind = decide(pair.lengths).kind
            assert classify_by_roots(pair).kind is kind, row
            kinds.add(kind)
    assert len(kinds) >= 8


def test_the_rule_of_signs_excludes_no_polynomial_that_has_a_root_from_0_to_1():
    """And it does exclude one whose values grow from 1 on."""
    for root in (Fraction(1, 9), Fraction(1, 2), Fraction(7, 8), Fraction(99, 100)):
        for others in itertools.product((Fraction(-3), Fraction(-1, 5), Fraction(3, 2), Fraction(40)), repeat=2):
            factors = [linear_factor(each) for each in (root, *others)]
            assert not _none_by_descartes(factors[0])
            assert not _none_by_descartes(polynomial_product(factors[0], factors[1]))
            assert not _none_by_descartes(polynomial_product(polynomial_product(*factors[:2]), factors[2]))
    assert _none_by_descartes((1, 2, 1))
    assert _none_by_descartes((1, -6, 8))  # roots 2 and 4
