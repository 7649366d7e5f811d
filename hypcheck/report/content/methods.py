"""What each method got wrong, by how much, and in which families."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hypcheck.record import Record
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Paragraph,
    Section,
    Table,
    Text,
    bullets,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.digest import Implementation, implementations, worst_error_u
from hypcheck.report.replays import tolerance_of
from hypcheck.report.text import counted, figure

NOTHING = "·"
NOT_ASKED = "–"

_IN_TABLE = ("right", "tolerated", "wrong", "skipped")
"""The statuses that have a column, and the one that stands for a case not asked."""


def sections(record: Record) -> Iterator[Section]:
    """The sections; none where nothing was judged."""
    found = implementations(record)
    exact = [each for each in found if each.exact]
    others = [each for each in found if not each.exact]
    if exact:
        yield _exact(exact)
    if others:
        yield _introduction(record, others)
    for precision in dict.fromkeys(each.precision for each in others):
        yield _part(precision, [each for each in others if each.precision == precision])


def _exact(methods: Sequence[Implementation]) -> Section:
    rows = [(Code(each.name), each.title, count(each.asked), _statuses(each.statuses)) for each in methods]
    return Section(
        "Methods that promise to be exact",
        (
            Paragraph("One answer of theirs that is not right fails the run."),
            table("exact methods", ("method", "what it is", number("asked"), "answers"), rows),
        ),
    )


def _introduction(record: Record, methods: Sequence[Implementation]) -> Section:
    tolerance = tolerance_of(record.header.options)
    limit = f"at most {figure(tolerance)} u" if tolerance is not None else "at most the run's tolerance"
    said = (
        prose(
            "Each method in floats, held against the exact decisions, on the cases inside its stated regimes. The"
            " *backward error* of a wrong answer is the least relative change of the inputs that makes it right, in"
            " units u of the precision (∞: no change of up to 100 % does); a wrong answer with"
        ),
        f" {limit} is ",
        prose(
            "*tolerated*. A *false clear* (dangerous) calls a contact clear, a *false contact* is an invisible wall."
        ),
    )
    return Section("Numerical findings", (Paragraph(said), _glossary(methods)))


def _glossary(methods: Sequence[Implementation]) -> Block:
    """What the methods are; one that runs in several precisions is described once."""
    titles = {_plain_name(each): each.title.removesuffix(f", {each.precision}") for each in methods}
    return bullets([(Code(name), f": {title}") for name, title in titles.items() if title != name])


def _plain_name(each: Implementation) -> str:
    return each.name.removesuffix(f"-{each.precision}")


def _part(precision: str, methods: Sequence[Implementation]) -> Section:
    otherwise = [(each, {name: n for name, n in each.statuses.items() if name not in _IN_TABLE}) for each in methods]
    also: list[Text] = [(Code(each.name), f" also ended: {_statuses(rest)}") for each, rest in otherwise if rest]
    return Section(precision, (_totals(methods), bullets(also), *_matrix(methods)), level=3)


def _totals(methods: Sequence[Implementation]) -> Table:
    numbers = map(number, ("asked", "right", "tolerated", "wrong", "false clear", "worst error in u"))
    columns: tuple[Column | str, ...] = ("method", "question", *numbers, "its case")
    return table("methods", columns, [_row(each) for each in methods])


def _row(each: Implementation) -> tuple[Cell, ...]:
    statuses, worst = each.statuses, each.worst
    error = worst_error_u(worst)
    return (
        Cell(Code(_plain_name(each))),
        Cell(each.question),
        count(each.asked),
        count(statuses.get("right", 0)),
        count(statuses.get("tolerated", 0)),
        count(statuses.get("wrong", 0), bad=True),
        count(each.mistakes.get("false-clear", 0)),
        Cell(figure(error) if worst else NOTHING, error),
        Cell(Code(worst.case) if worst else NOTHING),
    )


def _matrix(methods: Sequence[Implementation]) -> tuple[Block, ...]:
    families = dict.fromkeys(group.family for each in methods for group in each.groups)
    groups = {(each.name, group.family): group for each in methods for group in each.groups}

    def cell(method: str, family: str) -> Cell:
        group = groups.get((method, family))
        if group is None or not group.asked:
            return Cell(NOT_ASKED, -1)
        wrong = group.counts.get("wrong", 0)
        return Cell(f"{wrong:,}", wrong, "bad") if wrong else Cell(NOTHING, 0)

    rows: list[tuple[Cell, ...]] = [
        (Cell(Code(family)), *(cell(each.name, family) for each in methods)) for family in families
    ]
    asked = max((group.asked for group in groups.values()), default=0)
    columns: tuple[Column | str, ...] = ("family", *(number(Code(_plain_name(each))) for each in methods))
    return (
        Paragraph(
            f"Wrong answers by family, of at most {counted(asked, 'case')} each ({NOTHING} none, {NOT_ASKED} nothing"
            " asked: outside the stated regimes or the format's range):"
        ),
        table("wrong answers by family", columns, rows),
    )


def _statuses(statuses: dict[str, int]) -> str:
    return ", ".join(f"{name} {cases:,}" for name, cases in statuses.items())
