"""The record's line about one implementation and one family: counts, distances, bins and the worst cases.

A Tally is what such a line says of some of the cases. Tallies of parts add up to that of the whole in any order: counts
are sums, and which cases are kept with their rows depends on their places in the family, not on who was judged first.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from msgspec import UNSET, UnsetType
from numpy.typing import NDArray

from hypcheck import bins, judge
from hypcheck.bins import Bins
from hypcheck.judge import Criterion, Status
from hypcheck.record import lines
from hypcheck.record.fields import Unsigned
from hypcheck.record.lines import Group

WORST_KEPT = 3
"""Worst cases a group keeps with their rows; its counts are always exact."""

FAULTS_KEPT = 5
"""Cases that ended without an answer that counts which a group keeps with the reason; more, one of each status."""

STATUSES = tuple(Status)
CODES: Mapping[Status, int] = {status: code for code, status in enumerate(STATUSES)}
"""The number that stands for a status in arrays."""

Codes = NDArray[np.int8]
Place = tuple[int, int]
"""Where a case stands in its family: (0, n) for the n-th frozen vector, (1, n) for the n-th generated row."""


@dataclass(frozen=True, slots=True)
class Worst:
    """A wrong or tolerated answer that is kept: `error` is its backward error."""

    place: Place
    case: str
    row: tuple[float, ...]
    truth: int
    answer: int
    mistake: str
    status: str
    error: float

    @property
    def rank(self) -> tuple[bool, float, Place]:
        """Wrong before tolerated, then the largest error, then the first."""
        return self.status != Status.WRONG, -self.error, self.place


@dataclass(frozen=True, slots=True)
class Fault:
    """A case that ended without an answer that counts, and why."""

    place: Place
    case: str
    row: tuple[float, ...]
    status: str
    reason: str


@dataclass(frozen=True)
class Tally:
    """What came of some cases of one family.

    `counts` are by status, skipped rows among them though they are not `asked`; `mistakes` by what wrong and tolerated
    answers mean; `dangerous` are wrong ones, beyond the tolerance and unexcused, that claim clear in contact; `octaves`
    by the cases' own distance to the nearest other position, and there by status. `worst` and `faults` are in order.
    """

    asked: int = 0
    counts: Mapping[str, int] = field(default_factory=dict)
    mistakes: Mapping[str, int] = field(default_factory=dict)
    dangerous: int = 0
    octaves: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    size_bins: Bins = field(default_factory=Bins)
    place_bins: Bins = field(default_factory=Bins)
    worst: tuple[Worst, ...] = ()
    faults: tuple[Fault, ...] = ()


def merged(tallies: Iterable[Tally]) -> Tally:
    """The tally of all cases of these tallies, in whatever order they come."""
    parts = tuple(tallies)
    octaves: dict[str, Mapping[str, int]] = {}
    for part in parts:
        for key, counts in part.octaves.items():
            octaves[key] = _added((octaves.get(key, {}), counts))
    return Tally(
        asked=sum(part.asked for part in parts),
        counts=_added(part.counts for part in parts),
        mistakes=_added(part.mistakes for part in parts),
        dangerous=sum(part.dangerous for part in parts),
        octaves=octaves,
        size_bins=bins.added(part.size_bins for part in parts),
        place_bins=bins.added(part.place_bins for part in parts),
        worst=tuple(sorted((case for part in parts for case in part.worst), key=lambda case: case.rank)[:WORST_KEPT]),
        faults=kept(fault for part in parts for fault in part.faults),
    )


def line(
    tallied: Tally,
    family: str,
    criterion: Criterion,
    *,
    method: str,
    title: str,
    exact: bool = False,
    spec: str | UnsetType = UNSET,
    failing: list[str] | UnsetType = UNSET,
) -> Group:
    """The record's line; of an implementation under test, whose SPEC it is and which statuses fail the run."""
    return Group(
        method=method,
        spec=spec,
        title=title,
        exact=exact,
        question=criterion.question,
        precision=criterion.precision,
        family=family,
        asked=tallied.asked,
        counts=dict(sorted(tallied.counts.items())),
        mistakes=dict(sorted(tallied.mistakes.items())),
        octaves={key: dict(sorted(tallied.octaves[key].items())) for key in sorted(tallied.octaves, key=float)},
        size_bins=tallied.size_bins.as_lists(),
        place_bins=tallied.place_bins.as_lists(),
        worst=[_worst_line(case, criterion) for case in tallied.worst],
        faults=UNSET if failing is UNSET else _fault_lines(tallied),
        failing=failing,
    )


def _fault_lines(tallied: Tally) -> list[lines.Fault]:
    """The faults of the record's line: the first of each status, and the first of all up to FAULTS_KEPT."""
    first = {fault.status: fault for fault in reversed(tallied.faults)}.values()
    others = [fault for fault in tallied.faults if fault not in first]
    chosen = [*first, *others[: max(0, FAULTS_KEPT - len(first))]]
    return [
        lines.Fault(case=fault.case, row=_hex(fault.row), status=fault.status, reason=fault.reason)
        for fault in sorted(chosen, key=lambda fault: fault.place)
    ]


def _added(parts: Iterable[Mapping[str, int]]) -> Mapping[str, int]:
    total: Counter[str] = Counter()
    for part in parts:
        total.update(part)
    return dict(total)


def counts_of(status: Codes) -> dict[str, int]:
    """How many cases ended in each way."""
    other = status[status != CODES[Status.RIGHT]]  # few, as a rule
    numbers = np.bincount(other, minlength=len(STATUSES)).tolist()
    numbers[CODES[Status.RIGHT]] = len(status) - len(other)
    return {name.value: number for name, number in zip(STATUSES, numbers, strict=True) if number}


def by_exponent(exponents: NDArray[np.float64], status: Codes) -> dict[str, dict[str, int]]:
    """How many cases ended in each way, by floor(log2) of their distance to the nearest other position, ascending."""
    table = {}
    for exponent in sorted(set(exponents.tolist())):  # np.unique would load numpy.ma
        key = str(int(exponent)) if math.isfinite(exponent) else str(exponent)
        table[key] = counts_of(status[exponents == exponent])
    return table


def kept(faults: Iterable[Fault]) -> tuple[Fault, ...]:
    """The first of each status, as many as a line can show of it."""
    kept: list[Fault] = []
    seen: Counter[str] = Counter()
    for fault in sorted(faults, key=lambda fault: fault.place):
        seen[fault.status] += 1
        if seen[fault.status] <= FAULTS_KEPT:
            kept.append(fault)
    return tuple(kept)


def _worst_line(case: Worst, criterion: Criterion) -> lines.WrongAnswer:
    return lines.WrongAnswer(
        case=case.case,
        row=_hex(case.row),
        truth=case.truth,
        answer=case.answer,
        mistake=case.mistake,
        status=case.status,
        backward_error=Unsigned(case.error),
        backward_error_u=Unsigned(judge.in_units(case.error, criterion.unit)),
    )


def _hex(row: tuple[float, ...]) -> tuple[str, ...]:
    return tuple(value.hex() for value in row)
