"""The shapes that engines get: the hyperboloid's mesh and points on the spheroid; and the distance from that mesh.

A scene is a folder of three files: sizes.txt (α γ b d), surface.off (the mesh, inscribed in the surface) and body.off
(points on the spheroid). The mesh is that of implementations/meshes.py, whose deviation from the surface has a bound.

The exact answer about a mesh is known too: the spheroid touches it exactly if, in spheroid radii, the mesh is not
farther than 1 from the centre. That distance is the least of the distances to triangles. It is computed here with
numpy, without any engine. So an engine's error has two parts: one that its mesh explains, and its own with that mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin
from pathlib import Path

import numpy as np

from hypcheck.engines.placing import Spot
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.meshes import grid_of, turns_of
from hypcheck.truth.mesh import Triangles, Vertices

TRIANGLES = (500, 5_000, 50_000)
"""The approximate numbers of triangles of the three meshes."""

_RINGS, _AROUND = 11, 20

_SECANTS = 4


def ball_points() -> Vertices:
    """Return 222 points of the unit sphere: poles and rings, the equator too. Some engines take at most 256 points."""
    rings = [pi * (k + 1) / (_RINGS + 1) for k in range(_RINGS)]
    turns = [2 * pi * k / _AROUND for k in range(_AROUND)]
    around = [(sin(p) * cos(t), sin(p) * sin(t), cos(p)) for p in rings for t in turns]
    return np.array([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), *around])


HULL = cos(pi / (2 * (_RINGS + 1))) * cos(pi / _AROUND)
"""The hull of these points contains the ball of this radius. In each ring's plane it contains the disc of cos(π/20)
times the ring's radius. So it contains the body of revolution of the meridian's polygon, narrowed by that factor; and
the polygon, whose corners are π/12 apart, contains the disc of radius cos(π/24)."""


@dataclass(frozen=True)
class SurfaceMesh:
    """A mesh of the surface; `deviation` is an upper bound of its distance from the surface, in the vertices' unit."""

    vertices: Vertices
    triangles: Triangles
    deviation: float

    @cached_property
    def middles(self) -> Vertices:
        """The middles of the triangles."""
        return np.asarray(self.vertices[self.triangles].mean(axis=1))

    @cached_property
    def radii(self) -> Floats:
        """The largest distance of a corner from the middle of its triangle, for each triangle."""
        apart = self.vertices[self.triangles] - self.middles[:, np.newaxis]
        return np.asarray(np.linalg.norm(apart, axis=2).max(axis=1))


def surface_mesh(sizes: Sizes, triangles: int) -> SurfaceMesh:
    """Make the inscribed mesh of the whole tower, from −γ to γ, with about this number of triangles."""
    alpha, gamma, _, _ = sizes
    grid = grid_of(alpha, gamma, gamma, triangles)
    return SurfaceMesh(*grid.mesh(), grid.deviation)


def write_scene(folder: Path, sizes: Sizes, mesh: SurfaceMesh) -> None:
    """Write the files of a scene that an adapter reads: sizes.txt, surface.off and body.off."""
    folder.mkdir(parents=True, exist_ok=True)
    _, _, b, d = sizes
    (folder / "sizes.txt").write_text(" ".join(map(repr, sizes)) + "\n")
    (folder / "surface.off").write_text(_off(mesh.vertices, mesh.triangles))
    (folder / "body.off").write_text(_off(ball_points() * [b, b, d], np.empty((0, 3), dtype=np.int64)))


def _off(vertices: Vertices, triangles: Triangles) -> str:
    """Return a mesh in the format OFF."""
    lines = [" ".join(map(repr, vertex)) for vertex in vertices.tolist()]
    lines += [f"3 {i} {j} {k}" for i, j, k in triangles.tolist()]
    return f"OFF\n{len(vertices)} {len(triangles)} 0\n" + "\n".join(lines) + "\n"


def distances(rows: Rows, mesh: SurfaceMesh) -> Floats:
    """Compute the distances (n,) of the centres of rows (n, 10) from a mesh, each in radii of its own spheroid."""
    return np.array([_distance(row, mesh) for row in rows])


def _distance(row: Floats, mesh: SurfaceMesh) -> float:
    """Compute the distance of a row's centre from the mesh, in spheroid radii.

    The nearest middle of a triangle is `reach` radii away, so the nearest point of the mesh is not farther. That is at
    most reach times the longer semi-axis, so the middle of the nearest triangle is not farther than this plus the
    triangle's size. Only triangles with such middles are measured.
    """
    reach = float(np.linalg.norm(seen_from(row, mesh.middles), axis=1).min())
    away = np.linalg.norm(mesh.middles - row[4:7], axis=1)
    near = np.flatnonzero(away <= 1.001 * (reach * max(row[2], row[3]) + mesh.radii))
    squares = to_triangles(seen_from(row, mesh.vertices[mesh.triangles[near]].reshape(-1, 3)).reshape(-1, 3, 3))
    return float(np.sqrt(squares.min()))


def rows_near(spot: Spot, gap: Floats, mesh: SurfaceMesh) -> tuple[Rows, Floats]:
    """Return rows (n, 10) at about these gaps from contact with the mesh, and their distances in spheroid radii.

    A spheroid that touches the surface is moved along the normal until it touches the mesh, by the secant method. The
    distances are computed from the rows, so they are right even if the method did not converge.
    """
    half = spot.half_width()
    shift, before = np.zeros(len(gap)), half * 1e-3
    apart = distances(spot.rows(before), mesh) - 1.0
    for _ in range(_SECANTS):
        gaps = distances(spot.rows(shift), mesh) - 1.0
        slope = np.where(gaps != apart, (shift - before) / np.where(gaps != apart, gaps - apart, 1.0), 0.0)
        before, apart, shift = shift, gaps, shift - gaps * slope
    rows = spot.rows(shift + gap)
    return rows, distances(rows, mesh)


def seen_from(row: Floats, points: Vertices) -> Vertices:
    """Return points (m, 3) relative to a row's centre, in coordinates in which its spheroid is the unit ball."""
    turn = turns_of(row[np.newaxis, 7:])[0]
    return np.asarray((points - row[4:7]) @ turn / row[[2, 2, 3]])


def to_triangles(corners: Floats) -> Floats:
    """Compute the squares of the distances from the origin to triangles (n, 3, 3).

    A distance is the least of those to the three edges, and to the plane if its nearest point lies in the triangle.
    Each of these is, up to rounding, the distance to a point of the triangle.
    """
    edges = corners[:, [1, 2, 0]] - corners
    along = -(corners * edges).sum(axis=2) / (edges**2).sum(axis=2)
    foot = corners + np.clip(along, 0.0, 1.0)[:, :, np.newaxis] * edges
    to_edges = (foot**2).sum(axis=2).min(axis=1)
    normal = np.cross(edges[:, 0], edges[:, 1])
    height = (corners[:, 0] * normal).sum(axis=1)
    sides = (np.cross(edges, -corners) * normal[:, np.newaxis]).sum(axis=2)
    inside = (sides >= 0).all(axis=1)
    return np.asarray(np.where(inside, height**2 / (normal**2).sum(axis=1), to_edges))
