"""The choice of the kernel: what the environment may force, a missing compiled kernel, and equal answers of all."""

from __future__ import annotations

import platform
import sys
from pathlib import Path

import pytest

from hypcheck.errors import InputError
from tests.support.inside import EXTENSION, LEVELS, KernelChoice, choice, most_threads

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


def test_without_a_compiled_kernel_the_numpy_kernel_is_chosen_and_the_reason_is_stated(fresh):
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


def test_most_threads_is_the_number_set_in_the_environment_and_else_at_least_1(fresh):
    assert most_threads() >= 1
    for number in (7, 1):
        fresh.setenv("HYPCHECK_THREADS", str(number))
        assert most_threads() == number


@pytest.mark.parametrize("wanted", ["0", "-1", "two", "1.5", "٣"])
def test_an_invalid_number_of_threads_in_the_environment_is_refused(fresh, wanted):
    fresh.setenv("HYPCHECK_THREADS", wanted)
    with pytest.raises(InputError, match="it must be a whole number greater than 0, or unset"):
        most_threads()


def test_every_instruction_set_can_be_forced_or_is_refused(fresh):
    """What each answers is asked in tests/test_corpus.py."""
    core = pytest.importorskip("hypcheck.kernel._compiled")
    before, found = core.level(), []
    for level in LEVELS:
        fresh.setenv("HYPCHECK_LEVEL", level)
        choice.cache_clear()
        if core.use_level(level):
            assert choice().level == core.level() == level
            found.append(level)
        else:
            with pytest.raises(InputError, match="but this machine"):
                choice()
    assert len(found) >= 2
    assert core.use_level(before)


def test_the_numpy_kernel_can_be_forced(fresh):
    fresh.setenv("HYPCHECK_KERNEL", "numpy")
    assert (choice().kernel, choice().level) == ("numpy", None)
