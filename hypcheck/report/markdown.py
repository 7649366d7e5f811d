"""report.md and overview.md: a report as Markdown (CommonMark, GitHub's tables), with foreign text escaped.

report.md describes a whole run for people: its result, failures and findings. overview.md is one page, such as the
README of a folder of reports.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report import document
from hypcheck.report.drawings import ALONE, ReportContext
from hypcheck.report.sections import ReportContent, content, overview

_SPECIAL = re.compile(r"[\\`*_\[\]~$|<>&]")
_ENTITIES = {"|": "&#124;", "<": "&lt;", ">": "&gt;", "&": "&amp;"}
_BLOCK_START = re.compile(r"^(?:[-+=#]|\d+(?=[.)](?:\s|$)))")


def escape_text(foreign: object) -> str:
    """Escape foreign text for running text and cells of tables."""
    safe = _SPECIAL.sub(lambda match: _ENTITIES.get(match[0], "\\" + match[0]), escaped(foreign))
    return _BLOCK_START.sub(lambda match: "".join(f"&#{ord(c)};" for c in match[0]), safe)


def code_span(foreign: object) -> str:
    """Convert a text to a code span, for running text and cells of tables; empty for an empty text.

    A code span has no escapes, so a text with a bar or a backtick becomes an HTML element with entities.
    """
    shown = escaped(foreign)
    if "|" in shown or "`" in shown:
        return "<code>" + "".join(c if c.isalnum() or c in " ,." else f"&#{ord(c)};" for c in shown) + "</code>"
    return f"`{shown}`" if shown else ""


def table_lines(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Iterable[int] = ()) -> list[str]:
    """Return the lines of a table and an empty line; the columns `numbers` are aligned to the right.

    Cells are Markdown already, with foreign text escaped by escape_text() or code_span().
    """
    right = set(numbers)
    rule = ["---:" if column in right else "---" for column in range(len(head))]
    return [*(f"| {' | '.join(cells)} |" for cells in (head, rule, *rows)), ""]


def render(record: Record, context: ReportContext = ALONE) -> bytes:
    """Render the report in UTF-8; it refers to the pictures among the files beside it."""
    return _page(content(record, context.against), context.beside)


def render_overview(record: Record, context: ReportContext = ALONE) -> bytes:
    """Render the overview in UTF-8; it refers to the pictures among the files beside it."""
    return _page(overview(record, context.beside), context.beside)


def _page(whole: ReportContent, beside: Collection[str]) -> bytes:
    """Render a content in UTF-8; `beside` are the names of the files beside it."""
    head = [f"# {running_text(whole.title)}", "", f"**{running_text(whole.verdict.sentence)}**", ""]
    lines = [*head, *section_lines(whole.sections, beside)]
    return ("\n".join(lines).rstrip() + "\n").encode("utf-8", "replace")


def running_text(words: document.Text) -> str:
    """Convert running text to Markdown; foreign text is escaped, and cut if it is very long."""
    return _inline(words).strip()


def _inline(words: document.Text) -> str:
    """Convert running text to Markdown, and keep one space at each end that has white space."""
    if isinstance(words, str):
        return f"{' ' * words[:1].isspace()}{escape_text(document.bounded(words))}{' ' * words[-1:].isspace()}"
    if isinstance(words, document.Code):
        return code_span(document.bounded(words.text))
    if isinstance(words, document.ShownFormula):
        return f"{code_span(words.text)} {words.remark}".rstrip()
    if isinstance(words, document.Strong):
        return f"**{running_text(words.text)}**"
    if isinstance(words, document.Emphasis):
        return f"*{running_text(words.text)}*"
    return "".join(map(_inline, words))


def section_lines(sections: Iterable[document.Section], beside: Collection[str] = ()) -> Iterator[str]:
    """Yield the lines of the sections; a section that only the page has is left out."""
    for section in sections:
        if not section.page:
            yield from (f"{'#' * section.level} {running_text(section.title)}", "")
            for block in section.blocks:
                yield from _block(block, beside)


def _block(block: document.Block, beside: Collection[str]) -> Iterator[str]:
    """Yield the lines of a block; folded blocks and the explorer have none, since only the page shows them."""
    match block:
        case document.Paragraph(text):
            yield from (running_text(text), "")
        case document.Bullets(items, numbered) if items:
            for number, item in enumerate(items, 1):
                mark = f"{number}. " if numbered else "- "
                yield f"{mark}{running_text((item.title, ': ', item.text) if item.title else item.text)}"
                yield from (f"{' ' * len(mark)}- {running_text(text_below)}" for text_below in item.below)
            yield ""
        case document.TableBlock(_, columns, rows):
            numbers = [place for place, column in enumerate(columns) if column.number]
            cells = [[running_text(cell.text) for cell in row] for row in rows]
            yield from table_lines([running_text(column.title) for column in columns], cells, numbers)
        case document.Figures(alt=alt, file=file) if file in beside:
            yield from (f"![{alt}]({file})", "")
        case document.Either(text=text):
            yield from _block(text, beside)
