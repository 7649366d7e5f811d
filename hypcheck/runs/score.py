"""The score of tested rows: the status of each row, and the size of each wrong answer.

Conformance runs, the self-check, hunts, replays and bench use the same score. They choose different rows and keep
different parts of the score: conformance and the self-check keep a tally of all cases, a hunt the worst answers, bench
the distances.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import CANNOT_SAY, Floats, Indices, Layout, Positions, Rows
from hypcheck.implementations import domain
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.session import Answered, Outcome
from hypcheck.record.fields import row_fields
from hypcheck.record.progress import Place, Tally, UnansweredCase, WorstCase
from hypcheck.runs import judge, tally
from hypcheck.runs.judge import DANGEROUS, Criterion, Mistake, Status, WrongCase
from hypcheck.runs.tally import (
    STATUS_CODES,
    STATUSES,
    UNANSWERED_KEPT,
    WORST_KEPT,
    StatusCodes,
    answer_counts,
    by_octave,
    counts_of,
    kept_unanswered,
    rank_of,
    worst_case,
)
from hypcheck.vectors.families import is_extreme

_ENDED = np.array(
    [STATUS_CODES[Status.RIGHT if outcome is Outcome.ANSWERED else Status(outcome.label)] for outcome in Outcome],
    dtype=np.int8,
)


class CaseSource(Protocol):
    """The origin of rows: some cases of a family."""

    def name(self, index: int) -> str:
        """Return the id of a case."""
        ...

    def place(self, index: int) -> Place:
        """Return the place of a case in the family."""
        ...


def rows_asked(
    rows: Rows, family: str, criterion: Criterion, claimed: Domain, *, subnormal: bool = False
) -> tuple[Indices, dict[str, int]]:
    """Find the rows of a family to ask an implementation about: ascending indices, and counts of the others by reason.

    `claimed` is the domain that the implementation declares. Rows with subnormal numbers are asked where `subnormal`.
    """
    precision, layout, extreme = criterion.precision, criterion.layout, is_extreme(family)
    inside = domain.claimed(rows, claimed, precision, extreme=extreme, subnormal=subnormal, layout=layout)
    return inside, domain.reasons(
        np.delete(rows, inside, axis=0), claimed, precision, extreme=extreme, subnormal=subnormal, layout=layout
    )


@dataclass(frozen=True, eq=False)
class Score:
    """Rows (n, 7) with their true positions (n,), or sweeps with their hits, and the answers of one implementation.

    `answers` (n,) are CANNOT_SAY for rows without a valid answer. `status` (n,) holds STATUS_CODES; it is WRONG for
    each wrong answer, which `judged` may find within the tolerance. `reasons` has a sentence for each row without a
    valid answer. `times` (n,) are the times of hits, if the implementation gives any.
    """

    criterion: Criterion
    rows: Rows
    truth: Positions
    answers: NDArray[np.int8]
    status: StatusCodes
    reasons: Mapping[int, str]
    times: Floats | None = None

    @cached_property
    def wrong(self) -> Indices:
        """The indices of the wrong answers, tolerated or not."""
        return np.flatnonzero(self.status == STATUS_CODES[Status.WRONG])

    @property
    def answered(self) -> NDArray[np.bool_]:
        """A mask (n,) of the rows with a valid answer, "cannot say" included."""
        answered = (STATUS_CODES[Status.RIGHT], STATUS_CODES[Status.WRONG], STATUS_CODES[Status.ABSTAINED])
        return np.asarray(np.isin(self.status, answered))

    @property
    def mistakes(self) -> Counter[Mistake]:
        """The number of wrong answers by kind of mistake."""
        counts: Counter[Mistake] = Counter()
        pairs = zip(self.truth[self.wrong].tolist(), self.answers[self.wrong].tolist(), strict=True)
        for (truth, answer), number in Counter(pairs).items():
            counts[judge.mistake_of(truth, answer, self.criterion.question)] += number
        return counts

    def judged(self, wrong: Indices | None = None) -> Iterator[WrongCase]:
        """Judge the wrong answers, or those at these indices; yield each with its status and its error."""
        places = self.wrong if wrong is None else wrong
        return judge.judged(self.rows, self.answers, places, self.criterion, self.times)

    def part(self, places: Indices) -> Score:
        """Return the score of the rows at these ascending indices."""
        if len(places) == len(self.rows):
            return self
        chosen: slice | Indices = as_slice(places)
        numbered = enumerate(places.tolist()) if self.reasons else ()
        return Score(
            self.criterion,
            self.rows[chosen],
            self.truth[chosen],
            self.answers[chosen],
            self.status[chosen],
            {place: self.reasons[before] for place, before in numbered if before in self.reasons},
            None if self.times is None else self.times[chosen],
        )

    def without(self, lost: Mapping[int, tuple[Status, str]]) -> Score:
        """Return the score without the answers at the indices in `lost`, which has their new statuses and reasons."""
        answers, status = self.answers.copy(), self.status.copy()
        for place, (ended, _) in lost.items():
            answers[place], status[place] = CANNOT_SAY, STATUS_CODES[ended]
        reasons = {**self.reasons, **{place: reason for place, (_, reason) in lost.items()}}
        return replace(self, answers=answers, status=status, reasons=reasons)

    def tally(
        self,
        source: CaseSource,
        indices: Indices,
        exponents: NDArray[np.float64],
        *,
        left_out: Mapping[str, int] = MappingProxyType({}),
        wrong: Sequence[WrongCase] | None = None,
    ) -> Tally:
        """Count these rows, which are the cases `indices` (n,) of a source, in a tally.

        `exponents` are floor(log2) of the distances of the first rows to the nearest other position. `left_out` counts
        rows that were not tested, by reason. `wrong` are the judged cases if some of them are excused.
        """
        cases = list(self.judged()) if wrong is None else wrong
        status = self.status.copy()
        for case in cases:
            status[case.index] = STATUS_CODES[case.status]
        amiss = status != STATUS_CODES[Status.RIGHT]
        return Tally(
            asked=len(self.rows),
            counts=counts_of(status) | ({Status.SKIPPED.value: sum(left_out.values())} if left_out else {}),
            not_asked=dict(left_out),
            mistakes=dict(Counter(case.mistake.value for case in cases)),
            answers=answer_counts(self.truth, self.answers, self.answered),
            dangerous=sum(case.status is Status.WRONG and case.mistake in DANGEROUS for case in cases),
            octaves=by_octave(exponents, status[: len(exponents)]),
            size_bins=tally.by_size(self.rows, amiss),
            place_bins=tally.by_place(self.rows, amiss),
            worst=self._worst(cases, source, indices),
            faults=unanswered_cases(self.rows, self.status, self.reasons, source, indices, self.criterion.layout),
        )

    def _worst(self, wrong: Iterable[WrongCase], source: CaseSource, indices: Indices) -> list[WorstCase]:
        """Return the worst cases with their measured errors, at most WORST_KEPT."""
        ranked = sorted(wrong, key=lambda case: (_exponent_first(case), case.index))
        chosen = ranked[:WORST_KEPT]
        if chosen and math.isfinite(chosen[-1].exponent) and not chosen[-1].least:
            # Cases with the same exponent as the last one kept are compared by their exact numbers.
            last = _exponent_first(chosen[-1])
            chosen += [case for case in ranked[WORST_KEPT:] if _exponent_first(case) == last]
        measured = (
            worst_case(
                case, source.place(int(indices[case.index])), source.name(int(indices[case.index])), self.criterion
            )
            for case in chosen
        )
        return sorted(measured, key=rank_of)[:WORST_KEPT]


def score(rows: Rows, truth: Positions, answered: Answered, criterion: Criterion) -> Score:
    """Judge the answers to rows with these true positions or hits, int8 (n,), as right, wrong or without an answer."""
    status, times = status_of(answered), answered.times
    wrong = judge.is_amiss(rows, truth, answered.answers, times, criterion)
    status[wrong] = STATUS_CODES[Status.WRONG]
    return Score(criterion, rows, truth, answered.answers, status, answered.reasons, times)


def status_of(answered: Answered) -> StatusCodes:
    """Return the status codes of rows before they are judged: RIGHT for each row with an answer."""
    status = _ENDED.take(answered.status)
    status[(answered.answers == CANNOT_SAY) & answered.answered] = STATUS_CODES[Status.ABSTAINED]
    return status


def unanswered_case(
    row: Sequence[float], status: int, reason: str, place: Place, name: str, layout: Layout
) -> UnansweredCase:
    """Make the record's struct of a row without a valid answer; `place` and `name` (its id) are those of the case."""
    return UnansweredCase(
        place=place, case=name, **row_fields(row, layout), status=STATUSES[status].value, reason=reason
    )


def unanswered_cases(
    rows: Rows,
    status: StatusCodes,
    reasons: Mapping[int, str],
    source: CaseSource,
    indices: Indices,
    layout: Layout,
) -> list[UnansweredCase]:
    """Return the first rows in `reasons` of each status, at most UNANSWERED_KEPT."""
    if not reasons:
        return []
    places = np.sort(np.fromiter(reasons, dtype=np.intp, count=len(reasons)))
    first = (places[status[places] == code][:UNANSWERED_KEPT].tolist() for code in set(status[places].tolist()))
    chosen = [(place, int(indices[place])) for some in first for place in some]
    return kept_unanswered(
        unanswered_case(
            rows[place].tolist(), status[place], reasons[place], source.place(case), source.name(case), layout
        )
        for place, case in chosen
    )


def as_slice(indices: Indices) -> slice | Indices:
    """Return the indices as a slice, which copies nothing, if they are consecutive."""
    if not len(indices) or indices[-1] - indices[0] != len(indices) - 1:
        return indices
    return slice(int(indices[0]), int(indices[-1]) + 1)


def _exponent_first(case: WrongCase) -> tuple[bool, float]:
    """Return the key that orders wrong cases by their rough size: wrong before tolerated, large errors first."""
    return case.status is not Status.WRONG, -case.exponent
