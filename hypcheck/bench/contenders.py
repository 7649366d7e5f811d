"""All contenders by name: those that contenders.toml lists, meshes of collision engines, implementations under test.

A contender is a method with the settings of its comparison. Methods in C are printed and compiled when bench starts.
Meshes have 100 to 100,000 triangles, and are built once or for each row; a tilted spheroid is the engine's ellipsoid,
rotated to its axis, against the same mesh. Runs about tilted spheroids and runs about sweeps have separate contenders.
The number of rows that a SPEC answers in reasonable time is measured when it is opened.
"""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hypcheck
from hypcheck import toml
from hypcheck.bench.c_library import InC, place_of
from hypcheck.bench.loaded import InEngine, InPython, InScalars, LoadedMethod, RunningForeign
from hypcheck.bench.plan import PASSAGE, BenchPlan, chosen_names
from hypcheck.bench.workloads import NEAR_SCENES, WORKLOADS, listed
from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout, Rows
from hypcheck.implementations.builtin import builtin, methods
from hypcheck.implementations.description import QUESTIONS, Description
from hypcheck.implementations.domain import Domain, claimed
from hypcheck.implementations.frames import LARGEST
from hypcheck.implementations.implementation import Implementation, open_implementation
from hypcheck.implementations.meshes import ENGINES, PAIRINGS, MeshLibrary, scene_mesh
from hypcheck.implementations.method import Method, MethodClaims
from hypcheck.implementations.session import Limits, Outcome, StartError
from hypcheck.implementations.spec import parse_spec
from hypcheck.implementations.sweeps import SWEEP_SOLVERS, height_of_sweeps, sweep_mesh
from hypcheck.kernel.choice import choice


@dataclass(frozen=True, kw_only=True)
class Contender(MethodClaims):
    """A method, with the settings of its comparison.

    `tier` is its language or engine: "C", "numpy", "python", "FCL" or "foreign"; `kind` is its kind of algorithm. At
    most `judged` rows of a workload are judged; in a quick run `quick_judged`, or a quarter if `judged` is small.
    `timed` rows make a timed batch. Its first `singles` rows are also timed one by one; they are enough that a branch
    predictor does not learn them. `amortised` says whether a mesh is built once for a scene or for each row. `load`
    loads the method. `scenes`, if not None, is the largest number of different sizes in a workload that it can take.
    `quick` says whether it is fast enough for a quick run; a quick run includes slower methods only if they are named.
    """

    tier: str
    kind: str
    load: Callable[[], LoadedMethod]
    judged: int | None = None
    timed: int | None = None
    singles: int = 32
    amortised: str | None = None
    accuracy_only: bool = False
    note: str = ""
    scenes: int | None = None
    quick: bool = True
    quick_judged: int | None = None

    def asked(self, rows: Rows) -> NDArray[np.intp]:
        """Return the indices of the rows that it must answer: inside its domain, with numbers of its format."""
        if self.scenes is not None and len(np.unique(rows[:, :4], axis=0)) > self.scenes:
            return np.empty(0, dtype=np.intp)
        return claimed(rows, self.domain, self.precision, layout=QUESTIONS[self.question].layout)[: self.judged]


def of_method(method: Method, tier: str, kind: str, **fields: Any) -> Contender:  # noqa: ANN401 - of a contender
    """Return a built-in method as a contender; `fields` replace the method's values and the defaults."""
    claims: dict[str, Any] = {claim.name: getattr(method, claim.name) for claim in dataclasses.fields(MethodClaims)}
    return Contender(
        tier=tier, kind=kind, **{"load": partial(InPython, method.answer, method.scene), **claims, **fields}
    )


COMPILER = "C compiler"
"""What the methods in C need, as reports name it."""

SINGLES = 4096
"""How many rows are timed one by one: a branch predictor would learn 64 rows, on which the dual form's search then runs
several times as fast."""

ELLIPSOID = "ellipsoid"
"""The only pairing for tilted spheroids: a mesh scaled for a unit sphere would be another one for each axis."""


def contenders(plan: BenchPlan) -> dict[str, Contender]:
    """Return the methods that this run compares, by name, the reference first. Raises InputError for unknown names."""
    by_name = {contender.name: _quick(contender) if plan.quick else contender for contender in _everything(plan)}
    others = {contender.name: contender for contender in foreign_contenders(plan.foreign, plan.limits)}
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
    """Return a slow method gets a quarter of its rows in a quick run: a root by mpmath takes milliseconds."""
    if contender.quick_judged is not None:
        return replace(contender, judged=contender.quick_judged)
    return (
        contender
        if contender.judged is None or contender.judged >= _SLOW
        else replace(contender, judged=contender.judged // 4)
    )


def _everything(plan: BenchPlan) -> Iterable[Contender]:
    """Yield every method, chosen or not."""
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
    """Return the tables of contenders.toml."""
    return toml.shipped("hypcheck.bench", "contenders.toml")


def _listed(subject: str, plan: BenchPlan) -> Iterable[Contender]:
    """Yield the contenders that are listed for a subject, those that run here."""
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
    """Return the fields of a contender that is called with seven numbers."""
    return {"load": _position}


def _position() -> InScalars:
    """Return hypcheck.position as a loaded method."""
    return InScalars(hypcheck.position)  # the kernel is chosen where it is loaded


def _in_c(method: Method, library: Path | None) -> dict[str, Any]:
    """Return the fields of a contender in C; its library may not be compiled yet."""
    load = partial(InC, library or Path(), place_of(method.name))
    return {"load": load, "singles": SINGLES, "needs": COMPILER}


def _in_mesh(method: Method, _library: Path | None) -> dict[str, Any]:
    """Return the fields of a contender by an engine, with one mesh for each scene, built before the timing."""
    solver = SWEEP_SOLVERS[method.name]
    return {"load": partial(InEngine, partial(sweep_mesh, solver), height_of_sweeps, SWEEPS)}


_CALLED = {"rows": lambda _method, _library: {}, "numbers": _by_numbers, "C": _in_c, "mesh": _in_mesh}
"""Functions to the fields of a contender, by the key `call` of the listing, which says how a method is called."""

MOST_SCENES = 8
"""Contenders with a mesh for each scene get no workload with more different sizes: a mesh would serve few rows."""

MOST_QUICK = 1_000
"""Larger meshes belong to full runs."""

_TITLES = {
    "point": "distance from the centre to the scaled mesh",
    "sphere": "unit sphere against the scaled mesh",
    "ellipsoid": "ellipsoid against the mesh",
}


def _built_once(*pairings: str) -> Iterable[Contender]:
    """Yield the engines with these pairings, with every number of triangles that is listed."""
    for engine in ENGINES.values():
        for pairing in pairings:
            for triangles in _listing()["triangles"][engine.name]:
                yield built_once(engine, pairing, triangles)


def built_once(engine: MeshLibrary, pairing: str, triangles: int) -> Contender:
    """Return a pairing with a mesh of about `triangles` triangles, built once for each of a few scenes."""
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


SPEC_SINGLES = {"library": 256, "python": 64, "command": 16}
"""How many rows are sent one by one, by the kind of SPEC. The worker repeats them in order, and there are enough that a
branch predictor does not learn them; a command gets one question for each."""

_TRIED = 64
_TRIES, _TRYING_S = 5, 0.2
"""A batch is timed so often, unless that takes longer, and the fastest time counts: after one interruption the method
would get few rows."""
_JUDGED_S, _TIMED_S = 4.0, 0.01
"""Seconds for judging one workload, and for a timed batch."""


@dataclass(frozen=True)
class ForeignMethod:
    """A SPEC that was started, its description, and the number of rows that it can answer in reasonable time."""

    spec: str
    name: str
    description: Description
    judged: int
    timed: int


def foreign_method(
    spec: str, limits: Limits, taken: Sequence[str], *, tilted: bool = False, layout: Layout = PAIRS
) -> ForeignMethod:
    """Return the method of a SPEC. Raises StartError if it cannot be started, and InputError if it is not a SPEC.

    It also raises InputError if the run is about tilted spheroids and the description does not take tilt, or if its
    question has rows of another layout.
    """
    with open_implementation(spec, limits) as implementation:
        description = implementation.description
        if tilted and not description.tilt:
            raise InputError(f'{spec} answers rows of seven numbers alone: its description has no "tilt": true')
        if description.asked.layout != layout:
            other = "without" if layout.has_end else "with"
            raise InputError(
                f"{spec} answers the question {description.question}; it is measured {other} --question passage"
            )
        took = _seconds_a_row(implementation)
    name = description.name if description.name not in taken else f"{description.name} ({spec})"
    return ForeignMethod(
        spec, name, description, max(200, int(_JUDGED_S / took)), min(LARGEST, max(1, int(_TIMED_S / took)))
    )


def _seconds_a_row(implementation: Implementation) -> float:
    """Return the seconds per row of a batch; batches grow until one takes long enough to measure."""
    layout = implementation.description.asked.layout
    some = (listed(PASSAGE)["tower"] if layout.has_end else WORKLOADS["uniform"]).rows(1, _TRIED)
    inside = some[implementation.description.domain.holds(some, layout=layout)]
    usual = [*NEAR_SCENES[0], 1.0, 0.5, 2.0, 1.0, 0.5, -2.0][: len(layout.upright)]
    some = inside if len(inside) else np.array([usual])
    first = implementation.classify(some[:1])
    if Outcome.TIMEOUT in first.outcomes:  # each larger batch would time out again
        raise StartError(f"{implementation.spec} does not answer its first question, about one row: {first.reasons[0]}")
    implementation.classify(some)  # a warm-up
    while True:
        took = _fastest(implementation, some)
        if took > _TIMED_S or len(some) * 8 > LARGEST:
            return max(took / len(some), 1e-9)
        some = np.repeat(some, 8, axis=0)


def _fastest(implementation: Implementation, rows: Rows) -> float:
    """Return the least time in seconds of several tries on these rows."""
    tries = [_seconds(implementation, rows)]
    while len(tries) < _TRIES and sum(tries) < _TRYING_S:
        tries.append(_seconds(implementation, rows))
    return min(tries)


def _seconds(implementation: Implementation, rows: Rows) -> float:
    """Return the seconds that an implementation takes for these rows."""
    started = time.perf_counter()
    implementation.classify(rows)
    return time.perf_counter() - started


def foreign_contenders(methods: Iterable[ForeignMethod], limits: Limits) -> Iterable[Contender]:
    """Yield a contender for each SPEC; a built-in method runs in this process."""
    for method in methods:
        description = method.description
        kind, words = parse_spec(method.spec).kind, parse_spec(method.spec).words
        if kind == "builtin":
            own = builtin(words[0])
            yield of_method(own, "numpy", "algebraic", judged=own.max_rows, timed=min(8192, method.timed))
            continue
        yield Contender(
            name=method.name,
            title=" ".join(filter(None, (description.name, description.version, description.language))),
            tier="foreign",
            kind="foreign",
            precision=description.precision,
            question=description.question,
            domain=description.domain,
            load=partial(_opened, method.spec, limits),
            exact=description.precision == "exact",
            judged=method.judged,
            timed=method.timed,
            singles=SPEC_SINGLES[kind],
            note=f"as {method.spec}",
        )


def _opened(spec: str, limits: Limits) -> RunningForeign:
    """Start an implementation. Raises InputError and StartError."""
    return RunningForeign(open_implementation(spec, limits), parse_spec(spec).kind)
