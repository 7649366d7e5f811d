"""Timing: calibrated loops in interleaved rounds, and medians of ratios with bootstrap intervals.

In each round every entry runs once, and each round starts with another entry, so that a slow moment of the machine
affects all of them. The sum of the answers is checked after each sample: an entry whose answers changed is refused, and
not timed again.

Samples come in rounds of several fresh processes. The rounds of one process share random conditions (addresses, a
core). Therefore the bootstrap draws processes first, then rounds inside each drawn process: an interval from rounds
only would count twenty measurements under one condition as twenty conditions. The draws have a fixed seed, so the same
samples always give the same interval.

One thread is timed by its processor time, so that a busy machine does not matter; two threads by the wall clock.
"""

from __future__ import annotations

import gc
import math
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

_LONGEST = 4
"""A sample may last this many times its least duration if that allows more takes."""

Clocked = Callable[[int], tuple[int, int]]
"""A function that does its work as often as asked; it returns the nanoseconds, and the sum of the answers of one
time."""

SHORTEST_S = 0.01
"""The least duration in seconds of all takes of a sample together; the work is repeated to reach it."""

MOST_LOOPS = 1_000_000

TAKES = 5
"""The number of takes of a sample, which is the fastest of them. An interrupt only adds time, and seldom hits all of
several short takes. Long work has fewer takes."""


class TimingRefusedError(Exception):
    """A method does not do its work while it is timed; the text is a sentence about it. It is not timed again."""


@dataclass(frozen=True, slots=True)
class TimingEntry:
    """Work to be timed: `run` answers `rows` rows each time, and the sum of its answers must be `checksum`.

    If there is no checksum, the first sample's checksum is used. `loops` and `takes` are calibrated unless they are
    given.
    """

    name: str
    rows: int
    run: Clocked
    checksum: int | None = None
    loops: int | None = None
    takes: int = 1


@dataclass(slots=True)
class Samples:
    """The samples of one entry: nanoseconds a row in each round; `refused` is the reason if it was refused.

    A sample is the fastest of `takes` takes; a take repeats the work `loops` times.
    """

    name: str
    rows: int
    loops: int
    checksum: int
    samples_ns: list[float] = field(default_factory=list)
    refused: str | None = None
    takes: int = 1

    @property
    def median_ns(self) -> float:
        """The median of the rounds, in nanoseconds a row."""
        return statistics.median(self.samples_ns)


def clocked(work: Callable[[], NDArray[np.signedinteger]], clock: Callable[[], int] = time.perf_counter_ns) -> Clocked:
    """Work in this process, timed by a clock in nanoseconds; the sum is the sum of the last answers."""

    def run(repeat: int) -> tuple[int, int]:
        started = clock()
        for _ in range(repeat):
            answers = work()
        return clock() - started, int(answers.sum(dtype=np.int64))

    return run


def clocked_calls(
    answer: Callable[[float, float, float], int],
    centres: Sequence[Sequence[float]],
    clock: Callable[[], int] = time.perf_counter_ns,
) -> Clocked:
    """Return work that calls `answer` once for each centre, timed by a clock in nanoseconds.

    Its sum is the sum of the last answers.
    """

    def run(repeat: int) -> tuple[int, int]:
        total = 0
        started = clock()
        for _ in range(repeat):
            total = 0
            for x, y, z in centres:
                total += answer(x, y, z)
        return clock() - started, total

    return run


def clocked_in_c(
    call: Callable[[int], object], answers: NDArray[np.int8], clock: Callable[[], int] = time.perf_counter_ns
) -> Clocked:
    """Work that `call` repeats the requested number of times; the sum is the sum of `answers`, which it writes."""

    def run(repeat: int) -> tuple[int, int]:
        answers.fill(0)  # so that answers of an earlier call cannot be counted
        started = clock()
        call(repeat)
        return clock() - started, int(answers.sum(dtype=np.int64))

    return run


def measure(
    entries: Sequence[TimingEntry],
    rounds: int,
    shortest_s: float = SHORTEST_S,
    first: int = 0,
    advance: Callable[[int], object] = lambda _: None,
) -> list[Samples]:
    """Time all entries in rounds that run each entry once; `advance` is called after each round.

    `first` is the entry that starts the first round.
    """
    with _undisturbed():
        measured = [_calibrated(entry, shortest_s) for entry in entries]
        for turn in range(rounds):
            for step in range(len(entries)):
                place = (first + turn + step) % len(entries)
                _sample(entries[place], measured[place])
            advance(1)
    return measured


def _calibrated(entry: TimingEntry, shortest_s: float) -> Samples:
    """Run the entry as a warm-up, and choose enough loops for a sample of that duration; return it without a sample."""
    samples = Samples(entry.name, entry.rows, entry.loops or 1, entry.checksum or 0, takes=entry.takes)
    with _refused(samples):
        took, checksum = entry.run(1)
        if entry.checksum is None:
            samples.checksum = checksum
        if entry.loops is None:
            loops, shortest = 1, shortest_s / TAKES * 1e9
            while (
                took < shortest / 8 and loops < MOST_LOOPS
            ):  # a shorter time is too inaccurate to compute the number of loops
                loops = min(MOST_LOOPS, 2 * loops if took <= 0 else max(2 * loops, round(loops * shortest / 4 / took)))
                took, checksum = entry.run(loops)
            took = min(took, entry.run(loops)[0])  # an interruption would have made the takes too short
            samples.loops = min(MOST_LOOPS, max(1, math.ceil(loops * shortest / max(took, 1))))
            lasts = max(1, took * samples.loops / loops)
            samples.takes = max(1, min(TAKES, int(_LONGEST * TAKES * shortest / lasts)))
        _require_sum(samples, checksum)
    return samples


def _sample(entry: TimingEntry, samples: Samples) -> None:
    """Add a sample, unless the entry is refused."""
    if samples.refused is not None:
        return
    with _refused(samples):
        times = []
        for _ in range(samples.takes):
            took, checksum = entry.run(samples.loops)
            _require_sum(samples, checksum)
            times.append(took)
        samples.samples_ns.append(min(times) / (samples.loops * samples.rows))


def _require_sum(samples: Samples, checksum: int) -> None:
    """Raise TimingRefusedError if the sum of the answers is not the expected one."""
    if checksum != samples.checksum:
        raise TimingRefusedError(
            f"its answers summed to {checksum} while it was timed; they must sum to {samples.checksum}"
        )


@contextmanager
def _refused(samples: Samples) -> Iterator[None]:
    """Enter a block; if it raises TimingRefusedError, store the reason in the samples."""
    try:
        yield
    except TimingRefusedError as refused:
        samples.refused = str(refused)


@contextmanager
def _undisturbed() -> Iterator[None]:
    """Collect garbage, then enter a block in which none is collected."""
    gc.collect()
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


DRAWS = 2000
CONFIDENCE = 0.95
_SEED = 20_230_917

LEAST_NS = 0.01
"""The least time in nanoseconds that a sample can have: to write a byte of an answer takes longer. A difference to an
empty call may be shorter, if noise made the empty call longer; it says nothing about the work."""

SampleTable = Sequence[Sequence[float]]
"""A number for each round, for each process."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """A median and its 95 % interval."""

    median: float
    low: float
    high: float

    @property
    def half_width(self) -> float:
        """The distance of the interval's farther end from 1, as a factor minus 1: 0.02 for 0.98 … 1.01."""
        return max(self.high, 1 / self.low if self.low > 0 else np.inf) - 1


def estimate(samples: SampleTable) -> Estimate:
    """Compute the median of all samples and its bootstrap interval. Raises ValueError if there is no sample."""
    medians = resampled_medians(samples)
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(medians, (tail, 1 - tail))
    middle = float(np.median(np.concatenate([np.asarray(part, dtype=np.float64) for part in samples])))
    return Estimate(middle, min(float(low), middle), max(float(high), middle))


def ratios(samples: SampleTable, reference: SampleTable) -> list[list[float]]:
    """Divide the samples by those of the reference, round by round; processes and rounds of both are paired in order.

    A round in which either has an impossible sample has no ratio.
    """
    return [
        [mine / theirs for mine, theirs in zip(own, other, strict=False) if min(mine, theirs) > LEAST_NS]
        for own, other in zip(samples, reference, strict=False)
    ]


def resampled_medians(samples: SampleTable, seed: int = _SEED) -> NDArray[np.float64]:
    """Draw DRAWS resamples, and return their medians (DRAWS,). Raises ValueError if there is no sample."""
    parts = [np.asarray(part, dtype=np.float64) for part in samples if len(part)]
    if not parts:
        raise ValueError("there is no sample")
    places, short = _draws(tuple(map(len, parts)), seed)
    picked = np.concatenate(parts)[places]
    if short is not None:
        return np.asarray(np.nanmedian(np.where(short, np.nan, picked), axis=1))
    return np.asarray(np.median(picked, axis=1))


@lru_cache(maxsize=16)
def _draws(lengths: tuple[int, ...], seed: int) -> tuple[NDArray[np.int64], NDArray[np.bool_] | None]:
    """Draw, for each resample, places among all samples; return them, and a mask of places that do not exist.

    The mask is None if all exist: an interrupted process has fewer rounds. Samples of one run have the same numbers,
    and the same draws.
    """
    generator = np.random.Generator(np.random.PCG64(seed))
    number, rounds, counts = len(lengths), max(lengths), np.array(lengths)
    drawn = generator.integers(0, number, (DRAWS, number))[..., None]
    shares = generator.random((DRAWS, number, rounds))
    starts = np.cumsum(counts) - counts
    places = (starts[drawn] + np.floor(shares * counts[drawn]).astype(np.int64)).reshape(DRAWS, -1)
    missing = (np.arange(rounds) >= counts[drawn]).reshape(DRAWS, -1)
    return places, missing if missing.any() else None


def thread_clocked(work: Callable[[], NDArray[np.signedinteger]]) -> Clocked:
    """Work of this thread, timed by its processor time: the time of other programs does not count."""
    return clocked(work, thread_time_ns)


def measured_samples(entries: Sequence[TimingEntry], rounds: int) -> dict[str, Samples]:
    """Time all entries, and return their samples by name. Raises AssertionError for one that was refused."""
    samples = measure(entries, rounds)
    for sample in samples:
        if sample.refused is not None:
            raise AssertionError(f"{sample.name}: {sample.refused}")
    return {sample.name: sample for sample in samples}


def times_as_fast(mine: Samples, other: Samples) -> list[float]:
    """Return the time a row of `other` divided by that of `mine`, in each round: above 1 if `mine` is faster."""
    return [theirs / own for own, theirs in zip(mine.samples_ns, other.samples_ns, strict=True)]


def times_as_long(mine: Samples, other: Samples) -> list[float]:
    """Return the time a row of `mine` divided by that of `other`, in each round: above 1 if `mine` is slower."""
    return times_as_fast(other, mine)


def rate_text(samples: Samples) -> str:
    """Return the text of the median, in nanoseconds a row and in millions of rows a second."""
    return f"{samples.median_ns:.3g} ns a row ({1e3 / samples.median_ns:.3g} million a second)"
