"""The derivation step by step: from the two surfaces to the coefficients, the rotors, and the paper's Appendix A.

Each section is a chain of links whose parts are the displayed formulas, in the paper's letters and in the order in
which the paper prints them; every one is compared with what sympy makes of the two surfaces. Where the paper misprints
a formula the right one is used here.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.links import (
    Chain,
    chain,
    hessian_coefficients,
    identity,
    known,
    link,
    matrix_identity,
    printed,
)
from hypcheck.derivation.pencil import C0, C1, C2, GENERIC_CUBIC, LAMBDA, read, symbol
from hypcheck.derivation.printed_equations import rotor_meanings


def rotors() -> Chain:
    """Return the section about the rotors, equations (15) to (21)."""
    return chain(
        "The rotors",
        "Four spheroids of semi-axes b_s, b_s, d_s at the ends of arms of length l. One cosine and one sine serve all "
        "four: g_i = g_1 + (i − 1)·π/2 only exchanges T1 and T2 and turns signs.",
        link("Their centres, equations (15) and (18).", *printed("15", "18")),
        link("Scaled by 1/b_s and 1/d_s, equations (16) and (17).", *printed("16", "17")),
        link("Their coefficients, equations (19) to (21).", *printed("19", "20", "21")),
    )


def appendix() -> Chain:
    """Return the section about Appendix A, without the stray + l of its second display."""
    c1 = rotor_meanings()["c1"]
    repaired = identity(
        "c1(g_i) = (α/b_s)²·(1 − (γ/d_s)² − (z0/d_s)²) + (γ/d_s)²·((x0² + y0² + l²)/b_s² − 1) + "
        "(γ/d_s)²·(l·√2·(T1(g_i)·x0 + T2(g_i)·y0)/b_s²)",
        c1,
        **{name: rotor_meanings()[name] for name in ("T1", "T2")},
    )
    return chain(
        "Appendix A",
        "The same, step by step: (15) put into (14), and what turns with g_i parted from what does not.",
        link("c1 in x_i, y_i, z_i, and by (18).", *printed("A.1", "A.2a")),
        link("The paper prints l² + l here; + l is too much.", repaired),
        link("Parted into A1, A2 and C(g_i).", *printed("A.3", "A.4", "A.5", "A.6")),
        link("Named B1 and B2, equations (22) and (23).", *printed("22", "23")),
    )


def walk() -> Iterator[Chain]:
    """Yield the sections in order; each is derived when the iterator reaches it."""
    yield _surfaces()
    yield _theorem_1()
    yield _matrices()
    yield _pencil()
    yield _coefficients()
    yield _between_poles()
    yield _discriminant()
    yield _roots_in_numbers()
    yield rotors()
    yield appendix()


def _surfaces() -> Chain:
    """Return the section about the equations and matrices of the two surfaces."""
    return chain(
        "The two surfaces",
        "A circular hyperboloid of one sheet H̄, centred at the origin, and a spheroid E of semi-axes b, b, d about "
        "(x0, y0, z0).",
        link(
            "The hyperboloid, equations (1) to (3).",
            *printed("1", "2", "3"),
            known("the line (α, αt, γt), turned about the axis, lies on the hyperboloid"),
        ),
        link(
            "The spheroid, equations (4) to (6).",
            *printed("4", "5", "6"),
            known("the unit sphere, stretched by b, b, d and moved to (x0, y0, z0), is the spheroid"),
        ),
    )


def _theorem_1() -> Chain:
    """Return the section about Theorem 1, the scaling."""
    return chain(
        "Theorem 1: scaling",
        "Divide x and y by b, and z by d. The spheroid becomes the unit sphere S, the hyperboloid H has the semi-axes "
        "a = α/b and c = γ/d; points in common stay points in common.",
        link("The map X̄ = A·X, equations (9) and (10).", *printed("9", "10")),
        link("What it makes of the two surfaces, equations (7) and (8).", *printed("7", "8")),
        link(
            "The determinant below changes by a constant factor, its roots not at all.",
            known("Theorem 1 divides the pencil's determinant by the constant 1/(b⁴d²)"),
        ),
    )


def _matrices() -> Chain:
    """Return the section about the two matrices of the scaled surfaces."""
    hyperboloid, sphere = pencil.scaled_matrices()
    return chain(
        "The two matrices",
        "Of the surfaces (x, y, z, 1)·M·(x, y, z, 1)ᵀ = 0, with (x_c, y_c, z_c) = (x0/b, y0/b, z0/d).",
        link(
            "The scaled hyperboloid.",
            matrix_identity("H = [1/a², 0, 0, 0; 0, 1/a², 0, 0; 0, 0, −1/c², 0; 0, 0, 0, −1]", hyperboloid),
        ),
        link(
            "The unit sphere.",
            matrix_identity(
                "S = [1, 0, 0, −x_c; 0, 1, 0, −y_c; 0, 0, 1, −z_c; −x_c, −y_c, −z_c, x_c² + y_c² + z_c² − 1]",
                sphere,
            ),
        ),
    )


def _pencil() -> Chain:
    """Return the section about f = det(λH + S) and the cubic g."""
    derived = pencil.scaled_cubic()
    factor, whole = read("a² + λ"), sympy.cancel(derived.f * read("a⁴·c²"))
    remainder = sympy.rem(sympy.Poly(whole, LAMBDA), sympy.Poly(factor, LAMBDA)).as_expr()
    return chain(
        "The pencil and its cubic",
        "The characteristic polynomial is f(λ) = det(λ·H + S). One factor is known beforehand; what is left is the "
        "cubic g.",
        link(
            "The factor a² + λ, equation (11) with its denominator put right: the paper prints a²·c².",
            identity("remainder of a⁴·c²·f(λ) divided by (a² + λ) = 0", remainder),
            identity("f(λ) = (a² + λ)·g(λ)/(a⁴·c²)", derived.f, g=derived.g),
        ),
        link(
            "The cubic, equation (12) with the −z_c² that the paper drops.",
            identity(
                "g(λ) = λ³ + (a² − c² + 1 − x_c² − y_c² − z_c²)·λ² − (a²·c² − a² + c² − c²·x_c² − c²·y_c² + "
                "a²·z_c²)·λ − a²·c²",
                derived.g,
            ),
        ),
    )


def _coefficients() -> Chain:
    """Return the section about the coefficients of g."""
    derived = pencil.cubic()
    return chain(
        "The coefficients",
        "g(λ) = λ³ + c2·λ² + c1·λ + c0. Only A = (α/b)², B = (γ/d)², P = (x0² + y0²)/b² and Q = (z0/d)² matter.",
        link("In the seven inputs, equation (14).", *printed("14")),
        link(
            "In A, B, P and Q.",
            identity("c0 = −A·B", derived.c0),
            identity("c1 = −A·B + A − B + B·P − A·Q", derived.c1),
            identity("c2 = A − B + 1 − P − Q", derived.c2),
        ),
    )


def _between_poles() -> Chain:
    """Return the section about the signs of g at −A, 0 and B and between them."""
    return chain(
        "g at and between its poles",
        "Where λ·H + S degenerates, at −A and B, and at 0, the sign of g is known. Between them g has the sign of φ, "
        "the dual of the distance.",
        link(
            "g as a sum of three products.",
            known("g(λ) = (A + λ)(B − λ)(P + Q − 1 − λ) − AP(B − λ) − BQ(A + λ)"),
            known("g(−A) = −AP(A + B)"),
            known("g(0) = −AB"),
            known("g(B) = −BQ(A + B)"),
        ),
        link("φ(λ) = P·λ/(A + λ) − Q·λ/(B − λ) − 1 − λ.", known("g(λ) = (A + λ)(B − λ)·φ(λ)")),
    )


def _discriminant() -> Chain:
    """Return the section about the discriminant Δ."""
    h1, h2, h3 = hessian_coefficients()
    return chain(
        "The discriminant",
        "Δ is minus the resultant of g and g'. Three times it is a difference of two products of the Hessian's "
        "coefficients.",
        link(
            "Remark 2, equation (13).",
            *printed("13"),
            known("Δ is the product of the squared differences of the roots"),
        ),
        link(
            "The Hessian form takes fewer operations: the Hessian covariant of g is h1·λ² + h2·λ·μ + h3·μ².",
            identity("h1 = c2² − 3·c1", h1),
            identity("h2 = c2·c1 − 9·c0", h2),
            identity("h3 = c1² − 3·c2·c0", h3),
            known("3Δ = 4·h1·h3 − h2²"),
        ),
    )


def _roots_in_numbers() -> Chain:
    """Return the section about computing the roots. √h1 counts as a letter there, with c1 = (c2² − √h1²)/3."""
    root, cosine = symbol("h"), symbol("k")
    in_root = {C1: (C2**2 - root**2) / 3}
    w = (9 * C1 * C2 - 2 * C2**3 - 27 * C0).subs(in_root)
    at = 27 * GENERIC_CUBIC.subs(in_root).subs(LAMBDA, (2 * root * cosine - C2) / 3)
    return chain(
        "The roots in numbers",
        "What the coefficients spare: three cosines. With h = √h1 and w = 9·c1·c2 − 2·c2³ − 27·c0, λ = (2·h·k − c2)/3 "
        "is a root of g exactly if 4·k³ − 3·k = w/(2·h³); and 4·cos³ θ − 3·cos θ = cos 3θ.",
        link(
            "The substitution.",
            identity("27·g(λ) = 2·h³·(4·k³ − 3·k) − w", at, w=w),
            identity(
                "27·Δ = 4·h⁶ − w²",
                27 * pencil.discriminant_of_cubic().subs(in_root),
                w=w,
            ),
        ),
    )
