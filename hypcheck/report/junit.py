"""junit.xml: the run's test suites in the dialect that CI systems read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING
from xml.etree import ElementTree as Xml

from hypcheck.record import Record
from hypcheck.report.claims import settings_facts
from hypcheck.report.suite import Case, Suite, total
from hypcheck.report.suites import suites
from hypcheck.visible import visible

if TYPE_CHECKING:
    from hypcheck.report.write import Around

TAGS = {"failure": "failures", "error": "errors", "skipped": "skipped"}
"""The elements that say why a case did not pass, and the attributes that count them."""


def render(record: Record, _around: Around | None = None) -> bytes:
    """The test suites as XML 1.0 in UTF-8."""
    found = [suite for suite in suites(record) if suite.cases]
    root = Xml.Element("testsuites", {"name": "hypcheck", **_attributes(found)})
    # Without its offset: the schema that most parsers go by allows none.
    started = visible(record.header.started)[:19]
    for suite in found:
        element = Xml.SubElement(root, "testsuite", {"name": visible(suite.name), **_attributes([suite])})
        element.set("timestamp", started)
        _set_properties(element, record)
        for case in suite.cases:
            element.append(_element(suite, case))
    Xml.indent(root)
    return bytes(Xml.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _set_properties(element: Xml.Element, record: Record) -> None:
    """The settings of the run, in each suite: the schema that most parsers go by has properties nowhere else."""
    found = list(settings_facts(record.header.settings))
    if found:
        properties = Xml.SubElement(element, "properties")
        for fact in found:
            Xml.SubElement(properties, "property", {"name": "settings", "value": visible(fact)})


def _attributes(found: Sequence[Suite]) -> dict[str, str]:
    return {
        "tests": str(sum(len(suite.cases) for suite in found)),
        **{attribute: str(sum(suite.count(tag) for suite in found)) for tag, attribute in TAGS.items()},
        **_time(total(suite.milliseconds for suite in found)),
    }


def _element(suite: Suite, case: Case) -> Xml.Element:
    names = {"classname": visible(f"hypcheck.{suite.name}"), "name": visible(case.name)}
    element = Xml.Element("testcase", {**names, **_time(case.milliseconds)})
    if case.trouble is not None:
        message = visible(case.trouble.message)
        trouble = Xml.SubElement(element, case.trouble.tag, {"message": message})
        if case.trouble.tag != "skipped":
            trouble.set("type", visible(case.trouble.kind))
            trouble.text = "\n".join([message, *map(visible, case.trouble.details)])
    if case.output:
        Xml.SubElement(element, "system-out").text = "\n".join(map(visible, case.output))
    return element


def _time(milliseconds: int | None) -> dict[str, str]:
    """The attribute in seconds; none where no time was measured, since 0.000 would be a false one."""
    return {} if milliseconds is None else {"time": f"{milliseconds // 1000}.{milliseconds % 1000:03d}"}
