"""How long methods take on the same rows: interleaved rounds in one process, medians, ratios to a reference.

Each round runs every method once, in rotated order, so that a slow moment of the machine falls on all of them. A
method's loops are calibrated to last long enough for the clock, and its answers are counted, so that no work can be
left out.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from hypcheck.methods.method import Answers
from hypcheck.rows import Rows


@dataclass(frozen=True)
class Contender:
    """Something to be timed: `run` answers the first `count` rows of the workload it is given."""

    name: str
    title: str
    run: Callable[[Rows], Answers]
    count: int


@dataclass(frozen=True, slots=True)
class Timing:
    """What was measured: nanoseconds a row in each round, and the sum of the answers of one run."""

    name: str
    title: str
    rows: int
    loops: int
    samples_ns: tuple[float, ...]
    checksum: int

    @property
    def median_ns(self) -> float:
        """The median of the rounds, in nanoseconds a row."""
        return statistics.median(self.samples_ns)


def measure(
    contenders: Sequence[Contender], rows: Rows, rounds: int, shortest_s: float = 0.01
) -> Iterator[tuple[int, tuple[Timing, ...]]]:
    """Rounds of all contenders: after each the number done, and, with the last, the timings."""
    loops, checksums = [], []
    for contender in contenders:
        part = rows[: contender.count]
        checksums.append(int(contender.run(part).sum()))  # also the warm-up
        once = _time(contender, part, 1)
        loops.append(max(1, round(shortest_s / max(once, 1e-9))))
    samples: list[list[float]] = [[] for _ in contenders]
    for turn in range(rounds):
        order = [(turn + step) % len(contenders) for step in range(len(contenders))]
        for place in order:
            contender = contenders[place]
            seconds = _time(contender, rows[: contender.count], loops[place])
            samples[place].append(1e9 * seconds / (loops[place] * min(contender.count, len(rows))))
        if turn + 1 < rounds:
            yield turn + 1, ()
    yield (
        rounds,
        tuple(
            Timing(c.name, c.title, min(c.count, len(rows)), n, tuple(s), checksum)
            for c, n, s, checksum in zip(contenders, loops, samples, checksums, strict=True)
        ),
    )


def _time(contender: Contender, rows: Rows, loops: int) -> float:
    started = time.perf_counter()
    for _ in range(loops):
        contender.run(rows)
    return time.perf_counter() - started
