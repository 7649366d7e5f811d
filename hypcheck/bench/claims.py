"""The paper's claims about cost, the alternatives that are timed for each (the printed one first), and the verdicts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from hypcheck.bench.c_library import InC, bodies_asked, place_of
from hypcheck.bench.loaded import InPython, PreparedWork, prepared
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.procedures import CRAFT, PROCEDURES, CraftPath, hull_programs, procedure_2b
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, ROOTS_TRIGONOMETRIC, Formula, cost_of
from hypcheck.derivation.program import Operations, count
from hypcheck.implementations import alternatives
from hypcheck.implementations.method import RECIPROCAL, by_rows, by_scene
from hypcheck.record.measurements import Compared, CostLine
from hypcheck.runs.timing import Estimate, SampleTable, estimate, ratios
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.random_pairs import ARM, BODY, ROTOR, TOWER

TABLE_2, PROCEDURE_1 = FORMULAS["table-2"], REPAIRED["procedure-1-repaired"]
PRINTED_A, PRINTED_B, OURS = "Procedure 2.a", "Procedure 2.b", "ours: certified, the body first"
REPAIRED_A, REPAIRED_B = "Procedure 2.a put right", "Procedure 2.b put right"
REPAIRED_1 = "Procedure 1 put right"
PRINTED, RECIPROCALS = "Table 2 as printed", "Table 2 with 1/b² and 1/d kept outside the loop"
TRIGONOMETRIC, EIGENVALUES = "the roots by cosines, where Δ > 0", "the roots by numpy.roots"

BODIES = (PRINTED_A, PRINTED_B, OURS, REPAIRED_A, REPAIRED_B)
"""The procedures for a body and its rotors, in the order of PROCEDURES; in C the first has the place 1 of of_bodies."""

COST_OF = "cost of "
"""Begins the name of a claim, which takes the place of a workload's name in lines of the record."""

FIRST_AGAIN = "the first again"
"""The first alternative of a comparison a second time; its difference is noise."""

_ROOTS_TIMED = 96


@dataclass(frozen=True)
class CostClaim:
    """A claim of the paper about cost, and the scene and the tier in which it is measured.

    `compared` prepares the alternatives by name, the printed one first. `operations` are the operations for each
    position, if they can be counted.
    """

    name: str
    text: str
    scene: str
    tier: str
    compared: Callable[[BenchPlan], dict[str, PreparedWork]]
    operations: dict[str, Operations]

    @property
    def where(self) -> str:
        """The name that measurements of this claim have in place of a workload."""
        return f"{COST_OF}{self.name}-{self.tier}"


def cost_claims(plan: BenchPlan) -> list[CostClaim]:
    """Return the claims of this run: all in numpy, and in C if that was compiled."""
    if plan.methods or plan.workloads or not plan.everyday:
        return []  # a run of chosen methods measures only these, and the claims are about upright spheroids
    libraries = (None,) if plan.compiled is None else (None, plan.compiled)
    return [make(library) for make in (_procedures, _divisions, _roots) for library in libraries]


def flight_of(seed: int, number: int) -> CraftPath:
    """Return positions along random flights in the paper's cooling tower, with headings."""
    x, y, z = np.ascontiguousarray(WORKLOADS["flight"].rows(seed, number)[:, 4:].T)
    cosine, sine = Draw("bench-headings", 1, seed).circle(number)
    return CraftPath(dict(zip(CRAFT, (*TOWER, *BODY, *ROTOR, ARM), strict=True)), x, y, z, cosine, sine)


def share_touching(flight: CraftPath) -> float:
    """Return the share of positions with Δ ≤ 0 for the bounding spheroid; for these Procedure 2.b tests the rotors."""
    count = 0

    def counting(part: CraftPath) -> None:
        nonlocal count
        count += len(part)

    procedure_2b(flight, counting)
    return count / len(flight)


def hull_operations() -> Operations:
    """Return the operations of Procedure 2.b without the rotors, for every position."""
    return count(hull_programs()[1].steps)


def _procedures(library: Path | None) -> CostClaim:
    """Return the claim that asking the bounding spheroid first costs less."""
    where = "in numpy, 8,192 positions at a time" if library is None else "in C, one position a call"
    return CostClaim(
        "procedures",
        "Section 4: Δ(g_i) costs much, so asking the bounding spheroid first and the rotors only where Δ ≤ 0 "
        "(Procedure 2.b) costs less than asking the four rotors (2.a)",
        f"random flights in the cooling tower, {where}",
        _tier(library),
        partial(_prepared_procedures, library),
        {PRINTED_A: cost_of(FORMULAS["procedure-2a"]).query},
    )


def _divisions(library: Path | None) -> CostClaim:
    """Return the claim that the loop of Table 2 has only additions and products."""
    listed = {PRINTED: TABLE_2, RECIPROCALS: RECIPROCAL, REPAIRED_1: PROCEDURE_1}
    return CostClaim(
        "divisions",
        "Section 3.1: in Table 2 only additions or products are performed, so the computational cost is very low",
        f"uniform around the cooling tower, in {_tier(library)}, in a batch",
        _tier(library),
        partial(_prepared_formulas, library, listed),
        {name: cost_of(formula).query for name, formula in listed.items()},
    )


def _roots(library: Path | None) -> CostClaim:
    """Return the claim that the coefficients cost less than the roots."""
    of_roots = cost_of(ROOTS_TRIGONOMETRIC).query
    return CostClaim(
        "roots",
        "Section 3.1: coefficients alone cost less than the roots of [13], which take trigonometric functions where "
        "Δ > 0",
        f"uniform around the cooling tower, in {_tier(library)}, in a batch",
        _tier(library),
        partial(_prepared_roots, library),
        # In C two of the roots are enough, and only if Δ > 0: a straight-line program cannot express that.
        {PRINTED: cost_of(TABLE_2).query, **({TRIGONOMETRIC: of_roots} if library is None else {})},
    )


def _tier(library: Path | None) -> str:
    """Return the language of the methods: C if there is a library."""
    return "numpy" if library is None else "C"


def _prepared_procedures(library: Path | None, plan: BenchPlan) -> dict[str, PreparedWork]:
    """Return the procedures for a body and its rotors, ready to be timed, by name."""
    flight = flight_of(plan.seed, plan.amounts.bodies)
    if library is None:
        procedures = zip(BODIES, PROCEDURES.values(), strict=True)
        return {name: prepared(len(flight), partial(procedure, flight)) for name, procedure in procedures}
    return {name: bodies_asked(library, place, flight) for place, name in enumerate(BODIES, start=1)}


def _prepared_formulas(library: Path | None, listed: dict[str, Formula], plan: BenchPlan) -> dict[str, PreparedWork]:
    """Return the formulas, ready to be timed, by name."""
    rows = WORKLOADS["uniform"].rows(plan.seed, plan.amounts.timed)
    if library is None:
        functions = {
            name: (by_rows(formula, "float64"), by_scene(formula, "float64")) for name, formula in listed.items()
        }
        return {name: InPython(*by_both).batch(rows) for name, by_both in functions.items()}
    places = {name: place_of(f"{formula.name}-float64") for name, formula in listed.items()}
    return {name: InC(library, place).batch(rows) for name, place in places.items()}


def _prepared_roots(library: Path | None, plan: BenchPlan) -> dict[str, PreparedWork]:
    """Return Table 2 and the computations of roots, ready to be timed, by name."""
    rows = WORKLOADS["uniform"].rows(plan.seed, plan.amounts.timed)
    if library is None:
        prepared = _prepared_formulas(None, {PRINTED: TABLE_2, TRIGONOMETRIC: ROOTS_TRIGONOMETRIC}, plan)
        return {**prepared, EIGENVALUES: InPython(alternatives.numpy_roots).batch(rows[:_ROOTS_TIMED])}
    names = {PRINTED: "table-2-float64", TRIGONOMETRIC: "trigonometric-float64"}
    return {name: InC(library, place_of(method)).batch(rows) for name, method in names.items()}


HOLDS, DOES_NOT_HOLD, INCONCLUSIVE = "holds", "does not hold", "inconclusive"

Ratios = Mapping[str, Estimate]


def cost_line(plan: BenchPlan, claim: CostClaim, samples: Mapping[str, SampleTable]) -> CostLine:
    """Return the record's line about a claim, from the samples of its alternatives by name, the printed one first."""
    first = next(iter(samples))
    to_first = {name: estimate(ratios(timed, samples[first])) for name, timed in samples.items()}
    noise = 1 + to_first.pop(FIRST_AGAIN).half_width
    verdict, says = _SAYS[claim.name](plan, claim, to_first, noise)
    return CostLine(
        claim=claim.text,
        scene=claim.scene,
        compared=[
            Compared(
                name=name,
                operations=_counted(claim.operations.get(name)),
                median_ns=estimate(samples[name]).median,
                ratio=ratio.median,
                ratio_ci95=(ratio.low, ratio.high),
            )
            for name, ratio in to_first.items()
        ],
        verdict=verdict,
        says=says,
    )


def _counted(operations: Operations | None) -> dict[str, int] | None:
    """Return the kinds of operations with a count above 0, and their counts; None if they are not counted."""
    if operations is None:
        return None
    return {name: number for name, number in asdict(operations).items() if number}


def _says_of_procedures(plan: BenchPlan, claim: CostClaim, measured: Ratios, noise: float) -> tuple[str, str]:
    """Return the verdict on the claim about procedures, and its sentence."""
    second, ours = measured[PRINTED_B], measured[OURS]
    share = share_touching(flight_of(plan.seed, plan.amounts.bodies))
    four, hull = claim.operations[PRINTED_A].rounded, hull_operations().rounded
    return cheaper(second, noise), (
        f"2.b takes {_ratio_text(second)} of 2.a's time and ours {_ratio_text(ours)}; put right, 2.a takes "
        f"{_ratio_text(measured[REPAIRED_A])} and 2.b {_ratio_text(measured[REPAIRED_B])}; Δ ≤ 0 at "
        f"{100 * share:.1f} % of positions; 2.a rounds {four} times a position, 2.b {hull} times and, where Δ ≤ 0, "
        f"{four} times more."
    )


def _says_of_divisions(_plan: BenchPlan, claim: CostClaim, measured: Ratios, _noise: float) -> tuple[str, str]:
    """Return the verdict on the claim about divisions, and its sentence."""
    divisions = claim.operations[PRINTED].divisions
    return (HOLDS if divisions == 0 else DOES_NOT_HOLD), (
        f"The loop takes {divisions} divisions a position, by b² and by d; with their reciprocals kept outside it "
        f"takes {claim.operations[RECIPROCALS].divisions} and {_ratio_text(measured[RECIPROCALS])} of the time. "
        f"Put right, Procedure 1 takes {_ratio_text(measured[REPAIRED_1])} of it."
    )


def _says_of_roots(_plan: BenchPlan, claim: CostClaim, measured: Ratios, noise: float) -> tuple[str, str]:
    """Return the verdict on the claim about roots, and its sentence."""
    others = "; ".join(f"{name}: {_ratio_text(ratio)}" for name, ratio in measured.items() if name != PRINTED)
    counted = claim.operations.get(TRIGONOMETRIC)
    functions = f"{counted.functions} a position" if counted else "three where Δ > 0"
    return dearer(measured[TRIGONOMETRIC], noise), (
        f"Of Table 2's time take: {others}. Trigonometric functions: {functions} for the roots, none for "
        "the coefficients."
    )


_SAYS = {"procedures": _says_of_procedures, "divisions": _says_of_divisions, "roots": _says_of_roots}
"""The verdict on each claim, and a sentence about it."""


def cheaper(ratio: Estimate, noise: float) -> str:
    """Return the verdict "holds" if the alternative certainly takes less time than the first, beyond noise."""
    if ratio.high * noise < 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.low / noise > 1 else INCONCLUSIVE


def dearer(ratio: Estimate, noise: float) -> str:
    """Return the verdict "holds" if the alternative certainly takes more time than the first."""
    if ratio.low / noise > 1:
        return HOLDS
    return DOES_NOT_HOLD if ratio.high * noise < 1 else INCONCLUSIVE


def _ratio_text(ratio: Estimate) -> str:
    """Return a ratio with its interval, as text."""
    values = (ratio.median, ratio.low, ratio.high)
    middle, low, high = (f"{value:.3g}" if value < 1000 else f"{value:,.0f}" for value in values)
    return f"{middle} ({low} to {high})"
