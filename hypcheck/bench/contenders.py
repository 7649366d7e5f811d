"""All contenders by name: numpy and Python, C, meshes of collision engines, and implementations under test.

Methods in C are printed and compiled when bench starts. Meshes have 100 to 100,000 triangles, and are built once or for
each row; a tilted spheroid is the engine's ellipsoid, rotated to its axis, against the same mesh. Runs about tilted
spheroids and runs about sweeps have separate contenders.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path

import hypcheck
from hypcheck.bench import foreign
from hypcheck.bench.c_library import InC, bodies
from hypcheck.bench.c_source import FAST
from hypcheck.bench.contender import Contender, InEngine, InScalars, of_method
from hypcheck.bench.plan import PASSAGE, TILTED_REFERENCE, BenchPlan, chosen_names
from hypcheck.geometry.rows import SWEEPS
from hypcheck.implementations import builtin
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.meshes import COAL, FCL, PAIRINGS, MeshLibrary, scene_mesh
from hypcheck.implementations.method import Method
from hypcheck.implementations.sweeps import SWEEP_SOLVERS, height_of_sweeps, sweep_mesh
from hypcheck.kernel.choice import choice

ALGEBRAIC = ("coefficients", "hessian", "shared", "local-maximum", "dual")
PRECISIONS = ("float32", "float64")

PAPER = "the paper's own formula: it answers whether the pair is exterior, no more"
THIRTEEN = "the way that the paper attributes to its [13]"
BISECTED = "its multiplier is found by plain bisection, which nothing was done to make fast"
CERTIFIED = "where its bound cannot tell, integers do"
_UNSAID = "what does not converge is not said"
_TELLS = "tells the distance too"
_OTHER_SHAPE = "another shape in the spheroid's place"
_QUICK_DIGITS = "-15"

Methods = dict[str, Method]


def numpy_contenders() -> Iterable[Contender]:
    """All of them, including the reference."""
    methods = builtin.builtin_methods()
    yield from _formulas(methods)
    yield from _fast(methods)
    yield from _roots(methods)
    yield from _exact(methods)
    yield from _shapes(methods)


def _formulas(methods: Methods) -> Iterable[Contender]:
    """Table 2 in every format, and the other formulas in two."""
    listed = [("table-2", name) for name in ("float16", *PRECISIONS, "longdouble") if f"table-2-{name}" in methods]
    for formula, format_name in [*listed, *((name, each) for name in ALGEBRAIC for each in PRECISIONS)]:
        paper = formula == "table-2"
        yield of_method(
            methods[f"{formula}-{format_name}"],
            "numpy",
            "paper" if paper else "algebraic",
            accuracy_only=format_name == "float16",
            note=PAPER if paper else BISECTED if formula == "dual" else "",
            timed=4096 if formula == "dual" else None,
            singles=8 if formula == "dual" else 32,
        )


def _fast(methods: Methods) -> Iterable[Contender]:
    """The numpy kernel, the compiled kernel if it runs here, and one call of hypcheck.position for each row."""
    yield of_method(methods["fast-numpy"], "numpy", "certified", timed=8192, note=CERTIFIED)
    if choice().kernel == "compiled":
        # Only a batch: one call at a time is position-python from Python, and fast-c from C.
        yield of_method(methods["fast"], "C", "certified", note=_as_installed(), singles=0)
    yield of_method(
        methods["fast"], "python", "certified", name="position-python", title="hypcheck.position, one call a row",
        load=_position, timed=1024, singles=1024, note=CERTIFIED,
    )  # fmt: skip


def _as_installed() -> str:
    return f"{CERTIFIED}; as installed, called from Python, on one thread, {choice().level}"


def _position() -> InScalars:
    return InScalars(hypcheck.position)  # the kernel is chosen where it is loaded


def _roots(methods: Methods) -> Iterable[Contender]:
    for precision in PRECISIONS:
        yield of_method(methods[f"trigonometric-{precision}"], "numpy", "roots", note=THIRTEEN)
    yield of_method(methods["numpy-roots"], "python", "roots", judged=2000, timed=96, note="one call a row")
    for name in (name for name in methods if name.startswith("mpmath-roots-")):
        quick = name.endswith(_QUICK_DIGITS)
        yield of_method(methods[name], "python", "roots", judged=240, timed=4, note=_UNSAID, quick=quick)


def _exact(methods: Methods) -> Iterable[Contender]:
    yield of_method(methods["exact-integers"], "python", "exact", judged=3000, timed=192)
    yield of_method(methods["exact-oracle"], "python", "exact", judged=3000, timed=192)
    yield of_method(methods["nearest-point"], "numpy", "exact", judged=3000, timed=512, singles=16, note=_TELLS)


def _shapes(methods: Methods) -> Iterable[Contender]:
    for name in ("bounding-sphere", "bounding-cylinder"):
        yield of_method(methods[name], "numpy", "bounding", note=_OTHER_SHAPE)


_KINDS = {
    "table-2": ("paper", PAPER),
    "trigonometric": ("roots", THIRTEEN),
    "fast": ("certified", CERTIFIED),
    "dual": ("algebraic", BISECTED),
}


COMPILER = "C compiler"
"""The need of the methods in C."""

SINGLES = 4096
"""A branch predictor learns the branches of 64 rows, and the dual form's search then runs several times as fast."""


def c_contenders(library: Path | None) -> Iterable[Contender]:
    """Each method of the library, which may not be compiled yet, named as in numpy with -c appended."""
    methods = builtin.builtin_methods()
    for place, body in enumerate(bodies(), start=1):
        if body.name in methods:  # a long double that is no more than float64 is left out
            kind, note = _KINDS.get(body.name.rpartition("-")[0] or body.name, ("algebraic", ""))
            method, load = methods[body.name], partial(InC, library or Path(), place)
            title = "the fast path, compiled with the others and called from C" if body is FAST else method.title
            yield of_method(
                method, "C", kind, name=f"{body.name}-c", title=title, load=load, singles=SINGLES, needs=COMPILER,
                note=note,
            )  # fmt: skip


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


def mesh_contenders() -> Iterable[Contender]:
    """The contenders for every pairing with every number of triangles."""
    for pairing in PAIRINGS:
        for triangles in TRIANGLES:
            yield built_once(FCL, pairing, triangles)
    for pairing in PAIRINGS:
        for triangles in COAL_TRIANGLES:
            yield built_once(COAL, pairing, triangles)
    methods = builtin.builtin_methods()
    for pairing in PAIRINGS:
        if f"fcl-{pairing}-mesh" in methods:
            yield of_method(
                methods[f"fcl-{pairing}-mesh"],
                "FCL",
                "mesh",
                judged=400,
                timed=8,
                singles=8,
                amortised=FOR_EACH,
                needs=FCL.title,
                note="the mesh covers the body's surroundings alone, and is built anew for each row",
                quick=False,
            )


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
        amortised=ONCE,
        scenes=MOST_SCENES,
        needs=engine.title,
        note="the time of a row is without that of building",
        quick=triangles <= MOST_QUICK,
    )


ELLIPSOID = "ellipsoid"
"""The one pairing that an axis can pose: a mesh scaled to a unit sphere is another one for each axis."""


def tilted_contenders() -> Iterable[Contender]:
    """All of them, including the reference."""
    methods, compiled = builtin.tilted_methods(), choice().kernel == "compiled"
    if compiled:
        yield of_method(methods["fast"], "C", "certified", note=_as_installed())
    yield of_method(methods["fast-numpy"], "numpy", "certified", note=CERTIFIED, timed=8192)
    yield of_method(methods["exact-oracle"], "python", "exact", judged=3000, timed=96)
    yield of_method(methods["nearest-point"], "python", "exact", judged=240, timed=16, note=_TELLS)
    note = "its multiplier is found by plain bisection"
    yield of_method(methods[TILTED_REFERENCE], "numpy", "algebraic", timed=4096, note=note)
    yield of_method(methods["roots"], "numpy", "roots", timed=4096)
    tier = "C" if compiled else "numpy"
    yield of_method(methods["upright"], tier, "bounding", note="wrong by its axis alone")
    yield of_method(methods["bounding-sphere"], "numpy", "bounding", note=_OTHER_SHAPE)
    for triangles in TRIANGLES:
        yield built_once(FCL, ELLIPSOID, triangles)
    for triangles in COAL_TRIANGLES:
        yield built_once(COAL, ELLIPSOID, triangles)


_JUMPS = "it cannot see what lies between two of its times"
_BISECTED = "its distance is found by plain bisection, which nothing was done to make fast; a graze takes many steps"

WAYS_JUDGED, WAYS_JUDGED_QUICK = 200, 24
"""Sweeps of a workload that an engine is asked: where sizes differ, each takes a mesh."""

WAYS_TIMED, SLOW_FOR_WAYS, FEW_WAYS = 8, ("passage-fcl-advancement", "passage-fcl-polynomial"), 3
"""Sweeps of a timed batch: few of the solvers that take twenty milliseconds for one."""


def sweep_contenders(*, tilted: bool) -> Iterable[Contender]:
    """All contenders for sweeps, including the reference; engines take only upright spheroids."""
    methods = builtin.passage_methods()
    yield of_method(methods["passage-exact"], "python", "exact", timed=16, singles=8)
    compiled = choice().kernel == "compiled"
    tier, timed, singles = ("C", 2048, 32) if compiled else ("numpy", 16, 1)
    yield of_method(methods["passage-certified"], tier, "certified", timed=timed, singles=singles, note=CERTIFIED)
    for count in builtin.SAMPLES:
        yield of_method(methods[f"passage-sampled-{count}"], tier, "sampling", timed=32_768 // count, note=_JUMPS)
    for name, kind in (("passage-advancement", "advancement"), ("passage-capsule", "bounding")):
        yield of_method(
            methods[name], "numpy", kind, judged=WAYS_JUDGED, timed=8, singles=0, note=_BISECTED, quick=False
        )
    if not tilted:
        yield from _in_engines()


def _in_engines() -> Iterable[Contender]:
    """Each solver of the engines with a mesh of the whole surface for each scene, built before the timing."""
    for name, solver in SWEEP_SOLVERS.items():
        yield of_method(
            builtin.passage_mesh_methods()[name],
            "FCL",
            "mesh",
            load=partial(InEngine, partial(sweep_mesh, solver), height_of_sweeps, SWEEPS),
            judged=WAYS_JUDGED,
            quick_judged=WAYS_JUDGED_QUICK,
            timed=FEW_WAYS if name in SLOW_FOR_WAYS else WAYS_TIMED,
            singles=FEW_WAYS,
            amortised=ONCE,
            needs=solver.engine.title,
            note="the time of a sweep is without that of building its mesh",
        )


_SLOW = 1_000
"""A method that is judged on fewer rows is slow."""


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
        yield from sweep_contenders(tilted=plan.tilted)
        return
    if plan.tilted:
        yield from tilted_contenders()
        return
    yield from numpy_contenders()
    yield from c_contenders(plan.compiled)
    yield from mesh_contenders()
