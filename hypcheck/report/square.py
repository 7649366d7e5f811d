"""The square of an implementation under test: how often it gave each answer where each was right.

It is the first that a failing run shows: which answers are confused with which is what a bug looks like from outside.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import QUESTIONS
from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.report.document import Code, Column, Row, Strong, TableBlock, TableCell, number, plain, table
from hypcheck.report.messages import listed
from hypcheck.report.model import PASSAGE, ImplementationTotal, implementations
from hypcheck.runs.judge import in_words, truth_in_words

_WORDS = {str(CANNOT_SAY): "cannot say", "none": "no valid answer"}
"""Columns that a square has only if there is such an answer."""

AMISS = "✗"
"""Stands behind the counts of answers that are not the right one."""


def squares(record: Record) -> Iterator[tuple[TableBlock, str]]:
    """A square for each implementation under test with answers that are not right, and a sentence if some of them pass.

    None of a record before 1.10.0.
    """
    for each in implementations(record):
        counts = each.answers
        if each.gated and any(not _right(each.question, truth, answer) for truth in counts for answer in counts[truth]):
            yield _square(each, counts), _passing(each)


def _square(each: ImplementationTotal, counts: Mapping[str, Mapping[str, int]]) -> TableBlock:
    """What is true in rows, what was answered in columns."""
    truths = [truth for truth in (("1", "0") if each.question == PASSAGE else ("1", "0", "-1")) if truth in counts]
    usual = [str(answer) for answer in sorted(QUESTIONS[each.question].answers, reverse=True) if answer != CANNOT_SAY]
    others = [answer for answer in _WORDS if any(answer in row for row in counts.values())]
    titles = [f"answered {_WORDS.get(answer) or in_words(int(answer), each.question)}" for answer in usual]
    columns = [Column(Code(each.name)), *map(number, [*titles, *(_WORDS[answer] for answer in others)])]
    rows: list[Row] = [
        (
            f"truth {truth_in_words(int(truth), each.question)}",
            *(
                _cell(counts[truth].get(answer, 0), right=_right(each.question, truth, answer))
                for answer in [*usual, *others]
            ),
        )
        for truth in truths
    ]
    return table(f"answers of {each.name} against the truth", columns, rows)


def _passing(each: ImplementationTotal) -> str:
    """How many of the answers that are marked do not fail the run; "" without any."""
    reasons = (("tolerated", "within the tolerance"), ("excused", "excused as known failures"))
    parts = [
        f"{counted(each.statuses[status], 'answer')} {words}" for status, words in reasons if each.statuses.get(status)
    ]
    return f"{AMISS} includes {listed(parts)}" if parts else ""


def _cell(cases: int, *, right: bool) -> TableCell:
    if right or not cases:
        return TableCell(f"{cases:,}", cases, "good" if right and cases else "")
    return TableCell(Strong(f"{cases:,} {AMISS}"), cases, "bad")


def _right(question: str, truth: str, answer: str) -> bool:
    """Whether this is the right answer to a question about a row of which that is true."""
    position = QUESTIONS[question].position
    return answer == (truth if position is None else str(int(int(truth) == position)))


_WIDEST = 40
"""Characters of a title at most."""


def aligned(block: TableBlock) -> list[str]:
    """The lines of a table for a terminal, numbers to the right."""
    titles: Sequence[str] = [escaped(plain(column.title), _WIDEST) for column in block.columns]
    rows = [titles, *([plain(cell.text) for cell in row] for row in block.rows)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    left = [not column.number for column in block.columns]
    return [
        "  ".join(
            text.ljust(width) if first else text.rjust(width)
            for text, width, first in zip(row, widths, left, strict=True)
        ).rstrip()
        for row in rows
    ]
