"""What engines are given: the hyperboloid's mesh, points on the spheroid, and how far a body is from that mesh.

A scene is a folder of three files: sizes.txt (α γ b d), surface.off (the mesh, inscribed in the surface) and body.off
(points on the spheroid). The mesh is that of implementations/meshes.py, whose deviation from the surface has a bound.

A mesh is decided as the surface is: the spheroid touches it exactly if, in spheroid radii, the mesh is not farther
than 1 from the centre. That distance is the least of the distances to triangles, computed here with numpy alone, and
by none of the engines. So an engine's error divides: what its mesh explains, and what it does wrong with the mesh.
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
"""The three resolutions of the mesh, about."""

_RINGS, _AROUND = 11, 20

_SECANTS = 4


def ball_points() -> Vertices:
    """Points of the unit sphere: poles and rings, the equator too; 222, as some engines take 256 at most."""
    rings = [pi * (k + 1) / (_RINGS + 1) for k in range(_RINGS)]
    turns = [2 * pi * k / _AROUND for k in range(_AROUND)]
    around = [(sin(p) * cos(t), sin(p) * sin(t), cos(p)) for p in rings for t in turns]
    return np.array([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), *around])


HULL = cos(pi / (2 * (_RINGS + 1))) * cos(pi / _AROUND)
"""The hull of these points holds the ball of this radius. It holds, in each ring's plane, the disc of cos(π/20) times
the ring's radius; so it holds the body of revolution of the meridian's polygon, narrowed by that factor; and the
polygon, whose corners are π/12 apart, holds the disc of radius cos(π/24)."""


@dataclass(frozen=True)
class SurfaceMesh:
    """A mesh of the surface; `deviation` bounds how far it is from the surface, in the unit of its vertices."""

    vertices: Vertices
    triangles: Triangles
    deviation: float

    @cached_property
    def middles(self) -> Vertices:
        """The middles of the triangles."""
        return np.asarray(self.vertices[self.triangles].mean(axis=1))

    @cached_property
    def radii(self) -> Floats:
        """How far the corners of the triangles are from their middles at most."""
        apart = self.vertices[self.triangles] - self.middles[:, np.newaxis]
        return np.asarray(np.linalg.norm(apart, axis=2).max(axis=1))


def surface_mesh(sizes: Sizes, triangles: int) -> SurfaceMesh:
    """The inscribed mesh of the whole tower, from −γ to γ, with about so many triangles."""
    alpha, gamma, _, _ = sizes
    grid = grid_of(alpha, gamma, gamma, triangles)
    return SurfaceMesh(*grid.mesh(), grid.deviation)


def write_scene(folder: Path, sizes: Sizes, mesh: SurfaceMesh) -> None:
    """Write the files of a scene."""
    folder.mkdir(parents=True, exist_ok=True)
    _, _, b, d = sizes
    (folder / "sizes.txt").write_text(" ".join(map(repr, sizes)) + "\n")
    (folder / "surface.off").write_text(_off(mesh.vertices, mesh.triangles))
    (folder / "body.off").write_text(_off(ball_points() * [b, b, d], np.empty((0, 3), dtype=np.int64)))


def _off(vertices: Vertices, triangles: Triangles) -> str:
    lines = [" ".join(map(repr, vertex)) for vertex in vertices.tolist()]
    lines += [f"3 {i} {j} {k}" for i, j, k in triangles.tolist()]
    return f"OFF\n{len(vertices)} {len(triangles)} 0\n" + "\n".join(lines) + "\n"


def distances(rows: Rows, mesh: SurfaceMesh) -> Floats:
    """The distances (n,) of the centres of rows (n, 10) from a mesh, each in radii of its own spheroid."""
    return np.array([_distance(row, mesh) for row in rows])


def _distance(row: Floats, mesh: SurfaceMesh) -> float:
    """The distance of a row's centre from the mesh, in spheroid radii.

    Some triangle's middle is `reach` radii away; so what is nearest is no farther, which is reach times the longer
    semi-axis at most, and its triangle's middle is no farther than that and the triangle's own size.
    """
    reach = float(np.linalg.norm(seen_from(row, mesh.middles), axis=1).min())
    away = np.linalg.norm(mesh.middles - row[4:7], axis=1)
    near = np.flatnonzero(away <= 1.001 * (reach * max(row[2], row[3]) + mesh.radii))
    squares = to_triangles(seen_from(row, mesh.vertices[mesh.triangles[near]].reshape(-1, 3)).reshape(-1, 3, 3))
    return float(np.sqrt(squares.min()))


def rows_near(spot: Spot, gap: Floats, mesh: SurfaceMesh) -> tuple[Rows, Floats]:
    """Rows (n, 10) about these gaps from contact with the mesh itself, and how far they are from it in spheroid radii.

    What touches the surface is moved along its normal until it touches the mesh, by the secant method. The distances
    are those of the rows, whatever it came to.
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
    """Points (m, 3) relative to a row's centre, in radii of its spheroid: it is the unit ball there."""
    turn = turns_of(row[np.newaxis, 7:])[0]
    return np.asarray((points - row[4:7]) @ turn / row[[2, 2, 3]])


def to_triangles(corners: Floats) -> Floats:
    """Squares of the distances from the origin to triangles (n, 3, 3): to their edges, or to the plane if it is nearer.

    Each is a distance to a point of the triangle, up to rounding, and the least of them is to the nearest one.
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
