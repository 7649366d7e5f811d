"""Where the roots of g stand to −A, 0 and B: signs at three places, and Vieta's product."""

from __future__ import annotations

from itertools import product

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.chains.cubics import ROOTS, coefficients_of_roots
from hypcheck.derivation.links import Cases, Chain, Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA
from hypcheck.derivation.plain_text import symbol


def roots() -> Chain:
    """One root is at least B; the other two are complex, or stand together in one of four intervals."""
    return Chain(
        "roots",
        "One root s of g is at least B. The other two are complex, or lie together in one of (−∞, −A], [−A, 0), (0, "
        "B], [B, ∞).",
        (*_signs(), _one_root_beyond(), _same_sign(), _same_side(), _together()),
    )


def _signs() -> tuple[Link, ...]:
    return (
        Link(
            "g is not positive at −A.",
            "sign",
            (known("g(−A) = −AP(A + B)"), sign("−A·P·(A + B) ≤ 0", "A B", "P")),
        ),
        Link("g is negative at 0.", "sign", (known("g(0) = −AB"), sign("−A·B < 0", "A B"))),
        Link(
            "g is not positive at B.",
            "sign",
            (known("g(B) = −BQ(A + B)"), sign("−B·Q·(A + B) ≤ 0", "A B", "Q")),
        ),
    )


def _one_root_beyond() -> Link:
    leading = sympy.Poly(pencil.cubic().g, LAMBDA).LC()
    return Link(
        "So one root is at least B: g(B) ≤ 0, and g grows without bound, its leading coefficient being 1. Call the "
        "largest root s.",
        "cited theorem",
        (identity("coefficient of λ³ in g = 1", leading),),
        cites="intermediate value theorem",
    )


def _same_sign() -> Link:
    _, _, c0 = coefficients_of_roots()
    return Link(
        "The product of the other two is A·B/s > 0: if they are real they have one sign, and neither is 0.",
        "sign",
        (
            identity("c0 of (λ − r1)·(λ − r2)·(λ − s) = −r1·r2·s", c0),
            identity("c0 = −A·B", pencil.cubic().c0),
            sign("A·B/s > 0", "A B s"),
        ),
    )


def _same_side() -> Link:
    """Of the quadratic k(λ) = g(λ)/(λ − s); B = s − w."""
    r1, r2, s = ROOTS
    quadratic = (LAMBDA - r1) * (LAMBDA - r2)
    g, w = pencil.cubic().g, symbol("w")
    at_minus_A = (g / (LAMBDA - s)).subs(LAMBDA, -pencil.A)
    at_B = (g / (LAMBDA - s)).subs(LAMBDA, pencil.B).subs(s, pencil.B + w)
    return Link(
        "The other two stand on one side of −A, and on one side of B: k = g/(λ − s) = (λ − r1)·(λ − r2) is not "
        "negative at −A, nor at B = s − w. (Where w = 0 both are at most s = B.)",
        "sign",
        (
            identity("k(−A) = (r1 + A)·(r2 + A)", quadratic.subs(LAMBDA, -pencil.A)),
            identity("k(−A) = A·P·(A + B)/(A + s)", at_minus_A),
            sign("A·P·(A + B)/(A + s) ≥ 0", "A B s", "P"),
            identity("k(B) = (r1 − B)·(r2 − B)", quadratic.subs(LAMBDA, pencil.B)),
            identity("k(B) = B·Q·(A + B)/w", at_B),
            sign("B·Q·(A + B)/w ≥ 0", "A B w", "Q"),
        ),
    )


def _together() -> Link:
    """With A = B = 2 every place of two roots to −A, 0 and B is that of one of these pairs."""
    places = (-3, -2, -1, 1, 2, 3)
    return Link(
        "Hence they lie together in one of the four intervals.",
        "case split",
        (
            Cases(
                "r1·r2 > 0 and (r1 + A)·(r2 + A) ≥ 0 and (r1 − B)·(r2 − B) ≥ 0: one interval",
                tuple(product(places, repeat=2)),
                in_one_interval,
            ),
        ),
    )


def in_one_interval(r1: int, r2: int) -> bool:
    """Whether two roots that the three products allow share an interval, for A = B = 2."""
    if not (r1 * r2 > 0 and (r1 + 2) * (r2 + 2) >= 0 and (r1 - 2) * (r2 - 2) >= 0):
        return True
    return (
        (r1 <= -2 and r2 <= -2) or (-2 <= r1 < 0 and -2 <= r2 < 0) or (0 < r1 <= 2 and 0 < r2 <= 2) or min(r1, r2) >= 2
    )
