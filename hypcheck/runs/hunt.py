"""A hunt: its plan, the rows that were asked, and the wrong answers found, grouped by the surfaces next to them.

Wrong answers are likely on a few surfaces, where an argument about the pair changes its case. In their names a = α/b,
c = γ/d; r and z are the centre's distances from the axis and from the plane of the waist, in radii of the spheroid; c1,
c2 and Δ belong to the cubic g (docs/mathematics.md).
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
from hypcheck.truth.tilted import exact as tilted_exact
from hypcheck.truth.tilted.pair import TiltedPair, pair_of
from hypcheck.vectors.draw import Integers

NEAR = Fraction(1, 64)
"""A row within this relative distance is next to a surface."""

RING_NEAR, RING_CLEAR = 1 / 8, 1 / 256
"""A row within RING_NEAR spheroid radii is next to the ring, if the ring's clearance is at least RING_CLEAR radii, so
that the ring is not a border of contact."""

LONG = 2.0**17
"""A ratio α/b or γ/d above LONG or below 1/LONG is a long ratio."""

OPEN = "no special place"
RING = "the ring"
TILTED = "a tilted spheroid"

_OTHER_DOUBLE_ROOTS = (
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_CUSP,
)


@dataclass(frozen=True, slots=True)
class RowPlace:
    """The surfaces next to a row.

    `kind` is the surface that explains most; findings are grouped by it. `words` name every surface. `cause` is equal
    for rows that fail for the same reason: a special surface, or else the regime.
    """

    kind: str
    words: str
    cause: str


def place_of(pair: Pair | TiltedPair) -> RowPlace:
    """The place of a pair."""
    if isinstance(pair, TiltedPair):
        return _tilted_place(pair)
    lengths = pair.lengths
    special = [*_double_roots(lengths, exact.decide(lengths)), *_coefficients(exact.cubic(lengths))]
    regimes = list(_regimes(lengths))
    planes = [] if special and special[0][0] == RING else _planes(lengths)
    named = [*special, *_borders(lengths), *regimes, *planes] or [(OPEN, OPEN)]
    cause = special[0][0] if special else " and ".join(name for name, _ in regimes)
    return RowPlace(named[0][0], ", ".join(words for _, words in named), cause.removeprefix("next to "))


def _tilted_place(pair: TiltedPair) -> RowPlace:
    """The place of a tilted spheroid: what is special about its axis and its centre."""
    x, y, z, axis_x, axis_y, axis_z = map(Fraction, (pair.x, pair.y, pair.z, *pair.axis))
    across, along = axis_x**2 + axis_y**2, axis_z**2
    signs = {
        "exactly tangent": tilted_exact.decide(pair.lengths).tangent,
        "a horizontal axis": along == 0,
        "a nearly upright axis": across <= NEAR**2 * along,
        "a nearly horizontal axis": 0 < along <= NEAR**2 * across,
        "the axis in the plane of the centre": (x or y) and x * axis_y == y * axis_x,
        "r = 0": not (x or y),
        "z = 0": z == 0,
    }
    named = [name for name, holds in signs.items() if holds]
    return RowPlace(next(iter(named), TILTED), ", ".join([TILTED, *named]), next(iter(named), TILTED))


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
    """The rough distance of the centre from the circle z = 0, r² = (c² + 1)(a² + c²)/c², in radii; None if not near."""
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

    def claimed(self, rows: Rows) -> Indices:
        """The indices of the rows that the implementation claims to answer."""
        return claimed(rows, self.domain, self.criterion.precision, extreme=self.extreme)

    def ask(self, rows: Rows) -> Score:
        """Ask these rows; their score."""
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
    """The target with the implementation's own description; `regimes`, if given, replace those it declares.

    Raises InputError if a regime is unknown or the tolerance is negative.
    """
    used = implementation.description
    domain = used.domain if regimes is None else replace(used.domain, regimes=regimes)
    return HuntTarget(spec, implementation, Criterion(used.question, used.precision, tolerance), domain, options)


@dataclass(frozen=True, slots=True)
class HuntFinding:
    """A wrong answer, its backward error (also in units u), the surfaces next to its row, and what found it."""

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
        for case in cases:
            place = place_of(pair_of(case.row))
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
    error = judge.measured(case, criterion.question)
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
