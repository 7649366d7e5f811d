"""Operations of each formula, counted from its program: once for a scene, and for each position.

`hoist` and `split` take the steps that depend on the sizes alone out of the loop over centres, as the paper's Table 2
does; `loop_body` evaluates what stays inside.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from hypcheck.derivation.evaluation import Arithmetic, Evaluator
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, ROOTS_TRIGONOMETRIC, SWEEP, Formula
from hypcheck.derivation.paper_listings import ROTORS
from hypcheck.derivation.program import NUMBER, Operations, Program, Step, count, cut, kind_of


@dataclass(frozen=True, slots=True)
class Hoisting:
    """A program's steps in two parts: those that depend on fixed inputs alone, and those that move with the rest."""

    outside: tuple[Step, ...]
    inside: tuple[Step, ...]


def hoist(program: Program, fixed: Collection[str]) -> Hoisting:
    """The program's steps, parted by whether they depend on the `fixed` inputs (and constants) alone.

    Raises ValueError where one of these is no input of the program.
    """
    unknown = sorted(set(fixed) - set(program.inputs))
    if unknown:
        raise ValueError(f"program {program.name} has no input {', '.join(unknown)}")
    known = set(fixed)
    outside, inside = [], []
    for step in program.steps:
        if known.issuperset(step.reads):
            known.add(step.name)
            outside.append(step)
        else:
            inside.append(step)
    return Hoisting(tuple(outside), tuple(inside))


def split(program: Program, wanted: tuple[str, ...], fixed: tuple[str, ...]) -> tuple[Program, Program]:
    """A program in two: what the fixed inputs alone decide, and what is left, up to the wanted names.

    Inputs of a program are numbers, so a comparison of fixed numbers stays in the second part: it costs one operation.
    Raises KeyError where a wanted name does not exist.
    """
    kinds = dict.fromkeys(program.inputs, NUMBER)
    for step in program.steps:
        kinds[step.name] = kind_of(step, kinds)
    numbers = [step.name for step in hoist(program, fixed).outside if kinds[step.name] == NUMBER]
    left = cut(program, numbers, wanted)
    read = {name for step in left.steps for name in step.reads} | set(wanted)
    known = [name for name in numbers if name in read]
    return cut(program, fixed, known), cut(program, known, wanted)


def loop_body(
    program: Program, arithmetic: Arithmetic, constants: Mapping[str, Any], wanted: Iterable[str]
) -> Evaluator:
    """From the other inputs to the wanted values, bit for bit as without hoisting.

    Every number that depends on the constants alone is computed here, once. The constants may be arrays (the sizes of
    many trees). Raises KeyError where a wanted name does not exist.
    """
    names = tuple(wanted)
    before, body = split(program, names, tuple(constants))
    known = tuple(step.name for step in before.steps)
    values = Evaluator(before, arithmetic, known)(constants)
    return Evaluator(body, arithmetic, names, {**constants, **dict(zip(known, values, strict=True))})


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
