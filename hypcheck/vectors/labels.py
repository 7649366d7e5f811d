"""The labels of a case: answer, measures, flags, and the shortest proof.

Labels are made by the exact decisions (truth/exact.py), labels of sweeps by steps or by roots (truth/swept.py).
checking.py proves them in another way. flags.toml says what each flag means. Flags are decided exactly, in integers, in
rationals, or by comparing floats. Only in float formats every operation of a formula's program is rounded once, in the
order of the program.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import chain, count

import numpy as np
from numpy.typing import NDArray

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.float_arithmetic import float_arithmetic, unit_roundoff
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.arithmetic import cross, sign_of
from hypcheck.geometry.pair import COLUMNS, Pair, Position, to_integers
from hypcheck.geometry.rows import PAIRS, SWEEPS, Mask, Rows, within
from hypcheck.proof_text import height_of_point, reach_of_point
from hypcheck.truth import exact
from hypcheck.truth.backward_error import Bracket, bracket, quick_bracket, tolerated
from hypcheck.truth.certificate import Certificate, PassageCertificate
from hypcheck.truth.crossing import shortened
from hypcheck.truth.exact import Decision, discriminant
from hypcheck.truth.kinds import Kind
from hypcheck.truth.nearest import nearest
from hypcheck.truth.pencil import cubic, quartic, side_of_center
from hypcheck.truth.prove import prove, prove_passage
from hypcheck.truth.swept import passage_of_row, sweep_of_row
from hypcheck.vectors.cases import (
    Offset,
    StoredCertificate,
    Vector,
    case_fields,
    offset_to,
    point_at,
    row_at,
)
from hypcheck.vectors.draw import Row, rows_of
from hypcheck.vectors.format import Content, flag_facts

_MOST_BITS = 1 << 14


def labelled(content: Content, cases: Iterable[tuple[str, Row]]) -> list[Vector]:
    """Make the cases of a file with that content, with all labels and flags, from ids and valid rows.

    Raises ValueError as prove_passage does.
    """
    return (_sweeps if content.about_sweeps else _positions)(content, list(cases))


def _positions(content: Content, cases: Sequence[tuple[str, Row]]) -> list[Vector]:
    """Make the cases of pairs."""
    fields = case_fields(content)
    pairs = [Pair.from_row(row) for _, row in cases]
    decisions = [exact.decide(pair.lengths) for pair in pairs]
    flags = flags_of(content, [row for _, row in cases], decisions)
    return [
        Vector(
            id=name,
            row=row,
            answer=decision.position.value,
            tangent=decision.tangent,
            kind=decision.kind if "kind" in fields else None,
            clearance=nearest(pair).clearance if "clearance" in fields else None,
            flips=flips(content, pair, decision) if "flips" in fields else {},
            witness=stored_certificate(row, prove(pair, decision)),
            flags=held,
        )
        for (name, row), pair, decision, held in zip(cases, pairs, decisions, flags, strict=True)
    ]


def _sweeps(content: Content, cases: Sequence[tuple[str, Row]]) -> list[Vector]:
    """Make the cases of sweeps."""
    return [(_without_proof if content.ended else _with_proof)(*case) for case in cases]


def _with_proof(name: str, row: Row) -> Vector:
    """Make the case of a sweep with its certificate and flags."""
    _, first, proof = prove_passage(row)
    here = row if proof.time is None else row_at(row, proof.time)
    offsets = tuple(offset_to(here, point) for point in proof.points)
    witness = StoredCertificate(offsets=offsets, double_root=proof.double_root, steps=proof.pieces, time=proof.time)
    return Vector(name, row, int(first is not None), witness, first=first, flags=sweep_flags(row, first, proof))


def _without_proof(name: str, row: Row) -> Vector:
    """Make the case of a sweep beside a hyperboloid that ends, which has no certificate and no flags."""
    truth = passage_of_row(row)
    first = (truth.first_lower, truth.first_upper) if truth.hit else None
    return Vector(name, row, int(truth.hit), first=first)


def flips(content: Content, pair: Pair, truth: Decision) -> Mapping[Position, Bracket]:
    """Measure a pair's flip distance to each other position, in the order exterior, contact, interior.

    See `flips` of cases.Vector.
    """
    others = (other for other in Position if other is not truth.position)
    if content.tilted:
        return {other: bracket(pair, truth, other, cuts=0, steps=2) for other in others}
    uppers = {other: quick_bracket(pair, truth, other).upper for other in others}
    return {other: Bracket(upper, upper) for other, upper in uppers.items()}


def stored_certificate(row: Row, certificate: Certificate) -> StoredCertificate:
    """Return the certificate in the form of the files; the second point of a crossing is rounded as much as possible.

    If the hyperboloid ends, points are not rounded.
    """
    offsets = tuple(offset_to(row, point) for point in certificate.points)
    if len(offsets) < 2 or PAIRS.has_heights(row):
        return StoredCertificate(certificate.multiplier, offsets, certificate.double_root, certificate.pieces)
    center, far = offsets
    shorter: Iterator[Offset]
    if PAIRS.has_axis(row):
        shorter = chain(shortened(far, 1, _MOST_BITS), [far])
    else:
        shorter = _cut_off(next(offset for offset in _slid(row, far) if shows_crossing(row, (center, offset))))
    return StoredCertificate(
        offsets=(center, next(offset for offset in shorter if shows_crossing(row, (center, offset))))
    )


def _slid(row: Row, offset: Offset) -> Iterator[Offset]:
    """Yield the offset, then offsets in the spheroid nearer and nearer to it, in the plane through both axes.

    A proof of contact may end at a point of the spheroid's own surface that lies on the hyperboloid. If the two
    surfaces cross there, the hyperboloid's other side is in the direction (−w s, −w t, s² + t²) or its opposite. This
    vector is at right angles to (s, t, w) and no longer than 1, so that a step η along it and a shrinking by 1 − η²
    lead into the spheroid, farther across than inward. At a tip of the spheroid, s = t = 0, the vector is 0, and the
    direction to the hyperboloid's axis replaces it.
    """
    yield offset
    s, t, w = offset
    aside = (-w * s, -w * t, s * s + t * t)
    if s == t == 0:
        x, y = Fraction(row[4]), Fraction(row[5])
        reach = abs(x) + abs(y)
        aside = (x / reach, y / reach, Fraction(0)) if reach else (Fraction(1), Fraction(0), Fraction(0))
    for halvings in count(1):
        for step in (Fraction(1, 1 << halvings), Fraction(-1, 1 << halvings)):
            shrunk = 1 - step * step
            yield (
                (s + step * aside[0]) * shrunk,
                (t + step * aside[1]) * shrunk,
                (w + step * aside[2]) * shrunk,
            )


def _cut_off(offset: Offset) -> Iterator[Offset]:
    """Yield the offset with its parts cut off after more and more bits, which stays in the spheroid; last unchanged."""
    for bits in _bits():
        s, t, w = (Fraction(int(part * (1 << bits)), 1 << bits) for part in offset)
        yield (s, t, w)
    yield offset


def _bits() -> Iterator[int]:
    """Yield numbers of bits, each about a quarter larger than the one before, up to _MOST_BITS."""
    bits = 1
    while bits < _MOST_BITS:
        yield bits
        bits += 1 + bits // 4


def shows_crossing(row: Row, offsets: Sequence[Offset]) -> bool:
    """Decide whether these points of the closed spheroid prove a contact that is no tangency.

    A spheroid that only touches has all its points on one side or on the surface, and no inner point on the surface. So
    two points strictly on different sides, or an inner point on the surface, prove a crossing.
    """
    pair, sides = Pair.from_row(row), set()
    for point in (point_at(row, offset) for offset in offsets):
        reach, level = reach_of_point(pair, point), height_of_point(pair, point)
        if reach > 1:
            return False
        if level == 0 and reach < 1:
            return True
        sides.add(sign_of(level))
    return {-1, 1} <= sides


def exactly_right(formula: str, row: Row, truth: Position) -> bool:
    """Decide whether the formula, evaluated in rationals, gives the right answer to its question about the row."""
    answer = answers(FORMULAS[formula], EXACT, dict(zip(COLUMNS, row, strict=True)))
    return int(answer) == _right_answer(formula, truth)


def wrong_answers(formula: str, precision: str, rows: Rows, truths: Sequence[Position]) -> dict[int, Position]:
    """Return the indices of the rows that the formula answers wrongly in the format, each with its excuse.

    Rows beyond the format's range are left out.

    An excuse is the nearest position for which the answer would be right. If the formula names a position, it is that
    position. If it answers "no" to the question whether a pair is exterior (or interior), it is contact.
    """
    given_answers: NDArray[np.int8] = answers(
        FORMULAS[formula], float_arithmetic(precision), dict(zip(COLUMNS, rows.T, strict=True))
    )
    right = np.asarray([_right_answer(formula, truth) for truth in truths], dtype=np.int8)
    places: list[int] = np.flatnonzero(in_range(rows, precision) & (given_answers != right)).tolist()
    return {place: _excuse(formula, int(given_answers[place])) for place in places}


def in_range(rows: Rows, precision: str) -> Mask:
    """Return a mask (n,) of the rows whose numbers are all 0 or in the range of the format's normal numbers."""
    limits = np.finfo(np.dtype(precision))
    lengths = np.abs(rows)
    normal = (lengths >= float(limits.tiny)) & (lengths <= float(limits.max))
    return np.asarray((normal | (lengths == 0)).all(axis=1))


def leaves_range(formula: str, precision: str, rows: Rows) -> tuple[Mask, Mask]:
    """Evaluate the formula in the format; return masks (n,) of the rows where it overflows and where it underflows.

    Overflow: an intermediate is infinite. Underflow: a product or quotient of numbers ≠ 0 is below the normal numbers.

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
    """Return the right answer to the formula's question: the position, or 1 for yes and 0 for no."""
    question = FORMULAS[formula].question
    return int(truth) if question == "position" else int(truth is Position[question.upper()])


def _excuse(formula: str, answer: int) -> Position:
    """Return the nearest position for which a wrong answer of the formula would be right."""
    question = FORMULAS[formula].question
    if question == "position":
        return Position(answer)
    return Position[question.upper()] if answer else Position.CONTACT


FORMATS = ("float16", "float32", "float64")
DEFEATED = tuple((name, precision) for name in ("table-2", "local-maximum") for precision in ("float32", "float64"))
"""The formulas whose rounding errors give flags, each with a format in which it is evaluated."""

PRINTED = {"proposition-3-false": "table-2", "proposition-5-false": "procedure-2b-spheroid"}
"""Flags of rows that a procedure of the paper answers wrongly in exact arithmetic, each with the formula's name."""

TOLERANCE_U = 8
"""The backward error, in units u, up to which a wrong answer in floats is tolerated and gives no flag."""

_DOUBLE_ROOTS = {
    Kind.CROSSING_THROAT_NODE,
    Kind.CROSSING_GROOVE_NODE,
    Kind.CROSSING_GROOVE_ISOLATED_POINT,
    Kind.CROSSING_GROOVE_CUSP,
}


def flags_of(content: Content, rows: Sequence[Row], decisions: Sequence[Decision]) -> list[tuple[str, ...]]:
    """Return the flags of each valid row of a file with that content; the exact decisions are given."""
    if not content.flags:
        return [()] * len(rows)
    return (_tilted_flags if content.tilted else _upright_flags)(rows, decisions)


def _upright_flags(rows: Sequence[Row], decisions: Sequence[Decision]) -> list[tuple[str, ...]]:
    """Return the flags of each row with an upright spheroid."""
    array = rows_of(list(rows))
    masks = _of_numbers(array) | _of_table_2(array) | _of_formulas(array, decisions)
    exactly = [_of_pair(Pair.from_row(row), decision) for row, decision in zip(rows, decisions, strict=True)]
    return [
        tuple(name for name in flag_facts("upright") if name in exact or (name in masks and masks[name][place]))
        for place, exact in enumerate(exactly)
    ]


def _of_pair(pair: Pair, decision: Decision) -> set[str]:
    """Return the flags of a pair that exact arithmetic decides."""
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
    """Return masks (n,) of the flags that follow directly from the seven numbers, by name."""
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
    """Return masks (n,) of the flags for an intermediate of Table 2 beyond a format that holds the row, by name."""
    masks = {}
    for name in FORMATS:
        overflow, underflow = leaves_range("table-2", name, rows)
        counted = in_range(rows, name)
        masks[f"overflow-{name}"], masks[f"underflow-{name}"] = counted & overflow, counted & underflow
    return masks


def _of_formulas(rows: Rows, decisions: Sequence[Decision]) -> dict[str, Mask]:
    """Return masks (n,), by name, of the flags for a formula that is wrong in exact arithmetic, or only in floats."""
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
    """Decide whether no change of the inputs by TOLERANCE_U units u makes the wrong answer right."""
    change = TOLERANCE_U * Fraction(unit_roundoff(precision))
    return not tolerated(Pair.from_row(row), truth, [excuse], change)


_SHORTEST, _LONGEST = 2.0**-511, 2.0**511
"""Between these a length's square neither underflows nor overflows."""


def _tilted_flags(rows: Sequence[Row], decisions: Sequence[Decision]) -> list[tuple[str, ...]]:
    """Return the flags of each row with a tilted spheroid, each decided exactly."""
    return [_of_tilted_pair(Pair.from_row(row), decision) for row, decision in zip(rows, decisions, strict=True)]


def _of_tilted_pair(pair: Pair, decision: Decision) -> tuple[str, ...]:
    """Return the flags of a pair with a tilted spheroid, decided exactly."""
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
    """Return the flags of a sweep; the positions at its ends are decided exactly."""
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
