"""The document of a vector file: read strictly, and written as the same bytes for the same content.

Everything that the schema does not allow is refused, naming file, line and case. One case is one line. cases.py defines
the content of a case, and invalid_rows.py the content of a row that must be refused.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from fractions import Fraction
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import AXIS, ENDS, HEIGHTS, NO_DIRECTION, trouble_with, trouble_with_heights
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout, Positions, Rows
from hypcheck.tables.numbers import Literal, decimal_of, hex_of, is_shortest, rational_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace, fields_of
from hypcheck.vectors.family import Metadata, Row
from hypcheck.vectors.flags import FLAGS, SWEEP_FLAGS, TILTED_FLAGS, FlagFacts

SCHEMA = "1.0.0"
"""The version of the files' schemas, such as cases/schema/vectors-1.0.0.json."""

TILTED_SCHEMA = "1.1.0"
"""The version of the schemas of files about tilted spheroids."""

SWEEP_SCHEMA = "1.2.0"
"""The version of the schemas of files about sweeps."""

ENDED_SCHEMA = "1.3.0"
"""The version of the schemas of files about hyperboloids that end."""

ENDED_SWEEP_SCHEMA = "1.4.0"
"""The version of the schemas of files about sweeps beside these; a reader refuses any other than these five."""


@dataclass(frozen=True, slots=True)
class Content:
    """The kind of content of a file: its name in the file, and the version of its schema.

    `layout` is the layout of rows, of a position or a sweep. `tilted`: rows end with the spheroid's axis. `ended`: rows
    have an axis and the heights of the hyperboloid's ends. `refused`: rows are not valid, and have no answers.
    """

    name: str
    schema: str
    layout: Layout = PAIRS
    tilted: bool = False
    refused: bool = False
    ended: bool = False

    @property
    def about_sweeps(self) -> bool:
        """Whether the rows are sweeps."""
        return self.layout.has_end

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the numbers of a row."""
        return self.layout.columns_with(axis=self.tilted, heights=self.ended)

    @property
    def flags(self) -> Mapping[str, FlagFacts]:
        """The flags that a case may have; none if it has no answer."""
        known = SWEEP_FLAGS if self.about_sweeps else TILTED_FLAGS if self.tilted else FLAGS
        return {} if self.refused or self.ended else known


CONTENTS = {
    content.name: content
    for content in (
        Content("positions", SCHEMA),
        Content("refusals", SCHEMA, refused=True),
        Content("tilted-positions", TILTED_SCHEMA, tilted=True),
        Content("tilted-refusals", TILTED_SCHEMA, tilted=True, refused=True),
        Content("ways", SWEEP_SCHEMA, SWEEPS),
        Content("tilted-ways", SWEEP_SCHEMA, SWEEPS, tilted=True),
        Content("way-refusals", SWEEP_SCHEMA, SWEEPS, refused=True),
        Content("tilted-way-refusals", SWEEP_SCHEMA, SWEEPS, tilted=True, refused=True),
        Content("ended-positions", ENDED_SCHEMA, tilted=True, ended=True),
        Content("ended-refusals", ENDED_SCHEMA, tilted=True, refused=True, ended=True),
        Content("ended-ways", ENDED_SWEEP_SCHEMA, SWEEPS, tilted=True, ended=True),
        Content("ended-way-refusals", ENDED_SWEEP_SCHEMA, SWEEPS, tilted=True, refused=True, ended=True),
    )
}
"""All contents by name."""


def content_with(
    layout: Layout = PAIRS, *, tilted: bool = False, refused: bool = False, ended: bool = False
) -> Content:
    """The content of files with such rows; if hyperboloids end, rows have an axis."""
    wanted = (layout, tilted or ended, refused, ended)
    (match,) = (
        content
        for content in CONTENTS.values()
        if (content.layout, content.tilted, content.refused, content.ended) == wanted
    )
    return match


class AnyCase(Protocol):
    """The common attributes of all cases: the permanent `id`, the numbers of the row, the right answer."""

    @property
    def id(self) -> str: ...  # noqa: D102

    @property
    def row(self) -> Row: ...  # noqa: D102

    @property
    def answer(self) -> int: ...  # noqa: D102


Case = TypeVar("Case", bound=AnyCase)


@dataclass(frozen=True)
class CaseFile(Generic[Case]):
    """A file of cases. `lines` are the line numbers of its cases, for messages; 0 if the file was not read.

    `flags` has the meanings of the flags of its cases.
    """

    head: Metadata
    content: Content
    cases: tuple[Case, ...]
    flags: Mapping[str, FlagFacts] = field(default_factory=dict)
    lines: tuple[int, ...] = field(default=(), compare=False, repr=False)

    @property
    def ids(self) -> tuple[str, ...]:
        """The names of the cases."""
        return tuple(case.id for case in self.cases)

    @property
    def rows(self) -> Rows:
        """The rows, float64 (n, as many as the content's columns)."""
        return np.asarray([case.row for case in self.cases], dtype=np.float64).reshape(-1, len(self.content.columns))

    @property
    def positions(self) -> Positions:
        """The right answers, int8 (n,): positions, hits on sweeps, or REFUSED."""
        return np.asarray([case.answer for case in self.cases], dtype=np.int8)

    def numbered_cases(self) -> Iterable[tuple[int, Case]]:
        """Pairs of a line number and its case."""
        return zip(self.lines or (0,) * len(self.cases), self.cases, strict=True)


MEMBERS = ("schema", "content", "family", "flags", "count")
HEAD_FIELDS = tuple(Metadata.__dataclass_fields__)
_NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*(@[a-z0-9.,:=+-]+)?", re.ASCII)


def content_of(document: JsonDocument, path: str) -> Content:
    """The content that the document declares, for its schema version. Raises InputError."""
    for name in ("schema", "content"):
        if name not in document.members:
            raise InputError(f"{path}: the document lacks {name}")
    place, version = document.members["schema"]
    known = {name: content for name, content in CONTENTS.items() if content.schema == version}
    if not known:
        raise InputError(
            f"{place}: schema is {shown_json(version)}; this program reads {SCHEMA!r}, "
            f"{TILTED_SCHEMA!r} about tilted spheroids, {SWEEP_SCHEMA!r} about sweeps, {ENDED_SCHEMA!r} about "
            f"hyperboloids that end and {ENDED_SWEEP_SCHEMA!r} about sweeps beside these"
        )
    place, content = document.members["content"]
    if content not in tuple(known):
        raise InputError(f"{place}: content is {shown_json(content)}; it must be {' or '.join(map(repr, known))}")
    return known[content]


def read_metadata(document: JsonDocument, path: str) -> tuple[Metadata, Mapping[str, FlagFacts]]:
    """The family and the flags of a document, its members and count in order. Raises InputError."""
    content = content_of(document, path)
    wanted = tuple(name for name in MEMBERS if name != "flags" or content.flags)
    for name, (place, _) in document.members.items():
        if name not in wanted:
            raise InputError(f"{place}: the document has the key {name!r}; it may have {', '.join(wanted)}")
    for name in wanted:
        if name not in document.members:
            raise InputError(f"{path}: the document lacks {name}")
    place, count = document.members["count"]
    if not is_integer(count) or count != len(document.cases):
        raise InputError(f"{place}: count is {shown_json(count)}, but there are {len(document.cases)} cases")
    head = _metadata(*document.members["family"])
    return head, _flags(*document.members["flags"], content.flags) if content.flags else {}


ReadCase = Callable[[JsonPlace, dict[str, Any], Content, Mapping[str, FlagFacts]], Case]
"""What makes a case of its fields, checked but for what it holds. Raises InputError."""


def file_of(document: JsonDocument, path: str, names: tuple[str, ...], read: ReadCase[Case]) -> CaseFile[Case]:
    """The file of a document whose cases have these fields. Raises InputError."""
    content = content_of(document, path)
    head, flags = read_metadata(document, path)
    seen: dict[str, int] = {}
    cases = []
    for place, value in document.cases:
        name = value.get("id") if isinstance(value, dict) else None
        at = JsonPlace(path, place.line, name if isinstance(name, str) else None)
        fields = dict(zip(names, fields_of(value, names, at, "the case"), strict=True))
        _check_id(at, fields["id"], head.name)
        if fields["id"] in seen:
            raise InputError(f"{at}: duplicate id; it is first on line {seen[fields['id']]}")
        seen[fields["id"]] = place.line
        cases.append(read(at, fields, content, flags))
    return CaseFile(head, content, tuple(cases), flags, tuple(place.line for place, _ in document.cases))


def listed(place: JsonPlace, what: str, value: Any, length: int | None = None) -> list[Any]:  # noqa: ANN401 - JSON
    """A list, of the given length if there is one. Raises InputError."""
    if not isinstance(value, list) or (length is not None and len(value) != length):
        wanted = "a list" if length is None else f"a list of {length}"
        raise InputError(f"{place}: {what} is {shown_json(value)}; it must be {wanted}")
    return value


def number_of(place: JsonPlace, what: str, value: Any) -> float:  # noqa: ANN401 - JSON
    """A finite number that is written as the shortest decimal of its float64. Raises InputError."""
    if isinstance(value, Literal) and value.text == repr(value):  # the text that hypcheck writes
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
    if not is_integer(fields["version"]) or fields["version"] < 1:
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


def row_of(place: JsonPlace, numbers: Any, hexes: Any, content: Content) -> Row:  # noqa: ANN401 - JSON
    """The numbers of a valid row, and their hexadecimal forms. Raises InputError."""
    columns = content.columns
    row, count = [], len(columns)
    for name, value, text in zip(
        columns, listed(place, "row", numbers, count), listed(place, "hex", hexes, count), strict=True
    ):
        number = _height_of(value) if name in ENDS and isinstance(value, str) else number_of(place, name, value)
        if number is None:
            raise InputError(f'{place}: {name} is {shown_json(value)}; it must be a number, "inf" or "-inf"')
        trouble = None if name in HEIGHTS else trouble_with(name, number)
        if trouble is not None:
            raise InputError(f"{place}: {trouble}")
        check_hex(place, f"the hex of {name}", text, number)
        row.append(number)
    others = row[len(content.layout.upright) :]
    if content.tilted and not any(others[: len(AXIS)]):
        raise InputError(f"{place}: {NO_DIRECTION}")
    trouble = trouble_with_heights(others[len(AXIS) :]) if content.ended else None
    if trouble is not None:
        raise InputError(f"{place}: {trouble}")
    return tuple(row)


def _height_of(text: str) -> float | None:
    return {"inf": math.inf, "-inf": -math.inf}.get(text)


def check_hex(place: JsonPlace, what: str, text: Any, number: float) -> None:  # noqa: ANN401 - JSON
    """Raise InputError unless the text is the hexadecimal form of the number."""
    if text != hex_of(number):
        raise InputError(f"{place}: {what} is {shown_json(text)}; of {number!r} it must be {hex_of(number)!r}")


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
        raise InputError(f"{place}: duplicate flag")
    return tuple(flags)


def is_integer(value: Any) -> bool:  # noqa: ANN401 - JSON
    """Whether a JSON value is a whole number, as it is written."""
    return isinstance(value, int) and not isinstance(value, bool)


def document_text(file: CaseFile[Case], cases: Iterable[str]) -> str:
    """The whole document, ASCII but for the descriptions, with an end of line after every case; these are text."""
    lines = list(cases)
    described = []
    if file.content.flags:
        inner = ",\n".join(f"  {json_text(name)}: {json_text(asdict(facts))}" for name, facts in file.flags.items())
        described = [f'"flags": {{\n{inner}\n}}' if file.flags else '"flags": {}']
    members = [
        f'"schema": {json_text(file.content.schema)}',
        f'"content": {json_text(file.content.name)}',
        f'"family": {json_text(asdict(file.head))}',
        *described,
        f'"count": {len(lines)}',
        '"cases": [\n' + ",\n".join(lines) + "\n]" if lines else '"cases": []',
    ]
    return "{" + ",\n".join(members) + "}\n"


def object_text(members: Mapping[str, str]) -> str:
    """An object of members that are JSON text already."""
    return "{" + ",".join(f'"{name}":{value}' for name, value in members.items()) + "}"


def numbers_text(row: Iterable[float]) -> str:
    """A list of decimals; infinities and NaN are strings."""
    return f"[{','.join(map(decimal_of, row))}]"


def json_text(value: Any) -> str:  # noqa: ANN401 - JSON
    """`value` as JSON without blanks."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
