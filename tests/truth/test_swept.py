"""The way between two positions: against exact decisions at many times, exact tangencies, the ring, known times."""

from __future__ import annotations

import doctest
import itertools
import math
import random
from collections import Counter
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth import ended_sweeps
from hypcheck.truth.ended_sweeps import EndedSweep, first_contact
from hypcheck.truth.swept import sweep_of
from tests.support.examples import examples
from tests.support.fractions_truth import TRIPLES, exact_position, sign
from tests.support.inside import passage
from tests.support.inside import position as decided

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR
HALF = Fraction(1, 2)

_size = st.one_of(st.integers(64, 2**14).map(lambda n: n / 1024), st.integers(1, 6).map(float))
_coordinate = st.one_of(st.integers(-20480, 20480).map(lambda n: n / 1024), st.integers(-14, 14).map(lambda n: n / 2))
_sizes = st.tuples(_size, _size, _size, _size)
_centers = st.tuples(_coordinate, _coordinate, _coordinate)


def at(start, end, time):
    return tuple(Fraction(a) + time * (Fraction(b) - Fraction(a)) for a, b in zip(start, end, strict=True))


def truth(sizes, center):
    return exact_position((*sizes, *center))


def holds_first(found, time):
    """Whether the enclosure holds this time of first contact."""
    low, high = found.first
    return low < time < high or low == time == high


@examples(200)
@given(_sizes, _centers, _centers)
def test_answer_about_a_sweep_agrees_with_exact_positions_on_it(sizes, start, end):
    found = passage(sizes, start, end)
    assert found.start == truth(sizes, start)
    assert found.end == truth(sizes, end)
    for number in range(33):
        time = Fraction(number, 32)
        position = truth(sizes, at(start, end, time))
        if found.clear or time <= found.first[0] < found.first[1]:
            assert position == found.start
        elif position == 0:
            assert found.first[0] <= time
        elif position != found.start:
            assert found.first[0] < time


def test_the_first_contact_is_enclosed_narrowly_even_if_the_steps_towards_it_shrink_slowly():
    """Each of 64 steps reaches about half way to the contact: their end says little, the roots say it to 60 bits."""
    found = passage((0.0625, 0.0625, 0.0625, 65 / 1024), (0.0, 129 / 1024, 0.0), (0.0, 1 / 1024, 0.0))
    low, high = found.first
    assert low <= Fraction(1, 130) * (1 + Fraction(1, 2**50))
    assert high - low <= low / 2**60


@given(_sizes, _centers, _centers)
def test_the_first_contact_is_where_the_position_changes(sizes, start, end):
    """Just before the enclosure the spheroid is clear; just behind it, unless it grazes or goes on, it is not."""
    found = passage(sizes, start, end)
    assume(not found.clear and found.start is not CONTACT)
    low, high = found.first
    assert 0 <= low <= high <= 1
    assert high - low <= low / 2**60
    assert truth(sizes, at(start, end, low - (low == high) * low / 2**80)) in (found.start, 0)
    if low < high and not found.grazes:
        assert truth(sizes, at(start, end, high)) == 0
    assert found.first_lower <= low <= high <= found.first_upper
    assert found.first_upper <= math.nextafter(math.nextafter(found.first_lower, math.inf), math.inf)


@given(_sizes, _centers, _centers, st.fractions(0, 1, max_denominator=9))
def test_a_sweep_is_clear_exactly_if_the_sweeps_before_and_after_any_middle_point_are_clear(sizes, start, end, time):
    middle = at(start, end, time)
    whole, there, back = passage(sizes, start, end), passage(sizes, start, middle), passage(sizes, end, middle)
    assert whole.clear == (there.clear and back.clear)
    if not there.clear and whole.start is not CONTACT:
        assert whole.first[0] <= there.first[1] * time
        assert there.first[0] * time <= whole.first[1]


@st.composite
def tangent_places(draw):
    """Sizes and a centre at exactly `steps` radii along a rational normal; docs/mathematics.md, "Double roots"."""
    first, second, hypotenuse = draw(st.sampled_from(TRIPLES))
    cosine, sine = Fraction(first, hypotenuse), Fraction(second, hypotenuse)
    k, v = (draw(st.sampled_from([1, 3, 5])) * Fraction(2) ** draw(st.integers(-3, 3)) for _ in "kv")
    u = 1 / (k * k * v)
    assume(u != v)
    u, v = min(u, v), max(u, v)
    a, c = (u + v) / (2 * cosine), (v - u) / (2 * sine)
    steps = draw(st.sampled_from([1, -1])) * (1 + draw(st.sampled_from([0, 0, 1, -1])) * Fraction(1, 2**12))
    assume(-a * a < steps / k < c * c)
    b, d = draw(st.sampled_from([Fraction(1), Fraction(1, 4)])), draw(st.sampled_from([Fraction(1), Fraction(3)]))
    center = (a * a * k * cosine + steps * cosine, c * c * k * sine - steps * sine)
    return (a * b, c * d, b, d), center, (cosine, sine), steps


@given(tangent_places(), st.integers(6, 9).map(lambda n: Fraction(1, 2**n)))
def test_a_sweep_beside_the_surface_grazes_it_where_it_is_tangent_and_nowhere_else(place, half):
    """Outside, along the circle of the surface's horizontal section; inside, along the meridian's tangent.

    The surface bends away from the spheroid in that direction, so the point of tangency is the nearest on the way.
    """
    (alpha, gamma, b, d), (r, z), (cosine, sine), steps = place
    if steps > 0:
        start, end = (r * b, -half * b, z * d), (r * b, half * b, z * d)
    else:
        along, up = sine * half, cosine * half
        start, end = ((r - along) * b, 0, (z - up) * d), ((r + along) * b, 0, (z + up) * d)
        assume(r - along > 0)
    start, end = (tuple(map(Fraction, each)) for each in (start, end))
    found = passage((alpha, gamma, b, d), start, end)
    if abs(steps) == 1:
        assert found.grazes
        assert holds_first(found, HALF)
        assert found.start is found.end is (EXTERIOR if steps > 0 else INTERIOR)
    else:
        assert not found.grazes
        assert found.clear == (abs(steps) > 1)


def slanting_ways():
    """Ways through an exterior tangency at the middle that meet z = 0 at another time: there the ring would be."""
    for triple, k, v, when in itertools.product(
        TRIPLES,
        map(Fraction, ("1/4", "1/3", "1/2", "2/3", "3/4", "1", "3/2", "2")),
        range(1, 24),
        map(Fraction, ("1/4", "-1/2", "3/4")),
    ):
        cosine, sine = (Fraction(leg, triple[2]) for leg in triple[:2])
        u, w = sorted((4 / (k * k * v), Fraction(v, 4)))
        a, c = (u + w) / (2 * cosine), (w - u) / (2 * sine)
        if 1 < k * c * c:
            z = c * c * k * sine - sine
            slope = -z / cosine / when  # along the meridian's tangent
            if z and abs(slope) <= Fraction(1, 8):
                center, way = (a * a * k * cosine + cosine, 0, z), (slope * sine, 1, slope * cosine)
                yield (a, c, 1, 1), *(tuple(at + n * by for at, by in zip(center, way, strict=True)) for n in (-1, 1))


def test_tangency_on_a_slanting_sweep_is_not_mistaken_for_the_ring():
    grazing = 0
    for sizes, start, end in slanting_ways():
        found = passage(tuple(map(Fraction, sizes)), tuple(map(Fraction, start)), tuple(map(Fraction, end)))
        assert not found.clear
        assert found.first[0] <= HALF
        if found.grazes:
            grazing += 1
            assert holds_first(found, HALF)
    assert grazing > 10


@given(tangent_places())
def test_a_sweep_along_the_normal_has_contact_where_the_spheroid_touches_the_surface(place):
    (alpha, gamma, b, d), (r, z), (cosine, sine), steps = place
    side = sign(steps)
    foot = (r - steps * cosine, z + steps * sine)
    far, near = ((foot[0] + side * n * cosine, foot[1] - side * n * sine) for n in (1 + Fraction(1, 64), HALF))
    assume(far[0] > 0)
    start, end = ((x * b, Fraction(0), h * d) for x, h in (far, near))
    assume(truth((alpha, gamma, b, d), start) == side)
    found = passage((alpha, gamma, b, d), start, end)
    assert not found.grazes
    assert found.end is CONTACT
    assert holds_first(found, Fraction(1, 64) / (HALF + Fraction(1, 64)))


RINGS = [((1, 2, 1, 1), Fraction(5, 2)), ((7, 7, 1, 1), Fraction(10)), ((14, 21, 2, 3), Fraction(20))]


@pytest.mark.parametrize(("sizes", "radius"), RINGS)
@pytest.mark.parametrize("way", [(1, 0, 0), (0, 0, 1), (0, 1, 0), (1, 0, 1), (3, 4, 2), (1, 0, 0.1)])
def test_sweep_that_passes_the_ring_is_clear(sizes, radius, way):
    """The discriminant is 0 there and the spheroid far away, whichever way it comes through."""
    center = (radius, Fraction(0), Fraction(0))
    start, end = (tuple(c + n * Fraction(w) / 8 for c, w in zip(center, way, strict=True)) for n in (-1, 2))
    assert passage(sizes, start, end).clear
    assert passage(sizes, center, end).clear
    assert passage(sizes, start, center).clear


@pytest.mark.parametrize(
    ("sizes", "start", "end", "first"),
    [
        ((2, 3, 1, 1), (-4, 3, 0), (4, 3, 0), HALF),  # a + 1 = 3 from the axis: touched beside it, between two rings
        ((2, 3, 1, 1), (0, 0, 0), (4, 0, 0), Fraction(1, 4)),  # from inside, a − 1
        ((2, 3, 1, 1), (5, 0, 0), (0, 0, 0), Fraction(2, 5)),  # from outside, a + 1
        ((2, 3, 1, 1), (5, 0, 0), (3, 0, 0), Fraction(1)),  # at the very end
        ((2, 3, 1, 1), (Fraction(7, 2), 0, 0), (3, 0, 0), Fraction(1)),  # … with no ring on the way
        ((2, 3, 1, 1), (3, 0, 0), (5, 0, 0), Fraction(0)),  # at the very beginning
        ((2, 3, 1, 1), (1, 0, -2), (1, 0, 2), HALF),  # up along the throat, touched at the waist
        ((2, 1, 1, 1), (6, 0, 0), (0, 0, 0), (6 - math.sqrt(10)) / 6),  # c² < a: two points, r² = (c²+1)(a²+c²)/c²
        ((4, 1, 2, 1), (-4, 6, 0), (4, 6, 0), None),  # … which 6 < 2√10 undercuts: contact
        (
            (1, 1, 1, 1),
            (0, 0, 3),
            (0, 0, -3),
            (3 - math.sqrt(0)) / 6,
        ),  # a = 1 on the axis: the waist is touched all round
    ],
)
def test_times_of_first_contact_equal_values_worked_out_by_hand(sizes, start, end, first):
    found = passage(tuple(map(Fraction, sizes)), tuple(map(Fraction, start)), tuple(map(Fraction, end)))
    assert (found.first[1] - found.first[0]) * 2**60 <= found.first[1]
    if isinstance(first, Fraction):
        assert holds_first(found, first)
    elif first is not None:
        assert found.first_lower == pytest.approx(first, rel=1e-12)


@pytest.mark.parametrize(
    ("sizes", "start", "end", "grazes"),
    [
        ((2, 3, 1, 1), (-4, 3, 0), (4, 3, 0), True),
        ((2, 3, 1, 1), (-4, 2, 0), (4, 2, 0), False),
        ((2, 3, 1, 1), (1, 0, -2), (1, 0, 2), True),
        ((2, 3, 1, 1), (3, 0, 0), (5, 0, 0), True),
        ((2, 3, 1, 1), (3, 0, 0), (Fraction(7, 2), 0, 0), True),
        ((2, 3, 1, 1), (0, 0, 0), (9, 0, 0), False),
        ((2, 3, 1, 1), (2, 0, 0), (2, 0, 0), False),
        ((2, 3, 1, 1), (3, 0, 0), (3, 0, 0), True),
        ((1, 1, 1, 1), (0, 0, 3), (0, 0, -3), True),
    ],
)
def test_sweep_grazes_if_its_contact_lasts_only_an_instant(sizes, start, end, grazes):
    assert passage(sizes, start, end).grazes is grazes


def test_a_horizontal_spheroid_that_descends_onto_a_rim_touches_it_at_the_time_worked_out():
    # Its pole is 3.7 from the axis at the height of the rim, whose radius is 3.75; (5.7 − 3.75)² / 4 + (z − 3)² = 1.
    way = (3, 4, 1, 2), (5.7, 0, 9), (5.7, 0, 3), (1, 0, 0)
    touch = 3 + math.sqrt(1 - 1.95**2 / 4)
    for solid in (False, True):
        found = passage(*way, z_min=-1, z_max=3, solid=solid)
        assert found.first_lower == pytest.approx((9 - touch) / 6, rel=1e-14)
        assert not passage(*way, z_min=-1, z_max=2, solid=solid).hit


@pytest.mark.parametrize("upward", [(0, 0, 1), (3, 0, 4), (1, 1, 0)])
def test_answer_about_a_sweep_beside_ends_agrees_with_exact_positions_on_it(upward):
    """Where it begins a spheroid that is a hair larger is in contact; one a hair smaller meets nothing if it grazes."""
    draw = random.Random(str(upward))  # noqa: S311
    seen, hair = Counter(), Fraction(1, 2**20)
    for _ in range(16):
        sizes = [Fraction(draw.randint(1, 4)) for _ in range(4)]
        start, end = ([Fraction(draw.randint(-6, 6)) for _ in range(3)] for _ in range(2))
        axis = draw.choice([(0, 0, 1), (1, 0, 0), (0, 1, 1), (1, 1, 0), (1, -1, 0), upward])
        low, high = draw.choice([(-math.inf, draw.randint(-6, 6)), (draw.randint(-6, 6), math.inf), (-1, 1)])
        ends = {"z_min": low, "z_max": high, "solid": draw.randint(0, 1)}

        def meets(time, larger=0, sizes=sizes, start=start, end=end, axis=axis, ends=ends):
            place = [a + (b - a) * time for a, b in zip(start, end, strict=True)]
            scaled = [*sizes[:2], *(size * (1 + larger) for size in sizes[2:])]
            row = (*scaled, *place, *axis, *(Fraction(h) if math.isfinite(h) else h for h in ends.values()))
            return decided(Lengths.of(row, upward)) is CONTACT

        found = passage(sizes, start, end, axis, upward, **ends)
        before = 2 if found.clear else found.first[0]
        assert not any(meets(time) for time in (Fraction(k, 7) for k in range(8)) if time < before)
        if found.hit:
            smaller = [*sizes[:2], *(size * (1 - hair) for size in sizes[2:])]
            assert meets(sum(found.first) / 2, hair)
            assert found.grazes == passage(smaller, start, end, axis, upward, **ends).clear
        seen["clear" if found.clear else "grazes" if found.grazes else "at once" if not before else "later"] += 1
    assert min(seen["clear"], seen["at once"], seen["later"]) > 1, seen


@pytest.mark.parametrize("axis", [(0, 0, 1), (0.3, 0.1, 1)])
def test_a_sweep_of_any_length_beside_an_end_is_clear_where_it_passes_at_a_distance(axis):
    length = 1e160
    ways = [((-length, y, 0.25), (1.37 * length, y, 0.25)) for y in (3, 1.2)]
    assert [passage((1, 2, 0.5, 0.4), *way, axis, z_max=5.0).hit for way in ways] == [False, True]


def test_a_mover_with_parts_has_contact_if_a_part_has_or_parts_lie_on_both_sides_of_the_wall():
    def ball(radius, x, end):
        return sweep_of((1, 4, radius, radius), (x, 0, 0), end, None, None, (-1.0, 1.0, 0.0))

    whole, part = ball(2, 8, (0, 0, 0)), ball(1, 8, (0, 0, 0))
    assert first_contact(EndedSweep(whole)) == (Fraction(5, 8), Fraction(5, 8))
    assert first_contact(EndedSweep(whole, (part,))) == (Fraction(3, 4), Fraction(3, 4))
    large, inside, outside = ball(6, 0, (0, HALF, 0)), ball(0.25, 0, (0, HALF, 0)), ball(0.25, 4, (4, HALF, 0))
    for parts, first in (((), (0, 0)), ((inside,), None), ((outside,), None), ((inside, outside), (0, 0))):
        assert first_contact(EndedSweep(large, parts)) == first


def test_a_clear_sweep_has_no_time_of_contact():
    found = passage((2, 3, 1, 1), (5, 0, 0), (6, 0, 0))
    assert found.first is None
    assert not found.hit
    assert math.isnan(found.first_lower)
    assert math.isnan(found.first_upper)


@given(st.sampled_from([2.0**-1000, 2.0**-99, 2.0**1000]), st.sampled_from([2.0**-600, 1.0, 2.0**600]))
def test_passage_decides_sweeps_of_any_magnitude(wide, tall):
    start, end = (-4 * wide, 3 * wide, 0.0), (4 * wide, 3 * wide, tall * 2.0**-200)
    found = passage((2 * wide, 3 * tall, wide, tall), start, end)
    assert found.start is found.end is EXTERIOR
    assert not found.clear  # a hair below z = 0 it would be tangent; the tangency is crossed by what z adds


@pytest.mark.parametrize(
    ("sizes", "start", "end", "message"),
    [
        ((2.0, 0.0, 1.0, 1.0), (0.0,) * 3, (1.0,) * 3, "gamma is 0.0; a semi-axis must be greater than 0"),
        ((2.0, Fraction(-1, 3), 1.0, 1.0), (0.0,) * 3, (1.0,) * 3, "gamma is -1/3"),
        ((2.0, 3.0, 1.0, math.inf), (0.0,) * 3, (1.0,) * 3, "d is inf; it must be finite"),
        ((2.0, 3.0, 1.0, 1.0), (0.0, math.nan, 0.0), (1.0,) * 3, "y is nan; it must be finite"),
        ((2.0, 3.0, 1.0, 1.0), (0.0,) * 3, (0.0, 0.0, math.inf), "z is inf; it must be finite"),
        (
            (2.0, 3.0),
            (0.0,) * 3,
            (1.0,) * 3,
            r"the sizes: 2 numbers in \(2.0, 3.0\); there must be 4: alpha, gamma, b, d",
        ),
        (
            (2.0, 3.0, 1.0, 1.0),
            (0.0, 0.0),
            (1.0,) * 3,
            r"a centre: 2 numbers in \(0.0, 0.0\); there must be 3: x, y, z",
        ),
        ((2.0, 3.0, 1.0, 1.0), (0.0,) * 3, (1.0,) * 4, "a centre: 4 numbers in .*; there must be 3: x, y, z"),
        (
            (2.0, 3.0, 1.0, 1.0),
            None,
            (1.0,) * 3,
            "a centre: None is not a sequence of numbers; there must be 3: x, y, z",
        ),
        ((2.0, 3.0, 1.0, 1.0), "123", (1.0,) * 3, "a centre: '123' is not a sequence of numbers; there must be 3"),
    ],
)
def test_passage_raises_an_error_for_invalid_sizes_or_centres(sizes, start, end, message):
    with pytest.raises(InputError, match=message):
        passage(sizes, start, end)


def test_python_session_in_docs_motion_gives_the_results_that_it_shows():
    page = Path(__file__).resolve().parents[2] / "docs" / "motion.md"
    results = doctest.testfile(str(page), module_relative=False, encoding="utf-8")
    assert (results.failed, results.attempted) == (0, 4)


@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 2, 3)])
@pytest.mark.parametrize("deep", [2.0**-70, 2.0**-300])
def test_contact_that_begins_just_before_the_end_of_a_sweep_beside_a_disc_is_found_and_does_not_graze(axis, deep):
    way = (8, 8, 1, 1), (0, 0, 4), (0, 0, 1), axis
    found = passage(*way, z_max=deep, solid=True)
    assert (found.hit, found.grazes) == (True, False)
    assert 1 - 2.0**-53 <= found.first_lower <= found.first_upper == 1
    assert passage(*way, z_max=0.0, solid=True).grazes
    assert passage(*way, z_max=-deep, solid=True).clear


@pytest.mark.parametrize("lean", [(0, 1, 1), (1, 0, 1)])
def test_a_flat_spheroid_that_sweeps_over_a_small_body_with_the_same_axis_has_contact(lean):
    """It is 16 times as wide as thick, and moves partly along its axis: in contact for a thirtieth of the way."""
    start, end = ([side * part for part in (lean[0], lean[1], 0)] for side in (-2.2, 2))
    found = passage((0.01, 0.01, 1, 0.0625), start, end, lean, lean, z_min=-0.01, z_max=0.01, solid=True)
    assert found.hit
    assert 0.49 < found.first_lower < 0.524


@pytest.mark.parametrize("aside", [2.0**-100, 2.0**-140, 2.0**-400])
def test_distant_ends_do_not_change_whether_a_ball_grazes_a_throat_of_its_width(aside):
    """A ball as wide as the throat goes through it, exactly in the middle or a little aside."""
    for place, grazes in ((0.0, True), (aside, False)):
        way = (1, 1, 1, 1), (0, place, -1), (0, place, 1.5)
        assert passage(*way).grazes == grazes
        assert passage(*way, z_min=-5.0, z_max=5.0).grazes == grazes


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 1, 1), (1, 0, 1)])
@pytest.mark.parametrize(("b", "d"), [(16, 1), (1, 16)])
def test_the_bound_of_a_sweeps_length_in_radii_holds_if_spheroid_and_hyperboloid_have_one_axis(axis, b, d):
    """The step of the proof: a spheroid enlarged by that bound contains the moved one."""
    for move in itertools.product((0, 1, 5), (0, -1, 3), (0, 1, -7)):
        sweep = sweep_of((1, 1, b, d), (0, 0, 0), move, axis, axis)
        along = Fraction(sum(map(int.__mul__, axis, move))) ** 2 / sum(part * part for part in axis)
        across = sum(part * part for part in move) - along
        assert ended_sweeps._radii(sweep) ** 2 >= across / b**2 + along / d**2


def test_a_sweep_through_a_wall_is_not_proved_clear_because_its_middle_position_is_clear():
    sweep = EndedSweep(sweep_of((10, 10, 0.125, 0.125), (-10, 0, 0), (10, 0, 0), None, None, (-1.0, 1.0, 0.0)))
    assert not sweep.clear(Fraction(0), Fraction(1))
    assert sweep.clear(Fraction(15, 32), Fraction(17, 32))
