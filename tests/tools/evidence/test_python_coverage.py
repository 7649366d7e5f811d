"""What coverage leaves is told by function, with the reason that the code or a sentence of ours gives."""

from __future__ import annotations

import json

import pytest

from tests.tools.evidence import python_coverage
from tests.tools.evidence.parts import kept
from tests.tools.evidence.python_coverage import LEFT, UNEXPLAINED, by_function, reasons_of, section

TEXT = """\
import sys


def chosen(values):
    for value in values:
        if value:
            return value
    raise AssertionError("one is always there")


class Reader:
    def read(self, path):
        try:
            return open(path)
        except OSError:
            return None

    def width(self):
        if sys.platform == "win32":
            return 4
        return 8


if __name__ == "__main__":
    chosen([])
"""


@pytest.fixture
def left(monkeypatch, tmp_path):
    (tmp_path / "module.py").write_text(TEXT)
    monkeypatch.setattr(python_coverage, "ROOT", tmp_path)
    return lambda lines, branches: by_function("module.py", lines, branches)


def test_missed_lines_are_reported_by_function_as_ranges(left):
    found = left([5, 6, 7, 14, 21, 25], [])
    assert {name: each["lines"] for name, each in found.items()} == {
        "chosen": "5-7",
        "Reader.read": "14",
        "Reader.width": "21",
        "the module": "25",
    }


@pytest.mark.parametrize(
    ("lines", "branches", "kinds"),
    [
        ([8], [], ["assertion"]),
        ([], [[5, 8]], ["loop"]),
        ([16], [], ["failing system"]),
        ([20], [], ["system"]),
        ([25], [], ["command"]),
        ([6, 8], [], []),
        ([], [[6, 7]], []),
    ],
)
def test_reasons_that_follow_from_the_code_are_found_and_others_are_not(left, lines, branches, kinds):
    assert [each["kinds"] for each in left(lines, branches).values()] == [kinds]


def test_a_branch_of_a_missed_line_is_not_reported_twice(left):
    (found,) = left([8], [[5, 8]]).values()
    assert (found["lines"], found["branches"]) == ("8", [])


def test_a_sentence_of_ours_goes_before_the_reason_of_the_code_and_without_either_none_is_made_up(
    monkeypatch, tmp_path
):
    monkeypatch.setattr(python_coverage, "LEFT", tmp_path / "uncovered.json")
    (tmp_path / "uncovered.json").write_text('{"a.py:f": "it is so"}')
    one = {"lines": "3", "branches": [], "kinds": ["assertion"]}
    figures = {"missing": {"a.py": {"f": one, "g": one, "h": {**one, "kinds": []}}}}
    told = reasons_of(figures)
    assert told["a.py:f"] == "it is so"
    assert told["a.py:g"] == python_coverage.KINDS["assertion"]
    assert told["a.py:h"] == UNEXPLAINED


def test_every_missed_line_has_a_reason_and_no_reason_is_unused():
    figures = kept()["python-coverage"]
    reasons = reasons_of(figures)
    assert [place for place, reason in reasons.items() if reason == UNEXPLAINED] == []
    assert sorted(set(json.loads(LEFT.read_text(encoding="utf-8"))) - set(reasons)) == []
    assert section(figures).count("\n| `hypcheck/") == len(reasons)
