"""The result of a chunk or of the invalid rows: an implementation is asked, its answers are judged and tallied.

What came of a part of a run: a value that can be sent, kept and added to others in any order.

The cases of a conformance run asked and scored: those of a chunk, and the invalid rows.

What is final is judged and tallied. The last cases of each chunk stay open, to be asked again before they are judged.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import Indices
from hypcheck.implementations.description import Domain, claimed
from hypcheck.implementations.implementation import Crashed, Implementation
from hypcheck.implementations.session import Outcome
from hypcheck.record.lines import Retest
from hypcheck.runs import judge, tally
from hypcheck.runs.cases import CaseChunk, ChunkCases, cases_of_chunk, flip_exponents_of
from hypcheck.runs.judge import Criterion, Status, WrongCase
from hypcheck.runs.known_failures import KnownFailure
from hypcheck.runs.score import Score, as_slice, score, status_of, unanswered_cases
from hypcheck.runs.tally import STATUS_CODES, CasePlace, Tally, counts_of
from hypcheck.vectors import frozen
from hypcheck.vectors.families import is_extreme


@dataclass(frozen=True, slots=True)
class PendingRetest:
    """Cases that were answered and are to be asked again before they are judged.

    `indices` (n,) are theirs in the chunk, ascending, and `answers`, int8 (n,), what was answered at first.
    """

    chunk: CaseChunk
    indices: NDArray[np.intp]
    answers: NDArray[np.int8]


NO_RETEST = Retest(asked=0, within=0, beyond=0)


@dataclass(frozen=True)
class CasesResult:
    """What came of some cases: a tally for each family, and `open` cases that no tally counts yet.

    `outcomes` are all ways in which questions ended; `excusing` the numbers of the known failures that excused
    something, `named` the cases that known failures name and that were asked.
    """

    tallies: Mapping[str, Tally] = field(default_factory=dict)
    open: tuple[PendingRetest, ...] = ()
    again: Retest = NO_RETEST
    outcomes: frozenset[Outcome] = frozenset()
    excusing: frozenset[int] = frozenset()
    named: frozenset[str] = frozenset()

    @property
    def cases(self) -> int:
        """How many it speaks of: asked, skipped and open."""
        counted = sum(sum(tally.counts.values()) for tally in self.tallies.values())
        return counted + sum(len(each.indices) for each in self.open)

    @property
    def broke_protocol_throughout(self) -> bool:
        """Whether no row was ever answered, and every one that was asked ended as PROTOCOL."""
        return self.outcomes - {Outcome.NOT_RUN} == {Outcome.PROTOCOL}


def merged_result(results: Iterable[CasesResult]) -> CasesResult:
    """The result of all cases of these results; in whatever order they come, but for the order of the open ones."""
    parts = tuple(results)
    tallies: dict[str, list[Tally]] = {}
    for part in parts:
        for family, each in part.tallies.items():
            tallies.setdefault(family, []).append(each)
    return CasesResult(
        tallies={family: tally.merged_tally(some) if len(some) > 1 else some[0] for family, some in tallies.items()},
        open=tuple(each for part in parts for each in part.open),
        again=_added(part.again for part in parts),
        outcomes=frozenset().union(*(part.outcomes for part in parts)),
        excusing=frozenset().union(*(part.excusing for part in parts)),
        named=frozenset().union(*(part.named for part in parts)),
    )


def _added(retests: Iterable[Retest]) -> Retest:
    counts = ((each.asked, each.within, each.beyond) for each in retests)
    asked, within, beyond = map(sum, zip((0, 0, 0), *counts, strict=True))
    return Retest(asked=asked, within=within, beyond=beyond)


RETESTED_CASES = 32
"""Cases of each chunk that are asked again at least; of large chunks, one in a hundred."""

RETESTED_MOVEMENTS = 8
"""Movements of each chunk that are asked again at least, where its cases follow objects from moment to moment."""


@dataclass(frozen=True)
class JudgingRules:
    """What is asked of an implementation, how answers are judged, which failures are known, and the run's seed."""

    criterion: Criterion
    domain: Domain
    known: tuple[KnownFailure, ...] = ()
    seed: int = 1


@dataclass(frozen=True, slots=True)
class InvalidRows:
    """All of the invalid rows, of which an implementation says that it refuses them."""

    def name(self, index: int) -> str:
        """The id of a case."""
        return frozen.load_invalid_rows().cases[index].id

    def place(self, index: int) -> CasePlace:
        """Where it stands among them."""
        return 0, index


def ask_chunk(chunk: CaseChunk, implementation: Implementation | Crashed, rules: JudgingRules) -> CasesResult:
    """Ask the cases of a chunk that lie in the domain. Most are judged; the last ones stay open, to be asked again."""
    made = cases_of_chunk(chunk)
    extreme = is_extreme(chunk.family)
    indices = claimed(made.by_column, rules.domain, rules.criterion.precision, extreme=extreme)[: implementation.most]
    rows = made.rows if len(indices) == len(made.rows) else made.rows[indices]
    answered = implementation.classify(rows)
    part = as_slice(indices)
    scored = score(made.by_column[part], made.positions[part], answered, rules.criterion)
    cut = _first_pending(chunk, indices)
    tail = scored.answered[cut:]
    kept = cut + np.flatnonzero(tail)
    settled = np.append(np.arange(cut), cut + np.flatnonzero(~tail))
    result = result_of_final(made, indices[settled], scored.part(settled), rules, skipped=len(made.rows) - len(indices))
    return replace(result, open=_pending(chunk, indices[kept], scored.answers[kept]), outcomes=answered.outcomes)


def ask_invalid_rows(asked: InvalidRows, implementation: Implementation | Crashed) -> CasesResult:
    """Ask the invalid rows: each must be answered 127."""
    file = frozen.load_invalid_rows()
    answered = implementation.classify(file.rows)
    status, reasons = status_of(answered), dict(answered.reasons)
    for index in np.flatnonzero(answered.answered).tolist():
        answer = int(answered.answers[index])
        status[index] = STATUS_CODES[Status.REFUSED if answer == REFUSED else Status.WRONG]
        if answer != REFUSED:
            columns = " and ".join(file.cases[index].columns)
            reasons[index] = f"answered {answer}; a row with an invalid {columns} must be refused: {REFUSED}"
    found = unanswered_cases(file.rows, status, reasons, asked, np.arange(len(status)))
    tally = Tally(asked=len(status), counts=counts_of(status), faults=found)
    return CasesResult(tallies={frozen.INVALID_NAME: tally}, outcomes=answered.outcomes)


def result_of_final(
    made: ChunkCases, indices: Indices, scored: Score, rules: JudgingRules, *, skipped: int = 0
) -> CasesResult:
    """The result of cases of a chunk, `indices` (n,), whose answers are final: known failures are excused."""
    excusing: set[int] = set()
    wrong = []
    for case in scored.judged():
        found, used = _excused(case, made.chunk.name(int(indices[case.index])), made.chunk.family, rules)
        wrong.append(found)
        excusing.update(used)
    tally = scored.tally(made.chunk, indices, flip_exponents_of(made, indices), skipped=skipped, wrong=wrong)
    return CasesResult(
        tallies={made.chunk.family: tally},
        excusing=frozenset(excusing),
        named=frozenset(_named_cases(made.chunk, indices, rules.known)),
    )


def _first_pending(chunk: CaseChunk, indices: Indices) -> int:
    """From where on the asked cases stay open: a vector loop's tail is among the last, and so are whole movements."""
    wanted = max(RETESTED_CASES, len(indices) // 100 + 1)
    if chunk.movement > 1:
        wanted = max(wanted, RETESTED_MOVEMENTS * chunk.movement)
    cut = max(0, len(indices) - wanted)
    if chunk.movement > 1 and cut:
        first = chunk.start + int(indices[cut])
        cut = int(np.searchsorted(indices, first - first % chunk.movement - chunk.start))
    return cut


def _pending(chunk: CaseChunk, indices: Indices, answers: NDArray[np.int8]) -> tuple[PendingRetest, ...]:
    if not len(indices):
        return ()
    first, last = int(indices[0]), int(indices[-1]) + 1
    return (PendingRetest(chunk.between(first, last), indices - first, answers),)


def _excused(case: WrongCase, name: str, family: str, rules: JudgingRules) -> tuple[WrongCase, list[int]]:
    """The case as known failures leave it, and the numbers of all that cover it."""
    if case.status is not Status.WRONG or not rules.known:
        return case, []
    error_u = judge.in_units(judge.measured(case, rules.criterion.question), rules.criterion.unit)
    covering = [number for number, entry in enumerate(rules.known) if entry.covers(name, family, error_u)]
    return (replace(case, status=Status.EXCUSED) if covering else case), covering


def _named_cases(chunk: CaseChunk, indices: Indices, known: Sequence[KnownFailure]) -> Iterator[str]:
    """Those of the cases that known failures name."""
    for entry in known:
        if entry.case is not None:
            index = chunk.find(entry.case)
            if index is not None and index in indices:
                yield entry.case
