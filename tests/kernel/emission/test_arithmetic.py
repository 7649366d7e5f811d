"""Emitted kernels where the arithmetic is not the usual one: flushed, rounded otherwise, computed by x87, fast-math."""

from __future__ import annotations

import ctypes
import os
import platform
import re
import shutil
import subprocess
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.scene.model import Mover
from hypcheck.scene.reading import read_scene
from hypcheck.vectors import frozen
from tests.kernel.compiling import CLANG, compiled_source, needs_clang, needs_compiler, needs_gcc, shared_library
from tests.kernel.emission.building import COMMAND, COMMANDS, load_module, pointer, skip_without, worst_error
from tests.kernel.emission.test_tilted import SCENES as TILTED
from tests.support import inside
from tests.support.inside import METHODS, emitted, emitted_pair, emitted_whole, plan_of, whole_plan
from tests.support.scenes import scene
from tests.tools.attack.places import near_contact

TOWER = read_scene("tower")

CONTROL = """
#include <fenv.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
static void flush_to_zero(int on) { _mm_setcsr((_mm_getcsr() & ~0x8040u) | (on ? 0x8040u : 0)); }
#else
static void flush_to_zero(int on) {
    uint64_t word;
    __asm__ volatile("mrs %0, fpcr" : "=r"(word));
    word = (word & ~((uint64_t)1 << 24)) | ((uint64_t)(on != 0) << 24);
    __asm__ volatile("msr fpcr, %0" : : "r"(word));
}
#endif
void set_arithmetic(int mode, int flushed) {
    static const int modes[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    fesetround(modes[mode]);
    flush_to_zero(flushed);
}
void ask(int mode, int flushed, void (*classify)(size_t, const double *, int8_t *), size_t n, const double *rows,
         int8_t *positions) {
    set_arithmetic(mode, flushed);
    classify(n, rows, positions);
    set_arithmetic(0, 0);
}
__attribute__((constructor)) static void begin(void) {
    if (getenv("FLUSHED_FROM_THE_START")) flush_to_zero(1);
}
"""
"""Sets flush-to-zero for results and operands, and the rounding mode, as the program that calls a kernel may."""

NEAREST, DIRECTED = 0, (1, 2, 3)
SETTINGS = [(NEAREST, 1), *((mode, flushed) for mode in DIRECTED for flushed in (0, 1))]
NAMES = ["flushed"] + [f"{mode}{flushed}" for mode in ("up", "down", "to-zero") for flushed in ("", "-flushed")]
arithmetic = pytest.mark.parametrize("setting", SETTINGS, ids=NAMES)

needs_flags = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64", "aarch64", "arm64"),
    reason="how this processor flushes is not known",
)

needs_x87 = pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="only x86 has an x87")

REPORTED = [*map(float.fromhex, ("0x1.4p+3", "0x1.8p+3", "0x1.4p+4", "0x1.ffffffffffc00p+1", "0x0.0000004p-1022"))]
REPORTED += [float.fromhex("-0x1.ep+4"), -0.0]
"""An exterior row that the kernels once called contact where subnormal numbers were flushed."""


@pytest.fixture(scope="module")
def rows():
    """Every fifth frozen vector, and rows next to contact, also moved by a subnormal number or with subnormal sizes."""
    near = near_contact(np.random.default_rng(3), 1600)
    near[::5, 4] = float.fromhex("0x0.0000004p-1022")
    near[1::50, 4:] *= 1e-310
    near[2::50] *= 1e-308
    near[3::50, 1::2] *= 1e-309
    near = near[(near[:, :4] > 0).all(axis=1)]
    return np.ascontiguousarray(np.vstack([*(frozen.load(name).rows[::5] for name in frozen.NAMES), near, REPORTED]))


@pytest.fixture(scope="module")
def positions(rows):
    """The labels of the frozen vectors, and exact positions of the others, both found in the usual arithmetic."""
    labels = np.concatenate([frozen.load(name).positions[::5] for name in frozen.NAMES])
    found = np.concatenate([labels, inside.positions(rows[len(labels) :])])
    assert found[-1] == 1
    return found


@pytest.fixture(scope="module")
def control(tmp_path_factory):
    folder = tmp_path_factory.mktemp("control")
    library = shared_library(folder, CONTROL, "-frounding-math", "-std=gnu99")
    library.file = str(folder / "library.so")
    return library


def library(folder, language, text, *options, compiler=None):
    """The library of a kernel, loaded; fails with what the compiler says."""
    skip_without(language)
    path = folder / f"kernel.{ {'c': 'c', 'cpp': 'cpp', 'rust': 'rs'}[language] }"
    path.write_text(text, encoding="utf-8")
    words = [compiler or COMMANDS[language][0], *COMMANDS[language][1:], *options, str(path)]
    made = folder / f"{language}.so"
    done = subprocess.run(
        [*words, *["-lm"][: language == "c"], "-o", made], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return ctypes.CDLL(str(made))


def asked(control, setting, kernel, rows, function="hypcheck_classify"):
    """What the library answers in an arithmetic: the rounding mode, and whether subnormal numbers are flushed."""
    found, rows = np.full(len(rows), 99, np.int8), np.ascontiguousarray(rows)
    classify = ctypes.cast(getattr(kernel, function), ctypes.c_void_p)
    control.ask(*setting, classify, ctypes.c_size_t(len(rows)), pointer(rows), pointer(found))
    return found


COMPILED = ["c", pytest.param("cpp", marks=pytest.mark.thorough), "rust"]  # C++ is of the same templates as C


@pytest.fixture(scope="module")
def pair_kernel(tmp_path_factory):
    """The pair code of a method in a language, compiled once."""

    @cache
    def compiled(method, language):
        return library(tmp_path_factory.mktemp("pair"), language, emitted_pair(method, language, COMMAND))

    return compiled


@needs_compiler
@needs_flags
@pytest.mark.parametrize("language", COMPILED)
def test_emitted_exact_pair_code_is_right_in_every_arithmetic_that_a_program_may_set(
    pair_kernel, control, rows, positions, language
):
    kernel, some = pair_kernel("exact", language), slice(None, None, 1 if language == "c" else 3)
    for setting in [(NEAREST, 0), *SETTINGS]:
        found = asked(control, setting, kernel, rows[some])
        assert np.flatnonzero(found != positions[some]).tolist() == [], setting


@needs_compiler
@needs_flags
@pytest.mark.parametrize("language", COMPILED)
@pytest.mark.parametrize("method", METHODS[1:])
def test_emitted_pair_code_without_an_exact_stage_is_never_wrong_in_any_arithmetic_that_a_program_may_set(
    pair_kernel, control, rows, positions, language, method
):
    kernel = pair_kernel(method, language)
    usual = asked(control, (NEAREST, 0), kernel, rows)
    for setting in SETTINGS:
        found = asked(control, setting, kernel, rows)
        assert ((found == positions) | (found == 2)).all(), setting
        assert (found == 2).mean() < (usual == 2).mean() + 0.01


INVALID = [0.0, -0.0, -1.0, -5e-324, np.nan, np.inf, -np.inf]


@needs_compiler
@needs_flags
@pytest.mark.parametrize("language", COMPILED)
def test_emitted_pair_code_answers_127_to_an_invalid_row_in_every_arithmetic(pair_kernel, control, language):
    """And to no other: a subnormal size is a size."""
    row = [2.0, 5.0, 1.0, 1.0, 3.0, 0.0, 0.0]
    cases = [[*row[:k], bad, *row[k + 1 :]] for k in range(7) for bad in (INVALID if k < 4 else INVALID[4:])]
    cases += [[*row[:k], 5e-324, *row[k + 1 :]] for k in range(7)]
    for method in METHODS:
        kernel = pair_kernel(method, language)
        for setting in SETTINGS:
            found = asked(control, setting, kernel, np.array(cases))
            assert (found[:-7] == 127).all()
            assert (found[-7:] != 127).all()


@needs_compiler
@needs_flags
@pytest.mark.parametrize("method", METHODS)
@arithmetic
def test_emitted_python_pair_code_is_never_wrong_in_any_arithmetic_that_a_library_may_set(
    tmp_path, control, rows, positions, method, setting
):
    """As a library does that is linked with -ffast-math, for the thread that loads it."""
    path = tmp_path / "pair.py"
    path.write_text(emitted_pair(method, "python", COMMAND), encoding="utf-8")
    module, some = load_module(path), np.r_[0 : len(rows) : 5, len(rows) - 1]
    asked_rows = rows[some].tolist()
    control.set_arithmetic(*setting)
    try:
        found = module.classify(asked_rows)
    finally:
        control.set_arithmetic(NEAREST, 0)
    right = np.array(found) == positions[some]
    assert (right if method == "exact" else right | (np.array(found) == 2)).all()


@needs_compiler
@needs_flags
@pytest.mark.skipif(platform.system() != "Linux", reason="a library is loaded into node by LD_PRELOAD")
@pytest.mark.parametrize("method", METHODS)
def test_emitted_javascript_pair_code_is_never_wrong_where_subnormal_numbers_are_flushed(
    tmp_path, control, rows, positions, method
):
    """As an addon of node may set it. The engine itself flushes numbers as it copies them: 2 where one reads as 0."""
    skip_without("javascript")
    path = tmp_path / "pair.mjs"
    path.write_text(emitted_pair(method, "javascript", COMMAND), encoding="utf-8")
    script = tmp_path / "ask.mjs"
    script.write_text(_ASK, encoding="utf-8")
    environment = {**os.environ, "LD_PRELOAD": control.file, "FLUSHED_FROM_THE_START": "1"}
    node = [str(shutil.which("node")), str(script)]
    done = subprocess.run(node, input=rows.tobytes(), capture_output=True, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    flushed, *found = np.frombuffer(done.stdout, np.int8)
    assert flushed == 1
    given, may_be_flushed = np.array(found), (np.abs(rows) < 2.0**-1022).any(axis=1)
    assert ((given == positions) | (given == 2)).all()
    assert (given == positions)[~may_be_flushed].all() or method != "exact"


_ASK = """
import { predicate } from "./pair.mjs";
import { readFileSync } from "node:fs";
const bytes = readFileSync(0);
const rows = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const tiny = new Float64Array([5e-324]);
const flushed = tiny[0] > 0 ? 0 : 1;
const found = new Int8Array(rows.length / 7).map((_, i) => predicate(...rows.subarray(7 * i, 7 * i + 7)));
process.stdout.write(Buffer.concat([Buffer.from([flushed]), Buffer.from(found.buffer)]));
"""


@cache
def every_kind(language):
    """Names and texts of kernels: of pairs by each method, a scene in both formats, a whole one, and a tilted mover."""
    pairs = [(f"pair, {method}", emitted_pair(method, language, COMMAND)) for method in METHODS]
    scenes = [
        (name, emitted(plan_of(chosen, precision), language, COMMAND))
        for name, chosen, precision in (
            ("a scene", TOWER, "float64"),
            ("a scene in float32", TOWER, "float32"),
            ("one axis", TILTED["the tower, one axis"], "float64"),
            ("any axis", TILTED["the tower, any axis"], "float64"),
        )
    ]
    return [*pairs, *scenes, ("a whole scene", emitted_whole(TOWER, whole_plan(TOWER), language, COMMAND))]


VOID = ("-ffast-math", "-Ofast", "-ffinite-math-only", "-Ofast -fno-associative-math -fno-reciprocal-math")
PARTS = (
    "-Ofast -fno-finite-math-only",
    "-funsafe-math-optimizations",
    "-freciprocal-math",
    "-fassociative-math -fno-signed-zeros -fno-trapping-math",
)
SUFFIXES = {"c": ".c", "cpp": ".cpp"}


in_c = pytest.mark.parametrize("language", COMPILED[:2])


@in_c
@pytest.mark.parametrize(
    ("compiler", "option"),
    [
        *(pytest.param(None, option, marks=needs_compiler) for option in VOID),
        *(pytest.param(None, option, marks=needs_gcc) for option in PARTS),
        *(pytest.param(CLANG, option, marks=needs_clang) for option in VOID),
    ],
)
def test_no_emitted_kernel_compiles_with_options_that_void_its_bounds(tmp_path, language, compiler, option):
    complaints = refusals(tmp_path, language, option, compiler)
    for name, _ in every_kind(language):
        assert re.search(f'{name}:.* error: .*"?compile without -f', complaints), (name, complaints)


@needs_gcc
@in_c
def test_no_emitted_kernel_compiles_with_constants_in_single_precision(tmp_path, language):
    complaints = refusals(tmp_path, language, "-fsingle-precision-constant")
    for name, _ in every_kind(language):
        assert re.search(f"{name}:.* error: .*constants_are_double", complaints), (name, complaints)


def refusals(folder, language, option, compiler=None):
    """What the compiler says of all kinds of kernels in one file, each under its own name."""
    text = "\n".join(f'#line 1 "{name}"\n{text}' for name, text in every_kind(language))
    limit = ["-ferror-limit=0"] if compiler else []
    words = ("-fsyntax-only", *limit, *option.split())
    done = compiled_source(folder, text, *words, compiler=compiler, suffix=SUFFIXES[language])
    assert done.returncode != 0
    return done.stderr


@needs_clang
@pytest.mark.skipif(platform.machine() != "x86_64", reason="clang takes options back on x86-64 and on aarch64 alone")
@pytest.mark.parametrize(
    "option", ["-funsafe-math-optimizations", *(pytest.param(part, marks=pytest.mark.thorough) for part in PARTS[2:])]
)
def test_emitted_kernels_undo_options_that_clang_does_not_report(tmp_path, option):
    """No operation carries a flag that lets clang reorder a sum or replace a quotient.

    But a product by a constant that took over a change of sign: alone it can be reordered with nothing.
    """
    for name, text in every_kind("c"):
        (tmp_path / "source.c").write_text(text, encoding="utf-8")
        listing = [str(CLANG), "-O1", *option.split(), "-S", "-emit-llvm", "source.c", "-o", "-"]
        done = subprocess.run(listing, cwd=tmp_path, capture_output=True, text=True, check=True)
        operations = re.findall(r"= (?:fadd|fsub|fmul|fdiv) .*", re.sub("fmul .* 0xBFF0000100000000", "", done.stdout))
        assert len(operations) > 10, name
        assert [line for line in operations if re.search(r"\b(reassoc|arcp|nnan|ninf|fast)\b", line)] == [], name


HARMLESS = (
    "-O3 -ffp-contract=fast -fno-signed-zeros -fno-trapping-math -fno-math-errno",
    pytest.param("-O1 -frounding-math", marks=pytest.mark.thorough),
    pytest.param("-mfpmath=387", marks=[needs_gcc, needs_x87]),
)


@needs_compiler
@needs_flags
@pytest.mark.parametrize("option", HARMLESS)
def test_emitted_exact_pair_code_is_right_with_options_that_change_no_bound(tmp_path, control, rows, positions, option):
    """With x87, whole numbers decide each row."""
    kernel = library(tmp_path, "c", emitted_pair("exact", "c", COMMAND), *option.split())
    for setting in ((NEAREST, 0), *SETTINGS):
        assert (asked(control, setting, kernel, rows[::5]) == positions[::5]).all()


@needs_clang
@needs_flags
@pytest.mark.parametrize(
    "option",
    [
        "-O3 -march=native",
        *(pytest.param(option, marks=pytest.mark.thorough) for option in ("-O2", "-funsafe-math-optimizations")),
    ],
)
def test_emitted_exact_pair_code_that_clang_compiles_is_right_in_every_arithmetic(
    tmp_path, control, rows, positions, option
):
    kernel = library(tmp_path, "c", emitted_pair("exact", "c", COMMAND), *option.split(), compiler=CLANG)
    for setting in ((NEAREST, 0), *SETTINGS):
        assert (asked(control, setting, kernel, rows) == positions).all()


LEAST = {"float64": 1e-288, "float32": 1e-27}
"""About the smallest lengths that a kernel is made for."""


def of_size(length):
    """A tower and its drone, its semi-axis d being so long."""
    return scene(tuple(length / 0.15 * size for size in (2.0, 17.8, 0.25, 0.15)))


@needs_compiler
@needs_flags
@pytest.mark.parametrize("precision", ["float64", "float32"])
@pytest.mark.parametrize("language", COMPILED)
def test_emitted_scene_kernels_are_within_their_bound_where_subnormal_numbers_are_flushed(
    tmp_path, control, language, precision
):
    for length in (0.15, LEAST[precision]) if language == "c" else (LEAST[precision],):
        chosen = of_size(length)
        plan = plan_of(chosen, precision)
        folder = tmp_path / str(length)  # a library is loaded once for each name
        folder.mkdir()
        kernel = library(folder, language, emitted(plan, language, COMMAND))
        worst, count = worst_error(partial(asked, control, (NEAREST, 1), kernel), plan, 14)
        assert count > 50
        assert worst <= plan.bound_u


@pytest.mark.parametrize("precision", LEAST)
@pytest.mark.parametrize("place", [0, 1, 2, 3])
def test_emit_refuses_sizes_that_flushing_to_zero_could_change(precision, place):
    sizes = [LEAST[precision]] * 4
    sizes[place] = 1e-309 if place < 2 else LEAST[precision] / 100
    with pytest.raises(InputError, match=r"no kernel is made for .* a program may flush smaller numbers to zero"):
        plan_of(scene(tuple(sizes)), precision)


def test_emit_refuses_an_axis_with_a_subnormal_number():
    with pytest.raises(InputError, match=r"no kernel is made for .* an axis shorter than 3.1e-151 must"):
        plan_of(replace(TILTED["the tower, one axis"], mover=Mover(0.25, 0.15, axis=(1e-310, 0.0, 2e-310))))


@needs_compiler
@needs_flags
@pytest.mark.parametrize("language", [*COMPILED, pytest.param("python", marks=pytest.mark.thorough)])
def test_emitted_kernels_for_a_tilted_mover_are_never_wrong_where_subnormal_numbers_are_flushed(
    tmp_path, control, language
):
    """A short axis that flushing may turn is refused, and no other one."""
    for name in ("the tower, one axis", "the tower, any axis")[language != "c" :]:
        plan = plan_of(TILTED[name])
        folder = tmp_path / str(plan.free)
        folder.mkdir()
        ask = asking_in(language, folder, control, emitted(plan, language, COMMAND))
        for setting in ((NEAREST, 0), (NEAREST, 1)):
            worst, count = worst_error(partial(ask, setting), plan, 8)
            assert count > 25
            assert worst <= plan.bound_u
    turned = np.random.default_rng(1).normal(size=(400, 3))
    near = turned[:, :2] / np.hypot(*turned[:, :2].T)[:, None] * np.linspace(1.6, 2.4, 400)[:, None]
    rows = np.column_stack([np.tile((2.0, 17.8, 0.25, 0.15), (400, 1)), near, 0.5 * turned[:, 2], turned])
    assert set(inside.positions(rows).tolist()) == {-1, 0, 1}
    for length in (1e300, 1e-100, 1e-200, 1e-300, 1e-308, 1e-310):
        shorter = np.ascontiguousarray(rows * np.where(np.arange(10) < 7, 1.0, length))
        truth = inside.positions(shorter)
        assert (ask((NEAREST, 0), shorter) == truth).all()
        assert (ask((NEAREST, 1), shorter) == (2 if length < 1e-152 else truth)).all()


def asking_in(language, folder, control, text):
    """What answers rows of ten in an arithmetic by a kernel's text, of which there is one in a folder."""
    if language != "python":
        kernel = library(folder, language, text)
        return lambda setting, rows: asked(control, setting, kernel, rows, "hypcheck_classify_tilted")
    path = folder / "kernel.py"
    path.write_text(text, encoding="utf-8")
    module = load_module(path)

    def ask(setting, rows):
        given = rows.tolist()
        control.set_arithmetic(*setting)
        try:
            return np.array(module.classify(given), np.int8)
        finally:
            control.set_arithmetic(NEAREST, 0)

    return ask
