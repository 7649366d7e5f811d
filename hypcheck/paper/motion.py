"""Many ways at once: which straight ways and which turns in place are clear from beginning to end, exactly.

Both answers come from one observation (docs/mathematics.md, "Monotone in every input"): an interior spheroid stays so
where its centre comes nearer to the axis and farther from the waist's plane, an exterior one where it does the
opposite. So one exact decision at the worst corner of a way, its largest distance from the axis with its least height,
or the other way round, proves the whole way clear. What is not proved so, nor disproved by an end of the way, is
decided by truth.motion or truth.turning.

Bounds, u = 2⁻⁵³. Along a segment the distance from the axis is convex: the largest is at an end, and √(x²+y²) computed
is within 3u of it. The least is not below the least of n·C at the ends for any horizontal direction n of length 1; n·C
is computed to within 3u (|x|+|y|), and the n used is at most 1 + 4u long. Coordinates that are differences are within u
of themselves. MARGIN covers all of these several times.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from hypcheck.casebook.draw import Floats
from hypcheck.kernel.classify import classify_scene
from hypcheck.pairs import Position
from hypcheck.paper.flights_circle import Direction, any_angle, turned
from hypcheck.paper.flights_craft import Mask, Point
from hypcheck.truth.motion import passage
from hypcheck.truth.turning import turning

MARGIN = 64 * 2.0**-53

Sizes = tuple[float, float, float, float]


def always(
    side: Position, sizes: Sizes, start: Point, end: Point, center: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Mask:
    """Which spheroids keep to `side`, INTERIOR or EXTERIOR, on the whole segment from start to end; (n,).

    `center` is the hyperboloid's; what is rounded where it is subtracted is within the bounds too.
    """
    corner = _inner_corner if side is Position.INTERIOR else _outer_corner
    first, last = _from(center, start), _from(center, end)
    clear = np.asarray(classify_scene(sizes, *corner(first, last)) == side)
    at_ends = np.logical_and(*(classify_scene(sizes, *_favoured(side, at)) == side for at in (first, last)))
    for lane in np.flatnonzero(at_ends & ~clear).tolist():
        way = passage(sizes, _exactly(center, start, lane), _exactly(center, end, lane))
        clear[lane] = way.clear and way.start is side
    return clear


def first_contact(
    sizes: Sizes, start: Point, end: Point, lane: int, center: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> tuple[float, float]:
    """Bounds of the time of first contact on one of these ways, 0 ≤ time ≤ 1; inf twice where there is none."""
    way = passage(sizes, _exactly(center, start, lane), _exactly(center, end, lane))
    return way.first_lower, way.first_upper


def _favoured(side: Position, at: Point) -> Point:
    """A position that is not on that side only where the exact one is not either: a hair nearer to it."""
    more, less = (1 - MARGIN, 1 + MARGIN) if side is Position.INTERIOR else (1 + MARGIN, 1 - MARGIN)
    return at[0] * more, at[1] * more, at[2] * less


def _inner_corner(start: Point, end: Point) -> Point:
    """A position that is interior only where the whole way is: as far out and as low as the way gets."""
    radius = np.maximum(np.hypot(start[0], start[1]), np.hypot(end[0], end[1])) * (1 + MARGIN)
    return radius, np.zeros_like(radius), _least_height(start[2], end[2]) * (1 - MARGIN)


def _outer_corner(start: Point, end: Point) -> Point:
    """A position that is exterior only where the whole way is: as near to the axis and as high as the way gets."""
    x, y = start[0] + end[0], start[1] + end[1]
    length = np.hypot(x, y)
    length = np.where(length > 0, length, 1.0)
    reach = np.minimum(*(_along(x / length, y / length, at) for at in (start, end)))
    height = np.maximum(np.abs(start[2]), np.abs(end[2])) * (1 + MARGIN)
    return np.maximum(reach, 0.0), np.zeros_like(reach), height


def _along(ahead: Floats, aside: Floats, at: Point) -> Floats:
    """A lower bound of the way along a horizontal direction of length 1, to within rounding."""
    return np.asarray(ahead * at[0] + aside * at[1] - MARGIN * (np.abs(at[0]) + np.abs(at[1])))


def _from(center: tuple[float, float, float], at: Point) -> Point:
    x, y, z = (column - origin for column, origin in zip(at, center, strict=True))
    return x, y, z


def _exactly(center: tuple[float, float, float], at: Point, lane: int) -> tuple[Fraction, Fraction, Fraction]:
    x, y, z = (Fraction(value) - Fraction(origin) for value, origin in zip(_at(at, lane), center, strict=True))
    return x, y, z


def _least_height(first: Floats, second: Floats) -> Floats:
    crossing = (first > 0) != (second > 0)
    return np.where(crossing, 0.0, np.minimum(np.abs(first), np.abs(second)))


def always_turning(sizes: Sizes, arm: float, at: Point, direction: Direction, degrees: Floats) -> Mask:
    """Which parts stay interior while an arm that points into `direction` turns by so many degrees (−180 … 180); (n,).

    The largest distance from the axis is ρ + l where the arm points outward on the way, else it is reached at an end.
    Rounding may take an arm for one that just does not point outward: near there the distance is flat, and MARGIN, with
    the lengths ρ and l for a scale, holds what is missed.
    """
    x, y, z = at
    after = turned(direction, any_angle(degrees))
    reach, slack = np.hypot(x, y) + arm, MARGIN * (np.abs(x) + np.abs(y) + arm)
    ends = np.maximum(*(np.hypot(x + arm * cosine, y + arm * sine) for cosine, sine in (direction, after)))
    largest = np.where(_comes_by(x, y, direction, degrees), reach, ends)
    flat = np.zeros_like(largest)
    clear = classify_scene(sizes, largest + slack, flat, z) == Position.INTERIOR
    open_ = clear != (classify_scene(sizes, np.maximum(largest - slack, 0.0), flat, z) == Position.INTERIOR)
    for lane in np.flatnonzero(open_).tolist():
        angle = float(np.radians(degrees[lane]))
        ahead = (float(direction[0][lane]), float(direction[1][lane]))
        clear[lane] = turning(sizes, _at(at, lane), arm, ahead, angle) is Position.INTERIOR
    return np.asarray(clear)


def _comes_by(x: Floats, y: Floats, direction: Direction, degrees: Floats) -> Mask:
    """Whether an arm points away from the axis at some time of the turn."""
    cosine, sine = direction
    angle = np.degrees(np.arctan2(x * sine - y * cosine, x * cosine + y * sine))  # of the arm, from outward
    return np.asarray(
        np.where(degrees >= 0, (angle <= 0) & (angle + degrees >= 0), (angle >= 0) & (angle + degrees <= 0))
    )


def _at(point: Point, lane: int) -> tuple[float, float, float]:
    x, y, z = (float(column[lane]) for column in point)
    return x, y, z
