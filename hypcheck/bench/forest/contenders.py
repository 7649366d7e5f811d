"""Who is asked about a step: our scene, and FCL's tree of bounding boxes, the forest's trees meshes or cylinders."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import hypot
from types import MappingProxyType
from typing import Any

import numpy as np

from hypcheck.bench.forest.growth import KINDS, WALKER, Forest, Point
from hypcheck.errors import UnavailableError
from hypcheck.kernel.world.scene import Scene
from hypcheck.methods.engines import FCL
from hypcheck.methods.scene_mesh import grid_of

Clear = Callable[[float, float, float], int]
"""1 where the walker is clear of every tree, else 0."""

TRIANGLES = 128
HEIGHT = 1.2 * WALKER.d
"""Up to where a tree's mesh reaches, both ways: beyond the walker's head and feet."""


@dataclass(frozen=True)
class Walker:
    """Something that is asked about steps. `make` builds what it needs for a forest and answers from then on."""

    title: str
    triangles: int | None
    make: Callable[[Forest], Clear]


def _scene(forest: Forest) -> Clear:
    scene = Scene(forest.model)
    scene.position(0.0, 0.0, 0.0)  # which prepares it
    return scene.position


def _meshes() -> list[Any]:
    """A mesh of each kind, which all trees of that kind share."""
    import fcl  # noqa: PLC0415

    found = []
    for alpha, gamma in KINDS:
        vertices, triangles = grid_of(alpha, gamma, HEIGHT, TRIANGLES).mesh()
        mesh = fcl.BVHModel()
        mesh.beginModel(len(triangles), len(vertices))
        mesh.addSubModel(vertices, triangles)
        if mesh.endModel() != 0:
            raise UnavailableError("FCL refuses the mesh of a tree")
        found.append(mesh)
    return found


def _cylinders() -> list[Any]:
    """The least upright cylinder around the part of each kind that the walker can reach."""
    import fcl  # noqa: PLC0415

    return [fcl.Cylinder(alpha * hypot(1.0, WALKER.d / gamma), 2 * HEIGHT) for alpha, gamma in KINDS]


def _by_fcl(shapes: Callable[[], list[Any]]) -> Callable[[Forest], Clear]:
    def make(forest: Forest) -> Clear:
        import fcl  # noqa: PLC0415

        kinds = shapes()
        trees = [
            fcl.CollisionObject(kinds[kind], fcl.Transform(np.array([x, y, 0.0])))
            for kind, (x, y) in zip(forest.kinds.tolist(), forest.places.tolist(), strict=True)
        ]
        manager = fcl.DynamicAABBTreeCollisionManager()
        manager.registerObjects(trees)
        manager.setup()
        walker = fcl.CollisionObject(fcl.Ellipsoid(WALKER.b, WALKER.b, WALKER.d))

        def clear(x: float, y: float, z: float, _kept: Any = (kinds, trees)) -> int:  # noqa: ANN401
            walker.setTranslation(np.array([x, y, z]))
            found = fcl.CollisionData()  # results are not reset between calls
            manager.collide(walker, found, fcl.defaultCollisionCallback)
            return int(not found.result.is_collision)

        return clear

    return make


OURS = "hypcheck.Scene"
WALKERS: Mapping[str, Walker] = MappingProxyType(
    {
        OURS: Walker("a grid of cells, then exact decisions", None, _scene),
        "fcl-meshes": Walker(
            f"FCL: DynamicAABBTreeCollisionManager, trees as meshes of about {TRIANGLES} triangles, one for each of "
            f"{len(KINDS)} kinds; an Ellipsoid walks",
            TRIANGLES,
            _by_fcl(_meshes),
        ),
        "fcl-cylinders": Walker("FCL: the same with a bounding cylinder for each tree", None, _by_fcl(_cylinders)),
    }
)


def here() -> dict[str, Walker]:
    """Those that can be asked here; FCL may be missing."""
    return {name: each for name, each in WALKERS.items() if name == OURS or FCL.trouble() is None}


def answers(clear: Clear, centres: list[Point]) -> list[int]:
    """What it says of each centre."""
    return [clear(*centre) for centre in centres]
