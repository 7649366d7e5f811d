"""The one way time is taken: calibrated loops, interleaved rounds in rotated order, and a checksum in every sample.

In each round every entry runs once, and each round begins with another, so that a slow moment of the machine falls on
all of them. The sum of the answers is looked at after each sample: whoever does not answer what was answered before is
refused, and timed no further.
"""

from __future__ import annotations

import gc
import math
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

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


class RefusedError(Exception):
    """What is being timed does not do what it must; the text is a sentence about it. It is timed no further."""


@dataclass(frozen=True, slots=True)
class Entry:
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
    entries: Sequence[Entry], rounds: int, shortest_s: float = SHORTEST_S, first: int = 0
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


def _calibrated(entry: Entry, shortest_s: float) -> Samples:
    """The entry warmed up, with loops enough for a sample of that length."""
    found = Samples(entry.name, entry.rows, entry.loops or 1, entry.checksum or 0, takes=entry.takes)
    try:
        _calibrate(entry, found, shortest_s)
    except RefusedError as refused:
        found.refused = str(refused)
    return found


def _calibrate(entry: Entry, found: Samples, shortest_s: float) -> None:
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


def _sample(entry: Entry, found: Samples) -> None:
    takes = [_take(entry, found) for _ in range(found.takes)]
    if found.refused is None:
        found.samples_ns.append(min(takes) / (found.loops * found.rows))


def _take(entry: Entry, found: Samples) -> float:
    """Nanoseconds; what is refused is asked no more, and takes for ever."""
    if found.refused is None:
        try:
            took, checksum = entry.run(found.loops)
        except RefusedError as refused:
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
