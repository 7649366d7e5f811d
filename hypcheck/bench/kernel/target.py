"""A target of the fast path's speed, and the line that says whether it was met.

What one thread does is told by the time that the processor gave to it, so that a busy machine does not decide; what two
threads do, by the clock on the wall.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.rounds import Clocked, Entry, Samples, measure
from hypcheck.bench.statistics import estimate
from hypcheck.record.measurements import Kernel


@dataclass(frozen=True, slots=True)
class Target:
    """`wanted` is a least number, or a greatest one where `at_most` is set; `text` says of what."""

    name: str
    text: str
    wanted: float
    at_most: bool = False

    def line(self, measured: list[float], says: str) -> Kernel:
        """The record's line: the median of what was measured, round by round, with its 95 % interval."""
        found = estimate([measured])
        met = found.median <= self.wanted if self.at_most else found.median >= self.wanted
        return Kernel(
            name=self.name,
            target=self.text,
            wanted=self.wanted,
            measured=found.median,
            ci95=(found.low, found.high),
            met=met,
            says=says,
        )


def worked(work: Callable[[], NDArray[np.signedinteger]]) -> Clocked:
    """Work of this thread alone by the processor's time: what other programs take of it meanwhile is not counted."""

    def run(repeat: int) -> tuple[int, int]:
        started = thread_time_ns()
        for _ in range(repeat):
            answers = work()
        return thread_time_ns() - started, int(answers.sum(dtype=np.int64))

    return run


def measured(entries: Sequence[Entry], rounds: int) -> dict[str, Samples]:
    """The samples of all entries by their names, in rounds that take them in turn."""
    *_, (_, samples) = measure(entries, rounds)
    for each in samples:
        if each.refused is not None:
            raise AssertionError(f"{each.name}: {each.refused}")
    return {each.name: each for each in samples}


def times_as_fast(mine: Samples, other: Samples) -> list[float]:
    """Round by round, how many rows one answers in the time in which the other answers one."""
    return [theirs / own for own, theirs in zip(mine.samples_ns, other.samples_ns, strict=True)]


def rate(samples: Samples) -> str:
    """The median in nanoseconds a row and in millions of rows a second."""
    return f"{samples.median_ns:.3g} ns a row ({1e3 / samples.median_ns:.3g} million a second)"
