"""The labels of a case about a way (answer, first contact, flags, proof), and whether a file's are true.

Answer and first contact follow from the certificate alone (truth/passage_certificate.py, rational arithmetic). Labels
are made by steps or by roots (truth/swept.py), which share nothing with it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from hypcheck.geometry.pair import COLUMNS, SIZES, WAY_COLUMNS, Position
from hypcheck.tables.numbers import decimal_of
from hypcheck.truth.passage_certificate import check_passage, contact_at, place
from hypcheck.truth.passage_prove import prove
from hypcheck.truth.swept import journey_of
from hypcheck.vectors.family import Row
from hypcheck.vectors.labels import LabelFault, wrong_flags
from hypcheck.vectors.ways.format import Bounds, StoredPassage, WayFile, WayVector


def labelled_ways(cases: Iterable[tuple[str, Row]]) -> list[WayVector]:
    """Cases with every label and flag, from ids and valid rows. Raises ValueError as `prove` does."""
    return [_labelled(name, row) for name, row in cases]


def _labelled(name: str, row: Row) -> WayVector:
    _, first, certificate = prove(row)
    witness = StoredPassage(certificate.pieces, certificate.time, (), certificate.double_root)
    if certificate.time is not None and certificate.points:
        b, (x, y, z) = Fraction(row[2]), place(row, certificate.time).row[len(SIZES) :]
        offsets = tuple(((u - x) / b, (v - y) / b, (w - z) / b) for u, v, w in certificate.points)
        witness = StoredPassage(certificate.pieces, certificate.time, offsets)
    return WayVector(name, row, first, witness, way_flags(row, first, witness))


def way_flags(row: Row, first: Bounds | None, witness: StoredPassage) -> tuple[str, ...]:
    """What is special about a case; positions at its ends are decided exactly."""
    start, end, axis = row[4:7], row[7:10], row[len(WAY_COLUMNS) :]
    ends = [_position(row, Fraction(time)) for time in (0, 1)]
    found = {
        "tunnelling": first is not None and ends[0] is ends[1] is not Position.CONTACT,
        "tangent": witness.double_root is not None,
        "contact-at-start": ends[0] is Position.CONTACT,
        "contact-at-end-alone": first is not None and first[0] < 1 == witness.time and first[1] == 1,
        "still": start == end,
        "vertical-way": start[:2] == end[:2] and start[2] != end[2],
        "horizontal-way": start[2] == end[2] and start[:2] != end[:2],
        "upright": bool(axis) and (not any(axis[:2]) or row[2] == row[3]),
    }
    return tuple(name for name, holds in found.items() if holds)


def _position(row: Row, time: Fraction) -> Position:
    return journey_of(row[:4], row[4 : len(COLUMNS)], row[7:10], row[len(WAY_COLUMNS) :] or None).position(time)


def faults_of_ways(file: WayFile) -> list[LabelFault]:
    """Every wrong label of a file of cases, in order."""
    return [
        LabelFault(line, case.id, sentence)
        for line, case in zip(file.lines or (0,) * len(file.cases), file.cases, strict=True)
        for sentence in _sentences(case)
    ]


def _sentences(case: WayVector) -> Iterator[str]:
    if not check_passage(case.row, case.certificate, case.first):
        if case.first is None:
            yield "the certificate does not prove that the way is clear"
        elif contact_at(case.row, case.certificate) is None:
            yield "the certificate does not prove contact at its time"
        else:
            said = f"{decimal_of(case.first[0])} … {decimal_of(case.first[1])}"
            yield f"the certificate does not prove that the first contact is at {said}"
    yield from wrong_flags(case, way_flags(case.row, case.first, case.witness))
