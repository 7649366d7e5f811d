"""The record's line about one implementation and one family: counts, distances, bins and the worst cases."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.judge import Criterion, Status, WrongCase
from hypcheck.rows import Rows

WORST_KEPT = 3
"""Worst cases a group keeps with their rows; its counts are always exact."""

Statuses = NDArray[Any]
"""The status of each case, (n,), as strings of judge.Status."""


@dataclass(frozen=True)
class Judged:
    """The cases of one family as one implementation ended them.

    `rows` (n, 7) were asked and `status` (n,) says how each ended; `wrong` are those that were wrong or tolerated, with
    their places in `rows`; `skipped` counts rows outside the implementation's domain. `name` gives a place its case id.
    """

    family: str
    rows: Rows
    status: Statuses
    wrong: tuple[WrongCase, ...]
    skipped: int
    name: Callable[[int], str]


def line(judged: Judged, octaves: NDArray[np.float64], criterion: Criterion) -> dict[str, Any]:
    """The fields of the line; `octaves` are the first rows' own distances to the nearest other position."""
    counts = Counter(judged.status.tolist())
    counts[Status.SKIPPED.value] = judged.skipped
    return {
        "question": criterion.question,
        "precision": criterion.precision,
        "family": judged.family,
        "asked": len(judged.rows),
        "counts": {name: number for name, number in sorted(counts.items()) if number},
        "mistakes": dict(sorted(Counter(case.mistake.value for case in judged.wrong).items())),
        "octaves": _by_octave(octaves, judged.status[: len(octaves)]),
        "size_bins": _size_bins(judged.rows, judged.status),
        "place_bins": _place_bins(judged.rows, judged.status),
        "worst": [
            _worst(case, error, judged.name(case.index), criterion)
            for case, error in _worst_first(judged.wrong, criterion)
        ],
    }


def _worst_first(cases: Sequence[WrongCase], criterion: Criterion) -> list[tuple[WrongCase, float]]:
    """The worst cases with their backward errors: wrong before tolerated, then the largest error, then the first."""
    ranked = sorted(cases, key=lambda case: (case.status is not Status.WRONG, -case.exponent, case.index))
    kept = ranked[:WORST_KEPT]
    # Inside the last octave that is kept only the numbers themselves tell which cases are the worst.
    rivals = [
        case for case in ranked[WORST_KEPT:] if (case.status, case.exponent) == (kept[-1].status, kept[-1].exponent)
    ]
    if kept and math.isfinite(kept[-1].exponent):
        kept = [*kept, *rivals]
    with_errors = [(case, judge.measured(case, criterion.question)) for case in kept]
    with_errors.sort(key=lambda pair: (pair[0].status is not Status.WRONG, -pair[1], pair[0].index))
    return with_errors[:WORST_KEPT]


def _worst(case: WrongCase, error: float, name: str, criterion: Criterion) -> dict[str, Any]:
    return {
        "case": name,
        "row": [value.hex() for value in case.row],
        "truth": int(case.truth),
        "answer": case.answer,
        "mistake": case.mistake.value,
        "status": case.status.value,
        "backward_error": error,
        "backward_error_u": judge.in_units(error, criterion.unit),
    }


def _by_octave(octaves: NDArray[np.float64], status: Statuses) -> dict[str, dict[str, int]]:
    """Counts by status for each octave of the case's own distance to the nearest other position."""
    table: dict[str, Counter[str]] = {}
    for octave, name in zip(map(float, octaves), status.tolist(), strict=True):
        key = str(int(octave)) if math.isfinite(octave) else str(octave)
        table.setdefault(key, Counter())[name] += 1
    return {key: dict(sorted(table[key].items())) for key in sorted(table, key=float)}


def _size_bins(rows: Rows, status: Statuses) -> list[list[int]]:
    """Rows [⌊log2 α/b⌋, ⌊log2 γ/d⌋, asked, wrong or tolerated], one for each bin that has cases."""
    with np.errstate(all="ignore"):
        return _bins(np.frexp(rows[:, 0] / rows[:, 2])[1] - 1, np.frexp(rows[:, 1] / rows[:, 3])[1] - 1, status)


def _place_bins(rows: Rows, status: Statuses) -> list[list[int]]:
    """Rows [⌊8 r/α⌋, ⌊8 |z|/γ⌋, asked, wrong or tolerated], both clipped to 0 … 63."""
    with np.errstate(all="ignore"):
        r, z = np.hypot(rows[:, 4], rows[:, 5]) / rows[:, 0], np.abs(rows[:, 6]) / rows[:, 1]
        across, along = (np.nan_to_num(np.clip(8 * value, 0, 63)).astype(int) for value in (r, z))
    return _bins(across, along, status)


def _bins(first: NDArray[Any], second: NDArray[Any], status: Statuses) -> list[list[int]]:
    # Two bin numbers in one key: sorting pairs is fifty times slower.
    keys, bin_of = np.unique((first.astype(np.int64) << 32) + second.astype(np.int64), return_inverse=True)
    asked = np.bincount(bin_of, minlength=len(keys))
    wrong = np.bincount(bin_of[status != Status.RIGHT.value], minlength=len(keys))
    seconds = (keys + (1 << 31)) % (1 << 32) - (1 << 31)
    table = np.column_stack([(keys - seconds) >> 32, seconds, asked, wrong])
    return [[int(number) for number in line] for line in table]
