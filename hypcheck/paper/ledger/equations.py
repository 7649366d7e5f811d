"""The ledger's entries about displayed formulas, (1) to (23) and Appendix A, and about costs.

Formulas are judged by their checks (derivation/printed_equations.py). Costs that can be counted are counted from the
programs; the others are not judged.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.formulas import (
    FORMULAS,
    ROOTS_TRIGONOMETRIC,
    Cost,
    cost_of,
    discriminant_share,
    loop_as_printed,
)
from hypcheck.derivation.formulas import costs as counted
from hypcheck.derivation.pencil import plain, read
from hypcheck.derivation.printed_equations import EquationCheck, check, check_equations, equality, printed_claims
from hypcheck.geometry.pair import Position
from hypcheck.paper.ledger.entry import (
    DEFINITION,
    FALSE,
    MISPRINT,
    NOT_CHECKABLE,
    PROVED,
    Evidence,
    LedgerEntry,
    by_programs,
    rule_of_all_sizes,
    with_counterexample,
)
from hypcheck.paper.ledger.points import PointFacts, Rational, Statement, rational, with_c2

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


def equations() -> tuple[LedgerEntry, ...]:
    """An entry for every displayed formula, in the paper's order."""
    return tuple(map(equation, check_equations()))


def equation(checked: EquationCheck) -> LedgerEntry:
    """The entry of one formula; the verdict expected of it is confirmed where the check comes to the same."""
    section, statement, follows = _EQUATIONS[checked.number]
    misprinted = checked.number in _EXPECTED_MISPRINTS
    expected = "misprint" if misprinted else "holds"
    found = Evidence("identity", checked.finding, checked.verdict == expected)
    return LedgerEntry(
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


def _position_by_12(facts: PointFacts) -> int:
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


def regime_of_section_4() -> LedgerEntry:
    """Section 4 writes the regime of Proposition 5 as (a/b) ≥ 1; a is α/b already, by (12)."""
    meaning = read("α/b")
    checked = check((equality("Section 4", "regime = a/b", a=meaning, regime=meaning),))
    printed = plain(read("a/b").subs(pencil.SMALL_A, meaning))
    return LedgerEntry(
        number="Section 4, regime",
        section="4",
        statement="“(a/b) ≥ 1 in Proposition 5”",
        verdict=MISPRINT,
        why=f"(12) has a = α/b already, so that a/b is {printed}",
        follows="read (α/b) ≥ 1, as Table 4 prints it",
        grounds=lambda: (Evidence("identity", checked.finding, checked.verdict == "misprint"),),
        correction=f"{checked.correction.partition('= ')[2]} ≥ 1, where a = α/b",
    )


def costs() -> tuple[LedgerEntry, ...]:
    """The claims of sections 3.1 to 5 about operations, and those about time."""
    return (
        _only_sums_and_products(),
        _taken_out(),
        *_trigonometric(),
        _no_angle(),
        _discriminant(),
        *_by_the_clock(),
    )


def _only_sums_and_products() -> LedgerEntry:
    cost = cost_of(FORMULAS["table-2"])
    count = cost.query.divisions
    return LedgerEntry(
        "Section 3.1, operations",
        "3.1",
        "Table 2: only additions and products are performed",
        FALSE,
        f"each position takes {count} divisions, P ← …/b² and Q ← (z0/d)², and each scene {cost.scene.divisions}",
        "keep 1/b² and 1/d outside the loop: then it is true, and a division's latency is gone from every query",
        lambda: (
            Evidence(
                "count",
                f"{count} divisions a query, {cost.by_fixed} of them by a number that the sizes fix",
                count > 0 and cost.by_fixed == count,
            ),
        ),
        "only additions and products are performed in the loop, once 1/b² and 1/d are taken out of it",
        harmless="in exact arithmetic: the divisors b² and d do not change, and the answers are the same",
    )


def _taken_out() -> LedgerEntry:
    printed, cost = loop_as_printed(), cost_of(FORMULAS["table-2"])
    left = printed.rounded - cost.query.rounded
    return LedgerEntry(
        "Section 3.1, loop",
        "3.1",
        "terms independent of the position are computed once",
        PROVED,
        f"A, B, c0 and C leave the loop, which keeps {printed.rounded} operations; {left} more could leave it",
        f"take b², A − B + 1 and 27·c0² out as well: {cost.query.rounded} operations a query",
        lambda: (
            Evidence(
                "count", f"{cost.scene.rounded} operations depend on the sizes alone", 0 < left < cost.scene.rounded
            ),
        ),
    )


def _trigonometric() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Section 3.1, [13]",
            "3.1",
            "the proposal of [13] decides by the roots of the polynomial and evaluates trigonometric functions",
            NOT_CHECKABLE,
            "the text of [13] was not read",
            "a program that takes the three roots by cosines stands in for it here: `roots-trigonometric`",
        ),
        _by_roots(),
        _cost_of_roots(),
    )


def _by_roots() -> LedgerEntry:
    cosines, table_2 = cost_of(ROOTS_TRIGONOMETRIC), cost_of(FORMULAS["table-2"])
    (sweep,) = (cost for cost in counted() if cost.name == "roots-sweep")
    return LedgerEntry(
        "Section 3.1, roots",
        "3.1",
        "to decide by the roots implies to evaluate trigonometric functions when Δ > 0",
        FALSE,
        f"by cosines it takes {cosines.query.functions} functions and {cosines.query.rounded} operations "
        "a position, "
        f"Table 2 takes none and {table_2.query.rounded}; but `roots-sweep` finds all three roots by + − × ÷ alone",
        "signs of coefficients need no roots; the sign of g at its local maximum takes one square root",
        lambda: (
            Evidence(
                "count",
                f"{sweep.query.functions} functions in a sweep that finds roots, {cosines.query.functions} by cosines",
                sweep.query.functions == 0 < cosines.query.functions,
            ),
            by_programs(ROOTS_TRIGONOMETRIC),
        ),
        "the closed form of three real roots takes cosines; Table 2 takes none",
        harmless="for the conclusion: Table 2 takes no trigonometric function, and fewer operations",
    )


def _cost_of_roots() -> LedgerEntry:
    cosines, table_2 = cost_of(ROOTS_TRIGONOMETRIC), cost_of(FORMULAS["table-2"])
    return LedgerEntry(
        "Section 3.1, cost of roots",
        "3.1",
        "the coefficients alone cost less than the roots by trigonometric functions",
        PROVED,
        f"{table_2.query.rounded} rounded operations a position against {cosines.query.rounded} and, among these, "
        f"{cosines.query.functions} functions; `hypcheck bench` measured the same: {BENCH['roots']}",
        "prefer the coefficients, or g at its local maximum",
        lambda: (
            Evidence(
                "count",
                f"{table_2.query.rounded} < {cosines.query.rounded}",
                table_2.query.rounded < cosines.query.rounded and table_2.query.functions == 0,
            ),
        ),
    )


def _no_angle() -> LedgerEntry:
    program = FORMULAS["procedure-2a"].program
    angles = [name for name in program.inputs if name in {"cosine", "sine"}]
    return LedgerEntry(
        "Section 3.2, angles",
        "3.2",
        "c0, c1(g_i), c2(g_i) need no angle g_i of each rotor",
        PROVED,
        "the other three rotors have T1 and T2 of the first, exchanged and with other signs",
        "one cosine and one sine for all four rotors",
        lambda: (
            by_programs(FORMULAS["procedure-2a"]),
            Evidence(
                "count",
                f"{len(angles)} inputs tell the direction of four rotors, and no step takes a cosine",
                len(angles) == 2 and _total(cost_of(FORMULAS["procedure-2a"]), "functions") == 0,
            ),
        ),
    )


def _total(cost: Cost, name: str) -> int:
    return int(getattr(cost.scene, name) + getattr(cost.query, name))


def _discriminant() -> LedgerEntry:
    share, whole = discriminant_share()
    return LedgerEntry(
        "Section 4, cost",
        "4",
        "Δ(g_i) costs much in comparison to other operations",
        PROVED,
        f"a count against our own threshold, one half: {share} of the {whole} rounded operations of "
        "Procedure 2.a for a "
        f"position are those of its four Δ(g_i). Whether Procedure 2.b is cheaper for it: {BENCH['hull first']}",
        "a fixed λ decides most first, for a product and a comparison (docs/mathematics.md, “A line is a proof”)",
        lambda: (Evidence("count", f"{share} of {whole} is more than half", 2 * share > whole),),
    )


BENCH = {
    "operations": "does not hold in numpy, and does not hold in C",
    "roots": "holds in numpy, and holds in C",
    "hull first": "does not hold in numpy, 8,192 positions at a time, and holds in C, one position a call",
    "spheres": "22 % of a sphere's answers are false contacts uniformly around the tower, 26 % along flights",
    "cylinders": "1 % of a cylinder's are, and 2 % along flights",
}
"""What the reference run of `hypcheck bench` says (reports/reference/bench); a test holds it against that report."""


def _by_the_clock() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Section 1, spheres",
            "1",
            "a bounding sphere has faster tests, less memory and more false positives",
            NOT_CHECKABLE,
            f"[8, 9] were not read, and time is no matter of proof; `hypcheck bench` counts: {BENCH['spheres']}",
            "a sphere of radius max(b, d) has 2 numbers fewer; a spheroid costs 28 operations a position by Table 2",
        ),
        LedgerEntry(
            "Abstract; 3.1, speed",
            "3.1",
            "the computational cost is very low; real-time calculation",
            NOT_CHECKABLE,
            "a matter of time on a machine, not of proof; “very low since only additions and products are performed” "
            f"{BENCH['operations']}: the loop divides, and is faster without (`hypcheck bench`)",
            "`hypcheck bench` measures it beside the roots' way, FCL and bounding volumes",
        ),
        LedgerEntry(
            "Section 3.1, other methods",
            "3.1",
            "the methods of [3]–[7] cannot be used, since the objects are modelled by quadric surfaces",
            NOT_CHECKABLE,
            "their texts were not read; section 1 says of the same methods that they “use quadric bounding surfaces”",
            "meshes with FCL's distance do answer the question to a bound (docs/mesh-oracle.md)",
        ),
        LedgerEntry(
            "Section 5",
            "5",
            "less computational complexity by more adequate bounding volumes",
            NOT_CHECKABLE,
            f"it depends on the scene and on what the volumes bound; `hypcheck bench` counts: {BENCH['spheres']}; "
            f"{BENCH['cylinders']}",
            "count the false contacts of spheres and cylinders in your scene",
        ),
    )
