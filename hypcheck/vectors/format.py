"""The document of a vector file: read strictly, and written as the same bytes for the same content.

Everything that the schema does not allow is refused, naming file, line and case. One case is one line. cases.py defines
the content of a case, and invalid_rows.py the content of a row that must be refused.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from hypcheck import strict, toml
from hypcheck.geometry.pair import (
    ENDS,
    HEIGHTS,
    NO_DIRECTION,
    NO_GROUPS,
    Groups,
    trouble_with,
    trouble_with_heights,
)
from hypcheck.geometry.rows import Positions, Rows, columns_with, layout_with
from hypcheck.strict import Check, StrictTable
from hypcheck.tables.numbers import Literal, decimal_of, hex_of, is_shortest, rational_of, shown_json
from hypcheck.tables.strict_json import JsonDocument, JsonPlace
from hypcheck.vectors.draw import MARK, Family, Row

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


@dataclass(frozen=True, kw_only=True)
class Metadata:
    """The metadata of a file: the family's name, the version of its generator, and the command that made the file.

    `title`, `source` (the origin of the idea, or how the rows are made) and `purpose` (what a wrong program does here)
    are for people; so are `game` and `drone`, the consequence of a wrong answer for a game or a drone. `regimes`: the
    hyperboloids that occur, by a = α/b and c = γ/d. `extreme`: as in Family.
    """

    name: str
    version: int
    title: str
    source: str
    purpose: str
    game: str
    drone: str
    regimes: str
    extreme: bool
    made_by: str


def descriptions() -> dict[str, dict[str, str]]:
    """Read the texts of descriptions.toml by name."""
    return toml.shipped("hypcheck.vectors", "descriptions.toml")


def described(name: str, made_by: str, family: Family | None = None) -> Metadata:
    """Return the metadata of a file of that name, of a family if there is one, that the command `made_by` makes.

    The texts are those of descriptions.toml; for fixed sizes the trap's texts.
    """
    texts = {"regimes": "all four", **descriptions()[name.partition(MARK)[0]]}
    version, extreme = (1, False) if family is None else (family.version, family.extreme)
    return Metadata(name=name, version=version, extreme=extreme, made_by=made_by, **texts)


@dataclass(frozen=True, slots=True)
class FlagFacts:
    """The meaning of a flag, and the kind of defect that cases with it find."""

    meaning: str
    bug_type: str


@cache
def flag_facts(group: str) -> Mapping[str, FlagFacts]:
    """Read the flags of a group of flags.toml, upright, tilted or sweeps, in the order in which a case has them."""
    texts = toml.shipped("hypcheck.vectors", "flags.toml")
    return {name: FlagFacts(**(facts or texts["upright"][name])) for name, facts in texts[group].items()}


@dataclass(frozen=True, slots=True)
class Content:
    """The kind of content of a file: its name in the file, and the version of its schema.

    `groups` are the groups of columns that its rows have; rows with heights also have an axis. `refused`: rows are not
    valid, and have no answers.
    """

    name: str
    schema: str
    groups: Groups = NO_GROUPS
    refused: bool = False

    @property
    def about_sweeps(self) -> bool:
        """Whether the rows are sweeps."""
        return "end" in self.groups

    @property
    def tilted(self) -> bool:
        """Whether the rows have an axis."""
        return "axis" in self.groups

    @property
    def ended(self) -> bool:
        """Whether the hyperboloids end."""
        return "heights" in self.groups

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the numbers of a row."""
        return columns_with(self.groups)

    @property
    def flags(self) -> Mapping[str, FlagFacts]:
        """The flags that a case may have; none if it has no answer."""
        if self.refused or self.ended:
            return {}
        return flag_facts("sweeps" if self.about_sweeps else "tilted" if self.tilted else "upright")


_SWEPT, _TILTED, _ENDED = frozenset({"end"}), frozenset({"axis"}), frozenset({"axis", "heights"})

CONTENTS = {
    content.name: content
    for content in (
        Content("positions", SCHEMA),
        Content("refusals", SCHEMA, refused=True),
        Content("tilted-positions", TILTED_SCHEMA, _TILTED),
        Content("tilted-refusals", TILTED_SCHEMA, _TILTED, refused=True),
        Content("ways", SWEEP_SCHEMA, _SWEPT),
        Content("tilted-ways", SWEEP_SCHEMA, _SWEPT | _TILTED),
        Content("way-refusals", SWEEP_SCHEMA, _SWEPT, refused=True),
        Content("tilted-way-refusals", SWEEP_SCHEMA, _SWEPT | _TILTED, refused=True),
        Content("ended-positions", ENDED_SCHEMA, _ENDED),
        Content("ended-refusals", ENDED_SCHEMA, _ENDED, refused=True),
        Content("ended-ways", ENDED_SWEEP_SCHEMA, _SWEPT | _ENDED),
        Content("ended-way-refusals", ENDED_SWEEP_SCHEMA, _SWEPT | _ENDED, refused=True),
    )
}
"""All contents by name."""


def content_with(groups: Groups = NO_GROUPS, *, refused: bool = False) -> Content:
    """Return the content of files whose rows have these groups; if hyperboloids end, rows have an axis."""
    wanted = groups | {"axis"} if "heights" in groups else groups
    (match,) = (content for content in CONTENTS.values() if (content.groups, content.refused) == (wanted, refused))
    return match


@dataclass(frozen=True)
class CaseFile:
    """A file of cases, each of which has an `id`, the numbers of a `row`, and the right `answer` as a number.

    `flags` has the meanings of the flags of its cases. `lines` are the line numbers of its cases, for messages; 0 if
    the file was not read.
    """

    head: Metadata
    content: Content
    cases: tuple[Any, ...]
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

    def numbered_cases(self) -> Iterable[tuple[int, Any]]:
        """Return pairs of a line number and its case."""
        return zip(self.lines or (0,) * len(self.cases), self.cases, strict=True)


MEMBERS = ("schema", "content", "family", "flags", "count")
HEAD_FIELDS = tuple(Metadata.__dataclass_fields__)
_NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*(@[a-z0-9.,:=+-]+)?", re.ASCII)


_SCHEMAS = (
    f"{SCHEMA!r}, {TILTED_SCHEMA!r} about tilted spheroids, {SWEEP_SCHEMA!r} about sweeps, {ENDED_SCHEMA!r} about "
    f"hyperboloids that end, or {ENDED_SWEEP_SCHEMA!r} about sweeps beside these"
)


def content_of(document: JsonDocument) -> Content:
    """Read the content that the document declares, for its schema version. Raises InputError."""
    members = document.table(MEMBERS)
    schema = members.required("schema", _schema)
    known = {name: content for name, content in CONTENTS.items() if content.schema == schema}
    return known[members.required("content", strict.one_of(*known))]


def _schema(value: object) -> str:
    """Return a schema version that this program reads. Raises ValueError."""
    if not isinstance(value, str) or all(content.schema != value for content in CONTENTS.values()):
        raise ValueError(f"one that this program reads: {_SCHEMAS}")
    return value


def read_metadata(document: JsonDocument) -> tuple[Metadata, Mapping[str, FlagFacts]]:
    """Read the family and the flags of a document. Raises InputError if they, other members or the count are wrong."""
    content = content_of(document)
    members = document.table([name for name in MEMBERS if name != "flags" or content.flags])
    family = members.required_table("family", HEAD_FIELDS)
    head = Metadata(**{name: family.required(name, _HEAD_CHECKS.get(name, a_text)) for name in HEAD_FIELDS})
    flags = _flags(members.required_table("flags", tuple(content.flags))) if content.flags else {}
    members.required("count", _count(len(document.cases)))
    return head, flags


def _count(cases: int) -> Check[int]:
    """Return the check that a count is the number of cases."""

    def check(value: object) -> int:
        if not is_integer(value) or value != cases:
            raise ValueError(f"{cases}, the number of cases")
        return cases

    return check


def _name(value: object) -> str:
    """Return the name of a family. Raises ValueError."""
    if not _NAME.fullmatch(a_text(value)):
        raise ValueError("lower case, with hyphens, as in ring")
    return a_text(value)


def _version(value: object) -> int:
    """Return the version of a generator. Raises ValueError."""
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        raise ValueError("a whole number from 1")
    return value


_HEAD_CHECKS: Mapping[str, Check[Any]] = {"name": _name, "version": _version, "extreme": strict.truth}
"""The checks of metadata that are not texts, by field."""


def _flags(table: StrictTable) -> Mapping[str, FlagFacts]:
    """Read the meanings of the flags that a file describes. Raises InputError."""
    facts = {name: table.required_table(name, ("meaning", "bug_type")) for name in table}
    return {
        name: FlagFacts(about.required("meaning", a_text), about.required("bug_type", a_text))
        for name, about in facts.items()
    }


ReadCase = Callable[[str, StrictTable, Content, Mapping[str, FlagFacts]], Any]
"""The type of a function that makes a case of its id and its fields. Raises InputError."""


def file_of(document: JsonDocument, names: tuple[str, ...], read: ReadCase) -> CaseFile:
    """Read the file of a document whose cases have the fields `names`; `read` reads each case. Raises InputError."""
    content = content_of(document)
    head, flags = read_metadata(document)
    check_id = _id_of(head.name)
    seen: dict[str, int] = {}
    cases = []
    for place, value in document.cases:
        name = value.get("id") if isinstance(value, dict) else None
        at = JsonPlace(place.file, place.line, name if isinstance(name, str) else None)
        table = StrictTable(at, (), value, names)
        identity = table.required("id", check_id)
        if identity in seen:
            table.refuse(f"duplicate id; it is first on line {seen[identity]}")
        seen[identity] = place.line
        cases.append(read(identity, table, content, flags))
    return CaseFile(head, content, tuple(cases), flags, tuple(place.line for place, _ in document.cases))


def _id_of(family: str) -> Check[str]:
    """Return the check of a case's id: family-0001 for a frozen case, family/version/seed/index for a generated one."""
    wanted = re.compile(re.escape(family) + r"(-[0-9]{4,}|(/(0|[1-9][0-9]*)){3})", re.ASCII)

    def check(value: object) -> str:
        if not isinstance(value, str) or not wanted.fullmatch(value):
            raise ValueError(f"{family}-NNNN or {family}/VERSION/SEED/INDEX")
        return value

    return check


def a_text(value: object) -> str:
    """Return the value if it is a text that is not empty, of any length. Raises ValueError."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError("a text")
    return value


def a_number(value: object) -> float:
    """Return the value if it is finite and written as the shortest decimal of its float64. Raises ValueError."""
    if isinstance(value, Literal) and value.text == repr(value):  # the text that hypcheck writes
        return float(value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError("a number")  # noqa: TRY004 - turned into a sentence about the value
    if not is_shortest(value):
        raise ValueError("the shortest decimal that float64 reads back as itself")
    return float(value)


def a_rational(value: object) -> Fraction:
    """Read a text that is a fraction in lowest terms. Raises ValueError."""
    return rational_of(a_text(value))


def row_of(table: StrictTable, content: Content) -> Row:
    """Read the numbers of a valid row, and check their hexadecimal forms. Raises InputError."""
    columns = content.columns
    wanted = strict.list_with(f"a list of {len(columns)}", len(columns), len(columns))
    row = []
    for name, value, text in zip(columns, table.required("row", wanted), table.required("hex", wanted), strict=True):
        row.append(table.check(name, value, _height if name in ENDS else a_number))
        trouble = None if name in HEIGHTS else trouble_with(name, row[-1])
        if trouble is not None:
            table.refuse(trouble)
        check_hex(table, f"the hex of {name}", text, row[-1])
    _, axis, heights = layout_with(content.groups).split(row)
    trouble = NO_DIRECTION if axis and not any(axis) else trouble_with_heights(heights) if heights else None
    if trouble is not None:
        table.refuse(trouble)
    return tuple(row)


_number_or_infinity = strict.or_word("inf", strict.or_word("-inf", a_number))


def _height(value: object) -> float:
    """Return a height, which may be infinite. Raises ValueError."""
    return float(_number_or_infinity(value))


def check_hex(table: StrictTable, what: str, text: object, number: float) -> None:
    """Raise InputError unless the text is the hexadecimal form of the number."""
    if text != hex_of(number):
        table.refuse(f"{what} is {shown_json(text)}; of {number!r} it must be {hex_of(number)!r}")


def flags_of_case(table: StrictTable, known: Mapping[str, FlagFacts]) -> tuple[str, ...]:
    """Read the flags of a case; the file must describe each of them. Raises InputError."""
    flags = table.required("flags", strict.list_with("a list"))
    for flag in flags:
        if not isinstance(flag, str) or flag not in known:
            table.refuse(f"the flag {shown_json(flag)} is not among those that the file describes")
    if len(set(flags)) < len(flags):
        table.refuse("duplicate flag")
    return tuple(flags)


def is_integer(value: Any) -> bool:  # noqa: ANN401 - JSON
    """Decide whether a JSON value is written as a whole number, without a point."""
    return isinstance(value, int) and not isinstance(value, bool)


def document_text(file: CaseFile, cases: Iterable[str]) -> str:
    """Return the text of the document, ASCII except for the descriptions; each of `cases` is the text of one line."""
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
    """Return the text of an object whose members are JSON text already."""
    return "{" + ",".join(f'"{name}":{value}' for name, value in members.items()) + "}"


def numbers_text(row: Iterable[float]) -> str:
    """Return the text of a list of decimals; infinities and NaN are strings."""
    return f"[{','.join(map(decimal_of, row))}]"


def json_text(value: Any) -> str:  # noqa: ANN401 - JSON
    """Return `value` as JSON without blanks."""
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
