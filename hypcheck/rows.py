"""Many queries at once: float64 arrays of shape (n, 7), columns as in pairs.COLUMNS."""

from __future__ import annotations

import reprlib
import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hypcheck.errors import InputError
from hypcheck.pairs import COLUMNS, SIZES, trouble_with
from hypcheck.visible import counted, visible

Floats = NDArray[np.float64]
Rows = NDArray[np.float64]
Positions = NDArray[np.int8]
Columns = tuple[Floats, Floats, Floats]
"""x, y, z of shape (n,), with any strides."""

_ROWS_WANTED = f"an array (n, 7) of numbers: {', '.join(COLUMNS)}"

CANNOT_SAY = 2
"""What stands for an answer where a method does not give one."""


def as_rows(values: ArrayLike) -> Rows:
    """`values` as a float64 array (n, 7); contiguous float64 input is not copied.

    Raises InputError where the shape or the type cannot be that, or where values are masked; the values themselves are
    not looked at.
    """
    rows = np.ascontiguousarray(as_numbers("the rows are", values, f"they must be {_ROWS_WANTED}"))
    if rows.ndim != 2 or rows.shape[1] != len(COLUMNS):
        raise InputError(f"the rows have shape {rows.shape}; it must be (n, 7): {', '.join(COLUMNS)}")
    return rows


def as_columns(names: Sequence[str], given: Sequence[ArrayLike]) -> tuple[Floats, ...]:
    """What stands for x, y, z …, a number or an array (n,) each, as float64 columns of one length n.

    Raises InputError naming what is none, or the shapes that do not go together.
    """
    wanted = "it must be a number or an array (n,) of numbers"
    columns = [np.atleast_1d(as_numbers(f"{name} is", each, wanted)) for name, each in zip(names, given, strict=True)]
    try:
        shape = np.broadcast_shapes(*(each.shape for each in columns))
    except ValueError:
        shape = ()
    if len(shape) != 1:
        shapes = ", ".join(f"{name} {each.shape}" for name, each in zip(names, columns, strict=True))
        raise InputError(f"{shapes} have shapes that do not go together; each must be (n,) or a number")
    return tuple(np.broadcast_to(each, shape) for each in columns)


def as_numbers(subject: str, values: object, wanted: str) -> Floats:
    """`values` as float64 of their own shape. Raises InputError, "<subject> …; <wanted>", unless all are real numbers.

    What float64 does not hold becomes infinite. Texts and truth values are no numbers, and masked values none either.
    """
    require_unmasked(subject, values)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):  # of several lengths
        array = np.empty(0, dtype=np.object_)
    if array.dtype.kind not in "iuf":
        found = f"an array of {values.dtype}" if isinstance(values, np.ndarray) else visible(reprlib.repr(values), 60)
        raise InputError(f"{subject} {found}; {wanted}")
    with np.errstate(over="ignore"):
        return array.astype(np.float64, copy=False)


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
