"""The trees of a forest beside its walker: exact positions, gaps, and where Procedure 1 is not stated or errs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.kernel.scene_pairs import positions_beside
from hypcheck.scene.model import SceneModel
from hypcheck.truth.float_filter import lines_for_sizes

Places = Floats
"""Positions of the walker's centre in the scene, (n, 3)."""


@dataclass(frozen=True)
class Trees:
    """The hyperboloids of a scene as columns (m,), and its mover as the walker."""

    scene: SceneModel

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
        return np.array([(-np.inf, np.inf) if height is None else height.ends for height in heights])

    @cached_property
    def _lines(self) -> Floats:
        """K and M of x² + y² > K + M z², a proof of exterior (truth/float_filter.py); inf if λ = α/b gives no proof."""
        bounds = [lines_for_sizes(*map(float, sizes), 0).exterior[:1] for sizes in self.sizes]
        return np.array([bound[0] if bound else (np.inf, 0.0) for bound in bounds])

    @cached_property
    def types(self) -> list[int]:
        """The type of each tree in the paper's Figure 1: 1 if its trunk is at least as wide as the walker, else 2."""
        return [1 if tree.alpha >= self.scene.mover.b else 2 for tree in self.scene.hyperboloids]

    @cached_property
    def outside_regime(self) -> list[str]:
        """The names of the trees outside Procedure 1's regime: (γ/d)² < α/b."""
        mover = self.scene.mover
        return [
            tree.name
            for tree in self.scene.hyperboloids
            if (tree.gamma / mover.d) ** 2 * (1 + 2.0**-40) < tree.alpha / mover.b
        ]

    def ring(self, tree: int, height: float) -> float | None:
        """Return the radius of the ring about a tree for a walker at this height, or None if there is no ring.

        On the ring Δ = 0 although the walker is clear.

        There is a ring only if the walker's centre is at the height of the tree's centre (docs/mathematics.md, "The
        ring").
        """
        alpha, gamma, b, d = map(float, self.sizes[tree])
        a, c = alpha / b, gamma / d
        if height != self.centers[tree, 2] or c * c <= a:
            return None
        return b * math.sqrt((c * c + 1) * (a * a + c * c)) / c

    def offsets(self, at: Places) -> tuple[Floats, Floats, Floats]:
        """Return the walker's centres relative to each tree's centre, rounded; (n, m) each."""
        x, y, z = np.moveaxis(at[:, None, :] - self.centers, 2, 0)
        return x, y, z

    def modelled(self, at: Places) -> Mask:
        """Return a mask of the trees that exist at the height of the walker's centre, (n, m)."""
        level = at[:, None, 2] - self.centers[:, 2]
        return np.asarray((level >= self._heights[:, 0]) & (level <= self._heights[:, 1]))

    def proved_by_line(self, at: Places) -> Mask:
        """Return a mask (n, m) of the trees to which one line proves the walker exterior.

        The proof takes 2 products, 2 sums and a comparison.
        """
        x, y, z = self.offsets(at)
        return np.asarray(x * x + y * y > self._lines[:, 0] + self._lines[:, 1] * (z * z))

    def exterior(self, at: Places) -> Mask:
        """Return a mask of the trees to which the walker is exterior, exactly, (n, m)."""
        n, m = len(at), len(self.sizes)
        places = np.repeat(at, m, axis=0)
        positions = positions_beside(np.tile(self.sizes, (n, 1)), places, np.tile(self.centers, (n, 1)))
        return np.asarray(positions.reshape(n, m) == Position.EXTERIOR)

    def gaps(self, at: Places) -> Floats:
        """Estimate the gap between the walker and each trunk at the walker's height, (n, m). No decision uses it."""
        x, y, z = self.offsets(at)
        alpha, gamma, b, _ = self.sizes.T
        return np.asarray(np.hypot(x, y) - alpha * np.hypot(1.0, z / gamma) - b)
