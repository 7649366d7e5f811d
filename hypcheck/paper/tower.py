"""`simulate tower`: the quadcopter of the paper's sections 3.2 and 4, its flights (Figure 4) and Table 5.

The figure has flights of 25 positions and Δ along them; the table is shown with the printed figures. A cell of the
table belongs to a step v·t, the distance that the quadcopter covers at speed v in its response time t; it moves and
looks ahead by this step. Each run of a cell is a flight over the scene's distance; the cell's figure is the mean of the
runs' percentages.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Columns
from hypcheck.paper.ends import EndVerdicts, require_ends
from hypcheck.paper.flights import LANES, VERSION, Moves, Tallies, fly
from hypcheck.paper.motion import MoveVerdicts
from hypcheck.paper.pitch import PitchVerdicts, near_wall
from hypcheck.paper.quadcopter import Craft, Procedures, craft_of, require_valid_start
from hypcheck.processes import Advance, perform
from hypcheck.scene.model import Flight, SceneModel
from hypcheck.vectors.draw import Draw
from hypcheck.version import VERSION as HYPCHECK

FLIGHTS = 3
POSITIONS = 25


@dataclass(frozen=True, slots=True)
class ExactQuestions:
    """The questions about flights that are decided exactly, in addition to the answers of Procedure 2.b.

    `continuous`: whether the sweeps between positions are decided. `pitch`: the tilt of the quadcopter in horizontal
    movements, in degrees; with None, no tilted positions are decided. `ends`: whether positions beside the tower with
    its ends are decided.
    """

    continuous: bool = False
    pitch: float | None = None
    ends: bool = False


@dataclass(slots=True)
class FlightVerdicts:
    """The counts of exact verdicts about flights; they are zeros where the question was not asked."""

    ways: MoveVerdicts = field(default_factory=MoveVerdicts)
    pitch: PitchVerdicts = field(default_factory=PitchVerdicts)
    ends: EndVerdicts = field(default_factory=EndVerdicts)

    def watch(self, craft: Craft, questions: ExactQuestions, moves: Moves) -> None:
        """Count the results of a draw of many flights."""
        if questions.continuous:
            self.ways.watch(craft, moves)
        if questions.pitch is not None:
            self.pitch.watch(craft, questions.pitch, moves)
        if questions.ends:
            self.ends.watch(craft, moves)

    @classmethod
    def total(cls, several: Iterable[FlightVerdicts]) -> FlightVerdicts:
        """Return the sum of all counts."""
        added = cls()
        for verdicts in several:
            added.ways.add(verdicts.ways)
            added.pitch.add(verdicts.pitch)
            added.ends.add(verdicts.ends)
        return added


def paths(
    craft: Craft, flight: Flight, step: float, seed: int, questions: ExactQuestions
) -> tuple[list[dict[str, Any]], FlightVerdicts]:
    """Return three flights of 25 positions, from the tower's centre, for JSON; and exact verdicts on them.

    Each has `positions` [x, y, z], `discriminant` (equation (13) at each of them), and numbers: `executions`,
    executions with Δ ≤ 0 (`touching`), `refused` movements, and draws that lead outside the height (`outside_height`).
    """
    tracks: list[list[tuple[float, ...]]] = [[] for _ in range(FLIGHTS)]
    verdicts = FlightVerdicts()

    def observe(moves: Moves) -> None:
        verdicts.watch(craft, questions, moves)
        for place, lane in enumerate(moves.lane.tolist()):
            track = tracks[lane]
            for point, there in ((moves.start, not track), (moves.end, bool(moves.accepted[place]))):
                if there:
                    track.append(tuple(float(column[place]) for column in point))

    draw = Draw("tower-path", VERSION, seed, step)
    tallies = fly(craft, flight, step, POSITIONS - 1, draw, FLIGHTS, observe)
    procedures = Procedures(craft)
    return (
        [
            {
                "positions": [list(position) for position in track],
                "discriminant": procedures.discriminant(_columns(track)).tolist(),
                "executions": int(tallies.executions[lane]),
                "touching": int(tallies.touching[lane]),
                "refused": int(tallies.refused[lane]),
                "outside_height": int(tallies.redrawn[lane]),
            }
            for lane, track in enumerate(tracks)
        ],
        verdicts,
    )


def _columns(track: list[tuple[float, ...]]) -> Columns:
    x, y, z = np.array(track).T
    return x, y, z


SPEEDS = (5, 6, 7, 8, 9, 10)
"""The speeds v of the columns of Table 5, in metres a second."""

TIMES = (0.1, 0.2, 0.3)
"""The response times t of the rows of Table 5, in seconds."""

SECOND_READING = 0.25
"""The response time of the second row if the printed one, 0.2, is a misprint."""

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
    """Return the statement to show with every table; it also mentions rotors that overlap or leave the body."""
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
    questions: ExactQuestions

    @property
    def moves(self) -> int:
        """The number of accepted moves of a run."""
        return moves_of(self.flight, self.speed * self.time)


@dataclass(frozen=True, slots=True)
class FlightShare:
    """A figure of the table: the mean percentage, its standard error (None for a single run), and means per run.

    `outside_height`: draws that lead beyond the modelled height and are not tested.
    """

    percent: float
    standard_error: float | None
    executions: float
    refused: float
    outside_height: float
    verdicts: FlightVerdicts


def moves_of(flight: Flight, step: float) -> int:
    """Return the number of steps that cover the distance, without a last step that only a rounding makes necessary.

    Raises InputError if there are more than MOST_MOVES.
    """
    moves = flight.distance / step * (1 - 2.0**-40)
    if moves > MOST_MOVES:
        raise InputError(
            f"a run of {flight.distance!r} with steps of {step!r} would take {moves:.3g} moves; "
            f"it must be {MOST_MOVES:,} at most"
        )
    return math.ceil(moves)


def fly_block(block: FlightBlock) -> tuple[Tallies, FlightVerdicts]:
    """Return the events of a block's runs, counted, and the exact verdicts on them."""
    verdicts = FlightVerdicts()
    draw = Draw("tower-flight", VERSION, block.seed, float(block.speed), float(block.time), block.number)
    step = block.speed * block.time

    def observe(moves: Moves) -> None:
        verdicts.watch(block.craft, block.questions, moves)

    return fly(block.craft, block.flight, step, block.moves, draw, block.lanes, observe), verdicts


def blocks(
    craft: Craft, flight: Flight, seed: int, runs: int, questions: ExactQuestions = ExactQuestions()
) -> dict[tuple[float, float], list[FlightBlock]]:
    """Return the blocks of each cell (t, v): the cells of the table, and its second row read as t = 0.25."""
    return {
        (time, speed): [
            FlightBlock(craft, flight, speed, time, seed, number, min(LANES, runs - number * LANES), questions)
            for number in range(math.ceil(runs / LANES))
        ]
        for time in (*TIMES, SECOND_READING)
        for speed in SPEEDS
    }


def table_5(
    cells: Mapping[tuple[float, float], Sequence[FlightBlock]], executor: Executor | None, advance: Advance
) -> dict[tuple[float, float], FlightShare]:
    """Fly the blocks of every cell, in the executor's processes if there is one, and return the figures of the cells.

    `advance` gets the number of moves of a block when the block is done.
    """
    tasks = sorted((block for cell_blocks in cells.values() for block in cell_blocks), key=lambda block: -block.moves)
    results = {}
    for block, result in perform(fly_block, tasks, executor):
        results[block.time, block.speed, block.number] = result
        advance(block.moves)
    return {
        (time, speed): _cell([results[time, speed, block.number] for block in cell_blocks])
        for (time, speed), cell_blocks in cells.items()
    }


def _cell(results: Sequence[tuple[Tallies, FlightVerdicts]]) -> FlightShare:
    """Combine the results of the blocks of a cell into its figure."""
    executions, touching, refused, redrawn = (
        np.concatenate([getattr(tallies, name) for tallies, _ in results])
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
        verdicts=FlightVerdicts.total(verdicts for _, verdicts in results),
    )


_COLUMNS = "percent", "standard_error"
_FURTHER_COLUMNS = "difference_in_standard_errors", "executions", "refused", "outside_height"


def as_json(
    cells: Mapping[tuple[float, float], FlightShare], runs: int, craft_words: str, ways: MoveVerdicts | None
) -> dict[str, Any]:
    """Return the table with rows t and columns v, in the form of docs/simulate.md, and the statement for it."""
    rows = [[cells[time, speed] for speed in SPEEDS] for time in (*TIMES, SECOND_READING)]
    columns: dict[str, list[list[float | None]]] = {
        name: [[getattr(cell, name) for cell in row] for row in rows]
        for name in ("percent", "standard_error", "executions", "refused", "outside_height")
    }
    columns["difference_in_standard_errors"] = [
        [_difference(cell, figure, runs) for cell, figure in zip(row, figures, strict=True)]
        for row, figures in zip(rows, (*PRINTED, PRINTED[1]), strict=True)
    ]
    *as_printed, read_anew = rows
    return {
        "statement": craft_words,
        "runs": runs,
        "v": list(SPEEDS),
        "t": list(TIMES),
        **{name: columns[name][:-1] for name in _COLUMNS},
        "printed": [list(row) for row in PRINTED],
        **{name: columns[name][:-1] for name in _FURTHER_COLUMNS},
        "root_mean_square_difference": _root_mean_square(as_printed),
        "second_row_read_as_0.25": {
            "t": SECOND_READING,
            **{name: columns[name][-1] for name in (*_COLUMNS, *_FURTHER_COLUMNS)},
            "root_mean_square_difference": _root_mean_square([rows[0], read_anew, rows[2]]),
        },
        "ways": None if ways is None else asdict(ways),
    }


def _difference(cell: FlightShare, figure: float, runs: int) -> float | None:
    """Return our figure minus the paper's, divided by the standard error of the difference.

    The paper's figure is taken to be as uncertain as the mean of PRINTED_RUNS of our runs. The result is None if the
    cell has no standard error.
    """
    if not cell.standard_error:
        return None
    return (cell.percent - figure) / (cell.standard_error * math.sqrt(1 + runs / PRINTED_RUNS))


def _root_mean_square(rows: Sequence[Sequence[FlightShare]]) -> float:
    """Return the root mean square of the differences between our figures and the printed ones."""
    squares = [
        (cell.percent - figure) ** 2
        for row, figures in zip(rows, PRINTED, strict=True)
        for cell, figure in zip(row, figures, strict=True)
    ]
    return math.sqrt(math.fsum(squares) / len(squares))


SCHEMA = "1.2.0"


@dataclass(frozen=True, slots=True)
class TowerPlan:
    """The plan of a simulation: the figure's flights with steps of `speed`·`time`, and Table 5 if `runs` > 0.

    `questions` are of all flights, but tilted only those of the table.
    """

    scene: SceneModel
    seed: int
    speed: float
    time: float
    runs: int
    questions: ExactQuestions = ExactQuestions()

    @property
    def craft(self) -> Craft:
        """The scene's quadcopter. Raises InputError if the scene has none to which the procedures apply."""
        return craft_of(self.scene)

    @property
    def flight(self) -> Flight:
        """The scene's rules of flight. Raises InputError if it has none, or they begin at a place that is not valid."""
        if self.scene.flight is None:
            raise InputError(f"the scene {self.scene.name!r} has no [flight]; docs/scenes.md has its keys")
        _require_room(self.scene, self.scene.flight)
        require_valid_start(self.scene.name, self.craft, self.scene.flight.start)
        return self.scene.flight

    def blocks(self) -> dict[tuple[float, float], list[FlightBlock]]:
        """Return the blocks of Table 5 by cell; none if the table is not requested. Raises InputError."""
        if not self.runs:
            return {}
        return blocks(self.craft, self.flight, self.seed, self.runs, self.questions)


def _require_room(scene: SceneModel, flight: Flight) -> None:
    """Raise InputError if flights begin outside the modelled height, or if the region is smaller than that height."""
    (tower,) = scene.hyperboloids
    start, height, region = flight.start.z, tower.height, scene.region
    if height is not None and not height.low <= start.low <= start.high <= height.high:
        raise InputError(
            f"the scene {scene.name!r}: flights start at z from {start.low:g} to {start.high:g}; that must be within "
            f"the tower's height, {height.low:g} to {height.high:g}"
        )
    level = tower.center[2]
    roomy = region.z is None or (
        height is not None and region.z.low <= level + height.low and region.z.high >= level + height.high
    )
    if region.x is not None or region.y is not None or not roomy:
        raise InputError(
            f"the scene {scene.name!r}: its region bounds the flights, which only the tower's wall and height may do; "
            "it must have no x and no y, and a z no shorter than the tower's height"
        )


def simulate_tower(plan: TowerPlan, executor: Executor | None, advance: Advance) -> dict[str, Any]:
    """Return the result in the form of schemas/simulate-tower-1.2.0.json. Raises InputError."""
    craft, flight, step, asked = plan.craft, plan.flight, plan.speed * plan.time, plan.questions
    if asked.ends:
        require_ends(plan.scene)
    tracks, flown = paths(craft, flight, step, plan.seed, replace(asked, pitch=None))
    cells, craft_words = table_5(plan.blocks(), executor, advance), statement(craft)
    total = FlightVerdicts.total(cell.verdicts for cell in cells.values())
    return {
        "hypcheck": HYPCHECK,
        "schema": SCHEMA,
        "simulation": "tower",
        "seed": plan.seed,
        "statement": craft_words,
        "assumptions": _assumptions(plan.scene, craft, flight),
        "flights": {
            "speed": plan.speed,
            "time": plan.time,
            "step": step,
            "paths": tracks,
            "ways": asdict(flown.ways) if asked.continuous else None,
        },
        "table_5": as_json(cells, plan.runs, craft_words, total.ways if asked.continuous else None) if cells else None,
        "pitch": None
        if asked.pitch is None
        else {
            "degrees": asked.pitch,
            "total": asdict(total.pitch),
            "cells": [{"t": time, "v": speed, **asdict(cell.verdicts.pitch)} for (time, speed), cell in cells.items()],
            "near_wall": near_wall(craft, asked.pitch, plan.seed),
        },
        **(
            {"ends": {"flights": asdict(flown.ends), "table_5": asdict(total.ends) if cells else None}}
            if asked.ends
            else {}
        ),
    }


_RULES = ("distance", "straight", "vertical", "largest_turn", "refused_turn", "backward", "turn")


def _assumptions(scene: SceneModel, craft: Craft, flight: Flight) -> dict[str, Any]:
    """Return the assumptions of the scene: the sizes that the paper prints, and the values that it leaves open."""
    alpha, gamma, b, d = craft.sizes
    _, _, small_b, small_d = craft.rotor
    height, start = None if craft.height is None else [craft.height.low, craft.height.high], flight.start
    return {
        "scene": scene.name,
        "alpha": alpha,
        "gamma": gamma,
        "height": height,
        "b": b,
        "d": d,
        "b_s": small_b,
        "d_s": small_d,
        "l": craft.arm,
        "g1_from_heading": craft.ahead,
        **{name: getattr(flight, name) for name in _RULES},
        "start": {"z": [start.z.low, start.z.high], "radius": start.radius, "margin": start.margin},
    }
