"""Compilers accept hypcheck.h without warnings, and it refuses the options that void its proofs."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from tests.kernel.compiling import (
    CLANG,
    COMPILER,
    HEADER,
    IMPLEMENTATION,
    compiled_source,
    needs_clang,
    needs_compiler,
    needs_gcc,
)

WARNINGS = ("-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror")
COMPILERS = pytest.mark.parametrize(
    "compiler", [pytest.param(None, marks=needs_compiler), pytest.param(CLANG, marks=needs_clang)], ids=["cc", "clang"]
)
CPP_COMPILERS = [
    pytest.param(shutil.which(name), marks=pytest.mark.skipif(shutil.which(name) is None, reason=f"there is no {name}"))
    for name in ("g++", "clang++")
]


@COMPILERS
@pytest.mark.parametrize("options", [(), ("-DHYPCHECK_PLAIN", "-DHYPCHECK_SMALL_LIMBS")], ids=["levels", "plain"])
def test_the_header_compiles_as_c99_without_warnings(options, compiler, tmp_path):
    done = compiled_source(tmp_path, IMPLEMENTATION, "-std=c99", "-O1", *WARNINGS, *options, compiler=compiler)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("compiler", CPP_COMPILERS, ids=["g++", "clang++"])
@pytest.mark.parametrize("source", ['#include "hypcheck.h"\n', IMPLEMENTATION], ids=["declarations", "implementation"])
def test_the_header_compiles_as_cpp_without_warnings(source, compiler, tmp_path):
    options = ("-std=c++11", "-fsyntax-only", "-Wall", "-Wextra", "-pedantic", "-Werror")
    done = compiled_source(tmp_path, source, *options, compiler=compiler, suffix=".cpp")
    assert (done.returncode, done.stderr) == (0, "")


WHOLE = ("-ffast-math", "-Ofast", "-ffinite-math-only")
PARTS = ("-funsafe-math-optimizations", "-fassociative-math -fno-signed-zeros -fno-trapping-math", "-freciprocal-math")


@pytest.mark.parametrize(
    ("compiler", "option"),
    [
        *(pytest.param(None, option, marks=needs_compiler) for option in WHOLE),
        *(pytest.param(None, option, marks=needs_gcc) for option in PARTS),
        *(pytest.param(CLANG, option, marks=needs_clang) for option in WHOLE),
    ],
)
def test_the_header_does_not_compile_with_options_that_void_the_proofs(option, compiler, tmp_path):
    done = compiled_source(tmp_path, IMPLEMENTATION, "-fsyntax-only", *option.split(), compiler=compiler)
    assert done.returncode != 0
    assert "error: " in done.stderr
    assert "hypcheck: compile without" in done.stderr
    declared = compiled_source(tmp_path, '#include "hypcheck.h"\n', "-O1", *option.split(), compiler=compiler)
    assert declared.returncode == 0  # files that only call may be compiled as they like


@needs_gcc
def test_the_header_does_not_compile_with_constants_in_single_precision(tmp_path):
    done = compiled_source(tmp_path, IMPLEMENTATION, "-fsyntax-only", "-fsingle-precision-constant")
    assert done.returncode != 0
    assert "hc_constants_are_double" in done.stderr


@needs_clang
@pytest.mark.parametrize("option", PARTS)
def test_the_header_undoes_options_that_clang_does_not_report(option, tmp_path):
    """No operation carries a flag that lets clang reorder a sum or replace a quotient."""
    (tmp_path / "source.c").write_text(IMPLEMENTATION, encoding="utf-8")
    listing = [CLANG, "-O1", *option.split(), f"-I{HEADER.parent}", "-S", "-emit-llvm", "source.c", "-o", "-"]
    done = subprocess.run(listing, cwd=tmp_path, capture_output=True, text=True, check=True)
    operations = re.findall(r"= (?:fadd|fsub|fmul|fdiv) .*", done.stdout)
    assert len(operations) > 1000
    assert [line for line in operations if re.search(r"\b(reassoc|arcp|nnan|ninf|fast)\b", line)] == []


@needs_compiler
def test_the_header_compiles_under_another_file_name_with_its_macro(tmp_path):
    text = HEADER.read_text(encoding="utf-8")
    (tmp_path / "renamed.h").write_text(text, encoding="utf-8")
    source = '#define HYPCHECK_IMPLEMENTATION\n#define HYPCHECK_SELF "renamed.h"\n#include "renamed.h"\n'
    assert compiled_source(tmp_path, source, "-fsyntax-only").returncode == 0


@needs_compiler
@pytest.mark.parametrize(
    "beside", [None, "", "edition"], ids=["alone", "beside-another-file", "beside-another-edition"]
)
def test_a_renamed_header_without_its_macro_ends_in_one_clear_error(beside, tmp_path):
    text = HEADER.read_text(encoding="utf-8")
    (tmp_path / "renamed.h").write_text(text, encoding="utf-8")
    if beside is not None:
        other = text.replace("HC_EDITION_", "HC_EDITION_other_") if beside else "typedef int something_else;\n"
        (tmp_path / "hypcheck.h").write_text(other, encoding="utf-8")
    (tmp_path / "source.c").write_text('#define HYPCHECK_IMPLEMENTATION\n#include "renamed.h"\n', encoding="utf-8")
    command = [str(COMPILER), "-std=c99", "-fsyntax-only", "source.c"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    (error,) = re.findall(r"error: .*", done.stderr)
    assert "HYPCHECK_SELF does not name this file" in error
