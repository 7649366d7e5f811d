"""A term, a factor or a square forgotten, and what the paper prints wrongly."""

from __future__ import annotations

from dataclasses import replace

from tests.tools.mutants import exactly
from tests.tools.mutants.exactly import delta_terms, position
from tests.tools.mutants.expectation import wrong


def _with(rows, **wrong_terms):
    """The answers where terms are computed otherwise, from the lengths."""

    def terms(of):
        return replace(exactly.terms(of), **{name: compute(of) for name, compute in wrong_terms.items()})

    return position(rows, terms=terms)


@wrong()
def equation_12_as_printed(rows):
    """c2 lacks −z_c², as equation (12) is printed."""
    return position(rows, c2=lambda t: exactly.c2(t) + t.Q)


@wrong()
def A_not_squared(rows):
    """A = α/b."""
    return _with(rows, A=lambda of: of.alpha * of.b * of.d**2)


@wrong()
def B_not_squared(rows):
    """B = γ/d."""
    return _with(rows, B=lambda of: of.gamma * of.d * of.b**2)


@wrong()
def Q_not_squared(rows):
    """Q = |z|/d."""
    return _with(rows, Q=lambda of: abs(of.z) * of.d * of.b**2)


@wrong()
def P_not_squared(rows):
    """P = (|x| + |y|)/b."""
    return _with(rows, P=lambda of: (abs(of.x) + abs(of.y)) * of.b * of.d**2)


@wrong()
def A_squared_twice(rows):
    """A = (α/b)⁴: what is a square already is squared once more."""

    def terms(of):
        t, square = exactly.terms(of), of.b**2 * of.d**2
        return exactly.Terms(of.alpha**4 * of.d**4, t.B * square, t.P * square, t.Q * square, t.U * square)

    return position(rows, terms=terms)


@wrong()
def P_without_y(rows):
    """P = (x/b)²: the y term is forgotten."""
    return _with(rows, P=lambda of: of.x**2 * of.d**2)


@wrong()
def P_over_d(rows):
    """P = (x² + y²)/d²."""
    return _with(rows, P=lambda of: (of.x**2 + of.y**2) * of.b**2)


@wrong()
def c2_without_one(rows):
    """c2 lacks + 1."""
    return position(rows, c2=lambda t: exactly.c2(t) - t.U)


@wrong()
def c1_without_A(rows):
    """c1 lacks + A."""
    return position(rows, c1=lambda t: exactly.c1(t) - t.A * t.U)


@wrong()
def c1_mixes_A_and_B(rows):
    """c1 has A P − B Q for B P − A Q."""
    return position(rows, c1=lambda t: -t.A * t.B + t.U * (t.A - t.B) + t.A * t.P - t.B * t.Q)


@wrong()
def delta_depressed(rows):
    """Δ = −4 c1³ − 27 c0², the textbook's formula for a cubic without λ²."""
    return position(rows, delta=lambda t, k0, k1, k2: -4 * k1**3 - 27 * k0**2)


@wrong()
def delta_8_for_18(rows):
    """Δ has 8 c2 c1 c0 for 18 c2 c1 c0."""
    return position(rows, delta=lambda t, k0, k1, k2: sum(delta_terms(k0, k1, k2)) - 10 * k2 * k1 * k0)


@wrong()
def delta_26_for_27(rows):
    """Δ has 26 c0² for 27 c0²."""
    return position(rows, delta=lambda t, k0, k1, k2: sum(delta_terms(k0, k1, k2)) + k0**2)


@wrong()
def delta_square_for_cube(rows):
    """Δ has −4 c1² for −4 c1³."""
    return position(rows, delta=lambda t, k0, k1, k2: sum(delta_terms(k0, k1, k2)) + 4 * k1**3 - 4 * k1**2 * t.U**2)


@wrong()
def integer_division(rows):
    """A = ⌊α/b⌋²: the ratio is taken of integers."""
    return _with(rows, A=lambda of: (of.alpha // of.b) ** 2 * of.b**2 * of.d**2)


@wrong()
def Q_keeps_its_sign(rows):
    """Q = z |z|/d²: negative below the waist."""
    return _with(rows, Q=lambda of: of.z * abs(of.z) * of.b**2)


@wrong()
def delta_27_and_a_millionth(rows):
    """Δ has 27.000001 c0² for 27 c0²."""
    return position(rows, delta=lambda t, k0, k1, k2: 10**6 * sum(delta_terms(k0, k1, k2)) - k0**2)
