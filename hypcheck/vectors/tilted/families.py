"""Families of spheroids whose axis may point anywhere: rows of ten numbers, with the traps that a tilt adds.

First where the spheroid is put (beside a point of the surface, along M⁻¹ times the normal there), then rows that need
no more than that, then the families, those of exact coincidences (coincidences.py) among them.
"""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.vectors.draw import Draw, circle_at, in_turn, ldexp, turns
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


def beside(draw: Draw, size: Sizes, height: Floats, axis: Vectors, offset: Floats, *, on_x_axis: bool = False) -> Rows:
    """Rows whose centre is `offset` radii from the surface's point at `height` (in γ), outward positive.

    The way is M⁻¹ n, n being the normal there: with offset ±1 the spheroid touches the surface in that point, though it
    may cross it elsewhere.
    """
    n = len(height)
    cosine, sine = (draw.signs(n), np.zeros(n)) if on_x_axis else draw.circle(n)
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


def horizontal(draw: Draw, n: int) -> Rows:
    """Near contact, the axis horizontal."""
    size, height = _ordinary(draw, n)
    cosine, sine = draw.circle(n)
    return beside(draw, size, height, (cosine, sine, np.zeros(n)), _nearly(draw, n))


def through_the_centre(draw: Draw, n: int) -> Rows:
    """Near contact but for a last turn: the axis points to the hyperboloid's centre."""
    rows = near_contact(draw, n)
    rows[:, 7:] = np.where((rows[:, 4:7] != 0).any(axis=1)[:, None], rows[:, 4:7], 1.0)
    return rows


def in_meridian_plane(draw: Draw, n: int) -> Rows:
    """Near contact, centre and axis in one plane with the hyperboloid's axis: y = 0 or x = 0 in both."""
    size, height = _ordinary(draw, n)
    up, across = circle_at(draw.unit(n))
    axis = (across * draw.signs(n), np.zeros(n), up)
    rows = beside(draw, size, height, axis, _nearly(draw, n), on_x_axis=True)
    swap = draw.signs(n) < 0
    rows[:, [4, 5]] = np.where(swap[:, None], rows[:, [5, 4]], rows[:, [4, 5]])
    rows[:, [7, 8]] = np.where(swap[:, None], rows[:, [8, 7]], rows[:, [7, 8]])
    return rows


def at_the_waist(draw: Draw, n: int) -> Rows:
    """Uniform, but the centre in the plane of the waist."""
    rows = uniform(draw, n)
    rows[:, 6] = 0.0
    return rows


symmetric = in_turn(in_meridian_plane, horizontal, through_the_centre, at_the_waist)


def spheres(draw: Draw, n: int) -> Rows:
    """b = d: the axis means nothing."""
    size, height = _ordinary(draw, n)
    size = Sizes(size.alpha, size.c * size.b, size.b, size.b)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


def upright(draw: Draw, n: int) -> Rows:
    """The axis (0, 0, s), of any length and either sign."""
    size, height = _ordinary(draw, n)
    rows = beside(draw, size, height, (np.zeros(n), np.zeros(n), np.ones(n)), _nearly(draw, n))
    rows[:, 9] = draw.signs(n) * draw.log_uniform(n, -60, 60)
    return rows


def slight(draw: Draw, n: int) -> Rows:
    """Near contact, the axis off the vertical or off the horizontal by 2⁻¹⁰⁷⁴ to 2⁻¹."""
    size, height = _ordinary(draw, n)
    cosine, sine = draw.circle(n)
    little = np.where(turns(n, True, True, True, False), draw.log_uniform(n, -60, 0), draw.log_uniform(n, -1074, -60))
    standing = turns(n, True, True, False)
    across, up = np.where(standing, little, 1.0), np.where(standing, 1.0, little)
    return beside(draw, size, height, (across * cosine, across * sine, up * draw.signs(n)), _nearly(draw, n))


def stiff(draw: Draw, n: int) -> Rows:
    """Near contact, ratios of sizes up to 2²⁷, about 10⁸."""
    size = sizes(draw, draw.log_uniform(n, -14, 14), draw.log_uniform(n, -14, 14), units=(-13, 13))
    height = draw.signs(n) * draw.log_uniform(n, -20, 4)
    return beside(draw, size, height, anywhere(draw, n), _nearly(draw, n))


def any_length(draw: Draw, n: int) -> Rows:
    """Near contact, the axis as short and as long as float64 allows."""
    rows = near_contact(draw, n)
    length = draw.integers(n, -1073, 1023)
    rows[:, 7:] = ldexp(rows[:, 7:], np.where(turns(n, True, True, False), length, turns(n, -1073, 1023))[:, None])
    return rows + 0.0


def small_integers(draw: Draw, n: int) -> Rows:
    """Whole numbers as a person types them: sizes to 6, centres to 12, axes to 2."""
    whole = [draw.integers(n, 1, 6) for _ in range(4)] + [draw.integers(n, -12, 12) for _ in range(3)]
    axis = [draw.integers(n, -2, 2) for _ in range(3)]
    zero = (axis[0] == 0) & (axis[1] == 0) & (axis[2] == 0)
    return np.stack([*whole, np.where(zero, 1, axis[0]), *axis[1:]], axis=1).astype(np.float64)


def whole_domain(draw: Draw, n: int) -> Rows:
    """All that float64 holds: all lengths scaled by one power of two, to below the least normal number and beyond."""
    size = sizes(draw, draw.log_uniform(n, -6, 6), draw.log_uniform(n, -6, 6), units=(-3, 3))
    rows = beside(draw, size, draw.between(n, -2, 2), anywhere(draw, n), _nearly(draw, n, high=0))
    unit = np.where(turns(n, True, False), draw.integers(n, -1064, -1000), draw.integers(n, 900, 1008))
    rows[:, :7] = ldexp(rows[:, :7], unit[:, None])
    return np.concatenate([np.maximum(rows[:, :4], 5e-324), rows[:, 4:]], axis=1) + 0.0
