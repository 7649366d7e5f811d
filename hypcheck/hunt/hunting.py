"""A hunt: what is hunted and for how long, how rows are asked, and which wrong answers were found."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from hypcheck import judge
from hypcheck.casebook.draw import Integers
from hypcheck.hunt.place import Place, place_of
from hypcheck.judge import DEFAULT_TOLERANCE, Criterion, Mistake, Status, WrongCase
from hypcheck.methods.domain import Domain, claimed
from hypcheck.methods.implementation import Implementation
from hypcheck.pairs import Pair, Position
from hypcheck.rows import Rows
from hypcheck.score import Indices, Score, score
from hypcheck.tally import STATUSES, Fault, counts_of
from hypcheck.truth import batch

PIECE = 4096
"""Rows between two looks at the clock, at most; it begins with the square root of that."""

PIECE_SECONDS = 0.5
"""The seconds that a piece may take before the next ones are made smaller."""

_ANSWERED = (Status.RIGHT, Status.WRONG, Status.ABSTAINED)


@dataclass(frozen=True, slots=True)
class Plan:
    """How long to hunt: seconds, queries, or whichever ends first; None is no limit. `seed` fixes all the rest."""

    seconds: float | None = 60.0
    queries: int | None = None
    seed: int = 1


@dataclass(frozen=True, slots=True)
class Target:
    """An implementation with its SPEC, the criterion by which it is judged, and the domain in which it is asked.

    `options` are the command line's, as name and value, that stand for what it declares: reports repeat them.
    `extreme`: it is asked at the ends of the float formats too, where it has not declared otherwise.
    """

    spec: str
    implementation: Implementation
    criterion: Criterion
    domain: Domain
    options: tuple[tuple[str, str], ...] = ()
    extreme: bool = False

    def claimed(self, rows: Rows) -> Indices:
        """The places of the rows that the implementation claims to answer."""
        return claimed(rows, self.domain, self.criterion.precision, extreme=self.extreme)

    def ask(self, rows: Rows) -> Score:
        """The score of rows, which are asked now."""
        answered = self.implementation.classify(rows)
        return score(rows, batch.positions(rows), answered, self.criterion)


def target_of(
    spec: str,
    implementation: Implementation,
    *,
    regimes: tuple[str, ...] | None = None,
    tolerance: Fraction = DEFAULT_TOLERANCE,
    options: tuple[tuple[str, str], ...] = (),
) -> Target:
    """The implementation as it describes itself; `regimes`, where given, stand for those it declares.

    Raises InputError where a regime is unknown or the tolerance negative.
    """
    said = implementation.description
    domain = said.domain if regimes is None else replace(said.domain, regimes=regimes)
    return Target(spec, implementation, Criterion(said.question, said.precision, tolerance), domain, options)


@dataclass(frozen=True, slots=True)
class Finding:
    """A wrong answer, how far off it is (`error`, and in units u), where it stands, and what came upon it."""

    case: WrongCase
    error: float
    error_u: float
    place: Place
    source: str


@dataclass(slots=True)
class Cluster:
    """Wrong answers of one kind: how many were met, beyond tolerance and within it, and the worst."""

    worst: Finding
    beyond: int = 0
    tolerated: int = 0


Key = tuple[Mistake, Position, str]
"""What tells kinds of wrong answers apart: the mistake, the truth, and the kind of place."""


@dataclass(slots=True)
class Findings:
    """All clusters of a hunt."""

    criterion: Criterion
    clusters: dict[Key, Cluster] = field(default_factory=dict)

    def add(self, cases: Iterable[WrongCase], source: str) -> None:
        """Take in judged cases that one stratum or one search came upon."""
        for case in cases:
            place = place_of(Pair.from_row(case.row))
            key = (case.mistake, case.truth, place.kind)
            cluster = self.clusters.get(key)
            if cluster is None or _may_be_worse(case, cluster.worst.case):
                finding = measured(case, self.criterion, place, source)
                if cluster is None:
                    cluster = self.clusters[key] = Cluster(finding)
                elif rank(finding) > rank(cluster.worst):
                    cluster.worst = finding
            if case.status is Status.WRONG:
                cluster.beyond += 1
            else:
                cluster.tolerated += 1

    def worst_first(self) -> list[Cluster]:
        """The clusters with an answer beyond tolerance, the worst first."""
        beyond = [cluster for cluster in self.clusters.values() if cluster.beyond]
        return sorted(beyond, key=lambda cluster: rank(cluster.worst), reverse=True)


def measured(case: WrongCase, criterion: Criterion, place: Place, source: str) -> Finding:
    """The finding of a judged case."""
    error = judge.measured(case, criterion.question)
    return Finding(case, error, judge.in_units(error, criterion.unit), place, source)


def rank(finding: Finding) -> tuple[bool, float]:
    """What makes one finding worse than another: beyond tolerance, then the backward error."""
    return finding.case.status is Status.WRONG, finding.error


def _may_be_worse(case: WrongCase, worst: WrongCase) -> bool:
    return (case.status is Status.WRONG, case.exponent) >= (worst.status is Status.WRONG, worst.exponent)


@dataclass
class Hunt:
    """A hunt as it goes on: what was found, how the rows that were asked ended, and the first fault of each status.

    A tolerated answer counts as wrong. `piece` is how many rows are asked next; `barren` says that a whole round of
    strata had no row that is claimed.
    """

    target: Target
    plan: Plan
    findings: Findings = field(init=False)
    started: float = field(default_factory=time.monotonic)
    counts: Counter[str] = field(default_factory=Counter)
    faults: dict[Status, Fault] = field(default_factory=dict)
    piece: int = math.isqrt(PIECE)
    barren: bool = False

    def __post_init__(self) -> None:
        self.findings = Findings(self.target.criterion)

    @property
    def asked(self) -> int:
        """Rows asked so far."""
        return self.counts.total()

    @property
    def answered(self) -> int:
        """Rows with an answer, "cannot say" among them."""
        return sum(self.counts[status.value] for status in _ANSWERED)

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
        return self.spent >= 1 or self.barren or Status.NOT_RUN in self.faults


def ask(run: Hunt, rows: Rows, ladders: Integers | None = None) -> list[WrongCase]:
    """The wrong answers among those that the target gives to the claimed rows; their `index` counts the given rows.

    With `ladders`, (n,) numbers, only the last wrong one of each number is judged and given back.
    """
    places = run.target.claimed(rows)
    if run.plan.queries is not None:
        places = places[: run.plan.queries - run.asked]
    pieces = list(_pieces(run, rows, places))
    wrong = [part[scored.wrong] for part, scored in pieces]
    if ladders is not None:
        last = {int(ladders[place]): place for some in wrong for place in some.tolist()}
        wrong = [some[np.isin(some, list(last.values()))] for some in wrong]
    return [
        replace(case, index=int(part[case.index]))
        for (part, scored), some in zip(pieces, wrong, strict=True)
        for case in scored.judged(np.searchsorted(part, some))
    ]


def _pieces(run: Hunt, rows: Rows, places: Indices) -> Iterator[tuple[Indices, Score]]:
    """Ask the rows at these places, some at a time, until the budget is spent."""
    start = 0
    while start < len(places) and not run.over:
        part = places[start : start + run.piece]
        start += len(part)
        began = time.monotonic()
        scored = run.target.ask(rows[part])
        run.piece = max(1, run.piece // 2) if time.monotonic() - began > PIECE_SECONDS else min(PIECE, 2 * run.piece)
        for index, reason in scored.reasons.items():
            status = STATUSES[scored.status[index]]
            if status not in run.faults:
                row = tuple(scored.rows[index].tolist())
                run.faults[status] = Fault((1, run.asked + index), "", row, status.value, reason)
        run.counts.update(counts_of(scored.status))
        yield part, scored
