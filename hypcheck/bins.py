"""Where cases lie: counts over the sizes of the bodies and over the place of the centre, added up part by part."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hypcheck.rows import Rows

Integers = NDArray[np.int64]
Mask = NDArray[np.bool_]

FAR = 63
"""The last bin of a place, which holds everything beyond it too."""

_LEAST, _GREATEST = 2.0**-1000, 2.0**1000
_DENSE = 1 << 16


def _nothing() -> Integers:
    return np.empty((0, 4), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Bins:
    """A `table` (n, 4), ascending: the two numbers of a bin, its cases, and how many of these did not end as right."""

    table: Integers = field(default_factory=_nothing)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Bins) and np.array_equal(self.table, other.table)

    __hash__ = None  # type: ignore[assignment]  # arrays can change

    def as_lists(self) -> list[list[int]]:
        """Rows [first, second, cases, amiss], as the record has them."""
        lists: list[list[int]] = self.table.tolist()
        return lists

    @classmethod
    def of_lists(cls, lists: list[list[int]]) -> Bins:
        """The bins of such rows."""
        return cls(np.array(lists, dtype=np.int64).reshape(-1, 4))


def by_size(rows: Rows, amiss: Mask) -> Bins:
    """Bins (⌊log2 α/b⌋, ⌊log2 γ/d⌋)."""
    sizes = rows[:, :4]
    if len(rows) > 1 and (sizes == sizes[0]).all():  # of a scene with one of each
        (first, second, *_), *_ = by_size(rows[:1], amiss[:1]).as_lists()
        return Bins.of_lists([[first, second, len(rows), int(np.count_nonzero(amiss))]])
    with np.errstate(all="ignore"):
        across, along = (np.frexp(rows[:, i] / rows[:, i + 2])[1].astype(np.int64) - 1 for i in (0, 1))
    return _counted(across, along, amiss)


def by_place(rows: Rows, amiss: Mask) -> Bins:
    """Bins (⌊8 r/α⌋, ⌊8 |z|/γ⌋), both clipped to 0 … FAR."""
    with np.errstate(all="ignore"):
        across, along = _eighths(_radius(rows), rows[:, 0]), _eighths(np.abs(rows[:, 6]), rows[:, 1])
    return _counted(across, along, amiss)


def added(parts: Iterable[Bins]) -> Bins:
    """The bins of all parts together."""
    tables = [part.table for part in parts if len(part.table)]
    if not tables:
        return Bins()
    together = np.concatenate(tables)
    return Bins(_summed(together[:, 0], together[:, 1], together[:, 2:]))


def _radius(rows: Rows) -> NDArray[np.float64]:
    """√(x² + y²); by the slower hypot where a square leaves the range of floats."""
    x, y = rows[:, 4], rows[:, 5]
    square = x * x + y * y
    if len(rows) and _LEAST < square.min() and square.max() < _GREATEST:
        return np.sqrt(square, out=square)
    return np.hypot(x, y)


def _eighths(lengths: NDArray[np.float64], units: NDArray[np.float64]) -> Integers:
    eighths = lengths / units
    eighths *= 8
    return np.minimum(eighths, FAR, out=eighths).astype(np.int64)


def _counted(first: Integers, second: Integers, amiss: Mask) -> Bins:
    if not len(first):
        return Bins()
    low, origin = first.min(), second.min()
    span = second.max() - origin + 1
    if (first.max() - low + 1) * span > _DENSE:
        return Bins(_summed(first, second, np.column_stack([np.ones_like(first), amiss])))
    keys = (first - low) * span + (second - origin)
    cases = np.bincount(keys)
    wrong = np.bincount(keys[amiss], minlength=len(cases))
    there = np.flatnonzero(cases)
    return Bins(np.column_stack([there // span + low, there % span + origin, cases[there], wrong[there]]))


def _summed(first: Integers, second: Integers, counts: Integers) -> Integers:
    """One row [first, second, …] for each pair of numbers, ascending, with the sums of its counts."""
    keys = (first << 32) + second  # two numbers in one: sorting pairs is fifty times slower
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    starts = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
    return np.column_stack(
        [first[order][starts], second[order][starts], np.add.reduceat(counts[order], starts, axis=0)]
    )
