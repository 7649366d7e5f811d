"""Cells of the meridian, each an arc shut in the triangle of its chord and its two end tangents, and their bounds.

The meridian is convex, so the arc lies in that triangle, its chord on the outer side, its tangents on the inner.
Corners are held as float64 relative to C, in spheroid radii (docs/mesh-oracle.md).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from hypcheck.truth.mesh_window import UNIT, Meridian

Point = tuple[float, float]
Segment = tuple[Point, Point]

SLACK = 2.0**-49
"""More than every rounding in a bound can change it: 16 u, u = 2⁻⁵³ being the unit roundoff of float64.

A coordinate is at most 5/4 + 2⁻⁶⁰ in size, so a corner has |v| < 1.77 and is known within u + 2⁻⁹⁶ a coordinate,
1.5 u in all (and so are the points between corners). On top of that, to first order:
- upper: p + s (q − p) with |q − p| < 3.54 is off by at most (3.54 + 3.54 + 1.77) u, its length by 2 u · 1.77 more:
  with the corners 13.9 u.
- lower: (n·v)/|n| is off by 2 u |v| for the products and the sum, 2 u for |n| and 1 u for the quotient, each times at
  most 1.77: with the corners 10.4 u.
Adding or subtracting SLACK rounds by at most u; terms of second order and underflow stay below 10⁻³ u.
"""

_VANISHING = 2.0**-100
"""A direction shorter than this is not trusted, as its square could underflow; the lower bound is then 0."""


@dataclass(frozen=True, slots=True)
class Cell:
    """The arc from e = `low` to e = `high`, seen from C: its ends and the corner where the tangents there meet."""

    low: int
    high: int
    start: Point
    corner: Point
    end: Point

    @property
    def chord(self) -> tuple[Segment, ...]:
        """The outer mesh over this arc, in the meridian plane."""
        return ((self.start, self.end),)

    @property
    def tangents(self) -> tuple[Segment, ...]:
        """The inner mesh over this arc, in the meridian plane."""
        return ((self.start, self.corner), (self.corner, self.end))


@dataclass(frozen=True, slots=True)
class Bounds:
    """The distance from C to an arc is at least `lower`; the distance to the whole surface is at most `upper`."""

    lower: float
    upper: float


def cell_of(meridian: Meridian, low: int, high: int) -> Cell:
    """The cell over the arc from e = `low` to e = `high`."""
    start, end = _seen_from_center(meridian, low, low), _seen_from_center(meridian, high, high)
    return Cell(low, high, start, _seen_from_center(meridian, low, high), end)


def halves(meridian: Meridian, cell: Cell) -> tuple[Cell, Cell]:
    """The cell cut in two: by octaves of e while it spans many, in the middle of e from then on."""
    octaves = (cell.high // cell.low).bit_length() - 1
    middle = cell.low << octaves // 2 if octaves > 1 else (cell.low + cell.high) // 2
    cut = _seen_from_center(meridian, middle, middle)
    return (
        Cell(cell.low, middle, cell.start, _seen_from_center(meridian, cell.low, middle), cut),
        Cell(middle, cell.high, cut, _seen_from_center(meridian, middle, cell.high), cell.end),
    )


def bounds_of(cell: Cell, *, outside: bool) -> Bounds:
    """Proved bounds from one cell; `outside` says that C is not inside the surface (F(C) ≥ 0).

    Upper: for a point Y of the far facets (tangents seen from outside, chords from inside) F(C) and F(Y) do not have
    the same sign, so the segment CY meets the surface. Lower: for any direction n, every X in the triangle has
    |X| ≥ n·X / |n| ≥ min over its corners v of n·v / |n|; n = the point of the near facets that is nearest to C makes
    that sharp. Neither asks for more of the computed nearest points than that they are on the facets, up to rounding.
    """
    chord, tangent = _nearest(cell.chord), _nearest(cell.tangents)
    near, far = (chord, tangent) if outside else (tangent, chord)
    return Bounds(max(0.0, _least_along(near, cell) - SLACK), _length(far) + SLACK)


def _least_along(direction: Point, cell: Cell) -> float:
    """The least component of the triangle's corners along a direction, or 0 where the direction is too short."""
    length = _length(direction)
    if length < _VANISHING:
        return 0.0
    return min(direction[0] * v[0] + direction[1] * v[1] for v in (cell.start, cell.corner, cell.end)) / length


def _nearest(segments: tuple[Segment, ...]) -> Point:
    """About the point of the segments that is nearest to C."""
    return min((_nearest_on(p, q) for p, q in segments), key=_length)


def _nearest_on(p: Point, q: Point) -> Point:
    along = (q[0] - p[0], q[1] - p[1])
    square = along[0] * along[0] + along[1] * along[1]
    if square == 0.0:
        return p
    s = min(max(-(p[0] * along[0] + p[1] * along[1]) / square, 0.0), 1.0)
    return (p[0] + s * along[0], p[1] + s * along[1])


def _length(v: Point) -> float:
    return sqrt(v[0] * v[0] + v[1] * v[1])


def _seen_from_center(meridian: Meridian, e: int, f: int) -> Point:
    """Where the tangents at e and f meet (the arc's point if e = f), relative to C. Dividing integers rounds once."""
    r, z = meridian.tangents_meet(e, f)
    return ((r - meridian.rho) / UNIT, (z - meridian.zeta) / UNIT)
