"""The end of a run on the terminal: how it ended, what failed, what was found and where the reports are."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import click

from hypcheck.record import Record
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
from hypcheck.report.claims import claims
from hypcheck.report.digest import implementations, oracle_totals, timing_totals, under_test, worst_error_u
from hypcheck.report.text import counted, figure, listed
from hypcheck.report.verdict import failures, verdict
from hypcheck.visible import shortened, visible

if TYPE_CHECKING:
    from hypcheck.report.write import Around, Written

MOST_LINES = 25

MOST_FAILURES = 8
"""Failures shown one by one; report.md has more of them and junit.xml all."""

MOST_CONDITIONS = 3
"""Differences between two runs, other than what came of them, that are shown one by one."""

WIDTH = 160
"""Characters a line; longer ones are cut, the verdict apart."""


def render(record: Record, around: Around | None = None) -> bytes:
    """The lines as a file has them."""
    return "".join(
        f"{line}\n" for line in summary_lines(record, (), against=around.against if around else None)
    ).encode("utf-8", "replace")


def summary_lines(
    record: Record, written: Sequence[Written], *, against: Record | None = None, colour: bool = False
) -> list[str]:
    """At most MOST_LINES lines of plain text; with `colour`, the first in green or red."""
    ended = verdict(record)
    head = click.style(visible(ended.sentence), fg="green" if ended.passed else "red", bold=True)
    found = [
        *_failures(record),
        *([] if against is None else _changes(record, against)),
        *_oracles(record),
        *_paper(record),
        *_under_test(record),
        *_methods(record),
        *_timings(record),
        *_benchmark(record),
    ]
    reports = list(_reports(written))
    lines = [*found[: MOST_LINES - 1 - len(reports)], *reports]
    return [head if colour else click.unstyle(head), *map(_line, lines)]


def _line(text: str) -> str:
    indent = text[: len(text) - len(text.lstrip(" "))]
    return indent + shortened(visible(text), WIDTH)


def _failures(record: Record) -> Iterator[str]:
    found = failures(record)
    for each in found[:MOST_FAILURES]:
        yield f"  ✗ {each.case}: {each.message}" if each.case else f"  ✗ {each.message}"
    if len(found) > MOST_FAILURES:
        yield f"  ✗ … and {counted(len(found) - MOST_FAILURES, 'more failure')}"


def _changes(record: Record, against: Record) -> Iterator[str]:
    """What is not as it was in another record, the most important of each kind by name."""
    yield f"against the run of {against.header['started']}, which ended: {verdict(against).sentence}"
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


def _oracles(record: Record) -> Iterator[str]:
    """One line for the oracles that were asked, one for those that could not be."""
    totals = oracle_totals(record)
    asked = [f"{total.name} {total.agreed:,} of {total.asked:,}" for total in totals if total.unavailable is None]
    if asked:
        yield f"oracles in agreement: {', '.join(asked)}"
    missing = [f"{total.name} ({total.unavailable})" for total in totals if total.unavailable is not None]
    if missing:
        yield f"oracles not available: {'; '.join(missing)}"


def _paper(record: Record) -> Iterator[str]:
    """The paper's equations, the proofs and the mathematical findings."""
    equations = record.of("equation")
    if equations:
        numbers: dict[str, list[str]] = {}
        for line in equations:
            numbers.setdefault(line["verdict"], []).append(f"({line['number']})")
        holding = len(numbers.pop("holds", []))
        wrong = "".join(f"; {name}: {listed(those)}" for name, those in numbers.items())
        yield f"equations of the paper: {holding} of {len(equations)} hold{wrong}"
    proofs = record.of("proof")
    if proofs:
        yield f"proofs: {sum(line['holds'] for line in proofs)} of {len(proofs)} hold"
    findings = record.of("finding")
    if findings:
        inside = [line["family"] for line in findings if line["inside"]]
        named = f" ({', '.join(dict.fromkeys(inside))})" if inside else ""
        outside = len(findings) - len(inside)
        yield f"wrong in exact arithmetic: {len(inside)} inside the stated regimes{named}, {outside} outside"


def _under_test(record: Record) -> Iterator[str]:
    """What gated implementations say of themselves, and as what they were judged where that is something else."""
    for tested in under_test(record):
        yield from (f"{tested.name}: {claim}" for claim in claims(tested.line))


def _methods(record: Record) -> Iterator[str]:
    """For each precision how many methods err beyond the tolerance, and the one that does most."""
    found = [each for each in implementations(record) if each.asked]
    for precision in dict.fromkeys(each.precision for each in found if not each.exact):
        methods = [each for each in found if each.precision == precision and not each.exact]
        wrong = sum(each.statuses.get("wrong", 0) > 0 for each in methods)
        worst = max(methods, key=lambda each: worst_error_u(each.worst))
        error, case = worst_error_u(worst.worst), worst.worst["case"] if worst.worst else "none"
        yield (
            f"{precision}: {wrong} of {counted(len(methods), 'method')} beyond the tolerance;"
            f" farthest off: {worst.name}, {figure(error)} u at {case}"
        )


def _timings(record: Record) -> Iterator[str]:
    totals = [f"{total.name} {figure(total.median_ns)}" for total in timing_totals(record)]
    if totals:
        yield f"ns a row: {', '.join(totals)}"


def _benchmark(record: Record) -> Iterator[str]:
    """What a benchmark advises, what it says of the paper's claims and of the kernels."""
    for each in choice(record).advice:
        ratio = each.use.ratio(each.workload, each.need.mode) or 0.0
        where = "" if each.need.where == EVERYWHERE else f", {each.need.where}"
        asked = "" if each.need.asked == POSITION else f", {each.need.asked}"
        yield f"{each.need.what}{where}{asked}: {each.use.name}, {figure(ratio)} times the reference's time"
    for line in record.of("cost"):
        yield f"claim {line['verdict']}: {line['claim']}"
    kernels = record.of("kernel")
    if kernels:
        missed = [str(line["name"]) for line in kernels if not line["met"]]
        named = f"; not met: {listed(missed)}" if missed else ""
        yield f"targets of the kernels: {len(kernels) - len(missed)} of {len(kernels)} met{named}"


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
