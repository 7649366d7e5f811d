"""Making a case: the exact decision, the measures, and the shortest proof that is found, in a file's own terms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import count

from hypcheck.casebook.frozen.flags import flags_of
from hypcheck.casebook.frozen.model import Offset, Row, Vector, Witness
from hypcheck.pairs import Lengths, Pair, Position
from hypcheck.truth import exact, flip
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.nearest import nearest
from hypcheck.truth.prove import prove

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
        witness=witness(pair, prove(pair, decision)),
        flags=flags,
    )


def flips(lengths: Lengths, truth: Decision) -> Mapping[Position, float]:
    """The distance to each other position, in the order exterior, contact, interior."""
    others = (other for other in Position if other is not truth.position)
    return {other: flip.backward_error(lengths, truth, other) for other in others}


def witness(pair: Pair, certificate: Certificate) -> Witness:
    """The certificate in a file's terms; of two points of a crossing the second is rounded as far as it can be."""
    if not certificate.points:
        return Witness(multiplier=certificate.multiplier, double_root=certificate.double_root)
    _, _, b, d, x, y, z = map(Fraction, pair.row)
    offsets = [((u - x) / b, (v - y) / b, (w - z) / d) for u, v, w in certificate.points]
    if len(offsets) == 1:
        return Witness(offsets=tuple(offsets))
    center, touched = offsets
    far = next(offset for offset in _slid(touched) if shows_crossing(pair, (center, offset)))
    shorter = next(offset for offset in _cut_off(far) if shows_crossing(pair, (center, offset)))
    return Witness(offsets=(center, shorter))


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
