"""One hunt as it goes on: its budget, what it asks and judges, and what it keeps."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.casebook.draw import Integers
from hypcheck.hunt.findings import Findings
from hypcheck.hunt.target import Target
from hypcheck.judge import WrongCase
from hypcheck.methods.asking import Answered
from hypcheck.methods.faults import Outcome
from hypcheck.methods.method import Answers
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.truth import batch

PIECE = 4096
"""Rows between two looks at the clock, at most; it begins with the square root of that."""

PIECE_SECONDS = 0.5
"""The seconds that a piece may take before the next ones are made smaller."""


@dataclass(frozen=True, slots=True)
class Plan:
    """How long to hunt: seconds, queries, or whichever ends first; None is no limit. `seed` fixes all the rest."""

    seconds: float | None = 60.0
    queries: int | None = None
    seed: int = 1


@dataclass(slots=True)
class Fault:
    """Rows that ended without an answer in one way: the first of them, the reason, and how many they were."""

    row: tuple[float, ...]
    reason: str
    count: int = 0


@dataclass
class Hunt:
    """A hunt as it goes on: what was found, how many rows were asked, and what became of those without an answer.

    `piece` is how many rows are asked next; `barren` says that a whole round of strata had no row that is claimed.
    """

    target: Target
    plan: Plan
    findings: Findings = field(init=False)
    started: float = field(default_factory=time.monotonic)
    asked: int = 0
    answered: int = 0
    abstained: int = 0
    wrong: int = 0
    faults: dict[Outcome, Fault] = field(default_factory=dict)
    piece: int = math.isqrt(PIECE)
    barren: bool = False

    def __post_init__(self) -> None:
        self.findings = Findings(self.target.criterion)

    @property
    def seconds(self) -> float:
        """Since the start."""
        return time.monotonic() - self.started

    @property
    def spent(self) -> float:
        """The part of the budget that is spent, 1 where all of it is."""
        queries = self.asked / self.plan.queries if self.plan.queries else 0.0
        time_gone = self.seconds / self.plan.seconds if self.plan.seconds else 0.0
        return min(1.0, max(queries, time_gone))

    @property
    def over(self) -> bool:
        """Whether the budget is spent, there is nothing to ask, or the implementation cannot be asked any more."""
        return self.spent >= 1 or self.barren or Outcome.NOT_RUN in self.faults


def ask(run: Hunt, rows: Rows, ladders: Integers | None = None) -> list[WrongCase]:
    """The wrong answers among those that the target gives to the claimed rows; their `index` counts the given rows.

    With `ladders`, (n,) numbers, only the last wrong one of each number is judged and given back.
    """
    places = np.flatnonzero(run.target.claimed(rows))
    if run.plan.queries is not None:
        places = places[: run.plan.queries - run.asked]
    answers = np.full(len(rows), CANNOT_SAY, dtype=np.int8)
    start = 0
    while start < len(places) and not run.over:
        part = places[start : start + run.piece]
        start += len(part)
        began = time.monotonic()
        given = run.target.implementation.classify(rows[part])
        run.piece = max(1, run.piece // 2) if time.monotonic() - began > PIECE_SECONDS else min(PIECE, 2 * run.piece)
        _note(run, rows[part], given)
        answers[part] = given.answers
    return _judged(run, rows, answers, places[:start], ladders)


def _judged(
    run: Hunt, rows: Rows, answers: Answers, places: NDArray[np.intp], ladders: Integers | None
) -> list[WrongCase]:
    truth = batch.positions(rows[places])
    right = judge.expected(truth, run.target.criterion.question)
    wrong = np.flatnonzero((answers[places] != right) & (answers[places] != CANNOT_SAY))
    run.wrong += len(wrong)
    if ladders is not None:
        last = dict(zip(ladders[places[wrong]].tolist(), wrong.tolist(), strict=True))
        wrong = np.array(sorted(last.values()), dtype=np.intp)
    chosen = places[wrong]
    cases = judge.wrong_cases(rows[chosen], truth[wrong], answers[chosen], run.target.criterion)
    return [replace(case, index=int(chosen[case.index])) for case in cases]


def _note(run: Hunt, rows: Rows, given: Answered) -> None:
    run.asked += len(rows)
    run.answered += int(given.answered.sum())
    run.abstained += int(((given.answers == CANNOT_SAY) & given.answered).sum())
    for index, reason in given.reasons.items():
        fault = run.faults.setdefault(Outcome(int(given.status[index])), Fault(tuple(rows[index].tolist()), reason))
        fault.count += 1
