"""What a kernel says of itself, as its language holds it: a text of JSON, or an object; a line for each setting."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

LONGEST = 4095
"""Characters in a string that every compiler of ISO C takes."""

_BY_PARTS = """static const char *const parts[] = {{
    {parts},
}};
static char text[{size}];  /* ISO C has no strings of more than {longest} characters */
size_t end = 0;
for (size_t part = 0; part < sizeof parts / sizeof *parts; part++)
    for (const char *from = parts[part]; *from; from++) text[end++] = *from;
return text;"""


def described(value: dict[str, Any], language: str) -> str:
    """The description in a language. In C it is what the function does that returns it."""
    if language == "python":
        return "\n    ".join(line.rstrip() for line in _lines(value, repr))
    lines = list(_lines(value, json.dumps))
    if language == "javascript":
        return "\n    ".join(line.rstrip() for line in lines)
    quoted = [json.dumps(line) for line in lines]  # C, C++ and Rust escape quotation marks and backslashes alike
    if language == "rust":
        return ",\n        ".join(quoted)
    if language == "c" and sum(map(len, lines)) > LONGEST:
        size = sum(map(len, lines)) + 1
        return _BY_PARTS.format(parts=",\n    ".join(quoted), size=size, longest=LONGEST)
    return "return " + "\n    ".join(quoted) + ";"


def _lines(value: dict[str, Any], written: Callable[[Any], str]) -> Iterator[str]:
    """The value in pieces that make it when put together: what comes before the settings, each of them, the end."""
    settings = value["domain"]["settings"]
    text = written({**value, "domain": {"settings": []}})  # the settings come last: the text ends with []}}
    yield text[:-3]
    for place, each in enumerate(settings, start=1):
        yield written(each) + (", " if place < len(settings) else "")
    yield text[-3:]
