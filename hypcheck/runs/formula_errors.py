"""Causes about every row of positions: a sign or a term of a formula wrong, a column taken for another.

Each is a whole rule. A rule about the input changes the row as its sentence in causes.toml says, and then answers
exactly. A rule about a formula is evaluated in float64. If most of its answers agree with the given ones, it is
evaluated in whole numbers at the rows where they disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from hypcheck.geometry.pair import COLUMNS, REFUSED
from hypcheck.geometry.rows import PAIRS, Floats, Rows
from hypcheck.kernel.classify import classify
from hypcheck.runs.causes import SILENT, AnsweredRows, Answers, Cause, Rule, Scope, cause

_MOSTLY = 0.5
"""A formula is evaluated exactly, too, where it gives this share of the wrong answers in float64."""

Number = Any
"""An array of float64, or of Python's integers."""

Lengths = Mapping[str, Number]
"""The columns by name, float64 or whole numbers in a radial and an axial unit, on which no position depends."""


@dataclass(frozen=True)
class Terms:
    """A, B, P, Q and 1 of the cubic, all multiplied by U = b² d², so that whole lengths give whole numbers."""

    A: Number
    B: Number
    P: Number
    Q: Number
    U: Number

    @classmethod
    def of(cls, row: Lengths) -> Terms:
        """The terms of the paper for a row of lengths."""
        bb, dd = row["b"] ** 2, row["d"] ** 2
        squares = row["x"] ** 2 + row["y"] ** 2
        return cls(row["alpha"] ** 2 * dd, row["gamma"] ** 2 * bb, squares * dd, row["z"] ** 2 * bb, bb * dd)


def _in_floats(rows: Rows) -> Lengths:
    """The rows, with b and d as the two units."""
    alpha, gamma, b, d, x, y, z = rows.T
    one = np.ones(len(rows))
    return dict(zip(COLUMNS, (alpha / b, gamma / d, one, one, x / b, y / b, z / d), strict=True))


def _in_whole_numbers(rows: Rows) -> Lengths:
    columns: dict[str, Number] = {}
    for group in ((0, 2, 4, 5), (1, 3, 6)):
        mantissas, exponents = np.frexp(rows[:, group])
        least = np.where(mantissas == 0, 4000, exponents).min(axis=1, keepdims=True)
        shift = np.where(mantissas == 0, 0, exponents - least).astype(object)
        whole = np.ldexp(mantissas, 53).astype(np.int64).astype(object) << shift
        columns |= {COLUMNS[column]: whole[:, place] for place, column in enumerate(group)}
    return columns


_COEFFICIENTS: dict[str, dict[str, Callable[[Terms], Number]]] = {
    "c0": {"AB": lambda t: -t.A * t.B * t.U},
    "c1": {
        "AB": lambda t: -t.A * t.B,
        "A": lambda t: t.A * t.U,
        "B": lambda t: -t.B * t.U,
        "BP": lambda t: t.B * t.P,
        "AQ": lambda t: -t.A * t.Q,
    },
    "c2": {"A": lambda t: t.A, "B": lambda t: -t.B, "1": lambda t: t.U, "P": lambda t: -t.P, "Q": lambda t: -t.Q},
}
_WRITTEN = {"c0": "c0 = −AB", "c1": "c1 = −AB + A − B + BP − AQ", "c2": "c2 = A − B + 1 − P − Q"}

_DELTA = {"c2³ c0": -4, "c2² c1²": 1, "c2 c1 c0": 18, "c1³": -4, "c0²": -27}
"""The factors of the terms of Δ, equation (13)."""


@dataclass(frozen=True, slots=True)
class SlippedRule:
    """The coefficient rule for all regimes, with a part replaced.

    `factors` are the factors of terms of coefficients, by the names of the coefficient and the term; 1 unless given.
    `delta` are the factors of the terms of Δ. `signs` are the signs of c1 and c2 when all roots are positive.
    """

    terms: Callable[[Lengths], Terms] = Terms.of
    factors: Mapping[tuple[str, str], int] = field(default_factory=dict)
    delta: tuple[int, ...] = tuple(_DELTA.values())
    signs: tuple[int, int] = (1, -1)

    def positions(self, row: Lengths) -> Answers:
        """The positions, int8 (n,)."""
        with np.errstate(all="ignore"):
            t = self.terms(row)
            c0, c1, c2 = (
                sum(self.factors.get((name, term), 1) * compute(t) for term, compute in terms.items())
                for name, terms in _COEFFICIENTS.items()
            )
            parts = (c2**3 * c0, c2**2 * c1**2, c2 * c1 * c0, c1**3, c0**2)
            distinct = sum(factor * part for factor, part in zip(self.delta, parts, strict=True)) > 0
            positive = (self.signs[0] * c1 > 0) & (self.signs[1] * c2 > 0)
            at_B = 3 * t.B * t.B + 2 * c2 * t.B + c1
            ring = (t.Q == 0) & (at_B == 0) & (t.A * t.U < t.B * t.B)
            exterior = ring | (distinct & positive & ~((c2 < -3 * t.B) & (at_B > 0)))
            interior = distinct & ~positive & (c2 < 3 * t.A) & (3 * t.A * t.A - 2 * c2 * t.A + c1 > 0)
            return np.where(exterior, 1, np.where(interior, -1, 0)).astype(np.int8)

    def __call__(self, answered: AnsweredRows) -> Answers:
        """The rule's answers: from float64, or from exact arithmetic where only this gives the given answer."""
        answers = answered.answers_at(self.positions(_in_floats(answered.rows)))
        others, wrong = np.flatnonzero(answers != answered.given), answered.given != answered.answers_at(answered.truth)
        if (answers == answered.given)[wrong].sum() < _MOSTLY * wrong.sum():
            return answers
        if len(others):
            part = answered.part(others)
            answers[others] = part.answers_at(self.positions(_in_whole_numbers(part.rows)))
        return answers


def _formula_errors() -> Iterator[Cause]:
    """The causes with a wrong sign or term in a coefficient or in Δ, or with a wrong decision."""

    def slip(name: str, what: str, why: str, remedy: str, rule: Rule) -> Cause:
        sentence = f"it answers as if{what}"
        return Cause(name=name, sentence=sentence, why=why, remedy=remedy, rule=rule, scope=Scope.EVERYWHERE)

    why = "Equation (14) and Table 2 of the paper have these coefficients, which follow from the determinant of λH + S"
    for name, terms in _COEFFICIENTS.items():
        for term in terms:
            negated, left_out = (SlippedRule(factors={(name, term): factor}) for factor in (-1, 0))
            yield slip(f"{name}-sign-{term}", f" the sign of {term} in {name} were wrong", why, _WRITTEN[name], negated)
            if name != "c0":
                yield slip(f"{name}-without-{term}", f" {name} lacked the term {term}", why, _WRITTEN[name], left_out)
    right, factors = "Δ = −4 c2³ c0 + c2² c1² + 18 c2 c1 c0 − 4 c1³ − 27 c0²", tuple(_DELTA.values())
    why = "Equation (13) of the paper is the discriminant of g: it is > 0 exactly where g has three distinct real roots"
    for place, term in enumerate(_DELTA):
        for name, what, other in (("sign", "the sign were wrong", -factors[place]), ("without", "nothing stood", 0)):
            rule = SlippedRule(delta=(*factors[:place], other, *factors[place + 1 :]))
            yield slip(f"delta-{name}-{place + 1}", f", at the term {term} of Δ, {what}", why, right, rule)
    yield slip(
        "delta-negative", " Δ < 0 were asked for", why, right, SlippedRule(delta=tuple(-factor for factor in factors))
    )
    right = "three roots are positive exactly where c2 < 0 and c1 > 0"
    why = "With Δ > 0 and c0 < 0, Descartes' rule gives three positive roots exactly where c2 < 0 and c1 > 0"
    for name, signs in (("c1", (-1, -1)), ("c2", (1, 1))):
        what = f" the sign of {name} were asked for the other way"
        yield slip(f"decision-{name}", what, why, right, SlippedRule(signs=signs))


def _terms(**changed: Callable[[Lengths], Number]) -> Rule:
    """The rule of the formula with some of A, B, P, Q (times b² d²) replaced."""
    return SlippedRule(lambda row: replace(Terms.of(row), **{name: compute(row) for name, compute in changed.items()}))


def _changed(change: Callable[[Rows], Rows]) -> Rule:
    """The rule that answers the changed rows exactly; SILENT where a changed row is not valid."""

    def rule(answered: AnsweredRows) -> Answers:
        with np.errstate(all="ignore"):
            rows = change(answered.rows.copy())
        positions = classify(np.ascontiguousarray(rows), on_invalid="flag")
        return answered.answers_at(np.where(positions == REFUSED, SILENT, positions).astype(np.int8))

    return rule


def _put(**columns: Callable[[dict[str, Floats]], Floats]) -> Rule:
    """The change of rows that replaces some columns by values computed from all columns."""

    def change(rows: Rows) -> Rows:
        names = PAIRS.columns(rows.shape[1])
        before = dict(zip(names, rows.copy().T, strict=True))
        for name, compute in columns.items():
            rows[:, names.index(name)] = compute(before)
        return rows

    return _changed(change)


def _swapped(first: str, second: str) -> Rule:
    return _put(**{first: lambda c: c[second], second: lambda c: c[first]})


def _ignored(name: str) -> Rule:
    return _put(**{name: lambda c: 0 * c[name]})


def _larger(c: dict[str, Floats]) -> Floats:
    return np.maximum(c["b"], c["d"])


def _smaller(c: dict[str, Floats]) -> Floats:
    return np.minimum(c["b"], c["d"])


def always(answer: int) -> Rule:
    """The rule that gives this answer to every row."""
    return lambda answered: np.full(len(answered.rows), answer, dtype=np.int8)


def _gap(answered: AnsweredRows) -> Floats:
    """The horizontal distance of the centre from the surface at its height, negative inside."""
    alpha, gamma, _, _, x, y, z = answered.rows.T
    return np.asarray(np.hypot(x, y) - alpha * np.hypot(1, z / gamma))


def _horizontally(answered: AnsweredRows) -> Answers:
    gap, b = _gap(answered), answered.rows[:, 2]
    return answered.answers_at(np.where(gap > b, 1, np.where(gap < -b, -1, 0)).astype(np.int8))


def causes_about(subject: str, rules: Mapping[str, Rule], scope: Scope = Scope.EVERYWHERE) -> tuple[Cause, ...]:
    """The causes about a subject: "upright", "tilted" or "way", one for each of the rules by name."""
    return tuple(cause(name, rule, scope, subject=subject) for name, rule in rules.items())


UPRIGHT_FORMULA_ERRORS = (
    *causes_about(
        "upright",
        {
            "always-0": always(0),
            "always-1": always(1),
            "always-minus-1": always(-1),
            "horizontal-gap": _horizontally,
            "centre-alone": lambda answered: answered.answers_at(np.sign(_gap(answered)).astype(np.int8)),
            "sides-exchanged": lambda answered: answered.answers_at((-answered.truth).astype(np.int8)),
            "alpha-gamma": _swapped("alpha", "gamma"),
            "b-d": _swapped("b", "d"),
            "alpha-b": _swapped("alpha", "b"),
            "gamma-d": _swapped("gamma", "d"),
            "x-z": _swapped("x", "z"),
            "y-z": _swapped("y", "z"),
            "x-ignored": _ignored("x"),
            "y-ignored": _ignored("y"),
            "z-ignored": _ignored("z"),
            "x-for-y": _put(y=lambda c: c["x"]),
            "city-block": _put(x=lambda c: np.abs(c["x"]) + np.abs(c["y"]), y=lambda c: 0 * c["y"]),
            "chessboard": _put(x=lambda c: np.maximum(np.abs(c["x"]), np.abs(c["y"])), y=lambda c: 0 * c["y"]),
            "z-below": _put(z=lambda c: np.maximum(c["z"], 0)),
            "x-below": _put(x=lambda c: np.maximum(c["x"], 0)),
            "z-from-the-bottom": _put(z=lambda c: c["z"] - c["gamma"]),
            "ball-of-b": _put(d=lambda c: c["b"]),
            "ball-of-d": _put(b=lambda c: c["d"]),
            "ball-around": _put(b=_larger, d=_larger),
            "ball-within": _put(b=_smaller, d=_smaller),
            "half-spheroid": _put(b=lambda c: c["b"] / 2, d=lambda c: c["d"] / 2),
            "double-spheroid": _put(b=lambda c: c["b"] * 2, d=lambda c: c["d"] * 2),
            "half-waist": _put(alpha=lambda c: c["alpha"] / 2),
            "gamma-is-alpha": _put(gamma=lambda c: c["alpha"]),
            "input-in-float32": _changed(lambda rows: rows.astype(np.float32).astype(np.float64)),
            "input-in-float16": _changed(lambda rows: rows.astype(np.float16).astype(np.float64)),
            "A-not-squared": _terms(A=lambda row: row["alpha"] * row["b"] * row["d"] ** 2),
            "B-not-squared": _terms(B=lambda row: row["gamma"] * row["d"] * row["b"] ** 2),
            "Q-not-squared": _terms(Q=lambda row: abs(row["z"]) * row["d"] * row["b"] ** 2),
            "P-not-squared": _terms(P=lambda row: (abs(row["x"]) + abs(row["y"])) * row["b"] * row["d"] ** 2),
        },
    ),
    *_formula_errors(),
)
"""The simplest first."""

Axes = tuple[Floats, Floats, Floats]


def _axis(compute: Callable[[Floats, Floats, Floats], Axes]) -> Rule:
    """The change of rows that replaces the axis; upright if the new axis has no direction."""

    def change(rows: Rows) -> Rows:
        rows[:, 7:] = np.column_stack(compute(*rows[:, 7:].T.copy()))
        rows[~rows[:, 7:].any(axis=1), 7:] = (0.0, 0.0, 1.0)
        return rows

    return _changed(change)


def _angle(turn: Callable[[Floats], Floats]) -> Rule:
    """The change of rows that turns the axis to another angle from the vertical, in radians."""

    def compute(x: Floats, y: Floats, z: Floats) -> Axes:
        across = np.hypot(x, y)
        angle = turn(np.arctan2(across, z))
        scale = np.sin(angle) / np.where(across == 0, 1, across)
        return x * scale, y * scale, np.cos(angle)

    return _axis(compute)


def _in_float32(*values: Floats) -> Axes:
    x, y, z = (value.astype(np.float32).astype(np.float64) for value in values)
    return x, y, z


def _direction_in_float32(x: Floats, y: Floats, z: Floats) -> Axes:
    length = np.sqrt(x * x + y * y + z * z)
    return _in_float32(x / length, y / length, z / length)


def _along(factor: Callable[[Rows], Floats]) -> Rule:
    """The matrix I/b² + (1/d² − 1/b²) f v vᵀ/(v·v), which is the spheroid's own if f = 1."""

    def change(rows: Rows) -> Rows:
        b, d = rows[:, 2], rows[:, 3]
        square = 1 / b**2 + (1 / d**2 - 1 / b**2) * factor(rows[:, 7:])
        rows[:, 3] = 1 / np.sqrt(np.where(square > 0, square, 1e-12))
        return rows

    return _changed(change)


TILTED_FORMULA_ERRORS = causes_about(
    "tilted",
    {
        "axis-ignored": _axis(lambda x, y, z: (0 * x, 0 * y, 1 + 0 * z)),
        "axis-level": _axis(lambda x, y, z: (x, y, 0 * z)),
        "axis-towards-x": _axis(lambda x, y, z: (np.hypot(x, y), 0 * y, z)),
        "axis-turned-back": _axis(lambda x, y, z: (-x, -y, z)),
        "axis-y-negated": _axis(lambda x, y, z: (x, -y, z)),
        "axis-x-y": _axis(lambda x, y, z: (y, x, z)),
        "axis-y-z": _axis(lambda x, y, z: (x, z, y)),
        "axis-x-z": _axis(lambda x, y, z: (z, y, x)),
        "axis-sign": _axis(lambda x, y, z: (x, y, np.abs(z))),
        "axis-down": _axis(lambda x, y, z: (np.where(z > 0, x, 0), np.where(z > 0, y, 0), np.where(z > 0, z, 1))),
        "degrees-as-radians": _angle(np.degrees),
        "radians-as-degrees": _angle(np.radians),
        "half-angle": _angle(lambda angle: angle / 2),
        "double-angle": _angle(lambda angle: 2 * angle),
        "angle-from-the-plane": _angle(lambda angle: np.pi / 2 - angle),
        "small-angle": _angle(np.arctan),
        "axis-not-normalised": _along(lambda v: (v * v).sum(axis=1)),
        "axis-over-length": _along(lambda v: np.sqrt((v * v).sum(axis=1))),
        "axis-over-sum": _along(lambda v: (v * v).sum(axis=1) / np.abs(v).sum(axis=1) ** 2),
        "axis-over-greatest": _along(lambda v: (v * v).sum(axis=1) / np.abs(v).max(axis=1) ** 2),
        "axis-in-float32": _axis(_in_float32),
        "direction-in-float32": _axis(_direction_in_float32),
        "axis-is-d": _put(d=lambda c: np.sqrt(c["axis_x"] ** 2 + c["axis_y"] ** 2 + c["axis_z"] ** 2)),
        "tilted-b-d": _swapped("b", "d"),
        "tilted-ball-around": _put(b=_larger, d=_larger),
        "tilted-ball-within": _put(b=_smaller, d=_smaller),
    },
)
"""The axis ignored, read, normalised or turned wrongly; other bodies. The simplest first."""
