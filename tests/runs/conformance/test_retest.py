"""The retest finds errors that a single batch in one order and of one size does not show."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine, ImplementationLine
from hypcheck.runs.retest import FULL_QUESTION
from tests.kernel.compiling import needs_compiler, shared_library
from tests.runs import faulty
from tests.support.inside import HEADER

pytestmark = pytest.mark.usefixtures("text_reports")


@pytest.fixture
def gate(tmp_path, built_in):
    def verified(name, *options):
        """A function without a process of its own remembers as well what it was asked."""
        spec = name if ":" in name else built_in(getattr(faulty, name))
        code = main(["verify", spec, "--families", "tower-body", "--out", str(tmp_path), *options])
        return code, read(tmp_path)

    return verified


def counts(record):
    return {line.family: line.counts for line in record.of(GroupLine)}


def test_retest_finds_answers_that_depend_on_the_previous_moment_of_a_flight(gate):
    code, record = gate("carries_over", "--families", "flight")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "nondeterministic"}
    assert "when asked again, in another order and batch" in line.faults[0].reason
    assert gate("carries_over", "--families", "flight", "--count", "0")[0] == 0  # nothing moves


@pytest.mark.parametrize(
    ("name", "code"),
    [("python:tests.runs.faulty:loses_the_second_thread", 1), ("slowly_loses_the_second_thread", 0)],
)
def test_retest_sends_the_largest_proven_batch(gate, name, code):
    busy = ("--count", "4000", "--timeout", "60")  # enough to grow, though the machine be busy
    ended, record = gate(name, *(busy if code else ("--count", "1")))
    assert ended == code
    assert counts(record)["tower-body"].get("nondeterministic", 0) == record.of(ImplementationLine)[0].retest.beyond
    assert FULL_QUESTION > 4096


@pytest.mark.parametrize("name", ["forgets_what_comes_again", "forgets_twins"])
def test_a_small_run_retests_rows_too(gate, monkeypatch, name):
    monkeypatch.setattr(faulty, "_seen", set())
    code, record = gate(name, "--count", "40")
    assert code == 1
    assert record.of(GroupLine)[0].counts["nondeterministic"] > 0


def test_one_case_in_a_hundred_of_a_large_family_is_retested(gate):
    code, record = gate("builtin:fast", "--families", "tower-body,ring", "--count", "20000")
    assert code == 0
    (line,) = record.of(ImplementationLine)
    asked = sum(each.asked for each in record.of(GroupLine))
    assert asked / 100 < line.retest.asked < asked / 50
    assert line.retest.within == line.retest.beyond == 0


@pytest.mark.thorough
def test_answer_that_changes_within_the_tolerance_fails_only_with_deterministic(gate):
    families = ("--families", "tangent,tower-body")
    code, record = gate("forgets_a_little", *families)
    assert record.of(ImplementationLine)[0].retest.within > 0
    assert set(counts(record)["tangent"]) == {"right", "tolerated"}
    assert code == 0
    assert gate("forgets_a_little", *families, "--deterministic")[0] == 1


def test_fault_during_the_retest_is_recorded_with_its_reason(gate):
    code, record = gate("python:tests.runs.faulty:raises_when_asked_alone", "--count", "40")
    assert code == 1
    (line,) = record.of(GroupLine)
    assert set(line.counts) == {"right", "error"}
    assert line.faults[0].reason.startswith("when asked again: it raised ValueError: one is not enough")


SCENE_CALLS = "many(n, x, y, z, positions);"


@needs_compiler
@pytest.mark.parametrize(
    ("instead", "code"),
    [
        (SCENE_CALLS, 0),
        (f"{SCENE_CALLS} for (size_t i = 0; i < n; i++) positions[i] = 0;", 1),
        (f"{SCENE_CALLS} if (n > 8) positions[n - 1] = !positions[n - 1];", 1),
        (f"{SCENE_CALLS} for (size_t i = 0; i < n; i++) if (z[i] > 5 && z[i] < 7) positions[i] = 0;", 1),
        (f"if (n < 100) {SCENE_CALLS}", 1),
        (f"{SCENE_CALLS} if (n > 1000) positions[1000] = !positions[1000];", 1),
        (f"{SCENE_CALLS} if (n > 4096) positions[4096] = 0;", 1),
    ],
)
def test_function_for_scenes_must_answer_as_the_function_for_rows_does(tmp_path, instead, code):
    """The kernel of a scene, in whose code the loop over the centres is changed."""
    assert main(["emit", "--scene", "tower", "--language", "c", "--output", str(tmp_path / "kernel.c")]) == 0
    text = (tmp_path / "kernel.c").read_text(encoding="utf-8")
    assert text.count(SCENE_CALLS) == 1
    shared_library(tmp_path, text.replace(SCENE_CALLS, f"{{ {instead} }}"))
    spec = f"library:{tmp_path / 'library.so'}"
    words = ["--families", "tower-body,tower-rotors", "--count", "300", "--out", str(tmp_path / "out")]
    assert main(["verify", spec, *words]) == code
    reasons = [fault.reason for line in read(tmp_path / "out").of(GroupLine) for fault in line.faults]
    assert {"when its function for scenes is asked" in reason for reason in reasons} == ({True} if code else set())


TILTED_LIBRARY = """
#define HYPCHECK_IMPLEMENTATION
#define hypcheck_classify_tilted_scene right
#include "hypcheck.h"
#undef hypcheck_classify_tilted_scene
const char *hypcheck_describe(void) {{ return "{{\\"tilt\\": true}}"; }}
void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions)
{{
    right(sizes, axis, n, x, y, z, positions);
    {then}
}}
"""


@needs_compiler
@pytest.mark.parametrize(("then", "code"), [("", 0), ("if (axis[0] > axis[1]) positions[0] = 0;", 1)])
def test_function_for_tilted_scenes_is_called_though_hardly_two_rows_share_an_axis(tmp_path, then, code):
    shared_library(tmp_path, TILTED_LIBRARY.format(then=then), f"-I{HEADER.parent}")
    words = ["--families", "tilted-uniform,tilted-stiff", "--count", "100", "--out", str(tmp_path / "out")]
    assert main(["verify", f"library:{tmp_path / 'library.so'}", *words]) == code
