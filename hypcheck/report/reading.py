"""A record that somebody brings: read, held to the published schema, and known to be of which version."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path
from typing import Any

from hypcheck.errors import InputError
from hypcheck.record import SCHEMA, Line, Record, read
from hypcheck.record.reading import file_of
from hypcheck.report.counts import trouble_with
from hypcheck.report.json_schema import violations
from hypcheck.visible import visible


def read_checked(path: Path) -> Record:
    """The record in a file, or in the folder of a run. Raises InputError naming the line and what is wrong with it.

    Lines of types that later versions add are left as they are.
    """
    file = file_of(path)
    record = read(file)
    lines = [record.header, *record.lines, *([record.footer] if record.footer else [])]
    schema = _schema()
    for number, line in enumerate(lines, start=1):
        _check(line, number, file, schema)
    return record


def notes(record: Record) -> list[str]:
    """Sentences about what a report of this record lacks: its end, or what a later version has written."""
    found = []
    if record.footer is None:
        found.append("the record has no end: the run was interrupted, and its reports show what was finished")
    if _version(record.header["schema"]) > _version(SCHEMA):
        version = record.header["schema"]
        found.append(f"the record has schema {version}, later than this program's {SCHEMA}; what it adds is not shown")
    return found


def _version(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(".")))


def _schema() -> dict[str, Any]:
    text = resources.files("hypcheck.report").joinpath("schemas", f"record-{SCHEMA}.json").read_text(encoding="utf-8")
    return dict(json.loads(text))


def _check(line: Line, number: int, file: Path, schema: dict[str, Any]) -> None:
    kind = line["type"]
    if {"$ref": f"#/$defs/{kind}"} not in schema["oneOf"]:
        return
    wrong = violations(line, schema["$defs"][kind], schema)
    trouble = wrong[0].removeprefix("$.") if wrong else trouble_with(line)
    if trouble:
        raise InputError(f"{file}: line {number}, {kind}: {visible(trouble)}")
