"""The retest: pending cases are tested again later, in a fresh process, in another order and in other batches.

An implementation that answers many rows at once can be wrong at one place of a batch only: in the tail that fills no
vector, in the first row of a thread, in a block that is never computed. Such an answer may equal the truth by luck.
Therefore cases are tested alone, in batches of every size, and so that each place of a large batch holds a case of each
position. A function for scenes, which answers about many centres beside one hyperboloid, is other code, and must give
the same answers.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import CANNOT_SAY, Indices, Layout, Mask, Positions, Rows, as_wide, scenes_of
from hypcheck.implementations.implementation import Crashed, Implementation
from hypcheck.implementations.session import Answered, Outcome
from hypcheck.record.lines import Retest
from hypcheck.runs import judge
from hypcheck.runs.cases import PACE, CaseChunk, ChunkCases, Pace, cases_of_chunk
from hypcheck.runs.judge import Criterion, Status
from hypcheck.runs.results import CasesResult, JudgingRules, PendingRetest, merged_result, result_of_final
from hypcheck.runs.score import as_slice, score, status_of
from hypcheck.runs.tally import STATUSES

RetestQuestion = tuple[Indices, int | None]
"""The indices of cases, and the number of rows of each batch in which they are sent; None: as many as possible."""

SCENES = 256
"""The number of scenes of a round that are tested by the function for scenes: those with the most cases, and about as
many of the others, evenly chosen, because tilted spheroids hardly share their axes."""

LONG_SCENES = 3
"""The number of scenes of the first round with questions of FULL_QUESTION centres: those with the most cases."""

ALONE, SINGLE_STEP = 32, 20
"""The number of cases that are sent one by one, and the number of batches of one row between two looks at the clock."""

LENGTHS = (7, 3, 11, 2, 5, 13, 9, 6, 15, 10, 4, 14, 12, 8, 17, 16, 31, 33, 63, 65, 129, 127)
"""The numbers of rows of small batches: every remainder modulo 2, 4, 8 and 16, and the neighbours of powers of two."""

IN_LENGTHS = 1536
"""The most cases that are tested in batches of LENGTHS, unless they are tested more than once."""

LENGTH_ROUNDS = 3
"""The number of batches of each of LENGTHS for an implementation that answers LARGE_QUESTION rows at once."""

TWINS = 64
"""The number of cases that occur four times in one batch, adjacent and apart: an implementation may cache answers."""

LARGE_QUESTION = 4096
FULL_QUESTION = LARGE_QUESTION + 128 + 1
"""The least number of rows of a full batch, if the implementation accepts so many. Cases are repeated, so that every
thread, block and page has some if the implementation divides a batch."""

PARTS = 3
"""A round has at most so many parts, each with its own order."""

SHORTER = (0, 0, 2)
"""The numbers of rows by which full batches are shorter, so that the tail of a vector varies. Two have full length, so
that an answer that is always the same in the last place is wrong in one of them."""


@dataclass(frozen=True, slots=True)
class RetestStep:
    """A step that retests the pending cases of one part of the chunks since the last round.

    `number` counts the rounds of a run. Part 0 holds the first chunks of families, and everything that is tested once
    in a run. Parts 1 and 2 hold the other chunks, so that two processes are busy at the end of a run. `pending` are the
    cases; they are known after all chunks before the step were tested.
    """

    number: int
    part: int = 0
    pending: tuple[PendingRetest, ...] = ()
    pace: Pace = PACE

    def asks(self, chunk: CaseChunk) -> bool:
        """Return whether this part retests the pending cases of a chunk."""
        return chunk.part(self.pace.chunk_rows) == self.part

    def of(self, some: tuple[PendingRetest, ...]) -> RetestStep:
        """Return the step with its part of all pending cases."""
        return replace(self, pending=tuple(pending for pending in some if self.asks(pending.chunk)))


@dataclass(frozen=True)
class _Sample:
    """The cases of a round in arrays: rows, positions or hits, and first answers with their times, (n,) each.

    `moments` (n,) are the moments of cases that follow an object, and −1 for all other cases.
    """

    made: tuple[ChunkCases, ...]
    rows: Rows
    truth: Positions
    before: Answered
    moments: NDArray[np.int64]


ChangedAnswers = dict[int, tuple[Status, str]]
"""The status of cases with another answer than before, and the reason; TOLERATED if rounding can explain the change."""


def retest(step: RetestStep, implementation: Implementation | Crashed, rules: JudgingRules) -> CasesResult:
    """Test the pending cases again, and judge all of them; cases with a changed answer get the status of the change."""
    if not step.pending:
        return CasesResult()
    sample, changes, outcomes = _sample(step.pending, rules.criterion), ChangedAnswers(), set[Outcome]()
    implementation.close()  # so that a fresh process answers
    asking = retest_questions(
        sample.truth,
        sample.moments,
        lambda: implementation.proven_batch,
        rules.seed,
        step.number,
        step.part,
        step.pace,
    )
    by_scene: Iterator[RetestQuestion] = iter(())
    if implementation.scene:
        first = step.number == step.part == 0
        by_scene = scene_questions(
            sample.rows, sample.truth, lambda: implementation.proven_batch if first else 0, rules.seed
        )
    questions = chain(((*question, False) for question in asking), ((*question, True) for question in by_scene))
    for places, batch, one_scene in questions:
        answered = implementation.classify(sample.rows[places], batch=batch, by_scene=one_scene)
        outcomes |= answered.outcomes
        status = status_of(answered)
        for offset in np.flatnonzero(_differs(sample.before, places, answered) | ~answered.answered).tolist():
            place = int(places[offset])
            if changes.get(place, (Status.TOLERATED, ""))[0] is Status.TOLERATED:
                if answered.answered[offset]:
                    now = _BY_SCENE if one_scene else _AGAIN
                    changes[place] = _change(sample, place, answered, offset, rules.criterion, now)
                else:
                    how = _BY_SCENE if one_scene else "when asked again"
                    reason = f"{how}: {answered.reasons.get(offset, '')}"
                    changes[place] = STATUSES[status[offset]], reason
    within = sum(status is Status.TOLERATED for status, _ in changes.values())
    beyond = sum(status is Status.NONDETERMINISTIC for status, _ in changes.values())
    changed = Retest(asked=len(sample.rows), within=within, beyond=beyond)
    return replace(_judged(step.pending, sample, changes, rules), retest=changed, outcomes=frozenset(outcomes))


def result_without_retest(some: tuple[PendingRetest, ...], rules: JudgingRules) -> CasesResult:
    """Judge pending cases by their first answers, for a run that was interrupted before their retest."""
    return _judged(some, _sample(some, rules.criterion), {}, rules) if some else CasesResult()


def _sample(some: tuple[PendingRetest, ...], criterion: Criterion) -> _Sample:
    """Put the pending cases of a round together, with their rows, truths and first answers."""
    cases = tuple(cases_of_chunk(pending.chunk) for pending in some)
    both = tuple(zip(cases, some, strict=True))
    return _Sample(
        cases,
        _stacked([part.rows[pending.indices] for part, pending in both], criterion.layout),
        np.concatenate([part.positions[pending.indices] for part, pending in both]),
        _first_answers(some),
        np.concatenate([_moments(pending) for pending in some]),
    )


def _first_answers(some: tuple[PendingRetest, ...]) -> Answered:
    """Return the first answers of pending cases, and the times of their hits if there are any."""
    times = [pending.times for pending in some if pending.times is not None]
    return Answered.of(np.concatenate([pending.answers for pending in some]), np.concatenate(times) if times else None)


def _differs(before: Answered, places: Indices, now: Answered) -> Mask:
    """Mark the answers that differ from the earlier ones at these places, and the hits whose times differ."""
    other = np.asarray(now.answers != before.answers[places])
    if now.times is not None and before.times is not None:
        other |= ~((now.times == before.times[places]) | (np.isnan(now.times) & np.isnan(before.times[places])))
    return other


def _stacked(parts: list[Rows], layout: Layout) -> Rows:
    """Put all rows together; if some have an axis or heights, every row gets them."""
    return np.concatenate(as_wide(parts, layout))


def _moments(pending: PendingRetest) -> NDArray[np.int64]:
    """Return the moments of cases that follow a moving object; −1 for all other cases."""
    if pending.chunk.movement == 1:
        return np.full(len(pending.indices), -1)
    return (pending.chunk.start + pending.indices) % pending.chunk.movement


_AGAIN = "when asked again, in another order and batch"
_BY_SCENE = "when its function for scenes is asked"


def _change(
    sample: _Sample, place: int, answered: Answered, offset: int, criterion: Criterion, now: str
) -> tuple[Status, str]:
    """Return the new status of a case whose answer has changed, and the reason ("" if it is tolerated).

    The case is the one at `place` of the sample, and its new answer is at `offset` of `answered`. The status is
    TOLERATED if both answers are right or within the tolerance, else NONDETERMINISTIC.
    """
    before = sample.before
    pair = np.array([before.answers[place], answered.answers[offset]], dtype=np.int8)
    times = None
    if before.times is not None and answered.times is not None:
        times = np.array([before.times[place], answered.times[offset]])
    if CANNOT_SAY not in pair:
        twice = np.stack([sample.rows[place]] * 2)
        wrong = np.flatnonzero(judge.is_amiss(twice, np.repeat(sample.truth[place], 2), pair, times, criterion))
        if all(case.status is Status.TOLERATED for case in judge.judged(twice, pair, wrong, criterion, times)):
            return Status.TOLERATED, ""
    first, then = (
        f"{answer}" if times is None or answer != 1 else f"{answer} at time {time!r}"
        for answer, time in zip(pair.tolist(), [None, None] if times is None else times.tolist(), strict=True)
    )
    return Status.NONDETERMINISTIC, f"answered {first} at first and {then} {now}"


def _judged(
    some: tuple[PendingRetest, ...], sample: _Sample, changes: ChangedAnswers, rules: JudgingRules
) -> CasesResult:
    """Judge all cases of the round by their first answers, except for those whose answers changed."""
    results, start = [], 0
    lost = {place: change for place, change in changes.items() if change[0] is not Status.TOLERATED}
    for made, pending in zip(sample.made, some, strict=True):
        stop = start + len(pending.indices)
        part = as_slice(pending.indices)
        scored = score(
            made.by_column[part], made.positions[part], Answered.of(pending.answers, pending.times), rules.criterion
        )
        scored = scored.without({place - start: lost[place] for place in lost if start <= place < stop})
        results.append(result_of_final(made, pending.indices, scored, rules))
        start = stop
    return merged_result(results)


def retest_questions(
    truth: NDArray[np.int8],
    moments: NDArray[np.int64],
    proven_batch: Callable[[], int],
    seed: int,
    number: int,
    part: int = 0,
    pace: Pace = PACE,
) -> Iterator[RetestQuestion]:
    """Yield what is sent in one part of a round that retests n cases; each case is sent at least once.

    Each item is a RetestQuestion: indices of cases in the order in which they are sent, and the number of rows of a
    batch (1: row by row; None: as many as possible).

    `truth` (n,) are the positions or hits. `moments` (n,) are the moments of cases that follow a moving object, and −1
    for all other cases. Cases with moments are sent moment by moment, which reveals an implementation that carries
    answers over from one batch to the next. `proven_batch` returns the size of the largest batch that was answered well
    within the timeout so far. If it is LARGE_QUESTION rows or more, each case is sent many times in part 0 of round 0.
    `seed`, `number` (of the round) and `part` (0, 1 or 2, as in RetestStep) determine the order. Two processes can
    perform parts 1 and 2: each sends half of the small batches. `pace` limits the time for batches of one row, and
    decides whether the longest batches are sent.
    """
    random = np.random.Generator(np.random.Philox((seed, PARTS * number + part)))
    order = random.permutation(np.flatnonzero(moments < 0))
    parts = 2 if part else 1
    alone = ALONE // parts
    yield order[:alone], 1
    yield np.tile(np.repeat(order[: TWINS // parts], 2), 2), None
    rest = order[alone:]
    some = min(IN_LENGTHS // parts, (len(rest) + 1) // 2)
    yield from _of_every_length(rest[:some])
    yield _filled(rest[some:], order, FULL_QUESTION if proven_batch() >= FULL_QUESTION else 0), None
    if number == part == 0 and proven_batch() >= LARGE_QUESTION and len(order):
        yield from _of_every_length(np.resize(order, LENGTH_ROUNDS * sum(LENGTHS)))
        began = time.monotonic()
        yield from _in_every_place(order, truth, random, min(FULL_QUESTION, proven_batch()))
        if time.monotonic() - began < pace.soon_s:
            yield from _in_every_place(order, truth, random, proven_batch())
        yield from _one_by_one(np.resize(order, pace.single_rows), pace.single_s)
    yield from _moment_by_moment(moments)


def scene_questions(
    rows: Rows, truth: NDArray[np.int8], proven_batch: Callable[[], int], seed: int
) -> Iterator[RetestQuestion]:
    """Yield what is sent to a function for scenes: the cases of each scene in one question, and some in small ones.

    The cases of LONG_SCENES are repeated as in retest_questions, if `proven_batch` returns LARGE_QUESTION or more.
    """
    random = np.random.Generator(np.random.Philox(seed))
    scenes = scenes_of(rows)
    others = scenes[SCENES:]
    for number, cases in enumerate([*scenes[:SCENES], *others[:: 1 + len(others) // SCENES]]):
        yield cases, None
        if len(cases) > 1:
            yield cases[:IN_LENGTHS], LENGTHS[number % len(LENGTHS)]
        if number < LONG_SCENES and proven_batch() >= LARGE_QUESTION:
            yield from _in_every_place(cases, truth, random, min(FULL_QUESTION, proven_batch()))


def _one_by_one(cases: Indices, seconds: float) -> Iterator[RetestQuestion]:
    """Yield the cases in batches of one row, until `seconds` have passed."""
    began = time.monotonic()
    for start in range(0, len(cases), SINGLE_STEP):
        if time.monotonic() - began < seconds:
            yield cases[start : start + SINGLE_STEP], 1


def _of_every_length(cases: Indices) -> Iterator[RetestQuestion]:
    """Yield all cases in batches whose lengths are LENGTHS in turn."""
    start = 0
    while start < len(cases):
        for length in LENGTHS:
            part = cases[start : start + length]
            if len(part):
                yield part, length
            start += length


def _filled(cases: Indices, order: Indices, least: int) -> Indices:
    """Repeat the cases until there are at least `least`; if there are no cases, repeat those of `order`."""
    if len(order) and len(cases) < least:
        return np.resize(cases if len(cases) else order, least)
    return cases


def _in_every_place(
    order: Indices, truth: NDArray[np.int8], random: np.random.Generator, size: int
) -> Iterator[RetestQuestion]:
    """Yield batches of about `size` rows, one for each position among the cases.

    At each place of a batch, the cases in the different batches have different positions.
    """
    parts = [part for position in Position if len(part := order[truth[order] == position])]
    which = random.integers(len(parts), size=size)
    for turn in range(len(parts)):
        chosen = (which[: size - SHORTER[turn]] + turn) % len(parts)
        cases = np.empty(len(chosen), dtype=np.intp)
        for number, part in enumerate(parts):
            here = np.flatnonzero(chosen == number)
            cases[here] = np.resize(part, len(here))
        yield cases, None


def _moment_by_moment(moments: NDArray[np.int64]) -> Iterator[RetestQuestion]:
    """Yield the cases that follow a moving object: some one by one, then those of each moment in one batch."""
    moving = np.flatnonzero(moments >= 0)
    if len(moving):
        yield moving[: int(moments.max()) + 1], 1
        for moment in range(int(moments.max()) + 1):
            yield moving[moments[moving] == moment], None
