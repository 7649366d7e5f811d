"""Thresholds in single precision from the proved lines of a scene; programs/parallel_lines.py says why they hold."""

from __future__ import annotations

from math import inf

import numpy as np

from hypcheck.kernel.programs.parallel_lines import GREATEST_REACH, GREATEST_SLOPE, LEAST_REACH, LESS, MARGIN, TINY

Line = tuple[float, float]
"""K and M: of the line K + M T."""


def thresholds(lines: dict[str, Line | None], reach: float) -> dict[str, float] | None:
    """The inputs of the program PARALLEL_LINES but R and T, and `reach` as its T must not exceed it.

    `lines` has beyond, under, within and above, None for a line that proves nothing; they hold for T in [0, `reach`].
    None where single precision has no room for the scene.
    """
    outer, inner = _slope(lines["under"] or lines["beyond"]), _slope(lines["above"] or lines["within"])
    if not (LEAST_REACH < reach < GREATEST_REACH and max(outer, inner) <= GREATEST_SLOPE):
        return None
    return {
        "reach": _single(reach * LESS),
        "M_outer": outer,
        "K_beyond": _threshold(lines["beyond"], outer, reach, 1),
        "K_under": _threshold(lines["under"], outer, reach, -1),
        "M_inner": inner,
        "K_within": _threshold(lines["within"], inner, reach, -1),
        "K_above": _threshold(lines["above"], inner, reach, 1),
    }


def _slope(line: Line | None) -> float:
    return 0.0 if line is None else _single(line[1])


def _threshold(line: Line | None, M: float, reach: float, side: int) -> float:
    """What R − M T must exceed (side 1), or stay below (side −1): then the exact place is on that side of the line."""
    if line is None:
        return side * inf
    at_ends = line[0], line[0] + (line[1] - M) * reach
    K = max(at_ends) if side > 0 else min(at_ends)
    return _single(K + side * (MARGIN * (abs(K) + 2 * M * reach) + TINY))


def _single(value: float) -> float:
    with np.errstate(all="ignore"):
        return float(np.float32(value))
