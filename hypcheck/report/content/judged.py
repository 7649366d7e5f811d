"""What only the page has room for: every family of every judged method, the worst cases, and where they lie."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec import UNSET

from hypcheck.judge import Status
from hypcheck.pairs import Position
from hypcheck.record import Record
from hypcheck.record.lines import Fault, Group, WrongAnswer
from hypcheck.report.content.blocks import (
    Block,
    Cell,
    Code,
    Column,
    Details,
    Figures,
    Paragraph,
    Section,
    Table,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.digest import Implementation, implementations, worst_case, worst_error_u
from hypcheck.report.plots.heat import STEPS
from hypcheck.report.replays import Replays
from hypcheck.report.text import figure

MOST_CASES = 12
"""Cases shown of one implementation, the worst first; the record keeps up to three a family, and counts are exact."""

HEAT = tuple((f"share-{place}", words) for place, (_, words) in enumerate(STEPS))

_BAD = {status.value for status in Status} - {"right", "skipped", "tolerated", "refused", "excused"}

_DISTANCE = prose(
    "The *flip distance* of a case is the least relative change of its inputs that leads to another position. A method"
    " whose errors end at a distance can be trusted beyond it. All families together, tolerated answers among the"
    " wrong; a point stands for up to three octaves."
)


def sections(record: Record) -> Iterator[Section]:
    """The sections, for the page alone; none where nothing was judged."""
    found = [each for each in implementations(record) if each.asked or each.statuses]
    if not found:
        return
    yield Section("Wrong answers by distance", (Paragraph(_DISTANCE), Figures("octaves")), page=True)
    size = Figures("sizes", small=True, legend=HEAT)
    place = Figures("fields", small=True, legend=HEAT)
    blocks = (
        Details("By the sizes of the bodies, α/b and γ/d", (size,)),
        Details("By the place, r/α and |z|/γ", (place,)),
    )
    yield Section("Where the wrong answers lie", blocks, page=True)
    yield Section("Family by family", tuple(_families(record, found)), page=True)


def _families(record: Record, found: Sequence[Implementation]) -> Iterator[Block]:
    """Of a gated implementation a fold of its own, of the project's methods one for all."""
    replays = Replays.of(record)
    for each in found:
        if each.gated:
            yield Details(each.name, (_statuses([each]), *_cases([each], replays)))
    ours = [each for each in found if not each.gated]
    if ours:
        yield Details("All methods and families", (_statuses(ours),))
        yield Details("Their worst cases", tuple(_cases(ours, replays)))


def _statuses(found: Sequence[Implementation]) -> Table:
    """Family by status, with columns for the statuses that occurred."""
    seen = [status.value for status in Status if any(status.value in each.statuses for each in found)]
    named = [] if len(found) == 1 else [Column("method")]
    errors = map(number, ("false clear", "false contact", "wrong side", "worst error in u"))
    columns: tuple[Column | str, ...] = (*named, "family", number("asked"), *map(number, seen), *errors)
    rows = [
        (*([Cell(Code(each.name))] if named else []), *_status_row(group, seen))
        for each in found
        for group in each.groups
    ]
    return table("families", columns, rows)


def _status_row(group: Group, seen: Sequence[str]) -> tuple[Cell, ...]:
    error = worst_error_u(worst_case(group.worst))
    failing = _BAD if group.failing is UNSET else group.failing
    mistakes = [count(group.mistakes.get(name, 0)) for name in ("false-clear", "false-contact", "wrong-side")]
    return (
        Cell(Code(group.family)),
        count(group.asked),
        *(count(group.counts.get(status, 0), bad=status in failing) for status in seen),
        *mistakes,
        Cell(figure(error) if error else "·", error),
    )


def _cases(found: Sequence[Implementation], replays: Replays) -> Iterator[Table]:
    worst = [(each, group, case) for each in found for group in each.groups for case in group.worst]
    if worst:
        worst.sort(key=lambda of: -float(of[2].backward_error_u))
        kept = [of for each in found for of in [one for one in worst if one[0] is each][:MOST_CASES]]
        columns: tuple[Column | str, ...] = (
            "case",
            "method",
            "truth",
            "answer",
            "mistake",
            number("wrong by, u"),
            "status",
            "look at it with",
        )
        yield table("worst cases", columns, [_case(*of, replays) for of in kept])
    faults = [(each, group, case) for each in found for group in each.groups for case in group.faults or ()]
    if faults:
        columns = ("case", "method", "ended", "because", "look at it with")
        yield table("cases without an answer", columns, [_fault(*of, replays) for of in faults[: 5 * MOST_CASES]])


def _case(each: Implementation, group: Group, case: WrongAnswer, replays: Replays) -> tuple[Cell, ...]:
    error = float(case.backward_error_u)
    return (
        Cell(Code(case.case)),
        Cell(Code(each.name)),
        Cell(Position(case.truth).label),
        Cell(str(case.answer)),
        Cell(case.mistake),
        Cell(figure(error), error),
        Cell(case.status, tone="bad" if case.status in _BAD else ""),
        Cell(Code(replays.command(group, case))),
    )


def _fault(each: Implementation, group: Group, case: Fault, replays: Replays) -> tuple[Cell, ...]:
    return (
        Cell(Code(case.case)),
        Cell(Code(each.name)),
        Cell(case.status, tone="bad" if case.status in _BAD else ""),
        Cell(case.reason),
        Cell(Code(replays.command(group, case))),
    )
