"""What scenes save by leaving out, and what a walker's step costs in a forest."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import astuple, fields

from hypcheck.record import Record
from hypcheck.record.fields import Interval
from hypcheck.record.measurements import Forest, Scene, Shares
from hypcheck.report.content.blocks import (
    Cell,
    Code,
    Column,
    Figures,
    Paragraph,
    Section,
    Table,
    bullets,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.text import figure, with_interval

_FOREST = prose(
    "A walker's step from Python, one call each, on the same way through the same trees; *building* is from a list of"
    " trees to the first answer. *Wrong* answers are counted against rational arithmetic about every tree."
)
_SCENES = prose(
    "Centres spread evenly over each scene's region; the share that each stage of its kernel (`hypcheck emit`) decides."
    " Then the kernel's time, in C, by that of Table 2 as printed, in C, and of the certified kernel of"
    " `classify_scene`, in one thread, many rows by a call and a call for each: below 1 is faster."
)
_STAGES = tuple(each.name for each in fields(Shares))


def sections(record: Record) -> Iterator[Section]:
    """The sections about what the record has of these."""
    scenes, forests = record.of(Scene), record.of(Forest)
    if scenes:
        yield Section("What scenes leave out", (Paragraph(_SCENES), _shares(scenes), _times(scenes)))
    if forests:
        titles = {line.method: line.title for line in forests}
        who = bullets([(Code(name), f": {title}") for name, title in titles.items()])
        yield Section("A step in a forest", (Paragraph(_FOREST), Figures("forest"), _forest(forests), who))


def _forest(lines: list[Forest]) -> Table:
    numbers = map(number, ("trees", "ns a step", "by hypcheck.Scene's", "building, s", "steps", "wrong"))
    columns: tuple[Column | str, ...] = ("asked", *numbers)
    rows = [
        (
            Cell(Code(line.method)),
            count(line.trees),
            Cell(with_interval(line.step_ns, line.ci95_ns), line.step_ns),
            _ratio(line.ratio, line.ratio_ci95),
            Cell(figure(line.build_s), line.build_s),
            count(line.asked),
            count(line.wrong, bad=bool(line.exact)),
        )
        for line in lines
    ]
    return table("a step in a forest", columns, rows)


def _ratio(ratio: float | None, interval: Interval | None) -> Cell:
    return Cell("–") if ratio is None else Cell(with_interval(ratio, interval), ratio)


def _shares(lines: list[Scene]) -> Table:
    numbers = map(number, ("pairs of sizes", *(f"{stage}, %" for stage in _STAGES), "wrong"))
    columns: tuple[Column | str, ...] = ("scene", "question", *numbers)
    rows = [
        (
            Cell(line.scene),
            Cell(line.question),
            count(line.settings),
            *(Cell(figure(100 * share), share) for share in astuple(line.shares)),
            count(line.wrong, bad=True),
        )
        for line in lines
    ]
    return table("what decides in scenes", columns, rows)


def _times(lines: list[Scene]) -> Table:
    columns: tuple[Column | str, ...] = (
        "scene",
        "asked",
        *map(number, ("ns a row", "by Table 2's", "by the certified kernel's")),
    )
    rows = [
        (
            Cell(line.scene),
            Cell(how),
            Cell(figure(times.kernel_ns), times.kernel_ns),
            _ratio(times.by_printed, times.by_printed_ci95),
            _ratio(times.by_certified, times.by_certified_ci95),
        )
        for line in lines
        for times, how in ((line.batch, "many by a call"), (line.single, "a call each"))
    ]
    return table("what scenes save", columns, rows)
