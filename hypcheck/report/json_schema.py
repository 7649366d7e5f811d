"""JSON Schema, draft 2020-12, as far as this project's schemas use it; a keyword that is not known here is an error.

The records that people bring are held to the published schema before anything is made of them, so that a report is
never made from half a line. A library for this would be one more dependency of everybody's.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

Schema = Mapping[str, Any]
"""A schema; where it is the schema of a part, also False, which nothing fits."""

Inner = Callable[[Any, Any, str], list[str]]
"""What is wrong with a part of the value by a part of the schema, at a path."""

_SILENT = {"$schema", "$id", "$defs", "title", "description", "properties"}
_TYPES: dict[str, type | tuple[type, ...]] = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
    "null": type(None),
}
_SHOWN = 80
"""Characters of a value that a sentence quotes."""


def violations(
    value: Any,  # noqa: ANN401 - whatever JSON holds
    schema: Schema,
    root: Schema | None = None,
    path: str = "$",
    *,
    closed: bool = False,
) -> list[str]:
    """What is wrong with the value, a sentence each; with `closed`, so is a property that the schema does not name."""
    whole = schema if root is None else root

    def inner(part: Any, below: Any, where: str) -> list[str]:  # noqa: ANN401
        if below is False:
            return [f"{where} must not be there"]
        return violations(part, below, whole, where, closed=closed)

    found: list[str] = []
    for keyword, wanted in schema.items():
        if keyword not in _SILENT:
            speaks_of, check = _KEYWORDS[keyword]
            if isinstance(value, speaks_of):
                found += check(value, wanted, whole, path, inner)
    if isinstance(value, dict):
        found += _of_properties(value, schema, path, inner, closed=closed)
    return found


def _of_properties(value: Mapping[str, Any], schema: Schema, path: str, inner: Inner, *, closed: bool) -> list[str]:
    named: Schema = schema.get("properties", {})
    found: list[str] = []
    for name, part in value.items():
        if name in named:
            found += inner(part, named[name], f"{path}.{name}")
        elif "additionalProperties" in schema:
            found += inner(part, schema["additionalProperties"], f"{path}.{name}")
        elif closed and named and "oneOf" not in schema:
            found.append(f"{path}.{name} is not in the schema")
    return found


def _is(value: object, name: str) -> bool:
    if isinstance(value, bool):
        return name == "boolean"
    return isinstance(value, _TYPES[name])


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"


def _type(value: Any, wanted: Any, _root: Schema, path: str, _inner: Inner) -> list[str]:  # noqa: ANN401
    names = [wanted] if isinstance(wanted, str) else wanted
    return [] if any(_is(value, name) for name in names) else [f"{path} is {_shown(value)}, not {' or '.join(names)}"]


def _one_of(value: Any, wanted: Any, _root: Schema, path: str, inner: Inner) -> list[str]:  # noqa: ANN401
    results = [inner(value, schema, path) for schema in wanted]
    fits = sum(not result for result in results)
    return [] if fits == 1 else [f"{path} fits {fits} of oneOf", *min(results, key=len)]


def _any_of(value: Any, wanted: Any, _root: Schema, path: str, inner: Inner) -> list[str]:  # noqa: ANN401
    results = [inner(value, schema, path) for schema in wanted]
    return [] if any(not result for result in results) else [f"{path} is {_shown(value)}, which fits none of anyOf"]


def _reference(value: Any, wanted: Any, root: Schema, path: str, inner: Inner) -> list[str]:  # noqa: ANN401
    return inner(value, root["$defs"][wanted.removeprefix("#/$defs/")], path)


def _items(value: Any, wanted: Any, _root: Schema, path: str, inner: Inner) -> list[str]:  # noqa: ANN401
    return [text for place, part in enumerate(value) for text in inner(part, wanted, f"{path}[{place}]")]


Check = Callable[[Any, Any, Schema, str, Inner], list[str]]


def _rule(holds: Callable[[Any, Any], bool], says: Callable[[Any, Any], str]) -> Check:
    return lambda value, wanted, _root, path, _inner: [] if holds(value, wanted) else [f"{path} {says(value, wanted)}"]


_KEYWORDS: dict[str, tuple[type | tuple[type, ...], Check]] = {
    "$ref": (object, _reference),
    "type": (object, _type),
    "oneOf": (object, _one_of),
    "anyOf": (object, _any_of),
    "const": (object, _rule(lambda v, w: v == w and type(v) is type(w), lambda _, w: f"is not {w!r}")),
    "enum": (object, _rule(lambda v, w: v in w, lambda v, w: f"is {_shown(v)}, not one of {w}")),
    "required": (dict, _rule(lambda v, w: set(w) <= set(v), lambda v, w: f"lacks {', '.join(sorted({*w} - {*v}))}")),
    "additionalProperties": (dict, lambda *_: []),
    "items": (list, _items),
    "minItems": (list, _rule(lambda v, w: len(v) >= w, lambda _, w: f"has fewer than {w} items")),
    "maxItems": (list, _rule(lambda v, w: len(v) <= w, lambda _, w: f"has more than {w} items")),
    "exclusiveMinimum": ((int, float), _rule(lambda v, w: v > w, lambda v, w: f"is {v}, not above {w}")),
    "minimum": ((int, float), _rule(lambda v, w: v >= w, lambda v, w: f"is {v}, below {w}")),
    "maximum": ((int, float), _rule(lambda v, w: v <= w, lambda v, w: f"is {v}, above {w}")),
    "pattern": (
        str,
        _rule(lambda v, w: re.search(w, v) is not None, lambda v, w: f"is {_shown(v)}, not like {w}"),
    ),
}
"""What each keyword speaks of, and its check; it says nothing about values of other types."""
