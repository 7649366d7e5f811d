"""Quadcopters for Procedure 2.b: a hull and four rotors in it, and where the procedure refuses what is inside."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.pairs import Position
from hypcheck.paper.ledger import statements as say
from hypcheck.paper.ledger.entry import Evidence, described
from hypcheck.paper.ledger.facts import Facts, Point, facts
from hypcheck.paper.ledger.search import Condition, first, witness
from hypcheck.truth import exact


@dataclass(frozen=True)
class Quadcopter:
    """A hull at a point, and four rotors of `size` times the hull's axes on arms of length `arm`, in hull radii."""

    hull: Facts
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


def quadcopters(hull: Facts) -> tuple[Quadcopter, ...]:
    """Those tried about one hull: arms of a half, a quarter, … and rotors half as long as the arms."""
    tried = (Quadcopter(hull, Fraction(2, halvings), Fraction(1, halvings)) for halvings in (4, 8, 16, 32))
    return tuple(quadcopter for quadcopter in tried if quadcopter.fits)


def refused_though_inside(hull: Facts) -> Quadcopter | None:
    """A quadcopter that Procedure 2.b refuses by its hull alone although its four rotors are interior."""
    if hull.delta <= 0 or say.printed_interior(hull):
        return None
    inside = (each for each in quadcopters(hull) if exact.position(each.farthest.pair.lengths) is Position.INTERIOR)
    return next((each for each in inside if not each.answer), None)


def refusal(where: Condition, shows: str) -> Evidence:
    """The simplest hull in a regime at which Procedure 2.b refuses four interior rotors, and the farthest rotor."""
    search = first(lambda hull: where(hull) and refused_though_inside(hull) is not None, where)
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
