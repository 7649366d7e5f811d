"""The surfaces of a hunt: those next to a row, by which findings are grouped, and rows on their crossings.

Wrong answers are likely on a few surfaces in the space of rows, on which a case distinction about the pair changes. In
their names a = α/b, c = γ/d; r and z are the centre's distances from the axis and from the plane of the waist, in radii
of the spheroid; c1, c2 and Δ belong to the cubic g (docs/mathematics.md). For a sweep, the events on it are used
instead of surfaces.

The rows of a crossing lie on some of the four surfaces z = 0, r = 0, a = 1 and c² = a, or very close to them, at the
border of contact.

Rows are brought to the border of contact by bisection on exact positions. The position is monotone in every input
(docs/mathematics.md, "Monotone in every input"), so it changes at most twice along a factor on one length, or on x and
y together.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import (
    COLUMNS,
    HEIGHTS,
    SIZES,
    SWEEP_COLUMNS,
    Lengths,
    Pair,
    Position,
)
from hypcheck.geometry.rows import PAIRS, SWEEPS, Floats, Layout, Mask, Positions, Row, Rows, invalid
from hypcheck.runs.judge import truth_of
from hypcheck.truth import exact
from hypcheck.truth.kinds import Kind
from hypcheck.truth.passage_error import passage_of, sweep_in_radii
from hypcheck.truth.pencil import Cubic, cubic
from hypcheck.vectors.draw import Draw, ldexp, stepped
from hypcheck.vectors.random_pairs import Sizes, centred, heights, offsets

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
    """Return the place of a valid row of this layout."""
    return sweep_place(tuple(row)) if layout.has_end else place_of(Pair.from_row(row))


def _first_that_holds(signs: Mapping[str, object], otherwise: str, *known: str) -> RowPlace:
    """Return the place whose kind is the first sign that holds, or `otherwise` if none holds.

    Its words name all signs that hold, after the words in `known`.
    """
    named = [name for name, holds in signs.items() if holds]
    kind = named[0] if named else otherwise
    return RowPlace(kind, ", ".join([*known, *named] or [otherwise]), kind)


def place_of(pair: Pair) -> RowPlace:
    """Return the place of a pair: the surfaces that it is on or next to, and the cause that they suggest."""
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
    """Return the place of a tilted spheroid: the special properties of its axis and its centre."""
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
    return _first_that_holds(signs, TILTED, TILTED)


def _ended_place(pair: Pair) -> RowPlace:
    """Return the place of a pair whose hyperboloid ends: what the ends change, and where the centre is beside them."""
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
    return _first_that_holds(signs, ENDED, ENDED)


def _double_roots(lengths: Lengths, kind: Kind) -> Iterator[tuple[str, str]]:
    """Yield the name and the words of the surface Δ = 0, the ring or a tangency that the pair is on or next to."""
    if kind is Kind.EXTERIOR_RING:
        yield RING, "z = 0 and Δ = 0 (the ring)"
    elif kind.position is Position.EXTERIOR and (off := _off_the_ring(lengths)) is not None:
        yield f"next to {RING}", f"{off:.1e} radii from the ring"
    elif kind.limit_of is not None:
        yield "exactly tangent", f"exactly tangent ({kind.value})"
    elif kind in _OTHER_DOUBLE_ROOTS:
        yield "Δ = 0 without a tangency", f"Δ = 0 without a tangency ({kind.value})"


def _coefficients(g: Cubic) -> Iterator[tuple[str, str]]:
    """Yield the name and the words of each coefficient of the cubic that is 0."""
    if g.n1 == 0:
        yield "c1 = 0", "c1 = 0"
    if g.n2 == 0:
        yield "c2 = 0", "c2 = 0"


def _borders(lengths: Lengths) -> Iterator[tuple[str, str]]:
    """Yield the name and the words of each border of a regime, and each long ratio, that the pair is at."""
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
    """Yield the name and the words of each regime, beside the main one, in which the pair lies."""
    if lengths.gamma**2 * lengths.b < lengths.d**2 * lengths.alpha:
        yield "c² < a", "c² < a"
    if lengths.alpha < lengths.b:
        yield "a < 1", "a < 1"


def _planes(lengths: Lengths) -> Iterator[tuple[str, str]]:
    """Yield the name and the words of r = 0 and z = 0 if the centre is there or near."""
    r = Fraction(math.isqrt((lengths.x**2 + lengths.y**2) << 128), lengths.b << 64)
    if r <= NEAR and r * lengths.b <= NEAR * lengths.alpha:
        yield "r = 0", _at_or_near("r", "0", r, "r")
    z = Fraction(abs(lengths.z), lengths.d)
    if z <= NEAR and z * lengths.d <= NEAR * lengths.gamma:
        yield "z = 0", _at_or_near("z", "0", z, "z")


def _off_the_ring(lengths: Lengths) -> float | None:
    """Return roughly how far the centre is from the ring, a circle in the plane z = 0, in radii; None if not near."""
    a, c = _a(lengths), _c(lengths)
    radius = _ring_radius(a, c)
    if radius is None:
        return None
    clearance = (c - a / c) ** 2 / (radius + a + 1)
    r = math.hypot(_ratio(lengths.x, lengths.b), _ratio(lengths.y, lengths.b))
    off = math.hypot(r - radius, _ratio(lengths.z, lengths.d))
    return off if clearance >= RING_CLEAR and off <= min(RING_NEAR, clearance / 2) else None


def _ring_radius(a: float, c: float) -> float | None:
    """Return the ring's radius √((c² + 1)(a² + c²))/c in radii of the spheroid; None if there is no ring."""
    return math.sqrt(c * c + 1) * math.hypot(a / c, 1) if 0 < a < c * c < math.inf else None


def _at_or_near(name: str, value: str, off: Fraction, what: str) -> str:
    """Return the words for a quantity that has a special value, or differs from it by `off`."""
    return f"{name} = {value}" if off == 0 else f"{name} ≈ {value} ({what} = {float(off):.1e})"


def _a(lengths: Lengths) -> float:
    """Return a = α/b as a float; inf if it is too large."""
    return _ratio(lengths.alpha, lengths.b)


def _c(lengths: Lengths) -> float:
    """Return c = γ/d as a float; inf if it is too large."""
    return _ratio(lengths.gamma, lengths.d)


def _ratio(top: int, bottom: int) -> float:
    """Return |top|/bottom as a float; inf if it is too large."""
    try:
        return abs(top) / bottom
    except OverflowError:
        return math.inf


def sweep_place(row: Row) -> RowPlace:
    """Return the place of a sweep: the events on it, and its direction; findings are grouped by the first name."""
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
    return _first_that_holds(signs, ORDINARY_SWEEP)


def _crosses_the_ring(row: Row) -> bool:
    """Return whether an upright spheroid's centre is on or near the ring when its sweep crosses the waist's plane."""
    alpha, gamma, b, d, x, y, z, end_x, end_y, end_z = row
    radius = _ring_radius(alpha / b, gamma / d)
    if radius is None or z * end_z > 0:
        return False
    low, high = (0.0, 1.0) if z == end_z else (z / (z - end_z),) * 2
    first, last = (math.hypot(x + t * (end_x - x), y + t * (end_y - y)) / b - radius for t in (low, high))
    return first * last <= 0 or min(abs(first), abs(last)) <= RING_NEAR


MOVERS: dict[str, tuple[int, ...]] = {
    "radius": (4, 5),
    "height": (6,),
    "alpha": (0,),
    "gamma": (1,),
    "b": (2,),
    "d": (3,),
}
"""The movers of a pair: sets of columns, by name. Multiplied by one factor, a set can move the row to the border."""

END_MOVERS: dict[str, tuple[int, ...]] = {"lower end": (10,), "upper end": (11,)}
"""The movers of the heights between which a hyperboloid ends."""

SIZE = (2, 3)
"""The columns of b and d, which are the size of the spheroid together."""

REACH = 2.0**12
"""The greatest factor by which a number is multiplied in the search for the border; the least is 1/REACH."""

EXPONENTS = 46
"""Rows are moved up to 2^(EXPONENTS − 1) ulp of the factor away from the border."""


def columns_of(movers: NDArray[np.str_], columns: Sequence[str] = COLUMNS) -> Mask:
    """Return a mask (n, len(columns)) of the columns that each of the n named movers multiplies."""
    mask = np.zeros((len(movers), len(columns)), dtype=np.bool_)
    for name, places in movers_of(columns).items():
        mask[np.ix_(movers == name, places)] = True
    return mask


def movers_of(columns: Sequence[str]) -> dict[str, tuple[int, ...]]:
    """Return the movers of rows with these columns, by name."""
    return MOVERS if set(HEIGHTS).isdisjoint(columns) else MOVERS | END_MOVERS


def moved(rows: Rows, mask: Mask, factor: Floats) -> Rows:
    """Multiply the masked columns by each row's factor; numbers beyond float64 become infinite."""
    with np.errstate(all="ignore"):
        return np.where(mask, rows * factor[:, None], rows)


def border_factors(rows: Rows, mask: Mask, far: Mask, layout: Layout = PAIRS) -> Floats:
    """Find for each row the factor just before the position changes or contact on a sweep begins, (n,).

    It is NaN if nothing changes between 1/REACH and REACH.

    If there are two changes, the rows in `far` take the one with the greater factor.
    """
    low, high = np.full(len(rows), 1 / REACH), np.full(len(rows), REACH)
    at_low, at_high = _truths(moved(rows, mask, low), layout), _truths(moved(rows, mask, high), layout)
    changes = (at_low != at_high) & (at_low != UNUSABLE) & (at_high != UNUSABLE)
    rows, mask, far = rows[changes], mask[changes], far[changes]
    at_low, at_high = at_low[changes], at_high[changes]
    # Bisection of bit patterns bisects the logarithm at first, and the factor itself at the end.
    below, above = low[changes].view(np.int64), high[changes].view(np.int64)
    while (above - below).max(initial=0) > 1:
        middle = below + (above - below) // 2
        position = _truths(moved(rows, mask, middle.view(np.float64)), layout)
        before = np.where(far, position != at_high, position == at_low)
        below, above = np.where(before, middle, below), np.where(before, above, middle)
    factors = np.full(len(changes), np.nan)
    factors[changes] = below.view(np.float64)
    return factors


UNUSABLE = 3
"""The truth about a row whose numbers are outside the range of float64."""


def _truths(rows: Rows, layout: Layout) -> Positions:
    """Return exact positions, or hits of sweeps; UNUSABLE if a length is outside the range of float64."""
    usable = ~invalid(rows, layout)
    truths = np.full(len(rows), UNUSABLE, dtype=np.int8)
    truths[usable] = truth_of(rows[usable], layout)
    return truths


def beside_border(draw: Draw, rows: Rows, movers: NDArray[np.str_]) -> Rows:
    """Move each row to a border by its mover, then a random distance away; rows without a border are left out."""
    mask = columns_of(movers)
    factors = border_factors(rows, mask, draw.signs(len(rows)) > 0)
    rungs = ldexp(draw.signs(len(rows)), draw.integers(len(rows), 0, EXPONENTS - 1)).astype(np.int64)
    finite = np.isfinite(factors)
    return moved(rows[finite], mask[finite], stepped(factors[finite], rungs[finite]))


SURFACES = {"z = 0": "height", "r = 0": "radius", "a = 1": "alpha", "c² = a": "alpha"}
"""The four surfaces, each with the mover (a name in MOVERS) that would move a row away from it."""


def crossing(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Rows:
    """Make at most n rows on or very close to these surfaces, each at a random distance from the border of contact."""
    size = _sizes(draw, n, surfaces)
    height = heights(draw, size.c) * _slack(draw, n, pinned="z = 0" in surfaces)
    radius = np.abs(size.a + offsets(draw, n)) * _slack(draw, n, pinned="r = 0" in surfaces)
    rows = centred(draw, size, radius, height)
    movers = np.asarray(movers_within(surfaces))
    return beside_border(draw, rows, movers[draw.integers(n, 0, len(movers) - 1)])


def _slack(draw: Draw, n: int, *, pinned: bool) -> Floats:
    """Draw factors (n,) for a distance: 1; if `pinned`, 0 (on the surface) or from 2⁻⁵⁰ to 2⁻³, at random."""
    if not pinned:
        return np.ones(n)
    return np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -50, -3))


def _sizes(draw: Draw, n: int, surfaces: tuple[str, ...]) -> Sizes:
    """Draw sizes of every regime. On the surface a = 1, α = b; on c² = a, α/b = (γ/d)²: exactly or nearly."""
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
    """Draw factors (n,): 1, or 1 ± a number from 2⁻⁵² to 2⁻³, at random."""
    return np.asarray(1 + draw.signs(n) * np.where(draw.signs(n) < 0, 0.0, draw.log_uniform(n, -52, -3)))


def movers_within(surfaces: tuple[str, ...]) -> list[str]:
    """Return the movers that can bring a row to the border without leaving these surfaces."""
    kept = {SURFACES[surface] for surface in surfaces}
    return [mover for mover in ("radius", "height", "alpha") if mover not in kept]
