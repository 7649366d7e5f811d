"""The published schemas: that of a record's lines and that of summary.json, made from the structs that hold these.

`make schemas` writes their files.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec

import hypcheck
from hypcheck.record.fields import Extended, Histogram, SmallBin, Unsigned
from hypcheck.record.lines import SCHEMA, NotStartedLine
from hypcheck.record.reader import LINES
from hypcheck.report.summary import SCHEMA as SUMMARY_SCHEMA
from hypcheck.report.summary import Summary

Json = dict[str, Any]

DRAFT = "https://json-schema.org/draft/2020-12/schema"

_CRC = "Since 1.2.0 the last field of every line: the CRC-32 of all bytes before it, but for checksums and line ends."


def record_schema() -> Json:
    """The schema of a line of a record: every type of line, and every part of one, is a definition."""
    references, definitions = components([*LINES.values(), NotStartedLine])
    return {
        "$schema": DRAFT,
        "$id": f"urn:hypcheck:record-line:{SCHEMA}",
        "title": f"A line of record.jsonl of hypcheck, version {SCHEMA}",
        "description": "Explained in docs/record.md. Later versions 1.x may add fields and types of lines and change "
        "none; ignore what you do not know.",
        "type": "object",
        "required": ["type"],
        "properties": {"crc32": {"description": _CRC, "type": "string", "pattern": "^[0-9a-f]{8}$"}},
        "oneOf": references,
        "$defs": definitions,
    }


def summary_schema() -> Json:
    """The schema of summary.json."""
    _, definitions = components([Summary])
    head = {
        "$schema": DRAFT,
        "$id": f"urn:hypcheck:summary:{SUMMARY_SCHEMA}",
        "title": f"summary.json of hypcheck, version {SUMMARY_SCHEMA}",
    }
    return {**head, **definitions.pop("summary"), "$defs": definitions}


def components(kinds: Iterable[type]) -> tuple[list[Json], Json]:
    """References to these kinds, and the definitions of them and of all their parts."""
    references, definitions = msgspec.json.schema_components(kinds, schema_hook=_custom, ref_template="#/$defs/{name}")
    whole = [list(references), {_named(name): _untitled(each) for name, each in definitions.items()}]
    text = re.sub(r'"#/\$defs/(\w+)"', lambda match: f'"#/$defs/{_named(match[1])}"', json.dumps(whole))
    found: tuple[list[Json], Json] = tuple(json.loads(text))
    return found


def text(schema: Json) -> str:
    """The text of the file that publishes a schema: one property or definition on each line."""
    fields = ",\n".join(f"  {_json(name)}: {_entries(name, each)}" for name, each in schema.items())
    return f"{{\n{fields}\n}}\n"


def _entries(name: str, value: object) -> str:
    if not isinstance(value, dict) or name not in ("properties", "$defs"):
        return _json(value)
    entries = ",\n".join(f"    {_json(key)}: {_json(each)}" for key, each in value.items())
    return f"{{\n{entries}\n  }}"


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


PUBLISHED_NAMES = {
    "Tally": "saved_tally",
    "WorstCase": "saved_answer",
    "UnansweredCase": "saved_fault",
    "Explained": "saved_explained",
}
"""Definitions of the state of a run, as the first schema that had them named them."""


def _named(name: str) -> str:
    """wrong_answer for WrongAnswer, speed for SpeedLine: the definition of a type of line has its name."""
    if name in PUBLISHED_NAMES:
        return PUBLISHED_NAMES[name]
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", re.sub(r"(Line|Part)$", "", name)).lower()


def _untitled(definition: Json) -> Json:
    text = {"description": cleandoc(definition["description"])} if "description" in definition else {}
    return {key: value for key, value in definition.items() if key != "title"} | text


def _custom(kind: type) -> Json:
    if kind is Histogram:
        return msgspec.json.schema(list[SmallBin])
    if not issubclass(kind, Extended):
        raise TypeError(f"no line has a {kind.__name__}")
    if kind is Unsigned:
        return {"anyOf": [{"type": "number", "minimum": 0}, {"const": "inf"}]}
    return {"anyOf": [{"type": "number"}, {"enum": ["inf", "-inf"]}]}


FOLDER = Path(hypcheck.__file__).parent / "report/schemas"

PUBLISHED = {
    FOLDER / f"record-{SCHEMA}.json": record_schema,
    FOLDER / f"summary-{SUMMARY_SCHEMA}.json": summary_schema,
}

if __name__ == "__main__":
    for file, schema in PUBLISHED.items():
        file.write_text(text(schema()), encoding="utf-8")
