"""The built-in methods by name: each formula in each precision, the fast path, roots, exact methods, other shapes, FCL.

A built-in method has the same interface as all implementations, but runs in hypcheck's own process.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Axis, Pair, Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations import alternatives, ways
from hypcheck.implementations.alternatives import dual_positions
from hypcheck.implementations.description import EVERYWHERE, Description, Domain
from hypcheck.implementations.frames import LARGEST, GivenAnswers
from hypcheck.implementations.meshes import ellipsoid_mesh, point_mesh, sphere_mesh
from hypcheck.implementations.method import Answers, Method, by_rows
from hypcheck.implementations.way_meshes import WAY_SOLVERS, WaySolver, hits_and_times
from hypcheck.kernel import integers, numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.classify import kernel
from hypcheck.messages import suggestion
from hypcheck.truth import exact
from hypcheck.truth.mesh import availability as fcl_trouble
from hypcheck.version import VERSION

DIGITS = (15, 30, 50, 100)
"""Decimal digits with which mpmath computes roots."""

SLOW_ROWS = 24
"""A method that takes milliseconds for a row is asked so many rows of a family."""

LONG_DOUBLE = {2.0**-63: "x87", 2.0**-112: "binary128"}.get(float(np.finfo(np.longdouble).eps))
"""The precision of numpy's long double on this machine; None if it is float64, or two of them."""


def measured_methods() -> list[Method]:
    """All methods for bench; none loads mpmath or FCL before it is asked."""
    return [*_other_precisions(), *_root_methods(), *_exact_methods(), *_bounding_methods()]


def _other_precisions() -> list[Method]:
    formats = {"float16": "float16", **({"longdouble": LONG_DOUBLE} if LONG_DOUBLE else {})}
    listed = FORMULAS["table-2"]
    return [
        Method(
            f"{listed.name}-{format_name}",
            f"{listed.title}, {format_name}",
            listed.question,
            precision,
            by_rows(listed, format_name),
            Domain(regimes=listed.regimes),
            measured=True,
        )
        for format_name, precision in formats.items()
    ]


def _root_methods() -> list[Method]:
    trigonometric = [
        Method(
            f"trigonometric-{precision}",
            f"the roots of g by the trigonometric form, {precision}",
            "position",
            precision,
            alternatives.trigonometric_roots(precision),
            Domain(),
            measured=True,
        )
        for precision in ("float32", "float64")
    ]
    general = Method(
        "numpy-roots",
        "the roots of g by numpy.roots, float64",
        "position",
        "float64",
        alternatives.numpy_roots,
        Domain(),
        max_rows=400,
        measured=True,
    )
    many_digits = [
        Method(
            f"mpmath-roots-{digits}",
            f"the roots of g by mpmath.polyroots at {digits} digits",
            "position",
            "float64",
            partial(alternatives.mpmath_roots, digits=digits),
            Domain(),
            max_rows=SLOW_ROWS,
            measured=True,
        )
        for digits in DIGITS
    ]
    return [*trigonometric, general, *many_digits]


def _exact_methods() -> list[Method]:
    named = (
        ("exact-integers", "the coefficient rule in integers, the fast path's last stage", _integers),
        ("exact-oracle", "the exact oracle: the sign of g at its local maximum, in integers", _oracle),
        ("nearest-point", "the nearest point, in double-double and then in exact enclosures", _nearest),
    )
    return [
        Method(name, title, "position", "float64", answer, EVERYWHERE, exact=True, max_rows=400, measured=True)
        for name, title, answer in named
    ]


def _bounding_methods() -> list[Method]:
    named = (
        ("bounding-sphere", "the circumscribed sphere in the spheroid's place, exact", alternatives.bounding_sphere),
        (
            "bounding-cylinder",
            "the circumscribed cylinder in the spheroid's place, float64",
            alternatives.bounding_cylinder,
        ),
    )
    return [
        Method(name, title, "position", "float64", answer, Domain(), measured=True) for name, title, answer in named
    ]


def _integers(rows: Rows) -> Answers:
    return np.array([integers.position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _oracle(rows: Rows) -> Answers:
    return np.array([exact.position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _nearest(rows: Rows) -> Answers:
    from hypcheck.truth.nearest import positions  # noqa: PLC0415 - loads mpmath

    return positions(np.ascontiguousarray(rows)).position


SAMPLES = (4, 16, 64, 256)
"""Positions of a way at which a sampling method looks."""

WAY_ROWS = 200
"""A method that takes a millisecond for a way is asked so many of a family."""


@cache
def passage_methods() -> dict[str, Method]:
    """Every built-in method that answers the question passage, by its name."""
    looks = [(count, partial(ways.sampled, count=count)) for count in SAMPLES]
    sampling = [
        _passage_method(f"passage-sampled-{count}", f"exact positions at {count} times", look) for count, look in looks
    ]
    hits = Method(
        "passage-certified",
        "steps in certified floats, exact where they come to nothing",
        "passage",
        "float64",
        ways.certified,
        EVERYWHERE,
        exact=True,
        measured=True,
    )
    methods = [
        _passage_method("passage-exact", "roots and steps in integers", ways.exact, exact=True, max_rows=WAY_ROWS),
        hits,
        *sampling,
        _passage_method("passage-advancement", "conservative advancement by the centre's distance", ways.advanced),
        _passage_method("passage-capsule", "a swept ball in the spheroid's place, advanced alike", ways.capsule),
    ]
    return {method.name: method for method in methods}


def _passage_method(
    name: str,
    title: str,
    timed: Callable[[Rows], tuple[Answers, Floats]],
    *,
    exact: bool = False,
    max_rows: int | None = None,
) -> Method:
    domain = EVERYWHERE if exact else Domain()
    return Method(
        name,
        title,
        "passage",
        "float64",
        lambda rows: timed(rows)[0],
        domain,
        exact=exact,
        max_rows=max_rows,
        measured=True,
        timed=timed,
    )


@cache
def passage_mesh_methods() -> dict[str, Method]:
    """Every built-in method that asks a collision engine about ways, by its name, whether the engine is here or not."""
    return {name: _way_mesh_method(solver) for name, solver in WAY_SOLVERS.items()}


def _way_mesh_method(solver: WaySolver) -> Method:
    def timed(rows: Rows) -> tuple[Answers, Floats]:
        return hits_and_times(solver, rows)

    found = _passage_method(solver.name, solver.title, timed, max_rows=FCL_ROWS)
    return found if solver.times else replace(found, timed=None)


def _passage_mesh_method(name: str) -> Method | None:
    """The method of that name, if there is one. Raises InputError where its engine is missing."""
    if name not in WAY_SOLVERS:
        return None
    trouble = WAY_SOLVERS[name].engine.trouble()
    if trouble is not None:
        raise InputError(f"the built-in method {name!r} cannot be used: {trouble}")
    return passage_mesh_methods()[name]


PRECISIONS = ("float32", "float64")

FCL_ROWS = 12
"""Plain FCL is asked so many rows of a family: it builds a mesh for each, which takes milliseconds."""

NAIVE_FCL = (
    ("fcl-ellipsoid-mesh", "FCL's ellipsoid against a plain mesh of 2,000 triangles", ellipsoid_mesh),
    ("fcl-sphere-mesh", "FCL's unit sphere against a scaled plain mesh of 2,000 triangles", sphere_mesh),
    ("fcl-point-mesh", "FCL's distance from the centre to a scaled plain mesh of 2,000 triangles", point_mesh),
)


def _formula_method(formula: Formula, precision: str) -> Method:
    return Method(
        name=f"{formula.name}-{precision}",
        title=f"{formula.title}, {precision}",
        question=formula.question,
        precision=precision,
        answer=partial(dual_positions, precision=precision) if formula.name == "dual" else by_rows(formula, precision),
        domain=Domain(regimes=formula.regimes),
    )


def _fcl_method(name: str, title: str, answer: Callable[[Rows], Answers]) -> Method:
    return Method(name, title, "position", "float64", answer, Domain(), max_rows=FCL_ROWS)


def fast_positions(rows: Rows) -> Answers:
    """Positions (n,) of rows (n, 7) or (n, 10) by the kernel in use, on one thread."""
    return kernel().answer_rows(np.ascontiguousarray(rows), "position", 1)[0]


def fast_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis | None = None) -> Answers:
    """Positions of one spheroid's centres (n,) by the kernel in use, on one thread; without an axis it is upright."""
    return kernel().answer_scene(sizes, (x, y, z), "position", 1, axis)[0]


def _fast_method(name: str, where: str, answer: Callable[[Rows], Answers]) -> Method:
    title = f"the fast path, {where}: certified floats, integers where they cannot tell"
    return Method(name, title, "position", "float64", answer, EVERYWHERE, exact=True)


@cache
def methods_without_meshes() -> dict[str, Method]:
    """Every built-in method that needs no FCL, by its name."""
    in_use = "the kernel in use" if choice().kernel == "compiled" else "the kernel in use, which is numpy"
    fast = (
        _fast_method("fast", in_use, fast_positions),
        _fast_method("fast-numpy", "in numpy", numpy_kernel.positions),
    )
    formulas = [formula for formula in FORMULAS.values() if formula.classifies_pairs or formula.name == "dual"]
    ours = (_formula_method(formula, precision) for precision in PRECISIONS for formula in formulas)
    methods = [*fast, *ours, *measured_methods()]
    return {method.name: method for method in methods}


@cache
def builtin_methods() -> dict[str, Method]:
    """Every built-in method that answers about positions by its name, as `builtin:NAME` has it."""
    naive = [_fcl_method(*each) for each in NAIVE_FCL] if fcl_trouble() is None else []
    return methods_without_meshes() | {method.name: method for method in naive}


def builtin(name: str) -> Method:
    """The built-in method of that name; raises InputError naming those that exist, or what it needs and lacks."""
    method = methods_without_meshes().get(name) or passage_methods().get(name) or _passage_mesh_method(name)
    method = method or builtin_methods().get(name)  # FCL is loaded only on request
    if method is None:
        known = [*builtin_methods(), *passage_methods(), *WAY_SOLVERS]
        raise InputError(f"there is no built-in method {name!r}; {suggestion(name, known)}")
    return method


class BuiltinSession:
    """A session of a built-in method. Raises InputError if there is none of that name."""

    max_batch = LARGEST
    scene = False
    evidence = ""
    stderr: tuple[str, ...] = ()

    def __init__(self, name: str) -> None:
        self.method = builtin(name)
        self.max_rows = self.method.max_rows
        self.description = Description(
            name=self.method.name,
            version=VERSION,
            language="python",
            precision=self.method.precision,
            question=self.method.question,
            domain=self.method.domain,
            binary=True,
            time=True,
            times=self.method.timed is not None,
        )

    def classify(self, rows: Rows, *, by_scene: bool = False) -> GivenAnswers:  # noqa: ARG002 - it has no entry for scenes
        """The method's answers."""
        if self.method.timed is not None:
            return GivenAnswers(*self.method.timed(rows))
        return GivenAnswers(self.method.answer(rows))

    def time(
        self,
        rows: Rows,
        repeat: int,
        *,
        by_scene: bool = False,  # noqa: ARG002
        each: bool = False,
    ) -> tuple[int, int]:
        """Nanoseconds for `repeat` times the rows, and the sum of the answers; `each` makes a call for each row."""
        parts = [rows[place : place + 1] for place in range(len(rows))] if each else [rows]
        answers: list[NDArray[np.int8]] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            answers = [self.method.answer(part) for part in parts]
        return time.perf_counter_ns() - start, sum(int(each.sum(dtype=np.int64)) for each in answers)

    def close(self) -> None:
        """Do nothing: there is no process."""

    def kill(self) -> None:
        """Do nothing: there is no process."""
