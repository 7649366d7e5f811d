"""The picture of a scene: exact positions over the half plane (r, z), and where a method in low precision is wrong.

On it one sees the ring: at z = 0, far outside the surface, the discriminant vanishes, and a plain evaluation says
"contact" where nothing is (docs/mathematics.md, "The ring").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hypcheck import judge
from hypcheck.methods.method import Method
from hypcheck.record.lines import Map
from hypcheck.rows import Rows
from hypcheck.truth import batch

LETTERS = {1: "e", 0: "c", -1: "i"}
"""A grid point's letter: exterior, contact, interior; upper case where the method is wrong."""


@dataclass(frozen=True, slots=True)
class Panel:
    """A rectangle of the half plane in metres, with `columns` × `lines` grid points."""

    name: str
    sizes: tuple[float, float, float, float]
    r: tuple[float, float]
    z: tuple[float, float]
    columns: int
    lines: int


TOWER = (2.0, 17.8, 0.25, 0.15)


def tower_panels() -> tuple[Panel, Panel]:
    """The cooling tower and its surroundings, and the neighbourhood of its ring, at r* = b √((c²+1)(a²+c²))/c."""
    alpha, gamma, b, d = TOWER
    a, c = alpha / b, gamma / d
    ring = b * np.sqrt((c * c + 1) * (a * a + c * c)) / c
    whole = Panel("cooling tower", TOWER, (0.0, 34.0), (-17.8, 17.8), 341, 179)
    near = Panel("the ring", TOWER, (ring - 0.03, ring + 0.03), (-0.03, 0.03), 121, 121)
    return whole, near


def draw(panel: Panel, method: Method) -> Map:
    """The record's line about one panel: a text line of letters for each z, from the lowest up."""
    rows = _grid(panel)
    truth = batch.positions(rows)
    wrong = judge.is_wrong(truth, method.answer(rows), method.question)
    letters = np.array([LETTERS[position] for position in truth.tolist()])
    letters[wrong] = np.char.upper(letters[wrong])
    return Map(
        name=panel.name,
        method=method.name,
        sizes=panel.sizes,
        r=panel.r,
        z=panel.z,
        wrong=int(wrong.sum()),
        points=len(rows),
        lines=["".join(line) for line in letters.reshape(panel.lines, panel.columns).tolist()],
    )


def _grid(panel: Panel) -> Rows:
    r = np.linspace(*panel.r, panel.columns)
    z = np.linspace(*panel.z, panel.lines)
    rows = np.zeros((panel.columns * panel.lines, 7))
    rows[:, :4] = panel.sizes
    rows[:, 4] = np.tile(r, panel.lines)
    rows[:, 6] = np.repeat(z, panel.columns)
    return rows
