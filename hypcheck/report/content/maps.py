"""Where a method goes wrong in the half plane of a scene."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.lines import Map
from hypcheck.report.content.blocks import Code, Figures, Section, bullets
from hypcheck.report.text import counted

MAP = Figures("map", "exact positions and wrong answers over the half plane (r, z)", "map.svg")


def sections(record: Record) -> Iterator[Section]:
    """The section; none where there is no map."""
    items = [
        (
            f"{line.name}: ",
            Code(line.method),
            f" is wrong at {line.wrong:,} of {counted(line.points, 'grid point')}",
        )
        for line in record.of(Map)
    ]
    if items:
        yield Section("Where it goes wrong", (MAP, bullets(items)))
