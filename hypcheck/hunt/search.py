"""The hunt: the strata first, then by turns local search around the worst that was found and more of the strata."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from hypcheck.casebook.draw import Draw
from hypcheck.hunt.climb import Climber, neighbours
from hypcheck.hunt.hunting import Findings, Hunt, Key, ask, rank
from hypcheck.hunt.strata import strata
from hypcheck.rows import Rows

FIRST_LOOK = 128
"""Rows of each stratum in the first round; whole blocks follow."""

TOGETHER = 4
"""Climbers at a time, each of a cluster of its own."""

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
    everywhere = strata(run.target.domain.settings)
    for stratum in everywhere:
        _take(run, stratum.rows(run.plan.seed, 0)[:FIRST_LOOK], stratum.name)
        if run.over:
            break
    yield
    number = 0
    while True:
        number += 1
        before = run.asked
        for stratum in everywhere:
            _take(run, stratum.rows(run.plan.seed, number), stratum.name)
            yield
        run.barren = run.asked == before


def _take(run: Hunt, rows: Rows, source: str) -> None:
    run.findings.add(ask(run, rows), source)


def _climb(run: Hunt) -> Iterator[bool]:
    """Local search around the worst of each cluster, a step of some climbers at a time; False where there are none."""
    climbers: dict[Key, Climber] = {}
    number = 0
    while True:
        chosen = _climbers(run.findings, climbers)
        if chosen:
            number += 1
            around = neighbours(Draw("hunt", run.plan.seed, number), [climbers[key] for key in chosen])
            cases = ask(run, around.rows, around.ladders)
            for place, key in enumerate(chosen):
                own = [case for case in cases if around.owners[case.index] == place]
                run.findings.add(own, f"local search from {key[-1]}")
                climbers[key].step /= 2
        yield bool(chosen)


def _climbers(findings: Findings, climbers: dict[Key, Climber]) -> list[Key]:
    """The climbers whose turn it is: the longest step first, then the worst.

    A climber stands where its cluster's worst is, and begins anew with the first step where that has become worse.
    """
    found = sorted(findings.clusters.items(), key=lambda item: rank(item[1].worst), reverse=True)
    for key, cluster in found:
        if key not in climbers or cluster.worst.error > climbers[key].error:
            climbers[key] = Climber(cluster.worst.case.row, cluster.worst.error)
    awake = [key for key, _ in found if not climbers[key].resting]
    return sorted(awake, key=lambda key: -climbers[key].step)[:TOGETHER]
