"""SARIF, GitLab's report and the badge say what failed, and where it stands in the code under test."""

from __future__ import annotations

import hashlib
import json

import msgspec
import pytest
from pydantic_sarif.model import StaticAnalysisResultsFormatSarifVersion210JsonSchema as Sarif

from hypcheck.record import Record, read
from hypcheck.record.lines import CauseLine
from hypcheck.report.code_hosts import UNKNOWN, CodePlace, placed_failures, render_badge, render_gitlab, render_sarif
from hypcheck.report.verdict import failures
from tests.report import record_samples
from tests.report.record_samples import CRASHED, DISAGREEMENT, DRIFT, EXACT_WRONG, UNPROVED
from tests.tools.goldens import FOLDER, RUNS

SEVERITIES = {"info", "minor", "major", "critical", "blocker"}
SOURCE = """import numpy as np


def other(rows):
    return 1


def position(rows):
    return -np.ones(len(rows), np.int8)
"""

FAILING = [DISAGREEMENT, UNPROVED, EXACT_WRONG, CRASHED, DRIFT]


def made(*lines, exit_code=1, files=None):
    record = record_samples.record([*record_samples.lines(), *lines], exit_code)
    if files is None:
        return record
    return Record(msgspec.structs.replace(record.header, files=files), record.lines, record.footer)


def refused(spec):
    """A run whose implementation could not be started."""
    return {"type": "implementation", "spec": spec, "name": "theirs", "started": False, "trouble": "it is not there"}


def place_of(spec, files):
    (found,) = placed_failures(made(refused(spec), exit_code=5, files=files))
    return found.place


@pytest.fixture(params=[*RUNS, None])
def record(request):
    """That of a recorded run, or one that was interrupted."""
    return read(FOLDER / request.param) if request.param else made(exit_code=None)


def test_every_failure_of_a_run_is_a_result_of_valid_sarif(record):
    log = json.loads(render_sarif(record))
    Sarif.model_validate(log)  # made from the published schema; unknown keys are refused
    (run,) = log["runs"]
    messages = [result["message"]["text"] for result in run["results"] if result["level"] != "note"]
    assert len(messages) == len(failures(record)) + (record.footer is None)
    assert len(run["results"]) - len(messages) == len(list(record.of(CauseLine)))
    assert all(any(failure.message in text for text in messages) for failure in failures(record))
    for result in run["results"]:
        assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]


def caused(cause, cases):
    worst = {
        "case": "ring-0000",
        "row": ["0x1.0000000000000p+0"] * 7,
        "truth": 1,
        "answer": 0,
        "mistake": "false-contact",
        "status": "wrong",
    }
    worst |= {"backward_error": 0.25, "backward_error_u": 1e15}
    texts = {"sentence": f"what {cause} does", "remedy": f"what mends {cause}", "claim": ""}
    counts = {"cases": cases, "families": {"ring": cases}, "worst": worst}
    return {"type": "cause", "spec": "library:./mine.so", "method": "mine", "cause": cause, **texts, **counts}


def test_causes_are_rules_of_sarif_by_the_ids_that_explain_takes():
    record = made(CRASHED, caused("ring", 331), caused("unexplained", 7))
    log = json.loads(render_sarif(record))
    Sarif.model_validate(log)
    (run,) = log["runs"]
    rules = {rule["id"]: rule for rule in run["tool"]["driver"]["rules"]}
    assert rules["ring"]["shortDescription"] == {"text": "what ring does"}
    assert rules["ring"]["help"] == {"text": "what mends ring; hypcheck explain ring"}
    assert rules["unexplained"]["help"] == {"text": "what mends unexplained"}
    notes = [result for result in run["results"] if result["level"] == "note"]
    assert [note["ruleId"] for note in notes] == ["ring", "unexplained"]
    assert notes[0]["message"] == {"text": "331 wrong: what ring does; fix: what mends ring"}
    assert list(rules).index("ring") == notes[0]["ruleIndex"]
    assert len({result["partialFingerprints"]["hypcheck/v1"] for result in run["results"]}) == len(run["results"])


def test_causes_of_a_run_that_passed_are_no_results_of_sarif():
    (run,) = json.loads(render_sarif(made(caused("ring", 331), exit_code=0)))["runs"]
    assert run["results"] == []


def test_sarif_validation_of_these_tests_refuses_an_unknown_key():
    log = json.loads(render_sarif(made(*FAILING, exit_code=6)))
    log["runs"][0]["results"][0]["mesage"] = {"text": "misspelt"}
    with pytest.raises(ValueError, match="mesage"):
        Sarif.model_validate(log)


def test_every_failure_of_a_run_is_an_issue_with_the_keys_that_gitlab_reads(record):
    issues = json.loads(render_gitlab(record))
    assert len(issues) == len(failures(record)) + (record.footer is None)
    for issue in issues:
        assert set(issue) == {"description", "check_name", "fingerprint", "severity", "location"}
        assert issue["severity"] in SEVERITIES
        assert issue["location"]["lines"]["begin"] >= 1
        assert issue["location"]["path"]
    assert len({issue["fingerprint"] for issue in issues}) == len(issues)


def test_truncated_run_is_not_shown_as_a_run_without_failures():
    record = made(exit_code=None)
    assert "TRUNCATED" in json.loads(render_gitlab(record))[0]["description"]
    (run,) = json.loads(render_sarif(record))["runs"]
    assert run["results"][0]["ruleId"] == "run/unfinished"
    assert not run["invocations"][0]["executionSuccessful"]


def test_the_fingerprint_of_a_failure_does_not_depend_on_what_else_failed_or_on_its_numbers():
    worse = json.loads(json.dumps(CRASHED).replace('"crash": 2', '"crash": 3'))
    (alone,) = placed_failures(made(CRASHED))
    beside = {each.failure.kind: each for each in placed_failures(made(worse, DRIFT))}
    assert beside["crash"].fingerprint == alone.fingerprint
    assert beside["crash"].message != alone.message


def test_a_python_function_is_placed_at_its_definition(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(SOURCE, encoding="utf-8")
    told = hashlib.sha256(SOURCE.encode()).hexdigest()
    assert place_of("python:mine.py:position", {"mine.py": told}) == CodePlace("mine.py", 8)
    assert place_of("python:./mine.py:position", {"mine.py": told}) == CodePlace("mine.py", 8)
    assert place_of("python:mine:other", {str(tmp_path / "mine.py"): told}) == CodePlace("mine.py", 4)
    assert place_of("python:mine.py:imported", {"mine.py": told}) == CodePlace("mine.py")


def test_changed_python_file_of_an_implementation_is_placed_without_a_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(SOURCE, encoding="utf-8")
    assert place_of("python:mine.py:position", {"mine.py": "0" * 64}) == CodePlace("mine.py")
    assert place_of("python:mine.py:position", {}) == CodePlace("mine.py")


@pytest.mark.parametrize(
    ("spec", "files", "place"),
    [
        ("library:./build/libmine.so", [], CodePlace("build/libmine.so")),
        ("command:python3 adapter.py --fast", ["/usr/bin/python3", "adapter.py"], CodePlace("adapter.py")),
        ("command:./adapter --fast", ["adapter"], CodePlace("adapter")),
        ("command:adapter", ["/usr/bin/adapter"], UNKNOWN),
        ("builtin:table-2-float32", [], UNKNOWN),
        ("what is this?", [], UNKNOWN),
        ("python:pack.mine:f", ["/somewhere/pack/mine.py"], CodePlace("/somewhere/pack/mine.py")),
    ],
)
def test_place_of_returns_the_file_of_an_implementation_or_unknown_if_spec_and_record_do_not_show_it(
    spec, files, place
):
    assert place_of(spec, dict.fromkeys(files, "0" * 64)) == place


def test_a_path_in_sarif_is_a_uri():
    (run,) = json.loads(render_sarif(made(refused("library:my lib#1.so"), exit_code=5)))["runs"]
    location = run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
    assert location == {"uri": "my%20lib%231.so", "uriBaseId": "%SRCROOT%"}


@pytest.mark.parametrize(
    ("lines", "exit_code", "message", "color"),
    [
        ([], 0, "held", "brightgreen"),
        (FAILING, 6, "5 failures", "red"),
        ([], 4, "inconclusive", "yellow"),
        ([], 2, "failed", "red"),
        ([], None, "unfinished", "lightgrey"),
        ([], 130, "unfinished", "lightgrey"),
    ],
)
def test_badge_shows_how_the_run_ended(lines, exit_code, message, color):
    shown = json.loads(render_badge(made(*lines, exit_code=exit_code)))
    assert shown == {"schemaVersion": 1, "label": "hypcheck", "message": message, "color": color}
