"""The targets of kernels that targets.toml lists, and the measurements for the compiled kernel.

The compiled kernel is compared with memory bandwidth and the plain formula in C, on one and two threads, and on the
worst rows. Each target is a ratio to a ceiling that is measured in the same rounds. The rows are columns of one scene,
the paper's cooling tower. The plain formula, and a loop that only reads the rows, are compiled when they are needed,
for the instruction set of the kernel. The plain formula is Table 2 as the programs print it; steps that depend only on
sizes come before the loop, and contraction is allowed. It only answers whether the pair is exterior, and is not
certified. It is compiled for each vector width, and the fastest result is used.

Tilted spheroids are classified in the same scene, with axes in all directions, by calls from Python on one thread. They
are compared with upright spheroids and with numpy.linalg.eigh.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from time import perf_counter_ns, thread_time_ns
from typing import Any

import numpy as np

import hypcheck
from hypcheck import toml
from hypcheck.bench.accuracy import forget_peak, peak
from hypcheck.bench.c_library import TOWER_SIZES, CBaseline, c_baselines
from hypcheck.geometry.rows import Columns, Floats, Positions, Rows, tilted_rows
from hypcheck.implementations.alternatives import by_eigenvectors
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import fill_scene, in_parts
from hypcheck.record.measurements import KernelLine
from hypcheck.runs import timing
from hypcheck.vectors.families import FAMILIES
from hypcheck.vectors.random_pairs import beside_surface

Form = tuple[str, float]
"""A statement that calls, and how many times as long as the first of its table it may take."""


@dataclass(frozen=True, slots=True)
class KernelTarget:
    """A target: `wanted` is a least number, or a greatest one if `at_most`; `text` describes it.

    The measured number is a ratio to a ceiling. The ceiling is the time of work that no implementation can avoid,
    measured in the same rounds. So the ratio depends on the code, and as little as possible on the machine and on other
    programs.
    """

    name: str
    text: str
    wanted: float
    at_most: bool = False

    def line(self, measured: list[float], says: str) -> KernelLine:
        """The record's line: the median over rounds, with its 95 % interval. Missed means: by the whole interval."""
        ratio = timing.estimate([measured])
        met = ratio.low <= self.wanted if self.at_most else ratio.high >= self.wanted
        return KernelLine(
            name=self.name,
            target=self.text,
            wanted=self.wanted,
            measured=ratio.median,
            ci95=(ratio.low, ratio.high),
            met=met,
            says=says,
        )

    def against(self, mine: timing.Samples, other: timing.Samples, says: str) -> KernelLine:
        """The line about how many times as fast as the other mine is; as long, if the target is an upper bound."""
        return self.line((timing.times_as_long if self.at_most else timing.times_as_fast)(mine, other), says)


def listed() -> dict[str, Any]:
    """The content of targets.toml; it must not be changed."""
    return toml.shipped("hypcheck.bench", "targets.toml")


def target(name: str) -> KernelTarget:
    """The target of that name; it must be listed in targets.toml."""
    entry = listed()["targets"][name]
    at_most = "at_most" in entry
    return KernelTarget(name, entry["text"], entry["at_most" if at_most else "at_least"], at_most)


def most_times(subject: str) -> Mapping[str, float]:
    """The largest allowed ratio of the time of each form of a call about many rows to the first form's, by name."""
    times: Mapping[str, float] = listed()["many"][subject]
    return times


def forms(call: str) -> Mapping[str, Form]:
    """The forms in which a call may be written, by name; the first is the cheapest."""
    return {name: (text, times) for name, (text, times) in listed()["forms"][call].items()}


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


def tower_rows(columns: Columns) -> Rows:
    """The rows (n, 7) of these centres in the scene of TOWER_SIZES."""
    return np.column_stack([*(np.full(len(columns[0]), size) for size in TOWER_SIZES), *columns])


MANY, CACHED, FEW, WORST = 10_000_000, 100_000, 20_000, 20_000
AGAIN = 200
PART, PARTS, LEAST_PARTS = 1_000_000, 8, 100


def from_memory(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Ten million rows: reading them, the plain formula, and the kernel on one thread and on two."""
    columns, out = uniform_columns(MANY), np.zeros(MANY, dtype=np.int8)
    libraries = c_baselines(folder)
    read = libraries[0].read
    entries = [
        timing.TimingEntry("read", MANY, read(columns)),
        *_plain(libraries, columns, out),
        timing.TimingEntry("one", MANY, timing.thread_clocked(lambda: _answered(columns, out))),
        timing.TimingEntry("one by the clock", MANY, timing.clocked(lambda: _answered(columns, out))),
        timing.TimingEntry("two by the clock", MANY, timing.clocked(lambda: _answered(columns, out, threads=2))),
        timing.TimingEntry("read by the clock", MANY, read(columns, threads=1, clock=perf_counter_ns)),
        timing.TimingEntry("read on two by the clock", MANY, read(columns, threads=2, clock=perf_counter_ns)),
    ]
    samples = timing.measured_samples(entries, rounds)
    one, plain = samples["one"], _fastest(samples)
    beside = f"{timing.rate_text(one)} on {choice().level}"
    yield target("memory speed").against(
        one, samples["read"], f"{beside}; reading x, y and z alone: {timing.rate_text(samples['read'])}"
    )
    yield target("plain C, from memory").against(
        one, plain, f"{beside}; Table 2 in C, {plain.name}: {timing.rate_text(plain)}"
    )
    yield target("two threads").line(
        *_gain(*(samples[f"{name} by the clock"] for name in ("one", "two", "read", "read on two")))
    )


def _gain(
    one: timing.Samples, two: timing.Samples, read: timing.Samples, read_on_two: timing.Samples
) -> tuple[list[float], str]:
    """The gain from a second thread, divided by reading's gain in the same rounds; and the sentence about it."""
    gains, most = timing.times_as_fast(two, one), timing.times_as_fast(read_on_two, read)
    says = (
        f"by the clock, one thread: {timing.rate_text(one)}; two, {median(gains):.3g} times as fast: "
        f"{timing.rate_text(two)}; reading x, y and z alone: {timing.rate_text(read)}; "
        f"on two, {median(most):.3g} times as fast: {timing.rate_text(read_on_two)}"
    )
    return [gain / limit for gain, limit in zip(gains, most, strict=True)], says


def in_cache(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """A hundred thousand rows, which stay in the cache."""
    columns, out = uniform_columns(CACHED), np.zeros(CACHED, dtype=np.int8)
    libraries = c_baselines(folder)
    one = timing.TimingEntry("one", CACHED, timing.thread_clocked(lambda: _answered(columns, out)))
    samples = timing.measured_samples([*_plain(libraries, columns, out), one], 3 * rounds)
    plain = _fastest(samples)
    says = (
        f"{timing.rate_text(samples['one'])} on {choice().level}; Table 2 in C, {plain.name}: {timing.rate_text(plain)}"
    )
    yield target("plain C, in cache").against(samples["one"], plain, says)


def threads_in_cache(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Targets of two threads whose rows stay in the cache, so that memory does not limit them."""
    columns, out = uniform_columns(2 * CACHED), np.zeros(2 * CACHED, dtype=np.int8)
    library = c_baselines(folder)[0]
    works: dict[str, Part] = {
        "ask": lambda part, out: library.of_scene(part, out)(AGAIN),
        "read": lambda part, _out: library.reading(part)(AGAIN),
    }
    entries = [
        timing.TimingEntry(
            f"{name}, {threads}",
            threads * CACHED * AGAIN,
            timing.clocked(partial(_on_threads, work, columns, out, threads)),
        )
        for threads in (1, 2)
        for name, work in works.items()
    ]
    samples = timing.measured_samples(entries, 3 * rounds)
    yield target("two threads, in cache").line(
        *_gain(*(samples[name] for name in ("ask, 1", "ask, 2", "read, 1", "read, 2")))
    )


Part = Callable[[Columns, Positions], None]
"""Work of one thread on its part of the columns and answers."""


def _on_threads(work: Part, columns: Columns, out: Positions, threads: int) -> Positions:
    """Each thread works AGAIN times on CACHED rows of its own."""

    def part(start: int, stop: int) -> int:
        x, y, z = (column[start:stop] for column in columns)
        work((x, y, z), out[start:stop])
        return 0

    in_parts(part, threads * CACHED, threads)
    return out[: threads * CACHED]


def near_contact(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Targets of rows that floats cannot decide."""
    columns, out = touching_columns(WORST), np.zeros(WORST, dtype=np.int8)
    entries = [
        timing.TimingEntry("touching", WORST, timing.thread_clocked(lambda: _answered(columns, out))),
        timing.TimingEntry("product", 1, c_baselines(folder)[0].product()),
    ]
    samples = timing.measured_samples(entries, rounds)
    touching, product = samples["touching"], samples["product"]
    says = (
        f"{timing.rate_text(touching)}; fixed point decides nearly all of them; a product: {product.median_ns:.3g} ns"
    )
    yield target("near contact").against(touching, product, says)


SLOW_FAMILIES = (
    "tangent",
    "osculation",
    "ring",
    "ring-neighbourhood",
    "near-axis",
    "degenerate-crossing",
    "small-integers",
)
EACH, SAME, KEPT, TURNS, NEIGHBOURS = 120, 64, 8, 6, 6
"""The families that floats leave, and how they are searched: slow rows are moved a little, and kept if slower."""


def slowest_row(rounds: int) -> Iterator[KernelLine]:
    """Search the slowest row, then measure it together with rows near contact."""
    row = found_row()
    near = tower_rows(touching_columns(EACH))
    usual = [float(np.median([cost(near_row) for near_row in near])) for _ in range(rounds)]
    slow = [cost(row) for _ in range(rounds)]
    numbers = ", ".join(repr(float(value)) for value in row)
    says = f"{np.median(slow):.4g} ns: {numbers}; the median row near contact: {np.median(usual):.4g} ns"
    yield target("slowest row").line([a / b for a, b in zip(slow, usual, strict=True)], says)


def found_row() -> Rows:
    """The slowest row among the families and the rows derived from their slowest; the same rows are tried each time."""
    random = np.random.Generator(np.random.PCG64(SEED))
    rows = _of_a_scene(np.concatenate([FAMILIES[name].rows(SEED, EACH) for name in SLOW_FAMILIES]))
    slowest = _slowest(rows)
    for _ in range(TURNS):
        slowest = _slowest(
            _of_a_scene(np.concatenate([slowest, *(_moved(random, slowest) for _ in range(NEIGHBOURS))]))
        )
    return np.asarray(slowest[0])


def cost(row: Rows) -> float:
    """Nanoseconds per row of a call with this row SAME times: the least of three, as disturbances lengthen a call."""
    rows, out = np.tile(row, (SAME, 1)), np.zeros(SAME, dtype=np.int8)
    took = []
    for _ in range(3):
        started = thread_time_ns()
        hypcheck.classify(rows, out=out, threads=1)
        took.append(thread_time_ns() - started)
    return min(took) / SAME


def _slowest(rows: Rows) -> Rows:
    order = np.argsort([-cost(row) for row in rows], kind="stable")
    return np.asarray(rows[order[:KEPT]])


def _of_a_scene(rows: Rows) -> Rows:
    """The rows whose sizes and nonzero coordinates are within the magnitudes of a scene."""
    sizes = np.abs(rows)
    inside = (sizes >= 2.0**-30) & (sizes <= 2.0**30)
    inside[:, 4:] |= rows[:, 4:] == 0
    return np.asarray(rows[inside.all(axis=1)])


def _moved(random: np.random.Generator, rows: Rows) -> Rows:
    """Each row with one number moved by some ulps, or by a power of two if it is a coordinate."""
    moved = rows.copy()
    for row in moved:
        place = int(random.integers(0, 7))
        if place >= 4 and random.integers(0, 2):
            row[place] *= 2.0 ** -int(random.integers(0, 25))
        else:
            row[place] += int(random.integers(-4, 5)) * np.spacing(row[place])
    return moved


def streamed(folder: Path, most: int, rounds: int) -> Iterator[KernelLine]:
    """Targets from a million rows to `most`, a million at a time, from a ring of parts that exceeds every cache.

    With each part another part is only read, so that a slow moment of the memory affects both times.
    """
    columns, out = uniform_columns(PARTS * PART), np.zeros(PART, dtype=np.int8)
    slices = [slice(k * PART, (k + 1) * PART) for k in range(PARTS)]
    parts = [(columns[0][part], columns[1][part], columns[2][part]) for part in slices]
    library = c_baselines(folder)[0]
    _of_stream(library, PARTS, parts, out)
    before = forget_peak()
    totals = [10**k for k in range(4) if PART * 10**k <= most]
    costs = np.array([[_of_stream(library, total, parts, out) for total in totals] for _ in range(rounds)])
    grown = max(0, peak() - before)
    streams = ", ".join(f"{PART * t:,} rows {c:.3g}" for t, c in zip(totals, np.median(costs, axis=0), strict=True))
    dearest = costs[:, 1 + np.argmax(np.median(costs[:, 1:], axis=0))] if len(totals) > 1 else costs[:, 0]
    says = f"times as long as reading the row, in streams of {streams}; memory grew by {grown / 2**20:.1f} MB meanwhile"
    yield target("streamed").line((dearest / costs[:, 0]).tolist(), says)


def _of_stream(library: CBaseline, total: int, parts: Sequence[Columns], out: Positions) -> float:
    """The time of a row in a stream of `total` parts over the time of reading it; the median if the stream repeats."""
    streams = []
    for start in range(max(1, LEAST_PARTS // total)):
        answering = reading = 0
        for k in range(start, start + total):
            other, these = parts[(k + len(parts) // 2) % len(parts)], parts[k % len(parts)]
            read_other = library.reading(other)
            began = thread_time_ns()
            read_other(1)
            between = thread_time_ns()
            _answered(these, out)
            reading, answering = reading + between - began, answering + thread_time_ns() - between
        streams.append(answering / reading)
    return median(streams)


def _plain(libraries: list[CBaseline], columns: Columns, out: Positions) -> list[timing.TimingEntry]:
    return [
        timing.TimingEntry(" ".join(library.flags) or "no flags", len(out), library.plain(columns, out))
        for library in libraries
    ]


def _fastest(samples: dict[str, timing.Samples]) -> timing.Samples:
    others = [timed for name, timed in samples.items() if not name.startswith(("read", "one", "two"))]
    return min(others, key=lambda timed: timed.median_ns)


def _answered(columns: Columns, out: Positions, threads: int = 1) -> Positions:
    fill_scene(TOWER_SIZES, columns, out, "position", threads)
    return out


AXIS = (0.3, 0.1, 0.9)

_TURNS = 30
"""Bisections of numpy's version: enough away from contact, and fewer than it would need there."""


def axes(count: int) -> Floats:
    """Axes in all directions, (n, 3)."""
    return np.random.Generator(np.random.PCG64(SEED)).normal(size=(count, 3))


def touching_rows(count: int) -> Rows:
    """Rows of the tower's body tilted in all directions, within about 1e-15 radii of contact: (n, 10)."""
    random = np.random.Generator(np.random.PCG64(SEED))
    alpha, gamma, b, d = TOWER_SIZES
    turn, height = 2 * np.pi * random.random(count), (2 * random.random(count) - 1) * gamma
    radius = alpha * np.sqrt(1 + (height / gamma) ** 2)
    point = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])
    normal = point * [alpha**-2, alpha**-2, -(gamma**-2)]
    axis = axes(count)
    along = (axis * normal).sum(axis=1, keepdims=True) / (axis * axis).sum(axis=1, keepdims=True) * axis
    reach = b * b * (normal - along) + d * d * along
    side = np.where(random.random(count) < 0.5, -1.0, 1.0) * (1 + (2 * random.random(count) - 1) * 1e-15)
    centre = point + (side / np.sqrt((reach * normal).sum(axis=1)))[:, None] * reach
    return tilted_rows(TOWER_SIZES, (centre[:, 0], centre[:, 1], centre[:, 2]), (*axis.T,))


def one_orientation(rounds: int) -> Iterator[KernelLine]:
    """The target of a scene with an axis, compared with the same scene without it."""
    for name, count, more in (("one orientation", MANY, 1), ("one orientation, in cache", CACHED, 3)):
        ask = partial(hypcheck.classify_scene, TOWER_SIZES, *uniform_columns(count), threads=1)
        entries = [
            timing.TimingEntry("upright", count, timing.thread_clocked(ask)),
            timing.TimingEntry("tilted", count, timing.thread_clocked(partial(ask, axis=AXIS))),
        ]
        samples = timing.measured_samples(entries, more * rounds)
        says = f"{timing.rate_text(samples['tilted'])}; upright: {timing.rate_text(samples['upright'])}"
        yield target(name).against(samples["tilted"], samples["upright"], says)


def axis_along_z(rounds: int) -> Iterator[KernelLine]:
    """The target of upright rows of ten, compared with the same rows of seven."""
    ten = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (0.0, 0.0, 1.0))
    seven = np.ascontiguousarray(ten[:, :7])
    entries = [
        timing.TimingEntry(name, CACHED, timing.thread_clocked(partial(hypcheck.classify, rows, threads=1)))
        for name, rows in (("seven", seven), ("ten", ten))
    ]
    samples = timing.measured_samples(entries, 3 * rounds)
    ratios = [ratio * ten.shape[1] / seven.shape[1] for ratio in timing.times_as_fast(samples["ten"], samples["seven"])]
    yield target("axis along z").line(
        ratios, f"{timing.rate_text(samples['ten'])}; rows of seven: {timing.rate_text(samples['seven'])}"
    )


def an_axis_each(folder: Path, rounds: int) -> Iterator[KernelLine]:
    """Targets of rows with an axis each, against numpy; and of rows near contact, against integer products."""
    rows = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (*axes(CACHED).T,))
    entries = [
        timing.TimingEntry("rows", CACHED, timing.thread_clocked(partial(hypcheck.classify, rows, threads=1))),
        timing.TimingEntry("eigh", FEW, timing.thread_clocked(partial(by_eigenvectors, rows[:FEW], _TURNS))),
        timing.TimingEntry(
            "touching", WORST, timing.thread_clocked(partial(hypcheck.classify, touching_rows(WORST), threads=1))
        ),
        timing.TimingEntry("product", 1, c_baselines(folder)[0].product()),
    ]
    samples = timing.measured_samples(entries, rounds)
    says = f"{timing.rate_text(samples['rows'])}; numpy: {timing.rate_text(samples['eigh'])}"
    yield target("numpy.linalg.eigh").against(samples["rows"], samples["eigh"], says)
    says = f"{timing.rate_text(samples['touching'])}; a product: {samples['product'].median_ns:.3g} ns"
    yield target("near contact, tilted").against(samples["touching"], samples["product"], says)
