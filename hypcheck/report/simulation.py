"""The files of a simulation: its JSON, and pictures drawn from it alone where matplotlib is installed.

Files of `hypcheck simulate`: the JSON, and pictures drawn from it alone.

What a simulation came to, as files in a folder: its JSON, and its pictures where matplotlib is there.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError, UnavailableError, system_reason
from hypcheck.report.plots import forest_walk, tower
from hypcheck.report.plots.style import styled
from hypcheck.report.plots.svg import Plot, standalone
from hypcheck.tables.streams import writing

PICTURES: dict[str, tuple[Callable[[dict[str, Any]], Iterator[Plot]], tuple[str, ...]]] = {
    "forest": (forest_walk.plots, ("forest-walk", "forest-space")),
    "tower": (tower.plots, ("tower-flights", "tower-table-5", "tower-pitch")),
}
"""By the simulation's name what draws it, and the names of all pictures that it may draw."""


def make_ready(kind: str, directory: Path) -> None:
    """Make the folder, and raise InputError where a file of a simulation could not be written into it.

    So a long run is not begun whose result could not be kept.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"--out {directory}: nothing can be written into it: {reason}") from error
    for name in (_json(kind), *map(_svg, PICTURES[kind][1])):
        if (directory / name).is_dir():
            raise InputError(f"--out {directory}: {name} cannot be written: it is a folder")


def write_simulation(result: dict[str, Any], directory: Path) -> list[str]:
    """Write the files into a folder that was made ready; a line for each, and one that says why there are no pictures.

    Pictures of an earlier run that are not drawn again are removed: they would show another run. Raises InputError
    where a file cannot be written; what stood in its place then still does.
    """
    kind = result["simulation"]
    draw, names = PICTURES[kind]
    said = []
    try:
        with styled():
            pictures = {plot.name: standalone(plot) for plot in draw(result)}
    except UnavailableError as error:
        pictures = {}
        said.append(f"no pictures: {error}")
    text = json.dumps(result, ensure_ascii=False) + "\n"
    files = {_json(kind): text.encode(), **{_svg(name): content for name, content in pictures.items()}}
    for name in names:
        if name not in pictures:
            _remove(directory / _svg(name))
    return [_written(directory / name, content) for name, content in files.items()] + said


def _json(kind: str) -> str:
    return f"simulate-{kind}.json"


def _svg(name: str) -> str:
    return f"{name}.svg"


def _written(path: Path, content: bytes) -> str:
    with writing(str(path), follow=False) as file:
        file.write(content)
    return f"wrote {path}"


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot remove {path}: {system_reason(error)}") from error
