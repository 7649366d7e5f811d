"""The format of a vector file: read strictly, and written as the same bytes for the same content.

Everything that the schema does not allow is refused, naming file, line and case. Labels are read here and checked in
examining.py. One case stands on one line.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict
from fractions import Fraction
from typing import Any, TypeVar

from hypcheck.errors import InputError
from hypcheck.geometry.pair import (
    COLUMNS,
    TILTED_COLUMNS,
    TILTED_WAY_COLUMNS,
    WAY_COLUMNS,
    Position,
    trouble_with,
)
from hypcheck.tables.numbers import Literal, decimal_of, exact_text, hex_of, is_shortest, rational_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of, read_document
from hypcheck.truth.kinds import Kind
from hypcheck.vectors.family import (
    SCHEMA,
    TILTED_SCHEMA,
    WAY_SCHEMA,
    FlagFacts,
    Metadata,
    Offset,
    Row,
    StoredCertificate,
    Vector,
    VectorFile,
)
from hypcheck.vectors.flags import FLAGS, TILTED_FLAGS, WAY_FLAGS

Case = TypeVar("Case")

POSITIONS, INVALID = "positions", "refusals"
"""The contents that a file of rows of seven numbers can have: cases with answers, and rows that must be refused."""

TILTED_POSITIONS, TILTED_INVALID = "tilted-positions", "tilted-refusals"
"""The same of rows of ten numbers."""

WAYS, TILTED_WAYS = "ways", "tilted-ways"
"""Ways, rows of ten numbers, and those of spheroids that lean, rows of thirteen."""

WAYS_INVALID, TILTED_WAYS_INVALID = "way-refusals", "tilted-way-refusals"
"""Rows of as many numbers that are no ways, and must be refused."""

REFUSALS = (INVALID, TILTED_INVALID, WAYS_INVALID, TILTED_WAYS_INVALID)
"""The contents that have no answers."""

SCHEMAS = {
    POSITIONS: SCHEMA,
    INVALID: SCHEMA,
    TILTED_POSITIONS: TILTED_SCHEMA,
    TILTED_INVALID: TILTED_SCHEMA,
    WAYS: WAY_SCHEMA,
    TILTED_WAYS: WAY_SCHEMA,
    WAYS_INVALID: WAY_SCHEMA,
    TILTED_WAYS_INVALID: WAY_SCHEMA,
}
"""The version of the schema of each content."""

COLUMNS_OF = {
    POSITIONS: COLUMNS,
    INVALID: COLUMNS,
    TILTED_POSITIONS: TILTED_COLUMNS,
    TILTED_INVALID: TILTED_COLUMNS,
    WAYS: WAY_COLUMNS,
    TILTED_WAYS: TILTED_WAY_COLUMNS,
    WAYS_INVALID: WAY_COLUMNS,
    TILTED_WAYS_INVALID: TILTED_WAY_COLUMNS,
}
"""The numbers of a row of each content."""

_FLAGS_OF = {POSITIONS: FLAGS, TILTED_POSITIONS: TILTED_FLAGS, WAYS: WAY_FLAGS, TILTED_WAYS: WAY_FLAGS}

MEMBERS = ("schema", "content", "family", "flags", "count")
HEAD_FIELDS = tuple(Metadata.__dataclass_fields__)
CASE_FIELDS = (
    *("id", "row", "hex", "position", "tangent", "kind", "clearance", "clearance_hex"),
    *("flips", "certificate", "flags"),
)
CERTIFICATES = ("multiplier", "points", "double_root")
_NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*(@[a-z0-9.,:=+-]+)?", re.ASCII)
_KINDS = {kind.value: kind for kind in Kind}


def read_vectors(path: str) -> VectorFile:
    """The vector file at `path`. Raises InputError where it is not wholly as the schema demands."""
    return vectors_of(read_document(path), path)


def vectors_of(document: JsonDocument, path: str) -> VectorFile:
    """The vector file that a document is. Raises InputError where it is none."""
    head, flags = read_metadata(document, path, POSITIONS)
    cases = cases_of(document, path, head.name, CASE_FIELDS, lambda place, fields: _vector(place, fields, flags))
    return VectorFile(head, flags, cases, tuple(place.line for place, _ in document.cases))


def content_of(document: JsonDocument, path: str) -> str:
    """What the document says that it holds, one of SCHEMAS, after its schema version. Raises InputError."""
    for name in ("schema", "content"):
        if name not in document.members:
            raise InputError(f"{path}: the document lacks {name}")
    place, version = document.members["schema"]
    if version not in (SCHEMA, TILTED_SCHEMA, WAY_SCHEMA):
        raise InputError(
            f"{place}: schema is {shown_json(version)}; this program reads {SCHEMA!r}, "
            f"{TILTED_SCHEMA!r} about tilted spheroids and {WAY_SCHEMA!r} about ways"
        )
    place, content = document.members["content"]
    known = [name for name, of in SCHEMAS.items() if of == version]
    if content not in known:
        raise InputError(f"{place}: content is {shown_json(content)}; it must be {' or '.join(map(repr, known))}")
    return str(content)


def read_metadata(document: JsonDocument, path: str, content: str) -> tuple[Metadata, Mapping[str, FlagFacts]]:
    """The family and the flags of a document with that content, its members and count in order. Raises InputError."""
    found = content_of(document, path)
    if found != content:
        raise InputError(f"{document.members['content'][0]}: content is {found!r}; here it must be {content!r}")
    wanted = tuple(name for name in MEMBERS if name != "flags" or content in _FLAGS_OF)
    for name, (place, _) in document.members.items():
        if name not in wanted:
            raise InputError(f"{place}: the document has the key {name!r}; it may have {', '.join(wanted)}")
    for name in wanted:
        if name not in document.members:
            raise InputError(f"{path}: the document lacks {name}")
    place, count = document.members["count"]
    if not _is_integer(count) or count != len(document.cases):
        raise InputError(f"{place}: count is {shown_json(count)}, but there are {len(document.cases)} cases")
    head = _metadata(*document.members["family"])
    known = _FLAGS_OF.get(content)
    return head, {} if known is None else _flags(*document.members["flags"], known)


def cases_of(
    document: JsonDocument,
    path: str,
    family: str,
    names: tuple[str, ...],
    read: Callable[[JsonPlace, dict[str, Any]], Case],
) -> tuple[Case, ...]:
    """Every case, its fields named and its id its own. Raises InputError."""
    seen: dict[str, int] = {}
    cases = []
    for place, value in document.cases:
        name = value.get("id") if isinstance(value, dict) else None
        at = JsonPlace(path, place.line, name if isinstance(name, str) else None)
        fields = dict(zip(names, fields_of(value, names, at, "the case"), strict=True))
        _check_id(at, fields["id"], family)
        if fields["id"] in seen:
            raise InputError(f"{at}: the id stands on line {seen[fields['id']]} already")
        seen[fields["id"]] = place.line
        cases.append(read(at, fields))
    return tuple(cases)


def listed(place: JsonPlace, what: str, value: Any, length: int | None = None) -> list[Any]:  # noqa: ANN401 - JSON
    """A list, of that length where one is given. Raises InputError."""
    if not isinstance(value, list) or (length is not None and len(value) != length):
        wanted = "a list" if length is None else f"a list of {length}"
        raise InputError(f"{place}: {what} is {shown_json(value)}; it must be {wanted}")
    return value


def number_of(place: JsonPlace, what: str, value: Any) -> float:  # noqa: ANN401 - JSON
    """A finite number that is written as the shortest decimal of its float64. Raises InputError."""
    if isinstance(value, Literal) and value.text == repr(value):  # as we write it
        return float(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{place}: {what} is {shown_json(value)}; it must be a number")
    if not is_shortest(value):
        raise InputError(
            f"{place}: {what} is {shown_json(value)}, which does not round-trip; it must be the shortest decimal that "
            "float64 reads back as itself"
        )
    return float(value)


def text_of(place: JsonPlace, what: str, value: Any) -> str:  # noqa: ANN401 - JSON
    """A string that is not empty. Raises InputError."""
    if not isinstance(value, str) or not value.strip():
        raise InputError(f"{place}: {what} is {shown_json(value)}; it must be a text")
    return value


def _metadata(place: JsonPlace, value: Any) -> Metadata:  # noqa: ANN401 - JSON
    fields = dict(zip(HEAD_FIELDS, fields_of(value, HEAD_FIELDS, place, "family"), strict=True))
    for name in HEAD_FIELDS:
        if name not in ("version", "extreme"):
            text_of(place, f"family.{name}", fields[name])
    if not _NAME.fullmatch(fields["name"]):
        raise InputError(f"{place}: family.name is {fields['name']!r}; it must be lower case, with hyphens, as in ring")
    if not _is_integer(fields["version"]) or fields["version"] < 1:
        raise InputError(
            f"{place}: family.version is {shown_json(fields['version'])}; it must be a whole number from 1"
        )
    if not isinstance(fields["extreme"], bool):
        raise InputError(f"{place}: family.extreme is {shown_json(fields['extreme'])}; it must be true or false")
    return Metadata(**fields)


def _flags(place: JsonPlace, value: Any, known: Mapping[str, FlagFacts]) -> Mapping[str, FlagFacts]:  # noqa: ANN401 - JSON
    if not isinstance(value, dict):
        raise InputError(f"{place}: flags is {shown_json(value)}; it must be an object with what each flag means")
    flags = {}
    for name, facts in value.items():
        if name not in known:
            raise InputError(f"{place}: there is no flag {shown_json(name)}; there are {', '.join(known)}")
        meaning, bug_type = fields_of(facts, ("meaning", "bug_type"), place, f"flag {name}")
        flags[name] = FlagFacts(
            text_of(place, f"{name}.meaning", meaning), text_of(place, f"{name}.bug_type", bug_type)
        )
    return flags


def _check_id(place: JsonPlace, name: Any, family: str) -> None:  # noqa: ANN401 - JSON
    """A frozen case is family-0001, a generated one family/version/seed/index."""
    number = re.escape(family) + r"(-[0-9]{4,}|(/(0|[1-9][0-9]*)){3})"
    if not isinstance(name, str) or not re.fullmatch(number, name, re.ASCII):
        raise InputError(f"{place}: id is {shown_json(name)}; it must be {family}-NNNN or {family}/VERSION/SEED/INDEX")


def _vector(place: JsonPlace, fields: dict[str, Any], flags: Mapping[str, FlagFacts]) -> Vector:
    position = position_of(place, fields["position"])
    if not isinstance(fields["tangent"], bool):
        raise InputError(f"{place}: tangent is {shown_json(fields['tangent'])}; it must be true or false")
    kind = _KINDS.get(text_of(place, "kind", fields["kind"]))
    if kind is None:
        raise InputError(f"{place}: there is no kind {shown_json(fields['kind'])}; there are {', '.join(_KINDS)}")
    clearance = measure_of(place, "clearance", fields["clearance"])
    check_hex(place, "clearance_hex", fields["clearance_hex"], clearance)
    return Vector(
        id=fields["id"],
        row=row_of(place, fields["row"], fields["hex"]),
        position=position,
        tangent=fields["tangent"],
        kind=kind,
        clearance=clearance,
        flips=_flips(place, fields["flips"], position),
        witness=witness_of(place, fields["certificate"]),
        flags=flags_of_case(place, fields["flags"], flags),
    )


def position_of(place: JsonPlace, value: Any) -> Position:  # noqa: ANN401 - JSON
    """A position, as one of 1, 0 and −1. Raises InputError."""
    if not _is_integer(value) or value not in (-1, 0, 1):
        raise InputError(f"{place}: position is {shown_json(value)}; it must be 1, 0 or -1")
    return Position(value)


def row_of(place: JsonPlace, numbers: Any, hexes: Any, columns: tuple[str, ...] = COLUMNS) -> Row:  # noqa: ANN401 - JSON
    """The numbers of a row, valid one by one, and their hexadecimal forms. Raises InputError."""
    row, count = [], len(columns)
    for name, value, text in zip(
        columns, listed(place, "row", numbers, count), listed(place, "hex", hexes, count), strict=True
    ):
        number = number_of(place, name, value)
        trouble = trouble_with(name, number)
        if trouble is not None:
            raise InputError(f"{place}: {trouble}")
        check_hex(place, f"the hex of {name}", text, number)
        row.append(number)
    return tuple(row)


def check_hex(place: JsonPlace, what: str, text: Any, number: float) -> None:  # noqa: ANN401 - JSON
    """Raise InputError unless the text is the hexadecimal form of the number."""
    if text != hex_of(number):
        raise InputError(f"{place}: {what} is {shown_json(text)}; of {number!r} it must be {hex_of(number)!r}")


def measure_of(place: JsonPlace, what: str, value: Any) -> float:  # noqa: ANN401 - JSON
    """A number, or inf. Raises InputError."""
    return float("inf") if value == "inf" else number_of(place, what, value)


def _flips(place: JsonPlace, value: Any, position: Position) -> Mapping[Position, float]:  # noqa: ANN401 - JSON
    others = [other for other in Position if other is not position]
    names = tuple(other.label for other in others)
    distances = [measure_of(place, "a flip", each) for each in fields_of(value, names, place, "flips")]
    for name, distance in zip(names, distances, strict=True):
        if not (0 <= distance <= 1 or distance == float("inf")):
            raise InputError(f'{place}: the flip to {name} is {distance!r}; it must be from 0 to 1, or "inf"')
    return dict(zip(others, distances, strict=True))


def witness_of(place: JsonPlace, value: Any) -> StoredCertificate:  # noqa: ANN401 - JSON
    """What proves a case. Raises InputError."""
    if not isinstance(value, dict) or len(value) != 1 or not set(value) <= set(CERTIFICATES):
        raise InputError(
            f"{place}: certificate is {shown_json(value)}; it must be an object with one of {', '.join(CERTIFICATES)}"
        )
    ((name, proof),) = value.items()
    if name == "multiplier":
        return StoredCertificate(multiplier=rational_at(place, name, proof))
    if name == "double_root":
        return StoredCertificate(double_root=rational_at(place, name, proof))
    points = listed(place, "points", proof)
    if not 1 <= len(points) <= 2:
        raise InputError(f"{place}: points has {len(points)} points; it must have one or two")
    return StoredCertificate(offsets=tuple(offset_of(place, point) for point in points))


def offset_of(place: JsonPlace, value: Any) -> Offset:  # noqa: ANN401 - JSON
    """Three fractions. Raises InputError."""
    s, t, w = (rational_at(place, "a point", part) for part in listed(place, "a point", value, 3))
    return (s, t, w)


def rational_at(place: JsonPlace, what: str, value: Any) -> Fraction:  # noqa: ANN401 - JSON
    """A fraction in lowest terms, as a text. Raises InputError."""
    text = text_of(place, what, value)
    try:
        return rational_of(text)
    except ValueError as error:
        raise InputError(f"{place}: {what} is {shown_json(text)}; it {error}") from None


def flags_of_case(place: JsonPlace, value: Any, known: Mapping[str, FlagFacts]) -> tuple[str, ...]:  # noqa: ANN401 - JSON
    """The flags of a case, each described in the file. Raises InputError."""
    flags = listed(place, "flags", value)
    for flag in flags:
        if not isinstance(flag, str) or flag not in known:
            raise InputError(f"{place}: the flag {shown_json(flag)} is not among those that the file describes")
    if len(set(flags)) < len(flags):
        raise InputError(f"{place}: a flag stands twice")
    return tuple(flags)


def _is_integer(value: Any) -> bool:  # noqa: ANN401 - JSON
    return isinstance(value, int) and not isinstance(value, bool)


def vectors_text(file: VectorFile) -> str:
    """The whole document, ASCII but for the descriptions, with an end of line after every case."""
    return document_text(POSITIONS, file.head, file.flags, [vector_text(case) for case in file.cases])


def document_text(content: str, head: Metadata, flags: Mapping[str, FlagFacts] | None, cases: Iterable[str]) -> str:
    """A document of cases that are text already; one without flags where `flags` is None."""
    lines = list(cases)
    described = []
    if flags is not None:
        inner = ",\n".join(f"  {json_text(name)}: {json_text(asdict(facts))}" for name, facts in flags.items())
        described = [f'"flags": {{\n{inner}\n}}' if flags else '"flags": {}']
    members = [
        f'"schema": {json_text(SCHEMAS[content])}',
        f'"content": {json_text(content)}',
        f'"family": {json_text(asdict(head))}',
        *described,
        f'"count": {len(lines)}',
        '"cases": [\n' + ",\n".join(lines) + "\n]" if lines else '"cases": []',
    ]
    return "{" + ",\n".join(members) + "}\n"


def vector_text(case: Vector) -> str:
    """One case, an object on one line."""
    flips = ",".join(f'"{position.label}":{decimal_of(distance)}' for position, distance in case.flips.items())
    members = {
        "id": json_text(case.id),
        "row": numbers_text(case.row),
        "hex": json_text([hex_of(value) for value in case.row]),
        "position": str(int(case.position)),
        "tangent": json_text(case.tangent),
        "kind": json_text(case.kind.value),
        "clearance": decimal_of(case.clearance),
        "clearance_hex": json_text(hex_of(case.clearance)),
        "flips": f"{{{flips}}}",
        "certificate": json_text(certificate_members(case.witness)),
        "flags": json_text(case.flags),
    }
    return object_text(members)


def object_text(members: Mapping[str, str]) -> str:
    """An object of members that are JSON text already."""
    return "{" + ",".join(f'"{name}":{value}' for name, value in members.items()) + "}"


def numbers_text(row: Iterable[float]) -> str:
    """A list of decimals; infinities and NaN are strings."""
    return f"[{','.join(map(decimal_of, row))}]"


def certificate_members(witness: StoredCertificate) -> dict[str, Any]:
    """What proves a case, as it is written."""
    if witness.multiplier is not None:
        return {"multiplier": exact_text(witness.multiplier)}
    if witness.double_root is not None:
        return {"double_root": exact_text(witness.double_root)}
    return {"points": [[exact_text(part) for part in point] for point in witness.offsets]}


def json_text(value: Any) -> str:  # noqa: ANN401 - JSON
    """`value` as JSON without blanks."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
