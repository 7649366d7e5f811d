"""The errors of a benchmark's methods: by distance, by workload, by size and by place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from hypcheck.record import Record
from hypcheck.record.measurements import Accuracy, Places, Speed, Stability
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Details,
    Figures,
    Paragraph,
    Section,
    bullets,
    count,
    joined,
    number,
    prose,
    table,
)
from hypcheck.report.content.judged import HEAT
from hypcheck.report.measured import measured, workloads
from hypcheck.report.plots import places, stability
from hypcheck.report.text import figure

_DISTANCE = prose(
    "The *flip distance* of a case is the least relative change of its inputs that leads to another position: a method"
    " whose curve has come down can be trusted to the right of it. A point stands for up to three octaves."
)
_FRONT = prose(
    "Lower is right nearer to contact, farther left is faster; the line joins the methods that no other beats in both."
    " Every mark tells what it is. The *worst of all workloads* is with those that are only judged, as the ring."
)
_TABLE = prose(
    "*False clear* (dangerous) calls a contact clear, *false contact* is an invisible wall. *Reliable above*: the flip"
    " distance beyond which at most 1 in 1000 answers is wrong; 0 where none is, ∞ where there is no such distance."
)
FRONT = Figures("front", "error against run time near contact, and with the errors of all workloads", "front.svg")
PARETO = Figures("pareto", "error against run time on the other workloads", "pareto.svg")
ERRORS = Figures("errors", "share of wrong answers against flip distance", "errors.svg")

_PLACES = tuple((role, words) for words, role in places.MISTAKES.values())


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of these."""
    if record.of(Accuracy):
        blocks: tuple[Block, ...] = (Paragraph(_FRONT), FRONT, PARETO)
        if record.of(Speed):
            yield Section("Error against run time", blocks)
        others = Details("On the other workloads, the methods that are wrong there", (Figures("other-errors"),))
        yield Section("Wrong answers by distance", (Paragraph(_DISTANCE), ERRORS, others))
        yield Section("Wrong answers by workload", (Paragraph(_TABLE), _table(record)))
    yield from _maps(record)


def _table(record: Record) -> Block:
    numbers = map(
        number, ("asked", "wrong", "false clear", "false contact", "wrong side", "abstained", "reliable above")
    )
    columns: tuple[Column | str, ...] = ("method", "workload", *numbers, "case farthest from contact")
    titles = {name: str(line.title) for name, line in workloads(record).items()}
    rows = [
        (Cell(Code(each.name)), Cell(titles[name]), *_row(line))
        for each in measured(record)
        for name, line in each.accuracy.items()
    ]
    return table("wrong answers by workload", columns, rows)


def _row(line: Accuracy) -> tuple[Cell, ...]:
    worst = max(line.worst, key=lambda case: float(case.flip_distance), default=None)
    reliable = float(line.reliable_above)
    counts = [count(number) for number in (line.false_contact, line.wrong_side, line.abstained)]
    return (
        count(line.asked),
        count(line.wrong),
        count(line.false_clear, bad=True),
        *counts,
        Cell(figure(reliable), reliable, "bad" if reliable == math.inf else ""),
        Cell(Code(worst.case) if worst else ""),
    )


def _maps(record: Record) -> Iterator[Section]:
    if record.of(Stability):
        words = "Share of wrong answers over the sizes of the bodies, α/b across and γ/d up, in half decades."
        figures = Figures("stability", small=True, legend=HEAT)
        never = _never("Wrong nowhere: ", stability.right(record))
        yield Section("Stability", (Paragraph(words), figures, never), page=True)
    if record.of(Places):
        words = "Grid points of the half plane, distance from the axis across and height up, in metres."
        figures = Figures("places", small=True, legend=_PLACES)
        never = _never("Wrong at none of the grid points: ", places.right(record))
        yield Section("Where the wrong answers lie", (Paragraph(words), figures, never), page=True)


def _never(words: str, names: Sequence[str]) -> Block:
    return bullets([(words, joined([Code(name) for name in names]), ".")] if names else [])
