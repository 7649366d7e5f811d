"""The proof of an answer, and its check, in rational arithmetic alone.

Three numbers or points are enough (docs/mathematics.md, "A certificate for every answer"):

- exterior: a λ in (0, B) with g(λ) > 0; interior: a λ in (−A, 0) with g(λ) > 0;
- contact: two points of the closed spheroid on opposite sides of the hyperboloid, or one that lies on it;
- tangency: the double root m of g, in [−A, 0) or (0, B], but not m = B with the simple root below B (the ring).

This module shares no code with the one that makes certificates: it starts from the seven floats and the definitions.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.geometry.pair import Pair, Position

Point = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True, slots=True)
class Certificate:
    """A claim with its witness: `multiplier` λ, or `points` (in the caller's coordinates), or `double_root` m."""

    position: Position
    multiplier: Fraction | None = None
    points: tuple[Point, ...] = ()
    double_root: Fraction | None = None


def check_certificate(pair: Pair, certificate: Certificate) -> bool:
    """Whether the certificate proves its claim about this pair; a double root proves tangency, not contact alone.

    Numbers of other types are taken as the rationals that they are: with one float all would be rounded, and g > 0
    could come of that. Raises ValueError for a claim that is no position, and for NaN.
    """
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
    at, m = (None if each is None else Fraction(each) for each in (certificate.multiplier, certificate.double_root))
    claim = Position(certificate.position)
    if claim is not Position.CONTACT:
        if at is None or not (0 < at < B if claim is Position.EXTERIOR else -A < at < 0):
            return False
        return (A + at) * (B - at) * (P + Q - 1 - at) - A * P * (B - at) - B * Q * (A + at) > 0
    if m is not None:
        c2, c1, c0 = A - B + 1 - P - Q, B * P - A * Q + A - B - A * B, -A * B
        double = ((m + c2) * m + c1) * m + c0 == 0 and (3 * m + 2 * c2) * m + c1 == 0
        ring = m == B and -c2 - 2 * m < B
        return double and m != 0 and -A <= m <= B and not ring
    sides = set()
    for u, v, w in (map(Fraction, point) for point in certificate.points):
        if ((u - x) ** 2 + (v - y) ** 2) / b**2 + ((w - z) / d) ** 2 > 1:
            return False
        height = (u * u + v * v) / alpha**2 - (w / gamma) ** 2 - 1
        sides.add((height > 0) - (height < 0))
    return 0 in sides or sides == {-1, 1}
