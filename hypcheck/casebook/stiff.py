"""Long ratios: α/b, γ/d or both from 2¹⁰ to 2⁴⁰, about 1e3 to 1e12."""

from __future__ import annotations

import numpy as np

from hypcheck.casebook.draw import Draw, Floats, Maker, exponent, ldexp, turns
from hypcheck.casebook.family import Family
from hypcheck.casebook.placing import Sizes, beside, heights, offsets
from hypcheck.rows import Rows

RATIOS = (10, 40)
"""Exponents of 2. Ratios beyond 1e8 are outside the domain that an implementation has unless it declares more."""

PLAIN = (-2, 6)


def stiff(*, radial: bool, axial: bool) -> Maker:
    """Log-uniform ratios, half of the centres within 2.5 radii of the surface, half one radius and a hair off it."""

    def make(draw: Draw, n: int) -> Rows:
        a = draw.log_uniform(n, *(RATIOS if radial else PLAIN))
        c = draw.log_uniform(n, *(RATIOS if axial else PLAIN))
        (alpha, b), (gamma, d) = _split(draw, a), _split(draw, c)
        hair = 1 + draw.signs(n) * draw.log_uniform(n, -30, -3)
        offset = np.where(turns(n, True, False), offsets(draw, n), draw.signs(n) * hair)
        return beside(draw, Sizes(alpha, gamma, b, d), heights(draw, c), offset)

    return make


def _split(draw: Draw, ratio: Floats) -> tuple[Floats, Floats]:
    """Two lengths of this ratio, as far from 1 metre one as the other."""
    short = ldexp(draw.log_uniform(len(ratio), -1, 1), -(exponent(ratio) // 2))
    return ratio * short, short


FAMILIES = (
    Family(
        name="stiff-radial",
        version=1,
        title="α/b from 1e3 to 1e12",
        source="α/b log-uniform, γ/d in [1/4, 64)",
        purpose="A towers over every other term, and the surface is all but two planes with a slit between them",
        game="a bullet in the slit between two discs as wide as the world passes through them, or stops in mid-air",
        drone="a small drone between two wide canopies is told that both are far away",
        regimes="a > 1, c² < a for most",
        make=stiff(radial=True, axial=False),
    ),
    Family(
        name="stiff-axial",
        version=1,
        title="γ/d from 1e3 to 1e12",
        source="γ/d log-uniform, α/b in [1/4, 64)",
        purpose="B towers over every other term: the surface is a cylinder until z is very large",
        game="a flat disc slides along an endless pipe and its wall moves with the height",
        drone="a flat drone in a tall chimney, where c² multiplies every rounding of r",
        regimes="a on both sides of 1, c² > a",
        make=stiff(radial=False, axial=True),
    ),
    Family(
        name="stiff-both",
        version=1,
        title="α/b and γ/d from 1e3 to 1e12",
        source="both log-uniform, and independent of each other",
        purpose="Δ has degree 12: float32 overflows for a 30 m tower and a drone of 1 cm, float64 beyond 1e25",
        game="a pebble that falls on a moon is told that it lies on it already, or never will",
        drone="a real tower and a real small drone: an autopilot that computes in float32 refuses every flight",
        regimes="a > 1, c² on both sides of a",
        make=stiff(radial=True, axial=True),
    ),
)
