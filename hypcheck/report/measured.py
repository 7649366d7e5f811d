"""What a benchmark's lines come to: each method with its errors, times and memory by workload."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from hypcheck.record import Record
from hypcheck.record.measurements import Accuracy, Memory, Method, Noise, Speed, Workload

BATCH, SINGLE, BUILD = "batch", "single", "build"

PRINCIPAL = "near-contact"
"""The workload that has cases at every distance."""

LEAST_NS = 0.01
"""What a benchmark writes for a time of which nothing was left when the empty call was taken off: it is not known."""

NEAREST = 2.0**-75
"""What a benchmark writes for "reliable above" of a method that is wrong at exact tangencies alone."""

TIERS = ("C", "numpy", "python", "FCL", "foreign")
"""What methods are written in, the fastest first; only those of one tier compare as algorithms."""


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """A method and its lines: of its errors by workload, of its times by workload and mode, of its memory."""

    name: str
    line: Method
    accuracy: Mapping[str, Accuracy]
    speed: Mapping[tuple[str, str], Speed]
    memory: Memory | None

    @property
    def tier(self) -> str:
        """What it is written in."""
        return str(self.line.tier)

    @property
    def exact(self) -> bool:
        """Whether it promises never to be wrong."""
        return bool(self.line.exact)

    @property
    def asked(self) -> int:
        """The answers that were judged, on all workloads."""
        return sum(line.asked for line in self.accuracy.values())

    @property
    def wrong(self) -> int:
        """Those that were wrong."""
        return sum(line.wrong for line in self.accuracy.values())

    @property
    def never_wrong(self) -> bool:
        """Whether it promises that, and kept it on every row it was asked about."""
        return self.exact and self.asked > 0 and self.reliable_above == 0

    @property
    def reliable_above(self) -> float:
        """The flip distance above which at most 1 answer in 1000 is wrong or missing, on every workload."""
        return max((float(line.reliable_above) for line in self.accuracy.values()), default=math.inf)

    def ratio(self, workload: str, mode: str = BATCH) -> float | None:
        """Its time by that of the reference method; None where it was not timed or not compared."""
        line = self.speed.get((workload, mode))
        return None if line is None or line.ratio is None or lost(line) else float(line.ratio)


def lost(line: Speed) -> bool:
    """Whether a line of kind speed has no time: the call itself took as long as an empty one."""
    return float(line.median_ns) <= LEAST_NS


def measured(record: Record) -> list[Measured]:
    """Every method of a benchmark in the order of the record."""
    accuracy: dict[str, dict[str, Accuracy]] = {}
    speed: dict[str, dict[tuple[str, str], Speed]] = {}
    for line in record.of(Accuracy):
        accuracy.setdefault(line.method, {})[line.workload] = line
    for time in record.of(Speed):
        speed.setdefault(time.method, {})[time.workload, time.mode] = time
    memory = {line.method: line for line in record.of(Memory)}
    return [
        Measured(name, line, accuracy.get(name, {}), speed.get(name, {}), memory.get(name))
        for line in record.of(Method)
        for name in (line.method,)
    ]


def workloads(record: Record) -> dict[str, Workload]:
    """The workloads by name, in the order of the record; also those that are measured and not described."""
    found = {line.workload: line for line in record.of(Workload)}
    judged, timed = record.of(Accuracy), record.of(Speed)
    for name in [*(line.workload for line in judged), *(line.workload for line in timed)]:
        found.setdefault(name, Workload(workload=name, title=name, text="", rows=0, seed=0))
    return found


def principal(record: Record) -> str:
    """The workload that has cases at every distance from contact; the first where it was not measured."""
    known = workloads(record)
    return PRINCIPAL if PRINCIPAL in known else next(iter(known), "")


def reference(record: Record) -> str | None:
    """The method by whose time every other's is divided, where the record says which."""
    named = record.header.options.get("reference")
    return None if named is None else str(named)


def noise_floor(record: Record, workload: str, mode: str) -> float | None:
    """The relative difference below which two times of this run are not told apart."""
    floors = [line.floor for line in record.of(Noise) if (line.workload, line.mode) == (workload, mode)]
    return float(floors[0]) if floors else None
