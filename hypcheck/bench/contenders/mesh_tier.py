"""What is compared of collision engines: a mesh of 100 to 100,000 triangles built once a scene, or one for each row."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from hypcheck.bench.contenders.contender import Contender, of_method
from hypcheck.bench.contenders.ways import Empty, InPython, Prepared, each
from hypcheck.bench.rounds import clocked
from hypcheck.bench.workloads import scene_of
from hypcheck.methods.builtin import builtin_methods
from hypcheck.methods.domain import Domain
from hypcheck.methods.engines import COAL, FCL, PAIRINGS, Engine
from hypcheck.methods.formula import Sizes
from hypcheck.methods.method import Answers
from hypcheck.methods.scene_mesh import SceneMesh, built, height_of, scenes
from hypcheck.rows import CANNOT_SAY, Rows

TRIANGLES = (100, 1_000, 10_000, 100_000)
COAL_TRIANGLES = (10_000,)
MOST_SCENES = 8
"""Workloads of more pairs of bodies than this are not asked: a mesh that is built for one row is not built once."""

MOST_QUICK = 1_000
"""Larger meshes are left to full runs."""

ONCE, FOR_EACH = "build once", "build each"
_TITLES = {
    "point": "distance from the centre to the scaled mesh",
    "sphere": "unit sphere against the scaled mesh",
    "ellipsoid": "ellipsoid against the mesh",
}


@dataclass(frozen=True)
class InEngine:
    """One pairing with meshes of about so many triangles, each built once and kept."""

    engine: Engine
    pairing: str
    triangles: int
    meshes: dict[tuple[Sizes, float], SceneMesh] = field(default_factory=dict)
    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """Its answers, scene by scene; building is not avoided, but kept."""
        found = np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        for sizes, places in scenes(rows):
            found[places] = self.mesh(sizes, rows[places]).positions(rows[places])
        return found

    def mesh(self, sizes: Sizes, rows: Rows) -> SceneMesh:
        """The mesh of a scene."""
        key = sizes, height_of(sizes, rows)
        if key not in self.meshes:
            self.meshes[key] = built(self.engine, self.pairing, *key, self.triangles)
        return self.meshes[key]

    def batch(self, rows: Rows) -> Prepared:
        """Every row asked, the meshes being there."""
        work = partial(self._ready(rows), rows)
        return Prepared(len(rows), clocked(work), work)

    def single(self, rows: Rows) -> Prepared:
        """The same by a call a row."""
        return each(self._ready(rows), [rows[place : place + 1] for place in range(len(rows))])

    def _ready(self, rows: Rows) -> Callable[[Rows], Answers]:
        sizes = scene_of(rows)
        if sizes is not None:
            return self.mesh(sizes, rows).positions
        self.answer(rows)  # builds them
        return self.answer

    def build(self, rows: Rows) -> Prepared | None:
        """The mesh of a scene, from the vertices to the engine's tree; its answer is how many triangles it has."""
        sizes = scene_of(rows)
        if sizes is None:
            return None
        known = np.array([self.mesh(sizes, rows).triangles])
        make = partial(built, self.engine, self.pairing, sizes, height_of(sizes, rows), self.triangles)
        return Prepared(1, clocked(lambda: np.array([make().triangles])), lambda: known)

    def empty(self, rows: Rows, mode: str) -> Empty | None:
        """As of any Python function."""
        return None if mode == "build" else InPython(self.answer).empty(rows, mode)

    def close(self) -> None:
        """Let the meshes go."""
        self.meshes.clear()


def contenders() -> Iterable[Contender]:
    """Every pairing in every size."""
    for pairing in PAIRINGS:
        for triangles in TRIANGLES:
            yield _once(FCL, pairing, triangles)
    for pairing in PAIRINGS:
        for triangles in COAL_TRIANGLES:
            yield _once(COAL, pairing, triangles)
    methods = builtin_methods()
    for pairing in PAIRINGS:
        if f"fcl-{pairing}-mesh" in methods:
            found = of_method(methods[f"fcl-{pairing}-mesh"], "FCL", "mesh", judged=400, timed=8)
            note = "the mesh covers the body's surroundings alone, and is built anew for each row"
            yield replace(found, amortised=FOR_EACH, singles=8, needs=FCL.title, note=note, quick=False)


def _once(engine: Engine, pairing: str, triangles: int) -> Contender:
    return Contender(
        name=f"{engine.name}-{pairing}-{triangles}",
        title=f"{engine.title}: {_TITLES[pairing]} of the whole surface, about {triangles:,} triangles",
        tier="FCL",
        kind="mesh",
        precision="float64",
        question="position",
        domain=Domain(),
        load=partial(InEngine, engine, pairing, triangles),
        judged=3000 if triangles < 100_000 else 1200,
        timed=256,
        singles=32,
        amortised=ONCE,
        scenes=MOST_SCENES,
        needs=engine.title,
        note="the time of a row is without that of building",
        quick=triangles <= MOST_QUICK,
    )
