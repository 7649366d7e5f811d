"""The paper's Figure 4 and Table 5: flights inside the tower, and how many executions of Procedure 2.b meet Δ ≤ 0.

The figure has flights of 25 positions and Δ along them; the table stands beside the printed figures. A cell of the
table is v·t: the way that the quadcopter covers at speed v in its response time t is the step that it moves and looks
ahead by. Each run of a cell is a flight over the scene's distance; its figure is the mean of the runs' percentages.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Columns
from hypcheck.paper.flights import LANES, VERSION, Moves, Tallies, fly
from hypcheck.paper.motion import MoveVerdicts
from hypcheck.paper.pitch import PitchVerdicts
from hypcheck.paper.quadcopter import Craft, Procedures
from hypcheck.processes import Advance, perform
from hypcheck.scene.model import Flight
from hypcheck.vectors.draw import Draw

FLIGHTS = 3
POSITIONS = 25


def paths(craft: Craft, flight: Flight, step: float, seed: int) -> tuple[list[dict[str, Any]], MoveVerdicts]:
    """Three flights of 25 positions each, from the tower's centre, as JSON has them; and exact verdicts on their ways.

    Each has `positions` [x, y, z], `discriminant` (equation (13) at each of them), and how many `executions`, of these
    `touching` (Δ ≤ 0), of the movements `refused`, and draws to `outside_height`.
    """
    tracks: list[list[tuple[float, ...]]] = [[] for _ in range(FLIGHTS)]
    ways = MoveVerdicts()

    def observe(moves: Moves) -> None:
        ways.watch(craft, moves)
        for place, lane in enumerate(moves.lane.tolist()):
            track = tracks[lane]
            for point, there in ((moves.start, not track), (moves.end, bool(moves.accepted[place]))):
                if there:
                    track.append(tuple(float(column[place]) for column in point))

    draw = Draw("tower-path", VERSION, seed, step)
    tallies = fly(craft, flight, step, POSITIONS - 1, draw, FLIGHTS, observe)
    procedures = Procedures(craft)
    return [
        {
            "positions": [list(position) for position in track],
            "discriminant": procedures.discriminant(_columns(track)).tolist(),
            "executions": int(tallies.executions[lane]),
            "touching": int(tallies.touching[lane]),
            "refused": int(tallies.refused[lane]),
            "outside_height": int(tallies.redrawn[lane]),
        }
        for lane, track in enumerate(tracks)
    ], ways


def _columns(track: list[tuple[float, ...]]) -> Columns:
    x, y, z = np.array(track).T
    return x, y, z


SPEEDS = (5, 6, 7, 8, 9, 10)
"""v, metres a second: the columns."""

TIMES = (0.1, 0.2, 0.3)
"""t, seconds: the rows."""

SECOND_READING = 0.25
"""The t of the second row, if the one that is printed, 0.2, is a misprint."""

PRINTED = (
    (13.9532, 13.9029, 13.5640, 13.1907, 12.9477, 12.4708),
    (11.7990, 10.9387, 10.3449, 9.6364, 8.9626, 8.5885),
    (10.9574, 10.2549, 9.4475, 8.6942, 7.8514, 7.4627),
)
PRINTED_RUNS = 1000

STATEMENT = (
    "The unstated parameters are not identified by the table: about 40,000 combinations of rules of flight were tried, "
    "and many fit its 18 figures about as well, so a good fit tells nothing about which rules the authors used."
)


def statement(craft: Craft) -> str:
    """What has to be said wherever the table is shown; that rotors overlap, or leave the body, where they do."""
    (_, _, b, _), (_, _, small, _) = craft.sizes, craft.rotor
    apart, inside = math.sqrt(2.0) * craft.arm >= 2 * small, craft.arm + small <= b
    if apart and inside:
        return STATEMENT
    what = "neighbouring rotors overlap" if not apart else "rotors reach out of the body"
    room = f"apart and inside the body they need {math.sqrt(2.0) * small:.4g} <= l <= {b - small:.4g}"
    return f"{STATEMENT} With l = {craft.arm:g} {what}; {room if math.sqrt(2.0) * small <= b - small else 'no l fits'}."


MOST_MOVES = 1_000_000


@dataclass(frozen=True, slots=True)
class FlightBlock:
    """Some runs of a cell, flown together: the `number`-th block, the first `lanes` flights of it."""

    craft: Craft
    flight: Flight
    speed: float
    time: float
    seed: int
    number: int
    lanes: int
    watched: bool
    pitch: float | None = None

    @property
    def moves(self) -> int:
        """Accepted moves of a run."""
        return moves_of(self.flight, self.speed * self.time)


@dataclass(frozen=True, slots=True)
class FlightShare:
    """A figure of the table: the mean percentage and its standard error (None for a single run), and means a run.

    `outside_height`: draws that lead beyond the modelled height, of which nothing is asked.
    """

    percent: float
    standard_error: float | None
    executions: float
    refused: float
    outside_height: float
    ways: MoveVerdicts | None
    pitch: PitchVerdicts


def moves_of(flight: Flight, step: float) -> int:
    """How many steps cover the distance; a last one that overshoots by rounding alone is not made.

    Raises InputError where there are more than MOST_MOVES.
    """
    moves = flight.distance / step * (1 - 2.0**-40)
    if moves > MOST_MOVES:
        raise InputError(
            f"a run of {flight.distance!r} with steps of {step!r} would take {moves:.3g} moves; "
            f"it must be {MOST_MOVES:,} at most"
        )
    return math.ceil(moves)


@dataclass(frozen=True, slots=True)
class FlownBlock:
    """What came of a block's runs: `ways` where it was watched, `pitch` with counts where its craft leans."""

    tallies: Tallies
    ways: MoveVerdicts | None
    pitch: PitchVerdicts


def fly_block(block: FlightBlock) -> FlownBlock:
    """The runs of a block, with exact verdicts on their ways where it is `watched`, and on leaning where it has one."""
    ways, leaning, degrees = MoveVerdicts() if block.watched else None, PitchVerdicts(), block.pitch

    def observe(moves: Moves) -> None:
        if ways is not None:
            ways.watch(block.craft, moves)
        if degrees is not None:
            leaning.watch(block.craft, degrees, moves)

    draw = Draw("tower-flight", VERSION, block.seed, float(block.speed), float(block.time), block.number)
    step = block.speed * block.time
    tallies = fly(block.craft, block.flight, step, block.moves, draw, block.lanes, observe)
    return FlownBlock(tallies, ways, leaning)


def blocks(
    craft: Craft, flight: Flight, seed: int, runs: int, *, watched: bool, pitch: float | None = None
) -> dict[tuple[float, float], list[FlightBlock]]:
    """The blocks of each cell (t, v): those of the table, and of its second row read as 0.25."""
    return {
        (time, speed): [
            FlightBlock(craft, flight, speed, time, seed, number, min(LANES, runs - number * LANES), watched, pitch)
            for number in range(math.ceil(runs / LANES))
        ]
        for time in (*TIMES, SECOND_READING)
        for speed in SPEEDS
    }


def table_5(
    cells: Mapping[tuple[float, float], Sequence[FlightBlock]], executor: Executor | None, advance: Advance
) -> dict[tuple[float, float], FlightShare]:
    """Every cell, flown by the executor's processes; advanced by a block's moves whenever one is done."""
    tasks = sorted((block for each in cells.values() for block in each), key=lambda block: -block.moves)
    done = {}
    for block, result in perform(fly_block, tasks, executor):
        done[block.time, block.speed, block.number] = result
        advance(block.moves)
    return {
        (time, speed): _cell([done[time, speed, block.number] for block in each])
        for (time, speed), each in cells.items()
    }


def _cell(results: Sequence[FlownBlock]) -> FlightShare:
    executions, touching, refused, redrawn = (
        np.concatenate([getattr(block.tallies, name) for block in results])
        for name in ("executions", "touching", "refused", "redrawn")
    )
    percents = (100.0 * touching / executions).tolist()
    mean = math.fsum(percents) / len(percents)
    spread = math.fsum((percent - mean) ** 2 for percent in percents)
    error = None if len(percents) == 1 else math.sqrt(spread / (len(percents) - 1) / len(percents))
    return FlightShare(
        percent=mean,
        standard_error=error,
        executions=float(np.mean(executions)),
        refused=float(np.mean(refused)),
        outside_height=float(np.mean(redrawn)),
        ways=sum_of_verdicts(block.ways for block in results),
        pitch=sum_of_pitch(block.pitch for block in results),
    )


def sum_of_verdicts(several: Iterable[MoveVerdicts | None]) -> MoveVerdicts | None:
    """All verdicts in one; None where there are none."""
    seen = [ways for ways in several if ways is not None]
    total = MoveVerdicts()
    for ways in seen:
        total.add(ways)
    return total if seen else None


def sum_of_pitch(several: Iterable[PitchVerdicts]) -> PitchVerdicts:
    """All counts in one."""
    total = PitchVerdicts()
    for each in several:
        total.add(each)
    return total


def pitch_as_json(cells: Mapping[tuple[float, float], FlightShare]) -> dict[str, Any]:
    """The counts of each cell (t, v), and all together."""
    return {
        "total": asdict(sum_of_pitch(cell.pitch for cell in cells.values())),
        "cells": [{"t": time, "v": speed, **asdict(cell.pitch)} for (time, speed), cell in cells.items()],
    }


def as_json(cells: Mapping[tuple[float, float], FlightShare], runs: int, said: str) -> dict[str, Any]:
    """The table in rows t and columns v, as docs/simulate.md has it; `said` is what has to be said of it."""
    rows = [[cells[time, speed] for speed in SPEEDS] for time in TIMES]
    other = [cells[SECOND_READING, speed] for speed in SPEEDS]
    ways = sum_of_verdicts(cell.ways for cell in cells.values())
    return {
        "statement": said,
        "runs": runs,
        "v": list(SPEEDS),
        "t": list(TIMES),
        "percent": [[cell.percent for cell in row] for row in rows],
        "standard_error": [[cell.standard_error for cell in row] for row in rows],
        "printed": [list(row) for row in PRINTED],
        "difference_in_standard_errors": [
            [_difference(cell, figure, runs) for cell, figure in zip(row, figures, strict=True)]
            for row, figures in zip(rows, PRINTED, strict=True)
        ],
        "executions": [[cell.executions for cell in row] for row in rows],
        "refused": [[cell.refused for cell in row] for row in rows],
        "outside_height": [[cell.outside_height for cell in row] for row in rows],
        "root_mean_square_difference": _root_mean_square(rows),
        "second_row_read_as_0.25": {
            "t": SECOND_READING,
            "percent": [cell.percent for cell in other],
            "standard_error": [cell.standard_error for cell in other],
            "difference_in_standard_errors": [
                _difference(cell, figure, runs) for cell, figure in zip(other, PRINTED[1], strict=True)
            ],
            "executions": [cell.executions for cell in other],
            "refused": [cell.refused for cell in other],
            "outside_height": [cell.outside_height for cell in other],
            "root_mean_square_difference": _root_mean_square([rows[0], other, rows[2]]),
        },
        "ways": None if ways is None else asdict(ways),
    }


def _difference(cell: FlightShare, figure: float, runs: int) -> float | None:
    """Ours less theirs over the standard error of that, theirs being as uncertain as 1000 of our runs are."""
    if not cell.standard_error:
        return None
    return (cell.percent - figure) / (cell.standard_error * math.sqrt(1 + runs / PRINTED_RUNS))


def _root_mean_square(rows: Sequence[Sequence[FlightShare]]) -> float:
    squares = [
        (cell.percent - figure) ** 2
        for row, figures in zip(rows, PRINTED, strict=True)
        for cell, figure in zip(row, figures, strict=True)
    ]
    return math.sqrt(math.fsum(squares) / len(squares))
