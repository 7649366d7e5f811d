"""Many straight sweeps, of one pair of sizes or of a whole scene: which have contact, when first, and with what.

Hits are decided at once, times when they are asked for: the first costs a microsecond, the other a millisecond a sweep.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hypcheck.errors import InputError
from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.forms import Argument, named_points, require_known, sizes_of, spread
from hypcheck.geometry.pair import AXIS, CENTER, END, HEIGHTS, REFUSED, SIZES, START, WITHOUT_ENDS
from hypcheck.geometry.rows import (
    CANNOT_SAY,
    SWEEPS,
    Floats,
    Indices,
    Layout,
    Mask,
    Positions,
    Rows,
    as_rows,
    names_of,
    require_valid,
)
from hypcheck.kernel.in_use import kernel
from hypcheck.truth import swept
from hypcheck.truth.rationals import rounded_toward

First = tuple[tuple[Fraction, Fraction], int]
"""The time of the first contact, in an open interval or as one number twice; and the hyperboloid's number."""


@dataclass(frozen=True, eq=False)
class Passages:
    """The results for n straight sweeps; every array is (n,). For one sweep they are numbers.

    `hit`: whether there is contact somewhere on the sweep, its two ends included. It is exact, as are all results here.
    """

    hit: Mask | bool
    measure: Callable[[int], First] = field(repr=False)
    """The first contact of a sweep that has one."""

    @cached_property
    def _firsts(self) -> list[First | None]:
        return [self.measure(sweep) if hit else None for sweep, hit in enumerate(np.atleast_1d(self.hit).tolist())]

    @property
    def first(self) -> list[tuple[Fraction, Fraction] | None]:
        """Two fractions that enclose the time of the first contact, 0 ≤ t ≤ 1; None where the sweep is clear."""
        times = [None if first is None else first[0] for first in self._firsts]
        return times if np.ndim(self.hit) else times[0]  # type: ignore[return-value]

    @cached_property
    @in_default_environment
    def first_lower(self) -> Floats:
        """No contact comes before this time, rounded down; NaN where there is none."""
        times: Floats = self._rounded(0, -math.inf)
        return times

    @cached_property
    @in_default_environment
    def first_upper(self) -> Floats:
        """The first contact is not after this time, rounded up; NaN where there is none."""
        times: Floats = self._rounded(1, math.inf)
        return times

    @cached_property
    def index(self) -> Indices:
        """Which hyperboloid is touched first, its number from 0; −1 where the sweep is clear."""
        numbers: Indices = self._shaped([-1 if first is None else first[1] for first in self._firsts], np.intp)
        return numbers

    def _rounded(self, side: int, towards: float) -> Any:  # noqa: ANN401 - an array, or its number
        times = [math.nan if first is None else rounded_toward(first[0][side], towards) for first in self._firsts]
        return self._shaped(times, np.float64)

    def _shaped(self, values: list[Any], kind: type) -> Any:  # noqa: ANN401 - an array, or its number
        return np.array(values, kind) if np.ndim(self.hit) else values[0]

    def __array__(self, dtype: object = None, copy: bool | None = None) -> Positions:
        """The hits as int8 (n,), which Scene.passage returned in 0.1."""
        hits: Positions = np.atleast_1d(self.hit).astype(np.int8)
        return hits

    def tolist(self) -> list[int]:
        """The hits as 1 and 0, as of that array."""
        return [int(hit) for hit in np.atleast_1d(self.hit)]


def passages(
    sweeps: Sequence[Argument],
    columns: Mapping[str, Argument],
    axis: ArrayLike | None,
    heights: Sequence[Argument],
) -> Passages:
    """The results for sweeps in a form that hypcheck.passage accepts. Raises InputError."""
    given, single = _rows_of(sweeps, columns, axis, heights)
    rows = np.ascontiguousarray(given)
    require_valid(rows, layout=_LAYOUT)
    hits = _hits(rows)
    return Passages(bool(hits[0]) if single else hits, lambda sweep: (_interval(rows[sweep].tolist()), 0))


def _rows_of(
    sweeps: Sequence[Argument], columns: Mapping[str, Argument], axis: ArrayLike | None, heights: Sequence[Argument]
) -> tuple[Rows, bool]:
    """Rows of sweeps, and whether they are one sweep of numbers."""
    values: dict[str, Argument] = {}
    columns = {_NEW.get(name, name): value for name, value in columns.items()}
    require_known(columns, (*_LAYOUT.ended, "start", "end"))
    if len(sweeps) == 1 and not columns and axis is None and names_of(sweeps[0]) is None:
        single = np.ndim(sweeps[0]) == 1
        rows = as_rows([sweeps[0]] if single else sweeps[0], tilted=True, heights=True, layout=_LAYOUT)
        return rows, single
    if len(sweeps) == 1:
        names = names_of(sweeps[0])
        if names is None and not {"start", "end"}.isdisjoint(columns):
            raise InputError(f"{_FORMS}; start or end is missing")
        if names is None:
            raise InputError("rows of sweeps have their own axis and heights; these cannot be given beside them")
        values = spread({_NEW.get(name, name): sweeps[0][name] for name in names}, _POINTS)
    elif len(sweeps) in (3, 6):
        values = sizes_of(sweeps[0] if len(sweeps) == 3 else sweeps[:4])
        values |= named_points("start", sweeps[-2]) | named_points("end", sweeps[-1], END)
    elif sweeps or not columns:
        raise InputError(f"{_FORMS}, not {len(sweeps)} arguments")
    values |= spread(columns, _POINTS)
    if axis is not None:
        values |= named_points("axis", axis, AXIS)
    if any(np.ndim(height) or height != usual for height, usual in zip(heights, WITHOUT_ENDS, strict=True)):
        values |= dict(zip(HEIGHTS, heights, strict=True))
    rows = as_rows(values, tilted=True, heights=True, layout=_LAYOUT)
    return rows, all(not np.ndim(column) for column in values.values())


_FORMS = "passage takes (sizes, start, end), (alpha, gamma, b, d, start, end), rows or a table"

_LAYOUT = Layout(SIZES + CENTER + END)
"""The columns of sweeps as rows and tables have them."""

_POINTS = {"start": CENTER, "end": END, "axis": AXIS}

_NEW = dict(zip(START, CENTER, strict=True))
"""The protocol calls the centre at the start x0, y0, z0; that is taken too."""


def _hits(rows: Rows) -> Mask:
    """Hits, by bounds and else exactly. A sweep that is clear of an infinite hyperboloid is clear of its open wall."""
    width = len(SWEEPS.tilted)
    whole = np.ascontiguousarray(rows[:, :width])
    answers = kernel().answer_sweeps(whole)[0]
    if SWEEPS.has_heights(rows):
        ended = np.isfinite(rows[:, width : width + 2]).any(axis=1)
        sure = ~ended | ((answers == 0) & (rows[:, width + 2] == 0))
        answers = np.where(sure, answers, CANNOT_SAY)
    hits = np.asarray(answers == 1)
    for sweep in np.flatnonzero((answers == CANNOT_SAY) | (answers == REFUSED)).tolist():
        hits[sweep] = _passage_of(rows[sweep].tolist()).hit
    return hits


def _passage_of(row: Sequence[float]) -> swept.Passage:
    low, high, solid = row[13:] or WITHOUT_ENDS
    return swept.passage(row[:4], row[4:7], row[7:10], row[10:13] or None, z_min=low, z_max=high, solid=solid)


def _interval(row: Sequence[float]) -> tuple[Fraction, Fraction]:
    first = _passage_of(row).first
    if first is None:
        raise AssertionError(f"the exact decision about a sweep contradicts its bounds: {row}")
    return first
