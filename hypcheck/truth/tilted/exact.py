"""The exact decision for a spheroid in general position: integers alone, no division, every valid pair.

S and H are the two surfaces' 4×4 matrices, S + λH their pencil. The spheroid is exterior if and only if S + λH is
positive definite for some λ > 0, interior if and only if it is for some λ < 0 (the S-lemma; no symmetry is used), and
in contact otherwise. With M and D the upper 3×3 parts of S and H let (λ₋, λ₊) be the interval around 0 in which M + λD
is positive definite. There S + λH is positive definite exactly where f(λ) = det(S + λH) > 0.

**The quartic.** Let p = α², s = γ², q = b², t = d² and let v be the axis, V = v·v, c = v_z², W = V − c. A horizontal n
perpendicular to v splits the 3×3 pencil into 1/q + λ/p along n and a 2×2 block. Up to positive factors their
determinants are

    L = p + q λ     E = p s V + λ (s g1 − p g2) − λ² q t V,     g1 = t W + q c,  g2 = q W + t c,

and with R = x² + y², Z = z², N = x v_y − y v_x, T = (x v_x + y v_y) z v_z (expand det(S + λH); the tests do)

    p² q² s t V f = F = L G − (q − t) N² λ² (s − q λ)
    G = −(1 + λ) E + λ (R s − Z p) V − λ² (R g2 + Z g1 + 2 (q − t) T).

**Where its roots are.** F(0) < 0 and F(±∞) > 0. At λ₊ and λ₋ the matrix M + λD is singular and positive semidefinite,
so that F ≤ 0 there. Hence one root is ≤ λ₋, one is ≥ λ₊, and the other two are complex or sit together in one of
(−∞, λ₋], [λ₋, 0), (0, λ₊], [λ₊, ∞). On (λ₋, λ₊) f has the sign of φ = f/det(M + λD), which is concave with φ(0) = −1
and φ′(0) = h, the hyperboloid's equation at the centre: the sign of h says on which side of 0 f can be positive. With
μ = |λ| and ℓ the end of the interval on that side, all that is asked is whether F > 0 for some μ in (0, ℓ):

- F has two real roots at least, so two are complex if and only if its discriminant is < 0; then the pair is in contact;
- where all four are real, Descartes' rule counts exactly: 1 or 3 of them are positive (of λ's sign), and with 3 two lie
  in (0, ℓ] or all three in [ℓ, ∞), which the signs of F's derivatives at ℓ tell, by Descartes' rule again;
- where the discriminant is 0 there is one multiple root, and it is rational. In (0, ℓ] it is a tangency, unless it is ℓ
  itself and a simple root lies below it, which makes the pair clear (the ring of upright spheroids, tilted).

ℓ is p/q (towards interior, for b > d) or a root of E, so that every sign asked for is that of u + r √w in integers.
The axis vertical or b = d is an upright pair's question, and exact.py of upright pairs answers it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import Position
from hypcheck.truth import exact as upright
from hypcheck.truth.tilted.pair import TiltedLengths


@dataclass(frozen=True, slots=True)
class TiltedDecision:
    """The exact answer. `limit_of` is, for a tangency, the clear position that a smaller spheroid would have."""

    position: Position
    limit_of: Position | None = None

    @property
    def tangent(self) -> bool:
        """Whether the surfaces touch without crossing there; such a pair is in contact."""
        return self.limit_of is not None


@dataclass(frozen=True, slots=True)
class Bracket:
    """An answer's backward error is between these: both 0 for a right one or the limit of right ones, inf for never."""

    lower: float
    upper: float


@dataclass(frozen=True, slots=True)
class Quartic:
    """A positive multiple f4 μ⁴ + … + f0 of det(S + λH), λ = side · μ, where `side` is the sign of h; all integers.

    The factors of det(M + λD) are p + side · q μ and e0 + e1 μ − e2 μ², with p, q, e0, e2 > 0. The interval in which
    M + λD is positive definite ends at p/q if `at_first`, else at the positive root of the second factor.
    """

    f4: int
    f3: int
    f2: int
    f1: int
    f0: int
    p: int
    q: int
    e0: int
    e1: int
    e2: int
    side: int
    at_first: bool

    @property
    def coefficients(self) -> tuple[int, ...]:
        """f4, f3, f2, f1, f0."""
        return (self.f4, self.f3, self.f2, self.f1, self.f0)


def quartic(lengths: TiltedLengths) -> Quartic:
    """The quartic of a pair whose spheroid is neither upright nor a sphere."""
    p, s, q, t = lengths.alpha**2, lengths.gamma**2, lengths.b**2, lengths.d**2
    x, y, z = lengths.x, lengths.y, lengths.z
    v_x, v_y, v_z = lengths.axis
    c, W = v_z * v_z, v_x * v_x + v_y * v_y
    V, R, Z = W + c, x * x + y * y, z * z
    g1, g2 = t * W + q * c, q * W + t * c
    qt, ps = q * t, p * s
    e0, e1, e2 = ps * V, s * g1 - p * g2, qt * V
    height = R * s - Z * p
    G0, G1 = -e0, V * height - e0 - e1
    G2 = e2 - e1 - R * g2 - Z * g1 - 2 * (q - t) * (x * v_x + y * v_y) * z * v_z
    off_plane = (q - t) * (x * v_y - y * v_x) ** 2
    side = (height > ps) - (height < ps)
    f3, f1 = p * e2 + q * (G2 + off_plane), p * G1 + q * G0
    return Quartic(
        f4=q * e2,
        f3=side * f3,
        f2=p * G2 + q * G1 - s * off_plane,
        f1=side * f1,
        f0=p * G0,
        p=p,
        q=q,
        e0=e0,
        e1=side * e1,
        e2=e2,
        side=side,
        at_first=side < 0 and q > t,
    )


def position(lengths: TiltedLengths) -> Position:
    """The exact position of the two surfaces."""
    vertical = lengths.upright
    return upright.position(vertical) if vertical is not None else _decide(quartic(lengths)).position


def decide(lengths: TiltedLengths) -> TiltedDecision:
    """The exact position of the two surfaces, and whether they are tangent."""
    vertical = lengths.upright
    if vertical is None:
        return _decide(quartic(lengths))
    decision = upright.decide(vertical)
    return TiltedDecision(decision.position, decision.kind.limit_of)


def _decide(F: Quartic) -> TiltedDecision:
    contact = TiltedDecision(Position.CONTACT)
    if F.side == 0 or _variations(F.coefficients) < 3:
        return contact  # the centre on the hyperboloid, or one positive root alone
    sign = discriminant(F)
    if sign < 0:
        return contact
    if sign == 0:
        return _with_multiple_root(F)
    return contact if _three_beyond(F) else TiltedDecision(Position(F.side))


def _variations(signs: tuple[int, ...]) -> int:
    """How often the sign changes in a sequence, zeros left out."""
    count, last = 0, 0
    for value in signs:
        if value:
            positive = 1 if value > 0 else -1
            count += last == -positive
            last = positive
    return count


def discriminant(F: Quartic) -> int:
    """27 times the discriminant, by its two invariants."""
    a, b, c, d, e = F.coefficients
    ae, bd, cc = a * e, b * d, c * c
    H = 12 * ae - 3 * bd + cc
    J = c * (72 * ae + 9 * bd - 2 * cc) - 27 * (a * d * d + e * b * b)
    return 4 * H * H * H - J * J


def _three_beyond(F: Quartic) -> bool:
    """Whether all three positive roots, distinct ones, are ≥ ℓ.

    By Descartes' rule for the Taylor coefficients at ℓ, all roots being real: three changes of sign. F(ℓ) ≤ 0 may stand
    for −: where it is 0, the sign of F′(ℓ) at a simple root tells by itself which of the roots ℓ is.
    """
    signs = _signs_at_first(F) if F.at_first else _signs_at_second(F)
    return _variations((-1, *signs, 1)) == 3


def _derivative(F: Quartic, order: int) -> tuple[int, ...]:
    """The derivative of this order over its factorial, the highest power first."""
    if order == 1:
        return (4 * F.f4, 3 * F.f3, 2 * F.f2, F.f1)
    if order == 2:
        return (6 * F.f4, 3 * F.f3, F.f2)
    return (4 * F.f4, F.f3)


def sign_at(coefficients: tuple[int, ...], at: Fraction) -> int:
    """The sign of a polynomial, the highest power first, at a rational number."""
    return _sign_at(coefficients, at.numerator, at.denominator)


def _sign_at(coefficients: tuple[int, ...], numerator: int, denominator: int) -> int:
    value, scale = 0, 1
    for coefficient in coefficients:
        value = value * numerator + coefficient * scale
        scale *= denominator
    return (value > 0) - (value < 0)


def _signs_at_first(F: Quartic) -> list[int]:
    """The signs of the first three derivatives at p/q."""
    return [_sign_at(_derivative(F, order), F.p, F.q) for order in (1, 2, 3)]


def _signs_at_second(F: Quartic) -> list[int]:
    """The signs of the first three derivatives at ℓ = (e1 + √w)/D, w = e1² + 4 e0 e2, D = 2 e2 > 0."""
    e, D = F.e1, 2 * F.e2
    w = e * e + 2 * F.e0 * D
    square, twice = e * e + w, 2 * e  # (e + √w)² = square + twice √w
    cube, thrice = e * square + twice * w, square + e * twice  # (e + √w)³ = cube + thrice √w
    DD = D * D
    slope, curvature, last = 3 * F.f3 * D, 3 * F.f3 * D, F.f3 * D
    f2, f1 = F.f2 * DD, F.f1 * DD * D
    return [
        _sign_with_root(
            4 * F.f4 * cube + slope * square + 2 * f2 * e + f1,
            4 * F.f4 * thrice + slope * twice + 2 * f2,
            w,
        ),
        _sign_with_root(6 * F.f4 * square + curvature * e + f2, 6 * F.f4 * twice + curvature, w),
        _sign_with_root(4 * F.f4 * e + last, 4 * F.f4, w),
    ]


def _sign_with_root(u: int, r: int, w: int) -> int:
    """The sign of u + r √w, w > 0."""
    if u >= 0 and r >= 0:
        return int(u > 0 or r > 0)
    if u <= 0 and r <= 0:
        return -1
    difference = u * u - r * r * w
    return ((difference > 0) - (difference < 0)) * (1 if u > 0 else -1)


def _with_multiple_root(F: Quartic) -> TiltedDecision:
    """The decision where F has a multiple root, which is one number and rational."""
    m = double_root(F)
    if m <= 0 or (beyond := _beyond(F, m)) > 0:
        return TiltedDecision(Position.CONTACT)
    if beyond == 0 and sign_at(_derivative(F, 2), m) > 0:
        return TiltedDecision(Position(F.side))  # the simple root lies between 0 and ℓ
    return TiltedDecision(Position.CONTACT, limit_of=Position(F.side))


def _beyond(F: Quartic, m: Fraction) -> int:
    """The sign of m − ℓ, m > 0."""
    n, k = m.numerator, m.denominator
    past = F.q * n - F.p * k if F.at_first else F.e2 * n * n - F.e1 * n * k - F.e0 * k * k
    return (past > 0) - (past < 0)


def double_root(F: Quartic) -> Fraction:
    """The multiple root of a quartic that has exactly one (double or triple), by Euclid's algorithm on F and F′."""
    first: tuple[int, ...] = F.coefficients
    second: tuple[int, ...] = _derivative(F, 1)
    while second:
        first, second = second, _remainder(first, second)
    degree = len(first) - 1  # first is a multiple of (λ − m)^degree
    return Fraction(-first[1], degree * first[0])


def _remainder(first: tuple[int, ...], second: tuple[int, ...]) -> tuple[int, ...]:
    """A multiple of the remainder of two polynomials, without leading zeros."""
    rest = list(first)
    while len(rest) >= len(second):
        lead = rest[0]
        tail = [*second[1:], *[0] * (len(rest) - len(second))]
        rest = [second[0] * a - lead * b for a, b in zip(rest[1:], tail, strict=True)]
    while rest and rest[0] == 0:
        rest.pop(0)
    return tuple(rest)
