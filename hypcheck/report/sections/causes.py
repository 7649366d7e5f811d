"""The section about causes: why wrong answers of implementations under test are wrong, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.lines import CauseLine
from hypcheck.report.document import Code, Paragraph, Section, TableCell, count, number, prose, table
from hypcheck.report.messages import Replays, error_text, families_text

_CAUSES = prose(
    "A cause is a rule that is known to be wrong: at each of these rows it gives the very answer that was given, and"
    " where it errs no right answer denies it. *Unexplained* are those that no known rule gives."
)


def cause_sections(record: Record) -> Iterator[Section]:
    """The causes of wrong answers with their remedies; none if nothing was wrong, or the record is of before 1.7.0."""
    found, replays = record.of(CauseLine), Replays.of(record)
    if not found:
        return
    rows = [
        (
            Code(line.method),
            count(line.cases, bad=True),
            TableCell(line.sentence + (f" ({line.claim})" if line.claim else "")),
            families_text(line, len(line.families)),
            line.remedy,
            (error_text(line.worst), ": ", Code(replays.of_case(line.worst.case, line.spec))),
        )
        for line in found
    ]
    columns = ("implementation", number("wrong"), "why", "where", "what to do", "the worst of them")
    yield Section("Why wrong answers are wrong", (Paragraph(_CAUSES), table("causes", columns, rows)))
