"""report.md: a run for people, from top to bottom: how it ended, what failed, and then what was found."""

from __future__ import annotations

import json
from itertools import chain

from hypcheck.record import Line, Record
from hypcheck.report import markdown_gate, markdown_methods
from hypcheck.report.digest import REFERENCE, OracleTotal, explanation, oracle_totals, timing_totals, unlisted
from hypcheck.report.markup import bullets, code, paragraph, table, text
from hypcheck.report.text import counted, figure, from_hex, short_row
from hypcheck.report.verdict import failures, verdict

FAILURES_SHOWN = 50
"""How many failures are shown one by one; junit.xml and summary.json have them all."""


def render(record: Record, picture: str | None = None) -> bytes:
    """The report in UTF-8; `picture` is the name of the map beside it, if it was written."""
    sections = (
        _head(record),
        _failures(record),
        _oracles(record),
        _equations(record.of("equation")),
        _proofs(record.of("proof")),
        _mathematical(record.of("finding")),
        markdown_gate.sections(record),
        markdown_methods.sections(record),
        _map(record.of("map"), picture),
        _timings(record),
        _run(record),
    )
    return ("\n".join(chain.from_iterable(sections)).rstrip() + "\n").encode("utf-8", "replace")


def _head(record: Record) -> list[str]:
    return ["# hypcheck verify", "", *paragraph(f"**{text(verdict(record).sentence)}**")]


def _failures(record: Record) -> list[str]:
    found = failures(record)
    if not found:
        return []
    items = []
    for failure in found[:FAILURES_SHOWN]:
        place = f" ({code(failure.place)})" if failure.place else ""
        case = f" Case {code(failure.case)}{place}: {code(failure.replay)}" if failure.case else ""
        items.append(f"**{failure.subject}, {text(failure.group)}**: {text(failure.message)}.{case}")
    rest = len(found) - FAILURES_SHOWN
    if rest > 0:
        items.append(f"… and {counted(rest, 'more failure')}; `junit.xml` and `summary.json` list them all.")
    return ["## What failed", "", *bullets(items)]


def _oracles(record: Record) -> list[str]:
    totals = oracle_totals(record)
    if not totals:
        return []
    rows = [
        (
            code(total.name),
            f"{total.asked:,}",
            f"{total.agreed:,}",
            f"{total.undecided:,}",
            f"**{total.disagreements:,}**" if total.disagreements else "0",
            _stages(total),
            figure(total.seconds),
        )
        for total in totals
        if total.unavailable is None
    ]
    missing = [f"{code(total.name)} was not asked: {text(total.unavailable)}" for total in totals if total.unavailable]
    head = ("oracle", "asked", "agreed", "undecided", "disagreed", "how it answered", "seconds")
    return [
        "## The oracles",
        "",
        *paragraph(
            "Each oracle answers on its own. `exact` agrees where an independent check accepts the certificate of its",
            "answer; the others agree where they say what `exact` says. An oracle that cannot tell says so and is",
            "counted as undecided. Seconds are summed over all processes.",
        ),
        *(table(head, rows, (1, 2, 3, 4, 6)) if rows else []),
        *bullets(missing),
    ]


def _stages(total: OracleTotal) -> str:
    return ", ".join(f"{text(stage or 'answered')} {number:,}" for stage, number in total.stages.items())


def _equations(lines: list[Line]) -> list[str]:
    if not lines:
        return []
    holding = [f"({text(line['number'])})" for line in lines if line["holds"]]
    items = []
    for line in lines:
        if not line["holds"]:
            items.append(f"**({text(line['number'])})** {text(line['verdict'])}: {text(line['finding'])}.")
            items.append(f"printed: {code(line['statement'])}")
            items.append(f"derived: {code(line['correction'])}")
    nested = [item if index % 3 == 0 else f"  - {item}" for index, item in enumerate(items)]
    return [
        "## The paper's equations",
        "",
        *paragraph(
            f"Each displayed formula was compared with the derivation: {len(holding)} of {len(lines)} hold",
            f"({', '.join(holding)})." if holding else ".",
        ),
        *(f"- {item}" if not item.startswith("  ") else item for item in nested),
        *([""] if nested else []),
    ]


def _proofs(lines: list[Line]) -> list[str]:
    if not lines:
        return []
    by_formula: dict[str, list[bool]] = {}
    for line in lines:
        by_formula.setdefault(line["formula"], []).append(line["holds"])
    rows = [(code(name), str(sum(holds)), str(len(holds))) for name, holds in by_formula.items()]
    return [
        "## The proofs",
        "",
        *paragraph(
            "Each formula is a program of single steps. What its steps must equal was derived in symbols, and its",
            "decision was compared with its rule for every combination of signs. `derivation` are the identities that",
            "the rules rest on.",
        ),
        *table(("formula", "proved", "to be shown"), rows, (1, 2)),
    ]


def _mathematical(lines: list[Line]) -> list[str]:
    """Inside the stated regimes first: there a formula breaks its own word. Formulas with one witness share a line."""
    if not lines:
        return []
    alike: dict[tuple[object, ...], list[Line]] = {}
    for line in sorted(lines, key=lambda line: not line["inside"]):
        fields = ("inside", "family", "cause", "first_case", "wrong", "asked", "reason")
        alike.setdefault(tuple(line[field] for field in fields), []).append(line)
    head = ("formula", "family", "stated regimes", "wrong", "why", "first witness, to six digits", "its case")
    return [
        "## Mathematical findings",
        "",
        *paragraph(
            "Evaluated in exact rationals, so that no rounding is to blame. *Inside* its stated regimes a formula",
            "claims to be right; *outside* them it does not: the table shows what comes of not checking.",
        ),
        *table(head, [_finding(group) for group in alike.values()], (3,)),
    ]


def _finding(group: list[Line]) -> tuple[str, ...]:
    line = group[0]
    why = text(explanation(line))
    return (
        ", ".join(code(each["formula"]) for each in group),
        code(line["family"]),
        "**inside**" if line["inside"] else "outside",
        f"{line['wrong']:,} of {line['asked']:,}",
        f"**{why}**" if unlisted(line) else why,
        text(short_row(from_hex(line["first_row"]))),
        code(line["first_case"]),
    )


def _map(lines: list[Line], picture: str | None) -> list[str]:
    if not lines:
        return []
    items = [
        f"{text(line['name'])}: {code(line['method'])} is wrong at {line['wrong']:,} of"
        f" {counted(line['points'], 'grid point')}"
        for line in lines
    ]
    image = [f"![exact positions and wrong answers over the half plane (r, z)]({picture})", ""] if picture else []
    return ["## Where it goes wrong", "", *image, *bullets(items)]


def _timings(record: Record) -> list[str]:
    totals = timing_totals(record)
    if not totals:
        return []
    rows = [
        (
            text(total.name),
            text(total.title),
            f"{total.rows:,}",
            figure(total.median_ns),
            f"{figure(total.least_ns)} to {figure(total.greatest_ns)}",
            "–" if total.ratio is None else figure(total.ratio),
        )
        for total in totals
    ]
    workloads = ", ".join(code(name) for name in dict.fromkeys(total.workload for total in totals))
    head = ("contender", "what it is", "rows", "ns a row, median", "least to greatest", "time ratio")
    return [
        "## Timings",
        "",
        *paragraph(
            f"On {workloads}, in one process, in interleaved rounds on the machine below.",
            f"The ratio is the time by that of the {REFERENCE} in the same round, median of the rounds: below 1",
            "is faster. Absolute figures do not carry over to another machine.",
        ),
        *table(head, rows, (2, 3, 4, 5)),
    ]


def _run(record: Record) -> list[str]:
    header, machine = record.header, record.header["machine"]
    versions = {"hypcheck": header["hypcheck"], "Python": header["python"], **header["versions"]}
    seconds = f", took {figure(record.footer['seconds'])} s" if record.footer else ""
    options = json.dumps(header["options"], ensure_ascii=False)
    processor = f"{text(machine['processor'])}, {text(machine['architecture'])}, {text(machine['system'])}"
    return [
        "## The run",
        "",
        *bullets(
            [
                f"Started {text(header['started'])}{seconds}.",
                f"Machine: {processor}, {counted(machine['cores'], 'core') if machine['cores'] else 'cores unknown'}.",
                f"Versions: {', '.join(f'{text(name)} {text(version)}' for name, version in versions.items())}.",
                f"Options: {code(options)}.",
                "A case id, family/version/seed/index, names a generated case for ever.",
            ]
        ),
    ]
