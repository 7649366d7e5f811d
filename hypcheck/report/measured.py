"""The totals of a benchmark: each measured method with its errors, times and memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from hypcheck.messages import escaped
from hypcheck.record import Record, measurements
from hypcheck.report.model import PASSAGE

BATCH, SINGLE = "batch", "single"

PRINCIPAL = "near-contact"
"""The workload that has cases at every distance."""

LEAST_NS = 0.01
"""The time that a benchmark records if a call took no longer than an empty one: the true time is not known."""

NEAREST = 2.0**-75
"""The value of `reliable_above` that a benchmark records for a method that is wrong only at exact tangencies."""

TIERS = ("C", "numpy", "python", "FCL", "foreign")
"""The languages of methods, the fastest first; only methods of one tier compare as algorithms."""


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredMethod:
    """A method and its lines: errors by workload, times by workload and mode, memory."""

    name: str
    line: measurements.MethodLine
    accuracy: Mapping[str, measurements.AccuracyLine]
    speed: Mapping[tuple[str, str], measurements.SpeedLine]
    memory: measurements.MemoryLine | None

    @property
    def tier(self) -> str:
        """The language in which the method is written."""
        return self.line.tier

    @property
    def foreign(self) -> bool:
        """Whether it is the implementation of a user's SPEC."""
        return self.line.kind == "foreign"

    @property
    def label(self) -> str:
        """The method's name in a picture; a user's method is marked as "(yours)"."""
        return escaped(self.name, 28) + " (yours)" * self.foreign

    @property
    def exact(self) -> bool:
        """Whether it promises never to be wrong."""
        return self.line.exact

    @property
    def asked(self) -> int:
        """The number of judged answers, on all workloads."""
        return sum(line.asked for line in self.accuracy.values())

    @property
    def wrong(self) -> int:
        """The number of wrong answers, on all workloads."""
        return sum(line.wrong for line in self.accuracy.values())

    @property
    def never_wrong(self) -> bool:
        """Whether it promises to be exact, and was right about every row."""
        return self.exact and self.asked > 0 and self.reliable_above == 0

    @property
    def reliable_above(self) -> float:
        """The distance above which at most 1 answer in 1000 is wrong or missing, on every workload."""
        return max((line.reliable_above for line in self.accuracy.values()), default=math.inf)

    def ratio(self, workload: str, mode: str = BATCH) -> float | None:
        """Return the method's time divided by the reference method's; None if it was not timed or not compared."""
        line = self.speed.get((workload, mode))
        return None if line is None or line.ratio is None or lost(line) else line.ratio

    def ratio_interval(self, workload: str, mode: str = BATCH) -> tuple[float, float]:
        """Return the interval of that ratio, or the ratio twice if it has no interval.

        The method must have been timed.
        """
        line = self.speed[workload, mode]
        ratio = line.ratio or 0.0
        return line.ratio_ci95 or (ratio, ratio)


def lost(line: measurements.SpeedLine) -> bool:
    """Decide whether a speed line has no time, because a call took no longer than an empty one."""
    return line.median_ns <= LEAST_NS


def measured_methods(record: Record) -> list[MeasuredMethod]:
    """Return every method of a benchmark in the order of the record."""
    accuracy: dict[str, dict[str, measurements.AccuracyLine]] = {}
    speed: dict[str, dict[tuple[str, str], measurements.SpeedLine]] = {}
    for line in record.of(measurements.AccuracyLine):
        accuracy.setdefault(line.method, {})[line.workload] = line
    for time in record.of(measurements.SpeedLine):
        speed.setdefault(time.method, {})[time.workload, time.mode] = time
    memory = {line.method: line for line in record.of(measurements.MemoryLine)}
    return [
        MeasuredMethod(name, line, accuracy.get(name, {}), speed.get(name, {}), memory.get(name))
        for line in record.of(measurements.MethodLine)
        for name in (line.method,)
    ]


@dataclass(frozen=True, slots=True)
class SweepTotal:
    """A method for sweeps: its answers on all workloads together, and its time per sweep on the principal workload.

    typical: half of the wrong answers need at least about this change of the spheroid's size; 0 if there are none.
    worst: the greatest exactly measured change of size.
    """

    name: str
    tier: str
    exact: bool
    asked: int
    missed: int
    false: int
    abstained: int
    typical: float
    worst: float
    time_ns: float | None
    ratio: float | None
    ratio_ci95: tuple[float, float] | None

    def share(self, part: int) -> float:
        """Return the share of `part` in all tested sweeps."""
        return part / self.asked


def sweep_totals(record: Record) -> list[SweepTotal]:
    """Return every method that answers about sweeps and was judged, in the order of the record."""
    where = principal(record), BATCH
    return [
        _sweep_total(method, method.speed.get(where))
        for method in measured_methods(record)
        if method.line.question == PASSAGE and method.asked
    ]


def _sweep_total(method: MeasuredMethod, speed: measurements.SpeedLine | None) -> SweepTotal:
    """Add up the answers of a method for sweeps; `speed` is its line on the principal workload, if it was timed."""
    lines = method.accuracy.values()
    timed = speed if speed is not None and not lost(speed) else None
    return SweepTotal(
        name=method.name,
        tier=method.tier,
        exact=method.exact,
        asked=method.asked,
        missed=sum(line.false_clear for line in lines),
        false=sum(line.false_contact for line in lines),
        abstained=sum(line.abstained for line in lines),
        typical=_median_size([octave for line in lines for octave in line.octaves]),
        worst=max((case.flip_distance for line in lines for case in line.worst), default=0.0),
        time_ns=None if timed is None else timed.median_ns,
        ratio=None if timed is None else timed.ratio,
        ratio_ci95=None if timed is None else timed.ratio_ci95,
    )


def _median_size(octaves: Sequence[measurements.Octave]) -> float:
    """Return the lower end of the octave with the median of the wrong answers.

    It is 0 if no answer is wrong, or if the median is a tangency.
    """
    wrong = sorted((float(exponent), number) for exponent, _, number in octaves if number)
    left = sum(number for _, number in wrong) / 2
    for exponent, number in wrong:
        left -= number
        if left <= 0:
            return float(2.0**exponent)
    return 0.0


def workloads(record: Record) -> dict[str, measurements.WorkloadLine]:
    """Return the workloads by name, in the order of the record, with measured workloads that have no description."""
    known = {line.workload: line for line in record.of(measurements.WorkloadLine)}
    judged, timed = record.of(measurements.AccuracyLine), record.of(measurements.SpeedLine)
    for name in [*(line.workload for line in judged), *(line.workload for line in timed)]:
        known.setdefault(name, measurements.WorkloadLine(workload=name, title=name, text="", rows=0, seed=0))
    return known


def timed_workloads(record: Record) -> list[str]:
    """Return the names of the workloads that have times, in the order of the record."""
    timed = {line.workload for line in record.of(measurements.SpeedLine)}
    return [name for name in workloads(record) if name in timed]


def principal(record: Record) -> str:
    """Return the name of the workload with cases at every distance; if it was not measured, of the first one.

    Returns "" if the record has no workload.
    """
    known = workloads(record)
    return PRINCIPAL if PRINCIPAL in known else next(iter(known), "")


def reference(record: Record) -> str | None:
    """Return the name of the reference method; None if the record has none."""
    named = record.header.options.get("reference")
    return None if named is None else str(named)


REFERENCES = {
    "table-2-float64": "the paper's Table 2 in numpy (table-2-float64)",
    "eigh": "numpy's eigenvalues (eigh)",
    "passage-exact": "exact arithmetic (passage-exact)",
}
"""Reference methods in words that a reader understands without the list of methods."""


def reference_in_words(name: str) -> str:
    """Return the reference method in words: "the paper's Table 2 in numpy (table-2-float64)", else its name."""
    return REFERENCES.get(name, name)


def by_ratio(methods: Iterable[MeasuredMethod], workload: str, mode: str = BATCH) -> list[MeasuredMethod]:
    """Return the methods that have a ratio on this workload in this mode, the fastest first."""
    ranked = [(ratio, method) for method in methods if (ratio := method.ratio(workload, mode)) is not None]
    return [method for _, method in sorted(ranked, key=lambda pair: pair[0])]


def noise_floor(record: Record, workload: str, mode: str) -> float | None:
    """Return the relative difference below which two times of this run count as equal; None if not measured."""
    floors = [
        line.floor for line in record.of(measurements.NoiseLine) if (line.workload, line.mode) == (workload, mode)
    ]
    return float(floors[0]) if floors else None


def stability_title(line: measurements.StabilityLine) -> str:
    """Return the name of a method with the precision in which it was measured."""
    return line.method if line.method.endswith(line.precision) else f"{line.method}, {line.precision}"


def is_unstable(line: measurements.StabilityLine) -> bool:
    """Decide whether a method was wrong at any of the sizes of a stability line."""
    return any(wrong for *_, wrong in line.bins)


def is_wrong_somewhere(line: measurements.PlacesLine) -> bool:
    """Decide whether a method was wrong at any grid point of a places line, in which "." is right."""
    return any(set(text) - {"."} for text in line.wrong)
