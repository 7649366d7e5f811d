"""The mesh oracle's search for an upright spheroid: the meridian cut into cells, with proved bounds on each.

The bounds come from the meridian, cut into cells as far as the spheroid can reach.
Space is scaled by 1/b, 1/b, 1/d (Theorem 1): the spheroid becomes the unit sphere about C, the surface gets the radii
a = α/b, c = γ/d. By symmetry C is turned to azimuth 0 and lifted to height ζ ≥ 0, and the point of the surface nearest
to C is then found at azimuth 0 with z ≥ 0. That half branch of a hyperbola, the meridian, has the parametrisation

    r = a (e + 1/e) / 2,    z = c (e − 1/e) / 2,    e ≥ 1.

It has rational points for rational e, and its tangents at e and f meet in the rational point
r = a (e f + 1) / (e + f), z = c (e f − 1) / (e + f). Both coordinates grow with e. All this is done in exact integers.

A cell is an arc of the meridian in the triangle of its chord and its two end tangents. The meridian is convex, so the
arc lies in that triangle, its chord on the outer side, its tangents on the inner. Corners are held as float64 relative
to C, in spheroid radii. Cells are cut until their bounds decide whether the surface comes within one radius of C
(docs/mesh-oracle.md).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt, sqrt

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import Floats
from hypcheck.truth.mesh import Mesh, MeshOutcome, MeshVerdict, side_of_center

UNIT_BITS = 96
UNIT = 1 << UNIT_BITS
"""Lengths are integers, in units of 2⁻⁹⁶ spheroid radii."""

REACH = 5 * UNIT // 4
"""Surface farther than this from C, in r or in z, is left out: its distance is above 5/4 radii."""


@dataclass(frozen=True, slots=True)
class Meridian:
    """A pair in its meridian half plane: radii a and c, and the centre ρ, ζ in units, each rounded down.

    `side` is that of C.
    Values of e are integers, `one` standing for 1.
    """

    a: Fraction
    c: Fraction
    rho: int
    zeta: int
    side: Position
    one: int

    def tangents_meet(self, e: int, f: int) -> tuple[int, int]:
        """Return where the tangents at e and f meet, (r, z) in units, rounded down; if e = f, the arc's point."""
        product, square, total = e * f, self.one * self.one, (e + f) * self.one
        return (
            ((self.a.numerator * (product + square)) << UNIT_BITS) // (self.a.denominator * total),
            ((self.c.numerator * (product - square)) << UNIT_BITS) // (self.c.denominator * total),
        )


def meridian_of(pair: Pair) -> Meridian:
    """Put the pair into its meridian half plane: exact except for two roundings of the centre, at any magnitudes."""
    lengths = pair.lengths
    a, c = Fraction(lengths.alpha, lengths.b), Fraction(lengths.gamma, lengths.d)
    return Meridian(
        a=a,
        c=c,
        rho=isqrt((lengths.x**2 + lengths.y**2 << 2 * UNIT_BITS) // lengths.b**2),
        zeta=(abs(lengths.z) << UNIT_BITS) // lengths.d,
        side=side_of_center(pair),
        # dr/de < a/2 and dz/de ≤ c: a step of e, 1/one, moves a point by less than 2⁻⁶³ radii.
        one=1 << (64 + (int(max(a, c)) + 1).bit_length()),
    )


def window_of(meridian: Meridian) -> tuple[int, int] | None:
    """Return e of the first and the last point with |r − ρ| and |z − ζ| ≤ 5/4, rounded outwards; None if there is none.

    Both conditions hold on one interval of e, since r and z grow with e. The roundings make it stick out by less than
    2⁻⁶⁰ radii: one step of X moves the bound's own r by a/one, one of Z its z by c/one, a step of e either by less.
    """
    first = max(
        meridian.one,
        _e_of_radius(meridian, meridian.rho - REACH),
        _e_of_height(meridian, meridian.zeta - REACH),
    )
    last = min(
        _e_of_radius(meridian, meridian.rho + 1 + REACH, up=True),
        _e_of_height(meridian, meridian.zeta + 1 + REACH, up=True),
    )
    return (first, last) if first < last else None


def _e_of_radius(meridian: Meridian, r: int, *, up: bool = False) -> int:
    """Return e = X + √(X² − 1), X = r/a, rounded down, or with `up` to more than it; 0 if r is below the waist's."""
    x = _quotient(r, meridian.a, meridian.one, up=up)
    return x + isqrt(x * x - meridian.one**2) + up if x >= meridian.one else 0


def _e_of_height(meridian: Meridian, z: int, *, up: bool = False) -> int:
    """Return e = Z + √(Z² + 1), Z = z/c, rounded down, or with `up` to more than it; 0 if z is below the waist."""
    height = _quotient(z, meridian.c, meridian.one, up=up)
    return height + isqrt(height * height + meridian.one**2) + up if height >= 0 else 0


def _quotient(length: int, radius: Fraction, one: int, *, up: bool) -> int:
    """Return length / radius in multiples of 1/one, rounded down, or with `up` to more than it."""
    return length * radius.denominator * one // (radius.numerator << UNIT_BITS) + up


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
class MeridianCell:
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


def cell_of(meridian: Meridian, low: int, high: int) -> MeridianCell:
    """Return the cell over the arc from e = `low` to e = `high`."""
    start, end = _seen_from_center(meridian, low, low), _seen_from_center(meridian, high, high)
    return MeridianCell(low, high, start, _seen_from_center(meridian, low, high), end)


def halves(meridian: Meridian, cell: MeridianCell) -> tuple[MeridianCell, MeridianCell]:
    """Return the cell cut in two: by octaves of e while it spans many, in the middle of e from then on."""
    octaves = (cell.high // cell.low).bit_length() - 1
    middle = cell.low << octaves // 2 if octaves > 1 else (cell.low + cell.high) // 2
    cut = _seen_from_center(meridian, middle, middle)
    return (
        MeridianCell(cell.low, middle, cell.start, _seen_from_center(meridian, cell.low, middle), cut),
        MeridianCell(middle, cell.high, cut, _seen_from_center(meridian, middle, cell.high), cell.end),
    )


def bounds_of(cell: MeridianCell, *, outside: bool) -> Bounds:
    """Proved bounds from one cell; `outside` says that C is outside the surface (F(C) > 0).

    Upper: for a point Y of the far facets (tangents seen from outside, chords from inside) F(C) and F(Y) do not have
    the same sign, so the segment CY meets the surface. Lower: for any direction n, every X in the triangle has |X| ≥
    n·X / |n| ≥ min over its corners v of n·v / |n|; n = the point of the near facets that is nearest to C makes that
    sharp. Both need only that the computed nearest points are on the facets, up to rounding.
    """
    chord, tangent = _nearest(cell.chord), _nearest(cell.tangents)
    near, far = (chord, tangent) if outside else (tangent, chord)
    return Bounds(max(0.0, _least_along(near, cell) - SLACK), _length(far) + SLACK)


def _least_along(direction: Point, cell: MeridianCell) -> float:
    """Return the least component of the triangle's corners along a direction, or 0 if the direction is too short."""
    length = _length(direction)
    if length < _VANISHING:
        return 0.0
    return min(direction[0] * v[0] + direction[1] * v[1] for v in (cell.start, cell.corner, cell.end)) / length


def _nearest(segments: tuple[Segment, ...]) -> Point:
    """Find approximately the point of the segments that is nearest to C."""
    return min((_nearest_on(p, q) for p, q in segments), key=_length)


def _nearest_on(p: Point, q: Point) -> Point:
    """Find approximately the point of the segment from p to q that is nearest to C."""
    along = (q[0] - p[0], q[1] - p[1])
    square = along[0] * along[0] + along[1] * along[1]
    if square == 0.0:
        return p
    s = min(max(-(p[0] * along[0] + p[1] * along[1]) / square, 0.0), 1.0)
    return (p[0] + s * along[0], p[1] + s * along[1])


def _length(v: Point) -> float:
    """Return the length of a vector."""
    return sqrt(v[0] * v[0] + v[1] * v[1])


def _seen_from_center(meridian: Meridian, e: int, f: int) -> Point:
    """Return the intersection of the tangents at e and f (the arc's point if e = f), relative to C, rounded once."""
    r, z = meridian.tangents_meet(e, f)
    return ((r - meridian.rho) / UNIT, (z - meridian.zeta) / UNIT)


REACH_RADII = REACH / UNIT
RESOLUTION = 4 * SLACK
"""Where the bounds come this close to each other (7·10⁻¹⁵ radii) and to 1, finer cells would tell nothing more."""

MOST_CELLS = 1 << 14
"""Cells kept at most on one level. A tangency of fourth order (c² = a at the waist), the highest there is, opens about
4,000 at the resolution; the limit keeps the time of a query bounded."""


def refine(pair: Pair) -> MeshVerdict:
    """Halve undecided cells, level by level, until all are beyond one radius, one proves contact, or neither can be.

    This always ends: the bounds of a cell are at most 62 u and twice its length apart (u = 2⁻⁵³: 2 SLACK, and what
    SLACK covers at most), which is below RESOLUTION = 64 u long before the length has shrunk to one step of e, 2⁻⁶³
    radii.
    """
    meridian = meridian_of(pair)
    outside = meridian.side is Position.EXTERIOR
    window = window_of(meridian)
    cells = [] if window is None else [cell_of(meridian, *window)]
    settled: list[Segment] = []
    settled_lower, upper, levels = REACH_RADII, float("inf"), 0
    while cells:
        levels += 1
        judged = [(cell, bounds_of(cell, outside=outside)) for cell in cells]
        lower = min(settled_lower, *(bounds.lower for _, bounds in judged))
        upper = min(upper, *(bounds.upper for _, bounds in judged))
        if upper <= 1.0:
            shown = ribbon(_facets(cells, chords=not outside))
            return MeshVerdict(MeshOutcome.CONTACT, meridian.side, (shown,), levels, lower, upper)
        cells = [cell for cell, bounds in judged if bounds.lower <= 1.0]
        if cells and (upper - lower <= RESOLUTION or len(cells) > MOST_CELLS):
            why = _why_open(levels, lower, upper)
            return MeshVerdict(MeshOutcome.UNDECIDED, meridian.side, (), levels, lower, upper, reason=why)
        beyond = [(cell, bounds) for cell, bounds in judged if bounds.lower > 1.0]
        settled.extend(_facets((cell for cell, _ in beyond), chords=outside))
        settled_lower = min(settled_lower, _least(bounds for _, bounds in beyond))
        cells = [half for cell in cells for half in halves(meridian, cell)]
    return MeshVerdict(MeshOutcome.CLEAR, meridian.side, (ribbon(settled),), levels, settled_lower, upper)


def _facets(cells: Iterable[MeridianCell], *, chords: bool) -> tuple[Segment, ...]:
    """Return the chords, or the tangents, of all cells."""
    return tuple(segment for cell in cells for segment in (cell.chord if chords else cell.tangents))


def _least(bounds: Iterable[Bounds]) -> float:
    """Return the least lower bound, inf if there is none."""
    return min((bound.lower for bound in bounds), default=float("inf"))


def _why_open(levels: int, lower: float, upper: float) -> str:
    """Say why nothing is decided."""
    if upper - lower <= RESOLUTION:
        return f"the distance is within {RESOLUTION:.1e} radii of 1: a tangency, or as near as float64 meshes tell"
    return f"too many cells stay open at level {levels}: the surfaces run close along an arc"


_HALVES_OF_A_SQUARE = np.array([[0, 1, 2], [0, 2, 3]])


def ribbon(segments: Sequence[Segment]) -> Mesh:
    """Draw segments of the meridian plane (y = 0) out across it: vertices (4n, 3) and triangles (2n, 3).

    Each becomes a square of two triangles with the segment in its middle, so the point of it nearest to C, which is
    in that plane, is the segment's. Segments without length are left out, as FCL's distance to a triangle without area
    is 0 wherever it lies; one below about 1e-77, whose fourth power underflows, is to FCL without area too. Ends are of
    the lattice of UNIT, so that none is so short.
    """
    ends: Floats = np.array(segments, dtype=np.float64).reshape(-1, 4)
    half = np.hypot(ends[:, 2] - ends[:, 0], ends[:, 3] - ends[:, 1]) / 2
    ends, half = ends[half > 0], half[half > 0]
    (x, z), (u, w) = ends[:, :2].T, ends[:, 2:].T
    corners = np.array([(x, -half, z), (x, half, z), (u, half, w), (u, -half, w)])
    first = 4 * np.arange(len(ends))[:, np.newaxis, np.newaxis]
    return np.ascontiguousarray(corners.transpose(2, 0, 1).reshape(-1, 3)), (first + _HALVES_OF_A_SQUARE).reshape(-1, 3)
