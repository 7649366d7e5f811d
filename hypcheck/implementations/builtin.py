"""The built-in methods by name: each formula in each precision, the fast path, roots, exact methods, other shapes, FCL.

This is the one registry of what answers rows in hypcheck's own process: `verify` and `bench` ask the same methods. A
built-in method has the same interface as all implementations.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Axis, Pair, Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations import alternatives, sweeps
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import EVERYWHERE, ORDINARY, Domain
from hypcheck.implementations.frames import LARGEST, GivenAnswers
from hypcheck.implementations.meshes import ENGINES, FCL, naive_fcl
from hypcheck.implementations.method import Answers, Method, by_rows, by_scene, on_rows, on_scene
from hypcheck.implementations.sweeps import SWEEP_SOLVERS, hits_and_times
from hypcheck.kernel import integers, numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.kernel.in_use import kernel
from hypcheck.messages import suggestion
from hypcheck.truth import exact, nearest_rows
from hypcheck.truth.nearest import nearest
from hypcheck.version import VERSION

DIGITS = (15, 30, 50, 100)
"""The numbers of decimal digits with which mpmath computes roots."""

SLOW_ROWS = 24
"""The number of rows of a family on which a method that takes milliseconds for a row is tested."""

LONG_DOUBLE = {2.0**-63: "x87", 2.0**-112: "binary128"}.get(float(np.finfo(np.longdouble).eps))
"""The precision of numpy's long double on this machine; None if it is float64, or two of them."""


PRECISIONS = ("float32", "float64")


@cache
def methods() -> dict[str, Method]:
    """Return every built-in method by its name, even if what it needs is not installed.

    mpmath and collision engines are loaded only when a method is called.
    """
    formulas = [formula for formula in FORMULAS.values() if formula.classifies_pairs or formula.name == "dual"]
    ours = (_formula_method(formula, precision) for precision in PRECISIONS for formula in formulas)
    only_for_bench = partial(map, partial(replace, measured=True))
    return {
        method.name: method
        for method in (
            *_fast_methods(),
            *ours,
            *only_for_bench(_measured_methods()),
            *_naive_methods(),
            *only_for_bench(_tilted_methods()),
            *only_for_bench(_passage_methods()),
        )
    }


def _fast_methods() -> Iterator[Method]:
    """Yield the fast path as methods: by the kernel in use, and in numpy."""
    in_use = "the kernel in use" if choice().kernel == "compiled" else "the kernel in use, which is numpy"
    for name, where, answer, scene in (
        ("fast", in_use, fast_positions, fast_scene),
        ("fast-numpy", "in numpy", numpy_kernel.positions, numpy_kernel.positions_of_scene),
    ):
        title = f"the fast path, {where}: certified floats, integers where they cannot tell"
        yield Method(name, title, answer, domain=EVERYWHERE, exact=True, scene=scene)


def fast_positions(rows: Rows) -> Answers:
    """Return positions (n,) of rows (n, 7) or (n, 10) by the kernel in use, on one thread."""
    return kernel().answer_rows(np.ascontiguousarray(rows), "position", 1)[0]


def fast_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis | None = None) -> Answers:
    """Return positions of one spheroid's centres (n,) by the kernel in use, on one thread.

    Without an axis the spheroid is upright.
    """
    return kernel().answer_scene(sizes, (x, y, z), "position", 1, axis)[0]


def _formula_method(formula: Formula, format_name: str) -> Method:
    """Return a formula in a float format as a method; the dual form has a search of its own."""
    dual = alternatives.dual(format_name) if formula.name == "dual" else None
    return Method(
        f"{formula.name}-{format_name}",
        f"{formula.title}, {format_name}",
        on_rows(dual) if dual else by_rows(formula, format_name),
        scene=on_scene(dual) if dual else by_scene(formula, format_name),
        question=formula.question,
        precision=format_name,
        domain=Domain(regimes=formula.regimes),
    )


def _measured_methods() -> Iterator[Method]:
    """Yield methods that only bench uses: other precisions, roots, exact methods, and other shapes."""
    for format_name, precision in (("float16", "float16"), ("longdouble", LONG_DOUBLE)):
        if precision is not None:
            yield replace(_formula_method(FORMULAS["table-2"], format_name), precision=precision)
    for precision in PRECISIONS:
        title = f"the roots of g by the trigonometric form, {precision}"
        roots = alternatives.trigonometric_roots(precision)
        answer, scene = on_rows(roots), on_scene(roots)
        yield Method(f"trigonometric-{precision}", title, answer, precision=precision, scene=scene)
    yield Method("numpy-roots", "the roots of g by numpy.roots, float64", alternatives.numpy_roots, max_rows=400)
    for digits in DIGITS:
        title = f"the roots of g by mpmath.polyroots at {digits} digits"
        answer = partial(alternatives.mpmath_roots, digits=digits)
        yield Method(f"mpmath-roots-{digits}", title, answer, max_rows=SLOW_ROWS)
    for name, title, answer in (
        ("exact-integers", "the coefficient rule in integers, the fast path's last stage", _integers),
        ("exact-oracle", "the exact oracle: the sign of g at its local maximum, in integers", _oracle),
        ("nearest-point", "the nearest point, in double-double and then in exact enclosures", _nearest),
    ):
        yield Method(name, title, answer, domain=EVERYWHERE, exact=True, max_rows=400)
    sphere, cylinder = alternatives.bounding_sphere_scene, alternatives.bounding_cylinder
    for shape, how, answer, of_scene in (
        ("sphere", "exact", alternatives.bounding_sphere, sphere),
        ("cylinder", "float64", on_rows(cylinder), on_scene(cylinder)),
    ):
        title = f"the circumscribed {shape} in the spheroid's place, {how}"
        yield Method(f"bounding-{shape}", title, answer, scene=of_scene)


def _integers(rows: Rows) -> Answers:
    """Return positions (n,) by the fast path's last stage, in integers."""
    return np.array([integers.upright_position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _oracle(rows: Rows) -> Answers:
    """Return positions (n,) by the exact oracle."""
    return np.array([exact.position(Pair.from_row(row).lengths) for row in rows.tolist()], dtype=np.int8)


def _nearest(rows: Rows) -> Answers:
    """Return positions (n,) by the oracle of the nearest point."""
    return nearest_rows.positions(np.ascontiguousarray(rows)).position


FCL_ROWS = 12
"""The number of rows of a family on which plain FCL is tested: it builds a mesh for each, which takes milliseconds."""

NAIVE_FCL = {
    "ellipsoid": "FCL's ellipsoid against a plain mesh of 2,000 triangles",
    "sphere": "FCL's unit sphere against a scaled plain mesh of 2,000 triangles",
    "point": "FCL's distance from the centre to a scaled plain mesh of 2,000 triangles",
}
"""The titles of the naive use of FCL, by pairing."""


def _naive_methods() -> Iterator[Method]:
    """Yield the naive use of FCL, one method for each pairing."""
    for pairing, title in NAIVE_FCL.items():
        answer = partial(naive_fcl, pairing=pairing)
        yield Method(f"fcl-{pairing}-mesh", title, answer, max_rows=FCL_ROWS, needs=FCL.title)


def _tilted_methods() -> Iterator[Method]:
    """Yield methods whose rows have an axis; the fast path and the exact methods take rows with an axis and without."""
    for name, title, answer, scene in (
        (
            "eigh",
            "eigenvectors by numpy.linalg.eigh, then the dual function, float64",
            alternatives.by_eigenvectors,
            alternatives.by_eigenvectors_scene,
        ),
        (
            "roots",
            "the roots of the quartic det(S + λH) by numpy.linalg.eigvals, float64",
            alternatives.by_roots,
            None,
        ),
        (
            "upright",
            "the spheroid taken for upright, exact",
            alternatives.upright,
            alternatives.upright_scene,
        ),
    ):
        yield Method(name, title, answer, tilt=True, scene=scene)
    title = "the nearest point, in intervals of mpmath"
    yield Method("nearest-enclosed", title, _nearest_enclosed, domain=EVERYWHERE, exact=True, tilt=True)


def _nearest_enclosed(rows: Rows) -> Answers:
    """Return positions (n,) by the nearest point in intervals of mpmath."""
    return np.array([nearest(Pair.from_row(row)).position for row in rows.tolist()], dtype=np.int8)


SAMPLES = (4, 16, 64, 256)
"""How many positions of a sweep a sampling method tests."""

SWEEP_ROWS = 200
"""The number of sweeps of a family on which a method that takes a millisecond for a sweep is tested."""


def _passage_methods() -> Iterator[Method]:
    """Yield every method that answers the question passage."""
    yield _passage_method("passage-exact", "roots and steps in integers", sweeps.exact, exact=True, max_rows=SWEEP_ROWS)
    yield Method(
        "passage-certified",
        "steps in certified floats, exact where they come to nothing",
        sweeps.certified,
        question="passage",
        domain=EVERYWHERE,
        exact=True,
    )
    for count in SAMPLES:
        title, timed = f"exact positions at {count} times", partial(sweeps.sampled, count=count)
        yield _passage_method(f"passage-sampled-{count}", title, timed)
    yield _passage_method("passage-advancement", "conservative advancement by the centre's distance", sweeps.advanced)
    yield _passage_method("passage-capsule", "a swept ball in the spheroid's place, advanced alike", sweeps.capsule)
    for solver in SWEEP_SOLVERS.values():
        method = _passage_method(solver.name, solver.title, partial(hits_and_times, solver), max_rows=FCL_ROWS)
        yield replace(method, needs=solver.engine.title, timed=method.timed if solver.times else None)


def _passage_method(
    name: str,
    title: str,
    timed: Callable[[Rows], tuple[Answers, Floats]],
    *,
    exact: bool = False,
    max_rows: int | None = None,
) -> Method:
    """Return a method for sweeps; `timed` gives hits and times."""
    return Method(
        name,
        title,
        lambda rows: timed(rows)[0],
        question="passage",
        domain=EVERYWHERE if exact else ORDINARY,
        exact=exact,
        max_rows=max_rows,
        timed=timed,
    )


def names() -> list[str]:
    """Return the names that `builtin:NAME` takes.

    Methods with `tilt` are left out: their eigenvalues fail on extreme rows.
    """
    return [name for name, method in methods().items() if not method.tilt]


def trouble_with(method: Method) -> str | None:
    """Return the reason why a method cannot be used here, or None; the engine that it needs is loaded."""
    return ENGINES[method.needs].trouble() if method.needs else None


def builtin(name: str) -> Method:
    """Return the built-in method of that name. Raises InputError naming the known methods, or a missing requirement."""
    if name not in (known := names()):
        raise InputError(f"there is no built-in method {name!r}; {suggestion(name, known)}")
    method = methods()[name]
    if (trouble := trouble_with(method)) is not None:
        raise InputError(f"the built-in method {name!r} cannot be used: {trouble}")
    return method


class BuiltinSession:
    """A session of a built-in method. Raises InputError if there is none of that name."""

    max_batch = LARGEST
    scene = False
    evidence = ""

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
        """Return the method's answers."""
        if self.method.timed is not None:
            return GivenAnswers(*self.method.timed(rows))
        return GivenAnswers(self.method.answer(rows))

    def time(
        self,
        rows: Rows,
        repeat: int,
        *,
        by_scene: bool = False,  # noqa: ARG002
        row_by_row: bool = False,
    ) -> tuple[int, int]:
        """Return nanoseconds for `repeat` times the rows, and the sum of the answers.

        With `row_by_row` it makes one call for each row.
        """
        parts = [rows[place : place + 1] for place in range(len(rows))] if row_by_row else [rows]
        answers: list[NDArray[np.int8]] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            answers = [self.method.answer(part) for part in parts]
        return time.perf_counter_ns() - start, sum(int(answer.sum(dtype=np.int64)) for answer in answers)

    def advice(self, reason: str) -> str:  # noqa: ARG002 - it is not isolated
        """Nothing."""
        return ""

    def close(self) -> None:
        """Do nothing: there is no process."""

    def kill(self) -> None:
        """Do nothing: there is no process."""
