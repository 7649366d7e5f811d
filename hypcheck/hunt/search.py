"""The hunt: the strata first, then by turns local search around the worst that was found and more of the strata."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from hypcheck import judge
from hypcheck.casebook.draw import Draw
from hypcheck.hunt.climb import Climber, neighbours
from hypcheck.hunt.findings import Findings, Key, rank
from hypcheck.hunt.hunting import Hunt, ask
from hypcheck.hunt.strata import strata
from hypcheck.judge import WrongCase
from hypcheck.rows import Rows

FIRST_LOOK = 128
"""Rows of each stratum in the first round; whole blocks follow."""

TOGETHER = 4
"""Climbers at a time, each of a cluster of its own."""

MEASURED = 8
"""Neighbours of one climber whose backward errors are measured to their digits, out of those in the highest octave."""


Progress = Callable[[Hunt], object]


def hunt(run: Hunt, progress: Progress = lambda _: None) -> None:
    """Look for wrong answers until the budget is spent, and keep them in `run`; `progress` is told now and then.

    With a budget of queries alone, the same plan finds the same. What was found is there when the hunt is interrupted.
    """
    looking, climbing = _look(run), _climb(run)
    in_strata = 0
    while not run.over:
        before = run.asked
        next(looking)
        in_strata += run.asked - before
        progress(run)
        # Half of the questions go to each, once there is something to climb.
        while not run.over and 2 * in_strata > run.asked and next(climbing):
            progress(run)


def _look(run: Hunt) -> Iterator[None]:
    """The strata without end: a first look at all of them, then block after block."""
    everywhere = strata()
    for stratum in everywhere:
        _take(run, stratum.rows(run.plan.seed, 0)[:FIRST_LOOK], stratum.name)
        if run.over:
            break
    yield
    number = 0
    while True:
        number += 1
        for stratum in everywhere:
            _take(run, stratum.rows(run.plan.seed, number), stratum.name)
            yield


def _take(run: Hunt, rows: Rows, source: str) -> None:
    run.findings.add(ask(run, rows), source)


def _climb(run: Hunt) -> Iterator[bool]:
    """Local search around the worst of each cluster, a step of all climbers at a time; False where there are none."""
    climbers: dict[Key, Climber] = {}
    number = 0
    while True:
        chosen = _climbers(run.findings, climbers)
        if chosen:
            number += 1
            around = neighbours(Draw("hunt", run.plan.seed, number), list(chosen.values()))
            cases = ask(run, around.rows, around.ladders)
            for place, (key, climber) in enumerate(chosen.items()):
                own = [case for case in cases if around.owners[case.index] == place]
                run.findings.add(own, f"local search from {key[-1]}")
                climber.arrive(*_worst(own, climber, run.findings.criterion.question))
        yield bool(chosen)


def _climbers(findings: Findings, climbers: dict[Key, Climber]) -> dict[Key, Climber]:
    """The climbers whose turn it is, each where its cluster's worst is: the longest step first, then the worst."""
    found = sorted(findings.clusters.items(), key=lambda item: rank(item[1].worst), reverse=True)
    for key, cluster in found:
        if key not in climbers or cluster.worst.error > climbers[key].error:
            climbers[key] = Climber(np.array(cluster.worst.case.row), cluster.worst.error)
    awake = sorted((key for key, _ in found if not climbers[key].resting), key=lambda key: -climbers[key].step)
    return {key: climbers[key] for key in awake[:TOGETHER]}


def _worst(cases: list[WrongCase], climber: Climber, question: str) -> tuple[tuple[float, ...], float]:
    """The worst neighbour and its backward error; 0 where none can be worse than the climber's own row."""
    highest = max((case.exponent for case in cases), default=-math.inf)
    if highest < math.floor(math.log2(climber.error)):
        return (), 0.0
    rivals = [case for case in cases if case.exponent == highest][:MEASURED]
    error, row = max((judge.measured(case, question), case.row) for case in rivals)
    return row, error
