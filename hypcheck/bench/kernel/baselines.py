"""What the compiled kernel is measured against in C: the plain formula, and reading the rows and nothing else.

Both are compiled when they are needed, for the instruction set that the kernel runs on. The plain formula is Table 2 as
the programs print it, what sizes alone decide before the loop, contraction allowed; it answers whether the pair is
exterior, no more, and certifies nothing. It is compiled for each width of vectors, and the fastest is taken.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders.c_library import compiler_here, run_compiler
from hypcheck.bench.contenders.c_source import of_formula
from hypcheck.bench.rounds import Clocked, clocked
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.errors import UnavailableError
from hypcheck.kernel.choice import compiled
from hypcheck.kernel.compiled_path import in_parts
from hypcheck.pairs import SIZES

FLAGS = ("-O3", "-std=c99", "-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-fPIC")

LEVEL_FLAGS = {
    "avx512": (("-march=native", "-mprefer-vector-width=512"), ("-march=native", "-mprefer-vector-width=256")),
    "avx2": (("-mavx2", "-mfma", "-mbmi2"),),
    "sse2": ((),),
    "plain": ((),),
}

Floats = NDArray[np.float64]

_HEAD = """\
#include <math.h>
#include <stddef.h>
#include <stdint.h>

uint64_t read_only(size_t n, const uint64_t *restrict x, const uint64_t *restrict y, const uint64_t *restrict z)
{
    uint64_t mixed = 0;
    for (size_t i = 0; i < n; i++)
        mixed ^= x[i] ^ y[i] ^ z[i];
    return mixed;
}

typedef size_t (*kernel)(int, const double *, size_t, const double *, const double *, const double *, int8_t *);

void over_and_over(kernel ask, size_t times, const double *sizes, size_t n, const double *x, const double *y,
                   const double *z, int8_t *out)
{
    while (times--)
        ask(0, sizes, n, x, y, z, out);
}

void plain(const double *restrict sizes, size_t n, const double *restrict xs, const double *restrict ys,
           const double *restrict zs, int8_t *restrict out)
{
"""


@dataclass(frozen=True)
class Baseline:
    """A library, and the flags that made it."""

    library: ctypes.CDLL
    flags: tuple[str, ...]

    def read_only(self, x: Floats, y: Floats, z: Floats) -> Clocked:
        """Reading the columns, one thread."""
        function, pointers = self.library.read_only, [column.ctypes.data for column in (x, y, z)]
        function.restype, function.argtypes = ctypes.c_uint64, (ctypes.c_size_t, *[ctypes.c_void_p] * 3)
        return _clocked(lambda: int(function(len(x), *pointers)) & 0xFFFF)

    def read_by_the_clock(self, x: Floats, y: Floats, z: Floats, threads: int) -> Clocked:
        """The same shared among threads as the kernel shares its rows, by the clock on the wall."""
        function = self.library.read_only
        function.restype, function.argtypes = ctypes.c_uint64, (ctypes.c_size_t, *[ctypes.c_void_p] * 3)

        def part(start: int, stop: int) -> int:
            return int(function(stop - start, *(column[start:].ctypes.data for column in (x, y, z)))) & 0xFFFF

        return clocked(lambda: np.array([in_parts(part, len(x), threads)]))

    def over_and_over(self, sizes: Floats, x: Floats, y: Floats, z: Floats, out: NDArray[np.int8], times: int) -> None:
        """The compiled kernel `times` times, in one call during which other threads of Python run."""
        ask = ctypes.CDLL(str(compiled().__file__)).hypcheck_ask_scene
        function = self.library.over_and_over
        function.restype = None
        function.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_void_p] * 4)
        pointers = [column.ctypes.data for column in (x, y, z, out)]
        function(ctypes.cast(ask, ctypes.c_void_p), times, sizes.ctypes.data, len(x), *pointers)

    def plain(self, sizes: Floats, x: Floats, y: Floats, z: Floats, out: NDArray[np.int8]) -> Clocked:
        """The plain formula, one thread; the sum is of its answers."""
        function = self.library.plain
        function.restype = None
        function.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_void_p] * 4)
        pointers = [column.ctypes.data for column in (x, y, z, out)]
        return _clocked(lambda: function(sizes.ctypes.data, len(x), *pointers), lambda: int(np.count_nonzero(out)))


def baselines(folder: Path, level: str) -> list[Baseline]:
    """One for each width of vectors that the level has. Raises UnavailableError where there is no compiler."""
    program, code = compiler_here(), folder / "baselines.c"
    code.write_text(source(), encoding="ascii")
    found = []
    for number, flags in enumerate(LEVEL_FLAGS[level]):
        library = folder / f"baselines-{number}.so"
        done = run_compiler([program, *FLAGS, *flags, "-shared", str(code), "-o", str(library), "-lm"])
        if done.returncode == 0:
            found.append(Baseline(ctypes.CDLL(str(library)), flags))
    if not found:
        raise UnavailableError(f"{program} does not compile the baselines in C")
    return found


def source() -> str:
    """The C of both."""
    body = of_formula(FORMULAS["table-2"], "float64")
    sizes = "".join(f"    const double {name} = sizes[{place}];\n" for place, name in enumerate(SIZES))
    centre = "".join(f"        const double {name} = {name}s[i];\n" for name in ("x", "y", "z"))
    before = "".join(f"    {line}\n" for line in body.before)
    inside = "".join(f"        {line}\n" for line in body.inside)
    loop = (
        f"    for (size_t i = 0; i < n; i++) {{\n{centre}{inside}        out[i] = (int8_t){body.answer};\n    }}\n}}\n"
    )
    return _HEAD + sizes + before + loop


def _clocked(call: Callable[[], object], checksum: Callable[[], int] | None = None) -> Clocked:
    def run(repeat: int) -> tuple[int, int]:
        result: object = 0
        started = thread_time_ns()
        for _ in range(repeat):
            result = call()
        took = thread_time_ns() - started
        return took, checksum() if checksum is not None else int(result)  # type: ignore[call-overload]

    return run
