"""hypcheck.h on other processors: how answers are asked and judged, what is measured, and the page of results."""

from __future__ import annotations

import dataclasses
import re
from collections import Counter
from pathlib import Path

import click
import numpy as np
import pytest

from hypcheck.geometry.pair import REFUSED
from tests.kernel.compiling import needs_compiler
from tests.tools.processors import __main__ as tool
from tests.tools.processors import builds, jobs, measure, table
from tests.tools.processors.builds import BUILDS, MODES
from tests.tools.processors.jobs import Job, Tally
from tests.tools.processors.measure import Cost

PAGE = Path(__file__).resolve().parents[3] / "docs" / "processors.md"
ROWS = np.array([[1, 2, 1, 1, 2.5, 0, 0], [1, 2, 1, 1, 2.0, 0, 0], [4, 4, 1, 1, 0.0, 0, 0], [0, 4, 1, 1, 0.0, 0, 0]])
RIGHT = np.array([1, 0, -1, REFUSED])
COST = Cost({"one row": 1}, ("memcpy", "__ctzdi2"), (10, 20), (30, 40))


def asked_rows(truth):
    return Job("some", "rows", ROWS, len(ROWS), lambda answers, _: answers != truth, MODES)


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """A program of this machine; without optimisation, since it is asked little."""
    build = dataclasses.replace(BUILDS["here"], flags=("-std=gnu99", "-O0", "-DHYPCHECK_PLAIN"))
    folder = tmp_path_factory.mktemp("here")
    return build, builds.program(build, folder), folder


@pytest.mark.slow
@needs_compiler
def test_kernel_program_answers_frozen_vectors_sweeps_and_clearances_rightly(here):
    build, program, folder = here
    some = jobs.frozen(
        ("tangent", "extreme-subnormal", "tilted-tangent", "way-end", "tilted-way-uniform", "tilted-invalid")
    )
    tally = jobs.ask(build, program, [*some, *jobs.clearances(1, 400, ("uniform",))], "plain", folder)
    assert tally.rows == []
    assert set(tally.asked) == {"frozen", "frozen ways", "clearances"}
    assert tally.asked["frozen"] > 2000


@needs_compiler
def test_answer_that_differs_from_the_truth_is_counted_as_wrong_in_each_rounding_mode(here):
    build, program, folder = here
    assert jobs.ask(build, program, [asked_rows(RIGHT)], "plain", folder).wrong["some"] == 0
    tally = jobs.ask(build, program, [asked_rows(-RIGHT)], "plain", folder)
    assert (tally.asked["some"], tally.wrong["some"]) == (16, 12)
    assert tally.rows[0].startswith("rows, to nearest: 0x1.0000000000000p+0 0x1.0000000000000p+1 ")


@needs_compiler
def test_missing_instruction_level_of_a_program_raises_an_error_that_names_the_build(here):
    build, program, folder = here
    with pytest.raises(builds.BuildError, match="here: the program ended with 3"):
        jobs.ask(build, program, [asked_rows(RIGHT)], "neon", folder)


def test_numbers_for_a_big_endian_processor_are_written_in_its_order():
    job = Job("some", "rows", ROWS[:1], 1, lambda answers, _: answers != 0)
    little, big = (jobs._encoded(BUILDS[name], job, "to nearest", "plain") for name in ("here", "s390x"))
    assert big[12:16] == b"\0\0\0\1" == little[15:11:-1]
    assert big[16:24] == little[23:15:-1] == bytes.fromhex("3ff0000000000000")


GRAPH = """graph: { title: "a.c"
node: { title: "hypcheck_ask" label: "hypcheck_ask\\na.c:1:1\\n100 bytes (static)" }
node: { title: "a.c:hc_exact" label: "hc_exact\\na.c:2:1\\n1000 bytes (dynamic,bounded)" }
node: { title: "a.c:hc_certified_plain" label: "hc_certified_plain\\na.c:3:1\\n50 bytes (static)" }
node: { title: "memset" label: "__builtin_memset\\n<built-in>" shape : ellipse }
edge: { sourcename: "hypcheck_ask" targetname: "__indirect_call" }
edge: { sourcename: "hypcheck_ask" targetname: "a.c:hc_exact" }
edge: { sourcename: "a.c:hc_exact" targetname: "memset" }
"""


def test_stack_of_a_call_is_the_sum_of_frames_along_the_deepest_chain_of_calls():
    frames = measure.call_graph(GRAPH)
    assert measure.deepest(frames, ("hypcheck_ask",)) == 1100
    longer = measure.call_graph(GRAPH.replace("50 bytes", "5000 bytes"))
    assert measure.deepest(longer, ("hypcheck_ask",)) == 5100  # by a pointer


def test_stack_has_no_bound_with_a_frame_of_unknown_size_or_a_recursive_function():
    with pytest.raises(ValueError, match=r"the frame of a\.c:hc_exact is dynamic"):
        measure.call_graph(GRAPH.replace("(dynamic,bounded)", "(dynamic)"))
    itself = GRAPH + 'edge: { sourcename: "a.c:hc_exact" targetname: "hypcheck_ask" }\n'
    with pytest.raises(ValueError, match="calls itself"):
        measure.deepest(measure.call_graph(itself), ("hypcheck_ask",))


def test_kernel_object_with_heap_libm_or_too_much_stack_is_a_fault():
    assert COST.foreign == COST.too_deep == []
    upright, leaning = measure.stated()
    worse = Cost({}, ("malloc", "memcpy", "sqrt"), (upright + 1, 0), (0, leaning + 1))
    faults = table.Result(BUILDS["here"], {}, worse).faults
    assert [fault.split(": ")[1] for fault in faults] == [
        "the object asks for malloc",
        "the object asks for sqrt",
        f"upright rows take {upright + 1} bytes of stack; hypcheck.h says {upright}",
        f"leaning rows take {leaning + 1} bytes of stack; hypcheck.h says {leaning}",
    ]


def test_missing_packages_for_other_processors_are_named_in_one_sentence(monkeypatch):
    monkeypatch.setattr(builds.shutil, "which", lambda _: None)
    with pytest.raises(click.UsageError) as error:
        tool.require([BUILDS["s390x"], BUILDS["i686"]], install=False)
    assert "s390x, i686 cannot be built or run here; as root: apt-get install" in error.value.message
    assert "gcc-s390x-linux-gnu libc6-dev-s390x-cross qemu-user gcc-i686-linux-gnu" in error.value.message


def test_new_line_of_a_processor_replaces_the_old_one_on_the_page():
    result = table.Result(BUILDS["here"], {"plain": Tally(Counter({"some": 4}), Counter(), [])}, COST)
    page = table.changed("text\n<!-- processors -->\n<!-- end of processors -->\nmore\n", result)
    assert page.splitlines()[4].startswith("| here: this machine | `cc ")
    assert page.endswith("<!-- end of processors -->\nmore\n")
    other = dataclasses.replace(result, build=dataclasses.replace(BUILDS["here"], title="that machine"))
    assert table.changed(page, other) == page.replace("this machine", "that machine")


def test_page_of_processors_has_every_processor_and_no_wrong_answer():
    lines = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if re.match(r"\| \w\S+: ", line)]
    cells = [line.split(" | ") for line in lines]
    assert {line[0][2:].partition(":")[0] for line in cells} == set(BUILDS)
    assert {line[3] for line in cells} == {"0"}
    assert all(int(line[2].replace(",", "")) > 50_000 for line in cells)


@pytest.mark.thorough
@pytest.mark.parametrize("name", [name for name in BUILDS if name != "here"])
def test_kernel_built_for_another_processor_answers_the_frozen_vectors_rightly(name, tmp_path):
    build = BUILDS[name]
    if build.missing:
        pytest.skip(f"there is no {' and no '.join(build.missing)}")
    program = builds.program(build, tmp_path)
    for level in build.levels:
        tally = jobs.ask(build, program, [*jobs.frozen(), *jobs.clearances(1, 200)], level, tmp_path)
        assert tally.rows == []
