"""A document as plain text for a terminal, in WIDTH columns of Unicode: headings, lists and tables, laid out by spaces.

A heading of level 3 stands to the left of its blocks. The remark about a formula is at the right edge, so that a reader
sees at a glance that all formulas hold.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Iterable, Iterator, Sequence

from hypcheck.messages import escaped
from hypcheck.report import document

WIDTH = 100

_INDENT, _LEAST_TITLE, _LONGEST_TITLE = 4, 9, 40
"""The width of an indent; the least width of a list's titles; the most characters of a column's title."""


def lines(sections: Iterable[document.Section]) -> Iterator[str]:
    """Yield the lines of the sections; a section that only the page has is left out."""
    for section in sections:
        if section.page:
            continue
        title = inline(section.title)
        yield from ("", title, *([] if section.level > 2 else ["═" * columns(title)]))
        indent = _INDENT * (section.level > 2)
        for number, block in enumerate(section.blocks):
            if number or section.level == 2:
                yield ""
            yield from _block(block, indent)


def _block(block: document.Block, indent: int) -> Iterator[str]:
    """Yield the lines of a block; a text has no pictures and no folded blocks."""
    match block:
        case document.Paragraph(text):
            yield from _text(text, indent)
        case document.Bullets(items, numbered):
            yield from _numbered(items, max(indent, _INDENT)) if numbered else _bullets(items, indent)
        case document.TableBlock():
            yield from (f"{' ' * indent}{line}" for line in table_lines(block, WIDTH - indent))
        case document.Either(text=text):
            yield from _block(text, indent)


def _numbered(items: Sequence[document.Item], indent: int) -> Iterator[str]:
    """Yield the lines of a numbered list, with an empty line between two items."""
    for number, item in enumerate(items, 1):
        if number > 1:
            yield ""
        yield from _text(item.text, indent, f"{' ' * (indent - _INDENT)}{number}.")
        yield from _below(item, indent + _INDENT)


def _bullets(items: Sequence[document.Item], indent: int) -> Iterator[str]:
    """Yield the lines of a list. Texts of items that have titles begin in one column, to the right of the titles."""
    titles = [inline(item.title) for item in items]
    column = max(_LEAST_TITLE, *map(columns, titles)) + 1 if any(titles) else 2
    for item, title in zip(items, titles, strict=True):
        yield from _text(item.text, indent + column, f"{' ' * indent}{title or '-'}")
        yield from _below(item, indent + column + 2)


def _below(item: document.Item, indent: int) -> Iterator[str]:
    """Return an iterator over the lines of an item's sublist."""
    return (line for text in item.below for line in _text(text, indent))


def _text(words: document.Text, indent: int, first: str = "") -> Iterator[str]:
    """Yield a text in lines; `first` replaces the indent of the first line."""
    if isinstance(words, document.ShownFormula):
        yield from _formula(words, indent, first)
    elif isinstance(words, document.Code):
        yield padded(first, indent) + inline(words)  # whole, so that a command can be copied
    else:
        yield from paragraph(inline(words), indent, first)


def inline(words: document.Text) -> str:
    """Return running text on one line; code within a text is in backticks."""
    return escaped(words.text if isinstance(words, document.Code) else _with_backticks(words))


def _with_backticks(words: document.Text) -> str:
    """Return running text with backticks around each code."""
    if isinstance(words, document.Code):
        return f"`{words.text}`"
    return "".join(map(_with_backticks, words)) if isinstance(words, tuple) else document.plain(words)


def columns(text: str) -> int:
    """Count the columns of a text; combining marks, as in H̄, take none."""
    return sum(not unicodedata.combining(character) for character in text)


def padded(text: str, width: int) -> str:
    """Fill the text with spaces up to a width."""
    return text + " " * (width - columns(text))


def paragraph(text: str, indent: int = 0, first: str = "", width: int = WIDTH) -> Iterator[str]:
    """Yield the text in lines, without a break inside a comparison; `first` replaces the first line's indent."""
    glued = re.sub(r"(?<=\S) ([=<>≤≥≠]) (?=\S)", "\u00a0\\1\u00a0", text)
    glued = re.sub(r"(?<=\d), (?=[\d−]\S*\)|\d+, )", ",\u00a0", glued)  # a point's coordinates stay together
    wrapped = textwrap.wrap(glued, width - indent, break_long_words=False, break_on_hyphens=False)
    for number, line in enumerate(wrapped or [""]):
        yield (padded(first if number == 0 else "", indent) + line.replace("\u00a0", " ")).rstrip()


def _formula(formula: document.ShownFormula, indent: int, first: str) -> Iterator[str]:
    """Yield the lines of a formula, its remark at the right edge.

    A matrix is shown in rows. A long formula is broken (see `broken`).
    """
    remark = formula.remark
    named = matrix_of(formula.text)
    if named is not None:
        shown = [*_matrix(*named)]
    else:
        start, *others = broken(formula.text, WIDTH - indent - len(remark) - 2)
        shown = [start, *(f"    {line}" for line in others)]
    shown = [padded(first if number == 0 else "", indent) + line for number, line in enumerate(shown)]
    shown[-1] = padded(shown[-1], WIDTH - len(remark)) + remark
    yield from (line.rstrip() for line in shown)


def broken(text: str, room: int, depth: int = 0) -> list[str]:
    """Break the formula into lines of at most `room` columns, before signs that join terms, the outermost ones first.

    `depth` is the number of brackets around the signs at which this call breaks.
    """
    lines = [""]
    for piece in _terms(text, depth):
        if columns(lines[-1] + piece) <= room or not lines[-1]:
            lines[-1] += piece
        else:
            lines.append(piece.lstrip())
    deeper = [broken(line, room, depth + 1) if columns(line) > room and depth < _DEEPEST else [line] for line in lines]
    return [line for parts in deeper for line in parts]


_DEEPEST = 4
"""The most brackets around a place at which a formula is broken; no formula of hypcheck nests deeper."""


def _terms(text: str, depth: int) -> Iterator[str]:
    """Cut the text before each spaced sign, and after each comma, that is in at most `depth` brackets."""
    start = level = 0
    for place, character in enumerate(text):
        level += (character in "([") - (character in ")]")
        joins = text[place : place + 3] in {" + ", " − ", " ⟺ ", " = "} and place > 0
        if level <= depth and (joins or text[place - 1 : place] == ","):
            yield text[start:place]
            start = place
    yield text[start:]


def matrix_of(text: str) -> tuple[str, list[list[str]]] | None:
    """Return the name and the rows of the matrix in "H = [a, b; c, d]"; None if a formula ends with no matrix."""
    name, equals, inside = text.partition(" = ")
    if not (equals and inside.startswith("[") and inside.endswith("]")):
        return None
    return name, [row.split(", ") for row in inside.strip("[]").split("; ")]


def _matrix(name: str, rows: Sequence[Sequence[str]]) -> Iterator[str]:
    """Yield the lines of a matrix, one for each row."""
    widths = [max(map(columns, column)) for column in zip(*rows, strict=True)]
    last = len(rows) - 1
    for number, row in enumerate(rows):
        left, right = ("⎡", "⎤") if number == 0 else ("⎣", "⎦") if number == last else ("⎢", "⎥")
        cells = "  ".join(padded(cell, width) for cell, width in zip(row, widths, strict=True))
        title = f"{name} = " if number == last // 2 else " " * (columns(name) + 3)
        yield f"{title}{left} {cells} {right}"


def table_lines(block: document.TableBlock, room: int = WIDTH) -> Iterator[str]:
    """Yield the lines of a table, with numbers aligned to the right; a text too wide for its column is wrapped."""
    titles = [escaped(inline(column.title), _LONGEST_TITLE) for column in block.columns]
    rows = [titles, *([inline(cell.text) for cell in row] for row in block.rows)]
    widths = column_widths(block, rows, room)
    for row in rows:
        cells = [list(paragraph(text, width=width)) for text, width in zip(row, widths, strict=True)]
        for number in range(max(map(len, cells))):
            parts = [cell[number] if number < len(cell) else "" for cell in cells]
            yield "  ".join(
                part.rjust(width) if column.number else padded(part, width)
                for part, width, column in zip(parts, widths, block.columns, strict=True)
            ).rstrip()


def column_widths(block: document.TableBlock, rows: Sequence[Sequence[str]], room: int) -> list[int]:
    """Compute the widths of the columns of these rows, the titles first.

    If a table is wider than the room, the titles of numbers are wrapped; then the widest columns become narrower.
    """
    widths = [max(map(columns, cells)) for cells in zip(*rows, strict=True)]
    room -= 2 * (len(widths) - 1)
    for place, (column, (title, *cells)) in enumerate(zip(block.columns, zip(*rows, strict=True), strict=True)):
        if column.number and sum(widths) > room:
            widths[place] = max(map(columns, [*title.split(), *cells]))
    while sum(widths) > room and max(widths) > 1:
        widths[widths.index(max(widths))] -= 1
    return widths
