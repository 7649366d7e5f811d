"""Every way to compute the relative position that this project knows, each as a straight-line program.

The paper's procedures stand as they are printed, mistakes included; they are what is under test. The others answer for
every size of both bodies.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.derivation.coefficient_listings import (
    CENTRE,
    EQUATION_14,
    HESSIAN_DISCRIMINANT,
    SCALED_SIZES,
    SHARED_CANCELLATION,
    TABLE_2,
    TABLE_2_DISCRIMINANT,
    equation_13,
)
from hypcheck.derivation.decision_listings import (
    DUAL,
    LOCAL_MAXIMUM,
    ONE_SPHEROID,
    PROPOSITION_3,
    all_regimes,
    proposition_5,
)
from hypcheck.derivation.evaluation import Arithmetic, outputs
from hypcheck.derivation.listing import program_of
from hypcheck.derivation.program import Program
from hypcheck.derivation.rotor_listings import ONE_ROTOR, rotors_decided
from hypcheck.pairs import COLUMNS

REGIMES = ("a>=1", "c2>=a")
"""Conditions the paper's statements carry: α/b ≥ 1, and (γ/d)² ≥ α/b."""

ROTOR_INPUTS = ("alpha", "gamma", "b_s", "d_s", "x", "y", "z", "l", "cosine", "sine")
HULL_INPUTS = ("alpha", "gamma", "b", "d", "b_s", "d_s", "x", "y", "z", "l", "cosine", "sine")


@dataclass(frozen=True)
class Formula:
    """A program, the question it answers and the step that holds the answer.

    `question` is "position" (+1, 0, −1), "exterior" or "interior" (1 yes, 0 no). `source` says where it is printed or
    derived. `regimes` are conditions out of REGIMES, all of which must hold where the formula claims to be right; none
    means everywhere. `as_printed` marks the paper's own.
    """

    name: str
    title: str
    question: str
    program: Program
    answer: str
    source: str
    regimes: tuple[str, ...] = ()
    as_printed: bool = False

    @property
    def classifies_pairs(self) -> bool:
        """True where the inputs are the seven columns of a pair and nothing else."""
        return self.program.inputs == COLUMNS


def answers(formula: Formula, arithmetic: Arithmetic, inputs: Mapping[str, Any]) -> Any:
    """The answer to the formula's question: an int in exact arithmetic, an int8 array in machine arithmetic.

    `inputs` maps the program's inputs to numbers or arrays. Raises ValueError where one that matters is missing.
    """
    (answer,) = outputs(formula.program, arithmetic, inputs, (formula.answer,))
    return arithmetic.integers(answer)


_LISTED = (
    Formula(
        name="table-2",
        title="Table 2, Procedure 1 with constant terms taken out of the loop",
        question="exterior",
        program=program_of("table-2", COLUMNS, TABLE_2, TABLE_2_DISCRIMINANT, PROPOSITION_3),
        answer="valid",
        source="Table 2",
        regimes=("c2>=a",),
        as_printed=True,
    ),
    Formula(
        name="procedure-1",
        title="Procedure 1 with equations (14) and (13)",
        question="exterior",
        program=program_of("procedure-1", COLUMNS, EQUATION_14, equation_13(), PROPOSITION_3),
        answer="valid",
        source="Table 1, equations (13) and (14)",
        regimes=("c2>=a",),
        as_printed=True,
    ),
    Formula(
        name="procedure-2a",
        title="Procedure 2.a, four rotors",
        question="interior",
        program=program_of("procedure-2a", ROTOR_INPUTS, rotors_decided("valid")),
        answer="valid",
        source="Table 3, equations (13), (19), (20) and (21)",
        regimes=("a>=1",),
        as_printed=True,
    ),
    Formula(
        name="procedure-2b",
        title="Procedure 2.b, the bounding spheroid first and its four rotors where Δ ≤ 0",
        question="interior",
        program=program_of(
            "procedure-2b",
            HULL_INPUTS,
            EQUATION_14,
            equation_13(),
            "touching = delta <= 0",
            rotors_decided("rotors_valid"),
            proposition_5(),
            "valid = touching ? rotors_valid : inside",
        ),
        answer="valid",
        source="Table 4, equations (13), (14), (19), (20) and (21)",
        regimes=("a>=1",),
        as_printed=True,
    ),
    Formula(
        name="procedure-2a-spheroid",
        title="Procedure 2.a's test of one spheroid, with equations (19) to (21) at l = 0",
        question="interior",
        program=program_of("procedure-2a-spheroid", COLUMNS, ONE_ROTOR, equation_13(), ONE_SPHEROID),
        answer="valid",
        source="Table 3, equations (13), (19), (20) and (21)",
        regimes=("a>=1",),
        as_printed=True,
    ),
    Formula(
        name="procedure-2b-spheroid",
        title="Procedure 2.b's test of the bounding spheroid, with equations (14) and (13)",
        question="interior",
        program=program_of("procedure-2b-spheroid", COLUMNS, EQUATION_14, equation_13(), ONE_SPHEROID),
        answer="valid",
        source="Table 4, equations (13) and (14)",
        regimes=("a>=1",),
        as_printed=True,
    ),
    Formula(
        name="coefficients",
        title="signs of Δ and of the coefficients, for every size",
        question="position",
        program=program_of("coefficients", COLUMNS, TABLE_2, TABLE_2_DISCRIMINANT, all_regimes("delta")),
        answer="position",
        source="docs/mathematics.md, coefficient form",
    ),
    Formula(
        name="hessian",
        title="the coefficient rule with 3Δ = 4 h1 h3 − h2²",
        question="position",
        program=program_of("hessian", COLUMNS, TABLE_2, HESSIAN_DISCRIMINANT, all_regimes("delta_3")),
        answer="position",
        source="docs/mathematics.md, Hessian discriminant",
    ),
    Formula(
        name="shared",
        title="the coefficient rule with one cancellation for both coefficients",
        question="position",
        program=program_of("shared", COLUMNS, SHARED_CANCELLATION, HESSIAN_DISCRIMINANT, all_regimes("delta_3")),
        answer="position",
        source="docs/mathematics.md, shared cancellation",
    ),
    Formula(
        name="local-maximum",
        title="the sign of g at its local maximum",
        question="position",
        program=program_of("local-maximum", COLUMNS, TABLE_2, LOCAL_MAXIMUM),
        answer="position",
        source="docs/mathematics.md, local maximum",
    ),
    Formula(
        name="dual",
        title="the sign of the dual function φ at a given λ",
        question="position",
        program=program_of("dual", (*COLUMNS, "lambda_"), SCALED_SIZES, CENTRE, DUAL),
        answer="position",
        source="docs/mathematics.md, dual form",
    ),
)

FORMULAS: dict[str, Formula] = {formula.name: formula for formula in _LISTED}
"""By name. "dual" takes the λ to look at as an eighth input, lambda_: 0 from it means that this λ proves nothing."""
