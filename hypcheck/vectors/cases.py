"""Vector files: the content of cases with answers; whole files are read strictly, and written.

Cases are about positions, of upright spheroids or of tilted ones, or about sweeps. format.py has the other parts of a
file, and invalid_rows.py has the rows that must be refused.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, cast

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import PAIRS
from hypcheck.tables.numbers import decimal_of, exact_text, hex_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of, read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.truth.certificate import Certificate, PassageCertificate, Piece, place
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.family import Row
from hypcheck.vectors.flags import FlagFacts
from hypcheck.vectors.format import (
    CaseFile,
    Content,
    check_hex,
    content_of,
    document_text,
    file_of,
    flags_of_case,
    is_integer,
    json_text,
    listed,
    number_of,
    numbers_text,
    object_text,
    rational_at,
    row_of,
    text_of,
)
from hypcheck.vectors.invalid_rows import InvalidRow, invalid_row_text, invalid_rows_of

Offset = tuple[Fraction, Fraction, Fraction]
Bounds = tuple[float, float]


@dataclass(frozen=True, slots=True)
class StoredCertificate:
    """A certificate in the form of the files: it has a multiplier λ, a double root m, or points.

    Points are offsets (s, t, w) from the spheroid's centre, so that short numbers suffice. In rows of seven numbers a
    point is (x + b s, y + b t, z + d w), and belongs to the spheroid if s² + t² + w² ≤ 1; in all other rows it is (x,
    y, z) + b (s, t, w), on a sweep with the centre at the `time` of the proof. `pieces` prove a clear pair beside a
    hyperboloid that ends; a contact without any of these parts is proved only by the exact rule in the height. `steps`
    are the pieces (λ, end) of a sweep, see truth/certificate.py.
    """

    multiplier: Fraction | None = None
    offsets: tuple[Offset, ...] = ()
    double_root: Fraction | None = None
    pieces: tuple[Piece, ...] = ()
    steps: tuple[tuple[Fraction, Fraction], ...] = ()
    time: Fraction | None = None


@dataclass(frozen=True, slots=True)
class Vector:
    """A case about a position: a valid row (a given −0.0 is kept), its labels, and their proof.

    `kind` is None for a tilted spheroid. `clearance` is in spheroid radii, to within an ulp, inf beyond float64.
    `flips` has the distance to each other position as a bracket; for upright spheroids both ends are the distance that
    truth/backward_error.py measures. If the hyperboloid ends, `kind`, `clearance` and `flips` are missing. `flags` are
    names out of flags.FLAGS or flags.TILTED_FLAGS.
    """

    id: str
    row: Row
    position: Position
    tangent: bool
    witness: StoredCertificate
    kind: Kind | None = None
    clearance: float | None = None
    flips: Mapping[Position, Bracket] = field(default_factory=dict)
    flags: tuple[str, ...] = ()

    @property
    def answer(self) -> int:
        """The position as a number."""
        return int(self.position)

    @property
    def certificate(self) -> Certificate:
        """The certificate of the position, with points in the caller's coordinates."""
        points = tuple(point_at(self.row, offset) for offset in self.witness.offsets)
        witness = self.witness
        return Certificate(self.position, witness.multiplier, points, witness.double_root, witness.pieces)


def units_of(row: Row) -> tuple[Fraction, Fraction, Fraction]:
    """The units of the three parts of an offset: b, b, d in a row of seven numbers, else b."""
    b, d = Fraction(row[2]), Fraction(row[3])
    return b, b, b if PAIRS.has_axis(row) else d


def point_at(row: Row, offset: Offset) -> Offset:
    """The point with this offset from the centre."""
    x, y, z = (Fraction(start) + unit * part for start, unit, part in zip(row[4:7], units_of(row), offset, strict=True))
    return x, y, z


def offset_to(row: Row, point: Offset) -> Offset:
    """The offset of a point from the centre."""
    s, t, w = (
        (part - Fraction(start)) / unit for start, unit, part in zip(row[4:7], units_of(row), point, strict=True)
    )
    return s, t, w


@dataclass(frozen=True, slots=True)
class SweepVector:
    """A case about a sweep: a valid row of ten, thirteen or sixteen numbers, its answer, and the proof.

    `first` are bounds of the time of first contact: two neighbouring float64 numbers, or 0 twice; None if the sweep is
    clear. If the hyperboloid ends, they need not be neighbours, and only the exact decision proves the answer.
    """

    id: str
    row: Row
    first: Bounds | None
    witness: StoredCertificate
    flags: tuple[str, ...] = ()

    @property
    def hit(self) -> bool:
        """Whether there is contact somewhere on the sweep, its ends included."""
        return self.first is not None

    @property
    def answer(self) -> int:
        """1 for contact on the sweep, 0 for none."""
        return int(self.hit)

    @property
    def certificate(self) -> PassageCertificate:
        """The certificate of the answer, with points in the caller's coordinates."""
        witness, b = self.witness, Fraction(self.row[2])
        if witness.time is None:
            return PassageCertificate(witness.steps)
        x, y, z = place(self.row, witness.time).row[4:]
        points = tuple((x + b * s, y + b * t, z + b * w) for s, t, w in witness.offsets)
        return PassageCertificate(witness.steps, witness.time, points, witness.double_root)


AnyVector = Vector | SweepVector
"""A case with an answer."""

_CERTIFICATES = ("multiplier", "points", "double_root")
_PASSAGE_FIELDS = ("pieces", "time", "points", "double_root")
_KINDS = {kind.value: kind for kind in Kind}


def case_fields(content: Content) -> tuple[str, ...]:
    """The fields of a case in a file with that content, in order."""
    head = ("id", "row", "hex")
    if content.about_sweeps:
        return (*head, "hit", "first", "first_hex", *(() if content.ended else ("certificate", "flags")))
    if content.ended:
        return (*head, "position", "tangent", "certificate")
    measures = (*(() if content.tilted else ("kind",)), "clearance", "clearance_hex", "flips")
    return (*head, "position", "tangent", *measures, "certificate", "flags")


def read_cases(path: str, content: Content | None = None) -> CaseFile[Any]:
    """The vector file at `path`, with that content, if one is given.

    Raises InputError if it does not conform to the schema.
    """
    return cases_of(read_document(path), path, content)


def cases_of(document: JsonDocument, path: str, content: Content | None = None) -> CaseFile[Any]:
    """The vector file that a document is, as read_cases reads it. Raises InputError."""
    actual = content_of(document, path)
    if content is not None and content is not actual:
        location = document.members["content"][0]
        wanted = f"{content.name!r}, rows of {len(content.columns)} numbers"
        raise InputError(f"{location}: content is {actual.name!r}; here it must be {wanted}")
    if actual.refused:
        return invalid_rows_of(document, path)
    return file_of(document, path, case_fields(actual), _sweep_case if actual.about_sweeps else _position_case)


def _position_case(at: JsonPlace, fields: dict[str, Any], content: Content, flags: Mapping[str, FlagFacts]) -> Vector:
    position, tangent = _position(at, fields)
    clearance = None
    if "clearance" in fields:
        clearance = _measure(at, "clearance", fields["clearance"])
        check_hex(at, "clearance_hex", fields["clearance_hex"], clearance)
    return Vector(
        id=fields["id"],
        row=row_of(at, fields["row"], fields["hex"], content),
        position=position,
        tangent=tangent,
        kind=_kind(at, fields["kind"]) if "kind" in fields else None,
        clearance=clearance,
        flips=_flips(at, fields["flips"], position, _bracket if content.tilted else _distance)
        if "flips" in fields
        else {},
        witness=(_ended_certificate if content.ended else _certificate)(at, fields["certificate"]),
        flags=flags_of_case(at, fields["flags"], flags) if "flags" in fields else (),
    )


def _position(at: JsonPlace, fields: dict[str, Any]) -> tuple[Position, bool]:
    position, tangent = fields["position"], fields["tangent"]
    if not is_integer(position) or position not in (-1, 0, 1):
        raise InputError(f"{at}: position is {shown_json(position)}; it must be 1, 0 or -1")
    if not isinstance(tangent, bool):
        raise InputError(f"{at}: tangent is {shown_json(tangent)}; it must be true or false")
    return Position(position), tangent


def _ended_certificate(at: JsonPlace, value: Any) -> StoredCertificate:  # noqa: ANN401 - JSON
    if value == {"rule": "height"}:
        return StoredCertificate()
    if not isinstance(value, dict) or set(value) != {"pieces"}:
        return _certificate(at, value)
    return StoredCertificate(pieces=tuple(_piece(at, piece) for piece in listed(at, "pieces", value["pieces"])))


def _piece(at: JsonPlace, value: Any) -> Piece:  # noqa: ANN401 - JSON
    low, high, *numbers = listed(at, "a piece", value, 4)
    multiplier, plane = (rational_at(at, "a piece", number) for number in numbers)
    bottom = None if low == "-inf" else rational_at(at, "a piece", low)
    top = None if high == "inf" else rational_at(at, "a piece", high)
    return Piece(bottom, top, multiplier, plane)


def _kind(at: JsonPlace, value: Any) -> Kind:  # noqa: ANN401 - JSON
    kind = _KINDS.get(text_of(at, "kind", value))
    if kind is None:
        raise InputError(f"{at}: there is no kind {shown_json(value)}; there are {', '.join(_KINDS)}")
    return kind


def _measure(at: JsonPlace, what: str, value: Any) -> float:  # noqa: ANN401 - JSON
    """A number, or inf. Raises InputError."""
    return float("inf") if value == "inf" else number_of(at, what, value)


def _flips(
    at: JsonPlace,
    value: Any,  # noqa: ANN401 - JSON
    position: Position,
    read: Callable[[JsonPlace, str, Any], Bracket],
) -> Mapping[Position, Bracket]:
    others = [other for other in Position if other is not position]
    names = tuple(other.label for other in others)
    distances = zip(others, fields_of(value, names, at, "flips"), strict=True)
    return {other: read(at, f"the flip to {other.label}", distance) for other, distance in distances}


def _distance(at: JsonPlace, what: str, value: Any) -> Bracket:  # noqa: ANN401 - JSON
    distance = _measure(at, what, value)
    if not (0 <= distance <= 1 or distance == float("inf")):
        raise InputError(f'{at}: {what} is {distance!r}; it must be from 0 to 1, or "inf"')
    return Bracket(distance, distance)


def _bracket(at: JsonPlace, what: str, value: Any) -> Bracket:  # noqa: ANN401 - JSON
    lower, upper = (_measure(at, what, end) for end in listed(at, what, value, 2))
    if not (0 <= lower <= upper <= 1 or lower == upper == float("inf")):
        raise InputError(
            f'{at}: {what} is {shown_json(value)}; it must be two numbers from 0 to 1, the lower first, or "inf" twice'
        )
    return Bracket(lower, upper)


def _certificate(at: JsonPlace, value: Any) -> StoredCertificate:  # noqa: ANN401 - JSON
    if not isinstance(value, dict) or len(value) != 1 or not set(value) <= set(_CERTIFICATES):
        raise InputError(
            f"{at}: certificate is {shown_json(value)}; it must be an object with one of {', '.join(_CERTIFICATES)}"
        )
    ((name, proof),) = value.items()
    if name == "multiplier":
        return StoredCertificate(multiplier=rational_at(at, name, proof))
    if name == "double_root":
        return StoredCertificate(double_root=rational_at(at, name, proof))
    points = listed(at, "points", proof)
    if not 1 <= len(points) <= 2:
        raise InputError(f"{at}: points has {len(points)} points; it must have one or two")
    return StoredCertificate(offsets=tuple(_offset(at, point) for point in points))


def _offset(at: JsonPlace, value: Any) -> Offset:  # noqa: ANN401 - JSON
    s, t, w = (rational_at(at, "a point", part) for part in listed(at, "a point", value, 3))
    return (s, t, w)


def _sweep_case(at: JsonPlace, fields: dict[str, Any], content: Content, flags: Mapping[str, FlagFacts]) -> SweepVector:
    row = row_of(at, fields["row"], fields["hex"], content)
    first = _first(at, fields["first"], fields["first_hex"])
    if fields["hit"] is not (first is not None):
        raise InputError(
            f"{at}: hit is {shown_json(fields['hit'])}; with first {shown_json(fields['first'])} it must be "
            f"{json_text(first is not None)}"
        )
    if "certificate" not in fields:
        return SweepVector(fields["id"], row, first, StoredCertificate())
    witness = _passage(at, fields["certificate"])
    return SweepVector(fields["id"], row, first, witness, flags_of_case(at, fields["flags"], flags))


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


def _passage(at: JsonPlace, value: Any) -> StoredCertificate:  # noqa: ANN401 - JSON
    values = dict(zip(_PASSAGE_FIELDS, fields_of(value, _PASSAGE_FIELDS, at, "certificate"), strict=True))
    pieces = []
    for piece in listed(at, "pieces", values["pieces"]):
        multiplier, end = (rational_at(at, "a piece", part) for part in listed(at, "a piece", piece, 2))
        pieces.append((multiplier, end))
    time, root = (
        None if values[name] is None else rational_at(at, name, values[name]) for name in ("time", "double_root")
    )
    points = tuple(_offset(at, point) for point in listed(at, "points", values["points"]))
    if len(points) > 2:
        raise InputError(f"{at}: points has {len(points)} points; it may have two at most")
    if (time is None) != (not points and root is None) or (points and root is not None):
        raise InputError(f"{at}: a certificate has a time with points or with a double_root, or none of these keys")
    return StoredCertificate(offsets=points, double_root=root, steps=tuple(pieces), time=time)


def cases_text(file: CaseFile[Any]) -> str:
    """The whole document."""
    return document_text(file, (case_text(case, file.content) for case in file.cases))


def case_text(case: AnyVector | InvalidRow, content: Content) -> str:
    """One case of a file with that content, an object on one line."""
    if content.refused:
        return invalid_row_text(cast("InvalidRow", case))
    members = _sweep_members if content.about_sweeps else _position_members
    held = {
        "id": json_text(case.id),
        "row": numbers_text(case.row),
        "hex": json_text([hex_of(value) for value in case.row]),
        **members(cast("Any", case), content),
    }
    return object_text({name: held[name] for name in case_fields(content)})


def _position_members(case: Vector, content: Content) -> dict[str, str]:
    members = {
        "position": str(case.answer),
        "tangent": json_text(case.tangent),
        "certificate": json_text(_certificate_members(case.witness)),
        "flags": json_text(case.flags),
    }
    if case.kind is not None:
        members["kind"] = json_text(case.kind.value)
    if case.clearance is not None:
        members |= {"clearance": decimal_of(case.clearance), "clearance_hex": json_text(hex_of(case.clearance))}
    flips = {
        other.label: numbers_text((flip.lower, flip.upper)) if content.tilted else decimal_of(flip.upper)
        for other, flip in case.flips.items()
    }
    return members | {"flips": object_text(flips)}


def _certificate_members(witness: StoredCertificate) -> dict[str, Any]:
    if witness.multiplier is not None:
        return {"multiplier": exact_text(witness.multiplier)}
    if witness.double_root is not None:
        return {"double_root": exact_text(witness.double_root)}
    if witness.pieces:
        return {"pieces": [_piece_members(piece) for piece in witness.pieces]}
    if not witness.offsets:
        return {"rule": "height"}
    return {"points": [list(map(exact_text, point)) for point in witness.offsets]}


def _piece_members(piece: Piece) -> list[str]:
    low = "-inf" if piece.low is None else exact_text(piece.low)
    high = "inf" if piece.high is None else exact_text(piece.high)
    return [low, high, exact_text(piece.multiplier), exact_text(piece.plane)]


def _sweep_members(case: SweepVector, _content: Content) -> dict[str, str]:
    first, witness = case.first, case.witness
    proof = {
        "pieces": [list(map(exact_text, step)) for step in witness.steps],
        "time": None if witness.time is None else exact_text(witness.time),
        "points": [list(map(exact_text, point)) for point in witness.offsets],
        "double_root": None if witness.double_root is None else exact_text(witness.double_root),
    }
    return {
        "hit": json_text(case.hit),
        "first": "null" if first is None else numbers_text(first),
        "first_hex": json_text(None if first is None else list(map(hex_of, first))),
        "certificate": json_text(proof),
        "flags": json_text(case.flags),
    }
