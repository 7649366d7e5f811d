"""Vector files: what the cases with answers hold, and how whole files are read strictly and written.

Cases are about positions, of upright spheroids or of tilted ones, or about ways. What else stands in a file is in
format.py, and rows that must be refused are in invalid_rows.py.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Generic, TypeVar

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.geometry.rows import WAYS
from hypcheck.tables.numbers import decimal_of, exact_text, hex_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of, read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.truth.certificate import Certificate, Piece
from hypcheck.truth.kinds import Kind
from hypcheck.truth.passage_certificate import PassageCertificate, place
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
Flip = TypeVar("Flip", float, Bracket)


@dataclass(frozen=True, slots=True)
class StoredCertificate:
    """A certificate as files hold it: one of a multiplier λ, a double root m, and points.

    Points are offsets (s, t, w) from the spheroid's centre, so that short numbers do. Of an upright spheroid the point
    is (x + b s, y + b t, z + d w), and belongs to it if s² + t² + w² ≤ 1.
    Of a tilted one, and where the hyperboloid ends, it is (x, y, z) + b (s, t, w). `pieces` are those of a hyperboloid
    that ends; without any of these a contact rests on the exact rule in the height.
    """

    multiplier: Fraction | None = None
    offsets: tuple[Offset, ...] = ()
    double_root: Fraction | None = None
    pieces: tuple[Piece, ...] = ()


@dataclass(frozen=True, slots=True)
class Vector(Generic[Flip]):
    """A case: a valid row (−0.0 included, as it was given), its labels, and what proves them.

    `kind` is None of a tilted spheroid. `clearance` is in spheroid radii, to within an ulp, inf beyond float64. `flips`
    has the distance to each other position: of upright spheroids as truth/backward_error.py measures it, of tilted ones
    a bracket of it. `flags` are names out of flags.FLAGS or flags.TILTED_FLAGS.
    """

    id: str
    row: Row
    position: Position
    tangent: bool
    kind: Kind | None
    clearance: float
    flips: Mapping[Position, Flip]
    witness: StoredCertificate
    flags: tuple[str, ...] = ()

    @property
    def answer(self) -> int:
        """The position as a number."""
        return int(self.position)

    @property
    def certificate(self) -> Certificate:
        """What proves the position, its points in the caller's coordinates."""
        points = tuple(point_at(self.row, offset) for offset in self.witness.offsets)
        return Certificate(self.position, self.witness.multiplier, points, self.witness.double_root)


@dataclass(frozen=True, slots=True)
class EndedVector:
    """A case: a valid row of thirteen numbers, its position, whether that is a touch, and what proves it."""

    id: str
    row: Row
    position: Position
    tangent: bool
    witness: StoredCertificate
    flags: tuple[str, ...] = ()

    @property
    def answer(self) -> int:
        """The position as a number."""
        return int(self.position)

    @property
    def certificate(self) -> Certificate:
        """What proves the position, its points in the caller's coordinates."""
        points = tuple(point_at(self.row, offset) for offset in self.witness.offsets)
        witness = self.witness
        return Certificate(self.position, witness.multiplier, points, witness.double_root, witness.pieces)


UprightVector = Vector[float]
TiltedVector = Vector[Bracket]


def units_of(row: Row) -> tuple[Fraction, Fraction, Fraction]:
    """What the three parts of an offset are multiples of: b, b, d of an upright spheroid, else b."""
    b, d = Fraction(row[2]), Fraction(row[3])
    return b, b, d if len(row) == len(COLUMNS) else b


def point_at(row: Row, offset: Offset) -> Offset:
    """The point that is this offset away from the centre."""
    x, y, z = (Fraction(start) + unit * part for start, unit, part in zip(row[4:7], units_of(row), offset, strict=True))
    return x, y, z


def offset_to(row: Row, point: Offset) -> Offset:
    """How far a point is from the centre."""
    s, t, w = (
        (part - Fraction(start)) / unit for start, unit, part in zip(row[4:7], units_of(row), point, strict=True)
    )
    return s, t, w


@dataclass(frozen=True, slots=True)
class StoredPassage:
    """A proof as files hold it: see truth/passage_certificate.py. Points are (X − C)/b at the time of the proof."""

    pieces: tuple[tuple[Fraction, Fraction], ...] = ()
    time: Fraction | None = None
    offsets: tuple[Offset, ...] = ()
    double_root: Fraction | None = None


@dataclass(frozen=True, slots=True)
class WayVector:
    """A case: a valid row of ten, thirteen or sixteen numbers, its answer, and what proves it.

    `first` are bounds of the first contact: two neighbouring float64 numbers, or 0 twice; None where the way is clear.
    Beside a hyperboloid that ends they need not be neighbours, and nothing but the exact decision proves the answer.
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
    def answer(self) -> int:
        """1 for contact on the way, 0 for none."""
        return int(self.hit)

    @property
    def certificate(self) -> PassageCertificate:
        """What proves the answer, its points in the caller's coordinates."""
        time, b = self.witness.time, Fraction(self.row[2])
        if time is None:
            return PassageCertificate(self.witness.pieces)
        x, y, z = place(self.row, time).row[4:]
        points = tuple((x + b * s, y + b * t, z + b * w) for s, t, w in self.witness.offsets)
        return PassageCertificate(self.witness.pieces, time, points, self.witness.double_root)


AnyVector = UprightVector | TiltedVector | WayVector | EndedVector
"""A case with an answer."""

_POSITION_FIELDS = (
    *("id", "row", "hex", "position", "tangent", "kind", "clearance", "clearance_hex"),
    *("flips", "certificate", "flags"),
)
_WAY_FIELDS = ("id", "row", "hex", "hit", "first", "first_hex", "certificate", "flags")
_ENDED_WAY_FIELDS = ("id", "row", "hex", "hit", "first", "first_hex")
_ENDED_FIELDS = ("id", "row", "hex", "position", "tangent", "certificate")
_CERTIFICATES = ("multiplier", "points", "double_root")
_PASSAGE_FIELDS = ("pieces", "time", "points", "double_root")
_KINDS = {kind.value: kind for kind in Kind}


def case_fields(content: Content) -> tuple[str, ...]:
    """The fields of a case in a file with that content, in order."""
    if content.ended:
        return _ENDED_WAY_FIELDS if content.layout is WAYS else _ENDED_FIELDS
    if content.layout is WAYS:
        return _WAY_FIELDS
    return tuple(name for name in _POSITION_FIELDS if name != "kind" or not content.tilted)


def read_cases(path: str, content: Content | None = None) -> CaseFile[Any]:
    """The vector file at `path`, with that content, if one is given.

    Raises InputError where it is not wholly as the schema demands.
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
    read = _way if actual.layout is WAYS else _ended if actual.ended else _vector
    return file_of(document, path, case_fields(actual), read)


def _vector(at: JsonPlace, fields: dict[str, Any], content: Content, flags: Mapping[str, FlagFacts]) -> Vector[Any]:
    position, tangent = _position(at, fields)
    clearance = _measure(at, "clearance", fields["clearance"])
    check_hex(at, "clearance_hex", fields["clearance_hex"], clearance)
    return Vector(
        id=fields["id"],
        row=row_of(at, fields["row"], fields["hex"], content),
        position=position,
        tangent=tangent,
        kind=None if content.tilted else _kind(at, fields["kind"]),
        clearance=clearance,
        flips=_flips(at, fields["flips"], position, _bracket if content.tilted else _distance),
        witness=_certificate(at, fields["certificate"]),
        flags=flags_of_case(at, fields["flags"], flags),
    )


def _position(at: JsonPlace, fields: dict[str, Any]) -> tuple[Position, bool]:
    position, tangent = fields["position"], fields["tangent"]
    if not is_integer(position) or position not in (-1, 0, 1):
        raise InputError(f"{at}: position is {shown_json(position)}; it must be 1, 0 or -1")
    if not isinstance(tangent, bool):
        raise InputError(f"{at}: tangent is {shown_json(tangent)}; it must be true or false")
    return Position(position), tangent


def _ended(at: JsonPlace, fields: dict[str, Any], content: Content, _flags: Mapping[str, FlagFacts]) -> EndedVector:
    row = row_of(at, fields["row"], fields["hex"], content)
    return EndedVector(fields["id"], row, *_position(at, fields), _ended_certificate(at, fields["certificate"]))


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
    read: Callable[[JsonPlace, str, Any], Flip],
) -> Mapping[Position, Flip]:
    others = [other for other in Position if other is not position]
    names = tuple(other.label for other in others)
    distances = zip(others, fields_of(value, names, at, "flips"), strict=True)
    return {other: read(at, f"the flip to {other.label}", distance) for other, distance in distances}


def _distance(at: JsonPlace, what: str, value: Any) -> float:  # noqa: ANN401 - JSON
    distance = _measure(at, what, value)
    if not (0 <= distance <= 1 or distance == float("inf")):
        raise InputError(f'{at}: {what} is {distance!r}; it must be from 0 to 1, or "inf"')
    return distance


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


def _way(at: JsonPlace, fields: dict[str, Any], content: Content, flags: Mapping[str, FlagFacts]) -> WayVector:
    row = row_of(at, fields["row"], fields["hex"], content)
    first = _first(at, fields["first"], fields["first_hex"])
    if fields["hit"] is not (first is not None):
        raise InputError(
            f"{at}: hit is {shown_json(fields['hit'])}; with first {shown_json(fields['first'])} it must be "
            f"{json_text(first is not None)}"
        )
    if content.ended:
        return WayVector(fields["id"], row, first, StoredPassage())
    witness = _passage(at, fields["certificate"])
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


def _passage(at: JsonPlace, value: Any) -> StoredPassage:  # noqa: ANN401 - JSON
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
        raise InputError(f"{at}: a certificate has a time with points or a double_root, or none of the three")
    return StoredPassage(tuple(pieces), time, points, root)


def cases_text(file: CaseFile[Any]) -> str:
    """The whole document."""
    return document_text(file, map(case_text, file.cases))


def case_text(case: AnyVector | InvalidRow) -> str:
    """One case, an object on one line."""
    if isinstance(case, InvalidRow):
        return invalid_row_text(case)
    return object_text(
        {
            "id": json_text(case.id),
            "row": numbers_text(case.row),
            "hex": json_text([hex_of(value) for value in case.row]),
            **_members(case),
        }
    )


def _members(case: AnyVector) -> dict[str, str]:
    if isinstance(case, EndedVector):
        certificate = json_text(_certificate_members(case.witness))
        return {"position": str(case.answer), "tangent": json_text(case.tangent), "certificate": certificate}
    if isinstance(case, WayVector):
        answer = _way_answer_members(case)
        return answer if len(case.row) == len(WAYS.ended) else answer | _way_proof_members(case)
    return _position_members(case) | {"flags": json_text(case.flags)}


def _position_members(case: UprightVector | TiltedVector) -> dict[str, str]:
    return {
        "position": str(case.answer),
        "tangent": json_text(case.tangent),
        **({} if case.kind is None else {"kind": json_text(case.kind.value)}),
        "clearance": decimal_of(case.clearance),
        "clearance_hex": json_text(hex_of(case.clearance)),
        "flips": object_text({other.label: _flip_text(flip) for other, flip in case.flips.items()}),
        "certificate": json_text(_certificate_members(case.witness)),
    }


def _flip_text(flip: float | Bracket) -> str:
    return numbers_text((flip.lower, flip.upper)) if isinstance(flip, Bracket) else decimal_of(flip)


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


def _way_answer_members(case: WayVector) -> dict[str, str]:
    first = case.first
    return {
        "hit": json_text(case.hit),
        "first": "null" if first is None else numbers_text(first),
        "first_hex": json_text(None if first is None else list(map(hex_of, first))),
    }


def _way_proof_members(case: WayVector) -> dict[str, str]:
    witness = case.witness
    proof = {
        "pieces": [list(map(exact_text, piece)) for piece in witness.pieces],
        "time": None if witness.time is None else exact_text(witness.time),
        "points": [list(map(exact_text, point)) for point in witness.offsets],
        "double_root": None if witness.double_root is None else exact_text(witness.double_root),
    }
    return {"certificate": json_text(proof), "flags": json_text(case.flags)}
