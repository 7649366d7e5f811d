"""Targets of the compiled kernel: against memory bandwidth, the plain formula in C, two threads, and the worst rows.

Each is a ratio to a ceiling that is measured in the same rounds. The rows are columns of one scene, the paper's cooling
tower. The plain formula, and a loop that only reads the rows, are compiled when they are needed, for the instruction
set of the kernel. The plain formula is Table 2 as the programs print it, with what depends on sizes alone before
the loop, and contraction allowed. It only answers whether the pair is exterior, and certifies nothing. It is compiled
for each width of vectors, and the fastest counts.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.accuracy import forget_peak, peak
from hypcheck.bench.c_library import compiler_here, run_compiler
from hypcheck.bench.c_source import of_formula
from hypcheck.bench.timing import (
    Clocked,
    KernelTarget,
    Samples,
    TimingEntry,
    clocked,
    measured_samples,
    rate_text,
    thread_clocked,
    times_as_fast,
    times_as_long,
)
from hypcheck.derivation.formulas import FORMULAS
from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import SIZES, Sizes
from hypcheck.geometry.rows import Columns, Floats, Positions, Rows
from hypcheck.kernel.choice import choice, compiled
from hypcheck.kernel.compiled_kernel import fill_scene, in_parts
from hypcheck.record.measurements import KernelLine
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.random_pairs import beside_surface
from hypcheck.vectors.scenes import BODY, TOWER

TOWER_SIZES: Sizes = (*TOWER, *BODY)
SEED = 1
DISTINCT = 1_000_000
"""The number of different rows. A longer array repeats them, because to draw ten million takes longer than to measure
them."""


def uniform_columns(count: int) -> Columns:
    """Centres uniform in the box |x|, |y| ≤ 4 m, |z| ≤ 17.8 m about the tower (the workload "uniform")."""
    rows = FAMILIES["tower-body"].rows(SEED, min(count, DISTINCT))
    x, y, z = (np.resize(column, count) for column in rows[:, 4:].T)
    return x, y, z


def touching_columns(count: int) -> Columns:
    """Centres within about 1e-15 radii of contact, on both sides of the wall and all over it."""
    random = np.random.Generator(np.random.PCG64(SEED))
    alpha, gamma, b, d = TOWER_SIZES
    ratios = np.full(count, alpha / b), np.full(count, gamma / d)
    height = random.random(count) * gamma / d
    side = np.where(random.random(count) < 0.5, -1.0, 1.0) * (1 + (2 * random.random(count) - 1) * 1e-15)
    radius, level = beside_surface(*ratios, height, side)
    turn = 2 * np.pi * random.random(count)
    return radius * b * np.cos(turn), radius * b * np.sin(turn), level * d


FLAGS = ("-O3", "-std=c99", "-ffp-contract=fast", "-fno-math-errno", "-fno-trapping-math", "-fPIC")

LEVEL_FLAGS = {
    "avx512": (("-march=native", "-mprefer-vector-width=512"), ("-march=native", "-mprefer-vector-width=256")),
    "avx2": (("-mavx2", "-mfma", "-mbmi2"),),
    "sse2": ((),),
    "neon": ((),),
    "plain": ((),),
}


WORDS = 40
"""32-bit words of the integers whose product measures exact decisions. 1280 bits have room for the discriminant of a
row: it is of degree 24 in numbers of 53 bits that are alike in magnitude."""

_HEAD = (
    f"""\
#define WORDS {WORDS}
"""
    """\
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

uint64_t read_only(size_t n, const uint64_t *restrict x, const uint64_t *restrict y, const uint64_t *restrict z)
{
    uint64_t mixed = 0;
    for (size_t i = 0; i < n; i++)
        mixed ^= x[i] ^ y[i] ^ z[i];
    return mixed;
}

void read_over_and_over(size_t times, size_t n, const uint64_t *x, const uint64_t *y, const uint64_t *z)
{
    static volatile uint64_t seen;
    while (times--)
        seen = read_only(n, x, y, z);
}

/* The lower half of what two integers of WORDS words multiply to, column by column, over and over. */
uint32_t products(size_t times, const uint32_t *left, const uint32_t *right)
{
    uint32_t result[WORDS], sum = 0;
    while (times--) {
        memset(result, 0, sizeof result);
        for (size_t i = 0; i < WORDS; i++) {
            uint64_t carry = 0;
            for (size_t k = 0; i + k < WORDS; k++) {
                carry += (uint64_t)(left[i] ^ (uint32_t)times) * right[k] + result[i + k];
                result[i + k] = (uint32_t)carry;
                carry >>= 32;
            }
        }
        sum ^= result[WORDS - 1];
    }
    return sum;
}

typedef size_t (*by_rows)(int, size_t, const double *, int8_t *);

void rows_over_and_over(by_rows ask, size_t times, size_t n, const double *rows, int8_t *out)
{
    while (times--)
        ask(0, n, rows, out);
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
)


@dataclass(frozen=True)
class CBaseline:
    """A compiled library, and its flags."""

    library: ctypes.CDLL
    flags: tuple[str, ...]

    def read_only(self, x: Floats, y: Floats, z: Floats) -> Clocked:
        """Read the columns, in one thread."""
        function, pointers = self.library.read_only, [column.ctypes.data for column in (x, y, z)]
        function.restype, function.argtypes = ctypes.c_uint64, (ctypes.c_size_t, *[ctypes.c_void_p] * 3)
        return _clocked(lambda: int(function(len(x), *pointers)) & 0xFFFF)

    def read_by_the_clock(self, x: Floats, y: Floats, z: Floats, threads: int) -> Clocked:
        """Read the columns in threads that share them as the kernel does, by the wall clock."""
        function = self.library.read_only
        function.restype, function.argtypes = ctypes.c_uint64, (ctypes.c_size_t, *[ctypes.c_void_p] * 3)

        def part(start: int, stop: int) -> int:
            return int(function(stop - start, *(column[start:].ctypes.data for column in (x, y, z)))) & 0xFFFF

        return clocked(lambda: np.array([in_parts(part, len(x), threads)]))

    def product(self) -> Clocked:
        """Multiply two long integers, half of the product: what exact decisions are made of."""
        function = self.library.products
        function.restype, function.argtypes = ctypes.c_uint32, (ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p)
        numbers = np.random.Generator(np.random.PCG64(SEED)).integers(1 << 31, 1 << 32, (2, WORDS), dtype=np.uint32)

        def run(repeat: int) -> tuple[int, int]:
            started = thread_time_ns()
            function(repeat, numbers[0].ctypes.data, numbers[1].ctypes.data)
            return thread_time_ns() - started, 0

        return run

    def reading(self, x: Floats, y: Floats, z: Floats) -> Callable[[int], None]:
        """Reads the columns so many times in one call, during which other Python threads can run."""
        function = self.library.read_over_and_over
        function.restype, function.argtypes = None, (ctypes.c_size_t, ctypes.c_size_t, *[ctypes.c_void_p] * 3)
        pointers = [column.ctypes.data for column in (x, y, z)]
        return lambda times: function(times, len(x), *pointers)

    def of_rows(self, rows: Rows, out: NDArray[np.int8]) -> Callable[[int], None]:
        """Asks the compiled kernel about rows so many times in one call."""
        ask = ctypes.cast(ctypes.CDLL(str(compiled().__file__)).hypcheck_ask, ctypes.c_void_p)
        function = self.library.rows_over_and_over
        function.restype = None
        function.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_size_t, *[ctypes.c_void_p] * 2)
        pointers = [rows.ctypes.data, out.ctypes.data]
        return lambda times: function(ask, times, len(rows), *pointers)

    def of_scene(self, sizes: Floats, x: Floats, y: Floats, z: Floats, out: NDArray[np.int8]) -> Callable[[int], None]:
        """Asks the compiled kernel so many times in one call, during which other Python threads can run."""
        ask = ctypes.cast(ctypes.CDLL(str(compiled().__file__)).hypcheck_ask_scene, ctypes.c_void_p)
        function = self.library.over_and_over
        function.restype = None
        function.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_void_p] * 4)
        pointers = [column.ctypes.data for column in (x, y, z, out)]
        return lambda times: function(ask, times, sizes.ctypes.data, len(x), *pointers)

    def plain(self, sizes: Floats, x: Floats, y: Floats, z: Floats, out: NDArray[np.int8]) -> Clocked:
        """The plain formula in one thread; the sum is that of its answers."""
        function = self.library.plain
        function.restype = None
        function.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *[ctypes.c_void_p] * 4)
        pointers = [column.ctypes.data for column in (x, y, z, out)]
        return _clocked(lambda: function(sizes.ctypes.data, len(x), *pointers), lambda: int(np.count_nonzero(out)))


def c_baselines(folder: Path, level: str) -> list[CBaseline]:
    """One library for each width of vectors of the level. Raises UnavailableError if there is no compiler."""
    program, code = compiler_here(), folder / "baselines.c"
    code.write_text(baseline_source(), encoding="ascii")
    found = []
    for number, flags in enumerate(LEVEL_FLAGS[level]):
        library = folder / f"baselines-{number}.so"
        done = run_compiler([program, *FLAGS, *flags, "-shared", str(code), "-o", str(library), "-lm"])
        if done.returncode == 0:
            found.append(CBaseline(ctypes.CDLL(str(library)), flags))
    if not found:
        raise UnavailableError(f"{program} does not compile the baselines in C")
    return found


def baseline_source() -> str:
    """The C source of both."""
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


MANY, CACHED, WORST = 10_000_000, 100_000, 20_000
AGAIN = 200
PART, PARTS, LEAST_PARTS = 1_000_000, 8, 100

CEILING = KernelTarget("memory speed", "certified, one thread, of the speed of reading the rows; 1e7 rows", 0.75)
PLAIN = KernelTarget(
    "plain C, from memory", "certified, one thread, of the speed of the plain formula in C; 1e7 rows", 0.95
)
IN_CACHE = KernelTarget(
    "plain C, in cache", "certified, one thread, of the speed of the plain formula in C; 1e5 rows", 0.6
)
THREADS = KernelTarget("two threads", "what two threads gain, of what reading the rows gains from two; 1e7 rows", 0.95)
CACHED_THREADS = KernelTarget(
    "two threads, in cache",
    "what two threads gain, of what reading the rows gains from two; 1e5 rows each, over and over",
    0.95,
)
TOUCHING = KernelTarget(
    "near contact", f"a row within 1e-15 of contact, in products of integers of {32 * WORDS} bits", 0.6, at_most=True
)
STREAMED = KernelTarget(
    "streamed",
    "a row in streams of 1e7 to 1e9 rows, the dearest, to one in streams of 1e6, both beside reading it",
    1.15,
    at_most=True,
)


def from_memory(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Ten million rows: reading them, the plain formula, and the kernel on one thread and on two."""
    columns, out = uniform_columns(MANY), np.zeros(MANY, dtype=np.int8)
    libraries = c_baselines(folder, str(choice().level))
    entries = [
        TimingEntry("read", MANY, libraries[0].read_only(*columns)),
        *_plain(libraries, columns, out),
        TimingEntry("one", MANY, thread_clocked(lambda: _answered(columns, out))),
        TimingEntry("one by the clock", MANY, clocked(lambda: _answered(columns, out))),
        TimingEntry("two by the clock", MANY, clocked(lambda: _answered(columns, out, threads=2))),
        TimingEntry("read by the clock", MANY, libraries[0].read_by_the_clock(*columns, threads=1)),
        TimingEntry("read on two by the clock", MANY, libraries[0].read_by_the_clock(*columns, threads=2)),
    ]
    found = measured_samples(entries, rounds)
    one, plain = found["one"], _fastest(found)
    level = choice().level
    beside = f"{rate_text(one)} on {level}"
    yield CEILING.line(
        times_as_fast(one, found["read"]), f"{beside}; reading x, y and z alone: {rate_text(found['read'])}"
    )
    yield PLAIN.line(times_as_fast(one, plain), f"{beside}; Table 2 in C, {plain.name}: {rate_text(plain)}")
    yield THREADS.line(*_gain(*(found[f"{name} by the clock"] for name in ("one", "two", "read", "read on two"))))


def _gain(one: Samples, two: Samples, read: Samples, read_on_two: Samples) -> tuple[list[float], str]:
    """What two threads gain, of what reading gains from two in the same rounds; and the sentence about it."""
    gains, most = times_as_fast(two, one), times_as_fast(read_on_two, read)
    says = (
        f"by the clock, one thread: {rate_text(one)}; two, {median(gains):.3g} times as fast: {rate_text(two)}; "
        f"reading x, y and z alone: {rate_text(read)}; "
        f"on two, {median(most):.3g} times as fast: {rate_text(read_on_two)}"
    )
    return [gain / limit for gain, limit in zip(gains, most, strict=True)], says


def in_cache(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """A hundred thousand rows, which stay in the cache."""
    columns, out = uniform_columns(CACHED), np.zeros(CACHED, dtype=np.int8)
    libraries = c_baselines(folder, str(choice().level))
    one = TimingEntry("one", CACHED, thread_clocked(lambda: _answered(columns, out)))
    found = measured_samples([*_plain(libraries, columns, out), one], 3 * rounds)
    plain = _fastest(found)
    says = f"{rate_text(found['one'])} on {choice().level}; Table 2 in C, {plain.name}: {rate_text(plain)}"
    yield IN_CACHE.line(times_as_fast(found["one"], plain), says)


def threads_in_cache(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Two threads whose rows stay in the cache, so that memory does not limit them."""
    columns, out = uniform_columns(2 * CACHED), np.zeros(2 * CACHED, dtype=np.int8)
    library = c_baselines(folder, str(choice().level))[0]
    entries = [
        TimingEntry(
            f"{name}, {threads}", threads * CACHED * AGAIN, clocked(partial(_on_threads, work, columns, out, threads))
        )
        for threads in (1, 2)
        for name, work in (("ask", partial(_over_and_over, library)), ("read", partial(_read_over_and_over, library)))
    ]
    found = measured_samples(entries, 3 * rounds)
    yield CACHED_THREADS.line(*_gain(*(found[name] for name in ("ask, 1", "ask, 2", "read, 1", "read, 2"))))


Part = Callable[[Columns, Positions], None]


def _over_and_over(library: CBaseline, columns: Columns, out: Positions) -> None:
    library.of_scene(np.array(TOWER_SIZES), *columns, out)(AGAIN)


def _read_over_and_over(library: CBaseline, columns: Columns, _out: Positions) -> None:
    library.reading(*columns)(AGAIN)


def _on_threads(work: Part, columns: Columns, out: Positions, threads: int) -> Positions:
    """Each thread works AGAIN times on CACHED rows of its own."""

    def part(start: int, stop: int) -> int:
        x, y, z = (column[start:stop] for column in columns)
        work((x, y, z), out[start:stop])
        return 0

    in_parts(part, threads * CACHED, threads)
    return out[: threads * CACHED]


def near_contact(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Rows that floats cannot decide."""
    columns, out = touching_columns(WORST), np.zeros(WORST, dtype=np.int8)
    entries = [
        TimingEntry("touching", WORST, thread_clocked(lambda: _answered(columns, out))),
        TimingEntry("product", 1, c_baselines(folder, str(choice().level))[0].product()),
    ]
    found = measured_samples(entries, rounds)
    touching, product = found["touching"], found["product"]
    says = f"{rate_text(touching)}; fixed point decides nearly all of them; a product: {product.median_ns:.3g} ns"
    yield TOUCHING.line(times_as_long(touching, product), says)


def streamed(folder: Path, most: int, rounds: int) -> Iterator[KernelLine]:
    """From a million rows to `most`, a million at a time, from a ring of parts that exceeds every cache.

    Beside each part another one is only read, so that a slow moment of the memory counts for both.
    """
    columns, out = uniform_columns(PARTS * PART), np.zeros(PART, dtype=np.int8)
    slices = [slice(k * PART, (k + 1) * PART) for k in range(PARTS)]
    parts = [(columns[0][each], columns[1][each], columns[2][each]) for each in slices]
    library = c_baselines(folder, str(choice().level))[0]
    _of_stream(library, PARTS, parts, out)
    before = forget_peak()
    totals = [10**k for k in range(4) if PART * 10**k <= most]
    costs = np.array([[_of_stream(library, total, parts, out) for total in totals] for _ in range(rounds)])
    grown = max(0, peak() - before)
    each = ", ".join(f"{PART * t:,} rows {c:.3g}" for t, c in zip(totals, np.median(costs, axis=0), strict=True))
    dearest = costs[:, 1 + np.argmax(np.median(costs[:, 1:], axis=0))] if len(totals) > 1 else costs[:, 0]
    says = f"times as long as reading the row, in streams of {each}; memory grew by {grown / 2**20:.1f} MB meanwhile"
    yield STREAMED.line((dearest / costs[:, 0]).tolist(), says)


def _of_stream(library: CBaseline, total: int, parts: Sequence[Columns], out: Positions) -> float:
    """A row in a stream of `total` parts, in times of reading it; the median of the repeats of a short stream."""
    streams = []
    for start in range(max(1, LEAST_PARTS // total)):
        asked = read = 0
        for k in range(start, start + total):
            other, these = parts[(k + len(parts) // 2) % len(parts)], parts[k % len(parts)]
            read_other = library.reading(*other)
            began = thread_time_ns()
            read_other(1)
            between = thread_time_ns()
            _answered(these, out)
            read, asked = read + between - began, asked + thread_time_ns() - between
        streams.append(asked / read)
    return median(streams)


def _plain(libraries: list[CBaseline], columns: Columns, out: Positions) -> list[TimingEntry]:
    sizes = np.array(TOWER_SIZES)
    return [
        TimingEntry(" ".join(each.flags) or "no flags", len(out), each.plain(sizes, *columns, out))
        for each in libraries
    ]


def _fastest(found: dict[str, Samples]) -> Samples:
    others = [each for name, each in found.items() if not name.startswith(("read", "one", "two"))]
    return min(others, key=lambda each: each.median_ns)


def _answered(columns: Columns, out: Positions, threads: int = 1) -> Positions:
    fill_scene(TOWER_SIZES, columns, out, "position", threads)
    return out
