"""Exact positions of many rows: floats with error bounds decide most of them, exact.py decides the rest.

The filter looks for the parts of a certificate (certificate.py): a λ with g(λ) > 0, or two points of the spheroid on
opposite sides of the hyperboloid. The way in which a witness is found does not matter; only its check decides, and each
check compares two sums of positive terms.

Bound of the checks. u = 2⁻⁵³. A = (α/b)² and B, Q alike carry a factor (1+δ)^k, |δ| ≤ u, with k ≤ 3; P = (x²+y²)/b² k ≤
4; both sides of a comparison are sums, products and quotients of positive numbers, so the factors only add up: no side
below collects more than k = 16. (1+u)^16/(1−u)^16 < 1 + 33u, so MARGIN = 1 + 64u is more than enough. If a difference
of such numbers is needed (B − λ, r − 1), one operand is first moved by the margin to the safe side; k includes one more
rounding of the result. The roots r and a√(1+Q/B) are right to 4u and 10u of themselves, so that their difference lacks
no more than 64u of both. `_safe` keeps every square, quotient and sum away from overflow and underflow: with lengths in
2^±100 (or zero) A, B, P, Q lie in 2^±401, λ is asked to lie in 2^±450, and a difference of such numbers is 0 or at
least 2^-504, so that every quotient stays within 2^±960.

If all rows have the same sizes, lines are tested first: each costs a few products and a comparison in x² + y² and z².

Clearance. For a fixed λ in (0, B), g(λ) > 0 says P/(A+λ) − Q/(B−λ) > 1 + 1/λ, and for μ in (0, A), g(−μ) > 0 says
P/(A−μ) − Q/(B+μ) < 1 − 1/μ. With P = (x²+y²)/b² and Q = z²/d² these are the two sides of straight lines in x²+y², z²:

    exterior if x² + y² > K + M z²,   K = b² (A+λ)(1 + 1/λ),   M = (b²/d²) (A+λ)/(B−λ)
    interior if x² + y² < K + M z²,   K = b² (A−μ)(1 − 1/μ),   M = (b²/d²) (A−μ)/(B+μ)

Contact. The point of the hyperboloid at the centre's own height and azimuth is at the distance ρ from the axis,
ρ² = α² + (α/γ)² z², and lies inside the spheroid if |√(x²+y²) − ρ| < b.

A, B, K and M are exact rationals here, rounded once. Bound: x² + y² collects 2 factors 1+δ, |δ| ≤ u, and K + M z²
three, all of positive numbers, and rounding K or M one more; (1+u)^6/(1−u)^6 < 1 + 13u. K and M are moved by 64u to the
safe side. Lengths lie in 2^±100 or are zero: b²A = α², b²λ ≤ αb, d²B = γ², and a difference of A or B and a float is 0
or not below 2^-160 of them, so that K and M lie in 2^±600: nothing over- or underflows. √(x²+y²) and ρ are right to 4u
of themselves; their difference may lack 64u of both, and b another 64u.

Every multiplier gives a proof; good multipliers are double roots of g at a tangency. At height ζ = γ h of the surface
that is about a/√(1 + h²), exactly so at the waist, where c² > a or, inside, a > 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np

from hypcheck.geometry.pair import COLUMNS, TILTED_COLUMNS, Lengths, Pair, Position
from hypcheck.geometry.rows import PAIRS, Floats, Mask, Positions, Rows, require_valid, upright_mask
from hypcheck.truth import exact

LINE_MARGIN = 64 * 2.0**-53
SHARES = (0.0, 1 / 3, 2 / 3, 1.0)
"""Heights that have a line of their own, as parts of the requested height."""

Line = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SizeLines:
    """Lines (K, M): centres above one of the first lines are exterior, centres below one of the second are interior.

    `surface` is the line of ρ², (α², (α/γ)²), and `width` is b, on the safe side.
    """

    exterior: tuple[Line, ...]
    interior: tuple[Line, ...]
    surface: Line
    width: float

    def proved(self, squares: Floats, heights: Floats, otherwise: int) -> Positions:
        """Return the position of centres with these x² + y² and z², int8 (n,), where it is proved, else `otherwise`."""
        result = np.full(len(squares), otherwise, dtype=np.int8)
        for lines, nearest, beyond, position in (
            (self.exterior, np.minimum, np.greater, Position.EXTERIOR),
            (self.interior, np.maximum, np.less, Position.INTERIOR),
        ):
            if lines:
                border = _envelope(lines, heights, nearest)
                # At most one of the two proves a position, so a sum can replace a choice, and is many times faster.
                result += beyond(squares, border).view(np.int8) * np.int8(position - otherwise)
        rest = np.flatnonzero(result == otherwise)
        result[rest[self._touching(squares[rest], heights[rest])]] = Position.CONTACT
        return result

    def _touching(self, squares: Floats, heights: Floats) -> Mask:
        """Return a mask of the centres whose spheroid holds the surface's point at the same height and azimuth."""
        constant, slope = self.surface
        here, there = np.sqrt(squares), np.sqrt(constant + slope * heights)
        return np.asarray(np.abs(here - there) + LINE_MARGIN * (here + there) < self.width)


def _envelope(lines: tuple[Line, ...], heights: Floats, nearest: Callable[..., Floats]) -> Floats:
    """Return the least, or the greatest, of the lines at each height."""
    (first, slope), *others = lines
    border = slope * heights
    border += first
    for constant, slope in others:
        line = slope * heights
        line += constant
        nearest(border, line, out=border)
    return border


@lru_cache(maxsize=64)
def lines_for_sizes(alpha: float, gamma: float, b: float, d: float, reach: int) -> SizeLines:
    """Compute lines for these sizes, good for centres up to the height γ 2^reach."""
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
    return SizeLines(
        _moved(exterior, 1 + LINE_MARGIN), _moved(interior, 1 - LINE_MARGIN), surface, b * (1 - LINE_MARGIN)
    )


def _moved(exact: list[tuple[Fraction, Fraction]], factor: float) -> tuple[Line, ...]:
    """Return the lines in floats, moved to the safe side."""
    return tuple((float(constant) * factor, float(slope) * factor) for constant, slope in exact)


CHUNK = 32_768
"""The number of rows at a time: many for numpy's overhead, few enough for temporary arrays to stay in the cache."""

MARGIN = 1 + 64 * 2.0**-53
LEAST, GREATEST = 2.0**-100, 2.0**100
LEAST_MULTIPLIER, GREATEST_MULTIPLIER = 2.0**-450, 2.0**450
UNDECIDED = 2

STEP = 1 - 2.0**-30
"""The length, in radii, of a step in a computed direction; what is missing to 1 covers the direction's rounding."""

Directions = tuple[tuple[float, float], ...]
UPRIGHT: Directions = ((1.0, 0.0), (0.0, 1.0))
SLANTED: Directions = tuple((STEP * m / 25, STEP * n / 25) for m, n in ((20, 15), (15, 20), (24, 7), (7, 24)))

Squares = tuple[Floats, ...]
"""A, B, P and Q."""


def positions(rows: Rows) -> Positions:
    """Return the exact position of every row, (n, 7), (n, 10) or (n, 13): int8 (n,).

    Rows of seven whose columns lie in memory one behind the other (the transpose of a (7, n) array) are decided
    fastest; each row of a tilted spheroid is decided on its own, and so are ends. Raises InputError about the first
    invalid row.
    """
    result = np.empty(len(rows), dtype=np.int8)
    if not PAIRS.has_axis(rows):
        for start in range(0, len(rows), CHUNK):
            result[start : start + CHUNK] = _chunk(rows[start : start + CHUNK], start)
        return result
    require_valid(rows)
    upright = upright_mask(rows)
    result[upright] = positions(np.ascontiguousarray(rows[upright, : len(COLUMNS)]))
    for index in np.flatnonzero(~upright):
        result[index] = exact.position(Lengths.of(rows[index, : len(TILTED_COLUMNS)].tolist()))
    if PAIRS.has_heights(rows):
        for index in np.flatnonzero(np.isfinite(rows[:, 10:12]).any(axis=1)):
            result[index] = exact.ended_position(Lengths.of(rows[index].tolist()), Position(int(result[index])))
    return result


def filtered(rows: Rows) -> Positions:
    """Return the positions of valid rows that the filter proves, or UNDECIDED: int8 (n,)."""
    columns = np.ascontiguousarray(rows.T)
    if _all_safe(columns):
        return _proved(columns)
    result = np.full(len(rows), UNDECIDED, dtype=np.int8)
    safe = _safe(columns)
    result[safe] = _proved(columns[:, safe])
    return result


def _chunk(rows: Rows, first_number: int) -> Positions:
    """Return the exact positions of some rows. Raises InputError about the first invalid row."""
    columns = rows.T if rows.strides[0] == rows.itemsize else np.ascontiguousarray(rows.T)
    if _all_safe(columns):  # and so valid
        result = _proved(columns)
    else:
        require_valid(rows, first_number)
        result = filtered(rows)
    for index in np.flatnonzero(result == UNDECIDED):
        result[index] = exact.position(Pair.from_row(rows[index].tolist()).lengths)
    return result


def _all_safe(columns: Floats) -> bool:
    """Decide whether all rows are safe, by the extremes of each column; comparisons with a NaN are false."""
    if not columns.size:
        return True
    least, greatest = columns[:4].min(axis=1), columns[:4].max(axis=1)
    center = np.abs(columns[4:])
    return bool(
        (least >= LEAST).all()
        and (greatest <= GREATEST).all()
        and center.max() <= GREATEST
        and not ((center < LEAST) & (center > 0)).any()
    )


def _safe(columns: Floats) -> Mask:
    """Return a mask of the rows, given by columns, whose lengths are 0 or from LEAST to GREATEST."""
    lengths = np.abs(columns)
    inside: Mask = (lengths <= GREATEST) & ((lengths >= LEAST) | (lengths == 0))
    return np.asarray(inside.all(axis=0))


def _proved(columns: Floats) -> Positions:
    """Return the position, or UNDECIDED, of safe rows (7, n), by more and more expensive tests of undecided rows."""
    with np.errstate(all="ignore"):  # a NaN or an infinity compares false, which is undecided
        result = _by_lines(columns)
        rest = np.flatnonzero(result == UNDECIDED)
        left = _squares(columns if len(rest) == len(result) else columns[:, rest])
        for witness in (_level, _maximum, _upright, _slanted, _along_the_normal):
            if not len(rest):
                break
            result[rest] = answers = witness(*left)
            still = np.flatnonzero(answers == UNDECIDED)
            rest, left = rest[still], tuple(column[still] for column in left)
    return result


def _by_lines(columns: Floats) -> Positions:
    """Return the positions that lines prove if all rows have the same sizes; else UNDECIDED for all."""
    sizes, (x, y, z) = columns[:4], columns[4:]
    if not columns.size or (sizes != sizes[:, :1]).any():
        return np.full(columns.shape[1], UNDECIDED, dtype=np.int8)
    alpha, gamma, b, d = sizes[:, 0].tolist()
    heights = z * z
    reach = math.frexp(math.sqrt(float(heights.max())) / gamma)[1]
    return lines_for_sizes(alpha, gamma, b, d, min(max(reach, -2), 20)).proved(x * x + y * y, heights, UNDECIDED)


def _squares(columns: Floats) -> Squares:
    """Return A, B, P and Q of each row, (n,) each."""
    alpha, gamma, b, d, x, y, z = columns
    return (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2


def _level(A: Floats, B: Floats, P: Floats, Q: Floats) -> Positions:
    """Test the surface's point at the centre's height: within a radius it proves contact; its λ may prove clear."""
    a, stretch, r = np.sqrt(A), np.sqrt(1 + Q / B), np.sqrt(P)
    surface, size = a * stretch, a / stretch
    within = np.abs(r - surface) + (MARGIN - 1) * (r + surface) < 2 - MARGIN
    return _clear(A, B, P, Q, np.copysign(size, r - surface)) + _shift(within, Position.CONTACT)


def _maximum(A: Floats, B: Floats, P: Floats, Q: Floats) -> Positions:
    """Return EXTERIOR or INTERIOR where the λ of the local maximum of g proves it, else UNDECIDED."""
    return _clear(A, B, P, Q, _local_maximum(A, B, P, Q))


def _local_maximum(A: Floats, B: Floats, P: Floats, Q: Floats) -> Floats:
    """Return the λ of the local maximum of g, approximately; no accuracy is needed."""
    c2 = A - B + 1 - P - Q
    c1 = B * (P - A - 1) + A * (1 - Q)
    root = np.sqrt(c2 * c2 - 3 * c1)
    return np.asarray(np.where(c2 < 0, c1 / (root - c2), -(c2 + root) / 3))


def _clear(A: Floats, B: Floats, P: Floats, Q: Floats, at: Floats) -> Positions:
    """Return EXTERIOR or INTERIOR where λ = `at` proves it, else UNDECIDED."""
    size = np.abs(at)
    usable = (size > LEAST_MULTIPLIER) & (size < GREATEST_MULTIPLIER)
    # λ > 0:  P/(A+λ) > Q/(B−λ) + 1 + 1/λ;   λ = −μ < 0:  Q/(B+μ) + 1 > P/(A−μ) + 1/μ.  A pole stays on its side.
    to_b = B / MARGIN - size
    to_a = A / MARGIN - size
    exterior = (at > 0) & (to_b > 0) & (P / (A + size) > MARGIN * (Q / to_b + 1 + 1 / size))
    interior = (at < 0) & (to_a > 0) & (Q / (B + size) + 1 > MARGIN * (P / to_a + 1 / size))
    undecided = np.int8(UNDECIDED)
    return undecided + _shift(usable & exterior, Position.EXTERIOR) + _shift(usable & interior, Position.INTERIOR)


def _shift(proved: Mask, position: Position) -> Positions:
    """Return numbers that, added to UNDECIDED, give `position` where it is proved; a sum is faster than a choice."""
    return proved.view(np.int8) * np.int8(position - UNDECIDED)


def _upright(A: Floats, B: Floats, P: Floats, Q: Floats) -> Positions:
    """Return CONTACT where points above, below and beside the centre, or along the normal at it, prove it."""
    r, z = np.sqrt(P), np.sqrt(Q)
    return _contact(A, B, r, z, UPRIGHT, (r / A, z / B))


def _slanted(A: Floats, B: Floats, P: Floats, Q: Floats) -> Positions:
    """Return CONTACT where points in SLANTED directions from the centre prove it, else UNDECIDED."""
    return _contact(A, B, np.sqrt(P), np.sqrt(Q), SLANTED)


def _along_the_normal(A: Floats, B: Floats, P: Floats, Q: Floats) -> Positions:
    """Return CONTACT where points towards the nearest one of the surface, and away from it, prove it."""
    r, z, at = np.sqrt(P), np.sqrt(Q), _local_maximum(A, B, P, Q)
    return _contact(A, B, r, z, (), (r / (A + at), z / (B - at)))


def _contact(
    A: Floats, B: Floats, r: Floats, z: Floats, directions: Directions, normal: tuple[Floats, Floats] | None = None
) -> Positions:
    """Return CONTACT where points of the closed ball on both sides of the hyperboloid are found, else UNDECIDED.

    All is in the half plane r, |z| ≥ 0. Points lie in the `directions` away from the axis and to the waist, or the
    other way, a little less than one radius from the centre, and along the `normal`, of any length.
    """
    # Each point's coordinate is within 8u (r + 1), 8u (z + 1) of the one meant; the bounds below swallow that.
    slack_r, slack_z = (MARGIN - 1) * (r + 1), (MARGIN - 1) * (z + 1)

    def outside(radius: Floats, height: Floats) -> Mask:
        radius, height = np.maximum(radius - slack_r, 0), height + slack_z
        return np.asarray(radius * radius / A > MARGIN * (height * height / B + 1))

    def inside(radius: Floats, height: Floats) -> Mask:
        radius, height = radius + slack_r, np.maximum(height - slack_z, 0)
        return np.asarray(height * height / B + 1 > MARGIN * (radius * radius / A))

    some_outside, some_inside = np.zeros(len(r), dtype=bool), np.zeros(len(r), dtype=bool)
    if normal is not None:
        length = np.hypot(*normal)  # 0 at the origin alone: no square of it underflows
        across, along = (STEP * part / length for part in normal)
        some_outside |= outside(r + across, np.abs(z - along))
        some_inside |= inside(np.abs(r - across), np.abs(z + along))
    for wide, tall in directions:
        some_outside |= outside(r + wide, np.maximum(z - tall, 0))
        some_inside |= inside(np.maximum(r - wide, 0), z + tall)
    return np.int8(UNDECIDED) + _shift(some_outside & some_inside, Position.CONTACT)
