"""The summary of a run on the terminal: how it ended, what failed, what was found, and where the reports are."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterator, Sequence

import click

from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.record.lines import CauseLine, EquationLine, FindingLine, ProofLine
from hypcheck.record.measurements import AbsentLine, BoundingLine, CostLine, KernelLine, SpeedLine, UnmeasuredLine
from hypcheck.report.advice import (
    EVERYWHERE,
    IN_FLOATS,
    POSITION,
    best_rival_facts,
    own_method_facts,
    recommendations,
)
from hypcheck.report.benchmark_facts import facts_of, sentences_of
from hypcheck.report.changes import (
    FASTER,
    SLOWER,
    accuracy_changes,
    conditions,
    only_in_one,
    ratio_changes,
    status_changes,
)
from hypcheck.report.drawings import ALONE, ReportContext
from hypcheck.report.formats import WrittenReport
from hypcheck.report.measured import (
    NEAREST,
    MeasuredMethod,
    WayTotal,
    measured_methods,
    reference,
    way_totals,
    workloads,
)
from hypcheck.report.messages import (
    UNEXPLAINED,
    Replays,
    error_text,
    families_text,
    figure,
    implementation_claims,
    listed,
    pace,
    settings_facts,
    share_text,
    tolerance_of,
)
from hypcheck.report.model import (
    ImplementationTotal,
    implementations,
    oracle_totals,
    timing_totals,
    under_test,
    worst_error_u,
)
from hypcheck.report.verdict import aligned, failures, squares, verdict
from hypcheck.runs.judge import Status


def oracle_facts(record: Record) -> Iterator[str]:
    """One sentence about the oracles that were asked, one about those that could not be asked."""
    totals = oracle_totals(record)
    asked = [f"{total.name} {total.agreed:,} of {total.asked:,}" for total in totals if total.unavailable is None]
    if asked:
        yield f"oracles in agreement: {', '.join(asked)}"
    missing = [f"{total.name} ({total.unavailable})" for total in totals if total.unavailable is not None]
    if missing:
        yield f"oracles not available: {'; '.join(missing)}"


def paper_facts(record: Record) -> Iterator[str]:
    """The paper's equations, the proofs and the mathematical findings."""
    equations = record.of(EquationLine)
    if equations:
        numbers: dict[str, list[str]] = {}
        for line in equations:
            numbers.setdefault(line.verdict, []).append(f"({line.number})")
        holding = len(numbers.pop("holds", []))
        wrong = "".join(f"; {name}: {listed(those)}" for name, those in numbers.items())
        yield f"equations of the paper: {holding} of {len(equations)} hold{wrong}"
    proofs = record.of(ProofLine)
    if proofs:
        yield f"proofs: {sum(line.holds for line in proofs)} of {len(proofs)} hold"
    findings = record.of(FindingLine)
    if findings:
        inside = [line.family for line in findings if line.inside]
        named = f" ({', '.join(dict.fromkeys(inside))})" if inside else ""
        outside = len(findings) - len(inside)
        yield f"wrong in exact arithmetic: {len(inside)} inside the stated regimes{named}, {outside} outside"


def method_facts(record: Record) -> Iterator[str]:
    """For each precision: how many methods err beyond the tolerance, and the greatest backward error."""
    tolerance = tolerance_of(record.header.options)
    beyond = "the tolerance" if tolerance is None else f"the tolerance of {figure(tolerance)} u"
    found = [each for each in implementations(record) if each.asked and not each.gated]
    for precision in dict.fromkeys(each.precision for each in found if not each.exact):
        methods = [each for each in found if each.precision == precision and not each.exact]
        wrong = sum(each.statuses.get("wrong", 0) > 0 for each in methods)
        yield f"{precision}: {wrong} of {counted(len(methods), 'method')} beyond {beyond}; {_farthest(methods)}"


_REMARKS = {"wrong": "", "tolerated": " (tolerated)", "excused": " (excused as a known failure)"}
"""Remarks about the worst answer by its status: why it may not count as beyond the tolerance."""


def _farthest(methods: Sequence[ImplementationTotal]) -> str:
    """The answer with the greatest backward error, or that no answer is wrong, if one was judged."""
    method = max(methods, key=lambda each: worst_error_u(each.worst))
    worst = method.worst
    if worst is not None:
        also = _REMARKS.get(worst.status, f" ({worst.status})")
        return f"farthest off: {method.name}, {figure(worst_error_u(worst))} u at {worst.case}{also}"
    judged = any(each.statuses.get(status) for each in methods for status in ("right", *_REMARKS))
    return "no answer is wrong" if judged else "no answer was judged"


def benchmark_facts(record: Record) -> Iterator[str]:
    """Targets met, the price of other shapes, and the distances at which errors end."""
    kernels = record.of(KernelLine)
    if kernels:
        missed = [line.name for line in kernels if not line.met]
        named = f"; not met: {listed(missed)}" if missed else ""
        yield f"targets of the kernels: {len(kernels) - len(missed)} of {len(kernels)} met{named}"
    yield from sentences_of(record, BoundingLine)
    for each in way_totals(record):
        yield _way_fact(each)
    found = [each for each in measured_methods(record) if each.line.kind in IN_FLOATS]
    for name, workload in workloads(record).items():
        yield from _endings(workload.title, name, [each for each in found if name in each.accuracy])


def _way_fact(each: WayTotal) -> str:
    """What a method for sweeps gets wrong, and what a sweep costs."""
    missed, false = (figure(100 * each.share(part)) for part in (each.missed, each.false))
    silent = f", {figure(100 * each.share(each.abstained))} % cannot say" if each.abstained else ""
    time = "" if each.time_ns is None else f", {figure(each.time_ns / 1000)} µs a sweep"
    ratio = "" if each.ratio is None else f" ({pace(each.ratio, 'the reference')})"
    wrong = f"{missed} % missed contacts, {false} % false contacts{silent}, of {each.asked:,} sweeps"
    return f"{each.name}: {wrong}{time}{ratio}"


def _endings(title: str, workload: str, found: Sequence[MeasuredMethod]) -> Iterator[str]:
    """The distances at which errors of methods in floats end on a workload; methods that err at any distance."""
    ends = {each: float(each.accuracy[workload].reliable_above) for each in found}
    most = max((each.accuracy[workload].asked for each in found), default=0)
    for precision in ("float64", "float32"):
        mine = {each: end for each, end in ends.items() if each.line.precision == precision and end < math.inf}
        # A method that was asked only a few rows would seem to err less.
        mine = {each: end for each, end in mine.items() if 2 * each.accuracy[workload].asked >= most}
        if mine and max(mine.values()):
            best, worst = min(mine, key=mine.__getitem__), max(mine, key=mine.__getitem__)
            if mine[best] == mine[worst]:
                yield f"{title}, {precision}: {_end(mine[best])}"
                continue
            yield (
                f"{title}, {precision}, the best and the worst: {best.name}, {_end(mine[best])};"
                f" {worst.name}, {_end(mine[worst])}"
            )
    never, others = ([each.name for each in found if (ends[each] == math.inf) == bad] for bad in (True, False))
    if never and len(never) <= len(others):
        yield f"{title}: at no distance reliable: {listed(never)}"
    elif never:
        but = f", all but {listed(others)}" if others else ""
        yield f"{title}: at no distance reliable: {len(never)} of {counted(len(found), 'method')} in floats{but}"


def _end(distance: float) -> str:
    if not distance:
        return "none"
    return "at exact tangencies alone" if distance <= NEAREST else f"errors end at {figure(distance)}"


MOST_LINES = 25

MOST_FAILURES = 8
"""Failures that are listed; report.md has more of them, and junit.xml all."""

MOST_CAUSES = 6
"""Causes of wrong answers that are listed, three lines each; report.md has all."""

MOST_CONDITIONS = 3
"""Differences in the conditions of two runs that are listed."""

WIDTH = 160
"""Characters of a line on a terminal; longer ones are cut, but not the verdict, and nothing in a file or a pipe."""


def render(record: Record, context: ReportContext = ALONE) -> bytes:
    """The summary as a file."""
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
    """At most MOST_LINES lines of plain text, and those of squares and about causes; the reason of a failure first.

    With `colour`, the first is green or red; with `width`, lines are cut to that.
    """
    ended = verdict(record)
    head = click.style(escaped(ended.sentence), fg="green" if ended.passed else "red", bold=True)
    found = [
        *_failures(record, ended.sentence),
        *settings_facts(record.header.settings),
        *([] if against is None else _changes(record, against)),
        *own_method_facts(record),
        *_advice(record),
        *sentences_of(record, AbsentLine),
        *_unmeasured(record),
        *oracle_facts(record),
        *paper_facts(record),
        *_under_test(record),
        *method_facts(record),
        *_timings(record),
        *sentences_of(record, CostLine),
        *benchmark_facts(record),
    ]
    reports = [*_reports(written), *best_rival_facts(record)]
    drawn = [] if ended.passed else list(_squares(record))
    lines = [*_causes(record), *found[: MOST_LINES - 1 - len(reports)], *reports]
    return [head if colour else click.unstyle(head), *drawn, *(_line(line, width) for line in lines)]


def _squares(record: Record) -> Iterator[str]:
    for block, passing in squares(record):
        yield from (f"  {line}" for line in aligned(block))
        if passing:
            yield f"  {passing}"


def _line(text: str, width: int | None) -> str:
    indent = text[: len(text) - len(text.lstrip(" "))]
    return indent + escaped(text, width)


def _failures(record: Record, said: str) -> Iterator[str]:
    """The failures that neither the verdict, `said`, nor the causes of wrong answers name."""
    explained = {line.method for line in record.of(CauseLine)}
    found = [
        each
        for each in failures(record)
        if each.message not in said and not (each.kind == Status.WRONG.value and each.name in explained)
    ]
    for each in found[:MOST_FAILURES]:
        named = each.case is None or each.case in each.message
        yield f"  ✗ {each.message}" if named else f"  ✗ {each.case}: {each.message}"
    if len(found) > MOST_FAILURES:
        yield f"  ✗ and {counted(len(found) - MOST_FAILURES, 'more failure')}; junit.xml lists them all"


def _causes(record: Record) -> Iterator[str]:
    """Why wrong answers are wrong: the cause, where, the remedy, and the command that shows the worst of them."""
    found, replays = record.of(CauseLine), Replays.of(record)
    several = len({line.spec for line in found}) > 1
    for line in found[:MOST_CAUSES]:
        of = f" of {line.method}" if several else ""
        command = "" if line.cause == UNEXPLAINED else f", hypcheck explain {line.cause}"
        share = f"{share_text(line, found)} of all{command}"
        yield f"  {line.cases:,} wrong{of}: {line.sentence}; {families_text(line)} ({share})"
        yield f"      fix: {line.remedy}"
        yield f"      {replays.of_case(line.worst.case, line.spec)}  ({error_text(line.worst)})"
    if len(found) > MOST_CAUSES:
        rest = sum(line.cases for line in found[MOST_CAUSES:])
        yield f"  {rest:,} wrong for {counted(len(found) - MOST_CAUSES, 'other cause')}; report.md has them all"


def _changes(record: Record, against: Record) -> Iterator[str]:
    """The changes against another record, the most important of each kind by name."""
    yield f"against the run of {against.header.started}, which ended: {verdict(against).sentence}"
    statuses, ratios = status_changes(against, record), ratio_changes(against, record)
    accuracies = accuracy_changes(against, record)
    worse = [f"{change.implementation} on {change.family}" for change in statuses if change.worse]
    yield f"  statuses: {counted(len(statuses), 'family of a method', 'families of methods')} changed" + (
        f", worse: {listed(worse)}" if worse else ""
    )
    if accuracies:
        changed = [f"{change.after.method} on {change.after.workload}" for change in accuracies]
        yield f"  errors: {listed(changed)} changed"
    for verdict_ in (SLOWER, FASTER):
        named = [f"{each.method} ({each.workload}, {each.mode})" for each in ratios if each.verdict == verdict_]
        if named:
            yield f"  {verdict_}, by ratio: {listed(named)}"
    others = [*conditions(against, record), *only_in_one(against, record)]
    yield from (f"  {each}" for each in others[:MOST_CONDITIONS])
    if len(others) > MOST_CONDITIONS:
        yield f"  and {counted(len(others) - MOST_CONDITIONS, 'more difference')} between the runs themselves"


def _under_test(record: Record) -> Iterator[str]:
    """What gated implementations declare, what they were judged as, and what a verdict that is no pass leaves out."""
    for tested in under_test(record):
        counts: Counter[str] = sum((Counter(group.not_asked or {}) for group in tested.groups), Counter())
        yield from (f"{tested.name}: {claim}" for claim in implementation_claims(tested.line, counts))
        fresh = sum(group.fresh or 0 for group in tested.groups)
        if fresh:
            yield f"{tested.name}: {counted(fresh, 'fresh row')}"


def _timings(record: Record) -> Iterator[str]:
    totals = [f"{total.name} {figure(total.median_ns)}" for total in timing_totals(record)]
    if totals:
        yield f"ns a row: {', '.join(totals)}"


def _advice(record: Record) -> Iterator[str]:
    """The advice of a benchmark."""
    against = reference(record) or "the reference"
    for each in recommendations(record).advice:
        ratio = each.use.ratio(each.workload, each.need.mode) or 0.0
        where = "" if each.need.where == EVERYWHERE else f", {each.need.where}"
        asked = "" if each.need.asked == POSITION else f", {each.need.asked}"
        yield f"{each.need.what}{where}{asked}: {each.use.name}, {pace(ratio, against)}"


def _unmeasured(record: Record) -> Iterator[str]:
    """What could not be timed, and how many samples were dropped as impossible."""
    for each in facts_of(record, UnmeasuredLine):
        yield f"not measured: {each.name}: {each.line.reason}"
    dropped = [(speed, speed.dropped) for speed in record.of(SpeedLine) if speed.dropped]
    if dropped:
        number = sum(samples for _, samples in dropped)
        where = listed([f"{speed.method} ({speed.workload}, {speed.mode})" for speed, _ in dropped])
        yield f"{counted(number, 'sample')} dropped, no longer than the empty call that is taken off: {where}"


def _reports(written: Sequence[WrittenReport]) -> Iterator[str]:
    """The folders of the reports, and the reports that are missing, with the reason."""
    folders: dict[str, list[str]] = {}
    for each in written:
        if each.skipped is None:
            folders.setdefault(str(each.path.parent), []).append(each.path.name)
    for folder, names in folders.items():
        yield f"reports in {folder}{os.sep}: {', '.join(names)}"
    for each in written:
        if each.skipped is not None:
            yield f"no {each.path.name}: {each.skipped}"
