"""A hunt: its plan, the rows that were asked, and the wrong answers found, grouped by where their rows lie."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from hypcheck.geometry.rows import Indices, Layout, Rows
from hypcheck.implementations.description import Domain, claimed
from hypcheck.implementations.implementation import Implementation
from hypcheck.runs import judge
from hypcheck.runs.hunt_place import RowPlace, place_of_row
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion, Mistake, Status, WrongCase
from hypcheck.runs.judges import Judge, judge_of
from hypcheck.runs.score import Score, score
from hypcheck.runs.tally import STATUSES, UnansweredCase, counts_of
from hypcheck.vectors.draw import Integers

PIECE = 4096
"""At most so many rows between two checks of the budget; the first piece has the square root of that."""

PIECE_SECONDS = 0.5
"""If a piece takes longer, in seconds, the next pieces are smaller."""

_ANSWERED = (Status.RIGHT, Status.WRONG, Status.ABSTAINED)


@dataclass(frozen=True, slots=True)
class HuntPlan:
    """The budget of a hunt in seconds, in queries, or in both, of which the first ends it; None is no limit.

    `seed` determines the rows.
    """

    seconds: float | None = 60.0
    queries: int | None = None
    seed: int = 1


@dataclass(frozen=True, slots=True)
class HuntTarget:
    """An implementation with its SPEC, the criterion by which it is judged, and the domain in which it is asked.

    `options` are options of the command line, as name and value, that replace what it declares; reports repeat them.
    If `extreme`, it is also asked at the ends of the float formats, unless its domain excludes them.
    """

    spec: str
    implementation: Implementation
    criterion: Criterion
    domain: Domain
    options: tuple[tuple[str, str], ...] = ()
    extreme: bool = False

    @property
    def judge(self) -> Judge:
        """How its answers are judged."""
        return judge_of(self.criterion.question)

    @property
    def layout(self) -> Layout:
        """The columns of its rows."""
        return self.criterion.layout

    def claimed(self, rows: Rows) -> Indices:
        """The indices of the rows that the implementation claims to answer."""
        return claimed(rows, self.domain, self.criterion.precision, extreme=self.extreme, layout=self.layout)

    def ask(self, rows: Rows) -> Score:
        """Ask these rows; their score."""
        answered = self.implementation.classify(rows)
        return score(rows, self.judge.truth(rows), answered, self.criterion)


def target_of(
    spec: str,
    implementation: Implementation,
    *,
    regimes: tuple[str, ...] | None = None,
    tolerance: Fraction = DEFAULT_TOLERANCE,
    options: tuple[tuple[str, str], ...] = (),
) -> HuntTarget:
    """The target with the implementation's own description; `regimes`, if given, replace those it declares.

    Raises InputError if a regime is unknown or the tolerance is negative.
    """
    used = implementation.description
    domain = used.domain if regimes is None else replace(used.domain, regimes=regimes)
    return HuntTarget(spec, implementation, Criterion(used.question, used.precision, tolerance), domain, options)


@dataclass(frozen=True, slots=True)
class HuntFinding:
    """A wrong answer, its error as its judge measures it (also in units u), where its row lies, and what found it."""

    case: WrongCase
    error: float
    error_u: float
    place: RowPlace
    source: str


@dataclass(slots=True)
class FindingCluster:
    """Wrong answers of one kind: the worst, and how many were found beyond the tolerance and within it."""

    worst: HuntFinding
    beyond: int = 0
    tolerated: int = 0


ClusterKey = tuple[Mistake, int, str]
"""The kind of a wrong answer: the mistake, the truth, and the kind of the row's place."""


@dataclass(slots=True)
class HuntFindings:
    """All clusters of a hunt."""

    criterion: Criterion
    clusters: dict[ClusterKey, FindingCluster] = field(default_factory=dict)

    def add(self, cases: Iterable[WrongCase], source: str) -> None:
        """Add judged cases that one stratum or one search found."""
        layout = self.criterion.layout
        for case in cases:
            place = place_of_row(case.row, layout)
            key = (case.mistake, case.truth, place.kind)
            cluster = self.clusters.get(key)
            if cluster is None or _may_be_worse(case, cluster.worst.case):
                finding = measured_finding(case, self.criterion, place, source)
                if cluster is None:
                    cluster = self.clusters[key] = FindingCluster(finding)
                elif finding_rank(finding) > finding_rank(cluster.worst):
                    cluster.worst = finding
            if case.status is Status.WRONG:
                cluster.beyond += 1
            else:
                cluster.tolerated += 1

    def worst_first(self) -> list[FindingCluster]:
        """The clusters with an answer beyond the tolerance, the worst first."""
        beyond = [cluster for cluster in self.clusters.values() if cluster.beyond]
        return sorted(beyond, key=lambda cluster: finding_rank(cluster.worst), reverse=True)


def measured_finding(case: WrongCase, criterion: Criterion, place: RowPlace, source: str) -> HuntFinding:
    """The finding of a judged case."""
    error = judge_of(criterion.question).measured(case, criterion)
    return HuntFinding(case, error, judge.in_units(error, criterion.unit), place, source)


def finding_rank(finding: HuntFinding) -> tuple[bool, float]:
    """The order of findings: beyond the tolerance or not, then the backward error."""
    return finding.case.status is Status.WRONG, finding.error


def _may_be_worse(case: WrongCase, worst: WrongCase) -> bool:
    return (case.status is Status.WRONG, case.exponent) >= (worst.status is Status.WRONG, worst.exponent)


@dataclass
class Hunt:
    """The state of a hunt.

    `counts` are rows by status; a tolerated answer counts as wrong. `unanswered` is the first case of each status
    without a valid answer. `piece` is the number of rows to ask next. `barren` says that the implementation claimed no
    row of a whole round of strata.
    """

    target: HuntTarget
    plan: HuntPlan
    findings: HuntFindings = field(init=False)
    started: float = field(default_factory=time.monotonic)
    counts: Counter[str] = field(default_factory=Counter)
    unanswered: dict[Status, UnansweredCase] = field(default_factory=dict)
    piece: int = math.isqrt(PIECE)
    barren: bool = False

    def __post_init__(self) -> None:
        self.findings = HuntFindings(self.target.criterion)

    @property
    def asked(self) -> int:
        """Rows asked so far."""
        return self.counts.total()

    @property
    def answered(self) -> int:
        """Rows with an answer, "cannot say" included."""
        return sum(self.counts[status.value] for status in _ANSWERED)

    @property
    def seconds(self) -> float:
        """Seconds since the start."""
        return time.monotonic() - self.started

    @property
    def spent(self) -> float:
        """The part of the budget that is spent, at most 1."""
        queries = self.asked / self.plan.queries if self.plan.queries else 0.0
        time_gone = self.seconds / self.plan.seconds if self.plan.seconds else 0.0
        return min(1.0, max(queries, time_gone))

    @property
    def over(self) -> bool:
        """Whether the budget is spent, there is nothing to ask, or the implementation was given up."""
        return self.spent >= 1 or self.barren or Status.NOT_RUN in self.unanswered


def ask_rows(run: Hunt, rows: Rows, ladders: Integers | None = None) -> list[WrongCase]:
    """The target's wrong answers to the rows that it claims; their `index` is that of the given rows.

    With `ladders`, (n,) numbers, only the last wrong answer of each number is judged and returned.
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
            if status not in run.unanswered:
                row = tuple(scored.rows[index].tolist())
                run.unanswered[status] = UnansweredCase((1, run.asked + index), "", row, status.value, reason)
        run.counts.update(counts_of(scored.status))
        yield part, scored
