"""The content of reports: title, verdict and sections in reading order; and of the overview, a report on one page."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

from msgspec import UNSET, UnsetType

from hypcheck.geometry.pair import trouble_with_row
from hypcheck.geometry.rows import PAIRS
from hypcheck.isolation.launch import isolation_text
from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.fields import numbers_of
from hypcheck.record.lines import IsolationPart
from hypcheck.record.measurements import AbsentLine, CompilerLine, MethodLine, WorkloadLine
from hypcheck.report import advice, changes, document
from hypcheck.report.benchmark_facts import sentences_of
from hypcheck.report.facts import CauseFacts, Failure, cause_facts
from hypcheck.report.measured import MeasuredMethod, measured_methods
from hypcheck.report.messages import as_sentence, error_text, figure, from_hex, settings_facts
from hypcheck.report.model import implementations, under_test
from hypcheck.report.run_facts import benchmark_facts, method_facts, oracle_facts, paper_facts
from hypcheck.report.sections import accuracy, times, verification
from hypcheck.report.sections.accuracy import ERRORS, FRONT, PARETO
from hypcheck.report.verdict import Verdict, failures, tables_of_answers, verdict
from hypcheck.runs.judge import in_words, truth_in_words


def settings_sections(record: Record) -> Iterator[document.Section]:
    """Yield a section about the settings file and options that weaken the gate; nothing if there is neither."""
    facts = list(settings_facts(record.header.settings))
    if facts:
        items = [document.Strong(as_sentence(fact)) for fact in facts]
        yield document.Section("Settings", (document.bullets(items),))


def run_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the run: its time, machine, versions and options; every record has it."""
    header, machine = record.header, record.header.machine
    versions = {"hypcheck": header.hypcheck, "Python": header.python, **header.versions}
    seconds = f", took {figure(record.footer.seconds)} s" if record.footer else ""
    processor = f"{machine.processor}, {machine.architecture}, {machine.system}"
    cores = counted(machine.cores, "core") if machine.cores else "cores unknown"
    items: tuple[document.Text, ...] = (
        f"Started {header.started}{seconds}.",
        f"Machine: {processor}, {cores}.",
        *_isolation(header.isolation),
        f"Versions: {', '.join(f'{name} {version}' for name, version in versions.items())}.",
        ("Options: ", document.Code(json.dumps(header.options, ensure_ascii=False)), "."),
        "A case id, family/version/seed/index, names a generated case for ever.",
    )
    yield document.Section("The run", (document.bullets(items),))


def _isolation(isolation: IsolationPart | UnsetType) -> Iterator[str]:
    """Yield a sentence about how implementations are isolated; nothing if the record does not say."""
    if isolation is not UNSET:
        yield f"Implementations: {isolation_text(isolation.means, isolation.missing)}."


LISTED = 50
"""The most failures that a text lists."""

IN_TABLE = 1000
"""The most failures in the table of the page; junit.xml and summary.json have all."""


def failure_sections(record: Record) -> Iterator[document.Section]:
    """Yield a section with every failure and the command that shows it; nothing if nothing failed."""
    failed = failures(record)
    if failed:
        yield document.Section(
            "What failed", (document.Either(page=_failure_table(failed), text=_failure_list(failed)),)
        )


def _failure_list(failed: list[Failure]) -> document.Bullets:
    """Make the list of the first failures, for a text."""
    items: list[document.Text] = []
    for failure in failed[:LISTED]:
        place: document.Text = (" (", document.Code(failure.place), ")") if failure.place else ""
        case: document.Text = (
            (" Case ", document.Code(failure.case), place, ": ", document.Code(failure.replay or ""))
            if failure.case
            else ""
        )
        items.append((document.Strong((failure.subject, ", ", failure.group)), ": ", failure.message, ".", case))
    return document.bullets([*items, *_omitted_failures(len(failed) - LISTED)])


def _failure_table(failed: list[Failure]) -> document.TableBlock:
    """Make the table of the first failures, with the commands that show them if there are any."""
    replays = any(failure.replay for failure in failed)
    rows = [_failure_row(failure, with_case=replays) for failure in failed[:IN_TABLE]]
    rows += [("", "", text, *(("", "") if replays else ())) for text in _omitted_failures(len(failed) - IN_TABLE)]
    return document.table(
        "failures", f"which | where | what happened{' | case | look at it with' if replays else ''}", rows
    )


def _failure_row(failure: Failure, *, with_case: bool) -> document.Row:
    """Make the row of a failure; `with_case`: with the case and the command that shows it."""
    place: document.Text = (" (", document.Code(failure.place), ")") if failure.place else ""
    case = (document.Code(failure.case or "", failure.row), document.Code(failure.replay or "")) if with_case else ()
    return (document.Code(failure.name), failure.group, (failure.message, place), *case)


def _omitted_failures(left_out: int) -> list[document.Text]:
    """Return a sentence about the failures that are left out; an empty list if there are none."""
    if left_out <= 0:
        return []
    files = (document.Code("junit.xml"), " and ", document.Code("summary.json"))
    return [(f"… and {counted(left_out, 'more failure')}; ", *files, " list them all.")]


def square_sections(record: Record) -> Iterator[document.Section]:
    """Yield a section with the tables of answers, truths in rows and answers in columns, if the run did not pass.

    It has a table for each implementation under test that gave an answer that is not right. Yields nothing if the run
    passed, also where wrong answers were tolerated, or if there is no table.
    """
    if verdict(record).passed:
        return
    blocks: list[document.Block] = []
    for square, passing in tables_of_answers(record):
        blocks += [square, *([document.Paragraph(as_sentence(passing))] if passing else [])]
    if blocks:
        yield document.Section("Answers against the truth", tuple(blocks))


_CAUSES = document.prose(
    "A cause is a rule that is known to be wrong: at each of these rows it gives the very answer that was given, and"
    " where it errs hardly any right answer denies it. `hypcheck explain CAUSE` says more. *Unexplained* are those that"
    " no known rule gives."
)


def cause_sections(record: Record) -> Iterator[document.Section]:
    """Yield a section about the causes of wrong answers and their remedies.

    Yields nothing if no answer was wrong, or for records before 1.7.0.
    """
    causes = cause_facts(record)
    if not causes:
        return
    table = document.table_of("causes", causes, _CAUSE_CELLS)
    yield document.Section("Why wrong answers are wrong", (document.Paragraph(_CAUSES), table))


_CAUSE_CELLS: document.Cells[CauseFacts] = {
    "implementation": lambda facts: document.Code(facts.line.method),
    "# wrong": lambda facts: document.count(facts.line.cases, bad=True),
    "# share": lambda facts: facts.share,
    "cause": lambda facts: document.Code(facts.name),
    "why": lambda facts: facts.line.sentence + (f" ({facts.line.claim})" if facts.line.claim else ""),
    "where": lambda facts: facts.families(6),
    "what to do": lambda facts: document.with_code(facts.line.remedy),
    "the worst of them": lambda facts: (error_text(facts.line.worst), ": ", document.Code(facts.replay)),
}


ON_THE_RING = (1.0, 2.0, 1.0, 1.0, 2.5, 0.0, 0.0)
"""A row whose centre lies on the ring: exterior, with half a radius to the wall, and Δ is exactly 0."""


def can_be_drawn(row: Sequence[float]) -> bool:
    """Decide whether the half plane shows the truth about a row: it is valid, upright and not a sweep."""
    return len(row) > 0 and not PAIRS.has_axis(row) and trouble_with_row(row) is None  # a case may have no row


def explorer_sections(record: Record) -> Iterator[document.Section]:
    """Yield the picture with the bodies of a failing case, which a reader can move.

    Yields nothing if no failing case can be drawn.
    """
    shown = list(shown_case(record))
    rows = [failure.row for failure in failures(record) if can_be_drawn(failure.row)]
    if shown or rows:
        row = shown[0][0] if shown else min(rows, key=_spread)
        yield document.Section(
            "Look closer", (*(document.Paragraph(text) for _, text in shown), document.Explorer(row)), page=True
        )


_ON_THE_RING = document.Section("Look closer", (document.Explorer(ON_THE_RING),), page=True)
"""The explorer of a run without a failing case."""


def shown_case(record: Record) -> Iterator[tuple[tuple[float, ...], document.Text]]:
    """Yield the row of the drawable wrong answer with the greatest error, and a sentence; nothing if there is none.

    An answer whose wall looks like a straight line is taken only if there is no other.
    """
    failing = [
        (case, from_hex(numbers_of(case)), total)
        for total in implementations(record)
        for group in total.groups
        for case in group.worst
        if total.gated and case.status in (group.failing or ())
    ]
    drawable = [(case, row, total) for case, row, total in failing if can_be_drawn(row) and _spread(row) <= _ALIKE]
    for case, row, total in sorted(drawable, key=lambda drawn: (_flat(drawn[1]), -drawn[0].backward_error))[:1]:
        answers = f" is {truth_in_words(case.truth, total.question)}; ", document.Code(total.name), " answered "
        yield row, (document.Code(case.case), *answers, document.Strong(in_words(case.answer, total.question)), ".")


_ALIKE = 20.0
"""Lengths of a picture differ by at most this factor if all of them are to be seen."""


def _spread(row: Sequence[float]) -> float:
    """Return the ratio of the greatest to the least of α, b and d, or 4 times the radii to the wall if this is more."""
    alpha, gamma, b, d, x, y, z = row
    gap = abs(math.hypot(x, y) - alpha * math.hypot(1, z / gamma))
    return max(max(alpha, b, d) / min(alpha, b, d), 4 * gap / b)


def _flat(row: Sequence[float]) -> bool:
    """Decide whether the wall is so flat or so steep that it looks like a line beside the spheroid."""
    gamma, others = row[1], (row[0], row[2], row[3])
    return not max(others) / _ALIKE <= gamma <= min(others) * _ALIKE


def compared_sections(record: Record) -> Iterator[document.Section]:
    """Yield a section about a benchmark's methods, workloads and missing programs; nothing if none was measured."""
    methods = measured_methods(record)
    if not methods:
        return
    items = [
        (document.Strong(line.title), f" ({line.rows:,} rows, seed {line.seed}): {line.text}")
        for line in record.of(WorkloadLine)
    ]
    missing = map(as_sentence, sentences_of(record, AbsentLine))
    compiled = [
        f"Compiled with {line.program} {line.version}: {' '.join(line.flags)}." for line in record.of(CompilerLine)
    ]
    blocks: list[document.Block] = [
        document.table_of("methods", methods, _METHOD_CELLS),
        document.bullets([*items, *compiled, *missing]),
    ]
    yield document.Section("What was compared", tuple(blocks))


_METHOD_CELLS: document.Cells[MeasuredMethod] = {
    "method": lambda method: document.Code(method.name),
    "what it is": lambda method: method.line.title,
    "tier": lambda method: method.tier,
    "precision": lambda method: method.line.precision,
    "question": lambda method: method.line.question,
    "exact": lambda method: "yes" if method.exact else "",
    "remarks": lambda method: "; ".join(_remarks(method.line)),
}


def _remarks(line: MethodLine) -> Iterator[str]:
    """Yield the remarks about a method: its mesh, whether it was timed, and its note."""
    if line.amortised:
        yield f"its mesh is {line.amortised}".replace("is build", "is built")
    if line.accuracy_only:
        yield "not timed"
    if line.note:
        yield line.note


FAILING: tuple[Callable[[Record], Iterator[document.Section]], ...] = (
    square_sections,
    explorer_sections,
    cause_sections,
    failure_sections,
)
"""The sections of a failing run that come first: which answers are wrong, a picture, why, and what failed."""

PARTS: tuple[Callable[[Record], Iterator[document.Section]], ...] = (
    settings_sections,
    times.baseline_sections,
    advice.own_method_sections,
    advice.advice_sections,
    accuracy.error_sections,
    accuracy.peer_sections,
    times.speed_sections,
    times.target_sections,
    times.scene_sections,
    compared_sections,
    verification.oracle_sections,
    verification.paper_sections,
    verification.gated_sections,
    verification.sweep_sections,
    verification.method_sections,
    accuracy.family_sections,
    verification.map_sections,
    verification.timing_sections,
    run_sections,
)
"""The other sections in reading order, the run last.

A part is empty if the record has none of its lines.
"""

PASSING = tuple(part for part in PARTS if part not in (accuracy.family_sections, verification.method_sections))
"""The parts of a run with SPEC that passed: it has no wrong answers to distinguish."""


@dataclass(frozen=True, slots=True)
class ReportContent:
    """The content of a report for people."""

    title: str
    verdict: Verdict
    sections: tuple[document.Section, ...]


def content(record: Record, against: Record | None = None) -> ReportContent:
    """Collect the content of a report; with another record `against`, the changes follow the failures."""
    ended = verdict(record)
    first, later = (FAILING, PARTS) if not ended.passed else ((), PASSING if under_test(record) else PARTS)
    failing = [section for part in first for section in part(record)]
    changed = [] if against is None else [changes.change_section(record, against)]
    others = [section for part in later for section in part(record)]
    if not any(section.title == _ON_THE_RING.title for section in failing):
        others.insert(-1, _ON_THE_RING)
    return ReportContent(report_title(record), ended, (*failing, *changed, *others))


def report_title(record: Record) -> str:
    """Return the title of a report: the command that made the record."""
    return f"hypcheck {record.header.options.get('command', 'verify')}"


_OTHER_REPORTS = (
    "All reports of this run, with every table, plot and measurement, are made from its record by ",
    document.Code("hypcheck report record.jsonl --out FOLDER"),
    ".",
)


def overview(record: Record, beside: Collection[str]) -> ReportContent:
    """Collect the content of the overview; it shows the pictures among the files `beside` it."""
    parts = (oracle_facts, paper_facts, method_facts, benchmark_facts)
    shows = document.bullets([as_sentence(fact) for part in parts for fact in part(record)])
    pictures = tuple(figures for figures in (verification.MAP, FRONT, PARETO, ERRORS) if figures.file in beside)
    sections = [
        *square_sections(record),
        *failure_sections(record),
        *settings_sections(record),
        *advice.own_method_sections(record),
        *advice.advice_sections(record),
        *advice.advised_method_sections(record),
        *([document.Section("Pictures", pictures[:1])] if pictures else []),
        *([document.Section("What it shows", (shows,))] if shows.items else []),
        *times.claim_sections(record),
        *([document.Section("More pictures", pictures[1:])] if pictures[1:] else []),
        *run_sections(record),
        document.Section("The rest", (document.bullets([_OTHER_REPORTS]),)),
    ]
    return ReportContent(report_title(record), verdict(record), tuple(sections))
