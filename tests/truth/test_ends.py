"""Hyperboloids that end: by hand, against independent oracles, and what proves and measures the answers."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import hypcheck
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.sections import has_root
from tests.support.inside import (
    Certificate,
    backward_error,
    check_certificate,
    decide,
    ended_clearance,
    heights_position,
    least_position,
    prove,
)
from tests.support.inside import position as exact_position
from tests.support.strategies import rows_of

INF = math.inf
RIM = (3.0, 4.0)
"""α and γ whose circle at height 3 has the radius 15/4."""

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR

BY_HAND = [
    # A drone on the rim of a tree that ends at 2, and the same as a solid trunk.
    ((0.2, 1, 0.3, 0.2, 0.2 * math.sqrt(5), 0, 2.01), (-1, 2), CONTACT, CONTACT, None),
    # A sphere whose pole rests on the rim, over the mouth, a hair above it, and beside the wall's end.
    ((*RIM, 1, 1, 3.75, 0, 4), (-1, 3), CONTACT, CONTACT, EXTERIOR),
    ((*RIM, 1, 1, 2, 0, 4), (-1, 3), EXTERIOR, CONTACT, EXTERIOR),
    ((*RIM, 1, 1, 2, 0, math.nextafter(4, 5)), (-1, 3), EXTERIOR, EXTERIOR, None),
    ((*RIM, 1, 1, 2, 0, 4), (3.5, 5), INTERIOR, CONTACT, None),
    # A sphere of radius 5/4 whose centre is 5/4 from the rim: 3/4 out, 1 up.
    ((*RIM, 1.25, 1.25, 4.5, 0, 4), (-1, 3), CONTACT, CONTACT, EXTERIOR),
    ((*RIM, 1.25, 1.25, math.nextafter(4.5, 5), 0, 4), (-1, 3), EXTERIOR, EXTERIOR, None),
    # The examples of the definitions: a body that is pierced, and one that holds the sphere.
    ((5, 5, 0.5, 0.5, 0, 0, 1), (-INF, 1), INTERIOR, CONTACT, None),
    ((5, 5, 0.5, 0.5, 0, 0, 1), (-INF, 3), INTERIOR, INTERIOR, None),
    ((5, 5, 0.5, 0.5, 0, 0, 1.2), (-3, 1), EXTERIOR, CONTACT, None),
    ((5, 5, 0.5, 0.5, 0, 0, 1.5), (-3, 1), EXTERIOR, CONTACT, EXTERIOR),
    ((5, 5, 0.5, 0.5, 0, 0, 0.5), (-3, 1), INTERIOR, CONTACT, INTERIOR),
    # No λ without a plane proves this one.
    ((1, 1, 1, 1, 2.5, 0, -0.9), (0, INF), EXTERIOR, EXTERIOR, None),
    # A ring that the spheroid swallows.
    ((1, 1, 5, 5, 0, 0, 0), (-0.125, 0.125), CONTACT, CONTACT, None),
    # A prolate spheroid that lies with its pole on the rim; the wall leans outward above it.
    ((*RIM, 1, 2, 5.75, 0, 3, 1, 0, 0), (-1, 3), CONTACT, CONTACT, EXTERIOR),
    ((*RIM, 1, 2, 5.75, 0, 3, 1, 0, 0), (3, 4), CONTACT, CONTACT, None),
]
"""A row, its ends, the positions beside the open and the solid body, and the position that a touch comes from."""


def pair_of(row, ends, solid):
    axis = tuple(row[7:]) or (0, 0, 1)
    return Pair.from_row((*map(float, row[:7]), *map(float, axis), *map(float, ends), float(solid)))


@pytest.mark.parametrize(("row", "ends", "open_position", "solid_position", "limit"), BY_HAND)
def test_positions_beside_ends_are_those_found_by_hand(row, ends, open_position, solid_position, limit):
    for solid, expected in enumerate((open_position, solid_position)):
        pair = pair_of(row, ends, solid)
        decision = decide(pair.lengths)
        assert decision.position is expected
        assert heights_position(pair) is expected
        assert least_position(pair) in (None, expected)
        named = dict(zip(("z_min", "z_max", "solid"), (*ends, solid), strict=True))
        assert hypcheck.position(*row[:7], axis=row[7:] or None, **named) == expected
        if limit is not None and expected is CONTACT:
            assert decision.limit_of is limit


STEEP = (189762196.0, 1.0, 2604.0, 1.0, 0.0, 156261249365.0, 0.0, 0.0, 1.0, 3.0, 0.0, 94823.0, 1.0)
"""Bounds tell how far the disc is and nothing of the wall, which is nearer."""

HAIR = (456.0000000000002, 408.0, 6.0, 10.0, 0.0, 494.0, -180.0, 0.0, 0.0, 1.0, -170.0, -125.92588435866463, 0.0)
"""Clear of a rim by less than a clearance is rounded by: the frozen row ended-rim-neighbourhood-0010."""


NEEDLE = {
    "alpha": 8.918735195595878e27,
    "gamma": 195135224502.64587,
    "b": 2.3377896839480636e-55,
    "d": 2.1119469073753615e72,
    "start": (-2.0084740505778577e34, 3.4117899724542157e33, -1.763986608877674e34),
    "end": (-3.0419490871855027e-53, -1.2861582759925909e-53, -6.256981653755749e-53),
    "axis": (-1.2644927908197123, 0.5187849208779641, -1.142518017652492),
    "z_min": -2.089454385324576e47,
    "z_max": 1.0219078811547866e27,
}
"""It pierces the wall between heights 10⁻⁵⁵ apart: in halves of its length they are apart after 500 steps."""


def test_passage_of_a_needle_that_pierces_the_wall_at_nearly_equal_heights_takes_less_than_5_seconds():
    before = time.process_time()
    assert hypcheck.passage(**NEEDLE).hit
    assert time.process_time() - before < 5  # 23 s where all roots were counted at each halving, 1.8 s now


def test_bounds_by_heights_and_by_least_value_are_right_or_undecided_beside_a_steep_wall():
    pair = Pair.from_row(STEEP)
    position = exact_position(pair.lengths)
    assert heights_position(pair) is position
    assert least_position(pair) in (None, position)


@settings(max_examples=12)
@given(rows_of("axis heights"))
def test_a_certificate_beside_ends_proves_its_claim_and_no_other(row):
    pair = Pair.from_row(row)
    if not pair.has_ends:
        return
    decision = decide(pair.lengths)
    certificate = prove(pair, decision)
    witnessed = bool(certificate.points or certificate.pieces) or certificate.multiplier is not None
    assert witnessed or decision.position is CONTACT
    assert check_certificate(pair, certificate) == witnessed
    for other in set(Position) - {decision.position}:
        assert not check_certificate(pair, replace(certificate, position=other))


@pytest.mark.parametrize("unit", [1, 8, 1 / 8])
def test_certificate_without_pieces_with_a_gap_or_with_a_negative_number_is_refused(unit):
    pair = pair_of([unit * size for size in (1, 1, 1, 1, 2.5, 0, -0.9)], (0, 3 * unit), 0)
    certificate = prove(pair, decide(pair.lengths))
    assert check_certificate(pair, certificate)
    first, *rest = certificate.pieces
    for pieces in (
        (),
        (replace(first, low=first.low + Fraction(unit) if first.low is not None else Fraction(unit)), *rest),
        (replace(first, plane=-first.plane), *rest),
        (replace(first, multiplier=Fraction(-1)), *rest),
    ):
        assert not check_certificate(pair, Certificate(EXTERIOR, pieces=pieces))


@settings(max_examples=4)
@example(HAIR)
@given(rows_of("axis heights"))
def test_a_spheroid_scaled_by_slightly_less_than_its_clearance_is_clear_and_by_slightly_more_in_contact(row):
    pair = Pair.from_row(row)
    if not pair.has_ends:
        return
    decision = decide(pair.lengths)
    found = ended_clearance(pair, decision)
    assert (decision.position is CONTACT) is (found <= 0)
    for factor, meets in ((1 - 1e-9, False), (1 + 1e-9, True)):
        scale = (1 + found) * factor
        if 1e-6 < scale < 1e6:
            scaled = replace(pair, b=pair.b * scale, d=pair.d * scale)
            assert (exact_position(scaled.lengths) is CONTACT) == meets


def test_the_clearance_of_a_spheroid_with_its_centre_on_the_wall_or_a_disc_is_minus_1():
    for row, ends, solid in (((*RIM, 1, 1, 3.75, 0, 3), (-1, 3), 0), ((*RIM, 1, 0.5, 2, 0, 3, 1, 0, 1), (-1, 3), 1)):
        pair = pair_of(row, ends, solid)
        assert ended_clearance(pair, decide(pair.lengths)) == -1


def test_backward_error_of_a_touch_of_a_rim_moved_by_2_to_the_minus_30_is_bracketed_near_that_number():
    """A touch moved outward by a relative 2⁻³⁰ of x is about so far from contact, and contact from exterior."""
    for change, answer in ((2.0**-30, CONTACT), (-(2.0**-30), EXTERIOR)):
        pair = pair_of((*RIM, 1.25, 1.25, 4.5 * (1 + change), 0, 4), (-1, 3), 0)
        ends = backward_error.bracket(pair, decide(pair.lengths), answer)
        assert 2.0**-40 < ends.lower <= ends.upper < 2.0**-28
    pair = pair_of((*RIM, 1, 1, 0, 0, 3), (-1, 3), 0)
    truth = decide(pair.lengths)
    assert truth.position is INTERIOR
    assert backward_error.bracket(pair, truth, EXTERIOR).upper == 0, "a centre at an end has two sides"


@given(
    st.lists(st.tuples(st.integers(-30, 30), st.integers(1, 4)), max_size=4),
    st.lists(st.tuples(st.integers(-9, 9), st.integers(1, 5)), max_size=2),
    st.integers(-12, 10),
    st.integers(1, 12),
)
def test_roots_between_two_numbers_are_found_or_excluded(roots, pairs, low, width):
    """Of products of linear factors, whose roots are known, and of quadratic ones without a root."""
    f, high = [1], low + width
    for numerator, denominator in roots:
        f = np.convolve(f, [denominator, -numerator]).tolist()
    for middle, rest in pairs:
        f = np.convolve(f, [1, -2 * middle, middle * middle + rest]).tolist()
    if any(numerator in (low * denominator, high * denominator) for numerator, denominator in roots):
        return
    between = any(low * denominator < numerator < high * denominator for numerator, denominator in roots)
    assert has_root(tuple(map(int, f)), low, high) in (between, None)


@pytest.mark.parametrize(("axis", "square"), [((0, 0, 1), 4), ((3, 0, 4), 2.92), ((0, 1, 0), 1), ((0, 0, 2.0**-60), 4)])
def test_a_multiplier_proves_a_spheroid_inside_a_solid_body_only_if_it_reaches_no_end(axis, square):
    """Its highest point is √(b² + (d² − b²) v_z²) above its centre."""
    row = (9, 40, 1, 2, 0, 0, 0, *axis)
    whole = pair_of(row, (-INF, INF), 0)
    inside = Certificate(INTERIOR, multiplier=prove(whole, decide(whole.lengths)).multiplier)
    for factor in (1 + 1e-9, 1 - 1e-9):
        end = math.sqrt(square) * factor
        for ends in ((-end, INF), (-INF, end)):
            assert check_certificate(pair_of(row, ends, 1), inside) == (factor > 1)


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ((3, 1, 6, 6, 5, -5, 6, -math.inf, 2), Position.EXTERIOR),
        ((1, 1, 2, 2, 4, -5, 2, -math.inf, 3), Position.EXTERIOR),
        ((5, 2, 4, 4, -5, 5, 4, -5, -4), Position.EXTERIOR),
        ((4, 6, 6, 6, -1, 1, 5, -5, -2), Position.CONTACT),
    ],
)
def test_a_ball_about_an_irrational_end_of_a_tilted_wall_has_the_position_of_the_turned_pair(row, expected):
    """Along (1, 0, 1) heights are multiples of √2. Turned, the wall is vertical and the numbers are rounded."""
    alpha, gamma, b, d, x, y, z, low, high = map(float, row)
    leaning = exact_position(Lengths.of((alpha, gamma, b, d, x, y, z, 0.0, 0.0, 1.0, low, high, 0.0), (1, 0, 1)))
    place = (math.hypot(y, (x - z) * 0.5**0.5), 0.0, (x + z) * 0.5**0.5)
    turned = Lengths.of((alpha, gamma, b, d, *place, 0.0, 0.0, 1.0, low, high, 0.0))
    assert leaning is exact_position(turned) is expected


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 1.0)])
def test_a_centre_exactly_at_the_end_of_an_open_wall_counts_as_inside(axis):
    for height, expected in ((1.0, Position.INTERIOR), (math.nextafter(1.0, 2.0), Position.EXTERIOR)):
        row = (5.0, 5.0, 0.5, 0.25, 0.0, 0.0, height, *axis, -math.inf, 1.0, 0.0)
        assert exact_position(Lengths.of(row)) is expected
