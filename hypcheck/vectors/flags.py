"""The flags of a case: what each means, the defect it finds, and how it is computed.

Everything here is decided exactly (in integers, in rationals, or by comparing floats). Only in float formats every
operation of a formula's program is rounded once, in the order of the program.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic, unit_roundoff
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.arithmetic import cross
from hypcheck.geometry.pair import COLUMNS, Pair, Position, to_integers
from hypcheck.geometry.rows import SWEEPS, Mask, Rows, within
from hypcheck.truth import backward_error, exact
from hypcheck.truth.certificate import PassageCertificate
from hypcheck.truth.exact import Decision, discriminant
from hypcheck.truth.kinds import Kind
from hypcheck.truth.passage_error import sweep_of_row
from hypcheck.truth.pencil import cubic, quartic, side_of_center
from hypcheck.vectors.family import Row, rows_of


def exactly_right(formula: str, row: Row, truth: Position) -> bool:
    """Whether the formula, evaluated in rationals, gives the right answer to its question about the row."""
    answer = answers(FORMULAS[formula], EXACT, dict(zip(COLUMNS, row, strict=True)))
    return int(answer) == _right_answer(formula, truth)


def wrong_answers(formula: str, precision: str, rows: Rows, truths: Sequence[Position]) -> dict[int, Position]:
    """The rows in the format's range that the formula answers wrongly in it, each with its nearest excuse.

    An excuse is a position for which the answer would be right: the answer itself; if the formula answers "no" for a
    clear position, contact, which is nearer than the other clear position.
    """
    given_answers: NDArray[np.int8] = answers(
        FORMULAS[formula], float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True))
    )
    right = np.asarray([_right_answer(formula, truth) for truth in truths], dtype=np.int8)
    places: list[int] = np.flatnonzero(in_range(rows, precision) & (given_answers != right)).tolist()
    return {place: _excuse(formula, int(given_answers[place])) for place in places}


def in_range(rows: Rows, precision: str) -> Mask:
    """A mask (n,) of the rows whose every number is 0 or in the range of the format's normal numbers."""
    limits = np.finfo(np.dtype(precision))
    lengths = np.abs(rows)
    normal = (lengths >= float(limits.tiny)) & (lengths <= float(limits.max))
    return np.asarray((normal | (lengths == 0)).all(axis=1))


def leaves_range(formula: str, precision: str, rows: Rows) -> tuple[Mask, Mask]:
    """Masks of the rows with an infinity, and with a product or quotient of numbers ≠ 0 below the normal numbers.

    A NaN without an infinity is the root of a negative number and no overflow; a difference of infinities follows an
    infinity. Sums and differences do not underflow: if they are subnormal, they are exact.
    """
    program = FORMULAS[formula].program
    values = evaluate(program, float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True)))
    least = np.finfo(np.dtype(precision)).tiny
    overflow, underflow = np.zeros(len(rows), dtype=np.bool_), np.zeros(len(rows), dtype=np.bool_)
    for step in program.steps:
        value = values[step.name]
        if value.dtype == np.bool_:
            continue
        overflow |= np.isinf(value)
        if step.operation in ("mul", "div"):
            nonzero = np.ones(len(rows), dtype=np.bool_)
            for name in step.reads:
                nonzero &= values[name] != 0
            underflow |= nonzero & (np.abs(value) < least)
    return overflow, underflow


def _right_answer(formula: str, truth: Position) -> int:
    question = FORMULAS[formula].question
    return int(truth) if question == "position" else int(truth is Position[question.upper()])


def _excuse(formula: str, answer: int) -> Position:
    question = FORMULAS[formula].question
    if question == "position":
        return Position(answer)
    return Position[question.upper()] if answer else Position.CONTACT


@dataclass(frozen=True, slots=True)
class FlagFacts:
    """The meaning of a flag, and the kind of defect that cases with it find."""

    meaning: str
    bug_type: str


FORMATS = ("float16", "float32", "float64")
DEFEATED = tuple((name, precision) for name in ("table-2", "local-maximum") for precision in ("float32", "float64"))
"""The formulas whose rounding is looked at, and the formats in which it is."""

PRINTED = {"proposition-3-false": "table-2", "proposition-5-false": "procedure-2b-spheroid"}
"""The flags of the paper's own procedures, which are looked at in exact arithmetic."""

TOLERANCE_U = 8
"""Units u of backward error up to which a rounded answer counts as good."""

_DOUBLE_ROOTS = {
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_CUSP,
}

FLAGS: dict[str, FlagFacts] = {
    "tangent": FlagFacts("the surfaces touch and cross nowhere; tangency is contact", "equality"),
    "ring": FlagFacts("clear, though the discriminant is 0: g has the double root c²", "missing case"),
    "delta=0": FlagFacts("the discriminant of the characteristic cubic is exactly 0", "equality"),
    "c1=0": FlagFacts("the coefficient of λ is exactly 0", "missing case"),
    "c2=0": FlagFacts("the coefficient of λ² is exactly 0", "missing case"),
    "a<1": FlagFacts("α < b: the spheroid is wider than the throat", "hypothesis"),
    "a=1": FlagFacts("α = b: the border of the condition α/b ≥ 1", "hypothesis"),
    "c^2<a": FlagFacts("(γ/d)² < α/b: the spheroid is too round for the groove", "hypothesis"),
    "c^2=a": FlagFacts("(γ/d)² = α/b: the border of the condition (γ/d)² ≥ α/b", "hypothesis"),
    "axis": FlagFacts("x = y = 0: the nearest points of the surface are a whole circle", "degenerate input"),
    "waist": FlagFacts("z = 0: c² is a root of the cubic itself", "degenerate input"),
    "on-surface": FlagFacts("the spheroid's centre lies exactly on the hyperboloid", "degenerate input"),
    "negative-zero": FlagFacts("a coordinate is −0.0, which is 0", "degenerate input"),
    "extreme": FlagFacts(
        "a semi-axis is outside 1e-6 … 1e6, a coordinate beyond 1e6, or α/b or γ/d outside 1e-8 … 1e8; skip it unless "
        "you promise more",
        "range",
    ),
    **{
        f"{name}-exact": FlagFacts(f"every number is 0 or a normal number of {name}, exactly", "input conversion")
        for name in FORMATS[:2]
    },
    **{
        f"subnormal-{name}": FlagFacts(
            f"{name} holds every number exactly, one or more of them as subnormal numbers", "flush to zero"
        )
        for name in FORMATS
    },
    **{
        f"{event}-{name}": FlagFacts(
            f"every number is in {name}'s range, but an intermediate of the paper's Table 2 {how} when evaluated in it",
            event,
        )
        for name in FORMATS
        for event, how in (("overflow", "overflows"), ("underflow", "underflows"))
    },
    "proposition-3-false": FlagFacts(
        "the paper's Table 2 is wrong here in exact arithmetic, inside its regime or out of it", "mathematics"
    ),
    "proposition-5-false": FlagFacts(
        "the paper's Procedure 2.b, asked about this spheroid, is wrong here in exact arithmetic", "mathematics"
    ),
    **{
        f"{formula}-{precision}": FlagFacts(
            f"{what}, right here in exact arithmetic, is wrong by more than {TOLERANCE_U} u when evaluated in "
            f"{precision}",
            "rounding",
        )
        for formula, precision in DEFEATED
        for what in ("the paper's Table 2" if formula == "table-2" else "the sign of g at its local maximum",)
    },
}
"""Every flag of upright spheroids, in the order in which a case has them."""

SWEEP_FLAGS: dict[str, FlagFacts] = {
    "tunnelling": FlagFacts("both ends are clear, on one side, and there is contact between them", "sampling"),
    "tangent": FlagFacts("the surfaces are tangent at the time of the proof; tangency is contact", "equality"),
    "contact-at-start": FlagFacts("the first contact is at t = 0", "open interval"),
    "contact-at-end-alone": FlagFacts("the first contact is at t = 1, to the last digit", "open interval"),
    "still": FlagFacts("both ends are one point", "degenerate input"),
    "vertical-way": FlagFacts("x and y do not change, z does", "degenerate input"),
    "horizontal-way": FlagFacts("z does not change, x or y do", "degenerate input"),
    "upright": FlagFacts("the axis is given, and is vertical or that of a sphere", "degenerate input"),
}
"""The flags of sweeps, in the order in which a case has them."""

TILTED_FLAGS: dict[str, FlagFacts] = {
    "tangent": FLAGS["tangent"],
    "quartic-ring": FlagFacts("clear, though the discriminant of det(S + λH) is 0", "missing case"),
    "quartic-delta=0": FlagFacts("the discriminant of det(S + λH) is exactly 0", "equality"),
    "tilt-matters": FlagFacts("the same spheroid upright has another position", "ignored input"),
    "vertical-axis": FlagFacts("axis_x = axis_y = 0: an upright spheroid", "degenerate input"),
    "horizontal-axis": FlagFacts("axis_z = 0", "degenerate input"),
    "sphere": FlagFacts("b = d: the axis means nothing", "degenerate input"),
    "meridian-plane": FlagFacts("centre, axis and the hyperboloid's axis lie in one plane", "degenerate input"),
    "through-the-origin": FlagFacts("the axis points from the centre to the hyperboloid's", "degenerate input"),
    "on-axis": FlagFacts("x = y = 0: the centre lies on the hyperboloid's axis", "degenerate input"),
    "on-surface": FLAGS["on-surface"],
    "long-axis": FlagFacts("the square of the axis's length overflows or underflows in float64", "overflow"),
    "extreme": FLAGS["extreme"],
}
"""Every flag of tilted spheroids, in the order in which a case has them."""


def flags_of(
    known: Mapping[str, FlagFacts], rows: Sequence[Row], decisions: Sequence[Decision]
) -> list[tuple[str, ...]]:
    """The flags of each valid row, among the `known` flags of a file's content; the exact decisions are given."""
    if not known:
        return [()] * len(rows)
    flags = _tilted_flags if known is TILTED_FLAGS else _upright_flags
    return flags(rows, decisions)


def _upright_flags(rows: Sequence[Row], decisions: Sequence[Decision]) -> list[tuple[str, ...]]:
    array = rows_of(list(rows))
    masks = _of_numbers(array) | _of_table_2(array) | _of_formulas(array, decisions)
    exactly = [_of_pair(Pair.from_row(row), decision) for row, decision in zip(rows, decisions, strict=True)]
    return [
        tuple(name for name in FLAGS if name in exact or (name in masks and masks[name][place]))
        for place, exact in enumerate(exactly)
    ]


def _of_pair(pair: Pair, decision: Decision) -> set[str]:
    """The flags that exact arithmetic decides."""
    g, kind = cubic(pair.lengths), decision.kind
    a, square = Fraction(pair.alpha) / Fraction(pair.b), (Fraction(pair.gamma) / Fraction(pair.d)) ** 2
    held = {
        "tangent": decision.tangent,
        "ring": kind is Kind.EXTERIOR_RING,
        "delta=0": decision.tangent or kind is Kind.EXTERIOR_RING or kind in _DOUBLE_ROOTS,
        "c1=0": g.n1 == 0,
        "c2=0": g.n2 == 0,
        "a<1": a < 1,
        "a=1": a == 1,
        "c^2<a": square < a,
        "c^2=a": square == a,
        "axis": pair.x == pair.y == 0,
        "waist": pair.z == 0,
        "on-surface": side_of_center(pair.lengths) == 0,
    }
    return {name for name, holds in held.items() if holds}


def _of_numbers(rows: Rows) -> dict[str, Mask]:
    """The flags that follow directly from the seven numbers."""
    masks = {
        "extreme": ~within(rows),
        "negative-zero": np.asarray(((rows == 0) & np.signbit(rows)).any(axis=1)),
    }
    for name in FORMATS:
        with np.errstate(over="ignore", under="ignore"):
            held = (rows.astype(name).astype(np.float64) == rows).all(axis=1)
        normal = in_range(rows, name)
        masks[f"{name}-exact"] = held & normal
        masks[f"subnormal-{name}"] = held & ~normal
    return masks


def _of_table_2(rows: Rows) -> dict[str, Mask]:
    """The flags for an intermediate of Table 2 outside the range of a format that holds the row."""
    masks = {}
    for name in FORMATS:
        overflow, underflow = leaves_range("table-2", name, rows)
        counted = in_range(rows, name)
        masks[f"overflow-{name}"], masks[f"underflow-{name}"] = counted & overflow, counted & underflow
    return masks


def _of_formulas(rows: Rows, decisions: Sequence[Decision]) -> dict[str, Mask]:
    """The flags for a formula that is wrong in exact arithmetic, or right in exact arithmetic and wrong in floats."""
    listed: list[Row] = rows.tolist()
    truths = [decision.position for decision in decisions]
    masks = {
        flag: np.asarray(
            [not exactly_right(formula, *arguments) for arguments in zip(listed, truths, strict=True)], np.bool_
        )
        for flag, formula in PRINTED.items()
    }
    for formula, precision in DEFEATED:
        beyond = np.zeros(len(rows), dtype=np.bool_)
        for place, excuse in wrong_answers(formula, precision, rows, truths).items():
            row, truth = listed[place], decisions[place]
            beyond[place] = _beyond(row, truth, excuse, precision) and exactly_right(formula, row, truth.position)
        masks[f"{formula}-{precision}"] = beyond
    return masks


def _beyond(row: Row, truth: Decision, excuse: Position, precision: str) -> bool:
    """Whether no change of the inputs by TOLERANCE_U units u makes the wrong answer right."""
    change = TOLERANCE_U * Fraction(unit_roundoff(precision))
    return not backward_error.tolerated(Pair.from_row(row), truth, [excuse], change)


_SHORTEST, _LONGEST = 2.0**-511, 2.0**511
"""Between these a length's square neither underflows nor overflows."""


def _tilted_flags(rows: Sequence[Row], decisions: Sequence[Decision]) -> list[tuple[str, ...]]:
    """The flags of each row with a tilted spheroid, each decided exactly."""
    return [_of_tilted_pair(Pair.from_row(row), decision) for row, decision in zip(rows, decisions, strict=True)]


def _of_tilted_pair(pair: Pair, decision: Decision) -> tuple[str, ...]:
    sizes = pair.row[:7]
    double = not pair.is_upright and discriminant(quartic(pair.lengths)) == 0
    across = cross(to_integers((pair.x, pair.y, pair.z)), to_integers(pair.axis))
    largest = max(map(abs, pair.axis))
    conditions = {
        "tangent": decision.tangent,
        "quartic-ring": double and decision.position is not Position.CONTACT,
        "quartic-delta=0": double,
        "tilt-matters": exact.position(Pair(*sizes).lengths) is not decision.position,
        "vertical-axis": pair.axis_x == pair.axis_y == 0,
        "horizontal-axis": pair.axis_z == 0,
        "sphere": pair.b == pair.d,
        "meridian-plane": across[2] == 0,
        "through-the-origin": not any(across),
        "on-axis": pair.x == pair.y == 0,
        "on-surface": side_of_center(pair.lengths) == 0,
        "long-axis": not _SHORTEST <= largest <= _LONGEST,
        "extreme": not within(np.asarray([sizes]))[0],
    }
    return tuple(name for name, holds in conditions.items() if holds)


def sweep_flags(row: Row, first: tuple[float, float] | None, proof: PassageCertificate) -> tuple[str, ...]:
    """The flags of a sweep; the positions at its ends are decided exactly."""
    start, end, (_, axis, _) = row[4:7], row[7:10], SWEEPS.split(row)
    ends = [sweep_of_row(row).position(Fraction(time)) for time in (0, 1)]
    conditions = {
        "tunnelling": first is not None and ends[0] is ends[1] is not Position.CONTACT,
        "tangent": proof.double_root is not None,
        "contact-at-start": ends[0] is Position.CONTACT,
        "contact-at-end-alone": first is not None and first[0] < 1 == proof.time and first[1] == 1,
        "still": start == end,
        "vertical-way": start[:2] == end[:2] and start[2] != end[2],
        "horizontal-way": start[2] == end[2] and start[:2] != end[:2],
        "upright": bool(axis) and (not any(axis[:2]) or row[2] == row[3]),
    }
    return tuple(name for name, holds in conditions.items() if holds)
