"""The cases of a conformance run asked and scored: those of a chunk, and the invalid rows.

What is final is judged and tallied. The last cases of each chunk stay open, to be asked again before they are judged.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.casebook import vectors
from hypcheck.casebook.families import is_extreme
from hypcheck.casebook.frozen import refusals
from hypcheck.gate.chunks import Cases, Chunk, cases, octaves
from hypcheck.gate.known_failures import KnownFailure
from hypcheck.gate.results import PendingRetest, Result
from hypcheck.judge import Criterion, Status, WrongCase
from hypcheck.methods.domain import Domain, claimed
from hypcheck.methods.implementation import Crashed, Implementation
from hypcheck.pairs import REFUSED
from hypcheck.score import Indices, Score, as_slice, ended, faults, score
from hypcheck.tally import CODES, Place, Tally, counts_of

AGAIN_EACH = 32
"""Cases of each chunk that are asked again at least; of large chunks, one in a hundred."""

MOVEMENTS = 8
"""Movements of each chunk that are asked again at least, where its cases follow objects from moment to moment."""


@dataclass(frozen=True)
class Rules:
    """What is asked of an implementation, how answers are judged, which failures are known, and the run's seed."""

    criterion: Criterion
    domain: Domain
    known: tuple[KnownFailure, ...] = ()
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Invalid:
    """All of the invalid rows, of which an implementation says that it refuses them."""

    def name(self, index: int) -> str:
        """The id of a case."""
        return vectors.load_refusals().cases[index].id

    def place(self, index: int) -> Place:
        """Where it stands among them."""
        return 0, index


def ask_chunk(chunk: Chunk, implementation: Implementation | Crashed, rules: Rules) -> Result:
    """Ask the cases of a chunk that lie in the domain. Most are judged; the last ones stay open, to be asked again."""
    made = cases(chunk)
    extreme = is_extreme(chunk.family)
    indices = claimed(made.by_column, rules.domain, rules.criterion.precision, extreme=extreme)[: implementation.most]
    rows = made.rows if len(indices) == len(made.rows) else made.rows[indices]
    answered = implementation.classify(rows)
    part = as_slice(indices)
    scored = score(made.by_column[part], made.positions[part], answered, rules.criterion)
    cut = _first_open(chunk, indices)
    tail = scored.answered[cut:]
    kept = cut + np.flatnonzero(tail)
    settled = np.append(np.arange(cut), cut + np.flatnonzero(~tail))
    result = judged(made, indices[settled], scored.part(settled), rules, skipped=len(made.rows) - len(indices))
    return replace(result, open=_open(chunk, indices[kept], scored.answers[kept]), outcomes=answered.outcomes)


def ask_invalid(asked: Invalid, implementation: Implementation | Crashed) -> Result:
    """Ask the invalid rows: each must be answered 127."""
    file = vectors.load_refusals()
    answered = implementation.classify(file.rows)
    status, reasons = ended(answered), dict(answered.reasons)
    for index in np.flatnonzero(answered.answered).tolist():
        answer = int(answered.answers[index])
        status[index] = CODES[Status.REFUSED if answer == REFUSED else Status.WRONG]
        if answer != REFUSED:
            columns = " and ".join(file.cases[index].columns)
            reasons[index] = f"answered {answer}; a row with an invalid {columns} must be refused: {REFUSED}"
    found = faults(file.rows, status, reasons, asked, np.arange(len(status)))
    tally = Tally(asked=len(status), counts=counts_of(status), faults=found)
    return Result(tallies={refusals.NAME: tally}, outcomes=answered.outcomes)


def judged(made: Cases, indices: Indices, scored: Score, rules: Rules, *, skipped: int = 0) -> Result:
    """The result of cases of a chunk, `indices` (n,), whose answers are final: known failures are excused."""
    excusing: set[int] = set()
    wrong = []
    for case in scored.judged():
        found, used = _excused(case, made.chunk.name(int(indices[case.index])), made.chunk.family, rules)
        wrong.append(found)
        excusing.update(used)
    tally = scored.tally(made.chunk, indices, octaves(made, indices), skipped=skipped, wrong=wrong)
    return Result(
        tallies={made.chunk.family: tally},
        excusing=frozenset(excusing),
        named=frozenset(_named(made.chunk, indices, rules.known)),
    )


def _first_open(chunk: Chunk, indices: Indices) -> int:
    """From where on the asked cases stay open: a vector loop's tail is among the last, and so are whole movements."""
    wanted = max(AGAIN_EACH, len(indices) // 100 + 1)
    if chunk.movement > 1:
        wanted = max(wanted, MOVEMENTS * chunk.movement)
    cut = max(0, len(indices) - wanted)
    if chunk.movement > 1 and cut:
        first = chunk.start + int(indices[cut])
        cut = int(np.searchsorted(indices, first - first % chunk.movement - chunk.start))
    return cut


def _open(chunk: Chunk, indices: Indices, answers: NDArray[np.int8]) -> tuple[PendingRetest, ...]:
    if not len(indices):
        return ()
    first, last = int(indices[0]), int(indices[-1]) + 1
    return (PendingRetest(chunk.between(first, last), indices - first, answers),)


def _excused(case: WrongCase, name: str, family: str, rules: Rules) -> tuple[WrongCase, list[int]]:
    """The case as known failures leave it, and the numbers of all that cover it."""
    if case.status is not Status.WRONG or not rules.known:
        return case, []
    error_u = judge.in_units(judge.measured(case, rules.criterion.question), rules.criterion.unit)
    covering = [number for number, entry in enumerate(rules.known) if entry.covers(name, family, error_u)]
    return (replace(case, status=Status.EXCUSED) if covering else case), covering


def _named(chunk: Chunk, indices: Indices, known: Sequence[KnownFailure]) -> Iterator[str]:
    """Those of the cases that known failures name."""
    for entry in known:
        if entry.case is not None:
            index = chunk.find(entry.case)
            if index is not None and index in indices:
                yield entry.case
