"""Where to look first: thin sets of rows on which an argument about the pair changes its case.

Each family of the casebook is one: tangencies and other double roots (Δ = 0), the ring, vanishing coefficients, the
axis, the waist, the borders of the regimes, long ratios. To these come the crossings of four surfaces, z = 0, r = 0,
a = 1 and c² = a, with one another and with the border of contact: on them exactly, and a hair beside.

Whoever was made for given sizes is asked the families that are made for these, and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from hypcheck.casebook.draw import Draw, Floats, ldexp
from hypcheck.casebook.families import FAMILIES
from hypcheck.casebook.family import Family
from hypcheck.casebook.fixed_sizes import families_for
from hypcheck.casebook.placing import Sizes, centred, heights, offsets
from hypcheck.hunt.border import beside_border
from hypcheck.ranges import FixedSizes
from hypcheck.rows import Rows

SURFACES = {
    "z = 0": ("height",),
    "r = 0": ("radius",),
    "a = 1": ("alpha",),
    "c² = a": ("alpha",),
}
"""The four surfaces, and what cannot be moved without leaving each."""

CROSSING_BLOCK = 96
"""Rows of a crossing made at a time: coming to the border costs more than a question."""

VERSION = 1
"""Of the crossings' generator: part of its seed."""


@dataclass(frozen=True, slots=True)
class Stratum:
    """A set of rows: `rows(seed, number)` is its block of some rows with that number, all valid."""

    name: str
    rows: Callable[[int, int], Rows]


def strata(settings: tuple[FixedSizes, ...] = ()) -> tuple[Stratum, ...]:
    """All strata, the casebook's families first; where there are given sizes alone, the families made for them."""
    if settings:
        return tuple(map(_of_family, families_for(settings)))
    crossings = [names for size in (1, 2, 3) for names in combinations(SURFACES, size) if _movers(names)]
    return (*map(_of_family, FAMILIES.values()), *map(_of_crossing, crossings))


def _of_family(family: Family) -> Stratum:
    return Stratum(f"the family {family.name}", family.block)


def _of_crossing(surfaces: tuple[str, ...]) -> Stratum:
    name = f"contact beside {' and '.join(surfaces)}"
    return Stratum(name, lambda seed, number: crossing(Draw(name, VERSION, seed, number), CROSSING_BLOCK, surfaces))


def crossing(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Rows:
    """At most n rows on, or a hair beside, these surfaces, each a random way off the border of contact."""
    size = _sizes(draw, n, surfaces)
    height = heights(draw, size.c) * _slack(draw, n, pinned="z = 0" in surfaces)
    radius = np.abs(size.a + offsets(draw, n)) * _slack(draw, n, pinned="r = 0" in surfaces)
    rows = centred(draw, size, radius, height)
    movers = np.asarray(_movers(surfaces))
    return beside_border(draw, rows, movers[draw.integers(n, 0, len(movers) - 1)])


def _slack(draw: Draw, n: int, *, pinned: bool) -> Floats:
    """What a distance is multiplied by: 1, or if it is to vanish 0 and 2⁻⁵⁰ … 2⁻³ by turns."""
    if not pinned:
        return np.ones(n)
    return np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -50, -3))


def _sizes(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Sizes:
    """Sizes of every regime; α = b, and α/b and γ/d the square of and the fraction itself, exactly or all but."""
    top, bottom = np.floor(draw.log_uniform(n, 0, 12)), np.floor(draw.log_uniform(n, 0, 12))
    if "a = 1" in surfaces:
        top = bottom
    units = ldexp(1, draw.integers(n, -14, -10)), ldexp(1, draw.integers(n, -10, -6))
    b, d = bottom * bottom * units[0], bottom * units[1]
    alpha = top * top * units[0] * _nearly_one(draw, n)
    if "c² = a" in surfaces:
        return Sizes(alpha, top * units[1] * _nearly_one(draw, n), b, d)
    return Sizes(alpha, d * draw.log_uniform(n, -8, 10), b, d)


def _nearly_one(draw: Draw, n: int) -> Floats:
    """1, or 1 ± 2⁻⁵² … 2⁻³, by turns."""
    return np.asarray(1 + draw.signs(n) * np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -52, -3)))


def _movers(surfaces: tuple[str, ...]) -> list[str]:
    """What can be moved to come to the border without leaving these surfaces."""
    kept = {mover for surface in surfaces for mover in SURFACES[surface]}
    return [mover for mover in ("radius", "height", "alpha") if mover not in kept]
