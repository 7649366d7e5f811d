"""From what the processes measured to the record's lines: medians, ratios to the reference, and the noise floor."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from statistics import median
from typing import Any

from hypcheck.bench import session
from hypcheck.bench.accuracy import Answered
from hypcheck.bench.plan import REFERENCE, BenchPlan
from hypcheck.bench.session import AGAIN, COST, EMPTY_CALL, NOT_ANSWERED, Key, Measured, Session
from hypcheck.bench.statistics import Estimate, estimate, ratios
from hypcheck.processes import fresh, perform

Advance = Callable[[int], object]
Found = dict[Key, list[Measured]]
"""What each process measured, by method, workload and mode."""


def expected(answers: list[Answered]) -> dict[Key, str]:
    """The prints of the answers that were judged, by method, workload and mode."""
    found: dict[Key, str] = {}
    for each in answers:
        found[each.method, each.workload, "batch"] = NOT_ANSWERED if each.trouble else each.batch_print
        found[each.method, each.workload, "single"] = NOT_ANSWERED if each.trouble else each.single_print
    return found


def measured(plan: BenchPlan, prints: Mapping[Key, str], advance: Advance) -> Found:
    """What the processes measured, one process after the other; the first calibrates for all."""
    found: Found = {}
    loops: dict[Key, int] = {}
    for number in range(plan.processes):
        with fresh(1) as executor:
            ((_, results),) = perform(session.run, [Session(plan, number, prints, loops)], executor)
        for each in results:
            found.setdefault(each.key, []).append(each)
            loops.setdefault(each.key, each.samples.loops)
        advance(1)
    return found


def lines(found: Found) -> Iterator[tuple[str, dict[str, Any]]]:
    """The record's lines, each with its type: noise before the speeds it belongs to; those refused last."""
    found = {key: parts for key, parts in found.items() if not key[1].startswith(COST)}
    for (name, workload, mode), parts in found.items():
        if name == AGAIN and not _refusal(parts):
            yield "noise", {"workload": workload, "mode": mode, **_noise(found, workload, mode)}
    for key, parts in found.items():
        if key[0] != AGAIN and not key[0].startswith(EMPTY_CALL) and not _refusal(parts):
            yield "speed", _line(found, key)
    for (name, workload, mode), parts in found.items():
        reason = _refusal(parts)
        if reason:
            yield "refused", {"method": name, "workload": workload, "mode": mode, "reason": reason}


def _refusal(parts: list[Measured]) -> str | None:
    return next((each.samples.refused for each in parts if each.samples.refused), None)


def _line(found: Found, key: Key) -> dict[str, Any]:
    name, workload, mode = key
    parts = found[key]
    first = parts[0].samples
    time, ratio = estimate(samples_of(parts)), _ratio(found, key)
    return {
        "method": name,
        "workload": workload,
        "mode": mode,
        "rows": first.rows,
        "loops": first.loops,
        "samples_ns": samples_of(parts),
        "median_ns": time.median,
        "ci95_ns": [time.low, time.high],
        "ratio": None if ratio is None else ratio.median,
        "ratio_ci95": None if ratio is None else [ratio.low, ratio.high],
        "checksum": first.checksum,
        "empty_ns": median(each.empty_ns for each in parts),
        "timed_by": parts[0].timed_by,
    }


def _ratio(found: Found, key: Key) -> Estimate | None:
    _, workload, mode = key
    reference = found.get((REFERENCE, workload, mode))
    if reference is None or _refusal(reference):
        return None
    return estimate(ratios(samples_of(found[key]), samples_of(reference)))


def _noise(found: Found, workload: str, mode: str) -> dict[str, Any]:
    ratio = _ratio(found, (AGAIN, workload, mode))
    if ratio is None:
        raise ValueError(f"{AGAIN} was measured in {workload}, {mode} without {REFERENCE}")
    return {"ratio": ratio.median, "ratio_ci95": [ratio.low, ratio.high], "floor": ratio.half_width}


def samples_of(parts: list[Measured]) -> list[list[float]]:
    """Nanoseconds a row of each round, process by process; no clock tells more than six digits of them."""
    return [[float(f"{sample:.6g}") for sample in each.samples.samples_ns] for each in parts]
