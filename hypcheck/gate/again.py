"""Open cases asked again, later and otherwise: in a fresh process, another order and other questions; then judged."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.gate.arranging import questions
from hypcheck.gate.chunks import Cases, cases_of
from hypcheck.gate.results import Again, Open, Result, merged
from hypcheck.gate.rules import Final, Rules, final
from hypcheck.gate.subject import Subject
from hypcheck.gate.trial import ended
from hypcheck.groups import CODES, STATUSES, Codes, Fault
from hypcheck.judge import Criterion, Status
from hypcheck.methods.faults import Outcome
from hypcheck.rows import CANNOT_SAY, Positions, Rows


@dataclass(frozen=True, slots=True)
class Round:
    """Open cases of some chunks, to be asked again together.

    `number` counts the rounds of a run, which have up to three parts.
    """

    number: int
    part: int
    open: tuple[Open, ...]


@dataclass(frozen=True)
class _Sample:
    """The cases of a round, in arrays: rows (n, 7), positions and first answers (n,).

    `moments` (n,) are the moments of the movement, of those that follow an object; −1 of others.
    """

    made: tuple[Cases, ...]
    rows: Rows
    truth: Positions
    before: NDArray[np.int8]
    moments: NDArray[np.int64]


Changes = dict[int, tuple[Status, str]]
"""How those end that were not answered as before, and why; TOLERATED where rounding may explain the change."""


def ask_again(asked: Round, implementation: Subject, rules: Rules) -> Result:
    """Ask the open cases again, and judge all; those that have changed end as what has become of them."""
    if not asked.open:
        return Result()
    sample, changes, outcomes = _sample(asked.open), Changes(), set[Outcome]()
    implementation.fresh()
    asking = questions(
        sample.truth, sample.moments, lambda: implementation.stands, rules.seed, asked.number, asked.part
    )
    for places, batch in asking:
        answered = implementation.classify(sample.rows[places], batch=batch)
        outcomes |= answered.outcomes
        status = ended(answered)
        for offset in np.flatnonzero((answered.answers != sample.before[places]) | ~answered.answered).tolist():
            place = int(places[offset])
            if changes.get(place, (Status.TOLERATED, ""))[0] is Status.TOLERATED:
                if answered.answered[offset]:
                    changes[place] = _change(sample, place, int(answered.answers[offset]), rules.criterion)
                else:
                    reason = f"when asked again: {answered.reasons.get(offset, '')}"
                    changes[place] = STATUSES[status[offset]], reason
    within = sum(status is Status.TOLERATED for status, _ in changes.values())
    beyond = sum(status is Status.NONDETERMINISTIC for status, _ in changes.values())
    again = Again(len(sample.rows), within, beyond)
    return replace(_judged(asked.open, sample, changes, rules), again=again, outcomes=frozenset(outcomes))


def as_they_are(some: tuple[Open, ...], rules: Rules) -> Result:
    """Judge open cases by their first answers: of a run that is interrupted before it could ask them again."""
    return _judged(some, _sample(some), {}, rules) if some else Result()


def _sample(some: tuple[Open, ...]) -> _Sample:
    made = cases_of(each.chunk for each in some)
    both = tuple(zip(made, some, strict=True))
    return _Sample(
        made,
        np.concatenate([part.rows[each.indices] for part, each in both]),
        np.concatenate([part.positions[each.indices] for part, each in both]),
        np.concatenate([each.answers for each in some]),
        np.concatenate([_moments(each) for each in some]),
    )


def _moments(each: Open) -> NDArray[np.int64]:
    if each.chunk.movement == 1:
        return np.full(len(each.indices), -1)
    return (each.chunk.start + each.indices) % each.chunk.movement


def _change(sample: _Sample, place: int, answer: int, criterion: Criterion) -> tuple[Status, str]:
    """What another answer than the first means."""
    pair = np.array([sample.before[place], answer], dtype=np.int8)
    if CANNOT_SAY not in pair:
        twice = np.stack([sample.rows[place]] * 2)
        wrong = judge.wrong_cases(twice, np.repeat(sample.truth[place], 2), pair, criterion)
        if all(case.status is Status.TOLERATED for case in wrong):
            return Status.TOLERATED, ""
    reason = f"answered {pair[0]} at first and {pair[1]} when asked again, in another order and question"
    return Status.NONDETERMINISTIC, reason


def _judged(some: tuple[Open, ...], sample: _Sample, changes: Changes, rules: Rules) -> Result:
    """All cases of the round, judged by their first answers unless these count no more."""
    results, start = [], 0
    lost = {place: change for place, change in changes.items() if change[0] is not Status.TOLERATED}
    for made, each in zip(sample.made, some, strict=True):
        stop = start + len(each.indices)
        answers = each.answers.copy()
        status: Codes = np.where(answers == CANNOT_SAY, CODES[Status.ABSTAINED], CODES[Status.RIGHT]).astype(np.int8)
        faults = []
        for place in sorted(place for place in lost if start <= place < stop):
            offset, (ending, reason) = place - start, lost[place]
            answers[offset], status[offset] = CANNOT_SAY, CODES[ending]
            index, row = int(each.indices[offset]), tuple(sample.rows[place].tolist())
            faults.append(Fault(made.chunk.place(index), made.chunk.name(index), row, ending.value, reason))
        results.append(final(Final(made, each.indices, answers, status, tuple(faults)), rules))
        start = stop
    return merged(results)
