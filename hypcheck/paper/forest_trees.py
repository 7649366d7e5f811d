"""Many trunks and one walker: Procedure 1 by Table 2, lines that make it needless, and the exact positions.

Table 2 takes out of its loop what the sizes alone decide; here that is done once for each tree. It is asked about the
walker's centre as seen from the tree's: centres are anywhere, and the difference is rounded to float64, like any other
position that a game hands over. The exact positions are those of the exact differences.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hypcheck.casebook.draw import Floats
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.derivation.hoisting import loop_body
from hypcheck.derivation.repaired_formulas import REPAIRED
from hypcheck.kernel.world import offsets
from hypcheck.pairs import Position
from hypcheck.scene.model import Scene
from hypcheck.truth.lines import lines

Mask = NDArray[np.bool_]
Places = Floats
"""Positions of the walker's centre in the scene, (n, 3)."""

PRECISIONS = ("float32", "float64")


@dataclass(frozen=True)
class Trees:
    """The hyperboloids of a scene as columns (m,), and its mover as the walker."""

    scene: Scene

    @cached_property
    def centers(self) -> Floats:
        """The trees' centres, (m, 3)."""
        return np.array([tree.center for tree in self.scene.hyperboloids], dtype=np.float64)

    @cached_property
    def sizes(self) -> Floats:
        """α, γ, b, d of each tree and the walker, (m, 4)."""
        mover = self.scene.mover
        return np.array([(tree.alpha, tree.gamma, mover.b, mover.d) for tree in self.scene.hyperboloids])

    @cached_property
    def _heights(self) -> Floats:
        heights = [tree.height for tree in self.scene.hyperboloids]
        return np.array([(-np.inf, np.inf) if each is None else (each.low, each.high) for each in heights])

    @cached_property
    def _lines(self) -> Floats:
        """K and M of x² + y² > K + M z², which proves exterior (truth/lines.py); inf where λ = α/b is no proof."""
        found = [lines(*map(float, sizes), 0).exterior[:1] for sizes in self.sizes]
        return np.array([each[0] if each else (np.inf, 0.0) for each in found])

    @cached_property
    def types(self) -> list[int]:
        """1 for a trunk at least as wide as the walker, else 2 (the paper's Figure 1)."""
        return [1 if tree.alpha >= self.scene.mover.b else 2 for tree in self.scene.hyperboloids]

    @cached_property
    def outside_regime(self) -> list[str]:
        """The trees that Procedure 1 makes no claim about, by name: (γ/d)² < α/b."""
        mover = self.scene.mover
        return [
            tree.name
            for tree in self.scene.hyperboloids
            if (tree.gamma / mover.d) ** 2 * (1 + 2.0**-40) < tree.alpha / mover.b
        ]

    def ring(self, tree: int, height: float) -> float | None:
        """The radius about a tree where Δ is 0 for a walker at this height that touches nothing; None: there is none.

        Only a walker whose centre is level with the tree's has one (docs/mathematics.md, "The ring").
        """
        alpha, gamma, b, d = map(float, self.sizes[tree])
        a, c = alpha / b, gamma / d
        if height != self.centers[tree, 2] or c * c <= a:
            return None
        return b * math.sqrt((c * c + 1) * (a * a + c * c)) / c

    def offsets(self, at: Places) -> tuple[Floats, Floats, Floats]:
        """The walker's centres from each tree's, rounded; (n, m) each."""
        x, y, z = np.moveaxis(at[:, None, :] - self.centers, 2, 0)
        return x, y, z

    def modelled(self, at: Places) -> Mask:
        """Which trees stand at the height of the walker's centre, (n, m)."""
        level = at[:, None, 2] - self.centers[:, 2]
        return np.asarray((level >= self._heights[:, 0]) & (level <= self._heights[:, 1]))

    def proved_by_line(self, at: Places) -> Mask:
        """Which trees one line proves the walker exterior to, (n, m): two products, two sums and a comparison."""
        x, y, z = self.offsets(at)
        return np.asarray(x * x + y * y > self._lines[:, 0] + self._lines[:, 1] * (z * z))

    def exterior(self, at: Places) -> Mask:
        """Which trees the walker is exterior to, exactly, (n, m)."""
        n, m = len(at), len(self.sizes)
        found = offsets.positions(np.tile(self.sizes, (n, 1)), np.repeat(at, m, axis=0), np.tile(self.centers, (n, 1)))
        return np.asarray(found.reshape(n, m) == Position.EXTERIOR)

    def gaps(self, at: Places) -> Floats:
        """The free way between the walker and each trunk at the walker's height, (n, m); for people, not exact."""
        x, y, z = self.offsets(at)
        alpha, gamma, b, _ = self.sizes.T
        return np.asarray(np.hypot(x, y) - alpha * np.hypot(1.0, z / gamma) - b)


class Procedure1:
    """Table 2 as printed, or Procedure 1 put right, in one format, with the trees' sizes taken out of the loop."""

    def __init__(self, trees: Trees, precision: str, *, repaired: bool = False) -> None:
        columns = dict(zip(("alpha", "gamma", "b", "d"), trees.sizes.T, strict=True))
        self._trees = trees
        formula = REPAIRED["procedure-1-repaired"] if repaired else FORMULAS["table-2"]
        self._body = loop_body(formula.program, float_arithmetic(precision), columns, (formula.answer,))

    def valid(self, at: Places) -> Mask:
        """Which trees allow the movement, (n, m): whether the walker is taken to be exterior to each."""
        (answer,) = self._body(dict(zip("xyz", self._trees.offsets(at), strict=True)))
        return np.asarray(answer)
