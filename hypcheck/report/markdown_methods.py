"""The part of report.md about implementations: what each got wrong, by how much, and in which families."""

from __future__ import annotations

from collections.abc import Sequence

from hypcheck.record import Record
from hypcheck.report.digest import Implementation, implementations, worst_error_u
from hypcheck.report.markup import bullets, code, paragraph, table, text
from hypcheck.report.text import counted, figure

NOTHING = "·"
NOT_ASKED = "–"

_IN_TABLE = ("right", "tolerated", "wrong", "skipped")
"""The statuses that have a column, and the one that stands for a case not asked."""


def sections(record: Record) -> list[str]:
    """The lines of the sections; none where nothing was judged."""
    found = implementations(record)
    if not found:
        return []
    exact = [each for each in found if each.exact]
    others = [each for each in found if not each.exact]
    precisions = dict.fromkeys(each.precision for each in others)
    parts = [_part(precision, [each for each in others if each.precision == precision]) for precision in precisions]
    introduction = [*_introduction(record), *_glossary(others)] if others else []
    return [*_exact(exact), *introduction, *(line for part in parts for line in part)]


def _exact(methods: Sequence[Implementation]) -> list[str]:
    if not methods:
        return []
    rows = [(code(each.name), text(each.title), f"{each.asked:,}", _statuses(each.statuses)) for each in methods]
    return [
        "## Methods that promise to be exact",
        "",
        *paragraph("One answer of theirs that is not right fails the run."),
        *table(("method", "what it is", "asked", "answers"), rows, (2,)),
    ]


def _introduction(record: Record) -> list[str]:
    tolerance = record.header["options"].get("tolerance")
    limit = f"at most {figure(float(tolerance))} u" if tolerance is not None else "at most the run's tolerance"
    return [
        "## Numerical findings",
        "",
        *paragraph(
            "Each method in floats, held against the exact decisions, on the cases inside its stated regimes. The",
            "*backward error* of a wrong answer is the least relative change of the inputs that makes it right, in",
            f"units u of the precision (∞: no change of up to 100 % does); a wrong answer with {limit} is *tolerated*.",
            "A *false clear* (dangerous) calls a contact clear, a *false contact* is an invisible wall.",
        ),
    ]


def _glossary(methods: Sequence[Implementation]) -> list[str]:
    """What the methods are; one that runs in several precisions is described once."""
    titles = {_plain_name(each): each.title.removesuffix(f", {each.precision}") for each in methods}
    return bullets(f"{code(name)}: {text(title)}" for name, title in titles.items())


def _plain_name(each: Implementation) -> str:
    return each.name.removesuffix(f"-{each.precision}")


def _part(precision: str, methods: Sequence[Implementation]) -> list[str]:
    head = ("method", "question", "asked", "right", "tolerated", "wrong", "false clear", "worst error in u", "its case")
    otherwise = [(each, {name: n for name, n in each.statuses.items() if name not in _IN_TABLE}) for each in methods]
    return [
        f"### {text(precision)}",
        "",
        *table(head, [_row(each) for each in methods], range(2, 8)),
        *bullets(f"{code(each.name)} also ended: {_statuses(rest)}" for each, rest in otherwise if rest),
        *_matrix(methods),
    ]


def _row(each: Implementation) -> tuple[str, ...]:
    statuses, worst = each.statuses, each.worst
    wrong = statuses.get("wrong", 0)
    return (
        code(_plain_name(each)),
        text(each.question),
        f"{each.asked:,}",
        f"{statuses.get('right', 0):,}",
        f"{statuses.get('tolerated', 0):,}",
        f"**{wrong:,}**" if wrong else "0",
        f"{each.mistakes.get('false-clear', 0):,}",
        figure(worst_error_u(worst)) if worst else NOTHING,
        code(worst["case"]) if worst else NOTHING,
    )


def _matrix(methods: Sequence[Implementation]) -> list[str]:
    families = dict.fromkeys(group["family"] for each in methods for group in each.groups)
    groups = {(each.name, group["family"]): group for each in methods for group in each.groups}

    def cell(method: str, family: str) -> str:
        group = groups.get((method, family))
        if group is None or not group["asked"]:
            return NOT_ASKED
        wrong = group["counts"].get("wrong", 0)
        return f"{wrong:,}" if wrong else NOTHING

    rows = [(code(family), *(cell(each.name, family) for each in methods)) for family in families]
    asked = max((group["asked"] for group in groups.values()), default=0)
    return [
        *paragraph(
            f"Wrong answers by family, of at most {counted(asked, 'case')} each",
            f"({NOTHING} none, {NOT_ASKED} nothing asked: outside the stated regimes or the format's range):",
        ),
        *table(
            ("family", *(code(_plain_name(each)) for each in methods)),
            rows,
            range(1, len(methods) + 1),
        ),
    ]


def _statuses(statuses: dict[str, int]) -> str:
    return ", ".join(f"{text(name)} {number:,}" for name, number in statuses.items())
