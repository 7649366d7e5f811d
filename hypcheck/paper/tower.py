"""`simulate tower`: the quadcopter of the paper's sections 3.2 and 4, its flights and Table 5, as JSON and as text."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any

from hypcheck.errors import InputError
from hypcheck.messages import counted
from hypcheck.paper import tower_flights
from hypcheck.paper.pitch import near_wall, pitch_lines
from hypcheck.paper.quadcopter import Craft, craft_of, require_valid_start
from hypcheck.paper.tower_flights import FlightBlock, paths
from hypcheck.processes import Advance
from hypcheck.scene.model import Flight, SceneModel
from hypcheck.version import VERSION

SCHEMA = "1.2.0"


@dataclass(frozen=True, slots=True)
class TowerPlan:
    """What is to be simulated: the flights of the figure with steps of `speed`·`time`, and Table 5 where `runs` > 0.

    `continuous`: the ways between positions are decided as well, in the table too. `pitch`: by how many degrees the
    quadcopter leans into its horizontal movements in the table's flights, or None where that is not asked.
    """

    scene: SceneModel
    seed: int
    speed: float
    time: float
    runs: int
    continuous: bool
    pitch: float | None = None

    @property
    def craft(self) -> Craft:
        """The scene's quadcopter. Raises InputError where the scene has none that the procedures are about."""
        return craft_of(self.scene)

    @property
    def flight(self) -> Flight:
        """The scene's rules of flight. Raises InputError where it has none, or they begin where no flight may be."""
        if self.scene.flight is None:
            raise InputError(f"the scene {self.scene.name!r} has no [flight]; docs/scenes.md has its keys")
        _require_room(self.scene, self.scene.flight)
        require_valid_start(self.scene.name, self.craft, self.scene.flight.start)
        return self.scene.flight

    def blocks(self) -> dict[tuple[float, float], list[FlightBlock]]:
        """The work of Table 5, by cell; none where it is not asked for. Raises InputError."""
        if not self.runs:
            return {}
        return tower_flights.blocks(
            self.craft, self.flight, self.seed, self.runs, watched=self.continuous, pitch=self.pitch
        )


def _require_room(scene: SceneModel, flight: Flight) -> None:
    """Raise InputError where flights begin outside the modelled height, or the region bounds them closer than that."""
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
    """The result, as schemas/simulate-tower-1.2.0.json has it. Raises InputError."""
    craft, flight, step = plan.craft, plan.flight, plan.speed * plan.time
    tracks, ways = paths(craft, flight, step, plan.seed)
    blocks = plan.blocks()
    cells = tower_flights.table_5(blocks, executor, advance)
    return {
        "hypcheck": VERSION,
        "schema": SCHEMA,
        "simulation": "tower",
        "seed": plan.seed,
        "statement": tower_flights.statement(craft),
        "assumptions": _assumptions(plan.scene, craft, flight),
        "flights": {
            "speed": plan.speed,
            "time": plan.time,
            "step": step,
            "paths": tracks,
            "ways": asdict(ways) if plan.continuous else None,
        },
        "table_5": tower_flights.as_json(cells, plan.runs, tower_flights.statement(craft)) if cells else None,
        "pitch": None
        if plan.pitch is None
        else {
            "degrees": plan.pitch,
            **tower_flights.pitch_as_json(cells),
            "near_wall": near_wall(craft, plan.pitch, plan.seed),
        },
    }


def _assumptions(scene: SceneModel, craft: Craft, flight: Flight) -> dict[str, Any]:
    """What the scene says: the sizes the paper prints, and all that it leaves open."""
    alpha, gamma, b, d = craft.sizes
    _, _, small_b, small_d = craft.rotor
    height = None if craft.height is None else [craft.height.low, craft.height.high]
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
        "distance": flight.distance,
        "straight": flight.straight,
        "vertical": flight.vertical,
        "largest_turn": flight.largest_turn,
        "refused_turn": flight.refused_turn,
        "backward": flight.backward,
        "turn": flight.turn,
        "start": {
            "z": [flight.start.z.low, flight.start.z.high],
            "radius": flight.start.radius,
            "margin": flight.start.margin,
        },
    }


WIDTH = 100
SHOWN = 6
"""First contacts that are listed one by one; the JSON has more."""


_TURNS = {
    "executed": "a turn asks the procedure in place, ignores the answer, and a step ahead follows",
    "obeyed": "a turn asks the procedure in place, is not made if the answer is no, and else a step ahead follows",
    "free": "a turn asks nothing",
}


def tower_lines(result: dict[str, Any]) -> Iterator[str]:
    """Line by line."""
    yield from _assumed(result["assumptions"], result["seed"])
    yield ""
    yield from _flown(result["flights"])
    table = result["table_5"]
    if table is not None:
        yield ""
        yield from _table(table, result["assumptions"]["distance"])
        if table["ways"] is not None:
            yield ""
            yield "On the ways between the positions of these runs:"
            yield from _ways(table["ways"])
    if result["pitch"] is not None:
        yield ""
        yield from pitch_lines(result["pitch"])
    yield ""
    yield from textwrap.wrap(result["statement"], WIDTH)


def _assumed(scene: dict[str, Any], seed: int) -> Iterator[str]:
    yield f"{scene['scene']}, seed {seed}"
    yield f"  tower alpha = {scene['alpha']:g}, gamma = {scene['gamma']:g}; {_height(scene['height'])}"
    yield (
        f"  body b = {scene['b']:g}, d = {scene['d']:g}; rotors b_s = {scene['b_s']:g}, d_s = {scene['d_s']:g}, "
        f"l = {scene['l']:g}, g1 = heading {scene['g1_from_heading']:+g} degrees"
    )
    turns = 1 - scene["straight"] - scene["vertical"]
    ahead = "ahead or back, half each" if scene["backward"] else "ahead"
    yield f"  draws: straight {scene['straight']:g} ({ahead}), up or down {scene['vertical']:g}, turns {turns:g}"
    yield f"  turns within {scene['largest_turn']:g} degrees: {_TURNS[scene['turn']]}"
    yield f"  a refused movement turns by {scene['refused_turn']:g} degrees, left or right"
    yield f"  {_start(scene['start'])}"


def _height(span: Sequence[float] | None) -> str:
    if span is None:
        return "no end of its height is modelled"
    return f"its height from {span[0]:g} to {span[1]:g}, beyond which an up or down is drawn again"


def _start(start: dict[str, Any]) -> str:
    radius, margin, (low, high) = start["radius"], start["margin"], start["z"]
    disc = f"of radius {radius:g}" if margin is None else f"that ends {margin:g} before the wall"
    at = f"z = {low:g}" if low == high else f"z uniform from {low:g} to {high:g}"
    return f"flights begin at {at}, uniform over the disc {disc}, heading anywhere"


def _flown(flights: dict[str, Any]) -> Iterator[str]:
    paths = flights["paths"]
    yield (
        f"{counted(len(paths), 'flight')} of {counted(len(paths[0]['positions']), 'position')}, "
        f"steps of {flights['step']:g} ({flights['speed']:g} m/s for {flights['time']:g} s)"
    )
    for number, path in enumerate(paths, start=1):
        least, most = min(path["discriminant"]), max(path["discriminant"])
        made = len(path["positions"]) - 1
        yield (
            f"  {number}: {counted(path['executions'], 'execution')}, of which {made} moves made and "
            f"{counted(path['refused'], 'attempt')} refused; Δ ≤ 0 in {path['touching']};"
        )
        yield (
            f"     Δ at its positions from {least:.3g} to {most:.3g} (refused attempts lead to none); "
            f"{counted(path['outside_height'], 'draw')} beyond the height"
        )
    if flights["ways"] is not None:
        yield from _ways(flights["ways"])


def _table(table: dict[str, Any], distance: float) -> Iterator[str]:
    yield f"Table 5: executions with Δ ≤ 0, percent; means of {counted(table['runs'], 'run')} of {distance:g} m"
    yield "  (± standard error; below: printed, and ours less printed in standard errors of the difference)"
    yield "       v (m/s)" + "".join(f"{speed:>14}" for speed in table["v"])
    rows = zip(
        table["t"],
        table["percent"],
        table["standard_error"],
        table["printed"],
        table["difference_in_standard_errors"],
        strict=True,
    )
    for row in rows:
        yield from _row(*row)
    other = table["second_row_read_as_0.25"]
    yield "  the second row, if its t is a misprint for 0.25:"
    difference = other["difference_in_standard_errors"]
    yield from _row(other["t"], other["percent"], other["standard_error"], table["printed"][1], difference)
    yield (
        f"  root mean square difference of the 18 figures: {table['root_mean_square_difference']:.2f} as printed, "
        f"{other['root_mean_square_difference']:.2f} with t = 0.25 in the second row"
    )
    executions, refused, outside = (
        _between(table[name], other[name]) for name in ("executions", "refused", "outside_height")
    )
    yield f"  a run: {executions} executions, {refused} movements refused, {outside} draws outside the modelled height"


def _between(rows: Sequence[Sequence[float]], other: Sequence[float]) -> str:
    values = [value for row in (*rows, other) for value in row]
    return f"{min(values):,.0f} to {max(values):,.0f}"


def _row(
    time: float,
    percents: Sequence[float],
    errors: Sequence[float | None],
    printed: Sequence[float],
    differences: Sequence[float | None],
) -> Iterator[str]:
    ours = "".join(f"{_with_error(percent, error):>14}" for percent, error in zip(percents, errors, strict=True))
    yield f"  t = {time:4g} s  {ours}"
    yield "  printed     " + "".join(f"{figure:>14.4f}" for figure in printed)
    shown = ("–" if each is None else f"{each:+.1f}" for each in differences)
    yield "  difference  " + "".join(f"{each:>14}" for each in shown)


def _with_error(percent: float, error: float | None) -> str:
    return f"{percent:.2f}" if error is None else f"{percent:.2f} ± {error:.2f}"


def _ways(ways: dict[str, Any]) -> Iterator[str]:
    for name in ("vertical", "horizontal"):
        moves, touching, begun = ways[name], ways[f"{name}_touching"], ways[f"{name}_begun"]
        touch = "touches" if touching == 1 else "touch"
        yield (
            f"  {counted(moves, f'accepted {name} move')}: {touching:,} {touch}{_share(touching, moves)}, "
            f"{begun:,} from their beginning and {touching - begun:,} on the way"
        )
    yield from _contacts(ways["contacts"])
    turns, touching = ways["turns"], ways["turns_touching"]
    sweep = f"{touching:,} {'sweeps' if touching == 1 else 'sweep'} a rotor through contact{_share(touching, turns)}"
    yield f"  {counted(turns, 'turn')} in place: {sweep}"
    yield (
        "  at the ends of moves the procedure was wrong "
        + counted(ways["wrongly_accepted"] + ways["wrongly_refused"], "time")
    )
    yield (
        f"  of {counted(ways['asked'], 'move')} asked about, Procedure 2.b put right decides "
        f"{ways['repaired_2b_differs']:,} otherwise than as printed,"
    )
    yield (
        f"  Procedure 2.a put right {ways['repaired_2a_differs']:,}; 2.a as printed decides "
        f"{ways['procedure_2a_differs']:,} otherwise than 2.b as printed"
    )


def _contacts(contacts: list[dict[str, Any]]) -> Iterator[str]:
    for contact in contacts[:SHOWN]:
        start, end = (", ".join(f"{each:.3f}" for each in contact[name]) for name in ("start", "end"))
        yield (f"    ({start}) to ({end}): rotor {contact['rotor']} first at {contact['first_upper']:.3g} of the way")


def _share(part: int, whole: int) -> str:
    return f" ({100 * part / whole:.3f} %)" if whole else ""
