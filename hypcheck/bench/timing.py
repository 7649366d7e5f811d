"""Timing: calibrated loops in interleaved rounds, medians of ratios with bootstrap intervals, and targets for them.

The one way time is taken: calibrated loops, interleaved rounds in rotated order, and a checksum in every sample.

In each round every entry runs once, and each round begins with another, so that a slow moment of the machine falls on
all of them. The sum of the answers is looked at after each sample: whoever does not answer what was answered before is
refused, and timed no further.

Medians of ratios with honest intervals: the percentile bootstrap over processes, and over rounds inside them.

Samples come in rounds of several fresh processes. Rounds of one process share what that process happened to be given
(addresses, a core), so processes are drawn first, then rounds inside each drawn one: an interval from rounds alone
would take twenty looks at one accident for twenty accidents. The draws are of a fixed seed, so the same samples always
give the same interval.

A target of the fast path's speed, and the line that says whether it was met.

What one thread does is told by the time that the processor gave to it, so that a busy machine does not decide; what two
threads do, by the clock on the wall.
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

from hypcheck.record.measurements import KernelLine

_LONGEST = 4
"""So many times as long as it must last a sample may be, for the sake of more takes."""

Clocked = Callable[[int], tuple[int, int]]
"""Does its work as often as asked; the nanoseconds that took, and the sum of the answers of one time."""

SHORTEST_S = 0.01
"""What the takes of a sample last at least together, by repeating the work: 10⁵ ticks of the clock."""

MOST_LOOPS = 1_000_000

TAKES = 5
"""A sample is the fastest of so many takes, each a part of its length: what interrupts a process only ever adds time,
and of several short takes it seldom meets all. Work that takes long is taken less often."""


class TimingRefusedError(Exception):
    """What is being timed does not do what it must; the text is a sentence about it. It is timed no further."""


@dataclass(frozen=True, slots=True)
class TimingEntry:
    """Something to be timed: `run` handles `rows` rows each time, and the sum of its answers must be `checksum`.

    Without a checksum that of the first sample stands. `loops` and `takes` are calibrated where they are not given.
    """

    name: str
    rows: int
    run: Clocked
    checksum: int | None = None
    loops: int | None = None
    takes: int = 1


@dataclass(slots=True)
class Samples:
    """What was measured of one entry: nanoseconds a row in each round; `refused` says why it was left off, if so.

    A sample is the fastest of `takes` takes, each of `loops` times the work.
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


def clocked(work: Callable[[], NDArray[np.signedinteger]]) -> Clocked:
    """Work in this process, by our clock; the sum is of the answers of the last time."""

    def run(repeat: int) -> tuple[int, int]:
        started = time.perf_counter_ns()
        for _ in range(repeat):
            answers = work()
        return time.perf_counter_ns() - started, int(answers.sum(dtype=np.int64))

    return run


def clocked_calls(
    answer: Callable[[float, float, float], int],
    centres: Sequence[Sequence[float]],
    clock: Callable[[], int] = time.perf_counter_ns,
) -> Clocked:
    """A call for each centre, in this process, by a clock of nanoseconds; the sum is of the last time's answers."""

    def run(repeat: int) -> tuple[int, int]:
        total = 0
        started = clock()
        for _ in range(repeat):
            total = 0
            for x, y, z in centres:
                total += answer(x, y, z)
        return clock() - started, total

    return run


def measure(
    entries: Sequence[TimingEntry], rounds: int, shortest_s: float = SHORTEST_S, first: int = 0
) -> Iterator[tuple[int, tuple[Samples, ...]]]:
    """Rounds of all entries: after each the number done, and, with the last, the samples.

    `first` is the entry that begins the first round.
    """
    with _undisturbed():
        measured = [_calibrated(entry, shortest_s) for entry in entries]
        for turn in range(rounds):
            for step in range(len(entries)):
                place = (first + turn + step) % len(entries)
                _sample(entries[place], measured[place])
            yield turn + 1, tuple(measured) if turn + 1 == rounds else ()


def _calibrated(entry: TimingEntry, shortest_s: float) -> Samples:
    """The entry warmed up, with loops enough for a sample of that length."""
    found = Samples(entry.name, entry.rows, entry.loops or 1, entry.checksum or 0, takes=entry.takes)
    try:
        _calibrate(entry, found, shortest_s)
    except TimingRefusedError as refused:
        found.refused = str(refused)
    return found


def _calibrate(entry: TimingEntry, found: Samples, shortest_s: float) -> None:
    took, checksum = entry.run(1)
    if entry.checksum is None:
        found.checksum = checksum
    if entry.loops is None:
        loops, shortest = 1, shortest_s / TAKES * 1e9
        while took < shortest / 8 and loops < MOST_LOOPS:  # too short a time tells too little of how many are needed
            loops = min(MOST_LOOPS, 2 * loops if took <= 0 else max(2 * loops, round(loops * shortest / 4 / took)))
            took, checksum = entry.run(loops)
        took = min(took, entry.run(loops)[0])  # an interrupted one would make for too short takes
        found.loops = min(MOST_LOOPS, max(1, math.ceil(loops * shortest / max(took, 1))))
        lasts = max(1, took * found.loops / loops)
        found.takes = max(1, min(TAKES, int(_LONGEST * TAKES * shortest / lasts)))
    _check(found, checksum)


def _sample(entry: TimingEntry, found: Samples) -> None:
    takes = [_take(entry, found) for _ in range(found.takes)]
    if found.refused is None:
        found.samples_ns.append(min(takes) / (found.loops * found.rows))


def _take(entry: TimingEntry, found: Samples) -> float:
    """Nanoseconds; what is refused is asked no more, and takes for ever."""
    if found.refused is None:
        try:
            took, checksum = entry.run(found.loops)
        except TimingRefusedError as refused:
            found.refused = str(refused)
        else:
            _check(found, checksum)
            return took
    return math.inf


def _check(found: Samples, checksum: int) -> None:
    if checksum != found.checksum:
        found.refused = f"its answers summed to {checksum} while it was timed; they must sum to {found.checksum}"


@contextmanager
def _undisturbed() -> Iterator[None]:
    """No garbage collection while it lasts; what there is goes before."""
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
"""No sample is as short: a byte of an answer takes longer to write. What is left of a time from which an empty call was
taken off may be, where noise made that call take longer; it says nothing of the work."""

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
        """How far the interval reaches from 1 to its farther side, as a factor less 1: 0.02 for 0.98 … 1.01."""
        return max(self.high, 1 / self.low if self.low > 0 else np.inf) - 1


def estimate(samples: SampleTable) -> Estimate:
    """The median of all samples with the interval of the bootstrap. Raises ValueError where there is no sample."""
    medians = resampled_medians(samples)
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(medians, (tail, 1 - tail))
    middle = float(np.median(np.concatenate([np.asarray(part, dtype=np.float64) for part in samples])))
    return Estimate(middle, min(float(low), middle), max(float(high), middle))


def ratios(samples: SampleTable, reference: SampleTable) -> list[list[float]]:
    """Round by round, how often longer than the reference: processes and rounds of both go together in order.

    A round in which either has an impossible sample has no ratio.
    """
    return [
        [mine / theirs for mine, theirs in zip(own, other, strict=False) if min(mine, theirs) > LEAST_NS]
        for own, other in zip(samples, reference, strict=False)
    ]


def resampled_medians(samples: SampleTable, seed: int = _SEED) -> NDArray[np.float64]:
    """The medians of DRAWS resamples: (DRAWS,). Raises ValueError where there is no sample."""
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
    """For each resample the places of what it draws, of all samples in a row; and which of these there are not.

    A process that was cut short has fewer rounds. Samples of one run are alike in their numbers, and drawn alike.
    """
    generator = np.random.Generator(np.random.PCG64(seed))
    number, rounds, each = len(lengths), max(lengths), np.array(lengths)
    drawn = generator.integers(0, number, (DRAWS, number))[..., None]
    shares = generator.random((DRAWS, number, rounds))
    starts = np.cumsum(each) - each
    places = (starts[drawn] + np.floor(shares * each[drawn]).astype(np.int64)).reshape(DRAWS, -1)
    missing = (np.arange(rounds) >= each[drawn]).reshape(DRAWS, -1)
    return places, missing if missing.any() else None


@dataclass(frozen=True, slots=True)
class KernelTarget:
    """`wanted` is a least number, or a greatest one where `at_most` is set; `text` says of what."""

    name: str
    text: str
    wanted: float
    at_most: bool = False

    def line(self, measured: list[float], says: str) -> KernelLine:
        """The record's line: the median of what was measured, round by round, with its 95 % interval."""
        found = estimate([measured])
        met = found.median <= self.wanted if self.at_most else found.median >= self.wanted
        return KernelLine(
            name=self.name,
            target=self.text,
            wanted=self.wanted,
            measured=found.median,
            ci95=(found.low, found.high),
            met=met,
            says=says,
        )


def thread_clocked(work: Callable[[], NDArray[np.signedinteger]]) -> Clocked:
    """Work of this thread alone by the processor's time: what other programs take of it meanwhile is not counted."""

    def run(repeat: int) -> tuple[int, int]:
        started = thread_time_ns()
        for _ in range(repeat):
            answers = work()
        return thread_time_ns() - started, int(answers.sum(dtype=np.int64))

    return run


def measured_samples(entries: Sequence[TimingEntry], rounds: int) -> dict[str, Samples]:
    """The samples of all entries by their names, in rounds that take them in turn."""
    *_, (_, samples) = measure(entries, rounds)
    for each in samples:
        if each.refused is not None:
            raise AssertionError(f"{each.name}: {each.refused}")
    return {each.name: each for each in samples}


def times_as_fast(mine: Samples, other: Samples) -> list[float]:
    """Round by round, how many rows one answers in the time in which the other answers one."""
    return [theirs / own for own, theirs in zip(mine.samples_ns, other.samples_ns, strict=True)]


def rate_text(samples: Samples) -> str:
    """The median in nanoseconds a row and in millions of rows a second."""
    return f"{samples.median_ns:.3g} ns a row ({1e3 / samples.median_ns:.3g} million a second)"
