"""`hypcheck flight` and `hypcheck show`: what happens on a flight through a scene, in words and as a picture."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import completing
from hypcheck.cli.options import OutputPath
from hypcheck.errors import InputError
from hypcheck.messages import printable

if TYPE_CHECKING:
    from hypcheck.kernel.scene import Scene
    from hypcheck.tables.flight_table import FlightTable

_FLIGHT_HELP = """Find the first contact on flights through SCENE, and their least distance, exactly.

SCENE is a file (docs/scenes.md) or a shipped scene. PATH is a CSV file of corners of the mover's centre, which goes
straight from each to the next: columns x, y, z; optional are heading (degrees) and axis_x, axis_y, axis_z for the
segment that begins there, and flight, if the file has several. Standard input is - .

\b
hypcheck flight tower path.csv
hypcheck flight forest.toml flights.csv --json

The answer is the first segment with contact, counted from 0, bounds of the time within it, and the hyperboloid; or that
the flight is clear. The least distance is that of the mover itself, without its parts, at all times, given as two
bounds. The exit code is 0 with contact and without.
"""


@click.command(
    help=_FLIGHT_HELP, short_help="Find the first contact on flights through a scene, and how near they come."
)
@click.argument("scene", metavar="SCENE", type=completing.SCENE)
@click.argument("path", metavar="PATH")
@click.option("--json", "as_json", is_flag=True, help="One JSON object for each flight, a line each.")
def flight(scene: str, path: str, as_json: bool) -> None:
    """Read, decide, and print."""
    from hypcheck.kernel.scene import Scene
    from hypcheck.tables.flight_table import read_flights

    world = Scene.from_toml(scene)
    for answer in _answers(world, read_flights(path)):
        click.echo(json.dumps(answer) if as_json else printable(_in_words(answer)))


def _answers(scene: Scene, table: FlightTable) -> list[dict[str, Any]]:
    """What is said of each flight, with None where there is no contact."""
    heading = 0.0 if table.headings is None else table.headings
    contacts = scene.first_contact(table.paths, heading, axis=table.axes)
    names = [body.name for body in scene.model.hyperboloids]
    least, answers = contacts.least, []
    for place, name in enumerate(table.names):
        hit = bool(contacts.hit[place])  # type: ignore[index]  # many flights have arrays
        contact = {
            "segment": int(contacts.segment[place]),  # type: ignore[index]
            "time_lower": float(contacts.time_lower[place]), "time_upper": float(contacts.time_upper[place]),
            "hyperboloid": names[int(contacts.index[place])], "center": contacts.center[place].tolist(),
        } if hit else None  # fmt: skip
        answers.append({
            "flight": name or None, "segments": max(len(table.paths[place]) - 1, 1), "hit": hit, "contact": contact,
            "least": {
                "distance_lower": float(least.distance_lower[place]),
                "distance_upper": float(least.distance_upper[place]),
                "segment": int(least.segment[place]), "time": float(least.time[place]),
                "hyperboloid": names[int(least.index[place])], "center": least.center[place].tolist(),
            },
        })  # fmt: skip
    return answers


def _in_words(answer: dict[str, Any]) -> str:
    contact, least = answer["contact"], answer["least"]
    begin = "" if answer["flight"] is None else f"flight {answer['flight']}: "
    where = f"({', '.join(f'{part:.6g}' for part in (contact or least)['center'])})"
    if contact is not None:
        return (
            f"{begin}contact on segment {contact['segment']} with {contact['hyperboloid']}, at time "
            f"{contact['time_lower']!r} … {contact['time_upper']!r} of it, the centre at {where}"
        )
    return (
        f"{begin}clear; the least distance {least['distance_lower']:.10g} … {least['distance_upper']:.10g} is on "
        f"segment {least['segment']}, from {least['hyperboloid']}, the centre at {where}"
    )


_SHOW_HELP = """Write a page that shows SCENE in three dimensions, and a flight through it.

SCENE is a file (docs/scenes.md) or a shipped scene, and --path a CSV file as of `hypcheck flight`, of one flight. The
page needs a browser and nothing else, no network either. It turns with the mouse, with fingers and with keys; a slider
moves the mover along the flight, and a curve below has the least distance.

\b
hypcheck show tower --out tower.html
hypcheck show forest.toml --path path.csv --out view.html
"""


@click.command(help=_SHOW_HELP, short_help="Write a page that shows a scene, and a flight through it, in 3-D.")
@click.argument("scene", metavar="SCENE", type=completing.SCENE)
@click.option("--path", metavar="FILE", help="A flight: a CSV file with the columns x, y, z, or - .")
@click.option("--out", required=True, type=OutputPath(), metavar="FILE", help="The page to write.")
def show(scene: str, path: str | None, out: Path) -> None:
    """Read, draw, and write."""
    from hypcheck.kernel.scene import Scene
    from hypcheck.tables.flight_table import read_flights
    from hypcheck.tables.streams import write_files

    world = Scene.from_toml(scene)
    if path is None:
        page = world.show()
    else:
        table = read_flights(path)
        if len(table.paths) > 1:
            raise InputError(f"{path} has {len(table.paths)} flights; a page shows one")
        heading = 0.0 if table.headings is None else table.headings
        page = world.show(table.paths[0], heading, axis=table.axes)
    write_files({str(out): page.html.encode()})
    click.echo(f"wrote {printable(str(out))}")
