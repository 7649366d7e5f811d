"""Tallies of cases: counts by status, histograms over sizes and places, and the worst cases.

A tally is a struct of the record, so an interrupted run writes it without conversion. Tallies of parts add up to that
of the whole in any order: counts are sums, and the cases that are kept with their rows depend on their places in the
family, not on the order in which they were judged. A tally of all cases of a family becomes a line of the record.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping

import numpy as np
from msgspec import UNSET, UnsetType
from numpy.typing import NDArray

from hypcheck.geometry.rows import Mask, Positions, Rows
from hypcheck.record import lines
from hypcheck.record.fields import Histogram, Unsigned, row_of, row_parts
from hypcheck.record.lines import GroupLine
from hypcheck.record.progress import Place, Tally, UnansweredCase, WorstCase
from hypcheck.runs import diagnosis, judge
from hypcheck.runs.judge import Criterion, Status, WrongCase
from hypcheck.truth.passage_error import first_contact

Integers = NDArray[np.int64]

FAR = 63
"""The last bin of a place, which also holds all places beyond it."""

_LEAST, _GREATEST = 2.0**-1000, 2.0**1000
_DENSE = 1 << 16


def by_size(rows: Rows, amiss: Mask) -> Histogram:
    """Count the rows in bins by size, (⌊log2 α/b⌋, ⌊log2 γ/d⌋): all rows, and those that are amiss."""
    sizes = rows[:, :4]
    if len(rows) > 1 and (sizes == sizes[0]).all():  # rows of a scene
        (first, second, *_), *_ = by_size(rows[:1], amiss[:1]).as_lists()
        return Histogram.of_lists([[first, second, len(rows), int(np.count_nonzero(amiss))]])
    with np.errstate(all="ignore"):
        across, along = (np.frexp(rows[:, i] / rows[:, i + 2])[1].astype(np.int64) - 1 for i in (0, 1))
    return _counted(across, along, amiss)


def by_place(rows: Rows, amiss: Mask) -> Histogram:
    """Count the rows in bins by place, (⌊8 r/α⌋, ⌊8 |z|/γ⌋), both limited to FAR: all rows, and those that are amiss.

    r is the distance of the centre from the axis. A sweep is counted at its start.
    """
    with np.errstate(all="ignore"):
        across, along = _eighths(_radius(rows), rows[:, 0]), _eighths(np.abs(rows[:, 6]), rows[:, 1])
    return _counted(across, along, amiss)


def added(parts: Iterable[Histogram]) -> Histogram:
    """Add the counts of all parts, bin by bin."""
    tables = [part.table for part in parts if len(part.table)]
    if not tables:
        return Histogram()
    together = np.concatenate(tables)
    return Histogram(_summed(together[:, 0], together[:, 1], together[:, 2:]))


def _radius(rows: Rows) -> NDArray[np.float64]:
    """Compute √(x² + y²); if a square overflows or underflows float64, by the slower hypot."""
    x, y = rows[:, 4], rows[:, 5]
    square = x * x + y * y
    if len(rows) and _LEAST < square.min() and square.max() < _GREATEST:
        return np.sqrt(square, out=square)
    return np.hypot(x, y)


def _eighths(lengths: NDArray[np.float64], units: NDArray[np.float64]) -> Integers:
    """Return the lengths in eighths of their units, rounded down, at most FAR."""
    eighths = lengths / units
    eighths *= 8
    return np.minimum(eighths, FAR, out=eighths).astype(np.int64)


def _counted(first: Integers, second: Integers, amiss: Mask) -> Histogram:
    """Count the pairs of numbers: how often each occurs, and how often amiss."""
    if not len(first):
        return Histogram()
    low, origin = first.min(), second.min()
    span = second.max() - origin + 1
    if (first.max() - low + 1) * span > _DENSE:
        return Histogram(_summed(first, second, np.column_stack([np.ones_like(first), amiss])))
    keys = (first - low) * span + (second - origin)
    cases = np.bincount(keys)
    wrong = np.bincount(keys[amiss], minlength=len(cases))
    there = np.flatnonzero(cases)
    return Histogram(np.column_stack([there // span + low, there % span + origin, cases[there], wrong[there]]))


def _summed(first: Integers, second: Integers, counts: Integers) -> Integers:
    """Add `counts` for each distinct pair of numbers; return rows [first, second, sums …], ascending."""
    keys = (first << 32) + second  # both numbers as one: sorting pairs is fifty times slower
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    starts = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
    return np.column_stack(
        [first[order][starts], second[order][starts], np.add.reduceat(counts[order], starts, axis=0)]
    )


WORST_KEPT = 3
"""The number of worst cases that a group keeps with their rows; its counts include all cases."""

UNANSWERED_KEPT = 5
"""The number of cases of each status without a valid answer that a tally keeps, with their reasons.

The line of the record has as many in all, or one of each status if that is more.
"""

STATUSES = tuple(Status)
STATUS_CODES: Mapping[Status, int] = {status: code for code, status in enumerate(STATUSES)}
"""The number that represents a status in arrays."""

StatusCodes = NDArray[np.int8]


def worst_case(case: WrongCase, place: Place, name: str, criterion: Criterion) -> WorstCase:
    """Make the record's struct of a wrong case at that place with that id, with its measured error."""
    return diagnosis.kept_case(case, place, name, criterion.layout, judge.measured(case, criterion.question))


def rank_of(case: WorstCase) -> tuple[bool, float, Place]:
    """Return the key that orders worst cases: wrong before tolerated, then the largest error, then the first place."""
    return case.status != Status.WRONG, -case.error, case.place


EMPTY = Tally(
    asked=0,
    counts={},
    mistakes={},
    dangerous=0,
    octaves={},
    size_bins=Histogram(),
    place_bins=Histogram(),
    worst=[],
    faults=[],
)
"""The tally of no case."""


def merged_tally(tallies: Iterable[Tally]) -> Tally:
    """Add tallies; their order has no effect."""
    parts = tuple(tallies)
    return Tally(
        asked=sum(part.asked for part in parts),
        fresh=sum(part.fresh for part in parts),
        not_asked=_added(part.not_asked for part in parts),
        counts=_added(part.counts for part in parts),
        mistakes=_added(part.mistakes for part in parts),
        answers=_added_tables(part.answers for part in parts),
        dangerous=sum(part.dangerous for part in parts),
        octaves=_added_tables(part.octaves for part in parts),
        size_bins=added(part.size_bins for part in parts),
        place_bins=added(part.place_bins for part in parts),
        worst=sorted((case for part in parts for case in part.worst), key=rank_of)[:WORST_KEPT],
        faults=kept_unanswered(case for part in parts for case in part.faults),
        explained=diagnosis.merged(explained for part in parts for explained in part.explained),
        denied=dict(sorted(_added(part.denied for part in parts).items())),
    )


def group_line(
    tallied: Tally,
    family: str,
    criterion: Criterion,
    *,
    method: str,
    title: str,
    exact: bool = False,
    spec: str | UnsetType = UNSET,
    failing: list[str] | UnsetType = UNSET,
) -> GroupLine:
    """Return the record's line about a family.

    For an implementation under test, `spec` is its SPEC, and `failing` are the statuses that fail the run.
    """
    return GroupLine(
        method=method,
        spec=spec,
        title=title,
        exact=exact,
        question=criterion.question,
        precision=criterion.precision,
        family=family,
        asked=tallied.asked,
        fresh=UNSET if failing is UNSET else tallied.fresh,
        not_asked=dict(sorted(tallied.not_asked.items())),
        counts=dict(sorted(tallied.counts.items())),
        mistakes=dict(sorted(tallied.mistakes.items())),
        answers=UNSET
        if failing is UNSET or not tallied.answers
        else {truth: dict(sorted(counts.items())) for truth, counts in sorted(tallied.answers.items())},
        octaves={key: dict(sorted(tallied.octaves[key].items())) for key in sorted(tallied.octaves, key=float)},
        size_bins=tallied.size_bins.as_lists(),
        place_bins=tallied.place_bins.as_lists(),
        worst=[worst_line(case, criterion) for case in tallied.worst],
        faults=UNSET if failing is UNSET else _unanswered_lines(tallied),
        failing=failing,
    )


def _unanswered_lines(tallied: Tally) -> list[lines.FaultPart]:
    """Choose the unanswered cases for the record's line: the first of each status, then more up to UNANSWERED_KEPT."""
    first = {fault.status: fault for fault in reversed(tallied.faults)}.values()
    others = [fault for fault in tallied.faults if fault not in first]
    chosen = [*first, *others[: max(0, UNANSWERED_KEPT - len(first))]]
    return [
        lines.FaultPart(case=fault.case, **row_parts(fault), status=fault.status, reason=fault.reason)
        for fault in sorted(chosen, key=lambda fault: fault.place)
    ]


def _added(parts: Iterable[Mapping[str, int]]) -> dict[str, int]:
    """Add counts by their keys."""
    total: Counter[str] = Counter()
    for part in parts:
        total.update(part)
    return dict(total)


def _added_tables(parts: Iterable[Mapping[str, Mapping[str, int]]]) -> dict[str, dict[str, int]]:
    """Add tables of counts by their keys."""
    total: dict[str, dict[str, int]] = {}
    for part in parts:
        for key, counts in part.items():
            total[key] = _added((total.get(key, {}), counts))
    return total


_ANSWERS = ("-1", "0", "1", "2", "none")
"""The answers of the record, in the order of their columns in answer_counts."""


def answer_counts(truth: Positions, answers: NDArray[np.int8], answered: Mask) -> dict[str, dict[str, int]]:
    """Count rows by truth (n,), then by answer (n,); the answer is "none" where `answered` (n,) is false."""
    columns = np.where(answered, answers + 1, len(_ANSWERS) - 1)
    counts = np.bincount((truth.astype(np.int64) + 1) * len(_ANSWERS) + columns, minlength=3 * len(_ANSWERS))
    table = counts.reshape(3, len(_ANSWERS)).tolist()
    by_truth = {
        str(number): {name: cases for name, cases in zip(_ANSWERS, row, strict=True) if cases}
        for number, row in zip((-1, 0, 1), table, strict=True)
    }
    return {number: row for number, row in by_truth.items() if row}


def counts_of(status: StatusCodes) -> dict[str, int]:
    """Count cases by status."""
    other = status[status != STATUS_CODES[Status.RIGHT]]  # usually few
    numbers = np.bincount(other, minlength=len(STATUSES)).tolist()
    numbers[STATUS_CODES[Status.RIGHT]] = len(status) - len(other)
    return {name.value: number for name, number in zip(STATUSES, numbers, strict=True) if number}


def by_octave(exponents: NDArray[np.float64], status: StatusCodes) -> dict[str, dict[str, int]]:
    """Count cases by floor(log2) of their distance to the nearest other position, ascending, then by status."""
    table = {}
    for exponent in sorted(set(exponents.tolist())):  # np.unique would load numpy.ma
        key = str(int(exponent)) if math.isfinite(exponent) else str(exponent)
        table[key] = counts_of(status[exponents == exponent])
    return table


def kept_unanswered(faults: Iterable[UnansweredCase]) -> list[UnansweredCase]:
    """Return the first cases of each status, at most UNANSWERED_KEPT."""
    kept: list[UnansweredCase] = []
    seen: Counter[str] = Counter()
    for fault in sorted(faults, key=lambda fault: fault.place):
        seen[fault.status] += 1
        if seen[fault.status] <= UNANSWERED_KEPT:
            kept.append(fault)
    return kept


def worst_line(case: WorstCase, criterion: Criterion) -> lines.WrongAnswer:
    """Return the worst case for a line of the record, its error in units of the precision too."""
    return lines.WrongAnswer(
        case=case.case,
        **row_parts(case),
        truth=case.truth,
        answer=case.answer,
        mistake=case.mistake,
        status=case.status,
        backward_error=case.error,
        backward_error_u=Unsigned(judge.in_units(case.error, criterion.unit)),
        time=UNSET if case.time is None else case.time,
        first=UNSET if case.time is None else first_contact(row_of(case)),
    )
