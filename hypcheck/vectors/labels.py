"""The labels of a case: answer, measures, flags, and the shortest proof.

They are made by the exact decisions (truth/exact.py), ways by steps or by roots
(truth/swept.py). checking.py proves them in another way.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import count
from typing import Any

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import WAYS
from hypcheck.truth import ended_prove, exact
from hypcheck.truth.backward_error import Bracket, bracket, quick_bracket
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import nearest
from hypcheck.truth.passage_certificate import place
from hypcheck.truth.passage_error import scaled_passage
from hypcheck.truth.passage_prove import prove as prove_passage
from hypcheck.truth.prove import prove
from hypcheck.truth.vectors import dot
from hypcheck.vectors.cases import (
    EndedVector,
    Offset,
    StoredCertificate,
    StoredPassage,
    TiltedVector,
    UprightVector,
    Vector,
    WayVector,
    offset_to,
    point_at,
)
from hypcheck.vectors.family import Row
from hypcheck.vectors.flags import flags_of, tilted_flags, way_flags
from hypcheck.vectors.format import Content

_MOST_BITS = 1 << 14


def labelled(content: Content, cases: Iterable[tuple[str, Row]]) -> list[Any]:
    """Cases of a file of that content with every label and flag, from ids and valid rows.

    Raises ValueError as passage_prove.prove does.
    """
    if content.ended:
        labelled_one = _labelled_ended_way if content.layout is WAYS else _labelled_ended
        return [labelled_one(*case) for case in cases]
    if content.layout is WAYS:
        return [_labelled_way(*named_row) for named_row in cases]
    return [_labelled_tilted(*named_row) for named_row in cases] if content.tilted else _labelled_upright(list(cases))


def _labelled_upright(cases: Sequence[tuple[str, Row]]) -> list[UprightVector]:
    decisions = [exact.decide(Pair.from_row(row).lengths) for _, row in cases]
    flags = flags_of([row for _, row in cases], decisions)
    return [_labelled(*case, truth, held) for case, truth, held in zip(cases, decisions, flags, strict=True)]


def _labelled(name: str, row: Row, decision: Decision, flags: tuple[str, ...]) -> UprightVector:
    pair = Pair.from_row(row)
    return Vector(
        id=name,
        row=row,
        position=decision.position,
        tangent=decision.tangent,
        kind=decision.kind,
        clearance=nearest(pair).clearance,
        flips=flips(pair, decision),
        witness=stored_certificate(row, prove(pair, decision)),
        flags=flags,
    )


def _labelled_tilted(name: str, row: Row) -> TiltedVector:
    pair = Pair.from_row(row)
    decision = exact.decide(pair.lengths)
    return Vector(
        id=name,
        row=row,
        position=decision.position,
        tangent=decision.tangent,
        kind=None,
        clearance=nearest(pair).clearance,
        flips=_tilted_flips(pair, decision),
        witness=stored_certificate(row, prove(pair, decision)),
        flags=tilted_flags(pair, decision),
    )


def _labelled_ended(name: str, row: Row) -> EndedVector:
    pair = Pair.from_row(row)
    decision = exact.decide(pair.lengths)
    proof = ended_prove.prove(pair, decision) if pair.has_ends else prove(pair, decision)
    witness = StoredCertificate(
        proof.multiplier, tuple(offset_to(row, point) for point in proof.points), proof.double_root, proof.pieces
    )
    return EndedVector(name, row, decision.position, decision.tangent, witness)


def _labelled_way(name: str, row: Row) -> WayVector:
    _, first, proof = prove_passage(row)
    offsets: tuple[Offset, ...] = ()
    if proof.time is not None:
        b, (x, y, z) = Fraction(row[2]), place(row, proof.time).row[4:]
        offsets = tuple(((u - x) / b, (v - y) / b, (w - z) / b) for u, v, w in proof.points)
    witness = StoredPassage(proof.pieces, proof.time, offsets, proof.double_root)
    return WayVector(name, row, first, witness, way_flags(row, first, proof))


def _labelled_ended_way(name: str, row: Row) -> WayVector:
    truth = scaled_passage(row)
    return WayVector(name, row, (truth.first_lower, truth.first_upper) if truth.hit else None, StoredPassage())


def flips(pair: Pair, truth: Decision) -> Mapping[Position, float]:
    """An upright pair's distance to each other position, in the order exterior, contact, interior."""
    others = (other for other in Position if other is not truth.position)
    return {other: quick_bracket(pair, truth, other).upper for other in others}


def _tilted_flips(pair: Pair, decision: Decision) -> Mapping[Position, Bracket]:
    others = (other for other in Position if other is not decision.position)
    return {other: bracket(pair, decision, other, cuts=0, steps=2) for other in others}


def stored_certificate(row: Row, certificate: Certificate) -> StoredCertificate:
    """The certificate in a file's terms; of two points of a crossing the second is rounded as far as it can be."""
    if not certificate.points:
        return StoredCertificate(multiplier=certificate.multiplier, double_root=certificate.double_root)
    offsets = tuple(offset_to(row, point) for point in certificate.points)
    if len(offsets) == 1:
        return StoredCertificate(offsets=offsets)
    center, far = offsets
    if len(row) > 7:
        shorter = _rounded(far)
    else:
        shorter = _cut_off(next(offset for offset in _slid(row, far) if shows_crossing(row, (center, offset))))
    return StoredCertificate(
        offsets=(center, next(shortened for shortened in shorter if shows_crossing(row, (center, shortened))))
    )


def _slid(row: Row, offset: Offset) -> Iterator[Offset]:
    """The offset, then others beside it in the plane through both axes, ever nearer to it and all in the spheroid.

    A proof of contact may end at a point of the spheroid's own surface that lies on the hyperboloid. Where the two
    cross there, the hyperboloid's other side lies that way: (−w s, −w t, s² + t²) is at right angles to (s, t, w) and
    no longer than 1, so that a step η along it and a shrinking by 1 − η² lead into the spheroid, farther across than
    in. At a tip of the spheroid, s = t = 0, it is 0, and the way to the hyperboloid's axis stands for it.
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
    """The offset with each part cut off after more and more bits, so that it stays in the spheroid; at last itself."""
    for bits in _bits():
        s, t, w = (Fraction(int(part * (1 << bits)), 1 << bits) for part in offset)
        yield (s, t, w)
    yield offset


def _rounded(offset: Offset) -> Iterator[Offset]:
    """The offset, a little shortened, with more and more bits; at last itself."""
    longest = max(map(abs, offset))
    unit = Fraction(2) ** (longest.numerator.bit_length() - longest.denominator.bit_length())
    for bits in _bits():
        step, share = unit / (1 << bits), 1 - Fraction(1, 1 << bits)
        s, t, w = (round(part * share / step) * step for part in offset)
        yield (s, t, w)
    yield offset


def _bits() -> Iterator[int]:
    bits = 1
    while bits < _MOST_BITS:
        yield bits
        bits += 1 + bits // 4


def shows_crossing(row: Row, offsets: Sequence[Offset]) -> bool:
    """Whether these points of the closed spheroid prove a contact that is no tangency.

    A spheroid that only touches has all its points on one side or on the surface, and none of its inner ones on the
    surface: two points strictly on either side, or an inner one on the surface, prove that it does more.
    """
    alpha, gamma, b, d, _, _, _, *axis = map(Fraction, row)
    sides = set()
    for offset in offsets:
        reach = dot(offset, offset)
        if axis:
            reach += (b * b / (d * d) - 1) * dot(offset, axis) ** 2 / dot(axis, axis)
        if reach > 1:
            return False
        u, v, height = point_at(row, offset)
        level = (u * u + v * v) / alpha**2 - (height / gamma) ** 2 - 1
        if level == 0 and reach < 1:
            return True
        sides.add((level > 0) - (level < 0))
    return {-1, 1} <= sides
