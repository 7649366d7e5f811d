"""One page about a run for whoever reads no other: what it shows, what to use when, and its pictures."""

from __future__ import annotations

from collections.abc import Collection

from hypcheck.record import Record
from hypcheck.report.content import choosing, failed, maps, run
from hypcheck.report.content.blocks import Section, bullets
from hypcheck.report.content.errors import ERRORS, FRONT, PARETO
from hypcheck.report.content.report import Content, title
from hypcheck.report.facts import facts
from hypcheck.report.verdict import verdict


def overview(record: Record, beside: Collection[str]) -> Content:
    """The content of the page; `beside` are the names of the files beside it, whose pictures it shows."""
    shows = bullets([f"{sentence[:1].upper()}{sentence[1:]}." for sentence in facts(record)])
    pictures = tuple(figures for figures in (maps.MAP, FRONT, PARETO, ERRORS) if figures.file in beside)
    sections = [
        *failed.sections(record),
        *choosing.sections(record),
        *([Section("What it shows", (shows,))] if shows.items else []),
        *([Section("Pictures", pictures)] if pictures else []),
        *run.sections(record),
    ]
    return Content(title(record), verdict(record), tuple(sections))
