"""junit.xml: the run as test suites and cases, in the dialect that CI systems read.

There is a suite for each subject, and a case for each thing that can go wrong in it. A failure of the run is a failure;
a run that stopped before its end is an error. Errors of the paper's formulas, and of methods that promise nothing, are
expected: their cases pass, with what was found as output (docs/record.md, "junit.xml").
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from xml.etree import ElementTree as Xml

from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.record.lines import EquationLine, FindingLine, GroupLine, OracleLine, ProofLine
from hypcheck.record.measurements import (
    ComparisonLine,
    ForestLine,
    KernelLine,
    RefusedLine,
    SceneLine,
    SpeedLine,
    UnmeasuredLine,
)
from hypcheck.report.benchmark_failures import MEASUREMENT, Failure
from hypcheck.report.measured import measured_methods
from hypcheck.report.messages import (
    Replays,
    classify_command,
    figure,
    from_hex,
    implementation_claims,
    pace,
    rows_not_asked,
    settings_facts,
)
from hypcheck.report.model import (
    ImplementationTotal,
    explanation,
    implementations,
    in_order,
    oracle_totals,
    under_test,
    worst_case,
)
from hypcheck.report.verdict import ended_badly, failures, verdict


@dataclass(frozen=True, slots=True)
class JunitTrouble:
    """Why a case did not pass: `tag` is "failure", "error" or "skipped"; `kind` and `message` are one line each."""

    tag: str
    kind: str
    message: str
    details: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class JunitCase:
    """A test case; `output` are the lines of its system-out.

    Its name does not depend on its result. Times are whole milliseconds, so that sums add up; None: not measured.
    """

    name: str
    trouble: JunitTrouble | None = None
    output: tuple[str, ...] = ()
    milliseconds: int | None = None


@dataclass(frozen=True, slots=True)
class JunitSuite:
    """A named group of cases."""

    name: str
    cases: tuple[JunitCase, ...]

    def count(self, tag: str) -> int:
        """How many of its cases have a trouble with this tag."""
        return sum(case.trouble is not None and case.trouble.tag == tag for case in self.cases)

    @property
    def milliseconds(self) -> int | None:
        """The time of all cases that have one; None if no case has."""
        return total(case.milliseconds for case in self.cases)


def total(times: Iterable[int | None]) -> int | None:
    """The sum of the times that were measured; None if none was."""
    known = [time for time in times if time is not None]
    return sum(known) if known else None


def details(failed: Iterable[Failure]) -> Iterator[str]:
    """Each failure with its case, and the command that shows it."""
    for each in failed:
        place = f" ({each.place})" if each.place else ""
        yield f"case {each.case}{place}: {each.message}" if each.case else each.message
        if each.replay:
            yield f"replay: {each.replay}"


def benchmark_suites(record: Record, failed: Sequence[Failure]) -> Iterator[JunitSuite]:
    """The suites of a benchmark: answers, times, baseline, scenes, kernels; all empty if there was none."""
    found = [failure for failure in failed if failure.subject == MEASUREMENT]
    yield JunitSuite("bench.answers", tuple(_answer_cases(record, found)))
    yield JunitSuite("bench.times", tuple(_time_cases(record, found)))
    yield JunitSuite("bench.baseline", tuple(_comparison(line, found) for line in record.of(ComparisonLine)))
    yield JunitSuite("bench.scenes", tuple(_scene_cases(record, found)))
    yield JunitSuite("bench.kernels", tuple(_kernel(line, found) for line in record.of(KernelLine)))


def _answer_cases(record: Record, failed: Sequence[Failure]) -> Iterator[JunitCase]:
    for each in measured_methods(record):
        for workload, line in each.accuracy.items():
            reliable = figure(line.reliable_above)
            said = f"{line.wrong:,} of {counted(line.asked, 'answer')} wrong; reliable above {reliable}"
            yield JunitCase(f"{each.name} on {workload}", _trouble(failed, "wrong", each.name, workload), (said,))


def _time_cases(record: Record, failed: Sequence[Failure]) -> Iterator[JunitCase]:
    for line in record.of(SpeedLine):
        ratio = "" if line.ratio is None else f"{pace(line.ratio, 'the reference')}, "
        said = f"{ratio}{figure(line.median_ns)} ns"
        yield JunitCase(_name(line), output=(said,))
    for unmeasured in record.of(UnmeasuredLine):
        yield JunitCase(_name(unmeasured), JunitTrouble("skipped", "unmeasured", unmeasured.reason))
    for refused in record.of(RefusedLine):
        yield JunitCase(_name(refused), _trouble(failed, "refused", refused.method, _where(refused)))


def _scene_cases(record: Record, failed: Sequence[Failure]) -> Iterator[JunitCase]:
    for line in record.of(SceneLine):
        ratios = (figure(times.by_printed or 0.0) for times in (line.batch, line.single))
        said = f"{' in a batch and '.join(ratios)} one by one times Table 2's time, {line.wrong:,} wrong"
        yield JunitCase(line.scene, _trouble(failed, "wrong", line.scene, "scene"), (said,))
    for step in record.of(ForestLine):
        group = f"{step.trees:,} trees"
        said = f"{figure(step.step_ns)} ns a step, {step.wrong:,} wrong"
        yield JunitCase(f"{step.method}, {group}", _trouble(failed, "wrong", step.method, group), (said,))


def _comparison(line: ComparisonLine, failed: Sequence[Failure]) -> JunitCase:
    said = f"{figure(line.change)} times its former ratio, allowed {figure(line.allowed)}: {line.verdict}"
    trouble = _trouble(failed, line.verdict, line.method, _where(line))
    if trouble is None and line.verdict == "inconclusive":
        trouble = JunitTrouble("skipped", "inconclusive", said)
    return JunitCase(_name(line), trouble, (said,))


def _kernel(line: KernelLine, failed: Sequence[Failure]) -> JunitCase:
    said = f"wanted {figure(line.wanted)}, measured {figure(line.measured)}: {'met' if line.met else 'not met'}"
    missed = _failure([each for each in failed if (each.name, each.group) == (line.name, "target")])
    return JunitCase(f"{line.name}: {line.target}", missed, (said, line.says))


def _name(line: SpeedLine | UnmeasuredLine | RefusedLine | ComparisonLine) -> str:
    return f"{line.method} on {_where(line)}"


def _where(line: SpeedLine | UnmeasuredLine | RefusedLine | ComparisonLine) -> str:
    return f"{line.workload}, {line.mode}"


def _trouble(failed: Sequence[Failure], kind: str, name: str, group: str) -> JunitTrouble | None:
    return _failure([each for each in failed if (each.kind, each.name, each.group) == (kind, name, group)])


def _failure(mine: Sequence[Failure], message: str = "") -> JunitTrouble | None:
    """The trouble of a case to which these failures belong, with their details; None without any."""
    if not mine:
        return None
    said = message or "; ".join(each.message for each in mine)
    return JunitTrouble("failure", mine[0].kind, said, tuple(details(mine)))


_LONGEST_MS = 1e15
"""Milliseconds, at most; a larger time in a record is an error."""


def junit_suites(record: Record) -> Iterator[JunitSuite]:
    """All suites of a record; some may be empty."""
    failed = failures(record)
    others = list(_others(record, failed))
    yield JunitSuite("run", (_ended(record, failed, total(suite.milliseconds for suite in others) or 0),))
    yield from others


def _others(record: Record, failed: list[Failure]) -> Iterator[JunitSuite]:
    """The suites after that of the run itself."""
    yield JunitSuite("proofs", tuple(_distinct_names(_proof(line) for line in record.of(ProofLine))))
    yield JunitSuite("equations", tuple(_distinct_names(_equation(line) for line in record.of(EquationLine))))
    for oracle in oracle_totals(record):
        lines = [line for line in record.of(OracleLine) if line.oracle == oracle.name]
        if oracle.unavailable is not None:
            trouble = JunitTrouble("skipped", "unavailable", f"not available: {oracle.unavailable}")
            yield JunitSuite(f"oracles.{oracle.name}", (JunitCase("available", trouble),))
        else:
            yield JunitSuite(f"oracles.{oracle.name}", tuple(_oracle(line, failed) for line in lines))
    yield JunitSuite("findings", tuple(_findings(record, failed)))
    replays = Replays.of(record)
    for implementation in implementations(record):
        cases = tuple(_family_case(implementation, group, failed, replays) for group in implementation.groups)
        yield JunitSuite(f"implementations.{implementation.name}", cases)
    yield JunitSuite("implementations", tuple(_implementation_cases(record, failed)))
    yield from benchmark_suites(record, failed)


def _ended(record: Record, failed: list[Failure], others: int) -> JunitCase:
    """The end of the run: an error if it was not reached, or if the exit code contradicts the record's lines.

    Its time is that of the run without the milliseconds of the `others`, if the run has an end and a time. Failures of
    other cases are not repeated here.
    """
    seconds = None if record.footer is None else record.footer.seconds
    milliseconds = None if seconds is None else max(0, _milliseconds(seconds) - others)
    ended = ended_badly(record, failed)
    if ended is not None:
        return JunitCase("ended", JunitTrouble("error", ended.kind, ended.message), milliseconds=milliseconds)
    return JunitCase("ended", output=(verdict(record).sentence,), milliseconds=milliseconds)


def _milliseconds(seconds: float) -> int:
    """Whole milliseconds; a time beyond _LONGEST_MS is cut."""
    return round(min(1000 * seconds, _LONGEST_MS))


def _proof(line: ProofLine) -> JunitCase:
    name = f"{line.formula}: {line.quantity}"
    if line.holds:
        return JunitCase(name, output=(line.statement,))
    return JunitCase(name, JunitTrouble("failure", "unproved", f"not proved: {line.statement}"))


def _equation(line: EquationLine) -> JunitCase:
    derived = () if line.holds else (f"derived: {line.correction}",)
    output = (f"{line.verdict}: {line.finding}", f"printed: {line.statement}", *derived)
    return JunitCase(f"({line.number})", output=output)


def _distinct_names(cases: Iterable[JunitCase]) -> Iterator[JunitCase]:
    """The cases under distinct names: parsers merge cases with the same name."""
    seen: Counter[str] = Counter()
    for case in cases:
        seen[case.name] += 1
        number = seen[case.name]
        yield case if number == 1 else replace(case, name=f"{case.name} ({number})")


def _oracle(line: OracleLine, failed: list[Failure]) -> JunitCase:
    stages = ", ".join(f"{stage} {number:,}" for stage, number in line.stages.items())
    output = (f"{counted(line.asked, 'case')}, {line.undecided:,} undecided: {stages}",)
    milliseconds = _milliseconds(line.seconds)
    place = ("oracle", line.oracle, line.family)
    mine = [each for each in failed if (each.subject, each.name, each.group) == place]
    trouble = None
    if mine:
        counts = f"{counted(line.disagreeing, 'disagreement')} in {counted(line.asked, 'case')}"
        trouble = _failure(mine, f"{counts}; first: {mine[0].message}")
    elif line.undecided == line.asked:
        trouble = JunitTrouble("skipped", "undecided", "no case could be decided")
    return JunitCase(line.family, trouble, output, milliseconds)


def _findings(record: Record, failed: list[Failure]) -> Iterator[JunitCase]:
    """A case for each mathematical finding, and one about whether they are the known ones."""
    yield from _distinct_names(map(_finding, record.of(FindingLine)))
    drifted = [each for each in failed if each.subject == "findings"]
    if drifted:
        yield JunitCase("known findings", _failure(drifted))
    elif record.of(FindingLine):
        yield JunitCase("known findings", output=("the findings are the known ones",))


def _finding(line: FindingLine) -> JunitCase:
    where = "inside" if line.inside else "outside"
    return JunitCase(
        f"{line.formula} on {line.family}",
        output=(
            f"wrong in exact arithmetic, {where} its stated regimes: {line.wrong:,} of {line.asked:,}",
            explanation(line),
            f"first case: {line.first_case}",
            f"replay: {classify_command(from_hex(line.first_row))}",
        ),
    )


def _implementation_cases(record: Record, failed: list[Failure]) -> Iterator[JunitCase]:
    """A case for each gated implementation, which fails if it did not start, or failed outside any family."""
    for tested in under_test(record):
        families = {group.family for group in tested.groups}
        mine = [each for each in failed if each.name == tested.name and each.group not in families]
        if mine:
            message = "; ".join(each.message for each in mine)
            yield JunitCase(tested.name, JunitTrouble("failure", mine[0].kind, message))
        else:
            yield JunitCase(tested.name, output=tuple(implementation_claims(tested.line)))


def _family_case(
    implementation: ImplementationTotal, group: GroupLine, failed: list[Failure], replays: Replays
) -> JunitCase:
    """A case for each family: it fails if any status of its cases fails the run; the output has all statuses."""
    counts, output = in_order(Counter(group.counts)), []
    cases = sum(counts.values())
    for status, number in counts.items():
        why = rows_not_asked(group.not_asked or {}) if status == "skipped" else ""
        output.append(f"{status}: {number:,} of {counted(cases, 'case')}{why and f': {why}'}")
        worst = worst_case([case for case in group.worst if case.status == status])
        if worst is not None:
            numbered = f" ({replays.place(worst)})" if implementation.gated else ""
            error = figure(worst.backward_error_u)
            output.append(f"worst backward error: {error} u, case {worst.case}{numbered}")
            output.append(f"replay: {replays.command(group, worst)}")
    place = ("implementation", implementation.name, group.family)
    mine = [each for each in failed if (each.subject, each.name, each.group) == place and each.kind in counts]
    if not mine and set(counts) == {"skipped"}:
        why = rows_not_asked(group.not_asked or {}) or "they lie outside the method's domain or its format's range"
        message = f"all {counted(cases, 'case')} were not asked: {why}"
        return JunitCase(group.family, JunitTrouble("skipped", "skipped", message))
    if group.fresh:
        output.append(f"fresh rows: {group.fresh:,}")
    return JunitCase(group.family, _failure(mine), tuple(output))


TAGS = {"failure": "failures", "error": "errors", "skipped": "skipped"}
"""The elements of cases that did not pass, and the attributes that count them."""


def render(record: Record) -> bytes:
    """The test suites as XML 1.0 in UTF-8."""
    found = [suite for suite in junit_suites(record) if suite.cases]
    root = Xml.Element("testsuites", {"name": "hypcheck", **_attributes(found)})
    # Without its offset: the schema that most parsers use allows none.
    started = escaped(record.header.started)[:19]
    for suite in found:
        element = Xml.SubElement(root, "testsuite", {"name": escaped(suite.name), **_attributes([suite])})
        element.set("timestamp", started)
        _set_properties(element, record)
        for case in suite.cases:
            element.append(_element(suite, case))
    Xml.indent(root)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _set_properties(element: Xml.Element, record: Record) -> None:
    """The settings of the run, in each suite: the schema that most parsers use has properties only there."""
    found = list(settings_facts(record.header.settings))
    if found:
        properties = Xml.SubElement(element, "properties")
        for fact in found:
            Xml.SubElement(properties, "property", {"name": "settings", "value": escaped(fact)})


def _attributes(found: Sequence[JunitSuite]) -> dict[str, str]:
    return {
        "tests": str(sum(len(suite.cases) for suite in found)),
        **{attribute: str(sum(suite.count(tag) for suite in found)) for tag, attribute in TAGS.items()},
        **_time(total(suite.milliseconds for suite in found)),
    }


def _element(suite: JunitSuite, case: JunitCase) -> Xml.Element:
    names = {"classname": escaped(f"hypcheck.{suite.name}"), "name": escaped(case.name)}
    element = Xml.Element("testcase", {**names, **_time(case.milliseconds)})
    if case.trouble is not None:
        message = escaped(case.trouble.message)
        trouble = Xml.SubElement(element, case.trouble.tag, {"message": message})
        if case.trouble.tag != "skipped":
            trouble.set("type", escaped(case.trouble.kind))
            trouble.text = "\n".join([message, *map(escaped, case.trouble.details)])
    if case.output:
        Xml.SubElement(element, "system-out").text = "\n".join(map(escaped, case.output))
    return element


def _time(milliseconds: int | None) -> dict[str, str]:
    """The attribute in seconds; none if no time was measured, since 0.000 would be wrong."""
    return {} if milliseconds is None else {"time": f"{milliseconds // 1000}.{milliseconds % 1000:03d}"}
