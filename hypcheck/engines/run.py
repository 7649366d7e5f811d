"""The record of engines: each asked about each family on each mesh; one file a engine, from which all else is made."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from functools import cache
from json import dumps
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
from msgspec import Struct

from hypcheck.engines.install import command
from hypcheck.engines.measure import Measured, measure
from hypcheck.engines.placing import FAMILIES, Placed, drawn, placed
from hypcheck.engines.scene import TRIANGLES, SurfaceMesh, distances, rows_near, surface_mesh, write_scene
from hypcheck.engines.table import Engine
from hypcheck.errors import InputError
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Limits, StartError
from hypcheck.messages import escaped
from hypcheck.version import VERSION

SCHEMA = "1.0.0"

EACH = 8
"""Clear rows and contacts of each decade of gaps."""

_LIMITS = Limits(startup_timeout=120.0, timeout=60.0, restarts=3)


class EngineRecord(Struct):
    """What one engine did: the record's file NAME.json. `skipped` are families that it cannot be asked, and why."""

    schema: str
    hypcheck: str
    machine: str
    name: str
    version: str
    measured: list[Measured]
    skipped: dict[str, str]


@cache
def _placed(family: str, each: int) -> Placed:
    return placed(FAMILIES[family], each)


@cache
def _mesh(family: str, each: int, triangles: int) -> tuple[SurfaceMesh, Floats, tuple[Rows, Floats]]:
    """A family's mesh, how far its rows are from it, and half as many rows beside the mesh."""
    mesh = surface_mesh(FAMILIES[family].sizes, triangles)
    spot, gap = drawn(FAMILIES[family], each // 2, seed=2)
    return mesh, distances(_placed(family, each).rows, mesh), rows_near(spot, gap, mesh)


def spec_of(words: Sequence[str]) -> str:
    """The SPEC of a command."""
    return f"command:{dumps(list(words))}"


def record_of(
    engine: Engine,
    cache_folder: Path,
    progress: Callable[[str], None] = lambda _: None,
    *,
    each: int = EACH,
    meshes: Sequence[int] = TRIANGLES,
    families: Sequence[str] = tuple(FAMILIES),
) -> EngineRecord:
    """Ask an installed engine everything. Raises InputError where it is not installed."""
    found = EngineRecord(SCHEMA, VERSION, _machine(), engine.name, engine.version, [], {})
    for name in families:
        if FAMILIES[name].leans and not engine.tilts:
            found.skipped[name] = "no spheroid leans"
            continue
        for triangles in meshes:
            progress(f"{engine.name}: {name}, about {triangles} triangles")
            try:
                found.measured.append(_asked(engine, cache_folder, name, each, triangles))
            except StartError as error:
                found.skipped[name] = escaped(str(error).rpartition("stderr: ")[2], 200)
                break
    return found


def _asked(engine: Engine, cache_folder: Path, name: str, each: int, triangles: int) -> Measured:
    mesh, apart, beside = _mesh(name, each, triangles)
    with TemporaryDirectory(prefix="hypcheck-engine-") as folder:
        scene = Path(folder, "scene")
        write_scene(scene, FAMILIES[name].sizes, mesh)
        words = command(engine, cache_folder, scene)
        with open_implementation(spec_of(words), _LIMITS) as asked:
            return measure(engine, words, asked, _placed(name, each), mesh, apart, beside)


def _machine() -> str:
    return f"{platform.system()} {platform.machine()}"


def write_record(folder: Path, record: EngineRecord) -> None:
    """Write NAME.json."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{record.name}.json").write_bytes(msgspec.json.format(msgspec.json.encode(record)) + b"\n")


def read_records(folder: Path) -> list[EngineRecord]:
    """The records in a folder. Raises InputError for a file that is none."""
    return [_read(path) for path in sorted(folder.glob("*.json")) if not path.name.endswith(".badge.json")]


def _read(path: Path) -> EngineRecord:
    try:
        return msgspec.json.decode(path.read_bytes(), type=EngineRecord)
    except msgspec.MsgspecError as error:
        raise InputError(f"{path} is no record of an engine: {error}") from None
