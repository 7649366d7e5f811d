"""The procedures of Tables 1 to 4 as printed, run in exact arithmetic, and where they err.

For Procedure 2.b there are quadcopters, a hull with four rotors in it, and a search for those that it refuses although
they are inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.paper.ledger import statements
from hypcheck.paper.ledger.entry import Evidence, described, with_counterexample
from hypcheck.paper.ledger.points import Condition, Point, PointFacts, Statement, facts, first_point, witness
from hypcheck.truth import exact


def program_says(name: str, facts: PointFacts) -> int:
    """The answer of one of the formulas to a point, in exact arithmetic."""
    return int(answers(FORMULAS[name], EXACT, dict(zip(COLUMNS, facts.point.pair.row, strict=True))))


def errs(name: str, *about: Statement) -> Evidence:
    """That a printed program for exterior positions errs in exact arithmetic at a counterexample to each statement."""
    witnesses = with_counterexample(*about).witnesses
    wrong = [program_says(name, each.facts) != statements.exterior(each.facts) for each in witnesses]
    return Evidence("programs", f"{name} errs there in exact arithmetic", bool(wrong) and all(wrong))


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
    if hull.delta <= 0 or statements.printed_interior(hull):
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


def refused_for_a_zero_coefficient() -> Evidence:
    """That Procedure 2.b refuses an interior hull of the regimes of Propositions 3 and 5, and its rotors with it."""
    return refusal(
        lambda hull: statements.wide(hull) and statements.tall(hull), "interior, and refused for a zero coefficient"
    )


def refused_though_the_hull_is_in_contact() -> Evidence:
    """That Procedure 2.b refuses four interior rotors in a low hyperboloid, where a hull in contact can have Δ > 0."""
    return refusal(
        lambda hull: statements.wide(hull) and not statements.tall(hull) and statements.contact(hull),
        "contact with Δ > 0, refused, rotors unasked",
    )
