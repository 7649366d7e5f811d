"""Spheroids that lean, decided as one would write it without certificates: in numpy, or by a simpler body.

Rows are (n, 10), answers int8 (n,). Eigenvectors turn the pair into a unit ball about the origin and a surface with
three poles, x²/A1 + y²/A2 − z²/B = 1 (docs/mathematics.md, "General position"); then the greatest value of the dual
function decides. The roots of det(S + λH) beside its poles decide as well. Plain floats err near contact.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Axis, Sizes
from hypcheck.geometry.rows import Columns, Floats, Positions, Rows
from hypcheck.implementations import alternatives
from hypcheck.implementations.method import Answers
from hypcheck.kernel.classify import kernel

TURNS = 56
"""Bisections of the interval of λ, down to neighbouring floats: some dual functions are greatest at a pole."""


def by_eigenvectors(rows: Rows, turns: int = TURNS) -> Positions:
    """Positions of rows (n, 10) by numpy.linalg.eigh, and the dual function's greatest value.

    By bisection for its slope, which is safe from any start. Uncertified: near contact it is sometimes wrong.
    """
    with np.errstate(all="ignore"):
        return _by_dual(*_eigenbasis(rows[:, :4], rows[:, 7:]), rows[:, 4:7], turns)


def by_eigenvectors_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, axis: Axis) -> Positions:
    """The same for many centres of one spheroid, whose eigenvectors are found once."""
    with np.errstate(all="ignore"):
        return _by_dual(*_eigenbasis(np.array([sizes]), np.array([axis])), np.column_stack([x, y, z]), TURNS)


def _eigenbasis(sizes: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """The poles −B, then A1 and A2 with the nearer one last, (n, 3); and the map of a centre to its components."""
    b, d = sizes[:, 2, None, None], sizes[:, 3, None, None]
    unit = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    along = unit[:, :, None] * unit[:, None, :]
    root = b * np.eye(3) + (d - b) * along  # M^(-1/2)
    values, vectors = np.linalg.eigh(root @ (_diagonal(sizes)[:, :, None] * root))
    inverse = np.eye(3) / b + (1 / d - 1 / b) * along
    return 1 / values, np.swapaxes(vectors, 1, 2) @ inverse


def _diagonal(sizes: Floats) -> Floats:
    """The diagonal of D = diag(1/α², 1/α², −1/γ²), (n, 3)."""
    alpha, gamma = sizes[:, 0], sizes[:, 1]
    return np.column_stack([alpha**-2, alpha**-2, -(gamma**-2)])


def _by_dual(poles: Floats, turned: Floats, centres: Floats, turns: int) -> Positions:
    squares = (turned @ centres[:, :, None])[:, :, 0] ** 2
    low, high = (np.broadcast_to(-poles[:, k], len(centres)) for k in (2, 0))
    for _ in range(turns):
        middle = (low + high) / 2
        rising = (poles * squares / (poles + middle[:, None]) ** 2).sum(axis=1) > 1
        low, high = np.where(rising, middle, low), np.where(rising, high, middle)
    at = (low + high) / 2
    phi = at * (squares / (poles + at[:, None])).sum(axis=1) - 1 - at
    return np.where(phi > 0, np.sign(at), 0).astype(np.int8)


def by_roots(rows: Rows) -> Positions:
    """Positions of rows (n, 10) by the roots of det(S + λH), which numpy.linalg.eigvals finds; real if they say so.

    Exterior: two different roots between 0 and B. Interior: two between −min(A1, A2) and 0.
    """
    sizes, centre, axes = rows[:, :4], rows[:, 4:7], rows[:, 7:]
    b, d = sizes[:, 2, None, None], sizes[:, 3, None, None]
    unit = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    quadratic = np.eye(3) / b**2 + (1 / d**2 - 1 / b**2) * unit[:, :, None] * unit[:, None, :]  # M
    linear = (quadratic @ centre[:, :, None])[:, :, 0]
    inverse = 1 / np.column_stack([_diagonal(sizes), -np.ones(len(rows))])  # of H
    pencil = np.empty((len(rows), 4, 4))
    pencil[:, :3, :3], pencil[:, 3, 3] = quadratic, (linear * centre).sum(axis=1) - 1
    pencil[:, :3, 3] = pencil[:, 3, :3] = -linear
    roots = np.linalg.eigvals(-inverse[:, :, None] * pencil)
    poles = np.linalg.eigvals(-inverse[:, :3, None] * quadratic).real
    nearest = [np.where(poles * side > 0, np.abs(poles), np.inf).min(axis=1) for side in (1, -1)]
    sides = [_pair_below(side * roots, pole) for side, pole in zip((1, -1), nearest, strict=True)]
    return sides[0].astype(np.int8) - sides[1].astype(np.int8)


def _pair_below(roots: NDArray[Any], pole: Floats) -> Positions:
    """Whether two different real roots lie between 0 and the pole, (n,)."""
    real = np.where((roots.imag == 0) & (roots.real > 0), roots.real, np.inf)
    lowest, second = np.sort(real, axis=1)[:, :2].T
    return np.asarray((lowest < second) & (second <= pole))


def upright(rows: Rows) -> Answers:
    """Positions (n,) as if the spheroid stood upright, exact, so that every error is due to its axis."""
    return kernel().answer_rows(np.ascontiguousarray(rows[:, : len(COLUMNS)]), "position", 1)[0]


def upright_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, _axis: Axis) -> Answers:
    """The same for many centres of one spheroid."""
    columns: Columns = (x, y, z)
    return kernel().answer_scene(sizes, columns, "position", 1)[0]


def bounding_sphere(rows: Rows) -> Answers:
    """Positions (n,) of the circumscribed sphere, which no axis turns, exact."""
    return alternatives.bounding_sphere(rows[:, : len(COLUMNS)])


def bounding_sphere_scene(sizes: Sizes, x: Floats, y: Floats, z: Floats, _axis: Axis) -> Answers:
    """The same for many centres of one spheroid."""
    return alternatives.bounding_sphere_scene(sizes, x, y, z)
