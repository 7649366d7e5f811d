"""Shared libraries by their C ABI: answers, scenes, faults, and files that are no library."""

from __future__ import annotations

import ctypes
import os
import platform
import re
import sys
from dataclasses import replace

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.implementations import library as libraries
from hypcheck.implementations.foreign import LoadError
from hypcheck.implementations.frames import CALLS
from hypcheck.implementations.implementation import open_implementation
from hypcheck.implementations.session import Outcome, StartError
from tests.tools.miniatures import LIMITS, compiled, rows, signs, stderr_of

SHARED = ("-shared", "-fPIC")


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    return compiled("right", tmp_path_factory.mktemp("library") / "right.so", *SHARED)


FAULTS = {
    14: (Outcome.PROTOCOL, "answered -86, the value of positions that a library did not write"),
    15: (Outcome.CRASH, "ended by SIGSEGV"),
    16: (Outcome.CRASH, "SIGSEGV; stderr: it reached behind the answers$"),
    17: (Outcome.PROTOCOL, "left the rounding mode changed: upward"),
    18: (Outcome.PROTOCOL, "left the rounding mode changed: downward"),
}


def test_faults_of_a_library_fail_only_their_own_rows_with_the_reason(tmp_path):
    faults = {gamma: fault for gamma, fault in FAULTS.items() if gamma != 18 or platform.machine() == "x86_64"}
    some = rows(lucky=True)
    places = dict(zip(faults, (2, 17, 25, 26, 39), strict=False))
    for gamma, place in places.items():
        some[place, 1] = gamma
    library = compiled("faulty", tmp_path / "faulty.so", *SHARED)
    with open_implementation(f"library:{library}", replace(LIMITS, restarts=20)) as it:
        answered = it.classify(some)
    assert np.flatnonzero(~answered.answered).tolist() == [*places.values()]
    assert answered.answers[answered.answered].tolist() == signs(some)[answered.answered].tolist()
    for gamma, (outcome, sentence) in faults.items():
        assert answered.status[places[gamma]] == outcome
        assert re.search(sentence, answered.reasons[places[gamma]]), answered.reasons


TRACES = {
    100: r"it left changed: flushing results to zero \(FTZ\); a call must leave it as it was",
    101: r"it left changed: denormals are zero \(DAZ\)",
    102: "it left changed: the mask of floating point exceptions",
    103: "it left changed: the handler of SIGUSR1",
    104: "it left changed: the locale, which is '",
    105: "it left changed: the working directory, which is '/' now",
    106: "it left changed: the open descriptors",
    107: "it left changed: .*the files behind the standard descriptors",
    108: "ended by SIGSEGV; stderr: it wrote into the rows, which are read-only$",
    109: "ended by SIGSEGV; stderr: it reached behind the rows$",
    110: "ended by SIGSEGV; stderr: it reached before the answers$",
}


@pytest.mark.skipif(platform.machine() != "x86_64" or sys.platform != "linux", reason="it sets control words of x86")
def test_a_library_call_that_changes_the_state_of_the_process_fails_its_row(tmp_path):
    """Each row is asked alone; those before and after it are answered, and the change is undone or expected."""
    library = compiled("leaves_traces", tmp_path / "traces.so", *SHARED, "-w")
    some = rows(2 * len(TRACES), lucky=True)
    some[::2, 1] = list(TRACES)
    with open_implementation(f"library:{library}", replace(LIMITS, restarts=20)) as it:
        answered = it.classify(some, batch=1)
    assert answered.answered[1::2].all(), answered.reasons
    for place, sentence in enumerate(TRACES.values()):
        assert re.search(sentence, answered.reasons.get(2 * place, "it was answered")), (sentence, answered.reasons)


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are Unicode")
def test_a_library_in_a_folder_whose_name_is_not_utf8_is_loaded_and_what_it_prints_is_kept_as_standard_error(tmp_path):
    folder = tmp_path / os.fsdecode(b"\xff \n")
    folder.mkdir()
    library = compiled("faulty", folder / "faulty.so", *SHARED)  # it exports no description
    with open_implementation(f"library:{library}", LIMITS) as it:
        assert it.classify(rows()).answers.tolist() == signs(rows()).tolist()
        assert stderr_of(it) == ("7 1", "1")
    (folder / "broken.so").write_bytes(b"nothing")
    with pytest.raises(StartError, match="file too short"):
        open_implementation(f"library:{folder / 'broken.so'}", LIMITS)


def test_a_library_answers_batches_of_every_size_and_its_description_is_read(right):
    some = rows(70_000)
    with open_implementation(f"library:{right}", LIMITS) as it:
        assert (it.description.name, it.description.language, it.description.precision) == ("sign", "c", "exact")
        for n, batch in ((70_000, None), (70_000, 70_000), (50, 1), (700, 77)):
            assert it.classify(some[:n], batch=batch).answers.tolist() == signs(some[:n]).tolist()
        assert it.time(some[:1000], 3) > 0
        assert 0 < it.time(some[:1000], 3, row_by_row=True)


@pytest.mark.parametrize("loop", ["in C", "by ctypes"])
def test_timing_row_by_row_calls_a_library_once_per_row_and_an_empty_call_for_no_rows(loop, tmp_path, monkeypatch):
    if loop == "by ctypes":
        monkeypatch.setattr(libraries, "_calls", None)
    counting = libraries.Library(str(compiled("counting", tmp_path / f"{loop[-1]}.so", *SHARED)))
    calls = ctypes.c_long.in_dll(ctypes.CDLL(str(tmp_path / f"{loop[-1]}.so")), "calls_about_one_row")
    some = rows(40)
    took, total = counting.time(some, 25, CALLS[0], row_by_row=True)
    assert took > 0
    assert total == sum(signs(some).tolist())
    assert calls.value == 40 * 25
    assert counting.time(some[:0], 25, CALLS[0], row_by_row=True)[1] == 0
    assert calls.value == 40 * 25


def test_a_library_answers_with_times_and_is_timed_in_one_call(tmp_path):
    """At x0 = 3, −1 and 2 and x1 = −1, −2 and 2 it crosses 0 after three quarters, never and never."""
    library = libraries.Library(str(compiled("passage", tmp_path / "passage.so", *SHARED)))
    with_times = next(call for call in CALLS if call.times and not call.columns)
    some = np.zeros((3, 10))
    some[:, 4], some[:, 7] = (3, -1, 2), (-1, -2, 2)
    given = library.classify(some, with_times)
    assert given.integers.tolist() == [1, 0, 0]
    assert given.times[0] == 0.75
    took, total = library.time(some, 2, with_times, row_by_row=False)
    assert took > 0
    assert total == 1


def test_a_library_gets_the_axis_of_a_tilted_scene(tmp_path):
    """It answers the sign of x and the axis's x together."""
    library = libraries.Library(str(compiled("tilted", tmp_path / "tilted.so", *SHARED)))
    some = np.ones((3, 10))
    some[:, 4] = -3, -0.5, 2
    assert library.classify(some, CALLS[1]).integers.tolist() == [-1, 1, 1]
    some[:, 7] = -1.0
    assert library.classify(some, CALLS[1]).integers.tolist() == [-1, -1, 1]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are Unicode")
def test_the_worker_finds_the_entries_of_a_library_whose_path_is_not_utf8(tmp_path):
    path = compiled("faulty", tmp_path / os.fsdecode(b"\xff.so"), *SHARED)
    library = libraries.Library(str(path))
    assert (library.entries, library.description) == (("hypcheck_classify",), "")
    path.with_name(os.fsdecode(b"\xfe.so")).write_bytes(b"nothing")
    with pytest.raises(LoadError, match="cannot be loaded"):
        libraries.Library(str(path.with_name(os.fsdecode(b"\xfe.so"))))


def test_the_worker_refuses_a_file_that_is_no_library(tmp_path):
    (tmp_path / "short.so").write_bytes(b"nothing")
    silent = compiled("describes_nothing", tmp_path / "silent.so", *SHARED)
    for path, sentence in (
        (tmp_path / "none.so", "there is no file"),
        (tmp_path / "short.so", "cannot be loaded: .*short.so"),
        (silent, "hypcheck_describe returned a null pointer; it must be a JSON text"),
    ):
        with pytest.raises(LoadError, match=sentence):
            libraries.Library(str(path))


def test_a_relative_path_in_a_library_spec_is_relative_to_the_working_directory(right, monkeypatch):
    monkeypatch.chdir(right.parent)
    with open_implementation(f"library:{right.name}", LIMITS) as it:
        assert it.classify(rows()).answered.all()


def test_the_scene_function_of_a_library_is_called_for_rows_of_one_size(right, tmp_path):
    some = rows(2000)
    one = some.copy()
    one[:, :4] = some[0, :4]
    with open_implementation(f"library:{right}", LIMITS) as it:
        assert it.scene
        assert it.classify(one, by_scene=True).answers.tolist() == signs(one).tolist()
        assert it.time(one, 2, by_scene=True) > 0
        with pytest.raises(InputError, match="rows of several sizes"):
            it.classify(some, by_scene=True)
    library = compiled("faulty", tmp_path / "faulty.so", *SHARED)
    with open_implementation(f"library:{library}", LIMITS) as it:
        assert not it.scene
        assert it.description.name == "faulty.so"
        with pytest.raises(InputError, match="has no function for scenes"):
            it.classify(one, by_scene=True)


def test_a_file_that_is_no_library_with_the_needed_functions_is_refused(tmp_path):
    text = tmp_path / "text.so"
    text.write_text("this is a file of text, and longer than the head of a program that a system runs" * 10)
    without = compiled("without_entry", tmp_path / "without.so", *SHARED)
    silent = compiled("describes_nothing", tmp_path / "silent.so", *SHARED)
    for path, sentence in (
        (tmp_path / "none.so", "there is no file"),
        (text, "cannot be loaded: it is not a shared library"),
        (without, r"has no symbol hypcheck_classify; it must export void hypcheck_classify\(size_t n"),
        (silent, "hypcheck_describe returned a null pointer; it must be a JSON text"),
    ):
        with pytest.raises(StartError, match=sentence):
            open_implementation(f"library:{path}", LIMITS)


def test_a_library_compiled_for_another_machine_is_refused(right, tmp_path):
    """The same file with another word size in its head, byte 4 of an ELF file."""
    data = bytearray(right.read_bytes())
    if data[:4] != b"\x7fELF":
        pytest.skip("libraries of this system are not ELF files")
    data[4] = 3 - data[4]  # 32 bits for 64
    foreign = tmp_path / "foreign.so"
    foreign.write_bytes(data)
    with pytest.raises(StartError, match="it is built for another machine"):
        open_implementation(f"library:{foreign}", LIMITS)
