"""Sections of a verification: oracles, methods, implementations under test, timings, maps, and the paper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from msgspec import UNSET

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.fields import numbers_of
from hypcheck.record.lines import EquationLine, FindingLine, ImplementationLine, MapLine, NotStartedLine, ProofLine
from hypcheck.report import messages, model
from hypcheck.report.document import (
    MISSING,
    NONE,
    Block,
    Code,
    Column,
    Figures,
    Item,
    Paragraph,
    Row,
    Section,
    Strong,
    TableBlock,
    TableCell,
    Text,
    bullets,
    count,
    joined,
    measured,
    number,
    paced,
    prose,
    table,
)

_ORACLES = prose(
    "Each oracle answers on its own. `exact` agrees where an independent check accepts the certificate of its answer;"
    " the others agree where they say what `exact` says. An oracle that cannot decide says so and is counted as"
    " undecided. Where the hyperboloid ends, `roots` is not asked. Seconds are summed over all processes."
)


def oracle_sections(record: Record) -> Iterator[Section]:
    """The agreement of the oracles; none if the plan has no oracle."""
    totals = model.oracle_totals(record)
    if not totals:
        return
    answering = [total for total in totals if total.unavailable is None]
    missing = [(Code(total.name), f" was not asked: {total.unavailable}") for total in totals if total.unavailable]
    yield Section(
        "The oracles", (Paragraph(_ORACLES), *([_oracle_table(answering)] if answering else []), bullets(missing))
    )


def _oracle_table(totals: list[model.OracleTotal]) -> TableBlock:
    rows = [
        (
            Code(total.name),
            count(total.asked),
            count(total.agreed),
            count(total.undecided),
            count(total.disagreements, bad=True),
            ", ".join(f"{stage or 'answered'} {answers:,}" for stage, answers in total.stages.items()),
            measured(total.seconds),
        )
        for total in totals
    ]
    columns = "oracle | # asked | # agreed | # undecided | # disagreed | how it answered | # seconds"
    return table("oracles", columns, rows)


_IN_TABLE = ("right", "tolerated", "wrong", "skipped")
"""The statuses that have a column, and that of cases that were not asked."""


def method_sections(record: Record) -> Iterator[Section]:
    """The wrong answers of each method, their errors and families; none if nothing was judged."""
    totals = model.implementations(record)
    exact = [total for total in totals if total.exact]
    others = [total for total in totals if not total.exact]
    if exact:
        yield _exact(exact)
    if others:
        yield _introduction(record, others)
    for precision in dict.fromkeys(total.precision for total in others):
        yield _part(precision, [total for total in others if total.precision == precision])


def _exact(methods: Sequence[model.ImplementationTotal]) -> Section:
    rows = [(Code(method.name), method.title, count(method.asked), _statuses(method.statuses)) for method in methods]
    return Section(
        "Methods that promise to be exact",
        (
            Paragraph("A single answer that is not right fails the run."),
            table("exact methods", "method | what it is | # asked | answers", rows),
        ),
    )


def _introduction(record: Record, methods: Sequence[model.ImplementationTotal]) -> Section:
    tolerance = messages.tolerance_of(record.header.options)
    limit = f"at most {messages.figure(tolerance)} u" if tolerance is not None else "at most the run's tolerance"
    sentences = (
        prose(
            "Each method in floats, held against the exact decisions, on the cases inside its stated regimes. The"
            " *backward error* of a wrong answer is the least relative change of the inputs that makes it right, in"
            " units u of the precision (∞: no change of up to 100 % does); a wrong answer with"
        ),
        f" {limit} is ",
        prose(
            "*tolerated*. A *false clear* (dangerous) calls a contact clear, a *false contact* is an invisible wall."
        ),
    )
    return Section("Numerical findings", (Paragraph(sentences), _glossary(methods)))


def _glossary(methods: Sequence[model.ImplementationTotal]) -> Block:
    """The titles of the methods; one that runs in several precisions is described once."""
    titles = {_plain_name(method): method.title.removesuffix(f", {method.precision}") for method in methods}
    return bullets([(Code(name), f": {title}") for name, title in titles.items() if title != name])


def _plain_name(method: model.ImplementationTotal) -> str:
    return method.name.removesuffix(f"-{method.precision}")


def _part(precision: str, methods: Sequence[model.ImplementationTotal]) -> Section:
    otherwise = [
        (method, {name: n for name, n in method.statuses.items() if name not in _IN_TABLE}) for method in methods
    ]
    also: list[Text] = [(Code(method.name), f" also ended: {_statuses(rest)}") for method, rest in otherwise if rest]
    return Section(precision, (_totals(methods), bullets(also), *_matrix(methods)), level=3)


def _totals(methods: Sequence[model.ImplementationTotal]) -> TableBlock:
    columns = (
        "method | question | # asked | # right | # tolerated | # wrong | # false clear | # worst error in u | its case"
    )
    return table("methods", columns, [_method_row(method) for method in methods])


def _method_row(method: model.ImplementationTotal) -> Row:
    statuses, worst = method.statuses, method.worst
    error = model.worst_error_u(worst)
    return (
        Code(_plain_name(method)),
        method.question,
        count(method.asked),
        count(statuses.get("right", 0)),
        count(statuses.get("tolerated", 0)),
        count(statuses.get("wrong", 0), bad=True),
        count(method.mistakes.get("false-clear", 0)),
        TableCell(messages.figure(error) if worst else NONE, error),
        Code(worst.case, messages.from_hex(numbers_of(worst))) if worst else NONE,
    )


def _matrix(methods: Sequence[model.ImplementationTotal]) -> tuple[Block, ...]:
    families = dict.fromkeys(group.family for total in methods for group in total.groups)
    groups = {(total.name, group.family): group for total in methods for group in total.groups}

    def cell(method: str, family: str) -> TableCell:
        group = groups.get((method, family))
        if group is None or not group.asked:
            return TableCell(MISSING, -1)
        wrong = group.counts.get("wrong", 0)
        return TableCell(f"{wrong:,}", wrong, "bad") if wrong else TableCell(NONE, 0)

    rows: list[Row] = [(Code(family), *(cell(total.name, family) for total in methods)) for family in families]
    columns = (Column("family"), *(number(Code(_plain_name(total))) for total in methods))
    asked = max((group.asked for group in groups.values()), default=0)
    return (
        Paragraph(
            f"Wrong answers by family, of at most {counted(asked, 'case')} each ({NONE} none, {MISSING} nothing"
            " asked: outside the stated regimes or the format's range):"
        ),
        table("wrong answers by family", columns, rows),
    )


def _statuses(statuses: dict[str, int]) -> str:
    return ", ".join(f"{name} {cases:,}" for name, cases in statuses.items())


def gated_sections(record: Record) -> Iterator[Section]:
    """Gated implementations: their declarations, and the values used to judge them; none if nothing was gated."""
    gated = model.under_test(record)
    if not gated:
        return
    columns = " |  | question | spheroids | precision | domain | language | version"
    rows = [
        row
        for tested in gated
        if isinstance(tested.line, ImplementationLine)
        for row in _gated_rows(tested.name, tested.line)
    ]
    declared = [table("implementations under test", columns, rows)] if rows else []
    yield Section("Implementations under test", (*declared, bullets([_gated_value(tested) for tested in gated])))


def _gated_rows(name: str, line: ImplementationLine) -> Iterator[Row]:
    """The declarations and the values used to judge: options of the command line replace declarations."""
    for shown, what, description in ((Code(name), "declared", line.declared), ("", "judged as", line.used)):
        yield (
            shown,
            what,
            description.question,
            ("upright and tilted" if description.tilt else "upright") + ", with ends" * (description.heights is True),
            description.precision,
            messages.domain_text(description.domain),
            description.language or MISSING,
            description.version or MISSING,
        )


def _gated_value(tested: model.UnderTest) -> Text:
    line = tested.line
    name: Text = (Code(tested.name), ", ", Code(line.spec))
    if isinstance(line, NotStartedLine):
        return (name, f", was not started: {line.trouble}.")
    again = line.again
    troubles = "".join(f" {trouble}." for trouble in line.troubles)
    excused = sum(group.counts.get("excused", 0) for group in tested.groups)
    known = f" {counted(excused, 'case')} excused as known failures." if excused else ""
    fresh = sum(group.fresh or 0 for group in tested.groups)
    freshness = f" {counted(fresh, 'row')} of a seed that nobody knew before the run." if fresh else " No fresh rows."
    counts: Counter[str] = sum((Counter(group.not_asked or {}) for group in tested.groups), Counter())
    left_out = [text for text in (messages.rows_not_asked(counts), messages.families_not_asked(line)) if text]
    known += (freshness if line.not_asked is not UNSET else "") + (
        f" Not asked: {'; '.join(left_out)}." if left_out else ""
    )
    known += "".join(f" {fact[0].upper()}{fact[1:]}." for fact in messages.spread(line))
    sentences = (
        f": {counted(again.asked, 'case')} asked again in another order, in other batches and in a fresh process;"
        f" {again.within:,} answered otherwise within the tolerance, {again.beyond:,} beyond it."
        f" {counted(line.restarts, 'restart')}.{known}{troubles}"
    )
    return (name, sentences)


SWEEPS = Figures("ways", "the sweep of each implementation's worst answer, in the half plane (r, z)", "ways.svg")
_SWEEPS = prose(
    "The worst answer of each implementation about a sweep of an upright spheroid. Distance from the axis is drawn"
    " across and height up, so that a straight sweep is curved; a spheroid touches the hyperboloid in this plane. On"
    " the right is where it first touches, or comes nearest, each direction in its own scale."
)


def sweep_sections(record: Record) -> Iterator[Section]:
    """Pictures of the worst answers about sweeps; none if no answer about a sweep is wrong."""
    if any(model.drawn_sweep(implementation) is not None for implementation in model.implementations(record)):
        yield Section("The worst sweeps", (Paragraph(_SWEEPS), SWEEPS))


def timing_sections(record: Record) -> Iterator[Section]:
    """The time of the fast path compared with other methods; none if nothing was timed."""
    totals = model.timing_totals(record)
    if not totals:
        return
    workloads = joined([Code(name) for name in dict.fromkeys(total.workload for total in totals)])
    how = (
        ", in one process, in interleaved rounds on the machine below. Each is set against the"
        f" {model.REFERENCE} in the same round; the median of the rounds. Times do not carry over to another machine."
    )
    introduction = ("On ", workloads, how)
    rows = [
        (
            total.name,
            total.title,
            count(total.rows),
            measured(total.median_ns),
            TableCell(f"{messages.figure(total.least_ns)} to {messages.figure(total.greatest_ns)}", total.greatest_ns),
            paced(total.ratio),
        )
        for total in totals
    ]
    columns = "contender | what it is | # rows | # ns a row, median | # least to greatest | # against the plain formula"
    yield Section("Timings", (Paragraph(introduction), table("timings", columns, rows)))


MAP = Figures("map", "exact positions and wrong answers over the half plane (r, z)", "map.svg")


def map_sections(record: Record) -> Iterator[Section]:
    """The points in the half plane of a scene at which a method is wrong; none if there is no map."""
    items = [
        (
            f"{line.name}: ",
            Code(line.method),
            f" is wrong at {line.wrong:,} of {counted(line.points, 'grid point')}",
        )
        for line in record.of(MapLine)
    ]
    if items:
        yield Section("Where it goes wrong", (MAP, bullets(items)))


_PROOFS = prose(
    "Each formula is a program of single steps. What its steps must equal was derived in symbols, and its decision was "
    "compared with its rule for every combination of signs. `derivation` are the identities that the rules rest on."
)
_FINDINGS = prose(
    "Evaluated in exact rationals, without rounding. *Inside* its stated regimes a formula claims to be right; "
    "*outside* them it does not, and the table shows how it errs there."
)


def paper_sections(record: Record) -> Iterator[Section]:
    """The paper's equations, the proofs of its formulas, and their errors in exact arithmetic."""
    equations, proofs, findings = record.of(EquationLine), record.of(ProofLine), record.of(FindingLine)
    if equations:
        yield _equations(equations)
    if proofs:
        yield _proofs(proofs)
    if findings:
        yield _findings(findings)


def _equations(lines: list[EquationLine]) -> Section:
    holding = [f"({line.number})" for line in lines if line.holds]
    items = [
        Item(
            (Strong(f"({line.number})"), f" {line.verdict}: {line.finding}."),
            (("printed: ", Code(line.statement)), ("derived: ", Code(line.correction))),
        )
        for line in lines
        if not line.holds
    ]
    named = f": {', '.join(holding)}." if holding else "."
    introduction = (
        f"Each displayed formula was compared with the derivation: {len(holding)} of {len(lines)} hold{named}"
    )
    return Section("The paper's equations", (Paragraph(introduction), bullets(items)))


def _proofs(lines: list[ProofLine]) -> Section:
    by_formula: dict[str, list[bool]] = {}
    for line in lines:
        by_formula.setdefault(line.formula, []).append(line.holds)
    rows = [
        (Code(name), TableCell(str(sum(holds)), sum(holds)), TableCell(str(len(holds)), len(holds)))
        for name, holds in by_formula.items()
    ]
    proved = table("proofs", "formula | # proved | # to be shown", rows)
    return Section("The proofs", (Paragraph(_PROOFS), proved))


def _findings(lines: list[FindingLine]) -> Section:
    """Findings inside the stated regimes come first: they are errors. Formulas with the same witness share a row."""
    alike: dict[tuple[object, ...], list[FindingLine]] = {}
    for line in sorted(lines, key=lambda line: not line.inside):
        key = (line.inside, line.family, line.cause, line.first_case, line.wrong, line.asked, line.reason)
        alike.setdefault(key, []).append(line)
    columns = "formula | family | stated regimes | # wrong | why | first witness, to six digits | its case"
    witnesses = table("mathematical findings", columns, [_finding(group) for group in alike.values()])
    return Section("Mathematical findings", (Paragraph(_FINDINGS), witnesses))


def _finding(group: list[FindingLine]) -> Row:
    line = group[0]
    why = model.explanation(line)
    row = messages.from_hex(line.first_row)
    return (
        joined([Code(finding.formula) for finding in group]),
        Code(line.family),
        Strong("inside") if line.inside else "outside",
        TableCell(f"{line.wrong:,} of {line.asked:,}", line.wrong / max(1, line.asked)),
        TableCell(Strong(why), tone="bad") if model.unlisted(line) else why,
        messages.short_row(row),
        Code(line.first_case, row),
    )
