"""The cases of a file about tilted spheroids: what one holds, read strictly, and written as the same bytes.

All but the cases themselves is as in files about upright spheroids (vectors/format.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import NO_DIRECTION, TILTED_COLUMNS, Position
from hypcheck.geometry.rows import Positions, Rows
from hypcheck.tables.numbers import decimal_of, hex_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of, read_document
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.tilted.exact import Bracket
from hypcheck.truth.tilted.pair import TiltedPair
from hypcheck.vectors.family import CaseFile, FlagFacts, Row, StoredCertificate
from hypcheck.vectors.format import (
    TILTED_POSITIONS,
    cases_of,
    certificate_members,
    check_hex,
    document_text,
    flags_of_case,
    json_text,
    listed,
    measure_of,
    numbers_text,
    object_text,
    position_of,
    read_metadata,
    row_of,
    witness_of,
)

CASE_FIELDS = (
    *("id", "row", "hex", "position", "tangent", "clearance", "clearance_hex"),
    *("flips", "certificate", "flags"),
)


@dataclass(frozen=True, slots=True)
class TiltedVector:
    """A case: a valid row of ten numbers, its labels, and what proves them.

    `clearance` is in spheroid radii, to within an ulp, inf beyond float64. `flips` has the bracket of the backward
    error of each other position. Points of the witness are (X − C)/b. `flags` are names out of flags.TILTED_FLAGS.
    """

    id: str
    row: Row
    position: Position
    tangent: bool
    clearance: float
    flips: Mapping[Position, Bracket]
    witness: StoredCertificate
    flags: tuple[str, ...] = ()

    @property
    def pair(self) -> TiltedPair:
        """The row as a query."""
        return TiltedPair.from_row(self.row)

    @property
    def certificate(self) -> Certificate:
        """What proves the position, its points in the caller's coordinates."""
        b, x, y, z = map(Fraction, (self.row[2], *self.row[4:7]))
        points = tuple((x + b * s, y + b * t, z + b * w) for s, t, w in self.witness.offsets)
        return Certificate(self.position, self.witness.multiplier, points, self.witness.double_root)


class TiltedVectorFile(CaseFile[TiltedVector]):
    """A file about positions of spheroids that lean."""

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, 10)."""
        return np.asarray([case.row for case in self.cases]).reshape(len(self.cases), len(TILTED_COLUMNS))

    @property
    def positions(self) -> Positions:
        """The right answers, int8 (n,)."""
        return np.asarray([case.position for case in self.cases], dtype=np.int8)


def read_tilted_vectors(path: str) -> TiltedVectorFile:
    """The vector file at `path`. Raises InputError where it is not wholly as the schema demands."""
    return tilted_vectors_of(read_document(path), path)


def tilted_vectors_of(document: JsonDocument, path: str) -> TiltedVectorFile:
    """The vector file that a document is. Raises InputError where it is none."""
    head, flags = read_metadata(document, path, TILTED_POSITIONS)
    cases = cases_of(document, path, head.name, CASE_FIELDS, lambda place, fields: _vector(place, fields, flags))
    return TiltedVectorFile(head, flags, cases, tuple(place.line for place, _ in document.cases))


def _vector(place: JsonPlace, fields: dict[str, Any], flags: Mapping[str, FlagFacts]) -> TiltedVector:
    position = position_of(place, fields["position"])
    if not isinstance(fields["tangent"], bool):
        raise InputError(f"{place}: tangent is {shown_json(fields['tangent'])}; it must be true or false")
    row = row_of(place, fields["row"], fields["hex"], TILTED_COLUMNS)
    if not any(row[7:]):
        raise InputError(f"{place}: {NO_DIRECTION}")
    clearance = measure_of(place, "clearance", fields["clearance"])
    check_hex(place, "clearance_hex", fields["clearance_hex"], clearance)
    return TiltedVector(
        id=fields["id"],
        row=row,
        position=position,
        tangent=fields["tangent"],
        clearance=clearance,
        flips=_flips(place, fields["flips"], position),
        witness=witness_of(place, fields["certificate"]),
        flags=flags_of_case(place, fields["flags"], flags),
    )


def _flips(place: JsonPlace, value: Any, position: Position) -> Mapping[Position, Bracket]:  # noqa: ANN401 - JSON
    others = [other for other in Position if other is not position]
    names = tuple(other.label for other in others)
    brackets = []
    for name, ends in zip(names, fields_of(value, names, place, "flips"), strict=True):
        what = f"the flip to {name}"
        lower, upper = (measure_of(place, what, end) for end in listed(place, what, ends, 2))
        if not (0 <= lower <= upper <= 1 or lower == upper == float("inf")):
            raise InputError(
                f"{place}: {what} is {shown_json(ends)}; it must be two numbers from 0 to 1, the lower "
                'first, or "inf" twice'
            )
        brackets.append(Bracket(lower, upper))
    return dict(zip(others, brackets, strict=True))


def tilted_vectors_text(file: TiltedVectorFile) -> str:
    """The whole document, ASCII but for the descriptions, with an end of line after every case."""
    return document_text(TILTED_POSITIONS, file.head, file.flags, [tilted_vector_text(case) for case in file.cases])


def tilted_vector_text(case: TiltedVector) -> str:
    """One case, an object on one line."""
    flips = {other.label: numbers_text((ends.lower, ends.upper)) for other, ends in case.flips.items()}
    return object_text(
        {
            "id": json_text(case.id),
            "row": numbers_text(case.row),
            "hex": json_text([hex_of(value) for value in case.row]),
            "position": str(int(case.position)),
            "tangent": json_text(case.tangent),
            "clearance": decimal_of(case.clearance),
            "clearance_hex": json_text(hex_of(case.clearance)),
            "flips": object_text(flips),
            "certificate": json_text(certificate_members(case.witness)),
            "flags": json_text(case.flags),
        }
    )
