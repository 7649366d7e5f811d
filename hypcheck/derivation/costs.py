"""What each way to the answer costs in operations, counted from its program: once a scene, and for each position."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from hypcheck.derivation.counting import Operations, count
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.hoisting import hoist
from hypcheck.derivation.program import Program, cut
from hypcheck.derivation.repaired_formulas import REPAIRED
from hypcheck.derivation.root_formulas import ROOTS_TRIGONOMETRIC, SWEEP
from hypcheck.derivation.rotor_listings import ROTORS

SIZES_OF_A_SCENE = frozenset({"alpha", "gamma", "b", "d", "b_s", "d_s", "l"})
"""Inputs that do not change from one position to the next."""


@dataclass(frozen=True, slots=True)
class Cost:
    """The operations of a program that depend on the sizes alone, `scene`, and those of each position, `query`.

    `by_fixed` counts the divisions among the latter whose divisor depends on the sizes alone: each could be a product
    with a reciprocal kept from outside the loop (which rounds otherwise).
    """

    name: str
    title: str
    source: str
    scene: Operations
    query: Operations
    by_fixed: int


@cache
def costs() -> tuple[Cost, ...]:
    """Of every formula, then of the roots' way."""
    sweep = _cost(
        SWEEP, "a sweep of a general root finder (Weierstrass, complex); it takes several", "mpmath's polyroots"
    )
    return (*map(cost_of, (*FORMULAS.values(), *REPAIRED.values())), cost_of(ROOTS_TRIGONOMETRIC), sweep)


def cost_of(formula: Formula) -> Cost:
    """The cost of one formula."""
    return _cost(formula.program, formula.title, formula.source)


def _cost(program: Program, title: str, source: str) -> Cost:
    parts = hoist(program, SIZES_OF_A_SCENE & set(program.inputs))
    fixed = SIZES_OF_A_SCENE | {step.name for step in parts.outside}
    divisors = [step.arguments[1] for step in parts.inside if step.operation == "div"]
    by_fixed = sum(isinstance(divisor, int) or divisor in fixed for divisor in divisors)
    return Cost(program.name, title, source, count(parts.outside), count(parts.inside), by_fixed)


def loop_as_printed() -> Operations:
    """Of the lines that Table 2 prints inside its loop: all but those of A, B, c0 and C."""
    program = FORMULAS["table-2"].program
    before = cut(program, (), ("A", "B", "c0", "C")).steps
    return count(step for step in program.steps if step not in before)


def discriminant_share() -> tuple[int, int]:
    """The rounded operations of Procedure 2.a for a position: those from coefficients to the four Δ(g_i), and all."""
    program = FORMULAS["procedure-2a"].program
    coefficients = ("c0_s", *(f"{name}_g{rotor}" for rotor in ROTORS for name in ("c1", "c2")))
    parts = hoist(program, SIZES_OF_A_SCENE & set(program.inputs))
    of_discriminants = cut(program, coefficients, tuple(f"delta_g{rotor}" for rotor in ROTORS)).steps
    return count(step for step in parts.inside if step in of_discriminants).rounded, count(parts.inside).rounded
