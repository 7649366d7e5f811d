"""Questions about hyperboloids that end: rows and sweeps that are drawn about ends, and some at each border.

The right answers are those of the exact decisions of hypcheck.truth, which share no code with the kernel.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hypcheck.geometry.pair import Pair
from tests.support.ended_sweeps import near_a_rim, past_a_tower
from tests.support.inside import position
from tests.tools.ended_agreement import hairs, random_rows

MOST_ROWS, MOST_SWEEPS = 900, 24
"""Of one sort, where every row is asked: an exact decision takes a millisecond, an exact time 30 or more."""


def positions_of(rows: np.ndarray) -> np.ndarray:
    """The exact positions of rows of 13."""
    return np.array([position(Pair.from_row(row).lengths) for row in rows.tolist()])


def drawn_rows(seed: int, every: int) -> Iterator[np.ndarray]:
    """Rows of 13, random ones and hairs from contact with a rim, a flat end or the wall, down to 2⁻⁷⁵."""
    random, count = np.random.default_rng(seed), MOST_ROWS // every
    for tilted in (False, True):
        yield random_rows(random, count, tilted=tilted)
        yield hairs(random, count, tilted=tilted)
        yield hairs(random, count, tilted=tilted, nearest=-75)


def drawn_sweeps(seed: int, every: int) -> Iterator[np.ndarray]:
    """Sweeps of 16 numbers past a tower, and past a rim by up to half a radius, or by less than a rounding."""
    count = MOST_SWEEPS // every
    for tilted in (False, True):
        yield past_a_tower(seed, count, tilted=tilted)
        yield near_a_rim(seed, count, tilted=tilted)
        yield near_a_rim(seed + 1, count, tilted=tilted, hair=-70)
