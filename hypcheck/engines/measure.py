"""The record of engines. Each engine is asked about each family on each mesh, and its record is one file.

The page and everything else about engines is made from these files. An engine that offers settings is asked twice: at
its default settings, and at the tightest that it offers.

The record says what an engine got wrong, by how much, and which part of it the mesh explains. Lengths are millimetres
at the tower of 2 m. An answer is *wrong* if it differs from that of the surface; its error is the row's certified
distance from contact (placing.py). It is the engine's *own* error if it differs from that of its own mesh, decided
exactly (scene.py), even if it agrees with the surface by chance; its size is then at least the distance of the body
from contact with that mesh. An engine that is given a hull may answer for any body between the spheroid and the scaled
spheroid that the hull contains for certain; differences between these two are explained by the hull.
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
"""The number of clear rows, and of contacts, in each decade of gaps."""

_LIMITS = Limits(startup_timeout=120.0, timeout=60.0, restarts=3)


TIMED_ROWS = 64

_PATIENCE_S = 300.0

NO_DISTANCE = 1e300
"""A reported number of this size or larger is no distance: some engines report the largest float if they have none."""


class Decade(Struct):
    """Counts of rows whose distance from contact is from `least_mm` to ten times that.

    `clear` rows were asked, `false_contacts` of them answered wrongly; `contacts` were asked, `false_clears` of them
    answered wrongly.
    """

    least_mm: float
    clear: int
    false_contacts: int
    contacts: int
    false_clears: int


class Reported(Struct):
    """The errors of the distances that an engine reported for `rows` rows; for `missing` rows it reported none.

    The errors are differences from the exact distances. For a ball the distance from the mesh is known too:
    `own_worst_mm` is the worst difference from that. `contradicted` counts the rows for which the engine says contact
    but reports a distance above 0; `contradicted_row` is the one with the largest such distance.
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
    """The measurement of one engine for one family on one mesh.

    `mesh_wrong` and `mesh_worst_mm` count and measure the answers that an exact decision about that mesh would get
    wrong.
    """

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
    """A mask of the answers that differ from those of the engine's own mesh, and the least errors in spheroid radii."""

    wrong: Mask
    radii: Floats


def own_errors(contacts: Mask, distances: Floats, *, hull: bool) -> Own:
    """Compute the own errors of an engine that answered contact (or not) for bodies at these distances from its mesh.

    Distances are those of the centres, in spheroid radii. With `hull` the engine has a convex hull of the spheroid.
    """
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
    """Ask an engine's adapter about placed rows, and return the measurement.

    `words` start the adapter, and `implementation` is the opened adapter. `distances` are those of the rows from the
    mesh. `beside` are rows near contact with the mesh itself, with their distances from it; they only serve to find own
    errors.
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
    """Return the fields of Measured about own errors, of the placed rows and of the rows beside the mesh together."""
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
    """Decide whether the engine replaces these spheroids by a convex hull."""
    return engine.body == "hull" and placed.family.b != placed.family.d


def _decades(placed: Placed, error: Floats, wrong: Mask) -> list[Decade]:
    """Count rows by the decade of their distance from contact, `error`, the farthest decade first."""
    power = np.array([floor(log10(length)) for length in error])
    decades = []
    for exponent in sorted(set(power.tolist()), reverse=True):
        clear, contact = (power == exponent) & ~placed.contact, (power == exponent) & placed.contact
        counts = (int(mask.sum()) for mask in (clear, clear & wrong, contact, contact & wrong))
        decades.append(Decade(10.0**exponent, *counts))
    return decades


def reported_distances(words: Sequence[str], rows: Rows, patience_s: float = _PATIENCE_S) -> Floats:
    """Ask an adapter for the signed distances (n,) of rows.

    A distance is NaN if the adapter reports none for the row, or ended or took longer than `patience_s` before.
    """
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
    """Summarise the errors of the reported distances of the rows in the mask `which`.

    A distance of the wrong sign is compared as it is. `distances` are those from the mesh, and `contacts` is the mask
    of the rows for which the engine said contact.
    """
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
    """Measure the microseconds for a row by the adapter's own clock: the least of three tries.

    The result is None if the adapter cannot be timed.
    """
    some = rows[:: max(1, len(rows) // TIMED_ROWS)]
    try:
        tries = [implementation.time(some, 1) for _ in range(3)]
    except TimingError:
        return None
    return min(time for time in tries if time is not None) / len(some) / 1000.0


class EngineRecord(Struct):
    """The record of one engine, the content of the file NAME.json.

    `default` and `tightest` are the measurements at these settings; `tightest` is empty if the engine offers no
    settings. `skipped` has the families about which the engine cannot be asked, each with the reason.
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
        """The measurements at the setting by which the engine is judged: the tightest, or the default without one."""
        return self.tightest if self.tightest and ENGINES[self.name].tightens else self.default


@cache
def _placed(family: str, count: int) -> Placed:
    return placed(FAMILIES[family], count)


@cache
def _mesh(family: str, count: int, triangles: int) -> tuple[SurfaceMesh, Floats, tuple[Rows, Floats]]:
    """Return a family's mesh, the distances of its rows from it, and half as many rows near contact with the mesh."""
    mesh = surface_mesh(FAMILIES[family].sizes, triangles)
    spot, gap = drawn(FAMILIES[family], count // 2, seed=2)
    return mesh, distances(_placed(family, count).rows, mesh), rows_near(spot, gap, mesh)


def spec_of(words: Sequence[str]) -> str:
    """Return the SPEC of a command line."""
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
    """Ask an installed engine about these families on these meshes, and return its record.

    `progress` gets a line for each measurement. Raises InputError if the engine is not installed.
    """
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
    """Ask an engine about one family on one mesh at one of its settings."""
    mesh, apart, beside = _mesh(name, count, triangles)
    with TemporaryDirectory(prefix="hypcheck-engine-") as folder:
        scene = Path(folder, "scene")
        write_scene(scene, FAMILIES[name].sizes, mesh)
        words = command(engine, cache_folder, scene, tightest=tightest)
        with open_implementation(spec_of(words), _LIMITS) as implementation:
            return measure(engine, words, implementation, _placed(name, count), mesh, apart, beside)


def write_record(folder: Path, record: EngineRecord) -> None:
    """Write the record of an engine to NAME.json in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{record.name}.json").write_bytes(msgspec.json.format(msgspec.json.encode(record)) + b"\n")


def read_records(folder: Path) -> list[EngineRecord]:
    """Read the records of engines in a folder. Raises InputError for a file that is not one."""
    return [_read(path) for path in sorted(folder.glob("*.json")) if not path.name.endswith(".badge.json")]


def _read(path: Path) -> EngineRecord:
    try:
        return msgspec.json.decode(path.read_bytes(), type=EngineRecord)
    except msgspec.MsgspecError as error:
        raise InputError(f"{path} is not a record of an engine: {error}") from None
