"""What a hunt has found: wrong answers, put together by what they mean and by where they are."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from hypcheck import judge
from hypcheck.hunt.place import Place, place_of
from hypcheck.judge import Criterion, Mistake, Status, WrongCase
from hypcheck.pairs import Pair, Position


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
