"""The promised accuracy of a distance of hypcheck.clearance. This module loads no numpy."""

from __future__ import annotations

from typing import TypeVar

_PROMISED = 2.0**-29
"""How far apart the bounds of a distance are at most, in units of the distance and the spheroid's longer semi-axis."""

Number = TypeVar("Number")


def are_apart(low: Number, high: Number, longer: Number) -> Number:
    """Whether bounds of distances are farther apart than promised, of numbers or of arrays, or the upper is inf."""
    return high - low > _PROMISED * (low + longer)  # type: ignore[operator, no-any-return]
