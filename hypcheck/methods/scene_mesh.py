"""A collision engine as a scene has it: one mesh of the whole surface, built once and asked about every body.

The mesh is inscribed, its vertices on the surface, and its grid the best there is of so many triangles: as far off
across as along. The three pairings are those of fcl_naive.py, with the mesh in the caller's units for the ellipsoid and
in spheroid radii (Theorem 1 of the paper) for the other two. All answer 0 where the engine reports contact, else
the sign of F(C) in plain floats, and CANNOT_SAY where it refuses the mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, pi, sqrt

import numpy as np
from numpy.typing import NDArray

from hypcheck.methods.engines import Engine, Touches
from hypcheck.methods.formula import Sizes
from hypcheck.methods.method import Answers
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.truth.mesh_fcl import Triangles, Vertices


@dataclass(frozen=True, slots=True)
class Grid:
    """A mesh of the surface with semi-axes `a`, `a`, `c` up to `height` on both sides of the waist."""

    a: float
    c: float
    height: float
    around: int
    along: int

    @property
    def triangles(self) -> int:
        """How many there are."""
        return 2 * self.around * self.along

    @property
    def deviation(self) -> float:
        """A bound of how far the mesh is from the surface, horizontally, on the side where it is farther.

        A point of a triangle is a mean of vertices within an azimuth of Δθ and a height of Δz. Their radii's mean is at
        least r(z), which is convex, and exceeds it by r″ Δz²/8 at most, with r″ ≤ a/c²; the mean of their directions
        has a length of at least cos(Δθ/2).
        """
        widest = self.a * hypot(1.0, self.height / self.c)
        inward = widest * (1 - cos(pi / self.around))
        outward = self.a / self.c**2 * (2 * self.height / self.along) ** 2 / 8
        return max(inward, outward)

    def mesh(self) -> tuple[Vertices, Triangles]:
        """Vertices (n, 3) and triangles (m, 3)."""
        azimuths = np.linspace(0, 2 * pi, self.around, endpoint=False)
        heights = np.linspace(-self.height, self.height, self.along + 1)
        z, azimuth = np.meshgrid(heights, azimuths, indexing="ij")
        r = self.a * np.hypot(1.0, z / self.c)
        vertices = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), z], axis=-1).reshape(-1, 3)
        ring = np.arange(self.around)
        left = (np.arange(self.along)[:, np.newaxis] * self.around + ring).reshape(-1, 1)
        right = (np.arange(self.along)[:, np.newaxis] * self.around + (ring + 1) % self.around).reshape(-1, 1)
        lower = np.hstack([left, right, right + self.around])
        upper = np.hstack([left, right + self.around, left + self.around])
        return np.ascontiguousarray(vertices), np.concatenate([lower, upper])


def grid_of(a: float, c: float, height: float, triangles: int) -> Grid:
    """The grid of about so many triangles that is as far off across as along."""
    across = pi * c / height * sqrt(hypot(1.0, height / c))
    around = max(3, round(sqrt(triangles / 2 * across)))
    return Grid(a, c, height, around, max(1, round(triangles / 2 / around)))


def height_of(sizes: Sizes, rows: Rows) -> float:
    """Up to where a scene's mesh reaches, in the caller's unit: beyond γ, and beyond every body asked about."""
    _, gamma, _, d = sizes
    return float(max(1.2 * gamma, np.abs(rows[:, 6]).max(initial=0.0)) + 1.1 * d)


@dataclass(frozen=True, slots=True)
class SceneMesh:
    """A mesh in an engine, for one α, γ, b, d; a centre is asked about in the units `unit` of its three coordinates.

    `deviation` bounds how far the mesh is from the surface, in spheroid radii.
    """

    sizes: Sizes
    unit: tuple[float, float, float]
    deviation: float
    triangles: int
    touches: Touches | None

    def positions(self, rows: Rows) -> Answers:
        """Positions (n,) of rows that have these sizes."""
        if self.touches is None:
            return np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        alpha, gamma, _, _ = self.sizes
        across, aside, up = self.unit
        return np.array(
            [
                0
                if self.touches(x / across, y / aside, z / up)
                else (1 if (x * x + y * y) / alpha**2 - (z / gamma) ** 2 > 1 else -1)
                for x, y, z in rows[:, 4:].tolist()
            ],
            dtype=np.int8,
        )


def built(engine: Engine, pairing: str, sizes: Sizes, height: float, triangles: int) -> SceneMesh:
    """The scene's mesh for one of PAIRINGS."""
    alpha, gamma, b, d = sizes
    scaled = grid_of(alpha / b, gamma / d, height / d, triangles)
    whole = pairing == "ellipsoid"
    grid = Grid(alpha, gamma, height, scaled.around, scaled.along) if whole else scaled
    touches = engine.question(pairing, *grid.mesh(), b, d)
    return SceneMesh(sizes, (1.0, 1.0, 1.0) if whole else (b, b, d), scaled.deviation, grid.triangles, touches)


def scenes(rows: Rows) -> Iterator[tuple[Sizes, NDArray[np.intp]]]:
    """The sizes that occur, each with the places of its rows."""
    found, scene_of = np.unique(rows[:, :4], axis=0, return_inverse=True)
    for index, (alpha, gamma, b, d) in enumerate(found.tolist()):
        yield (alpha, gamma, b, d), np.flatnonzero(scene_of.reshape(-1) == index)
