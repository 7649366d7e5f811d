"""`simulate tower`: the quadcopter of the paper's sections 3.2 and 4, its flights and Table 5, as one JSON object."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from typing import Any

from hypcheck.errors import InputError
from hypcheck.paper import tower_table
from hypcheck.paper.flights_craft import Craft, craft_of
from hypcheck.paper.flights_start import require_valid_start
from hypcheck.paper.tower_paths import paths
from hypcheck.paper.tower_table import Advance, Block
from hypcheck.scene.model import Flight, Scene
from hypcheck.version import VERSION

SCHEMA = "1.1.0"


@dataclass(frozen=True, slots=True)
class TowerPlan:
    """What is to be simulated: the flights of the figure with steps of `speed`·`time`, and Table 5 where `runs` > 0.

    `continuous`: the ways between positions are decided as well, in the table too.
    """

    scene: Scene
    seed: int
    speed: float
    time: float
    runs: int
    continuous: bool

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

    def blocks(self) -> dict[tuple[float, float], list[Block]]:
        """The work of Table 5, by cell; none where it is not asked for. Raises InputError."""
        if not self.runs:
            return {}
        return tower_table.blocks(self.craft, self.flight, self.seed, self.runs, watched=self.continuous)


def _require_room(scene: Scene, flight: Flight) -> None:
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
    """The result, as schemas/simulate-tower-1.1.0.json has it. Raises InputError."""
    craft, flight, step = plan.craft, plan.flight, plan.speed * plan.time
    tracks, ways = paths(craft, flight, step, plan.seed)
    blocks = plan.blocks()
    cells = tower_table.table_5(blocks, executor, advance)
    return {
        "hypcheck": VERSION,
        "schema": SCHEMA,
        "simulation": "tower",
        "seed": plan.seed,
        "statement": tower_table.statement(craft),
        "assumptions": _assumptions(plan.scene, craft, flight),
        "flights": {
            "speed": plan.speed,
            "time": plan.time,
            "step": step,
            "paths": tracks,
            "ways": asdict(ways) if plan.continuous else None,
        },
        "table_5": tower_table.as_json(cells, plan.runs, tower_table.statement(craft)) if cells else None,
    }


def _assumptions(scene: Scene, craft: Craft, flight: Flight) -> dict[str, Any]:
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
