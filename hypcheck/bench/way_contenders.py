"""Contenders for ways: the exact decision, certified floats, sampling, conservative advancement, engines on meshes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial

from hypcheck.bench.contender import Contender, of_method
from hypcheck.bench.mesh_contenders import ONCE, InEngine
from hypcheck.geometry.rows import WAYS
from hypcheck.implementations.builtin import SAMPLES, passage_mesh_methods, passage_methods
from hypcheck.implementations.way_meshes import WAY_SOLVERS, height_of_ways, way_mesh
from hypcheck.kernel.choice import choice

CERTIFIED = "where its bound cannot tell, integers do"
_JUMPS = "it cannot see what lies between two of its times"
_BISECTED = "its distance is found by plain bisection, which nothing was done to make fast; a graze takes many steps"

JUDGED, QUICK_JUDGED = 200, 24
"""Ways of a workload that an engine is asked: where sizes differ, each takes a mesh."""

TIMED, SLOW, FEW = 8, ("passage-fcl-advancement", "passage-fcl-polynomial"), 3
"""Ways of a timed batch: few of the solvers that take twenty milliseconds for one."""


def way_contenders() -> Iterable[Contender]:
    """All of them, including the reference."""
    methods = passage_methods()
    yield of_method(methods["passage-exact"], "python", "exact", timed=16, singles=8)
    compiled = choice().kernel == "compiled"
    tier, timed, singles = ("C", 2048, 32) if compiled else ("numpy", 16, 1)
    yield of_method(methods["passage-certified"], tier, "certified", timed=timed, singles=singles, note=CERTIFIED)
    for count in SAMPLES:
        yield of_method(methods[f"passage-sampled-{count}"], tier, "sampling", timed=32_768 // count, note=_JUMPS)
    for name, kind in (("passage-advancement", "advancement"), ("passage-capsule", "bounding")):
        found = of_method(methods[name], "numpy", kind, judged=JUDGED, timed=8, singles=0, note=_BISECTED)
        yield replace(found, quick=False)
    yield from _in_engines()


def _in_engines() -> Iterable[Contender]:
    """Each solver with a mesh of the whole surface for each scene, which is built before its time is taken."""
    for name, solver in WAY_SOLVERS.items():
        timed = FEW if name in SLOW else TIMED
        found = of_method(passage_mesh_methods()[name], "FCL", "mesh", judged=JUDGED, timed=timed, singles=FEW)
        yield replace(
            found,
            load=partial(InEngine, partial(way_mesh, solver), height_of_ways, WAYS),
            amortised=ONCE,
            needs=solver.engine.title,
            note="the time of a way is without that of building its mesh",
            quick_judged=QUICK_JUDGED,
        )
