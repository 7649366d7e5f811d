"""Proofs for many centres beside bodies of one size, each a few products and a comparison in x² + y² and z².

Clearance. For a fixed λ in (0, B), g(λ) > 0 says P/(A+λ) − Q/(B−λ) > 1 + 1/λ, and for μ in (0, A), g(−μ) > 0 says
P/(A−μ) − Q/(B+μ) < 1 − 1/μ. With P = (x²+y²)/b² and Q = z²/d² these are the two sides of straight lines in x²+y², z²:

    exterior if x² + y² > K + M z²,   K = b² (A+λ)(1 + 1/λ),   M = (b²/d²) (A+λ)/(B−λ)
    interior if x² + y² < K + M z²,   K = b² (A−μ)(1 − 1/μ),   M = (b²/d²) (A−μ)/(B+μ)

Contact. The point of the hyperboloid at the centre's own height and azimuth is at the distance ρ from the axis,
ρ² = α² + (α/γ)² z², and lies inside the spheroid if |√(x²+y²) − ρ| < b.

A, B, K and M are exact rationals here, rounded once. Bound, u = 2⁻⁵³: x² + y² collects 2 factors 1+δ, |δ| ≤ u, and
K + M z² three, all of positive numbers, and rounding K or M one more; (1+u)^6/(1−u)^6 < 1 + 13u. K and M are moved by
64u to the safe side. batch.py asks with lengths in 2^±100 or zero: b²A = α², b²λ ≤ αb, d²B = γ², and a difference of
A or B and a float is 0 or not below 2^-160 of them, so that K and M lie in 2^±600: nothing over- or underflows.
√(x²+y²) and ρ are right to 4u of themselves; their difference may lack 64u of both, and b another 64u.

Any multiplier proves; good ones are double roots of g at a tangency. At height ζ = γ h of the surface that is about
a/√(1 + h²), exactly so at the waist, where c² > a or, inside, a > 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hypcheck.pairs import Position

MARGIN = 64 * 2.0**-53
SHARES = (0.0, 1 / 3, 2 / 3, 1.0)
"""Heights that have a line of their own, as parts of the height that is asked for."""

Floats = NDArray[np.float64]
Line = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Lines:
    """Pairs (K, M): exterior is what lies above one of the first, interior what lies below one of the second.

    `surface` is the line of ρ², (α², (α/γ)²), and `width` is b, on the safe side.
    """

    exterior: tuple[Line, ...]
    interior: tuple[Line, ...]
    surface: Line
    width: float

    def proved(self, squares: Floats, heights: Floats, otherwise: int) -> NDArray[np.int8]:
        """The position of centres with these x² + y² and z², int8 (n,), where it is proved so, else `otherwise`."""
        result = np.full(len(squares), otherwise, dtype=np.int8)
        for lines, nearest, beyond, position in (
            (self.exterior, np.minimum, np.greater, Position.EXTERIOR),
            (self.interior, np.maximum, np.less, Position.INTERIOR),
        ):
            if lines:
                border = _envelope(lines, heights, nearest)
                # By one of the two at most, so that adding does what choosing would, and many times faster.
                result += beyond(squares, border).view(np.int8) * np.int8(position - otherwise)
        rest = np.flatnonzero(result == otherwise)
        result[rest[self._touching(squares[rest], heights[rest])]] = Position.CONTACT
        return result

    def _touching(self, squares: Floats, heights: Floats) -> NDArray[np.bool_]:
        constant, slope = self.surface
        here, there = np.sqrt(squares), np.sqrt(constant + slope * heights)
        return np.asarray(np.abs(here - there) + MARGIN * (here + there) < self.width)


def _envelope(lines: tuple[Line, ...], heights: Floats, nearest: Callable[..., Floats]) -> Floats:
    """The least, or the greatest, of the lines at each height."""
    (first, slope), *others = lines
    border = slope * heights
    border += first
    for constant, slope in others:
        line = slope * heights
        line += constant
        nearest(border, line, out=border)
    return border


@lru_cache(maxsize=64)
def lines(alpha: float, gamma: float, b: float, d: float, reach: int) -> Lines:
    """Lines for these sizes, good for centres as high as γ 2^reach."""
    A, B = (Fraction(alpha) / Fraction(b)) ** 2, (Fraction(gamma) / Fraction(d)) ** 2
    across, slope = Fraction(b) ** 2, Fraction(b) ** 2 / Fraction(d) ** 2
    exterior, interior = [], []
    for share in SHARES:
        multiplier = Fraction(alpha / b / math.hypot(1.0, math.ldexp(share, reach)))
        if 0 < multiplier < B:
            constant = across * (A + multiplier) * (1 + 1 / multiplier)
            exterior.append((constant, slope * (A + multiplier) / (B - multiplier)))
        if 1 < multiplier < A:
            constant = across * (A - multiplier) * (1 - 1 / multiplier)
            interior.append((constant, slope * (A - multiplier) / (B + multiplier)))
    surface = alpha * alpha, (alpha / gamma) * (alpha / gamma)
    return Lines(_moved(exterior, 1 + MARGIN), _moved(interior, 1 - MARGIN), surface, b * (1 - MARGIN))


def _moved(exact: list[tuple[Fraction, Fraction]], factor: float) -> tuple[Line, ...]:
    """The lines in floats, moved to the safe side."""
    return tuple((float(constant) * factor, float(slope) * factor) for constant, slope in exact)
