"""The summary of a run on the terminal: its result, its failures and findings, and the places of the reports."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence

import click

from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.record.lines import CauseLine
from hypcheck.record.measurements import AbsentLine, CostLine
from hypcheck.report import WrittenReport, run_facts
from hypcheck.report.advice import advice_facts, best_rival_facts, own_method_facts
from hypcheck.report.benchmark_facts import sentences_of
from hypcheck.report.changes import change_facts
from hypcheck.report.drawings import ALONE, ReportContext
from hypcheck.report.facts import Failure, cause_facts
from hypcheck.report.messages import error_text, settings_facts
from hypcheck.report.text import table_lines
from hypcheck.report.verdict import failures, tables_of_answers, verdict
from hypcheck.runs.judge import Status

MOST_LINES = 25

MOST_FAILURES = 8
"""The most failures that are listed; report.md has more of them, and junit.xml has all."""

MOST_CAUSES = 6
"""The most causes of wrong answers that are listed, three lines each; report.md has all."""

WIDTH = 160
"""Characters of a line on a terminal; longer ones are cut, but not the verdict, and nothing in a file or a pipe."""


def render(record: Record, context: ReportContext = ALONE) -> bytes:
    """Render the summary as a file."""
    return "".join(f"{line}\n" for line in summary_lines(record, (), against=context.against)).encode(
        "utf-8", "replace"
    )


def summary_lines(
    record: Record,
    written: Sequence[WrittenReport],
    *,
    against: Record | None = None,
    colour: bool = False,
    width: int | None = None,
) -> list[str]:
    """Return the summary, a failure's reason first: at most MOST_LINES plain lines, besides answers and causes.

    A benchmark of a user's methods is about these: the paper's claims of cost are in its other reports. With `colour`,
    the first line is green or red; with `width`, lines are cut to this width.
    """
    ended = verdict(record)
    head = click.style(escaped(ended.sentence), fg="green" if ended.passed else "red", bold=True)
    mine = list(own_method_facts(record))
    facts = [
        *_failures(record, ended.sentence),
        *settings_facts(record.header.settings),
        *([] if against is None else change_facts(record, against)),
        *mine,
        *advice_facts(record),
        *sentences_of(record, AbsentLine),
        *run_facts.unmeasured_facts(record),
        *run_facts.oracle_facts(record, held=ended.passed),
        *run_facts.paper_facts(record, held=ended.passed),
        *run_facts.tested_facts(record, held=ended.passed),
        *run_facts.method_facts(record),
        *run_facts.timing_facts(record),
        *([] if mine else sentences_of(record, CostLine)),
        *run_facts.benchmark_facts(record),
    ]
    reports = [*_reports(written), *best_rival_facts(record)]
    drawn = [] if ended.passed else list(_squares(record))
    lines = [*_causes(record), *facts[: MOST_LINES - 1 - len(reports)], *reports]
    return [head if colour else click.unstyle(head), *drawn, *(_line(line, width) for line in lines)]


def _squares(record: Record) -> Iterator[str]:
    """Yield the lines of each table of answers, with the sentence about answers that pass."""
    for block, passing in tables_of_answers(record):
        yield from (f"  {line}" for line in table_lines(block, WIDTH))
        if passing:
            yield f"  {passing}"


def _line(text: str, width: int | None) -> str:
    """Escape a line behind its indent, and cut it to the width if there is one."""
    indent = text[: len(text) - len(text.lstrip(" "))]
    return indent + escaped(text, width)


def _failures(record: Record, verdict_sentence: str) -> Iterator[str]:
    """Yield a line for each failure that neither the verdict nor the causes of wrong answers name.

    The same failure of an implementation in several families is listed once; cases that were not tested come after
    their reason.
    """
    explained = {line.method for line in record.of(CauseLine)}
    failed = failures(record)
    lost = {failure.name for failure in failed if failure.group == "start"}
    alike: dict[tuple[str, ...], list[Failure]] = {}
    for failure in failed:
        of_cause = failure.kind == Status.WRONG.value and failure.name in explained
        of_start = failure.kind == Status.PROTOCOL.value and failure.name in lost
        if failure.message not in verdict_sentence and not of_cause and not of_start:
            behaviour = failure.subject == "implementation" and failure.case is not None
            alike.setdefault((failure.name, failure.kind) if behaviour else (str(len(alike)),), []).append(failure)
    ordered = sorted(alike.values(), key=lambda some: some[0].kind == Status.NOT_RUN.value)
    for first, *others in ordered[:MOST_FAILURES]:
        named = first.case is None or first.case in first.message
        also = f"; so in {counted(len(others), 'more family', 'more families')}" if others else ""
        yield f"  ✗ {first.message}{also}" if named else f"  ✗ {first.case}: {first.message}{also}"
    if len(ordered) > MOST_FAILURES:
        rest = sum(map(len, ordered[MOST_FAILURES:]))
        yield f"  ✗ and {counted(rest, 'more failure')}; junit.xml lists them all"


def _causes(record: Record) -> Iterator[str]:
    """Yield lines about the causes of wrong answers: name, families, remedy, the command that shows the worst one."""
    causes = cause_facts(record)
    several = len({facts.line.spec for facts in causes}) > 1
    for facts in causes[:MOST_CAUSES]:
        of = f" of {facts.line.method}" if several else ""
        command = facts.command and f", {facts.command}"
        wrong = f"{facts.line.cases:,} wrong{of}: {facts.line.sentence}"
        yield f"  {wrong}; {facts.families()} ({facts.share} of all{command})"
        yield from (f"      {sentence}" for sentence in facts.sentences())
        yield f"      {facts.replay}  ({error_text(facts.line.worst)})"
    if len(causes) > MOST_CAUSES:
        rest = sum(facts.line.cases for facts in causes[MOST_CAUSES:])
        yield f"  {rest:,} wrong for {counted(len(causes) - MOST_CAUSES, 'other cause')}; report.md has them all"


def _reports(written: Sequence[WrittenReport]) -> Iterator[str]:
    """Yield the folders of the reports, and the reports that are missing, with the reason."""
    folders: dict[str, list[str]] = {}
    for report in written:
        if report.skipped is None:
            folders.setdefault(str(report.path.parent), []).append(report.path.name)
    for folder, names in folders.items():
        yield f"reports in {folder}{os.sep}: {', '.join(names)}"
    for report in written:
        if report.skipped is not None:
            yield f"no {report.path.name}: {report.skipped}"
