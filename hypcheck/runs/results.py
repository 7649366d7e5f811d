"""The result of a chunk or of the invalid rows: an implementation is asked, its answers are judged and tallied.

The last cases of each chunk stay pending: they are asked again before they are judged. A result is a value that can be
sent, stored, and merged with others in any order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import Floats, Indices
from hypcheck.implementations.description import Domain, claimed
from hypcheck.implementations.implementation import Crashed, Implementation
from hypcheck.implementations.session import Outcome
from hypcheck.record.lines import Retest
from hypcheck.runs import judge, tally
from hypcheck.runs.cases import CaseChunk, ChunkCases, cases_of_chunk, flip_exponents_of
from hypcheck.runs.causes import Asked
from hypcheck.runs.diagnosis import CasePlace, Diagnosis, diagnose
from hypcheck.runs.judge import Criterion, Status, WrongCase
from hypcheck.runs.judges import judge_of
from hypcheck.runs.known_failures import KnownFailure
from hypcheck.runs.score import Score, as_slice, score, status_of, unanswered_cases
from hypcheck.runs.tally import STATUS_CODES, Tally, counts_of
from hypcheck.vectors import frozen
from hypcheck.vectors.families import is_extreme
from hypcheck.vectors.format import CaseFile
from hypcheck.vectors.invalid_rows import InvalidRow


@dataclass(frozen=True, slots=True)
class PendingRetest:
    """Cases that were answered and will be asked again before they are judged.

    `indices` (n,) are their places in the chunk, ascending; `answers`, int8 (n,), are the first answers, and `times`
    (n,) those of hits, if the implementation gives any.
    """

    chunk: CaseChunk
    indices: NDArray[np.intp]
    answers: NDArray[np.int8]
    times: Floats | None = None


NO_RETEST = Retest(asked=0, within=0, beyond=0)


@dataclass(frozen=True)
class CasesResult:
    """The result of some cases: a tally for each family, and `pending` cases that no tally counts yet.

    `retest` counts cases that were asked again. `outcomes` are all ways in which questions ended. `excusing` are the
    numbers of the known failures that excused a case, `named` the cases that known failures name and that were asked.
    """

    tallies: Mapping[str, Tally] = field(default_factory=dict)
    pending: tuple[PendingRetest, ...] = ()
    retest: Retest = NO_RETEST
    outcomes: frozenset[Outcome] = frozenset()
    excusing: frozenset[int] = frozenset()
    named: frozenset[str] = frozenset()

    @property
    def cases(self) -> int:
        """The number of all its cases: asked, skipped and pending."""
        counted = sum(sum(tally.counts.values()) for tally in self.tallies.values())
        return counted + sum(len(each.indices) for each in self.pending)

    @property
    def broke_protocol_throughout(self) -> bool:
        """Whether every row that was asked ended as PROTOCOL."""
        return self.outcomes - {Outcome.NOT_RUN} == {Outcome.PROTOCOL}


def merged_result(results: Iterable[CasesResult]) -> CasesResult:
    """The result of all cases of these results. Their order matters only for the order of the pending cases."""
    parts = tuple(results)
    tallies: dict[str, list[Tally]] = {}
    for part in parts:
        for family, each in part.tallies.items():
            tallies.setdefault(family, []).append(each)
    return CasesResult(
        tallies={family: tally.merged_tally(some) if len(some) > 1 else some[0] for family, some in tallies.items()},
        pending=tuple(each for part in parts for each in part.pending),
        retest=Retest(
            asked=sum(part.retest.asked for part in parts),
            within=sum(part.retest.within for part in parts),
            beyond=sum(part.retest.beyond for part in parts),
        ),
        outcomes=frozenset().union(*(part.outcomes for part in parts)),
        excusing=frozenset().union(*(part.excusing for part in parts)),
        named=frozenset().union(*(part.named for part in parts)),
    )


RETESTED_CASES = 32
"""At least so many cases of each chunk are asked again; of large chunks, one in a hundred."""

RETESTED_MOVEMENTS = 8
"""At least so many movements of each chunk are asked again if its cases follow objects from moment to moment."""


@dataclass(frozen=True)
class JudgingRules:
    """How an implementation is judged: the criterion, its domain, the known failures, and the seed of the run."""

    criterion: Criterion
    domain: Domain
    known: tuple[KnownFailure, ...] = ()
    seed: int = 1


@dataclass(frozen=True, slots=True)
class InvalidRows:
    """All invalid rows of one file, which go to an implementation that declares that it refuses such rows."""

    family: str = "invalid"

    def __len__(self) -> int:
        return len(self.file.cases)

    @property
    def file(self) -> CaseFile[InvalidRow]:
        """The rows."""
        return frozen.load(self.family)

    def name(self, index: int) -> str:
        """The id of a case."""
        return self.file.cases[index].id

    def place(self, index: int) -> CasePlace:
        """The place of a case among the invalid rows."""
        return 0, index


def ask_chunk(chunk: CaseChunk, implementation: Implementation | Crashed, rules: JudgingRules) -> CasesResult:
    """Ask the cases of a chunk that lie in the domain. Most are judged; the last ones stay pending."""
    made = cases_of_chunk(chunk)
    inside = claimed(
        made.by_column,
        rules.domain,
        rules.criterion.precision,
        extreme=is_extreme(chunk.family),
        layout=rules.criterion.layout,
    )
    indices = inside[: implementation.max_rows]
    rows = made.rows if len(indices) == len(made.rows) else made.rows[indices]
    answered = implementation.classify(rows)
    part = as_slice(indices)
    scored = score(made.by_column[part], made.positions[part], answered, rules.criterion)
    cut = _first_pending(chunk, indices)
    tail = scored.answered[cut:]
    kept = cut + np.flatnonzero(tail)
    settled = np.append(np.arange(cut), cut + np.flatnonzero(~tail))
    result = result_of_final(made, indices[settled], scored.part(settled), rules, skipped=len(made.rows) - len(indices))
    return replace(result, pending=_pending(chunk, indices[kept], scored.part(kept)), outcomes=answered.outcomes)


def ask_invalid_rows(asked: InvalidRows, implementation: Implementation | Crashed) -> CasesResult:
    """Ask the invalid rows: each must be answered 127."""
    file = asked.file
    answered = implementation.classify(file.rows)
    status, reasons = status_of(answered), dict(answered.reasons)
    for index in np.flatnonzero(answered.answered).tolist():
        answer = int(answered.answers[index])
        status[index] = STATUS_CODES[Status.REFUSED if answer == REFUSED else Status.WRONG]
        if answer != REFUSED:
            columns = " and ".join(file.cases[index].columns)
            reasons[index] = f"answered {answer}; a row with an invalid {columns} must be refused: {REFUSED}"
    found = unanswered_cases(file.rows, status, reasons, asked, np.arange(len(status)))
    tally = Tally(asked=len(status), counts=counts_of(status), unanswered=found)
    return CasesResult(tallies={asked.family: tally}, outcomes=answered.outcomes)


def result_of_final(
    made: ChunkCases, indices: Indices, scored: Score, rules: JudgingRules, *, skipped: int = 0
) -> CasesResult:
    """The result of the cases `indices` (n,) of a chunk, whose answers are final. Known failures are excused."""
    excusing: set[int] = set()
    wrong = []
    for case in scored.judged():
        found, used = _excused(case, made.chunk.name(int(indices[case.index])), made.chunk.family, rules)
        wrong.append(found)
        excusing.update(used)
    tally = scored.tally(made.chunk, indices, flip_exponents_of(made, indices), skipped=skipped, wrong=wrong)
    return CasesResult(
        tallies={made.chunk.family: replace(tally, diagnosis=_diagnosed(made.chunk, indices, scored, wrong))},
        excusing=frozenset(excusing),
        named=frozenset(_named_cases(made.chunk, indices, rules.known)),
    )


def _diagnosed(chunk: CaseChunk, indices: Indices, scored: Score, wrong: Sequence[WrongCase]) -> Diagnosis:
    """Which causes explain the wrong answers to the cases `indices` (n,) of a chunk."""
    if not wrong:
        return Diagnosis()
    asked = Asked(scored.rows, scored.truth, scored.answers, scored.criterion, scored.times)
    right = np.flatnonzero(scored.status == STATUS_CODES[Status.RIGHT]).tolist()
    cases = [int(indices[case.index]) for case in wrong]
    return diagnose(asked, wrong, right, [(chunk.place(case), chunk.name(case)) for case in cases])


def _first_pending(chunk: CaseChunk, indices: Indices) -> int:
    """The first asked case that stays pending. The last cases hold the tail of a vector loop, and whole movements."""
    wanted = max(RETESTED_CASES, len(indices) // 100 + 1)
    if chunk.movement > 1:
        wanted = max(wanted, RETESTED_MOVEMENTS * chunk.movement)
    cut = max(0, len(indices) - wanted)
    if chunk.movement > 1 and cut:
        first = chunk.start + int(indices[cut])
        cut = int(np.searchsorted(indices, first - first % chunk.movement - chunk.start))
    return cut


def _pending(chunk: CaseChunk, indices: Indices, scored: Score) -> tuple[PendingRetest, ...]:
    if not len(indices):
        return ()
    first, last = int(indices[0]), int(indices[-1]) + 1
    return (PendingRetest(chunk.between(first, last), indices - first, scored.answers, scored.times),)


def _excused(case: WrongCase, name: str, family: str, rules: JudgingRules) -> tuple[WrongCase, list[int]]:
    """The case, EXCUSED if known failures cover it, and the numbers of these."""
    if case.status is not Status.WRONG or not rules.known:
        return case, []
    naming = [(number, entry) for number, entry in enumerate(rules.known) if entry.names(name, family)]
    error_u = 0.0
    if any(entry.max_u < math.inf for _, entry in naming):  # to measure takes a thousand times as long as to judge
        measured = judge_of(rules.criterion.question).measured(case, rules.criterion)
        error_u = judge.in_units(measured, rules.criterion.unit)
    covering = [number for number, entry in naming if error_u <= entry.max_u]
    return (replace(case, status=Status.EXCUSED) if covering else case), covering


def _named_cases(chunk: CaseChunk, indices: Indices, known: Sequence[KnownFailure]) -> Iterator[str]:
    """The ids of these cases that known failures name."""
    for entry in known:
        if entry.case is not None:
            index = chunk.find(entry.case)
            if index is not None and index in indices:
                yield entry.case
