"""Exact positions of many rows of ten numbers, (n, 10), columns as in geometry.pair.TILTED_COLUMNS."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.geometry.pair import REFUSED, TILTED_COLUMNS
from hypcheck.geometry.rows import Positions, Rows, as_numbers, invalid, require_valid
from hypcheck.truth.tilted import exact
from hypcheck.truth.tilted.pair import TiltedLengths

_NAMES = ", ".join(TILTED_COLUMNS)
_ROWS_WANTED = f"they must be an array (n, 10) of numbers: {_NAMES}"


def positions(rows: ArrayLike, *, on_invalid: Literal["raise", "flag"] = "raise") -> Positions:
    """The exact position of every row of ten numbers: +1 exterior, 0 contact, −1 interior; int8 (n,).

    Raises InputError where `rows` is no array (n, 10) of numbers, and about the first invalid row (counted from 0);
    with on_invalid="flag" such rows are marked 127 instead.
    """
    queries = as_tilted_rows(rows)
    bad = invalid(queries)
    if on_invalid == "raise":
        require_valid(queries)
    result = np.full(len(queries), REFUSED, dtype=np.int8)
    for index in np.flatnonzero(~bad):
        result[index] = exact.position(TiltedLengths.of(queries[index].tolist()))
    return result


def as_tilted_rows(values: ArrayLike) -> Rows:
    """`values` as a float64 array (n, 10); contiguous float64 input is not copied.

    Raises InputError where the shape or the type cannot be that; the values themselves are not looked at.
    """
    rows = np.ascontiguousarray(as_numbers("the rows are", values, _ROWS_WANTED))
    if rows.ndim != 2 or rows.shape[1] != len(TILTED_COLUMNS):
        raise InputError(f"the rows have shape {rows.shape}; it must be (n, 10): {_NAMES}")
    return rows
