"""The files of a simulation: its JSON, and pictures drawn from it if matplotlib is installed."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError, UnavailableError, system_reason
from hypcheck.report.drawings import pictures
from hypcheck.tables.streams import remove_file, writing

PICTURES = {
    "forest": ("forest-walk", "forest-space"),
    "tower": ("tower-flights", "tower-table-5", "tower-pitch"),
}
"""The names of all pictures that a simulation may have, by its name."""


def make_ready(kind: str, directory: Path) -> None:
    """Make the folder. Raises InputError if a file of the simulation could not be written there.

    So no long run starts whose result would be lost.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"--out {directory}: files cannot be written to it: {reason}") from error
    for name in (_json(kind), *map(_svg, PICTURES[kind])):
        if (directory / name).is_dir():
            raise InputError(f"--out {directory}: {name} cannot be written: it is a folder")


def write_simulation(result: dict[str, Any], directory: Path) -> list[str]:
    """Write the files into a folder; returns a line for each, and one with the reason if there are no pictures.

    Pictures of an earlier run that are not drawn again are removed, since they show another run. Raises InputError if a
    file cannot be written; an earlier file then stays.
    """
    kind, notes = result["simulation"], []
    try:
        drawn: dict[str, bytes] = pictures().simulation_pictures(result)
    except UnavailableError as error:
        drawn = {}
        notes.append(f"no pictures: {error}")
    text = json.dumps(result, ensure_ascii=False) + "\n"
    files = {_json(kind): text.encode(), **{_svg(name): content for name, content in drawn.items()}}
    for name in PICTURES[kind]:
        if name not in drawn:
            remove_file(directory / _svg(name))
    return [_written(directory / name, content) for name, content in files.items()] + notes


def _json(kind: str) -> str:
    return f"simulate-{kind}.json"


def _svg(name: str) -> str:
    return f"{name}.svg"


def _written(path: Path, content: bytes) -> str:
    with writing(str(path), follow=False) as file:
        file.write(content)
    return f"wrote {path}"
