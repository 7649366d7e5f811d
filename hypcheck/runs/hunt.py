"""A hunt: its plan, the rows that were asked, and the wrong answers found, grouped by the surfaces they lie on.

Where a row stands, in words: which of the surfaces that arguments trip over it is on, or next to.

a = α/b, c = γ/d, r and z are the centre's distances from the axis and from the waist's plane in spheroid radii, and
c1, c2, Δ belong to the cubic g (docs/mathematics.md).

A hunt: what is hunted and for how long, how rows are asked, and which wrong answers were found.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.geometry.rows import Indices, Rows
from hypcheck.implementations.description import Domain, claimed
from hypcheck.implementations.implementation import Implementation
from hypcheck.runs import judge
from hypcheck.runs.judge import DEFAULT_TOLERANCE, Criterion, Mistake, Status, WrongCase
from hypcheck.runs.score import Score, score
from hypcheck.runs.tally import STATUSES, UnansweredCase, counts_of
from hypcheck.truth import exact
from hypcheck.truth.exact import Cubic, Decision
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.draw import Integers

NEAR = Fraction(1, 64)
"""Relative to the lengths at hand, what counts as next to a surface."""

RING_NEAR, RING_CLEAR = 1 / 8, 1 / 256
"""In spheroid radii, what counts as next to the ring, where that is clear enough not to be a border of contact too."""

LONG = 2.0**17
"""A ratio α/b or γ/d beyond this, or below 1/LONG, is a long one."""

OPEN = "no special place"
RING = "the ring"

_OTHER_DOUBLE_ROOTS = (
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_CUSP,
)


@dataclass(frozen=True, slots=True)
class RowPlace:
    """Where a row stands, for three purposes.

    `kind` is the surface that explains most, by which findings are told apart; `words` name every surface; `cause` is
    the same for rows that fail alike: a special surface, or else the regime.
    """

    kind: str
    words: str
    cause: str


def place_of(pair: Pair) -> RowPlace:
    """The place of a pair."""
    lengths = pair.lengths
    special = [*_double_roots(lengths, exact.decide(lengths)), *_coefficients(exact.cubic(lengths))]
    regimes = list(_regimes(lengths))
    planes = [] if special and special[0][0] == RING else _planes(lengths)
    named = [*special, *_borders(lengths), *regimes, *planes] or [(OPEN, OPEN)]
    cause = special[0][0] if special else " and ".join(name for name, _ in regimes)
    return RowPlace(named[0][0], ", ".join(words for _, words in named), cause.removeprefix("next to "))


def _double_roots(lengths: Lengths, decision: Decision) -> Iterator[tuple[str, str]]:
    if decision.kind is Kind.EXTERIOR_RING:
        yield RING, "z = 0 and Δ = 0 (the ring)"
    elif decision.position is Position.EXTERIOR and (off := _off_the_ring(lengths)) is not None:
        yield f"next to {RING}", f"{off:.1e} radii from the ring"
    elif decision.tangent:
        yield "exactly tangent", f"exactly tangent ({decision.kind.value})"
    elif decision.kind in _OTHER_DOUBLE_ROOTS:
        yield "Δ = 0 without a tangency", f"Δ = 0 without a tangency ({decision.kind.value})"


def _coefficients(g: Cubic) -> Iterator[tuple[str, str]]:
    if g.n1 == 0:
        yield "c1 = 0", "c1 = 0"
    if g.n2 == 0:
        yield "c2 = 0", "c2 = 0"


def _borders(lengths: Lengths) -> Iterator[tuple[str, str]]:
    throat = Fraction(lengths.alpha - lengths.b, lengths.b)
    if abs(throat) <= NEAR:
        yield "a = 1", _at_or_near("a", "1", throat, "a − 1")
    groove = Fraction(lengths.gamma**2 * lengths.b, lengths.d**2 * lengths.alpha) - 1
    if abs(groove) <= NEAR:
        yield "c² = a", _at_or_near("c²", "a", groove, "c²/a − 1")
    for name, ratio in (("a", _a(lengths)), ("c", _c(lengths))):
        if not 1 / LONG <= ratio <= LONG:
            yield "a long ratio", f"{name} = {ratio:.1e}"


def _regimes(lengths: Lengths) -> Iterator[tuple[str, str]]:
    if lengths.gamma**2 * lengths.b < lengths.d**2 * lengths.alpha:
        yield "c² < a", "c² < a"
    if lengths.alpha < lengths.b:
        yield "a < 1", "a < 1"


def _planes(lengths: Lengths) -> Iterator[tuple[str, str]]:
    r = Fraction(math.isqrt((lengths.x**2 + lengths.y**2) << 128), lengths.b << 64)
    if r <= NEAR and r * lengths.b <= NEAR * lengths.alpha:
        yield "r = 0", _at_or_near("r", "0", r, "r")
    z = Fraction(abs(lengths.z), lengths.d)
    if z <= NEAR and z * lengths.d <= NEAR * lengths.gamma:
        yield "z = 0", _at_or_near("z", "0", z, "z")


def _off_the_ring(lengths: Lengths) -> float | None:
    """About how far the centre is from the circle z = 0, r² = (c² + 1)(a² + c²)/c², in radii; None where not near."""
    a, c = _a(lengths), _c(lengths)
    if not a < c * c < math.inf:
        return None
    radius = math.sqrt(c * c + 1) * math.hypot(a / c, 1)
    clearance = (c - a / c) ** 2 / (radius + a + 1)
    r = math.hypot(_ratio(lengths.x, lengths.b), _ratio(lengths.y, lengths.b))
    off = math.hypot(r - radius, _ratio(lengths.z, lengths.d))
    return off if clearance >= RING_CLEAR and off <= min(RING_NEAR, clearance / 2) else None


def _at_or_near(name: str, value: str, off: Fraction, what: str) -> str:
    return f"{name} = {value}" if off == 0 else f"{name} ≈ {value} ({what} = {float(off):.1e})"


def _a(lengths: Lengths) -> float:
    return _ratio(lengths.alpha, lengths.b)


def _c(lengths: Lengths) -> float:
    return _ratio(lengths.gamma, lengths.d)


def _ratio(top: int, bottom: int) -> float:
    try:
        return abs(top) / bottom
    except OverflowError:
        return math.inf


PIECE = 4096
"""Rows between two looks at the clock, at most; it begins with the square root of that."""

PIECE_SECONDS = 0.5
"""The seconds that a piece may take before the next ones are made smaller."""

_ANSWERED = (Status.RIGHT, Status.WRONG, Status.ABSTAINED)


@dataclass(frozen=True, slots=True)
class HuntPlan:
    """How long to hunt: seconds, queries, or whichever ends first; None is no limit. `seed` fixes all the rest."""

    seconds: float | None = 60.0
    queries: int | None = None
    seed: int = 1


@dataclass(frozen=True, slots=True)
class HuntTarget:
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
        return score(rows, judge.exact_positions(rows), answered, self.criterion)


def target_of(
    spec: str,
    implementation: Implementation,
    *,
    regimes: tuple[str, ...] | None = None,
    tolerance: Fraction = DEFAULT_TOLERANCE,
    options: tuple[tuple[str, str], ...] = (),
) -> HuntTarget:
    """The implementation as it describes itself; `regimes`, where given, stand for those it declares.

    Raises InputError where a regime is unknown or the tolerance negative.
    """
    said = implementation.description
    domain = said.domain if regimes is None else replace(said.domain, regimes=regimes)
    return HuntTarget(spec, implementation, Criterion(said.question, said.precision, tolerance), domain, options)


@dataclass(frozen=True, slots=True)
class HuntFinding:
    """A wrong answer, how far off it is (`error`, and in units u), where it stands, and what came upon it."""

    case: WrongCase
    error: float
    error_u: float
    place: RowPlace
    source: str


@dataclass(slots=True)
class FindingCluster:
    """Wrong answers of one kind: how many were met, beyond tolerance and within it, and the worst."""

    worst: HuntFinding
    beyond: int = 0
    tolerated: int = 0


ClusterKey = tuple[Mistake, Position, str]
"""What tells kinds of wrong answers apart: the mistake, the truth, and the kind of place."""


@dataclass(slots=True)
class HuntFindings:
    """All clusters of a hunt."""

    criterion: Criterion
    clusters: dict[ClusterKey, FindingCluster] = field(default_factory=dict)

    def add(self, cases: Iterable[WrongCase], source: str) -> None:
        """Take in judged cases that one stratum or one search came upon."""
        for case in cases:
            place = place_of(Pair.from_row(case.row))
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
        """The clusters with an answer beyond tolerance, the worst first."""
        beyond = [cluster for cluster in self.clusters.values() if cluster.beyond]
        return sorted(beyond, key=lambda cluster: finding_rank(cluster.worst), reverse=True)


def measured_finding(case: WrongCase, criterion: Criterion, place: RowPlace, source: str) -> HuntFinding:
    """The finding of a judged case."""
    error = judge.measured(case, criterion.question)
    return HuntFinding(case, error, judge.in_units(error, criterion.unit), place, source)


def finding_rank(finding: HuntFinding) -> tuple[bool, float]:
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
        return self.spent >= 1 or self.barren or Status.NOT_RUN in self.unanswered


def ask_rows(run: Hunt, rows: Rows, ladders: Integers | None = None) -> list[WrongCase]:
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
            if status not in run.unanswered:
                row = tuple(scored.rows[index].tolist())
                run.unanswered[status] = UnansweredCase((1, run.asked + index), "", row, status.value, reason)
        run.counts.update(counts_of(scored.status))
        yield part, scored
