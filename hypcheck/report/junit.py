"""junit.xml: the run as test suites and cases, in the dialect that CI systems read.

There is a suite for each subject, and a case for each thing that can go wrong in it. A failure of the run is a failure;
a run that stopped before its end is an error. Errors of the paper's formulas, and of methods without a promise, are
expected: their cases pass, with the findings as output (docs/record.md, "junit.xml").
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any
from xml.etree import ElementTree as Xml

from hypcheck.messages import escaped
from hypcheck.record import Record, RecordLine, lines, measurements
from hypcheck.report.benchmark_facts import accuracy_facts, facts_of
from hypcheck.report.facts import Failure, LineFacts
from hypcheck.report.messages import settings_facts
from hypcheck.report.model import implementations, oracle_totals
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

    Its name does not depend on its result. Times are whole milliseconds, so that sums agree; None: not measured.
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
        """Count its cases that have a trouble with this tag."""
        return sum(case.trouble is not None and case.trouble.tag == tag for case in self.cases)

    @property
    def milliseconds(self) -> int | None:
        """The time of all cases that have one; None if no case has."""
        return total(case.milliseconds for case in self.cases)


def total(times: Iterable[int | None]) -> int | None:
    """Return the sum of the times that were measured; None if none was."""
    known = [time for time in times if time is not None]
    return sum(known) if known else None


def details(failed: Iterable[Failure]) -> Iterator[str]:
    """Yield each failure with its case, and the command that shows it."""
    for failure in failed:
        place = f" ({failure.place})" if failure.place else ""
        yield f"case {failure.case}{place}: {failure.message}" if failure.case else failure.message
        if failure.replay:
            yield f"replay: {failure.replay}"


def _trouble(failed: Sequence[Failure], message: str = "") -> JunitTrouble | None:
    """Make the trouble of a case with these failures, with what shows them; None if there is no failure."""
    if not failed:
        return None
    text = message or "; ".join(failure.message for failure in failed)
    shown = tuple(details(failed)) if any(failure.case or failure.replay for failure in failed) else ()
    return JunitTrouble("failure", failed[0].kind, text, shown)


def _case(facts: LineFacts[Any]) -> JunitCase:
    """Make the test case of one line."""
    failed, not_judged, seconds = list(facts.failures()), facts.not_judged(), facts.seconds()
    trouble = _trouble(failed, facts.headline()) if failed else None
    if not failed and not_judged:
        trouble = JunitTrouble("skipped", not_judged.kind, not_judged.message)
    milliseconds = None if seconds is None else _milliseconds(seconds)
    return JunitCase(facts.name, trouble, tuple(facts.sentences()), milliseconds)


def _cases(facts: Iterable[LineFacts[Any]]) -> tuple[JunitCase, ...]:
    """Make the test cases of these lines under distinct names: parsers merge cases with the same name."""
    seen: Counter[str] = Counter()
    cases = []
    for case in map(_case, facts):
        seen[case.name] += 1
        number = seen[case.name]
        cases.append(case if number == 1 else replace(case, name=f"{case.name} ({number})"))
    return tuple(cases)


_LONGEST_MS = 1e15
"""Milliseconds, at most; a larger time in a record is an error."""


def junit_suites(record: Record) -> Iterator[JunitSuite]:
    """Yield all suites of a record; some may be empty."""
    failed = failures(record)
    others = list(_others(record, failed))
    yield JunitSuite("run", (_ended(record, failed, total(suite.milliseconds for suite in others) or 0),))
    yield from others


def _others(record: Record, failed: list[Failure]) -> Iterator[JunitSuite]:
    """Yield the suites that follow the run's suite."""
    yield JunitSuite("proofs", _cases(facts_of(record, lines.ProofLine)))
    yield JunitSuite("equations", _cases(facts_of(record, lines.EquationLine)))
    answers = facts_of(record, lines.OracleLine)
    for oracle in oracle_totals(record):
        if oracle.unavailable is not None:
            trouble = JunitTrouble("skipped", "unavailable", f"not available: {oracle.unavailable}")
            yield JunitSuite(f"oracles.{oracle.name}", (JunitCase("available", trouble),))
        else:
            yield JunitSuite(
                f"oracles.{oracle.name}", _cases(facts for facts in answers if facts.line.oracle == oracle.name)
            )
    yield JunitSuite("findings", tuple(_findings(record, failed)))
    groups = {id(facts.line): facts for facts in facts_of(record, lines.GroupLine)}
    for implementation in implementations(record):
        mine = _cases(groups[id(group)] for group in implementation.groups)
        yield JunitSuite(f"implementations.{implementation.name}", mine)
    yield JunitSuite("implementations", _cases(facts_of(record, lines.ImplementationLine, lines.NotStartedLine)))
    yield JunitSuite("bench.answers", _cases(accuracy_facts(record)))
    yield JunitSuite(
        "bench.times",
        _cases(_by_type(record, measurements.SpeedLine, measurements.UnmeasuredLine, measurements.RefusedLine)),
    )
    yield JunitSuite("bench.baseline", _cases(facts_of(record, measurements.ComparisonLine)))
    yield JunitSuite("bench.scenes", _cases(_by_type(record, measurements.SceneLine, measurements.ForestLine)))
    yield JunitSuite("bench.kernels", _cases(facts_of(record, measurements.KernelLine)))


def _by_type(record: Record, *kinds: type[RecordLine]) -> Iterator[LineFacts[Any]]:
    """Return an iterator over the facts of these types of lines, one type after the other."""
    return (facts for kind in kinds for facts in facts_of(record, kind))


def _findings(record: Record, failed: list[Failure]) -> Iterator[JunitCase]:
    """Yield a case for each mathematical finding, and one about whether all of them are known."""
    cases = _cases(facts_of(record, lines.FindingLine))
    yield from cases
    drifted = [failure for failure in failed if failure.subject == "findings"]
    if drifted:
        yield JunitCase("known findings", _trouble(drifted))
    elif cases:
        yield JunitCase("known findings", output=("the findings are the known ones",))


def _ended(record: Record, failed: list[Failure], others: int) -> JunitCase:
    """Make the case about the run's end: an error if the run stopped early, or its exit code contradicts its lines.

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
    """Convert seconds to whole milliseconds; a time beyond _LONGEST_MS is cut."""
    return round(min(1000 * seconds, _LONGEST_MS))


TAGS = {"failure": "failures", "error": "errors", "skipped": "skipped"}
"""The elements of cases that did not pass, and the attributes that count them."""


def render(record: Record) -> bytes:
    """Render the test suites as XML 1.0 in UTF-8."""
    suites = [suite for suite in junit_suites(record) if suite.cases]
    root = Xml.Element("testsuites", {"name": "hypcheck", **_attributes(suites)})
    # without its UTC offset, which the schema of most parsers does not allow
    started = escaped(record.header.started)[:19]
    for suite in suites:
        element = Xml.SubElement(root, "testsuite", {"name": escaped(suite.name), **_attributes([suite])})
        element.set("timestamp", started)
        _set_properties(element, record)
        for case in suite.cases:
            element.append(_element(suite, case))
    Xml.indent(root)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _set_properties(element: Xml.Element, record: Record) -> None:
    """Add the settings of the run to a suite: the schema that most parsers use has properties only there."""
    facts = list(settings_facts(record.header.settings))
    if facts:
        properties = Xml.SubElement(element, "properties")
        for fact in facts:
            Xml.SubElement(properties, "property", {"name": "settings", "value": escaped(fact)})


def _attributes(suites: Sequence[JunitSuite]) -> dict[str, str]:
    """Return the attributes of these suites together: the counts and the time."""
    return {
        "tests": str(sum(len(suite.cases) for suite in suites)),
        **{attribute: str(sum(suite.count(tag) for suite in suites)) for tag, attribute in TAGS.items()},
        **_time(total(suite.milliseconds for suite in suites)),
    }


def _element(suite: JunitSuite, case: JunitCase) -> Xml.Element:
    """Make the XML element of a test case."""
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
    """Return the attribute in seconds; none if no time was measured, since 0.000 would be wrong."""
    return {} if milliseconds is None else {"time": f"{milliseconds // 1000}.{milliseconds % 1000:03d}"}
