"""Ranges of ratios and of lengths: those that everybody is asked about, and which rows lie in given ones."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.rows import Rows

Range = tuple[float, float]

ORDINARY_RATIO: Range = (1e-8, 1e8)
ORDINARY_MAGNITUDE: Range = (1e-6, 1e6)
"""What an implementation is judged on that declares no ranges: insects to islands in metres, and any two of them."""

UNBOUNDED: Range = (0.0, math.inf)


def within(rows: Rows, ratio: Range = ORDINARY_RATIO, magnitude: Range = ORDINARY_MAGNITUDE) -> NDArray[np.bool_]:
    """A mask (n,) of the rows with α/b and γ/d in `ratio` and lengths in `magnitude`, bounds included.

    The least magnitude is one of semi-axes: a coordinate may be as near to 0 as it likes, for a centre close to the
    axis or to the waist is nothing out of the ordinary.
    """
    alpha, gamma, b, d = rows[:, :4].T
    with np.errstate(over="ignore", under="ignore"):
        ratios = np.stack([alpha / b, gamma / d], axis=1)
    inside = ((ratios >= ratio[0]) & (ratios <= ratio[1])).all(axis=1)
    inside &= (rows[:, :4] >= magnitude[0]).all(axis=1) & (np.abs(rows) <= magnitude[1]).all(axis=1)
    return np.asarray(inside)


@dataclass(frozen=True, slots=True)
class FixedSizes:
    """Rows of one spheroid beside one hyperboloid: α, γ, b, d, and the spans of x, y, z; None is any, bounds belong."""

    sizes: tuple[float, float, float, float]
    x: Range | None = None
    y: Range | None = None
    z: Range | None = None

    @property
    def spans(self) -> tuple[Range | None, Range | None, Range | None]:
        """The spans in order."""
        return self.x, self.y, self.z

    def holds(self, rows: Rows) -> NDArray[np.bool_]:
        """A mask (n,) of the rows with these sizes and the centre in the spans."""
        inside = (rows[:, :4] == self.sizes).all(axis=1)
        for column, span in zip(rows[:, 4:].T, self.spans, strict=True):
            if span is not None:
                inside &= (column >= span[0]) & (column <= span[1])
        return np.asarray(inside)
