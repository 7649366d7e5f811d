"""Every formula for the relative position, each a straight-line program: as printed, repaired, derived, and by roots.

The paper's procedures stand as they are printed, mistakes included: they are under test. The derived formulas answer
for every size of both bodies.

REPAIRED has the paper's Procedures 1, 2.a and 2.b put right. Procedure 1 asks where Q = 0, in the plane of the waist,
whether the distance from the axis exceeds a + 1: that is E = P − A − 1 > 0 and E² > 4·A. Elsewhere it is as printed.
A test for the ring beside Δ would be right in exact arithmetic but useless in floats, which round Δ to 0 beside the
ring too. Procedures 2.a and 2.b ask for Δ > 0 and not (c2 < 0 and c1 > 0); 2.b asks the rotors wherever the bounding
spheroid is not interior, and not only where Δ ≤ 0. The chains "Procedure 1, repaired" and "Proposition 5, repaired"
prove them.

ROOTS_TRIGONOMETRIC and SWEEP compute the roots of g. They are counted beside the other formulas, which need no root.

`costs` counts the operations of each formula from its program: once for a scene, and for each position.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

from hypcheck.derivation import listings
from hypcheck.derivation.evaluation import Arithmetic, Evaluator
from hypcheck.derivation.paper_listings import ONE_ROTOR, ROTORS, TRIGONOMETRIC, WEIERSTRASS_SWEEP, rotors_decided
from hypcheck.derivation.program import Operations, Program, count, cut, hoist, program_of
from hypcheck.geometry.pair import COLUMNS

REGIMES = ("a>=1", "c2>=a")
"""Conditions the paper's statements carry: α/b ≥ 1, and (γ/d)² ≥ α/b."""

ROTOR_INPUTS = ("alpha", "gamma", "b_s", "d_s", "x", "y", "z", "l", "cosine", "sine")
HULL_INPUTS = ("alpha", "gamma", "b", "d", "b_s", "d_s", "x", "y", "z", "l", "cosine", "sine")


@dataclass(frozen=True)
class Formula:
    """A program, the question it answers and the step that holds the answer.

    `question` is "position" (+1, 0, −1), "exterior" or "interior" (1 yes, 0 no). `source` says where it is printed or
    derived. `regimes` are conditions out of REGIMES, all of which must hold where the formula claims to be right; none
    means everywhere.
    """

    name: str
    title: str
    question: str
    program: Program
    answer: str
    source: str
    regimes: tuple[str, ...] = ()

    @property
    def classifies_pairs(self) -> bool:
        """Whether the inputs are the seven columns of a pair and nothing else."""
        return self.program.inputs == COLUMNS


def answers(formula: Formula, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> Any:
    """Compute the answer to the formula's question: an int in exact arithmetic, an int8 array in machine arithmetic.

    `inputs` maps the program's inputs to numbers or arrays. Raises ValueError where one that matters is missing.
    """
    return answering(formula, arithmetic)(inputs)


def answering(formula: Formula, arithmetic: Arithmetic) -> Callable[[Mapping[str, Any]], Any]:
    """Return a function from the inputs by name to the formula's answers, prepared once for many calls."""
    evaluate = Evaluator(formula.program, arithmetic, (formula.answer,))
    return lambda inputs: arithmetic.integers(*evaluate(inputs))


_PRINTED_AND_DERIVED = (
    Formula(
        name="table-2",
        title="Table 2, Procedure 1 with constant terms taken out of the loop",
        question="exterior",
        program=program_of("table-2", COLUMNS, listings.TABLE_2, listings.TABLE_2_DISCRIMINANT, listings.PROPOSITION_3),
        answer="valid",
        source="Table 2",
        regimes=("c2>=a",),
    ),
    Formula(
        name="procedure-1",
        title="Procedure 1 with equations (14) and (13)",
        question="exterior",
        program=program_of(
            "procedure-1", COLUMNS, listings.EQUATION_14, listings.equation_13(), listings.PROPOSITION_3
        ),
        answer="valid",
        source="Table 1, equations (13) and (14)",
        regimes=("c2>=a",),
    ),
    Formula(
        name="procedure-2a",
        title="Procedure 2.a, four rotors",
        question="interior",
        program=program_of("procedure-2a", ROTOR_INPUTS, rotors_decided("valid")),
        answer="valid",
        source="Table 3, equations (13), (19), (20) and (21)",
        regimes=("a>=1",),
    ),
    Formula(
        name="procedure-2b",
        title="Procedure 2.b, the bounding spheroid first and its four rotors where Δ ≤ 0",
        question="interior",
        program=program_of(
            "procedure-2b",
            HULL_INPUTS,
            listings.EQUATION_14,
            listings.equation_13(),
            "touching = delta <= 0",
            rotors_decided("rotors_valid"),
            listings.proposition_5(),
            "valid = touching ? rotors_valid : inside",
        ),
        answer="valid",
        source="Table 4, equations (13), (14), (19), (20) and (21)",
        regimes=("a>=1",),
    ),
    Formula(
        name="procedure-2a-spheroid",
        title="Procedure 2.a's test of one spheroid, with equations (19) to (21) at l = 0",
        question="interior",
        program=program_of("procedure-2a-spheroid", COLUMNS, ONE_ROTOR, listings.equation_13(), listings.ONE_SPHEROID),
        answer="valid",
        source="Table 3, equations (13), (19), (20) and (21)",
        regimes=("a>=1",),
    ),
    Formula(
        name="procedure-2b-spheroid",
        title="Procedure 2.b's test of the bounding spheroid, with equations (14) and (13)",
        question="interior",
        program=program_of(
            "procedure-2b-spheroid", COLUMNS, listings.EQUATION_14, listings.equation_13(), listings.ONE_SPHEROID
        ),
        answer="valid",
        source="Table 4, equations (13) and (14)",
        regimes=("a>=1",),
    ),
    Formula(
        name="coefficients",
        title="signs of Δ and of the coefficients, for every size",
        question="position",
        program=program_of(
            "coefficients", COLUMNS, listings.TABLE_2, listings.TABLE_2_DISCRIMINANT, listings.all_regimes("delta")
        ),
        answer="position",
        source="docs/mathematics.md, coefficient form",
    ),
    Formula(
        name="hessian",
        title="the coefficient rule with 3Δ = 4 h1 h3 − h2²",
        question="position",
        program=program_of(
            "hessian", COLUMNS, listings.TABLE_2, listings.HESSIAN_DISCRIMINANT, listings.all_regimes("delta_3")
        ),
        answer="position",
        source="docs/mathematics.md, Hessian discriminant",
    ),
    Formula(
        name="shared",
        title="the coefficient rule with one cancellation for both coefficients",
        question="position",
        program=program_of(
            "shared",
            COLUMNS,
            listings.SHARED_CANCELLATION,
            listings.HESSIAN_DISCRIMINANT,
            listings.all_regimes("delta_3"),
        ),
        answer="position",
        source="docs/mathematics.md, shared cancellation",
    ),
    Formula(
        name="local-maximum",
        title="the sign of g at its local maximum",
        question="position",
        program=program_of("local-maximum", COLUMNS, listings.TABLE_2, listings.LOCAL_MAXIMUM),
        answer="position",
        source="docs/mathematics.md, local maximum",
    ),
    Formula(
        name="dual",
        title="the sign of the dual function φ at a given λ",
        question="position",
        program=program_of("dual", (*COLUMNS, "lambda_"), listings.SCALED_SIZES, listings.CENTRE, listings.DUAL),
        answer="position",
        source="docs/mathematics.md, dual form",
    ),
)

FORMULAS: dict[str, Formula] = {formula.name: formula for formula in _PRINTED_AND_DERIVED}
"""Formulas by name. "dual" takes a λ as an eighth input, lambda_; its answer 0 means that this λ proves nothing."""


_IN_THE_PLANE_OF_THE_WAIST = """
    at_waist = Q == 0
    P_minus_A = P - A
    E = P_minus_A - 1
    EE = E * E
    four_A = 4 * A
    beyond = E > 0
    wide_apart = EE > four_A
    clear_at_waist = beyond and wide_apart
    answer = at_waist ? clear_at_waist : valid
"""

_HULL = (
    listings.not_all_positive()
    + """
    distinct = delta > 0
    inside = distinct and some_negative
    unclear = not inside
    valid = inside or rotors_valid
"""
)

_REPAIRED = (
    Formula(
        name="procedure-1-repaired",
        title="Procedure 1 put right: in the plane of the waist r > a + 1, elsewhere Table 2",
        question="exterior",
        program=program_of(
            "procedure-1-repaired",
            COLUMNS,
            listings.TABLE_2,
            listings.TABLE_2_DISCRIMINANT,
            listings.PROPOSITION_3,
            _IN_THE_PLANE_OF_THE_WAIST,
        ),
        answer="answer",
        source="docs/mathematics.md, procedures put right",
        regimes=("c2>=a",),
    ),
    Formula(
        name="procedure-2a-repaired",
        title="Procedure 2.a put right: Δ > 0 and not (c2 < 0 and c1 > 0) for each rotor",
        question="interior",
        program=program_of(
            "procedure-2a-repaired", ROTOR_INPUTS, rotors_decided("valid", listings.not_all_positive, "some_negative")
        ),
        answer="valid",
        source="docs/mathematics.md, procedures put right",
        regimes=("a>=1",),
    ),
    Formula(
        name="procedure-2b-repaired",
        title="Procedure 2.b put right: the rotors are asked wherever the bounding spheroid is not interior",
        question="interior",
        program=program_of(
            "procedure-2b-repaired",
            HULL_INPUTS,
            listings.EQUATION_14,
            listings.equation_13(),
            rotors_decided("rotors_valid", listings.not_all_positive, "some_negative"),
            _HULL,
        ),
        answer="valid",
        source="docs/mathematics.md, procedures put right",
        regimes=("a>=1",),
    ),
)

REPAIRED = MappingProxyType({formula.name: formula for formula in _REPAIRED})
"""The repaired procedures by name: that of the printed procedure followed by "-repaired"."""


ROOTS_TRIGONOMETRIC = Formula(
    name="roots-trigonometric",
    title="Δ, and where it is positive the signs of the three roots, by cosines",
    question="exterior",
    program=program_of("roots-trigonometric", COLUMNS, listings.TABLE_2, TRIGONOMETRIC),
    answer="valid",
    source="section 3.1, after its words on [13]",
    regimes=("c2>=a",),
)

APPROXIMATIONS = ("x1", "y1", "x2", "y2", "x3", "y3")

SWEEP = program_of("roots-sweep", ("c2", "c1", "c0", *APPROXIMATIONS), WEIERSTRASS_SWEEP)
"""One iteration of a root finder, from approximations x + yi of the three roots to better ones, new_x1 … new_y3."""


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
    """Count the operations of every formula, then of computing the roots."""
    sweep = _cost(
        SWEEP, "a sweep of a general root finder (Weierstrass, complex); it takes several", "mpmath's polyroots"
    )
    return (*map(cost_of, (*FORMULAS.values(), *REPAIRED.values())), cost_of(ROOTS_TRIGONOMETRIC), sweep)


def cost_of(formula: Formula) -> Cost:
    """Count the operations of one formula."""
    return _cost(formula.program, formula.title, formula.source)


def _cost(program: Program, title: str, source: str) -> Cost:
    """Count the operations of a program, once for a scene and for each position."""
    parts = hoist(program, SIZES_OF_A_SCENE & set(program.inputs))
    fixed = SIZES_OF_A_SCENE | {step.name for step in parts.outside}
    divisors = [step.arguments[1] for step in parts.inside if step.operation == "div"]
    by_fixed = sum(isinstance(divisor, int) or divisor in fixed for divisor in divisors)
    return Cost(program.name, title, source, count(parts.outside), count(parts.inside), by_fixed)


def loop_as_printed() -> Operations:
    """Count the operations of the lines that Table 2 prints inside its loop: all but those of A, B, c0 and C."""
    program = FORMULAS["table-2"].program
    before = cut(program, (), ("A", "B", "c0", "C")).steps
    return count(step for step in program.steps if step not in before)


def discriminant_share() -> tuple[int, int]:
    """Count the rounded operations of Procedure 2.a for a position: those for the four Δ(g_i), and all."""
    program = FORMULAS["procedure-2a"].program
    coefficients = ("c0_s", *(f"{name}_g{rotor}" for rotor in ROTORS for name in ("c1", "c2")))
    parts = hoist(program, SIZES_OF_A_SCENE & set(program.inputs))
    of_discriminants = cut(program, coefficients, tuple(f"delta_g{rotor}" for rotor in ROTORS)).steps
    return count(step for step in parts.inside if step in of_discriminants).rounded, count(parts.inside).rounded
