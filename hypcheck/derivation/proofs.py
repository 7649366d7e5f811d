"""The proof that each program is the formula it is said to be.

Its numbers are evaluated in symbols and compared with the derivation, and its decision is asked for every combination
of signs. What the rules themselves rest on is in identities.py and in the words of decision_listings.py.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy

from hypcheck.derivation.decisions import Decision, decisions
from hypcheck.derivation.differences import difference
from hypcheck.derivation.evaluation import evaluate, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.derivation.identities import identities, vanishes
from hypcheck.derivation.obligations import INPUTS, Obligation, letter, obligations
from hypcheck.derivation.plain_text import plain
from hypcheck.derivation.program import Program, cut
from hypcheck.derivation.repaired_formulas import REPAIRED
from hypcheck.derivation.rotor_listings import ROTORS
from hypcheck.derivation.symbolic import SYMBOLIC


@dataclass(frozen=True)
class Proof:
    """One thing that was to be shown about a formula, and whether it holds.

    `formula` is a name in FORMULAS or REPAIRED, or "derivation" for the identities that the rules rest on; `quantity`
    is the step in question; `statement` says what was compared with what.
    """

    formula: str
    quantity: str
    holds: bool
    statement: str


@cache
def prove_formulas() -> tuple[Proof, ...]:
    """Every proof: the identities, each formula, and that procedure-2a-spheroid is one rotor with l = 0."""
    found = [Proof("derivation", text, vanishes(gap), text) for text, gap in identities()]
    for formula in (*FORMULAS.values(), *REPAIRED.values()):
        found.extend(proofs_of(formula))
    found.extend(_prove_one_rotor())
    return tuple(found)


@cache
def proofs_of(formula: Formula) -> tuple[Proof, ...]:
    """The proofs of a formula, found once in a process."""
    return tuple(prove(formula))


def prove(formula: Formula) -> Iterable[Proof]:
    """The proofs of one formula, by its name: what a program of that name must compute and must decide."""
    for obligation in obligations(formula.name):
        yield _prove_number(formula, obligation)
    for decision in decisions(formula.name):
        yield _prove_decision(formula, decision)


def _prove_number(formula: Formula, obligation: Obligation) -> Proof:
    values = _symbolic_values(formula.program, obligation.letters, obligation.step)
    holds = _equal(values, obligation.expected)
    of = f" of {', '.join(obligation.letters)}" if obligation.letters else ""
    statement = f"{obligation.step}{of} is {plain(obligation.expected)}"
    return Proof(formula.name, obligation.step, holds, statement)


def _symbolic_values(program: Program, letters: tuple[str, ...], step: str) -> sympy.Expr:
    part = cut(program, letters, (step,))
    (value,) = outputs(part, SYMBOLIC, {name: letter(name) for name in part.inputs}, (step,))
    return value


def _equal(value: sympy.Expr, expected: sympy.Expr) -> bool:
    """Whether the two are one function; a value that is nowhere defined equals nothing."""
    return not value.has(sympy.zoo, sympy.nan) and bool(difference(value, expected) == 0)


def _prove_decision(formula: Formula, decision: Decision) -> Proof:
    part = cut(formula.program, decision.letters, (decision.step,))
    # Nothing but the letters may have a say in the decision.
    holds = part.inputs == decision.letters and _decides(part, decision)
    return Proof(formula.name, decision.step, holds, f"{decision.statement} ({len(decision.cases)} cases)")


def _decides(part: Program, decision: Decision) -> bool:
    """Whether the program decides every case by the rule; all are asked at once, as arrays.

    Whole numbers below 2⁵³ are exact in float64, and what is not a whole number there proves nothing.
    """
    columns = np.array(decision.cases, dtype=np.float64).T
    values = evaluate(part, float_arithmetic("float64"), dict(zip(decision.letters, columns, strict=True)))
    if not all(np.all(np.abs(value) < 2.0**53) and np.all(value == np.floor(value)) for value in values.values()):
        return False
    expected = [decision.rule(*case) for case in decision.cases]
    return bool(np.array_equal(np.broadcast_to(values[decision.step], len(expected)), expected))


def _prove_one_rotor() -> Iterable[Proof]:
    """With l = 0, b_s = b and d_s = d each rotor of Procedure 2.a has the coefficients of procedure-2a-spheroid."""
    rotors, spheroid = FORMULAS["procedure-2a"].program, FORMULAS["procedure-2a-spheroid"].program
    inputs = {**INPUTS, "b_s": INPUTS["b"], "d_s": INPUTS["d"], "l": sympy.Integer(0)}
    pairs = [("c0", "c0_s"), *((name, f"{name}_g{rotor}") for rotor in ROTORS for name in ("c1", "c2"))]
    for own, of_rotor in pairs:
        (value,) = outputs(spheroid, SYMBOLIC, INPUTS, (own,))
        (expected,) = outputs(rotors, SYMBOLIC, inputs, (of_rotor,))
        statement = f"{own} is Procedure 2.a's {of_rotor} with l = 0, b_s = b, d_s = d"
        yield Proof("procedure-2a-spheroid", own, _equal(value, expected), statement)
