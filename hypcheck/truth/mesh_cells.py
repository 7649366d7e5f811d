"""The mesh oracle's search where there is no meridian: cells of a surface, cut until they decide.

A surface is given by cells; each piece of the surface lies in the convex hull of its cell's corners, seen from C in the
space in which the spheroid is the unit ball about the origin. Some corners are points of the surface. Cells are cut
until each is beyond the ball (the corners' least component along their middle is > 1), or a corner that is a point of
the surface is within it. Then FCL is asked about meshes that show the answer.

Nothing is claimed within `slack` of 1, which is what roundings may add up to: counted in mesh_ends.py, and in
mesh_lines.py ten times what can be expected, which is no proof. There, and where cells become too many, nothing is
decided.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np

from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import Floats, Indices, Mask
from hypcheck.truth.mesh import Mesh, MeshOutcome, Refinement

MOST_CELLS = 1 << 13
REACH = 1.25
"""Cells farther than this, in radii, are left out at once."""

LEAST = 2.0**-60
"""Sizes smaller than this beside the largest length are not tried: roundings would leave nothing."""

_U = 2.0**-52

Faces = tuple[tuple[int, int, int], ...]
"""Triangles of a cell, by the places of its corners."""


class Surface(Protocol):
    """A surface in cells (n, any number of columns), and the meshes that show where it is.

    `on_surface` are the places of the corners that are points of it. All of the surface is clear of the ball if the
    triangles `clear` of all cells are beyond it and no cell holds the origin; there is contact if the ball reaches each
    of the meshes `contact` of one cell. `side` is the sign of the hyperboloid's equation at C. `levels` are as many
    rounds of cutting as leave anything but roundings.
    """

    side: int
    levels: int
    on_surface: tuple[int, ...]
    clear: Faces
    contact: tuple[Faces, ...]

    def within_reach(self, cells: Floats) -> Floats:
        """The cells without those that are known to be out of reach."""

    def usable(self, cells: Floats) -> Mask:
        """Which cells, (n,), are small enough that the hull of their corners holds their piece of the surface."""

    def corners(self, cells: Floats) -> tuple[Floats, Floats]:
        """Corners (n, number, 3) of cells, and what roundings may move each, (n,)."""

    def cut(self, cells: Floats, corners: Floats) -> Floats:
        """The cells in parts."""


def refine(surface: Surface, cells: Floats) -> Refinement:
    """Cut cells, level by level, until all are beyond the ball, or a point of the surface is within it, or neither."""
    side, number = surface.side, 1 + max(max(face) for face in surface.clear)
    beyond: list[tuple[Floats, Floats]] = []
    for level in range(surface.levels):
        cells = surface.within_reach(cells)
        if not len(cells):
            corners = np.concatenate([np.empty((0, number, 3)), *(part for part, _ in beyond)])
            slack = max((float(part.max()) for _, part in beyond if len(part)), default=0.0)
            return Refinement(MeshOutcome.CLEAR, side, (mesh_of(corners, surface.clear),), level, slack=slack)
        if len(cells) > MOST_CELLS:
            return undecided(side, level, "too many cells stay open")
        usable = surface.usable(cells)
        corners, slacks = surface.corners(cells)
        points = corners[:, surface.on_surface]
        within = usable & (np.sqrt(_least(np.einsum("nij,nij->ni", points, points))) + slacks < 1)
        if within.any():
            meshes = tuple(mesh_of(corners[within][:1], faces) for faces in surface.contact)
            return Refinement(MeshOutcome.CONTACT, side, meshes, level + 1, slack=float(slacks[within][0]))
        lower = _least_along(corners) - slacks
        done = usable & (lower > 1)
        near = done & (lower <= REACH)
        beyond.append((corners[near], slacks[near]))
        cells = surface.cut(cells[~done], corners[~done])
    return undecided(side, surface.levels, "cells stay open to the last level")


def undecided(side: int, levels: int, reason: str) -> Refinement:
    """The outcome of a search that decides nothing, and why."""
    return Refinement(MeshOutcome.UNDECIDED, side, (), levels, reason=reason)


def side_of_center(pair: Pair) -> int:
    """The exact sign of F(C) = (x² + y²)/α² − z²/γ² − 1: 1 outside the surface, −1 inside, 0 on it."""
    lengths = pair.lengths
    level = (lengths.x**2 + lengths.y**2 - lengths.alpha**2) * lengths.gamma**2 - (lengths.z * lengths.alpha) ** 2
    return (level > 0) - (level < 0)


def slack_of(size: Floats, root: Floats) -> Floats:
    """What roundings may move a corner, (n,): `size` is that of its coordinates, `root` makes the spheroid a ball."""
    return np.asarray(80 * _U * (1 + size * np.abs(root).max()))


def scaled(numbers: Sequence[float]) -> list[float]:
    """The numbers times a power of two that makes the largest about 1."""
    exponent = math.frexp(max(map(abs, numbers)))[1]
    return [math.ldexp(number, -exponent) for number in numbers]


def mesh_of(corners: Floats, faces: Faces) -> Mesh:
    """These faces of cells with corners (n, number, 3); triangles without area are left out."""
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    first = corners.shape[1] * np.arange(len(corners))[:, None, None]
    triangles = (first + np.array(faces)).reshape(-1, 3)
    return vertices, np.ascontiguousarray(triangles[_has_area(vertices, triangles)])


def _has_area(vertices: Floats, faces: Indices) -> Mask:
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(q - p, r - p)
    return np.asarray((normal * normal).sum(axis=1) > 1e-150)


def _least_along(corners: Floats) -> Floats:
    """The least component of a cell's corners along the direction to their middle."""
    middle = np.einsum("nij->nj", corners) / corners.shape[1]
    length = np.sqrt(np.einsum("nj,nj->n", middle, middle))
    along = _least(np.einsum("nij,nj->ni", corners, middle))
    return np.where(length > 0, along / np.where(length > 0, length, 1), 0.0)


def _least(numbers: Floats) -> Floats:
    """The least number of each row; numpy takes long for `min` along a short axis."""
    return np.asarray(np.minimum.reduce([*numbers.T]))
