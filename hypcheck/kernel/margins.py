"""Positions with a margin: a spheroid that is not proved to be at least so far away counts as contact.

Two proofs are tried. The spheroid with the semi-axes √((v + δ)(b²/v + δ)) and √((v + δ)(d²/v + δ)) contains all points
within δ of the given one, for any v > 0 (clearance_bounds.py says why): if it is clear, so is the given one, on the
same side, and its distance is at least δ. Here v is b, for which the wider semi-axis is b + δ. If that proves nothing,
the lower bound of the distance decides. _OUTWARD covers the twelve roundings of a semi-axis, for lengths in 2^±300.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.pair import REFUSED, trouble_with
from hypcheck.geometry.rows import Floats, Mask, Positions, Rows
from hypcheck.kernel.choice import POSITION_OF, Question
from hypcheck.kernel.clearance import clearances
from hypcheck.kernel.in_use import positions_of_rows

_OUTWARD = 1 + 2.0**-48
_RANGE = (2.0**-300, 2.0**300)


def checked_margin(margin: object) -> float:
    """The margin as a float, 0 or more. Raises InputError."""
    value = margin.item() if isinstance(margin, np.generic) else margin
    trouble = trouble_with("margin", value)
    if trouble is None and value < 0:  # type: ignore[operator]  # a number
        trouble = f"margin is {value!r}; it must be 0 or more"
    if trouble is not None:
        raise InputError(trouble)
    return float(value)  # type: ignore[arg-type]


def enlarged(b: ArrayLike, d: ArrayLike, margin: ArrayLike, half: ArrayLike | None = None) -> tuple[Floats, Floats]:
    """Semi-axes of spheroids that contain all points within `margin` of those given, (n,) each; inf where unknown.

    They are no larger than necessary in the directions in which the given ones are `half` (n,) wide; `half` is b by
    default.
    """
    b, d, margin = (np.asarray(numbers, np.float64) for numbers in (b, d, margin))
    margin = np.maximum(margin, _RANGE[0])
    v = b if half is None else np.asarray(half, np.float64)
    fits = (np.minimum(b, d) >= _RANGE[0]) & (np.maximum(b, d) <= _RANGE[1]) & (margin <= _RANGE[1]) & (v >= _RANGE[0])
    with np.errstate(all="ignore"):
        wide, tall = (np.sqrt((v + margin) * (axis * axis / v + margin)) * _OUTWARD for axis in (b, d))
    return np.where(fits, wide, math.inf), np.where(fits, tall, math.inf)


def with_margin(rows: Rows, positions: Positions, margin: float, question: Question, threads: int | None) -> Positions:
    """The answers for rows of these positions, 127 for invalid ones: contact where less than the margin is proved."""
    margin = checked_margin(margin)
    result = positions.copy()
    clear = np.flatnonzero((positions != 0) & (positions != REFUSED))
    left = clear[~_by_growing(rows[clear], positions[clear], margin, threads)]
    if len(left):
        near = clearances(np.ascontiguousarray(rows[left]), threads)
        result[left[~(near.distance_lower >= margin)]] = 0
    if question == "position":
        return result
    yes: Positions = (result == POSITION_OF[question]).astype(np.int8)
    yes[positions == REFUSED] = REFUSED
    return yes


def _by_growing(rows: Rows, positions: Positions, margin: float, threads: int | None) -> Mask:
    """Whether the enlarged spheroid is clear on the same side."""
    grown = rows.copy()
    grown[:, 2], grown[:, 3] = enlarged(rows[:, 2], rows[:, 3], margin)
    answers, _ = positions_of_rows(grown, "position", threads)
    return np.asarray(answers == positions)
