"""Vector files: the content of cases with answers; whole files are read strictly, and written.

Cases are about positions, of upright spheroids or of tilted ones, or about sweeps. format.py has the other parts of a
file, and invalid_rows.py has the rows that must be refused.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, cast

from hypcheck import strict
from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import PAIRS
from hypcheck.strict import Check, StrictTable
from hypcheck.tables.numbers import decimal_of, exact_text, hex_of
from hypcheck.tables.strict_json import JsonDocument, read_document
from hypcheck.truth.backward_error import Bracket
from hypcheck.truth.certificate import Certificate, PassageCertificate, Piece, place
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.family import Row
from hypcheck.vectors.flags import FlagFacts
from hypcheck.vectors.format import (
    CaseFile,
    Content,
    a_number,
    a_rational,
    a_text,
    check_hex,
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


def row_at(row: Row, time: Fraction) -> ExactRow:
    """The pair at a time of a sweep, in ten numbers."""
    here = place(row, time)
    return (*here.row, *here.axis)


def units_of(row: ExactRow) -> Offset:
    """The units of the three parts of an offset: b, b, d in a row of seven numbers, else b."""
    b, d = Fraction(row[2]), Fraction(row[3])
    return b, b, b if PAIRS.has_axis(row) else d


def point_at(row: ExactRow, offset: Offset) -> Offset:
    """The point with this offset from the centre."""
    x, y, z = (Fraction(start) + unit * part for start, unit, part in zip(row[4:7], units_of(row), offset, strict=True))
    return x, y, z


def offset_to(row: ExactRow, point: Offset) -> Offset:
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
        witness = self.witness
        if witness.time is None:
            return PassageCertificate(witness.steps)
        here = row_at(self.row, witness.time)
        points = tuple(point_at(here, offset) for offset in witness.offsets)
        return PassageCertificate(witness.steps, witness.time, points, witness.double_root)


AnyVector = Vector | SweepVector
"""A case with an answer."""

_CERTIFICATES = ("multiplier", "points", "double_root")
_PASSAGE_FIELDS = ("pieces", "time", "points", "double_root")
_KINDS = {kind.value: kind for kind in Kind}


def case_fields(content: Content) -> tuple[str, ...]:
    """The names of the fields that each case has in a file with this content, in order."""
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
    return cases_of(read_document(path), content)


def cases_of(document: JsonDocument, content: Content | None = None) -> CaseFile[Any]:
    """The vector file that a document is, as read_cases reads it. Raises InputError."""
    actual = content_of(document)
    if content is not None and content is not actual:
        wanted = f"{content.name!r}, rows of {len(content.columns)} numbers"
        document.refuse(("content",), f"content is {actual.name!r}; here it must be {wanted}")
    if actual.refused:
        return invalid_rows_of(document)
    return file_of(document, case_fields(actual), _sweep_case if actual.about_sweeps else _position_case)


def _position_case(name: str, table: StrictTable, content: Content, flags: Mapping[str, FlagFacts]) -> Vector:
    fields, position = case_fields(content), table.required("position", _position)
    clearance = None
    if "clearance" in fields:
        clearance = table.required("clearance", _measure)
        check_hex(table, "clearance_hex", table.required("clearance_hex", a_text), clearance)
    return Vector(
        id=name,
        row=row_of(table, content),
        position=position,
        tangent=table.required("tangent", strict.truth),
        kind=table.required("kind", _kind) if "kind" in fields else None,
        clearance=clearance,
        flips=_flips(table, position, _bracket if content.tilted else _distance) if "flips" in fields else {},
        witness=_certificate(table, ended=content.ended),
        flags=flags_of_case(table, flags) if "flags" in fields else (),
    )


def _position(value: object) -> Position:
    if not is_integer(value) or value not in (-1, 0, 1):
        raise ValueError("1, 0 or -1")
    return Position(value)


def _kind(value: object) -> Kind:
    kind = _KINDS.get(value) if isinstance(value, str) else None
    if kind is None:
        raise ValueError(f"one of {', '.join(_KINDS)}")
    return kind


_number_or_inf = strict.or_word("inf", a_number)


def _measure(value: object) -> float:
    """A number, or inf."""
    return float(_number_or_inf(value))


def _flips(table: StrictTable, position: Position, read: Check[Bracket]) -> Mapping[Position, Bracket]:
    others = [other for other in Position if other is not position]
    flips = table.required_table("flips", [other.label for other in others])
    return {other: flips.required(other.label, read) for other in others}


def _distance(value: object) -> Bracket:
    distance = _measure(value)
    if not (0 <= distance <= 1 or distance == float("inf")):
        raise ValueError('from 0 to 1, or "inf"')
    return Bracket(distance, distance)


def _bracket(value: object) -> Bracket:
    wanted = 'a list of 2 numbers from 0 to 1, the lower first, or of "inf" twice'
    lower, upper = strict.list_of(_measure, wanted, 2, 2)(value)
    if not (0 <= lower <= upper <= 1 or lower == upper == float("inf")):
        raise ValueError(wanted)
    return Bracket(lower, upper)


def _certificate(table: StrictTable, *, ended: bool) -> StoredCertificate:
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
    return Piece(*strict.parts(strict.list_with("a list of 4", 4, 4)(value), _PIECE))


def _bound(infinite: str) -> Check[Fraction | None]:
    """A check for a fraction, or the word for no bound, of which it makes None."""
    bound = strict.or_word(infinite, a_rational)

    def check(value: object) -> Fraction | None:
        made = bound(value)
        return None if isinstance(made, str) else made

    return check


_PIECE = (_bound("-inf"), _bound("inf"), a_rational, a_rational)
"""The checks of the ends of a piece, of its multiplier and its plane."""


def _offset(value: object) -> Offset:
    s, t, w = strict.list_of(a_rational, "a list of 3", 3, 3)(value)
    return s, t, w


def _sweep_case(name: str, table: StrictTable, content: Content, flags: Mapping[str, FlagFacts]) -> SweepVector:
    row, first = row_of(table, content), table.required("first", _first)
    wanted = {"hit": first is not None, "first_hex": None if first is None else list(map(hex_of, first))}
    for key, right in wanted.items():
        table.required(key, _equal_to(right))
    if content.ended:
        return SweepVector(name, row, first, StoredCertificate())
    return SweepVector(name, row, first, _passage(table), flags_of_case(table, flags))


def _equal_to(right: object) -> Check[object]:
    """A check for what follows from the other fields."""

    def check(value: object) -> object:
        if value != right or type(value) is not type(right):
            raise ValueError(f"{json_text(right)}, which follows from the field first")
        return value

    return check


def _first(value: object) -> Bounds | None:
    if value is None:
        return None
    wanted = "null, or two times from 0 to 1, the lower first"
    lower, upper = strict.list_of(a_number, wanted, 2, 2)(value)
    if not 0 <= lower <= upper <= 1:
        raise ValueError(wanted)
    return lower, upper


def _passage(table: StrictTable) -> StoredCertificate:
    proof = table.required_table("certificate", _PASSAGE_FIELDS)
    steps = proof.required("pieces", strict.list_of(_step, "a list of pieces"))
    time, root = (proof.required(name, _rational_or_null) for name in ("time", "double_root"))
    points = proof.required("points", strict.list_of(_offset, "a list of two points at most", 0, 2))
    if (time is None) != (not points and root is None) or (points and root is not None):
        table.refuse("a certificate has a time with points or with a double_root, or none of these keys")
    return StoredCertificate(offsets=points, double_root=root, steps=steps, time=time)


def _step(value: object) -> tuple[Fraction, Fraction]:
    multiplier, end = strict.list_of(a_rational, "a list of 2", 2, 2)(value)
    return multiplier, end


def _rational_or_null(value: object) -> Fraction | None:
    return None if value is None else a_rational(value)


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
