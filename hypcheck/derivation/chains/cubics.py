"""Links about any cubic with real roots that several chains use: Vieta's formulas, signs between roots, Δ."""

from __future__ import annotations

import sympy

from hypcheck.derivation.identities import C0, C1, C2, GENERIC_CUBIC
from hypcheck.derivation.links import Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA, discriminant_of_cubic
from hypcheck.derivation.plain_text import symbol

ROOTS = tuple(symbol(name) for name in ("r1", "r2", "s"))


def coefficients_of_roots() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """c2, c1, c0 of (λ − r1)(λ − r2)(λ − s)."""
    r1, r2, s = ROOTS
    _, c2, c1, c0 = sympy.Poly((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s), LAMBDA).all_coeffs()
    return c2, c1, c0


def slope_of_roots(at: sympy.Expr) -> sympy.Expr:
    """g' of (λ − r1)(λ − r2)(λ − s) at a value of λ."""
    r1, r2, s = ROOTS
    return sympy.diff((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s), LAMBDA).subs(LAMBDA, at)


def distinct_roots() -> Link:
    """Δ > 0 means three different real roots."""
    real, imaginary, s = (symbol(name) for name in ("p", "q", "s"))
    of_pair = sympy.Poly(((LAMBDA - real) ** 2 + imaginary**2) * (LAMBDA - s), LAMBDA).all_coeffs()[1:]
    of_pair_discriminant = discriminant_of_cubic().subs(dict(zip((C2, C1, C0), of_pair, strict=True)))
    return Link(
        "Δ > 0 exactly if g has three different real roots: it is the product of their squared differences, and below "
        "0 for a pair p ± q·i beside a real root s.",
        "identity",
        (
            known("Δ is the product of the squared differences of the roots"),
            identity("Δ = −4·q²·((s − p)² + q²)²", of_pair_discriminant),
            sign("−4·q²·(t² + q²)² < 0", "q"),
        ),
    )


def positive_roots_have_signs() -> Link:
    """Vieta's formulas for three positive roots."""
    c2, c1, _ = coefficients_of_roots()
    return Link(
        "Three positive roots r1, r2, s mean c2 < 0 and c1 > 0.",
        "sign",
        (
            identity("c2 = −(r1 + r2 + s)", c2),
            sign("−(r1 + r2 + s) < 0", "r1 r2 s"),
            identity("c1 = r1·r2 + r2·s + s·r1", c1),
            sign("r1·r2 + r2·s + s·r1 > 0", "r1 r2 s"),
        ),
    )


def no_negative_root() -> Link:
    """Descartes' rule where all signs are alike."""
    p, q, r = (symbol(name) for name in ("p", "q", "r"))
    mirrored = -GENERIC_CUBIC.subs({C2: -p, C1: q, C0: -r}, simultaneous=True).subs(LAMBDA, -LAMBDA)
    return Link(
        "c2 < 0 and c1 > 0 leave no root below 0: with c2 = −p, c1 = q, c0 = −r every term of −g(−λ) is positive.",
        "sign",
        (
            identity("−g(−λ) = λ³ + p·λ² + q·λ + r", mirrored),
            sign("λ³ + p·λ² + q·λ + r > 0", "p q r", "lambda"),
        ),
    )


def positive_between_roots() -> Link:
    """g > 0 between its two lower roots."""
    u, v, w = (symbol(name) for name in ("u", "v", "w"))
    r1, r2, s = ROOTS
    product = ((LAMBDA - r1) * (LAMBDA - r2) * (LAMBDA - s)).subs({r1: LAMBDA - u, r2: LAMBDA + v, s: LAMBDA + w})
    return Link(
        "Between its two lower roots g is positive: λ = r1 + u = r2 − v = s − w.",
        "sign",
        (identity("(λ − r1)·(λ − r2)·(λ − s) = u·v·w", product), sign("u·v·w > 0", "u v w")),
    )
