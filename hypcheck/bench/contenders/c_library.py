"""Compiling the methods in C with the compiler that is found here, and calling them."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from time import perf_counter_ns

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders.c_source import Body, dual, of_formula, source, trigonometric
from hypcheck.bench.contenders.ways import Empty, Prepared
from hypcheck.bench.rounds import Clocked
from hypcheck.bench.workloads import scene_of
from hypcheck.errors import UnavailableError
from hypcheck.methods.method import Answers
from hypcheck.rows import Rows

FLAGS = ("-O3", "-march=native", "-std=c99", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC")
"""Nothing that changes a result: no fast-math, no contraction. The last two let gcc make vectors of comparisons."""

FORMULAS = ("table-2", "coefficients", "hessian", "shared", "local-maximum")
FORMATS = ("float32", "float64")

_SECONDS = 120


@dataclass(frozen=True)
class Compiler:
    """What compiled: the program, the first line it says of its version, and the flags it was given."""

    program: str
    version: str
    flags: tuple[str, ...]


def bodies() -> list[Body]:
    """Every method in C; its place in the table is its place here plus one."""
    listed = [of_formula(name, format_name) for name in FORMULAS for format_name in FORMATS]
    roots = [trigonometric(format_name) for format_name in FORMATS]
    return [*listed, of_formula("table-2", "longdouble"), *roots, *(dual(format_name) for format_name in FORMATS)]


def compiled(folder: Path) -> tuple[Path, Compiler]:
    """The library, made in a folder. Raises UnavailableError where there is no compiler that makes it."""
    code, library = folder / "methods.c", folder / "methods.so"
    code.write_text(source(bodies()), encoding="ascii")
    return library, compile_c(code, library)


def compile_c(code: Path, library: Path) -> Compiler:
    """Make a library of a file in C. Raises UnavailableError where there is no compiler that makes it."""
    program = _program()
    trouble = ""
    for flags in (FLAGS, tuple(flag for flag in FLAGS if flag != "-march=native")):  # not every target has it
        done = _run([program, *flags, "-shared", str(code), "-o", str(library), "-lm"])
        if done.returncode == 0:
            return Compiler(program, _version(program), flags)
        trouble = trouble or (done.stderr.strip().splitlines() or ["it says nothing"])[0]
    raise UnavailableError(f"{program} does not compile {code.name}: {trouble}")


def _program() -> str:
    named = os.environ.get("CC", "")
    for name in (named, "cc", "gcc", "clang"):
        found = shutil.which(name) if name else None
        if found:
            return found
    raise UnavailableError("no C compiler is found (cc, gcc, clang, or what CC names)")


def _run(words: list[str]) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(words, capture_output=True, text=True, timeout=_SECONDS, check=False)  # noqa: S603
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(f"{words[0]} cannot be run: {error}") from None


def _version(program: str) -> str:
    return (_run([program, "--version"]).stdout.splitlines() or [""])[0]


@cache
def _loaded(library: Path) -> ctypes.CDLL:
    loaded = ctypes.CDLL(str(library))
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    loaded.bench_rows.argtypes = loaded.bench_single.argtypes = (size, size, size, pointer, pointer)
    loaded.bench_scene.argtypes = (size, size, pointer, size, pointer, pointer, pointer, pointer)
    for function in (loaded.bench_rows, loaded.bench_single, loaded.bench_scene):
        function.restype = None
    return loaded


@dataclass(frozen=True)
class InC:
    """A method of the library, by its place in the table; place 0 does nothing."""

    library: Path
    place: int

    def answer(self, rows: Rows) -> Answers:
        """Its answers, by the entry for rows."""
        queries = np.ascontiguousarray(rows)
        found = np.empty(len(queries), dtype=np.int8)
        _loaded(self.library).bench_rows(self.place, 1, len(queries), queries.ctypes.data, found.ctypes.data)
        return found

    def batch(self, rows: Rows) -> Prepared:
        """One call, by scene where all rows share their sizes."""
        found = np.zeros(len(rows), dtype=np.int8)
        sizes = scene_of(rows)
        if sizes is None:
            return self._by_rows(np.ascontiguousarray(rows), found, _loaded(self.library).bench_rows)
        parts: list[NDArray[np.float64]] = [np.array(sizes), *np.ascontiguousarray(rows[:, 4:].T)]
        function, fixed = _loaded(self.library).bench_scene, [part.ctypes.data for part in parts]

        def call(repeat: int) -> object:
            held = parts  # the pointers alone would not keep them
            return function(self.place, repeat, fixed[0], len(held[1]), *fixed[1:], found.ctypes.data)

        return _prepared(len(rows), call, found)

    def single(self, rows: Rows) -> Prepared:
        """A call a row, through the same table of functions, in C: what a program in C would wait for."""
        part = np.ascontiguousarray(rows)
        return self._by_rows(part, np.zeros(len(part), dtype=np.int8), _loaded(self.library).bench_single)

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> Empty:
        """A function in C that does nothing."""
        nothing = InC(self.library, 0)
        return Empty("C", nothing.single(rows) if mode == "single" else nothing._by_one(rows))

    def close(self) -> None:
        """The process ends with it."""

    def _by_one(self, rows: Rows) -> Prepared:
        return self._by_rows(
            np.ascontiguousarray(rows[:1]), np.zeros(1, dtype=np.int8), _loaded(self.library).bench_rows
        )

    def _by_rows(self, rows: Rows, found: Answers, function: Callable[..., object]) -> Prepared:
        def call(repeat: int) -> object:
            return function(self.place, repeat, len(rows), rows.ctypes.data, found.ctypes.data)

        return _prepared(len(rows), call, found)


def _prepared(count: int, call: Callable[[int], object], found: Answers) -> Prepared:
    def answers() -> Answers:
        call(1)
        return found

    return Prepared(count, _clocked(call, found), answers)


def _clocked(call: Callable[[int], object], found: Answers) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        found.fill(0)  # so that answers left from before cannot stand for these
        started = perf_counter_ns()
        call(repeat)
        return perf_counter_ns() - started, int(found.sum(dtype=np.int64))

    return run
