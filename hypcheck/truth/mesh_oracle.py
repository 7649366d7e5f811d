"""The mesh oracle: FCL with one-sided meshes of the surface (docs/mesh-oracle.md).

It answers clear, contact or undecided, and is never wrong: bounds found without FCL decide the pair, and FCL, given the
meshes that show the decision, must agree. The only question to FCL (python-fcl) is the distance of C from a mesh. FCL
knows no sides; the side is that of C, exactly. The bounds for an upright spheroid without ends are proved
(mesh_meridian.py). Those for any axis and any ends, for the wall between two heights and the end discs of a solid, are
here; they are proved if the math library's functions are right within 4 units in the last place.

A surface is given by cells; each piece of it lies in the convex hull of its cell's corners, seen from C in the space in
which the spheroid is the unit ball about the origin. Some corners are points of the surface. Cells are cut until each
is beyond the ball (the corners' least component along their middle is > 1), or a corner that is a point of the surface
is within it. Then FCL is asked about meshes that show the answer. `slack` bounds the sum of all roundings. Nothing is
decided within `slack` of 1, or if there are too many cells.

The wall is X(s, θ) = (α cosh s cos θ, α cosh s sin θ, γ sinh s). Over a cell s₀ ≤ s ≤ s₁ the meridian lies in the
triangle of its chord and its two end tangents, which meet where r = α cosh m/cosh δ, z = γ sinh m/cosh δ, m being the
middle of s and δ half its width. The arc θ₀ ≤ θ ≤ θ₁ of the unit circle lies in the triangle of its two ends and the
corner where the tangents there meet. The cell's piece of the wall is products of both, (r, z) times u being (r u, z),
and so lies in the hull of the nine products of their corners; all this outlives a linear map.

The products of chords with the circumscribed polygon lie outside (F ≥ 0), those of tangents with the inscribed polygon
inside (F ≤ 0). These are two meshes with the wall between them, and the flat rims between the two at the ends, and at
the sides of a cell, make a closed body of each cell. All of the wall is clear of the ball if all of these bodies are.
There is contact if the ball reaches both meshes of one cell: what it holds of the slab between the heights is convex,
so it holds a path from the one to the other, on which F vanishes.

Roundings, in units u = 2⁻⁵³, if functions of the library are right within 4 units in the last place (8u), s is a cell's
parameter and `size` the largest coordinate of its corners and of C: a corner is a quotient of two of them times a
quotient of two others (36u), with middles of s and of θ that are rounded (7u + 2|s| u), and ends at asinh(z/γ), which
moves them by 9|s| u; less C it is off by (45 + 11|s|) u size in each coordinate, √3 times that in all. Upright, seven
lengths over b or d add 6u, and the root is 1: 90 + 19|s| in all. Else the root, whose norm is ρ, is off by 42u ρ, its
product by 12u ρ, and the component along the middle by 21u: 184 + 19|s| times ρ, which is 3 times its largest entry at
most. _slack_of has 160u (1 + |s|/5), which is more than the first, and 4 times that is more than the second.

An end disc is cut in the same way, z being the height of the end and r its own parameter. A pair without contact has
the side of its centre; the centre is in the body if it is also between the heights.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats, Indices, Mask
from hypcheck.truth import mesh_meridian
from hypcheck.truth.mesh import (
    Measure,
    Mesh,
    MeshOutcome,
    MeshVerdict,
    distance_to_mesh,
    require_fcl,
    side_of_center,
)

_MOST_CELLS = 1 << 13
_LEVELS = 80
"""The most rounds of cutting; after more of them cells are as small as rounding errors."""

_REACH = 1.25
"""Cells farther than this, in radii, are left out at once."""

_LEAST = 2.0**-60
"""Sizes smaller than this beside the largest length are not tried: roundings would leave nothing."""

_U = 2.0**-52

_TILTED = 4
"""The corners of a tilted pair may be wrong by this multiple of _slack_of."""

_START = 8
"""Cells around the axis at the beginning."""

WALL = 0
"""What a cell is part of: the wall, or the disc at the lower end, −1, or at the upper, 1."""

Faces = tuple[tuple[int, int, int], ...]
"""Triangles of a cell, by the places of its corners."""

INNER: Faces = ((0, 2, 3), (2, 5, 3), (3, 5, 6), (5, 8, 6))
OUTER: Faces = ((0, 1, 6), (1, 7, 6), (1, 2, 7), (2, 8, 7))
RIMS: Faces = ((0, 1, 2), (6, 7, 8), (0, 3, 6), (2, 5, 8))
"""Triangles of the nine corners: 3 i + j is start, corner or end (i) of the meridian, in such a direction (j).

All of the surface is clear of the ball if the triangles of all cells are beyond it and no cell holds the origin; there
is contact if the ball reaches both INNER and OUTER of one cell.
"""

_CORNERS = 9
_ON_SURFACE = (0, 2, 6, 8)
"""The places of the corners that are points of the surface."""


class MeshScene:
    """A pair in the space in which the spheroid is the unit ball: corners are relative to C in this space."""

    def __init__(self, pair: Pair, seven: list[float], ends: list[float]) -> None:
        alpha, gamma, b, d, x, y, z = seven
        axis = np.array(_scaled(pair.axis))
        axis /= math.sqrt(float(axis @ axis))
        self.side, self.solid, self.upright = side_of_center(pair), bool(pair.solid), pair.is_upright
        self.alpha, self.gamma, self.centre, self.ends = alpha, gamma, np.array([x, y, z]), ends
        self.root = np.eye(3) / b + (1 / d - 1 / b) * np.outer(axis, axis)
        reach = math.sqrt(b * b + (d * d - b * b) * float(axis[2]) ** 2) * _REACH
        self.low, self.high = max(z - reach, ends[0]), min(z + reach, ends[1])

    def whole(self) -> Floats:
        """Make cells (n, 5) that cover all parts within reach: part, first and last s or r, first and last θ."""
        parts = list(self._parts())
        turns = np.linspace(0, 2 * math.pi, _START + 1)
        rows = [(*part, *turn) for part in parts for turn in pairwise(turns.tolist())]
        return np.array(rows).reshape(-1, 5)

    def _parts(self) -> Iterator[tuple[float, float, float]]:
        """Yield the strips of the wall, and the discs of a solid, within reach: part, least and greatest s or r."""
        if self.low <= self.high:
            first, last = (math.asinh(height / self.gamma) for height in (self.low, self.high))
            steps = np.linspace(first, last, 2 + math.ceil(last - first))
            yield from ((WALL, low, high) for low, high in pairwise(steps.tolist()))
        if self.solid:
            for side, end in zip((-1, 1), self.ends, strict=True):
                if self.low <= end <= self.high:
                    yield side, 0.0, self.alpha * math.hypot(1, end / self.gamma)

    def corners(self, cells: Floats) -> tuple[Floats, Floats]:
        """Compute corners (n, 9, 3) of cells (n, 5), and bounds of their rounding errors, (n,)."""
        part, low, high, start, end = cells.T
        middle, half = (low + high) / 2, (high - low) / 2
        wall = part == WALL
        s = np.where(wall, np.stack([low, middle, high]), 0)
        shrink = np.stack([np.ones_like(half), np.cosh(np.where(wall, half, 0)), np.ones_like(half)])
        r = np.where(wall, self.alpha * np.cosh(s) / shrink, np.stack([low, middle, high]))
        flat = np.where(part < 0, *self.ends) if self.solid else np.zeros_like(low)
        z = np.where(wall, self.gamma * np.sinh(s) / shrink, flat)
        angle, wide = np.stack([start, (start + end) / 2, end]), np.cos((end - start) / 2)
        u = np.stack([np.cos(angle), np.sin(angle)]) / np.stack([np.ones_like(wide), wide, np.ones_like(wide)])
        across = np.einsum("in,kjn->nijk", r, u)
        up = np.broadcast_to(z.T[:, :, None, None], (len(cells), 3, 3, 1))
        points = np.concatenate([across, up], axis=3).reshape(-1, 9, 3)
        size = np.abs(points).reshape(len(cells), 27).max(axis=1, initial=0.0) + np.abs(self.centre).max()
        slack = _slack_of(size * (1 + np.abs(s).max(axis=0) / 5), self.root)
        return (points - self.centre) @ self.root, slack if self.upright else _TILTED * slack

    def cut(self, cells: Floats, corners: Floats) -> Floats:
        """Cut each cell in halves, across its longer direction."""
        along = np.maximum(_lengths(corners[:, 0] - corners[:, 6]), _lengths(corners[:, 2] - corners[:, 8]))
        round_axis = np.maximum(_lengths(corners[:, 0] - corners[:, 2]), _lengths(corners[:, 6] - corners[:, 8]))
        first = np.where(along >= round_axis, 1, 3)
        rows = np.arange(len(cells))
        middle = (cells[rows, first] + cells[rows, first + 1]) / 2
        one, other = cells.copy(), cells.copy()
        one[rows, first + 1], other[rows, first] = middle, middle
        return np.concatenate([one, other])


def _lengths(vectors: Floats) -> Floats:
    """Return the lengths of vectors (n, 3)."""
    return np.asarray(np.sqrt(np.einsum("nj,nj->n", vectors, vectors)))


def verdict(pair: Pair, measure: Measure = distance_to_mesh) -> MeshVerdict:
    """Return the verdict about any valid pair, if `measure`, the distance to a mesh, confirms it; else undecided.

    Raises UnavailableError if FCL cannot be imported.
    """
    require_fcl()
    found = (mesh_meridian.refine if pair.is_upright and not pair.has_ends else refine)(pair)
    for mesh in found.meshes:
        distance = measure(*mesh)
        clear = found.outcome is MeshOutcome.CLEAR
        if not (distance > 1 + found.slack if clear else distance <= 1 - found.slack):
            reason = f"FCL's distance {distance!r} to the mesh does not bear out {found.outcome.value}"
            return replace(found, outcome=MeshOutcome.UNDECIDED, reason=reason)
    return found


def refine(pair: Pair) -> MeshVerdict:
    """Halve cells, level by level, until all are beyond the ball, a point is within it, or no decision is possible."""
    with np.errstate(all="ignore"):
        scene = scene_of(pair)
        if scene is None:
            return _undecided(side_of_center(pair), 0, f"a size is below {_LEAST:.1e} of the largest length")
        return _cut(scene)


def scene_of(pair: Pair) -> MeshScene | None:
    """Return the pair with the spheroid as the unit ball; None if roundings would prevent every decision."""
    if pair.is_upright:
        # Theorem 1: lengths across the axis in units of b, those along it in units of d.
        seven = [pair.alpha / pair.b, pair.gamma / pair.d, 1.0, 1.0, pair.x / pair.b, pair.y / pair.b, pair.z / pair.d]
        ends = [pair.z_min / pair.d, pair.z_max / pair.d]
    else:
        exponent = math.frexp(max(map(abs, pair.row[:7])))[1]
        seven = _scaled(pair.row[:7])
        ends = [float(np.ldexp(end, -exponent)) for end in (pair.z_min, pair.z_max)]
    if not min(seven[:4]) >= _LEAST * max(map(abs, seven)) or not all(map(math.isfinite, seven)):
        return None
    return MeshScene(pair, seven, ends)


def _cut(scene: MeshScene) -> MeshVerdict:
    """Cut cells until all are decided, or no decision is possible."""
    cells, side = scene.whole(), scene.side
    beyond: list[tuple[Floats, Floats]] = []
    for level in range(_LEVELS):
        if not len(cells):
            corners = np.concatenate([np.empty((0, _CORNERS, 3)), *(part for part, _ in beyond)])
            slack = max((float(part.max()) for _, part in beyond if len(part)), default=0.0)
            return MeshVerdict(MeshOutcome.CLEAR, side, (_mesh_of(corners, INNER + OUTER + RIMS),), level, slack=slack)
        if len(cells) > _MOST_CELLS:
            return _undecided(side, level, "too many cells stay open")
        corners, slacks = scene.corners(cells)
        points = corners[:, _ON_SURFACE]
        within = np.sqrt(_least(np.einsum("nij,nij->ni", points, points))) + slacks < 1
        if within.any():
            meshes = tuple(_mesh_of(corners[within][:1], faces) for faces in (INNER, OUTER))
            return MeshVerdict(MeshOutcome.CONTACT, side, meshes, level + 1, slack=float(slacks[within][0]))
        lower = _least_along(corners) - slacks
        done = lower > 1
        near = done & (lower <= _REACH)
        beyond.append((corners[near], slacks[near]))
        cells = scene.cut(cells[~done], corners[~done])
    return _undecided(side, _LEVELS, "cells stay open to the last level")


def _undecided(side: Position, levels: int, reason: str) -> MeshVerdict:
    """Return the outcome of a search that decides nothing, and why."""
    return MeshVerdict(MeshOutcome.UNDECIDED, side, (), levels, reason=reason)


def _slack_of(size: Floats, root: Floats) -> Floats:
    """Bound the rounding errors of corners, (n,): `size` bounds the coordinates, `root` maps the spheroid to a ball."""
    return np.asarray(80 * _U * (1 + size * np.abs(root).max()))


def _scaled(numbers: Sequence[float]) -> list[float]:
    """Return the numbers times a power of two that makes the largest about 1."""
    exponent = math.frexp(max(map(abs, numbers)))[1]
    return [math.ldexp(number, -exponent) for number in numbers]


def _mesh_of(corners: Floats, faces: Faces) -> Mesh:
    """Make the mesh of these faces of cells with corners (n, 9, 3); triangles without area are left out."""
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    first = _CORNERS * np.arange(len(corners))[:, None, None]
    triangles = (first + np.array(faces)).reshape(-1, 3)
    return vertices, np.ascontiguousarray(triangles[_has_area(vertices, triangles)])


def _has_area(vertices: Floats, faces: Indices) -> Mask:
    """Return a mask of the triangles that have an area."""
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(q - p, r - p)
    return np.asarray((normal * normal).sum(axis=1) > 1e-150)


def _least_along(corners: Floats) -> Floats:
    """Return the least component of a cell's corners along the direction to their middle."""
    middle = np.einsum("nij->nj", corners) / _CORNERS
    length = np.sqrt(np.einsum("nj,nj->n", middle, middle))
    along = _least(np.einsum("nij,nj->ni", corners, middle))
    return np.where(length > 0, along / np.where(length > 0, length, 1), 0.0)


def _least(numbers: Floats) -> Floats:
    """Return the least number of each row; numpy takes long for `min` along a short axis."""
    return np.asarray(np.minimum.reduce([*numbers.T]))
