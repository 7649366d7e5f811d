"""Many queries at once: float64 arrays of shape (n, 7), columns as in pairs.COLUMNS."""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS, SIZES, trouble_with
from hypcheck.visible import counted

Rows = NDArray[np.float64]
Positions = NDArray[np.int8]

CANNOT_SAY = 2
"""What stands for an answer where a method does not give one."""


def as_rows(values: ArrayLike) -> Rows:
    """`values` as a float64 array (n, 7); contiguous float64 input is not copied.

    Raises InputError where the shape or the type cannot be that, or where values are masked; the values themselves are
    not looked at.
    """
    require_unmasked("the rows are", values)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise InputError(f"the rows are no array of numbers: {error}") from None
    if array.dtype.kind not in "iuf":
        raise InputError(f"the rows are of type {array.dtype}; they must be real numbers")
    rows = np.ascontiguousarray(array, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != len(COLUMNS):
        raise InputError(f"the rows have shape {rows.shape}; it must be (n, 7): {', '.join(COLUMNS)}")
    return rows


def require_unmasked(subject: str, values: object) -> None:
    """Raise InputError for an array with masked values: without their mask they would be answered like others."""
    ma = sys.modules.get("numpy.ma")  # where nobody has imported it, nothing is masked, and that takes a while
    if ma is not None and isinstance(values, ma.MaskedArray) and (count := int(ma.getmaskarray(values).sum())):
        these = "it" if count == 1 else "these"
        raise InputError(f"{subject} masked in {counted(count, 'place')}; fill {these}, with nan or a number")


def invalid(rows: Rows) -> NDArray[np.bool_]:
    """A mask (n,) of the rows that are no valid query (see pairs.Pair)."""
    sizes = rows[:, : len(SIZES)]
    return np.asarray(~(np.isfinite(rows).all(axis=1) & (sizes > 0).all(axis=1)))


def first_trouble(rows: Rows, first_number: int = 0) -> str | None:
    """The sentence about the first invalid row, counted from `first_number`, or None where all rows are valid."""
    bad = np.flatnonzero(invalid(rows))
    if not len(bad):
        return None
    index = int(bad[0])
    for name, value in zip(COLUMNS, rows[index].tolist(), strict=True):
        trouble = trouble_with(name, value)
        if trouble is not None:
            return f"row {first_number + index}: {trouble}"
    raise AssertionError("a row was found invalid, but none of its values is")


def require_valid(rows: Rows, first_number: int = 0) -> None:
    """Raise InputError about the first invalid row, if there is one."""
    trouble = first_trouble(rows, first_number)
    if trouble is not None:
        raise InputError(trouble)
