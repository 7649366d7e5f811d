"""The ledger's entries about Tables 1 to 4: the procedures as printed, run in exact arithmetic.

For Procedure 2.b there are quadcopters, a hull with four rotors in it, and a search for those that it refuses although
they are inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, REPAIRED, answers
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.paper.ledger import entry
from hypcheck.paper.ledger.entry import (
    FALSE,
    PROVED,
    Evidence,
    LedgerEntry,
    by_chain,
    by_programs,
    described,
    harmless_where,
    with_counterexample,
    without_counterexample,
)
from hypcheck.paper.ledger.points import Condition, Point, PointFacts, Statement, facts, first_point, witness
from hypcheck.paper.ledger.propositions import OFF_THE_WAIST, VERY_TALL
from hypcheck.truth import exact


@dataclass(frozen=True)
class Quadcopter:
    """A hull at a point, and four rotors of `size` times the hull's axes on arms of length `arm`, in hull radii."""

    hull: PointFacts
    arm: Fraction
    size: Fraction

    @property
    def fits(self) -> bool:
        """Whether the rotors lie in the hull and do not meet one another."""
        return self.arm + self.size <= 1 and self.arm**2 * 2 >= (2 * self.size) ** 2

    @property
    def farthest(self) -> Point:
        """A rotor at the hull's radius and an arm more, scaled to the unit sphere: no rotor is farther from the axis.

        If it is interior so is every rotor, for interior positions stay interior when r falls (docs/mathematics.md).
        """
        hull = self.hull.point
        lengths = (hull.a, hull.c, hull.r + self.arm, hull.z)
        return Point(*(length / self.size for length in lengths))

    @property
    def answer(self) -> bool:
        """Procedure 2.b's, in exact arithmetic, with rotors at 45° to the axes (cosine 1, sine 0)."""
        hull = self.hull.point
        lengths = {"alpha": hull.a, "gamma": hull.c, "b": 1, "d": 1, "b_s": self.size, "d_s": self.size, "l": self.arm}
        centre = {"x": hull.r, "y": 0, "z": hull.z, "cosine": 1, "sine": 0}
        return bool(answers(FORMULAS["procedure-2b"], EXACT, {**lengths, **centre}))


def quadcopters(hull: PointFacts) -> tuple[Quadcopter, ...]:
    """Those tried about one hull: arms of a half, a quarter, … and rotors half as long as the arms."""
    tried = (Quadcopter(hull, Fraction(2, halvings), Fraction(1, halvings)) for halvings in (4, 8, 16, 32))
    return tuple(quadcopter for quadcopter in tried if quadcopter.fits)


def refused_though_inside(hull: PointFacts) -> Quadcopter | None:
    """A quadcopter that Procedure 2.b refuses by its hull alone although its four rotors are interior."""
    if hull.delta <= 0 or entry.printed_interior(hull):
        return None
    inside = (each for each in quadcopters(hull) if exact.position(each.farthest.pair.lengths) is Position.INTERIOR)
    return next((each for each in inside if not each.answer), None)


def refusal(where: Condition, shows: str) -> Evidence:
    """The simplest hull in a regime at which Procedure 2.b refuses four interior rotors, and the farthest rotor."""
    search = first_point(lambda hull: where(hull) and refused_though_inside(hull) is not None, where)
    quadcopter = refused_though_inside(search.found) if search.found else None
    if search.found is None or quadcopter is None:
        return Evidence("search", f"nothing found among {search.tried:,} hulls", holds=False)
    rotor = facts(quadcopter.farthest)
    witnesses = (
        witness(search.found, f"the hull: {shows}"),
        witness(rotor, "a rotor at r + l, in rotor radii: interior"),
    )
    text = f"hull {described(search.found)}; rotors of {quadcopter.size} its size on arms of {quadcopter.arm} interior"
    return Evidence("search", text, all(each.holds for each in witnesses), witnesses)


def procedures() -> tuple[LedgerEntry, ...]:
    """The tables and what the text says of them, in the paper's order."""
    return (
        _table_1(),
        _caption_of_table_1(),
        *_table_2(),
        _table_3(),
        _contact_by_discriminant(),
        _table_4(),
        _caption_of_table_4(),
        _same_pseudocode(),
    )


def program_says(name: str, facts: PointFacts) -> int:
    """The answer of one of the formulas to a point, in exact arithmetic."""
    return int(answers(FORMULAS[name], EXACT, dict(zip(COLUMNS, facts.point.pair.row, strict=True))))


def _exterior(where: Condition, text: str) -> Statement:
    """Procedure 1 and Table 2 are proved to decide as Proposition 3.1 says; the program is asked about a witness."""
    return Statement(f"{text} a movement is valid ⟺ the spheroid is exterior", where, entry.PROPOSITION_3_1.says)


BOTH_TYPES = (
    _exterior(lambda facts: entry.tall(facts) and facts.point.a >= 1, "for α/b ≥ 1"),
    _exterior(lambda facts: entry.tall(facts) and facts.point.a < 1, "for α/b < 1"),
)


def _errs(name: str, *statements: Statement) -> tuple[Evidence, ...]:
    """Counterexamples to the statements, and that the printed program errs at each in exact arithmetic."""
    found = with_counterexample(*statements)
    wrong = [program_says(name, each.facts) != entry.exterior(each.facts) for each in found.witnesses]
    text = f"{name} errs there in exact arithmetic"
    return found, Evidence("programs", text, bool(wrong) and all(wrong)), by_programs(FORMULAS[name])


_PHANTOM = "a walker is stopped by nothing in the plane of the waist; never a wrong “valid” in the stated regime"


def _table_1() -> LedgerEntry:
    return LedgerEntry(
        "Table 1",
        "3.1",
        "Procedure 1: valid ⟺ exterior",
        FALSE,
        "what it calls valid is exterior; on the ring it refuses a movement that is clear",
        _PHANTOM,
        lambda: (
            *_errs("procedure-1", _exterior(entry.tall, "by Procedure 1")),
            by_chain("Procedure 1, repaired"),
            by_programs(REPAIRED["procedure-1-repaired"]),
        ),
        "valid ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring; in floats ask r > a + 1 where z0 = 0 instead",
        harmless=OFF_THE_WAIST,
    )


def _caption_of_table_1() -> LedgerEntry:
    return LedgerEntry(
        "Table 1, caption",
        "3.1",
        "Procedure 1 is valid for both cases α/b ≥ 1 and α/b < 1",
        FALSE,
        "it has the same one fault in both: the ring needs no more than c² > a",
        "no size of trunk avoids it",
        lambda: (*_errs("procedure-1", *BOTH_TYPES), by_chain("Proposition 3, repaired")),
        harmless=OFF_THE_WAIST,
    )


def _table_2() -> tuple[LedgerEntry, ...]:
    return (
        LedgerEntry(
            "Table 2, lines",
            "3.1",
            "its lines compute (14) and (13)",
            PROVED,
            "the program expands to the derived coefficients and discriminant",
            "code from it; in floats the order of evaluation decides how thick the ring is",
            lambda: (by_programs(FORMULAS["table-2"]),),
        ),
        LedgerEntry(
            "Table 2",
            "3.1",
            "valid = 1 ⟺ exterior",
            FALSE,
            "as Procedure 1: on the ring valid = 0",
            _PHANTOM,
            lambda: (*_errs("table-2", _exterior(entry.tall, "by Table 2")), by_chain("Proposition 3, repaired")),
            "valid ← (Δ > 0 and c2 < 0 and c1 > 0) or the ring",
            harmless=OFF_THE_WAIST,
        ),
    )


def _procedure_2a_says(facts: PointFacts) -> bool:
    """The answer to a quadcopter on the axis, whose four rotors all stand to the hyperboloid as this point does."""
    point = facts.point
    inputs = {"alpha": point.a, "gamma": point.c, "b_s": 1, "d_s": 1, "x": 0, "y": 0, "z": point.z, "l": point.r}
    return bool(answers(FORMULAS["procedure-2a"], EXACT, {**inputs, "cosine": 1, "sine": 0}))


PROCEDURE_2A = Statement(
    "Procedure 2.a calls a movement valid ⟺ all four rotors are interior (here disjoint, on arms of length r about the "
    "axis)",
    lambda facts: entry.wide(facts) and facts.point.r**2 >= 2,  # neighbours are √2 r apart, and 2 at least
    lambda facts: _procedure_2a_says(facts) == entry.interior(facts),
)


def _table_3() -> LedgerEntry:
    return LedgerEntry(
        "Table 3",
        "3.2",
        "Procedure 2.a: valid ⟺ all four rotors interior",
        FALSE,
        "what it calls valid is interior; it refuses where c2(g_i) = 0 or c1(g_i) = 0 for a rotor",
        "ask for not (c2 < 0 and c1 > 0); such positions are rare, but whole sizes and grids meet them",
        lambda: (
            with_counterexample(PROCEDURE_2A),
            by_programs(FORMULAS["procedure-2a"]),
            by_chain("Proposition 5, repaired"),
            by_programs(REPAIRED["procedure-2a-repaired"]),
            harmless_where(PROCEDURE_2A, entry.very_tall),
        ),
        "valid ⟺ Δ(g_i) > 0 and not (c2(g_i) < 0 and c1(g_i) > 0) for all i",
        harmless=VERY_TALL,
    )


CONTACT_MEANS_NOT_POSITIVE = Statement(
    "contact ⟹ Δ ≤ 0", entry.wide, lambda facts: facts.delta <= 0 or not entry.contact(facts)
)
CONTACT_IF_TALL = Statement(
    "for (γ/d)² ≥ α/b: contact ⟹ Δ ≤ 0",
    lambda facts: entry.wide(facts) and entry.tall(facts),
    CONTACT_MEANS_NOT_POSITIVE.says,
)


CONTACT_IS_DISCRIMINANT = Statement(
    "contact ⟺ Δ ≤ 0", entry.wide, lambda facts: entry.contact(facts) == (facts.delta <= 0)
)


def _contact_by_discriminant() -> LedgerEntry:
    return LedgerEntry(
        "Section 4, contact",
        "4",
        "“contact, i.e. Δ ≤ 0”",
        FALSE,
        "the ring has Δ = 0 and no contact; for (γ/d)² < α/b there is contact with Δ > 0",
        "for α/b ≥ 1 and (γ/d)² ≥ α/b contact does mean Δ ≤ 0, and Δ ≤ 0 contact or the ring",
        lambda: (
            with_counterexample(entry.PROPOSITION_5_2, CONTACT_MEANS_NOT_POSITIVE),
            by_chain("Proposition 3, repaired"),
            by_chain("Proposition 5, repaired"),
            without_counterexample(CONTACT_IF_TALL),
            harmless_where(CONTACT_IS_DISCRIMINANT, lambda facts: entry.tall(facts) and not entry.exterior(facts)),
        ),
        harmless="inside a hyperboloid with (γ/d)² ≥ α/b, as in the paper's tower: there contact ⟺ Δ ≤ 0",
    )


def _table_4() -> LedgerEntry:
    return LedgerEntry(
        "Table 4",
        "4",
        "Procedure 2.b: valid ⟺ hull interior, or else all four rotors",
        FALSE,
        "what it calls valid is interior; where the hull has Δ > 0 and c2 = 0 or c1 = 0 it refuses, rotors unasked",
        "ask the hull for not (c2 < 0 and c1 > 0), and the rotors whenever the hull is not interior",
        lambda: (
            refusal(lambda hull: entry.wide(hull) and entry.tall(hull), "interior, and refused for a zero coefficient"),
            by_programs(FORMULAS["procedure-2b"]),
            by_chain("Proposition 5, repaired"),
            by_programs(REPAIRED["procedure-2b-repaired"]),
            harmless_where(entry.PROPOSITION_5_1, entry.very_tall),
        ),
        "valid ⟺ the hull has Δ > 0 and not (c2 < 0 and c1 > 0), or else each rotor has",
        harmless=VERY_TALL,
    )


def _caption_of_table_4() -> LedgerEntry:
    return LedgerEntry(
        "Table 4, caption",
        "4",
        "valid for both cases (γ/d)² ≥ α/b and (γ/d)² < α/b",
        FALSE,
        "for (γ/d)² < α/b a hull in contact can have Δ > 0, so the rotors are never asked",
        "in a low, wide hyperboloid free movements are refused; ask the rotors whenever the hull is not interior",
        lambda: (
            refusal(
                lambda hull: entry.wide(hull) and not entry.tall(hull) and entry.contact(hull),
                "contact with Δ > 0, refused, rotors unasked",
            ),
            by_chain("Proposition 5, repaired"),
            without_counterexample(CONTACT_IF_TALL),
        ),
        harmless="where (γ/d)² ≥ α/b, as in the paper's tower: contact has Δ ≤ 0 there, and the rotors are asked",
    )


def _same_pseudocode() -> LedgerEntry:
    return LedgerEntry(
        "Section 4, pseudocode",
        "4",
        "the lines of Procedure 2.b for Δ ≤ 0 are those of Procedure 2.a",
        PROVED,
        "line by line but for punctuation; the two programs answer alike wherever the hull has Δ ≤ 0",
        "one routine serves both",
        lambda: (
            Evidence("text", "Tables 3 and 4 have the same lines there", holds=True),
            by_programs(FORMULAS["procedure-2a"], FORMULAS["procedure-2b"]),
        ),
    )
