"""The exact decision: integers alone, no division, no rounding, every valid pair in every regime.

With p = α², q = b², s = γ², t = d², R = x² + y², S = z² (each group of lengths in its own unit), A = p/q, B = s/t,
P = R/q, Q = S/t, and N = q t > 0 times the cubic g is n3 λ³ + n2 λ² + n1 λ + n0 in integers.

The rule (docs/mathematics.md, "The local maximum decides"): g(−A), g(0), g(B) ≤ 0, and the pair is exterior when g > 0
somewhere in (0, B), interior when g > 0 somewhere in (−A, 0), in contact otherwise. A cubic with leading coefficient
> 0 has one local maximum λm at most, so only the sign of g(λm) and the place of λm are asked for. Both are signs of
numbers u + v √h with integers u, v, h, and those are decided by squaring.
"""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth.kinds import Kind


@dataclass(frozen=True, slots=True)
class Cubic:
    """N g(λ) = n3 λ³ + n2 λ² + n1 λ + n0 and the poles −A = −p/q, B = s/t, all integers; n3, p, q, s, t > 0."""

    n3: int
    n2: int
    n1: int
    n0: int
    p: int
    q: int
    s: int
    t: int


@dataclass(frozen=True, slots=True)
class Decision:
    """The exact answer: the position, whether it is a tangency, and the kind of contact or of clearance."""

    position: Position
    tangent: bool
    kind: Kind


def cubic(lengths: Lengths) -> Cubic:
    """The cubic of equation (14) of the paper over the common denominator b² d²."""
    p, q, s, t = lengths.alpha**2, lengths.b**2, lengths.gamma**2, lengths.d**2
    radius, height = lengths.x**2 + lengths.y**2, lengths.z**2
    return Cubic(
        n3=q * t,
        n2=(p + q - radius) * t - (s + height) * q,
        n1=p * (t - s - height) + s * (radius - q),
        n0=-p * s,
        p=p,
        q=q,
        s=s,
        t=t,
    )


def position(lengths: Lengths) -> Position:
    """The exact position of the two surfaces."""
    return _position(cubic(lengths))


def decide(lengths: Lengths) -> Decision:
    """The exact position, tangency and kind of the two surfaces."""
    g = cubic(lengths)
    where = _position(g)
    discriminant = _discriminant(g)
    if where is Position.EXTERIOR:
        return Decision(where, False, Kind.EXTERIOR if discriminant > 0 else Kind.EXTERIOR_RING)
    if where is Position.INTERIOR:
        return Decision(where, False, Kind.INTERIOR)
    kind = _contact_kind(g, discriminant)
    return Decision(where, kind.tangent, kind)


def _position(g: Cubic) -> Position:
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    if h <= 0:
        return Position.CONTACT  # g never falls: it has no local maximum
    if g.n1 > 0 and g.n2 < 0:  # λm > 0
        beyond = -(g.n2 * g.t + 3 * g.n3 * g.s)  # λm < B ⟺ beyond < t √h
        if beyond >= 0 and beyond * beyond >= g.t * g.t * h:
            return Position.CONTACT
        side = Position.EXTERIOR
    else:  # λm < 0, or λm = 0, where g(0) = −AB < 0
        above = 3 * g.n3 * g.p - g.n2 * g.q  # λm > −A ⟺ above > q √h
        if above <= 0 or above * above <= g.q * g.q * h:
            return Position.CONTACT
        side = Position.INTERIOR
    # 27 N² · N g(λm) = w + 2 h √h, w being 27 N² · N g at the inflection
    w = g.n2 * (2 * g.n2 * g.n2 - 9 * g.n3 * g.n1) + 27 * g.n3 * g.n3 * g.n0
    return side if w > 0 or 4 * h * h * h > w * w else Position.CONTACT


def _discriminant(g: Cubic) -> int:
    """N⁴ Δ, Δ as in equation (13)."""
    n3, n2, n1, n0 = g.n3, g.n2, g.n1, g.n0
    return n1 * n1 * (n2 * n2 - 4 * n3 * n1) + n0 * (n2 * (18 * n3 * n1 - 4 * n2 * n2) - 27 * n3 * n3 * n0)


def _contact_kind(g: Cubic, discriminant: int) -> Kind:
    """The row of the root-pattern table, for a pair already known to be in contact."""
    if discriminant < 0:
        return Kind.CROSSING_ONE_CURVE
    if discriminant > 0:  # three real roots, none of the patterns that are clear
        all_positive = g.n2 < 0 and g.n1 > 0
        return Kind.CROSSING_GROOVE_TWO_CURVES if all_positive else Kind.CROSSING_THROAT_TWO_CURVES
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    if h == 0:  # triple root −n2/(3 N), never negative: one root is always ≥ B
        return Kind.EXTERIOR_TANGENT_OSCULATING if -g.n2 * g.t == 3 * g.n3 * g.s else Kind.CROSSING_GROOVE_CUSP
    top, bottom = 9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * h  # the double root m = top/bottom
    if top < 0:
        return _inner_tangency(top * g.q + g.p * bottom)
    return _outer_tangency(g, top, bottom)


def _inner_tangency(above: int) -> Kind:
    """The kind of a double root m < 0, by the sign of m + A."""
    if above > 0:
        return Kind.INTERIOR_TANGENT_POINT
    return Kind.INTERIOR_TANGENT_CIRCLE if above == 0 else Kind.CROSSING_THROAT_NODE


def _outer_tangency(g: Cubic, top: int, bottom: int) -> Kind:
    """The kind of a double root m = top/bottom > 0, by the place of m to B and to the simple root."""
    below = g.s * bottom - top * g.t  # the sign of B − m
    if below > 0:
        return Kind.EXTERIOR_TANGENT_POINT
    if below == 0:
        return Kind.EXTERIOR_TANGENT_TWO_POINTS
    simple_above = -g.n2 * bottom - 3 * g.n3 * top > 0  # simple root −n2/N − 2 m against m
    return Kind.CROSSING_GROOVE_ISOLATED_POINT if simple_above else Kind.CROSSING_GROOVE_NODE
