"""The cases of a file about ways: what one holds, read strictly, and written as the same bytes.

All but the cases themselves is as in files about positions (vectors/format.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import NO_DIRECTION, WAY_COLUMNS
from hypcheck.geometry.rows import Rows
from hypcheck.tables.numbers import exact_text, hex_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of, read_document
from hypcheck.truth.passage_certificate import PassageCertificate, place
from hypcheck.vectors.family import CaseFile, FlagFacts, Offset, Row
from hypcheck.vectors.format import (
    COLUMNS_OF,
    TILTED_WAYS,
    WAYS,
    cases_of,
    check_hex,
    content_of,
    document_text,
    flags_of_case,
    json_text,
    listed,
    number_of,
    numbers_text,
    object_text,
    offset_of,
    rational_at,
    read_metadata,
    row_of,
)

CASE_FIELDS = ("id", "row", "hex", "hit", "first", "first_hex", "certificate", "flags")
CERTIFICATE_FIELDS = ("pieces", "time", "points", "double_root")

Bounds = tuple[float, float]


@dataclass(frozen=True, slots=True)
class StoredPassage:
    """A proof as files hold it: see truth/passage_certificate.py. Points are (X − C)/b at the time of the proof."""

    pieces: tuple[tuple[Fraction, Fraction], ...] = ()
    time: Fraction | None = None
    offsets: tuple[Offset, ...] = ()
    double_root: Fraction | None = None


@dataclass(frozen=True, slots=True)
class WayVector:
    """A case: a valid row of ten or thirteen numbers, its answer, and what proves it.

    `first` are bounds of the first contact: two neighbouring float64 numbers, or 0 twice; None where the way is clear.
    """

    id: str
    row: Row
    first: Bounds | None
    witness: StoredPassage
    flags: tuple[str, ...] = ()

    @property
    def hit(self) -> bool:
        """Whether there is contact somewhere on the way, its ends included."""
        return self.first is not None

    @property
    def certificate(self) -> PassageCertificate:
        """What proves the answer, its points in the caller's coordinates."""
        time, b = self.witness.time, Fraction(self.row[2])
        if time is None:
            return PassageCertificate(self.witness.pieces)
        x, y, z = place(self.row, time).row[4:]
        points = tuple((x + b * s, y + b * t, z + b * w) for s, t, w in self.witness.offsets)
        return PassageCertificate(self.witness.pieces, time, points, self.witness.double_root)


class WayFile(CaseFile[WayVector]):
    """A file about ways."""

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, 10 or 13)."""
        return np.asarray([case.row for case in self.cases], dtype=np.float64)

    @property
    def hits(self) -> NDArray[np.int8]:
        """The right answers: 1 for contact on the way, 0 for none, int8 (n,)."""
        return np.asarray([case.hit for case in self.cases], dtype=np.int8)


def read_ways(path: str) -> WayFile:
    """The file at `path`. Raises InputError where it is not wholly as the schema demands."""
    return ways_of(read_document(path), path)


def ways_of(document: JsonDocument, path: str) -> WayFile:
    """The file about ways that a document is. Raises InputError where it is none."""
    content = content_of(document, path)
    head, flags = read_metadata(document, path, content if content in (WAYS, TILTED_WAYS) else WAYS)
    columns = COLUMNS_OF[content]
    cases = cases_of(document, path, head.name, CASE_FIELDS, lambda at, fields: _vector(at, fields, flags, columns))
    return WayFile(head, flags, cases, tuple(at.line for at, _ in document.cases))


def _vector(
    at: JsonPlace, fields: dict[str, Any], flags: Mapping[str, FlagFacts], columns: tuple[str, ...]
) -> WayVector:
    row = row_of(at, fields["row"], fields["hex"], columns)
    if len(columns) > len(WAY_COLUMNS) and not any(row[len(WAY_COLUMNS) :]):
        raise InputError(f"{at}: {NO_DIRECTION}")
    first = _first(at, fields["first"], fields["first_hex"])
    if fields["hit"] is not (first is not None):
        raise InputError(
            f"{at}: hit is {shown_json(fields['hit'])}; with first {shown_json(fields['first'])} it must be "
            f"{json_text(first is not None)}"
        )
    witness = _witness(at, fields["certificate"])
    return WayVector(fields["id"], row, first, witness, flags_of_case(at, fields["flags"], flags))


def _first(at: JsonPlace, value: Any, hexes: Any) -> Bounds | None:  # noqa: ANN401 - JSON
    if value is None:
        if hexes is not None:
            raise InputError(f"{at}: first_hex is {shown_json(hexes)}; it must be null, as first is")
        return None
    lower, upper = (number_of(at, "first", end) for end in listed(at, "first", value, 2))
    for end, text in zip((lower, upper), listed(at, "first_hex", hexes, 2), strict=True):
        check_hex(at, "first_hex", text, end)
    if not 0 <= lower <= upper <= 1:
        raise InputError(f"{at}: first is {shown_json(value)}; it must be two times from 0 to 1, the lower first")
    return lower, upper


def _witness(at: JsonPlace, value: Any) -> StoredPassage:  # noqa: ANN401 - JSON
    found = dict(zip(CERTIFICATE_FIELDS, fields_of(value, CERTIFICATE_FIELDS, at, "certificate"), strict=True))
    pieces = []
    for piece in listed(at, "pieces", found["pieces"]):
        multiplier, end = (rational_at(at, "a piece", part) for part in listed(at, "a piece", piece, 2))
        pieces.append((multiplier, end))
    time, root = (
        None if found[name] is None else rational_at(at, name, found[name]) for name in ("time", "double_root")
    )
    points = tuple(offset_of(at, point) for point in listed(at, "points", found["points"]))
    if len(points) > 2:
        raise InputError(f"{at}: points has {len(points)} points; it may have two at most")
    if (time is None) != (not points and root is None) or (points and root is not None):
        raise InputError(f"{at}: a certificate has a time with points or a double_root, or none of the three")
    return StoredPassage(tuple(pieces), time, points, root)


def ways_text(file: WayFile) -> str:
    """The whole document, ASCII but for the descriptions, with an end of line after every case."""
    wide = any(len(case.row) > len(WAY_COLUMNS) for case in file.cases)
    return document_text(TILTED_WAYS if wide else WAYS, file.head, file.flags, map(way_text, file.cases))


def way_text(case: WayVector) -> str:
    """One case, an object on one line."""
    witness = case.witness
    members = {
        "pieces": [[exact_text(part) for part in piece] for piece in witness.pieces],
        "time": None if witness.time is None else exact_text(witness.time),
        "points": [[exact_text(part) for part in point] for point in witness.offsets],
        "double_root": None if witness.double_root is None else exact_text(witness.double_root),
    }
    return object_text(
        {
            "id": json_text(case.id),
            "row": numbers_text(case.row),
            "hex": json_text([hex_of(value) for value in case.row]),
            "hit": json_text(case.hit),
            "first": "null" if case.first is None else numbers_text(case.first),
            "first_hex": "null" if case.first is None else json_text([hex_of(end) for end in case.first]),
            "certificate": json_text(members),
            "flags": json_text(case.flags),
        }
    )
