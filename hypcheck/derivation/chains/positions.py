"""From the rule to the roots: what exterior and interior mean for them, and where Δ = 0 deceives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hypcheck.derivation.chains import cubics
from hypcheck.derivation.chains.cubics import coefficients_of_roots
from hypcheck.derivation.links import Cases, Chain, Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA, B
from hypcheck.derivation.plain_text import symbol


@dataclass(frozen=True)
class Pattern:
    """How the roots of g can stand, after the chain "roots": what it means for signs and for the position.

    `delta` is the sign of Δ. `all_positive` is true where c2 < 0 and c1 > 0 in case Δ > 0. `crowded` marks three roots
    none of which is below B, or two at most −A.
    """

    name: str
    delta: int
    all_positive: bool
    position: int
    crowded: bool = False
    ring: bool = False


PATTERNS = (
    Pattern("two different roots in (0, B]", 1, True, 1),
    Pattern("three different roots, none below B", 1, True, 0, crowded=True),
    Pattern("two different roots in [−A, 0)", 1, False, -1),
    Pattern("two different roots at most −A", 1, False, 0, crowded=True),
    Pattern("the double root B above a simple one", 0, True, 1, ring=True),
    Pattern("another double root", 0, True, 0),
    Pattern("a double root below 0", 0, False, 0),
    Pattern("one real root", -1, True, 0),
    Pattern("one real root, other signs", -1, False, 0),
)


def put_together(statement: str, where: Callable[[Pattern], bool], right: Callable[[Pattern], bool]) -> Link:
    """That what is said is `right` of every pattern of roots that can occur, which are those `where` it says so."""
    possible = tuple((pattern,) for pattern in PATTERNS if where(pattern))
    return Link(
        statement,
        "case split",
        (Cases(f"true of each of the {len(possible)} patterns of roots that can occur", possible, right),),
    )


def no_contact_but_the_ring() -> Link:
    """What Δ ≤ 0 means for every size."""
    return put_together(
        "So Δ ≤ 0 means contact or the ring, and for the interior nothing else than “no”.",
        lambda roots: roots.delta <= 0,
        lambda roots: roots.position == 0 or roots.ring,
    )


def positions() -> Chain:
    """What the propositions have in common."""
    return Chain(
        "positions",
        "Exterior has three positive roots, different but on the ring; interior has two different negative roots; and "
        "the signs of Δ, c2 and c1 tell how many roots are real, different and positive.",
        (
            exterior_has_positive_roots(),
            interior_has_negative_roots(),
            only_the_ring(),
            ring_is_exterior(),
            cubics.distinct_roots(),
            cubics.positive_roots_have_signs(),
            cubics.no_negative_root(),
            cubics.positive_between_roots(),
        ),
        needs=("rule", "roots"),
    )


def exterior_has_positive_roots() -> Link:
    """From g > 0 in (0, B) to three positive roots."""
    _, _, c0 = coefficients_of_roots()
    return Link(
        "Exterior means g > 0 somewhere in (0, B), so by its signs at 0 and B two roots r1 < r2 in (0, B]; the third, "
        "A·B/(r1·r2), is positive too.",
        "sign",
        (
            known("g(0) = −AB"),
            known("g(B) = −BQ(A + B)"),
            identity("c0 of (λ − r1)·(λ − r2)·(λ − s) = −r1·r2·s", c0),
            sign("A·B/(r1·r2) > 0", "A B r1 r2"),
        ),
    )


def interior_has_negative_roots() -> Link:
    """From g > 0 in (−A, 0) to two different negative roots."""
    return Link(
        "Interior means g > 0 somewhere in (−A, 0), so by its signs at −A and 0 two different roots in [−A, 0); the "
        "third is at least B > 0. Three different roots: Δ > 0.",
        "sign",
        (
            known("g(−A) = −AP(A + B)"),
            known("g(0) = −AB"),
            sign("−A·P·(A + B) ≤ 0", "A B", "P"),
            sign("−A·B < 0", "A B"),
        ),
    )


def only_the_ring() -> Link:
    """Exterior with a double root."""
    w, t, m, n = (symbol(name) for name in "wtmn")
    at_B = ((LAMBDA - m) ** 2 * (LAMBDA - n)).subs({LAMBDA: B, m: B + w, n: B - t}, simultaneous=True)
    return Link(
        "Exterior with a double root m, g = (λ − m)²·(λ − n), is the ring: g > 0 below B puts n = B − t below it, so m "
        "= B + w is the root that is at least B; g(B) ≤ 0 leaves w = 0. So Q = 0, g'(B) = 0, and n = A/B < B.",
        "sign",
        (
            identity("g(B) = w²·t", at_B),
            sign("w²·t > 0", "w t"),
            known("g(B) = −BQ(A + B)"),
            known("with Q = 0, g'(B) = 0 only at P = (A + B)(B + 1)/B"),
            known("on the ring Q = 0, P = (A + B)(B + 1)/B: g(λ) = (λ − B)²(λ − A/B)"),
        ),
    )


def ring_is_exterior() -> Link:
    """The converse: λ between A/B and B."""
    at = symbol("m")
    u, v = symbol("u"), symbol("v")
    g = ((LAMBDA - B) ** 2 * (LAMBDA - at)).subs({LAMBDA: B - u, at: B - u - v}, simultaneous=True)
    return Link(
        "On the ring the spheroid is exterior: g is positive between the simple root A/B < B and B, where λ = B − u "
        "and A/B = λ − v.",
        "sign",
        (
            known("on the ring Q = 0, P = (A + B)(B + 1)/B: g(λ) = (λ − B)²(λ − A/B)"),
            identity("g(λ) = u²·v", g),
            sign("u²·v > 0", "u v"),
        ),
    )
