"""One page about a run for whoever reads no other: what it shows, what to use when, and its pictures."""

from __future__ import annotations

from collections.abc import Collection

from hypcheck.record import Record
from hypcheck.report.content import choosing, failed, maps, run, targets
from hypcheck.report.content.blocks import Code, Section, bullets
from hypcheck.report.content.errors import ERRORS, FRONT, PARETO
from hypcheck.report.content.report import Content, title
from hypcheck.report.facts import benchmark_facts, method_facts, oracle_facts, paper_facts
from hypcheck.report.verdict import verdict

_REST = (
    "All reports of this run, with every table, plot and measurement, are made from its record by ",
    Code("hypcheck report record.jsonl --out FOLDER"),
    ".",
)


def overview(record: Record, beside: Collection[str]) -> Content:
    """The content of the page; `beside` are the names of the files beside it, whose pictures it shows."""
    parts = (oracle_facts, paper_facts, method_facts, benchmark_facts)
    shows = bullets([f"{said[:1].upper()}{said[1:]}." for part in parts for said in part(record)])
    pictures = tuple(figures for figures in (maps.MAP, FRONT, PARETO, ERRORS) if figures.file in beside)
    sections = [
        *failed.sections(record),
        *run.settings(record),
        *choosing.sections(record),
        *choosing.named(record),
        *([Section("Pictures", pictures[:1])] if pictures else []),
        *([Section("What it shows", (shows,))] if shows.items else []),
        *targets.told(record),
        *([Section("More pictures", pictures[1:])] if pictures[1:] else []),
        *run.sections(record),
        Section("The rest", (bullets([_REST]),)),
    ]
    return Content(title(record), verdict(record), tuple(sections))
