"""All contenders by name: those that contenders.toml lists, meshes of collision engines, implementations under test.

Methods in C are printed and compiled when bench starts. Meshes have 100 to 100,000 triangles, and are built once or for
each row; a tilted spheroid is the engine's ellipsoid, rotated to its axis, against the same mesh. Runs about tilted
spheroids and runs about sweeps have separate contenders.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import hypcheck
from hypcheck import toml
from hypcheck.bench import foreign
from hypcheck.bench.c_library import InC, place_of
from hypcheck.bench.contender import Contender, InEngine, InScalars, of_method
from hypcheck.bench.plan import PASSAGE, BenchPlan, chosen_names
from hypcheck.geometry.rows import SWEEPS
from hypcheck.implementations.builtin import methods
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.meshes import ENGINES, PAIRINGS, MeshLibrary, scene_mesh
from hypcheck.implementations.method import Method
from hypcheck.implementations.sweeps import SWEEP_SOLVERS, height_of_sweeps, sweep_mesh
from hypcheck.kernel.choice import choice

COMPILER = "C compiler"
"""The need of the methods in C."""

SINGLES = 4096
"""A branch predictor learns the branches of 64 rows, and the dual form's search then runs several times as fast."""

ELLIPSOID = "ellipsoid"
"""The one pairing that an axis can pose: a mesh scaled to a unit sphere is another one for each axis."""


def contenders(plan: BenchPlan) -> dict[str, Contender]:
    """The methods that this run compares, by name, the reference first. Raises InputError for unknown names."""
    by_name = {contender.name: _quick(contender) if plan.quick else contender for contender in _everything(plan)}
    others = {contender.name: contender for contender in foreign.foreign_contenders(plan.foreign, plan.limits)}
    names = chosen_names(list(by_name), plan.methods, "method")
    by_name |= others
    return {
        name: by_name[name]
        for name in dict.fromkeys((plan.reference, *names, *others))
        if by_name[name].needs not in plan.missing and (by_name[name].quick or not plan.quick or plan.methods)
    }


_SLOW = 1_000
"""A method that is judged on fewer rows is slow."""


def _quick(contender: Contender) -> Contender:
    """A slow method gets a quarter of its rows in a quick run: a root by mpmath takes milliseconds."""
    if contender.quick_judged is not None:
        return replace(contender, judged=contender.quick_judged)
    return (
        contender
        if contender.judged is None or contender.judged >= _SLOW
        else replace(contender, judged=contender.judged // 4)
    )


def _everything(plan: BenchPlan) -> Iterable[Contender]:
    """Every method, chosen or not."""
    if plan.question == PASSAGE:
        yield from _listed("passage", plan)
    elif plan.tilted:
        yield from _listed("tilted", plan)
        yield from _built_once(ELLIPSOID)
    else:
        yield from _listed("position", plan)
        yield from _built_once(*PAIRINGS)
        yield from _listed("naive", plan)


def _listing() -> Mapping[str, Any]:
    return toml.shipped("hypcheck.bench", "contenders.toml")


def _listed(subject: str, plan: BenchPlan) -> Iterable[Contender]:
    """The contenders that are listed for a subject, those that run here."""
    in_use = choice()
    for entry in _listing()["contenders"][subject]:
        fields = dict(entry)
        names, call = fields.pop("methods"), fields.pop("call", "rows")
        if fields.pop("kernel", in_use.kernel) != in_use.kernel or (call == "mesh" and plan.tilted):
            continue  # engines have no sweeps of tilted spheroids
        if fields["tier"] == "kernel":
            fields["tier"] = "C" if in_use.kernel == "compiled" else "numpy"
        note = _listing()["notes"][fields.pop("note")] if "note" in fields else ""
        of = fields.pop("of", None)
        for name in names:
            method = methods().get(of or (name.removesuffix("-c") if call == "C" else name))
            if method is not None:  # for a long double that is no more than float64 there is none
                called = _CALLED[call](method, plan.compiled)
                yield of_method(method, name=name, note=note.format(level=in_use.level), **called, **fields)


def _by_numbers(_method: Method, _library: Path | None) -> dict[str, Any]:
    return {"load": _position}


def _position() -> InScalars:
    return InScalars(hypcheck.position)  # the kernel is chosen where it is loaded


def _in_c(method: Method, library: Path | None) -> dict[str, Any]:
    """By the library, which may not be compiled yet."""
    load = partial(InC, library or Path(), place_of(method.name))
    return {"load": load, "singles": SINGLES, "needs": COMPILER}


def _in_mesh(method: Method, _library: Path | None) -> dict[str, Any]:
    """By an engine with a mesh of the whole surface for each scene, built before the timing."""
    solver = SWEEP_SOLVERS[method.name]
    return {"load": partial(InEngine, partial(sweep_mesh, solver), height_of_sweeps, SWEEPS)}


_CALLED = {"rows": lambda _method, _library: {}, "numbers": _by_numbers, "C": _in_c, "mesh": _in_mesh}
"""How a method is called, by the key `call` of the listing: what a contender has for that."""

MOST_SCENES = 8
"""Workloads with more different sizes are not asked: a mesh for one row is not built once."""

MOST_QUICK = 1_000
"""Larger meshes belong to full runs."""

_TITLES = {
    "point": "distance from the centre to the scaled mesh",
    "sphere": "unit sphere against the scaled mesh",
    "ellipsoid": "ellipsoid against the mesh",
}


def _built_once(*pairings: str) -> Iterable[Contender]:
    """The engines with these pairings, with every number of triangles that is listed."""
    for engine in ENGINES.values():
        for pairing in pairings:
            for triangles in _listing()["triangles"][engine.name]:
                yield built_once(engine, pairing, triangles)


def built_once(engine: MeshLibrary, pairing: str, triangles: int) -> Contender:
    """A pairing with a mesh of about `triangles` triangles, built once for each of a few scenes."""
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
        amortised="build once",
        scenes=MOST_SCENES,
        needs=engine.title,
        note="the time of a row is without that of building",
        quick=triangles <= MOST_QUICK,
    )
