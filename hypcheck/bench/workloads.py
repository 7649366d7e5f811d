"""The rows on which methods are compared: three workloads that are timed, and three strata whose answers are judged.

Every workload's rows depend on its name, the seed and the place alone, and a shorter call gives the beginning of a
longer one (casebook/draw.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hypcheck.casebook.draw import Draw, in_turn
from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.family import BLOCK
from hypcheck.casebook.placing import Sizes, beside_surface, centred
from hypcheck.casebook.scenes import BODY, ROTOR, TOWER
from hypcheck.rows import Rows

NEAR_SCENES = (
    (*TOWER, *BODY),
    (*TOWER, *ROTOR),
    (0.6, 3.0, 0.35, 0.85),  # a trunk wider than the walker
    (0.2, 2.0, 0.35, 0.9),  # a trunk narrower than the walker
    (30.0, 65.0, 0.01, 0.01),  # a large tower and a 1 cm drone: where Δ overflows in float32
    (5.0, 2.0, 1.0, 1.0),  # (γ/d)² < α/b: outside the regime of the paper's Proposition 3
)
"""α, γ, b, d of the pairs of bodies that the workload near contact takes in turn."""

GAPS = (-57, -2)
"""Distances from contact, in spheroid radii, are m 2^e with 1 ≤ m < 2 and e of this range: 1e-17 to 0.5."""


@dataclass(frozen=True)
class Workload:
    """`rows(seed, n)` are n of its rows, float64 (n, 7). `timed`: methods are timed on it, not only judged."""

    name: str
    title: str
    text: str
    rows: Callable[[int, int], Rows]
    timed: bool = True

    def scene(self, rows: Rows) -> tuple[float, float, float, float] | None:
        """The sizes that all these rows share, or None where they differ."""
        return scene_of(rows)


def scene_of(rows: Rows) -> tuple[float, float, float, float] | None:
    """α, γ, b, d where all rows share them."""
    if not len(rows) or (rows[:, :4] != rows[0, :4]).any():
        return None
    alpha, gamma, b, d = rows[0, :4].tolist()
    return alpha, gamma, b, d


def near_contact(seed: int, count: int) -> Rows:
    """Centres near touching, in the scenes of NEAR_SCENES in turn."""
    scenes, numbers = np.array(NEAR_SCENES), range(-(-count // BLOCK))
    turns = ((number * BLOCK + np.arange(BLOCK)) % len(scenes) for number in numbers)
    blocks = [
        near(Draw("bench-near-contact", 1, seed, number), Sizes(*scenes[turn].T), GAPS)
        for number, turn in zip(numbers, turns, strict=True)
    ]
    return np.concatenate([np.empty((0, 7)), *blocks])[:count]


def near(draw: Draw, size: Sizes, gaps: tuple[int, int]) -> Rows:
    """Centres one radius from the surface and a gap of m 2^e more or less, e in the range `gaps`, on either side."""
    n = len(size.b)
    near_the_waist = draw.words(n) >> np.uint64(63) == 0
    height = draw.unit(n) * np.where(near_the_waist, np.minimum(size.c, 8.0), size.c)
    gap = draw.signs(n) * draw.log_uniform(n, *gaps)
    # Inside, a ball touches a throat that is wider than itself alone.
    side = np.where(size.a >= 1, draw.signs(n), 1.0)
    return centred(draw, size, *beside_surface(size.a, size.c, height, side * (1 + gap)))


def _mixed(*names: str) -> Callable[[int, int], Rows]:
    """Rows of several families in turn."""
    make = in_turn(*(FAMILIES[name].make for name in names))

    def rows(seed: int, count: int) -> Rows:
        blocks = [make(Draw("bench", *names, 1, seed, number), BLOCK) for number in range(-(-count // BLOCK))]
        return np.concatenate([np.empty((0, 7)), *blocks])[:count]

    return rows


WORKLOADS = {
    workload.name: workload
    for workload in (
        Workload(
            "uniform",
            "uniform around the tower",
            "A quadcopter's body, uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m about the paper's cooling tower.",
            FAMILIES["tower-body"].rows,
        ),
        Workload(
            "flight",
            "along random flights",
            "Positions asked for along the paper's random flights in the tower, 32 consecutive rows a flight, so that "
            "neighbours resemble each other.",
            FAMILIES["flight"].rows,
        ),
        Workload(
            "near-contact",
            "near contact",
            "Six pairs of bodies in turn, at distances from touching that are log-uniform from 1e-17 to 0.5 spheroid "
            "radii, apart and overlapping, outside and inside; sizes differ from row to row.",
            near_contact,
        ),
        Workload(
            "ring",
            "on the ring and next to it",
            "Half clear positions where Δ = 0 exactly, half within 1e-12 to 1e-2 radii of such (docs/mathematics.md).",
            _mixed("ring", "ring-neighbourhood"),
            timed=False,
        ),
        Workload(
            "zero-coefficient",
            "where c1 or c2 is 0",
            "Positions at which one of the coefficients vanishes exactly, which the paper's Proposition 5 forgets.",
            FAMILIES["coefficient-zero"].rows,
            timed=False,
        ),
        Workload(
            "ladder",
            "a ladder of ulps beside tangency",
            "Exact tangencies of many sizes with one length moved by 1, 2, 4 … 2⁴⁰ ulp, both ways.",
            FAMILIES["tangent-ladder"].rows,
            timed=False,
        ),
    )
}
"""By name, in the order of the record."""
