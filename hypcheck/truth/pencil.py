"""The pencil S + λH of a spheroid and a hyperboloid: its determinant as a polynomial in λ, in integers.

S and H are the two surfaces' 4×4 matrices, M and D their upper 3×3 parts. With p = α², s = γ², q = b², t = d².

**Upright.** The determinant has the known root −A and the cubic g of equation (14) of the paper is left. With
R = x² + y² and S = z², each group of lengths in its own unit, A = p/q, B = s/t, P = R/q, Q = S/t, and N = q t > 0 times
g is n3 λ³ + n2 λ² + n1 λ + n0.

**Tilted.** Let v be the axis, V = v·v, c = v_z², W = V − c. A horizontal n perpendicular to v splits the 3×3 pencil
into 1/q + λ/p along n and a 2×2 block. Up to positive factors their determinants are

    L = p + q λ     E = p s V + λ (s g1 − p g2) − λ² q t V,     g1 = t W + q c,  g2 = q W + t c,

and with R = x² + y², Z = z², N = x v_y − y v_x, T = (x v_x + y v_y) z v_z (expand det(S + λH); the tests do)

    p² q² s t V det(S + λH) = F = L G − (q − t) N² λ² (s − q λ)
    G = −(1 + λ) E + λ (R s − Z p) V − λ² (R g2 + Z g1 + 2 (q − t) T).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import Lengths
from hypcheck.truth.polynomial_roots import polynomial_product
from hypcheck.truth.rationals import power_near


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


def quartic(lengths: Lengths) -> Quartic:
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


def sign_at(coefficients: tuple[int, ...], at: Fraction) -> int:
    """The sign of a polynomial, the highest power first, at a rational number."""
    return sign_at_ratio(coefficients, at.numerator, at.denominator)


def sign_at_ratio(coefficients: tuple[int, ...], numerator: int, denominator: int) -> int:
    """The sign of a polynomial, the highest power first, at numerator/denominator, the denominator > 0."""
    value, scale = 0, 1
    for coefficient in coefficients:
        value = value * numerator + coefficient * scale
        scale *= denominator
    return (value > 0) - (value < 0)


def slope_of_quotient(F: Quartic) -> tuple[int, ...]:
    """A polynomial that has the sign of φ′ on (0, ℓ), the highest power first.

    φ is F over the determinant of M + λD, up to a positive factor, so that its slope has the sign of
    F′ K − F K′, K = (p ± q μ)(e0 + e1 μ − e2 μ²).
    """
    signed = F.side * F.q
    K = (-signed * F.e2, signed * F.e1 - F.p * F.e2, signed * F.e0 + F.p * F.e1, F.p * F.e0)
    return _difference(polynomial_product(_derived(F.coefficients), K), polynomial_product(F.coefficients, _derived(K)))


def toward_maximum(F: Quartic) -> Iterator[Fraction]:
    """Numbers μ > 0 that tend to where φ has its maximum on (0, ℓ], by bisection; not all of them are < ℓ."""
    slope = slope_of_quotient(F)
    largest = max(abs(each) for each in (*F.coefficients, *slope)).bit_length()
    low, high = Fraction(1, 2 << largest), Fraction(2 << largest)
    while True:
        middle = power_near(low, high) if high > 4 * low else (low + high) / 2
        yield middle
        if inside(F, middle) and sign_at(slope, middle) > 0:
            low = middle
        else:
            high = middle


def inside(F: Quartic, at: Fraction) -> bool:
    """Whether 0 < at < ℓ."""
    n, k = at.numerator, at.denominator
    before_first = F.side > 0 or F.q * n < F.p * k
    return n > 0 and before_first and F.e2 * n * n - F.e1 * n * k < F.e0 * k * k


def _derived(f: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(each * (len(f) - 1 - i) for i, each in enumerate(f[:-1]))


def _difference(f: tuple[int, ...], g: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(a - b for a, b in zip(f, g, strict=True))
