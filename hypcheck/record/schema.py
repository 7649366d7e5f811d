"""The published JSON schema of a record's lines, made from their values: `make schemas` writes it anew."""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

import msgspec

from hypcheck.record.fields import Extended, Unsigned
from hypcheck.record.lines import SCHEMA, NotStarted
from hypcheck.record.reader import LINES

Json = dict[str, Any]

_CRC = "Since 1.2.0 the last field of every line: the CRC-32 of all bytes before it, but for checksums and line ends."


def schema() -> Json:
    """The schema of a line, draft 2020-12. Every type of line, and every part of one, is a definition."""
    kinds = [*LINES.values(), NotStarted]
    references, definitions = msgspec.json.schema_components(
        kinds, schema_hook=_extended, ref_template="#/$defs/{name}"
    )
    whole = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:hypcheck:record-line:{SCHEMA}",
        "title": f"A line of record.jsonl of hypcheck, version {SCHEMA}",
        "description": "Explained in docs/record.md. Later versions 1.x may add fields and types of lines and change "
        "none; ignore what you do not know.",
        "type": "object",
        "required": ["type"],
        "properties": {"crc32": {"description": _CRC, "type": "string", "pattern": "^[0-9a-f]{8}$"}},
        "oneOf": list(references),
        "$defs": {_named(name): _untitled(each) for name, each in definitions.items()},
    }
    text = json.dumps(whole, ensure_ascii=False)
    found: Json = json.loads(re.sub(r'"#/\$defs/(\w+)"', lambda match: f'"#/$defs/{_named(match[1])}"', text))
    return found


def file_name() -> str:
    """The name of the file in which this version is published."""
    return f"record-{SCHEMA}.json"


def text() -> str:
    """The content of that file, a definition a line."""
    found = schema()
    definitions = ",\n".join(f"    {_json(name)}: {_json(each)}" for name, each in found.pop("$defs").items())
    fields = "".join(f"  {_json(name)}: {_json(each)},\n" for name, each in found.items())
    return f'{{\n{fields}  "$defs": {{\n{definitions}\n  }}\n}}\n'


def _json(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def _named(name: str) -> str:
    """wrong_answer for WrongAnswer: the definition of a type of line has its name."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()


def _untitled(definition: Json) -> Json:
    return {key: value for key, value in definition.items() if key != "title"}


def _extended(kind: type) -> Json:
    if not issubclass(kind, Extended):
        raise TypeError(f"no line has a {kind.__name__}")
    if kind is Unsigned:
        return {"anyOf": [{"type": "number", "minimum": 0}, {"const": "inf"}]}
    return {"anyOf": [{"type": "number"}, {"enum": ["inf", "-inf"]}]}


if __name__ == "__main__":
    (Path(sys.argv[1]) / file_name()).write_text(text(), encoding="utf-8")
