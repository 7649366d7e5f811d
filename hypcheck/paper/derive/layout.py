"""Lines of text in 100 columns: what stands where, whatever the letters are made of."""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Iterator

WIDTH = 100


def columns(text: str) -> int:
    """How many columns the text takes: marks that are set over a letter, as in H̄, take none."""
    return sum(not unicodedata.combining(character) for character in text)


def padded(text: str, width: int) -> str:
    """The text with spaces up to a width."""
    return text + " " * (width - columns(text))


def paragraph(text: str, indent: int = 0, first: str = "") -> Iterator[str]:
    """The text in lines, no comparison parted from its sides; `first` stands in the indent of the first line."""
    glued = re.sub(r"(?<=\S) ([=<>≤≥≠]) (?=\S)", "\u00a0\\1\u00a0", text)
    glued = re.sub(r"(?<=\d), (?=[\d−]\S*\)|\d+, )", ",\u00a0", glued)  # a point's coordinates stay together
    lines = textwrap.wrap(glued, WIDTH - indent, break_long_words=False, break_on_hyphens=False)
    for number, line in enumerate(lines or [""]):
        yield (padded(first if number == 0 else "", indent) + line.replace("\u00a0", " ")).rstrip()


def formula(text: str, indent: int, remark: str) -> Iterator[str]:
    """A formula with a remark at the right edge; one that is too long is broken (see `broken`)."""
    first, *others = broken(text, WIDTH - indent - len(remark) - 2)
    lines = [first, *(f"    {line}" for line in others)]
    for line in lines[:-1]:
        yield " " * indent + line
    yield padded(" " * indent + lines[-1], WIDTH - len(remark)) + remark


def broken(text: str, room: int, depth: int = 0) -> list[str]:
    """The formula in lines of at most `room` columns, broken before signs that join terms, the outermost ones first."""
    lines = [""]
    for piece in _terms(text, depth):
        if columns(lines[-1] + piece) <= room or not lines[-1]:
            lines[-1] += piece
        else:
            lines.append(piece.lstrip())
    deeper = [broken(line, room, depth + 1) if columns(line) > room and depth < _DEEPEST else [line] for line in lines]
    return [line for parts in deeper for line in parts]


_DEEPEST = 4
"""No formula here nests further."""


def _terms(text: str, depth: int) -> Iterator[str]:
    """The text cut before each spaced sign, and after each comma, that stands in at most `depth` brackets."""
    start = level = 0
    for place, character in enumerate(text):
        level += (character in "([") - (character in ")]")
        joins = text[place : place + 3] in {" + ", " − ", " ⟺ ", " = "} and place > 0
        if level <= depth and (joins or text[place - 1 : place] == ","):
            yield text[start:place]
            start = place
    yield text[start:]


def matrix(text: str, indent: int, remark: str) -> Iterator[str]:
    """The matrix that "H = [a, b; c, d]" says, a row a line; the remark stands at the last."""
    name, _, inside = text.partition(" = ")
    rows = [row.split(", ") for row in inside.strip("[]").split("; ")]
    widths = [max(map(columns, column)) for column in zip(*rows, strict=True)]
    last = len(rows) - 1
    for number, row in enumerate(rows):
        left, right = ("⎡", "⎤") if number == 0 else ("⎣", "⎦") if number == last else ("⎢", "⎥")
        cells = "  ".join(padded(cell, width) for cell, width in zip(row, widths, strict=True))
        title = f"{name} = " if number == last // 2 else " " * (columns(name) + 3)
        line = f"{' ' * indent}{title}{left} {cells} {right}"
        yield line if number < last else padded(line, WIDTH - len(remark)) + remark
