"""From a wrong answer to the simplest row next to it that is answered wrongly in the same way."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from hypcheck.errors import InputError
from hypcheck.hunt import shrink
from hypcheck.hunt.hunting import Finding, Target, measured
from hypcheck.hunt.place import place_of
from hypcheck.hunt.simple import Complexity, Row, complexity, simpler_than, simplest_below
from hypcheck.judge import Status, WrongCase
from hypcheck.pairs import Pair
from hypcheck.rows import Rows
from hypcheck.score import Score
from hypcheck.tally import STATUSES

PIECE = 2048
"""Rows a question."""

MOST = 30_000
"""Rows that are asked for one step at most: the simplest of those that could be."""


Ways = Callable[[Row, Complexity], Rows]
"""From a row to the rows below a complexity that could take its place, the simplest first."""


@dataclass
class Minimised:
    """The search as it goes on: the given row, every simpler one that was taken, the last being the answer."""

    target: Target
    steps: list[Finding] = field(default_factory=list)
    asked: int = 0

    @property
    def first(self) -> Finding:
        """The given row's."""
        return self.steps[0]

    @property
    def last(self) -> Finding:
        """The simplest so far."""
        return self.steps[-1]


def minimise(target: Target, pair: Pair) -> Minimised:
    """Simplify until nothing simpler fails in the same way. Raises InputError where the answer is not wrong.

    The same way: the same answer where the same is true, beyond tolerance, and for the same cause (place.Place).
    """
    run = Minimised(target)
    run.steps.append(_start(run, pair))
    while any(_improve(run, ways) for ways in _WAYS):
        pass
    return run


def _start(run: Minimised, pair: Pair) -> Finding:
    rows = np.array([pair.row])
    if not len(run.target.claimed(rows)):
        raise InputError("the implementation does not claim to answer this row; --regimes any asks it all the same")
    scored = _ask(run, rows)
    for index, reason in scored.reasons.items():
        status = STATUSES[scored.status[index]]
        raise InputError(f"the implementation gives no answer to this row: {status.value}: {reason}")
    case = next(scored.judged(), None)
    if case is None:
        raise InputError("the implementation's answer to this row is not wrong; there is nothing to simplify")
    if case.status is not Status.WRONG:
        raise InputError("the implementation's answer to this row is wrong within tolerance; see --tolerance")
    return measured(case, run.target.criterion, place_of(pair), "given")


def _improve(run: Minimised, ways: Ways) -> bool:
    """Take the simplest row of those ways that fails alike; False where there is none."""
    row = run.last.case.row
    candidates = ways(row, complexity(row))[:MOST]
    for start in range(0, len(candidates), PIECE):
        rows = candidates[start : start + PIECE]
        rows = rows[run.target.claimed(rows)]
        for case in _ask(run, rows).judged():
            place = place_of(Pair.from_row(case.row)) if _alike(case, run.first.case) else None
            if place is not None and place.cause == run.first.place.cause:
                run.steps.append(measured(case, run.target.criterion, place, f"step {len(run.steps)}"))
                return True
    return False


def _alike(case: WrongCase, first: WrongCase) -> bool:
    return case.status is Status.WRONG and (case.truth, case.answer) == (first.truth, first.answer)


def _ask(run: Minimised, rows: Rows) -> Score:
    run.asked += len(rows)
    return run.target.ask(rows)


def _next_to(around: Callable[[Row], Iterable[Row]]) -> Ways:
    return lambda row, limit: simpler_than(around(row), limit)


_WAYS: tuple[Ways, ...] = (
    _next_to(shrink.same_pair),
    _next_to(shrink.one_changed),
    lambda _, limit: simplest_below(limit),
    _next_to(shrink.brought_back),
)
"""Cheap ways first: each later one is tried only where those before it have nothing more to offer."""
