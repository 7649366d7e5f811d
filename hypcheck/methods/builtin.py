"""The methods this project brings along: each formula in each precision, the fast path, roots, FCL on a mesh."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.errors import InputError
from hypcheck.kernel import numpy_path
from hypcheck.kernel.answering import kernel
from hypcheck.kernel.choice import choice
from hypcheck.methods.domain import EVERYWHERE, Domain
from hypcheck.methods.dual import dual_positions
from hypcheck.methods.fcl_naive import ellipsoid_mesh, point_mesh, sphere_mesh
from hypcheck.methods.formula import by_rows
from hypcheck.methods.measured import measured_methods
from hypcheck.methods.method import Answers, Method
from hypcheck.pairs import Sizes
from hypcheck.rows import Floats, Rows
from hypcheck.suggesting import advice
from hypcheck.truth.mesh import availability as fcl_trouble

PRECISIONS = ("float32", "float64")

FCL_ROWS = 12
"""Rows of a family that are asked of plain FCL: a mesh is built for each, which takes milliseconds."""

NAIVE_FCL = (
    ("fcl-ellipsoid-mesh", "FCL's ellipsoid against a plain mesh of 2,000 triangles", ellipsoid_mesh),
    ("fcl-sphere-mesh", "FCL's unit sphere against a scaled plain mesh of 2,000 triangles", sphere_mesh),
    ("fcl-point-mesh", "FCL's distance from the centre to a scaled plain mesh of 2,000 triangles", point_mesh),
)


def _of_formula(formula: Formula, precision: str) -> Method:
    return Method(
        name=f"{formula.name}-{precision}",
        title=f"{formula.title}, {precision}",
        question=formula.question,
        precision=precision,
        answer=partial(dual_positions, precision=precision) if formula.name == "dual" else by_rows(formula, precision),
        domain=Domain(regimes=formula.regimes),
    )


def _of_fcl(name: str, title: str, answer: Callable[[Rows], Answers]) -> Method:
    return Method(name, title, "position", "float64", answer, Domain(), most=FCL_ROWS)


def fast_positions(rows: Rows) -> Answers:
    """Positions (n,) of rows (n, 7) by the kernel in use, on one thread."""
    return kernel().answer_rows(np.ascontiguousarray(rows), "position", 1)[0]


def fast_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats) -> Answers:
    """The same of one spheroid's centres (n,)."""
    return kernel().answer_scene(sizes, (x, y, z), "position", 1)[0]


def _exact(name: str, where: str, answer: Callable[[Rows], Answers]) -> Method:
    title = f"the fast path, {where}: certified floats, integers where they cannot tell"
    return Method(name, title, "position", "float64", answer, EVERYWHERE, exact=True)


@cache
def methods_without_meshes() -> dict[str, Method]:
    """Every built-in method that needs no FCL, by its name."""
    in_use = "the kernel in use" if choice().kernel == "compiled" else "the kernel in use, which is numpy"
    fast = (_exact("fast", in_use, fast_positions), _exact("fast-numpy", "in numpy", numpy_path.positions))
    formulas = [formula for formula in FORMULAS.values() if formula.classifies_pairs or formula.name == "dual"]
    ours = (_of_formula(formula, precision) for precision in PRECISIONS for formula in formulas)
    methods = [*fast, *ours, *measured_methods()]
    return {method.name: method for method in methods}


@cache
def builtin_methods() -> dict[str, Method]:
    """Every built-in method by its name, as `builtin:NAME` has it."""
    naive = [_of_fcl(*each) for each in NAIVE_FCL] if fcl_trouble() is None else []
    return methods_without_meshes() | {method.name: method for method in naive}


def builtin(name: str) -> Method:
    """The built-in method of that name; raises InputError naming those that exist."""
    method = methods_without_meshes().get(name) or builtin_methods().get(name)  # FCL is loaded where it is asked for
    if method is None:
        raise InputError(f"there is no built-in method {name!r}; {advice(name, builtin_methods())}")
    return method
