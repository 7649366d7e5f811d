"""Compiling the methods in C with the compiler of this machine, and calling them."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from time import perf_counter_ns

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.c_source import FAST, CBody, Ready, dual, of_formula, source, trigonometric
from hypcheck.bench.contender import EmptyCall, PreparedWork
from hypcheck.bench.timing import Clocked
from hypcheck.bench.workloads import scene_of
from hypcheck.derivation.formulas import FORMULAS, REPAIRED
from hypcheck.errors import UnavailableError
from hypcheck.geometry.rows import Rows
from hypcheck.implementations.method import RECIPROCAL, Answers
from hypcheck.implementations.procedures import CRAFT, MOVING, CraftPath
from hypcheck.kernel import core

FLAGS = ("-O3", "-march=native", "-std=c99", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC")
"""No flag changes a result: no fast-math, no contraction. The last two let gcc vectorise comparisons."""

LISTED = ("table-2", "coefficients", "hessian", "shared", "local-maximum")
FORMATS = ("float32", "float64")

_SECONDS = 120


@dataclass(frozen=True)
class Compiler:
    """The compiler: the program, the first line of its version, and its flags."""

    program: str
    version: str
    flags: tuple[str, ...]


KERNEL_FLAGS = ("-O3", "-ffp-contract=fast", "-fPIC")
"""The flags of the package's own build (setup.py): the kernel selects its instruction set at run time, and its bounds
allow FMA."""


@cache
def bodies() -> tuple[CBody | Ready, ...]:
    """Every method in C; its place in the driver's table is its place here plus one."""
    listed = [of_formula(FORMULAS[name], format_name) for name in LISTED for format_name in FORMATS]
    roots = [trigonometric(format_name) for format_name in FORMATS]
    others = [of_formula(FORMULAS["table-2"], "longdouble"), of_formula(RECIPROCAL, "float64")]
    others.append(of_formula(REPAIRED["procedure-1-repaired"], "float64"))
    duals = [dual(format_name) for format_name in FORMATS]
    return (FAST, *listed, *others, *roots, *duals)


def place_of(name: str) -> int:
    """A method's place in the table. Raises ValueError if it has none."""
    return [each.name for each in bodies()].index(name) + 1


def compiled(folder: Path) -> tuple[Path, Compiler]:
    """The library, made in a folder. Raises UnavailableError if no compiler can make it."""
    code, methods, library = folder / "methods.c", folder / "methods.o", folder / "methods.so"
    code.write_text(source(bodies()), encoding="ascii")
    with ThreadPoolExecutor(1) as beside:
        kernel = beside.submit(_kernel, folder)
        compiler = compile_c(code, methods, "-c")
    done = run_compiler([compiler.program, "-shared", str(methods), kernel.result(), "-o", str(library), "-lm"])
    if done.returncode != 0:
        raise UnavailableError(f"{compiler.program} does not link {library.name}: {_first_line(done)}")
    return library, compiler


def compile_c(code: Path, target: Path, how: str = "-shared") -> Compiler:
    """Compile a C file to a library, or as `how` says. Raises UnavailableError without a compiler."""
    program = compiler_here()
    trouble = ""
    for flags in (FLAGS, tuple(flag for flag in FLAGS if flag != "-march=native")):  # not every target has this flag
        words = [program, *flags, f"-I{core.__path__[0]}", how, str(code), "-o", str(target), "-lm"]
        done = run_compiler(words)
        if done.returncode == 0:
            return Compiler(program, _version(program), flags)
        trouble = trouble or _first_line(done)
    raise UnavailableError(f"{program} does not compile {code.name}: {trouble}")


def _kernel(folder: Path) -> str:
    """The object file of the fast path."""
    program, code, target = compiler_here(), folder / "fast.c", folder / "fast.o"
    code.write_text('#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n', encoding="ascii")
    done = run_compiler([program, *KERNEL_FLAGS, f"-I{core.__path__[0]}", "-c", str(code), "-o", str(target)])
    if done.returncode != 0:
        raise UnavailableError(f"{program} does not compile the fast path: {_first_line(done)}")
    return str(target)


def compiler_here() -> str:
    """The C compiler of this machine. Raises UnavailableError if there is none."""
    named = os.environ.get("CC", "")
    for name in (named, "cc", "gcc", "clang"):
        found = shutil.which(name) if name else None
        if found:
            return found
    raise UnavailableError("no C compiler is found (cc, gcc, clang, or what CC names)")


def run_compiler(words: list[str]) -> subprocess.CompletedProcess[str]:
    """Run the compiler. Raises UnavailableError if it cannot be run, or does not end."""
    try:
        return subprocess.run(words, capture_output=True, text=True, timeout=_SECONDS, check=False)  # noqa: S603
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(f"{words[0]} cannot be run: {error}") from None


def _first_line(done: subprocess.CompletedProcess[str]) -> str:
    return (done.stderr.strip().splitlines() or ["it says nothing"])[0]


def _version(program: str) -> str:
    return (run_compiler([program, "--version"]).stdout.splitlines() or [""])[0]


@cache
def _loaded(library: Path) -> ctypes.CDLL:
    loaded = ctypes.CDLL(str(library))
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    loaded.bench_rows.argtypes = loaded.bench_single.argtypes = (size, size, size, pointer, pointer)
    loaded.bench_scene.argtypes = (size, size, pointer, size, pointer, pointer, pointer, pointer)
    loaded.bench_bodies.argtypes = (size, size, pointer, size, *[pointer] * 6)
    for function in (loaded.bench_rows, loaded.bench_single, loaded.bench_scene, loaded.bench_bodies):
        function.restype = None
    return loaded


@dataclass(frozen=True)
class InC:
    """A method of the library, by its place in the table; place 0 does nothing."""

    library: Path
    place: int
    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """The method's answers, by the entry for rows."""
        queries = np.ascontiguousarray(rows)
        found = np.empty(len(queries), dtype=np.int8)
        _loaded(self.library).bench_rows(self.place, 1, len(queries), queries.ctypes.data, found.ctypes.data)
        return found

    def batch(self, rows: Rows) -> PreparedWork:
        """One call, by scene if all rows share their sizes."""
        found = np.zeros(len(rows), dtype=np.int8)
        sizes = scene_of(rows)
        if sizes is None:
            return self._by_rows(np.ascontiguousarray(rows), found, _loaded(self.library).bench_rows)
        parts: list[NDArray[np.float64]] = [np.array(sizes), *np.ascontiguousarray(rows[:, 4:].T)]
        function, fixed = _loaded(self.library).bench_scene, [part.ctypes.data for part in parts]

        def call(repeat: int) -> object:
            held = parts  # pointers alone would not keep them alive
            return function(self.place, repeat, fixed[0], len(held[1]), *fixed[1:], found.ctypes.data)

        return _prepared(len(rows), call, found)

    def single(self, rows: Rows) -> PreparedWork:
        """A call for each row, in C through the table of functions: the time that a program in C would wait."""
        part = np.ascontiguousarray(rows)
        return self._by_rows(part, np.zeros(len(part), dtype=np.int8), _loaded(self.library).bench_single)

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> EmptyCall:
        """A function in C that does nothing."""
        nothing = InC(self.library, 0)
        return EmptyCall("C", nothing.single(rows) if mode == "single" else nothing._by_one(rows))

    def close(self) -> None:
        """Do nothing: the library lives as long as the process."""

    def _by_one(self, rows: Rows) -> PreparedWork:
        return self._by_rows(
            np.ascontiguousarray(rows[:1]), np.zeros(1, dtype=np.int8), _loaded(self.library).bench_rows
        )

    def _by_rows(self, rows: Rows, found: Answers, function: Callable[..., object]) -> PreparedWork:
        def call(repeat: int) -> object:
            return function(self.place, repeat, len(rows), rows.ctypes.data, found.ctypes.data)

        return _prepared(len(rows), call, found)


def bodies_asked(library: Path, place: int, flight: CraftPath) -> PreparedWork:
    """One of the quadcopter's procedures, by its place in NAMES, for each position of a flight."""
    craft = np.array([flight.craft[name] for name in CRAFT])
    columns = [np.ascontiguousarray(flight.columns[name]) for name in MOVING]
    found = np.zeros(len(flight), dtype=np.int8)

    def call(repeat: int) -> object:
        moving = [column.ctypes.data for column in columns]
        return _loaded(library).bench_bodies(place, repeat, craft.ctypes.data, len(found), *moving, found.ctypes.data)

    return _prepared(len(found), call, found)


def _prepared(count: int, call: Callable[[int], object], found: Answers) -> PreparedWork:
    def answers() -> Answers:
        call(1)
        return found

    return PreparedWork(count, _clocked(call, found), answers)


def _clocked(call: Callable[[int], object], found: Answers) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        found.fill(0)  # so that answers of an earlier call cannot count for these
        started = perf_counter_ns()
        call(repeat)
        return perf_counter_ns() - started, int(found.sum(dtype=np.int64))

    return run
