"""The exact decision: integers alone, no division, no rounding, every valid pair in every regime.

The spheroid is exterior if and only if S + λH (pencil.py) is positive definite for some λ > 0, interior if and only if
it is for some λ < 0 (the S-lemma; no symmetry is used), and in contact otherwise. With M and D the upper 3×3 parts of S
and H let (λ₋, λ₊) be the interval around 0 in which M + λD is positive definite. There S + λH is positive definite
exactly where f(λ) = det(S + λH) > 0.

**Upright.** f is A + λ times the cubic g, and (λ₋, λ₊) is (−A, B). The rule (docs/mathematics.md, "The local maximum
decides"): g(−A), g(0), g(B) ≤ 0, and the pair is exterior when g > 0 somewhere in (0, B), interior when g > 0 somewhere
in (−A, 0), in contact otherwise. A cubic with leading coefficient > 0 has one local maximum λm at most, so only the
sign of g(λm) and the place of λm are needed. Both follow from signs of numbers u + v √h with integers u, v, h; squaring
decides these signs.

**Tilted.** F is a positive multiple of f (pencil.py). F(0) < 0 and F(±∞) > 0. At λ₊ and λ₋ the matrix M + λD is
singular and positive semidefinite, so that F ≤ 0 there. Hence one root is ≤ λ₋, one is ≥ λ₊, and the other two are
complex or sit together in one of (−∞, λ₋], [λ₋, 0), (0, λ₊], [λ₊, ∞). On (λ₋, λ₊) f has the sign of φ = f/det(M + λD),
which is concave with φ(0) = −1 and φ′(0) = h, the hyperboloid's equation at the centre: the sign of h gives the side of
0 on which f can be positive. With μ = |λ| and ℓ the end of the interval on that side, the only question is whether F >
0 for some μ in (0, ℓ):

- F has at least two real roots, so two are complex if and only if its discriminant is < 0; then the pair is in contact;
- where all four are real, Descartes' rule counts exactly: 1 or 3 of them are positive (of λ's sign), and with 3 two lie
  in (0, ℓ] or all three in [ℓ, ∞), which the signs of F's derivatives at ℓ tell, by Descartes' rule again;
- where the discriminant is 0 there is one multiple root, and it is rational. In (0, ℓ] it is a tangency, unless it is ℓ
  itself and a simple root lies below it, which makes the pair clear (the ring of upright spheroids, tilted).

ℓ is p/q (towards interior, for b > d) or a root of E, so that every required sign is the sign of u + r √w in integers.

**Where the hyperboloid ends** (h is < 0 inside of it), W = {h = 0, z_min ≤ z ≤ z_max} is the wall,
K = {h ≤ 0, z_min ≤ z ≤ z_max} the body, E the closed solid spheroid.

- Open: contact if and only if E meets W; else interior if the centre lies in K, exterior if not.
- Solid: contact if and only if E meets W or one of the two discs in which K ends; else E lies in K or is disjoint from
  it, and the centre says which.

E meets W only where it meets the whole hyperboloid. So the position without ends is decided first. sections.py decides
about the wall only if that position is contact and E reaches beyond an end.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.arithmetic import changes_of_sign, sign_of, sign_with_root
from hypcheck.geometry.pair import Lengths, Position
from hypcheck.truth.kinds import Kind
from hypcheck.truth.pencil import Cubic, Number, Quartic, cubic, quartic, side_of_center
from hypcheck.truth.polynomials import common_divisor, sign_at
from hypcheck.truth.sections import Sections


@dataclass(frozen=True, slots=True)
class Decision:
    """The exact answer.

    `limit_of` is, for a tangency, the clear position that a smaller spheroid would have. `kind` is the kind of contact
    or clearance of an upright pair; None for a tilted one.
    """

    position: Position
    limit_of: Position | None = None
    kind: Kind | None = None

    @property
    def tangent(self) -> bool:
        """Whether the surfaces touch without crossing there; such a pair is in contact."""
        return self.limit_of is not None


def position(lengths: Lengths) -> Position:
    """Return the exact position of the spheroid."""
    whole = _upright_position(cubic(lengths)) if lengths.is_upright else _tilted(quartic(lengths)).position
    return ended_position(lengths, whole) if lengths.has_ends else whole


def decide(lengths: Lengths) -> Decision:
    """Decide exactly: the position, whether the spheroid only touches, the kind of an upright pair without ends."""
    whole = _without_ends(lengths)
    if not lengths.has_ends:
        return whole
    where = ended_position(lengths, whole.position)
    touching = where is Position.CONTACT
    return Decision(where, ended_limit(lengths, whole.position, whole.limit_of) if touching else None)


def _without_ends(lengths: Lengths) -> Decision:
    """Return the decision about the whole hyperboloid."""
    if not lengths.is_upright:
        return _tilted(quartic(lengths))
    kind = kind_of(lengths)
    return Decision(kind.position, kind.limit_of, kind)


def kind_of(lengths: Lengths) -> Kind:
    """Return the kind of an upright pair: the row of the table of root patterns (kinds.py)."""
    g = cubic(lengths)
    where, discriminant = _upright_position(g), cubic_discriminant(*g.coefficients)
    if where is Position.EXTERIOR:
        return Kind.EXTERIOR if discriminant > 0 else Kind.EXTERIOR_RING
    return Kind.INTERIOR if where is Position.INTERIOR else _contact_kind(g, discriminant)


def _upright_position(g: Cubic) -> Position:
    """Decide the position of an upright pair beside the hyperboloid without ends, by its cubic."""
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


def cubic_discriminant(n3: Number, n2: Number, n1: Number, n0: Number) -> Number:
    """Return N⁴ Δ, where Δ is the discriminant of equation (13) and N = n3."""
    return n1 * n1 * (n2 * n2 - 4 * n3 * n1) + n0 * (n2 * (18 * n3 * n1 - 4 * n2 * n2) - 27 * n3 * n3 * n0)


def _contact_kind(g: Cubic, discriminant: int) -> Kind:
    """Return the row of the root-pattern table, for a pair already known to be in contact."""
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
    """Return the kind of a double root m < 0, by the sign of m + A."""
    if above > 0:
        return Kind.INTERIOR_TANGENT_POINT
    return Kind.INTERIOR_TANGENT_CIRCLE if above == 0 else Kind.CROSSING_THROAT_NODE


def _outer_tangency(g: Cubic, top: int, bottom: int) -> Kind:
    """Return the kind of a double root m = top/bottom > 0, by the order of m, B and the simple root."""
    below = g.s * bottom - top * g.t  # the sign of B − m
    if below > 0:
        return Kind.EXTERIOR_TANGENT_POINT
    if below == 0:
        return Kind.EXTERIOR_TANGENT_TWO_POINTS
    simple_above = -g.n2 * bottom - 3 * g.n3 * top > 0  # simple root −n2/N − 2 m against m
    return Kind.CROSSING_GROOVE_ISOLATED_POINT if simple_above else Kind.CROSSING_GROOVE_NODE


def _tilted(F: Quartic) -> Decision:
    """Decide about a tilted pair beside the hyperboloid without ends, by its quartic."""
    contact = Decision(Position.CONTACT)
    if F.side == 0 or changes_of_sign(F.coefficients) < 3:
        return contact  # the centre on the hyperboloid, or one positive root alone
    sign = discriminant(F)
    if sign < 0:
        return contact
    if sign == 0:
        return _with_multiple_root(F)
    return contact if _three_beyond(F) else Decision(Position(F.side))


def discriminant(F: Quartic) -> int:
    """Return 27 times the discriminant of F."""
    return int(quartic_discriminant(*F.coefficients))


def quartic_discriminant(a: Number, b: Number, c: Number, d: Number, e: Number) -> Number:
    """Return 27 times the discriminant of a quartic, by its two invariants."""
    ae, bd, cc = a * e, b * d, c * c
    H = 12 * ae - 3 * bd + cc
    J = c * (72 * ae + 9 * bd - 2 * cc) - 27 * (a * d * d + e * b * b)
    return 4 * H * H * H - J * J


def _three_beyond(F: Quartic) -> bool:
    """Decide whether all three positive roots, distinct ones, are ≥ ℓ.

    By Descartes' rule for the Taylor coefficients at ℓ, all roots being real: three changes of sign. F(ℓ) ≤ 0 counts as
    −: if it is 0, the sign of F′(ℓ) at a simple root alone shows which of the roots ℓ is.
    """
    signs = _signs_at_first(F) if F.at_first else _signs_at_second(F)
    return changes_of_sign((-1, *signs, 1)) == 3


def _derivative(F: Quartic, order: int) -> tuple[int, ...]:
    """Return the derivative of this order over its factorial, the highest power first."""
    if order == 1:
        return (4 * F.f4, 3 * F.f3, 2 * F.f2, F.f1)
    if order == 2:
        return (6 * F.f4, 3 * F.f3, F.f2)
    return (4 * F.f4, F.f3)


def _signs_at_first(F: Quartic) -> list[int]:
    """Return the signs of the first three derivatives at p/q."""
    return [sign_at(_derivative(F, order), Fraction(F.p, F.q)) for order in (1, 2, 3)]


def _signs_at_second(F: Quartic) -> list[int]:
    """Return the signs of the first three derivatives at ℓ, by Horner's rule for numbers u + v √w.

    Here ℓ = (e1 + √w)/D, w = e1² + 4 e0 e2, D = 2 e2 > 0.
    """
    e, D = F.e1, 2 * F.e2
    w = e * e + 2 * F.e0 * D
    signs = []
    for order in (1, 2, 3):
        u = v = 0
        scale = 1
        for coefficient in _derivative(F, order):
            u, v, scale = u * e + v * w + coefficient * scale, u + v * e, scale * D
        signs.append(sign_with_root(u, v, w))
    return signs


def _with_multiple_root(F: Quartic) -> Decision:
    """Return the decision if F has a multiple root; there is only one, and it is rational."""
    m = double_root(F)
    if m <= 0 or (beyond := _beyond(F, m)) > 0:
        return Decision(Position.CONTACT)
    if beyond == 0 and sign_at(_derivative(F, 2), m) > 0:
        return Decision(Position(F.side))  # the simple root lies between 0 and ℓ
    return Decision(Position.CONTACT, limit_of=Position(F.side))


def _beyond(F: Quartic, m: Fraction) -> int:
    """Return the sign of m − ℓ, m > 0."""
    n, k = m.numerator, m.denominator
    past = F.q * n - F.p * k if F.at_first else F.e2 * n * n - F.e1 * n * k - F.e0 * k * k
    return sign_of(past)


def double_root(F: Quartic) -> Fraction:
    """Return the multiple root of a quartic with exactly one (double or triple), by Euclid's algorithm on F and F′."""
    common = common_divisor(F.coefficients, _derivative(F, 1))
    degree = len(common) - 1  # a multiple of (λ − m)^degree
    return Fraction(-common[1], degree * common[0])


def ended_position(lengths: Lengths, whole: Position) -> Position:
    """Return the exact position; `whole` is that without ends."""
    sections = Sections.of(lengths)
    return Position.CONTACT if _meet(sections, lengths, whole) else _side(sections, lengths)


def ended_limit(lengths: Lengths, whole: Position, whole_limit: Position | None) -> Position | None:
    """Return the clear position that a smaller spheroid would have if a contact is only a touch, else None.

    `whole_limit` is this clear position for the pair without ends, whose position is `whole`.
    """
    sections = Sections.of(lengths)
    if whole is Position.CONTACT and _between(sections, lengths):
        return whole_limit
    if lengths.solid and any(sections.disc_crosses(end) for end, _ in _ends(lengths)):
        return None
    if whole is Position.CONTACT:
        lowest, highest = sections.reach_in_heights
        low = lowest if lengths.low is None else lengths.low
        high = highest if lengths.high is None else lengths.high
        if sections.wall_crosses(low, high):
            return None
    return _side(sections, lengths)


def _meet(sections: Sections, lengths: Lengths, whole: Position) -> bool:
    """Decide whether E meets W or, if the body is solid, one of the discs."""
    if whole is Position.EXTERIOR or (whole is Position.INTERIOR and not lengths.solid):
        return False
    if whole is Position.CONTACT:
        if _between(sections, lengths):
            return True
        if not _beyond_ends(sections, lengths) and not sections.wall_misses(lengths.low, lengths.high):
            return True
    return lengths.solid and not all(sections.disc_misses(end) for end, _ in _ends(lengths))


def _ends(lengths: Lengths) -> list[tuple[int, int]]:
    """Return the finite ends, each with the direction from the body out through it."""
    return [(end, outward) for end, outward in ((lengths.low, -1), (lengths.high, 1)) if end is not None]


def _between(sections: Sections, lengths: Lengths) -> bool:
    """Decide whether all of E lies between the ends."""
    return all(
        sections.sign(sections.above, end) * outward > 0 and sections.sign(sections.inside, end) <= 0
        for end, outward in _ends(lengths)
    )


def _beyond_ends(sections: Sections, lengths: Lengths) -> bool:
    """Decide whether all of E lies below or above both ends."""
    return any(
        sections.sign(sections.above, end) * outward < 0 and sections.sign(sections.inside, end) < 0
        for end, outward in _ends(lengths)
    )


def _side(sections: Sections, lengths: Lengths) -> Position:
    """Return interior if the centre lies in the body, else exterior."""
    inside = side_of_center(lengths) <= 0 and all(
        sections.sign(sections.above, end) * outward >= 0 for end, outward in _ends(lengths)
    )
    return Position.INTERIOR if inside else Position.EXTERIOR
