"""Causes about every row: a sign or a term of a formula wrong, a column taken for another, another question answered.

Each is a whole rule. A rule about the input changes the row as its sentence in causes.toml says, and then answers
exactly. A rule about a formula is evaluated in float64. If most of its answers agree with the given ones, it is
evaluated in whole numbers at the rows where they disagree.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from hypcheck.geometry.pair import COLUMNS
from hypcheck.geometry.rows import Columns, Floats, Rows
from hypcheck.runs.causes import (
    AnsweredRows,
    Answers,
    Cause,
    Rule,
    Scope,
    always,
    causes_about,
    of_changed_rows,
    with_columns,
)

_MOSTLY = 0.5
"""If float64 gives at least this share of the wrong answers, the formula is evaluated exactly at the other rows."""


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
        """Return the terms of the paper for a row of lengths."""
        bb, dd = row["b"] ** 2, row["d"] ** 2
        squares = row["x"] ** 2 + row["y"] ** 2
        return cls(row["alpha"] ** 2 * dd, row["gamma"] ** 2 * bb, squares * dd, row["z"] ** 2 * bb, bb * dd)


def _in_floats(rows: Rows) -> Lengths:
    """Return the columns of rows in float64, radial lengths in units of b and axial ones in units of d."""
    alpha, gamma, b, d, x, y, z = rows.T
    one = np.ones(len(rows))
    return dict(zip(COLUMNS, (alpha / b, gamma / d, one, one, x / b, y / b, z / d), strict=True))


def _in_whole_numbers(rows: Rows) -> Lengths:
    """Return the columns of rows as whole numbers, exactly: radial lengths in one unit, axial ones in another."""
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
        """Answer rows with this rule: positions, int8 (n,)."""
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
        """Return the rule's answers to the question.

        They are computed in float64. If most of the wrong answers agree, the rows that disagree are computed exactly.
        """
        answers = answered.answers_at(self.positions(_in_floats(answered.rows)))
        others, wrong = np.flatnonzero(answers != answered.given), answered.given != answered.answers_at(answered.truth)
        if (answers == answered.given)[wrong].sum() < _MOSTLY * wrong.sum():
            return answers
        if len(others):
            part = answered.part(others)
            answers[others] = part.answers_at(self.positions(_in_whole_numbers(part.rows)))
        return answers


def _formula_errors() -> Iterator[Cause]:
    """Yield the causes with a wrong sign or term in a coefficient or in Δ, or with a wrong decision."""

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
    """Return the rule of the formula with some of A, B, P, Q (times b² d²) replaced."""
    return SlippedRule(lambda row: replace(Terms.of(row), **{name: compute(row) for name, compute in changed.items()}))


def _swapped(first: str, second: str) -> Rule:
    """Return the rule that takes each of two columns for the other."""
    return with_columns(**{first: lambda c: c[second], second: lambda c: c[first]})


def _ignored(name: str) -> Rule:
    """Return the rule that computes with 0 in the place of a column."""
    return with_columns(**{name: lambda c: 0 * c[name]})


def _ball(radius: Callable[[Floats, Floats], Floats]) -> Rule:
    """Return the rule that takes the spheroid for a ball whose radius is computed from b and d."""
    return with_columns(b=lambda c: radius(c["b"], c["d"]), d=lambda c: radius(c["b"], c["d"]))


def _gap(answered: AnsweredRows) -> Floats:
    """Return the horizontal distance of the centre from the surface at its height, negative inside."""
    alpha, gamma, _, _, x, y, z = answered.rows.T
    return np.asarray(np.hypot(x, y) - alpha * np.hypot(1, z / gamma))


def _horizontally(answered: AnsweredRows) -> Answers:
    """Answer by the horizontal distance alone, as if the spheroid were a horizontal disc with radius b."""
    gap, b = _gap(answered), answered.rows[:, 2]
    return answered.answers_at(np.where(gap > b, 1, np.where(gap < -b, -1, 0)).astype(np.int8))


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
            "x-for-y": with_columns(y=lambda c: c["x"]),
            "city-block": with_columns(x=lambda c: np.abs(c["x"]) + np.abs(c["y"]), y=lambda c: 0 * c["y"]),
            "chessboard": with_columns(x=lambda c: np.maximum(np.abs(c["x"]), np.abs(c["y"])), y=lambda c: 0 * c["y"]),
            "z-below": with_columns(z=lambda c: np.maximum(c["z"], 0)),
            "x-below": with_columns(x=lambda c: np.maximum(c["x"], 0)),
            "z-from-the-bottom": with_columns(z=lambda c: c["z"] - c["gamma"]),
            "ball-of-b": with_columns(d=lambda c: c["b"]),
            "ball-of-d": with_columns(b=lambda c: c["d"]),
            "ball-around": _ball(np.maximum),
            "ball-within": _ball(np.minimum),
            "half-spheroid": with_columns(b=lambda c: c["b"] / 2, d=lambda c: c["d"] / 2),
            "double-spheroid": with_columns(b=lambda c: c["b"] * 2, d=lambda c: c["d"] * 2),
            "half-waist": with_columns(alpha=lambda c: c["alpha"] / 2),
            "gamma-is-alpha": with_columns(gamma=lambda c: c["alpha"]),
            "input-in-float32": of_changed_rows(lambda rows: rows.astype(np.float32).astype(np.float64)),
            "input-in-float16": of_changed_rows(lambda rows: rows.astype(np.float16).astype(np.float64)),
            "A-not-squared": _terms(A=lambda row: row["alpha"] * row["b"] * row["d"] ** 2),
            "B-not-squared": _terms(B=lambda row: row["gamma"] * row["d"] * row["b"] ** 2),
            "Q-not-squared": _terms(Q=lambda row: abs(row["z"]) * row["d"] * row["b"] ** 2),
            "P-not-squared": _terms(P=lambda row: (abs(row["x"]) + abs(row["y"])) * row["b"] * row["d"] ** 2),
        },
    ),
    *_formula_errors(),
)
"""The simplest first."""


def _axis(compute: Callable[[Floats, Floats, Floats], Columns]) -> Rule:
    """Return the rule that replaces the axis, and answers exactly. A new axis without direction becomes vertical."""

    def change(rows: Rows) -> Rows:
        rows[:, 7:] = np.column_stack(compute(*rows[:, 7:].T.copy()))
        rows[~rows[:, 7:].any(axis=1), 7:] = (0.0, 0.0, 1.0)
        return rows

    return of_changed_rows(change)


def _angle(turn: Callable[[Floats], Floats]) -> Rule:
    """Return the rule that turns the axis to another angle from the vertical, in radians, and answers exactly."""

    def compute(x: Floats, y: Floats, z: Floats) -> Columns:
        across = np.hypot(x, y)
        angle = turn(np.arctan2(across, z))
        scale = np.sin(angle) / np.where(across == 0, 1, across)
        return x * scale, y * scale, np.cos(angle)

    return _axis(compute)


def _in_float32(*values: Floats) -> Columns:
    """Return the values, rounded to float32."""
    x, y, z = (value.astype(np.float32).astype(np.float64) for value in values)
    return x, y, z


def _direction_in_float32(x: Floats, y: Floats, z: Floats) -> Columns:
    """Return the unit vector of the axis, rounded to float32."""
    length = np.sqrt(x * x + y * y + z * z)
    return _in_float32(x / length, y / length, z / length)


def _along(factor: Callable[[Rows], Floats]) -> Rule:
    """Return the rule of a wrong matrix of the spheroid: I/b² + (1/d² − 1/b²) f v vᵀ/(v·v).

    v is the axis, and f is `factor` of it; with f = 1 the matrix is right. The rule changes d so that the spheroid has
    this matrix, and answers exactly.
    """

    def change(rows: Rows) -> Rows:
        b, d = rows[:, 2], rows[:, 3]
        square = 1 / b**2 + (1 / d**2 - 1 / b**2) * factor(rows[:, 7:])
        rows[:, 3] = 1 / np.sqrt(np.where(square > 0, square, 1e-12))
        return rows

    return of_changed_rows(change)


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
        "axis-is-d": with_columns(d=lambda c: np.sqrt(c["axis_x"] ** 2 + c["axis_y"] ** 2 + c["axis_z"] ** 2)),
        "tilted-b-d": _swapped("b", "d"),
        "tilted-ball-around": _ball(np.maximum),
        "tilted-ball-within": _ball(np.minimum),
    },
)
"""The axis ignored, read, normalised or turned wrongly; other bodies. The simplest first."""
