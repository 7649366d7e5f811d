"""A whole report: its title, its verdict, and its sections in the order in which they are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from hypcheck.record import Record
from hypcheck.report.content import (
    changed,
    choosing,
    compared,
    errors,
    failed,
    gated,
    judged,
    maps,
    methods,
    oracles,
    paper,
    peers,
    run,
    scenes,
    speeds,
    targets,
    timings,
)
from hypcheck.report.content.blocks import Section
from hypcheck.report.verdict import Verdict, verdict

PARTS: tuple[Callable[[Record], Iterator[Section]], ...] = (
    failed.sections,
    run.settings,
    targets.baseline,
    choosing.sections,
    errors.sections,
    peers.sections,
    speeds.sections,
    targets.sections,
    scenes.sections,
    compared.sections,
    oracles.sections,
    paper.sections,
    gated.sections,
    methods.sections,
    judged.sections,
    maps.sections,
    timings.sections,
    run.sections,
)
"""What failed comes first, what was run last; each part has nothing to say where the record has none of its lines."""


@dataclass(frozen=True, slots=True)
class Content:
    """What every report for people shows."""

    title: str
    verdict: Verdict
    sections: tuple[Section, ...]


def content(record: Record, against: Record | None = None) -> Content:
    """The content of a record's report; with another record, what changed against it stands behind what failed."""
    sections = [section for part in PARTS for section in part(record)]
    if against is not None:
        failing = sum(1 for _ in failed.sections(record))
        sections[failing:failing] = changed.sections(record, against)
    return Content(title(record), verdict(record), tuple(sections))


def title(record: Record) -> str:
    """The command that made the record."""
    return f"hypcheck {record.header.options.get('command', 'verify')}"
