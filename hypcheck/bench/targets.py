"""`hypcheck bench --kernel`: every target of the fast path's speed, each a line "kernel" of the record.

Here are the run, and the targets of the compiled kernel; call_targets.py has those of calls from Python. A target that
cannot be measured here becomes a line "absent".

The plain formula, and a loop that only reads the rows, are compiled when they are needed, for the instruction set of
the kernel. The plain formula is Table 2 as the programs print it; steps that depend only on sizes come before the loop,
and contraction is allowed. It only answers whether the pair is exterior, and is not certified. It is compiled for each
vector width, and the fastest result is used.

Tilted spheroids are classified in the same scene, with axes in all directions, by calls from Python on one thread. For
hyperboloids that end, the targets are the cost of ends, and the share of each family's rows that C leaves open.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter_ns, thread_time_ns

import numpy as np

import hypcheck
from hypcheck.bench import call_targets, yardsticks
from hypcheck.bench.accuracy import forget_peak, peak
from hypcheck.bench.c_library import TOWER_SIZES, CBaseline
from hypcheck.bench.yardsticks import Measuring, lines, target, threaded, tower_rows, uniform_columns
from hypcheck.errors import UnavailableError
from hypcheck.geometry.rows import CANNOT_SAY, Columns, Positions, Rows, tilted_rows
from hypcheck.implementations.alternatives import by_eigenvectors
from hypcheck.implementations.meshes import FCL
from hypcheck.kernel.choice import choice
from hypcheck.kernel.compiled_kernel import answer_ended, answer_rows, answer_sweeps, fill_scene, in_parts
from hypcheck.record import Recorder
from hypcheck.record.measurements import AbsentLine, KernelLine
from hypcheck.runs.timing import Samples, TimingEntry, clocked, measured_samples, rate_text, times_as_fast
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES

AGAIN = 2
"""How many times a missed target is measured again."""

STREAM, QUICK_STREAM = 1_000_000_000, 100_000_000


MANY, CACHED, FEW, WORST = 10_000_000, 100_000, 20_000, 20_000
"""How many rows come from memory, stay in the cache, are for numpy, and are next to contact."""


def _answered(columns: Columns, out: Positions, threads: int = 1) -> Positions:
    """Classify columns into `out`, and return it."""
    fill_scene(TOWER_SIZES, columns, out, "position", threads)
    return out


def _plain(libraries: Sequence[CBaseline], columns: Columns, out: Positions) -> list[TimingEntry]:
    """Return the plain formula in C, compiled for each vector width, by the flags of the compiler."""
    return [
        TimingEntry(" ".join(library.flags) or "no flags", len(out), library.plain(columns, out))
        for library in libraries
    ]


def _with_fastest(samples: dict[str, Samples], plain: Sequence[TimingEntry]) -> dict[str, Samples]:
    """Return the samples, and the fastest of the plain formula as "plain"."""
    return {**samples, "plain": min((samples[entry.name] for entry in plain), key=lambda timed: timed.median_ns)}


def from_memory(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of ten million rows: reading them, the plain formula, and the kernel on one thread and on two."""
    columns, out = uniform_columns(MANY), np.zeros(MANY, dtype=np.int8)
    read, plain = run.baselines[0].read, _plain(run.baselines, columns, out)
    entries = [
        TimingEntry("read", MANY, read(columns)),
        *plain,
        *threaded(MANY, {"one": partial(_answered, columns, out)}),
        TimingEntry("one by the clock", MANY, clocked(partial(_answered, columns, out))),
        TimingEntry("two by the clock", MANY, clocked(partial(_answered, columns, out, threads=2))),
        TimingEntry("read by the clock", MANY, read(columns, threads=1, clock=perf_counter_ns)),
        TimingEntry("read on two by the clock", MANY, read(columns, threads=2, clock=perf_counter_ns)),
    ]
    samples = _with_fastest(measured_samples(entries, run.rounds), plain)
    yield from lines(samples, "memory speed", "plain C, from memory")
    yield target("two threads").line(
        *_gain(*(samples[f"{name} by the clock"] for name in ("one", "two", "read", "read on two")))
    )


def _gain(one: Samples, two: Samples, read: Samples, read_on_two: Samples) -> tuple[list[float], str]:
    """Return the gain from a second thread, divided by reading's gain in the same rounds; and the sentence about it."""
    gains, most = times_as_fast(two, one), times_as_fast(read_on_two, read)
    says = (
        f"by the clock, one thread: {rate_text(one)}; two, {median(gains):.3g} times as fast: "
        f"{rate_text(two)}; reading x, y and z alone: {rate_text(read)}; "
        f"on two, {median(most):.3g} times as fast: {rate_text(read_on_two)}"
    )
    return [gain / limit for gain, limit in zip(gains, most, strict=True)], says


def in_cache(run: Measuring) -> Iterator[KernelLine]:
    """Yield a hundred thousand rows, which stay in the cache."""
    columns, out = uniform_columns(CACHED), np.zeros(CACHED, dtype=np.int8)
    plain = _plain(run.baselines, columns, out)
    entries = [*plain, *threaded(CACHED, {"one": partial(_answered, columns, out)})]
    yield from lines(_with_fastest(measured_samples(entries, 3 * run.rounds), plain), "plain C, in cache")


REPEATED = 200


Part = Callable[[Columns, Positions], None]
"""A function that does the work of one thread on its part of the columns and answers."""


def threads_in_cache(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of two threads whose rows stay in the cache, so that memory does not limit them."""
    columns, out = uniform_columns(2 * CACHED), np.zeros(2 * CACHED, dtype=np.int8)
    library = run.baselines[0]
    works: dict[str, Part] = {
        "ask": lambda part, out: library.of_scene(part, out)(REPEATED),
        "read": lambda part, _out: library.reading(part)(REPEATED),
    }
    entries = [
        TimingEntry(
            f"{name}, {threads}",
            threads * CACHED * REPEATED,
            clocked(partial(_on_threads, work, columns, out, threads)),
        )
        for threads in (1, 2)
        for name, work in works.items()
    ]
    samples = measured_samples(entries, 3 * run.rounds)
    yield target("two threads, in cache").line(
        *_gain(*(samples[name] for name in ("ask, 1", "ask, 2", "read, 1", "read, 2")))
    )


def _on_threads(work: Part, columns: Columns, out: Positions, threads: int) -> Positions:
    """Measure threads that each work REPEATED times on CACHED rows of their own."""

    def part(start: int, stop: int) -> int:
        x, y, z = (column[start:stop] for column in columns)
        work((x, y, z), out[start:stop])
        return 0

    in_parts(part, threads * CACHED, threads)
    return out[: threads * CACHED]


def near_contact(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of rows that floats cannot decide, upright and tilted; and of tilted rows against numpy."""
    columns, out = yardsticks.touching_columns(WORST), np.zeros(WORST, dtype=np.int8)
    product = TimingEntry("product", 1, run.baselines[0].product())
    upright = threaded(WORST, {"touching": partial(_answered, columns, out)})
    yield from lines(measured_samples([*upright, product], run.rounds), "near contact")
    rows = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (*yardsticks.axes(CACHED).T,))
    tilted = [
        *threaded(CACHED, {"rows": partial(hypcheck.classify, rows, threads=1)}),
        *threaded(FEW, {"eigh": partial(by_eigenvectors, rows[:FEW], _TURNS)}),
        *threaded(WORST, {"touching": partial(hypcheck.classify, yardsticks.touching_rows(WORST), threads=1)}),
    ]
    yield from lines(measured_samples([*tilted, product], run.rounds), "numpy.linalg.eigh", "near contact, tilted")


_TURNS = 30
"""How often numpy's version bisects: enough away from contact, and fewer than it would need next to contact."""


def slowest_row(run: Measuring) -> Iterator[KernelLine]:
    """Search the slowest row, then measure it together with rows near contact."""
    row = yardsticks.found_row()
    near = tower_rows(yardsticks.touching_columns(yardsticks.EACH))
    usual = [median(map(yardsticks.cost, near)) for _ in range(run.rounds)]
    slow = [yardsticks.cost(row) for _ in range(run.rounds)]
    numbers = ", ".join(repr(float(value)) for value in row)
    says = f"{median(slow):.4g} ns: {numbers}; the median row near contact: {median(usual):.4g} ns"
    yield target("slowest row").line([a / b for a, b in zip(slow, usual, strict=True)], says)


PART, PARTS, LEAST_PARTS = 1_000_000, 8, 100


def streamed(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets from a million rows to a billion, a million at a time, from a ring of parts larger than caches.

    With each part another part is only read, so that a slow moment of the memory affects both times.
    """
    most, rounds = (QUICK_STREAM, 3) if run.quick else (STREAM, 5)
    columns, out = uniform_columns(PARTS * PART), np.zeros(PART, dtype=np.int8)
    slices = [slice(k * PART, (k + 1) * PART) for k in range(PARTS)]
    parts = [(columns[0][part], columns[1][part], columns[2][part]) for part in slices]
    library = run.baselines[0]
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
    """Return the time of a row in a stream of `total` parts over the time of reading it.

    The median if the stream repeats.
    """
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


AXIS = (0.3, 0.1, 0.9)


def one_orientation(run: Measuring) -> Iterator[KernelLine]:
    """Yield the target of a scene with an axis, compared with the same scene without it."""
    for name, count, more in (("one orientation", MANY, 1), ("one orientation, in cache", CACHED, 3)):
        ask = partial(hypcheck.classify_scene, TOWER_SIZES, *uniform_columns(count), threads=1)
        calls = {"upright": ask, "tilted": partial(ask, axis=AXIS)}
        yield from lines(measured_samples(threaded(count, calls), more * run.rounds), name)


def axis_along_z(run: Measuring) -> Iterator[KernelLine]:
    """Yield the target of upright rows of ten, compared with the same rows of seven by the bytes that are read."""
    ten = tilted_rows(TOWER_SIZES, uniform_columns(CACHED), (0.0, 0.0, 1.0))
    calls = {
        name: partial(hypcheck.classify, rows, threads=1)
        for name, rows in (("seven", np.ascontiguousarray(ten[:, :7])), ("ten", ten))
    }
    samples = measured_samples(threaded(CACHED, calls), 3 * run.rounds)
    ratios = [ratio * 10 / 7 for ratio in times_as_fast(samples["ten"], samples["seven"])]
    says = f"{rate_text(samples['ten'])}; rows of seven: {rate_text(samples['seven'])}"
    yield target("axis along z").line(ratios, says)


PACED = 20_000


ORDINARY, NEAR = 20_000, 2_000
"""How many rows each ordinary family gives, and each family near a rim, a flat end or the wall."""


def _whole(rows: Rows) -> Positions:
    """Return the answers of the compiled kernel to rows."""
    return answer_rows(rows, "position", 1)[0]


def paces(run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of rows whose ends are far away, and of rows near the rim, upright and tilted."""
    for kind, (whole, far, near) in yardsticks.ended_rows(PACED).items():
        calls: dict[str, Callable[[], Positions]] = {
            "whole": partial(_whole, whole),
            "far": partial(answer_ended, far, 1),
            "near": partial(answer_ended, near, 1),
        }
        samples = measured_samples(threaded(PACED, calls), run.rounds)
        yield from lines(samples, f"ends far away, {kind}", f"ends near the rim, {kind}")


def left_open(_run: Measuring) -> Iterator[KernelLine]:
    """Yield targets of the rows and sweeps of each family that C answers with 2; Python then decides these exactly."""
    counts = {name: _open_share(name) for name in (*ENDED_FAMILIES, *ENDED_SWEEP_FAMILIES)}
    for subject, ordinary in (("left open, ordinary", True), ("left open, near an end", False)):
        some = {name: share for name, share in counts.items() if name.endswith("uniform") is ordinary}
        n = ORDINARY if ordinary else NEAR
        words = ", ".join(f"{name} {round(share * n)}" for name, share in some.items() if share) or "none of any family"
        yield target(subject).line([max(some.values())], f"of {n:,} of each of {len(some)} families: {words}")


def _open_share(name: str) -> float:
    """Return the share of a family's rows or sweeps that C answers with 2."""
    sweeps = name in ENDED_SWEEP_FAMILIES
    family = ENDED_SWEEP_FAMILIES[name] if sweeps else ENDED_FAMILIES[name]
    rows = np.ascontiguousarray(family.rows(yardsticks.SEED, ORDINARY if name.endswith("uniform") else NEAR))
    answers = answer_sweeps(rows)[0] if sweeps else answer_ended(rows, 1)
    return float((answers == CANNOT_SAY).mean())


Group = Callable[[Measuring], Iterable[KernelLine]]


ANYWHERE: tuple[Group, ...] = (call_targets.against_numpy, call_targets.against_others, call_targets.one_call)


COMPILED: tuple[Group, ...] = (
    from_memory,
    in_cache,
    threads_in_cache,
    near_contact,
    slowest_row,
    one_orientation,
    axis_along_z,
    streamed,
    call_targets.batches,
    call_targets.ten_centres,
    call_targets.forms_of_one_pair,
    call_targets.forms_of_ten_centres,
    call_targets.forms_of_ten_rows,
    call_targets.forms_of_many,
    call_targets.forms_of_an_axis_each,
    paces,
    left_open,
)
"""The groups of targets that are measured together: with either kernel, and with the compiled one."""


def _groups() -> tuple[Group, ...]:
    """Return the groups of targets that the kernel in use can measure."""
    return (*COMPILED, *ANYWHERE) if choice().kernel == "compiled" else ANYWHERE


def steps() -> int:
    """Return the number of times that `run` advances."""
    return len(_groups())


def run(recorder: Recorder, advance: Callable[[int], object], quick: bool) -> None:
    """Measure every target and add its line; a quick run has fewer rounds and streams a tenth of the rows."""
    absent = {}
    with TemporaryDirectory(prefix="hypcheck-kernel-") as folder:
        for group in _groups():
            try:
                for line in confirmed_lines(partial(group, Measuring(Path(folder), quick))):
                    recorder.add(line)
            except UnavailableError as error:
                absent["C compiler"] = str(error)
            advance(1)
    if choice().kernel != "compiled":
        absent["compiled kernel"] = choice().reason
    if (trouble := FCL.trouble()) is not None:
        absent[FCL.title] = trouble
    for what, reason in absent.items():
        recorder.add(AbsentLine(what=what, reason=reason))


def confirmed_lines(group: Callable[[], Iterable[KernelLine]]) -> list[KernelLine]:
    """Return the group's lines. A missed target is measured again; it counts as missed only if it is missed each time.

    The interval shows the differences between rounds; it cannot show that another program used the memory in all of
    them.
    """
    lines = list(group())
    for _ in range(AGAIN):
        if all(line.met for line in lines):
            break
        anew = {line.name: line for line in group()}
        lines = [line if line.met else anew[line.name] for line in lines]
    return lines
