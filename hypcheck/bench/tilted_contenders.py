"""Contenders for spheroids that lean: the fast path, exact methods, numpy versions, simpler bodies, and meshes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np

from hypcheck.bench.contender import Contender, InPython
from hypcheck.bench.mesh_contenders import COAL_TRIANGLES, TRIANGLES, built_once
from hypcheck.bench.plan import TILTED_REFERENCE
from hypcheck.geometry.rows import CANNOT_SAY, Rows
from hypcheck.implementations import tilted_alternatives
from hypcheck.implementations.builtin import fast_positions, fast_scene
from hypcheck.implementations.description import EVERYWHERE, Domain
from hypcheck.implementations.meshes import COAL, FCL
from hypcheck.implementations.method import Answers
from hypcheck.kernel import numpy_kernel
from hypcheck.kernel.choice import choice
from hypcheck.truth.tilted import batch
from hypcheck.truth.tilted.pair import TiltedPair

CERTIFIED = "where its bound cannot tell, integers do"
ELLIPSOID = "ellipsoid"
"""The one pairing that an axis can pose: a mesh scaled to a unit sphere is another one for each axis."""


def tilted_contenders() -> Iterable[Contender]:
    """All of them, including the reference."""
    if choice().kernel == "compiled":
        note = f"{CERTIFIED}; as installed, called from Python, on one thread, {choice().level}"
        yield _ours("fast", "C", "certified", "the fast path, as installed", fast_positions, fast_scene, note=note)
    yield _ours(
        "fast-numpy", "numpy", "certified", "the fast path in numpy",
        numpy_kernel.positions, numpy_kernel.positions_of_scene, note=CERTIFIED, timed=8192,
    )  # fmt: skip
    yield _ours("exact-oracle", "python", "exact", _ORACLE, batch.positions, judged=3000, timed=96)
    yield _ours("nearest-point", "python", "exact", _NEAREST, _nearest, judged=240, timed=16, note=_TELLS)
    yield _ours(
        TILTED_REFERENCE, "numpy", "algebraic", "eigenvectors by numpy.linalg.eigh, then the dual function, float64",
        tilted_alternatives.by_eigenvectors, tilted_alternatives.by_eigenvectors_scene, timed=4096,
        note="its multiplier is found by plain bisection",
    )  # fmt: skip
    yield _ours("roots", "numpy", "roots", _ROOTS, tilted_alternatives.by_roots, timed=4096)
    shapes = "another shape in the spheroid's place"
    yield _ours(
        "upright", "C" if choice().kernel == "compiled" else "numpy", "bounding", _UPRIGHT,
        tilted_alternatives.upright, tilted_alternatives.upright_scene, note="wrong by its axis alone",
    )  # fmt: skip
    yield _ours(
        "bounding-sphere", "numpy", "bounding", "the circumscribed sphere in the spheroid's place, exact",
        tilted_alternatives.bounding_sphere, tilted_alternatives.bounding_sphere_scene, note=shapes,
    )  # fmt: skip
    for triangles in TRIANGLES:
        yield built_once(FCL, ELLIPSOID, triangles)
    for triangles in COAL_TRIANGLES:
        yield built_once(COAL, ELLIPSOID, triangles)


_ORACLE = "the exact oracle: the sign of a quartic between its poles, in integers"
_NEAREST = "the nearest point, in intervals of mpmath"
_ROOTS = "the roots of the quartic det(S + λH) by numpy.linalg.eigvals, float64"
_UPRIGHT = "the spheroid taken for upright, exact"
_TELLS = "tells the distance too"


def _ours(
    name: str,
    tier: str,
    kind: str,
    title: str,
    answer: Callable[[Rows], Answers],
    scene: Callable[..., Answers] | None = None,
    **more: Any,  # noqa: ANN401 - fields of a contender
) -> Contender:
    """A method of ours; those that promise to be exact are asked everywhere."""
    exact = kind in ("certified", "exact")
    load = partial(InPython, answer, scene)
    domain = EVERYWHERE if exact else Domain()
    return Contender(name, title, tier, kind, "float64", "position", domain, load, exact=exact, **more)


def _nearest(rows: Rows) -> Answers:
    from hypcheck.truth.tilted import nearest  # noqa: PLC0415 - loads mpmath

    found = (nearest.position(TiltedPair.from_row(row)) for row in rows.tolist())
    return np.array([CANNOT_SAY if each is None else each for each in found], dtype=np.int8)
