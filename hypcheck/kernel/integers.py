"""The last stage: exact positions in integers, over all of float64, for the rows that floats cannot decide.

**Upright**, the coefficient rule for all regimes. The lengths may be in any unit (pair.Lengths); everything is
multiplied by N = b² d² > 0, or by a power of it, so that nothing is divided. The rule is the program "coefficients" of
derivation/formulas.py, but with an equivalent ring condition that does not need the sign of Δ: z = 0, g'(B) = 0 and the
remaining root below B.

**Tilted.** With p, q, s, t the squares of α, b, γ, d, with the axis v and w = v·v, and λ the multiplier of the pencil
S + λH,

    F(λ) = p² q² s t w det(S + λH) = λ (λ E + (p + qλ)(G − λ m)) − (1 + λ)(p + qλ) K(λ),   K(λ) = k0 + k1 λ − k2 λ²

is the quartic of the pair in whole numbers (programs/integers.py has E, G, m and K). The poles of the dual
function φ = F/((p + qλ) K) are −A1 = −p/q and the roots −A2 < 0 < B of K; S + λH is positive definite exactly where
F > 0 between λ₋ = −min(A1, A2) and B. F(0) < 0 < F(±∞), F(B) ≤ 0, F(λ₋) ≤ 0, and φ is concave from λ₋ to B, so

    exterior: two roots in (0, B], or one and a double root at B; one root ≥ B; one root < 0;
    interior: the same with [λ₋, 0) for (0, B];          contact: everything else.

The discriminant Δ of F distinguishes these, not the roots' places. Δ < 0: two roots are complex, contact. Δ > 0: four
roots are real, and Descartes' rule is exact: three are positive or three negative. The pair is clear if at most one of
them lies beyond the pole, which the same rule says of F's coefficients at the pole; the pole is a root of a quadratic,
so each sign is that of some U + V √D. Δ = 0: a tangency, unless the pole is a double root with F > 0 beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.arithmetic import changes_of_sign, cross, dot, sign_of, sign_with_root
from hypcheck.geometry.pair import COLUMNS, Lengths, Pair, Position, to_integers


def upright_position(lengths: Lengths) -> Position:
    """Return the exact position of an upright pair, whose lengths are as in pair.Lengths."""
    return upright_position_of_squares(
        lengths.alpha**2,
        lengths.b**2,
        lengths.gamma**2,
        lengths.d**2,
        lengths.x**2 + lengths.y**2,
        lengths.z**2,
    )


def upright_position_of_squares(p: int, q: int, s: int, t: int, radius: int, height: int) -> Position:
    """Return the position from the squares of α, b, γ, d, of the centre's distance from the axis, and of its height."""
    N = q * t
    C2 = (p + q - radius) * t - (s + height) * q  # N c2
    C1 = p * (t - s - height) + s * (radius - q)  # N c1
    C0 = -p * s  # N c0
    h1, h2, h3 = C2 * C2 - 3 * N * C1, C2 * C1 - 9 * N * C0, C1 * C1 - 3 * C2 * C0
    delta = 4 * h1 * h3 - h2 * h2  # 3 N⁴ Δ
    slope_at_B = 3 * N * s * s + 2 * C2 * s * t + C1 * t * t  # N t² g'(B)
    if delta > 0:
        if C2 < 0 and C1 > 0:
            beyond_B = C2 * t < -3 * N * s and slope_at_B > 0
            return Position.CONTACT if beyond_B else Position.EXTERIOR
        slope_at_A = 3 * N * p * p - 2 * C2 * p * q + C1 * q * q  # N q² g'(−A)
        inside = C2 * q < 3 * N * p and slope_at_A > 0
        return Position.INTERIOR if inside else Position.CONTACT
    # The ring: B is a double root (z = 0 makes it a root), and the simple one, A/B by Vieta, lies below it.
    ring = height == 0 and slope_at_B == 0 and p * t * t < q * s * s
    return Position.EXTERIOR if ring else Position.CONTACT


@dataclass(frozen=True, slots=True)
class QuarticWithPoles:
    """F's coefficients, lowest first, and the numbers that give its poles: −p/q and the roots of k0 + k1 λ − k2 λ²."""

    f: tuple[int, int, int, int, int]
    p: int
    q: int
    oblate: bool
    k: tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Squares:
    """The integers that determine a pair's position: all lengths in one unit and both axes in another.

    p, q, s, t are α², b², γ², d². `upward` and `level` are the squares of the parts of the spheroid's axis v along and
    across the hyperboloid's axis, `height` and `radius` those of the centre C. `cross` and `along` are the squares of
    the part of v × C along the hyperboloid's axis, and of v·C.
    """

    p: int
    q: int
    s: int
    t: int
    level: int
    upward: int
    radius: int
    height: int
    cross: int
    along: int

    @property
    def upright(self) -> bool:
        """Whether the axes are parallel, or the spheroid is a sphere."""
        return self.level == 0 or self.q == self.t


def squares(row: Sequence[float]) -> Squares:
    """Return the squares of a row of ten, in units that make all of its numbers whole."""
    alpha, gamma, b, d, x, y, z = to_integers(row[:7])
    vx, vy, vz = to_integers(row[7:])
    cross, along = vx * y - vy * x, vx * x + vy * y + vz * z
    return Squares(
        alpha * alpha, b * b, gamma * gamma, d * d, vx * vx + vy * vy, vz * vz,
        x * x + y * y, z * z, cross * cross, along * along,
    )  # fmt: skip


def squares_between_axes(
    sizes: Sequence[float], centre: Sequence[Fraction | float], axis: Sequence[float], other: Sequence[float]
) -> Squares:
    """Return the squares for a tilted hyperboloid with axis `other`, w.

    `centre` is the spheroid's, from the hyperboloid's.

    Nothing is rotated: with W = w·w, C·w and v·w the parts along w are (C·w)²/W and (v·w)²/W, and those across are what
    is left of C·C and v·v; the part of v × C along w is det(v, C, w)²/W. All are multiplied by as many W as they need.
    """
    alpha, gamma, b, d, x, y, z = to_integers((*sizes, *centre))
    v, w, C = to_integers(axis), to_integers(other), (x, y, z)
    W, upward, height = dot(w, w), dot(v, w), dot(C, w)
    p, q, s, t = (W * length * length for length in (alpha, b, gamma, d))
    return Squares(
        p, q, s, t, W * dot(v, v) - upward * upward, upward * upward,
        W * dot(C, C) - height * height, height * height, W * dot(v, cross(C, w)) ** 2, (W * dot(v, C)) ** 2,
    )  # fmt: skip


def quartic(of: Squares) -> QuarticWithPoles:
    """Return the quartic of a pair whose axes are not parallel, and whose spheroid is not a sphere."""
    p, q, s, t = of.p, of.q, of.s, of.t
    w = of.level + of.upward
    E = (t - q) * (s + p) * of.cross
    G = w * (s * of.radius - p * of.height)
    m = t * w * (of.radius + of.height) + (q - t) * of.along
    k0, k2 = p * s * w, q * t * w
    k1 = s * (t * of.level + q * of.upward) - p * (t * of.upward + q * of.level)
    f = (
        -p * k0,
        p * (G - k1) - (p + q) * k0,
        E + q * (G - k0) + p * (k2 - m) - (p + q) * k1,
        q * (-m - k1) + (p + q) * k2,
        q * k2,
    )
    return QuarticWithPoles(f, p, q, q > t, (k0, k1, k2))


def position(row: Sequence[float]) -> Position:
    """Return the exact position of a valid row of ten."""
    if row[7] == row[8] == 0 or row[2] == row[3]:
        return upright_position(Pair.from_row(row[: len(COLUMNS)]).lengths)
    return position_of_squares(squares(row))


def position_of_squares(of: Squares) -> Position:
    """Return the exact position of the pair that has these squares."""
    if of.upright:
        return upright_position_of_squares(of.p, of.q, of.s, of.t, of.radius, of.height)
    pair = quartic(of)
    delta = discriminant(pair.f)
    if delta < 0:
        return Position.CONTACT
    if delta == 0:
        return _on_a_pole(pair)
    side = Position.EXTERIOR if changes_of_sign(pair.f) == 3 else Position.INTERIOR
    return side if changes_of_sign(_outwards(pair, side)) <= 1 else Position.CONTACT


def discriminant(f: tuple[int, int, int, int, int]) -> int:
    """Return 27 times the discriminant of the quartic."""
    e, d, c, b, a = f
    i = 12 * a * e - 3 * b * d + c * c
    j = 72 * a * c * e + 9 * b * c * d - 27 * (a * d * d + e * b * b) - 2 * c * c * c
    return 4 * i * i * i - j * j


def _on_a_pole(pair: QuarticWithPoles) -> Position:
    """Return the position where F has a multiple root: clear where that is a pole and F > 0 on its inner side."""
    for side in (Position.EXTERIOR, Position.INTERIOR):
        value, slope, curve = _outwards(pair, side)[:3]
        if value == slope == 0 and curve > 0:
            return side
    return Position.CONTACT


def _outwards(pair: QuarticWithPoles, side: Position) -> list[int]:
    """Return the signs of the coefficients of F in the distance beyond the pole on that side, lowest first."""
    at_ratio = side < 0 and pair.oblate
    signs = _at_ratio(pair.f, -pair.p, pair.q) if at_ratio else _at_root(pair, side)
    return [sign if side > 0 or power % 2 == 0 else -sign for power, sign in enumerate(signs)]


def _at_ratio(f: Sequence[int], over: int, under: int) -> list[int]:
    """Return the signs of F's coefficients at over/under, under > 0."""
    left = [coefficient * under ** (4 - power) for power, coefficient in enumerate(f)]
    for first in range(4):
        for power in range(3, first - 1, -1):
            left[power] += over * left[power + 1]
    return [sign_of(coefficient) for coefficient in left]


def _at_root(pair: QuarticWithPoles, side: Position) -> list[int]:
    """Return the signs of F's coefficients at B (side 1) or −A2.

    Each coefficient is u + vμ with μ = k2 λ, a root of μ² = k1 μ + k0 k2.
    """
    (f0, f1, f2, f3, _), (k0, k1, k2) = pair.f, pair.k
    left = [(k2**3 * f0, 0), (k2 * k2 * f1, 0), (k2 * f2, 0), (f3, 0), (pair.q, 0)]
    for first in range(4):
        for power in range(3, first - 1, -1):
            (u, v), (c, d) = left[power + 1], left[power]
            left[power] = c + v * k0 * k2, d + u + v * k1
    D = k1 * k1 + 4 * k0 * k2
    return [sign_with_root(2 * u + v * k1, side * v, D) for u, v in left]
