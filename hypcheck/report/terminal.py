"""The end of a run on the terminal: how it ended, what failed, what was found and where the reports are."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import click

from hypcheck.record import Record
from hypcheck.record.measurements import Absent, Speed, Unmeasured
from hypcheck.report.changes import (
    FASTER,
    SLOWER,
    accuracy_changes,
    conditions,
    in_one_alone,
    ratio_changes,
    status_changes,
)
from hypcheck.report.choice import EVERYWHERE, POSITION, choice
from hypcheck.report.claims import claims, settings_facts
from hypcheck.report.digest import timing_totals, under_test
from hypcheck.report.facts import benchmark_facts, claim_facts, method_facts, oracle_facts, paper_facts
from hypcheck.report.text import counted, figure, listed
from hypcheck.report.verdict import failures, verdict
from hypcheck.visible import visible

if TYPE_CHECKING:
    from hypcheck.report.write import Around, Written

MOST_LINES = 25

MOST_FAILURES = 8
"""Failures shown one by one; report.md has more of them and junit.xml all."""

MOST_CONDITIONS = 3
"""Differences between two runs, other than what came of them, that are shown one by one."""

WIDTH = 160
"""Characters of a line on a terminal; longer ones are cut, the verdict apart. In a file or a pipe nothing is."""


def render(record: Record, around: Around | None = None) -> bytes:
    """The lines as a file has them."""
    return "".join(
        f"{line}\n" for line in summary_lines(record, (), against=around.against if around else None)
    ).encode("utf-8", "replace")


def summary_lines(
    record: Record,
    written: Sequence[Written],
    *,
    against: Record | None = None,
    colour: bool = False,
    width: int | None = None,
) -> list[str]:
    """At most MOST_LINES lines of plain text; with `colour`, the first in green or red; with `width`, cut to that."""
    ended = verdict(record)
    head = click.style(visible(ended.sentence), fg="green" if ended.passed else "red", bold=True)
    found = [
        *settings_facts(record.header.settings),
        *_failures(record),
        *([] if against is None else _changes(record, against)),
        *_advice(record),
        *_absent(record),
        *_unmeasured(record),
        *oracle_facts(record),
        *paper_facts(record),
        *_under_test(record),
        *method_facts(record),
        *_timings(record),
        *claim_facts(record),
        *benchmark_facts(record),
    ]
    reports = list(_reports(written))
    lines = [*found[: MOST_LINES - 1 - len(reports)], *reports]
    return [head if colour else click.unstyle(head), *(_line(line, width) for line in lines)]


def _line(text: str, width: int | None) -> str:
    indent = text[: len(text) - len(text.lstrip(" "))]
    return indent + visible(text, width)


def _failures(record: Record) -> Iterator[str]:
    found = failures(record)
    for each in found[:MOST_FAILURES]:
        named = each.case is None or each.case in each.message
        yield f"  ✗ {each.message}" if named else f"  ✗ {each.case}: {each.message}"
    if len(found) > MOST_FAILURES:
        yield f"  ✗ and {counted(len(found) - MOST_FAILURES, 'more failure')}; junit.xml lists them all"


def _changes(record: Record, against: Record) -> Iterator[str]:
    """What is not as it was in another record, the most important of each kind by name."""
    yield f"against the run of {against.header.started}, which ended: {verdict(against).sentence}"
    statuses, ratios = status_changes(against, record), ratio_changes(against, record)
    accuracies = accuracy_changes(against, record)
    worse = [f"{change.implementation} on {change.family}" for change in statuses if change.worse]
    yield f"  statuses: {counted(len(statuses), 'family of a method', 'families of methods')} changed" + (
        f", worse: {listed(worse)}" if worse else ""
    )
    if accuracies:
        yield f"  errors: {listed([f'{change.method} on {change.workload}' for change in accuracies])} changed"
    for verdict_ in (SLOWER, FASTER):
        named = [f"{each.method} ({each.workload}, {each.mode})" for each in ratios if each.verdict == verdict_]
        if named:
            yield f"  {verdict_}, by ratio: {listed(named)}"
    others = [*conditions(against, record), *in_one_alone(against, record)]
    yield from (f"  {each}" for each in others[:MOST_CONDITIONS])
    if len(others) > MOST_CONDITIONS:
        yield f"  and {counted(len(others) - MOST_CONDITIONS, 'more difference')} between the runs themselves"


def _under_test(record: Record) -> Iterator[str]:
    """What gated implementations say of themselves, and as what they were judged where that is something else."""
    for tested in under_test(record):
        yield from (f"{tested.name}: {claim}" for claim in claims(tested.line))


def _timings(record: Record) -> Iterator[str]:
    totals = [f"{total.name} {figure(total.median_ns)}" for total in timing_totals(record)]
    if totals:
        yield f"ns a row: {', '.join(totals)}"


def _advice(record: Record) -> Iterator[str]:
    """What a benchmark advises."""
    for each in choice(record).advice:
        ratio = each.use.ratio(each.workload, each.need.mode) or 0.0
        where = "" if each.need.where == EVERYWHERE else f", {each.need.where}"
        asked = "" if each.need.asked == POSITION else f", {each.need.asked}"
        yield f"{each.need.what}{where}{asked}: {each.use.name}, {figure(ratio)} times the reference's time"


def _absent(record: Record) -> Iterator[str]:
    """What was left out because something is not there, and what would bring it."""
    yield from (f"left out: {line.reason}" for line in record.of(Absent))


def _unmeasured(record: Record) -> Iterator[str]:
    """What could not be timed, and how many samples of what could be were impossible."""
    for line in record.of(Unmeasured):
        yield f"not measured: {line.method} on {line.workload}, {line.mode}: {line.reason}"
    dropped = [(speed, speed.dropped) for speed in record.of(Speed) if speed.dropped]
    if dropped:
        number = sum(samples for _, samples in dropped)
        where = listed([f"{speed.method} ({speed.workload}, {speed.mode})" for speed, _ in dropped])
        yield f"{counted(number, 'sample')} dropped, no longer than the empty call that is taken off: {where}"


def _reports(written: Sequence[Written]) -> Iterator[str]:
    """Where the reports are, and which are missing and why."""
    folders: dict[str, list[str]] = {}
    for each in written:
        if each.skipped is None:
            folders.setdefault(str(each.path.parent), []).append(each.path.name)
    for folder, names in folders.items():
        yield f"reports in {folder}{os.sep}: {', '.join(names)}"
    for each in written:
        if each.skipped is not None:
            yield f"no {each.path.name}: {each.skipped}"
