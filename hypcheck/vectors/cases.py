"""Vector files: the content of cases with answers; whole files are read strictly, and written.

Cases are about positions, of upright spheroids or of tilted ones, or about sweeps. format.py reads and writes the other
parts of a file, and invalid_rows.py the rows that must be refused.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from hypcheck import strict
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import PAIRS
from hypcheck.strict import Check, StrictTable
from hypcheck.tables.numbers import decimal_of, exact_text, hex_of
from hypcheck.tables.strict_json import JsonDocument, read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.truth.certificate import Certificate, PassageCertificate, Piece, place
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.draw import Row
from hypcheck.vectors.format import (
    CaseFile,
    Content,
    FlagFacts,
    a_number,
    a_rational,
    content_of,
    document_text,
    file_of,
    flags_of_case,
    is_integer,
    json_text,
    numbers_text,
    object_text,
    row_of,
)
from hypcheck.vectors.invalid_rows import InvalidRow, invalid_row_text, invalid_rows_of

Offset = tuple[Fraction, Fraction, Fraction]
Bounds = tuple[float, float]
ExactRow = Sequence[float | Fraction]


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
    """A case with an answer about a pair or a sweep: a valid row (a given −0.0 is kept), its labels, and their proof.

    `answer`: of a pair its position, of a sweep 1 for contact somewhere on it, its ends included, and 0 for none.
    `flags` are names out of the file's. Other labels are None, False or empty if the file has no such field.

    Of a pair: `kind` is not that of a tilted spheroid. `clearance` is in spheroid radii, to within an ulp, inf beyond
    float64. `flips` has the distance to each other position as a bracket; for upright spheroids both ends are the
    distance that truth/backward_error.py measures. If the hyperboloid ends, all three are missing.

    Of a sweep: `first` are bounds of the time of first contact: two neighbouring float64 numbers, or 0 twice; None if
    the sweep is clear. If the hyperboloid ends, they need not be neighbours, and only the exact decision proves them.
    """

    id: str
    row: Row
    answer: int
    witness: StoredCertificate = StoredCertificate()
    tangent: bool = False
    kind: Kind | None = None
    clearance: float | None = None
    flips: Mapping[Position, Bracket] = field(default_factory=dict)
    first: Bounds | None = None
    flags: tuple[str, ...] = ()

    @property
    def position(self) -> Position:
        """The answer about a pair: its position."""
        return Position(self.answer)

    @property
    def hit(self) -> bool:
        """The answer about a sweep: whether there is contact on it."""
        return bool(self.answer)

    @property
    def certificate(self) -> Certificate:
        """The certificate of the position of a pair, with points in the caller's coordinates."""
        points = tuple(point_at(self.row, offset) for offset in self.witness.offsets)
        witness = self.witness
        return Certificate(self.position, witness.multiplier, points, witness.double_root, witness.pieces)

    @property
    def passage_certificate(self) -> PassageCertificate:
        """The certificate of the answer about a sweep, with points in the caller's coordinates."""
        witness = self.witness
        if witness.time is None:
            return PassageCertificate(witness.steps)
        here = row_at(self.row, witness.time)
        points = tuple(point_at(here, offset) for offset in witness.offsets)
        return PassageCertificate(witness.steps, witness.time, points, witness.double_root)


def row_at(row: Row, time: Fraction) -> ExactRow:
    """Return the pair at a time of a sweep, 0 to 1, in ten exact numbers."""
    here = place(row, time)
    return (*here.row, *here.axis)


def units_of(row: ExactRow) -> Offset:
    """Return the units of the three parts of an offset: b, b, d in a row of seven numbers, else b, b, b."""
    b, d = Fraction(row[2]), Fraction(row[3])
    return b, b, b if PAIRS.has_axis(row) else d


def point_at(row: ExactRow, offset: Offset) -> Offset:
    """Return the point with this offset from the centre."""
    x, y, z = (Fraction(start) + unit * part for start, unit, part in zip(row[4:7], units_of(row), offset, strict=True))
    return x, y, z


def offset_to(row: ExactRow, point: Offset) -> Offset:
    """Return the offset of a point from the centre, in the units of units_of."""
    s, t, w = (
        (part - Fraction(start)) / unit for start, unit, part in zip(row[4:7], units_of(row), point, strict=True)
    )
    return s, t, w


_CERTIFICATES = ("multiplier", "points", "double_root")
_PASSAGE_FIELDS = ("pieces", "time", "points", "double_root")
_KINDS = {kind.value: kind for kind in Kind}


def case_fields(content: Content) -> tuple[str, ...]:
    """Return the names of the fields that each case has in a file with this content, in order."""
    head = ("id", "row", "hex")
    if content.about_sweeps:
        return (*head, "hit", "first", "first_hex", *(() if content.ended else ("certificate", "flags")))
    if content.ended:
        return (*head, "position", "tangent", "certificate")
    measures = (*(() if content.tilted else ("kind",)), "clearance", "clearance_hex", "flips")
    return (*head, "position", "tangent", *measures, "certificate", "flags")


def read_cases(path: str, content: Content | None = None) -> CaseFile:
    """Read the vector file at `path`.

    Raises InputError if it does not conform to the schema, or is of another content than `content`, if that is given.
    """
    return cases_of(read_document(path), content)


def cases_of(document: JsonDocument, content: Content | None = None) -> CaseFile:
    """Read a document as a vector file, which must have this `content` if it is given. Raises InputError."""
    actual = content_of(document)
    if content is not None and content is not actual:
        wanted = f"{content.name!r}, rows of {len(content.columns)} numbers"
        document.refuse(("content",), f"content is {actual.name!r}; here it must be {wanted}")
    if actual.refused:
        return invalid_rows_of(document)
    return file_of(document, case_fields(actual), _case)


def _case(name: str, table: StrictTable, content: Content, flags: Mapping[str, FlagFacts]) -> Vector:
    """Read the fields of a case, each by its check. Raises InputError."""
    fields = case_fields(content)
    labels = {key: table.required(key, check) for key, check in _CHECKS.items() if key in fields}
    for key, (other, derived) in _DERIVED.items():
        if key in fields:
            table.required(key, _equal_to(derived(labels[other]), other))
    position = labels.pop("position", None)
    if "flips" in fields:
        labels["flips"] = _flips(table, Position(position), _bracket if content.tilted else _distance)
    if "certificate" in fields:
        witness = _passage(table) if content.about_sweeps else _certificate(table, ended=content.ended)
    else:
        witness = StoredCertificate()
    return Vector(
        id=name,
        row=row_of(table, content),
        answer=int(labels["first"] is not None) if position is None else position,
        witness=witness,
        flags=flags_of_case(table, flags) if "flags" in fields else (),
        **labels,
    )


def _position(value: object) -> int:
    """Read a position. Raises ValueError."""
    if not is_integer(value) or value not in (-1, 0, 1):
        raise ValueError("1, 0 or -1")
    return Position(value).value


def _kind(value: object) -> Kind:
    """Read the name of a kind. Raises ValueError."""
    kind = _KINDS.get(value) if isinstance(value, str) else None
    if kind is None:
        raise ValueError(f"one of {', '.join(_KINDS)}")
    return kind


_number_or_inf = strict.or_word("inf", a_number)


def _measure(value: object) -> float:
    """Return the value if it is a number or inf. Raises ValueError."""
    return float(_number_or_inf(value))


def _first(value: object) -> Bounds | None:
    """Read the bounds of the time of first contact; None if there is no contact. Raises ValueError."""
    if value is None:
        return None
    wanted = "null, or two times from 0 to 1, the lower first"
    lower, upper = strict.list_of(a_number, wanted, 2, 2)(value)
    if not 0 <= lower <= upper <= 1:
        raise ValueError(wanted)
    return lower, upper


_CHECKS: Mapping[str, Check[Any]] = {
    "position": _position,
    "tangent": strict.truth,
    "kind": _kind,
    "clearance": _measure,
    "first": _first,
}
"""The checks of fields that hold a label."""

_DERIVED: Mapping[str, tuple[str, Callable[[Any], object]]] = {
    "clearance_hex": ("clearance", hex_of),
    "hit": ("first", lambda first: first is not None),
    "first_hex": ("first", lambda first: None if first is None else list(map(hex_of, first))),
}
"""The fields that follow from another field: the name of that one, and the function that derives the value."""


def _equal_to(right: object, other: str) -> Check[object]:
    """Return the check of a value that follows from the field `other`, and must be `right`."""

    def check(value: object) -> object:
        if value != right or type(value) is not type(right):
            raise ValueError(f"{json_text(right)}, which follows from the field {other}")
        return value

    return check


def _flips(table: StrictTable, position: Position, read: Check[Bracket]) -> Mapping[Position, Bracket]:
    """Read the distance to each position other than `position`. Raises InputError."""
    others = [other for other in Position if other is not position]
    flips = table.required_table("flips", [other.label for other in others])
    return {other: flips.required(other.label, read) for other in others}


def _distance(value: object) -> Bracket:
    """Read one number as a bracket whose ends are equal. Raises ValueError."""
    distance = _measure(value)
    if not (0 <= distance <= 1 or distance == float("inf")):
        raise ValueError('from 0 to 1, or "inf"')
    return Bracket(distance, distance)


def _bracket(value: object) -> Bracket:
    """Read the two ends of a bracket. Raises ValueError."""
    wanted = 'a list of 2 numbers from 0 to 1, the lower first, or of "inf" twice'
    lower, upper = strict.list_of(_measure, wanted, 2, 2)(value)
    if not (0 <= lower <= upper <= 1 or lower == upper == float("inf")):
        raise ValueError(wanted)
    return Bracket(lower, upper)


def _certificate(table: StrictTable, *, ended: bool) -> StoredCertificate:
    """Read the certificate of a pair, which has exactly one part. Raises InputError."""
    keys = (*_CERTIFICATES, "pieces", "rule") if ended else _CERTIFICATES
    proof = table.required_table("certificate", keys)
    if len(proof) != 1:
        proof.refuse(f"certificate has {len(proof)} keys; it must be an object with one of {', '.join(keys)}")
    proof.optional("rule", strict.one_of("height"), None)
    return StoredCertificate(
        multiplier=proof.optional("multiplier", a_rational, None),
        offsets=proof.optional("points", strict.list_of(_offset, "a list of one or two points", 1, 2), ()),
        double_root=proof.optional("double_root", a_rational, None),
        pieces=proof.optional("pieces", strict.list_of(_piece, "a list of pieces"), ()),
    )


def _piece(value: object) -> Piece:
    """Read a piece of the wall. Raises ValueError."""
    return Piece(*strict.parts(strict.list_with("a list of 4", 4, 4)(value), _PIECE))


def _bound(infinite: str) -> Check[Fraction | None]:
    """Return a check that reads a fraction, or the word `infinite` as None, which means no bound."""
    bound = strict.or_word(infinite, a_rational)

    def check(value: object) -> Fraction | None:
        made = bound(value)
        return None if isinstance(made, str) else made

    return check


_PIECE = (_bound("-inf"), _bound("inf"), a_rational, a_rational)
"""The checks of the four members of a piece: its two ends, its multiplier and its plane."""


def _offset(value: object) -> Offset:
    """Read the three parts of an offset. Raises ValueError."""
    s, t, w = strict.list_of(a_rational, "a list of 3", 3, 3)(value)
    return s, t, w


def _passage(table: StrictTable) -> StoredCertificate:
    """Read the certificate of a sweep. Raises InputError."""
    proof = table.required_table("certificate", _PASSAGE_FIELDS)
    steps = proof.required("pieces", strict.list_of(_step, "a list of pieces"))
    time, root = (proof.required(name, _rational_or_null) for name in ("time", "double_root"))
    points = proof.required("points", strict.list_of(_offset, "a list of two points at most", 0, 2))
    if (time is None) != (not points and root is None) or (points and root is not None):
        table.refuse("a certificate has a time with points or with a double_root, or none of these keys")
    return StoredCertificate(offsets=points, double_root=root, steps=steps, time=time)


def _step(value: object) -> tuple[Fraction, Fraction]:
    """Read a piece of a sweep: its multiplier and its end. Raises ValueError."""
    multiplier, end = strict.list_of(a_rational, "a list of 2", 2, 2)(value)
    return multiplier, end


def _rational_or_null(value: object) -> Fraction | None:
    """Read a rational, or null as None. Raises ValueError."""
    return None if value is None else a_rational(value)


def cases_text(file: CaseFile) -> str:
    """Return the text of the whole document."""
    return document_text(file, (case_text(case, file.content) for case in file.cases))


def case_text(case: Vector | InvalidRow, content: Content) -> str:
    """Return the text of one case of a file with that content, an object on one line."""
    if isinstance(case, InvalidRow):
        return invalid_row_text(case)
    return object_text({name: _TEXTS[name](case, content) for name in case_fields(content)})


def _flips_text(case: Vector, content: Content) -> str:
    """Write the flip distances of a case as JSON."""
    return object_text(
        {
            other.label: numbers_text((flip.lower, flip.upper)) if content.tilted else decimal_of(flip.upper)
            for other, flip in case.flips.items()
        }
    )


def _certificate_text(case: Vector, content: Content) -> str:
    """Write the certificate of a case as JSON."""
    witness = case.witness
    points = [list(map(exact_text, point)) for point in witness.offsets]
    if content.about_sweeps:
        return json_text(
            {
                "pieces": [list(map(exact_text, step)) for step in witness.steps],
                "time": None if witness.time is None else exact_text(witness.time),
                "points": points,
                "double_root": None if witness.double_root is None else exact_text(witness.double_root),
            }
        )
    if witness.multiplier is not None:
        return json_text({"multiplier": exact_text(witness.multiplier)})
    if witness.double_root is not None:
        return json_text({"double_root": exact_text(witness.double_root)})
    if witness.pieces:
        return json_text({"pieces": [_piece_members(piece) for piece in witness.pieces]})
    return json_text({"points": points} if points else {"rule": "height"})


def _piece_members(piece: Piece) -> list[str]:
    """Return the texts of a piece: low, high, multiplier, plane."""
    low = "-inf" if piece.low is None else exact_text(piece.low)
    high = "inf" if piece.high is None else exact_text(piece.high)
    return [low, high, exact_text(piece.multiplier), exact_text(piece.plane)]


def _derived_text(name: str) -> Callable[[Any, Content], str]:
    """Return the function that makes the text of a field that follows from another."""
    other, derived = _DERIVED[name]
    return lambda case, _: json_text(derived(getattr(case, other)))


_TEXTS: Mapping[str, Callable[[Any, Content], str]] = {
    "id": lambda case, _: json_text(case.id),
    "row": lambda case, _: numbers_text(case.row),
    "hex": lambda case, _: json_text(list(map(hex_of, case.row))),
    "position": lambda case, _: str(case.answer),
    "tangent": lambda case, _: json_text(case.tangent),
    "kind": lambda case, _: json_text(case.kind.value),
    "clearance": lambda case, _: decimal_of(case.clearance),
    "flips": _flips_text,
    "first": lambda case, _: "null" if case.first is None else numbers_text(case.first),
    **{name: _derived_text(name) for name in _DERIVED},
    "certificate": _certificate_text,
    "flags": lambda case, _: json_text(case.flags),
}
"""The JSON text of each field of a case."""
