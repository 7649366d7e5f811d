"""The pieces of a Markdown file (CommonMark and GitHub's tables), with foreign text made harmless."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from hypcheck.visible import visible

_SPECIAL = re.compile(r"[\\`*_\[\]~$|<>&]")
_ENTITIES = {"|": "&#124;", "<": "&lt;", ">": "&gt;", "&": "&amp;"}
_BLOCK_START = re.compile(r"^(?:[-+=#]|\d+(?=[.)](?:\s|$)))")


def text(foreign: object) -> str:
    """The text as running text that means itself, in a table's cell as elsewhere."""
    safe = _SPECIAL.sub(lambda found: _ENTITIES.get(found[0], "\\" + found[0]), visible(foreign))
    return _BLOCK_START.sub(lambda found: "".join(f"&#{ord(c)};" for c in found[0]), safe)


def code(foreign: object) -> str:
    """The text as code, in a table's cell as elsewhere; nothing for the empty text.

    A code span has no escapes, so a text with a bar or a backtick becomes an element whose marks are entities.
    """
    shown = visible(foreign)
    if "|" in shown or "`" in shown:
        return "<code>" + "".join(c if c.isalnum() or c in " ,." else f"&#{ord(c)};" for c in shown) + "</code>"
    return f"`{shown}`" if shown else ""


def table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Iterable[int] = ()) -> list[str]:
    """The lines of a table and an empty one; the columns `numbers` are set to the right.

    Cells are Markdown already: what is foreign in them has gone through text() or code().
    """
    right = set(numbers)
    rule = ["---:" if column in right else "---" for column in range(len(head))]
    return [*(f"| {' | '.join(cells)} |" for cells in (head, rule, *rows)), ""]


def paragraph(*sentences: str) -> list[str]:
    """A paragraph and an empty line."""
    return [" ".join(sentences), ""]


def bullets(items: Iterable[str]) -> list[str]:
    """A list and an empty line; nothing at all for no items."""
    lines = [f"- {item}" for item in items]
    return [*lines, ""] if lines else []
