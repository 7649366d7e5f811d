"""Causes of wrong answers: each is a rule that is known to be wrong, with the rows at which it answers and its answers.

A cause explains a wrong answer only if its rule, evaluated at that row, gives the same answer (docs/causes.md).
diagnosis.py judges over a whole run whether the implementation has this rule: if the rule is wrong at rows where the
implementation is right, it has not.

This file defines a cause, rules that answer changed rows, and the numbers of the plain formula with bounds of their
rounding errors. place_causes.py has the causes that are limited to some places: on the ring, outside a regime, where
rounding decides. formula_errors.py has the causes that apply to every row: a wrong sign, a column taken for another.
sweep_causes.py has those of sweeps: a time counted from the wrong end. causes.toml has the texts of all causes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hypcheck import toml
from hypcheck.geometry.pair import COLUMNS, REFUSED, Pair, Position
from hypcheck.geometry.rows import PAIRS, Floats, Indices, Mask, Positions, Rows
from hypcheck.kernel.classify import classify
from hypcheck.kernel.emission.dialects import LANGUAGES
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion
from hypcheck.truth import exact
from hypcheck.truth.kinds import Kind

Answers = NDArray[np.int8]


SILENT = 100
"""The value that a rule returns for a row to which it does not apply."""


class Scope(IntEnum):
    """The rows to which a rule applies, in the order in which rules explain the wrong answers that are left."""

    PLACE = 0
    """The rule is wrong in exact arithmetic, in one region."""

    ROUNDING = 1
    """The rule is right in exact arithmetic; rounding makes its answer wrong."""

    EVERYWHERE = 2
    """The rule is wrong at every row. It is tried first if it explains most of the wrong answers."""


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
        """Return the rows at these indices with their truths, answers and times, as a value of their own."""
        times = None if self.times is None else self.times[places]
        rows = np.ascontiguousarray(self.rows[places])
        return AnsweredRows(rows, self.truth[places], self.given[places], self.criterion, times)

    def answers_at(self, positions: NDArray[np.int8]) -> Answers:
        """Return the right answers to the question for these positions; SILENT is unchanged."""
        answers = judge.expected(positions, self.criterion.question)
        return np.where(positions == SILENT, SILENT, answers).astype(np.int8)

    @cached_property
    def kinds(self) -> dict[int, Kind]:
        """The kinds of rows (n, 7) by index, for the rows that were decided exactly so far."""
        return {}

    def kind(self, place: int) -> Kind:
        """Return the kind of a row (7,), decided exactly."""
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
        """Return the remedy for an implementation in that language. Commands in the text can be typed as they are."""
        name = {"c++": "cpp"}.get(language.lower(), language.lower())
        command = "hypcheck emit --method exact"
        return self.remedy.replace(command, f"{command} --language {name}") if name in LANGUAGES else self.remedy

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
    """Return the cause with the texts of that name in causes.toml."""
    texts = toml.shipped("hypcheck.runs", "causes.toml")[name]
    return Cause(name=name, rule=rule, scope=scope, subject=subject, slack=slack, certain=certain, **texts)


def causes_about(subject: str, rules: Mapping[str, Rule], scope: Scope = Scope.EVERYWHERE) -> tuple[Cause, ...]:
    """Return the causes about a subject: "upright", "tilted" or "way", one for each of the rules by name."""
    return tuple(cause(name, rule, scope, subject=subject) for name, rule in rules.items())


@dataclass(frozen=True, eq=False)
class Numbers:
    """The numbers of the plain formula at rows (n, 7), in float64; values that overflow are not finite.

    A = (α/b)², B = (γ/d)², P = (x² + y²)/b² and Q = (z/d)² are the letters of the paper. c1 and c2 are coefficients of
    the cubic g, and `delta` is its discriminant Δ. `slope_at_B` is g'(B), `slope_at_minus_A` is g'(−A).
    """

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
        """Return the numbers of Table 2, and g'(B) and g'(−A), of rows (n, 7) or wider."""
        alpha, gamma, b, d, x, y, z = rows[:, : len(COLUMNS)].T
        with np.errstate(all="ignore"):
            A, B, P, Q = (alpha / b) ** 2, (gamma / d) ** 2, (x * x + y * y) / (b * b), (z / d) ** 2
            c0, c1, c2 = -A * B, -A * B + A - B + B * P - A * Q, A - B + 1 - P - Q
            delta = -4 * c2**3 * c0 + (c2 * c1) ** 2 + 18 * c2 * c1 * c0 - 4 * c1**3 - 27 * c0**2
            return cls(A, B, P, Q, c1, c2, delta, (3 * B + 2 * c2) * B + c1, (3 * A - 2 * c2) * A + c1)

    def errors(self, unit: float, *, roots: bool = False) -> tuple[Floats, Floats, Floats]:
        """Compute bounds of the errors of c0, c1 and c2 for roundings of this unit, with 8 roundings a term (ample).

        With `roots`, compute bounds of the errors of the cubic whose exact roots are the computed roots. Divided by
        powers of N, the largest of |c2|, √|c1| and ∛|c0|, the companion matrix has numbers up to 1. Its computed
        eigenvalues are the exact ones of a matrix whose numbers differ by 30 u at most, as QR of three rows leaves it.
        A coefficient is a sum of up to 6 products of up to 3 such numbers, so the error of the coefficient of λ^(3 − k)
        is at most 6 · 3 · 30 u N^k, less than 1024 u N^k.
        """
        A, B, P, Q = self.A, self.B, self.P, self.Q
        e0, e1 = 8 * unit * A * B, 12 * unit * (A * B + A + B + B * P + A * Q)
        e2 = 8 * unit * (A + B + 1 + P + Q)
        if roots:
            N = greatest_of(np.abs(self.c2), np.sqrt(np.abs(self.c1)), np.cbrt(A * B))
            e0, e1, e2 = e0 + 1024 * unit * N**3, e1 + 1024 * unit * N**2, e2 + 1024 * unit * N
        return e0, e1, e2

    def delta_error(self, unit: float, *, roots: bool = False) -> Floats:
        """Compute a bound of the error of Δ: 16 roundings a term, and the effect of the coefficients' errors."""
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
        """Return a mask (n, 3) of the signs −1, 0, +1 that a plain evaluation with roundings of this unit can give.

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
        """Mark the rows where B is nearly a double root of g, and the simple root lies below B.

        B is nearly a double root if g'(B) is at most `share` times the sum of the sizes of its terms, and if Q is at
        most `share` (1 + B + P).
        """
        with np.errstate(all="ignore"):
            size = 3 * self.B * self.B + 2 * np.abs(self.c2) * self.B + np.abs(self.c1)
            small = self.Q <= share * (1 + self.B + self.P)
            return np.asarray(small & (np.abs(self.slope_at_B) <= share * size) & (self.A < self.B**2))


def greatest_of(*values: Floats) -> Floats:
    """Return the greatest of these arrays' values at each place."""
    return np.asarray(np.max(values, axis=0))


def silent(answered: AnsweredRows) -> Answers:
    """Return SILENT for every row."""
    return np.full(len(answered.rows), SILENT, dtype=np.int8)


def always(answer: int) -> Rule:
    """Return the rule that gives this answer to every row."""
    return lambda answered: np.full(len(answered.rows), answer, dtype=np.int8)


def of_changed_rows(change: Callable[[Rows], Rows]) -> Rule:
    """Return the rule that answers the changed rows exactly; SILENT where a changed row is not valid."""

    def rule(answered: AnsweredRows) -> Answers:
        with np.errstate(all="ignore"):
            rows = change(answered.rows.copy())
        positions = classify(np.ascontiguousarray(rows), on_invalid="flag")
        return answered.answers_at(np.where(positions == REFUSED, SILENT, positions).astype(np.int8))

    return rule


def with_columns(**columns: Callable[[dict[str, Floats]], Floats]) -> Rule:
    """Return the rule that answers rows exactly after it replaced some columns by values computed from all columns."""

    def change(rows: Rows) -> Rows:
        names = PAIRS.columns(rows.shape[1])
        before = dict(zip(names, rows.copy().T, strict=True))
        for name, compute in columns.items():
            rows[:, names.index(name)] = compute(before)
        return rows

    return of_changed_rows(change)


def where_kind(candidates: Mask, answered: AnsweredRows, kind: Kind, position: Position) -> Answers:
    """Return the answer for this position at those candidates whose exact kind is this one; SILENT elsewhere."""
    positions = silent(answered)
    for place in np.flatnonzero(candidates).tolist():
        if answered.kind(place) is kind:
            positions[place] = position
    return answered.answers_at(positions)
