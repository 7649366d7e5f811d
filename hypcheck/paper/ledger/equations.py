"""The ledger's lines about displayed formulas: (1) to (23) and those of Appendix A, from their checks (printed.py)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.plain_text import plain, read
from hypcheck.derivation.printed import EquationCheck, check, check_equations
from hypcheck.derivation.printed_equations import equality, printed_claims
from hypcheck.pairs import Position
from hypcheck.paper.ledger.entry import DEFINITION, MISPRINT, PROVED, Entry, Evidence, with_counterexample
from hypcheck.paper.ledger.facts import Facts, Rational, rational, with_c2
from hypcheck.paper.ledger.search import Statement
from hypcheck.paper.ledger.statements import rule_of_all_sizes

_AS_PRINTED = "use it as printed"

# number: section, what it is, what follows
_EQUATIONS = {
    "1": ("2", "the hyperboloid", _AS_PRINTED),
    "2": ("2", "the hyperboloid with a matrix", _AS_PRINTED),
    "3": ("2", "the hyperboloid's matrix", _AS_PRINTED),
    "4": ("2", "the spheroid", _AS_PRINTED),
    "5": ("2", "the spheroid with a matrix", _AS_PRINTED),
    "6": ("2", "the spheroid's matrix", _AS_PRINTED),
    "7": ("2", "the scaled hyperboloid", _AS_PRINTED),
    "8": ("2", "the unit sphere", _AS_PRINTED),
    "9": ("2", "the scaling", _AS_PRINTED),
    "10": ("2", "the scaled hyperboloid's matrix", _AS_PRINTED),
    "11": ("2", "f from g", "harmless: only f's roots are used, and they are right; for f's values divide by a⁴·c²"),
    "12": ("2", "g in a, c and the centre", "do not code from it: (14) and Table 2 have the right c2"),
    "13": ("2", "the discriminant", _AS_PRINTED + "; 3·Δ = 4·h1·h3 − h2² takes fewer operations"),
    "14": ("2", "the coefficients of g", _AS_PRINTED + "; A = (α/b)², B = (γ/d)², P and Q are all it needs"),
    "15": ("3.2", "the rotors' centres", _AS_PRINTED),
    "16": ("3.2", "the hyperboloid scaled for a rotor", _AS_PRINTED),
    "17": ("3.2", "a rotor's unit sphere", _AS_PRINTED),
    "18": ("3.2", "a rotor's distance from the axis", _AS_PRINTED),
    "19": ("3.2", "c0 of every rotor", _AS_PRINTED),
    "20": ("3.2", "C, B1 and B2", _AS_PRINTED),
    "21": ("3.2", "c1 and c2 of a rotor", _AS_PRINTED + "; one cosine and one sine serve all four"),
    "A.1": ("A", "c1 in the rotor's centre", _AS_PRINTED),
    "A.2a": ("A", "c1 by (18)", _AS_PRINTED),
    "A.2b": ("A", "c1 by (18), parted in two", "do not code from it: (21) and (23) are right"),
    "A.3": ("A", "C and A1", _AS_PRINTED),
    "A.4": ("A", "c1 = A1 + (γ/d_s)²·C", _AS_PRINTED),
    "A.5": ("A", "c2 = A2 − C", _AS_PRINTED),
    "A.6": ("A", "A2", _AS_PRINTED),
    "22": ("A", "B1 and B2", _AS_PRINTED),
    "23": ("A", "c1 and c2 of a rotor", _AS_PRINTED),
}

_EXPECTED_MISPRINTS = {"11", "12", "A.2b"}
_DEFINITIONS = {"1", "3", "4", "6", "9", "15", "20", "22", "A.3", "A.6"}

_ASSUMED = {"11": "if f(λ) = det(λH + S), which the text never says: "}
"""What a finding assumes, where the text leaves something open."""


def equations() -> tuple[Entry, ...]:
    """An entry for every displayed formula, in the paper's order."""
    return tuple(map(equation, check_equations()))


def equation(checked: EquationCheck) -> Entry:
    """The entry of one formula; the verdict expected of it is confirmed where the check comes to the same."""
    section, statement, follows = _EQUATIONS[checked.number]
    misprinted = checked.number in _EXPECTED_MISPRINTS
    expected = "misprint" if misprinted else "holds"
    found = Evidence("identity", checked.finding, checked.verdict == expected)
    return Entry(
        number=checked.number if checked.number.startswith("A") else f"({checked.number})",
        section=section,
        statement=statement,
        verdict=MISPRINT if misprinted else DEFINITION if checked.number in _DEFINITIONS else PROVED,
        why=_ASSUMED.get(checked.number, "") + checked.finding,
        follows=follows,
        grounds=lambda: (found, _misled_by_12()) if checked.number == "12" else (found,),
        correction=checked.correction,
        printed=checked.statement,
    )


@cache
def _c2_of_12() -> Rational:
    """The coefficient of λ² that (12) prints, in a, c, x_c, y_c and z_c."""
    (claim,) = (claim for claim in printed_claims() if claim.number == "12")
    ((right, _),) = claim.pairs
    letters = (pencil.SMALL_A, pencil.SMALL_C, pencil.XC, pencil.YC, pencil.ZC)
    return rational(letters, sympy.Poly(right, pencil.LAMBDA).coeff_monomial(pencil.LAMBDA**2))


def _position_by_12(facts: Facts) -> int:
    point = facts.point
    return rule_of_all_sizes(with_c2(facts, _c2_of_12()(point.a, point.c, point.r, 0, point.z)))


_POSITION_BY_12 = Statement(
    "the cubic that (12) prints tells the position",
    lambda _: True,
    lambda facts: _position_by_12(facts) == facts.position,
)


def _misled_by_12() -> Evidence:
    """A pair about which the cubic as printed says something wrong."""
    found = with_counterexample(_POSITION_BY_12)
    said = ", ".join(Position(_position_by_12(each.facts)).label for each in found.witnesses)
    return replace(found, text=f"{found.text}; by (12) as printed {said}") if said else found


def regime_of_section_4() -> Entry:
    """Section 4 writes the regime of Proposition 5 as (a/b) ≥ 1; a is α/b already, by (12)."""
    meaning = read("α/b")
    checked = check((equality("Section 4", "regime = a/b", a=meaning, regime=meaning),))
    printed = plain(read("a/b").subs(pencil.SMALL_A, meaning))
    return Entry(
        number="Section 4, regime",
        section="4",
        statement="“(a/b) ≥ 1 in Proposition 5”",
        verdict=MISPRINT,
        why=f"(12) has a = α/b already, so that a/b is {printed}",
        follows="read (α/b) ≥ 1, as Table 4 prints it",
        grounds=lambda: (Evidence("identity", checked.finding, checked.verdict == "misprint"),),
        correction=f"{checked.correction.partition('= ')[2]} ≥ 1, where a = α/b",
    )
