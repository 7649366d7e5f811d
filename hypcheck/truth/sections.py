"""The rule in the height: in which horizontal planes the spheroid meets the hyperboloid's circle.

Horizontal means across the hyperboloid's axis. At height w the plane cuts the hyperboloid in a circle of radius r,
r² = α² (1 + w²/γ²), and the solid spheroid in an ellipse whose axes have the same directions at every height: one is
horizontal and perpendicular to the spheroid's axis (eigenvalue μ₁ = 1/b²), the other in the plane of both axes (μ₂).
With (η, ξ) the centre of the ellipse in these directions and k = 1 − (w − z)²/(its half height)²,

    e = μ₁ (X − η)² + μ₂ (Y − ξ)² − k ≤ 0 in the ellipse.

By Lagrange's duality for one quadratic equation (the trust region's boundary) the least e on the circle is the
supremum of φ(λ) for λ > −μ, μ the smaller eigenvalue, where (μ₁ + λ)(μ₂ + λ) φ(λ) is the cubic

    g(λ) = −(k + λ r²)(μ₁ + λ)(μ₂ + λ) + λ μ₁ η² (μ₂ + λ) + λ μ₂ ξ² (μ₁ + λ).

In ν = λ + μ its coefficients c3 < 0, c2, c1, c0 ≤ 0 are polynomials in w of degree 2, and g(−μ) ≤ 0. So by Descartes'
rule the circle misses the ellipse, that is g > 0 for some ν > 0, if and only if

    c2 > 0 or c1 > 0,   and   the discriminant Δ > 0 or c0 = c1 = 0.

The least e on the circle is continuous in w, and where it is 0, Δ = 0. Between two heights whose circles miss the
spheroid, the wall therefore meets it if and only if Δ has a root there at which not c0 = c1 = 0 < c2. Sturm's theorem
counts the roots of Δ, Tarski's the others. Where c0 = 0 at all heights, Δ = c1² (c2² − 4 c3 c1), and where c1 = 0 too,
c2 alone decides. For an upright spheroid c2² − 4 c3 c1 is the quartic Q² − 4 R r² of docs/mathematics.md.

All is done in integers. `upward` u need not be vertical or of length 1: with U = u·u the variable is w √U, and a height
z is the number z √U.

`position` is the oracle of heights. There is no λ of the pencil S + λH here, and no distance: where the hyperboloid has
no ends, nothing is shared with the other oracles. Where it ends, the exact decision asks `Sections` after the pencil.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from hypcheck.geometry.arithmetic import changes_of_sign, cross, dot, root_of, sign_with_root
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth.polynomials import (
    Polynomial,
    common_divisor,
    derivative,
    polynomial_product,
    polynomial_sum,
    primitive,
    roots_from_0_to_1,
    scaled,
    separated,
    signed_chain,
    squarefree,
    trimmed,
)

Height = int | None
"""A height over √U; None is infinite: −∞ at the lower end, ∞ at the upper."""


@dataclass(frozen=True, slots=True)
class Sections:
    """The sections by horizontal planes: polynomials in the variable w √U, w a height, each up to a positive factor.

    The letters are those of the module's docstring. `cubic` is c3, c2, c1, c0. `above` is the height over the
    spheroid's centre. `inside` is k, ≥ 0 where the plane meets the spheroid. `off` is η² + ξ² − r², ≤ 0 where the
    ellipse's centre lies in the circle. `unit` is U. The λ of S + λH is (ν − `pole`)/`scale`.
    """

    cubic: tuple[Polynomial, Polynomial, Polynomial, Polynomial]
    above: Polynomial
    inside: Polynomial
    off: Polynomial
    unit: int
    pole: int
    scale: Fraction

    @classmethod
    def of(cls, lengths: Lengths, *, over_content: bool = True) -> Sections:
        """Make the sections of a pair; with `over_content` the coefficients of g are divided by their common divisor.

        Without that, their values at a height are polynomials in the coordinates of the spheroid's centre.
        """
        q, t = lengths.b**2, lengths.d**2
        u, v, C = lengths.upward, lengths.axis, (lengths.x, lengths.y, lengths.z)
        U, V, product, height, along = dot(u, u), dot(v, v), dot(v, u), dot(C, u), dot(C, v)
        W = V * U - product * product
        m1 = t * U * V
        m2 = m1 + (q - t) * W
        p, s = lengths.alpha**2, lengths.gamma**2 * U
        above = (1, -height)
        k = _sum((m2,), scaled(-V, polynomial_product(above, above)))
        r2 = (p, 0, p * s)
        if W:
            line = _sum(((U * along - product * height) * m2,), scaled(-(q - t) * W * product, above))
            eta = (m2 * s * m1 * dot(C, cross(u, v)) ** 2,)
            xi = scaled(lengths.gamma**2, polynomial_product(line, line))
        else:
            W, eta, xi = 1, (m2 * lengths.gamma**2 * m1 * (U * dot(C, C) - height * height),), ()
        A0, A1 = scaled(s * W * q * m1, k), scaled(m2 * W, r2)
        cubic = _shifted(A0, A1, eta, xi, m1, m2)
        if over_content:
            cubic = _over_content(*cubic)
        return cls(cubic, above, k, _off(A1, eta, xi, m1, m2), U, min(m1, m2), Fraction(q * m1, p))

    def sign(self, f: Polynomial, height: int | Fraction) -> int:
        """Return the sign of a polynomial at a height."""
        return sign_with_root(*self.value(f, height), self.unit)

    def value(self, f: Polynomial, height: int | Fraction) -> tuple[int | Fraction, int | Fraction]:
        """Return u and v of the value u + v √U of a polynomial at a height."""
        even: int | Fraction = 0
        odd: int | Fraction = 0
        for place, coefficient in enumerate(reversed(f)):
            term = coefficient * height**place * self.unit ** (place // 2)
            even, odd = (even, odd + term) if place % 2 else (even + term, odd)
        return even, odd

    def multiplier(self, height: Fraction) -> Fraction:
        """Return approximately the λ at which φ is greatest for the plane at this height; U is 1.

        It is the λ of S + λH.
        """
        c3, c2, c1, _ = (_value(c, height) for c in self.cubic)
        inner = c2 * c2 - 3 * c3 * c1
        top = (c2 + root_of(inner, 64)) / (-3 * c3) if inner > 0 else c2 / (-3 * c3)
        return (top - self.pole) / self.scale

    def circle_misses(self, height: int | Fraction) -> bool:
        """Decide whether the circle at this height and the spheroid have no point in common."""
        _, c2, c1, c0 = (self.sign(c, height) for c in self.cubic)
        if max(c2, c1) <= 0:
            return False
        return c0 == c1 == 0 or self.sign(discriminant(self.cubic), height) > 0

    def disc_misses(self, height: int) -> bool:
        """Decide whether the flat end at this height, a disc, and the spheroid have no point in common."""
        return self.circle_misses(height) and (self.sign(self.inside, height) < 0 or self.sign(self.off, height) > 0)

    def disc_crosses(self, height: int) -> bool:
        """Decide whether points of the disc at this height, not all on its rim, lie inside the spheroid."""
        return self.sign(self.inside, height) > 0 and self.sign(self.off, height) < 0

    @property
    def reach(self) -> tuple[int, int]:
        """Two integers between which the variable w √U lies at all heights w of the spheroid."""
        (_, center), (leading, _, last) = self.above, self.inside
        half = math.isqrt((last * -leading + (leading * center) ** 2) // leading**2) + 1
        return -center - half, half - center

    @property
    def reach_in_heights(self) -> tuple[int, int]:
        """Two integers between which all heights of the spheroid lie."""
        first, last = self.reach
        return _floor_of_quotient(first, self.unit), -_floor_of_quotient(-last, self.unit)

    def between(self, low: Height, high: Height) -> tuple[int, int]:
        """Return integers between which the variable w √U lies at all common points of the spheroid and the wall."""
        first, last = self.reach
        if low is not None:
            first = max(first, _floor_of_multiple(low, self.unit))
        if high is not None:
            last = min(last, -_floor_of_multiple(-high, self.unit))
        return first, last

    def wall_misses(self, low: Height, high: Height) -> bool:
        """Decide whether the wall between two heights and the spheroid have no point in common."""
        if not all(self.circle_misses(height) for height in (low, high) if height is not None):
            return False
        _, c2, c1, c0 = self.cubic
        apart = common_divisor(c0, c1)
        if len(apart) <= 1:
            lowest, highest = self.between(low, high)
            some = has_root(discriminant(self.cubic) if apart else c2, lowest, highest)
            if some is not None and (self.unit == 1 or not some):
                return not some
        f = self.critical
        roots = self.roots(signed_chain(f, derivative(f)), low, high)
        if len(apart) <= 1 or not roots:
            return roots == 0
        apart = squarefree(apart)  # at its roots with c2 > 0 the circle misses, though Δ = 0
        chains = signed_chain(apart, derivative(apart)), signed_chain(apart, polynomial_product(derivative(apart), c2))
        return 2 * roots == sum(self.roots(chain, low, high) for chain in chains)

    def wall_crosses(self, low: int, high: int) -> bool:
        """Decide whether points of the wall between two heights lie strictly inside the spheroid.

        Between two roots next to each other of the critical polynomial the least e of the circles keeps its sign: one
        height in each gap is asked, and the two ends, for the gaps that they cut.
        """
        f = self.critical
        if any(self.sign(f, end) and not self.circle_misses(end) for end in (low, high)):
            return True
        first, last = self.between(low, high)
        if first >= last:
            return False
        roots = roots_from_0_to_1(primitive(_coefficients_between(f, first, last)))
        gaps = ((below + above) / 2 for (_, below), (above, _) in itertools.pairwise(roots))
        by_variable = replace(self, unit=1)
        return any(
            sign_with_root(at, -low, self.unit) > 0 > sign_with_root(at, -high, self.unit)
            and not by_variable.circle_misses(at)
            for at in (first + (last - first) * gap for gap in gaps)
        )

    @property
    def critical(self) -> Polynomial:
        """A polynomial with simple roots that is 0 at all heights where the circle just touches the spheroid."""
        _, c2, c1, c0 = self.cubic
        return squarefree(discriminant(self.cubic) if c0 or c1 else c2)

    def roots(self, chain: Sequence[Polynomial], low: Height | Fraction, high: Height | Fraction) -> int:
        """Count the roots of a polynomial f from `low`, which is left out, to `high`, by its Sturm chain.

        f has only simple roots, and `chain` begins with f, f′. If it begins with f, f′ h, the result is the sum of the
        signs of h at these roots; h must be > 0 at `low` and `high` if these are roots.
        """
        return self._changes(chain, low, -1) - self._changes(chain, high, 1)

    def _changes(self, chain: Sequence[Polynomial], height: Height | Fraction, far: int) -> int:
        """Return the number of sign changes in the chain at a height, or at −∞ or ∞."""
        if height is None:
            return changes_of_sign(f[0] * (far if len(f) % 2 == 0 else 1) for f in chain)
        return changes_of_sign(self.sign(f, height) for f in chain)


def position(pair: Pair) -> Position:
    """Return the exact position of a pair: whether some horizontal plane cuts both surfaces where they meet."""
    lengths = pair.lengths
    sections, ends = Sections.of(lengths), [end for end in (lengths.low, lengths.high) if end is not None]
    if not sections.wall_misses(lengths.low, lengths.high):
        return Position.CONTACT
    if lengths.solid and not all(sections.disc_misses(end) for end in ends):
        return Position.CONTACT
    R, p, s = lengths.x**2 + lengths.y**2, lengths.alpha**2, lengths.gamma**2
    outside = R * s > p * (s + lengths.z**2)
    between = (lengths.low is None or lengths.low <= lengths.z) and (lengths.high is None or lengths.z <= lengths.high)
    return Position.INTERIOR if between and not outside else Position.EXTERIOR


def discriminant(cubic: tuple[Polynomial, Polynomial, Polynomial, Polynomial]) -> Polynomial:
    """Return the discriminant Δ of the cubic in ν, except for a constant factor > 0."""
    c3, c2, c1, c0 = cubic
    outer, inner = polynomial_product(c3, c1), polynomial_product(c2, c2)
    rest = _sum(inner, scaled(-4, outer))
    if not c0 and len(c1) == 1:
        return rest
    cross = _sum(scaled(-4, polynomial_product(inner, c2)), scaled(18, polynomial_product(outer, c2)))
    ends = polynomial_product(c3, c0)
    return _sum(
        polynomial_product(polynomial_product(c1, c1), rest),
        polynomial_product(c0, cross),
        scaled(-27, polynomial_product(ends, ends)),
    )


def _shifted(
    A0: Polynomial, A1: Polynomial, eta: Polynomial, xi: Polynomial, m1: int, m2: int
) -> tuple[Polynomial, Polynomial, Polynomial, Polynomial]:
    """Expand −(A0 + κ A1)(m1 + κ)(m2 + κ) + κ eta (m2 + κ) + κ xi (m1 + κ) in ν = κ + min(m1, m2); return c3 to c0."""
    m, gap = min(m1, m2), abs(m2 - m1)
    first, second = (eta, xi) if m1 <= m2 else (xi, eta)
    at_least = _sum(A0, scaled(-m, A1))
    c2 = _sum(scaled(-1, at_least), scaled(-gap, A1), first, second)
    c1 = _sum(scaled(-gap, at_least), scaled(gap - m, first), scaled(-m, second))
    return scaled(-1, A1), c2, c1, trimmed(scaled(-m * gap, first))


def _off(A1: Polynomial, eta: Polynomial, xi: Polynomial, m1: int, m2: int) -> Polynomial:
    """Return η² + ξ² − r², up to a positive factor: `off` of Sections."""
    return primitive(_sum(scaled(m2, eta), scaled(m1, xi), scaled(-m1 * m2, A1)))


def _over_content(*polynomials: Polynomial) -> tuple[Polynomial, Polynomial, Polynomial, Polynomial]:
    """Divide four polynomials by the greatest number that divides all coefficients."""
    content = math.gcd(*(coefficient for f in polynomials for coefficient in f))
    c3, c2, c1, c0 = (tuple(coefficient // content for coefficient in f) for f in polynomials)
    return c3, c2, c1, c0


def _sum(*terms: Polynomial) -> Polynomial:
    """Add polynomials, without leading zeros."""
    return trimmed(polynomial_sum(*terms))


def _value(f: Polynomial, at: Fraction) -> Fraction:
    """Return f(at)."""
    total = Fraction(0)
    for coefficient in f:
        total = total * at + coefficient
    return total


def _floor_of_multiple(number: int, unit: int) -> int:
    """Return number √unit, rounded down."""
    if unit == 1:
        return number
    root = math.isqrt(number * number * unit)
    return root if number >= 0 else -root - 1


def _floor_of_quotient(number: int, unit: int) -> int:
    """Return number/√unit, rounded down."""
    root = math.isqrt(number * number // unit)
    return root if number >= 0 else -root - 1


MOST_HALVINGS = 8
"""The number of halvings after which Sturm's theorem decides: Descartes' rule never decides about a multiple root."""


def has_root(f: Polynomial, low: int, high: int) -> bool | None:
    """Decide whether f has a root between low < high, which are no roots; None if Descartes' rule cannot decide."""
    first = next(separated(_coefficients_between(f, low, high), MOST_HALVINGS), None)
    if first is None:
        return False
    return True if first[2] <= 1 else None


def _coefficients_between(f: Polynomial, low: int, high: int) -> list[int]:
    """Return the coefficients of f(low + (high − low) s), the highest power of s first."""
    shifted = list(f)
    for last in range(len(f) - 1, 0, -1):  # Horner's scheme, from powers of x to powers of x − low
        for place in range(1, last + 1):
            shifted[place] += low * shifted[place - 1]
    width, power = high - low, 1
    for place in range(len(f) - 2, -1, -1):
        power *= width
        shifted[place] *= power
    return shifted
