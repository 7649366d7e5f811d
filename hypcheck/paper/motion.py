"""Moves and turns decided exactly from beginning to end, and the errors of a test at the end of each move.

One observation proves most sweeps and turns in place clear from beginning to end (docs/mathematics.md, "Monotone in
every input"): an interior spheroid stays interior if its centre moves nearer to the axis and farther from the waist's
plane, an exterior spheroid stays exterior if it does the opposite. So one exact decision at the worst corner of a sweep
proves the whole sweep clear; the corner is the largest distance from the axis with the least height, or the reverse. If
this proof fails and no end of the sweep is in contact, truth/swept.py or truth/turning.py decides.

Bounds, u = 2⁻⁵³. Along a segment the distance from the axis is convex: the largest is at an end, and √(x²+y²) computed
is within 3u of it. The least is not below the least of n·C at the ends for any horizontal direction n of length 1; n·C
is computed to within 3u (|x|+|y|), and the n used is at most 1 + 4u long. Coordinates that are differences are within u
of themselves. MARGIN is several times larger than the sum of these errors.

A position is valid where the body is interior, or all four rotors are. The rotors lie within the body, so a sweep is
valid from beginning to end exactly where no rotor meets contact on it. The rotors are tested only if the body is not
clear.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from fractions import Fraction
from math import inf

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position, Sizes
from hypcheck.geometry.rows import Columns, Floats, Mask, Positions
from hypcheck.kernel.classify import classify, classify_scene
from hypcheck.paper.flights import Moves
from hypcheck.paper.quadcopter import ROTORS, Craft, Direction, Procedures, any_angle, turned
from hypcheck.truth.swept import passage
from hypcheck.truth.turning import turning

MARGIN = 64 * 2.0**-53


def stays_on_side(
    side: Position, sizes: Sizes, start: Columns, end: Columns, center: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Mask:
    """Return a mask (n,) of the spheroids that stay on `side`, INTERIOR or EXTERIOR, all the way from start to end.

    `center` is the hyperboloid's; the bounds include the rounding of its subtraction.
    """
    corner = _inner_corner if side is Position.INTERIOR else _outer_corner
    first, last = _from(center, start), _from(center, end)
    clear = np.asarray(classify_scene(sizes, *corner(first, last)) == side)
    at_ends = np.logical_and(*(classify_scene(sizes, *_favoured(side, at)) == side for at in (first, last)))
    for lane in np.flatnonzero(at_ends & ~clear).tolist():
        sweep = passage(sizes, _exactly(center, start, lane), _exactly(center, end, lane))
        clear[lane] = sweep.clear and sweep.start is side
    return clear


def first_contact(
    sizes: Sizes, start: Columns, end: Columns, lane: int, center: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[float, float]:
    """Return bounds of the time of first contact on the sweep number `lane`, 0 ≤ time ≤ 1; inf twice if it has none."""
    sweep = passage(sizes, _exactly(center, start, lane), _exactly(center, end, lane))
    return (sweep.first_lower, sweep.first_upper) if sweep.hit else (inf, inf)


def _favoured(side: Position, at: Columns) -> Columns:
    """Return a position slightly nearer to that side: if it is not on the side, the exact position is not either."""
    more, less = (1 - MARGIN, 1 + MARGIN) if side is Position.INTERIOR else (1 + MARGIN, 1 - MARGIN)
    return at[0] * more, at[1] * more, at[2] * less


def _inner_corner(start: Columns, end: Columns) -> Columns:
    """Return the corner of the sweep with the largest radius and the least height.

    If that corner is interior, the whole sweep is interior.
    """
    radius = np.maximum(np.hypot(start[0], start[1]), np.hypot(end[0], end[1])) * (1 + MARGIN)
    return radius, np.zeros_like(radius), _least_height(start[2], end[2]) * (1 - MARGIN)


def _outer_corner(start: Columns, end: Columns) -> Columns:
    """Return the corner of the sweep with the least radius and the largest height.

    If that corner is exterior, the whole sweep is exterior.
    """
    x, y = start[0] + end[0], start[1] + end[1]
    length = np.hypot(x, y)
    length = np.where(length > 0, length, 1.0)
    reach = np.minimum(*(_along(x / length, y / length, at) for at in (start, end)))
    height = np.maximum(np.abs(start[2]), np.abs(end[2])) * (1 + MARGIN)
    return np.maximum(reach, 0.0), np.zeros_like(reach), height


def _along(ahead: Floats, aside: Floats, at: Columns) -> Floats:
    """Return a lower bound of ahead·x + aside·y for centres `at`, where (ahead, aside) is a unit vector.

    The bound holds in spite of rounding.
    """
    return np.asarray(ahead * at[0] + aside * at[1] - MARGIN * (np.abs(at[0]) + np.abs(at[1])))


def _from(center: tuple[float, float, float], at: Columns) -> Columns:
    """Return the points relative to the centre, rounded."""
    x, y, z = (column - origin for column, origin in zip(at, center, strict=True))
    return x, y, z


def _exactly(center: tuple[float, float, float], at: Columns, lane: int) -> tuple[Fraction, Fraction, Fraction]:
    x, y, z = (Fraction(value) - Fraction(origin) for value, origin in zip(_at(at, lane), center, strict=True))
    return x, y, z


def _least_height(first: Floats, second: Floats) -> Floats:
    """Return the least size of the heights between the two: 0 if their signs differ."""
    crossing = (first > 0) != (second > 0)
    return np.where(crossing, 0.0, np.minimum(np.abs(first), np.abs(second)))


def stays_on_side_turning(sizes: Sizes, arm: float, at: Columns, direction: Direction, degrees: Floats) -> Mask:
    """Return a mask of the parts that stay interior while an arm in `direction` turns by `degrees` (−180 … 180); (n,).

    The largest distance from the axis is ρ + l if the arm points outward at some time of the turn, else it is reached
    at an end. Rounding may wrongly find that an arm nearly, but never, points outward. There the distance hardly
    changes, and MARGIN, scaled by the lengths ρ and l, covers the difference.
    """
    x, y, z = at
    after = turned(direction, any_angle(degrees))
    reach, slack = np.hypot(x, y) + arm, MARGIN * (np.abs(x) + np.abs(y) + arm)
    ends = np.maximum(*(np.hypot(x + arm * cosine, y + arm * sine) for cosine, sine in (direction, after)))
    largest = np.where(_comes_by(x, y, direction, degrees), reach, ends)
    flat = np.zeros_like(largest)
    clear = classify_scene(sizes, largest + slack, flat, z) == Position.INTERIOR
    open_ = clear != (classify_scene(sizes, np.maximum(largest - slack, 0.0), flat, z) == Position.INTERIOR)
    for lane in np.flatnonzero(open_).tolist():
        angle = float(np.radians(degrees[lane]))
        ahead = (float(direction[0][lane]), float(direction[1][lane]))
        clear[lane] = turning(sizes, _at(at, lane), arm, ahead, angle) is Position.INTERIOR
    return np.asarray(clear)


def _comes_by(x: Floats, y: Floats, direction: Direction, degrees: Floats) -> Mask:
    """Decide whether an arm points away from the axis at some time of the turn."""
    cosine, sine = direction
    angle = np.degrees(np.arctan2(x * sine - y * cosine, x * cosine + y * sine))  # angle of the arm from outward
    return np.asarray(
        np.where(degrees >= 0, (angle <= 0) & (angle + degrees >= 0), (angle >= 0) & (angle + degrees <= 0))
    )


def _at(point: Columns, lane: int) -> tuple[float, float, float]:
    """Return the point number `lane`."""
    x, y, z = (float(column[lane]) for column in point)
    return x, y, z


MOST_CONTACTS = 12
"""First contacts that are listed one by one."""


@dataclass(frozen=True, slots=True)
class Contact:
    """The first contact of `rotor` 1 to 4 on an accepted move of the centre from `start` to `end`.

    Its time is from `first_lower` to `first_upper`; the move lasts from 0 to 1.
    """

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    rotor: int
    first_lower: float
    first_upper: float


@dataclass(slots=True)
class VerdictCounts:
    """Counts of events, one field for each kind."""

    def add(self, other: VerdictCounts) -> None:
        """Add the counts of another value of the same class."""
        for field in fields(self):
            setattr(self, field.name, getattr(self, field.name) + getattr(other, field.name))

    def _count(self, name: str, events: Mask) -> None:
        setattr(self, name, getattr(self, name) + int(np.count_nonzero(events)))


@dataclass(slots=True)
class MoveVerdicts(VerdictCounts):
    """Exact verdicts on the movements of flights.

    `vertical` and `horizontal` count the accepted moves. `…_touching` of them have contact on the sweep, `…_begun` of
    these at its beginning (after a turn in place whose answer was ignored); `wrongly_accepted` of all have contact at
    their end. `wrongly_refused` moves end in a valid position. `asked` is the number of tested moves. For
    `procedure_2a_differs` of them the printed Procedure 2.a decides differently from the printed 2.b; for
    `repaired_2a_differs` and `repaired_2b_differs` the repaired procedure decides differently from the printed one.
    `turns` counts turns in place; `turns_touching` of them move a rotor through contact. `contacts` has the contacts of
    moves that begin in a valid position, at most MOST_CONTACTS.
    """

    vertical: int = 0
    vertical_touching: int = 0
    vertical_begun: int = 0
    horizontal: int = 0
    horizontal_touching: int = 0
    horizontal_begun: int = 0
    wrongly_accepted: int = 0
    wrongly_refused: int = 0
    asked: int = 0
    procedure_2a_differs: int = 0
    repaired_2a_differs: int = 0
    repaired_2b_differs: int = 0
    turns: int = 0
    turns_touching: int = 0
    contacts: tuple[Contact, ...] = ()

    def add(self, other: VerdictCounts) -> None:
        """Add the counts of another value."""
        VerdictCounts.add(self, other)  # super() fails in a class that dataclass copies for its slots
        self.contacts = self.contacts[:MOST_CONTACTS]

    def watch(self, craft: Craft, moves: Moves) -> None:
        """Count the results of a draw of many flights."""
        accepted = np.flatnonzero(moves.accepted)
        start, end, heading = of(moves.start, accepted), of(moves.end, accepted), headed(moves.before, accepted)
        vertical = moves.vertical[accepted]
        clear, begun, ended = _judged(craft, start, end, heading)
        for name, moved in (("vertical", vertical), ("horizontal", ~vertical)):
            self._count(name, moved)
            self._count(f"{name}_touching", moved & ~clear)
            self._count(f"{name}_begun", moved & ~begun)
        self._count("wrongly_accepted", ~ended)
        touching = np.flatnonzero(begun & ~clear)[: MOST_CONTACTS - len(self.contacts)]
        if len(touching):
            self.contacts += _contacts(craft, of(start, touching), of(end, touching), headed(heading, touching))
        refused = np.flatnonzero(moves.refused & ~moves.turning)
        self._count("wrongly_refused", valid(craft, of(moves.end, refused), headed(moves.before, refused)))
        self._compare(craft, moves)
        self._watch_turns(craft, moves)

    def _compare(self, craft: Craft, moves: Moves) -> None:
        """Count the answers of 2.a and of both repaired procedures that differ, about the moves that 2.b tested."""
        some = moves.tested
        at, heading, answer = of(moves.end, some), headed(moves.before, some), moves.accepted[some]
        printed, repaired = Procedures(craft), Procedures(craft, repaired=True)
        second = printed.ask_rotors(at, heading)
        self.asked += len(some)
        self._count("procedure_2a_differs", second != answer)
        self._count("repaired_2a_differs", repaired.ask_rotors(at, heading) != second)
        self._count("repaired_2b_differs", repaired.ask(at, heading)[0] != answer)

    def _watch_turns(self, craft: Craft, moves: Moves) -> None:
        some = np.flatnonzero(moves.turn)
        self.turns += len(some)
        at = of(moves.start, some)
        near = some[classify_scene(craft.sizes, *at) != Position.INTERIOR]
        at, heading = of(moves.start, near), headed(moves.before, near)
        x, y, z, turn = (np.tile(column, ROTORS) for column in (*at, moves.turn[near]))
        clear = stays_on_side_turning(craft.rotor, craft.arm, (x, y, z), craft.arms(heading), turn)
        self._count("turns_touching", ~all_four(clear))


def valid(craft: Craft, at: Columns, heading: Direction) -> Mask:
    """Return a mask of the valid positions, decided exactly: the body or every rotor is interior.

    Rotors' centres are floats computed by equation (15).
    """
    return body_or_rotors(craft, at, heading, lambda sizes, at: classify_scene(sizes, *at) == Position.INTERIOR)


def body_or_rotors(craft: Craft, at: Columns, heading: Direction, interior: Callable[[Sizes, Columns], Mask]) -> Mask:
    """Return a mask of the crafts of which the body, or else every rotor, is interior by the function `interior`."""

    def all_rotors(near: NDArray[np.int64]) -> Mask:
        return interior(craft.rotor, craft.rotors(of(at, near), headed(heading, near)))

    return or_all_four(interior(craft.sizes, at), all_rotors)


def or_all_four(bodies: Mask, rotors: Callable[[NDArray[np.int64]], Mask]) -> Mask:
    """Return a mask of the crafts whose body has the answer, or else all four rotors.

    `rotors` gets the indices of the crafts whose body does not have it, and answers in the order of `Craft.rotors`.
    """
    result = np.array(bodies)
    near = np.flatnonzero(~result)
    result[near] = all_four(rotors(near))
    return result


def all_four(rotors: Mask) -> Mask:
    """Return a mask of the crafts all of whose four rotors have the answer.

    `rotors` has the answers for all first rotors, then for all second ones, and so on.
    """
    return np.asarray(rotors.reshape(ROTORS, -1).all(axis=0))


def _judged(craft: Craft, start: Columns, end: Columns, heading: Direction) -> tuple[Mask, Mask, Mask]:
    """Return masks of the sweeps that are valid everywhere, at their beginning, and at their end."""
    bodies = stays_on_side(Position.INTERIOR, craft.sizes, start, end)
    begun, ended = bodies.copy(), bodies.copy()
    near = np.flatnonzero(~bodies)
    first, last, ahead = of(start, near), of(end, near), headed(heading, near)
    begun[near], ended[near] = valid(craft, first, ahead), valid(craft, last, ahead)
    rotors = craft.rotors(first, ahead), craft.rotors(last, ahead)
    clear = or_all_four(bodies, lambda _: stays_on_side(Position.INTERIOR, craft.rotor, *rotors))
    return clear, begun, ended


def _contacts(craft: Craft, start: Columns, end: Columns, heading: Direction) -> tuple[Contact, ...]:
    """Return the first contact of each move, with its rotor."""
    first, last = craft.rotors(start, heading), craft.rotors(end, heading)
    contacts = []
    for move in range(len(start[0])):
        times = [
            (first_contact(craft.rotor, first, last, move + rotor * len(start[0])), rotor + 1)
            for rotor in range(ROTORS)
        ]
        (lower, upper), rotor = min(times)
        contacts.append(Contact(_at(start, move), _at(end, move), rotor, lower, upper))
    return tuple(contacts)


def of(point: Columns, indices: NDArray[np.int64]) -> Columns:
    """Return the points at these indices."""
    x, y, z = point
    return x[indices], y[indices], z[indices]


def headed(direction: Direction, indices: NDArray[np.int64]) -> Direction:
    """Return the directions at these indices."""
    return direction[0][indices], direction[1][indices]


def positions(sizes: Sizes, at: Columns, *further: Floats) -> Positions:
    """Decide the exact positions of spheroids of one size, (n,); `further` are a row's columns after the centre."""
    return np.asarray(classify(np.column_stack([np.tile(sizes, (len(at[0]), 1)), *at, *further])), dtype=np.int8)
