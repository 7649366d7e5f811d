"""A record read as a whole: decoded and validated in one place; and the cases that it keeps with their rows.

A record read as a whole: decoded into its lines and held to what they may be, in one place for everybody who reads.

Every schema 1.x is read: later versions have added fields and types of lines, and changed none. Nothing is converted:
what an older record lacks is UNSET or None in its lines, and what a newer one has beside them is left out.

The cases that a record keeps with their rows, numbered: what RECORD:N on the command line names.
"""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from hypcheck.errors import InputError
from hypcheck.messages import escaped
from hypcheck.record import lines, measurements, progress
from hypcheck.record.fields import RecordLine, decoded
from hypcheck.record.integrity import Raw, RecordScan
from hypcheck.record.lines import SCHEMA, FaultPart, FooterLine, GroupLine, HeaderLine, NotStartedLine, WrongAnswer
from hypcheck.tables.numbers import shown_json
from hypcheck.tables.streams import reading

FILE = "record.jsonl"
"""The record's name in the folder of a run."""

GROWING = "record.jsonl.part"
"""Its name while the run goes on, and after one that was killed."""

LINES: Mapping[str, type[RecordLine]] = {
    str(kind.__struct_config__.tag): kind
    for module in (lines, progress, measurements)
    for kind in vars(module).values()
    if isinstance(kind, type) and issubclass(kind, RecordLine) and kind not in (RecordLine, NotStartedLine)
}
"""What a line of each type is decoded into; an implementation that was not started is a NotStarted."""

Kind = TypeVar("Kind", bound=RecordLine)

_TYPES = {
    "object": "an object",
    "array": "a list",
    "str": "a text",
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
}


@dataclass(frozen=True)
class Record:
    """A record as read: its header, its lines between header and footer, and its footer (None: truncated)."""

    header: HeaderLine
    lines: tuple[RecordLine, ...]
    footer: FooterLine | None

    def of(self, kind: type[Kind]) -> list[Kind]:
        """The lines of one kind, in order."""
        return [line for line in self.lines if isinstance(line, kind)]


def file_of(path: Path) -> Path:
    """The file of a record, which may be named by the folder of its run."""
    return path / FILE if os.path.isdir(path) else path  # is_dir() raises where a name is too long


def interrupted_in(path: Path) -> Path:
    """The file of a record to go on with: in the folder of a run, that of one that was killed goes before."""
    return path / GROWING if (path / GROWING).is_file() else file_of(path)


def file_and_newer(path: Path) -> tuple[Path, str]:
    """As file_of, and a sentence about a newer run in its folder that has not finished; empty where there is none.

    Raises InputError where the newer run is the only one.
    """
    file = file_of(path)
    growing = file.with_name(GROWING)
    if file.name != FILE or not growing.is_file():
        return file, ""
    goes_on = f"its command with --resume {shlex.quote(str(file.parent))} goes on with it where it names a SPEC"
    newer = f"{growing} is of a newer run, which was killed or is still at work; {goes_on}"
    if not file.exists():
        raise InputError(f"{file} is not there; {newer}")
    return file, newer


def read(path: Path) -> Record:
    """The record in a file, or in the folder of a run, truncated where it was cut off anywhere behind its first line.

    Raises DamagedError, an InputError that names the byte and what is wrong there, where it is not as it was written,
    and InputError where it is no record that this program reads, or a line has something that it must not have.
    """
    path = file_of(path)
    with reading(str(path)) as reader:
        raws = list(RecordScan(reader))  # all of them: what is damaged behind a line matters more than what is in it
    header, *found = _decoded(raws, path)
    footer = found.pop() if found and isinstance(found[-1], FooterLine) else None
    if not isinstance(header, HeaderLine) or not (footer is None or isinstance(footer, FooterLine)):
        raise TypeError("the scan has let through what is no record")
    return Record(header, tuple(found), footer)


def notes(record: Record) -> list[str]:
    """Sentences about what a report of this record lacks: its end, or what a later version has written."""
    found = []
    if record.footer is None:
        found.append("the record has no end: the run was interrupted, and its reports show what was finished")
    version = record.header.schema
    if tuple(map(int, version.split("."))) > tuple(map(int, SCHEMA.split("."))):
        found.append(f"the record has schema {version}, later than this program's {SCHEMA}; what it adds is not shown")
    return found


def line_of(raw: Raw) -> RecordLine | None:
    """The value of a line as JSON has it, None of a type that this version does not know. Raises ValidationError."""
    kind = LINES.get(raw["type"])
    if kind is lines.ImplementationLine and raw.get("started") is False:
        kind = NotStartedLine
    return None if kind is None else decoded(raw, kind)


def _decoded(raws: Sequence[Raw], path: Path) -> Iterator[RecordLine]:
    for number, raw in enumerate(raws, start=1):
        try:
            line = line_of(raw)
        except msgspec.ValidationError as error:
            raise InputError(f"{path}: line {number}, {escaped(raw['type'])}: {_said(error, raw)}") from None
        if line is not None:
            yield line


def _said(error: msgspec.ValidationError, raw: Raw) -> str:
    """What is wrong with a line: where in it, what stands there, and what must."""
    what, _, path = str(error).partition(" - at `$")
    path = path.removesuffix("`").removeprefix(".")
    missing = re.fullmatch(r"Object missing required field `(\w+)`", what)
    if missing:
        return f"{path or 'it'} lacks {missing[1]}"
    wanted = re.fullmatch(r"Expected (.*?)(?:, got [^,]*)?", what, re.DOTALL)
    if not wanted:
        return escaped(f"{path}: {what}" if path else what)
    must = re.sub(r"`([^`]*)`", lambda found: _named(found[1]), wanted[1])
    must = re.sub(r"matching regex '\^\(([^\\()]*)\)\$'", lambda found: f"out of {found[1].replace('|', ', ')}", must)
    stands = "" if "[...]" in path else f"is {shown_json(_at(raw, path))}; it "
    return escaped(f"{path} {stands}must be {must}")


def _named(types: str) -> str:
    return " or ".join(_TYPES.get(name, name) for name in types.split(" | "))


def _at(raw: Any, path: str) -> object:  # noqa: ANN401 - whatever JSON holds
    """What stands at a path such as worst[0].row."""
    for name, index in re.findall(r"(\w+)|\[(\d+)\]", path):
        raw = raw[name] if name else raw[int(index)]
    return raw


@dataclass(frozen=True, slots=True)
class RecordedCase:
    """The `number`-th case of a record, from 1 on, and the line of the group it belongs to."""

    number: int
    group: GroupLine
    case: WrongAnswer | FaultPart


def recorded_cases(record: Record) -> list[RecordedCase]:
    """Every worst case and every fault, in the order of the record; of a group first the worst, then the faults."""
    kept = [(group, case) for group in record.of(GroupLine) for case in (*group.worst, *(group.faults or ()))]
    return [RecordedCase(number, group, case) for number, (group, case) in enumerate(kept, start=1)]
