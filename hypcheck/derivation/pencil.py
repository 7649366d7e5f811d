"""From the two surfaces to the cubic g, in symbols: Theorem 1, the pencil's determinant, its factor, g and Δ.

Everything is computed from the equations of the two bodies; nothing is taken from the paper's formulas, which are
checked against this (printed_equations.py).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import sympy

from hypcheck.derivation.plain_text import symbol

X, Y, Z, LAMBDA = (symbol(name) for name in ("x", "y", "z", "lambda"))
ALPHA, GAMMA, SMALL_B, SMALL_D = (symbol(name) for name in ("alpha", "gamma", "b", "d"))
X0, Y0, Z0 = (symbol(name) for name in ("x0", "y0", "z0"))
SEVEN = (ALPHA, GAMMA, SMALL_B, SMALL_D, X0, Y0, Z0)
SMALL_A, SMALL_C = (symbol(name) for name in ("a", "c"))
XC, YC, ZC = (symbol(name) for name in ("x_c", "y_c", "z_c"))
A, B, P, Q = (symbol(name) for name in "ABPQ")

IN_SEVEN = {
    A: (ALPHA / SMALL_B) ** 2,
    B: (GAMMA / SMALL_D) ** 2,
    P: (X0**2 + Y0**2) / SMALL_B**2,
    Q: (Z0 / SMALL_D) ** 2,
}
"""A, B, P and Q in the seven inputs."""

SCALED = {
    SMALL_A: ALPHA / SMALL_B,
    SMALL_C: GAMMA / SMALL_D,
    XC: X0 / SMALL_B,
    YC: Y0 / SMALL_B,
    ZC: Z0 / SMALL_D,
}
"""The scaled hyperboloid's semi-axes and the sphere's centre (Theorem 1) in the seven inputs."""


@dataclass(frozen=True)
class Cubic:
    """g(λ) = λ³ + c2 λ² + c1 λ + c0, its discriminant, and the determinant it comes from.

    f = det(λH + S) = factor · g/denominator, where the factor is A + λ and the denominator A² B.
    """

    f: sympy.Expr
    factor: sympy.Expr
    denominator: sympy.Expr
    c0: sympy.Expr
    c1: sympy.Expr
    c2: sympy.Expr
    discriminant: sympy.Expr

    @property
    def g(self) -> sympy.Expr:
        """The cubic in λ."""
        return LAMBDA**3 + self.c2 * LAMBDA**2 + self.c1 * LAMBDA + self.c0


def hyperboloid() -> sympy.Expr:
    """h(x, y, z), zero on the hyperboloid: centred at the origin, waist radius α, asymptotic slope γ/α."""
    return (X**2 + Y**2) / ALPHA**2 - Z**2 / GAMMA**2 - 1


def spheroid() -> sympy.Expr:
    """e(x, y, z), zero on the spheroid of semi-axes b, b, d about (x0, y0, z0)."""
    return ((X - X0) ** 2 + (Y - Y0) ** 2) / SMALL_B**2 + (Z - Z0) ** 2 / SMALL_D**2 - 1


def scaled(surface: sympy.Expr) -> sympy.Expr:
    """The surface's equation in the coordinates of Theorem 1, X̄ = (x/b, y/b, z/d): x becomes b x, and so on."""
    return surface.subs({X: SMALL_B * X, Y: SMALL_B * Y, Z: SMALL_D * Z}, simultaneous=True)


def quadric_matrix(surface: sympy.Expr, coordinates: Sequence[sympy.Symbol] = (X, Y, Z)) -> sympy.Matrix:
    """The symmetric 4×4 matrix M with (x, y, z, 1) M (x, y, z, 1)ᵀ equal to the surface's equation."""
    w = sympy.Dummy("w")
    homogeneous = sympy.expand(w**2 * surface.subs({v: v / w for v in coordinates}, simultaneous=True))
    variables = (*coordinates, w)
    return sympy.Matrix(4, 4, lambda i, j: sympy.diff(homogeneous, variables[i], variables[j]) / 2)


@cache
def scaled_matrices() -> tuple[sympy.Matrix, sympy.Matrix]:
    """H and S: the 4×4 matrices of the hyperboloid and of the unit sphere, in a, c, x_c, y_c, z_c."""
    names = {ALPHA: SMALL_A * SMALL_B, GAMMA: SMALL_C * SMALL_D, X0: XC * SMALL_B, Y0: YC * SMALL_B, Z0: ZC * SMALL_D}
    surfaces = (scaled(surface).subs(names, simultaneous=True) for surface in (hyperboloid(), spheroid()))
    hyperboloid_matrix, sphere_matrix = (quadric_matrix(sympy.cancel(surface)) for surface in surfaces)
    return hyperboloid_matrix, sphere_matrix


@cache
def scaled_cubic() -> Cubic:
    """The derivation in a, c, x_c, y_c, z_c. Raises ArithmeticError where det(λH + S) is not what it must be."""
    hyperboloid_matrix, sphere_matrix = scaled_matrices()
    f = (LAMBDA * hyperboloid_matrix + sphere_matrix).det(method="berkowitz")
    numerator, denominator = sympy.fraction(sympy.cancel(f))
    factor = SMALL_A**2 + LAMBDA
    quotient, remainder = sympy.div(sympy.Poly(numerator, LAMBDA), sympy.Poly(factor, LAMBDA))
    if remainder != 0 or quotient.degree() != 3:
        raise ArithmeticError("det(λH + S) is not (a² + λ) times a cubic")
    leading, *coefficients = quotient.all_coeffs()
    c2, c1, c0 = (sympy.expand(sympy.cancel(coefficient / leading)) for coefficient in coefficients)
    discriminant = discriminant_of_cubic().subs(dict(zip(_GENERIC, (c2, c1, c0), strict=True)), simultaneous=True)
    return Cubic(sympy.cancel(f), factor, denominator / leading, c0, c1, c2, discriminant)


@cache
def cubic() -> Cubic:
    """The derivation in A, B, P, Q. Raises ArithmeticError where more than these four mattered."""
    roots = {SMALL_A: sympy.sqrt(A), SMALL_C: sympy.sqrt(B), ZC: sympy.sqrt(Q), XC: sympy.sqrt(P - YC**2)}
    derived = _substituted(scaled_cubic(), roots)
    c0, c1, c2 = (sympy.expand(coefficient) for coefficient in (derived.c0, derived.c1, derived.c2))
    if any(not coefficient.free_symbols <= {A, B, P, Q} for coefficient in (c0, c1, c2)):
        raise ArithmeticError("the coefficients depend on more than A, B, P and Q")
    f, discriminant = sympy.cancel(derived.f), sympy.expand(derived.discriminant)
    return Cubic(f, derived.factor, derived.denominator, c0, c1, c2, discriminant)


@cache
def cubic_in_seven() -> Cubic:
    """The derivation in α, γ, b, d, x0, y0, z0."""
    return _substituted(scaled_cubic(), SCALED)


@cache
def discriminant_of_cubic() -> sympy.Expr:
    """Δ of λ³ + c2 λ² + c1 λ + c0 in c2, c1, c0: minus the resultant of the cubic and its derivative.

    It is the product of the squared differences of the roots, so Δ > 0 means three distinct real roots.
    """
    c2, c1, c0 = _GENERIC
    generic = LAMBDA**3 + c2 * LAMBDA**2 + c1 * LAMBDA + c0
    return sympy.expand(-sympy.resultant(generic, sympy.diff(generic, LAMBDA), LAMBDA))


_GENERIC = tuple(symbol(name) for name in ("c2", "c1", "c0"))


def _substituted(derived: Cubic, values: dict[sympy.Symbol, sympy.Expr]) -> Cubic:
    fields = (derived.f, derived.factor, derived.denominator, derived.c0, derived.c1, derived.c2, derived.discriminant)
    return Cubic(*(field.subs(values, simultaneous=True) for field in fields))
