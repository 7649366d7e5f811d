"""A baseline: ratios to the reference are compared with an earlier run's ratios; times of two machines never are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from statistics import median

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders import Contender, ForeignMethod
from hypcheck.bench.plan import BenchPlan
from hypcheck.errors import InputError
from hypcheck.record import RecordLine, read
from hypcheck.record.measurements import ComparisonLine, NoiseLine, SpeedLine
from hypcheck.record.reader import file_of
from hypcheck.runs.timing import CONFIDENCE, LEAST_NS, ratios, resampled_medians

SpeedKey = tuple[str, str, str]
"""A method, a workload and a mode."""

_SEEDS = (1, 2)
"""The seeds of the draws before and after, which differ because the runs are independent."""


@dataclass(frozen=True)
class Baseline:
    """The speeds of a run that have a ratio to the reference, the ratios, and the noise."""

    speeds: dict[SpeedKey, SpeedLine]
    ratios: dict[SpeedKey, float]
    floors: dict[tuple[str, str], float]


@dataclass(frozen=True)
class SpeedChange:
    """The change of a ratio between two runs: the quotient, its interval, and the noise of both runs as one factor."""

    change: float
    low: float
    high: float
    noise: float

    def verdict(self, allowed: float) -> str:
        """Return "slower" if it is slower than allowed, "inconclusive" if it may be, else "faster" or "same"."""
        low, high = self.low / self.noise, self.high * self.noise
        if low > allowed:
            return "slower"
        if high > allowed:
            return "inconclusive"
        return "faster" if high < 1 else "same"


def read_baseline(plan: BenchPlan) -> Baseline | None:
    """Return the plan's baseline, if it has one. Raises InputError if the record cannot be a baseline for this run."""
    if plan.baseline is None:
        return None
    path = file_of(plan.baseline)
    record = read(path)
    options = record.header.options
    if options.get("command") != "bench":
        raise InputError(f"--baseline {path} is a record of another command; it must be a record of hypcheck bench")
    if options.get("reference") != plan.reference:
        before = options.get("reference")
        raise InputError(
            f"--baseline {path}: its ratios are relative to {before!r}, those of this version to {plan.reference!r}"
        )
    if options.get("quick") != plan.quick:
        kind = "quick" if options.get("quick") else "full"
        raise InputError(f"--baseline {path} is of a {kind} run; compare it with another {kind} run")
    baseline = speeds_of(record.lines)
    if not baseline.speeds:
        raise InputError(
            f"--baseline {path} has no speed relative to {plan.reference}; nothing can be compared with it"
        )
    return baseline


def speeds_of(lines: Iterable[RecordLine]) -> Baseline:
    """Return the speeds among lines of a record that have a ratio, and the noise.

    Earlier versions wrote LEAST_NS if an empty call was not shorter; speeds without any other time are not compared.
    """
    baseline = Baseline({}, {}, {})
    for line in lines:
        if isinstance(line, SpeedLine) and line.ratio is not None and median(chain(*line.samples_ns)) > LEAST_NS:
            key = line.method, line.workload, line.mode
            baseline.speeds[key], baseline.ratios[key] = line, line.ratio
        elif isinstance(line, NoiseLine):
            baseline.floors[line.workload, line.mode] = line.floor
    return baseline


def alike(before: Baseline, methods: Iterable[ForeignMethod]) -> tuple[ForeignMethod, ...]:
    """Return the methods of SPECs, timed on as many rows as in the baseline: small batches cost more per row."""
    rows: dict[str, int] = {}
    for (method, _, mode), line in before.speeds.items():
        if mode == "batch":
            rows[method] = max(rows.get(method, 0), line.rows)
    return tuple(replace(method, timed=rows.get(method.name, method.timed)) for method in methods)


def gated(plan: BenchPlan, contenders_by_name: Mapping[str, Contender]) -> set[str]:
    """Return the methods whose verdicts decide the exit code: the named methods, else hypcheck's certified ones."""
    foreign = {method.name for method in plan.foreign}
    if foreign:
        return foreign
    if plan.methods:
        return set(contenders_by_name) - {plan.reference}
    return {name for name, contender in contenders_by_name.items() if contender.kind == "certified"}


def require_common(before: Baseline, names: set[str]) -> None:
    """Raise InputError if the baseline has none of the methods that are compared with it."""
    known = {method for method, _, _ in before.speeds}
    if not known & names:
        sentence = f"{', '.join(sorted(names)) or 'nothing'}; it has {', '.join(sorted(known))}"
        raise InputError(f"--baseline contains no times of the methods that this run compares: {sentence}")


def comparisons(plan: BenchPlan, before: Baseline, after: Baseline, gates: set[str]) -> Iterator[ComparisonLine]:
    """Yield a line for each method, workload and mode that both runs timed."""
    for key in after.speeds:
        method, workload, mode = key
        if key in before.speeds and method != plan.reference:
            change = change_of(before, after, key, plan.reference)
            yield ComparisonLine(
                method=method,
                workload=workload,
                mode=mode,
                before=before.ratios[key],
                after=after.ratios[key],
                change=change.change,
                ci95=(change.low, change.high),
                verdict=change.verdict(plan.max_slowdown),
                allowed=plan.max_slowdown,
                gates=method in gates,
            )


def change_of(before: Baseline, after: Baseline, key: SpeedKey, reference: str) -> SpeedChange:
    """Return the change of one ratio."""
    draws = [_medians(run, key, reference, seed) for run, seed in zip((before, after), _SEEDS, strict=True)]
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(draws[1] / draws[0], (tail, 1 - tail)).tolist()
    change = after.ratios[key] / before.ratios[key]
    noise = (1 + before.floors.get(key[1:], 0.0)) * (1 + after.floors.get(key[1:], 0.0))
    return SpeedChange(change, min(low, change), max(high, change), noise)


def _medians(run: Baseline, key: SpeedKey, reference: str, seed: int) -> NDArray[np.float64]:
    """Return medians of a method's ratios to the reference, each over samples drawn anew."""
    compared = run.speeds[reference, key[1], key[2]].samples_ns
    return resampled_medians(ratios(run.speeds[key].samples_ns, compared), seed)
