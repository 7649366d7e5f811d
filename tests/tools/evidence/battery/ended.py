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
from tests.tools.evidence.battery.constructed import rows_of

MOST_ROWS, MOST_SWEEPS = 900, 24
"""Of one sort, where every row is asked: an exact decision takes a millisecond, an exact time 30 or more."""

FAR_FROM_THE_MULTIPLIER = """
    0x1.8p-13 0x1.2p-31 1 3200 2008 -0x1.48p+17 -0x1.cp-1 1 0 0 -1 0 1;
    0x1p-14 0x1.4p-36 1 16384 12288 0x1.acp+17 0 1 0 0 -1 0 0;
    0x1p-36 0x1.4p-46 0x1.04p-14 0x1p-32 0x1.3ap-13 -0x1.ap-15 0 1 0 0 -1 0 0;
    0x1.4p-39 0x1.4p-46 0x1p-14 0x1p-32 -0x1.3ap-13 0x1.ap-15 0 1 0 0 -1 0 1;
    2 1 2 1 0 0 0 1 1 -1 0 1 0;
    0x1.4p+26 0x1.ep-92 0x1p+86 1 1 1 0 1 0 1 -inf 0 1;
    0x1.ap-84 0x1.6p-91 1 0x1.2p-87 0 0 -0x1.6p-11 1 0 1 0 1 1;
    0x1.a80f6cd4fc659p+17 0x1.cbe332da21d9fp-63 0x1.58f980626e04dp+72 0x1.bbc91e24bed4bp+1 0x1.af28c10ae4bf4p+31
    0x1.e88320ef6722cp+9 -0x1.064e2caa3eab5p+72 -3 2 -2 -6 12 0
"""
"""Flat cones: steps do not come to the multiplier, and a point on each of the four axes shows contact. A value far
below 0; more pieces than are made; a step beyond its bounds; one piece more than wait. Found by search; `;` ends a
row."""

SWEEPS_BEYOND_BOUNDS = """
    1 1 1 6 0 0 0x1.baep+0 0 0 0x1.88p+1 0 0 -1 0x1.ef6p+2 22 1;
    1 0x1.ep-35 0x1.8p-21 0x1.d6p+18 -0x1.2p+23 0 0x1.4p+19 -0x1.2p+23 0 0 0 0 -1 0 0x1.4p+17 1;
    0x1.57ap+36 0x1.b2p-40 18432 0x1.ep+29 0 0 -0x1p+30 0x1.eap+35 0x1.e9cp+35 0 1 1 -1 -0x1.cp-43 1 0;
    0x1.ap-9 1 1 1 1 1 -4608 0 0 0 1 1 -1 0 1 0;
    1 1 0x1.4p+73 0x1.4p+71 0x1.2cp+73 0 -0x1.ep+69 0 0 0x1.cp+70 0 0 -1 0 inf 0;
    1 0x1.6p+32 1 1 0 0 0x1.6p+34 0 0x1.2p+20 -0x1.4p+31 0 1 1 -0x1.cp+31 0 1;
    8 1 1 4 0 0 0x1.71434a18ca81cp+0 0 0 0 0 1 0 0x1.38a1a50c6540ep+1 15 1;
    0x1.1d83d99d42f11p-48 0x1.6127e2601d542p-95 0x1.c5094b4bb437p-89 0x1.1b8fa9d6568c8p+25 -0x1.da49d8e4df007p-49
    -0x1.da49d8e4ea2eap-49 -0x1.ecf4f62856946p+28 -0x1.da49d8e4fe51p-49 -0x1.da49d8e4ea2eap-49 0x1.ed7a1375c873p+29
    0 0 1 -0x1.4409a2p+24 0x1.21cefp+22 0;
    0x1.5f341b5062eacp+13 0x1.9a6752d4c2829p-80 0x1.5dc0b2bfd4548p-81 0x1.82347aa56822ap+70 0 0x1.0ef5c3e8280a6p-79
    -0x1.1498f5292a01fp+69 0 -0x1.0ef5c3e8280a6p-79 -0x1.1498f5292a01fp+69 0 0 1 -0x1.3c36783655f4fp+68 inf 0;
    3 4 1 2 1 0 4 1 0 9 1 0 0 -1 3 1; 3 4 1 2 1 0 9 1 0 4 1 0 0 -1 3 1
"""
"""More halvings of a time than are made, and more that tell nothing; a time at which no contact is seen; a point on an
axis that is met; a simple time after the last; more rectangles than are made; a start of which nothing is told; one
rectangle more than wait; a start, or an end, that touches. Found by search, but for the last two."""

PLAIN_SWEEPS_BEYOND_BOUNDS = """
    1 1 0x1.2p-38 0x1.ep+67 0 0 0x1p+68 1 0 0 0 0 -1; 1 1 0x1.2p-38 0x1.ep+67 0 0 0 1 0 0 0 0 -1
"""
"""Without ends: more steps to a time than are made, and more to a multiplier. Found by search."""


def constructed_sweeps() -> Iterator[np.ndarray]:
    """Sweeps at the limits of bounds."""
    yield from map(rows_of, (SWEEPS_BEYOND_BOUNDS, PLAIN_SWEEPS_BEYOND_BOUNDS))


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
