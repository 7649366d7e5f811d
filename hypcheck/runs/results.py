"""The result of a chunk or of the invalid rows: an implementation answers, and the answers are judged and tallied.

The last cases of each chunk stay pending: they are tested again before they are judged. A result is a value that can be
sent, stored, and merged with other results in any order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import Floats, Indices, Rows, scenes_of
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.implementation import Crashed, Implementation
from hypcheck.implementations.session import Outcome
from hypcheck.record.lines import Retest
from hypcheck.record.progress import Place, Tally
from hypcheck.runs import judge, tally
from hypcheck.runs.cases import CaseChunk, ChunkCases, cases_of_chunk, flip_exponents_of
from hypcheck.runs.causes import AnsweredRows
from hypcheck.runs.diagnosis import with_diagnosis
from hypcheck.runs.judge import Criterion, Status, WrongCase
from hypcheck.runs.known_failures import KnownFailure, entries_about
from hypcheck.runs.score import Score, as_slice, rows_asked, score, status_of, unanswered_cases
from hypcheck.runs.tally import STATUS_CODES, counts_of
from hypcheck.vectors import frozen
from hypcheck.vectors.format import CaseFile


@dataclass(frozen=True, slots=True)
class PendingRetest:
    """Cases that were answered and will be tested again before they are judged.

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
    """The result of some cases: a tally for each family, and `pending` cases that are not in a tally yet.

    `retest` counts cases that were tested again. `outcomes` are the outcomes of questions. `excusing` are the numbers
    of the known failures that excused a case, `named` the tested cases that known failures name.
    """

    tallies: Mapping[str, Tally] = field(default_factory=dict)
    pending: tuple[PendingRetest, ...] = ()
    retest: Retest = NO_RETEST
    outcomes: frozenset[Outcome] = frozenset()
    excusing: frozenset[int] = frozenset()
    named: frozenset[str] = frozenset()

    @property
    def cases(self) -> int:
        """The number of all its cases: tested, skipped and pending."""
        counted = sum(sum(tally.counts.values()) for tally in self.tallies.values())
        return counted + sum(len(pending.indices) for pending in self.pending)

    @property
    def broke_protocol_throughout(self) -> bool:
        """Whether every tested row ended with status PROTOCOL."""
        return self.outcomes - {Outcome.NOT_RUN} == {Outcome.PROTOCOL}


def merged_result(results: Iterable[CasesResult]) -> CasesResult:
    """Merge results into one. Their order has an effect only on the order of the pending cases."""
    parts = tuple(results)
    tallies: dict[str, list[Tally]] = {}
    for part in parts:
        for family, tallied in part.tallies.items():
            tallies.setdefault(family, []).append(tallied)
    return CasesResult(
        tallies={family: tally.merged_tally(some) if len(some) > 1 else some[0] for family, some in tallies.items()},
        pending=tuple(pending for part in parts for pending in part.pending),
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
"""The least number of cases of each chunk that are tested again; of large chunks it is one in a hundred."""

RETESTED_OF_SCENE = 2048
"""The least number of retested cases of a family's first chunk that has one scene, if a function for scenes exists."""

RETESTED_MOVEMENTS = 8
"""The least number of movements of each chunk that are tested again if its cases follow moving objects."""


@dataclass(frozen=True)
class JudgingRules:
    """The rules for judging an implementation: the criterion, its domain, the known failures, the seeds of the run.

    `fresh` is the seed of the fresh rows, if there are any. `named` are the families that the plan names in full: their
    rows with subnormal numbers are tested too.
    """

    criterion: Criterion
    domain: Domain
    known: tuple[KnownFailure, ...] = ()
    seed: int = 1
    fresh: int | None = None
    named: frozenset[str] = frozenset()

    def asked_of(self, family: str, rows: Rows) -> tuple[Indices, dict[str, int]]:
        """Return the ascending indices of the rows to test, and how many of the others are left out for each reason."""
        return rows_asked(rows, family, self.criterion, self.domain, subnormal=family in self.named)

    def are_fresh(self, chunk: CaseChunk) -> bool:
        """Return whether the cases of a chunk are rows that were not known before the run."""
        return chunk.seed is not None and chunk.seed == self.fresh


@dataclass(frozen=True, slots=True)
class InvalidRows:
    """All invalid rows of one file, for implementations that declare that they refuse invalid rows."""

    family: str = "invalid"

    def __len__(self) -> int:
        return len(self.file.cases)

    @property
    def file(self) -> CaseFile:
        """The rows."""
        return frozen.load(self.family)

    def name(self, index: int) -> str:
        """Return the id of a case."""
        return self.file.ids[index]

    def place(self, index: int) -> Place:
        """Return the place of a case among the invalid rows."""
        return 0, index


def ask_chunk(chunk: CaseChunk, implementation: Implementation | Crashed, rules: JudgingRules) -> CasesResult:
    """Test the cases of a chunk that lie in the domain. Most are judged; the last ones stay pending."""
    cases = cases_of_chunk(chunk)
    inside, left_out = rules.asked_of(chunk.family, cases.by_column)
    indices = inside[: implementation.max_rows]
    left_out |= {"slow": len(inside) - len(indices)} if len(indices) < len(inside) else {}
    rows = cases.rows if len(indices) == len(cases.rows) else cases.rows[indices]
    answered = implementation.classify(rows)
    part = as_slice(indices)
    scored = score(cases.by_column[part], cases.positions[part], answered, rules.criterion)
    of_scene = implementation.scene and chunk.start == 0 and len(scenes_of(rows)) == 1
    cut = _first_pending(chunk, indices, RETESTED_OF_SCENE if of_scene else RETESTED_CASES)
    tail = scored.answered[cut:]
    kept = cut + np.flatnonzero(tail)
    settled = np.append(np.arange(cut), cut + np.flatnonzero(~tail))
    result = result_of_final(cases, indices[settled], scored.part(settled), rules, left_out=left_out)
    return replace(result, pending=_pending(chunk, indices[kept], scored.part(kept)), outcomes=answered.outcomes)


def ask_invalid_rows(
    invalid: InvalidRows, implementation: Implementation | Crashed, rules: JudgingRules
) -> CasesResult:
    """Test the invalid rows: the answer to each must be 127."""
    file = invalid.file
    answered = implementation.classify(file.rows)
    status, reasons = status_of(answered), dict(answered.reasons)
    for index in np.flatnonzero(answered.answered).tolist():
        answer = int(answered.answers[index])
        status[index] = STATUS_CODES[Status.REFUSED if answer == REFUSED else Status.WRONG]
        if answer != REFUSED:
            columns = " and ".join(file.cases[index].columns)
            reasons[index] = f"answered {answer}; a row with an invalid {columns} must be refused: {REFUSED}"
    layout = rules.criterion.layout
    faults = unanswered_cases(file.rows, status, reasons, invalid, np.arange(len(status)), layout)
    tallied = structs.replace(tally.EMPTY, asked=len(status), counts=counts_of(status), faults=faults)
    return CasesResult(tallies={invalid.family: tallied}, outcomes=answered.outcomes)


def result_of_final(
    made: ChunkCases,
    indices: Indices,
    scored: Score,
    rules: JudgingRules,
    *,
    left_out: Mapping[str, int] = MappingProxyType({}),
) -> CasesResult:
    """Judge and tally the cases `indices` (n,) of a chunk, whose answers are final; excuse known failures.

    `left_out` counts the rows of the chunk that were not tested, by reason.
    """
    answered = AnsweredRows(scored.rows, scored.truth, scored.answers, scored.criterion, scored.times)
    wrong, excusing = _excused(list(scored.judged()), made.chunk, indices, answered, rules)
    tallied = scored.tally(made.chunk, indices, flip_exponents_of(made, indices), left_out=left_out, wrong=wrong)
    if wrong:
        right = np.flatnonzero(scored.status == STATUS_CODES[Status.RIGHT]).tolist()
        cases = [int(indices[case.index]) for case in wrong]
        named = [(made.chunk.place(case), made.chunk.name(case)) for case in cases]
        tallied = with_diagnosis(tallied, answered, wrong, right, named)
    fresh = len(indices) if rules.are_fresh(made.chunk) else 0
    return CasesResult(
        tallies={made.chunk.family: structs.replace(tallied, fresh=fresh)},
        excusing=frozenset(excusing),
        named=frozenset(_named_cases(made.chunk, indices, rules.known)),
    )


def _first_pending(chunk: CaseChunk, indices: Indices, least: int) -> int:
    """Return the place, in `indices`, of the first tested case that stays pending: all from there on do.

    They have the tail of a vector loop, and whole movements.
    """
    wanted = max(least, len(indices) // 100 + 1)
    if chunk.movement > 1:
        wanted = max(wanted, RETESTED_MOVEMENTS * chunk.movement)
    cut = max(0, len(indices) - wanted)
    if chunk.movement > 1 and cut:
        first = chunk.start + int(indices[cut])
        cut = int(np.searchsorted(indices, first - first % chunk.movement - chunk.start))
    return cut


def _pending(chunk: CaseChunk, indices: Indices, scored: Score) -> tuple[PendingRetest, ...]:
    """Return these cases as pending, with their first answers; an empty tuple if there are none."""
    if not len(indices):
        return ()
    first, last = int(indices[0]), int(indices[-1]) + 1
    return (PendingRetest(chunk.between(first, last), indices - first, scored.answers, scored.times),)


def _excused(
    wrong: list[WrongCase], chunk: CaseChunk, indices: Indices, answered: AnsweredRows, rules: JudgingRules
) -> tuple[list[WrongCase], set[int]]:
    """Return the wrong cases, EXCUSED where a known failure covers them; and the numbers of these known failures."""
    places = [place for place, case in enumerate(wrong) if case.status is Status.WRONG and rules.known]
    cases = [(wrong[place].index, chunk.name(int(indices[wrong[place].index]))) for place in places]
    judged, excusing = list(wrong), set[int]()
    about = entries_about(rules.known, cases, chunk.family, answered, fresh=rules.are_fresh(chunk))
    for place, numbers in zip(places, about, strict=True):
        case, error_u = wrong[place], 0.0
        if any(rules.known[number].max_u < math.inf for number in numbers):  # the error takes a thousand times as long
            measured = judge.measured(case, rules.criterion.question)
            error_u = judge.in_units(measured, rules.criterion.unit)
        covering = [number for number in numbers if error_u <= rules.known[number].max_u]
        if covering:
            judged[place] = replace(case, status=Status.EXCUSED)
            excusing.update(covering)
    return judged, excusing


def _named_cases(chunk: CaseChunk, indices: Indices, known: Sequence[KnownFailure]) -> Iterator[str]:
    """Yield the ids of those of these cases that known failures name."""
    for entry in known:
        if entry.case is not None:
            index = chunk.find(entry.case)
            if index is not None and index in indices:
                yield entry.case
