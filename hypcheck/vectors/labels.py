"""The labels of a case: answer, measures, flags, and the shortest proof.

Labels are made by the exact decisions (truth/exact.py), labels of sweeps by steps or by roots (truth/swept.py).
checking.py proves them in another way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import chain, count

from hypcheck.geometry.arithmetic import sign_of
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import PAIRS
from hypcheck.proof_text import height_of_point, reach_of_point
from hypcheck.truth import exact
from hypcheck.truth.backward_error import Bracket, bracket, quick_bracket
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.crossing import shortened
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import nearest
from hypcheck.truth.passage_error import scaled_passage
from hypcheck.truth.prove import prove, prove_passage
from hypcheck.vectors.cases import (
    Offset,
    StoredCertificate,
    Vector,
    case_fields,
    offset_to,
    point_at,
    row_at,
)
from hypcheck.vectors.family import Row
from hypcheck.vectors.flags import flags_of, sweep_flags
from hypcheck.vectors.format import Content

_MOST_BITS = 1 << 14


def labelled(content: Content, cases: Iterable[tuple[str, Row]]) -> list[Vector]:
    """Cases for a file of that content, with all labels and flags, from ids and valid rows.

    Raises ValueError as prove_passage does.
    """
    return (_sweeps if content.about_sweeps else _positions)(content, list(cases))


def _positions(content: Content, cases: Sequence[tuple[str, Row]]) -> list[Vector]:
    fields = case_fields(content)
    pairs = [Pair.from_row(row) for _, row in cases]
    decisions = [exact.decide(pair.lengths) for pair in pairs]
    flags = flags_of(content.flags, [row for _, row in cases], decisions)
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
    return [(_without_proof if content.ended else _with_proof)(*case) for case in cases]


def _with_proof(name: str, row: Row) -> Vector:
    _, first, proof = prove_passage(row)
    here = row if proof.time is None else row_at(row, proof.time)
    offsets = tuple(offset_to(here, point) for point in proof.points)
    witness = StoredCertificate(offsets=offsets, double_root=proof.double_root, steps=proof.pieces, time=proof.time)
    return Vector(name, row, int(first is not None), witness, first=first, flags=sweep_flags(row, first, proof))


def _without_proof(name: str, row: Row) -> Vector:
    truth = scaled_passage(row)
    first = (truth.first_lower, truth.first_upper) if truth.hit else None
    return Vector(name, row, int(truth.hit), first=first)


def flips(content: Content, pair: Pair, truth: Decision) -> Mapping[Position, Bracket]:
    """A pair's distance to each other position, in the order exterior, contact, interior; see cases.Vector."""
    others = (other for other in Position if other is not truth.position)
    if content.tilted:
        return {other: bracket(pair, truth, other, cuts=0, steps=2) for other in others}
    uppers = {other: quick_bracket(pair, truth, other).upper for other in others}
    return {other: Bracket(upper, upper) for other, upper in uppers.items()}


def stored_certificate(row: Row, certificate: Certificate) -> StoredCertificate:
    """The certificate in the form of the files; the second point of a crossing is rounded as much as possible.

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
    """The offset, then offsets beside it in the plane through both axes, nearer and nearer to it, all in the spheroid.

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
    """The offset with each part cut off after more and more bits, so that it stays in the spheroid; last unchanged."""
    for bits in _bits():
        s, t, w = (Fraction(int(part * (1 << bits)), 1 << bits) for part in offset)
        yield (s, t, w)
    yield offset


def _bits() -> Iterator[int]:
    bits = 1
    while bits < _MOST_BITS:
        yield bits
        bits += 1 + bits // 4


def shows_crossing(row: Row, offsets: Sequence[Offset]) -> bool:
    """Whether these points of the closed spheroid prove a contact that is no tangency.

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
