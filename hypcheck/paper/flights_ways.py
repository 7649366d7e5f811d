"""What a test at the end of each movement does not see: contact on the way, and turns that nobody answers for.

A position is valid where the body is interior, or all four rotors are. The rotors lie within the body, so a way is
valid from beginning to end exactly where no rotor meets contact on it: they are asked only where the body is not clear.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.classify import classify_scene
from hypcheck.pairs import Position
from hypcheck.paper.flights import Moves
from hypcheck.paper.flights_circle import Direction
from hypcheck.paper.flights_craft import ROTORS, Craft, Mask, Point, Procedures
from hypcheck.paper.motion import always, always_turning, first_contact

TOLD = 12
"""First contacts that are told one by one."""


@dataclass(frozen=True, slots=True)
class Contact:
    """The first contact on an accepted move from `start` to `end`, the centre's: of `rotor` 1 to 4.

    It is at a time from `first_lower` to `first_upper`, where the move takes from 0 to 1.
    """

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    rotor: int
    first_lower: float
    first_upper: float


@dataclass(slots=True)
class Ways:
    """Exact verdicts on the movements of flights.

    Of the accepted `vertical` and `horizontal` moves `…_touching` meet contact somewhere on the way, `…_begun` of these
    at its very beginning (after a turn in place whose answer was ignored), `wrongly_accepted` of all at their end.
    `wrongly_refused` moves end in a valid position. Of the moves that were `asked` about, Procedure 2.a as printed
    decides `procedure_2a_differs` otherwise than 2.b as printed; `repaired_2a_differs` and `repaired_2b_differs` are
    those that the procedures put right decide otherwise than as printed. Of the `turns` in place `turns_touching` sweep
    a rotor through contact. The `contacts` of moves that begin in a valid position are told, TOLD of them at most.
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

    def add(self, other: Ways) -> None:
        """Count what another has counted as well."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))
        self.contacts = self.contacts[:TOLD]

    def watch(self, craft: Craft, moves: Moves) -> None:
        """Count what a draw of many flights came to."""
        accepted = np.flatnonzero(moves.accepted)
        start, end, heading = _of(moves.start, accepted), _of(moves.end, accepted), _headed(moves.before, accepted)
        vertical = moves.vertical[accepted]
        clear, begun, ended = _judged(craft, start, end, heading)
        for name, those in (("vertical", vertical), ("horizontal", ~vertical)):
            self._count(name, those)
            self._count(f"{name}_touching", those & ~clear)
            self._count(f"{name}_begun", those & ~begun)
        self._count("wrongly_accepted", ~ended)
        touching = np.flatnonzero(begun & ~clear)[: TOLD - len(self.contacts)]
        if len(touching):
            self.contacts += _contacts(craft, _of(start, touching), _of(end, touching), _headed(heading, touching))
        refused = np.flatnonzero(moves.refused & ~moves.turning)
        self._count("wrongly_refused", valid(craft, _of(moves.end, refused), _headed(moves.before, refused)))
        self._compare(craft, moves)
        self._watch_turns(craft, moves)

    def _compare(self, craft: Craft, moves: Moves) -> None:
        """What Procedure 2.a, and both procedures put right, say of the moves that Procedure 2.b was asked about."""
        some = np.flatnonzero((moves.accepted | moves.refused) & ~moves.turning)
        at, heading, answer = _of(moves.end, some), _headed(moves.before, some), moves.accepted[some]
        printed, repaired = Procedures(craft), Procedures(craft, repaired=True)
        second = printed.ask_rotors(at, heading)
        self.asked += len(some)
        self._count("procedure_2a_differs", second != answer)
        self._count("repaired_2a_differs", repaired.ask_rotors(at, heading) != second)
        self._count("repaired_2b_differs", repaired.ask(at, heading)[0] != answer)

    def _watch_turns(self, craft: Craft, moves: Moves) -> None:
        some = np.flatnonzero(moves.turn)
        self.turns += len(some)
        at = _of(moves.start, some)
        near = some[classify_scene(craft.sizes, *at) != Position.INTERIOR]
        at, heading = _of(moves.start, near), _headed(moves.before, near)
        x, y, z, turn = (np.tile(column, ROTORS) for column in (*at, moves.turn[near]))
        clear = always_turning(craft.rotor, craft.arm, (x, y, z), craft.arms(heading), turn)
        self._count("turns_touching", ~_all_four(clear))

    def _count(self, name: str, those: Mask) -> None:
        setattr(self, name, getattr(self, name) + int(np.count_nonzero(those)))


def valid(craft: Craft, at: Point, heading: Direction) -> Mask:
    """Which positions are exactly valid: the body interior, or every rotor, centred where (15) says in floats."""
    result = np.asarray(classify_scene(craft.sizes, *at) == Position.INTERIOR)
    near = np.flatnonzero(~result)
    rotors = craft.rotors(_of(at, near), _headed(heading, near))
    result[near] = _all_four(classify_scene(craft.rotor, *rotors) == Position.INTERIOR)
    return result


def _all_four(rotors: Mask) -> Mask:
    return np.asarray(rotors.reshape(ROTORS, -1).all(axis=0))


def _judged(craft: Craft, start: Point, end: Point, heading: Direction) -> tuple[Mask, Mask, Mask]:
    """Which ways are valid throughout, which at their beginning, which at their end."""
    clear = always(Position.INTERIOR, craft.sizes, start, end)
    begun, ended = clear.copy(), clear.copy()
    near = np.flatnonzero(~clear)
    first, last, ahead = _of(start, near), _of(end, near), _headed(heading, near)
    rotors = craft.rotors(first, ahead), craft.rotors(last, ahead)
    clear[near] = _all_four(always(Position.INTERIOR, craft.rotor, *rotors))
    begun[near], ended[near] = valid(craft, first, ahead), valid(craft, last, ahead)
    return clear, begun, ended


def _contacts(craft: Craft, start: Point, end: Point, heading: Direction) -> tuple[Contact, ...]:
    """The first contact of each of these moves; the rotor that has it first."""
    first, last = craft.rotors(start, heading), craft.rotors(end, heading)
    found = []
    for move, (here, there) in enumerate(zip(zip(*start, strict=True), zip(*end, strict=True), strict=True)):
        times = [
            (first_contact(craft.rotor, first, last, move + rotor * len(start[0])), rotor + 1)
            for rotor in range(ROTORS)
        ]
        (lower, upper), rotor = min(times)
        found.append(Contact(_floats(here), _floats(there), rotor, lower, upper))
    return tuple(found)


def _floats(point: tuple[np.float64, ...]) -> tuple[float, float, float]:
    x, y, z = map(float, point)
    return x, y, z


def _of(point: Point, those: NDArray[np.int64]) -> Point:
    x, y, z = point
    return x[those], y[those], z[those]


def _headed(direction: Direction, those: NDArray[np.int64]) -> Direction:
    return direction[0][those], direction[1][those]
