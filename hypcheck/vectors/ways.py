"""Families of ways between two positions of an upright spheroid: rows of ten numbers, as pair.WAY_COLUMNS has them."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import WAYS, Floats, Rows
from hypcheck.vectors.draw import Draw, turns
from hypcheck.vectors.family import Family


def _sizes(draw: Draw, n: int) -> tuple[Floats, Floats, Floats, Floats]:
    """α, γ, b, d: the hyperboloid's from 1 to 32, the spheroid's up to twice as large and down to 1/256 of it."""
    alpha, gamma = draw.log_uniform(n, 0, 5), draw.log_uniform(n, 0, 5)
    return alpha, gamma, alpha * draw.log_uniform(n, -8, 1), gamma * draw.log_uniform(n, -8, 1)


def anywhere(draw: Draw, n: int) -> Rows:
    """Both ends uniform in a box about the waist."""
    alpha, gamma, b, d = _sizes(draw, n)
    across, along = 2 * (alpha + b), 2 * (gamma + d)
    ends = [draw.between(n, -reach, reach) for _ in range(2) for reach in (across, across, along)]
    return np.stack([alpha, gamma, b, d, *ends], axis=1)


def tunnelling(draw: Draw, n: int) -> Rows:
    """Straight through the wall from outside to inside, or through the whole waist from one side to the other."""
    alpha, gamma, b, d = _sizes(draw, n)
    b, d = np.minimum(b, alpha / 8), np.minimum(d, gamma / 8)
    cosine, sine = draw.circle(n)
    aside = draw.between(n, -0.5, 0.5) * alpha
    far = alpha * draw.between(n, 1.5, 4.0) + 2 * b
    near = turns(n, 0.0, -1.0) * alpha * draw.between(n, 1.5, 4.0)
    z0, z1 = (gamma * draw.between(n, -0.5, 0.5) for _ in range(2))
    start = (far * cosine - aside * sine, far * sine + aside * cosine, z0)
    end = (near * cosine - aside * sine, near * sine + aside * cosine, z1)
    return np.stack([alpha, gamma, b, d, *start, *end], axis=1) + 0.0


WAY_FAMILIES = (
    Family(
        name="way-anywhere",
        version=1,
        title="ways from anywhere to anywhere about the waist",
        source="both ends uniform in a box of twice the hyperboloid's size",
        purpose="a program that tests the ends alone, or mixes up their columns, is wrong on every third way",
        game="a bullet passes through the pillar, or stops in front of nothing",
        drone="a leg of the route is called free that crosses the tower's wall",
        regimes="all four",
        make=anywhere,
        layout=WAYS,
    ),
    Family(
        name="way-tunnelling",
        version=1,
        title="ways through the wall, clear at both ends or inside at the second",
        source="from far outside to the waist's inside, or through the waist and out again, past the axis",
        purpose="a test at the ends of a step misses what happened inside it",
        game="a fast ball tunnels through the wall",
        drone="a step of the simulation jumps over the shell of the tower",
        regimes="a > 1",
        make=tunnelling,
        layout=WAYS,
    ),
)
