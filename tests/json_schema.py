"""JSON Schema, draft 2020-12, as far as this project's schemas use it; a keyword that is not known here is an error."""

from __future__ import annotations

import re

SILENT = {"$schema", "$id", "$defs", "title", "description", "properties"}
TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
    "null": type(None),
}


def violations(value, schema, root=None, path="$", *, closed=False):
    """What is wrong with the value, a sentence each; with `closed`, so is a property that the schema does not name."""
    root = schema if root is None else root

    def inner(part, below, where):
        if below is False:  # the schema of nothing
            return [f"{where} must not be there"]
        return violations(part, below, root, where, closed=closed)

    found = []
    for keyword, wanted in schema.items():
        if keyword not in SILENT:
            speaks_of, check = KEYWORDS[keyword]
            if isinstance(value, speaks_of):
                found += check(value, wanted, root, path, inner)
    if isinstance(value, dict):
        found += _of_properties(value, schema, path, inner, closed=closed)
    return found


def _of_properties(value, schema, path, inner, *, closed):
    named, found = schema.get("properties", {}), []
    for name, part in value.items():
        if name in named:
            found += inner(part, named[name], f"{path}.{name}")
        elif "additionalProperties" in schema:
            found += inner(part, schema["additionalProperties"], f"{path}.{name}")
        elif closed and named and "oneOf" not in schema:
            found.append(f"{path}.{name} is not in the schema")
    return found


def _is(value, name):
    if isinstance(value, bool):
        return name == "boolean"
    return isinstance(value, TYPES[name])


def _type(value, wanted, root, path, inner):
    names = [wanted] if isinstance(wanted, str) else wanted
    return [] if any(_is(value, name) for name in names) else [f"{path} is {value!r}, not {wanted}"]


def _one_of(value, wanted, root, path, inner):
    results = [inner(value, schema, path) for schema in wanted]
    if sum(not result for result in results) == 1:
        return []
    return [f"{path} fits {sum(not result for result in results)} of oneOf", *min(results, key=len)]


def _any_of(value, wanted, root, path, inner):
    results = [inner(value, schema, path) for schema in wanted]
    return [] if any(not result for result in results) else [f"{path} fits none of anyOf"]


def _reference(value, wanted, root, path, inner):
    return inner(value, root["$defs"][wanted.removeprefix("#/$defs/")], path)


def _says(holds, text):
    return [] if holds else [text]


def _items(value, wanted, root, path, inner):
    return [text for place, part in enumerate(value) for text in inner(part, wanted, f"{path}[{place}]")]


KEYWORDS = {
    "$ref": (object, _reference),
    "type": (object, _type),
    "oneOf": (object, _one_of),
    "anyOf": (object, _any_of),
    "const": (object, lambda v, w, root, path, inner: _says(v == w and type(v) is type(w), f"{path} is not {w!r}")),
    "enum": (object, lambda v, w, root, path, inner: _says(v in w, f"{path} is {v!r}, not one of {w}")),
    "required": (dict, lambda v, w, root, path, inner: _says(set(w) <= set(v), f"{path} lacks {set(w) - set(v)}")),
    "additionalProperties": (dict, lambda v, w, root, path, inner: []),
    "items": (list, _items),
    "minItems": (list, lambda v, w, root, path, inner: _says(len(v) >= w, f"{path} has fewer than {w} items")),
    "maxItems": (list, lambda v, w, root, path, inner: _says(len(v) <= w, f"{path} has more than {w} items")),
    "minimum": ((int, float), lambda v, w, root, path, inner: _says(v >= w, f"{path} is {v}, below {w}")),
    "exclusiveMinimum": ((int, float), lambda v, w, root, path, inner: _says(v > w, f"{path} is {v}, not above {w}")),
    "pattern": (str, lambda v, w, root, path, inner: _says(re.search(w, v), f"{path} is {v!r}, not like {w}")),
}
"""What each keyword speaks of, and its check; it says nothing about values of other types."""
