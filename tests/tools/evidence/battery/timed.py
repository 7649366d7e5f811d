"""Sweeps as questions: whether there is contact, and two times between which the kernel's time of a hit must lie.

Both, and the hits, are those of the exact passage of hypcheck.truth. The first contact is not after the later time; and
the spheroid that has contact at the kernel's time, larger as hypcheck.h says there, has none before the earlier one.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck import Passage
from tests.support.inside import passage

INVALID = 127
GROWTH = Fraction(1, 2**43)
"""How much larger that spheroid is, in units of 1 + S."""


def timed(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sweeps (n, 10), (n, 13) or (n, 16) with the two times behind them, and the right hits."""
    return _with_times(rows, [(first.hit, first.first_upper) for first in map(_passage, rows.tolist())])


def frozen(rows: np.ndarray, cases: list[dict[str, Any]]) -> tuple[np.ndarray, np.ndarray]:
    """The same of frozen sweeps: hits and later times are those of the file, INVALID and NaN for a row that is none."""
    latest = [float.fromhex((case.get("first_hex") or ("nan", "nan"))[1]) for case in cases]
    return _with_times(rows, [(case.get("hit", INVALID), last) for case, last in zip(cases, latest, strict=True)])


def _with_times(rows: np.ndarray, firsts: list[tuple[int, float]]) -> tuple[np.ndarray, np.ndarray]:
    """A sweep that begins in contact has no earlier time than 0."""
    hits, latest = (np.array(column) for column in zip(*firsts, strict=True))
    earliest = [
        _passage(row, 1 + GROWTH * (1 + _reach(row))).first_lower if last > 0 else last
        for row, last in zip(rows.tolist(), latest.tolist(), strict=True)
    ]
    return np.column_stack([rows, earliest, latest]), hits


def _passage(row: list[float], scale: Fraction = Fraction(1)) -> Passage:
    low, high, solid = row[13:] or (-math.inf, math.inf, 0)
    sizes = (*row[:2], Fraction(row[2]) * scale, Fraction(row[3]) * scale)
    axis = row[10:13] or None
    return passage(sizes, row[4:7], row[7:10], axis, z_min=low, z_max=high, solid=bool(solid))


def _reach(row: list[float]) -> Fraction:
    """S: the coordinates of both ends in radii, and in the smaller radius where the axis is tilted."""
    b, d = (min(row[2:4]),) * 2 if any(row[10:12]) else row[2:4]
    across, along = (sum(abs(Fraction(row[place])) for place in places) for places in ((4, 5, 7, 8), (6, 9)))
    return across / Fraction(b) + along / Fraction(d)
