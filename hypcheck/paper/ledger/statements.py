"""The paper's statements about pairs, printed and repaired, and the conditions that they consist of.

claims.toml names them. The last part runs the procedures of Tables 1 to 4 as printed, in exact arithmetic. For
Procedure 2.b there are quadcopters, a hull with four rotors in it, and a search for quadcopters that it refuses
although their rotors are interior.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from hypcheck.derivation.evaluation import EXACT
from hypcheck.derivation.formulas import FORMULAS, answers
from hypcheck.geometry.pair import COLUMNS, Position
from hypcheck.paper.ledger.entry import Evidence, described, with_counterexample
from hypcheck.paper.ledger.points import (
    Condition,
    Point,
    PointFacts,
    PointWitness,
    Statement,
    facts,
    first_point,
    witness,
)
from hypcheck.truth import exact


def tall(facts: PointFacts) -> bool:
    """Decide whether (γ/d)² ≥ α/b, the regime of Proposition 3."""
    return facts.B >= facts.point.a


def wide(facts: PointFacts) -> bool:
    """Decide whether α/b ≥ 1, the regime of Proposition 5 and of Procedures 2.a and 2.b."""
    return facts.point.a >= 1


def wider(facts: PointFacts) -> bool:
    """Decide whether α/b > 1, the regime that Proposition 5 prints."""
    return facts.point.a > 1


def very_tall(facts: PointFacts) -> bool:
    """Decide whether (γ/d)² > (α/b)² + 1, where c2 < 0 for every centre."""
    return facts.B > facts.A + 1


def off_the_waist(facts: PointFacts) -> bool:
    """Decide whether z0 ≠ 0, where there is no ring."""
    return facts.Q != 0


def three_real_roots(facts: PointFacts) -> bool:
    """Decide whether Δ > 0: three different real roots."""
    return facts.delta > 0


def exterior(facts: PointFacts) -> bool:
    """Decide whether the spheroid is exterior."""
    return facts.position is Position.EXTERIOR


def interior(facts: PointFacts) -> bool:
    """Decide whether the spheroid is interior."""
    return facts.position is Position.INTERIOR


def contact(facts: PointFacts) -> bool:
    """Decide whether there is contact."""
    return facts.position is Position.CONTACT


def not_exterior(facts: PointFacts) -> bool:
    """Decide whether the spheroid is interior or in contact; it always is if its centre is inside the hyperboloid."""
    return not exterior(facts)


def inside_a_tall_one(facts: PointFacts) -> bool:
    """Decide whether the spheroid is not exterior to a hyperboloid of both regimes, as in the paper's tower."""
    return tall(facts) and wide(facts) and not exterior(facts)


def three_positive(facts: PointFacts) -> bool:
    """Decide whether the coefficients have the signs that Proposition 3 requires in addition to Δ > 0."""
    return facts.c2 < 0 and facts.c1 > 0


def printed_interior(facts: PointFacts) -> bool:
    """Decide whether the coefficients have the signs that Proposition 5 requires in addition to Δ > 0."""
    return (facts.c2 > 0 and facts.c1 != 0) or (facts.c2 < 0 and facts.c1 < 0)


def ring(facts: PointFacts) -> bool:
    """Decide whether the pair is on the ring, exterior with Δ = 0: Q = 0, g'(B) = 0 and A < B²."""
    return facts.Q == 0 and facts.slope_at_B == 0 and facts.A < facts.B**2


PROPOSITION_3_1 = Statement(
    "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0",
    tall,
    lambda facts: exterior(facts) == (facts.delta > 0 and three_positive(facts)),
)
PROPOSITION_3_2 = Statement("Δ ≤ 0 ⟹ contact", tall, lambda facts: facts.delta > 0 or contact(facts))
THREE_POSITIVE_ROOTS = Statement(
    "exterior ⟺ g has three different positive roots",
    tall,
    lambda facts: exterior(facts) == (facts.delta > 0 and facts.negative_roots == 0),
)
ALL_POSITIVE = Statement(
    "c2 < 0 and c1 > 0 ⟺ all real roots of g are positive",
    tall,
    lambda facts: three_positive(facts) == (facts.negative_roots == 0),
)
REMARK_4 = Statement(
    "two different negative roots ⟹ contact or interior",
    tall,
    lambda facts: not (facts.delta > 0 and facts.negative_roots == 2) or not exterior(facts),
)


def _proposition_5_1(text: str, zero: Callable[[PointFacts], bool]) -> Statement:
    """Return the printed Proposition 5.1 restricted to pairs for which `zero` holds, in which a coefficient is 0."""
    return Statement(
        text,
        lambda facts: wider(facts) and zero(facts),
        lambda facts: interior(facts) == (facts.delta > 0 and printed_interior(facts)),
    )


_5_1 = "interior ⟺ Δ > 0 and [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0]"
PROPOSITION_5_1 = _proposition_5_1(_5_1, lambda _: True)
PROPOSITION_5_1_WITH_C2 = _proposition_5_1(f"{_5_1}, for c2 = 0", lambda facts: facts.c2 == 0)
PROPOSITION_5_1_WITH_C1 = _proposition_5_1(f"{_5_1}, for c1 = 0", lambda facts: facts.c1 == 0)
PROPOSITION_5_2 = Statement("Δ ≤ 0 ⟹ contact", wider, lambda facts: facts.delta > 0 or contact(facts))
REMARK_6 = Statement(
    "three different positive roots ⟹ contact or exterior",
    wide,
    lambda facts: not (facts.delta > 0 and facts.negative_roots == 0) or not interior(facts),
)
REPAIRED_3 = Statement(
    "exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring; Δ ≤ 0 ⟹ contact or the ring",
    tall,
    lambda facts: (
        exterior(facts) == ((facts.delta > 0 and three_positive(facts)) or ring(facts))
        and (facts.delta > 0 or contact(facts) or ring(facts))
    ),
)
REPAIRED_5 = Statement(
    "interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0); Δ ≤ 0 ⟹ contact or the ring",
    wide,
    lambda facts: (
        interior(facts) == (facts.delta > 0 and not three_positive(facts))
        and (facts.delta > 0 or contact(facts) or ring(facts))
    ),
)


def _valid(where: Condition, text: str) -> Statement:
    """Return the statement that Procedure 1 or Table 2 is right for the pairs in `where`.

    Both are proved to decide by Proposition 3.1; their programs are tested at a witness.
    """
    return Statement(f"{text} a movement is valid ⟺ the spheroid is exterior", where, PROPOSITION_3_1.says)


VALID_BY_PROCEDURE_1 = _valid(tall, "by Procedure 1")
VALID_BY_TABLE_2 = _valid(tall, "by Table 2")
VALID_IF_WIDE = _valid(lambda facts: tall(facts) and facts.point.a >= 1, "for α/b ≥ 1")
VALID_IF_NARROW = _valid(lambda facts: tall(facts) and facts.point.a < 1, "for α/b < 1")


def _procedure_2a_says(facts: PointFacts) -> bool:
    """Return Procedure 2.a's answer for a quadcopter on the axis all of whose rotors have this point's position."""
    point = facts.point
    inputs = {"alpha": point.a, "gamma": point.c, "b_s": 1, "d_s": 1, "x": 0, "y": 0, "z": point.z, "l": point.r}
    return bool(answers(FORMULAS["procedure-2a"], EXACT, {**inputs, "cosine": 1, "sine": 0}))


PROCEDURE_2A = Statement(
    "Procedure 2.a calls a movement valid ⟺ all four rotors are interior (here disjoint, on arms of length r about the "
    "axis)",
    lambda facts: wide(facts) and facts.point.r**2 >= 2,  # neighbours are √2 r apart, and 2 at least
    lambda facts: _procedure_2a_says(facts) == interior(facts),
)
CONTACT_MEANS_NOT_POSITIVE = Statement("contact ⟹ Δ ≤ 0", wide, lambda facts: facts.delta <= 0 or not contact(facts))
CONTACT_IF_TALL = Statement(
    "for (γ/d)² ≥ α/b: contact ⟹ Δ ≤ 0",
    lambda facts: wide(facts) and tall(facts),
    CONTACT_MEANS_NOT_POSITIVE.says,
)
CONTACT_INSIDE = Statement(
    "inside a hyperboloid with (γ/d)² ≥ α/b ≥ 1: contact ⟺ Δ ≤ 0",
    inside_a_tall_one,
    lambda facts: contact(facts) == (facts.delta <= 0),
)
CLEAR_IS_POSITIVE = Statement("interior or exterior ⟺ Δ > 0", wide, lambda facts: contact(facts) == (facts.delta <= 0))


def program_says(name: str, facts: PointFacts) -> int:
    """Return the answer of the formula with this name for a point, in exact arithmetic."""
    return int(answers(FORMULAS[name], EXACT, dict(zip(COLUMNS, facts.point.pair.row, strict=True))))


def errs(name: str, *about: Statement) -> Evidence:
    """Return evidence that a printed program for exterior positions errs at a counterexample to each statement."""
    witnesses = with_counterexample(*about).witnesses
    wrong = [program_says(name, witness.facts) != exterior(witness.facts) for witness in witnesses]
    return Evidence("programs", f"{name} errs there in exact arithmetic", bool(wrong) and all(wrong))


@dataclass(frozen=True)
class Quadcopter:
    """A hull at a point, with four rotors of `size` times the hull's axes on arms of length `arm`, in hull radii."""

    hull: PointFacts
    arm: Fraction
    size: Fraction

    @property
    def fits(self) -> bool:
        """Whether the rotors lie in the hull and do not meet one another."""
        return self.arm + self.size <= 1 and self.arm**2 * 2 >= (2 * self.size) ** 2

    @property
    def farthest(self) -> Point:
        """A rotor whose radius is that of the hull plus an arm, scaled to the unit sphere.

        No rotor is farther from the axis. If this one is interior, every rotor is interior, because an interior
        position stays interior when r falls (docs/mathematics.md).
        """
        hull = self.hull.point
        lengths = (hull.a, hull.c, hull.r + self.arm, hull.z)
        return Point(*(length / self.size for length in lengths))

    @property
    def answer(self) -> bool:
        """Procedure 2.b's answer, in exact arithmetic, with rotors at 45° to the axes (cosine 1, sine 0)."""
        hull = self.hull.point
        lengths = {"alpha": hull.a, "gamma": hull.c, "b": 1, "d": 1, "b_s": self.size, "d_s": self.size, "l": self.arm}
        centre = {"x": hull.r, "y": 0, "z": hull.z, "cosine": 1, "sine": 0}
        return bool(answers(FORMULAS["procedure-2b"], EXACT, {**lengths, **centre}))


def quadcopters(hull: PointFacts) -> tuple[Quadcopter, ...]:
    """Return the quadcopters tried with one hull: arms of a half, a quarter, … and rotors half as large as the arms."""
    tried = (Quadcopter(hull, Fraction(2, halvings), Fraction(1, halvings)) for halvings in (4, 8, 16, 32))
    return tuple(quadcopter for quadcopter in tried if quadcopter.fits)


def refused_though_inside(hull: PointFacts) -> Quadcopter | None:
    """Return a quadcopter that Procedure 2.b refuses by its hull alone although its four rotors are interior."""
    if hull.delta <= 0 or printed_interior(hull):
        return None
    inside = (
        quadcopter
        for quadcopter in quadcopters(hull)
        if exact.position(quadcopter.farthest.pair.lengths) is Position.INTERIOR
    )
    return next((quadcopter for quadcopter in inside if not quadcopter.answer), None)


def _hull_and_rotor(
    decided: Callable[[PointFacts], Quadcopter | None],
    where: Condition,
    shows: str,
    text: Callable[[PointWitness, Quadcopter], str],
) -> Evidence:
    """Return the simplest hull in a regime with a quadcopter that is decided wrongly, and its farthest rotor.

    `shows` says what the hull shows, and `text` what the hull and its quadcopter show together.
    """
    search = first_point(lambda hull: decided(hull) is not None, where)
    quadcopter = decided(search.found) if search.found else None
    if search.found is None or quadcopter is None:
        return Evidence("search", f"nothing found among {search.tried:,} hulls", holds=False)
    hull = witness(search.found, shows)
    rotor = witness(facts(quadcopter.farthest), "a rotor at r + l, in rotor radii: interior")
    return Evidence("search", text(hull, quadcopter), hull.holds and rotor.holds, (hull, rotor))


def refusal(where: Condition, shows: str) -> Evidence:
    """Find the simplest hull in a regime at which Procedure 2.b refuses four interior rotors, and a rotor of it."""
    return _hull_and_rotor(
        refused_though_inside,
        where,
        f"the hull: {shows}",
        lambda hull, quadcopter: f"hull {described(hull.facts)}; {_small_rotors(quadcopter)}",
    )


def _small_rotors(quadcopter: Quadcopter) -> str:
    return f"rotors of {quadcopter.size} its size on arms of {quadcopter.arm} interior"


def refused_for_a_zero_coefficient() -> Evidence:
    """Return evidence that Procedure 2.b refuses an interior hull, and its rotors, in the regimes of both propositions.

    These are Propositions 3 and 5.
    """
    return refusal(lambda hull: wide(hull) and tall(hull), "interior, and refused for a zero coefficient")


def refused_though_the_hull_is_in_contact() -> Evidence:
    """Return evidence that Procedure 2.b refuses interior rotors in a low hyperboloid, where Δ > 0 can mean contact."""
    return refusal(
        lambda hull: wide(hull) and not tall(hull) and contact(hull),
        "contact with Δ > 0, refused, rotors unasked",
    )


def valid_though_the_body_meets_the_wall() -> Evidence:
    """Return evidence that Procedure 2.b calls a movement valid although a part of the body is beyond the wall.

    The body is in contact, the rotors are interior, and the certificate of contact has a point of the body's spheroid
    beyond the wall: a part at this point would collide.
    """
    return _hull_and_rotor(
        cleared_by_its_rotors,
        _crossing,
        "the body: contact, and called valid since its rotors are interior",
        _beside_the_rotors,
    )


def _beside_the_rotors(body: PointWitness, quadcopter: Quadcopter) -> str:
    where = ", ".join(map(str, part_beyond_the_wall(body))).replace("-", "−")
    return (
        f"body {described(body.facts)}; its point ({where}) is beyond the wall; {_small_rotors(quadcopter)}, "
        "and the movement valid"
    )


def _crossing(hull: PointFacts) -> bool:
    """Decide whether the hull crosses the wall with Δ < 0, in the regimes of Propositions 3 and 5.

    Such contact is not a tangency, and Procedure 2.b tests the rotors.
    """
    return wide(hull) and tall(hull) and contact(hull) and hull.delta < 0


def cleared_by_its_rotors(hull: PointFacts) -> Quadcopter | None:
    """Return a quadcopter with this hull, which is in contact, that Procedure 2.b calls valid."""
    return next((quadcopter for quadcopter in quadcopters(hull) if quadcopter.answer), None)


def part_beyond_the_wall(body: PointWitness) -> tuple[Fraction, ...]:
    """Return the point of a certificate of contact that is outside the hyperboloid, in radii of the body."""
    pair = body.facts.point.pair
    alpha, gamma, b, d = map(Fraction, pair.row[:4])
    (beyond,) = ((x, y, z) for x, y, z in body.certificate.points if (x * x + y * y) / alpha**2 - (z / gamma) ** 2 > 1)
    return beyond[0] / b, beyond[1] / b, beyond[2] / d
