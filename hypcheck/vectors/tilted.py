"""Families of spheroids whose axis may point anywhere: rows of ten numbers, with the traps that a tilt adds.

First where the spheroid is put (beside a point of the surface, along M⁻¹ times the normal there), then the families
that need no more than that, then those in exact coincidence: tangencies from rational rotations, rings and twins.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.vectors.draw import Draw, turns
from hypcheck.vectors.family import Family
from hypcheck.vectors.random_pairs import Sizes, all_regimes, heights, offsets, sizes
from hypcheck.vectors.scenes import BODY, TOWER

Vectors = tuple[Floats, Floats, Floats]
"""x, y, z, each (n,)."""


def anywhere(draw: Draw, n: int) -> Vectors:
    """Unit vectors in every direction, some in the planes of the coordinates."""
    up = draw.between(n, -1, 1)
    cosine, sine = draw.circle(n)
    across = np.sqrt(1 - up * up)
    return across * cosine, across * sine, up


def beside(draw: Draw, size: Sizes, height: Floats, axis: Vectors, offset: Floats) -> Rows:
    """Rows whose centre is `offset` radii from the surface's point at `height` (in γ), outward positive.

    The way is M⁻¹ n, n being the normal there: with offset ±1 the spheroid touches the surface in that point, though it
    may cross it elsewhere.
    """
    cosine, sine = draw.circle(len(height))
    radius = np.sqrt(1 + height * height)
    point = (size.alpha * radius * cosine, size.alpha * radius * sine, size.gamma * height)
    normal = (radius * cosine / size.alpha, radius * sine / size.alpha, -height / size.gamma)
    length = np.sqrt(_dot(axis, axis))
    unit = (axis[0] / length, axis[1] / length, axis[2] / length)
    along = _dot(normal, unit)
    across = [n - along * v for n, v in zip(normal, unit, strict=True)]
    way = [size.b * size.b * q + size.d * size.d * along * v for q, v in zip(across, unit, strict=True)]
    half = np.sqrt(_dot(normal, (way[0], way[1], way[2])))
    return stack(size, [p + offset * w / half for p, w in zip(point, way, strict=True)], axis)


def _dot(one: Vectors, other: Vectors) -> Floats:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def stack(size: Sizes, centre: list[Floats], axis: Vectors) -> Rows:
    """The rows of these columns, without negative zeros."""
    return np.stack([size.alpha, size.gamma, size.b, size.d, *centre, *axis], axis=1) + 0.0


def _ordinary(draw: Draw, n: int) -> tuple[Sizes, Floats]:
    """Sizes of every regime, and heights in γ."""
    size = sizes(draw, *all_regimes(draw, n))
    return size, heights(draw, size.c) / size.c * draw.signs(n)


def _nearly(draw: Draw, n: int, low: int = -52, high: int = -4) -> Floats:
    """±1, and a little more or less."""
    return draw.signs(n) * (1 + draw.signs(n) * draw.log_uniform(n, low, high))


def uniform(draw: Draw, n: int) -> Rows:
    """All regimes, all directions, centres all around the surface."""
    size, height = _ordinary(draw, n)
    return beside(draw, size, height, anywhere(draw, n), offsets(draw, n))


def tower(draw: Draw, n: int) -> Rows:
    """The paper's body beside the wall of its tower, leaning up to 45° from the vertical to any side."""
    size = Sizes(*(np.full(n, value) for value in TOWER + BODY))
    cosine, sine = draw.circle(n)
    lean = draw.unit(n)
    axis = (lean * cosine, lean * sine, np.ones(n))
    offset = draw.signs(n) * (1 + draw.between(n, -0.75, 0.75) * turns(n, 1.0, 0.25, 2.0**-10))
    return beside(draw, size, draw.between(n, -1, 1), axis, offset)


def near_contact(draw: Draw, n: int) -> Rows:
    """From 2⁻⁵² to 2⁻⁴ radii off contact, everywhere."""
    size, height = _ordinary(draw, n)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


TILTED_FAMILIES = (
    Family(
        name="tilted-uniform",
        version=1,
        title="ordinary sizes, axes in every direction, centres all around the surface",
        source="the four regimes of α/b against 1 and (γ/d)² against α/b in turn, directions uniform on the sphere",
        purpose="nothing special: a program that fails here has a plain error, or takes the spheroid for upright",
        game="anything that leans collides with air, or with nothing",
        drone="a pitching drone is answered as one that hovers",
        regimes="all four",
        make=uniform,
        tilted=True,
    ),
    Family(
        name="tilted-tower",
        version=1,
        title="the paper's quadcopter, pitching beside the wall of its tower",
        source="section 3.2 of the paper speaks of pitch and does not model it; axes up to 45° from the vertical",
        purpose="the answer of the upright spheroid is wrong for some percent of these rows",
        game="a vehicle that banks clips the wall that it seemed to miss",
        drone="leaning into the movement brings a rotor into the wall",
        regimes="α ≥ b and (γ/d)² ≥ α/b, the tower's",
        make=tower,
        tilted=True,
    ),
    Family(
        name="tilted-near-contact",
        version=1,
        title="from 2⁻⁵² to 2⁻⁴ radii off contact, axes in every direction",
        source="centres beside a point of the surface along M⁻¹ times the normal, where that point touches",
        purpose="measures how near to contact a program can still tell; the eigenvectors lose digits here first",
        game="sliding along a wall on a slope stutters, or sinks into it",
        drone="a planned clearance of a millimetre is none",
        regimes="all four",
        make=near_contact,
        tilted=True,
    ),
)
