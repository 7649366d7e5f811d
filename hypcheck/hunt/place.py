"""Where a row stands, in words: which of the surfaces that arguments trip over it is on, or next to.

a = α/b, c = γ/d, r and z are the centre's distances from the axis and from the waist's plane in spheroid radii, and
c1, c2, Δ belong to the cubic g (docs/mathematics.md).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.pairs import Lengths, Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.exact import Cubic, Decision
from hypcheck.truth.kinds import Kind

NEAR = Fraction(1, 64)
"""Relative to the lengths at hand, what counts as next to a surface."""

RING_NEAR, RING_CLEAR = 1 / 8, 1 / 256
"""In spheroid radii, what counts as next to the ring, where that is clear enough not to be a border of contact too."""

LONG = 2.0**17
"""A ratio α/b or γ/d beyond this, or below 1/LONG, is a long one."""

OPEN = "no special place"
RING = "the ring"

_OTHER_DOUBLE_ROOTS = (
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_CUSP,
)


@dataclass(frozen=True, slots=True)
class Place:
    """Where a row stands, for three purposes.

    `kind` is the surface that explains most, by which findings are told apart; `words` name every surface; `cause` is
    the same for rows that fail alike: a special surface, or else the regime.
    """

    kind: str
    words: str
    cause: str


def place_of(pair: Pair) -> Place:
    """The place of a pair."""
    lengths = pair.lengths
    special = [*_double_roots(lengths, exact.decide(lengths)), *_coefficients(exact.cubic(lengths))]
    regimes = list(_regimes(lengths))
    planes = [] if special and special[0][0] == RING else _planes(lengths)
    named = [*special, *_borders(lengths), *regimes, *planes] or [(OPEN, OPEN)]
    cause = special[0][0] if special else " and ".join(name for name, _ in regimes)
    return Place(named[0][0], ", ".join(words for _, words in named), cause.removeprefix("next to "))


def _double_roots(lengths: Lengths, decision: Decision) -> Iterator[tuple[str, str]]:
    if decision.kind is Kind.EXTERIOR_RING:
        yield RING, "z = 0 and Δ = 0 (the ring)"
    elif decision.position is Position.EXTERIOR and (off := _off_the_ring(lengths)) is not None:
        yield f"next to {RING}", f"{off:.1e} radii from the ring"
    elif decision.tangent:
        yield "exactly tangent", f"exactly tangent ({decision.kind.value})"
    elif decision.kind in _OTHER_DOUBLE_ROOTS:
        yield "Δ = 0 without a tangency", f"Δ = 0 without a tangency ({decision.kind.value})"


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
    """About how far the centre is from the circle z = 0, r² = (c² + 1)(a² + c²)/c², in radii; None where not near."""
    a, c = _a(lengths), _c(lengths)
    if not a < c * c < math.inf:
        return None
    radius = math.sqrt(c * c + 1) * math.hypot(a / c, 1)
    clearance = (c - a / c) ** 2 / (radius + a + 1)
    r = math.hypot(_ratio(lengths.x, lengths.b), _ratio(lengths.y, lengths.b))
    off = math.hypot(r - radius, _ratio(lengths.z, lengths.d))
    return off if clearance >= RING_CLEAR and off <= min(RING_NEAR, clearance / 2) else None


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
