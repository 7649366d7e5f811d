"""A record read as a whole, decoded and validated in one place; and the cases that it keeps with their rows.

Every schema 1.x is read: later versions have added fields and types of lines, and changed none. Fields that an older
record lacks are UNSET or None; fields that a newer record adds are left out.
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
from hypcheck.tables import STREAM
from hypcheck.tables.numbers import shown_json
from hypcheck.tables.streams import open_input

FILE = "record.jsonl"
"""The record's name in the folder of a run."""

GROWING = "record.jsonl.part"
"""The record's name while the run lasts, and after a run that was killed."""

LINES: Mapping[str, type[RecordLine]] = {
    str(kind.__struct_config__.tag): kind
    for module in (lines, progress, measurements)
    for kind in vars(module).values()
    if isinstance(kind, type) and issubclass(kind, RecordLine) and kind not in (RecordLine, NotStartedLine)
}
"""The struct of each type of line; for an implementation that was not started, line_of takes NotStartedLine."""

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
        """Return the lines of one kind, in order."""
        return [line for line in self.lines if isinstance(line, kind)]


def file_of(path: Path) -> Path:
    """Return the file of a record; `path` is that file, or the folder of its run."""
    return path / FILE if os.path.isdir(path) else path  # Path.is_dir() raises if a name is too long


def interrupted_in(path: Path) -> Path:
    """Return the record to resume; in a folder, that of a killed run comes first. Raises InputError for a stream."""
    if str(path) == STREAM:
        raise InputError(f"--resume {STREAM} is standard input; name the file of a record, or the folder of a run")
    return path / GROWING if (path / GROWING).is_file() else file_of(path)


def file_and_newer(path: Path) -> tuple[Path, str]:
    """Return the file of a record, as file_of, and a sentence about a newer run in its folder.

    The sentence is about a newer run that has not finished; it is "" if there is none. Raises InputError if the
    unfinished run is the only one.
    """
    file = file_of(path)
    growing = file.with_name(GROWING)
    if file.name != FILE or not growing.is_file():
        return file, ""
    continues = f"its command with --resume {shlex.quote(str(file.parent))} continues it if it names a SPEC"
    newer = f"{growing} is of a newer run, which was killed or is still running; {continues}"
    if not file.exists():
        raise InputError(f"{file} is not there; {newer}")
    return file, newer


def read(path: Path) -> Record:
    """Read the record in a file, or in the folder of a run; it has no footer if it was cut off after its first line.

    Raises DamagedError, an InputError that names the byte and what is wrong there, if it is not as it was written.
    Raises InputError if it is not a record that this program reads, or if a line has an invalid value.
    """
    path = file_of(path)
    with open_input(str(path)) as reader:
        raws = list(RecordScan(reader))  # all of them: damage matters more than an invalid value before it
    header, *others = _decoded(raws, path)
    footer = others.pop() if others and isinstance(others[-1], FooterLine) else None
    if not isinstance(header, HeaderLine) or not (footer is None or isinstance(footer, FooterLine)):
        raise TypeError("the scan accepted a file that is not a record")
    return Record(header, tuple(others), footer)


def notes(record: Record) -> list[str]:
    """Return sentences about missing parts of a report of this record: its end, or lines of a later version."""
    sentences = []
    if record.footer is None:
        sentences.append("the record has no end: the run was interrupted, and its reports show the finished part")
    version = record.header.schema
    if tuple(map(int, version.split("."))) > tuple(map(int, SCHEMA.split("."))):
        sentences.append(
            f"the record has schema {version}, later than this program's {SCHEMA}; what it adds is not shown"
        )
    return sentences


def line_of(raw: Raw) -> RecordLine | None:
    """Return the struct of a raw line; None for a type that this version does not know. Raises ValidationError."""
    kind = LINES.get(raw["type"])
    if kind is lines.ImplementationLine and raw.get("started") is False:
        kind = NotStartedLine
    return None if kind is None else decoded(raw, kind)


def _decoded(raws: Sequence[Raw], path: Path) -> Iterator[RecordLine]:
    """Yield the struct of each line whose type is known. Raises InputError if a line has an invalid value."""
    for number, raw in enumerate(raws, start=1):
        try:
            line = line_of(raw)
        except msgspec.ValidationError as error:
            raise InputError(f"{path}: line {number}, {escaped(raw['type'])}: {_explained(error, raw)}") from None
        if line is not None:
            yield line


def _explained(error: msgspec.ValidationError, raw: Raw) -> str:
    """Return the error of a line as a sentence: its place, the value, and the allowed values."""
    what, _, path = str(error).partition(" - at `$")
    path = path.removesuffix("`").removeprefix(".")
    missing = re.fullmatch(r"Object missing required field `(\w+)`", what)
    if missing:
        return f"{path or 'it'} lacks {missing[1]}"
    wanted = re.fullmatch(r"Expected (.*?)(?:, got [^,]*)?", what, re.DOTALL)
    if not wanted:
        return escaped(f"{path}: {what}" if path else what)
    must = re.sub(r"`([^`]*)`", lambda match: _named(match[1]), wanted[1])
    must = re.sub(r"matching regex '\^\(([^\\()]*)\)\$'", lambda match: f"out of {match[1].replace('|', ', ')}", must)
    shown = "" if "[...]" in path else f"is {shown_json(_at(raw, path))}; it "
    return escaped(f"{path} {shown}must be {must}")


def _named(types: str) -> str:
    """Return the types of an error of msgspec in words: "a text or a number"."""
    return " or ".join(_TYPES.get(name, name) for name in types.split(" | "))


def _at(raw: Any, path: str) -> object:  # noqa: ANN401 - whatever JSON holds
    """Return the value at a path such as worst[0].row."""
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
    """Return every worst case and every fault in the order of the record; in a group the worst cases come first."""
    kept = [(group, case) for group in record.of(GroupLine) for case in (*group.worst, *(group.faults or ()))]
    return [RecordedCase(number, group, case) for number, (group, case) in enumerate(kept, start=1)]
