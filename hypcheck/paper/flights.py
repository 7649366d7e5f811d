"""Random flights inside a tower, many at once: the paper's section 4, with Procedure 2.b deciding each movement.

A flight is a sequence of draws. A draw gives a movement. Before the movement is made, the procedure tests the position
to which it leads; each test is an *execution* of the procedure. The rules, including those that the paper leaves open,
are a scene's `Flight`. A vertical draw that leads above the tower's height is drawn again without an execution.

Every draw of a flight takes two words of its block's stream, whatever its result, and a block always has LANES flights,
even if fewer are requested: so a flight depends only on the name of its block and its place in the block.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Columns, Floats, Mask
from hypcheck.paper import quadcopter
from hypcheck.scene.model import Flight, Start
from hypcheck.vectors.draw import Draw, unit_of

LANES = 1000
"""Flights of a block: enough to keep numpy's loops long."""

VERSION = 1
"""Version of the flights, raised whenever they draw other words, or the same words in another order."""

PATIENCE = 2000
"""Draws without an accepted move after which a flight is stuck. One with a hundredth of its draws accepted, fewer than
any that leads somewhere, waits that long with a chance of 0.99^2000 < 2e-9."""

Counts = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Moves:
    """The results of one draw, for the flights still under way; arrays (n,) throughout.

    `lane` has the numbers of the flights; they moved, or would have moved, from `start` to `end`. `accepted` and
    `refused` are movements that the procedure tested; `vertical` movements go up or down. A turn in place (`turning`)
    was tested too if `executed`, and may be refused if the flight's rules obey the answer. `touching` is Δ ≤ 0 at
    `end`. The heading was `before`; it turned by `turn` degrees, in place.
    """

    lane: NDArray[np.int64]
    start: Columns
    end: Columns
    before: quadcopter.Direction
    turn: Floats
    accepted: Mask
    refused: Mask
    vertical: Mask
    turning: Mask
    executed: Mask
    touching: Mask

    @property
    def tested(self) -> NDArray[np.int64]:
        """The indices of the movements, not turns in place, that the procedure tested."""
        return np.flatnonzero((self.accepted | self.refused) & ~self.turning)


@dataclass(slots=True)
class Tallies:
    """Events of each flight of a block, counted; int64 (lanes,) each."""

    executions: Counts
    touching: Counts
    accepted: Counts
    vertical: Counts
    refused: Counts
    redrawn: Counts

    @classmethod
    def of(cls, lanes: int) -> Tallies:
        """Make tallies of zeros for this many flights."""
        return cls(*(np.zeros(lanes, dtype=np.int64) for _ in fields(cls)))

    def add(self, moves: Moves) -> None:
        """Count the results of a draw."""
        drawn = moves.lane
        self.executions[drawn] += moves.executed
        self.touching[drawn] += moves.executed & moves.touching
        self.accepted[drawn] += moves.accepted
        self.vertical[drawn] += moves.accepted & moves.vertical
        self.refused[drawn] += moves.refused
        self.redrawn[drawn] += ~moves.executed & moves.vertical


@dataclass(slots=True)
class _State:
    """The unfinished flights: their places, their headings, and whether their next draw is a step ahead.

    `left` is the number of accepted moves still to make; the last `idle` draws led to no accepted move.
    """

    lane: NDArray[np.int64]
    at: Columns
    heading: quadcopter.Direction
    due: Mask
    left: Counts
    idle: Counts

    def kept(self, those: Mask) -> _State:
        """Return the state reduced to the flights of the mask."""
        (x, y, z), (cosine, sine) = self.at, self.heading
        return _State(
            self.lane[those],
            (x[those], y[those], z[those]),
            (cosine[those], sine[those]),
            self.due[those],
            self.left[those],
            self.idle[those],
        )


@dataclass(frozen=True, slots=True)
class _Chosen:
    """The draw of each flight: the step ahead (1, −1 or 0), the step up or down (1, −1 or 0), the turn."""

    ahead: Floats
    up: Floats
    turning: Mask
    turn: Floats
    refused_turn: Floats


def fly(
    craft: quadcopter.Craft,
    flight: Flight,
    step: float,
    moves: int,
    draw: Draw,
    lanes: int = LANES,
    observe: Callable[[Moves], object] | None = None,
) -> Tallies:
    """Let `lanes` flights make `moves` accepted moves of length `step` each.

    `draw` is the stream of the block; the first `lanes` of its LANES flights are flown. `observe` gets the results of
    every draw. Raises InputError if a flight is stuck: no draw is accepted.
    """
    procedures, tallies = quadcopter.Procedures(craft), Tallies.of(lanes)
    state = _begin(craft, flight.start, draw, lanes, moves)
    while len(state.lane):
        words = draw.words(2 * LANES).reshape(2, LANES)[:, state.lane]
        drawn = _advance(craft, flight, step, procedures, state, words)
        tallies.add(drawn)
        if observe is not None:
            observe(drawn)
        if (state.idle >= PATIENCE).any():
            raise InputError(
                f"a flight with steps of {step!r} is stuck: {PATIENCE} draws in a row led to no accepted move; "
                "steps must be short enough, and the scene's flight must leave it a way"
            )
        if not state.left.all():
            state = state.kept(state.left > 0)
    return tallies


def _begin(craft: quadcopter.Craft, start: Start, draw: Draw, lanes: int, moves: int) -> _State:
    """Draw the start and the heading of each flight."""
    z = draw.between(LANES, start.z.low, start.z.high)
    radius = quadcopter.rims(craft, start, z) * np.sqrt(draw.unit(LANES))
    (cosine, sine), heading = _anywhere(draw), _anywhere(draw)
    return _State(
        lane=np.arange(lanes),
        at=((radius * cosine)[:lanes], (radius * sine)[:lanes], z[:lanes]),
        heading=(heading[0][:lanes], heading[1][:lanes]),
        due=np.zeros(lanes, dtype=np.bool_),
        left=np.full(lanes, moves, dtype=np.int64),
        idle=np.zeros(lanes, dtype=np.int64),
    )


def _anywhere(draw: Draw) -> quadcopter.Direction:
    """Draw directions, uniform over the circle."""
    words = draw.words(LANES)
    return quadcopter.quarter_turns(
        *quadcopter.small_angle((2 * unit_of(words) - 1) * quadcopter.EIGHTH), (words & np.uint64(3)).astype(np.int64)
    )


def _choose(flight: Flight, due: Mask, words: NDArray[np.uint64]) -> _Chosen:
    """Return the choice from the two words of each flight. A step ahead that is due replaces this choice."""
    chance, sense = unit_of(words[0]), np.where(words[0] & np.uint64(1) == 0, 1.0, -1.0)
    straight = ~due & (chance < flight.straight)
    vertical = ~due & ~straight & (chance < flight.straight + flight.vertical)
    turning = ~(due | straight | vertical)
    left = np.where(words[0] & np.uint64(2) == 0, 1.0, -1.0)
    return _Chosen(
        ahead=np.where(due, 1.0, np.where(straight, sense if flight.backward else 1.0, 0.0)),
        up=np.where(vertical, sense, 0.0),
        turning=turning,
        turn=np.where(turning, (2 * unit_of(words[1]) - 1) * flight.largest_turn, 0.0),
        refused_turn=left * flight.refused_turn,
    )


def _advance(
    craft: quadcopter.Craft,
    flight: Flight,
    step: float,
    procedures: quadcopter.Procedures,
    state: _State,
    words: NDArray[np.uint64],
) -> Moves:
    """Draw a move for every unfinished flight, and change the state accordingly; return the moves."""
    chosen, start, before = _choose(flight, state.due, words), state.at, state.heading
    heading = _turned(before, chosen.turn)
    end = _moved(start, heading, chosen, step)
    vertical = chosen.up != 0
    executed = ~(vertical & _beyond(craft, end)) & ~(chosen.turning & (flight.turn == "free"))
    valid, touching = procedures.ask(end, heading)
    moving = executed & ~chosen.turning
    answered = executed if flight.turn == "obeyed" else moving
    accepted, refused = moving & valid, answered & ~valid
    turn = np.where(refused, chosen.refused_turn, chosen.turn)
    state.at = _where(accepted, end, start)
    undone = refused & chosen.turning
    new_heading = np.where(undone, before[0], heading[0]), np.where(undone, before[1], heading[1])
    state.heading = _turned(new_heading, np.where(refused, chosen.refused_turn, 0.0))
    state.due = chosen.turning & ~refused & (flight.turn != "free")
    state.left = state.left - accepted
    state.idle = np.where(accepted, 0, state.idle + 1)
    return Moves(state.lane, start, end, before, turn, accepted, refused, vertical, chosen.turning, executed, touching)


def _moved(start: Columns, heading: quadcopter.Direction, chosen: _Chosen, step: float) -> Columns:
    """Return the places to which the chosen steps of length `step` lead."""
    (x, y, z), along = start, chosen.ahead * step
    return x + along * heading[0], y + along * heading[1], z + chosen.up * step


def _beyond(craft: quadcopter.Craft, at: Columns) -> Mask:
    """Return a mask of the positions outside the modelled height."""
    z = at[2]
    if craft.height is None:
        return np.zeros(z.shape, dtype=np.bool_)
    return np.asarray((z < craft.height.low) | (z > craft.height.high))


def _turned(heading: quadcopter.Direction, degrees: Floats) -> quadcopter.Direction:
    """Return the headings after a turn; one that does not turn stays as it is, bit for bit."""
    some = np.flatnonzero(degrees)
    cosine, sine = heading[0].copy(), heading[1].copy()
    cosine[some], sine[some] = quadcopter.turned((cosine[some], sine[some]), quadcopter.any_angle(degrees[some]))
    return cosine, sine


def _where(those: Mask, one: Columns, other: Columns) -> Columns:
    """Return the points of `one` in the mask and those of `other` elsewhere."""
    x, y, z = (np.where(those, a, b) for a, b in zip(one, other, strict=True))
    return x, y, z
