"""The record of engines: each asked about each family on each mesh; one file an engine, from which all else is made.

An engine that offers settings is asked twice: at its default settings, and at the tightest that it offers.

It says what an engine got wrong, by how much, and what its mesh explains of it. Lengths are millimetres at the tower
of 2 m. An answer is *wrong* if it is not that of the surface; its error is the row's certified distance from contact
(placing.py). It is the engine's *own* error if it is not that of its own mesh either, decided exactly (scene.py),
whether or not the surface happens to agree; its size is then the distance of the body from that mesh, at least. An
engine that is given a hull may answer for any body between the spheroid and the ball that the hull holds for certain:
what lies between is explained by the hull.
"""

from __future__ import annotations

import platform
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from json import dumps
from math import floor, log10, nan
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import msgspec
import numpy as np
from msgspec import Struct

from hypcheck.engines.engine import ENGINES, Engine, command
from hypcheck.engines.placing import FAMILIES, Placed, drawn, placed
from hypcheck.engines.scene import HULL, TRIANGLES, SurfaceMesh, distances, rows_near, surface_mesh, write_scene
from hypcheck.errors import InputError
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.implementations.implementation import Implementation, open_implementation
from hypcheck.implementations.session import Answered, Limits, Outcome, StartError, TimingError
from hypcheck.messages import escaped
from hypcheck.version import VERSION

SCHEMA = "2.0.0"

EACH = 8
"""Clear rows and contacts of each decade of gaps."""

_LIMITS = Limits(startup_timeout=120.0, timeout=60.0, restarts=3)


TIMED_ROWS = 64

_PATIENCE_S = 300.0

NO_DISTANCE = 1e300
"""What some engines report as large as a float can be is no distance."""


class Decade(Struct):
    """Rows whose distance from contact is from `least_mm` to ten times that: asked, and answered wrongly."""

    least_mm: float
    clear: int
    false_contacts: int
    contacts: int
    false_clears: int


class Reported(Struct):
    """Distances that the engine reported for so many `rows`, `missing` ones not; errors against the exact ones.

    Of a ball the mesh's own distance is known: `own_worst_mm` is the worst error against that one. `contradicted`
    counts the rows of which the engine says contact, but reports a distance above 0; the one farthest above is
    `contradicted_row`.
    """

    rows: int
    missing: int
    median_mm: float | None
    worst_mm: float | None
    worst_row: list[float] | None
    own_worst_mm: float | None
    contradicted: int = 0
    contradicted_row: list[float] | None = None


class Measured(Struct):
    """An engine, a family, a mesh. `mesh_wrong` and `mesh_worst_mm` are those of exact answers about that very mesh."""

    family: str
    triangles: int
    deviation_mm: float
    rows: int
    false_clears: int
    false_contacts: int
    worst_mm: float
    worst_row: list[float] | None
    mesh_wrong: int
    mesh_worst_mm: float
    own_rows: int
    own: int
    own_worst_mm: float
    own_worst_row: list[float] | None
    faults: dict[str, int]
    decades: list[Decade]
    distance: Reported
    penetration: Reported
    microseconds: float | None


@dataclass(frozen=True, slots=True)
class Own:
    """Where an engine's answers differ from those of its own mesh: a mask, and by how many spheroid radii at least."""

    wrong: Mask
    radii: Floats


def own_errors(contacts: Mask, distances: Floats, *, hull: bool) -> Own:
    """The own errors of an engine that said contact (or not), at these distances from its mesh in spheroid radii."""
    false_contact = contacts & (distances > 1.0)
    inner = HULL if hull else 1.0
    missed = ~contacts & (distances < inner)
    size = np.where(false_contact, distances - 1.0, np.where(missed, inner - distances, 0.0))
    return Own(np.asarray(false_contact | missed), np.asarray(size))


def measure(
    engine: Engine,
    words: Sequence[str],
    implementation: Implementation,
    placed: Placed,
    mesh: SurfaceMesh,
    distances: Floats,
    beside: tuple[Rows, Floats],
) -> Measured:
    """Ask an engine's adapter, started with `words` and opened, about placed rows; `distances` are those of the mesh.

    `beside` are rows near contact with the mesh itself, and their distances from it: they are asked for own errors
    alone.
    """
    family = placed.family
    answered = implementation.classify(placed.rows)
    known, contacts = answered.answered, answered.answers == 1
    wrong = known & (contacts != placed.contact)
    meshed = (distances <= 1.0) != placed.contact
    error = np.abs(placed.gap) * family.millimetres
    others = implementation.classify(beside[0])
    worst = int(np.where(wrong, error, -1.0).argmax())
    reported = reported_distances(words, placed.rows)
    return Measured(
        family=family.name,
        triangles=len(mesh.triangles),
        deviation_mm=mesh.deviation * family.millimetres,
        rows=len(placed.rows),
        false_clears=int((wrong & placed.contact).sum()),
        false_contacts=int((wrong & ~placed.contact).sum()),
        worst_mm=float(error[wrong].max(initial=0.0)),
        worst_row=placed.rows[worst].tolist() if wrong.any() else None,
        mesh_wrong=int(meshed.sum()),
        mesh_worst_mm=float(error[meshed].max(initial=0.0)),
        **_own(engine, placed, distances, beside, answered, others),
        faults={
            outcome.label: answered.count(outcome) + others.count(outcome)
            for outcome in Outcome
            if outcome and answered.count(outcome) + others.count(outcome)
        },
        decades=_decades(placed, error, wrong),
        distance=_reported(reported, placed, distances, ~placed.contact, contacts),
        penetration=_reported(reported, placed, distances, placed.contact, contacts),
        microseconds=_microseconds(implementation, placed.rows),
    )


def _own(
    engine: Engine,
    placed: Placed,
    distances: Floats,
    beside: tuple[Rows, Floats],
    answered: Answered,
    others: Answered,
) -> dict[str, Any]:
    """The engine's own errors, as Measured has them: those of the placed rows, and of the rows beside the mesh."""
    family, rows = placed.family, np.concatenate([placed.rows, beside[0]])
    errors = own_errors(
        np.concatenate([answered.answers == 1, others.answers == 1]),
        np.concatenate([distances, beside[1]]),
        hull=hulled(engine, placed),
    )
    wrong = errors.wrong & np.concatenate([answered.answered, others.answered])
    millimetres = errors.radii * min(family.sizes[2:]) * family.millimetres
    furthest = int(np.where(wrong, millimetres, -1.0).argmax())
    return {
        "own_rows": len(wrong),
        "own": int(wrong.sum()),
        "own_worst_mm": float(millimetres[wrong].max(initial=0.0)),
        "own_worst_row": rows[furthest].tolist() if wrong.any() else None,
    }


def hulled(engine: Engine, placed: Placed) -> bool:
    """Whether the engine replaces these spheroids by a convex hull."""
    return engine.body == "hull" and placed.family.b != placed.family.d


def _decades(placed: Placed, error: Floats, wrong: Mask) -> list[Decade]:
    power = np.array([floor(log10(length)) for length in error])
    decades = []
    for exponent in sorted(set(power.tolist()), reverse=True):
        clear, contact = (power == exponent) & ~placed.contact, (power == exponent) & placed.contact
        counts = (int(mask.sum()) for mask in (clear, clear & wrong, contact, contact & wrong))
        decades.append(Decade(10.0**exponent, *counts))
    return decades


def reported_distances(words: Sequence[str], rows: Rows, patience_s: float = _PATIENCE_S) -> Floats:
    """The signed distances (n,) that an adapter reports, NaN where it reports none, or ended or hung before it did."""
    lines = "".join(" ".join(map(repr, row)) + "\n" for row in rows.tolist())
    question = f"distance 1 {len(rows)} tilted-text\n{lines}"
    try:
        done = subprocess.run(  # noqa: S603 - an adapter of ours
            words, input=question, capture_output=True, text=True, check=False, timeout=patience_s
        )
    except subprocess.TimeoutExpired:
        return np.full(len(rows), nan)
    replies = done.stdout.splitlines()[2:]  # after its description, and the reply's own line
    numbers = [float(line) for line in replies[: len(rows)]]
    return np.array(numbers + [nan] * (len(rows) - len(numbers)))


def _reported(reported: Floats, placed: Placed, distances: Floats, which: Mask, contacts: Mask) -> Reported:
    """Errors of the distances of these rows; a distance of the wrong sign counts as it is. `said`: contact or not."""
    family = placed.family
    there = which & (np.abs(reported) < NO_DISTANCE)  # false for NaN
    if not there.any():
        return Reported(0, int(which.sum()), None, None, None, None)
    errors = np.abs(reported - placed.gap)[there] * family.millimetres
    own = None
    if family.b == family.d:
        exact = (distances - 1.0) * family.sizes[2]
        own = float((np.abs(reported - exact)[there] * family.millimetres).max())
    missing, worst = int(which.sum() - there.sum()), placed.rows[there][int(errors.argmax())].tolist()
    above = np.where(there & contacts, reported, 0.0)
    against = placed.rows[int(above.argmax())].tolist() if (above > 0).any() else None
    counts = (int((above > 0).sum()), against)
    return Reported(int(there.sum()), missing, float(np.median(errors)), float(errors.max()), worst, own, *counts)


def _microseconds(implementation: Implementation, rows: Rows) -> float | None:
    """Microseconds for a row, by the adapter's own clock: the least of three tries; None where it cannot be timed."""
    some = rows[:: max(1, len(rows) // TIMED_ROWS)]
    try:
        tries = [implementation.time(some, 1) for _ in range(3)]
    except TimingError:
        return None
    return min(time for time in tries if time is not None) / len(some) / 1000.0


class EngineRecord(Struct):
    """What one engine did: the record's file NAME.json. `skipped` are families that it cannot be asked, and why.

    `tightest` is empty where the engine offers no settings: then `default` is all that it can do.
    """

    schema: str
    hypcheck: str
    machine: str
    name: str
    version: str
    default: list[Measured]
    tightest: list[Measured]
    skipped: dict[str, str]

    @property
    def best(self) -> list[Measured]:
        """What it did at the setting that it is judged by: the tightest that it offers."""
        return self.tightest if self.tightest and ENGINES[self.name].tightens else self.default


@cache
def _placed(family: str, count: int) -> Placed:
    return placed(FAMILIES[family], count)


@cache
def _mesh(family: str, count: int, triangles: int) -> tuple[SurfaceMesh, Floats, tuple[Rows, Floats]]:
    """A family's mesh, how far its rows are from it, and half as many rows beside the mesh."""
    mesh = surface_mesh(FAMILIES[family].sizes, triangles)
    spot, gap = drawn(FAMILIES[family], count // 2, seed=2)
    return mesh, distances(_placed(family, count).rows, mesh), rows_near(spot, gap, mesh)


def spec_of(words: Sequence[str]) -> str:
    """The SPEC of a command."""
    return f"command:{dumps(list(words))}"


def record_of(
    engine: Engine,
    cache_folder: Path,
    progress: Callable[[str], None] = lambda _: None,
    *,
    count: int = EACH,
    meshes: Sequence[int] = TRIANGLES,
    families: Sequence[str] = tuple(FAMILIES),
) -> EngineRecord:
    """Ask an installed engine everything. Raises InputError where it is not installed."""
    machine = f"{platform.system()} {platform.machine()}"
    record = EngineRecord(SCHEMA, VERSION, machine, engine.name, engine.version, [], [], {})
    for tightest in (False, True) if engine.adjustable else (False,):
        _ask_all(engine, cache_folder, record, progress, count, meshes, families, tightest=tightest)
    return record


def _ask_all(
    engine: Engine,
    cache_folder: Path,
    record: EngineRecord,
    progress: Callable[[str], None],
    count: int,
    meshes: Sequence[int],
    families: Sequence[str],
    *,
    tightest: bool,
) -> None:
    """Ask an engine about all families on all meshes at one of its settings, and add it to the record."""
    measurements, setting = (record.tightest, engine.tightest) if tightest else (record.default, engine.default)
    for name in families:
        if FAMILIES[name].leans and not engine.tilts:
            record.skipped[name] = "no spheroid leans"
            continue
        for triangles in meshes:
            progress(f"{engine.name}, {setting.words}: {name}, about {triangles} triangles")
            try:
                measurements.append(_asked(engine, cache_folder, name, count, triangles, tightest=tightest))
            except StartError as error:
                record.skipped[name] = escaped(str(error).rpartition("stderr: ")[2], 200)
                break


def _asked(engine: Engine, cache_folder: Path, name: str, count: int, triangles: int, *, tightest: bool) -> Measured:
    mesh, apart, beside = _mesh(name, count, triangles)
    with TemporaryDirectory(prefix="hypcheck-engine-") as folder:
        scene = Path(folder, "scene")
        write_scene(scene, FAMILIES[name].sizes, mesh)
        words = command(engine, cache_folder, scene, tightest=tightest)
        with open_implementation(spec_of(words), _LIMITS) as implementation:
            return measure(engine, words, implementation, _placed(name, count), mesh, apart, beside)


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
        raise InputError(f"{path} is not a record of an engine: {error}") from None
