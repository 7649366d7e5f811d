"""Every answer about a tilted pair is proved, and the checker accepts no proof of another answer."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import pytest

from hypcheck.geometry.pair import WITHOUT_ENDS, Lengths, Pair, Position
from tests.support.inside import Certificate, check_certificate, decide, exact, pivots, prove, quartic
from tests.support.inside import position as exact_position
from tests.truth.tilted_cases import SYMMETRIC, TANGENT, WITNESSES, grown, near_contact, random_rows

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR


def position(row):
    return exact_position(Lengths.of(row))


@pytest.fixture(scope="module")
def proofs():
    """Pairs of all positions with their proofs: worked by hand, random, and on both sides of contact in float64."""
    rows = [row for row, *_ in (*WITNESSES, *SYMMETRIC)] + random_rows(40)
    for row in random_rows(16, seed=1):
        rows += near_contact(row, position) or ()
    pairs = [Pair.from_row(row) for row in rows]
    return [(pair, prove(pair)) for pair in pairs]


def test_tilted_certificate_proves_its_position_and_is_refused_for_every_other(proofs):
    for pair, certificate in proofs:
        assert check_certificate(pair, certificate)
        for other in set(Position) - {certificate.position}:
            assert not check_certificate(pair, replace(certificate, position=other))
        at = certificate.multiplier
        if at is not None:
            assert not check_certificate(pair, replace(certificate, multiplier=-at))
            assert not check_certificate(pair, Certificate(CONTACT, double_root=at))


def test_double_root_proves_every_tangency_from_rational_rotations():
    for row, side in TANGENT:
        F = quartic(Lengths.of(row))
        root = exact.double_root(F) * F.side
        pair = SimpleNamespace(row=row, axis=row[7:], heights=WITHOUT_ENDS)
        assert root * side > 0
        assert check_certificate(pair, Certificate(CONTACT, double_root=root))
        assert not check_certificate(pair, Certificate(CONTACT, double_root=root * (1 + Fraction(1, 2**99))))
        for claim in (EXTERIOR, INTERIOR):
            assert not check_certificate(pair, Certificate(claim, multiplier=root))


@pytest.mark.parametrize("row", [row for row, position, _ in SYMMETRIC if position is not CONTACT])
def test_certificate_with_a_double_root_at_a_pole_is_refused_on_the_ring(row):
    F = quartic(Lengths.of(row))
    certificate = Certificate(CONTACT, double_root=exact.double_root(F) * F.side)
    assert not check_certificate(Pair.from_row(row), certificate)


def test_certificate_with_a_double_root_at_a_double_pole_is_refused_for_a_crossing_pair():
    # Upright and on the axis det(S + λH) has a double root at −A = −1/4 whatever the height.
    crossing = Pair(1, 1, 2, 2, 0, 0, 0.5, 0, 0, 1)
    assert not decide(crossing.lengths).tangent
    assert not check_certificate(crossing, Certificate(CONTACT, double_root=Fraction(-1, 4)))


def test_two_points_prove_contact_only_if_they_are_within_the_spheroid_and_on_two_sides_of_the_surface():
    pair = Pair(1, 1, 0.5, 2, 2, 0, 0, 1, 0, 0)  # from (0, 0, 0) to (4, 0, 0)
    for points, proves in (
        ([(2, 0, 0), (Fraction(1, 2), 0, 0)], True),
        ([(1, 0, 0)], True),
        ([(2, 0, 0)], False),
        ([(2, 0, 0), (4, 0, 0)], False),
        ([(2, 0, 0), (Fraction(-1, 9), 0, 0)], False),
        ([(2, 0, 0), (Fraction(1, 2), 0, Fraction(1, 2))], False),
        ([], False),
    ):
        assert check_certificate(pair, Certificate(CONTACT, points=tuple(points))) is proves


@pytest.mark.parametrize(
    ("matrix", "expected"),
    [
        ([[2, 1], [1, 2]], [2, Fraction(3, 2)]),
        ([[1, 2], [2, 4]], [1, 0]),
        ([[0, 0], [0, 3]], [0, 3]),
        ([[0, 1], [1, 3]], [-1]),
        ([[1, 2], [2, 3]], [1, -1]),
    ],
)
def test_pivots_distinguish_definite_from_semidefinite_matrices(matrix, expected):
    assert pivots([[Fraction(each) for each in row] for row in matrix]) == expected


@pytest.mark.parametrize("unit", [1, Fraction(1, 8), 12])
def test_a_crossing_on_a_plane_of_symmetry_is_proved_by_points_beyond_a_pole_in_any_unit(unit):
    """The double root of the tangency is the pole there, and so X(λ) stays on the centre's side."""
    proved = 0
    for row, _, limit_of in SYMMETRIC:
        for part in (Fraction(33, 32), Fraction(1025, 1024)) if limit_of is not None else ():
            grown_row = [float(each * unit) for each in grown(row, part)[:7]] + row[7:]
            pair = Pair.from_row(grown_row)
            certificate = prove(pair)
            assert certificate.position is CONTACT
            assert len(certificate.points) == 2
            assert check_certificate(pair, certificate)
            proved += 1
    assert proved > 10


def test_contact_of_a_spheroid_with_its_centre_on_the_surface_is_proved_by_the_centre():
    pair = Pair.from_row((1.0, 2.0, 0.5, 0.25, 0.0, 1.0, 0.0, 1.0, 2.0, 3.0))
    certificate = prove(pair)
    assert certificate.points == ((0, 1, 0),)
    assert check_certificate(pair, certificate)
