"""What meshes and bounding volumes cost in answers and in time."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Bounding, Convergence
from hypcheck.report.content.blocks import (
    Cell,
    Code,
    Column,
    Figures,
    Paragraph,
    Section,
    Table,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.text import figure

_MESHES = prose(
    "A mesh in the hyperboloid's place errs by its deviation; triangles bring it down, and cost time. A build is a"
    " mesh, a query one position."
)
_BOUNDS = prose(
    "Another shape around the spheroid is never clear where the spheroid is not, so a *false clear* would be a fault;"
    " what it costs are invisible walls, the more the less the spheroid is like the shape."
)


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of these."""
    if record.of(Convergence):
        yield Section("Meshes", (Paragraph(_MESHES), Figures("convergence"), _meshes(record.of(Convergence))))
    if record.of(Bounding):
        lines = record.of(Bounding)
        yield Section("Bounding volumes", (Paragraph(_BOUNDS), Figures("bounding"), _bounds(lines), _overlaps(lines)))


def _meshes(lines: list[Convergence]) -> Table:
    numbers = map(number, ("triangles", "deviation, radii", "asked", "wrong", "query, ns", "build, ns"))
    columns: tuple[Column | str, ...] = ("method", *numbers)
    rows = [
        (
            Cell(Code(line.method)),
            count(line.triangles),
            Cell(figure(line.deviation), line.deviation),
            count(line.asked),
            count(line.wrong),
            Cell(figure(line.query_ns), line.query_ns),
            Cell(figure(line.build_ns), line.build_ns),
        )
        for line in lines
    ]
    return table("meshes", columns, rows)


def _bounds(lines: list[Bounding]) -> Table:
    columns: tuple[Column | str, ...] = (
        "shape",
        "workload",
        *map(number, ("asked", "false contact", "share", "false clear")),
    )
    rows = [
        (
            Cell(line.shape),
            Cell(line.workload),
            count(line.asked),
            count(line.false_contact),
            _share(line.false_contact, line.asked),
            count(line.false_clear, bad=True),
        )
        for line in lines
    ]
    return table("bounding volumes", columns, rows)


def _overlaps(lines: list[Bounding]) -> Table:
    numbers = map(number, ("d/b", "asked", "false contact", "share", "median excess clearance, radii"))
    columns: tuple[Column | str, ...] = ("shape", "workload", *numbers)
    rows = [
        (
            Cell(line.shape),
            Cell(line.workload),
            Cell(figure(ratio), ratio),
            count(int(asked)),
            count(int(contacts)),
            _share(contacts, asked),
            Cell("–") if excess is None else Cell(figure(excess), excess),
        )
        for line in lines
        for ratio, asked, contacts, excess in line.overlap
    ]
    return table("bounding volumes by shape of the spheroid", columns, rows)


def _share(part: float, whole: float) -> Cell:
    return Cell(f"{figure(100 * part / whole)} %", part / whole) if whole else Cell("–")
