"""The quadcopter of the paper's section 3.2 in symbols: where the rotors are, and the cubic of one rotor's spheroid."""

from __future__ import annotations

from functools import cache

import sympy

from hypcheck.derivation.differences import COSINE, SINE
from hypcheck.derivation.pencil import SMALL_B, SMALL_D, X0, Y0, Z0, Cubic, cubic_in_seven
from hypcheck.derivation.plain_text import symbol

ARM, ROTOR_B, ROTOR_D = (symbol(name) for name in ("l", "b_s", "d_s"))


@cache
def rotor_centre() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """The end of an arm of length l that is turned by g_i and another eighth of a turn, on a body at (x0, y0, z0)."""
    eighth = sympy.Matrix([[1, -1], [1, 1]]) / sympy.sqrt(2)
    turn = sympy.Matrix([[COSINE, -SINE], [SINE, COSINE]])
    along, across = eighth * turn * sympy.Matrix([ARM, 0])
    return X0 + along, Y0 + across, Z0


def next_rotor(expression: sympy.Expr) -> sympy.Expr:
    """The same expression of the next rotor, a quarter of a turn on."""
    return expression.subs({COSINE: -SINE, SINE: COSINE}, simultaneous=True)


def mean_over_rotors(expression: sympy.Expr) -> sympy.Expr:
    """The mean of what the expression is for each of the four rotors."""
    second = next_rotor(expression)
    third = next_rotor(second)
    return sympy.expand((expression + second + third + next_rotor(third)) / 4)


@cache
def rotor_cubic() -> Cubic:
    """The derivation for the rotor's spheroid, of semi-axes b_s, b_s, d_s."""
    x, y, z = rotor_centre()
    whole = cubic_in_seven()
    here = {SMALL_B: ROTOR_B, SMALL_D: ROTOR_D, X0: x, Y0: y, Z0: z}
    fields = (whole.f, whole.factor, whole.denominator, whole.c0, whole.c1, whole.c2, whole.discriminant)
    return Cubic(*(field.subs(here, simultaneous=True) for field in fields))
