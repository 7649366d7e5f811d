"""A certificate that does not prove its claim is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings

from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import Certificate, Piece, check_certificate, decide, prove
from tests.support.inside import position as exact_position
from tests.support.pairs import pairs

RING = Pair(1, 2, 1, 1, 2.5, 0, 0)
TOUCHING = Pair(2, 5, 1, 1, 3, 0, 0)
ON_SURFACE = Pair(1, 1, 1, 1, 1, 0, 0)
CROSSING = Pair(2, 5, 1, 1, 2.5, 0, 0)


def _point(*values: float) -> tuple[Fraction, Fraction, Fraction]:
    x, y, z = map(Fraction, values)
    return (x, y, z)


@pytest.mark.parametrize(
    ("pair", "certificate"),
    [
        (RING, Certificate(Position.EXTERIOR, multiplier=Fraction(2))),
        (TOUCHING, Certificate(Position.CONTACT, double_root=Fraction(2))),
        (TOUCHING, Certificate(Position.CONTACT, points=(_point(2, 0, 0),))),
        (ON_SURFACE, Certificate(Position.CONTACT, points=(_point(1, 0, 0),))),
        (CROSSING, Certificate(Position.CONTACT, points=(_point(1.5, 0, 0), _point(3.5, 0, 0)))),
    ],
)
def test_certificate_written_by_hand_is_accepted(pair, certificate):
    assert check_certificate(pair, certificate)


@pytest.mark.parametrize(
    ("pair", "certificate", "flaw"),
    [
        (RING, Certificate(Position.EXTERIOR), "no witness at all"),
        (RING, Certificate(Position.EXTERIOR, multiplier=Fraction(4)), "λ at the pole B"),
        (RING, Certificate(Position.EXTERIOR, multiplier=Fraction(9)), "g > 0, but beyond B"),
        (RING, Certificate(Position.EXTERIOR, multiplier=Fraction(1, 8)), "g < 0"),
        (RING, Certificate(Position.INTERIOR, multiplier=Fraction(2)), "the other side's interval"),
        (
            RING,
            Certificate(Position.CONTACT, double_root=Fraction(4)),
            "the ring: a double root at B that is no tangency",
        ),
        (TOUCHING, Certificate(Position.CONTACT, double_root=Fraction(3)), "no root"),
        (TOUCHING, Certificate(Position.CONTACT), "no points"),
        (CROSSING, Certificate(Position.CONTACT, points=(_point(1.5, 0, 0), _point(1.6, 0, 0))), "one side only"),
        (
            CROSSING,
            Certificate(Position.CONTACT, points=(_point(1.5, 0, 0), _point(3.75, 0, 0))),
            "outside the spheroid",
        ),
        (
            CROSSING,
            Certificate(Position.CONTACT, points=(_point(1.5, 0, 0), _point(4, 0, 1.2))),
            "outside the spheroid, and above",
        ),
        (
            CROSSING,
            Certificate(Position.CONTACT, points=(_point(1.5, 0, 0), _point(4, 1.2, 0))),
            "outside the spheroid, and beside",
        ),
    ],
)
def test_certificate_with_a_flaw_is_refused(pair, certificate, flaw):
    assert not check_certificate(pair, certificate), flaw


BALL = Pair(1, 1, 1, 1, 1, 0, 0, z_min=-2, z_max=2, solid=1)
"""Its centre lies on the wall of a solid body: half of it is within."""
LOW = Pair(1, 1, 0.5, 0.5, 0, 0, -3, z_min=1, z_max=3)
"""On the axis, far below the ends."""
CUTS_THE_WALL = Pair(1, 1, 1, 1, 2.5, 0, 2, z_min=1, z_max=3)


@pytest.mark.parametrize(
    ("pair", "certificate", "holds"),
    [
        (BALL, Certificate(Position.CONTACT, points=(_point(0.5, 0, 0), _point(1.5, 0, 0))), True),
        (BALL, Certificate(Position.CONTACT, points=(_point(1.5, 0, 0),)), False),
        (BALL, Certificate(Position.CONTACT, points=(_point(0.5, 0, 0),)), False),
        (BALL, Certificate(Position.CONTACT, points=(_point(1, 0, 0),)), True),
        # A point of a flat end lies on the border of a solid body, and outside of it above the end.
        (replace(BALL, x=0, z=2), Certificate(Position.CONTACT, points=(_point(0, 0, 2),)), True),
        (replace(BALL, x=0, z=2), Certificate(Position.CONTACT, points=(_point(0, 0, 1.5), _point(0, 0, 2.5))), True),
        (replace(BALL, x=0, z=2, solid=0), Certificate(Position.CONTACT, points=(_point(0, 0, 2),)), False),
        # Near the wall, and on one side of it: h is 0.44, or −0.19.
        (Pair(1, 1, 0.1, 0.1, 1.2, 0, 0, z_max=2), Certificate(Position.CONTACT, points=(_point(1.2, 0, 0),)), False),
        (Pair(1, 1, 0.05, 0.05, 0.9, 0, 0, z_max=2), Certificate(Position.CONTACT, points=(_point(0.9, 0, 0),)), False),
        # What holds beside the whole hyperboloid says nothing of one that ends.
        (Pair(5, 5, 0.5, 0.5, 0, 0, 0), Certificate(Position.INTERIOR, multiplier=Fraction(-4)), True),
        *(
            (Pair(5, 5, 0.5, 0.5, 0, 0, z, **ends), Certificate(Position.INTERIOR, multiplier=Fraction(-4)), holds)
            for z, ends, holds in [
                (0, {"z_max": 1.0}, True),
                (0, {"z_min": -1.0}, True),
                (2, {"z_max": 1.0}, False),
                (-2, {"z_min": -1.0}, False),
                (0, {"z_max": 0.5, "solid": 1.0}, False),
                (0, {"z_max": 0.75, "solid": 1.0}, True),
                (0, {"z_min": -0.5, "solid": 1.0}, False),
            ]
        ),
        # With λ = 0 a piece says that the spheroid does not reach its heights.
        (
            LOW,
            Certificate(Position.EXTERIOR, pieces=(Piece(Fraction(1), Fraction(3), Fraction(0), Fraction(1)),)),
            True,
        ),
        (replace(LOW, z=0.5), Certificate(Position.EXTERIOR, multiplier=Fraction(0)), False),
        *(
            (
                CUTS_THE_WALL,
                Certificate(Position.EXTERIOR, pieces=(Piece(low, high, Fraction(0), Fraction(mu)),)),
                False,
            )
            for low, high in [(Fraction(1), Fraction(3)), (Fraction(1), None), (None, Fraction(3)), (None, None)]
            for mu in (1, 2, 8, 64)
        ),
    ],
)
def test_certificates_beside_ends_are_accepted_if_they_prove_their_position_and_else_refused(pair, certificate, holds):
    assert check_certificate(pair, certificate) is holds


def test_certificate_of_contact_is_accepted_with_a_point_on_the_spheroid_and_refused_with_one_beyond_it():
    pair, center, outside = Pair(5, 5, 3, 0.5, 4, 3, 0.25), _point(4, 3, 0.25), _point(7, 3, 0.25)
    for axis, radius in enumerate((3, 3, Fraction(1, 2))):
        for way in (radius, -radius):
            for stretch, holds in ((1, True), (1 + Fraction(1, 1024), False)):
                point = tuple(at + way * stretch * (axis == place) for place, at in enumerate(center))
                certificate = Certificate(Position.CONTACT, points=(point, center, outside))
                assert check_certificate(pair, certificate) is holds


def test_certificate_with_a_value_that_is_positive_only_by_rounding_is_refused():
    """At the double root −4/7 of a tangency g is 0, and above 0 in floats: a float must not spoil the arithmetic."""
    tangent = Pair(14.0, 0.109375, 7.0, 0.109375, -18.0, -12.0, -0.2578125)
    root = Fraction(-4, 7)
    assert check_certificate(tangent, Certificate(Position.CONTACT, double_root=root))
    assert not check_certificate(tangent, Certificate(Position.INTERIOR, multiplier=float(root)))
    assert not check_certificate(tangent, Certificate(Position.CONTACT, double_root=float(root)))


def test_certificate_accepts_a_position_given_as_an_integer():
    inside = Pair(4, 4, 1, 1, 0, 0, 0)
    assert check_certificate(inside, Certificate(-1, multiplier=Fraction(-8)))
    assert not check_certificate(inside, Certificate(1, multiplier=Fraction(-8)))
    assert not check_certificate(inside, Certificate(0, multiplier=Fraction(-8)))
    with pytest.raises(ValueError, match="7 is not a valid Position"):
        check_certificate(inside, Certificate(7, multiplier=Fraction(-8)))


@settings(max_examples=30)
@given(pairs)
def test_certificate_of_one_position_is_refused_for_every_other(pair):
    certificate = prove(pair)
    for position in Position:
        if position is not certificate.position:
            assert not check_certificate(pair, replace(certificate, position=position))


def test_a_double_root_outside_the_poles_is_no_tangency():
    """a = 1/2, c = 1: a double root below −A is a crossing with a node (r² and z² from the root m = −1/2, n = 1)."""
    A, B, m = Fraction(1, 4), Fraction(1), Fraction(-1, 2)
    n = A * B / m**2
    P = (A + m) ** 2 * (A + n) / (A * (A + B))
    Q = (B - m) ** 2 * (n - B) / (B * (A + B))
    assert (P, Q) == (Fraction(1, 4), 0)
    node = Pair(0.5, 1, 1, 1, 0.5, 0, 0)
    assert not check_certificate(node, Certificate(Position.CONTACT, double_root=m))


HAIR = 2.0**-40
NEARLY_TANGENT = [
    (2.0, 5.0, 1.0, 1.0, 3.0 + HAIR, 0.0, 0.0),
    (2.0, 5.0, 1.0, 1.0, 3.0 - HAIR, 0.0, 0.0),
    (3.0, 3.0, 1.0, 1.0, 2.0 - HAIR, 0.0, 0.0),
    (3.0, 3.0, 1.0, 1.0, 2.0 + HAIR, 0.0, 0.0),
    (1.0 + HAIR, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0),
    (1.0 - HAIR, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0),
    (1.0, 0.5, 1.0, 1.0, 2.5 + HAIR, 0.0, 0.0),
    (1.0, 0.5, 1.0, 1.0, 2.5 - HAIR, 0.0, 0.0),
    (1.0, 2.0, 1.0, 1.0, 2.0 + HAIR, 0.0, 0.0),
    (51.0, 6.0, 27.0, 9.0, 74.0, 0.0, 4.0),
]
TALL = [
    (2.0, 1.75, 2.0, 6.0, 0.0, 0.0, 1.0),
    (4.5, 4.5, 3.0, 9.0, 1.5, 0.0, 1.25),
    (0.5, 2.0, 1.0, 7.0, 0.0, 0.0, 7.0),
    (4.0, 7.0, 2.0, 5.0, 2.0, 0.0, 2.25),
]


@pytest.mark.parametrize(
    "row", [*NEARLY_TANGENT, *TALL, (1.0, 8.0, 1.0, 1.0, 4.0, 0.0, 0.0), (3.0, 3.0, 1.0, 1.0, 1.0, 0.0, 0.0)]
)
def test_certificates_of_pairs_near_tangency_and_far_from_it_hold_and_have_short_multipliers(row):
    pair = Pair(*row)
    certificate = prove(pair)
    assert certificate.position is exact_position(pair.lengths)
    assert check_certificate(pair, certificate)
    if certificate.multiplier is not None:
        digits = abs(certificate.multiplier.numerator)
        assert (digits // (digits & -digits)).bit_length() <= (2 if row[4] in (4.0, 1.0) else 64)


HAIR = 2.0**-30


@pytest.mark.parametrize(
    ("unit", "x"),
    [(1.0, 0.0), (1.0, 1e-200), (1e150, 1e-200)],
    ids=["on the axis", "beside it", "beside it by no float"],
)
def test_a_ball_that_barely_reaches_the_wall_around_it_has_a_certificate_of_two_points(unit, x):
    """From the height 1 on the axis the wall of α = 1 and γ = 2 is √1.2 away, all around, at the height 0.8."""
    radius = (math.sqrt(1.2) + HAIR) * unit
    pair = Pair(unit, 2 * unit, radius, radius, x, 0.0, unit)
    certificate = prove(pair, decide(pair.lengths))
    assert certificate.position is Position.CONTACT
    assert len(certificate.points) == 2
    assert check_certificate(pair, certificate)


def test_a_ball_above_a_flat_end_within_the_wall_is_proved_clear_in_pieces():
    """In the last piece below the ball its sections are empty, within the wall."""
    pair = Pair.from_row((8.0, 8.0, 1.0, 1.0, 0.0, 0.0, 2.0625, 0.0, 0.0, 1.0, -64.0, 1.0, 1.0))
    certificate = prove(pair, decide(pair.lengths))
    assert certificate.position is Position.EXTERIOR
    assert certificate.multiplier is None
    assert len(certificate.pieces) > 1
    assert check_certificate(pair, certificate)
    assert not check_certificate(pair, replace(certificate, pieces=certificate.pieces[:-1]))
