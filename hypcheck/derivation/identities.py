"""The identities that the decision rules rest on, each an expression that must vanish."""

from __future__ import annotations

from functools import cache

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.differences import COSINE, SINE, difference
from hypcheck.derivation.pencil import (
    ALPHA,
    GAMMA,
    LAMBDA,
    SMALL_B,
    SMALL_D,
    X0,
    Y0,
    Z0,
    A,
    B,
    P,
    Q,
    X,
    Y,
    Z,
)
from hypcheck.derivation.plain_text import symbol

C0, C1, C2 = (symbol(name) for name in ("c0", "c1", "c2"))
GENERIC_CUBIC = LAMBDA**3 + C2 * LAMBDA**2 + C1 * LAMBDA + C0
PHI = P * LAMBDA / (A + LAMBDA) - Q * LAMBDA / (B - LAMBDA) - 1 - LAMBDA


@cache
def hessian_coefficients() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """h1, h2, h3: minus a quarter of the Hessian determinant of the cubic made homogeneous is h1 λ² + h2 λμ + h3 μ²."""
    mu = sympy.Dummy("mu")
    form = sympy.expand(mu**3 * GENERIC_CUBIC.subs(LAMBDA, LAMBDA / mu))
    covariant = -sympy.hessian(form, (LAMBDA, mu)).det() / 4
    h1, h2, h3 = sympy.Poly(covariant.subs(mu, 1), LAMBDA).all_coeffs()
    return h1, h2, h3


def local_maximum() -> sympy.Expr:
    """λm = (−c2 − √h1)/3, in c1 and c2."""
    return (-C2 - sympy.sqrt(hessian_coefficients()[0])) / 3


def identities() -> tuple[tuple[str, sympy.Expr], ...]:
    """Each identity as a sentence, with left side − right side."""
    return (*_surface_identities(), *_cubic_identities(), *_generic_identities())


def vanishes(expression: sympy.Expr) -> bool:
    """Whether the expression is 0 for all values of its letters (with cosine² + sine² = 1)."""
    return bool(difference(expression, sympy.Integer(0)) == 0)


def _surface_identities() -> tuple[tuple[str, sympy.Expr], ...]:
    turn = symbol("t")
    line = {X: ALPHA * (COSINE - turn * SINE), Y: ALPHA * (SINE + turn * COSINE), Z: GAMMA * turn}
    # A point of the unit sphere, rationally: (1 − t², 2t)/(1 + t²) is a point of the unit circle.
    across, along = (1 - turn**2) / (1 + turn**2), 2 * turn / (1 + turn**2)
    point = {
        X: X0 + SMALL_B * across * COSINE,
        Y: Y0 + SMALL_B * across * SINE,
        Z: Z0 + SMALL_D * along,
    }
    unscaled = LAMBDA * pencil.quadric_matrix(pencil.hyperboloid()) + pencil.quadric_matrix(pencil.spheroid())
    f = pencil.cubic_in_seven().f
    return (
        (
            "the line (α, αt, γt), turned about the axis, lies on the hyperboloid",
            pencil.hyperboloid().subs(line, simultaneous=True),
        ),
        (
            "the unit sphere, stretched by b, b, d and moved to (x0, y0, z0), is the spheroid",
            pencil.spheroid().subs(point, simultaneous=True),
        ),
        (
            "Theorem 1 divides the pencil's determinant by the constant 1/(b⁴d²)",
            unscaled.det(method="berkowitz") - f / (SMALL_B**4 * SMALL_D**2),
        ),
    )


def _cubic_identities() -> tuple[tuple[str, sympy.Expr], ...]:
    derived = pencil.cubic()
    g = derived.g
    product_form = (A + LAMBDA) * (B - LAMBDA) * (P + Q - 1 - LAMBDA) - A * P * (B - LAMBDA) - B * Q * (A + LAMBDA)
    on_the_ring = {Q: 0, P: (A + B) * (B + 1) / B}
    return (
        ("det(λH + S) = (A + λ)·g(λ)/(A²·B)", derived.f - (A + LAMBDA) * g / (A**2 * B)),
        ("g(λ) = (A + λ)(B − λ)(P + Q − 1 − λ) − AP(B − λ) − BQ(A + λ)", g - product_form),
        ("g(λ) = (A + λ)(B − λ)·φ(λ)", g - (A + LAMBDA) * (B - LAMBDA) * PHI),
        ("g(−A) = −AP(A + B)", g.subs(LAMBDA, -A) + A * P * (A + B)),
        ("g(0) = −AB", g.subs(LAMBDA, 0) + A * B),
        ("g(B) = −BQ(A + B)", g.subs(LAMBDA, B) + B * Q * (A + B)),
        (
            "on the ring Q = 0, P = (A + B)(B + 1)/B: g(λ) = (λ − B)²(λ − A/B)",
            g.subs(on_the_ring) - (LAMBDA - B) ** 2 * (LAMBDA - A / B),
        ),
        (
            "with Q = 0, g'(B) = 0 only at P = (A + B)(B + 1)/B",
            sympy.diff(g, LAMBDA).subs({LAMBDA: B, Q: 0}) - (A + B) * (B + 1) + B * P,
        ),
    )


def _generic_identities() -> tuple[tuple[str, sympy.Expr], ...]:
    h1, h2, h3 = hessian_coefficients()
    roots = tuple(symbol(name) for name in ("r1", "r2", "r3"))
    product = sympy.Poly((LAMBDA - roots[0]) * (LAMBDA - roots[1]) * (LAMBDA - roots[2]), LAMBDA)
    of_roots = dict(zip((C2, C1, C0), product.all_coeffs()[1:], strict=True))
    differences = ((roots[0] - roots[1]) * (roots[1] - roots[2]) * (roots[2] - roots[0])) ** 2
    first, second = sympy.diff(GENERIC_CUBIC, LAMBDA), sympy.diff(GENERIC_CUBIC, LAMBDA, 2)
    discriminant = pencil.discriminant_of_cubic()
    return (
        ("Δ is the product of the squared differences of the roots", discriminant.subs(of_roots) - differences),
        ("3Δ = 4·h1·h3 − h2²", 3 * discriminant - 4 * h1 * h3 + h2**2),
        ("g'(λm) = 0", first.subs(LAMBDA, local_maximum())),
        ("g''(λm) = −2√h1", second.subs(LAMBDA, local_maximum()) + 2 * sympy.sqrt(h1)),
    )
