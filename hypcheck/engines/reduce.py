"""Find an engine's findings from its record: the worst rows, each reduced to one triangle with short numbers.

An error of a whole mesh is searched in ever smaller halves of the triangles near the body: the engine's adapter is
asked about a scene of only these triangles. The triangle that remains is moved so that the spheroid is about the
origin, and its corners are rounded to as few binary digits as keep half of the error.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import floor, isfinite, log2, nan
from pathlib import Path
from tempfile import TemporaryDirectory

import msgspec
import numpy as np

from hypcheck.engines.engine import ENGINES, Engine, command
from hypcheck.engines.findings import KINDS, Finding, proved
from hypcheck.engines.measure import NO_DISTANCE, EngineRecord, Measured
from hypcheck.engines.placing import FAMILIES
from hypcheck.engines.scene import TRIANGLES, SurfaceMesh, seen_from, surface_mesh, to_triangles, write_scene
from hypcheck.geometry.rows import Floats

MOST_TRIED = 3
"""The number of rows tried for each kind of error."""

_NEAREST = 16
_BITS = 44


@dataclass(frozen=True, slots=True)
class Said:
    """The answer of an engine: contact or not, and the signed distance that it reports, NaN if it reports none."""

    contact: bool
    reported: float


@dataclass(frozen=True, slots=True)
class Asker:
    """A function that asks an engine about an upright spheroid about the origin, of semi-axes b and d, and triangles.

    `cache` is the folder in which engines are installed. With `tightest` the engine is asked at the tightest settings
    that it offers, else at its default ones. `answer` is a function that answers in place of the engine's adapter; with
    None the adapter is asked.
    """

    engine: Engine
    cache: Path
    b: float
    d: float
    tightest: bool = True
    answer: Callable[[Asker, Floats], Said | None] | None = None

    def __call__(self, corners: Floats) -> Said | None:
        """Ask about triangles (m, 3, 3); the result is None if the adapter ends without an answer."""
        if self.answer is not None:
            return self.answer(self, corners)
        row = f"1 1 {self.b!r} {self.d!r} 0 0 0 0 0 1\n"
        mesh = SurfaceMesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3), 0.0)
        with TemporaryDirectory(prefix="hypcheck-engine-") as folder:
            write_scene(Path(folder), (1.0, 1.0, self.b, self.d), mesh)
            words = command(self.engine, self.cache, Path(folder), tightest=self.tightest)
            question = f"classify 1 1 tilted-text\n{row}distance 2 1 tilted-text\n{row}"
            done = subprocess.run(  # noqa: S603 - an adapter of ours
                words, input=question, capture_output=True, text=True, check=False, timeout=120
            )
        lines = done.stdout.split("\n")
        try:
            return Said(lines[2] == "1", float(lines[4]) if len(lines) > 4 else nan)
        except (IndexError, ValueError):
            return None

    @property
    def hull(self) -> bool:
        """Whether the engine replaces the spheroid by a hull within it. Then only some kinds of errors are proved."""
        return self.engine.body == "hull" and self.b != self.d

    def error(self, kind: str, reply: Said | None, corners: Floats) -> float:
        """Compute the error of this kind in a reply about one triangle (3, 3), in the unit of lengths; 0 for none."""
        if reply is None or (self.hull and kind in {"missed contact", "too far"}):
            return 0.0
        if kind == "missed contact":
            inside = 1 - float(np.linalg.norm(nearest_point(corners / [self.b, self.b, self.d])))
            return 0.0 if reply.contact else max(0.0, inside * min(self.b, self.d))
        way = best_direction(corners, self.b, self.d)
        least = float(lower_bounds(corners, self.b, self.d, way[np.newaxis])[0])
        if kind == "false contact":
            return max(0.0, least) if reply.contact else 0.0
        if not abs(reply.reported) < NO_DISTANCE:
            return 0.0
        if kind == "contradiction":
            return max(0.0, least) if reply.contact and reply.reported > 0 else 0.0
        return max(0.0, least - reply.reported if kind == "too near" else reply.reported - least if least > 0 else 0.0)


def findings_of(
    record: EngineRecord, cache: Path, answer: Callable[[Asker, Floats], Said | None] | None = None
) -> Iterator[Finding]:
    """Yield the worst finding of each kind that an engine's record leads to; one in metres precedes other units.

    The engine is asked at the setting by which it is judged. An error within the tolerance that the engine states there
    is not a finding. `answer` answers in place of the engine's adapter.
    """
    tolerance = ENGINES[record.name].judged.tolerance or 0.0
    for kind in KINDS:
        best: Finding | None = None
        for measured, row in _candidates(record, kind):
            reduced = _reduced(asker_of(ENGINES[record.name], cache, measured, answer), kind, measured, np.array(row))
            if reduced is None or reduced.error_mm <= tolerance * reduced.millimetres:
                continue
            if best is None or _weight(reduced) > _weight(best):
                best = reduced
        if best is not None:
            yield best


def _weight(finding: Finding) -> tuple[bool, float]:
    """Return a key that is greater for a worse finding: metres before other units, then the larger error."""
    return finding.millimetres == 1000.0, finding.error_mm


def _candidates(record: EngineRecord, kind: str) -> list[tuple[Measured, list[float]]]:
    """Select rows that may show this kind of error, upright and outside the tower: one a family, the worst first."""
    hull = ENGINES[record.name].body == "hull" and kind in {"missed contact", "too far"}
    worst: dict[str, tuple[float, Measured, list[float]]] = {}
    for measurement in record.best:
        family = FAMILIES[measurement.family]
        if family.leans or family.inside or (hull and family.b != family.d):
            continue
        for size, row in _shown(measurement, kind):
            if row is not None and (measurement.family not in worst or size > worst[measurement.family][0]):
                worst[measurement.family] = (size, measurement, row)
    worst_first = sorted(worst.values(), key=lambda one: (FAMILIES[one[1].family].unit != 1, -one[0]))
    return [(measured, row) for _, measured, row in worst_first[:MOST_TRIED]]


def _shown(measured: Measured, kind: str) -> list[tuple[float, list[float] | None]]:
    """Return the worst rows of one mesh for a kind of error, each after its size; a row is None if there is none.

    The size is the error in millimetres, or for a contradiction the number of rows that show it.
    """
    if kind in {"missed contact", "false contact"}:
        return [(measured.own_worst_mm, measured.own_worst_row)]
    if kind == "contradiction":
        return [(one.contradicted, one.contradicted_row) for one in (measured.distance, measured.penetration)]
    reported = [(one.worst_mm or 0.0, one.worst_row) for one in (measured.distance, measured.penetration)]
    return [(size, row) for size, row in reported if size > 1.5 * measured.deviation_mm]


def asker_of(
    engine: Engine, cache: Path, measured: Measured, answer: Callable[[Asker, Floats], Said | None] | None
) -> Asker:
    """Return the function that asks the engine about the spheroid of a measured family."""
    b, d = FAMILIES[measured.family].sizes[2:]
    return Asker(engine, cache, b, d, tightest=engine.tightens, answer=answer)


def _reduced(asker: Asker, kind: str, measured: Measured, row: Floats) -> Finding | None:
    """Reduce a row to a finding about one triangle; None if no triangle shows the error or it cannot be proved."""
    family, engine = FAMILIES[measured.family], asker.engine
    corners = _alone(asker, kind, _near(measured, row))
    if corners is None:
        return None
    error = asker.error(kind, asker(corners[np.newaxis]), corners)
    if not error > 0:
        return None
    small = _rounded(asker, kind, corners, error)
    reply, other = asker(small[np.newaxis]), replace(asker, tightest=not engine.tightens)(small[np.newaxis])
    if reply is None:
        return None
    finding = _certified(asker, kind, small, reply, family.millimetres)
    if finding is None or not engine.adjustable:
        return finding
    words = "nothing" if other is None else _words(kind, other, 0.0, family.millimetres)[0]
    return msgspec.structs.replace(finding, at_other=words)


def _near(measured: Measured, row: Floats) -> Floats:
    """Return the triangles (m, 3, 3) that a row's spheroid touches, or that are nearest to it, the nearest first.

    Corners are relative to the spheroid's centre.
    """
    sizes = FAMILIES[measured.family].sizes
    mesh = next(
        surface
        for surface in (surface_mesh(sizes, n) for n in TRIANGLES)
        if len(surface.triangles) == measured.triangles
    )
    squares = to_triangles(seen_from(row, mesh.vertices)[mesh.triangles])
    order = np.argsort(squares)
    count = max(_NEAREST, int((squares <= 1.0).sum()))
    return np.asarray((mesh.vertices - row[4:7])[mesh.triangles[order[:count]]])


def _alone(asker: Asker, kind: str, corners: Floats) -> Floats | None:
    """Find one of the triangles that may show the error alone; None if the search by halves ends without one."""
    if kind in {"missed contact", "too far"} or asker.error(kind, asker(corners[:1]), corners[0]) > 0:
        return np.asarray(corners[0])
    while len(corners) > 1:
        halves = [corners[: len(corners) // 2], corners[len(corners) // 2 :]]
        replies = [asker(half) for half in halves]
        marks = [_mark(kind, reply) for reply in replies]
        if max(marks) == -np.inf:
            return None
        corners = halves[int(np.argmax(marks))]
    return np.asarray(corners[0])


def _mark(kind: str, reply: Said | None) -> float:
    """Rate how much an answer about many triangles looks like this error; −inf if it does not."""
    if reply is None:
        return -np.inf
    if kind == "false contact":
        return float(reply.contact) if reply.contact else -np.inf
    if kind == "contradiction":
        return reply.reported if reply.contact and reply.reported > 0 else -np.inf
    return -reply.reported if isfinite(reply.reported) else -np.inf


def _rounded(asker: Asker, kind: str, corners: Floats, error: float) -> Floats:
    """Round the corners to as few binary digits as keep half of the error; without such a number they are unchanged."""
    least = min(asker.b, asker.d)
    exponent = floor(log2(least))
    for bits in range(max(2, floor(log2(least / error)) - 1), _BITS, 3):
        unit = 2.0 ** (exponent - bits)
        tried = np.round(corners / unit) * unit
        if asker.error(kind, asker(tried[np.newaxis]), tried) >= error / 2:
            return np.asarray(tried)
    return corners


def _certified(asker: Asker, kind: str, corners: Floats, reply: Said, millimetres: float) -> Finding | None:
    """Make the finding, with its certificate in few digits; None if rational arithmetic does not prove it."""
    error = asker.error(kind, reply, corners)
    way = best_direction(corners, asker.b, asker.d)
    shares = nearest_shares(
        corners / [asker.b, asker.b, asker.d] if kind == "missed contact" else corners - _foot(asker, way)
    )
    scale = millimetres
    reported = reply.reported if kind in {"too near", "too far"} else None
    words = _words(kind, reply, error, scale)
    for digits in range(2, 17):
        unit = 2.0 ** (3 * digits)
        parts = np.round(shares * unit) / unit
        parts[int(parts.argmax())] = 1.0 - (parts.sum() - parts.max())
        finding = Finding(
            asker.engine.name, asker.engine.version, kind, asker.b, asker.d, corners.tolist(), reported,
            [round(part, digits) for part in way.tolist()], parts.tolist(), error * scale, scale, *words, "", "",
        )  # fmt: skip
        if proved(finding):
            return finding
    return None


def _foot(asker: Asker, way: Floats) -> Floats:
    """Return the spheroid's farthest point in a direction n, S n/h(n) in the notation of findings.py."""
    pushed = way * [asker.b**2, asker.b**2, asker.d**2]
    return np.asarray(pushed / np.sqrt(way @ pushed))


def _words(kind: str, reply: Said, error: float, scale: float) -> tuple[str, str]:
    """Return an answer in words, and what is proved of it in words; lengths times `scale` are millimetres."""
    if kind == "missed contact":
        return (
            "contact" if reply.contact else "clear",
            f"in contact: {error * scale:.2g} mm less in radius still touches",
        )
    if kind in {"false contact", "contradiction"}:
        word = "contact" if reply.contact else "clear"
        contradicts = kind == "contradiction" or (reply.contact and 0 < reply.reported < NO_DISTANCE)
        words = f"{word}, and {_length(reply.reported * scale)}" if contradicts else word
        return words, f"clear by {error * scale:.2g} mm"
    reported, exact = reply.reported * scale, (reply.reported + (error if kind == "too near" else -error)) * scale
    return _length(reported), f"{_length(exact)} at {'least' if exact > 0 and kind == 'too near' else 'most'}"


def _length(millimetres: float) -> str:
    """Return a signed distance in words."""
    if not abs(millimetres) < NO_DISTANCE:
        return "no distance"
    return f"{millimetres:.3g} mm apart" if millimetres > 0 else f"{-millimetres:.3g} mm deep"


def lower_bounds(corners: Floats, b: float, d: float, direction: Floats) -> Floats:
    """Compute s(n), the lower bound of the signed distance of findings.py, for directions (m, 3), in floats."""
    half = np.sqrt((direction * direction * [b * b, b * b, d * d]).sum(axis=-1))
    return np.asarray(((corners @ direction.T).min(axis=0) - half) / np.linalg.norm(direction, axis=-1))


def best_direction(corners: Floats, b: float, d: float) -> Floats:
    """Find a direction n with nearly the greatest s(n), which is the signed distance: draw many, refine the best."""
    rng = np.random.default_rng(1)
    scale = np.array([b, b, d])
    ways = rng.normal(size=(2000, 3))
    near = nearest_point(corners / scale)
    if near @ near > 0:
        ways[0] = near / scale
    best, spread = ways[np.argmax(lower_bounds(corners, b, d, ways))], 0.5
    best = best / np.linalg.norm(best)
    while spread > 1e-12:
        tries = best + spread * rng.normal(size=(200, 3))
        tries = np.vstack([best, tries / np.linalg.norm(tries, axis=1, keepdims=True)])
        best, spread = tries[np.argmax(lower_bounds(corners, b, d, tries))], spread * 0.7
    return np.asarray(best)


def nearest_point(corners: Floats) -> Floats:
    """Return the point of a triangle nearest to the origin."""
    return np.asarray(nearest_shares(corners) @ corners)


def nearest_shares(corners: Floats) -> Floats:
    """Return the shares of the corners in the point of a triangle nearest to the origin."""
    edges = corners[1:] - corners[0]
    gram = edges @ edges.T
    if np.linalg.det(gram) > 0:
        s, t = np.linalg.solve(gram, -edges @ corners[0])
        if s >= 0 and t >= 0 and s + t <= 1:
            return np.array([1 - s - t, s, t])
    candidates = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        edge = corners[j] - corners[i]
        share = float(np.clip(-(corners[i] @ edge) / (edge @ edge), 0.0, 1.0)) if edge @ edge > 0 else 0.0
        shares = np.zeros(3)
        shares[i], shares[j] = 1 - share, share
        candidates.append(shares)
    return np.asarray(min(candidates, key=lambda candidate: float(np.linalg.norm(candidate @ corners))))
