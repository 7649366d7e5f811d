"""The mesh oracle's search in general position: two meshes of the hyperboloid, one on either side of it.

Two families of straight lines lie on the surface. Line a of the one and line b of the other meet in

    X(a, b) = (α cos θ/cos τ, α sin θ/cos τ, γ tan τ),    θ = (a + b)/2,  τ = (a − b)/2,  |τ| < π/2.

A cell a₀ ≤ a ≤ a₁, b₀ ≤ b ≤ b₁ is bounded by four such lines, and is a rational bilinear patch with positive weights:
it lies in the tetrahedron of its four corners. Of the two diagonals, the one from (a₀, b₀) to (a₁, b₁) goes round the
axis and is a chord inside; the other goes along it and is one outside. The two triangles beside either diagonal, of all
cells together, are a mesh without gaps on that side of the surface. All this outlives a linear map, and so M^(1/2)
makes the spheroid the unit ball about the origin.

The search is that of mesh_cells.py. FCL is asked whether the mesh on C's side is farther than 1 (every way from C to
the surface crosses it), or the one on the other side is nearer (every way to it crosses the surface).
"""

from __future__ import annotations

import math

import numpy as np

from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.truth import mesh_cells
from hypcheck.truth.mesh import Refinement
from hypcheck.truth.mesh_cells import LEAST, REACH, Faces, scaled, side_of_center, slack_of, undecided

_START = 8
"""Cells around the axis at the beginning."""

INNER = ((0, 1, 3), (0, 3, 2))
OUTER = ((0, 1, 2), (1, 3, 2))
"""Triangles of the corners (a₀, b₀), (a₀, b₁), (a₁, b₀), (a₁, b₁): beside the diagonal 0–3, and beside 1–2."""


class _Scene:
    """A pair with the spheroid as the unit ball: corners are seen from C in that space."""

    levels = 40
    on_surface: tuple[int, ...] = (0, 1, 2, 3)
    clear: Faces
    contact: tuple[Faces, ...]

    def __init__(self, pair: Pair) -> None:
        alpha, gamma, b, d, x, y, z = scaled(pair.row[:7])
        axis = np.array(scaled(pair.axis))
        axis /= math.sqrt(float(axis @ axis))
        self.alpha, self.gamma, self.centre = alpha, gamma, np.array([x, y, z])
        self.root = np.eye(3) / b + (1 / d - 1 / b) * np.outer(axis, axis)
        height = math.sqrt(b * b + (d * d - b * b) * float(axis[2]) ** 2) * REACH
        self.low, self.high = (math.atan((z + side * height) / gamma) for side in (-1, 1))
        self.side = side_of_center(pair)
        self.clear, far = (OUTER, INNER) if self.side >= 0 else (INNER, OUTER)
        self.contact = (far,)

    def within_reach(self, cells: Floats) -> Floats:
        """The cells without those that lie above or below the ball."""
        low, high = _heights(cells)
        return cells[(high >= self.low) & (low <= self.high)]

    def usable(self, cells: Floats) -> Mask:
        """Which cells are bounded, and span less than 1 in a."""
        low, high = _heights(cells)
        return (low > -math.pi / 2 + 1e-9) & (high < math.pi / 2 - 1e-9) & (cells[:, 1] - cells[:, 0] < 1)

    def corners(self, cells: Floats) -> tuple[Floats, Floats]:
        """Corners (n, 4, 3) of cells (n, 4) with columns a₀, a₁, b₀, b₁, and what roundings may move each, (n,)."""
        a, b = cells[:, [0, 0, 1, 1]], cells[:, [2, 3, 2, 3]]
        theta, tau = (a + b) / 2, (a - b) / 2
        radius = self.alpha / np.cos(tau)
        points = np.stack([radius * np.cos(theta), radius * np.sin(theta), self.gamma * np.tan(tau)], axis=2)
        farthest = np.abs(points).reshape(len(cells), 12).max(axis=1)
        size = farthest / np.cos(tau).min(axis=1) + np.abs(self.centre).max()
        return (points - self.centre) @ self.root, slack_of(size, self.root)

    def cut(self, cells: Floats, _: Floats) -> Floats:
        """Each cell in quarters."""
        a0, a1, b0, b1 = cells.T
        a, b = (a0 + a1) / 2, (b0 + b1) / 2
        parts = [(a0, a, b0, b), (a0, a, b, b1), (a, a1, b0, b), (a, a1, b, b1)]
        return np.concatenate([np.stack(part, axis=1) for part in parts])


def _heights(cells: Floats) -> tuple[Floats, Floats]:
    """The least and the greatest τ of cells."""
    return (cells[:, 0] - cells[:, 3]) / 2, (cells[:, 1] - cells[:, 2]) / 2


def refine(pair: Pair) -> Refinement:
    """Quarter cells, level by level, until all are beyond the ball, or a corner is within it, or neither."""
    if min(scaled(pair.row[:7])[:4]) < LEAST:
        return undecided(0, 0, f"a size is below {LEAST:.1e} of the largest length")
    with np.errstate(all="ignore"):
        return mesh_cells.refine(_Scene(pair), _whole())


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
