"""A marked test of a user's own pytest fails where `hypcheck verify` does, with the worst case and its replay."""

from __future__ import annotations

import re

import pytest

from hypcheck.cli import pytest_plugin
from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine
from hypcheck.report.messages import error_text
from hypcheck.report.verdict import failures

pytest_plugins = ["pytester"]

MINE = """
import hypcheck


def exact(rows):
    return hypcheck.classify(rows)


def clears_contacts(rows):
    found = hypcheck.classify(rows)
    return found + (found == 0)
"""

SUITE = """
import pytest

FEW = {"families": ["ring", "tangent*"], "count": 0, "isolate": "off"}


@pytest.mark.hypcheck("python:mine.py:exact", **FEW)
def test_right():
    print("its body ran")


@pytest.mark.hypcheck("python:mine.py:clears_contacts", **FEW)
def test_wrong():
    print("its body ran")


@pytest.mark.hypcheck()
def test_without_spec(): ...


@pytest.mark.hypcheck("python:mine.py:exact", tolerence=3)
def test_misspelt(): ...


def test_without_marker(): ...
"""


def test_a_marked_test_fails_where_verify_fails_and_shows_the_replay_command(pytester):
    pytester.makepyfile(mine=MINE, test_mine=SUITE)
    result = pytester.runpytest_subprocess("-rP", "--strict-markers")
    result.assert_outcomes(passed=2, failed=3)
    text = result.stdout.str()
    assert text.count("its body ran") == 1
    (replay,) = [line for line in text.splitlines() if line.startswith("replay: ")]
    assert replay.startswith("replay: hypcheck replay tangent")
    assert re.search(r" python:mine\.py:clears_contacts( --isolate=off)?$", replay)
    assert "hypcheck: FAILED with exit code 1: " in text
    assert "no implementation is named" in text
    assert "there is no option '--tolerence'; did you mean --tolerance?" in text


def test_a_failed_marked_test_shows_the_case_with_the_greatest_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(MINE, encoding="utf-8")
    options = "--families tangent*,near* --count 0 --isolate off --out out"
    assert main(["verify", "python:mine.py:clears_contacts", *options.split()]) == 1
    record = read(tmp_path / "out")
    worst = pytest_plugin._worst(record, failures(record))
    cases = [case for group in record.of(GroupLine) for case in group.worst]
    assert error_text(max(cases, key=lambda case: float(case.backward_error_u))) in worst.message


def test_a_failure_named_in_the_verdict_and_shown_by_no_command_takes_one_line(tmp_path):
    said = pytest_plugin.gate(("python:nowhere.py:f",), {"families": "ring", "count": 0, "isolate": "off"}, tmp_path)
    assert said == (
        "hypcheck: FAILED with exit code 5: python:nowhere.py:f could not be started: there is no file 'nowhere.py'."
    )


KINDS = """
import unittest
import pytest

WRONG = pytest.mark.hypcheck("python:mine.py:clears_contacts", families="tangent*", count=0, isolate="off")


@WRONG
class TestOfUnittest(unittest.TestCase):
    def test_method(self): ...


class TestMethods(unittest.TestCase):
    @WRONG
    def test_marked(self): ...

    def test_without_marker(self): ...


@WRONG
class TestAsync(unittest.IsolatedAsyncioTestCase):
    async def test_method(self): ...


@WRONG
class TestPlain:
    def test_method(self): ...


@WRONG
async def test_coroutine(): ...
"""


def test_the_marker_gates_tests_of_unittest_and_coroutines_too(pytester):
    """None of these passes, and none is skipped, beside a wrong implementation."""
    pytester.makepyfile(mine=MINE, test_kinds=KINDS)
    result = pytester.runpytest_subprocess("-rP", "--strict-markers")
    result.assert_outcomes(passed=1, failed=5)
    assert result.stdout.str().count("hypcheck: FAILED with exit code 1: ") == 5


REFUSED = {
    '"python:mine.py:exact", help=True': "has help=True, which prints help and gates nothing",
    '"python:mine.py:exact", update=True': "has update=True, which rewrites the list of known failures and",
    '"--help"': "has '--help' as SPEC; an option is written as a keyword: tolerance=16",
    "7": "has 7 as SPEC; it must be a text such as 'python:mine.py:position'",
}


@pytest.mark.parametrize("arguments", REFUSED)
def test_marker_that_would_gate_nothing_is_refused_when_tests_are_collected(arguments, pytester):
    pytester.makepyfile(
        mine=MINE, test_mine=f"import pytest\n\n@pytest.mark.hypcheck({arguments})\ndef test_it(): ...\n"
    )
    result = pytester.runpytest_subprocess()
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    said = " ".join((result.stdout.str() + result.stderr.str()).split())
    assert f"ERROR: test_mine.py::test_it: the marker hypcheck {REFUSED[arguments]}" in said


def test_arguments_of_the_pytest_marker_become_options_of_verify():
    options = {"max_abstained": 3, "deterministic": True, "fail_on": None, "families": ("a", "b*")}
    assert list(pytest_plugin._words(options)) == ["--max-abstained=3", "--deterministic", "--families=a,b*"]
