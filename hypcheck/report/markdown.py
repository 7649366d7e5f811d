"""report.md: a run for people, from top to bottom: how it ended, what failed, and then what was found."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from hypcheck.record import Record
from hypcheck.report import markup
from hypcheck.report.content.blocks import (
    Block,
    Bullets,
    Code,
    Details,
    Either,
    Emphasis,
    Figures,
    Paragraph,
    Section,
    Strong,
    Table,
    Text,
    bounded,
)
from hypcheck.report.content.report import Content, content

if TYPE_CHECKING:
    from hypcheck.report.write import Around


def render(record: Record, around: Around | None = None) -> bytes:
    """The report in UTF-8, which refers to the pictures among the files beside it."""
    beside = around.beside if around else ()
    return page(content(record, around.against if around else None), beside)


def page(whole: Content, beside: Collection[str]) -> bytes:
    """A content in UTF-8; `beside` are the names of the files beside it."""
    lines = [f"# {text(whole.title)}", "", f"**{text(whole.verdict.sentence)}**", ""]
    for section in (section for section in whole.sections if not section.page):
        lines += _section(section, beside)
    return ("\n".join(lines).rstrip() + "\n").encode("utf-8", "replace")


def text(words: Text) -> str:
    """Running text as Markdown; what is foreign in it means itself and is cut where it is endless."""
    return _inline(words).strip()


def _inline(words: Text) -> str:
    if isinstance(words, str):
        return f"{' ' * words[:1].isspace()}{markup.text(bounded(words))}{' ' * words[-1:].isspace()}"
    if isinstance(words, Code):
        return markup.code(bounded(words.text))
    if isinstance(words, Strong):
        return f"**{text(words.text)}**"
    if isinstance(words, Emphasis):
        return f"*{text(words.text)}*"
    return "".join(map(_inline, words))


def _section(section: Section, beside: Collection[str]) -> Iterator[str]:
    yield from (f"{'#' * section.level} {text(section.title)}", "")
    for block in section.blocks:
        yield from _block(block, beside)


def _block(block: Block, beside: Collection[str]) -> Iterator[str]:
    if isinstance(block, Paragraph):
        yield from (text(block.text), "")
    elif isinstance(block, Bullets):
        yield from _bullets(block)
    elif isinstance(block, Table):
        yield from _table(block)
    elif isinstance(block, Figures):
        if block.file in beside:
            yield from (f"![{block.alt}]({block.file})", "")
    elif isinstance(block, Either):
        yield from _block(block.text, beside)
    elif not isinstance(block, Details):
        raise TypeError(f"{type(block).__name__} is no block")


def _bullets(block: Bullets) -> Iterator[str]:
    for item in block.items:
        yield f"- {text(item.text)}"
        yield from (f"  - {text(each)}" for each in item.below)
    if block.items:
        yield ""


def _table(block: Table) -> Iterator[str]:
    numbers = [place for place, column in enumerate(block.columns) if column.number]
    rows = [[text(cell.text) for cell in row] for row in block.rows]
    yield from markup.table([text(column.title) for column in block.columns], rows, numbers)
