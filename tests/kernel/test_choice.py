"""The choice of the kernel: what the environment may force, a missing compiled kernel, and equal answers of all."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from hypcheck.errors import InputError
from hypcheck.kernel.choice import EXTENSION, LEVELS, KernelChoice, choice, most_threads

CPUINFO = Path("/proc/cpuinfo")


@pytest.fixture
def fresh(monkeypatch):
    """A process that has not chosen yet, in an environment that asks for nothing."""
    for name in ("HYPCHECK_KERNEL", "HYPCHECK_LEVEL", "HYPCHECK_THREADS"):
        monkeypatch.delenv(name, raising=False)
    choice.cache_clear()
    yield monkeypatch
    choice.cache_clear()


WITHOUT = "it was not built at install, which takes a C compiler and Python's headers"


def test_kernel_choice_without_a_compiled_kernel_is_numpy_with_the_reason(fresh):
    fresh.setitem(sys.modules, EXTENSION, None)
    assert choice() == KernelChoice("numpy", None, f"there is no compiled kernel: {WITHOUT}")


def test_forcing_a_missing_kernel_raises_an_input_error(fresh):
    fresh.setitem(sys.modules, EXTENSION, None)
    fresh.setenv("HYPCHECK_KERNEL", "compiled")
    with pytest.raises(InputError, match=f"HYPCHECK_KERNEL is 'compiled', but there is no compiled kernel: {WITHOUT}"):
        choice()


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("HYPCHECK_KERNEL", "numba", "HYPCHECK_KERNEL is 'numba'; it must be compiled or numpy, or unset"),
        (
            "HYPCHECK_LEVEL",
            "avx",
            "HYPCHECK_LEVEL is 'avx'; it must be one of avx512, avx2, sse2, neon, plain, or unset",
        ),
    ],
)
def test_invalid_kernel_environment_variables_raise_an_error_with_valid_values(fresh, name, value, sentence):
    pytest.importorskip("hypcheck.kernel._compiled")
    fresh.setenv(name, value)
    with pytest.raises(InputError, match=sentence):
        choice()


def test_forcing_an_instruction_set_that_this_machine_lacks_is_refused(fresh):
    class Old:
        use_level = staticmethod(lambda name: name == "sse2")
        level = staticmethod(lambda: "sse2")

    fresh.setitem(sys.modules, EXTENSION, Old)
    fresh.setenv("HYPCHECK_LEVEL", "avx512")
    with pytest.raises(InputError, match="'avx512', but this machine or build has no more than sse2"):
        choice()


OF_AVX2 = {"avx2", "fma", "bmi2"}
NEEDS = {"avx512": OF_AVX2 | {"avx512f", "avx512bw", "avx512dq", "avx512vl"}, "avx2": OF_AVX2, "neon": {"neon"}}


@pytest.mark.skipif(platform.machine() != "x86_64" or not CPUINFO.exists(), reason="it is read where Linux tells it")
def test_the_chosen_instruction_set_is_the_best_that_the_processor_has(fresh):
    compiled = pytest.importorskip("hypcheck.kernel._compiled")
    flags = set(next(line for line in CPUINFO.read_text().splitlines() if line.startswith("flags")).split())
    assert choice().level == next((level for level, needed in NEEDS.items() if needed <= flags), "sse2")
    for level in LEVELS:
        assert compiled.use_level(level) == (NEEDS.get(level, set()) <= flags)
    compiled.use_level(choice().level)


def test_most_threads_is_the_number_of_processors_unless_set(fresh):
    assert most_threads() >= 1
    for number in (7, 1):
        fresh.setenv("HYPCHECK_THREADS", str(number))
        assert most_threads() == number


@pytest.mark.parametrize("wanted", ["0", "-1", "two", "1.5", "٣"])
def test_an_invalid_number_of_threads_in_the_environment_is_refused(fresh, wanted):
    fresh.setenv("HYPCHECK_THREADS", wanted)
    with pytest.raises(InputError, match="it must be a whole number greater than 0, or unset"):
        most_threads()


ASK = """
import json, sys, hypcheck
from hypcheck.kernel.choice import choice
rows = [[1, 2, 1, 1, 2.5, 0, 0], [1, 2, 1, 1, 2, 0, 0], [4, 4, 1, 1, 0, 0, 0], [1, 1, 1, 1, 1, 0, 0]] * 700
x, y, z = zip(*(row[4:] for row in rows))
by_row, by_scene = hypcheck.classify(rows).tolist(), hypcheck.classify_scene((4, 9, 1, 2), x, y, z).tolist()
one_by_one = [hypcheck.position(*map(float, row)) for row in rows[:4]]
print(json.dumps([choice().kernel, choice().level, by_row, by_scene, one_by_one]))
"""


@pytest.mark.slow
def test_every_kernel_and_instruction_set_can_be_forced_and_answers_the_same():
    pytest.importorskip("hypcheck.kernel._compiled")
    found = {}
    for kernel, level in [("numpy", ""), *(("compiled", level) for level in LEVELS)]:
        environment = os.environ | {"HYPCHECK_KERNEL": kernel, "HYPCHECK_LEVEL": level}
        done = subprocess.run([sys.executable, "-c", ASK], env=environment, capture_output=True, text=True, check=False)
        if done.returncode and "but this machine" in done.stderr:
            continue
        used, at, *answers = json.loads(done.stdout)
        assert (used, at) == (kernel, level or None)
        found[kernel, level] = answers
    assert len(found) >= 2
    assert len({json.dumps(answers) for answers in found.values()}) == 1
    assert found["numpy", ""][0][:4] == [1, 0, -1, 0]
