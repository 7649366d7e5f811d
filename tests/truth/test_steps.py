"""Journeys and their steps: polynomials in time against exact pairs at a time, and reaches against known roots."""

from __future__ import annotations

import random
from fractions import Fraction

import mpmath
import pytest

from hypcheck.geometry.pair import Position
from tests.support.inside import WIDTH_BITS, cubic, piece, quartic, reach, shortened, steps, sweep_of, value
from tests.support.inside import exact_discriminant as discriminant_of
from tests.truth.test_passage_certificate import INSIDE, OUTSIDE, THROUGH, TUNNEL, random_ways

SWEEPS = [THROUGH, OUTSIDE, TUNNEL, INSIDE, *random_ways(12)]


def discriminant(f):
    """The discriminant of a polynomial of degree 2 or 3, the highest power first."""
    if len(f) == 3:
        a, b, c = f
        return b * b - 4 * a * c
    a, b, c, d = f
    return b * b * c * c - 4 * a * c**3 - 4 * b**3 * d + 18 * a * b * c * d - 27 * a * a * d * d


def sweep(row):
    return sweep_of(row[:4], row[4:7], row[7:10], row[10:] or None)


def times(seed=1):
    draw = random.Random(seed)  # noqa: S311
    return [Fraction(0), Fraction(1), *(Fraction(draw.randrange(1, 97), 97) for _ in range(6))]


def coefficients(way, time):
    """Of det(S + λH) at a time, up to a positive factor; of a leaning spheroid too, for λ itself."""
    there = way.at(time)
    if not way.is_upright:
        F = quartic(there)
        return (F.f4, F.f3 * (F.side or 1), F.f2, F.f1 * (F.side or 1), F.f0)
    g = cubic(there)
    return (g.n3, g.n2, g.n1, g.n0)


def are_proportional(first, second):
    """Whether two sequences are the same up to a positive factor."""
    return first[0] * second[0] > 0 and all(a * second[0] == b * first[0] for a, b in zip(first, second, strict=True))


@pytest.mark.parametrize("row", SWEEPS)
def test_the_pencil_of_a_sweep_is_that_of_the_pair_at_each_time(row):
    way = sweep(row)
    for time in times():
        there = [at_time(each, time) for each in way.pencil]
        if way.is_upright or quartic(way.at(time)).side:
            assert are_proportional(there, coefficients(way, time)), time


@pytest.mark.parametrize("row", SWEEPS)
def test_piece_of_a_proof_is_the_determinant_of_the_pencil_at_its_multiplier(row):
    way = sweep(row)
    for multiplier in (Fraction(3, 7), Fraction(-2, 5), Fraction(11)):
        proof = piece(way.pencil, multiplier)
        assert len(proof) == 3
        for time in times():
            powers = [at_time(each, time) * multiplier**power for power, each in enumerate(reversed(way.pencil))]
            factor = multiplier.denominator ** (len(powers) - 1)
            assert at_time(proof, time) == sum(powers) * factor


def at_time(polynomial, time):
    return sum(each * time**power for power, each in enumerate(reversed(polynomial)))


@pytest.mark.parametrize("row", SWEEPS)
def test_the_critical_polynomial_of_a_sweep_has_the_sign_of_the_discriminant(row):
    way = sweep(row)
    for time in times():
        upright = len(row) == 10
        expected = discriminant(coefficients(way, time)) if upright else discriminant_of(quartic(way.at(time)))
        found = value(way.critical(), time)
        assert (found > 0, found < 0) == (expected > 0, expected < 0)


@pytest.mark.parametrize("row", [OUTSIDE, INSIDE])
def test_each_multiplier_of_an_upright_sweep_is_the_local_maximum_to_twice_as_many_bits(row):
    way = sweep(row)
    with mpmath.workprec(600):
        for time in times():
            n3, n2, n1, _ = coefficients(way, time)
            best = (-n2 - mpmath.sqrt(n2 * n2 - 3 * n3 * n1)) / (3 * n3)
            found = way.multipliers(time)
            for bits in (12, 24, 48, 96):
                at = next(found)
                assert abs(mpmath.mpf(at.numerator) / at.denominator / best - 1) < mpmath.mpf(2) ** (2 - bits)


@pytest.mark.parametrize("bits", [5, 12, 40])
def test_shortened_quotient_has_the_given_number_of_bits_and_is_rounded_down(bits):
    draw = random.Random(bits)  # noqa: S311
    for _ in range(200):
        top = draw.choice((1, -1)) * draw.getrandbits(draw.randrange(1, 200)) or 1
        bottom = draw.getrandbits(draw.randrange(1, 200)) or 1
        found = shortened(top, bottom, bits)
        lost = Fraction(top, bottom) - found
        assert 0 <= lost < abs(Fraction(top, bottom)) * Fraction(4, 2**bits)
        assert abs(found.numerator) // (abs(found.numerator) & -abs(found.numerator) or 1) <= 1 << (bits + 1)


def quadratic(factor, *roots):
    """factor (t − r)(t − r′) in integers, of degree 2 in form; one root less makes it linear."""
    one, other = roots
    poly = (1, -one - other, one * other) if other is not None else (0, 1, -one)
    scale = one.denominator * (other.denominator if other is not None else 1)
    return tuple(int(each * scale) * factor for each in map(Fraction, poly))


def drawn_roots(draw):
    ends = sorted(Fraction(draw.randrange(1, 10**6), draw.randrange(1, 10**6)) for _ in range(3))
    return ends if len(set(ends)) == 3 else drawn_roots(draw)


def test_reach_is_slightly_below_the_distance_to_the_next_root_of_the_quadratic():
    draw = random.Random(8)  # noqa: S311
    for _ in range(300):
        first, second, third = drawn_roots(draw)
        for proof, time, root in (
            (quadratic(-3, first, third), second, third),  # it rises and falls
            (quadratic(5, second, third), first, second),  # it falls and rises
            (quadratic(-7, second, None), first, second),  # a falling line
        ):
            distance = root - time
            found = reach(proof, time)
            assert found is not None
            assert distance * (1 - Fraction(1, 2**37)) < found < distance


def test_reach_is_none_if_the_quadratic_has_no_later_root():
    one, two, three = Fraction(1, 3), Fraction(2, 3), Fraction(1)
    assert reach(quadratic(5, one, two), three) is None
    assert reach(quadratic(5, two, None), three) is None
    assert reach((0, 0, 4), one) is None
    assert reach((1, 0, 1), one) is None
    assert reach((3, -3, 1), one) is None  # it falls there, and turns above 0


def test_steps_enclose_the_first_contact_within_the_stated_width():
    for row in (THROUGH, TUNNEL):
        way = sweep(row)
        found = steps(way)
        assert way.position(found.contact) is Position.CONTACT
        assert way.position(found.until) is not Position.CONTACT
        assert 0 < (found.contact - found.until) * 2**WIDTH_BITS <= found.until


@pytest.mark.parametrize("row", [THROUGH, OUTSIDE, TUNNEL, INSIDE])
def test_each_piece_of_a_proof_is_positive_from_its_start_to_its_end(row):
    way, last = sweep(row), Fraction(0)
    found = steps(way)
    for multiplier, end in found.pieces:
        assert last < end <= 1
        for share in range(9):
            assert value(piece(way.pencil, multiplier), last + (end - last) * Fraction(share, 8)) > 0
        last = end
    assert found.contact is None or found.contact > last
    assert found.contact is not None or last == 1
