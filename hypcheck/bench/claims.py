"""The paper's claims about cost, and the ways that are timed for each: the printed one first, then the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path

import numpy as np

from hypcheck.bench.c_library import InC, bodies_asked, place_of
from hypcheck.bench.c_source import NAMES
from hypcheck.bench.contender import InPython, PreparedWork
from hypcheck.bench.plan import BenchPlan
from hypcheck.bench.timing import clocked
from hypcheck.bench.workloads import WORKLOADS
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, ROOTS_TRIGONOMETRIC, Formula, cost_of
from hypcheck.derivation.program import Operations, count
from hypcheck.implementations import alternatives
from hypcheck.implementations.method import RECIPROCAL, by_rows, by_scene
from hypcheck.implementations.procedures import CRAFT, PROCEDURES, CraftPath, hull_programs, procedure_2b
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.scenes import ARM, BODY, ROTOR, TOWER

TABLE_2, PROCEDURE_1 = FORMULAS["table-2"], REPAIRED["procedure-1-repaired"]
PRINTED_A, PRINTED_B, OURS = "Procedure 2.a", "Procedure 2.b", "ours: certified, the body first"
REPAIRED_A, REPAIRED_B = "Procedure 2.a put right", "Procedure 2.b put right"
REPAIRED_1 = "Procedure 1 put right"
PRINTED, RECIPROCALS = "Table 2 as printed", "Table 2 with 1/b² and 1/d kept outside the loop"
TRIGONOMETRIC, EIGENVALUES = "the roots by cosines, where Δ > 0", "the roots by numpy.roots"

BODIES = (PRINTED_A, PRINTED_B, OURS, REPAIRED_A, REPAIRED_B)
"""The procedures for a body and its rotors, in the order of PROCEDURES and of NAMES."""

_ROOTS_TIMED = 96


@dataclass(frozen=True)
class CostClaim:
    """A claim of the paper about cost, and the scene and the tier in which it is measured.

    `compared` prepares the alternatives by name, the printed one first. `operations` are those for each position, if
    they can be counted.
    """

    name: str
    text: str
    scene: str
    tier: str
    compared: Callable[[BenchPlan], dict[str, PreparedWork]]
    operations: dict[str, Operations]


def cost_claims(plan: BenchPlan) -> list[CostClaim]:
    """The claims of this run: all in numpy, and in C if that was compiled."""
    if plan.methods or plan.workloads or not plan.everyday:
        return []  # a run of a few methods is only about these, and the claims are about upright spheroids
    tiers = ("numpy", "C") if plan.compiled is not None else ("numpy",)
    return [make(tier) for make in (_procedures, _divisions, _roots) for tier in tiers]


def flight_of(seed: int, number: int) -> CraftPath:
    """Positions along random flights in the paper's cooling tower, with headings."""
    x, y, z = np.ascontiguousarray(WORKLOADS["flight"].rows(seed, number)[:, 4:].T)
    cosine, sine = Draw("bench-headings", 1, seed).circle(number)
    return CraftPath(dict(zip(CRAFT, (*TOWER, *BODY, *ROTOR, ARM), strict=True)), x, y, z, cosine, sine)


def share_touching(flight: CraftPath) -> float:
    """The share of positions with Δ ≤ 0 for the bounding spheroid, for which Procedure 2.b asks the rotors."""
    asked = 0

    def counting(part: CraftPath) -> None:
        nonlocal asked
        asked += len(part)

    procedure_2b(flight, counting)
    return asked / len(flight)


def _procedures(tier: str) -> CostClaim:
    where = "in numpy, 8,192 positions at a time" if tier == "numpy" else "in C, one position a call"
    return CostClaim(
        "procedures",
        "Section 4: Δ(g_i) costs much, so asking the bounding spheroid first and the rotors only where Δ ≤ 0 "
        "(Procedure 2.b) costs less than asking the four rotors (2.a)",
        f"random flights in the cooling tower, {where}",
        tier,
        _procedures_in_numpy if tier == "numpy" else _procedures_in_c,
        {PRINTED_A: cost_of(FORMULAS["procedure-2a"]).query},
    )


def hull_operations() -> Operations:
    """The operations of Procedure 2.b for every position, without the rotors."""
    return count(hull_programs()[1].steps)


def _procedures_in_numpy(plan: BenchPlan) -> dict[str, PreparedWork]:
    flight = flight_of(plan.seed, plan.amounts.bodies)
    ways = zip(BODIES, PROCEDURES.values(), strict=True)
    return {
        name: PreparedWork(len(flight), clocked(work), work)
        for name, procedure in ways
        for work in [partial(procedure, flight)]
    }


def _procedures_in_c(plan: BenchPlan) -> dict[str, PreparedWork]:
    flight = flight_of(plan.seed, plan.amounts.bodies)
    places = enumerate(NAMES[1:], start=1)
    return {name: bodies_asked(_library(plan), place, flight) for name, (place, _) in zip(BODIES, places, strict=True)}


def _divisions(tier: str) -> CostClaim:
    return CostClaim(
        "divisions",
        "Section 3.1: in Table 2 only additions or products are performed, so the computational cost is very low",
        f"uniform around the cooling tower, in {tier}, in a batch",
        tier,
        partial(_formulas, tier=tier, listed={PRINTED: TABLE_2, RECIPROCALS: RECIPROCAL, REPAIRED_1: PROCEDURE_1}),
        {
            PRINTED: cost_of(TABLE_2).query,
            RECIPROCALS: cost_of(RECIPROCAL).query,
            REPAIRED_1: cost_of(PROCEDURE_1).query,
        },
    )


def _roots(tier: str) -> CostClaim:
    of_roots = cost_of(ROOTS_TRIGONOMETRIC).query
    return CostClaim(
        "roots",
        "Section 3.1: coefficients alone cost less than the roots of [13], which take trigonometric functions where "
        "Δ > 0",
        f"uniform around the cooling tower, in {tier}, in a batch",
        tier,
        _roots_in_numpy if tier == "numpy" else _roots_in_c,
        # In C two of the roots are enough, and only if Δ > 0: a straight-line program cannot express that.
        {PRINTED: cost_of(TABLE_2).query, **({TRIGONOMETRIC: of_roots} if tier == "numpy" else {})},
    )


def _roots_in_numpy(plan: BenchPlan) -> dict[str, PreparedWork]:
    rows = WORKLOADS["uniform"].rows(plan.seed, plan.amounts.timed)
    found = _formulas(plan, tier="numpy", listed={PRINTED: TABLE_2, TRIGONOMETRIC: ROOTS_TRIGONOMETRIC})
    return {**found, EIGENVALUES: InPython(alternatives.numpy_roots).batch(rows[:_ROOTS_TIMED])}


def _roots_in_c(plan: BenchPlan) -> dict[str, PreparedWork]:
    rows = WORKLOADS["uniform"].rows(plan.seed, plan.amounts.timed)
    names = {PRINTED: "table-2-float64", TRIGONOMETRIC: "trigonometric-float64"}
    return {name: InC(_library(plan), place_of(body)).batch(rows) for name, body in names.items()}


def _formulas(plan: BenchPlan, *, tier: str, listed: dict[str, Formula]) -> dict[str, PreparedWork]:
    rows = WORKLOADS["uniform"].rows(plan.seed, plan.amounts.timed)
    if tier == "C":
        places = {name: place_of(f"{formula.name}-float64") for name, formula in listed.items()}
        return {name: InC(_library(plan), place).batch(rows) for name, place in places.items()}
    ways = {name: (by_rows(each, "float64"), by_scene(each, "float64")) for name, each in listed.items()}
    return {name: InPython(*way).batch(rows) for name, way in ways.items()}


def _library(plan: BenchPlan) -> Path:
    if plan.compiled is None:
        raise ValueError("nothing was compiled")
    return plan.compiled


def shown_operations(operations: Operations) -> dict[str, int]:
    """The operations with a number above 0, by kind."""
    return {name: number for name, number in asdict(operations).items() if number}
