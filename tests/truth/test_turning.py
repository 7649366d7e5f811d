"""Turning in place: against exact decisions at many angles, and turns whose extreme is known."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.truth.turning import _all_along, _summit, squared_distances, turning
from tests.support.examples import examples
from tests.support.fractions_truth import exact_position

EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR
SIZES = (2, 3, 0.5, 0.5)
"""a = 4, c = 6: at z = 0 a part is inside nearer than 3/2 to the axis, outside beyond 5/2."""

_size = st.integers(64, 4096).map(lambda n: n / 1024)
_coordinate = st.integers(-4096, 4096).map(lambda n: n / 1024)
_direction = st.tuples(_coordinate, _coordinate).filter(any)


def after(center, arm, direction, angle):
    """The arm's end, to some 15 digits."""
    heading = math.atan2(direction[1], direction[0]) + angle
    return center[0] + arm * math.cos(heading), center[1] + arm * math.sin(heading), center[2]


def positions_near(row):
    """The exact positions that a change of the radial coordinates in the twelfth digit leads to."""
    sizes, (x, y, z) = row[:4], row[4:]
    return {exact_position((*sizes, x * change, y * change, z)) for change in (1 - 1e-12, 1 + 1e-12)}


@pytest.mark.slow
@examples(60)
@given(
    st.tuples(_size, _size, _size, _size),
    st.tuples(_coordinate, _coordinate, _coordinate),
    _size,
    _direction,
    st.floats(-7, 7),
)
def test_answer_about_a_turn_agrees_with_exact_positions_on_it(sizes, center, arm, direction, angle):
    found = turning(sizes, center, arm, direction, angle)
    seen = [positions_near((*sizes, *after(center, arm, direction, angle * n / 16))) for n in range(17)]
    if found is not CONTACT:
        assert all(found in positions for positions in seen)
    elif not any(0 in positions for positions in seen):
        assert near_contact(sizes, center, arm, direction, angle)


def near_contact(sizes, center, arm, direction, angle):
    """Whether a closer look at the turn finds the contact."""
    return any(0 in positions_near((*sizes, *after(center, arm, direction, angle * n / 2000))) for n in range(2001))


@examples(60)
@given(st.tuples(_coordinate, _coordinate), _size, _direction, st.floats(-7, 7))
def test_enclosures_of_least_and_largest_distance_on_a_turn_hold_every_distance_and_are_narrow(
    center, arm, direction, angle
):
    x, y = map(Fraction, center)
    ahead = tuple(map(Fraction, direction))
    least, largest = squared_distances(x, y, Fraction(arm), ahead, angle, 128)
    assert least[0] <= least[1] <= largest[1] + Fraction(1, 2**90)
    assert least[1] - least[0] < Fraction(1, 2**60)  # where the slope is 0 half of the digits are left
    assert largest[1] - largest[0] < Fraction(1, 2**60)
    seen = [math.hypot(*after((*center, 0), arm, direction, angle * n / 200)[:2]) ** 2 for n in range(201)]
    assert least[0] <= min(seen) + 1e-9
    assert max(seen) <= largest[1] + 1e-9
    assert min(seen) - least[1] < Fraction(1, 50)  # and they are reached
    assert largest[0] - max(seen) < Fraction(1, 50)


@pytest.mark.parametrize("center", [(1.0, 2.0), (0.1, -0.7), (3.0, 4.0), (0.0, 0.0)])
@pytest.mark.parametrize("angle", [7.0, -6.5])
def test_distances_of_a_whole_turn_enclose_the_nearest_and_farthest_point_of_the_circle(center, angle):
    """They are (ρ ± l)², ρ the root of a number: base ± 2 l ρ."""
    x, y = map(Fraction, center)
    arm = Fraction(3, 4)
    base, square = x * x + y * y + arm * arm, x * x + y * y
    least, largest = squared_distances(x, y, arm, (Fraction(1), Fraction(0)), angle, 128)
    for low, high in ((base - least[1], base - least[0]), (largest[0] - base, largest[1] - base)):
        assert low <= high
        assert (low / (2 * arm)) ** 2 <= square <= (high / (2 * arm)) ** 2


@pytest.mark.parametrize("beyond", [-1, 1])
def test_a_turn_that_nearly_touches_is_decided_with_more_bits(beyond):
    """The mover's centre is √2 from the axis, the arm brings the part's to √2 + l, and to l − √2 on the other side."""
    hair, root = Fraction(beyond, 2**140), Fraction(math.isqrt(2 << 800), 1 << 400)
    inner, outer = 3 - root + hair, 5 + root + hair
    sizes, center, ahead = (4.0, 3.0, 1.0, 1.0), (1.0, 1.0, 0.0), (1.0, 0.0)
    assert turning(sizes, center, inner, ahead, 7.0) is (Position.INTERIOR if beyond < 0 else Position.CONTACT)
    assert turning(sizes, center, outer, ahead, 7.0) is (Position.EXTERIOR if beyond > 0 else Position.CONTACT)


QUARTER = math.pi / 2


@pytest.mark.parametrize(
    ("x", "direction", "angle", "position"),
    [
        (1.0, (0, 1), QUARTER, INTERIOR),  # away from the wall and on: at most 1.118 from the axis
        (1.0, (0, 1), -QUARTER + 1e-9, INTERIOR),  # nearly towards it: √(1 + 1/4 + …) < 3/2
        (1.0, (0, 1), -1.571, CONTACT),  # beyond π/2: straight at the wall, exactly 3/2 from the axis
        (1.0, (1, 0), 0.0, CONTACT),
        (1.0, (1, 2.0**-30), 0.0, INTERIOR),
        (1.0, (1, 2.0**-30), 2.0**-40, INTERIOR),
        (1.0, (1, 2.0**-30), -1.0, CONTACT),
        (1.0, (-1, 0), 3.1415926535, INTERIOR),  # not quite half a turn
        (1.0, (-1, 0), 3.1415926536, CONTACT),
        (1.0, (-1, 0), -3.1415926536, CONTACT),
        (0.9999, (-1, 0), 1e9, INTERIOR),  # round and round
        (1.0, (-1, 0), 6.6, CONTACT),
        (3.0, (0, 1), 1.5707, EXTERIOR),
        (3.0, (0, 1), 1.5708, CONTACT),
        (3.0001, (0, 1), -50.0, EXTERIOR),
        (2.0, (0, 1), 1.0, CONTACT),
        (0.0, (0, 1), 3.0, INTERIOR),
    ],
)
def test_turns_worked_out_by_hand_are_decided_rightly(x, direction, angle, position):
    for cosine, sine in ((1, 0), (Fraction(3, 5), Fraction(4, 5))):
        center = (cosine * Fraction(x), sine * Fraction(x), 0)
        ahead = (cosine * direction[0] - sine * direction[1], sine * direction[0] + cosine * direction[1])
        assert turning(SIZES, center, 0.5, ahead, angle) is position


def test_a_turn_with_an_arm_of_length_0_has_the_position_of_its_centre():
    for x, position in ((1.4, INTERIOR), (1.5, CONTACT), (2.5, CONTACT), (2.6, EXTERIOR)):
        assert turning(SIZES, (x, 0, 0), 0, (0, 1), 3.0) is position


@pytest.mark.parametrize(
    ("arm", "direction", "angle", "message"),
    [
        (-1, (0, 1), 1.0, "arm is -1; it must be 0 or more"),
        (math.inf, (0, 1), 1.0, "arm is inf; it must be finite"),
        (1, (0, 0), 1.0, r"direction is \(0, 0\)"),
        (1, (0, math.nan), 1.0, "direction is nan"),
        (1, (0, 1), math.inf, "angle is inf"),
        (1, (0,), 1.0, r"direction: 1 number in \(0,\); there must be 2: x, y"),
        (1, (0, 1, 2), 1.0, "direction: 3 numbers in .*; there must be 2: x, y"),
        (None, (0, 1), 1.0, "arm is None; it must be a number"),
        (1, (0, 1), "1", "angle is '1'; it must be a number"),
    ],
)
def test_turning_raises_an_error_for_an_invalid_turn(arm, direction, angle, message):
    with pytest.raises(InputError, match=message):
        turning(SIZES, (0, 0, 0), arm, direction, angle)
    with pytest.raises(InputError, match="gamma is 0"):
        turning((2, 0, 1, 1), (0, 0, 0), 1, (0, 1), 1.0)


@pytest.mark.parametrize(
    ("squared", "b", "truth"),
    [("2.24", "0.6", CONTACT), ("2.19", "0.51", INTERIOR), ("6.2", "0.495", CONTACT), ("6.245", "0.495", EXTERIOR)],
)
def test_a_turn_is_right_or_undecided_if_its_radius_is_known_only_within_a_half(squared, b, truth):
    """At z = 0 contact is from α − b to α + b; of the halves beside the radius, one is where the truth is another."""
    squared, b = Fraction(squared), Fraction(b)
    inner, outer = ((2 + side * b) ** 2 for side in (-1, 1))
    assert truth is (INTERIOR if squared < inner else EXTERIOR if squared > outer else CONTACT)
    row = (Fraction(2), Fraction(3), b, b, Fraction(0), Fraction(0), Fraction(0))
    assert _all_along(row, (squared, squared), (squared, squared), 1) in (None, truth)
    assert _all_along(row, (squared, squared), (squared, squared), 20) is truth


def test_the_largest_value_of_a_piece_is_that_of_the_summit_if_the_slope_may_still_be_positive():
    """ρ = 1; at the start cos is 0.995 and falls by 0.1, which an enclosure of 1/2 to each side does not tell."""
    start, slope = (Fraction("0.99"), Fraction(1)), (Fraction("-0.6"), Fraction("0.4"))
    end, falls = (Fraction("0.8"), Fraction("0.9")), (Fraction("-0.6"), Fraction("-0.5"))
    reach = (Fraction(2), Fraction("2.1"))
    assert _summit(start, end, slope, falls, reach) == (Fraction("0.99"), Fraction("2.1"))
    assert _summit(start, end, falls, falls, reach) == start
