"""What came of the paper's claims about cost: ratios to the printed way, and a verdict where noise allows one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hypcheck.bench import claims
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
    Claim,
)
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.session import COST, FIRST_AGAIN
from hypcheck.bench.speed import Found, samples_of
from hypcheck.bench.statistics import Estimate, estimate, ratios
from hypcheck.record.measurements import Compared, Cost

HOLDS, DOES_NOT_HOLD, INCONCLUSIVE = "holds", "does not hold", "inconclusive"

Ratios = Mapping[str, Estimate]


def lines(plan: BenchPlan, found: Found) -> Iterator[Cost]:
    """A line for each claim."""
    for claim in claims.claims(plan):
        where = f"{COST}{claim.name}-{claim.tier}"
        samples = {
            name: samples_of(parts) for (name, workload, _), parts in found.items() if workload == where and parts
        }
        first = next(iter(samples))
        to_first = {name: estimate(ratios(each, samples[first])) for name, each in samples.items()}
        noise = 1 + to_first.pop(FIRST_AGAIN).half_width
        verdict, says = _SAYS[claim.name](plan, claim, to_first, noise)
        yield Cost(
            claim=claim.text,
            scene=claim.scene,
            compared=[
                Compared(
                    name=name,
                    operations=claims.shown(claim.operations[name]) if name in claim.operations else None,
                    median_ns=estimate(samples[name]).median,
                    ratio=ratio.median,
                    ratio_ci95=(ratio.low, ratio.high),
                )
                for name, ratio in to_first.items()
            ],
            verdict=verdict,
            says=says,
        )


def _procedures(plan: BenchPlan, claim: Claim, found: Ratios, noise: float) -> tuple[str, str]:
    second, ours = found[PRINTED_B], found[OURS]
    share = claims.share_touching(claims.flight_of(plan.seed, plan.amounts.bodies))
    four, hull = claim.operations[PRINTED_A].rounded, claims.hull_operations().rounded
    return cheaper(second, noise), (
        f"2.b takes {_told(second)} of 2.a's time and ours {_told(ours)}; put right, 2.a takes "
        f"{_told(found[REPAIRED_A])} and 2.b {_told(found[REPAIRED_B])}; Δ ≤ 0 at {100 * share:.1f} % of positions; "
        f"2.a rounds {four} times a position, 2.b {hull} times and, where Δ ≤ 0, {four} times more."
    )


def _divisions(_plan: BenchPlan, claim: Claim, found: Ratios, _noise: float) -> tuple[str, str]:
    divisions = claim.operations[PRINTED].divisions
    return (HOLDS if divisions == 0 else DOES_NOT_HOLD), (
        f"The loop takes {divisions} divisions a position, by b² and by d; with their reciprocals kept outside it "
        f"takes {claim.operations[RECIPROCALS].divisions} and {_told(found[RECIPROCALS])} of the time. Put right, "
        f"Procedure 1 takes {_told(found[REPAIRED_1])} of it."
    )


def _roots(_plan: BenchPlan, claim: Claim, found: Ratios, noise: float) -> tuple[str, str]:
    others = "; ".join(f"{name}: {_told(ratio)}" for name, ratio in found.items() if name != PRINTED)
    counted = claim.operations.get(TRIGONOMETRIC)
    functions = f"{counted.functions} a position" if counted else "three where Δ > 0"
    return dearer(found[TRIGONOMETRIC], noise), (
        f"Of Table 2's time take: {others}. Trigonometric functions: {functions} for the roots, none for "
        "the coefficients."
    )


_SAYS = {"procedures": _procedures, "divisions": _divisions, "roots": _roots}


def cheaper(ratio: Estimate, noise: float) -> str:
    """Whether it takes less time than the first, for certain, whatever the noise."""
    if ratio.high * noise < 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.low / noise > 1 else INCONCLUSIVE


def dearer(ratio: Estimate, noise: float) -> str:
    """Whether it takes more time than the first."""
    if ratio.low / noise > 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.high * noise < 1 else INCONCLUSIVE


def _told(ratio: Estimate) -> str:
    values = (ratio.median, ratio.low, ratio.high)
    middle, low, high = (f"{value:.3g}" if value < 1000 else f"{value:,.0f}" for value in values)
    return f"{middle} ({low} to {high})"
