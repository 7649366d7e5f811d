"""Causes about every row of upright spheroids: a sign or a term wrong in a formula, a column taken for another.

Each is a whole rule. Rules about what is asked are answered exactly after what their sentence says was done to the row.
Rules about a formula are evaluated in float64 and, where most of their answers agree with the ones given, in whole
numbers at the rows where they do not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from hypcheck.geometry.pair import COLUMNS, REFUSED, TILTED_COLUMNS
from hypcheck.geometry.rows import Floats, Rows
from hypcheck.kernel.classify import classify
from hypcheck.runs.causes import SILENT, Answers, Asked, Cause, Rule, Standing

_MOSTLY = 0.5
"""A formula is evaluated exactly, too, where it gives this share of the wrong answers in float64."""

Number = Any
"""An array of float64, or of Python's integers."""


@dataclass(frozen=True)
class SlipLengths:
    """The seven columns, float64 or whole numbers in a radial and an axial unit, on which no position depends."""

    alpha: Number
    gamma: Number
    b: Number
    d: Number
    x: Number
    y: Number
    z: Number


@dataclass(frozen=True)
class Terms:
    """A, B, P, Q and 1 of the cubic, all times U = b² d², so that they are whole where the lengths are."""

    A: Number
    B: Number
    P: Number
    Q: Number
    U: Number

    @classmethod
    def of(cls, of: SlipLengths) -> Terms:
        """Those of the paper."""
        bb, dd = of.b * of.b, of.d * of.d
        return cls(of.alpha**2 * dd, of.gamma**2 * bb, (of.x**2 + of.y**2) * dd, of.z**2 * bb, bb * dd)


def _in_floats(rows: Rows) -> SlipLengths:
    """The rows, with b and d as the two units."""
    alpha, gamma, b, d, x, y, z = rows.T
    one = np.ones(len(rows))
    return SlipLengths(alpha / b, gamma / d, one, one, x / b, y / b, z / d)


def _in_whole_numbers(rows: Rows) -> SlipLengths:
    columns: list[Any] = [None] * len(COLUMNS)
    for group in ((0, 2, 4, 5), (1, 3, 6)):
        mantissas, exponents = np.frexp(rows[:, group])
        least = np.where(mantissas == 0, 4000, exponents).min(axis=1, keepdims=True)
        shift = np.where(mantissas == 0, 0, exponents - least).astype(object)
        whole = np.ldexp(mantissas, 53).astype(np.int64).astype(object) << shift
        for place, column in enumerate(group):
            columns[column] = whole[:, place]
    return SlipLengths(*columns)


def _c0(t: Terms) -> Number:
    return -t.A * t.B * t.U


def _c1(t: Terms) -> Number:
    return -t.A * t.B + t.U * (t.A - t.B) + t.B * t.P - t.A * t.Q


def _c2(t: Terms) -> Number:
    return t.A - t.B + t.U - t.P - t.Q


def _all_positive(c1: Number, c2: Number) -> Number:
    return (c2 < 0) & (c1 > 0)


@dataclass(frozen=True, slots=True)
class SlippedRule:
    """The coefficient rule for all regimes, with one of its parts replaced.

    `delta` are the factors of the five terms of equation (13).
    """

    terms: Callable[[SlipLengths], Terms] = Terms.of
    c0: Callable[[Terms], Number] = _c0
    c1: Callable[[Terms], Number] = _c1
    c2: Callable[[Terms], Number] = _c2
    delta: tuple[int, int, int, int, int] = (-4, 1, 18, -4, -27)
    positive: Callable[[Number, Number], Number] = _all_positive
    groove: bool = True
    throat: bool = True
    ring: bool = True

    def positions(self, of: SlipLengths) -> Answers:
        """The positions, int8 (n,)."""
        with np.errstate(all="ignore"):
            t = self.terms(of)
            c0, c1, c2 = self.c0(t), self.c1(t), self.c2(t)
            parts = (c2**3 * c0, c2**2 * c1**2, c2 * c1 * c0, c1**3, c0**2)
            distinct = sum(factor * part for factor, part in zip(self.delta, parts, strict=True)) > 0
            positive, at_B = self.positive(c1, c2), 3 * t.B * t.B + 2 * c2 * t.B + c1
            exterior, interior = distinct & positive, distinct & ~positive
            if self.groove:
                exterior = exterior & ~((c2 < -3 * t.B) & (at_B > 0))
            if self.ring:
                exterior = exterior | ((t.Q == 0) & (at_B == 0) & (t.A * t.U < t.B * t.B))
            if self.throat:
                interior = interior & (c2 < 3 * t.A) & (3 * t.A * t.A - 2 * c2 * t.A + c1 > 0)
            return np.where(exterior, 1, np.where(interior, -1, 0)).astype(np.int8)

    def __call__(self, asked: Asked) -> Answers:
        """The rule's answers: in float64, or exactly where that gives the answer given and float64 does not."""
        answers = asked.said(self.positions(_in_floats(asked.rows)))
        others, wrong = np.flatnonzero(answers != asked.given), asked.given != asked.said(asked.truth)
        if (answers == asked.given)[wrong].sum() < _MOSTLY * wrong.sum():
            return answers
        if len(others):
            part = Asked(asked.rows[others], asked.truth[others], asked.given[others], asked.criterion)
            answers[others] = part.said(self.positions(_in_whole_numbers(part.rows)))
        return answers


_RIGHT = {"c0": _c0, "c1": _c1, "c2": _c2}
_WRITTEN = {"c0": "c0 = −AB", "c1": "c1 = −AB + A − B + BP − AQ", "c2": "c2 = A − B + 1 − P − Q"}
_NEGATED: dict[str, dict[str, Callable[[Terms], Number]]] = {
    "c0": {"AB": lambda t: 2 * t.A * t.B * t.U},
    "c1": {
        "AB": lambda t: 2 * t.A * t.B,
        "A": lambda t: -2 * t.A * t.U,
        "B": lambda t: 2 * t.B * t.U,
        "BP": lambda t: -2 * t.B * t.P,
        "AQ": lambda t: 2 * t.A * t.Q,
    },
    "c2": {
        "A": lambda t: -2 * t.A,
        "B": lambda t: 2 * t.B,
        "1": lambda t: -2 * t.U,
        "P": lambda t: 2 * t.P,
        "Q": lambda t: 2 * t.Q,
    },
}
"""What turns the sign of each term of a coefficient; half of it takes the term away."""


def _changed(name: str, change: Callable[[Terms], Number], part: int) -> SlippedRule:
    """The formula with this coefficient changed, by all of the change or, where `part` is 2, by half of it."""

    def coefficient(t: Terms) -> Number:
        whole = change(t)
        return _RIGHT[name](t) + (whole if part == 1 else _half(whole))

    if name == "c0":
        return SlippedRule(c0=coefficient)
    return SlippedRule(c1=coefficient) if name == "c1" else SlippedRule(c2=coefficient)


def _half(value: Number) -> Number:
    return value / 2 if value.dtype == np.float64 else value // 2


def _coefficient_slips() -> Iterator[tuple[str, str, str, Rule]]:
    """Names, sentences, remedies and rules of formulas with a sign or a term of a coefficient wrong."""
    for name, terms in _NEGATED.items():
        for term, change in terms.items():
            sentence = f"it answers as if the sign of {term} in {name} were wrong"
            yield f"{name}-sign-{term}", sentence, _WRITTEN[name], _changed(name, change, 1)
            if name != "c0":
                sentence = f"it answers as if {name} lacked the term {term}"
                yield f"{name}-without-{term}", sentence, _WRITTEN[name], _changed(name, change, 2)


_POWERS = ("c2³ c0", "c2² c1²", "c2 c1 c0", "c1³", "c0²")


def _discriminant_slips() -> Iterator[tuple[str, str, str, Rule]]:
    """The same of formulas with a term of Δ or the decision wrong."""
    delta, plain = "Δ = −4 c2³ c0 + c2² c1² + 18 c2 c1 c0 − 4 c1³ − 27 c0²", SlippedRule().delta
    for place, term in enumerate(_POWERS):
        for name, what, other in (("sign", "the sign were wrong", -plain[place]), ("without", "nothing stood", 0)):
            factors = (*plain[:place], other, *plain[place + 1 :])
            sentence = f"it answers as if, at the term {term} of Δ, {what}"
            yield f"delta-{name}-{place + 1}", sentence, delta, SlippedRule(delta=_five(factors))
    yield "delta-negative", "it answers as if Δ < 0 were asked for", delta, SlippedRule(delta=(4, -1, -18, 4, 27))
    right = "three roots are positive exactly if c2 < 0 and c1 > 0"
    for name, positive in (("c1", _c1_negative), ("c2", _c2_positive)):
        sentence = f"it answers as if the sign of {name} were asked for the other way"
        yield f"decision-{name}", sentence, right, SlippedRule(positive=positive)


def _c1_negative(c1: Number, c2: Number) -> Number:
    return (c2 < 0) & (c1 < 0)


def _c2_positive(c1: Number, c2: Number) -> Number:
    return (c2 > 0) & (c1 > 0)


def _terms(**changed: Callable[[SlipLengths], Number]) -> SlippedRule:
    """The formula with some of A, B, P, Q (times b² d²) computed otherwise."""
    return SlippedRule(
        terms=lambda of: replace(Terms.of(of), **{name: compute(of) for name, compute in changed.items()})
    )


_TERMS: tuple[tuple[str, str, str, Rule], ...] = (
    ("A-not-squared", "it answers as if A were α/b", "A = (α/b)²", _terms(A=lambda of: of.alpha * of.b * of.d**2)),
    ("B-not-squared", "it answers as if B were γ/d", "B = (γ/d)²", _terms(B=lambda of: of.gamma * of.d * of.b**2)),
    ("Q-not-squared", "it answers as if Q were |z|/d", "Q = (z/d)²", _terms(Q=lambda of: abs(of.z) * of.d * of.b**2)),
    (
        "P-not-squared",
        "it answers as if P were (|x| + |y|)/b",
        "P = (x² + y²)/b²",
        _terms(P=lambda of: (abs(of.x) + abs(of.y)) * of.b * of.d**2),
    ),
)


def _five(factors: tuple[int, ...]) -> tuple[int, int, int, int, int]:
    first, second, third, fourth, fifth = factors
    return first, second, third, fourth, fifth


@dataclass(frozen=True, slots=True)
class Changed:
    """The exact answers to other rows than those asked."""

    change: Callable[[Rows], Rows]

    def __call__(self, asked: Asked) -> Answers:
        """The answers; SILENT where the changed row is none."""
        with np.errstate(all="ignore"):
            rows = self.change(asked.rows.copy())
        positions = classify(np.ascontiguousarray(rows), on_invalid="flag")
        return asked.said(np.where(positions == REFUSED, SILENT, positions).astype(np.int8))


def put(**columns: Callable[[dict[str, Floats]], Floats]) -> Changed:
    """The rows with some columns computed from all columns."""

    def change(rows: Rows) -> Rows:
        names = TILTED_COLUMNS[: rows.shape[1]]
        before = dict(zip(names, rows.copy().T, strict=True))
        for name, compute in columns.items():
            rows[:, names.index(name)] = compute(before)
        return rows

    return Changed(change)


def swapped(first: str, second: str) -> Changed:
    """The rows with two columns exchanged."""
    return put(**{first: lambda c: c[second], second: lambda c: c[first]})


def _ignored(name: str) -> Changed:
    return put(**{name: lambda c: 0 * c[name]})


_AS_ASKED = "read the columns as alpha, gamma, b, d, x, y, z"

_ROWS: tuple[tuple[str, str, str, Rule], ...] = (
    ("alpha-gamma", "it answers as if α and γ changed places", _AS_ASKED, swapped("alpha", "gamma")),
    ("b-d", "it answers as if b and d changed places", _AS_ASKED, swapped("b", "d")),
    ("alpha-b", "it answers as if α and b changed places", _AS_ASKED, swapped("alpha", "b")),
    ("gamma-d", "it answers as if γ and d changed places", _AS_ASKED, swapped("gamma", "d")),
    ("x-z", "it answers as if x and z changed places", "the axis of the hyperboloid is z", swapped("x", "z")),
    ("y-z", "it answers as if y and z changed places", "the axis of the hyperboloid is z", swapped("y", "z")),
    ("x-ignored", "it answers as if x were 0", "r² = x² + y²", _ignored("x")),
    ("y-ignored", "it answers as if y were 0", "r² = x² + y²", _ignored("y")),
    ("z-ignored", "it answers as if z were 0", "Q = (z/d)²", _ignored("z")),
    ("x-for-y", "it answers as if y were x", "r² = x² + y²", put(y=lambda c: c["x"])),
    (
        "city-block",
        "it answers as if r were |x| + |y|",
        "r² = x² + y²",
        put(x=lambda c: np.abs(c["x"]) + np.abs(c["y"]), y=lambda c: 0 * c["y"]),
    ),
    (
        "chessboard",
        "it answers as if r were the larger of |x| and |y|",
        "r² = x² + y²",
        put(x=lambda c: np.maximum(np.abs(c["x"]), np.abs(c["y"])), y=lambda c: 0 * c["y"]),
    ),
    ("z-below", "it answers as if a negative z were 0", "Q = (z/d)²", put(z=lambda c: np.maximum(c["z"], 0))),
    ("x-below", "it answers as if a negative x were 0", "r² = x² + y²", put(x=lambda c: np.maximum(c["x"], 0))),
    (
        "z-from-the-bottom",
        "it answers as if z were measured from −γ",
        "z is measured from the waist",
        put(z=lambda c: c["z"] - c["gamma"]),
    ),
    ("ball-of-b", "it answers for a ball of radius b", "d is the semi-axis along z", put(d=lambda c: c["b"])),
    ("ball-of-d", "it answers for a ball of radius d", "b is the semi-axis across z", put(b=lambda c: c["d"])),
    (
        "ball-around",
        "it answers for the smallest ball around the spheroid",
        "scale x and y by b, z by d",
        put(b=lambda c: np.maximum(c["b"], c["d"]), d=lambda c: np.maximum(c["b"], c["d"])),
    ),
    (
        "ball-within",
        "it answers for the largest ball in the spheroid",
        "scale x and y by b, z by d",
        put(b=lambda c: np.minimum(c["b"], c["d"]), d=lambda c: np.minimum(c["b"], c["d"])),
    ),
    (
        "half-spheroid",
        "it answers as if b and d were diameters",
        "b and d are semi-axes",
        put(b=lambda c: c["b"] / 2, d=lambda c: c["d"] / 2),
    ),
    (
        "double-spheroid",
        "it answers as if b and d were half the semi-axes",
        "b and d are semi-axes",
        put(b=lambda c: c["b"] * 2, d=lambda c: c["d"] * 2),
    ),
    (
        "half-waist",
        "it answers as if α were the waist's diameter",
        "α is the waist's radius",
        put(alpha=lambda c: c["alpha"] / 2),
    ),
    ("gamma-is-alpha", "it answers as if γ were α", "B = (γ/d)²", put(gamma=lambda c: c["alpha"])),
    (
        "input-in-float32",
        "it answers the row after each number was rounded to float32",
        "keep the row in float64",
        Changed(lambda rows: rows.astype(np.float32).astype(np.float64)),
    ),
    (
        "input-in-float16",
        "it answers the row after each number was rounded to float16",
        "keep the row in the declared precision",
        Changed(lambda rows: rows.astype(np.float16).astype(np.float64)),
    ),
)


def always(answer: int) -> Rule:
    """One answer to every row."""

    def rule(asked: Asked) -> Answers:
        return np.full(len(asked.rows), answer, dtype=np.int8)

    return rule


def _other_side(asked: Asked) -> Answers:
    return asked.said((-asked.truth).astype(np.int8))


def _horizontally(asked: Asked) -> Answers:
    """The surface's radius at the centre's height, compared with r ± b."""
    alpha, gamma, b, _, x, y, z = asked.rows.T
    gap = np.hypot(x, y) - alpha * np.hypot(1, z / gamma)
    return asked.said(np.where(gap > b, 1, np.where(gap < -b, -1, 0)).astype(np.int8))


def _centre(asked: Asked) -> Answers:
    """The side of the centre."""
    alpha, gamma, _, _, x, y, z = asked.rows.T
    return asked.said(np.sign(np.hypot(x, y) - alpha * np.hypot(1, z / gamma)).astype(np.int8))


_SAME: tuple[tuple[str, str, str, Rule], ...] = (
    ("always-0", "it answers 0 whatever the row", "let the answer depend on the row", always(0)),
    ("always-1", "it answers 1 whatever the row", "let the answer depend on the row", always(1)),
    ("always-minus-1", "it answers −1 whatever the row", "let the answer depend on the row", always(-1)),
    (
        "horizontal-gap",
        "it compares the horizontal distance at the centre's height with b",
        "the wall slopes: the nearest point is at another height",
        _horizontally,
    ),
    ("centre-alone", "it tests the centre alone", "the spheroid has a size: compare with b and d", _centre),
    ("sides-exchanged", "it exchanges exterior and interior", "exterior is +1, interior −1", _other_side),
)


def causes_told(told: Iterable[tuple[str, str, str, Rule]], subject: str, standing: Standing) -> tuple[Cause, ...]:
    """Causes from their names, sentences, remedies and rules."""
    return tuple(Cause(*each, standing=standing, subject=subject) for each in told)


UPRIGHT_SLIPS = causes_told(
    (*_SAME, *_ROWS, *_TERMS, *_coefficient_slips(), *_discriminant_slips()), "upright", Standing.EVERYWHERE
)
"""The simplest first."""
