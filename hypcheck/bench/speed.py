"""Times as lines of the record: medians, ratios to the reference, the noise floor, verdicts on claims about cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from statistics import median

from msgspec import UNSET

from hypcheck.bench import claims, session
from hypcheck.bench.accuracy import MethodAnswers
from hypcheck.bench.claims import (
    OURS,
    PRINTED,
    PRINTED_A,
    PRINTED_B,
    RECIPROCALS,
    REPAIRED_1,
    REPAIRED_A,
    REPAIRED_B,
    TRIGONOMETRIC,
    CostClaim,
)
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.session import (
    COST_OF,
    EMPTY_CALL,
    FIRST_AGAIN,
    NOT_ANSWERED,
    REFERENCE_AGAIN,
    Measurement,
    MeasurementKey,
    MeasuringSession,
)
from hypcheck.bench.timing import LEAST_NS, Estimate, estimate, ratios
from hypcheck.processes import Advance, fresh, perform
from hypcheck.record.measurements import Compared, CostLine, NoiseLine, RefusedLine, SpeedLine, UnmeasuredLine

UNLIKE = 0.1
"""An empty call may differ by this share: through ctypes it takes 200 ns, and 7 ns more or less by its arguments."""


Measurements = dict[MeasurementKey, list[Measurement]]
"""The measurements of all processes, by method, workload and mode."""


def expected_prints(answers: list[MethodAnswers]) -> dict[MeasurementKey, str]:
    """The hashes of the judged answers, by method, workload and mode."""
    found: dict[MeasurementKey, str] = {}
    for each in answers:
        found[each.method, each.workload, "batch"] = NOT_ANSWERED if each.trouble else each.batch_print
        found[each.method, each.workload, "single"] = NOT_ANSWERED if each.trouble else each.single_print
    return found


def measurements_of(plan: BenchPlan, prints: Mapping[MeasurementKey, str], advance: Advance) -> Measurements:
    """The measurements of the processes, one process after the other; the first calibrates for all."""
    found: Measurements = {}
    loops: dict[MeasurementKey, tuple[int, int]] = {}
    for number in range(plan.processes):
        with fresh(1) as executor:
            ((_, results),) = perform(session.run_session, [MeasuringSession(plan, number, prints, loops)], executor)
        for each in results:
            found.setdefault(each.key, []).append(each)
            loops.setdefault(each.key, (each.samples.loops, each.samples.takes))
        advance(1)
    return found


def speed_lines(found: Measurements, reference: str) -> Iterator[NoiseLine | SpeedLine | UnmeasuredLine | RefusedLine]:
    """The record's lines: noise before the speeds that it belongs to; methods without a time last."""
    found = {key: parts for key, parts in found.items() if not key[1].startswith(COST_OF)}
    refused = {key: reason for key, parts in found.items() if (reason := _refusal(parts))}
    hidden = {key: reason for key, parts in found.items() if key not in refused and (reason := _hidden(parts))}
    timed = {key: parts for key, parts in found.items() if key not in refused and key not in hidden}
    for name, workload, mode in timed:
        if name == REFERENCE_AGAIN and (reference, workload, mode) in timed:
            yield _noise(timed, reference, workload, mode)
    for key in timed:
        if key[0] != REFERENCE_AGAIN and not key[0].startswith(EMPTY_CALL):
            yield _speed_line(timed, reference, key)
    for (name, workload, mode), reason in hidden.items():
        if name != REFERENCE_AGAIN:
            yield UnmeasuredLine(method=name, workload=workload, mode=mode, reason=reason)
    for (name, workload, mode), reason in refused.items():
        yield RefusedLine(method=name, workload=workload, mode=mode, reason=reason)


def _hidden(parts: list[Measurement]) -> str | None:
    """Why the time cannot be separated from that of an empty call, which is subtracted; None if it can.

    It can if the 95 % intervals of the two medians, before the subtraction, are apart by more than UNLIKE, the possible
    difference between the empty call and the cost of calling the method.
    """
    if not all(each.calls_ns for each in parts):
        return None
    call = estimate([[left + median(each.calls_ns) for left in each.samples.samples_ns] for each in parts])
    empty = estimate([each.calls_ns for each in parts])
    if call.low > (1 + UNLIKE) * empty.high and any(map(_possible, parts)):
        return None
    return (
        f"its time, {_time_text(call)}, cannot be distinguished from that of a call that does nothing, "
        f"{_time_text(empty)}, which must be taken off"
    )


def _time_text(time: Estimate) -> str:
    return f"{time.median:.3g} ns ({time.low:.3g} to {time.high:.3g})"


def _possible(part: Measurement) -> list[float]:
    """The positive samples of a process; no clock has more than six digits of them."""
    return [float(f"{sample:.6g}") for sample in part.samples.samples_ns if sample > LEAST_NS]


def _refusal(parts: list[Measurement]) -> str | None:
    return next((each.samples.refused for each in parts if each.samples.refused), None)


def _speed_line(found: Measurements, reference: str, key: MeasurementKey) -> SpeedLine:
    name, workload, mode = key
    parts = found[key]
    first = parts[0].samples
    samples = [possible for part in parts if (possible := _possible(part))]
    dropped = sum(len(part.samples.samples_ns) for part in parts) - sum(map(len, samples))
    time, ratio = estimate(samples), _ratio(found, reference, key)
    return SpeedLine(
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


def _ratio(found: Measurements, reference: str, key: MeasurementKey) -> Estimate | None:
    _, workload, mode = key
    parts = found.get((reference, workload, mode))
    if parts is None or _refusal(parts):
        return None
    pairs = ratios(samples_of(found[key]), samples_of(parts))
    return estimate(pairs) if any(pairs) else None


def _noise(found: Measurements, reference: str, workload: str, mode: str) -> NoiseLine:
    ratio = _ratio(found, reference, (REFERENCE_AGAIN, workload, mode))
    if ratio is None:
        raise ValueError(f"{reference} was measured again in {workload}, {mode}, and not before")
    return NoiseLine(
        workload=workload,
        mode=mode,
        ratio=ratio.median,
        ratio_ci95=(ratio.low, ratio.high),
        floor=ratio.half_width,
    )


def samples_of(parts: list[Measurement]) -> list[list[float]]:
    """Nanoseconds a row of each round, by process; no clock has more than six digits of them."""
    return [[float(f"{sample:.6g}") for sample in each.samples.samples_ns] for each in parts]


HOLDS, DOES_NOT_HOLD, INCONCLUSIVE = "holds", "does not hold", "inconclusive"

Ratios = Mapping[str, Estimate]


def cost_lines(plan: BenchPlan, found: Measurements) -> Iterator[CostLine]:
    """A line for each claim."""
    for claim in claims.cost_claims(plan):
        where = f"{COST_OF}{claim.name}-{claim.tier}"
        samples = {
            name: samples_of(parts) for (name, workload, _), parts in found.items() if workload == where and parts
        }
        first = next(iter(samples))
        to_first = {name: estimate(ratios(each, samples[first])) for name, each in samples.items()}
        noise = 1 + to_first.pop(FIRST_AGAIN).half_width
        verdict, says = _SAYS[claim.name](plan, claim, to_first, noise)
        yield CostLine(
            claim=claim.text,
            scene=claim.scene,
            compared=[
                Compared(
                    name=name,
                    operations=claims.shown_operations(claim.operations[name]) if name in claim.operations else None,
                    median_ns=estimate(samples[name]).median,
                    ratio=ratio.median,
                    ratio_ci95=(ratio.low, ratio.high),
                )
                for name, ratio in to_first.items()
            ],
            verdict=verdict,
            says=says,
        )


def _procedures(plan: BenchPlan, claim: CostClaim, found: Ratios, noise: float) -> tuple[str, str]:
    second, ours = found[PRINTED_B], found[OURS]
    share = claims.share_touching(claims.flight_of(plan.seed, plan.amounts.bodies))
    four, hull = claim.operations[PRINTED_A].rounded, claims.hull_operations().rounded
    return cheaper(second, noise), (
        f"2.b takes {_ratio_text(second)} of 2.a's time and ours {_ratio_text(ours)}; put right, 2.a takes "
        f"{_ratio_text(found[REPAIRED_A])} and 2.b {_ratio_text(found[REPAIRED_B])}; Δ ≤ 0 at {100 * share:.1f} % of "
        f"positions; 2.a rounds {four} times a position, 2.b {hull} times and, where Δ ≤ 0, {four} times more."
    )


def _divisions(_plan: BenchPlan, claim: CostClaim, found: Ratios, _noise: float) -> tuple[str, str]:
    divisions = claim.operations[PRINTED].divisions
    return (HOLDS if divisions == 0 else DOES_NOT_HOLD), (
        f"The loop takes {divisions} divisions a position, by b² and by d; with their reciprocals kept outside it "
        f"takes {claim.operations[RECIPROCALS].divisions} and {_ratio_text(found[RECIPROCALS])} of the time. "
        f"Put right, Procedure 1 takes {_ratio_text(found[REPAIRED_1])} of it."
    )


def _roots(_plan: BenchPlan, claim: CostClaim, found: Ratios, noise: float) -> tuple[str, str]:
    others = "; ".join(f"{name}: {_ratio_text(ratio)}" for name, ratio in found.items() if name != PRINTED)
    counted = claim.operations.get(TRIGONOMETRIC)
    functions = f"{counted.functions} a position" if counted else "three where Δ > 0"
    return dearer(found[TRIGONOMETRIC], noise), (
        f"Of Table 2's time take: {others}. Trigonometric functions: {functions} for the roots, none for "
        "the coefficients."
    )


_SAYS = {"procedures": _procedures, "divisions": _divisions, "roots": _roots}


def cheaper(ratio: Estimate, noise: float) -> str:
    """The verdict "holds" if it certainly takes less time than the first, beyond noise."""
    if ratio.high * noise < 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.low / noise > 1 else INCONCLUSIVE


def dearer(ratio: Estimate, noise: float) -> str:
    """The verdict "holds" if it certainly takes more time than the first."""
    if ratio.low / noise > 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.high * noise < 1 else INCONCLUSIVE


def _ratio_text(ratio: Estimate) -> str:
    values = (ratio.median, ratio.low, ratio.high)
    middle, low, high = (f"{value:.3g}" if value < 1000 else f"{value:,.0f}" for value in values)
    return f"{middle} ({low} to {high})"
