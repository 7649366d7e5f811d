"""Many ways and turns at once are decided as each of them alone, exactly."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.paper.flights import Moves, fly
from hypcheck.paper.motion import MOST_CONTACTS, Contact, MoveVerdicts, stays_on_side, stays_on_side_turning, valid
from hypcheck.paper.quadcopter import any_angle, craft_of, small_angle
from hypcheck.scene.model import Span
from hypcheck.scene.reading import read_scene
from hypcheck.truth.turning import turning
from hypcheck.vectors.draw import Draw
from tests.support.inside import passage

INTERIOR, EXTERIOR = Position.INTERIOR, Position.EXTERIOR
TOWER = (2.0, 17.8, 0.25, 0.15)
TREE = (0.5, 20.0, 0.3, 0.9)
COUNT = 300


def ways(draw, reach, length):
    start = tuple(draw.between(COUNT, -size, size) for size in reach)
    end = tuple(at + draw.between(COUNT, -length, length) for at in start)
    return start, end


def ways_of_each_kind(draw, reach):
    """Long and short ones, horizontal and vertical ones, and some through the waist."""
    for length in (0.1, 1.0, 8.0):
        start, end = ways(draw, reach, length)
        yield start, end
        yield start, (end[0], end[1], start[2])
        yield start, (start[0], start[1], end[2])
        yield start, (start[0], start[1], -start[2])


def alone(side, sizes, start, end, center, lane):
    here, there = (
        [Fraction(float(column[lane])) - Fraction(origin) for column, origin in zip(at, center, strict=True)]
        for at in (start, end)
    )
    found = passage(sizes, here, there)
    return found.clear and found.start is side


@pytest.mark.parametrize(
    ("side", "sizes", "reach", "center"),
    [
        (INTERIOR, TOWER, (2, 2, 9), (0.0, 0.0, 0.0)),
        (EXTERIOR, TREE, (2, 2, 1), (0.0, 0.0, 0.0)),
        (EXTERIOR, TREE, (2, 2, 1), (0.1, -0.7, 0.3)),
        (INTERIOR, TOWER, (2, 2, 9), (0.1, -0.7, 0.3)),
        (INTERIOR, TREE, (0.5, 0.5, 60), (0.0, 0.0, 0.0)),
        (EXTERIOR, (1.0, 0.25, 1.0, 1.0), (9, 9, 1), (0.0, 0.0, 0.0)),  # c² < a
    ],
)
def test_sweeps_decided_in_a_batch_equal_sweeps_decided_one_by_one(side, sizes, reach, center):
    seen = set()
    for number, (start, end) in enumerate(ways_of_each_kind(Draw("ways", sizes[0]), reach)):
        clear = stays_on_side(side, sizes, start, end, center)
        for lane in range(2 * number, COUNT, 24):
            assert clear[lane] == alone(side, sizes, start, end, center, lane)
            seen.add(bool(clear[lane]))
    assert seen == {True, False}


def test_a_sweep_within_rounding_of_a_tangency_is_decided_exactly():
    """At z = 0 the tower's inside ends at 1.75: a hair on both sides of that, and through it."""
    radius = np.array([1.75, np.nextafter(1.75, 0), np.nextafter(1.75, 2), 1.75 * (1 - 2.0**-48)])
    zero = np.zeros(4)
    low, high = np.full(4, -1.0), np.full(4, 1.0)
    for center in ((0.0, 0.0, 0.0), (0.25, 0.0, 0.0)):
        at = radius + center[0]
        found = stays_on_side(INTERIOR, TOWER, (at, zero, low), (at, zero, high), center)
        assert found.tolist() == [False, True, False, True]
        ahead = stays_on_side(INTERIOR, TOWER, (zero + center[0], zero, zero), (at, zero, zero), center)
        assert ahead.tolist() == [False, True, False, True]


@pytest.mark.parametrize("largest", [1.0, 45.0, 180.0])
def test_turns_decided_in_a_batch_equal_turns_decided_one_by_one(largest):
    draw, rotor, arm = Draw("arms", largest), (2.0, 17.8, 0.1, 0.05), 0.135
    at = (draw.between(COUNT, 1.1, 1.4), draw.between(COUNT, 1.1, 1.4), draw.between(COUNT, -5, 5))
    direction, degrees = any_angle(draw.between(COUNT, -180, 180)), draw.between(COUNT, -largest, largest)
    clear = stays_on_side_turning(rotor, arm, at, direction, degrees)
    assert 10 < clear.sum() < COUNT - 10
    for lane in range(0, COUNT, 3):
        ahead = (float(direction[0][lane]), float(direction[1][lane]))
        center = tuple(float(column[lane]) for column in at)
        alone = turning(rotor, center, arm, ahead, float(np.radians(degrees[lane])))
        assert clear[lane] == (alone is INTERIOR)


def test_turn_of_an_arm_within_rounding_of_a_tangency_is_decided_exactly():
    """ρ + l is the largest distance inside at z = 0, α − b_s: touched where the arm comes by, not where it does not."""
    rotor, arm = (2.0, 17.8, 0.25, 0.15), 0.25
    at = (np.full(4, 1.5), np.zeros(4), np.zeros(4))
    direction = any_angle(np.array([-30.0, 30.0, 30.0, -90.0]))
    degrees = np.array([60.0, 60.0, -30.0, 89.0])
    assert stays_on_side_turning(rotor, arm, at, direction, degrees).tolist() == [False, True, False, True]


def floats(*columns):
    """The points that columns hold, as tuples of floats."""
    return [tuple(map(float, point)) for point in zip(*columns, strict=True)]


def of_one(columns, place):
    return tuple(column[place : place + 1] for column in columns)


def watched_alone(craft, moves, place, expected):
    """Count one move of one flight, asking each body and each rotor by itself."""
    start, end, heading = (of_one(columns, place) for columns in (moves.start, moves.end, moves.before))
    expected.asked += bool((moves.accepted[place] or moves.refused[place]) and not moves.turning[place])
    if moves.accepted[place]:
        kind = "vertical" if moves.vertical[place] else "horizontal"
        rotors = zip(floats(*craft.rotors(start, heading)), floats(*craft.rotors(end, heading)), strict=True)
        found = [passage(craft.rotor, one, other) for one, other in rotors]
        body = passage(craft.sizes, floats(*start)[0], floats(*end)[0])
        good = (body.clear and body.start is INTERIOR) or all(way.clear and way.start is INTERIOR for way in found)
        begun = body.start is INTERIOR or all(way.start is INTERIOR for way in found)
        for name, count in ((kind, True), (f"{kind}_touching", not good), (f"{kind}_begun", not begun)):
            setattr(expected, name, getattr(expected, name) + count)
        if begun and not good:
            (lower, upper), rotor = min(
                ((way.first_lower, way.first_upper), each) for each, way in enumerate(found, 1) if way.hit
            )
            expected.contacts += (Contact(floats(*start)[0], floats(*end)[0], rotor, lower, upper),)
        expected.wrongly_accepted += not (body.end is INTERIOR or all(way.end is INTERIOR for way in found))
    if moves.turn[place]:
        angle, center = float(np.radians(moves.turn[place])), floats(*start)[0]
        expected.turns += 1
        arms = floats(*craft.arms(heading))
        expected.turns_touching += any(turning(craft.rotor, center, craft.arm, a, angle) is not INTERIOR for a in arms)


def test_verdict_counts_on_flights_equal_the_sum_over_single_moves():
    scene = read_scene("tower")
    craft, counted, expected = craft_of(scene), MoveVerdicts(), MoveVerdicts()

    def observe(moves: Moves) -> None:
        counted.watch(craft, moves)
        for place in range(len(moves.lane)):
            watched_alone(craft, moves, place, expected)

    near = replace(scene.flight.start, margin=0.24, z=Span(-1.0, 1.0))
    fly(craft, replace(scene.flight, start=near), 0.25, 20, Draw("watched"), 12, observe)
    assert counted == expected
    assert counted.wrongly_accepted == counted.wrongly_refused == 0
    assert counted.turns_touching > 0
    assert counted.horizontal_touching > 0


def test_a_move_through_the_waist_touches_first_where_its_first_rotor_does():
    """Both ends are a metre and more from the waist, where the tower is wider than a rotor needs; the waist is not."""
    craft, counted, expected = craft_of(read_scene("tower")), MoveVerdicts(), MoveVerdicts()
    yes, no = np.ones(40, dtype=bool), np.zeros(40, dtype=bool)
    start = (np.linspace(1.76, 1.79, 40), np.zeros(40), np.full(40, -1.0))
    moves = Moves(
        lane=np.arange(40),
        start=start,
        end=(start[0], start[1], np.full(40, 2.0)),
        before=small_angle(np.radians(np.linspace(-45.0, 45.0, 40))),
        turn=np.zeros(40),
        accepted=yes,
        refused=no,
        vertical=yes,
        turning=no,
        executed=yes,
        touching=yes,
    )
    counted.watch(craft, moves)
    for place in range(40):
        watched_alone(craft, moves, place, expected)
    assert 0 < len(expected.contacts) <= MOST_CONTACTS
    assert all(0 < contact.first_lower <= contact.first_upper < 1 for contact in expected.contacts)
    assert counted == expected


def test_position_is_valid_if_all_rotors_are_interior_though_the_body_is_not():
    craft = craft_of(read_scene("tower"))
    at = tuple(np.array(column) for column in ([1.77, 1.77, 1.5, 1.9], [0.0] * 4, [0.0] * 4))
    heading = small_angle(np.radians(np.array([45.0, 0.0, 0.0, 45.0])))
    assert valid(craft, at, heading).tolist() == [True, False, True, False]
