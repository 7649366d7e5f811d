"""The oracles' agreement."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.content.blocks import (
    Cell,
    Code,
    Paragraph,
    Section,
    Table,
    bullets,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.digest import OracleTotal, oracle_totals
from hypcheck.report.text import figure

_TEXT = prose(
    "Each oracle answers on its own. `exact` agrees where an independent check accepts the certificate of its answer;"
    " the others agree where they say what `exact` says. An oracle that cannot tell says so and is counted as"
    " undecided. Seconds are summed over all processes."
)


def sections(record: Record) -> Iterator[Section]:
    """The section; none where no oracle was wanted."""
    totals = oracle_totals(record)
    if not totals:
        return
    asked = [total for total in totals if total.unavailable is None]
    missing = [(Code(total.name), f" was not asked: {total.unavailable}") for total in totals if total.unavailable]
    yield Section("The oracles", (Paragraph(_TEXT), *([_table(asked)] if asked else []), bullets(missing)))


def _table(totals: list[OracleTotal]) -> Table:
    columns = (
        "oracle",
        number("asked"),
        number("agreed"),
        number("undecided"),
        number("disagreed"),
        "how it answered",
        number("seconds"),
    )
    rows = [
        (
            Code(total.name),
            count(total.asked),
            count(total.agreed),
            count(total.undecided),
            count(total.disagreements, bad=True),
            ", ".join(f"{stage or 'answered'} {answers:,}" for stage, answers in total.stages.items()),
            Cell(figure(total.seconds), total.seconds),
        )
        for total in totals
    ]
    return table("oracles", columns, rows)
