"""The labels of a case about a tilted spheroid (decision, measures, flags, proof), and whether a file's are true.

Position and tangency follow from the certificate alone (truth/tilted/certificate.py, rational arithmetic), each end of
a flip from a proof of its own; the clearance is asked of the nearest point. Labels are made by the exact decision,
which shares nothing with these.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

import numpy as np

from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import within
from hypcheck.tables.numbers import decimal_of
from hypcheck.truth import exact as upright
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.tilted import exact
from hypcheck.truth.tilted.backward_error import bracket, excluded_at_once, goal_of, is_bracket
from hypcheck.truth.tilted.certificate import check_certificate
from hypcheck.truth.tilted.exact import Bracket, TiltedDecision
from hypcheck.truth.tilted.nearest import nearest
from hypcheck.truth.tilted.pair import TiltedPair
from hypcheck.truth.tilted.prove import prove
from hypcheck.vectors.family import Offset, Row, StoredCertificate
from hypcheck.vectors.labels import LabelFault, unproved, wrong_flags
from hypcheck.vectors.tilted.format import TiltedVector, TiltedVectorFile

_MOST_BITS = 1 << 14
_SHORTEST, _LONGEST = 2.0**-511, 2.0**511
"""Between these a length's square neither underflows nor overflows."""


def labelled_tilted(cases: Iterable[tuple[str, Row]]) -> list[TiltedVector]:
    """Cases with every label and flag, from ids and valid rows."""
    return [_labelled(name, row) for name, row in cases]


def _labelled(name: str, row: Row) -> TiltedVector:
    pair = TiltedPair.from_row(row)
    decision = exact.decide(pair.lengths)
    return TiltedVector(
        id=name,
        row=row,
        position=decision.position,
        tangent=decision.tangent,
        clearance=nearest(pair).clearance,
        flips=tilted_flips(row, decision),
        witness=_stored(pair, prove(pair, decision)),
        flags=tilted_flags(pair, decision),
    )


def tilted_flips(row: Row, decision: TiltedDecision) -> dict[Position, Bracket]:
    """The bracket of each other position, in the order exterior, contact, interior."""
    return {
        other: bracket(row, decision, other, cuts=0, steps=2) for other in Position if other is not decision.position
    }


def tilted_flags(pair: TiltedPair, decision: TiltedDecision) -> tuple[str, ...]:
    """What is special about a case, each decided exactly."""
    lengths, sizes = pair.lengths, pair.row[:7]
    vertical = lengths.upright is not None
    double = not vertical and exact.discriminant(exact.quartic(lengths)) == 0
    v_x, v_y, v_z = lengths.axis
    across = lengths.x * v_y - lengths.y * v_x
    leaning = lengths.y * v_z - lengths.z * v_y, lengths.z * v_x - lengths.x * v_z
    largest = max(map(abs, pair.axis))
    found = {
        "tangent": decision.tangent,
        "quartic-ring": double and decision.position is not Position.CONTACT,
        "quartic-delta=0": double,
        "tilt-matters": upright.position(Pair(*sizes).lengths) is not decision.position,
        "vertical-axis": v_x == v_y == 0,
        "horizontal-axis": v_z == 0,
        "sphere": pair.b == pair.d,
        "meridian-plane": across == 0,
        "through-the-origin": across == leaning[0] == leaning[1] == 0,
        "on-axis": lengths.x == lengths.y == 0,
        "on-surface": (lengths.x**2 + lengths.y**2) * lengths.gamma**2
        == lengths.alpha**2 * (lengths.gamma**2 + lengths.z**2),
        "long-axis": not _SHORTEST <= largest <= _LONGEST,
        "extreme": not within(np.asarray([sizes]))[0],
    }
    return tuple(name for name, holds in found.items() if holds)


def _stored(pair: TiltedPair, certificate: Certificate) -> StoredCertificate:
    """The certificate in a file's terms; of two points of a crossing the second is rounded as far as it can be."""
    if not certificate.points:
        return StoredCertificate(multiplier=certificate.multiplier, double_root=certificate.double_root)
    b, x, y, z = map(Fraction, (pair.b, pair.x, pair.y, pair.z))
    offsets = [((u - x) / b, (v - y) / b, (w - z) / b) for u, v, w in certificate.points]
    if len(offsets) == 1:
        return StoredCertificate(offsets=tuple(offsets))
    center, far = offsets
    shorter = next(offset for offset in _rounded(far) if shows_tilted_crossing(pair, (center, offset)))
    return StoredCertificate(offsets=(center, shorter))


def _rounded(offset: Offset) -> Iterator[Offset]:
    """The offset, a little shortened, with more and more bits; at last itself."""
    longest = max(map(abs, offset))
    unit = Fraction(2) ** (longest.numerator.bit_length() - longest.denominator.bit_length())
    bits = 1
    while bits < _MOST_BITS:
        step, share = unit / (1 << bits), 1 - Fraction(1, 1 << bits)
        s, t, w = (round(part * share / step) * step for part in offset)
        yield (s, t, w)
        bits += 1 + bits // 4
    yield offset


def shows_tilted_crossing(pair: TiltedPair, offsets: Sequence[Offset]) -> bool:
    """Whether these points C + b·offset of the closed spheroid prove a contact that is no tangency.

    A spheroid that only touches has all its points on one side or on the surface, and none of its inner ones on the
    surface: two points strictly on either side, or an inner one on the surface, prove that it does more.
    """
    alpha, gamma, b, d, x, y, z, *axis = map(Fraction, pair.row)
    square, sides = sum(each * each for each in axis), set()
    for s, t, w in offsets:
        along = (s * axis[0] + t * axis[1] + w * axis[2]) ** 2 / square
        reach = s * s + t * t + w * w + (b * b / (d * d) - 1) * along
        if reach > 1:
            return False
        u, v, height = x + b * s, y + b * t, z + b * w
        level = (u * u + v * v) / alpha**2 - (height / gamma) ** 2 - 1
        if level == 0 and reach < 1:
            return True
        sides.add((level > 0) - (level < 0))
    return {-1, 1} <= sides


def faults_of_tilted(file: TiltedVectorFile) -> list[LabelFault]:
    """Every wrong label of a file of cases, in order."""
    proved = _proved_lower_ends(file.cases)
    return [
        LabelFault(line, case.id, sentence)
        for line, case, proofs in zip(file.lines or (0,) * len(file.cases), file.cases, proved, strict=True)
        for sentence in _sentences(case, proofs)
    ]


def _proved_lower_ends(cases: Sequence[TiltedVector]) -> list[set[Position]]:
    """For each case the other positions whose lower end float64 proves, all cases at once: most, in little time."""
    proved: list[set[Position]] = [set() for _ in cases]
    asked = [
        (place, other, ends.lower)
        for place, case in enumerate(cases)
        for other, ends in case.flips.items()
        if other is not case.position and 0 < ends.lower < 1
    ]
    goals = [goal_of(cases[place].position, other) for place, other, _ in asked]
    rows = [cases[place].row for place, *_ in asked]
    for (place, other, _), holds in zip(asked, excluded_at_once(rows, goals, [low for *_, low in asked]), strict=True):
        if holds:
            proved[place].add(other)
    return proved


def _sentences(case: TiltedVector, proved: set[Position]) -> Iterator[str]:
    pair = case.pair
    proves = check_certificate(pair, case.certificate)
    double = case.witness.double_root is not None
    yield from unproved(
        case.position, case.tangent, double, proves, lambda: shows_tilted_crossing(pair, case.witness.offsets)
    )
    measured = nearest(pair)
    if measured.clearance != case.clearance:
        yield f"clearance is {decimal_of(case.clearance)}; the nearest point says {decimal_of(measured.clearance)}"
    truth = exact.decide(pair.lengths)
    if (truth.position, truth.tangent) != (case.position, case.tangent):
        return  # its flips are to other positions
    for other, ends in case.flips.items():
        if not is_bracket(case.row, truth, other, ends, cuts=0, lower_holds=other in proved):
            said = f"{decimal_of(ends.lower)} … {decimal_of(ends.upper)}"
            yield f"the flip to {other.label} is {said}; no proof of both ends is found"
    yield from wrong_flags(case, tilted_flags(pair, truth))
