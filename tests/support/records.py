"""Records of any lines with their checksums, and JSON values checked by the library that implements JSON Schema."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from hypcheck.geometry.rows import PAIRS
from hypcheck.record.fields import Unsigned, row_fields
from hypcheck.record.integrity import sealed
from hypcheck.record.progress import UnansweredCase, WorstCase
from hypcheck.record.writer import GrowingFile


class GrowingText(GrowingFile):
    """A growing file in memory, its content as `text`."""

    def __init__(self):
        super().__init__(Path("record.jsonl"))
        self.text = ""

    def write(self, data):
        """Add to the end."""
        self.text += data.decode()

    def renew(self, data):
        """Replace the whole content."""
        self.text = data.decode()


def worst_case(place, case, row, truth, answer, mistake, status, error, time=None, *, layout=PAIRS):
    """A wrong or tolerated answer as a tally keeps it."""
    return WorstCase(
        place=place,
        case=case,
        **row_fields(row, layout),
        truth=truth,
        answer=answer,
        mistake=mistake,
        status=status,
        error=Unsigned(error),
        time=time,
    )


def unanswered_case(place, case, row, status, reason, layout=PAIRS):
    """A case without a valid answer as a tally keeps it."""
    return UnansweredCase(place=place, case=case, **row_fields(row, layout), status=status, reason=reason)


def resealed(lines):
    """The bytes of a record that has these lines."""
    data, check = b"", 0
    for line in lines:
        part, check = sealed({name: value for name, value in line.items() if name != "crc32"}, check)
        data += part
    return data


@cache
def load_jsonschema() -> None:
    """Load jsonschema without the grammars of internationalised addresses: they take two seconds, and few ask for them.

    Whatever asks loads them then.
    """

    def is_valid_syntax(rule: str, text: str) -> bool:
        return importlib.import_module(grammars).is_valid_syntax(rule, text)

    grammars = "rfc3987_syntax"
    if grammars not in sys.modules:
        sys.modules[grammars] = SimpleNamespace(is_valid_syntax=is_valid_syntax)
        try:
            import jsonschema  # noqa: F401
        finally:
            del sys.modules[grammars]


@cache
def _checker() -> Any:
    """The class of validators that takes 500.0 for no integer, as whatever reads JSON or TOML here does.

    The library takes long to load, so that tests without a schema do not load it.
    """
    load_jsonschema()
    from jsonschema import Draft202012Validator
    from jsonschema.validators import extend

    integers = Draft202012Validator.TYPE_CHECKER.redefine("integer", lambda _, value: type(value) is int)
    return extend(Draft202012Validator, type_checker=integers)


def violations(value: Any, schema: dict[str, Any], *, closed: bool = False) -> list[str]:
    """What is wrong with the value, a sentence each; with `closed`, so is a property that the schema does not name."""
    kind = value.get("type") if isinstance(value, dict) else None
    found = _validator(schema, closed, kind if isinstance(kind, str) else "").iter_errors(value)
    return [f"{error.json_path}: {error.message[:300]}" for error in found]


_VALIDATORS: dict[tuple[int, bool, str], tuple[Any, Any]] = {}
"""The last schemas, by their identity, with the validator of each for lines of one type."""


def _validator(schema: dict[str, Any], closed: bool, kind: str) -> Any:
    """Of a choice of types of lines it asks that of the value alone: no other can fit, and there are forty."""
    key = id(schema), closed, kind if "oneOf" in schema else ""
    if key not in _VALIDATORS:
        if len(_VALIDATORS) > 300:
            _VALIDATORS.clear()
        choices = [part for part in schema.get("oneOf", ()) if kind in _types(part, schema, kind)]
        narrowed = {**schema, "oneOf": choices} if choices else schema
        _VALIDATORS[key] = schema, _checker()(_closed(narrowed) if closed else narrowed)
    return _VALIDATORS[key][1]


def _types(part: dict[str, Any], schema: dict[str, Any], otherwise: str) -> Sequence[str]:
    """The types that a part of a choice names, or the other one if it names none."""
    named = schema.get("$defs", {}).get(part.get("$ref", "").removeprefix("#/$defs/"), part)
    return named.get("properties", {}).get("type", {}).get("enum", [otherwise])


def _closed(schema: Any) -> Any:
    """The schema without room for properties that it does not name; of a choice, in each of its parts."""
    if isinstance(schema, list):
        return [_closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    found = {key: _closed(part) for key, part in schema.items()}
    if isinstance(schema.get("properties"), dict) and "oneOf" not in schema:
        found.setdefault("additionalProperties", False)
    return found
