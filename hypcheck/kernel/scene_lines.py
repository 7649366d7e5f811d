"""The half planes of one scene for the numpy kernel: chosen by rules of thumb, proved by programs/lines.py.

What is chosen here, λ, μ and the heights, decides only how many rows the next stage gets; core/parts/scene.h chooses in
the same way. `thresholds` turns the proved lines into thresholds in single precision.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from math import inf

import numpy as np

from hypcheck.geometry.pair import Pair, Sizes
from hypcheck.geometry.rows import Floats
from hypcheck.kernel import integers
from hypcheck.kernel.printed import scalars
from hypcheck.kernel.programs.lines import (
    CAP,
    FLOAT32_GREATEST_SLOPE,
    FLOAT32_LESS,
    FLOAT32_MARGIN,
    FLOAT32_TINY,
    GREATEST_REACH,
    GREATEST_SIZE,
    GREATEST_SLOPE,
    LEAST_CONSTANT,
    LEAST_REACH,
    LEAST_SIZE,
    LESS,
    SIDES,
)

Line = tuple[float, float]
"""K and M of the line R = K + M T, with R = x² + y² and T = z² of the centre."""


def thresholds(lines: dict[str, Line | None], reach: float) -> dict[str, float] | None:
    """Return the inputs of the program PARALLEL_LINES without R and T, and `reach`, which its T must not exceed.

    `lines` has beyond, under, within and above, None for a line that proves nothing; they hold for T in [0, `reach`].
    Return None if the scene leaves the range of single precision.
    """
    outer, inner = _slope(lines["under"] or lines["beyond"]), _slope(lines["above"] or lines["within"])
    if not (LEAST_REACH < reach < GREATEST_REACH and max(outer, inner) <= FLOAT32_GREATEST_SLOPE):
        return None
    return {
        "reach": _single(reach * FLOAT32_LESS),
        "M_outer": outer,
        "K_beyond": _threshold(lines["beyond"], outer, reach, 1),
        "K_under": _threshold(lines["under"], outer, reach, -1),
        "M_inner": inner,
        "K_within": _threshold(lines["within"], inner, reach, -1),
        "K_above": _threshold(lines["above"], inner, reach, 1),
    }


def _slope(line: Line | None) -> float:
    """Return the slope of a line in single precision; 0 without a line."""
    return 0.0 if line is None else _single(line[1])


def _threshold(line: Line | None, M: float, reach: float, side: int) -> float:
    """Return the threshold of R − M T above which (side 1) or below which (−1) the exact place is beyond the line."""
    if line is None:
        return side * inf
    at_ends = line[0], line[0] + (line[1] - M) * reach
    K = max(at_ends) if side > 0 else min(at_ends)
    return _single(K + side * (FLOAT32_MARGIN * (abs(K) + 2 * M * reach) + FLOAT32_TINY))


def _single(value: float) -> float:
    """Return the number in single precision."""
    with np.errstate(all="ignore"):
        return float(np.float32(value))


NEVER = 1.7976931348623157e308
GREATEST_HEIGHT, LEAST_HEIGHT = 2.0**150, 2.0**-150
SAMPLE = 256
STEPS = (2.0**-30, 2.0**-16, 2.0**-8)
"""The relative distances from the edge at which a point with a known position is tried."""

NUDGE = 2.0**-30

PROVES_NOTHING: dict[str, Line] = {"beyond": (NEVER, 0), "within": (-1, 0), "under": (-1, 0), "above": (NEVER, 0)}


@dataclass(frozen=True, slots=True)
class KnownPlace:
    """A place in the plane of T = z² and R = x² + y² whose position is known to differ from the tested one."""

    T: float
    R: float


@dataclass(frozen=True, slots=True)
class SceneLines:
    """The constants of a scene in the programs PARALLEL_LINES and TWO_LINES; None if single precision has no room."""

    parallel: dict[str, float] | None
    two: dict[str, float]


def lines_of(sizes: Sizes, z: Floats) -> SceneLines | None:
    """Return lines for valid sizes and heights like those of `z`.

    Return None where the sizes are beyond what the margins allow.
    """
    if not all(LEAST_SIZE < size < GREATEST_SIZE for size in sizes):
        return None
    heights = _heights(z)
    under = [_known_point(sizes, height, 1) for height in heights]
    above = [_known_point(sizes, height, -1) for height in heights]
    top = heights[2] * heights[2]  # exact; a power need not be when rounding is directed
    two: dict[str, float] = {"reach": top * LESS}
    for part in (1, 2):  # the lower and the upper heights
        middle = (heights[part - 1] ** 2 + heights[part] ** 2) / 2
        made = {
            "beyond": _beyond(sizes, multiplier(sizes, middle, side=1)),
            "within": _within(sizes, multiplier(sizes, middle, side=-1)),
            "under": _chord("under", under[part - 1], under[part]),
            "above": _chord("above", above[part - 1], above[part]),
        }
        for side in SIDES:
            two[f"K_{side}_{part}"], two[f"M_{side}_{part}"] = made[side] or PROVES_NOTHING[side]
    chords = {"under": _chord("under", under[0], under[2]), "above": _chord("above", above[0], above[2])}
    parallel = {
        "beyond": _beyond(sizes, parallel_multiplier(sizes, chords["under"], heights[1], side=1)),
        "within": _within(sizes, parallel_multiplier(sizes, chords["above"], heights[1], side=-1)),
        **chords,
    }
    return SceneLines(thresholds(parallel, top), two)


def _heights(z: Floats) -> tuple[float, float, float]:
    """Return the three heights at which lines are made: 0, a middle one, and one above nearly all of the sample.

    The middle one is 0.55 of the last, or lies just below the least height of the sample if that is higher. The square
    of each is exact. The last is never 0: T = z² must not pass as within reach where z² has underflowed to 0.
    """
    sample = np.abs(z[:: len(z) // SAMPLE + 1])
    sample = sample[sample < GREATEST_HEIGHT]
    least, greatest = (float(sample.min()), float(sample.max())) if len(sample) else (0.0, 0.0)
    top = shortened(1.0625 * greatest, up=True) if greatest > LEAST_HEIGHT else LEAST_HEIGHT
    return 0.0, shortened(max(0.55 * top, 0.999 * least if least < greatest else 0.0), up=False), top


def shortened(value: float, *, up: bool) -> float:
    """Return the value cut, or raised, to 25 significant bits: its square is a float64."""
    mantissa, exponent = math.frexp(value)
    whole = mantissa * 2**25
    return math.ldexp(math.ceil(whole) if up else math.floor(whole), exponent - 25)


def multiplier(sizes: Sizes, T: float, side: int) -> float:
    """Return about the λ where (A+λ)(1+1/λ) + Q(A+λ)/(B−λ) is least (side 1), or with −μ for λ greatest (side −1)."""
    A, B, Q = _ratios(sizes, T)
    low, high = 0.0, min(math.sqrt(A), B) if side > 0 else math.sqrt(A)
    for _ in range(20):
        middle = (low + high) / 2
        if A / (middle * middle) > 1 + Q * (A + B) / (B - side * middle) ** 2:
            low = middle
        else:
            high = middle
    return (low + high) / 2  # never 0


def parallel_multiplier(sizes: Sizes, chord: Line | None, height: float, side: int) -> float:
    """Return λ (side 1) or μ (side −1) of the tangent parallel to the chord; without a chord, of that at the height."""
    if chord is not None:
        A, B, Q_slope = _ratios(sizes, 1.0)
        slope = chord[1] / (Q_slope * sizes[2] ** 2)  # (A+λ)/(B−λ), or (A−μ)/(B+μ)
        at = side * (slope * B - A) / (1 + slope)
        if 0 < at < (B if side > 0 else A):
            return at
    return multiplier(sizes, height**2, side)


def _ratios(sizes: Sizes, T: float) -> tuple[float, float, float]:
    """Return A = (α/b)², B = (γ/d)² and T/d²."""
    alpha, gamma, b, d = sizes
    return (alpha / b) ** 2, (gamma / d) ** 2, T / (d * d)


def _known_point(sizes: Sizes, height: float, side: int) -> KnownPlace | None:
    """Return a point near the edge at that height whose position is not exterior (side 1), or not interior (−1)."""
    A, B, Q = _ratios(sizes, height**2)
    at = side * multiplier(sizes, height**2, side)
    edge = (A + at) * (1 + 1 / at) + Q * (A + at) / (B - at)
    if not edge < CAP:
        return None
    for step in STEPS:
        x = shortened(sizes[2] * math.sqrt(max(edge * (1 - side * step), 0.0)), up=side < 0)
        if integers.upright_position(Pair.from_row((*sizes, x, 0.0, height)).lengths) != side:
            return KnownPlace(height * height, x * x)
    return None


def _beyond(sizes: Sizes, lambda_: float) -> Line | None:
    """Return the line of λ that proves exterior positions, or None if a constant is out of range."""
    K, M, gap = scalars.tangent_beyond(*sizes, lambda_)
    return (K, M) if gap > 0 and K >= LEAST_CONSTANT and 0 <= M <= GREATEST_SLOPE else None


def _within(sizes: Sizes, mu: float) -> Line | None:
    """Return the line of μ that proves interior positions, or None if a constant is out of range, or μ ≤ 1."""
    if mu <= 1:
        return None
    K, M, across = scalars.tangent_within(*sizes, mu)
    return (K, M) if across > 0 and K >= LEAST_CONSTANT and 0 <= M <= GREATEST_SLOPE else None


def _chord(side: str, first: KnownPlace | None, last: KnownPlace | None) -> Line | None:
    """Return a line below (under) or above the chord of the points, found roughly and then checked at both."""
    if first is None or last is None:
        return None
    slope = (last.R - first.R) / (last.T - first.T) if last.T > first.T else 0.0
    if side == "under":
        K, M = (first.R - slope * first.T) * (1 - NUDGE), slope
    else:
        through_origin = first.R - slope * first.T < 0
        M = last.R / last.T * (1 + NUDGE) if through_origin else slope
        moved = (first.R - M * first.T) * (1 + NUDGE)
        K = max(moved, LEAST_CONSTANT) if M > 0 or moved > 0 else 0.0
    below, above = scalars.chord(K, M, first.T, first.R, last.T, last.R)
    proved = (below and K >= LEAST_CONSTANT) if side == "under" else above
    return (K, M) if proved and 0 <= M <= GREATEST_SLOPE else None
