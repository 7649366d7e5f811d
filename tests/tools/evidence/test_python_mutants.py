"""Mutants of Python code are small changes of functions that are loaded, and the figures know the code.

The figures are those of the commit on which `make evidence` ran last. What compares them with the present code is
thorough, so that a change of the code does not have to measure for hours.
"""

from __future__ import annotations

import importlib.util
import json
from collections import Counter

import pytest

from tests.tools.evidence.mutations import apply, functions_of, mutations
from tests.tools.evidence.parts import ROOT, kept
from tests.tools.evidence.python_mutants import EXPLAINED, _lot, chosen

SOURCE = '''\
from functools import cache

LIMIT = 3


def within(value: int, least: int = 1) -> bool:
    """Whether it is."""
    if not value > least:
        raise ValueError(f"{value + 1} is too small")
    return least + 1 <= value and value < LIMIT


class Doubling:
    @property
    def two(self):
        return [each * 2 for each, _ in zip((1,), "a", strict=True)]
'''


@pytest.fixture
def module(tmp_path):
    path = tmp_path / "mutated_here.py"
    path.write_text(SOURCE, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("mutated_here", path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def test_every_operator_and_constant_of_a_function_is_changed_and_no_message_default_annotation_or_check_of_lengths():
    found = [(each.line, each.what) for each in mutations("mutated_here.py", SOURCE)]
    assert sorted(found) == [
        (8, "Gt becomes GtE"),
        (8, "Not left out"),
        (10, "1 becomes 2"),
        (10, "Add becomes Sub"),
        (10, "And becomes Or"),
        (10, "Lt becomes LtE"),
        (10, "LtE becomes Lt"),
        (10, "returns None"),
        (16, "1 becomes 2"),
        (16, "2 becomes 3"),
        (16, "Mult becomes Add"),
        (16, "returns None"),
    ]


def test_applied_mutant_changes_the_answers_of_functions_that_are_already_loaded(module):
    changes = {(each.line, each.what): each for each in mutations("mutated_here.py", SOURCE)}
    living = functions_of(module.__file__)
    assert (module.within(2), module.within(3), module.Doubling().two) == (True, False, [2])
    assert apply(changes[10, "Lt becomes LtE"], module.__file__, SOURCE, living)
    assert module.within(3)
    assert apply(changes[16, "Mult becomes Add"], module.__file__, SOURCE, living)
    assert module.Doubling().two == [3]


def test_a_mutant_keeps_its_name_when_code_around_it_is_edited():
    edited = SOURCE.replace('    """Whether it is."""\n', "    value = max(value, 0)\n\n").replace(
        "two(self)", "two(self, of=9)"
    )
    before, after = ([each.key for each in mutations("here.py", text)] for text in (SOURCE, edited))
    assert set(before) < set(after)
    assert len(set(after)) == len(after)
    assert "here.py within: least + 1 <= value → least + 1 < value" in before
    assert "here.py within: least + 1 → least + 2" in before
    assert "here.py Doubling.two: each * 2 → each + 2" in before


def test_equal_mutants_within_one_function_are_numbered():
    found = [each.key for each in mutations("here.py", "def f(x):\n    x = g(x, 0)\n    return g(x, 0)\n")]
    assert "here.py f: g(x, 0) → g(x, 1)" in found
    assert "here.py f: g(x, 0) → g(x, 1) (2)" in found


def test_edit_of_other_code_keeps_the_order_in_which_mutants_are_drawn():
    edited = SOURCE.replace('"""Whether it is."""', "value = abs(value)")
    before, after = ([each.key for each in sorted(mutations("here.py", text), key=_lot)] for text in (SOURCE, edited))
    assert [each for each in after if each in before] == before


def test_mutant_is_tried_on_tests_that_run_few_lines_first_and_at_most_six_of_a_function():
    own = [f"tests/runs/test_score.py::test_a[{n}]" for n in range(8)]
    broad, narrow = "tests/runs/test_tally.py::test_b", "tests/cli/test_score.py::test_c"
    lines = Counter({broad: 900, narrow: 3} | dict.fromkeys(own, 50))
    score = "hypcheck/runs/score.py"
    assert chosen(score, [broad, *own, narrow], 10, 9.0, {}, lines) == [narrow, *own[:6], broad]
    assert chosen(score, [broad, *own, narrow], 3, 9.0, {}, lines) == [narrow, *own[:2]]
    assert chosen(score, [broad, *own, narrow], 9, 9.0, {own[0]: 0.5, broad: 10.0}, lines) == [narrow, *own[1:7]]


def test_mutant_is_tried_on_long_tests_of_its_room_first_and_on_none_that_takes_most_of_the_time():
    took = {"tests/runs/a.py::a": 0.3, "tests/runs/a.py::b": 0.7, "tests/runs/a.py::c": 0.9, "tests/cli/a.py::d": 0.8}
    found = chosen("hypcheck/runs/score.py", took, 10, 2.0, took, Counter(), longest=True)
    assert found == ["tests/runs/a.py::b", "tests/runs/a.py::a", "tests/cli/a.py::d"]


@pytest.mark.thorough
def test_kept_coverage_figures_include_at_least_95_percent_of_the_code():
    """A new file is not measured at once; when they are many, `make evidence` has to be run."""
    known = set(kept()["python-coverage"]["files"])
    omitted = ("adapter.py", "speak.py", "predicate.py")
    files = [path for path in (ROOT / "hypcheck").rglob("*.py") if path.name not in omitted]
    sizes = {str(path.relative_to(ROOT)): path.stat().st_size for path in files}
    unknown = sum(size for name, size in sizes.items() if name not in known)
    assert unknown < 0.05 * sum(sizes.values())


@pytest.mark.thorough
def test_every_explained_python_mutant_is_a_mutant_of_the_present_code():
    explained = json.loads(EXPLAINED.read_text(encoding="utf-8"))
    modules = sorted({key.partition(" ")[0] for key in explained})
    keys = {each.key for module in modules for each in mutations(module, (ROOT / module).read_text(encoding="utf-8"))}
    assert not set(explained) - keys
