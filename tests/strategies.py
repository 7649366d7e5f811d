"""Pairs for property tests: every regime, every magnitude, and the borders where cases coincide."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.pairs import Pair


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
