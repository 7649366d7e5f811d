"""The mesh oracle's search in general position: two meshes of the hyperboloid, one on either side of it.

Two families of straight lines lie on the surface. Line a of the one and line b of the other meet in

    X(a, b) = (α cos θ/cos τ, α sin θ/cos τ, γ tan τ),    θ = (a + b)/2,  τ = (a − b)/2,  |τ| < π/2.

A cell a₀ ≤ a ≤ a₁, b₀ ≤ b ≤ b₁ is bounded by four such lines, and is a rational bilinear patch with positive weights:
it lies in the tetrahedron of its four corners. Of the two diagonals, the one from (a₀, b₀) to (a₁, b₁) goes round the
axis and is a chord inside; the other goes along it and is one outside. The two triangles beside either diagonal, of all
cells together, are a mesh without gaps on that side of the surface. All this outlives a linear map, and so M^(1/2)
makes the spheroid the unit ball about the origin.

Cells are quartered until each is beyond the ball (the corners' least component along their middle is > 1), or a corner
is within it. Then FCL is asked whether the mesh on C's side is farther than 1 (every way from C to the surface crosses
it), or the one on the other side is nearer (every way to it crosses the surface). Nothing is claimed within `slack` of
1, which is ten times what roundings can be expected to add up to, and no proof. There, and where cells become too many,
nothing is decided.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import Floats, Indices, Mask
from hypcheck.truth.mesh import NO_MESH, MeshOutcome, Refinement, Triangles, Vertices

LEVELS = 40
MOST_CELLS = 1 << 13
REACH = 1.25
"""Cells farther than this, in radii, are left out at once."""

_U = 2.0**-52
_LEAST = 2.0**-60
"""Sizes smaller than this beside the largest length are not tried: roundings would leave nothing."""

_START = 8
"""Cells around the axis at the beginning."""

INNER = ((0, 1, 3), (0, 3, 2))
OUTER = ((0, 1, 2), (1, 3, 2))
"""Triangles of the corners (a₀, b₀), (a₀, b₁), (a₁, b₀), (a₁, b₁): beside the diagonal 0–3, and beside 1–2."""


class _Scene:
    """A pair with the spheroid as the unit ball: corners are seen from C in that space."""

    def __init__(self, pair: Pair) -> None:
        alpha, gamma, b, d, x, y, z = _scaled(pair.row[:7])
        axis = np.array(_scaled(pair.axis))
        axis /= math.sqrt(float(axis @ axis))
        self.alpha, self.gamma, self.centre = alpha, gamma, np.array([x, y, z])
        self.root = np.eye(3) / b + (1 / d - 1 / b) * np.outer(axis, axis)
        height = math.sqrt(b * b + (d * d - b * b) * float(axis[2]) ** 2) * REACH
        self.low, self.high = (math.atan((z + side * height) / gamma) for side in (-1, 1))
        lengths = pair.lengths
        level = (lengths.x**2 + lengths.y**2 - lengths.alpha**2) * lengths.gamma**2 - (lengths.z * lengths.alpha) ** 2
        self.side = (level > 0) - (level < 0)

    def corners(self, cells: Floats) -> tuple[Floats, Floats]:
        """Corners (n, 4, 3) of cells (n, 4) with columns a₀, a₁, b₀, b₁, and what roundings may move each, (n,)."""
        a, b = cells[:, [0, 0, 1, 1]], cells[:, [2, 3, 2, 3]]
        theta, tau = (a + b) / 2, (a - b) / 2
        radius = self.alpha / np.cos(tau)
        points = np.stack([radius * np.cos(theta), radius * np.sin(theta), self.gamma * np.tan(tau)], axis=2)
        farthest = -_least(-np.abs(points).reshape(len(cells), 12))
        size = farthest / _least(np.cos(tau)) + np.abs(self.centre).max()
        slack = 80 * _U * (1 + size * np.abs(self.root).max())
        return (points - self.centre) @ self.root, slack


def _scaled(numbers: Sequence[float]) -> list[float]:
    """The numbers times a power of two that makes the largest about 1."""
    exponent = math.frexp(max(map(abs, numbers)))[1]
    return [math.ldexp(each, -exponent) for each in numbers]


def refine(pair: Pair) -> Refinement:
    """Quarter cells, level by level, until all are beyond the ball, or a corner is within it, or neither."""
    if min(_scaled(pair.row[:7])[:4]) < _LEAST:
        return _undecided(0, 0, f"a size is below {_LEAST:.1e} of the largest length")
    with np.errstate(all="ignore"):
        return _refined(_Scene(pair))


def _undecided(side: int, levels: int, reason: str) -> Refinement:
    return Refinement(MeshOutcome.UNDECIDED, side, *NO_MESH, levels, reason=reason)


def _refined(scene: _Scene) -> Refinement:
    cells, outside = _whole(), scene.side >= 0
    beyond: list[tuple[Floats, Floats]] = []
    for level in range(LEVELS):
        tau_low, tau_high = (cells[:, 0] - cells[:, 3]) / 2, (cells[:, 1] - cells[:, 2]) / 2
        cells = cells[(tau_high >= scene.low) & (tau_low <= scene.high)]
        if not len(cells):
            corners = np.concatenate([np.empty((0, 4, 3)), *(part for part, _ in beyond)])
            slack = max((float(part.max()) for _, part in beyond if len(part)), default=0.0)
            shown = _triangles(corners, OUTER if outside else INNER)
            return Refinement(MeshOutcome.CLEAR, scene.side, *shown, level, slack=slack)
        if len(cells) > MOST_CELLS:
            return _undecided(scene.side, level, "too many cells stay open")
        tau_low, tau_high = (cells[:, 0] - cells[:, 3]) / 2, (cells[:, 1] - cells[:, 2]) / 2
        bounded = (tau_low > -math.pi / 2 + 1e-9) & (tau_high < math.pi / 2 - 1e-9) & (cells[:, 1] - cells[:, 0] < 1)
        corners, slack_of = scene.corners(cells)
        within = bounded & (np.sqrt(_least(np.einsum("nij,nij->ni", corners, corners))) + slack_of < 1)
        if within.any():
            shown = _triangles(corners[within][:1], INNER if outside else OUTER)
            slack = float(slack_of[within][0])
            return Refinement(MeshOutcome.CONTACT, scene.side, *shown, level + 1, slack=slack)
        lower = _least_along(corners) - slack_of
        done = bounded & (lower > 1)
        near = done & (lower <= REACH)
        beyond.append((corners[near], slack_of[near]))
        cells = _quarters(cells[~done])
    return _undecided(scene.side, LEVELS, "cells stay open to the last level")


def _whole() -> Floats:
    """Cells that cover the surface, some of them beyond its ends."""
    step = 2 * math.pi / _START
    return np.array(
        [
            (step * i, step * (i + 1), step * (i - j), step * (i - j + 1))
            for i in range(_START)
            for j in range(-_START // 2, _START // 2 + 2)
        ]
    )


def _quarters(cells: Floats) -> Floats:
    a0, a1, b0, b1 = cells.T
    a, b = (a0 + a1) / 2, (b0 + b1) / 2
    parts = [(a0, a, b0, b), (a0, a, b, b1), (a, a1, b0, b), (a, a1, b, b1)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def _least_along(corners: Floats) -> Floats:
    """The least component of a cell's corners along the direction to their middle."""
    middle = np.einsum("nij->nj", corners) / 4
    length = np.sqrt(np.einsum("nj,nj->n", middle, middle))
    along = _least(np.einsum("nij,nj->ni", corners, middle))
    return np.where(length > 0, along / np.where(length > 0, length, 1), 0.0)


def _least(numbers: Floats) -> Floats:
    """The least number of each row; numpy takes long for `min` along a short axis."""
    return np.asarray(np.minimum.reduce([*numbers.T]))


def _triangles(corners: Floats, places: tuple[tuple[int, int, int], ...]) -> tuple[Vertices, Triangles]:
    """The triangles of these cells; those without area are left out."""
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    first = 4 * np.arange(len(corners))[:, None, None]
    faces = (first + np.array(places)).reshape(-1, 3)
    return vertices, np.ascontiguousarray(faces[_has_area(vertices, faces)])


def _has_area(vertices: Floats, faces: Indices) -> Mask:
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(q - p, r - p)
    return np.asarray((normal * normal).sum(axis=1) > 1e-150)
