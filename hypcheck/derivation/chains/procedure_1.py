"""Procedure 1, repaired: in the plane of the waist r > a + 1 decides; elsewhere there is no ring."""

from __future__ import annotations

from hypcheck.derivation import pencil
from hypcheck.derivation.links import Chain, Link, identity, sign
from hypcheck.derivation.pencil import LAMBDA, A, B, P, Q
from hypcheck.derivation.plain_text import symbol


def procedure_1() -> Chain:
    """Both cases of the procedure put right."""
    at_waist = pencil.cubic().g.subs(Q, 0)
    e = symbol("E")
    return Chain(
        "Procedure 1, repaired",
        "For (γ/d)² ≥ α/b: exterior ⟺ E > 0 and E² > 4·A where Q = 0, with E = P − A − 1; elsewhere Δ > 0, c2 < 0 and "
        "c1 > 0.",
        (
            Link(
                "Where Q = 0, g is (λ − B) times a quadratic. So in (0, B), where λ − B < 0, g > 0 exactly where the "
                "quadratic is negative.",
                "identity",
                (identity("g = (λ − B)·(λ² − E·λ + A)", at_waist, E=P - A - 1),),
            ),
            Link(
                "If E > 0 and E² > 4·A, the quadratic has two different roots u and u + v, u, v > 0, of sum E and of "
                "product A; between them it is negative. The smaller has u² < A ≤ B², so part of that is in (0, B): "
                "exterior.",
                "sign",
                (
                    identity("(λ − u)·(λ − u − v) = λ² − (2·u + v)·λ + u·(u + v)", _from_roots()),
                    sign("u·(u + v) − u² > 0", "u v"),
                    sign("(2·u + v)² − 4·u·(u + v) > 0", "u v"),
                ),
            ),
            Link(
                "If E = −h ≤ 0, all terms of the quadratic are ≥ 0 for λ = s > 0, and one is > 0; if E² ≤ 4·A, it is a "
                "square and k = A − E²/4 ≥ 0. So it is nowhere negative in (0, B): not exterior.",
                "sign",
                (
                    sign("s² + h·s + A > 0", "A s", "h"),
                    identity("(λ − E/2)² + A − E²/4 = λ² − E·λ + A", (LAMBDA - e / 2) ** 2 + A - e**2 / 4),
                ),
            ),
            Link(
                "In lengths E > 0 and E² > 4·A say r > a + 1: with r = a + 1 + t, E² − 4·A is positive exactly where t "
                "is, for r > 0.",
                "identity",
                (
                    identity(
                        "E² − 4·A = t·(t + 2)·(t + 2·a)·(t + 2·a + 2)",
                        ((symbol("a") + 1 + symbol("t")) ** 2 - symbol("a") ** 2 - 1) ** 2 - 4 * symbol("a") ** 2,
                    ),
                ),
            ),
            Link(
                "Where Q > 0 there is no ring, since g(B) = −B·Q·(A + B) < 0 leaves no root at B; Proposition 3, "
                "repaired, says the rest.",
                "identity",
                (identity("g(B) = −B·Q·(A + B)", pencil.cubic().g.subs(LAMBDA, B)),),
            ),
        ),
        needs=("rule", "Proposition 3, repaired"),
    )


def _from_roots() -> object:
    u, v = symbol("u"), symbol("v")
    return (LAMBDA - u) * (LAMBDA - u - v)
