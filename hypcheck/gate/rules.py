"""How answers are judged in a gating run, and what comes of the cases whose answers are final."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hypcheck import groups, judge
from hypcheck.casebook.families import is_extreme
from hypcheck.gate.chunks import Cases, octaves
from hypcheck.gate.known_failures import KnownFailure
from hypcheck.gate.results import Result
from hypcheck.groups import CODES, Codes, Ended, Fault
from hypcheck.judge import Criterion, Status, WrongCase
from hypcheck.methods.domain import Domain, representable
from hypcheck.rows import Rows

Indices = NDArray[np.intp]

_WHICH = np.array([(*sizes, center, center, center) for *sizes, center in product((0, 1), repeat=5)])
"""Least or greatest, of four sizes and of the centre."""


@dataclass(frozen=True)
class Rules:
    """What is asked of an implementation, how answers are judged, which failures are known, and the run's seed."""

    criterion: Criterion
    domain: Domain
    known: tuple[KnownFailure, ...] = ()
    seed: int = 1


@dataclass(frozen=True)
class Final:
    """Cases of a chunk whose answers are final.

    `indices` (n,) are those that were asked, ascending, with the answer of each (CANNOT_SAY where none counts) and its
    status in CODES, which is RIGHT where the answer is still to be judged.
    """

    made: Cases
    indices: Indices
    answers: NDArray[np.int8]
    status: Codes
    faults: tuple[Fault, ...] = ()
    skipped: int = 0


def claimed(made: Cases, rules: Rules) -> Indices:
    """The indices of the cases that lie in the domain and can be written in the declared precision."""
    rows, extreme = made.by_column, is_extreme(made.chunk.family)
    corners, precision = _corners(made.columns), rules.criterion.precision
    alike = not rules.domain.settings and rules.domain.holds(corners, extreme=extreme).all()
    if alike and representable(corners, precision).all():
        return np.arange(len(rows))
    return np.flatnonzero(rules.domain.holds(rows, extreme=extreme) & representable(rows, precision))


def _corners(columns: NDArray[np.float64]) -> Rows:
    """Rows (32, 7) of the extremes of |columns|: all combinations of sizes, with the least and the greatest centre.

    Each condition of a domain, its settings apart, is monotone in each length, and so is what a precision can write,
    a zero apart, which it always can: what holds of these rows holds of all.
    """
    lengths = np.abs(columns)
    least, greatest = lengths.min(axis=1, initial=np.inf), lengths.max(axis=1, initial=0.0)
    for index in np.flatnonzero(least == 0):
        least[index] = lengths[index][lengths[index] > 0].min(initial=greatest[index])
    return np.asarray(np.stack([least, greatest])[_WHICH, np.arange(7)])


def final(cases: Final, rules: Rules) -> Result:
    """Judge them, and tally them."""
    made, indices = cases.made, cases.indices
    part = _as_slice(indices)  # no copy of most cases
    rows, truth = made.by_column[part], made.positions[part]
    excusing: set[int] = set()
    status, wrong = cases.status.copy(), []
    for case in judge.wrong_cases(rows, truth, cases.answers, rules.criterion):
        name = made.chunk.name(int(indices[case.index]))
        judged, used = _excused(case, name, made.chunk.family, rules)
        status[case.index] = CODES[judged.status]
        wrong.append(judged)
        excusing.update(used)
    ended = Ended(
        rows=rows,
        status=status,
        wrong=wrong,
        octaves=octaves(made, indices),
        name=lambda index: made.chunk.name(int(indices[index])),
        place=lambda index: made.chunk.place(int(indices[index])),
        skipped=cases.skipped,
        faults=cases.faults,
    )
    return Result(
        tallies={made.chunk.family: groups.tally(ended, rules.criterion)},
        excusing=frozenset(excusing),
        named=frozenset(_named(cases, rules.known)),
    )


def _as_slice(indices: Indices) -> slice | Indices:
    """The indices as a slice, where none is left out between the first and the last."""
    if not len(indices) or indices[-1] - indices[0] != len(indices) - 1:
        return indices
    return slice(int(indices[0]), int(indices[-1]) + 1)


def _excused(case: WrongCase, name: str, family: str, rules: Rules) -> tuple[WrongCase, list[int]]:
    """The case as known failures leave it, and the numbers of all that cover it."""
    if case.status is not Status.WRONG or not rules.known:
        return case, []
    error_u = judge.in_units(judge.measured(case, rules.criterion.question), rules.criterion.unit)
    covering = [number for number, entry in enumerate(rules.known) if entry.covers(name, family, error_u)]
    return (replace(case, status=Status.EXCUSED) if covering else case), covering


def _named(cases: Final, known: Sequence[KnownFailure]) -> Iterator[str]:
    """Those of the cases that known failures name."""
    for entry in known:
        if entry.case is not None:
            index = cases.made.chunk.find(entry.case)
            if index is not None and index in cases.indices:
                yield entry.case
