"""The last stage: the coefficient rule for all regimes in integers, for the rows that floats cannot decide.

The lengths may be in any unit (pair.Lengths); everything is multiplied by N = b² d² > 0, or by a power of it, so that
nothing is divided. The rule is the program "coefficients" of derivation/formulas.py, whose ring condition is here the
equal one that no sign of Δ is asked for: z = 0, g'(B) = 0 and the remaining root below B.
"""

from __future__ import annotations

from hypcheck.geometry.pair import Lengths, Position


def position(lengths: Lengths) -> Position:
    """The exact position; lengths as in pairs.Lengths."""
    return position_of_squares(
        lengths.alpha**2,
        lengths.b**2,
        lengths.gamma**2,
        lengths.d**2,
        lengths.x**2 + lengths.y**2,
        lengths.z**2,
    )


def position_of_squares(p: int, q: int, s: int, t: int, radius: int, height: int) -> Position:
    """The same from the squares of α, b, γ, d, of the centre's distance from the axis, and of its height."""
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
