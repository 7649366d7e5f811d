"""overview.md: one page of Markdown for whoever reads no other, such as the README of a folder of reports."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypcheck.record import Record
from hypcheck.report.content.overview import overview
from hypcheck.report.markdown import page

if TYPE_CHECKING:
    from hypcheck.report.write import Around


def render(record: Record, around: Around | None = None) -> bytes:
    """The page in UTF-8, which refers to the pictures among the files beside it."""
    beside = around.beside if around else ()
    return page(overview(record, beside), beside)
