"""Prove that the program of each formula computes and decides what it must.

The numbers of a program are evaluated in symbols and compared with the derivation. A decision reads its numbers only
through comparisons with 0 and with 3A, −3B, −A, B and B². The values tried meet every combination of outcomes of these
that can occur, so agreement on all of them is agreement everywhere. The rules themselves rest on the identities of
links.py and on the argument in listings.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import sympy

from hypcheck.derivation import links, pencil
from hypcheck.derivation.evaluation import evaluate, outputs
from hypcheck.derivation.float_arithmetic import float_arithmetic
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, Formula
from hypcheck.derivation.paper_listings import ROTORS
from hypcheck.derivation.pencil import INPUTS, LAMBDA, SYMBOLIC, A, B, P, Q, symbol
from hypcheck.derivation.program import Program, cut


@dataclass(frozen=True)
class Obligation:
    """The demand that a step equals `expected`, an expression in the inputs and in the steps named in `letters`.

    A step named there counts as a letter; another obligation says what it must equal.
    """

    step: str
    expected: sympy.Expr
    letters: tuple[str, ...] = ()


def letter(name: str) -> sympy.Symbol:
    """Return the symbol of an input, or of a step that counts as a letter."""
    return INPUTS.get(name) or symbol(name)


_COEFFICIENTS = ("c0", "c1", "c2")


def _coefficients() -> Iterable[Obligation]:
    """Yield what the steps c0, c1 and c2 must be."""
    derived = pencil.cubic_in_seven()
    yield from (Obligation(name, getattr(derived, name)) for name in _COEFFICIENTS)


def _scaled_sizes() -> Iterable[Obligation]:
    """Yield what the steps A, B and Q must be."""
    return (Obligation(name, pencil.IN_SEVEN[of]) for name, of in (("A", A), ("B", B), ("Q", Q)))


def _discriminant() -> Iterable[Obligation]:
    """Yield what the step delta must be."""
    yield Obligation("delta", pencil.discriminant_of_cubic(), _COEFFICIENTS)


def _hessian() -> Iterable[Obligation]:
    """Yield what the coefficients of the Hessian, and three times Δ, must be."""
    for name, expected in zip(("h1", "h2", "h3"), links.hessian_coefficients(), strict=True):
        yield Obligation(name, expected, _COEFFICIENTS)
    yield Obligation("delta_3", 3 * pencil.discriminant_of_cubic(), _COEFFICIENTS)


def _slopes() -> Iterable[Obligation]:
    """Yield what g' at B and at −A must be."""
    slope = sympy.diff(pencil.GENERIC_CUBIC, LAMBDA)
    letters = ("c1", "c2", "A", "B")
    yield Obligation("slope_at_B", slope.subs(LAMBDA, B), letters)
    yield Obligation("slope_at_minus_A", slope.subs(LAMBDA, -A), letters)


def _shared() -> Iterable[Obligation]:
    """Yield what the step E, the difference P − A − 1, must be."""
    yield Obligation("E", (P - A - 1).subs(pencil.IN_SEVEN))


def _in_the_plane() -> Iterable[Obligation]:
    """Yield what the steps of the repaired Procedure 1 for Q = 0 must be: E² and 4A."""
    yield Obligation("EE", symbol("E") ** 2, ("E",))
    yield Obligation("four_A", 4 * A, ("A",))


def _local_maximum() -> Iterable[Obligation]:
    """Yield what the local maximum λm of g, by either of its two formulas, and g(λm) must be."""
    h1 = links.hessian_coefficients()[0]
    yield Obligation("h1", h1, ("c1", "c2"))
    yield Obligation("from_c1", links.local_maximum(), ("c1", "c2"))
    yield Obligation("from_c2", links.local_maximum(), ("c1", "c2"))
    yield Obligation("g_m", pencil.GENERIC_CUBIC.subs(LAMBDA, symbol("lambda_m")), (*_COEFFICIENTS, "lambda_m"))


def _dual() -> Iterable[Obligation]:
    """Yield what A, B, P, Q and φ(λ) must be."""
    yield from (Obligation(name, pencil.IN_SEVEN[of]) for name, of in (("A", A), ("B", B), ("P", P), ("Q", Q)))
    yield Obligation("phi", links.PHI, ("A", "B", "P", "Q", "lambda_"))


def _rotor_numbers() -> Iterable[Obligation]:
    """Yield what the coefficients and the discriminants of the four rotors must be."""
    derived = pencil.rotor_cubic()
    yield Obligation("c0_s", derived.c0)
    c1, c2 = derived.c1, derived.c2
    for rotor in ROTORS:
        yield Obligation(f"c1_g{rotor}", c1)
        yield Obligation(f"c2_g{rotor}", c2)
        letters = ("c0_s", f"c1_g{rotor}", f"c2_g{rotor}")
        renamed = dict(zip((pencil.C0, pencil.C1, pencil.C2), (symbol(name) for name in letters), strict=True))
        yield Obligation(f"delta_g{rotor}", pencil.discriminant_of_cubic().subs(renamed), letters)
        c1, c2 = pencil.next_rotor(c1), pencil.next_rotor(c2)


def _trigonometric() -> Iterable[Obligation]:
    """Yield what the trigonometric formula must compute: the roots λ = (2 √h1 cos θ_k − c2)/3.

    cos 3θ = w/(2 h1 √h1), and the three θ_k are a third of a turn apart.
    """
    h1 = links.hessian_coefficients()[0]
    w = 9 * pencil.C1 * pencil.C2 - 2 * pencil.C2**3 - 27 * pencil.C0
    root, three_theta = symbol("root"), symbol("three_theta")
    yield Obligation("delta_27", 27 * pencil.discriminant_of_cubic(), _COEFFICIENTS)
    yield Obligation("root", sympy.sqrt(h1), ("c1", "c2"))
    yield Obligation("cosine_of_three", w / (2 * h1 * root), (*_COEFFICIENTS, "root"))
    for number, thirds in ((1, 0), (2, 1), (3, -1)):
        cosine = sympy.cos(three_theta / 3 + thirds * 2 * sympy.pi / 3)
        yield Obligation(f"cosine_{number}", cosine, ("three_theta",))
        value = (2 * root * symbol(f"cosine_{number}") - pencil.C2) / 3
        yield Obligation(f"r{number}", value, ("c2", "root", f"cosine_{number}"))


SIGNS = (-1, 0, 1)


@dataclass(frozen=True)
class DecisionRule:
    """The demand that a step equals `rule` of the values of `letters`, for each of the `cases`.

    `letters` names steps or inputs, a case has a value for each of them, and `statement` is the rule in words.
    """

    step: str
    letters: tuple[str, ...]
    cases: tuple[tuple[int, ...], ...]
    rule: Callable[..., int]
    statement: str


def _proposition_3(delta: int, c1: int, c2: int) -> int:
    """Decide exterior by the printed Proposition 3: 1 for yes, 0 for no."""
    return int(delta > 0 and c2 < 0 and c1 > 0)


def _inside(c1: int, c2: int) -> bool:
    """Decide whether c1 and c2 fulfil the printed condition of Proposition 5."""
    return (c2 > 0 and c1 != 0) or (c2 < 0 and c1 < 0)


def _one_spheroid(delta: int, c1: int, c2: int) -> int:
    """Decide interior by the printed Proposition 5 for one spheroid: 1 for yes, 0 for no."""
    return int(not delta <= 0 and _inside(c1, c2))


def _four_rotors(*signs: int, inside: Callable[[int, int], bool] = _inside) -> int:
    """Decide by Procedure 2.a from Δ, c1 and c2 of each rotor: 1 for valid, 0 for not."""
    rotors = tuple(zip(signs[0::3], signs[1::3], signs[2::3], strict=True))
    if any(delta <= 0 for delta, _, _ in rotors):
        return 0
    return int(all(inside(c1, c2) for _, c1, c2 in rotors))


def _hull_then_rotors(delta: int, c1: int, c2: int, *rotors: int) -> int:
    """Decide by the printed Procedure 2.b: the bounding spheroid, or the rotors if its Δ ≤ 0."""
    return _four_rotors(*rotors) if delta <= 0 else int(_inside(c1, c2))


def _some_negative(c1: int, c2: int) -> bool:
    """Decide whether c1 and c2 fulfil the repaired condition of Proposition 5."""
    return not (c2 < 0 and c1 > 0)


def _four_rotors_repaired(*signs: int) -> int:
    """Decide by the repaired Procedure 2.a."""
    return _four_rotors(*signs, inside=_some_negative)


def _hull_then_rotors_repaired(delta: int, c1: int, c2: int, *rotors: int) -> int:
    """Decide by the repaired Procedure 2.b: the bounding spheroid is interior, or all rotors are."""
    return int((delta > 0 and _some_negative(c1, c2)) or _four_rotors_repaired(*rotors))


def _procedure_1_repaired(delta: int, c1: int, c2: int, Q: int, E: int, EE: int, four_A: int) -> int:
    """Decide exterior by the repaired Procedure 1."""
    return int(E > 0 and EE > four_A) if Q == 0 else _proposition_3(delta, c1, c2)


def _all_regimes(delta: int, c1: int, c2: int, A: int, B: int, Q: int, slope_at_B: int, slope_at_minus_A: int) -> int:
    """Decide the position by the coefficient rule for all sizes: 1, −1 or 0."""
    all_positive = c2 < 0 and c1 > 0
    ring = Q == 0 and slope_at_B == 0 and A < B**2
    if ring or (delta > 0 and all_positive and not (c2 < -3 * B and slope_at_B > 0)):
        return 1
    return -1 if delta > 0 and not all_positive and c2 < 3 * A and slope_at_minus_A > 0 else 0


def _side(at: int, A: int, B: int) -> int:
    """Return the sign of a λ if it lies between the poles −A and B, else 0."""
    return (at > 0) - (at < 0) if -A < at < B else 0


_ONE = ("delta", "c1", "c2")
_PATTERNS = tuple(product(SIGNS, repeat=3))
_ROTOR_LETTERS = tuple(f"{name}_g{rotor}" for rotor in ROTORS for name in _ONE)
_RIGHT, _TOUCHING, _OUTSIDE = (1, 1, 1), (0, 1, 1), (1, 1, -1)


def _rotor_cases() -> Iterable[tuple[int, ...]]:
    """Yield cases of Δ, c1 and c2 of the four rotors.

    One rotor has every pattern while the other three are interior; and all mixtures of interior, touching and exterior
    rotors.
    """
    for rotor, pattern in product(range(len(ROTORS)), _PATTERNS):
        yield _RIGHT * rotor + pattern + _RIGHT * (len(ROTORS) - 1 - rotor)
    for mixture in product((_RIGHT, _TOUCHING, _OUTSIDE), repeat=len(ROTORS)):
        yield sum(mixture, ())


_PROPOSITION_3 = DecisionRule("valid", _ONE, _PATTERNS, _proposition_3, "valid ⟺ Δ > 0, c2 < 0 and c1 > 0")
_INTERIOR_RULE = "[c2 > 0; c1 ≠ 0] or [c2 < 0; c1 < 0]"
_ONE_SPHEROID = DecisionRule("valid", _ONE, _PATTERNS, _one_spheroid, f"valid ⟺ not Δ ≤ 0, and {_INTERIOR_RULE}")
_FOUR_ROTORS = DecisionRule(
    "valid",
    _ROTOR_LETTERS,
    tuple(_rotor_cases()),
    _four_rotors,
    f"non-valid if Δ(g_i) ≤ 0 for some i; else valid ⟺ {_INTERIOR_RULE} for all i",
)
_HULL_THEN_ROTORS = DecisionRule(
    "valid",
    (*_ONE, *_ROTOR_LETTERS),
    tuple(hull + rotors for hull, rotors in product(_PATTERNS, _rotor_cases())),
    _hull_then_rotors,
    f"as Procedure 2.a where Δ ≤ 0; else valid ⟺ {_INTERIOR_RULE}",
)
_REPAIRED_RULE = "Δ > 0 and not (c2 < 0 and c1 > 0)"
_FOUR_ROTORS_REPAIRED = DecisionRule(
    "valid", _ROTOR_LETTERS, _FOUR_ROTORS.cases, _four_rotors_repaired, f"valid ⟺ {_REPAIRED_RULE} for each rotor"
)
_HULL_THEN_ROTORS_REPAIRED = DecisionRule(
    "valid",
    _HULL_THEN_ROTORS.letters,
    _HULL_THEN_ROTORS.cases,
    _hull_then_rotors_repaired,
    f"valid ⟺ {_REPAIRED_RULE} for the bounding spheroid, or for each rotor",
)
_PROCEDURE_1_REPAIRED = DecisionRule(
    "answer",
    (*_ONE, "Q", "E", "EE", "four_A"),
    tuple(pattern + rest for pattern in _PATTERNS for rest in product(SIGNS, repeat=4)),
    _procedure_1_repaired,
    "valid ⟺ Q = 0, E > 0 and E² > 4A, or Q ≠ 0, Δ > 0, c2 < 0 and c1 > 0",
)
_SIZES_TRIED = ((1, 1), (1, 2), (2, 1))  # A = B², A < B² and A > B²


def _all_regimes_decision(discriminant: str) -> DecisionRule:
    """Return the rule for all sizes; `discriminant` is the name of the step that has the sign of Δ."""
    # c2 below, at and above −3B, 0 and 3A, for A and B up to 2.
    cases = tuple(
        (delta, c1, c2, *sizes, Q, at_B, at_minus_A)
        for delta, c1, c2, sizes, Q, at_B, at_minus_A in product(
            SIGNS, SIGNS, (-7, -6, -4, -3, -1, 0, 1, 3, 4, 6, 7), _SIZES_TRIED, SIGNS, SIGNS, SIGNS
        )
    )
    letters = (discriminant, "c1", "c2", "A", "B", "Q", "slope_at_B", "slope_at_minus_A")
    return DecisionRule(
        "position",
        letters,
        cases,
        _all_regimes,
        "exterior ⟺ Δ > 0, c2 < 0, c1 > 0 and not (c2 < −3B and g'(B) > 0), or Q = 0, g'(B) = 0 and A < B²; "
        "interior ⟺ Δ > 0, not (c2 < 0 and c1 > 0), c2 < 3A and g'(−A) > 0",
    )


_AROUND = tuple(range(-3, 4))  # below, at, between and above −A, 0 and B, for A and B up to 2
_LOCAL_MAXIMUM = DecisionRule(
    "position",
    ("h1", "lambda_m", "g_m", "A", "B"),
    tuple((h1, at, g, *sizes) for h1, at, g, sizes in product(SIGNS, _AROUND, SIGNS, _SIZES_TRIED)),
    lambda h1, lambda_m, g_m, A, B: _side(lambda_m, A, B) if h1 > 0 and g_m > 0 else 0,
    "the sign of λm where h1 > 0, g(λm) > 0 and −A < λm < B, else contact",
)
_CHOICE = DecisionRule(
    "lambda_m",
    ("c2", "from_c1", "from_c2"),
    tuple((c2, 5, 7) for c2 in SIGNS),
    lambda c2, from_c1, from_c2: from_c1 if c2 < 0 else from_c2,
    "λm = c1/(−c2 + √h1) where c2 < 0, else (−c2 − √h1)/3",
)
_DUAL = DecisionRule(
    "position",
    ("phi", "lambda_", "A", "B"),
    tuple((phi, at, *sizes) for phi, at, sizes in product(SIGNS, _AROUND, _SIZES_TRIED)),
    lambda phi, lambda_, A, B: _side(lambda_, A, B) if phi > 0 else 0,
    "the sign of λ where φ(λ) > 0 and −A < λ < B, else 0",
)

_ALL_POSITIVE = DecisionRule(
    "valid",
    ("delta_27", "r1", "r2", "r3"),
    tuple(product(SIGNS, repeat=4)),
    lambda *signs: int(min(signs) > 0),
    "valid ⟺ Δ > 0 and all three roots are positive",
)

_SIZED = (_scaled_sizes, _coefficients)
_BY_DELTA = (_coefficients, _discriminant)

_REQUIREMENTS: dict[str, tuple[tuple[Callable[[], Iterable[Obligation]], ...], tuple[DecisionRule, ...]]] = {
    "table-2": (_BY_DELTA, (_PROPOSITION_3,)),
    "procedure-1": (_BY_DELTA, (_PROPOSITION_3,)),
    "procedure-2a": ((_rotor_numbers,), (_FOUR_ROTORS,)),
    "procedure-2b": ((*_BY_DELTA, _rotor_numbers), (_HULL_THEN_ROTORS,)),
    "procedure-2a-spheroid": (_BY_DELTA, (_ONE_SPHEROID,)),
    "procedure-2b-spheroid": (_BY_DELTA, (_ONE_SPHEROID,)),
    "coefficients": ((*_SIZED, _discriminant, _slopes), (_all_regimes_decision("delta"),)),
    "hessian": ((*_SIZED, _hessian, _slopes), (_all_regimes_decision("delta_3"),)),
    "shared": ((_scaled_sizes, _shared, _coefficients, _hessian, _slopes), (_all_regimes_decision("delta_3"),)),
    "local-maximum": ((*_SIZED, _local_maximum), (_LOCAL_MAXIMUM, _CHOICE)),
    "dual": ((_dual,), (_DUAL,)),
    "roots-trigonometric": ((_coefficients, _trigonometric), (_ALL_POSITIVE,)),
    "procedure-1-repaired": ((*_BY_DELTA, _scaled_sizes, _shared, _in_the_plane), (_PROCEDURE_1_REPAIRED,)),
    "procedure-2a-repaired": ((_rotor_numbers,), (_FOUR_ROTORS_REPAIRED,)),
    "procedure-2b-repaired": ((*_BY_DELTA, _rotor_numbers), (_HULL_THEN_ROTORS_REPAIRED,)),
}
"""What the numbers and the answer of each formula must be, by its name."""


def decisions(formula_name: str) -> tuple[DecisionRule, ...]:
    """Return the rules that the decisions of the formula by that name must follow.

    Raises KeyError for a name that has none.
    """
    return _REQUIREMENTS[formula_name][1]


@dataclass(frozen=True)
class Proof:
    """One statement about a formula, and whether it was proved.

    `formula` is a name in FORMULAS or REPAIRED, or "derivation" for the identities that the rules rest on; `quantity`
    is the step in question; `statement` says what was compared with what.
    """

    formula: str
    quantity: str
    holds: bool
    statement: str


@cache
def prove_formulas() -> tuple[Proof, ...]:
    """Prove the identities, each formula, and that procedure-2a-spheroid is one rotor with l = 0."""
    proofs = [Proof("derivation", text, links.vanishes(gap), text) for text, gap in links.identities().items()]
    for formula in (*FORMULAS.values(), *REPAIRED.values()):
        proofs.extend(proofs_of(formula))
    proofs.extend(_prove_one_rotor())
    return tuple(proofs)


@cache
def proofs_of(formula: Formula) -> tuple[Proof, ...]:
    """Prove a formula, once in a process; later calls return the same proofs."""
    return tuple(prove(formula))


def prove(formula: Formula) -> Iterable[Proof]:
    """Yield the proofs of one formula: that its program computes and decides what a formula of its name must."""
    for numbers in _REQUIREMENTS[formula.name][0]:
        yield from (_prove_number(formula, obligation) for obligation in numbers())
    for decision in decisions(formula.name):
        yield _prove_decision(formula, decision)


def _prove_number(formula: Formula, obligation: Obligation) -> Proof:
    """Compare a step of the formula's program with the expression that it must equal."""
    step, letters = obligation.step, obligation.letters
    part = cut(formula.program, letters, (step,))
    (value,) = outputs(part, SYMBOLIC, {name: letter(name) for name in part.inputs}, (step,))
    of = f" of {', '.join(letters)}" if letters else ""
    statement = f"{step}{of} is {pencil.plain(obligation.expected)}"
    return Proof(formula.name, step, _equal(value, obligation.expected), statement)


def _equal(value: sympy.Expr, expected: sympy.Expr) -> bool:
    """Decide whether the two are the same function; a value that is nowhere defined equals nothing."""
    return not value.has(sympy.zoo, sympy.nan) and bool(pencil.difference(value, expected) == 0)


def _prove_decision(formula: Formula, decision: DecisionRule) -> Proof:
    """Compare a decision of the formula's program with its rule, on every case."""
    part = cut(formula.program, decision.letters, (decision.step,))
    # The decision may depend on nothing but the letters.
    holds = part.inputs == decision.letters and _decides(part, decision)
    return Proof(formula.name, decision.step, holds, f"{decision.statement} ({len(decision.cases)} cases)")


def _decides(part: Program, decision: DecisionRule) -> bool:
    """Decide whether the program follows the rule in every case; all cases are evaluated at once, as arrays.

    Whole numbers below 2⁵³ are exact in float64. Where any value is not such a number, nothing is proved: False.
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
