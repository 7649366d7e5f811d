"""Chains about the roots of g: their places beside −A, 0 and B, what the positions mean for them, the propositions.

Letters: A = (α/b)², B = (γ/d)², P = (x0² + y0²)/b² and Q = (z0/d)²; r1 and r2 are the two smaller roots of g and s is
the largest one.

First come links about any cubic with real roots (Vieta's formulas, signs between roots, Δ), then the chain "roots":
signs of g at three places and Vieta's product; then the chain "positions", from the rule to the roots, with the cases
of Δ = 0 that are not contact.

From these follow the propositions put right:

- Proposition 3, repaired: for (γ/d)² ≥ α/b, which is B² ≥ A, exterior by Δ, c2 and c1, and the ring.
- Procedure 1, repaired: in the plane of the waist r > a + 1 decides; elsewhere there is no ring.
- Proposition 5, repaired: for α/b ≥ 1, which is A ≥ 1, interior by Δ, c2, c1, and the positions that the printed
  condition drops.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import (
    Chain,
    FiniteCases,
    Link,
    chain,
    identity,
    known,
    link,
    sign,
)
from hypcheck.derivation.pencil import C0, C1, C2, GENERIC_CUBIC, LAMBDA, A, B, P, Q, discriminant_of_cubic, symbol
from hypcheck.derivation.proofs import SIGNS

ROOTS = tuple(symbol(name) for name in ("r1", "r2", "s"))


def coefficients_of_roots() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """Return c2, c1 and c0 of (λ − r1)(λ − r2)(λ − s)."""
    r1, r2, s = ROOTS
    _, c2, c1, c0 = sympy.Poly((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s), LAMBDA).all_coeffs()
    return c2, c1, c0


def slope_of_roots(at: sympy.Expr) -> sympy.Expr:
    """Return the derivative of (λ − r1)(λ − r2)(λ − s) at a value of λ."""
    r1, r2, s = ROOTS
    return sympy.diff((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s), LAMBDA).subs(LAMBDA, at)


def distinct_roots() -> Link:
    """Return the link that Δ > 0 means three different real roots."""
    real, imaginary, s = (symbol(name) for name in ("p", "q", "s"))
    of_pair = sympy.Poly(((LAMBDA - real) ** 2 + imaginary**2) * (LAMBDA - s), LAMBDA).all_coeffs()[1:]
    of_pair_discriminant = discriminant_of_cubic().subs(dict(zip((C2, C1, C0), of_pair, strict=True)))
    return link(
        "Δ > 0 exactly if g has three different real roots: it is the product of their squared differences, and below "
        "0 for a pair p ± q·i beside a real root s.",
        known("Δ is the product of the squared differences of the roots"),
        identity("Δ = −4·q²·((s − p)² + q²)²", of_pair_discriminant),
        sign("−4·q²·(t² + q²)² < 0", "q"),
        reason="identity",
    )


def positive_roots_have_signs() -> Link:
    """Return the link about the signs of c2, c1 and c0 for three positive roots, by Vieta's formulas."""
    c2, c1, _ = coefficients_of_roots()
    return link(
        "Three positive roots r1, r2, s mean c2 < 0 and c1 > 0.",
        identity("c2 = −(r1 + r2 + s)", c2),
        sign("−(r1 + r2 + s) < 0", "r1 r2 s"),
        identity("c1 = r1·r2 + r2·s + s·r1", c1),
        sign("r1·r2 + r2·s + s·r1 > 0", "r1 r2 s"),
    )


def no_negative_root() -> Link:
    """Return the link that g has no negative root if c2 < 0 and c1 > 0, by Descartes' rule."""
    p, q, r = (symbol(name) for name in ("p", "q", "r"))
    mirrored = -GENERIC_CUBIC.subs({C2: -p, C1: q, C0: -r}, simultaneous=True).subs(LAMBDA, -LAMBDA)
    return link(
        "c2 < 0 and c1 > 0 leave no root below 0: with c2 = −p, c1 = q, c0 = −r every term of −g(−λ) is positive.",
        identity("−g(−λ) = λ³ + p·λ² + q·λ + r", mirrored),
        sign("λ³ + p·λ² + q·λ + r > 0", "p q r", "lambda"),
    )


def positive_between_roots() -> Link:
    """Return the link that g > 0 between its two smaller roots."""
    u, v, w = (symbol(name) for name in ("u", "v", "w"))
    r1, r2, s = ROOTS
    product = ((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s)).subs({r1: LAMBDA - u, r2: LAMBDA + v, s: LAMBDA + w})
    return link(
        "Between its two lower roots g is positive: λ = r1 + u = r2 − v = s − w.",
        identity("(λ − r1)·(λ − r2)·(λ − s) = u·v·w", product),
        sign("u·v·w > 0", "u v w"),
    )


def roots_chain() -> Chain:
    """Return the chain "roots": one root is at least B; the others are complex or lie in one of four intervals."""
    return chain(
        "roots",
        "One root s of g is at least B. The other two are complex, or lie together in one of (−∞, −A], [−A, 0), (0, "
        "B], [B, ∞).",
        link("g is not positive at −A.", known("g(−A) = −AP(A + B)"), sign("−A·P·(A + B) ≤ 0", "A B", "P")),
        link("g is negative at 0.", known("g(0) = −AB"), sign("−A·B < 0", "A B")),
        link("g is not positive at B.", known("g(B) = −BQ(A + B)"), sign("−B·Q·(A + B) ≤ 0", "A B", "Q")),
        _one_root_beyond(),
        _same_sign(),
        _same_side(),
        _together(),
    )


def _one_root_beyond() -> Link:
    """Return the link that one root of g is at least B."""
    leading = sympy.Poly(pencil.cubic().g, LAMBDA).LC()
    return link(
        "So one root is at least B: g(B) ≤ 0, and g grows without bound, its leading coefficient being 1. Call the "
        "largest root s.",
        identity("coefficient of λ³ in g = 1", leading),
        cites="intermediate value theorem",
    )


def _same_sign() -> Link:
    """Return the link that the two smaller roots have one sign if they are real."""
    _, _, c0 = coefficients_of_roots()
    return link(
        "The product of the other two is A·B/s > 0: if they are real they have one sign, and neither is 0.",
        identity("c0 of (λ − r1)·(λ − r2)·(λ − s) = −r1·r2·s", c0),
        identity("c0 = −A·B", pencil.cubic().c0),
        sign("A·B/s > 0", "A B s"),
    )


def _same_side() -> Link:
    """Return the link that the two smaller roots are on one side of −A and of B.

    They are the roots of the quadratic k(λ) = g(λ)/(λ − s), and B = s − w.
    """
    r1, r2, s = ROOTS
    quadratic = (LAMBDA - r1) * (LAMBDA - r2)
    g, w = pencil.cubic().g, symbol("w")
    at_minus_A = (g / (LAMBDA - s)).subs(LAMBDA, -pencil.A)
    at_B = (g / (LAMBDA - s)).subs(LAMBDA, pencil.B).subs(s, pencil.B + w)
    return link(
        "The other two stand on one side of −A, and on one side of B: k = g/(λ − s) = (λ − r1)·(λ − r2) is not "
        "negative at −A, nor at B = s − w. (Where w = 0 both are at most s = B.)",
        identity("k(−A) = (r1 + A)·(r2 + A)", quadratic.subs(LAMBDA, -pencil.A)),
        identity("k(−A) = A·P·(A + B)/(A + s)", at_minus_A),
        sign("A·P·(A + B)/(A + s) ≥ 0", "A B s", "P"),
        identity("k(B) = (r1 − B)·(r2 − B)", quadratic.subs(LAMBDA, pencil.B)),
        identity("k(B) = B·Q·(A + B)/w", at_B),
        sign("B·Q·(A + B)/w ≥ 0", "A B w", "Q"),
    )


def _together() -> Link:
    """Return the link that the two smaller roots lie in one of four intervals, by cases.

    With A = B = 2 every order of two roots, −A, 0 and B is that of one of the pairs of whole numbers that are tried.
    """
    places = (-3, -2, -1, 1, 2, 3)
    return link(
        "Hence they lie together in one of the four intervals.",
        FiniteCases(
            "r1·r2 > 0 and (r1 + A)·(r2 + A) ≥ 0 and (r1 − B)·(r2 − B) ≥ 0: one interval",
            tuple(product(places, repeat=2)),
            in_one_interval,
        ),
    )


def in_one_interval(r1: int, r2: int) -> bool:
    """Decide, for A = B = 2, whether the two roots lie in one interval, or break one of the three conditions.

    The conditions are those of the links before: the roots have one sign, and are on one side of −A and of B.
    """
    if not (r1 * r2 > 0 and (r1 + 2) * (r2 + 2) >= 0 and (r1 - 2) * (r2 - 2) >= 0):
        return True
    return (
        (r1 <= -2 and r2 <= -2) or (-2 <= r1 < 0 and -2 <= r2 < 0) or (0 < r1 <= 2 and 0 < r2 <= 2) or min(r1, r2) >= 2
    )


@dataclass(frozen=True)
class Pattern:
    """A possible order of the roots of g, after the chain "roots", with the signs and the position that follow.

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


def true_of_patterns(statement: str, where: Callable[[Pattern], bool], right: Callable[[Pattern], bool]) -> Link:
    """Make a link that holds if `right` is true of every possible pattern of roots that meets the condition `where`."""
    possible = tuple((pattern,) for pattern in PATTERNS if where(pattern))
    return link(
        statement, FiniteCases(f"true of each of the {len(possible)} patterns of roots that can occur", possible, right)
    )


def no_contact_but_the_ring() -> Link:
    """Return the link that for all sizes Δ ≤ 0 means contact, except on the ring."""
    return true_of_patterns(
        "So Δ ≤ 0 means contact or the ring, and for the interior nothing else than “no”.",
        lambda roots: roots.delta <= 0,
        lambda roots: roots.position == 0 or roots.ring,
    )


def positions_chain() -> Chain:
    """Return the chain "positions", which all propositions use."""
    return chain(
        "positions",
        "Exterior has three positive roots, different but on the ring; interior has two different negative roots; and "
        "the signs of Δ, c2 and c1 tell how many roots are real, different and positive.",
        exterior_has_positive_roots(),
        link(
            "Interior means g > 0 somewhere in (−A, 0), so by its signs at −A and 0 two different roots in [−A, 0); "
            "the third is at least B > 0. Three different roots: Δ > 0.",
            known("g(−A) = −AP(A + B)"),
            known("g(0) = −AB"),
            sign("−A·P·(A + B) ≤ 0", "A B", "P"),
            sign("−A·B < 0", "A B"),
        ),
        only_the_ring(),
        ring_is_exterior(),
        distinct_roots(),
        positive_roots_have_signs(),
        no_negative_root(),
        positive_between_roots(),
        needs=("rule", "roots"),
    )


def exterior_has_positive_roots() -> Link:
    """Return the link that g > 0 somewhere in (0, B) means three positive roots."""
    _, _, c0 = coefficients_of_roots()
    return link(
        "Exterior means g > 0 somewhere in (0, B), so by its signs at 0 and B two roots r1 < r2 in (0, B]; the third, "
        "A·B/(r1·r2), is positive too.",
        known("g(0) = −AB"),
        known("g(B) = −BQ(A + B)"),
        identity("c0 of (λ − r1)·(λ − r2)·(λ − s) = −r1·r2·s", c0),
        sign("A·B/(r1·r2) > 0", "A B r1 r2"),
    )


def only_the_ring() -> Link:
    """Return the link that an exterior position with a double root is on the ring."""
    w, t, m, n = (symbol(name) for name in "wtmn")
    at_B = ((LAMBDA - m) ** 2 * (LAMBDA - n)).subs({LAMBDA: B, m: B + w, n: B - t}, simultaneous=True)
    return link(
        "Exterior with a double root m, g = (λ − m)²·(λ − n), is the ring: g > 0 below B puts n = B − t below it, so m "
        "= B + w is the root that is at least B; g(B) ≤ 0 leaves w = 0. So Q = 0, g'(B) = 0, and n = A/B < B.",
        identity("g(B) = w²·t", at_B),
        sign("w²·t > 0", "w t"),
        known("g(B) = −BQ(A + B)"),
        known("with Q = 0, g'(B) = 0 only at P = (A + B)(B + 1)/B"),
        known("on the ring Q = 0, P = (A + B)(B + 1)/B: g(λ) = (λ − B)²(λ − A/B)"),
    )


def ring_is_exterior() -> Link:
    """Return the link that the ring is exterior: g > 0 for λ between A/B and B."""
    at = symbol("m")
    u, v = symbol("u"), symbol("v")
    g = ((LAMBDA - B) ** 2 * (LAMBDA - at)).subs({LAMBDA: B - u, at: B - u - v}, simultaneous=True)
    return link(
        "On the ring the spheroid is exterior: g is positive between the simple root A/B < B and B, where λ = B − u "
        "and A/B = λ − v.",
        known("on the ring Q = 0, P = (A + B)(B + 1)/B: g(λ) = (λ − B)²(λ − A/B)"),
        identity("g(λ) = u²·v", g),
        sign("u²·v > 0", "u v"),
    )


def proposition_3() -> Chain:
    """Return the chain of the repaired Proposition 3: both directions, and the positions with Δ ≤ 0."""
    return chain(
        "Proposition 3, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring (z0 = 0, g'(B) = 0, A < B²). Δ ≤ 0 means "
        "contact or the ring.",
        link(
            "Three different positive roots are not all at least B, at B + u, B + v and B + w: their product A·B would "
            "exceed B³, against B² = A + k with k ≥ 0. So the lower two lie in (0, B], and g > 0 between them.",
            sign("(B + u)·(B + v)·(B + w) − B³ > 0", "B v w", "u"),
            identity("A·B − B³ = −B·(B² − A)", A * B - B**3),
            sign("−B·k ≤ 0", "B", "k"),
        ),
        true_of_patterns(
            "So exterior ⟺ Δ > 0, c2 < 0 and c1 > 0, or the ring.",
            lambda roots: not (roots.crowded and roots.all_positive),
            lambda roots: ((roots.delta > 0 and roots.all_positive) or roots.ring) == (roots.position > 0),
        ),
        no_contact_but_the_ring(),
        needs=("rule", "roots", "positions"),
    )


def procedure_1() -> Chain:
    """Return the chain of the repaired Procedure 1: both cases, Q = 0 and Q ≠ 0."""
    return chain(
        "Procedure 1, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ E > 0 and E² > 4·A where Q = 0, with E = P − A − 1; elsewhere Δ > 0, c2 < 0 and "
        "c1 > 0.",
        *_in_the_plane_of_the_waist(),
        link(
            "In lengths E > 0 and E² > 4·A say r > a + 1: with r = a + 1 + t, E² − 4·A is positive exactly where t "
            "is, for r > 0.",
            identity(
                "E² − 4·A = t·(t + 2)·(t + 2·a)·(t + 2·a + 2)",
                ((symbol("a") + 1 + symbol("t")) ** 2 - symbol("a") ** 2 - 1) ** 2 - 4 * symbol("a") ** 2,
            ),
        ),
        link(
            "Where Q > 0 there is no ring, since g(B) = −B·Q·(A + B) < 0 leaves no root at B; Proposition 3, "
            "repaired, says the rest.",
            identity("g(B) = −B·Q·(A + B)", pencil.cubic().g.subs(LAMBDA, B)),
        ),
        needs=("rule", "Proposition 3, repaired"),
    )


def _in_the_plane_of_the_waist() -> tuple[Link, ...]:
    """Return the links about Q = 0, where r > a + 1 decides."""
    e, u, v = symbol("E"), symbol("u"), symbol("v")
    return (
        link(
            "Where Q = 0, g is (λ − B) times a quadratic. So in (0, B), where λ − B < 0, g > 0 exactly where the "
            "quadratic is negative.",
            identity("g = (λ − B)·(λ² − E·λ + A)", pencil.cubic().g.subs(Q, 0), E=P - A - 1),
        ),
        link(
            "If E > 0 and E² > 4·A, the quadratic has two different roots u and u + v, u, v > 0, of sum E and of "
            "product A; between them it is negative. The smaller has u² < A ≤ B², so part of that is in (0, B): "
            "exterior.",
            identity("(λ − u)·(λ − u − v) = λ² − (2·u + v)·λ + u·(u + v)", (LAMBDA - u) * (LAMBDA - u - v)),
            sign("u·(u + v) − u² > 0", "u v"),
            sign("(2·u + v)² − 4·u·(u + v) > 0", "u v"),
        ),
        link(
            "If E = −h ≤ 0, all terms of the quadratic are ≥ 0 for λ = s > 0, and one is > 0; if E² ≤ 4·A, it is a "
            "square and k = A − E²/4 ≥ 0. So it is nowhere negative in (0, B): not exterior.",
            sign("s² + h·s + A > 0", "A s", "h"),
            identity("(λ − E/2)² + A − E²/4 = λ² − E·λ + A", (LAMBDA - e / 2) ** 2 + A - e**2 / 4),
        ),
    )


def proposition_5() -> Chain:
    """Return the chain of the repaired Proposition 5: both directions, and what the printed statement omits."""
    return chain(
        "Proposition 5, repaired",
        "For α/b ≥ 1: interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0). Δ ≤ 0 means contact or the ring.",
        _two_negative(),
        link(
            "They are not both at most −A, at −A − u and −A − v: the third, A·B over their product, would be below B, "
            "with A = 1 + k, k ≥ 0. So both lie in [−A, 0), and g > 0 between them.",
            sign("B − (1 + k)·B/((1 + k + u)·(1 + k + v)) > 0", "B v", "k u"),
        ),
        true_of_patterns(
            "So interior ⟺ Δ > 0 and not (c2 < 0 and c1 > 0).",
            lambda roots: not (roots.crowded and not roots.all_positive),
            lambda roots: (roots.delta > 0 and not roots.all_positive) == (roots.position < 0),
        ),
        no_contact_but_the_ring(),
        _dropped(),
        needs=("rule", "roots", "positions"),
    )


def _two_negative() -> Link:
    """Return the link that Δ > 0 and not (c2 < 0 and c1 > 0) means two negative roots."""
    r1, r2, s = ROOTS
    return link(
        "Δ > 0 and not (c2 < 0 and c1 > 0): not all roots are positive, by Vieta; none is 0; and the product A·B > 0 "
        "makes two of them negative.",
        *positive_roots_have_signs().parts,
        identity("−c0 = r1·r2·s", r1 * r2 * s),
        sign("A·B > 0", "A B"),
    )


def _dropped() -> Link:
    """Return the link about the interior positions that the printed condition omits. In it c0 = −r with r > 0."""
    p, q, r = (symbol(name) for name in "pqr")
    generic = discriminant_of_cubic()
    return link(
        "Of these interior positions the printed [c2 > 0, c1 ≠ 0] or [c2 < 0, c1 < 0] drops those with c2 = 0 > c1 and "
        "those with c1 = 0 < c2, and no others: c2 = 0 ≤ c1 = q and c1 = 0 ≥ c2 = −p have Δ < 0 (as Δ(c2, c1, c0), c0 "
        "= −r).",
        FiniteCases(
            "the printed condition and not (c2 < 0 and c1 > 0) differ ⟺ c2 = 0 or c1 = 0",
            tuple(product(SIGNS, repeat=2)),
            only_zeros_are_dropped,
        ),
        identity("Δ(0, q, −r) = −4·q³ − 27·r²", generic.subs({C2: 0, C1: q, C0: -r})),
        sign("−4·q³ − 27·r² < 0", "r", "q"),
        identity("Δ(−p, 0, −r) = −4·p³·r − 27·r²", generic.subs({C1: 0, C2: -p, C0: -r})),
        sign("−4·p³·r − 27·r² < 0", "r", "p"),
    )


def only_zeros_are_dropped(c2: int, c1: int) -> bool:
    """Decide whether the repaired and the printed condition differ for these signs only if one of the signs is 0."""
    printed = (c2 > 0 and c1 != 0) or (c2 < 0 and c1 < 0)
    repaired = not (c2 < 0 and c1 > 0)
    return (printed != repaired) == (0 in (c2, c1))
