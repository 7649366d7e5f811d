"""Which method to use when, as a benchmark's figures say it."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Speed
from hypcheck.report.choice import Advice, beaten, choice, price
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Paragraph,
    Section,
    Text,
    bullets,
    joined,
    number,
    prose,
    table,
)
from hypcheck.report.measured import reference, workloads
from hypcheck.report.text import figure, listed, with_interval

_HOW = prose(
    "The fastest method that fills the need, by its ratio to the run's reference; nanoseconds are this machine's. Those"
    " that the intervals or the noise of the run do not tell from it are named behind it. *Reliable above* a flip"
    " distance: at most 1 in 1000 answers beyond it is wrong, on every workload that is spoken of. A need without a"
    " line of its own is filled by a stricter one's. What was not measured is not spoken of either: gate a method on"
    " your own scene before you rely on it."
)


def sections(record: Record) -> Iterator[Section]:
    """The section; none where nothing was timed."""
    chosen = choice(record)
    if not chosen.advice:
        return
    known = workloads(record)
    timed = [line for name, line in known.items() if any(each.workload == name for each in record.of(Speed))]
    scenes = listed([str(line.title) for line in timed])
    against = reference(record)
    said: list[Text] = [*_in_short(record), f"Everyday scenes are the workloads that were timed: {scenes}."]
    if against is not None:
        said.append(("The reference, of ratio 1, is ", Code(against), "."))
    said += [(f"Nothing measured fills this: {need.what}, {need.where}, {need.asked}.") for need in chosen.unmet]
    worse = [(Code(loser.name), " (", Code(winner.name), ")") for loser, winner in beaten(record)]
    if worse:
        lead = "Beaten by a method of the same tier that is faster beyond doubt and errs no farther from contact: "
        said.append((lead, joined(worse), "."))
    blocks: tuple[Block, ...] = (Paragraph(_HOW), _table(chosen.advice), bullets(said))
    yield Section("Which method to use when", blocks)


def _in_short(record: Record) -> Iterator[Text]:
    """What it costs never to be wrong."""
    found = price(record)
    if found is not None:
        known, distance = workloads(record), found.fastest.reliable_above
        errs = (
            f"errors end at {figure(distance)}" if distance < math.inf else "reliable at no distance on some workload"
        )
        times = listed([f"{figure(ratio)} times ({known[name].title})" for name, ratio in found.ratios])
        fastest: Text = (Code(found.fastest.name), f", the fastest of those that err ({errs})")
        lead = "What it costs never to be wrong: in a batch "
        yield (lead, Code(found.never.name), f" takes {times} as long as ", fastest, ".")


def named(record: Record) -> Iterator[Section]:
    """What the methods are that are advised, in a section."""
    found = {each.use.name: each.use for each in choice(record).advice}
    if found:
        items: list[Text] = [
            (
                Code(name),
                f", {each.tier}: {each.line.title}",
                f"; {note}" if (note := each.line.note) else "",
                ".",
            )
            for name, each in found.items()
        ]
        yield Section("What these methods are", (bullets(items),), level=3)


def _table(advice: tuple[Advice, ...]) -> Block:
    numbers = (number("time ratio"), number("ns a query"), number("judged"))
    columns: tuple[Column | str, ...] = (
        *("you need", "use", "in", "asked"),
        *numbers,
        *("not told from it", "not reliable on"),
    )
    return table("which method to use when", columns, [_row(each) for each in advice])


def _row(each: Advice) -> tuple[Cell, ...]:
    line = each.use.speed[each.workload, each.need.mode]
    ratio = line.ratio or 0.0
    return (
        Cell(each.need.what),
        Cell(Code(each.use.name)),
        Cell(each.need.where),
        Cell(each.need.asked),
        Cell(with_interval(ratio, line.ratio_ci95), ratio),
        Cell(figure(line.median_ns), line.median_ns),
        Cell(f"{each.use.asked:,}", each.use.asked),
        Cell(joined([Code(other.name) for other in each.alike])),
        Cell(", ".join(each.errs)),
    )
