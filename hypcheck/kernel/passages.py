"""Many straight sweeps, of one pair of sizes or of a whole scene: which have contact, when first, and with what.

Hits are decided at once, times at their first use: for each sweep a hit costs a microsecond, a time a millisecond.
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

from hypcheck.float_environment import in_default_environment
from hypcheck.geometry.arithmetic import rounded_toward
from hypcheck.geometry.forms import SWEEP, Argument, questions_of
from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import (
    CANNOT_SAY,
    SWEEPS,
    Floats,
    Indices,
    Mask,
    Rows,
)
from hypcheck.kernel.in_use import kernel
from hypcheck.truth.swept import passage_of_row

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
        """The first contact of each sweep, None for sweeps without."""
        return [self.measure(sweep) if hit else None for sweep, hit in enumerate(np.atleast_1d(self.hit).tolist())]

    @property
    def first(self) -> list[tuple[Fraction, Fraction] | None]:
        """Two fractions that enclose the time of the first contact, 0 ≤ t ≤ 1; None where the sweep is clear."""
        times = [None if first is None else first[0] for first in self._firsts]
        return times if np.ndim(self.hit) else times[0]  # type: ignore[return-value]

    @cached_property
    @in_default_environment
    def first_lower(self) -> Floats:
        """A lower bound, rounded down, of the time of the first contact; NaN if there is no contact."""
        times: Floats = self._rounded(0, -math.inf)
        return times

    @cached_property
    @in_default_environment
    def first_upper(self) -> Floats:
        """An upper bound, rounded up, of the time of the first contact; NaN if there is no contact."""
        times: Floats = self._rounded(1, math.inf)
        return times

    @cached_property
    def index(self) -> Indices:
        """The number, from 0, of the hyperboloid that is touched first; −1 if the sweep is clear."""
        numbers: Indices = self._shaped([-1 if first is None else first[1] for first in self._firsts], np.intp)
        return numbers

    def _rounded(self, side: int, towards: float) -> Any:  # noqa: ANN401 - an array, or its number
        """Return one end of the intervals of first contact, rounded to float64 towards a side."""
        times = [math.nan if first is None else rounded_toward(first[0][side], towards) for first in self._firsts]
        return self._shaped(times, np.float64)

    def _shaped(self, values: list[Any], kind: type) -> Any:  # noqa: ANN401 - an array, or its number
        """Return the values as an array, or for one sweep as a number."""
        return np.array(values, kind) if np.ndim(self.hit) else values[0]


def passages(
    sweeps: Sequence[Argument],
    columns: Mapping[str, Argument],
    axis: ArrayLike | None,
    heights: Sequence[Argument],
) -> Passages:
    """Return the results for sweeps in a form that hypcheck.passage accepts. Raises InputError."""
    call = questions_of(sweeps, columns, axis, heights, SWEEP)
    rows = np.ascontiguousarray(call.rows())
    call.require_valid(rows)
    hits = _hits(rows)
    return Passages(bool(hits[0]) if call.single else hits, lambda sweep: (_interval(rows[sweep].tolist()), 0))


def _hits(rows: Rows) -> Mask:
    """Return hits, by bounds and else exactly.

    A sweep that is clear of an infinite hyperboloid is clear of its open wall.
    """
    width = len(SWEEPS.tilted)
    whole = np.ascontiguousarray(rows[:, :width])
    answers = kernel().answer_sweeps(whole)[0]
    if SWEEPS.has_heights(rows):
        ended = np.isfinite(rows[:, width : width + 2]).any(axis=1)
        sure = ~ended | ((answers == 0) & (rows[:, width + 2] == 0))
        answers = np.where(sure, answers, CANNOT_SAY)
    hits = np.asarray(answers == 1)
    for sweep in np.flatnonzero((answers == CANNOT_SAY) | (answers == REFUSED)).tolist():
        hits[sweep] = passage_of_row(rows[sweep].tolist()).hit
    return hits


def _interval(row: Sequence[float]) -> tuple[Fraction, Fraction]:
    """Return the exact interval of the first contact of a sweep that has one."""
    first = passage_of_row(row).first
    if first is None:
        raise AssertionError(f"the exact decision about a sweep contradicts its bounds: {row}")
    return first
