"""The paper's Procedures 1, 2.a and 2.b put right, as programs beside those that are printed (formulas.py).

Procedure 1 asks where Q = 0, in the plane of the waist, whether the distance from the axis exceeds a + 1: that is
E = P − A − 1 > 0 and E² > 4·A. Elsewhere it is as printed. A test for the ring beside Δ would be right in exact
arithmetic and useless in floats, which round Δ to 0 beside the ring too. Procedures 2.a and 2.b ask for Δ > 0 and not
(c2 < 0 and c1 > 0); 2.b asks the rotors wherever the bounding spheroid is not interior, and not only where Δ ≤ 0. The
chains "Procedure 1, repaired" and "Proposition 5, repaired" prove them.
"""

from __future__ import annotations

from types import MappingProxyType

from hypcheck.derivation.coefficient_listings import EQUATION_14, TABLE_2, TABLE_2_DISCRIMINANT, equation_13
from hypcheck.derivation.decision_listings import PROPOSITION_3, not_all_positive
from hypcheck.derivation.formulas import HULL_INPUTS, ROTOR_INPUTS, Formula
from hypcheck.derivation.listing import program_of
from hypcheck.derivation.rotor_listings import rotors_decided
from hypcheck.pairs import COLUMNS

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
    not_all_positive()
    + """
    distinct = delta > 0
    inside = distinct and some_negative
    unclear = not inside
    valid = inside or rotors_valid
"""
)

_LISTED = (
    Formula(
        name="procedure-1-repaired",
        title="Procedure 1 put right: in the plane of the waist r > a + 1, elsewhere Table 2",
        question="exterior",
        program=program_of(
            "procedure-1-repaired",
            COLUMNS,
            TABLE_2,
            TABLE_2_DISCRIMINANT,
            PROPOSITION_3,
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
            "procedure-2a-repaired", ROTOR_INPUTS, rotors_decided("valid", not_all_positive, "some_negative")
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
            EQUATION_14,
            equation_13(),
            rotors_decided("rotors_valid", not_all_positive, "some_negative"),
            _HULL,
        ),
        answer="valid",
        source="docs/mathematics.md, procedures put right",
        regimes=("a>=1",),
    ),
)

REPAIRED = MappingProxyType({formula.name: formula for formula in _LISTED})
"""By name: that of the printed procedure and "-repaired"."""
