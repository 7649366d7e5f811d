"""The proof that each program computes its formula: what each step must equal, over sympy, and each decision.

The numbers of a program are evaluated in symbols and compared with the derivation. Its decision is tested for every
combination of signs (decisions.py). The rules themselves rest on the identities of links.py and on the argument in
listings.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy

from hypcheck.derivation import links, pencil
from hypcheck.derivation.decisions import DecisionRule, decisions
from hypcheck.derivation.evaluation import OPERATORS, Arithmetic, evaluate, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, Formula
from hypcheck.derivation.paper_listings import ROTORS
from hypcheck.derivation.pencil import (
    ARM,
    COSINE,
    IN_SEVEN,
    LAMBDA,
    ROTOR_B,
    ROTOR_D,
    SINE,
    A,
    B,
    P,
    Q,
    difference,
    next_rotor,
    plain,
    rotor_cubic,
    symbol,
)
from hypcheck.derivation.program import Program, cut

SYMBOLIC = Arithmetic(
    name="symbolic",
    convert=sympy.sympify,
    operations={
        **OPERATORS,
        "sqrt": sympy.sqrt,
        "cos": sympy.cos,
        "arccos": sympy.acos,
        "eq": sympy.Equality,
        "ne": sympy.Unequality,
        "not": sympy.Not,
        "select": lambda condition, yes, no: sympy.Piecewise((yes, condition), (no, True)),
    },
)
"""Inputs may be expressions, integers or rationals; comparisons become relations, and a selection is a Piecewise."""


INPUTS = {
    **dict(zip(("alpha", "gamma", "b", "d", "x", "y", "z"), pencil.SEVEN, strict=True)),
    "b_s": ROTOR_B,
    "d_s": ROTOR_D,
    "l": ARM,
    "cosine": COSINE,
    "sine": SINE,
    "lambda_": LAMBDA,
}
"""The letter that each input of a program represents."""


@dataclass(frozen=True)
class Obligation:
    """The step must equal `expected`, as an expression in the inputs and in the steps named in `letters`.

    A step named there counts as a letter of its own; its own obligation says what it is.
    """

    step: str
    expected: sympy.Expr
    letters: tuple[str, ...] = ()


def obligations(formula_name: str) -> tuple[Obligation, ...]:
    """All that the numbers of the formula by that name must be. Raises KeyError for a name that has none."""
    return tuple(_OBLIGATIONS[formula_name]())


def letter(name: str) -> sympy.Symbol:
    """The symbol of an input or of a step that counts as a letter."""
    return INPUTS.get(name) or symbol(name)


_COEFFICIENTS = ("c0", "c1", "c2")


def _coefficients() -> Iterable[Obligation]:
    derived = pencil.cubic_in_seven()
    yield from (Obligation(name, getattr(derived, name)) for name in _COEFFICIENTS)


def _scaled_sizes() -> Iterable[Obligation]:
    return (Obligation(name, IN_SEVEN[of]) for name, of in (("A", A), ("B", B), ("Q", Q)))


def _discriminant() -> Iterable[Obligation]:
    yield Obligation("delta", pencil.discriminant_of_cubic(), _COEFFICIENTS)


def _hessian() -> Iterable[Obligation]:
    for name, expected in zip(("h1", "h2", "h3"), links.hessian_coefficients(), strict=True):
        yield Obligation(name, expected, _COEFFICIENTS)
    yield Obligation("delta_3", 3 * pencil.discriminant_of_cubic(), _COEFFICIENTS)


def _slopes() -> Iterable[Obligation]:
    slope = sympy.diff(links.GENERIC_CUBIC, LAMBDA)
    letters = ("c1", "c2", "A", "B")
    yield Obligation("slope_at_B", slope.subs(LAMBDA, B), letters)
    yield Obligation("slope_at_minus_A", slope.subs(LAMBDA, -A), letters)


def _shared() -> Iterable[Obligation]:
    yield Obligation("E", (P - A - 1).subs(IN_SEVEN))


def _in_the_plane() -> Iterable[Obligation]:
    yield Obligation("EE", symbol("E") ** 2, ("E",))
    yield Obligation("four_A", 4 * A, ("A",))


def _local_maximum() -> Iterable[Obligation]:
    h1 = links.hessian_coefficients()[0]
    yield Obligation("h1", h1, ("c1", "c2"))
    yield Obligation("from_c1", links.local_maximum(), ("c1", "c2"))
    yield Obligation("from_c2", links.local_maximum(), ("c1", "c2"))
    yield Obligation("g_m", links.GENERIC_CUBIC.subs(LAMBDA, symbol("lambda_m")), (*_COEFFICIENTS, "lambda_m"))


def _dual() -> Iterable[Obligation]:
    yield from (Obligation(name, IN_SEVEN[of]) for name, of in (("A", A), ("B", B), ("P", P), ("Q", Q)))
    yield Obligation("phi", links.PHI, ("A", "B", "P", "Q", "lambda_"))


def _four_rotors() -> Iterable[Obligation]:
    derived = rotor_cubic()
    yield Obligation("c0_s", derived.c0)
    c1, c2 = derived.c1, derived.c2
    for rotor in ROTORS:
        yield Obligation(f"c1_g{rotor}", c1)
        yield Obligation(f"c2_g{rotor}", c2)
        letters = ("c0_s", f"c1_g{rotor}", f"c2_g{rotor}")
        renamed = dict(zip((links.C0, links.C1, links.C2), (symbol(name) for name in letters), strict=True))
        yield Obligation(f"delta_g{rotor}", pencil.discriminant_of_cubic().subs(renamed), letters)
        c1, c2 = next_rotor(c1), next_rotor(c2)


def _trigonometric() -> Iterable[Obligation]:
    """λ = (2 √h1 cos θ_k − c2)/3 with cos 3θ = w/(2 h1 √h1), a third of a turn from one θ_k to the next."""
    h1 = links.hessian_coefficients()[0]
    w = 9 * links.C1 * links.C2 - 2 * links.C2**3 - 27 * links.C0
    root, three_theta = symbol("root"), symbol("three_theta")
    yield Obligation("delta_27", 27 * pencil.discriminant_of_cubic(), _COEFFICIENTS)
    yield Obligation("root", sympy.sqrt(h1), ("c1", "c2"))
    yield Obligation("cosine_of_three", w / (2 * h1 * root), (*_COEFFICIENTS, "root"))
    for number, thirds in ((1, 0), (2, 1), (3, -1)):
        cosine = sympy.cos(three_theta / 3 + thirds * 2 * sympy.pi / 3)
        yield Obligation(f"cosine_{number}", cosine, ("three_theta",))
        value = (2 * root * symbol(f"cosine_{number}") - links.C2) / 3
        yield Obligation(f"r{number}", value, ("c2", "root", f"cosine_{number}"))


def _all(*parts: Callable[[], Iterable[Obligation]]) -> Callable[[], Iterable[Obligation]]:
    return lambda: [obligation for part in parts for obligation in part()]


_OBLIGATIONS = {
    "table-2": _all(_coefficients, _discriminant),
    "procedure-1": _all(_coefficients, _discriminant),
    "procedure-2a": _all(_four_rotors),
    "procedure-2b": _all(_coefficients, _discriminant, _four_rotors),
    "procedure-2a-spheroid": _all(_coefficients, _discriminant),
    "procedure-2b-spheroid": _all(_coefficients, _discriminant),
    "coefficients": _all(_scaled_sizes, _coefficients, _discriminant, _slopes),
    "hessian": _all(_scaled_sizes, _coefficients, _hessian, _slopes),
    "shared": _all(_scaled_sizes, _shared, _coefficients, _hessian, _slopes),
    "local-maximum": _all(_scaled_sizes, _coefficients, _local_maximum),
    "dual": _all(_dual),
    "roots-trigonometric": _all(_coefficients, _trigonometric),
    "procedure-1-repaired": _all(_coefficients, _discriminant, _scaled_sizes, _shared, _in_the_plane),
    "procedure-2a-repaired": _all(_four_rotors),
    "procedure-2b-repaired": _all(_coefficients, _discriminant, _four_rotors),
}


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
    proofs = [Proof("derivation", text, links.vanishes(gap), text) for text, gap in links.identities().items()]
    for formula in (*FORMULAS.values(), *REPAIRED.values()):
        proofs.extend(proofs_of(formula))
    proofs.extend(_prove_one_rotor())
    return tuple(proofs)


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
    step, letters = obligation.step, obligation.letters
    part = cut(formula.program, letters, (step,))
    (value,) = outputs(part, SYMBOLIC, {name: letter(name) for name in part.inputs}, (step,))
    of = f" of {', '.join(letters)}" if letters else ""
    statement = f"{step}{of} is {plain(obligation.expected)}"
    return Proof(formula.name, step, _equal(value, obligation.expected), statement)


def _equal(value: sympy.Expr, expected: sympy.Expr) -> bool:
    """Whether the two are one function; a value that is nowhere defined equals nothing."""
    return not value.has(sympy.zoo, sympy.nan) and bool(difference(value, expected) == 0)


def _prove_decision(formula: Formula, decision: DecisionRule) -> Proof:
    part = cut(formula.program, decision.letters, (decision.step,))
    # Nothing but the letters may have a say in the decision.
    holds = part.inputs == decision.letters and _decides(part, decision)
    return Proof(formula.name, decision.step, holds, f"{decision.statement} ({len(decision.cases)} cases)")


def _decides(part: Program, decision: DecisionRule) -> bool:
    """Whether the program decides every case by the rule; all cases are evaluated at once, as arrays.

    Whole numbers below 2⁵³ are exact in float64, and what is not a whole number there proves nothing.
    """
    columns = np.array(decision.cases, dtype=np.float64).T
    values = evaluate(part, float_arithmetic("float64"), dict(zip(decision.letters, columns, strict=True)))
    if not all(np.all(np.abs(value) < 2.0**53) and np.all(value == np.floor(value)) for value in values.values()):
        return False
    expected = [decision.rule(*case) for case in decision.cases]
    return bool(np.array_equal(np.broadcast_to(values[decision.step], len(expected)), expected))


def _prove_one_rotor() -> Iterable[Proof]:
    """Prove that each rotor of Procedure 2.a has procedure-2a-spheroid's coefficients if l = 0, b_s = b and d_s = d."""
    rotors, spheroid = FORMULAS["procedure-2a"].program, FORMULAS["procedure-2a-spheroid"].program
    inputs = {**INPUTS, "b_s": INPUTS["b"], "d_s": INPUTS["d"], "l": sympy.Integer(0)}
    pairs = [("c0", "c0_s"), *((name, f"{name}_g{rotor}") for rotor in ROTORS for name in ("c1", "c2"))]
    for own, of_rotor in pairs:
        (value,) = outputs(spheroid, SYMBOLIC, INPUTS, (own,))
        (expected,) = outputs(rotors, SYMBOLIC, inputs, (of_rotor,))
        statement = f"{own} is Procedure 2.a's {of_rotor} with l = 0, b_s = b, d_s = d"
        yield Proof("procedure-2a-spheroid", own, _equal(value, expected), statement)
