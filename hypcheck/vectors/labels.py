"""The labels of a case (decision, measures, flags, shortest proof), and whether those of a file are true.

Each label of a file is proved, or computed anew by an oracle that did not make it. Position and tangency follow from
the certificate alone (truth/certificate.py and shows_crossing, rational arithmetic); the roots give the kind, the
nearest point the clearance. Labels are made by the exact decision, which shares nothing with these.
Distances to other answers rest on exact decisions and are computed anew, and so are the flags.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import count

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.tables.numbers import decimal_of
from hypcheck.truth import backward_error, exact
from hypcheck.truth.certificate import Certificate, check_certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest_exact import nearest
from hypcheck.truth.prove import prove
from hypcheck.truth.roots import classify_by_roots
from hypcheck.vectors.family import LabelledCase, Offset, Row, StoredCertificate, Vector, VectorFile
from hypcheck.vectors.flags import flags_of
from hypcheck.vectors.frozen import InvalidRowFile, columns_at_fault

_MOST_BITS = 1 << 14


def labelled(cases: Iterable[tuple[str, Row]]) -> list[Vector]:
    """Cases with every label and flag, from ids and valid rows."""
    named = list(cases)
    rows = [row for _, row in named]
    decisions = [exact.decide(Pair.from_row(row).lengths) for row in rows]
    flags = flags_of(rows, decisions) if rows else []
    return [
        _labelled(name, row, decision, flags_of_row)
        for (name, row), decision, flags_of_row in zip(named, decisions, flags, strict=True)
    ]


def _labelled(name: str, row: Row, decision: Decision, flags: tuple[str, ...]) -> Vector:
    pair = Pair.from_row(row)
    return Vector(
        id=name,
        row=row,
        position=decision.position,
        tangent=decision.tangent,
        kind=decision.kind,
        clearance=nearest(pair).clearance,
        flips=flips(pair.lengths, decision),
        witness=stored_certificate(pair, prove(pair, decision)),
        flags=flags,
    )


def flips(lengths: Lengths, truth: Decision) -> Mapping[Position, float]:
    """The distance to each other position, in the order exterior, contact, interior."""
    others = (other for other in Position if other is not truth.position)
    return {other: backward_error.backward_error(lengths, truth, other) for other in others}


def stored_certificate(pair: Pair, certificate: Certificate) -> StoredCertificate:
    """The certificate in a file's terms; of two points of a crossing the second is rounded as far as it can be."""
    if not certificate.points:
        return StoredCertificate(multiplier=certificate.multiplier, double_root=certificate.double_root)
    _, _, b, d, x, y, z = map(Fraction, pair.row)
    offsets = [((u - x) / b, (v - y) / b, (w - z) / d) for u, v, w in certificate.points]
    if len(offsets) == 1:
        return StoredCertificate(offsets=tuple(offsets))
    center, touched = offsets
    far = next(offset for offset in _slid(touched) if shows_crossing(pair, (center, offset)))
    shorter = next(offset for offset in _cut_off(far) if shows_crossing(pair, (center, offset)))
    return StoredCertificate(offsets=(center, shorter))


def _slid(offset: Offset) -> Iterator[Offset]:
    """The offset, then others beside it in the plane through both axes, ever nearer to it and all in the spheroid.

    A proof of contact may end at a point of the spheroid's own surface that lies on the hyperboloid. Where the two
    cross there, the hyperboloid's other side lies that way: (−w s, −w t, s² + t²) is at right angles to (s, t, w) and
    no longer than 1, so that a step η along it and a shrinking by 1 − η² lead into the spheroid, farther across than
    in.
    """
    yield offset
    s, t, w = offset
    for halvings in count(1):
        for step in (Fraction(1, 1 << halvings), Fraction(-1, 1 << halvings)):
            shrunk = 1 - step * step
            yield (
                (s - step * w * s) * shrunk,
                (t - step * w * t) * shrunk,
                (w + step * (s * s + t * t)) * shrunk,
            )


def _cut_off(offset: Offset) -> Iterator[Offset]:
    """The offset with each part cut off after more and more bits, so that it stays in the spheroid; at last itself."""
    bits = 1
    while bits < _MOST_BITS:
        s, t, w = (Fraction(_toward_zero(part * (1 << bits)), 1 << bits) for part in offset)
        yield (s, t, w)
        bits += 1 + bits // 4
    yield offset


def _toward_zero(value: Fraction) -> int:
    whole = abs(value.numerator) // value.denominator
    return whole if value >= 0 else -whole


def shows_crossing(pair: Pair, offsets: Sequence[Offset]) -> bool:
    """Whether these points of the closed spheroid prove a contact that is no tangency.

    A spheroid that only touches has all its points on one side or on the surface, and none of its inner ones on the
    surface: two points strictly on either side, or an inner one on the surface, prove that it does more.
    """
    alpha, gamma, b, d, x, y, z = map(Fraction, pair.row)
    sides = set()
    for s, t, w in offsets:
        reach = s * s + t * t + w * w
        if reach > 1:
            return False
        u, v, height = x + b * s, y + b * t, z + d * w
        level = (u * u + v * v) / alpha**2 - (height / gamma) ** 2 - 1
        if level == 0 and reach < 1:
            return True
        sides.add((level > 0) - (level < 0))
    return {-1, 1} <= sides


@dataclass(frozen=True, slots=True)
class LabelFault:
    """A label that is wrong: the line of its case (0 where it was not read from a file), its id, and what is wrong."""

    line: int
    case: str
    sentence: str


def faults_of_vectors(file: VectorFile) -> list[LabelFault]:
    """Every wrong label of a file of cases, in order."""
    lines = file.lines or (0,) * len(file.cases)
    decisions = [exact.decide(case.pair.lengths) for case in file.cases]
    flags = flags_of([case.row for case in file.cases], decisions) if file.cases else []
    faults = []
    for line, case, truth, computed in zip(lines, file.cases, decisions, flags, strict=True):
        faults += [LabelFault(line, case.id, sentence) for sentence in _sentences(case, truth, computed)]
    return faults


def faults_of_invalid_rows(file: InvalidRowFile) -> list[LabelFault]:
    """Every row that is valid, or refused for other columns than the file says."""
    faults = []
    for line, case in zip(file.lines or (0,) * len(file.cases), file.cases, strict=True):
        found = columns_at_fault(case.row, file.columns)
        if found != case.columns:
            said = f"columns {', '.join(case.columns)} are said to be at fault"
            faults.append(LabelFault(line, case.id, f"{said}, but {', '.join(found) or 'none'} is"))
    return faults


def _sentences(case: Vector, truth: Decision, flags: Sequence[str]) -> Iterator[str]:
    pair = case.pair
    proved = check_certificate(pair, case.witness.certificate(pair, case.position))
    double = case.witness.double_root is not None
    yield from unproved(case.position, case.tangent, double, proved, lambda: shows_crossing(pair, case.witness.offsets))
    kind = classify_by_roots(pair).kind
    if kind is not case.kind:
        yield f"kind is {case.kind.value}; the roots say {kind.value}"
    measured = nearest(pair)
    if measured.clearance != case.clearance:
        yield f"clearance is {decimal_of(case.clearance)}; the nearest point says {decimal_of(measured.clearance)}"
    if (truth.position, truth.tangent) != (case.position, case.tangent):
        return  # its flips are to other positions
    for position, distance in flips(pair.lengths, truth).items():
        if distance != case.flips[position]:
            yield f"the flip to {position.label} is {decimal_of(case.flips[position])}; it is {decimal_of(distance)}"
    yield from wrong_flags(case, flags)


def unproved(
    position: Position, tangent: bool, double: bool, proved: bool, crosses: Callable[[], bool]
) -> Iterator[str]:
    """What a certificate does not prove of position and tangency.

    `double`: it has a double root. `proved`: it proves the position. `crosses` says whether its points prove a contact
    that is no tangency.
    """
    claim = f"{position.label}, tangent" if tangent else position.label
    if not proved:
        yield f"the certificate does not prove {claim}"
    elif tangent != (position is Position.CONTACT and double):
        yield f"the certificate is not one of a pair that is {claim}"
    elif position is Position.CONTACT and not tangent and not crosses():
        yield "the certificate proves contact, but does not rule tangency out"


def wrong_flags(case: LabelledCase, flags: Sequence[str]) -> Iterator[str]:
    """A sentence if the flags of a case are others than these."""
    if set(flags) != set(case.flags):
        yield f"flags are {', '.join(case.flags) or 'none'}; they are {', '.join(flags) or 'none'}"
