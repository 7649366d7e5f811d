"""How wrong an answer about a way is: size errors and windows of time worked out by hand, and the tolerance's claim."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.inside import hits_at_size, is_tolerated, octave, size_error, time_is_within, tolerance

BESIDE = (2.0, 3.0, 1.0, 1.0, -4.0, 3.5, 0.0, 4.0, 3.5, 0.0)
"""Past the waist at 3.5 from the axis: 1.5 from the surface, so that it touches when grown by a half."""
THROUGH = (2.0, 3.0, 1.0, 1.0, -4.0, 2.75, 0.0, 4.0, 2.75, 0.0)
"""The same at 2.75: it is clear when a quarter smaller."""
ACROSS = (2.0, 3.0, 1.0, 1.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0)
"""From outside to the axis; contact from a distance of 3, at t = 2/5. The centre meets the surface."""


@pytest.mark.parametrize(("row", "answer", "change"), [(BESIDE, True, 0.5), (THROUGH, False, 0.25)])
def test_the_size_error_is_the_distance_worked_out_by_hand(row, answer, change):
    found = size_error(row, answer)
    assert found.lower <= change <= found.upper <= 1.011 * found.lower


def test_a_right_answer_has_no_size_error():
    assert size_error(BESIDE, False).upper == size_error(THROUGH, True).upper == 0


@pytest.mark.parametrize("end", [(4.0, 3.0, 0.0), (0.0, 3.0, 0.0)])
def test_the_size_errors_of_both_answers_are_0_if_a_sweep_only_touches(end):
    row = (2.0, 3.0, 1.0, 1.0, -4.0, 3.0, 0.0, *end)
    assert size_error(row, True).upper == size_error(row, False).upper == 0


def test_size_error_is_infinite_if_the_centre_meets_the_surface_or_stays_far_away():
    assert size_error(ACROSS, False).lower == math.inf
    assert size_error((2.0, 3.0, 1.0, 1.0, 9.0, 0.0, 0.0, 8.0, 0.0, 0.0), True).lower == math.inf


_sizes = st.tuples(*[st.integers(64, 4096).map(lambda n: n / 1024)] * 4)
_centers = st.tuples(*[st.integers(-6144, 6144).map(lambda n: n / 1024)] * 3)


@examples(40)
@given(_sizes, _centers, _centers, st.sampled_from([0.25, 0.5, 0.9, 1.1, 1.5, 4.0]))
def test_a_larger_spheroid_has_contact_on_a_sweep_if_a_smaller_one_has(sizes, start, end, scale):
    row = (*sizes, *start, *end)
    hit = hits_at_size(row)
    other = hits_at_size(row, Fraction(scale))
    assert other >= hit if scale > 1 else other <= hit


@pytest.mark.slow
@examples(40)
@given(_sizes, _centers, _centers)
def test_both_ends_of_a_size_error_are_proved_by_exact_decisions(sizes, start, end):
    row = (*sizes, *start, *end)
    answer = not hits_at_size(row)
    found = size_error(row, answer)
    assume(0 < found.upper < 1)
    sign = 1 if answer else -1
    assert hits_at_size(row, 1 + sign * Fraction(found.upper)) == answer
    assert hits_at_size(row, 1 + sign * Fraction(found.lower)) != answer


@examples(40)
@given(
    _sizes,
    _centers,
    _centers,
    st.sampled_from([Fraction(1, 2**n) for n in (3, 6, 12)]),
    st.lists(st.sampled_from([-1, 0, 1]), min_size=10, max_size=10),
)
@example(
    (303 / 1024, 405 / 1024, 1 / 16, 1 / 16),
    (31 / 64, 0.0, 860 / 1024),
    (0.0, 60 / 1024, 3 / 1024),
    Fraction(1, 8),
    [-1, 0, 0, -1, 0, -1, -1, -1, -1, -1],
)  # the tolerance is 6.5: nothing is left of the smaller spheroid, whose centre crosses the surface
def test_answer_about_a_sweep_that_is_right_for_slightly_changed_inputs_is_tolerated(sizes, start, end, change, signs):
    """The claim by which the tolerance is derived, at corners of the box of changes."""
    row = tuple(map(Fraction, (*sizes, *start, *end)))
    moved = tuple(each * (1 + sign * change) for each, sign in zip(row, signs, strict=True))
    assert is_tolerated(row, hits_at_size(moved), tolerance(row, 1, change))


@examples(40)
@given(
    _sizes,
    _centers,
    _centers,
    st.tuples(st.integers(-64, 63), st.integers(1, 64), st.sampled_from([0.0, 1.0])),
    st.sampled_from([Fraction(1, 2**n) for n in (3, 6, 12)]),
    st.lists(st.sampled_from([-1, 0, 1]), min_size=12, max_size=12),
)
def test_answer_about_a_sweep_beside_ends_that_is_right_for_changed_inputs_is_tolerated(
    sizes, start, end, heights, change, signs
):
    low, extent, solid = heights
    row = tuple(map(Fraction, (*sizes, *start, *end, 0, 0, 1, low / 64, (low + extent) / 64)))
    moved = [each * (1 + sign * change) for each, sign in zip((*row[:10], *row[13:]), signs, strict=True)]
    assume(moved[10] < moved[11])
    answer = hits_at_size((*moved[:10], 0, 0, 1, *moved[10:], solid))
    assert is_tolerated((*row, solid), answer, tolerance((*row, solid), 1, change))


def test_contact_far_from_a_small_spheroid_is_tolerated_where_the_tolerance_multiplies_its_size():
    far = (2.0, 3.0, 0.5, 0.5, -4.0, 4.0, 0.0, 4.0, 4.0, 0.0)  # the surface is 2 away: 4 semi-axes
    assert not hits_at_size(far)
    assert is_tolerated(far, True, Fraction(4))
    assert not is_tolerated(far, True, Fraction(2))
    assert time_is_within(far, 1, Fraction(4))  # nothing is left of the smaller spheroid, so no time is too late
    assert not time_is_within(far, 1, Fraction(2))


def test_tolerance_of_a_sweep_is_the_sum_of_the_effects_of_each_input():
    row = (2.0, 3.0, 0.5, 0.25, -4.0, 3.0, 1.0, 1.0, 0.0, -2.0)  # ρ = 14, ζ = 8
    unit = Fraction(1, 2**24)
    assert tolerance(row, 8, unit) / (8 * unit) == pytest.approx(1 + 22 + 24, rel=1e-5)


def test_times_are_right_from_the_first_contact_of_a_larger_spheroid_to_that_of_a_smaller_one():
    earliest, latest, hair = Fraction("1.99") / 5, Fraction("2.01") / 5, Fraction(1, 10**9)
    right = (earliest + hair, Fraction(2, 5), latest - hair)
    assert [time_is_within(ACROSS, time, Fraction(1, 100)) for time in right] == [True] * 3
    wrong = (0, earliest - hair, latest + hair, 1)
    assert [time_is_within(ACROSS, time, Fraction(1, 100)) for time in wrong] == [False] * 4


def test_no_time_of_contact_counts_as_too_late_if_a_slightly_smaller_spheroid_is_clear():
    touching = (2.0, 3.0, 1.0, 1.0, -4.0, 3.0, 0.0, 4.0, 3.0, 0.0)
    change = Fraction(1, 2**20)
    assert [time_is_within(touching, time, change) for time in (0, 0.25, 0.5, 1)] == [False, False, True, True]
    assert not any(time_is_within(BESIDE, time, change) for time in (0, 0.5, 1))


@pytest.mark.parametrize(
    ("axis", "roundoff", "expected"),
    [
        ((), Fraction(1, 4), Fraction(49, 12)),  # ρ = 5/2, ζ = 2: (1 + 9/2 + 5/3 · 13/2)/4
        ((0.0, 0.0, -3.0), Fraction(1, 4), Fraction(49, 12)),
        ((), Fraction(2), 50),  # δ counts as 1/2 in K
        ((0.0, 0.0, 1.0, -math.inf, math.inf, 1.0), Fraction(1, 4), Fraction(49, 12)),
        ((0.0, 0.0, 1.0, -math.inf, 1.0, 0.0), Fraction(1, 4), Fraction(73, 4)),  # and 10/3 · 3 · (1 + 14/3)/4
        ((1.0, 0.0, 0.0, -9.0, 1.0, 0.0), Fraction(1, 4), Fraction(445, 64) + Fraction(50, 3)),  # 10/3 · 6 · 10/3 · 1/4
        ((1.0, 0.0, 0.0), Fraction(1, 4), Fraction(445, 64)),  # 13/2 and 2: (1 + 13/2 + 5/4 · 9/4 + 5/3 · 21/2)/4
    ],
)
def test_the_tolerance_is_the_one_worked_out_by_hand(axis, roundoff, expected):
    row = (7.0, 3.0, 2.0, 4.0, 1.0, 2.0, 4.0, 0.0, 5.0, -8.0, *axis)
    assert tolerance(row, 1, roundoff) == expected


@pytest.mark.parametrize(
    "least", [0.3, 0.25, 2.0**-9, 2.0**-10, 1.01 * 2.0**-11, 1e-7, 1e-12, 2.0**-60, 1.5 * 2.0**-300]
)
def test_search_encloses_the_least_sufficient_change_between_neighbouring_powers_of_two(least):
    low = Fraction(2) ** octave(lambda change: change >= least)
    assert low < least <= 2 * low
