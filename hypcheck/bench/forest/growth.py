"""Forests of any number of trees at one density, a walker's way through each, and the truth about every step of it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.world.scene import Scene
from hypcheck.pairs import Lengths, Position, to_integers
from hypcheck.scene.model import Hyperboloid, Mover, Region, Span
from hypcheck.scene.model import Scene as SceneModel
from hypcheck.truth import exact

ROOM = 25.0
"""Square metres for each tree."""

KINDS = tuple((alpha, gamma) for alpha in (0.61, 0.52, 0.45, 0.38, 0.27, 0.2, 0.14, 0.08) for gamma in (6.0, 28.0))
"""α and γ of the trees, in metres: half of them wider than the walker, half narrower (section 3.1 of the paper)."""

WALKER = Mover(0.3, 0.9)
STEP, REFUSED_TURN, LARGEST_TURN = 0.25, 60.0, 15.0
"""How the walker goes: metres, and degrees."""

LOOK = 3.0
"""Metres beyond which no tree of KINDS and no walker touch: the widest trunk is below 0.7 m at her height."""

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Forest:
    """Trees at `places` (n, 2), of the kinds that `kinds` (n,) number, on a square with sides of `side` metres."""

    side: float
    places: NDArray[np.float64]
    kinds: NDArray[np.int64]

    @cached_property
    def model(self) -> SceneModel:
        """The forest as a scene that asks whether the walker is clear of it, on a plain."""
        pairs = zip(self.kinds.tolist(), self.places.tolist(), strict=True)
        trees = tuple(_tree(number, kind, (x, y)) for number, (kind, (x, y)) in enumerate(pairs, start=1))
        return SceneModel("forest", "exterior", trees, WALKER, Region(z=Span(0.0, 0.0)))

    def clear(self, centre: Point) -> bool:
        """The truth, from rational arithmetic, about every tree that is not metres away."""
        x, y, _ = centre
        near = np.flatnonzero(np.hypot(self.places[:, 0] - x, self.places[:, 1] - y) < LOOK)
        return all(self._beside(index, centre) is Position.EXTERIOR for index in near.tolist())

    def _beside(self, index: int, centre: Point) -> Position:
        alpha, gamma = KINDS[int(self.kinds[index])]
        there = self.places[index].tolist()
        x, y = (Fraction(here) - Fraction(tree) for here, tree in zip(centre[:2], there, strict=True))
        radial = to_integers((alpha, WALKER.b, x, y))
        axial = to_integers((gamma, WALKER.d, centre[2]))
        return exact.position(Lengths(radial[0], radial[1], radial[2], radial[3], *axial))


def _tree(number: int, kind: int, place: tuple[float, float]) -> Hyperboloid:
    alpha, gamma = KINDS[kind]
    return Hyperboloid(f"tree {number}", alpha, gamma, (*place, 0.0), Span(-0.9, 5.0))


def forest_of(trees: int, seed: int) -> Forest:
    """So many trees, uniform on a square."""
    draw = np.random.Generator(np.random.PCG64([seed, trees]))
    side = float(np.sqrt(ROOM * trees))
    return Forest(side, side * draw.random((trees, 2)), draw.integers(0, len(KINDS), trees))


def walk(scene: Scene, forest: Forest, steps: int, seed: int) -> list[Point]:
    """The centres that a walker asks about: each a step from where she is, taken where it is clear."""
    draw = np.random.Generator(np.random.PCG64([seed, steps]))
    x = y = forest.side / 2
    heading, asked = 0.0, []
    for turn, side in draw.random((steps, 2)).tolist():
        to_x = x + STEP * float(np.cos(np.deg2rad(heading)))
        to_y = y + STEP * float(np.sin(np.deg2rad(heading)))
        asked.append((to_x, to_y, 0.0))
        if 0 < to_x < forest.side and 0 < to_y < forest.side and scene.position(to_x, to_y, 0.0) == 1:
            x, y = to_x, to_y
            heading += LARGEST_TURN * (2 * turn - 1)
        else:
            heading += REFUSED_TURN if side < 0.5 else -REFUSED_TURN
    return asked
