"""junit.xml is valid with any names, its numbers add up, and its failures are those of the run.

The goldens of recorded runs show its suites and cases.
"""

from __future__ import annotations

from xml.etree import ElementTree

import pytest
from hypothesis import given, settings

from hypcheck.messages import escaped
from hypcheck.record import read
from hypcheck.report.junit import render
from tests.report import record_samples
from tests.report.record_samples import DISAGREEMENT, DRIFT, EXACT_WRONG, UNPROVED
from tests.tools.goldens import FOLDER, RUNS


def junit(*extra, exit_code=0, body=None):
    return parsed(record_samples.record([*(record_samples.lines() if body is None else body), *extra], exit_code))


def parsed(record):
    return ElementTree.fromstring(render(record))  # noqa: S314 - it was written a moment ago


def names(root):
    return [(each.get("classname"), each.get("name")) for each in root.iter("testcase")]


def milliseconds(element):
    return round(1000 * float(element.get("time", 0)))


@pytest.mark.parametrize("run", [*RUNS, None])
def test_counts_and_times_of_junit_suites_add_up_and_names_are_unique(run):
    """Of recorded runs, and of one that was interrupted at once."""
    root = parsed(read(FOLDER / run)) if run else junit(body=[], exit_code=None)
    for parent in (root, *root):
        cases = list(parent.iter("testcase"))
        assert int(parent.get("tests")) == len(cases) > 0
        for tag, attribute in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            assert int(parent.get(attribute)) == len(list(parent.iter(tag)))
        assert milliseconds(parent) == sum(map(milliseconds, cases))
    assert {child.tag for child in root} == {"testsuite"}
    assert len({suite.get("name") for suite in root}) == len(root)
    assert len(set(names(root))) == len(names(root))


PLACES = (
    "table-2-float32",
    "ring",
    "ring/1/1/7",
    "the ring: Δ = 0 without contact",
    "c2",
    "python-fcl cannot be imported",
    "double-double",
    "the coefficient of λ² lacks − z_c²",
    "contact, tangent: False, None",
    "tangent",
)


@pytest.mark.parametrize("old", PLACES)
@settings(max_examples=25)
@given(foreign=record_samples.FOREIGN)
def test_junit_contains_no_control_character(old, foreign):
    failing = [DISAGREEMENT, UNPROVED, EXACT_WRONG, DRIFT]
    changed = record_samples.rewritten([*record_samples.lines(), *failing], old, foreign)
    content = render(record_samples.record(changed, 6)).decode("utf-8")
    root = ElementTree.fromstring(content)  # noqa: S314
    texts = [content, *(part for element in root.iter() for part in (element.text or "", *element.attrib.values()))]
    assert all(character == "\n" or character.isprintable() for text in texts for character in text)


@given(record_samples.FOREIGN)
def test_junit_keeps_a_foreign_name_in_escaped_form(foreign):
    root = parsed(record_samples.record(record_samples.rewritten(record_samples.lines(), "table-2-float32", foreign)))
    assert escaped(f"implementations.{foreign}") in [suite.get("name") for suite in root]
