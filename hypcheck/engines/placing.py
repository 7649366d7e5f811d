"""Rows at certified distances from contact: the families of the record.

A row is placed from a point P of the hyperboloid and the normal n there: it is the spheroid that touches at P, moved by
`gap` along n. Exact positions of two spheroids about the same centre prove that `gap` is its distance from contact, or
its depth. S is the matrix of the spheroid, h = √(nᵀSn) its half width along n, and g the gap:

- A clear row is at least g from contact: the spheroid of (1 + t) S + (1 + 1/t) g² I with t = g/h contains every point
  within g of the body, since (√(nᵀSn) + g |n|)² ≤ (1 + t) nᵀSn + (1 + 1/t) g² |n|² for all n. It must be clear, too.
- A contact is at least p = −g deep: no move by less than p separates the bodies, since the spheroid with the matrix
  (S − (1 + 1/t) p² I)/(1 + t), t = p/(h − p), and all points within p of it lie in the body. It must be in contact.

Both are sharp at P. The matrices are those of spheroids with the same axis. Rows for which this is not proved, because
the surface is nearer elsewhere, are omitted.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import Floats, Mask, Rows
from hypcheck.kernel.classify import classify
from hypcheck.vectors.draw import Draw

TOWER = (2.0, 17.8)
"""α and γ of the paper's cooling tower in metres: 2 m from its axis to its wall at the waist."""

DECADES = tuple(range(-9, 0))
"""Gaps of a decade k are from 10^k to 10^(k+1) m."""

SLACK, FUZZ = 1e-6, 1e-14
"""A gap is certified up to these parts of it and of α, for the rounding of the centre and of b and d."""


@dataclass(frozen=True, slots=True)
class SpotFamily:
    """A family of rows about one spheroid, whose b and d are in metres; `text` describes it.

    `unit` is the length of one unit of the rows in metres; with `leans` the rows have axes in all directions; with
    `inside` the spheroid is inside the tower.
    """

    name: str
    text: str
    b: float
    d: float
    unit: float = 1.0
    leans: bool = False
    inside: bool = False

    @property
    def sizes(self) -> Sizes:
        """α, γ, b, d in the unit of the rows."""
        alpha, gamma = TOWER
        return alpha / self.unit, gamma / self.unit, self.b / self.unit, self.d / self.unit

    @property
    def millimetres(self) -> float:
        """One unit of length of the rows in millimetres."""
        return self.unit * 1000.0


FAMILIES = {
    family.name: family
    for family in (
        SpotFamily("ball", "a ball of 0.25 m outside the tower", 0.25, 0.25),
        SpotFamily("body", "the paper's quadcopter, 0.25 m by 0.15 m, upright, outside", 0.25, 0.15),
        SpotFamily("leaning", "the same with its axis in any direction", 0.25, 0.15, leans=True),
        SpotFamily("inside", "the same inside the tower", 0.25, 0.15, inside=True),
        SpotFamily("disc", "a flat spheroid, 0.25 m by 0.01 m, upright, outside", 0.25, 0.01),
        SpotFamily("small", "a small one, 5 mm by 3 mm, upright, outside", 0.005, 0.003),
        SpotFamily("millimetres", "family body with all lengths in millimetres", 0.25, 0.15, unit=0.001),
        SpotFamily("kilometres", "family body with all lengths in kilometres", 0.25, 0.15, unit=1000.0),
    )
}


@dataclass(frozen=True, slots=True)
class Spot:
    """Spheroids that touch the surface, with normals (n, 3) towards the spheroids, their axes, and their centres."""

    family: SpotFamily
    normal: Floats
    axis: Floats
    center: Floats

    @classmethod
    def at(cls, family: SpotFamily, azimuth: Floats, height: Floats, axis: Floats) -> Spot:
        """Place spheroids at these azimuths and heights in metres, with these axes (n, 3) of length 1."""
        alpha, gamma, b, d = family.sizes
        z = height / family.unit
        r = alpha * np.hypot(1.0, z / gamma)
        x, y = r * np.cos(azimuth), r * np.sin(azimuth)
        normal = np.stack([x / alpha**2, y / alpha**2, -z / gamma**2], axis=1) * (-1 if family.inside else 1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        along = (normal * axis).sum(axis=1, keepdims=True)
        pushed = b * b * (normal - along * axis) + d * d * along * axis
        half = np.sqrt((normal * pushed).sum(axis=1, keepdims=True))
        return cls(family, normal, axis, np.stack([x, y, z], axis=1) + pushed / half)

    def half_width(self) -> Floats:
        """Return the spheroids' half widths along the normals, (n,)."""
        _, _, b, d = self.family.sizes
        along = (self.normal * self.axis).sum(axis=1)
        return np.asarray(np.sqrt(b * b * (1 - along**2) + d * d * along**2))

    def rows(self, gap: Floats) -> Rows:
        """Return rows (n, 10) of the spheroids moved by these gaps along the normals, in the unit of the rows."""
        sizes = np.tile(self.family.sizes, (len(gap), 1))
        return np.hstack([sizes, self.center + gap[:, np.newaxis] * self.normal, self.axis])

    def certifies(self, gap: Floats) -> Mask:
        """Decide for each gap whether it is proved to be the distance to the other answer, up to SLACK and FUZZ."""
        rows, half = self.rows(gap), self.half_width()
        size = np.abs(gap) * (1 - SLACK) - FUZZ * rows[:, 0]
        grown = size**2 + half * size
        with np.errstate(invalid="ignore"):
            squares = np.where(
                (gap > 0)[:, np.newaxis],
                rows[:, 2:4] ** 2 * (1 + size / half)[:, np.newaxis] + grown[:, np.newaxis],
                (rows[:, 2:4] ** 2 - (half * size)[:, np.newaxis]) * (1 - size / half)[:, np.newaxis],
            )
        good = np.asarray((size > 0) & (squares > 0).all(axis=1) & ((gap > 0) | (size < half)))
        other = rows.copy()
        other[:, 2:4] = np.sqrt(np.where(good[:, np.newaxis], squares, 1.0))
        wanted = np.where(gap < 0, 0, -1 if self.family.inside else 1)
        return np.asarray(good & (classify(other) == wanted) & (classify(rows) == wanted))


@dataclass(frozen=True, slots=True)
class Placed:
    """Rows (n, 10) of a family: each is proved to be clear by `gap` > 0, or in contact with the depth −`gap` > 0."""

    family: SpotFamily
    rows: Rows
    gap: Floats

    @property
    def contact(self) -> Mask:
        """A mask of the rows in contact."""
        return np.asarray(self.gap < 0)


def placed(family: SpotFamily, count: int, seed: int = 1) -> Placed:
    """Place up to `count` clear rows and `count` contacts in every decade; rows that are not certified are omitted."""
    spot, gap = drawn(family, count, seed)
    good = spot.certifies(gap)
    return Placed(family, spot.rows(gap)[good], gap[good])


def drawn(family: SpotFamily, count: int, seed: int = 1) -> tuple[Spot, Floats]:
    """Draw spots all over the surface, and `count` gaps of each sign in every decade, in the unit of the rows."""
    n = 2 * count * len(DECADES)
    draw = Draw("engines", family.name, 1, seed)
    decade = np.repeat(np.array(DECADES, dtype=np.float64), 2 * count)
    gap = 10.0 ** (decade + draw.unit(n)) * np.where(np.arange(n) % 2 == 0, 1.0, -1.0)
    spot = Spot.at(family, 2 * pi * draw.unit(n), (1.6 * draw.unit(n) - 0.8) * TOWER[1], _axes(family, draw, n))
    return spot, gap / family.unit


def _axes(family: SpotFamily, draw: Draw, n: int) -> Floats:
    """Draw the axes (n, 3) of spheroids, of length 1: vertical, or uniform over all directions if the family leans."""
    if not family.leans:
        return np.tile([0.0, 0.0, 1.0], (n, 1))
    up, around = 2 * draw.unit(n) - 1, 2 * pi * draw.unit(n)
    level = np.sqrt(1 - up * up)
    return np.stack([level * np.cos(around), level * np.sin(around), up], axis=1)
