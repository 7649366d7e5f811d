"""The hyperboloids of a scene as columns, and the heights in which they stand."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.world.sums import two_sum
from hypcheck.scene.model import Hyperboloid

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Bodies:
    """α and γ (m, 2), centres (m, 3), and how far from its centre each is modelled, up or down, (m,).

    `heights` (m, 2) are the lowest and the highest float z of the scene that is within the modelled height, exactly.
    """

    shapes: Floats
    origins: Floats
    tall: Floats
    heights: Floats


def bodies_of(hyperboloids: Sequence[Hyperboloid]) -> Bodies:
    """The columns of these hyperboloids."""
    table = np.fromiter((number for body in hyperboloids for number in _numbers(body)), np.float64).reshape(-1, 7)
    origins, relative = table[:, 2:5], table[:, 5:]
    with np.errstate(all="ignore"):
        ends, lost = two_sum(origins[:, 2:], relative)
    low = np.where(lost[:, 0] > 0, np.nextafter(ends[:, 0], inf), ends[:, 0])
    high = np.where(lost[:, 1] < 0, np.nextafter(ends[:, 1], -inf), ends[:, 1])
    return Bodies(table[:, :2], origins, np.abs(relative).max(axis=1), np.stack([low, high], axis=1))


def _numbers(body: Hyperboloid) -> tuple[float, ...]:
    low, high = (-inf, inf) if body.height is None else (body.height.low, body.height.high)
    return (body.alpha, body.gamma, *body.center, low, high)


@dataclass(frozen=True)
class Levels:
    """The heights in which some hyperboloid stands: disjoint spans of z, from the lowest up."""

    starts: list[float]
    ends: list[float]

    def hold(self, z: float) -> bool:
        """Whether some hyperboloid is modelled at this height."""
        place = bisect_right(self.starts, z) - 1
        return place >= 0 and z <= self.ends[place]

    def hold_each(self, z: Floats) -> NDArray[np.bool_]:
        """The same of many heights, (n,)."""
        place = np.searchsorted(np.array(self.starts), z, side="right") - 1
        return np.asarray((place >= 0) & (z <= np.append(self.ends, -inf)[place]))


def levels_of(heights: Floats) -> Levels:
    """The union of spans (m, 2)."""
    spans = heights[heights[:, 0] <= heights[:, 1]]
    spans = spans[np.argsort(spans[:, 0])]
    top = np.maximum.accumulate(spans[:, 1]) if len(spans) else spans[:, 1]
    begins = np.append(True, spans[1:, 0] > top[:-1])[: len(spans)]
    closes = np.append(begins[1:], True)[: len(spans)]
    return Levels(spans[begins, 0].tolist(), top[closes].tolist())
