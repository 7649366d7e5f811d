"""Code for one pair from routines: tilted positions, clearances and sweeps, held to the labels of the frozen cases."""

from __future__ import annotations

import ctypes
import re
from functools import cache

import numpy as np
import pytest

from tests.kernel.compiling import needs_compiler, shared_library
from tests.kernel.emission.building import COMMAND, built_of, load_module, pointer, skip_without
from tests.kernel.emission.test_arithmetic import CONTROL, SETTINGS, needs_flags
from tests.support.corpus import expected, questions
from tests.support.inside import emitted_pair

UPRIGHT = [0.0, 0.0, 1.0]
LANGUAGES = ["c", *(pytest.param(name, marks=pytest.mark.thorough) for name in ("cpp", "rust"))]


@cache
def with_axes(first: str, second: str):
    """The frozen cases of both sets of groups as rows with an axis, their answers and the cases."""
    upright, tilted = questions(first), questions(second)
    rows = np.vstack([np.hstack([upright.rows, np.tile(UPRIGHT, (len(upright), 1))]), tilted.rows])
    cases = (*upright.cases, *tilted.cases)
    return np.ascontiguousarray(rows), np.array([expected(case) for case in cases]), cases


def loaded(folder, method, language, change=str):
    skip_without(language)
    return ctypes.CDLL(str(built_of(folder, change(emitted_pair(method, language, COMMAND)), language)))


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The code of a method in a language, compiled once."""
    return cache(lambda method, language: loaded(tmp_path_factory.mktemp("kinds"), method, language))


def positions_of(library, rows):
    rows = np.ascontiguousarray(rows)
    found = np.full(len(rows), 99, np.int8)
    library.hypcheck_classify_tilted(ctypes.c_size_t(len(rows)), pointer(rows), pointer(found))
    return found


def sweeps_of(library, rows):
    rows = np.ascontiguousarray(rows)
    found, times = np.full(len(rows), 99, np.int8), np.full(len(rows), 99.0)
    library.hypcheck_passage_tilted(ctypes.c_size_t(len(rows)), pointer(rows), pointer(found), pointer(times))
    return found, times


def numbers_of(library, name, rows):
    """What a function says of each row: a library's, of Rust by a pointer, or a module's."""
    if not isinstance(library, ctypes.CDLL):
        return np.array([getattr(library, name)(*row) for row in rows.tolist()])
    function, one = getattr(library, f"hypcheck_{name}", None), getattr(library, f"hypcheck_{name}_of", None)
    if one is not None:
        one.restype = ctypes.c_double
        return np.array([one(pointer(row)) for row in rows])
    function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * rows.shape[1]
    return np.array([function(*row) for row in rows.tolist()])


@pytest.mark.parametrize("language", [*LANGUAGES, "python"])
def test_bounds_of_emitted_clearance_code_contain_the_clearance_of_each_frozen_case(tmp_path, language):
    rows, _, cases = with_axes("", "axis")
    step = 29 if language == "python" else 9
    rows, true = rows[::step], np.array([float(case["clearance"]) for case in cases[::step]])
    skip_without(language)
    path = built_of(tmp_path, emitted_pair("clearance", language, COMMAND), language)
    library = load_module(path) if language == "python" else ctypes.CDLL(str(path))
    lower, upper = (numbers_of(library, f"clearance_{side}", rows) for side in ("lower", "upper"))
    assert (lower <= np.nextafter(true, np.inf)).all()
    assert (upper >= np.nextafter(true, -np.inf)).all()
    assert np.median((upper - lower) / (1 + np.abs(true))) < 1e-8


@pytest.mark.parametrize("language", LANGUAGES)
def test_emitted_code_for_sweeps_gives_right_hits_and_times_that_are_not_after_the_first_contact(library, language):
    rows, answers, cases = with_axes("end", "end axis")
    found, times = sweeps_of(library("passage", language), rows)
    assert ((found == answers) | (found == 2)).all()
    assert np.isnan(times[found != 1]).all()
    hits = found == 1
    true = np.array([case["first"] for case, hit in zip(cases, hits, strict=True) if hit], dtype=float)
    assert (times[hits] <= true[:, 1]).all()
    assert np.median(true[:, 0] - times[hits]) < 1e-12
    assert np.quantile(true[:, 0] - times[hits], 0.95) < 1e-6


@needs_compiler
@needs_flags
@pytest.mark.parametrize("language", LANGUAGES)
def test_emitted_tilted_code_and_sweeps_are_never_wrong_in_any_arithmetic_that_a_program_may_set(
    tmp_path, library, language
):
    control = shared_library(tmp_path, CONTROL, "-frounding-math", "-std=gnu99")
    tilted, passage = (library(method, language) for method in ("tilted", "passage"))
    rows, positions, _ = (some[::3] for some in with_axes("", "axis"))
    sweeps, hits, cases = (some[::2] for some in with_axes("end", "end axis"))
    last = np.array([case["first"][1] if case["hit"] else np.inf for case in cases], dtype=float)
    for setting in SETTINGS:
        control.set_arithmetic(*setting)
        try:
            found, (hit, times) = positions_of(tilted, rows), sweeps_of(passage, sweeps)
        finally:
            control.set_arithmetic(0, 0)
        assert ((found == positions) | (found == 2)).all(), setting
        assert ((hit == hits) | (hit == 2)).all(), setting
        assert not (times > last).any(), setting
        assert (found == 2).mean() < 0.3
        assert (hit == 2).mean() < 0.3


def test_emitted_tilted_code_with_a_wrong_multiplier_is_never_wrong(tmp_path):
    """The search proves nothing: a multiplier that is off makes the answer 2."""
    rows, positions, _ = with_axes("", "axis")
    line = "const double pole_share = pole * share;"

    def change(text):
        assert text.count(line) == 1
        return text.replace(line, "const double pole_share = 0.75 * pole * share;")

    found = positions_of(loaded(tmp_path, "tilted", "c", change), rows)
    assert ((found == positions) | (found == 2)).all()
    assert 0.3 < (found == 2).mean() < 0.9


@pytest.mark.thorough
def test_emitted_tilted_code_and_sweeps_are_wrong_without_their_bounds(tmp_path):
    """So the frozen cases would show a bound that is left out."""

    def change(text):
        found, count = re.subn(r"(const double u_\w+ = )[^;]+;", r"\g<1>0.0;", text)
        assert count >= 5
        return found

    rows, positions, _ = with_axes("", "axis")
    found = positions_of(loaded(tmp_path, "tilted", "c", change), rows)
    assert 20 < ((found != positions) & (found != 2)).sum()
    sweeps, hits, _ = with_axes("end", "end axis")
    hit, _ = sweeps_of(loaded(tmp_path, "passage", "c", change), sweeps)
    assert 5 < ((hit != hits) & (hit != 2)).sum()
