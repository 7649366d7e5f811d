"""Filling a template: ${name} in a line becomes its text; alone on a line, its lines, indented as the mark was."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib import resources

_ALONE = re.compile(r"^( *)\$\{(\w+)\}$", re.MULTILINE)
_WITHIN = re.compile(r"\$\{(\w+)\}")


def template(name: str) -> str:
    """The text of a template of this package."""
    return resources.files("hypcheck.kernel.emission").joinpath("templates", name).read_text(encoding="utf-8")


def filled(text: str, parts: Mapping[str, str]) -> str:
    """The text with its marks filled in, once: what a part says is never taken for a mark.

    Raises KeyError for a mark that has no part.
    """

    def block(match: re.Match[str]) -> str:
        indent, lines = match.group(1), parts[match.group(2)].splitlines()
        return "\n".join(f"{indent}{line}" if line else "" for line in lines)

    pieces = []
    end = 0
    for match in _ALONE.finditer(text):
        pieces += [_inline(text[end : match.start()], parts), block(match)]
        end = match.end()
    return "".join([*pieces, _inline(text[end:], parts)])


def _inline(text: str, parts: Mapping[str, str]) -> str:
    return _WITHIN.sub(lambda match: parts[match.group(1)], text)
