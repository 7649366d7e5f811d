"""The half planes of one scene for the numpy kernel: chosen by rules of thumb, proved by programs/lines.py.

What is chosen here, λ, μ and the heights, decides nothing but how many rows the next stage gets; core/parts/scene.h
chooses in the same way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.printed import scalars
from hypcheck.kernel.programs.lines import (
    CAP,
    GREATEST_SIZE,
    GREATEST_SLOPE,
    LEAST_CONSTANT,
    LEAST_SIZE,
    LESS,
    PLACES,
    SIDES,
)
from hypcheck.kernel.scalar import exact_position

Floats = NDArray[np.float64]
Sizes = tuple[float, float, float, float]

NEVER = 1.7976931348623157e308
GREATEST_HEIGHT, LEAST_HEIGHT = 2.0**150, 2.0**-150
SAMPLE = 256
STEPS = (2.0**-30, 2.0**-16, 2.0**-8)
"""How far from the edge a known point is tried, relatively."""

NUDGE = 2.0**-30
Line = tuple[float, float]
"""K and M."""

PROVES_NOTHING: dict[str, Line] = {"beyond": (NEVER, 0), "within": (-1, 0), "under": (-1, 0), "above": (NEVER, 0)}


@dataclass(frozen=True, slots=True)
class Point:
    """A place of the plane of T = z² and R = x² + y² where the position is known not to be the one asked about."""

    T: float
    R: float


def constants_of(sizes: Sizes, z: Floats) -> dict[str, float] | None:
    """The inputs of the programs ONE_LINE and TWO_LINES but x, y, z, for valid sizes and heights like those of `z`.

    None where the sizes are beyond what the margins allow.
    """
    if not all(LEAST_SIZE < size < GREATEST_SIZE for size in sizes):
        return None
    heights = _heights(z)
    under = [_known_point(sizes, height, 1) for height in heights]
    above = [_known_point(sizes, height, -1) for height in heights]
    found: dict[str, float] = {"reach": heights[2] ** 2 * LESS}
    for place in PLACES:  # line 0 over all heights, 1 over the lower, 2 over the upper ones
        first, last = (1 if place == 2 else 0), (1 if place == 1 else 2)
        middle = heights[1] ** 2 if place == 0 else (heights[first] ** 2 + heights[last] ** 2) / 2
        made = {
            "beyond": _beyond(sizes, middle),
            "within": _within(sizes, middle),
            "under": _chord("under", under[first], under[last]),
            "above": _chord("above", above[first], above[last]),
        }
        for side in SIDES:
            found[f"K_{side}_{place}"], found[f"M_{side}_{place}"] = made[side] or PROVES_NOTHING[side]
    return found


def _heights(z: Floats) -> tuple[float, float, float]:
    """0, a height below most of the sample or about the middle, one above nearly all of it; their squares are exact.

    The last is not 0: T ≤ reach must not hold for heights whose squares have underflowed.
    """
    sample = np.abs(z[:: len(z) // SAMPLE + 1])
    sample = sample[sample < GREATEST_HEIGHT]
    least, greatest = (float(sample.min()), float(sample.max())) if len(sample) else (0.0, 0.0)
    top = _short(1.0625 * greatest, up=True) if greatest > LEAST_HEIGHT else LEAST_HEIGHT
    return 0.0, _short(max(0.55 * top, 0.999 * least if least < greatest else 0.0), up=False), top


def _short(value: float, *, up: bool) -> float:
    """The value cut, or raised, to 25 significant bits: its square is a float64."""
    mantissa, exponent = math.frexp(value)
    whole = mantissa * 2**25
    return math.ldexp(math.ceil(whole) if up else math.floor(whole), exponent - 25)


def _multiplier(A: float, B: float, Q: float, side: int) -> float:
    """About where (A+λ)(1+1/λ) + Q(A+λ)/(B−λ) is least (side 1), or with −μ for λ greatest (side −1)."""
    low, high = 0.0, min(math.sqrt(A), B) if side > 0 else math.sqrt(A)
    for _ in range(20):
        middle = (low + high) / 2
        if A / (middle * middle) > 1 + Q * (A + B) / (B - side * middle) ** 2:
            low = middle
        else:
            high = middle
    return (low + high) / 2  # never 0


def _ratios(sizes: Sizes, T: float) -> tuple[float, float, float]:
    alpha, gamma, b, d = sizes
    return (alpha / b) ** 2, (gamma / d) ** 2, T / (d * d)


def _known_point(sizes: Sizes, height: float, side: int) -> Point | None:
    """A point close to the edge at that height whose position is not exterior (side 1), or not interior (side −1)."""
    A, B, Q = _ratios(sizes, height**2)
    at = side * _multiplier(A, B, Q, side)
    edge = (A + at) * (1 + 1 / at) + Q * (A + at) / (B - at)
    if not edge < CAP:
        return None
    for step in STEPS:
        x = _short(sizes[2] * math.sqrt(max(edge * (1 - side * step), 0.0)), up=side < 0)
        if exact_position(*sizes, x, 0.0, height) != side:
            return Point(height**2, x * x)
    return None


def _beyond(sizes: Sizes, T: float) -> Line | None:
    K, M, gap = scalars.tangent_beyond(*sizes, _multiplier(*_ratios(sizes, T), side=1))
    return (K, M) if gap > 0 and K >= LEAST_CONSTANT and 0 <= M <= GREATEST_SLOPE else None


def _within(sizes: Sizes, T: float) -> Line | None:
    mu = _multiplier(*_ratios(sizes, T), side=-1)
    if mu <= 1:
        return None
    K, M, across = scalars.tangent_within(*sizes, mu)
    return (K, M) if across > 0 and K >= LEAST_CONSTANT and 0 <= M <= GREATEST_SLOPE else None


def _chord(side: str, first: Point | None, last: Point | None) -> Line | None:
    """A line below (under) or above the chord of the points, found roughly and then checked at both."""
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
