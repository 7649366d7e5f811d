"""Sections of a verification: oracles, methods, implementations under test, timings, maps, and the paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.fields import numbers_of
from hypcheck.record.lines import (
    EquationLine,
    FindingLine,
    ImplementationLine,
    MapLine,
    ProofLine,
    WrongAnswer,
)
from hypcheck.report import document, messages, model

_ORACLES = document.prose(
    "Each oracle answers on its own. `exact` agrees where an independent check accepts the certificate of its answer;"
    " the others agree where they say what `exact` says. An oracle that cannot decide says so and is counted as"
    " undecided. Where the hyperboloid ends, `roots` is not asked. Seconds are summed over all processes."
)


def oracle_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the agreement of the oracles; nothing if the plan has no oracle."""
    totals = model.oracle_totals(record)
    if not totals:
        return
    answering = [total for total in totals if total.unavailable is None]
    missing = [
        (document.Code(total.name), f" was not asked: {total.unavailable}") for total in totals if total.unavailable
    ]
    answers = [document.table_of("oracles", answering, _ORACLE_CELLS)] if answering else []
    yield document.Section("The oracles", (document.Paragraph(_ORACLES), *answers, document.bullets(missing)))


_ORACLE_CELLS: document.Cells[model.OracleTotal] = {
    "oracle": lambda total: document.Code(total.name),
    "# asked": lambda total: document.count(total.asked),
    "# agreed": lambda total: document.count(total.agreed),
    "# undecided": lambda total: document.count(total.undecided),
    "# disagreed": lambda total: document.count(total.disagreements, bad=True),
    "how it answered": lambda total: ", ".join(f"{stage or 'answered'} {n:,}" for stage, n in total.stages.items()),
    "# seconds": lambda total: document.measured(total.seconds),
}


_IN_TABLE = ("right", "tolerated", "wrong", "skipped")
"""The statuses that have a column, and the status of cases that were not tested."""


def method_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the wrong answers of each method; nothing if nothing was judged."""
    totals = model.implementations(record)
    exact = [total for total in totals if total.exact]
    others = [total for total in totals if not total.exact]
    if exact:
        yield _exact(exact)
    if others:
        yield _introduction(record, others)
    for precision in dict.fromkeys(total.precision for total in others):
        yield _part(precision, [total for total in others if total.precision == precision])


def _exact(methods: Sequence[model.ImplementationTotal]) -> document.Section:
    """Make the section about the methods that promise to be exact."""
    cells: document.Cells[model.ImplementationTotal] = {
        "method": lambda method: document.Code(method.name),
        "what it is": lambda method: method.title,
        "# asked": lambda method: document.count(method.asked),
        "answers": lambda method: _statuses(method.statuses),
    }
    words = document.Paragraph("A single answer that is not right fails the run.")
    return document.Section(
        "Methods that promise to be exact", (words, document.table_of("exact methods", methods, cells))
    )


def _introduction(record: Record, methods: Sequence[model.ImplementationTotal]) -> document.Section:
    """Make the section that introduces the methods in floats and explains the words about errors."""
    tolerance = messages.tolerance_of(record.header.options)
    limit = f"at most {messages.figure(tolerance)} u" if tolerance is not None else "at most the run's tolerance"
    sentences = (
        document.prose(
            "Each method in floats, held against the exact decisions, on the cases inside its stated regimes. The"
            " *backward error* of a wrong answer is the least relative change of the inputs that makes it right, in"
            " units u of the precision (∞: no change of up to 100 % does); a wrong answer with"
        ),
        f" {limit} is ",
        document.prose(
            "*tolerated*. A *false clear* (dangerous) calls a contact clear, a *false contact* is an invisible wall."
        ),
    )
    return document.Section("Numerical findings", (document.Paragraph(sentences), _glossary(methods)))


def _glossary(methods: Sequence[model.ImplementationTotal]) -> document.Block:
    """List the titles of the methods; one that runs in several precisions is described once."""
    titles = {_plain_name(method): method.title.removesuffix(f", {method.precision}") for method in methods}
    return document.terms((document.Code(name), title) for name, title in titles.items() if title != name)


def _plain_name(method: model.ImplementationTotal) -> str:
    """Return the name of a method without its precision."""
    return method.name.removesuffix(f"-{method.precision}")


def _part(precision: str, methods: Sequence[model.ImplementationTotal]) -> document.Section:
    """Make the section about the methods in one precision."""
    otherwise = [
        (method, {name: n for name, n in method.statuses.items() if name not in _IN_TABLE}) for method in methods
    ]
    also: list[document.Text] = [
        (document.Code(method.name), f" also ended: {_statuses(rest)}") for method, rest in otherwise if rest
    ]
    totals = document.table_of("methods", methods, _METHOD_CELLS)
    return document.Section(precision, (totals, document.bullets(also), *_matrix(methods)), level=3)


def _worst_error(worst: WrongAnswer | None) -> document.TableCell:
    """Make the cell of the worst backward error in units u; NONE if no answer was wrong."""
    error = model.worst_error_u(worst)
    return document.TableCell(messages.figure(error) if worst else document.NONE, error)


def _worst_case(worst: WrongAnswer | None) -> document.Text:
    """Return the id of the case with the worst answer; NONE if no answer was wrong."""
    return document.Code(worst.case, messages.from_hex(numbers_of(worst))) if worst else document.NONE


_METHOD_CELLS: document.Cells[model.ImplementationTotal] = {
    "method": lambda method: document.Code(_plain_name(method)),
    "question": lambda method: method.question,
    "# asked": lambda method: document.count(method.asked),
    "# right": lambda method: document.count(method.statuses.get("right", 0)),
    "# tolerated": lambda method: document.count(method.statuses.get("tolerated", 0)),
    "# wrong": lambda method: document.count(method.statuses.get("wrong", 0), bad=True),
    "# false clear": lambda method: document.count(method.mistakes.get("false-clear", 0)),
    "# worst error in u": lambda method: _worst_error(method.worst),
    "its case": lambda method: _worst_case(method.worst),
}


def _matrix(methods: Sequence[model.ImplementationTotal]) -> tuple[document.Block, ...]:
    """Return the table of wrong answers, a row for each family and a column for each method, and its introduction."""
    families = dict.fromkeys(group.family for total in methods for group in total.groups)
    groups = {(total.name, group.family): group for total in methods for group in total.groups}

    def cell(method: str, family: str) -> document.TableCell:
        group = groups.get((method, family))
        if group is None or not group.asked:
            return document.TableCell(document.MISSING, -1)
        wrong = group.counts.get("wrong", 0)
        return document.TableCell(f"{wrong:,}", wrong, "bad") if wrong else document.TableCell(document.NONE, 0)

    rows: list[document.Row] = [
        (document.Code(family), *(cell(total.name, family) for total in methods)) for family in families
    ]
    columns = (document.Column("family"), *(document.number(document.Code(_plain_name(total))) for total in methods))
    most_cases = max((group.asked for group in groups.values()), default=0)
    return (
        document.Paragraph(
            f"Wrong answers by family, of at most {counted(most_cases, 'case')} each ({document.NONE} none, "
            f"{document.MISSING} nothing asked: outside the stated regimes or the format's range):"
        ),
        document.table("wrong answers by family", columns, rows),
    )


def _statuses(statuses: dict[str, int]) -> str:
    """Return the counts by status as a text: "right 12, wrong 3"."""
    return ", ".join(f"{name} {cases:,}" for name, cases in statuses.items())


def gated_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about gated implementations and how they were tested; nothing if none was gated."""
    gated = model.under_test(record)
    if not gated:
        return
    columns = " |  | question | spheroids | precision | domain | language | version"
    rows = [row for tested in gated if tested.started is not None for row in _gated_rows(tested.name, tested.started)]
    declared = [document.table("implementations under test", columns, rows)] if rows else []
    tests = document.bullets([_tested_text(tested) for tested in gated])
    yield document.Section("Implementations under test", (*declared, document.Paragraph(_AGAIN), tests))


_AGAIN = (
    "Some cases are asked again, in another order, in other batches and in a fresh process. Fresh rows are of a seed "
    "that nobody knew before the run."
)


def _gated_rows(name: str, line: ImplementationLine) -> Iterator[document.Row]:
    """Yield two rows: what an implementation declares, and what it was judged as.

    Options of the command line replace declarations.
    """
    for shown, what, description in ((document.Code(name), "declared", line.declared), ("", "judged as", line.used)):
        yield (
            shown,
            what,
            description.question,
            ("upright and tilted" if description.tilt else "upright") + ", with ends" * (description.heights is True),
            description.precision,
            messages.domain_text(description.domain),
            description.language or document.MISSING,
            description.version or document.MISSING,
        )


def _tested_text(tested: model.UnderTest) -> document.Text:
    """Describe in sentences how a gated implementation was tested."""
    line, fresh, excused = tested.started, tested.fresh, tested.statuses.get("excused")
    name: document.Text = (document.Code(tested.name), ", ", document.Code(tested.line.spec))
    if line is None:
        return (name, f", was not started: {tested.trouble}.")
    facts = [
        *messages.how_tested(line, tested.not_asked),
        *([f"{counted(excused, 'case')} excused as known failures"] if excused else []),
        *([] if fresh is None else [counted(fresh, "fresh row") if fresh else "no fresh rows"]),
    ]
    return (name, ": ", " ".join([*map(messages.as_sentence, facts), *(f"{trouble}." for trouble in line.troubles)]))


SWEEPS = document.Figures(
    "ways", "the sweep of each implementation's worst answer, in the half plane (r, z)", "ways.svg"
)
_SWEEPS = document.prose(
    "The worst answer of each implementation about a sweep of an upright spheroid. Distance from the axis is drawn"
    " across and height up, so that a straight sweep is curved; a spheroid touches the hyperboloid in this plane. On"
    " the right is where it first touches, or comes nearest, each direction in its own scale."
)


def sweep_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section with pictures of the worst answers about sweeps; nothing if no such answer is wrong."""
    if any(model.drawn_sweep(implementation) is not None for implementation in model.implementations(record)):
        yield document.Section("The worst sweeps", (document.Paragraph(_SWEEPS), SWEEPS))


def timing_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the time of the fast path and other methods; nothing if nothing was timed."""
    totals = model.timing_totals(record)
    if not totals:
        return
    workloads = document.joined([document.Code(name) for name in dict.fromkeys(total.workload for total in totals)])
    how = (
        ", in one process, in interleaved rounds on the machine below. Each is set against the"
        f" {model.REFERENCE} in the same round; the median of the rounds. Times do not carry over to another machine."
    )
    introduction = ("On ", workloads, how)
    times = document.table_of("timings", totals, _TIMING_CELLS)
    yield document.Section("Timings", (document.Paragraph(introduction), times))


def _spread(total: model.TimingTotal) -> document.TableCell:
    """Make the cell of the least and the greatest time of the rounds."""
    ends = (messages.figure(total.least_ns), messages.figure(total.greatest_ns))
    return document.TableCell(" to ".join(ends), total.greatest_ns)


_TIMING_CELLS: document.Cells[model.TimingTotal] = {
    "contender": lambda total: total.name,
    "what it is": lambda total: total.title,
    "# rows": lambda total: document.count(total.rows),
    "# ns a row, median": lambda total: document.measured(total.median_ns),
    "# least to greatest": _spread,
    "# against the plain formula": lambda total: document.paced(total.ratio),
}


MAP = document.Figures("map", "exact positions and wrong answers over the half plane (r, z)", "map.svg")


def map_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the grid points at which a method is wrong; nothing if there is no map."""
    items = [
        (
            f"{line.name}: ",
            document.Code(line.method),
            f" is wrong at {line.wrong:,} of {counted(line.points, 'grid point')}",
        )
        for line in record.of(MapLine)
    ]
    if items:
        yield document.Section("Where it goes wrong", (MAP, document.bullets(items)))


_PROOFS = document.prose(
    "Each formula is a program of single steps. What its steps must equal was derived in symbols, and its decision was "
    "compared with its rule for every combination of signs. `derivation` are the identities that the rules rest on."
)
_FINDINGS = document.prose(
    "Evaluated in exact rationals, without rounding. *Inside* its stated regimes a formula claims to be right; "
    "*outside* them it does not, and the table shows how it errs there."
)


def paper_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the paper's equations, the proofs of its formulas, and their errors in exact arithmetic."""
    equations, proofs, findings = record.of(EquationLine), record.of(ProofLine), record.of(FindingLine)
    if equations:
        yield _equations(equations)
    if proofs:
        yield _proofs(proofs)
    if findings:
        yield _findings(findings)


def _equations(lines: list[EquationLine]) -> document.Section:
    """Make the section about the displayed formulas: how many hold, and how the others are corrected."""
    holding = [f"({line.number})" for line in lines if line.holds]
    items = [
        document.Item(
            (document.Strong(f"({line.number})"), f" {line.verdict}: {line.finding}."),
            (("printed: ", document.Code(line.statement)), ("derived: ", document.Code(line.correction))),
        )
        for line in lines
        if not line.holds
    ]
    named = f": {', '.join(holding)}." if holding else "."
    introduction = (
        f"Each displayed formula was compared with the derivation: {len(holding)} of {len(lines)} hold{named}"
    )
    return document.Section("The paper's equations", (document.Paragraph(introduction), document.bullets(items)))


def _proofs(lines: list[ProofLine]) -> document.Section:
    """Make the section about the proofs, with a row for each formula."""
    by_formula: dict[str, list[bool]] = {}
    for line in lines:
        by_formula.setdefault(line.formula, []).append(line.holds)
    rows = [
        (document.Code(name), document.count(sum(holds)), document.count(len(holds)))
        for name, holds in by_formula.items()
    ]
    proved = document.table("proofs", "formula | # proved | # to be shown", rows)
    return document.Section("The proofs", (document.Paragraph(_PROOFS), proved))


def _findings(lines: list[FindingLine]) -> document.Section:
    """Make the section about formulas that err in exact arithmetic.

    Findings inside the stated regimes come first, because they are errors. Formulas with the same witness share a row.
    """
    alike: dict[tuple[object, ...], list[FindingLine]] = {}
    for line in sorted(lines, key=lambda line: not line.inside):
        key = (line.inside, line.family, line.cause, line.first_case, line.wrong, line.asked, line.reason)
        alike.setdefault(key, []).append(line)
    witnesses = document.table_of("mathematical findings", alike.values(), _FINDING_CELLS)
    return document.Section("Mathematical findings", (document.Paragraph(_FINDINGS), witnesses))


def _why(line: FindingLine) -> document.TableCell:
    """Make the cell with the reason why a formula errs; it is marked if the finding is not a known one."""
    why = model.explanation(line)
    return document.TableCell(document.Strong(why), tone="bad") if model.unlisted(line) else document.TableCell(why)


_FINDING_CELLS: document.Cells[list[FindingLine]] = {
    "formula": lambda group: document.joined([document.Code(finding.formula) for finding in group]),
    "family": lambda group: document.Code(group[0].family),
    "stated regimes": lambda group: document.Strong("inside") if group[0].inside else "outside",
    "# wrong": lambda group: document.ratio_of(group[0].wrong, group[0].asked),
    "why": lambda group: _why(group[0]),
    "first witness, to six digits": lambda group: messages.short_row(messages.from_hex(group[0].first_row)),
    "its case": lambda group: document.Code(group[0].first_case, messages.from_hex(group[0].first_row)),
}
