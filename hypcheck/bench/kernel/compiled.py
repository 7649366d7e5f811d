"""The compiled kernel: against reading memory, the plain formula in C, itself on two threads, and the worst rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from time import thread_time_ns

import numpy as np

from hypcheck.bench.kernel.baselines import Baseline, baselines
from hypcheck.bench.kernel.rows import SIZES, touching, uniform
from hypcheck.bench.kernel.target import Target, measured, rate, times_as_fast, worked
from hypcheck.bench.memory import forget_peak, peak
from hypcheck.bench.rounds import Entry, Samples, clocked
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_path import fill_scene, in_parts
from hypcheck.record.measurements import Kernel
from hypcheck.rows import Columns, Positions

MANY, CACHED, WORST = 10_000_000, 100_000, 20_000
AGAIN = 200
PART, PARTS, LEAST_PARTS = 1_000_000, 8, 100

CEILING = Target("memory speed", "certified, one thread, of the speed of reading the rows; 1e7 rows", 0.75)
PLAIN = Target("plain C, from memory", "certified, one thread, of the speed of the plain formula in C; 1e7 rows", 0.95)
IN_CACHE = Target("plain C, in cache", "certified, one thread, of the speed of the plain formula in C; 1e5 rows", 0.6)
THREADS = Target("two threads", "two threads of the speed of one; 1e7 rows", 1.8)
CACHED_THREADS = Target("two threads, in cache", "two threads of the speed of one; 1e5 rows each, over and over", 1.8)
TOUCHING = Target("near contact", "nanoseconds a row where all rows are within 1e-15 of contact", 2000.0, at_most=True)
STREAMED = Target("streamed", "a row in streams of 1e6 to 1e9 rows, the dearest to the cheapest", 1.15, at_most=True)


def from_memory(folder: Path, rounds: int) -> Iterator[Kernel]:
    """Ten million rows: reading them, the plain formula, the kernel on one thread and on two."""
    columns, out = uniform(MANY), np.zeros(MANY, dtype=np.int8)
    libraries = baselines(folder, str(choice().level))
    entries = [
        Entry("read", MANY, libraries[0].read_only(*columns)),
        *_plain(libraries, columns, out),
        Entry("one", MANY, worked(lambda: _answered(columns, out))),
        Entry("one by the clock", MANY, clocked(lambda: _answered(columns, out))),
        Entry("two by the clock", MANY, clocked(lambda: _answered(columns, out, threads=2))),
        Entry("read by the clock", MANY, libraries[0].read_by_the_clock(*columns, threads=1)),
        Entry("read on two by the clock", MANY, libraries[0].read_by_the_clock(*columns, threads=2)),
    ]
    found = measured(entries, rounds)
    one, plain = found["one"], _fastest(found)
    level = choice().level
    beside = f"{rate(one)} on {level}"
    yield CEILING.line(times_as_fast(one, found["read"]), f"{beside}; reading x, y and z alone: {rate(found['read'])}")
    yield PLAIN.line(times_as_fast(one, plain), f"{beside}; Table 2 in C, {plain.name}: {rate(plain)}")
    alone, two = found["one by the clock"], found["two by the clock"]
    read, read_on_two = found["read by the clock"], found["read on two by the clock"]
    gain = median(times_as_fast(read_on_two, read))
    beside = f"reading x, y and z alone: {rate(read)}; on two, {gain:.3g} times as fast: {rate(read_on_two)}"
    says = f"by the clock, one thread: {rate(alone)}; two: {rate(two)}; {beside}"
    yield THREADS.line(times_as_fast(two, alone), says)


def in_cache(folder: Path, rounds: int) -> Iterator[Kernel]:
    """A hundred thousand rows, which stay in the cache."""
    columns, out = uniform(CACHED), np.zeros(CACHED, dtype=np.int8)
    libraries = baselines(folder, str(choice().level))
    one = Entry("one", CACHED, worked(lambda: _answered(columns, out)))
    found = measured([*_plain(libraries, columns, out), one], 3 * rounds)
    plain = _fastest(found)
    says = f"{rate(found['one'])} on {choice().level}; Table 2 in C, {plain.name}: {rate(plain)}"
    yield IN_CACHE.line(times_as_fast(found["one"], plain), says)


def threads_in_cache(folder: Path, rounds: int) -> Iterator[Kernel]:
    """Two threads whose rows stay in the cache, over and over: what the memory takes no part in."""
    columns, out = uniform(2 * CACHED), np.zeros(2 * CACHED, dtype=np.int8)
    library = baselines(folder, str(choice().level))[0]
    entries = [
        Entry(name, threads * CACHED * AGAIN, clocked(partial(_over_and_over, library, columns, out, threads)))
        for name, threads in (("one", 1), ("two", 2))
    ]
    one, two = measured(entries, 3 * rounds).values()
    says = f"by the clock, one thread: {rate(one)}; two: {rate(two)}"
    yield CACHED_THREADS.line(times_as_fast(two, one), says)


def _over_and_over(library: Baseline, columns: Columns, out: Positions, threads: int) -> Positions:
    """Each thread answers CACHED rows of its own AGAIN times."""
    sizes = np.array(SIZES)

    def part(start: int, stop: int) -> int:
        x, y, z = (column[start:stop] for column in columns)
        library.over_and_over(sizes, x, y, z, out[start:stop], AGAIN)
        return 0

    in_parts(part, threads * CACHED, threads)
    return out[: threads * CACHED]


def near_contact(rounds: int) -> Iterator[Kernel]:
    """Rows that floats cannot decide."""
    columns, out = touching(WORST), np.zeros(WORST, dtype=np.int8)
    found = measured([Entry("worst", WORST, worked(lambda: _answered(columns, out)))], rounds)["worst"]
    yield TOUCHING.line(found.samples_ns, f"{rate(found)}; the exact integers decide nearly all of them")


def streamed(most: int, rounds: int) -> Iterator[Kernel]:
    """From a million rows to `most`, a million at a time, out of a ring of parts that no cache holds."""
    columns, out = uniform(PARTS * PART), np.zeros(PART, dtype=np.int8)
    slices = [slice(k * PART, (k + 1) * PART) for k in range(PARTS)]
    parts = [(columns[0][each], columns[1][each], columns[2][each]) for each in slices]
    _cost_of_stream(PARTS, parts, out)
    before = forget_peak()
    totals = [10**k for k in range(4) if PART * 10**k <= most]
    costs = [[_cost_of_stream(total, parts, out) for total in totals] for _ in range(rounds)]
    grown = max(0, peak() - before)
    middle = np.median(costs, axis=0).tolist()
    each = ", ".join(f"{PART * total:,} rows {cost:.3g} ns" for total, cost in zip(totals, middle, strict=True))
    says = f"a row of {each}; memory grew by {grown / 2**20:.1f} MB meanwhile"
    yield STREAMED.line([max(cost) / min(cost) for cost in costs], says)


def _cost_of_stream(total: int, parts: Sequence[Columns], out: Positions) -> float:
    """Nanoseconds a row in a stream of `total` parts; a short stream is repeated, and the middle one taken."""
    streams = []
    for start in range(max(1, LEAST_PARTS // total)):
        began = thread_time_ns()
        for k in range(total):
            _answered(parts[(start + k) % len(parts)], out)
        streams.append((thread_time_ns() - began) / (total * PART))
    return median(streams)


def _plain(libraries: list[Baseline], columns: Columns, out: Positions) -> list[Entry]:
    sizes = np.array(SIZES)
    return [Entry(" ".join(each.flags) or "no flags", len(out), each.plain(sizes, *columns, out)) for each in libraries]


def _fastest(found: dict[str, Samples]) -> Samples:
    others = [each for name, each in found.items() if not name.startswith(("read", "one", "two"))]
    return min(others, key=lambda each: each.median_ns)


def _answered(columns: Columns, out: Positions, threads: int = 1) -> Positions:
    fill_scene(SIZES, columns, out, "position", threads)
    return out
