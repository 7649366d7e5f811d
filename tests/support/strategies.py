"""Questions that hypothesis draws, for all deciders: ordinary, on a grid, of any float64 at all, and frozen ones."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from tests.support.corpus import questions

_size = st.floats(1 / 64, 64)
_offset = st.floats(-96, 96)
_small = st.integers(1, 12).map(float)
_small_offset = st.integers(-14, 14).map(lambda number: number / 2)
_any_size = st.floats(math.ulp(0.0), 1.7e308, allow_subnormal=True)
_any_offset = st.floats(allow_nan=False, allow_infinity=False)
_wide_size = st.floats(2.0**-60, 2.0**60)
_wide_offset = st.floats(-(2.0**60), 2.0**60)
_direction = (
    st.tuples(*[st.floats(-1, 1, allow_subnormal=False)] * 3) | st.tuples(*[st.integers(-4, 4).map(float)] * 3)
).filter(any)


def _rows(size: st.SearchStrategy[float], offset: st.SearchStrategy[float], groups: str):
    """Rows of these sizes and places: α, γ, b, d, the centre, the end of a way, an axis, heights."""
    places = st.tuples(*[offset] * (6 if "end" in groups else 3))
    axis = _direction if "axis" in groups else st.just(())
    parts = st.tuples(st.tuples(*[size] * 4), places, axis).map(lambda parts: (*parts[0], *parts[1], *parts[2]))
    return (
        st.tuples(parts, _heights(offset)).map(lambda parts: (*parts[0], *parts[1])) if "heights" in groups else parts
    )


def _heights(offset: st.SearchStrategy[float]):
    """z_min, z_max, of which one may be infinite, and solid."""
    ends = st.tuples(offset | st.just(-math.inf), offset | st.just(math.inf)).filter(lambda ends: ends[0] < ends[1])
    return st.tuples(ends, st.sampled_from([0.0, 1.0])).map(lambda parts: (*parts[0], parts[1]))


def rows_of(groups: str) -> st.SearchStrategy[tuple[float, ...]]:
    """Rows with these groups of columns.

    Any float64 at all is drawn for upright positions alone: with an axis or on a way one row can take a second. The
    frozen rows have such numbers.
    """
    frozen = questions(groups).rows
    drawn = [
        _rows(_size, _offset, groups),
        _rows(_small, _small_offset, groups),
        st.integers(0, len(frozen) - 1).map(lambda index: tuple(frozen[index].tolist())),
    ]
    sizes, offsets = (_wide_size, _wide_offset) if groups else (_any_size, _any_offset)
    return st.one_of(*drawn, *([] if "end" in groups else [_rows(sizes, offsets, groups)]))
