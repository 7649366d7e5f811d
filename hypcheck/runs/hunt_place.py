"""The place of a row of a hunt: the surfaces next to it. Findings are grouped by place.

Wrong answers are likely on a few surfaces in the space of rows, on which a case distinction about the pair changes. In
their names a = α/b, c = γ/d; r and z are the centre's distances from the axis and from the plane of the waist, in radii
of the spheroid; c1, c2 and Δ belong to the cubic g (docs/mathematics.md). For a sweep, the events on it are used
instead of surfaces.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import COLUMNS, SIZES, SWEEP_COLUMNS, Lengths, Pair, Position
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout
from hypcheck.truth import exact
from hypcheck.truth.kinds import Kind
from hypcheck.truth.passage_error import passage_of, sweep_in_radii
from hypcheck.truth.pencil import Cubic, cubic

NEAR = Fraction(1, 64)
"""A row within this relative distance is next to a surface."""

RING_NEAR, RING_CLEAR = 1 / 8, 1 / 256
"""A row within RING_NEAR spheroid radii is next to the ring, if the ring's clearance is at least RING_CLEAR radii, so
that the ring is not a border of contact."""

LONG = 2.0**17
"""A ratio α/b or γ/d above LONG or below 1/LONG is a long ratio."""

OPEN = "no special place"
RING = "the ring"
TILTED = "a tilted spheroid"
ENDED = "a hyperboloid that ends"
ORDINARY_SWEEP = "an ordinary sweep"

LONG_SWEEP, SHORT_SWEEP = 2.0**10, 2.0**-10
"""A sweep of more spheroid radii is long, one of less is short."""

_OTHER_DOUBLE_ROOTS = (
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_CUSP,
)


@dataclass(frozen=True, slots=True)
class RowPlace:
    """The surfaces next to a row.

    `kind` is the most specific surface; findings are grouped by it. `words` name every surface next to the row. `cause`
    is equal for rows that probably fail for the same reason: a special surface, or else the regime.
    """

    kind: str
    words: str
    cause: str


def place_of_row(row: Sequence[float], layout: Layout) -> RowPlace:
    """The place of a valid row of this layout."""
    return _PLACES[layout](tuple(row))


def place_of(pair: Pair) -> RowPlace:
    """The place of a pair: the surfaces that it is on or next to, and the cause that they suggest."""
    if pair.has_ends:
        return _ended_place(pair)
    if not pair.is_upright:
        return _tilted_place(pair)
    lengths = pair.upright.lengths
    special = [*_double_roots(lengths, exact.kind_of(lengths)), *_coefficients(cubic(lengths))]
    regimes = list(_regimes(lengths))
    planes = [] if special and special[0][0] == RING else _planes(lengths)
    named = [*special, *_borders(lengths), *regimes, *planes] or [(OPEN, OPEN)]
    cause = special[0][0] if special else " and ".join(name for name, _ in regimes)
    return RowPlace(named[0][0], ", ".join(words for _, words in named), cause.removeprefix("next to "))


def _tilted_place(pair: Pair) -> RowPlace:
    """The place of a tilted spheroid: the special properties of its axis and its centre."""
    x, y, z, axis_x, axis_y, axis_z = map(Fraction, (pair.x, pair.y, pair.z, *pair.axis))
    across, along = axis_x**2 + axis_y**2, axis_z**2
    signs = {
        "exactly tangent": exact.decide(pair.lengths).tangent,
        "a horizontal axis": along == 0,
        "a nearly upright axis": across <= NEAR**2 * along,
        "a nearly horizontal axis": 0 < along <= NEAR**2 * across,
        "the axis in the plane of the centre": (x or y) and x * axis_y == y * axis_x,
        "r = 0": not (x or y),
        "z = 0": z == 0,
    }
    named = [name for name, holds in signs.items() if holds]
    kind = named[0] if named else TILTED
    return RowPlace(kind, ", ".join([TILTED, *named]), kind)


def _ended_place(pair: Pair) -> RowPlace:
    """The place of a pair whose hyperboloid ends: the change that the ends cause, and the centre's position to them."""
    decision, whole = exact.decide(pair.lengths), exact.position(pair.without_ends.lengths)
    low, high = pair.z_min, pair.z_max
    signs = {
        "exactly tangent": decision.tangent,
        "clear because it ends": whole is Position.CONTACT is not decision.position,
        "contact with a flat end": whole is not Position.CONTACT is decision.position,
        "outside because it ends": whole is Position.INTERIOR and decision.position is Position.EXTERIOR,
        "the centre at an end": pair.z in (low, high),
        "the centre beyond an end": not low <= pair.z <= high,
        "a slab thinner than the spheroid": high - low < 2 * max(pair.b, pair.d),
        "an end at the waist": 0 in (low, high),
        "r = 0": not (pair.x or pair.y),
        "a solid body": bool(pair.solid),
        TILTED: not pair.is_upright,
    }
    named = [name for name, holds in signs.items() if holds]
    kind = named[0] if named else ENDED
    return RowPlace(kind, ", ".join([ENDED, *named]), kind)


def _double_roots(lengths: Lengths, kind: Kind) -> Iterator[tuple[str, str]]:
    if kind is Kind.EXTERIOR_RING:
        yield RING, "z = 0 and Δ = 0 (the ring)"
    elif kind.position is Position.EXTERIOR and (off := _off_the_ring(lengths)) is not None:
        yield f"next to {RING}", f"{off:.1e} radii from the ring"
    elif kind.limit_of is not None:
        yield "exactly tangent", f"exactly tangent ({kind.value})"
    elif kind in _OTHER_DOUBLE_ROOTS:
        yield "Δ = 0 without a tangency", f"Δ = 0 without a tangency ({kind.value})"


def _coefficients(g: Cubic) -> Iterator[tuple[str, str]]:
    if g.n1 == 0:
        yield "c1 = 0", "c1 = 0"
    if g.n2 == 0:
        yield "c2 = 0", "c2 = 0"


def _borders(lengths: Lengths) -> Iterator[tuple[str, str]]:
    throat = Fraction(lengths.alpha - lengths.b, lengths.b)
    if abs(throat) <= NEAR:
        yield "a = 1", _at_or_near("a", "1", throat, "a − 1")
    groove = Fraction(lengths.gamma**2 * lengths.b, lengths.d**2 * lengths.alpha) - 1
    if abs(groove) <= NEAR:
        yield "c² = a", _at_or_near("c²", "a", groove, "c²/a − 1")
    for name, ratio in (("a", _a(lengths)), ("c", _c(lengths))):
        if not 1 / LONG <= ratio <= LONG:
            yield "a long ratio", f"{name} = {ratio:.1e}"


def _regimes(lengths: Lengths) -> Iterator[tuple[str, str]]:
    if lengths.gamma**2 * lengths.b < lengths.d**2 * lengths.alpha:
        yield "c² < a", "c² < a"
    if lengths.alpha < lengths.b:
        yield "a < 1", "a < 1"


def _planes(lengths: Lengths) -> Iterator[tuple[str, str]]:
    r = Fraction(math.isqrt((lengths.x**2 + lengths.y**2) << 128), lengths.b << 64)
    if r <= NEAR and r * lengths.b <= NEAR * lengths.alpha:
        yield "r = 0", _at_or_near("r", "0", r, "r")
    z = Fraction(abs(lengths.z), lengths.d)
    if z <= NEAR and z * lengths.d <= NEAR * lengths.gamma:
        yield "z = 0", _at_or_near("z", "0", z, "z")


def _off_the_ring(lengths: Lengths) -> float | None:
    """The approximate distance of the centre from the ring, a circle in the plane z = 0, in radii; None if not near."""
    a, c = _a(lengths), _c(lengths)
    radius = _ring_radius(a, c)
    if radius is None:
        return None
    clearance = (c - a / c) ** 2 / (radius + a + 1)
    r = math.hypot(_ratio(lengths.x, lengths.b), _ratio(lengths.y, lengths.b))
    off = math.hypot(r - radius, _ratio(lengths.z, lengths.d))
    return off if clearance >= RING_CLEAR and off <= min(RING_NEAR, clearance / 2) else None


def _ring_radius(a: float, c: float) -> float | None:
    """The ring's radius √((c² + 1)(a² + c²))/c in radii of the spheroid; None if there is no ring."""
    return math.sqrt(c * c + 1) * math.hypot(a / c, 1) if 0 < a < c * c < math.inf else None


def _at_or_near(name: str, value: str, off: Fraction, what: str) -> str:
    return f"{name} = {value}" if off == 0 else f"{name} ≈ {value} ({what} = {float(off):.1e})"


def _a(lengths: Lengths) -> float:
    return _ratio(lengths.alpha, lengths.b)


def _c(lengths: Lengths) -> float:
    return _ratio(lengths.gamma, lengths.d)


def _ratio(top: int, bottom: int) -> float:
    try:
        return abs(top) / bottom
    except OverflowError:
        return math.inf


def sweep_place(row: tuple[float, ...]) -> RowPlace:
    """The place of a sweep: the events on it, and its direction; findings are grouped by the first name."""
    start, end = row[len(SIZES) : len(COLUMNS)], row[len(COLUMNS) : len(SWEEP_COLUMNS)]
    passage, length = passage_of(row), sweep_in_radii(row)
    still, sides = start == end, (passage.start, passage.end)
    signs = {
        "nothing moves": still,
        "begun in contact": passage.start is Position.CONTACT,
        "contact for an instant": passage.grazes,
        "contact between two clear ends": passage.hit and Position.CONTACT not in sides,
        "contact towards the end": passage.hit and passage.start is not Position.CONTACT is passage.end,
        f"across {RING}": not passage.hit and not SWEEPS.has_axis(row) and _crosses_the_ring(row),
        "clear inside": not passage.hit and passage.start is Position.INTERIOR,
        "a vertical sweep": start[:2] == end[:2] and not still,
        "a horizontal sweep": start[2] == end[2] and not still,
        "a long sweep": length > LONG_SWEEP,
        "a short sweep": 0 < length < SHORT_SWEEP,
        TILTED: row[2] != row[3] and any(row[len(SWEEP_COLUMNS) : len(SWEEP_COLUMNS) + 2]),
        ENDED: SWEEPS.has_heights(row),
    }
    named = [name for name, holds in signs.items() if holds] or [ORDINARY_SWEEP]
    return RowPlace(named[0], ", ".join(named), named[0])


def _crosses_the_ring(row: tuple[float, ...]) -> bool:
    """Whether an upright spheroid's centre is on or near the ring when its sweep crosses the waist's plane."""
    alpha, gamma, b, d, x, y, z, end_x, end_y, end_z = row
    radius = _ring_radius(alpha / b, gamma / d)
    if radius is None or z * end_z > 0:
        return False
    low, high = (0.0, 1.0) if z == end_z else (z / (z - end_z),) * 2
    first, last = (math.hypot(x + t * (end_x - x), y + t * (end_y - y)) / b - radius for t in (low, high))
    return first * last <= 0 or min(abs(first), abs(last)) <= RING_NEAR


_PLACES: dict[Layout, Callable[[tuple[float, ...]], RowPlace]] = {
    PAIRS: lambda row: place_of(Pair.from_row(row)),
    SWEEPS: sweep_place,
}
