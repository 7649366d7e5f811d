"""Questions made for one branch of the header each, which frozen and drawn ones do not reach.

The right answers are those of the oracles, or follow from the construction; none is asked of the header.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tests.support.inside import clearances
from tests.tools.attack.strike import truth_of
from tests.tools.evidence.battery.timed import timed
from tests.tools.evidence.seeds import CLEARANCES, LEANING_SCENE, ROWS, SCENE, SWEEPS

HAIR = 2.0**-100

BESIDE_TANGENCIES = (
    *((2, 8, 1, 1, 1, 0, hair) for hair in (0, HAIR, -HAIR)),  # from within, in the plane of the waist
    *((2, 8, 1, 1, 3, 0, hair) for hair in (0, HAIR)),  # from without
    *((2, 8, 1, 1, x, HAIR, z) for x in (1, 3) for z in (0, HAIR)),
    *((4, 4, 1, 1, x, y, 0) for x, y in ((0, 3), (HAIR, 3), (5, HAIR), (0, 5))),
    (4, 2, 1, 1, 5, 0, 0),  # osculating: the triple root B
    (486, 648, 611, 611, 630, 910, 75),  # the double root lies below B, and there the slope is 0, too
)
"""Tangencies, some with coordinates of a hair's breadth."""

CANCELLED = """
    0x1.5f07d003f5566p-3 0x1.a31ae49ff5368p-52 0x1.72a18cbf8ceap+51 0x1.d477f6cc465f2p-14 0x1.72a18cbf8ceap+51
    0 0;
    0x1.1d98d5adc9f2dp-55 0x1.ep-39 0x1.2p+3 0x1p+3 0x1.2p+3 0 0;
    0x1.28806d4cac898p-38 0x1.af8beebe9b632p-16 0x1.e8674a661f2bdp+20 0x1.4abe23e2878c7p+14
    0x1.e8674a661f2bdp+20 0 0x1.29ed66f7b0ff1p-43
"""
"""c2 or c1 is tiny beside its terms: errors of fixed point grow beyond 2^100. Found by search; `;` ends a row."""

NOT_TOLD = """
    0x1.4p+2 2 0x1.4p+2 0x1.8p+59 0x1.4p+2 0x1p+203 0; 2 3 48 0x1p+58 48 0x1.5616baaef4f68p+106 3;
    1 10 1 10 0x1.fffffffffffffp+0 0x1.ep-26 0;
    0x1p-22 0x1p-40 0x1p-22 0x1p-40 0x1.fffffffffffffp-22 0x1.ebbdb23e3baf8p-48 0;
    0x1p+49 0x1.c0deb85f87128p+0 0x1p-124 0x1.8p+40 0x1p+49 0x1.6p-10 0;
    0x1.cp-73 0x1.8p-252 0x1p-13 14 0 0 14;
    0x1.2p-98 0x1.ep-124 0x1p-48 0x1p-75 0 0x1.593133468bf73p+0 0x1p-75
"""
"""In fixed point one sign is not told, and the others are those of another position: the slope at B, twice; at the
inflection, twice; the offset at B, and at -A. In the last row errors grow to their limit. Found by search."""

WAYS_BEYOND_BOUNDS = """
    0x1p+99 0x1p-99 0x1p+60 0x1p-99 0x1p+100 0 0 0x1p+100 0x1p+80 0;
    3 9 1 3 0x1.47ae147ae147bp-7 0 0x1.3ffffffffffbep+4 0x1.47ae147ae147bp-6 0 0x1.3ffffffffffbep+4;
    0x1.25c2e118fc63cp+72 0x1.2ca8f9ed139bdp-96 0x1.747f652755558p+63 0x1.696611cdcd89cp+81
    0x1.2263b55f3e678p+3 -0x1.a30f9ec2e4866p-80 0x1.696611cdcd89cp+81 -0x1.aea0458562f04p-58
    0x1.1e840175c1f2p-73 -0x1.4ca96612637p-34;
    0x1.3e86f23da4692p+1 0x1.5965da903289ap+1 0x1.2f89e8a6545e6p+0 0x1.2f89e8a6545e6p+0 -0x1.8e28aecd0d836p+3
    0x1.d64be690ce98bp+1 0 0x1.8e28aecd0d836p+3 0x1.d64be690ce98bp+1 0;
    0x1.4e67ed37acb9ap+9 0x1.4e67ed37acb9ap+11 0x1.92eaced5af2cap+0 0x1.92eaced5af2cap+0 -0x1.a201e88597e8p+11
    0x1.4f31629f1795bp+9 0 0x1.a201e88597e8p+11 0x1.4f31629f1795bp+9 0
"""
"""A half plane steeper than 2^400; the multiplier 1, between both kinds of half planes; a sum beyond 2^400; beside a
line on the surface, more steps than are made, and steps that come to nothing. Found by search."""

LEANING_WAYS_BEYOND_BOUNDS = """
    0x1.1fdd207db2088p+40 0x1.ec27b49373362p+71 0x1.8376f81353704p-6 0x1.20cebea1cbb34p+32
    0x1.3b48d7cbf949cp+14 0 0x1.0db6581561a9bp-65 -0x1.98441e0ae119cp-90 0 -0x1.c5db8f1fa57a4p-98
    0x1.c47a06b7bc579p-39 0x1.682a4a5fe1554p-48 0;
    0x1.79867bc0dab3ep+10 0x1.21ad613f880e4p+7 0x1.4868413737496p+3 0x1.21a8e05b8dcfp-34 0
    -0x1.6060affa47bdfp-40 0x1.6cabdd0215022p-29 0 0x1.4cbf76617e534p-31 -0x1.38b3880a01d72p-21
    -0x1.bcccbc7d5d6c2p-40 -0x1.7dcf0529c1ce4p-35 -0x1.7802df4700637p-25;
    11 11 0x1.8p-27 10 0x1.8p-27 0 -10 12 0 -12 0x1.4p-75 8 15
"""
"""A pole that is not known to lie beyond the multiplier; coefficients beyond 2^400. Found by search."""

CLEARANCES_AT_ENDS = (
    *((2.0**e, 2.0 ** (e + 5), 2.0**e, 2.0**e, 2.0**e * x, 0, 0) for e in (-180, -171) for x in (2.125, 2.625)),
    (2.0**-1000, 2.0**-995, 2.0**-1001, 2.0**-1001, 2.0**-998, 0, 0),  # no bound of the distance fits
    (2.0**-88, 2.0**-88, 2.0**93, 2.0**91, 0, 0, 0),  # a place of touch of which nothing is known
    (2.0**-98, 2.0**-86, 2.0**89, 2.0**95, 0, 0, 2.0**-85),
)
"""A half of what is known is exactly the factor at which the first touches; sizes for which bounds are lost."""

SIZE = 10 * 64 + 7


def rows_of(text: str) -> np.ndarray:
    """Rows from hexadecimal or decimal numbers, a `;` between rows."""
    return np.array([[_number(word) for word in row.split()] for row in text.split(";")])


def _number(word: str) -> float:
    return float.fromhex(word) if "x" in word else float(word)


def constructed() -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """The kind, the rows and the right answers."""
    for rows in (np.array(BESIDE_TANGENCIES, float), rows_of(CANCELLED), rows_of(NOT_TOLD)):
        yield ROWS, rows, truth_of(rows)
    for text in (WAYS_BEYOND_BOUNDS, LEANING_WAYS_BEYOND_BOUNDS):
        yield SWEEPS, *timed(rows_of(text))
    rows = np.array(CLEARANCES_AT_ENDS)
    known = clearances(rows)
    yield CLEARANCES, np.column_stack([rows, known.clearance]), known.position
    for kind, scene in _scenes():
        right = np.full(len(scene), 127, np.int8)
        valid = np.isfinite(scene).all(axis=1)
        right[valid] = truth_of(scene[valid])
        yield kind, scene, right


def _scenes() -> Iterator[tuple[int, np.ndarray]]:
    """Scenes of one place, of one height, with centres that are none or far away, and too large for half planes."""
    random = np.random.default_rng(9)
    for axis in ((), (1.0, 2.0, 3.0)):
        kind = LEANING_SCENE if axis else SCENE
        sizes, places = (3.0, 4.0, 0.5, 0.25), 8 * random.random((SIZE, 3)) - 4
        yield kind, _scene(sizes, np.broadcast_to(places[:1], places.shape), axis)
        yield kind, _scene(sizes, np.column_stack([places[:, :2], 9 + random.random(SIZE)]), axis)
        odd = places.copy()
        odd[5, 0], odd[77, 1], odd[300, 2], odd[400, 0], odd[SIZE - 1, 1] = np.nan, np.inf, 1e250, -1e250, np.nan
        yield kind, _scene(sizes, odd, axis)
        yield kind, _scene(tuple(size * 2.0**101 for size in sizes), places * 2.0**101, axis)


def _scene(sizes: Sequence[float], places: np.ndarray, axis: Sequence[float]) -> np.ndarray:
    one = np.ones((len(places), 1))
    return np.hstack([one * np.array(sizes), places, *([one * np.array(axis)] if axis else [])])
