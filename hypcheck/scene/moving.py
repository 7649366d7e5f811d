"""The tables of a scene file that say how `hypcheck simulate` moves the mover: [flight] and [walk]."""

from __future__ import annotations

from hypcheck.scene import tables
from hypcheck.scene.model import TURNS, Flight, Start, Walk
from hypcheck.scene.tables import Table

_FLIGHT = ("distance", "straight", "vertical", "largest_turn", "refused_turn", "backward", "turn", "start")
_START = ("z", "radius", "margin")
_WALK = ("start", "heading", "steps", "step", "largest_turn", "refused_turn")


def flight_of(top: Table) -> Flight | None:
    """What [flight] says, None where it is not there. Raises InputError."""
    table = top.table("flight", _FLIGHT)
    if table is None:
        return None
    flight = Flight(
        distance=table.required("distance", tables.positive),
        straight=table.required("straight", tables.share),
        vertical=table.required("vertical", tables.share),
        largest_turn=table.required("largest_turn", tables.turn),
        refused_turn=table.required("refused_turn", tables.turn),
        backward=table.required("backward", tables.truth),
        turn=table.required("turn", tables.one_of(*TURNS)),
        start=_start(table),
    )
    moving = flight.straight + flight.vertical
    if moving > 1:
        table.refuse(f"[flight]: straight and vertical add up to {moving!r}; they must not exceed 1", "vertical")
    if moving == 0 and flight.turn == "free":
        table.refuse("[flight]: nothing ever moves: straight and vertical are 0, and turns are free", "straight")
    return flight


def _start(flight: Table) -> Start:
    table = flight.table("start", _START)
    if table is None:
        flight.refuse("[flight] has no start; it must be a table with z, and radius or margin")
    start = Start(
        z=table.required("z", tables.span_or_number),
        radius=table.optional("radius", tables.not_negative, None),
        margin=table.optional("margin", tables.not_negative, None),
    )
    if (start.radius is None) == (start.margin is None):
        table.refuse("[flight].start must have either a radius or a margin")
    return start


def walk_of(top: Table) -> Walk | None:
    """What [walk] says, None where it is not there. Raises InputError."""
    table = top.table("walk", _WALK)
    if table is None:
        return None
    return Walk(
        start=table.required("start", tables.point),
        heading=table.required("heading", tables.turn),
        steps=table.required("steps", tables.whole),
        step=table.required("step", tables.positive),
        largest_turn=table.required("largest_turn", tables.turn),
        refused_turn=table.required("refused_turn", tables.turn),
    )
