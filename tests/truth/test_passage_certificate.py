"""The proof of what happens on a way: every one that is found holds, and none that is damaged does."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from fractions import Fraction

import pytest

from hypcheck.truth.prove import prove_passage, simplest
from hypcheck.vectors.tilted import listed
from tests.support.inside import PassageCertificate, check_passage, clear_until, contact_at

TWO_POINTS = list(map(tuple, listed("tangent-in-two-points").tolist()))

THROUGH = (2.0, 3.0, 1.0, 1.0, 0.25, 0.5, 0.0, 8.0, 2.0, 0.5)
OUTSIDE = (2.0, 3.0, 1.0, 1.0, -6.0, 5.0, 1.0, 8.0, 3.25, 0.5)
TUNNEL = (2.0, 3.0, 1.0, 0.5, -6.0, 0.5, 1.0, 8.0, 0.5, 0.5, 1.0, 0.0, 2.0)
GRAZING = (2.0, 3.0, 1.0, 1.0, -4.0, 3.0, 0.0, 4.0, 3.0, 0.0)
STILL = (2.0, 3.0, 1.0, 1.0, 2.5, 0.0, 0.0, 2.5, 0.0, 0.0)
ON_WALL = (1.0, 2.0, 1.0, 1.0, 1.0, 0.0, 0.0, 3.0, 0.0, 0.0)
"""Its centre begins on the wall: one point proves it."""
INSIDE = (4.0, 3.0, 1.0, 1.0, 0.5, 0.0, -9.0, 0.5, 1.0, 9.0)


def random_ways(number):
    draw = random.Random(7)  # noqa: S311
    for turn in range(number):
        reach = draw.choice([3, 8, 20])
        yield (
            *(draw.uniform(0.3, 6) for _ in range(4)),
            *(draw.uniform(-reach, reach) for _ in range(6)),
            *((draw.uniform(-1, 1) for _ in range(3)) if turn % 3 == 0 else ()),
        )


@pytest.mark.parametrize("row", [THROUGH, OUTSIDE, TUNNEL, GRAZING, STILL, ON_WALL, INSIDE, *random_ways(24)])
def test_proof_found_for_a_sweep_passes_its_check(row):
    found, first, certificate = prove_passage(row)
    assert check_passage(row, certificate, first)
    if first:
        assert first[0] <= found.first[1]
        assert found.first[0] <= first[1]
    if first and first[0] and row not in (GRAZING, STILL):
        assert math.nextafter(first[0], 1.0) == first[1], "bounds are neighbouring floats"
        assert certificate.pieces[-1][1] == first[0]


def test_points_of_a_proof_of_contact_on_a_sweep_have_denominators_below_2_to_the_128():
    lengths = []
    for row in random_ways(60):
        _, first, certificate = prove_passage(row)
        assert check_passage(row, certificate, first)
        if len(certificate.points) == 2:
            offsets = [(far - near) / Fraction(row[2]) for near, far in zip(*certificate.points, strict=True)]
            lengths.append(max(offset.denominator.bit_length() for offset in offsets))
    assert len(lengths) > 40
    assert max(lengths) < 128


def test_proofs_of_hand_worked_sweeps_have_the_expected_first_contacts():
    firsts = [prove_passage(row)[1] for row in (THROUGH, OUTSIDE, TUNNEL, GRAZING, STILL, INSIDE)]
    assert [first is not None for first in firsts] == [True, False, True, True, True, False]
    assert firsts[3][0] < 0.5 == firsts[3][1]
    assert firsts[4] == (0.0, 0.0)


def test_a_grazing_sweep_is_proved_by_the_double_root_of_one_time():
    certificate = prove_passage(GRAZING)[2]
    assert certificate.double_root == 2  # √A at the waist
    assert certificate.time == Fraction(1, 2)


@pytest.mark.parametrize("row", [(*row[:4], *row[4:7], *row[4:7], *row[7:]) for row in TWO_POINTS[::3]])
def test_a_tangency_in_two_points_on_a_sweep_of_length_0_is_proved(row):
    row = tuple(map(float, row))
    found, first, certificate = prove_passage(row)
    assert found.grazes
    assert check_passage(row, certificate, first)


def test_a_sweep_that_ends_in_tangency_is_proved_at_the_time_1():
    row = (*GRAZING[:7], 0.0, *GRAZING[8:])
    found, first, certificate = prove_passage(row)
    assert found.first[1] == certificate.time == first[1] == 1
    assert check_passage(row, certificate, first)


def test_damaged_proof_of_a_clear_sweep_is_refused():
    _, first, certificate = prove_passage(OUTSIDE)
    assert first is None
    (multiplier, end), *_ = certificate.pieces
    for pieces in (
        (),
        ((-multiplier, end), *certificate.pieces[1:]),
        ((multiplier * 100, end), *certificate.pieces[1:]),
        ((Fraction(0), end), *certificate.pieces[1:]),
        certificate.pieces[:-1],
        (*certificate.pieces[:-1], (certificate.pieces[-1][0], Fraction(99, 100))),
        (*certificate.pieces, (multiplier, Fraction(2))),
        (*certificate.pieces, certificate.pieces[-1]),
    ):
        assert not check_passage(OUTSIDE, replace(certificate, pieces=pieces), None), pieces
    assert not check_passage(THROUGH, certificate, None)
    assert not check_passage(OUTSIDE, certificate, (0.5, 0.5))


def test_piece_of_a_proof_whose_stretch_contains_a_contact_is_refused():
    """The middle coefficient decides: φ is positive at both ends of [0, 1]."""
    row = (2.0, 3.0, 1.0, 1.0, -4.0, 2.0, 0.0, 4.0, 2.0, 0.0)
    for multiplier in (Fraction(1), Fraction(2), Fraction(3)):
        assert clear_until(row, PassageCertificate(((multiplier, Fraction(1)),))) is None


def test_piece_of_a_proof_that_ends_after_the_end_of_the_sweep_is_refused():
    """The ball stays outside on the straight line beyond the way, too."""
    clear = (2.0, 3.0, 1.0, 1.0, 4.0, 0.0, 0.0, 4.0, 1.0, 0.0)
    multiplier = prove_passage(clear)[2].pieces[0][0]
    assert clear_until(clear, PassageCertificate(((multiplier, Fraction(1)),))) == 1
    assert clear_until(clear, PassageCertificate(((multiplier, Fraction(3, 2)),))) is None


def test_damaged_proof_of_contact_on_a_sweep_is_refused():
    _, first, certificate = prove_passage(TUNNEL)
    assert check_passage(TUNNEL, certificate, first)
    for damaged in (
        replace(certificate, points=certificate.points[:1]),
        replace(certificate, points=()),
        replace(certificate, points=(), double_root=Fraction(1)),
        replace(certificate, time=Fraction(0)),
        replace(certificate, time=certificate.time + 1),
        replace(certificate, time=None),
    ):
        assert contact_at(TUNNEL, damaged) is None
        assert not check_passage(TUNNEL, damaged, first)
    assert not check_passage(TUNNEL, certificate, (first[1] * 1.5, first[1] * 2))
    assert not check_passage(TUNNEL, certificate, (first[0] / 2, first[0]))
    assert not check_passage(TUNNEL, replace(certificate, pieces=certificate.pieces[:1]), first)


def test_a_proof_of_a_clear_sweep_whose_minors_are_1_is_accepted():
    row = (1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 4.0, 0.0, 0.0, 5.0)
    assert clear_until(row, PassageCertificate(((Fraction(-1, 2), Fraction(1)),))) == 1


@pytest.mark.parametrize(
    ("low", "high"),
    [("3/10", "4/10"), ("0/1", "1/9"), ("314/100", "315/100"), ("7/3", "7/3"), ("2/7", "5/17"), ("5/2", "7/2")],
)
def test_simplest_returns_a_fraction_of_the_least_denominator_between_two_numbers(low, high):
    low, high = Fraction(low), Fraction(high)
    found = simplest(low, high)
    assert low <= found <= high
    for denominator in range(1, found.denominator):
        assert math.ceil(low * denominator) > high * denominator
