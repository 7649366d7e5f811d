"""Pairs for tests: strategies for all regimes, magnitudes and borders, and pairs worked out by hand.

No code of hypcheck made the answers that were worked out by hand; each has its reason.
"""

from __future__ import annotations

import math

from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position
from tests.support.inside import Kind


def _pair(values: tuple[float, ...]) -> Pair | None:
    try:
        return Pair.from_row(values)
    except InputError:
        return None


def _valid(strategy: st.SearchStrategy[tuple[float, ...]]) -> st.SearchStrategy[Pair]:
    return strategy.map(_pair).filter(lambda pair: pair is not None)


_size = st.floats(1 / 64, 64)
_offset = st.floats(-96, 96)
_small = st.integers(1, 12).map(float)
_small_offset = st.integers(-14, 14).map(lambda number: number / 2)
_any_size = st.floats(math.ulp(0.0), 1.7e308, allow_subnormal=True)
_any_offset = st.floats(allow_nan=False, allow_infinity=False)

ordinary_pairs = _valid(st.tuples(_size, _size, _size, _size, _offset, _offset, _offset))
"""Sizes within 64 of each other: all four regimes and all three positions are common."""

grid_pairs = _valid(st.tuples(_small, _small, _small, _small, _small_offset, _small_offset, _small_offset))
"""Small integers and halves: tangencies, rings and border regimes occur exactly."""

extreme_pairs = _valid(st.tuples(_any_size, _any_size, _any_size, _any_size, _any_offset, _any_offset, _any_offset))
"""Any float64 at all, subnormal and near the largest among them."""

pairs = st.one_of(ordinary_pairs, grid_pairs, extreme_pairs)


EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR

# row (alpha, gamma, b, d, x, y, z), position, clearance where it is a short number, and why
WITNESSES = [
    # The ring: g has the double root B, and yet the ball is clear. Nearest point on z = ±… by symmetry; see the rows.
    ((1, 2, 1, 1, 2.5, 0, 0), EXTERIOR, 0.5, "r − a = 3/2 at the waist is the distance: a r = 5/2 < A + B = 5"),
    ((7, 7, 1, 1, 10, 0, 0), EXTERIOR, 2.0, "r − a = 3 at the waist is the distance: a r = 70 < A + B = 98"),
    # Interior with c2 = 0 or c1 = 0, which Proposition 5 drops. On the x-axis the wall of the waist is nearest.
    ((3, 3, 1, 1, 1, 0, 0), INTERIOR, 1.0, "c2 = 0: 9 − 9 + 1 − 1; a − r = 2"),
    ((4, 1, 1, 1, 1, 0, 0), INTERIOR, 2.0, "c1 = 0: −16 + 16 − 1 + 1; a − r = 3"),
    # Outside its regimes Procedure 1 calls this crossing valid: the ball of radius 1 is too round for the groove.
    ((2, 0.5, 1, 1, 4, 0, 0), CONTACT, None, "z² = B (A (r/(…))² …): the flanks at a r = 8 ≥ A + B are nearer than 1"),
    ((1, 0.25, 1, 1, 2, 0, 0.5), CONTACT, None, "Δ = 2023/4096 > 0 and yet contact"),
    # A ball about the origin, in a throat of its own width, touches it along the waist circle.
    ((1, 1, 1, 1, 0, 0, 0), CONTACT, 0.0, "tangent along the circle r = 1"),
    ((2, 1, 1, 1, 1, 0, 0), CONTACT, 0.0, "a − r = 1: tangent from inside at (2, 0, 0)"),
    ((2, 5, 1, 1, 3, 0, 0), CONTACT, 0.0, "r − a = 1 and a r = 6 < A + B: tangent from outside at (2, 0, 0)"),
    ((1, 1, 1, 1, 1, 0, 0), CONTACT, -1.0, "the centre lies on the hyperboloid"),
    # Clear or in contact by so little that no float λ or point shows it.
    ((1, 1, 3, 1, 4, 1e-160, 0), EXTERIOR, None, "c² = 1 > a = 1/3, r − a = 1 and a hair more"),
    ((4, 10, 1, 1, 3, 4, 1e-160), CONTACT, None, "r − a = 1, and a hair of z brings the wall nearer"),
]

KINDS = [
    ((1, 2, 1, 1, 2.5, 0, 0), Kind.EXTERIOR_RING),
    ((1, 1, 1, 1, 0, 0, 0), Kind.INTERIOR_TANGENT_CIRCLE),
    ((2, 1, 1, 1, 1, 0, 0), Kind.INTERIOR_TANGENT_POINT),
    ((2, 5, 1, 1, 3, 0, 0), Kind.EXTERIOR_TANGENT_POINT),
    ((4, 2, 1, 1, 5, 0, 0), Kind.EXTERIOR_TANGENT_OSCULATING),
    ((2, 0.5, 1, 1, 4, 0, 0), Kind.CROSSING_GROOVE_TWO_CURVES),
    ((0.25, 1, 1, 1, 0.5, 0, 0), Kind.CROSSING_THROAT_TWO_CURVES),
    ((1, 1, 1, 1, 1, 0, 0), Kind.CROSSING_ONE_CURVE),
    ((3, 3, 1, 1, 1, 0, 0), Kind.INTERIOR),
    ((2, 1, 1, 1, 4, 0, 0), Kind.EXTERIOR),
]


_direction = st.tuples(*[st.one_of(st.sampled_from([0.0, 1.0, -1.0, 3.0]), _any_offset)] * 3).filter(any)
_touching = st.sampled_from(
    [
        (1, 2, 1, 1.5, 2, 0, 0, 0, 1, 0),  # r − b = α, with the long axis along the circle of the waist
        (1, 2, 1, 0.5, 1.5, 0, 0, -1, 0, 0),  # r − d = α
        (4, 4, 4, 1, 0, 0, 0, 0, 0, 1),  # α = b: tangent along the circle of the waist
        (4, 4, 2, 4, 0, 0, 0, 0, 1, 0),  # α = d
        (2, 5, 1, 1, 3, 0, 0, 0, 0, 1),
        (2, 1, 1, 1, 1, 0, 0, 0, 0, 1),
    ]
)


def _displaced(row: tuple[float, ...], scale: int, steps: tuple[float, ...]) -> tuple[float, ...]:
    """The row times a power of two, its coordinates that are 0 replaced."""
    lengths = [math.ldexp(each, scale) for each in row[:7]]
    return (*lengths[:4], *(x or step for x, step in zip(lengths[4:], steps, strict=True)), *row[7:])


def _beside_0(most: int) -> st.SearchStrategy[float]:
    power = st.builds(lambda sign, exponent: sign * 2.0**exponent, st.sampled_from([1, -1]), st.integers(-1074, most))
    return st.one_of(st.just(0.0), power)


nearly_touching_tilted_rows = st.integers(-1000, 1000).flatmap(
    lambda scale: st.builds(_displaced, _touching, st.just(scale), st.tuples(*[_beside_0(scale)] * 3))
)
"""Rows (10,) that touch, of any size, but for coordinates of any exponent where there was 0; some are tilted."""

extreme_tilted_rows = st.builds(lambda pair, axis: (*pair.row, *axis), extreme_pairs, _direction)
"""Rows (10,) of any float64 at all."""
