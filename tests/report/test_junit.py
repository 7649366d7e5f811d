"""junit.xml is valid with any names, its numbers add up, and its failures are those of the run."""

from __future__ import annotations

import dataclasses
import re
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings

from hypcheck.messages import escaped
from hypcheck.record.lines import FooterLine
from hypcheck.report.junit import render
from tests.report import record_samples
from tests.report.test_verdict import CRASHED, DISAGREEMENT, DRIFT, EXACT_WRONG, UNPROVED


def junit(*extra, exit_code=0, body=None):
    return parsed(record_samples.record([*(record_samples.lines() if body is None else body), *extra], exit_code))


def parsed(record):
    return ElementTree.fromstring(render(record))  # noqa: S314 - it was written a moment ago


def case(root, suite, name):
    (found,) = [
        each
        for each in root.iterfind("testsuite/testcase")
        if (each.get("classname"), each.get("name")) == (f"hypcheck.{suite}", name)
    ]
    return found


def ended(root, tag):
    return [(each.get("classname"), each.get("name")) for each in root.iterfind(f"testsuite/testcase[{tag}]")]


def milliseconds(element):
    return round(1000 * float(element.get("time", 0)))


@pytest.mark.parametrize(
    "root",
    [
        junit(),
        junit(DISAGREEMENT, UNPROVED, EXACT_WRONG, CRASHED, DRIFT, exit_code=6),
        junit(exit_code=None),
        junit(body=[], exit_code=70),
    ],
)
def test_counts_and_times_of_junit_suites_add_up(root):
    for parent in (root, *root):
        cases = list(parent.iter("testcase"))
        assert int(parent.get("tests")) == len(cases) > 0
        for tag, attribute in (("failure", "failures"), ("error", "errors"), ("skipped", "skipped")):
            assert int(parent.get(attribute)) == len(list(parent.iter(tag)))
        assert milliseconds(parent) == sum(map(milliseconds, cases))
    assert {child.tag for child in root} == {"testsuite"}
    assert len({suite.get("name") for suite in root}) == len(root)


def test_junit_times_are_seconds_to_the_millisecond():
    root = junit()
    assert case(root, "oracles.nearest", "ring").get("time") == "0.250"
    short = junit(body=[record_samples.oracle("exact", "ring", {"proved": 1}, seconds=0.0074)])
    assert case(short, "oracles.exact", "ring").get("time") == "0.007"


def test_junit_has_the_time_of_the_run_once_and_no_time_for_a_case_that_was_not_timed():
    _, record = record_samples.text_and_record(exit_code=0)
    record = dataclasses.replace(record, footer=FooterLine(lines=9, exit_code=0, seconds=12.5))
    root = parsed(record)
    assert root.get("time") == "12.500"
    assert case(root, "run", "ended").get("time") == "11.500"  # the four oracles' 0.25 s have cases of their own
    assert case(root, "implementations.fast", "ring").get("time") is None
    assert junit(body=[], exit_code=None).get("time") is None


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        (record_samples.group("fast", "float64", "tangent", {"right": 30}, exact=True), EXACT_WRONG),
        (record_samples.group("theirs", "float64", "tangent", {"right": 30}), CRASHED),
        (None, DRIFT),
    ],
)
def test_name_of_a_junit_case_does_not_depend_on_its_result(good, bad):
    names = [
        [(each.get("classname"), each.get("name")) for each in junit(*filter(None, [line])).iter("testcase")]
        for line in (good, bad)
    ]
    assert names[0] == names[1]


def test_names_of_junit_cases_are_unique():
    found = [(each.get("classname"), each.get("name")) for each in junit().iter("testcase")]
    assert len(set(found)) == len(found)
    assert ("hypcheck.proofs", "table-2: c2 (2)") in found


def test_junit_timestamp_has_no_utc_offset():
    assert all(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", suite.get("timestamp")) for suite in junit())


def test_junit_counts_wrong_answers_of_the_papers_formulas_as_passed():
    root = junit()
    assert root.get("failures") == root.get("errors") == "0"
    assert "misprint: the coefficient of λ² lacks" in case(root, "equations", "(12)").findtext("system-out")
    wrong = case(root, "implementations.table-2-float32", "ring").findtext("system-out").splitlines()
    assert wrong[0] == "right: 9 of 20 cases"
    assert wrong[wrong.index("wrong: 6 of 20 cases") + 1] == "worst backward error: ∞ u, case ring/1/1/7"
    assert wrong[-1] == "skipped: 1 of 20 cases"
    finding = case(root, "findings", "table-2 on ring")
    assert "the ring: Δ = 0 without contact" in finding.findtext("system-out")


def test_junit_marks_cases_that_were_not_asked_as_skipped():
    assert ended(junit(), "skipped") == [
        ("hypcheck.oracles.mesh", "available"),
        ("hypcheck.implementations.table-2-float64", "tower-body"),
    ]
    undecided = record_samples.oracle("mesh", "tangent", {"undecided": 4}, undecided=4)
    assert ("hypcheck.oracles.mesh", "tangent") in ended(junit(undecided), "skipped")


@pytest.mark.parametrize(
    ("line", "suite", "name", "kind"),
    [
        (DISAGREEMENT, "oracles.nearest", "tangent", "disagreement"),
        (UNPROVED, "proofs", "hessian: delta_3", "unproved"),
        (EXACT_WRONG, "implementations.fast", "tangent", "wrong"),
        (CRASHED, "implementations.theirs", "tangent", "crash"),
        (DRIFT, "findings", "known findings", "drift"),
    ],
)
def test_junit_has_one_failed_case_for_each_failure_of_the_run(line, suite, name, kind):
    root = junit(line, exit_code=1)
    assert ended(root, "failure") == [(f"hypcheck.{suite}", name)]
    assert ended(root, "error") == []
    assert case(root, suite, name).find("failure").get("type") == kind


@pytest.mark.parametrize(("line", "suite"), [(DISAGREEMENT, "oracles.nearest"), (EXACT_WRONG, "implementations.fast")])
def test_junit_gives_the_replay_command_of_a_failed_case(line, suite):
    (failure,) = junit(line, exit_code=1).iter("failure")
    assert line["family"] == "tangent"
    assert "case tangent/1/1/" in failure.text
    assert "replay: hypcheck classify --alpha 1.0 --gamma 2.0 --b 1.0 --d 1.0 --center 2.5 -0.0 0.0" in failure.text


def test_junit_lists_every_recorded_disagreement_of_an_oracle():
    cases = [record_samples.disagreement("roots", f"tangent/1/1/{place}") for place in range(20)]
    line = record_samples.oracle("roots", "tangent", {"signs suffice": 50}, cases=cases, disagreeing=33)
    (failure,) = junit(line, exit_code=6).iter("failure")
    assert failure.get("message").startswith("33 disagreements in 50 cases; first: ")
    assert all(f"case {each['case']}: " in failure.text for each in cases)
    assert "13 further cases, not kept in the record" in failure.text


@pytest.mark.parametrize(
    ("extra", "code", "kind"),
    [
        ((), None, "unfinished"),
        ((), 130, "unfinished"),
        ((UNPROVED,), 70, "unfinished"),
        ((), 6, "unexplained"),
        ((DRIFT,), 0, "unexplained"),
    ],
)
def test_junit_marks_a_run_that_did_not_end_normally_as_an_error(extra, code, kind):
    (error,) = junit(*extra, exit_code=code).iter("error")
    assert error.get("type") == kind
    assert not junit(body=[]).findall("testsuite/testcase/failure")


def test_junit_marks_a_run_that_asked_nothing_as_an_error():
    (error,) = junit(body=[]).iter("error")
    assert error.get("message").startswith("NOTHING")


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
