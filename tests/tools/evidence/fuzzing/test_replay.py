"""The fuzzer's target: kept inputs and frozen rows are answered as its own oracle says, and a wrong header is found."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from tests.tools.evidence.battery import CORE
from tests.tools.evidence.c_sites import HEADER
from tests.tools.evidence.fuzz import FUZZING, corpus_kept, figures_of, with_earlier
from tests.tools.evidence.seeds import seeds

OPTIONS = ("-std=gnu99", "-O1", "-w", "-frounding-math", "-ffp-contract=off")


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Makes the target with the header of a folder; skips where there is no C compiler, or no GMP."""
    if shutil.which("cc") is None:
        pytest.skip("there is no C compiler")

    def make(core):
        program = tmp_path_factory.mktemp("replay") / "replay"
        command = ["cc", *OPTIONS, f"-I{core}", str(FUZZING / "replay.c"), "-lgmp", "-lm", "-o", str(program)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if "gmp.h: No such file" in done.stderr:
            pytest.skip("there is no gmp.h")
        assert done.returncode == 0, done.stderr
        return program

    return make


def replayed(program, folder, inputs):
    paths = []
    for number, data in enumerate(inputs):
        paths.append(folder / f"{number}")
        paths[-1].write_bytes(data)
    return subprocess.run([program, *paths], capture_output=True, text=True, check=False)


def few_inputs():
    return [*corpus_kept()[::12], *list(seeds(12))[::40]]


@pytest.mark.slow
def test_kernel_answers_kept_fuzz_inputs_and_frozen_rows_as_the_oracle_does(compiled, tmp_path):
    done = replayed(compiled(CORE), tmp_path, few_inputs())
    assert (done.returncode, done.stdout) == (0, "")


@pytest.mark.thorough
def test_fuzz_replay_fails_for_a_header_with_a_wrong_answer(compiled, tmp_path):
    """The second stage calls what is exterior interior too."""
    text, right = HEADER.read_text(encoding="utf-8"), "found.minus |= HC_BITS(interior) << at;"
    assert right in text
    (tmp_path / "hypcheck.h").write_text(text.replace(right, right.replace("interior", "exterior")), encoding="utf-8")
    done = replayed(compiled(tmp_path), tmp_path, list(seeds(4)))
    assert done.returncode != 0
    assert done.stdout.startswith("WRONG: kind ")


def test_figures_of_a_fuzz_run_count_and_name_its_findings():
    log = "stat::number_of_executed_units: 12\nDone 12 runs in 3 second(s)\n"
    assert figures_of("", log) == {"executions": 12, "seconds": 3, "findings": 0, "first": []}
    assert figures_of("WRONG: kind 0\n", log)["first"] == ["WRONG: kind 0"]
    assert figures_of("", "==1==ERROR: AddressSanitizer: x\n")["first"] == ["==1==ERROR: AddressSanitizer: x"]
    assert figures_of("", "")["first"] == ["it ended before its time"]


def test_long_fuzz_runs_add_up_on_one_header_and_begin_anew_on_another():
    first = {"executions": 10, "seconds": 60, "findings": 0, "first": [], "header": "a"}
    second = {"executions": 5, "seconds": 30, "findings": 1, "first": ["WRONG: row"]}
    both = {"executions": 15, "seconds": 90, "findings": 1, "first": ["WRONG: row"], "header": "a"}
    assert with_earlier(second, first, "a") == both
    assert with_earlier(second, first, "b") == {**second, "header": "b"}
