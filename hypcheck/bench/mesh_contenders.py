"""Contenders that ask a collision engine about a mesh: of 100 to 100,000 triangles, built once or for each row.

A spheroid that leans is asked as the engine's ellipsoid, posed by its axis, against the same mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Protocol

import numpy as np

from hypcheck.bench.contender import Contender, EmptyCall, InPython, PreparedWork, of_method, one_by_one
from hypcheck.bench.timing import clocked
from hypcheck.bench.workloads import scene_of
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, Layout, Rows
from hypcheck.implementations.builtin import builtin_methods
from hypcheck.implementations.description import Domain
from hypcheck.implementations.meshes import COAL, FCL, PAIRINGS, MeshLibrary, height_of, rows_by_sizes, scene_mesh
from hypcheck.implementations.method import Answers

TRIANGLES = (100, 1_000, 10_000, 100_000)
COAL_TRIANGLES = (10_000,)
MOST_SCENES = 8
"""Workloads with more different sizes are not asked: a mesh for one row is not built once."""

MOST_QUICK = 1_000
"""Larger meshes belong to full runs."""

ONCE, FOR_EACH = "build once", "build each"
_TITLES = {
    "point": "distance from the centre to the scaled mesh",
    "sphere": "unit sphere against the scaled mesh",
    "ellipsoid": "ellipsoid against the mesh",
}


class BuiltMesh(Protocol):
    """A scene's mesh in an engine."""

    @property
    def triangles(self) -> int:
        """How many it has."""
        ...

    def answers(self, rows: Rows) -> Answers:
        """The answers to rows that have its sizes."""
        ...


@dataclass(frozen=True)
class InEngine:
    """An engine with meshes, each built once and kept: `make` from sizes and height, which `high` finds for rows."""

    make: Callable[[Sizes, float], BuiltMesh]
    high: Callable[[Sizes, Rows], float] = height_of
    layout: Layout = PAIRS
    meshes: dict[tuple[Sizes, float], BuiltMesh] = field(default_factory=dict)
    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """Its answers, scene by scene; missing meshes are built and kept."""
        found = np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        for sizes, places in rows_by_sizes(rows):
            found[places] = self.mesh(sizes, rows[places]).answers(rows[places])
        return found

    def mesh(self, sizes: Sizes, rows: Rows) -> BuiltMesh:
        """The mesh of a scene."""
        key = sizes, self.high(sizes, rows)
        if key not in self.meshes:
            self.meshes[key] = self.make(*key)
        return self.meshes[key]

    def batch(self, rows: Rows) -> PreparedWork:
        """Every row, with meshes that exist."""
        work = partial(self._ready(rows), rows)
        return PreparedWork(len(rows), clocked(work), work)

    def single(self, rows: Rows) -> PreparedWork:
        """The same by a call for each row."""
        return one_by_one(self._ready(rows), [rows[place : place + 1] for place in range(len(rows))])

    def _ready(self, rows: Rows) -> Callable[[Rows], Answers]:
        sizes = scene_of(rows, self.layout)
        if sizes is not None:
            return self.mesh(sizes, rows).answers
        self.answer(rows)  # builds them
        return self.answer

    def build(self, rows: Rows) -> PreparedWork | None:
        """The mesh of a scene, from the vertices to the engine's tree; its answer is the number of its triangles."""
        sizes = scene_of(rows, self.layout)
        if sizes is None:
            return None
        known = np.array([self.mesh(sizes, rows).triangles])
        make = partial(self.make, sizes, self.high(sizes, rows))
        return PreparedWork(1, clocked(lambda: np.array([make().triangles])), lambda: known)

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """The empty call of a Python function."""
        return None if mode == "build" else InPython(self.answer).empty(rows, mode)

    def close(self) -> None:
        """Release the meshes."""
        self.meshes.clear()


def mesh_contenders() -> Iterable[Contender]:
    """Every pairing with every number of triangles."""
    for pairing in PAIRINGS:
        for triangles in TRIANGLES:
            yield built_once(FCL, pairing, triangles)
    for pairing in PAIRINGS:
        for triangles in COAL_TRIANGLES:
            yield built_once(COAL, pairing, triangles)
    methods = builtin_methods()
    for pairing in PAIRINGS:
        if f"fcl-{pairing}-mesh" in methods:
            found = of_method(methods[f"fcl-{pairing}-mesh"], "FCL", "mesh", judged=400, timed=8)
            note = "the mesh covers the body's surroundings alone, and is built anew for each row"
            yield replace(found, amortised=FOR_EACH, singles=8, needs=FCL.title, note=note, quick=False)


def built_once(engine: MeshLibrary, pairing: str, triangles: int) -> Contender:
    """A pairing with one mesh of about so many triangles for a scene, or for each of a few scenes."""
    return Contender(
        name=f"{engine.name}-{pairing}-{triangles}",
        title=f"{engine.title}: {_TITLES[pairing]} of the whole surface, about {triangles:,} triangles",
        tier="FCL",
        kind="mesh",
        precision="float64",
        question="position",
        domain=Domain(),
        load=partial(InEngine, partial(scene_mesh, engine, pairing, triangles=triangles)),
        judged=3000 if triangles < 100_000 else 1200,
        timed=256,
        singles=32,
        amortised=ONCE,
        scenes=MOST_SCENES,
        needs=engine.title,
        note="the time of a row is without that of building",
        quick=triangles <= MOST_QUICK,
    )
