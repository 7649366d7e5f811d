"""A report as values without a format: sections of paragraphs, lists, tables and figures.

Text is foreign unless `prose` returned it; each renderer escapes it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar, Union

from hypcheck.report.messages import figure, pace, with_interval

NONE, MISSING = "·", "–"
"""The text of a cell if nothing is wrong, and that of a cell without a value."""

Value = TypeVar("Value")

LONGEST = 2000
"""Characters of one foreign text that a report shows, so that a long name does not hide the rest."""


@dataclass(frozen=True, slots=True)
class Code:
    """Text to type or copy: a name, an id, a command. For a case's id `row` has its numbers, which the page draws."""

    text: str
    row: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Strong:
    """Text that must be noticed."""

    text: Text


@dataclass(frozen=True, slots=True)
class Emphasis:
    """A term that is explained here."""

    text: Text


@dataclass(frozen=True, slots=True)
class ShownFormula:
    """A formula as hypcheck writes it, in Unicode: x_c² + y_c². `remark` says whether it was checked."""

    text: str
    remark: str = ""


Text = Union[str, Code, Strong, Emphasis, ShownFormula, "tuple[Text, ...]"]
"""Running text: a string, a marked part, or a tuple of parts."""

_MARKS = re.compile(r"`([^`]+)`|\*\*(.+?)\*\*|\*(.+?)\*")
_CODE_MARKS = re.compile(r"`([^`]+)`()()")


def prose(words: str) -> Text:
    """Parse the marks in hypcheck's own text: `code`, **strong** and *emphasised*; never call it with foreign text."""
    return _marked(words, _MARKS)


def with_code(words: str) -> Text:
    """Parse only the marks of `code`, in a text such as a remedy that a record holds."""
    return _marked(words, _CODE_MARKS)


def _marked(words: str, marks: re.Pattern[str]) -> Text:
    """Split a text at its marks; the groups of the pattern `marks` are code, strong and emphasised text."""
    parts: list[Text] = []
    end = 0
    for mark in marks.finditer(words):
        code, strong, emphasis = mark.groups()
        parts.append(words[end : mark.start()])
        parts.append(Code(code) if code else Strong(strong) if strong else Emphasis(emphasis))
        end = mark.end()
    return tuple(part for part in (*parts, words[end:]) if part)


def bounded(foreign: str) -> str:
    """Return the text; if it has more than LONGEST characters, it is cut and its length is added."""
    return foreign if len(foreign) <= LONGEST else f"{foreign[:LONGEST]}… ({len(foreign):,} characters)"


def joined(texts: Sequence[Text]) -> Text:
    """Join the texts with commas between them."""
    parts: list[Text] = []
    for text in texts:
        parts += [", ", text] if parts else [text]
    return tuple(parts)


def plain(text: Text) -> str:
    """Return the text without its marks."""
    if isinstance(text, str):
        return text
    if isinstance(text, Code):
        return text.text
    if isinstance(text, ShownFormula):
        return f"{text.text} {text.remark}".rstrip()
    if isinstance(text, (Strong, Emphasis)):
        return plain(text.text)
    return "".join(plain(part) for part in text)


@dataclass(frozen=True, slots=True)
class TableCell:
    """A cell of a table: its text, the number that it is sorted by, and its tone ("good", "bad" or none)."""

    text: Text
    value: float | None = None
    tone: str = ""


Row = tuple[TableCell | Text, ...]
"""A row of a table; a text is a cell without a value."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table; numbers are aligned to the right. `hint` explains the title."""

    title: Text
    number: bool = False
    hint: str = ""


@dataclass(frozen=True, slots=True)
class TableBlock:
    """A table; `name` describes its content for readers who do not see the heading."""

    name: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[TableCell, ...], ...]


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph."""

    text: Text


@dataclass(frozen=True, slots=True)
class Item:
    """An item of a list, with a sublist of items; `title` is the term that the text explains."""

    text: Text
    below: tuple[Text, ...] = ()
    title: Text = ""


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list; an empty list is not shown. The items of a `numbered` list are steps."""

    items: tuple[Item, ...]
    numbered: bool = False


@dataclass(frozen=True, slots=True)
class Figures:
    """The plots of that name, if they can be drawn; a text refers to the picture `file` beside it instead.

    `small` plots are placed side by side; `legend` explains the roles of their colours.
    """

    name: str
    alt: str = ""
    file: str | None = None
    small: bool = False
    legend: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Explorer:
    """The picture whose bodies a reader can move; only the page has it. It begins with a row of seven numbers."""

    row: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Details:
    """Blocks that only the page has, folded under a title."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class Either:
    """Two forms of a block: one for the page, which can sort and filter, and one for a text."""

    page: Block
    text: Block


Block = Paragraph | Bullets | TableBlock | Figures | Explorer | Details | Either


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a report under a heading; `level` 2 is a part of the report, 3 a part of the section before it.

    `page`: only the page has this section; a text does not.
    """

    title: Text
    blocks: tuple[Block, ...]
    level: int = 2
    page: bool = False


def table(name: str, heads: str | Iterable[Column], rows: Iterable[Row]) -> TableBlock:
    """Make a table. `heads` are its columns, or their titles with bars between them: "method | # rows".

    A # stands before the title of a column of numbers. Use a string only for titles that this project wrote; other text
    needs a Column.
    """
    cells = tuple(tuple(cell if isinstance(cell, TableCell) else TableCell(cell) for cell in row) for row in rows)
    return TableBlock(name, columns(heads) if isinstance(heads, str) else tuple(heads), cells)


Cells = Mapping[str, Callable[[Value], TableCell | Text]]
"""The title of each column, as in table(), with the function that makes its cell from the value of a row."""


def table_of(name: str, values: Iterable[Value], cells: Cells[Value]) -> TableBlock:
    """Make a table with a row for each value."""
    return table(name, " | ".join(cells), [tuple(cell(value) for cell in cells.values()) for value in values])


def bullets(items: Sequence[Text | Item]) -> Bullets:
    """Make a list of texts or items."""
    return Bullets(tuple(item if isinstance(item, Item) else Item(item) for item in items))


def terms(explained: Iterable[tuple[Text, Text]]) -> Bullets:
    """Make a list of terms, each with the text that explains it."""
    return Bullets(tuple(Item(text, title=title) for title, text in explained))


def count(number: int, *, bad: bool = False) -> TableCell:
    """Make the cell of a count; with `bad`, a count above zero has the tone "bad"."""
    shown = f"{number:,}"
    return TableCell(Strong(shown), number, "bad") if bad and number else TableCell(shown, number)


def measured(value: float | None, interval: Sequence[float] | None = None) -> TableCell:
    """Make the cell of a value to three digits, with its interval if it has one; a dash without a value."""
    return TableCell(MISSING) if value is None else TableCell(with_interval(value, interval), value)


def paced(ratio: float | None, interval: tuple[float, float] | None = None) -> TableCell:
    """Make the cell of a time relative to the column's method: "24 times as fast"; a dash without a ratio."""
    return TableCell(MISSING) if ratio is None else TableCell(pace(ratio, interval=interval), ratio)


def share(part: float, whole: float) -> TableCell:
    """Make the cell of a share in per cent; a dash if `whole` is 0."""
    return TableCell(f"{figure(100 * part / whole)} %", part / whole) if whole else TableCell(MISSING)


def ratio_of(part: int, whole: int) -> TableCell:
    """Make the cell of a part and its whole, "3 of 40", which is sorted by the share."""
    return TableCell(f"{part:,} of {whole:,}", part / max(1, whole))


def number(title: Text, hint: str = "") -> Column:
    """Make a column of numbers."""
    return Column(title, number=True, hint=hint)


def against(other: str | None, hint: str = "") -> Column:
    """Make the column of times relative to another method; None means the reference, which has no name."""
    return number("against the reference" if other is None else ("against ", Code(other)), hint)


def columns(titles: str) -> tuple[Column, ...]:
    """Make the columns with these titles, which have bars between them: see table()."""
    return tuple(Column(title.removeprefix("# "), title.startswith("# ")) for title in titles.split(" | "))
