"""Theorem 1, and the rule without hypothesis: the bodies are clear if g > 0 somewhere between −A and B, and only then.

Theorem 1: dividing x, y by b and z by d changes no position, and makes the spheroid the unit sphere. φ is the Lagrange
dual of the squared distance to the hyperboloid H (docs/mathematics.md). Letters: C = (x_c, y_c, z_c) the centre,
h(X) = (x² + y²)/A − z²/B − 1, and for −A < λ < B the positive u = A + λ, v = B − λ.
"""

from __future__ import annotations

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import PHI, Chain, Link, identity, known, sign
from hypcheck.derivation.pencil import LAMBDA, XC, YC, ZC, A, B, P, Q, X, Y, Z, read, symbol


def theorem_1() -> Chain:
    """The chain; the map is X̄ = A·X with A = diag(1/b, 1/b, 1/d) of equation (9)."""
    scaling = sympy.diag(1 / pencil.SMALL_B, 1 / pencil.SMALL_B, 1 / pencil.SMALL_D)
    return Chain(
        "Theorem 1",
        "The spheroid stands to the hyperboloid as the unit sphere stands to the scaled hyperboloid.",
        (
            Link(
                "X̄ = A·X is one-to-one: A = diag(1/b, 1/b, 1/d) has a determinant above 0.",
                "sign",
                (identity("det A = 1/(b²·d)", scaling.det()), sign("1/(b²·d) > 0", "b d")),
            ),
            Link(
                "The hyperboloid's equation, with its values inside and outside, becomes (7).",
                "identity",
                (identity("h(A⁻¹·X̄) = x²/(α/b)² + y²/(α/b)² − z²/(γ/d)² − 1", pencil.scaled(pencil.hyperboloid())),),
            ),
            Link(
                "The spheroid's equation becomes (8), that of a unit sphere. So points in common go to points in "
                "common, and inside stays inside.",
                "identity",
                (identity("e(A⁻¹·X̄) = (x − x0/b)² + (y − y0/b)² + (z − z0/d)² − 1", pencil.scaled(pencil.spheroid())),),
            ),
            Link(
                "The roots stay the same too: the determinant of the pencil changes by a constant factor.",
                "identity",
                (known("Theorem 1 divides the pencil's determinant by the constant 1/(b⁴d²)"),),
            ),
        ),
    )


S_LEMMA = "S-lemma (Yakubovich 1971; Pólik and Terlaky, SIAM Review 49 (2007) 371–418)"

_U, _V = A + LAMBDA, B - LAMBDA
_OF_CENTRE = {P: XC**2 + YC**2, Q: ZC**2}
_SURFACE = (X**2 + Y**2) / A - Z**2 / B - 1
_SQUARED_DISTANCE = (X - XC) ** 2 + (Y - YC) ** 2 + (Z - ZC) ** 2
_SLOPE = sympy.diff(PHI, LAMBDA)
_NEAREST = {X: A * XC / _U, Y: A * YC / _U, Z: B * ZC / _V}


def rule_chain() -> Chain:
    """Exterior, interior and contact by the sign of g between the poles, for all sizes."""
    return Chain(
        "rule",
        "For all a, c > 0: exterior ⟺ g(λ) > 0 for some λ in (0, B); interior ⟺ g(λ) > 0 for some λ in (−A, 0); "
        "contact ⟺ neither.",
        (
            _weak_duality(),
            _attained_inside(),
            _concave(),
            _attained_at_minus_A(),
            _attained_at_B(),
            _s_lemma(),
            _sides(),
            _same_sign(),
            _no_fourth_position(),
        ),
    )


def _weak_duality() -> Link:
    whole = _SQUARED_DISTANCE + LAMBDA * _SURFACE
    return Link(
        "Every λ in (−A, B) bounds the distance: for X on H, where h = 0, |X − C|² ≥ φ(λ) + 1.",
        "identity",
        (
            identity(
                "|X − C|² + λ·h(X) = u/A·((x − A·x_c/u)² + (y − A·y_c/u)²) + v/B·(z − B·z_c/v)² + φ + 1",
                whole,
                u=_U,
                v=_V,
                phi=PHI.subs(_OF_CENTRE),
            ),
            sign("u/A > 0", "u A"),
            sign("v/B > 0", "v B"),
        ),
    )


def _attained_inside() -> Link:
    distance = (_SQUARED_DISTANCE + LAMBDA * _SURFACE).subs(_NEAREST)
    return Link(
        "Where φ' = 0 the bound is attained: the minimiser X = (A·x_c/u, A·y_c/u, B·z_c/v) lies on H.",
        "identity",
        (
            identity("φ'(λ) = A·P/u² − B·Q/v² − 1", _SLOPE, u=_U, v=_V),
            identity("h(X) = A·P/u² − B·Q/v² − 1", _SURFACE.subs(_NEAREST), u=_U, v=_V, **_centre()),
            identity("|X − C|² + λ·h(X) = φ + 1", distance, phi=PHI.subs(_OF_CENTRE)),
        ),
    )


def _centre() -> dict[str, sympy.Expr]:
    return {name.name: value for name, value in _OF_CENTRE.items()}


def _concave() -> Link:
    return Link(
        "φ is concave, so it has one largest value: where φ' = 0, or at a pole. At −A only if P = 0, at B only if Q = "
        "0: else φ' is positive near −A, negative near B.",
        "sign",
        (
            identity("φ''(λ) = −2·A·P/u³ − 2·B·Q/v³", sympy.diff(PHI, LAMBDA, 2), u=_U, v=_V),
            sign("−2·A·P/u³ − 2·B·Q/v³ ≤ 0", "A B u v", "P Q"),
            identity("u²·φ' at −A = A·P", sympy.cancel(_SLOPE * _U**2).subs(LAMBDA, -A)),
            identity("v²·φ' at B = −B·Q", sympy.cancel(_SLOPE * _V**2).subs(LAMBDA, B)),
            sign("A·P > 0", "A P"),
            sign("−B·Q < 0", "B Q"),
        ),
    )


def _attained_at_minus_A() -> Link:
    on_axis = {XC: 0, YC: 0}
    height = B * ZC / (A + B)
    circle = {X: symbol("rho"), Y: 0, Z: height}
    radius = {"rho": sympy.sqrt(A * (1 + height**2 / B))}
    distance = _SQUARED_DISTANCE.subs(on_axis).subs(circle).subs(symbol("rho"), radius["rho"])
    return Link(
        "If P = 0, φ falls all the way from −A, and the bound is attained there: on a circle of H at height B·z_c/(A + "
        "B).",
        "identity",
        (
            identity("φ' without P = −B·Q/v² − 1", _SLOPE.subs(P, 0), v=_V),
            sign("−B·Q/v² − 1 < 0", "B v", "Q"),
            identity("h on the circle = 0", _SURFACE.subs(circle).subs(symbol("rho"), radius["rho"])),
            identity("|X − C|² on the circle = A + A·z_c²/(A + B)", distance),
            identity("φ(−A) + 1 without P = A + A·Q/(A + B)", (PHI.subs(P, 0) + 1).subs(LAMBDA, -A)),
        ),
    )


def _attained_at_B() -> Link:
    """In the half plane y = 0, x ≥ 0 of the centre (r, 0, 0); k says by how much A·P exceeds (A + B)²."""
    r, zeta = symbol("r"), symbol("zeta")
    rho = A * r / (A + B)
    height = sympy.sqrt(B * (rho**2 / A - 1))
    in_waist = {XC: r, YC: 0, ZC: 0}
    points = {X: rho, Y: 0, Z: zeta}
    distance = _SQUARED_DISTANCE.subs(in_waist).subs(points).subs(zeta, height)
    return Link(
        "If Q = 0 and φ' ≥ 0 up to B, which is A·P = (A + B)² + k with k ≥ 0, the bound is attained at B: in two "
        "points of H, at x = A·r/(A + B), r² = P.",
        "identity",
        (
            identity("φ'(B) without Q = A·P/(A + B)² − 1", _SLOPE.subs(Q, 0).subs(LAMBDA, B)),
            identity("z²/B = A·P/(A + B)² − 1", height**2 / B, P=r**2),
            sign("((A + B)² + k)/(A + B)² − 1 ≥ 0", "A B", "k"),
            identity("h in the points = 0", _SURFACE.subs(points).subs(zeta, height)),
            identity("|X − C|² in the points = P·B/(A + B) − B", distance, P=r**2),
            identity("φ(B) + 1 without Q = P·B/(A + B) − B", (PHI.subs(Q, 0) + 1).subs(LAMBDA, B)),
        ),
    )


def _s_lemma() -> Link:
    """Its hypothesis on either side: the constraint h ≤ 0, or −h ≤ 0, holds strictly somewhere."""
    a = symbol("a")
    return Link(
        "So the largest φ is dist(C, H)² − 1. The S-lemma says the same in general: |X − C|² ≥ ρ² wherever h ≤ 0 (or "
        "−h ≤ 0) exactly if some λ ≥ 0 (or ≤ 0) has |X − C|² − ρ² + λ·h ≥ 0 everywhere.",
        "cited theorem",
        (
            identity("h(0, 0, 0) = −1", _SURFACE.subs({X: 0, Y: 0, Z: 0})),
            sign("−1 < 0"),
            identity("h(2·a, 0, 0) = 3", _SURFACE.subs({X: 2 * a, Y: 0, Z: 0}).subs(A, a**2)),
            sign("3 > 0"),
        ),
        cites=S_LEMMA,
    )


def _sides() -> Link:
    tangent = PHI - PHI.subs(LAMBDA, 0) - _SLOPE.subs(LAMBDA, 0) * LAMBDA
    return Link(
        "φ lies below its tangent at 0, which begins at −1 with the slope h(C): φ > 0 at a λ > 0 puts C outside H, at "
        "a λ < 0 inside.",
        "sign",
        (
            identity("φ(0) = −1", PHI.subs(LAMBDA, 0)),
            identity("φ'(0) = P/A − Q/B − 1", _SLOPE.subs(LAMBDA, 0)),
            identity("h(C) = P/A − Q/B − 1", _SURFACE.subs({X: XC, Y: YC, Z: ZC}), **_centre()),
            identity("φ − φ(0) − φ'(0)·λ = −λ²·(P/(A·u) + Q/(B·v))", tangent, u=_U, v=_V),
            sign("−λ²·(P/(A·u) + Q/(B·v)) ≤ 0", "A B u v", "P Q"),
        ),
    )


def _same_sign() -> Link:
    return Link(
        "The ball is clear exactly if dist > 1, so exactly if φ > 0 somewhere between the poles; and there g has the "
        "sign of φ.",
        "identity",
        (known("g(λ) = (A + λ)(B − λ)·φ(λ)"), sign("u·v > 0", "u v")),
    )


def _no_fourth_position() -> Link:
    line = {X: read("α"), Y: read("α·t"), Z: read("γ·t")}
    reach = (X**2 + Y**2 + Z**2).subs(line)
    return Link(
        "There is no fourth position: the ball, being connected, is wholly on one side if it is clear; and H, "
        "connected and without bound, does not fit into a ball.",
        "identity",
        (
            known("the line (α, αt, γt), turned about the axis, lies on the hyperboloid"),
            identity("|(α, α·t, γ·t)|² = α² + (α² + γ²)·t²", reach),
            sign("α² + (α² + γ²)·t² > 0", "alpha gamma"),
        ),
    )
