"""A hunt: its plan, the tested rows, the wrong answers grouped by the places of their rows, and its report.

hunt_search.py chooses the rows.
"""

from __future__ import annotations

import math
import shlex
import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from hypcheck.geometry.rows import Indices, Layout, Rows
from hypcheck.implementations.domain import Domain, claimed
from hypcheck.implementations.implementation import Implementation
from hypcheck.messages import counted
from hypcheck.record.fields import row_of
from hypcheck.record.progress import UnansweredCase
from hypcheck.runs import judge
from hypcheck.runs.hunt_surfaces import RowPlace, place_of_row
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion, Mistake, Status, WrongCase
from hypcheck.runs.score import Score, score, unanswered_case
from hypcheck.runs.tally import STATUSES, counts_of
from hypcheck.tables.numbers import decimals_of, hex_of
from hypcheck.truth.passage_error import first_contact
from hypcheck.vectors.draw import Integers

PIECE = 4096
"""A piece is the rows that are tested between two checks of the budget: PIECE at most, and √PIECE at first."""

PIECE_SECONDS = 0.5
"""If a piece takes more seconds than this, the next pieces are smaller."""

_ANSWERED = (Status.RIGHT, Status.WRONG, Status.ABSTAINED)


@dataclass(frozen=True, slots=True)
class HuntPlan:
    """The budget of a hunt in seconds, queries, or both: the hunt ends when either is spent; None is no limit.

    `seed` determines the rows.
    """

    seconds: float | None = 60.0
    queries: int | None = None
    seed: int = 1


@dataclass(frozen=True, slots=True)
class HuntTarget:
    """An implementation with its SPEC, the criterion that judges it, and the domain in which it is tested.

    `options` are options of the command line, as name and value, that replace what it declares; reports repeat them. If
    `extreme`, it is also tested with the largest and smallest numbers of the float formats, unless its domain excludes
    them.
    """

    spec: str
    implementation: Implementation
    criterion: Criterion
    domain: Domain
    options: tuple[tuple[str, str], ...] = ()
    extreme: bool = False

    @property
    def layout(self) -> Layout:
        """The columns of its rows."""
        return self.criterion.layout

    def claimed(self, rows: Rows) -> Indices:
        """Return the indices of the rows that the implementation claims to answer."""
        return claimed(rows, self.domain, self.criterion.precision, extreme=self.extreme, layout=self.layout)

    def ask(self, rows: Rows) -> Score:
        """Send these rows to the implementation; return their score."""
        answered = self.implementation.classify(rows)
        return score(rows, judge.truth_of(rows, self.layout), answered, self.criterion)


def target_of(
    spec: str,
    implementation: Implementation,
    *,
    regimes: tuple[str, ...] | None = None,
    tolerance: Fraction = DEFAULT_TOLERANCE,
    options: tuple[tuple[str, str], ...] = (),
) -> HuntTarget:
    """Return the target with the implementation's own description; `regimes`, if given, replace the declared ones.

    Raises InputError if a regime is unknown or the tolerance is negative.
    """
    used = implementation.description
    domain = used.domain if regimes is None else replace(used.domain, regimes=regimes)
    return HuntTarget(spec, implementation, Criterion(used.question, used.precision, tolerance), domain, options)


@dataclass(frozen=True, slots=True)
class HuntFinding:
    """A wrong answer with its error as judge.measured gives it, and in units u; and the place of its row.

    `source` names the stratum or the search that found the row.
    """

    case: WrongCase
    error: float
    error_u: float
    place: RowPlace
    source: str

    @classmethod
    def of(cls, case: WrongCase, criterion: Criterion, place: RowPlace, source: str) -> HuntFinding:
        """Measure the error of a judged case, and return its finding."""
        error = judge.measured(case, criterion.question)
        return cls(case, error, judge.in_units(error, criterion.unit), place, source)

    @property
    def rank(self) -> tuple[bool, float]:
        """The sorting key of findings: beyond the tolerance or not, then the error."""
        return self.case.status is Status.WRONG, self.error


@dataclass(slots=True)
class FindingCluster:
    """Wrong answers of one kind: the worst one, and the numbers beyond and within the tolerance."""

    worst: HuntFinding
    beyond: int = 0
    tolerated: int = 0


ClusterKey = tuple[Mistake, int, str]
"""The kind of a wrong answer: the mistake, the truth, and the kind of the row's place."""


@dataclass
class Hunt:
    """The state of a hunt.

    `clusters` are the wrong answers found, by kind. `counts` are rows by status; a tolerated answer counts as wrong.
    `unanswered` is the first case of each status without a valid answer. `piece` is the number of rows to send next.
    `nothing_in_domain` says that the implementation claims no row of a whole round of strata.
    """

    target: HuntTarget
    plan: HuntPlan
    clusters: dict[ClusterKey, FindingCluster] = field(default_factory=dict)
    started: float = field(default_factory=time.monotonic)
    counts: Counter[str] = field(default_factory=Counter)
    unanswered: dict[Status, UnansweredCase] = field(default_factory=dict)
    piece: int = math.isqrt(PIECE)
    nothing_in_domain: bool = False

    @property
    def asked(self) -> int:
        """The number of rows tested so far."""
        return self.counts.total()

    @property
    def answered(self) -> int:
        """The number of rows with an answer, "cannot say" included."""
        return sum(self.counts[status.value] for status in _ANSWERED)

    @property
    def seconds(self) -> float:
        """The seconds since the start."""
        return time.monotonic() - self.started

    @property
    def spent(self) -> float:
        """The part of the budget that is spent, at most 1."""
        queries = self.asked / self.plan.queries if self.plan.queries else 0.0
        time_gone = self.seconds / self.plan.seconds if self.plan.seconds else 0.0
        return min(1.0, max(queries, time_gone))

    @property
    def over(self) -> bool:
        """Whether the budget is spent, the domain has no row, or the implementation was given up."""
        return self.spent >= 1 or self.nothing_in_domain or Status.NOT_RUN in self.unanswered

    def worst_first(self) -> list[FindingCluster]:
        """Return the clusters with an answer beyond the tolerance, the worst first."""
        beyond = [cluster for cluster in self.clusters.values() if cluster.beyond]
        return sorted(beyond, key=lambda cluster: cluster.worst.rank, reverse=True)

    def add(self, cases: Iterable[WrongCase], source: str) -> None:
        """Add judged cases that the stratum or search `source` found."""
        for case in cases:
            place = place_of_row(case.row, self.target.layout)
            key = (case.mistake, case.truth, place.kind)
            cluster = self.clusters.get(key)
            if cluster is None or _may_be_worse(case, cluster.worst.case):
                finding = HuntFinding.of(case, self.target.criterion, place, source)
                if cluster is None:
                    cluster = self.clusters[key] = FindingCluster(finding)
                elif finding.rank > cluster.worst.rank:
                    cluster.worst = finding
            if case.status is Status.WRONG:
                cluster.beyond += 1
            else:
                cluster.tolerated += 1

    def ask(self, rows: Rows, ladders: Integers | None = None) -> list[WrongCase]:
        """Test the rows that the target claims, and return the wrong answers. Their `index` is the place in `rows`.

        With `ladders`, the number of each row's ladder, (n,), only the last wrong answer of each ladder is judged and
        returned.
        """
        places = self.target.claimed(rows)
        if self.plan.queries is not None:
            places = places[: self.plan.queries - self.asked]
        pieces = list(self._pieces(rows, places))
        wrong = [part[scored.wrong] for part, scored in pieces]
        if ladders is not None:
            last = {int(ladders[place]): place for some in wrong for place in some.tolist()}
            wrong = [some[np.isin(some, list(last.values()))] for some in wrong]
        return [
            replace(case, index=int(part[case.index]))
            for (part, scored), some in zip(pieces, wrong, strict=True)
            for case in scored.judged(np.searchsorted(part, some))
        ]

    def _pieces(self, rows: Rows, places: Indices) -> Iterator[tuple[Indices, Score]]:
        """Test the rows at these places, a piece at a time, until the budget is spent; yield each with its score."""
        start = 0
        while start < len(places) and not self.over:
            part = places[start : start + self.piece]
            start += len(part)
            began = time.monotonic()
            scored = self.target.ask(rows[part])
            slow = time.monotonic() - began > PIECE_SECONDS
            self.piece = max(1, self.piece // 2) if slow else min(PIECE, 2 * self.piece)
            for index, reason in scored.reasons.items():
                status = STATUSES[scored.status[index]]
                if status not in self.unanswered:
                    row, place = scored.rows[index].tolist(), (1, self.asked + index)
                    self.unanswered[status] = unanswered_case(
                        row, scored.status[index], reason, place, "", self.target.layout
                    )
            self.counts.update(counts_of(scored.status))
            yield part, scored


def _may_be_worse(case: WrongCase, worst: WrongCase) -> bool:
    """Return whether a case may be worse than the worst so far; only then is its error measured."""
    return (case.status is Status.WRONG, case.exponent) >= (worst.status is Status.WRONG, worst.exponent)


def hunt_lines(run: Hunt, most: int) -> Iterator[str]:
    """Yield the report of a hunt: at most `most` kinds of wrong answers in full, the worst first."""
    clusters = run.worst_first()
    beyond = sum(cluster.beyond for cluster in clusters)
    tolerated = sum(cluster.tolerated for cluster in run.clusters.values())
    tolerance = float(run.target.criterion.tolerance)
    wrong, abstained = run.counts[Status.WRONG.value], run.counts[Status.ABSTAINED.value]
    count_text = f"{counted(run.asked, 'row')} asked in {run.seconds:.1f} s, seed {run.plan.seed}"
    yield f"{name_of_target(run.target)}: {count_text}"
    judged = f"; of those that were judged, {beyond:,} by more than {tolerance:g} u and {tolerated:,} by less"
    if run.answered:
        yield f"{_answers(wrong)} wrong{judged if wrong else ''}"
    else:
        yield "no row was answered, so no answer was judged"
    if abstained:
        yield f'{_answers(abstained)} "cannot say"'
    if clusters:
        yield f"kinds of wrong answers: {len(clusters)}, the worst first"
    for number, cluster in enumerate(clusters[:most], start=1):
        yield ""
        yield from _cluster_lines(number, cluster, run.target)
    if len(clusters) > most:
        yield ""
        more = counted(len(clusters) - most, "more kind")
        yield f"and {more}, the worst of them {how_wrong(clusters[most].worst)}; --show shows more"
    for status, fault in run.unanswered.items():
        yield ""
        yield f"{status.value}: {counted(run.counts[status.value], 'row')}; the first: {fault.reason}"
        if status is not Status.NOT_RUN:
            yield titled("row", _row(row_of(fault), run.target))


def _answers(number: int) -> str:
    """Return the number of answers with the verb: "1 answer was", "2 answers were"."""
    return f"{counted(number, 'answer')} {'was' if number == 1 else 'were'}"


def _cluster_lines(number: int, cluster: FindingCluster, target: HuntTarget) -> Iterator[str]:
    """Yield the lines about one kind of wrong answers."""
    worst = cluster.worst
    yield f"{number}. {worst.case.mistake.value}, {how_wrong(worst)}, {worst.place.words}"
    yield from finding_lines(worst, target)
    tolerated = f", and {cluster.tolerated:,} within tolerance" if cluster.tolerated else ""
    times = "once" if cluster.beyond == 1 else f"{cluster.beyond:,} times"
    yield titled("found", f"{times}{tolerated}; the worst from {worst.source}")
    yield titled("simplify", _command(target, "minimise", target.spec, decimals_of(worst.case.row)))


def finding_lines(finding: HuntFinding, target: HuntTarget) -> Iterator[str]:
    """Yield the lines about a finding: its row, the truth beside the answer, and the command that replays it."""
    case = finding.case
    question = target.criterion.question
    truth, answer = judge.truth_in_words(case.truth, question), judge.in_words(case.answer, question)
    yield titled("row", _row(case.row, target))
    yield titled("hex", ",".join(map(hex_of, case.row)))
    yield titled("truth", f"{truth}; answered: {answer} ({case.mistake.value}, wrong by {how_wrong(finding)})")
    if case.time is not None:
        lower, upper = first_contact(case.row)
        yield titled("time", f"answered: {case.time!r}; first contact between {lower!r} and {upper!r}")
    yield titled("replay", _command(target, "replay", decimals_of(case.row), target.spec))


def _command(target: HuntTarget, *words: str) -> str:
    """Return the start of a command about the target, with the options that opened it."""
    options = [
        part for name, value in target.options if words[0] != "replay" or name != "--regimes" for part in (name, value)
    ]
    return shlex.join(("hypcheck", *words, *options))


def _row(row: Sequence[float], target: HuntTarget) -> str:
    """Return the text of a row: its numbers, and the names of its columns."""
    return f"{decimals_of(row)}  ({', '.join(target.layout.columns(len(row)))})"


def how_wrong(finding: HuntFinding) -> str:
    """Return the text of a finding's error: in units u; for a wrong time, in spheroid radii of the sweep."""
    if finding.case.time is not None:
        return f"{finding.error:.3g} spheroid radii"
    if finding.error_u == math.inf:
        return "inf u (no change of the inputs makes it right)" if finding.error == math.inf else "inf u"
    return f"{finding.error_u:.3g} u"


def name_of_target(target: HuntTarget) -> str:
    """Return the text that names the implementation, the question and the precision."""
    return f"{target.implementation.description.name} ({target.criterion.question}, {target.criterion.precision})"


def titled(title: str, line: str) -> str:
    """Return a line of a finding that begins with its title."""
    return f"   {title:9} {line}"
