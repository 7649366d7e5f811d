"""C code compiled for a test, with the compiler that the machine has."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import hypcheck.kernel.core

HEADER = Path(hypcheck.kernel.core.__file__).with_name("hypcheck.h")
IMPLEMENTATION = '#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n'

COMPILER = shutil.which(os.environ.get("CC", "cc"))
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")


def _is_clang(compiler: str | None) -> bool:
    """Whatever its name is: on macOS cc and gcc are clang."""
    if compiler is None:
        return False
    done = subprocess.run([compiler, "-dM", "-E", "-x", "c", os.devnull], capture_output=True, text=True, check=False)
    return "__clang__" in done.stdout


needs_gcc = pytest.mark.skipif(COMPILER is None or _is_clang(COMPILER), reason="the C compiler is none, or clang")
CLANG = shutil.which("clang")
needs_clang = pytest.mark.skipif(CLANG is None, reason="there is no clang")

STRICT = ("-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror")


def shared_library(folder: Path, source: str, *options: str, compiler: str | None = None) -> ctypes.CDLL:
    """The library that the C source makes, loaded. Fails the test with what the compiler said."""
    path = folder / "source.c"
    path.write_text(source, encoding="utf-8")
    library = folder / "library.so"
    command = [
        str(compiler or COMPILER),
        *STRICT,
        "-O2",
        "-shared",
        "-fPIC",
        *options,
        str(path),
        "-lm",
        "-o",
        str(library),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return ctypes.CDLL(str(library))


def compiled_source(
    folder: Path, source: str, *options: str, compiler: str | None = None, suffix: str = ".c"
) -> subprocess.CompletedProcess[str]:
    """What the compiler says of the source, without linking; hypcheck.h is found."""
    path = folder / f"source{suffix}"
    path.write_text(source, encoding="utf-8")
    command = [
        str(compiler or COMPILER),
        *options,
        f"-I{HEADER.parent}",
        "-c",
        str(path),
        "-o",
        str(folder / "source.o"),
    ]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def program(folder: Path, source: str, *options: str) -> Path:
    """The program that the C source makes with hypcheck.h. Fails the test with what the compiler said."""
    path, target = folder / "program.c", folder / "program"
    path.write_text(source, encoding="utf-8")
    command = [str(COMPILER), *options, f"-I{HEADER.parent}", str(path), "-o", str(target), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return target
