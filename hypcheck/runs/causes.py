"""Causes of wrong answers: each is a rule that is known to be wrong, with the rows at which it answers and its answers.

A cause explains a wrong answer only if its rule, evaluated at that row, gives the same answer (docs/causes.md).
diagnosis.py judges over a whole run whether the implementation has this rule: if the rule is wrong at rows where the
implementation is right, it has not.

This file defines a cause, and has the causes that are limited to some places: on the ring, outside a regime, where
rounding decides. formula_errors.py has the causes that apply to every row: a wrong sign, a column taken for another, an
axis that is ignored; sweep_causes.py has those of sweeps. causes.toml has the texts of all causes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import Floats, Indices, Mask, Positions, Rows
from hypcheck.implementations.domain import UNIT_ROUNDOFF
from hypcheck.kernel.emission.dialects import DIALECTS
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion
from hypcheck.truth import exact
from hypcheck.truth.kinds import Kind
from hypcheck.truth.pencil import cubic

Answers = NDArray[np.int8]

SILENT = 100
"""What a rule gives for a row about which it says nothing."""


class Scope(IntEnum):
    """The rows to which a rule applies, in the order in which rules explain the wrong answers that are left."""

    PLACE = 0
    """Wrong in exact arithmetic, in one region."""

    ROUNDING = 1
    """Right in exact arithmetic; what rounding leaves open."""

    EVERYWHERE = 2
    """Another rule altogether; asked first where it explains most wrong answers."""


@dataclass(frozen=True, eq=False)
class AnsweredRows:
    """Rows (n, 7), (n, 10) or (n, 13) with the truth (n,), the answers given (n,), and the times of hits, if any."""

    rows: Rows
    truth: Positions
    given: Answers
    criterion: Criterion
    times: Floats | None = None

    @property
    def subject(self) -> str:
        """The subject of the rows."""
        return self.criterion.layout.subject(self.rows)

    def part(self, places: Sequence[int] | Indices) -> AnsweredRows:
        """The rows at these indices with their truths, answers and times, as a value of their own."""
        times = None if self.times is None else self.times[places]
        rows = np.ascontiguousarray(self.rows[places])
        return AnsweredRows(rows, self.truth[places], self.given[places], self.criterion, times)

    def answers_at(self, positions: NDArray[np.int8]) -> Answers:
        """The right answers to the question for these positions; SILENT is unchanged."""
        answers = judge.expected(positions, self.criterion.question)
        return np.where(positions == SILENT, SILENT, answers).astype(np.int8)

    @cached_property
    def kinds(self) -> dict[int, Kind]:
        """The kinds of rows (n, 7) by index, for the rows that were decided exactly so far."""
        return {}

    def kind(self, place: int) -> Kind:
        """The kind of a row (7,), decided exactly."""
        if place not in self.kinds:
            self.kinds[place] = exact.kind_of(Pair.from_row(self.rows[place].tolist()).lengths)
        return self.kinds[place]

    @cached_property
    def numbers(self) -> Numbers:
        """The numbers of the plain formula, in float64."""
        return Numbers.of(self.rows)


Rule = Callable[[AnsweredRows], Answers]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cause:
    """A wrong rule: its name (the published id), what it does, why it is wrong, and the remedy, without a full stop.

    Tests read `remedy` as code and apply it, so its formulas use the names A, B, P, Q, c1, c2 and Δ.

    `rule` gives the cause's answers. `subject` is what its rows are about (subject_of). `claim` is the statement of the
    paper that leads to this rule, as `hypcheck derive --claim` takes it. `slack` is the number of right answers at rows
    where the rule is wrong that are allowed for each wrong answer that it explains. `certain` gives the rows at which
    an implementation with this cause cannot be right by luck, whatever the order of its operations.
    """

    name: str
    sentence: str
    why: str
    remedy: str
    rule: Rule
    scope: Scope
    subject: str = "upright"
    claim: str = ""
    slack: float = 0.02
    certain: Callable[[AnsweredRows], Mask] | None = None

    def remedy_in(self, language: str) -> str:
        """The remedy for an implementation in that language; a command in the text can be typed without changes."""
        name = {"c++": "cpp"}.get(language.lower(), language.lower())
        command = "hypcheck emit --method exact"
        return self.remedy.replace(command, f"{command} --language {name}") if name in DIALECTS else self.remedy

    @property
    def rounds(self) -> bool:
        """Whether its rule gives any answer that roundings may produce, so that no right answer contradicts it."""
        return self.scope is Scope.ROUNDING and self.subject == "upright"


def cause(
    name: str,
    rule: Rule,
    scope: Scope,
    *,
    subject: str = "upright",
    slack: float = 0.02,
    certain: Callable[[AnsweredRows], Mask] | None = None,
) -> Cause:
    """The cause with the texts of that name in causes.toml."""
    texts = toml.shipped("hypcheck.runs", "causes.toml")[name]
    return Cause(name=name, rule=rule, scope=scope, subject=subject, slack=slack, certain=certain, **texts)


@dataclass(frozen=True, eq=False)
class Numbers:
    """A, B, P, Q, c1, c2, Δ, g'(B) and g'(−A) of rows (n, 7) in float64; values that overflow are not finite."""

    A: Floats
    B: Floats
    P: Floats
    Q: Floats
    c1: Floats
    c2: Floats
    delta: Floats
    slope_at_B: Floats
    slope_at_minus_A: Floats

    @classmethod
    def of(cls, rows: Rows) -> Numbers:
        """The numbers of Table 2, and g'(B) and g'(−A), of rows (n, 7) or wider."""
        alpha, gamma, b, d, x, y, z = rows[:, : len(COLUMNS)].T
        with np.errstate(all="ignore"):
            A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
            c0, c1, c2 = -A * B, -A * B + A - B + B * P - A * Q, A - B + 1 - P - Q
            delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
            return cls(A, B, P, Q, c1, c2, delta, (3 * B + 2 * c2) * B + c1, (3 * A - 2 * c2) * A + c1)

    def errors(self, unit: float, *, roots: bool = False) -> tuple[Floats, Floats, Floats]:
        """Bounds of the errors of c0, c1 and c2 with roundings of this unit: 8 roundings a term, which is ample.

        With `roots`, bounds of the errors of the cubic whose exact roots are the computed roots. Divided by powers of
        N, the largest of |c2|, √|c1| and ∛|c0|, the companion matrix has numbers up to 1. Its computed eigenvalues are
        the exact ones of a matrix whose numbers differ by 30 u at most, as QR of three rows leaves it. A coefficient is
        a sum of up to 6 products of up to 3 such numbers, so the error of the coefficient of λ^(3 − k) is at most 6 · 3
        · 30 u N^k, less than 1024 u N^k.
        """
        A, B, P, Q = self.A, self.B, self.P, self.Q
        e0, e1 = 8 * unit * A * B, 12 * unit * (A * B + A + B + B * P + A * Q)
        e2 = 8 * unit * (A + B + 1 + P + Q)
        if roots:
            N = _greatest(np.abs(self.c2), np.sqrt(np.abs(self.c1)), np.cbrt(A * B))
            e0, e1, e2 = e0 + 1024 * unit * N**3, e1 + 1024 * unit * N**2, e2 + 1024 * unit * N
        return e0, e1, e2

    def delta_error(self, unit: float, *, roots: bool = False) -> Floats:
        """A bound of the error of Δ: 16 roundings a term, and the effect of the coefficients' errors."""
        e0, e1, e2 = self.errors(unit, roots=roots)
        m0, m1, m2 = self.A * self.B + e0, np.abs(self.c1) + e1, np.abs(self.c2) + e2
        carried = (
            (12 * m2**2 * m0 + 2 * m2 * m1**2 + 18 * m1 * m0) * e2
            + (2 * m2**2 * m1 + 18 * m2 * m0 + 12 * m1**2) * e1
            + (4 * m2**3 + 18 * m2 * m1 + 54 * m0) * e0
        )
        terms = 4 * m2**3 * m0 + m2**2 * m1**2 + 18 * m2 * m1 * m0 + 4 * m1**3 + 27 * m0**2
        return np.asarray(carried + 16 * unit * terms)

    def possible(self, unit: float, *, printed: bool = False, roots: bool = False) -> NDArray[np.bool_]:
        """A mask (n, 3) of the signs −1, 0, +1 that a plain evaluation with roundings of this unit can give.

        With `printed`, the evaluation is one of the rules of Propositions 3 and 5, which do not compare roots with the
        poles −A and B. With `roots`, it is a rule about computed roots, with or without the poles: a root at a pole can
        be on either side of it.

        The bounds are of first order, multiplied by a factor above 1, so that they cover any order of the operations.
        """
        with np.errstate(all="ignore"):
            A, B, c1, c2 = self.A, self.B, self.c1, self.c2
            e0, e1, e2 = self.errors(unit, roots=roots)
            m1, m2 = np.abs(c1) + e1, np.abs(c2) + e2
            error = self.delta_error(unit, roots=roots)
            at_B = 2 * B * e2 + e1 + 16 * unit * (3 * B * B + 2 * m2 * B + m1)
            at_A = 2 * A * e2 + e1 + 16 * unit * (3 * A * A + 2 * m2 * A + m1)
            beyond, above = c2 + 3 * B, 3 * A - c2
            positive = (c2 < e2) & (c1 > -e1)
            negative = (c2 > -e2) | (c1 < e1)
            apart, together = self.delta > -error, self.delta <= error
            below_B = (beyond > -e2 - 16 * unit * (B + m2)) | (self.slope_at_B < at_B)
            none_below = (beyond < e2 + 16 * unit * (B + m2)) & (self.slope_at_B > -at_B)
            above_A = (above > -e2 - 16 * unit * (A + m2)) & (self.slope_at_minus_A > -at_A)
            none_above = (above < e2 + 16 * unit * (A + m2)) | (self.slope_at_minus_A < at_A)
            zero = apart & negative & ((np.abs(c1) <= e1) | (np.abs(c2) <= e2))
            if roots:  # g(B) and g(−A) are sums of products without cancellation, and 0 where a pole is a root
                none_below = none_below | (B * self.Q * (A + B) <= (e2 * B + e1) * B + e0)
                none_above = none_above | (A * self.P * (A + B) <= (e2 * A + e1) * A + e0)
            contact = together | zero | (apart & ((positive & none_below) | (negative & none_above)))
            inner, outer = (negative, positive) if printed else (negative & above_A, positive & below_B)
            return np.column_stack([apart & inner, contact, apart & outer])

    def near_the_ring(self, share: float) -> Mask:
        """Whether B is nearly a double root, and the simple one lies below it: g'(B) is this share of its terms."""
        with np.errstate(all="ignore"):
            size = 3 * self.B * self.B + 2 * np.abs(self.c2) * self.B + np.abs(self.c1)
            small = self.Q <= share * (1 + self.B + self.P)
            return np.asarray(small & (np.abs(self.slope_at_B) <= share * size) & (self.A < self.B**2))


def silent(answered: AnsweredRows) -> Answers:
    """An answer to no row."""
    return np.full(len(answered.rows), SILENT, dtype=np.int8)


def where_kind(candidates: Mask, answered: AnsweredRows, kind: Kind, position: Position) -> Answers:
    """The answer for this position at the candidates of this kind, which exact arithmetic decides; SILENT elsewhere."""
    positions = silent(answered)
    for place in np.flatnonzero(candidates).tolist():
        if answered.kind(place) is kind:
            positions[place] = position
    return answered.answers_at(positions)


def _ring(answered: AnsweredRows) -> Answers:
    """Proposition 3 on the ring: Δ = 0 is contact."""
    at = (answered.truth == Position.EXTERIOR) & (answered.rows[:, 6] == 0) & answered.numbers.near_the_ring(2.0**-30)
    return where_kind(at, answered, Kind.EXTERIOR_RING, Position.CONTACT)


def _unless_rounded(answered: AnsweredRows, answers: Answers) -> Answers:
    """The answers, but SILENT where the given answer is right and may be right by rounding."""
    luck = answered.numbers.possible(2 * max(unit_of(answered), FLOAT64), printed=True)[:, 1]
    right = answered.given == answered.answers_at(answered.truth)
    return np.where(right & luck, SILENT, answers).astype(np.int8)


def _groove(answered: AnsweredRows) -> Answers:
    """Proposition 3 where c² < a: three positive roots are exterior, though all are at B or beyond."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        at = (answered.truth == Position.CONTACT) & (n.B**2 <= n.A * (1 + 2.0**-40)) & (n.c2 <= 0) & (n.c1 >= 0)
    return _unless_rounded(answered, where_kind(at, answered, Kind.CROSSING_GROOVE_TWO_CURVES, Position.EXTERIOR))


def _throat(answered: AnsweredRows) -> Answers:
    """Proposition 5 where a < 1: two negative roots are interior, though both are at −A or below."""
    at = (answered.truth == Position.CONTACT) & (answered.numbers.A < 1)
    return _unless_rounded(answered, where_kind(at, answered, Kind.CROSSING_THROAT_TWO_CURVES, Position.INTERIOR))


def _zero_coefficient(answered: AnsweredRows) -> Answers:
    """Proposition 5 where c1 or c2 is 0: not interior."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        small = (np.abs(n.c1) <= 2.0**-40 * (1 + n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q)) | (
            np.abs(n.c2) <= 2.0**-40 * (1 + n.A + n.B + n.P + n.Q)
        )

    positions = silent(answered)
    for place in np.flatnonzero((answered.truth == Position.INTERIOR) & small).tolist():
        g = cubic(Pair.from_row(answered.rows[place].tolist()).lengths)
        if g.n1 == 0 or g.n2 == 0:
            positions[place] = Position.CONTACT
    return answered.answers_at(positions)


def _coefficients_are_exact(answered: AnsweredRows) -> Mask:
    """The rows where c1 and c2 are computed without a rounding, whatever the order of operations (_on_a_grid)."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        size = n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q
        return _on_a_grid(answered, 16 * (1 + size), 4)


def _delta_is_exact(answered: AnsweredRows) -> Mask:
    """The rows where Δ is computed without a rounding, whatever the order of operations and the form of Δ."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        m0, m1, m2 = n.A * n.B, n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q, 1 + n.A + n.B + n.P + n.Q
        return _on_a_grid(answered, 128 * (m2**3 * m0 + m2**2 * m1**2 + m1**3 + m0**2), 12)


def _on_a_grid(answered: AnsweredRows, size: Floats, power: int) -> Mask:
    """A mask of the rows where the declared precision represents numbers up to this size exactly.

    The numbers are polynomials of degree `power` in the lengths. After a division by powers of two, the lengths are
    multiples of 1, ½, ¼ or 1/64.
    """
    alpha, gamma, b, d, x, y, z = answered.rows[:, : len(COLUMNS)].T
    lengths = np.column_stack([alpha / b, gamma / d, x / b, y / b, z / d])
    halved = (np.frexp(b)[0] == 0.5) & (np.frexp(d)[0] == 0.5)
    exactly = np.zeros(len(answered.rows), dtype=bool)
    for digits in (0, 1, 2, 6):
        on_grid = (np.ldexp(lengths, digits) % 1 == 0).all(axis=1)
        exactly |= halved & on_grid & (np.ldexp(size, power * digits) < 1 / max(unit_of(answered), FLOAT64))
    return exactly


def _tangency(kind: Kind, clear: Position) -> Rule:
    """The rule that answers a tangency of this kind with the clear position of which it is the limit."""

    def rule(answered: AnsweredRows) -> Answers:
        at = (answered.truth == Position.CONTACT) & answered.numbers.possible(2.0**-50)[:, 1]
        return where_kind(at, answered, kind, clear)

    return rule


FLOAT64 = 2.0**-53
"""The unit of float64."""


def unit_of(answered: AnsweredRows) -> float:
    """The unit u of the declared precision; 0 if no rounding is tolerated."""
    return float(UNIT_ROUNDOFF[answered.criterion.precision])


def rounded(
    answered: AnsweredRows, unit: float, at: Mask | bool = True, *, printed: bool = False, roots: bool = False
) -> Answers:
    """The given answers, at those of the rows `at` where roundings of this unit can produce them (Numbers.possible)."""
    answers = judge.expected(np.array([-1, 0, 1], dtype=np.int8), answered.criterion.question)
    possible = answered.numbers.possible(unit, printed=printed, roots=roots)
    agrees = (possible & (answers[None, :] == answered.given[:, None])).any(axis=1)
    return np.where(agrees & at, answered.given, SILENT).astype(np.int8)


def _lost_beside_the_ring(answered: AnsweredRows) -> Answers:
    """Beside the ring the rounded Δ has no reliable sign, and is taken for 0 or less."""
    at = (answered.truth == Position.EXTERIOR) & answered.numbers.near_the_ring(2.0**-12)
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64), at)


def _lost(answered: AnsweredRows) -> Answers:
    """A sign that the rounding errors of a plain evaluation can change."""
    unit = unit_of(answered)
    return rounded(answered, 2 * unit) if unit >= FLOAT64 else silent(answered)


def _lost_outside(answered: AnsweredRows) -> Answers:
    """A sign that roundings can change in the printed rules, at contacts outside the regimes of these rules."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        outside = (answered.truth == Position.CONTACT) & ((n.A < 1) | (n.B**2 < n.A))
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64), outside, printed=True)


def _lost_in_float64(answered: AnsweredRows) -> Answers:
    """A sign that float64 cannot determine, though the declared precision is higher."""
    return rounded(answered, 2 * FLOAT64) if unit_of(answered) < FLOAT64 else silent(answered)


def _half_lost(answered: AnsweredRows) -> Answers:
    """A sign that half the digits of the precision cannot determine."""
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64) ** 0.5)


_RANGES = {"float16": (-14, 16), "bfloat16": (-126, 128), "float32": (-126, 128), "float64": (-1022, 1024)}
"""The binary exponents of the least normal number and of the greatest, plus one."""


def _out_of_range(answered: AnsweredRows) -> Answers:
    """A square or a product of the plain formula overflows or underflows in the format, so that Δ has no sign."""
    if answered.criterion.precision not in _RANGES:
        return silent(answered)
    least, greatest = _RANGES[answered.criterion.precision]
    with np.errstate(all="ignore"):
        alpha, gamma, b, d, x, y, z = np.log2(np.abs(answered.rows[:, : len(COLUMNS)].T))
        r = np.maximum(x, y)
        A, B, P, Q = 2 * (alpha - b), 2 * (gamma - d), 2 * (r - b), 2 * (z - d)
        M2, M1 = _greatest(A, B, P, Q, 0 * A), _greatest(A + B, A, B, B + P, A + Q)
        squares = [2 * b, A, B, 2 * (A + B), P, Q, 2 * x, 2 * y]
        too_small = np.any([(exponent < least) & np.isfinite(exponent) for exponent in squares], axis=0)
        too_large = np.any(
            [exponent >= greatest for exponent in (*squares, 3 * M1, 3 * M2 + A + B, 2 * (M1 + M2))], axis=0
        )
    return np.where(too_small | too_large, answered.given, SILENT).astype(np.int8)


def _greatest(*values: Floats) -> Floats:
    return np.asarray(np.max(values, axis=0))


PLACES: tuple[Cause, ...] = (
    cause("ring", _ring, Scope.PLACE, slack=4, certain=_delta_is_exact),
    cause("groove", _groove, Scope.PLACE),
    cause("throat", _throat, Scope.PLACE),
    cause("zero-coefficient", _zero_coefficient, Scope.PLACE, slack=4, certain=_coefficients_are_exact),
    *(
        Cause(
            name=kind.value,
            sentence=f"it takes a tangency for clear ({kind.contact_set} in common, {kind.value})",
            why=f"{kind.description} There Δ = 0, as the roots of g are: {kind.roots}. Touching is contact",
            remedy="a tangency is contact: exterior and interior must also require: Δ > 0",
            rule=_tangency(kind, kind.limit_of),
            scope=Scope.PLACE,
        )
        for kind in Kind
        if kind.limit_of is not None
    ),
    cause("out-of-range", _out_of_range, Scope.ROUNDING),
    cause("lost-beside-the-ring", _lost_beside_the_ring, Scope.ROUNDING),
    cause("lost-to-rounding", _lost, Scope.ROUNDING),
    cause("lost-outside-the-regime", _lost_outside, Scope.ROUNDING),
)
"""The causes about places, those in exact arithmetic first."""

WIDER_ROUNDINGS: tuple[Cause, ...] = (
    cause("float64-for-more", _lost_in_float64, Scope.ROUNDING),
    cause("half-the-digits", _half_lost, Scope.ROUNDING),
)
"""Roundings of a narrower format than the declared one, which explain what no other rounding does."""
