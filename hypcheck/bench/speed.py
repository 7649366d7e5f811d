"""From what the processes measured to the record's lines: medians, ratios to the reference, and the noise floor."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from statistics import median

from msgspec import UNSET

from hypcheck.bench import session
from hypcheck.bench.accuracy import MethodAnswers
from hypcheck.bench.plan import REFERENCE, BenchPlan
from hypcheck.bench.session import AGAIN, COST, EMPTY_CALL, NOT_ANSWERED, Key, Measured, Session
from hypcheck.bench.statistics import LEAST_NS, Estimate, estimate, ratios
from hypcheck.processes import fresh, perform
from hypcheck.record.measurements import Noise, Refused, Speed, Unmeasured

UNLIKE = 0.1
"""Relative to a call that does nothing: through ctypes it takes 200 ns, and 7 ns more or less by its arguments."""

Advance = Callable[[int], object]
Found = dict[Key, list[Measured]]
"""What each process measured, by method, workload and mode."""


def expected(answers: list[MethodAnswers]) -> dict[Key, str]:
    """The prints of the answers that were judged, by method, workload and mode."""
    found: dict[Key, str] = {}
    for each in answers:
        found[each.method, each.workload, "batch"] = NOT_ANSWERED if each.trouble else each.batch_print
        found[each.method, each.workload, "single"] = NOT_ANSWERED if each.trouble else each.single_print
    return found


def measured(plan: BenchPlan, prints: Mapping[Key, str], advance: Advance) -> Found:
    """What the processes measured, one process after the other; the first calibrates for all."""
    found: Found = {}
    loops: dict[Key, tuple[int, int]] = {}
    for number in range(plan.processes):
        with fresh(1) as executor:
            ((_, results),) = perform(session.run, [Session(plan, number, prints, loops)], executor)
        for each in results:
            found.setdefault(each.key, []).append(each)
            loops.setdefault(each.key, (each.samples.loops, each.samples.takes))
        advance(1)
    return found


def lines(found: Found) -> Iterator[Noise | Speed | Unmeasured | Refused]:
    """The record's lines: noise before the speeds it belongs to; those without a time last."""
    found = {key: parts for key, parts in found.items() if not key[1].startswith(COST)}
    refused = {key: reason for key, parts in found.items() if (reason := _refusal(parts))}
    hidden = {key: reason for key, parts in found.items() if key not in refused and (reason := _hidden(parts))}
    timed = {key: parts for key, parts in found.items() if key not in refused and key not in hidden}
    for name, workload, mode in timed:
        if name == AGAIN and (REFERENCE, workload, mode) in timed:
            yield _noise(timed, workload, mode)
    for key in timed:
        if key[0] != AGAIN and not key[0].startswith(EMPTY_CALL):
            yield _line(timed, key)
    for (name, workload, mode), reason in hidden.items():
        if name != AGAIN:
            yield Unmeasured(method=name, workload=workload, mode=mode, reason=reason)
    for (name, workload, mode), reason in refused.items():
        yield Refused(method=name, workload=workload, mode=mode, reason=reason)


def _hidden(parts: list[Measured]) -> str | None:
    """Why the time cannot be told from that of a call that does nothing, which is taken off; None where it can.

    It can where the 95 % intervals of the two medians, before anything is taken off, lie apart by more than UNLIKE: so
    much the call that does nothing may differ from what calling costs the method.
    """
    if not all(each.calls_ns for each in parts):
        return None
    call = estimate([[left + median(each.calls_ns) for left in each.samples.samples_ns] for each in parts])
    empty = estimate([each.calls_ns for each in parts])
    if call.low > (1 + UNLIKE) * empty.high and any(map(_possible, parts)):
        return None
    return (
        f"its time, {_told(call)}, cannot be told from that of a call that does nothing, {_told(empty)}, which must be "
        "taken off"
    )


def _told(time: Estimate) -> str:
    return f"{time.median:.3g} ns ({time.low:.3g} to {time.high:.3g})"


def _possible(part: Measured) -> list[float]:
    """The samples of a process of which something is left; no clock tells more than six digits of them."""
    return [float(f"{sample:.6g}") for sample in part.samples.samples_ns if sample > LEAST_NS]


def _refusal(parts: list[Measured]) -> str | None:
    return next((each.samples.refused for each in parts if each.samples.refused), None)


def _line(found: Found, key: Key) -> Speed:
    name, workload, mode = key
    parts = found[key]
    first = parts[0].samples
    samples = [possible for part in parts if (possible := _possible(part))]
    dropped = sum(len(part.samples.samples_ns) for part in parts) - sum(map(len, samples))
    time, ratio = estimate(samples), _ratio(found, key)
    return Speed(
        method=name,
        workload=workload,
        mode=mode,
        rows=first.rows,
        loops=first.loops,
        samples_ns=samples,
        dropped=dropped or UNSET,
        median_ns=time.median,
        ci95_ns=(time.low, time.high),
        ratio=None if ratio is None else ratio.median,
        ratio_ci95=None if ratio is None else (ratio.low, ratio.high),
        checksum=first.checksum,
        empty_ns=median(each.empty_ns for each in parts),
        timed_by=parts[0].timed_by,
    )


def _ratio(found: Found, key: Key) -> Estimate | None:
    _, workload, mode = key
    reference = found.get((REFERENCE, workload, mode))
    if reference is None or _refusal(reference):
        return None
    pairs = ratios(samples_of(found[key]), samples_of(reference))
    return estimate(pairs) if any(pairs) else None


def _noise(found: Found, workload: str, mode: str) -> Noise:
    ratio = _ratio(found, (AGAIN, workload, mode))
    if ratio is None:
        raise ValueError(f"{AGAIN} was measured in {workload}, {mode} without {REFERENCE}")
    return Noise(
        workload=workload,
        mode=mode,
        ratio=ratio.median,
        ratio_ci95=(ratio.low, ratio.high),
        floor=ratio.half_width,
    )


def samples_of(parts: list[Measured]) -> list[list[float]]:
    """Nanoseconds a row of each round, process by process; no clock tells more than six digits of them."""
    return [[float(f"{sample:.6g}") for sample in each.samples.samples_ns] for each in parts]
