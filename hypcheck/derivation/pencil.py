"""The derivation in symbols: from the two surfaces to det(λH + S), its factor, the cubic g and its discriminant Δ.

Letters: α, γ, b, d are the sizes and (x0, y0, z0) the centre; A = (α/b)², B = (γ/d)², P = (x0² + y0²)/b² and
Q = (z0/d)². Scaled by Theorem 1, a = α/b and c = γ/d are the semi-axes and (x_c, y_c, z_c) is the centre of the sphere.
H and S are the matrices of the scaled surfaces.

Everything is computed from the equations of the two bodies. Nothing is taken from the paper's formulas: those are
checked against this (printed_equations.py), and `repair` finds what is wrong with a printed formula from its difference
to the derived one. A misprint is one place where one changed term makes the formula right: a factor, a term too many or
a missing term. The place is searched for, not known beforehand. The last part is the quadcopter of the paper's
section 3.2: where its rotors are, and the cubic of one rotor's spheroid.

`read` and `plain` turn plain text into sympy expressions and back, as in "(α/b)²·B1 − λ". A product is written with a
dot, never by juxtaposition; raised digits are powers; √2 is a root; diag(…) is a diagonal matrix. Greek letters stand
for the symbols of their names. Arguments that only say what a letter depends on, as in f(λ) and c1(g_i), are skipped.
`SYMBOLIC` is the arithmetic that evaluates a program in symbols, and `INPUTS` has the letters of its inputs.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

import sympy
from sympy.parsing.sympy_parser import parse_expr

from hypcheck.derivation.evaluation import OPERATORS, Arithmetic

_GREEK = {"α": "alpha", "γ": "gamma", "λ": "lambda", "φ": "phi", "Δ": "delta"}
_SPELLED = {name: letter for letter, name in _GREEK.items()}
_RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_TO_DIGITS = str.maketrans(_RAISED, "0123456789")
_TO_RAISED = str.maketrans("0123456789", _RAISED)
_NAME = re.compile(r"[^\W\d]\w*")
_LENGTHS = frozenset({"alpha", "gamma", "b", "d", "b_s", "d_s", "a", "c", "l"})


def symbol(name: str) -> sympy.Symbol:
    """Return the symbol of that name, always the same one: positive if it is a semi-axis or an arm, else real."""
    return sympy.Symbol(name, positive=True) if name in _LENGTHS else sympy.Symbol(name, real=True)


def read(text: str) -> sympy.Expr:
    """Return the expression of the formula in the text; a matrix if the text is diag(…)."""
    code = text.replace("(λ)", "").replace("(g_i)", "").replace("−", "-").replace("·", "*")
    code = re.sub(f"[{_RAISED}]+", lambda digits: f"**{digits[0].translate(_TO_DIGITS)}", code)
    code = re.sub(r"√(\d+)", r"sqrt(\1)", code)
    letters = {_in_code(name): symbol(_GREEK.get(name, name)) for name in _NAME.findall(code)}
    code = _NAME.sub(lambda name: _in_code(name[0]), code)
    return parse_expr(code, local_dict={**letters, "sqrt": sympy.sqrt, "diag": sympy.diag})


def plain(expression: sympy.Expr) -> str:
    """Return the formula as text, in sympy's order of terms."""
    text = sympy.sstr(expression).replace("sqrt(2)", "√2")
    text = _NAME.sub(lambda name: _SPELLED.get(name[0], name[0]), text)
    text = re.sub(r"\*\*(\d+)", lambda power: power[1].translate(_TO_RAISED), text)
    return text.replace("*", "·").replace("-", "−")


def _in_code(name: str) -> str:
    """Return the symbol's name for a letter of a text: a Greek letter's is its English name with an underscore."""
    return f"{_GREEK[name]}_" if name in _GREEK else name  # lambda is a word of Python's, lambda_ is not


X, Y, Z, LAMBDA = (symbol(name) for name in ("x", "y", "z", "lambda"))
ALPHA, GAMMA, SMALL_B, SMALL_D = (symbol(name) for name in ("alpha", "gamma", "b", "d"))
X0, Y0, Z0 = (symbol(name) for name in ("x0", "y0", "z0"))
SEVEN = (ALPHA, GAMMA, SMALL_B, SMALL_D, X0, Y0, Z0)
SMALL_A, SMALL_C = (symbol(name) for name in ("a", "c"))
XC, YC, ZC = (symbol(name) for name in ("x_c", "y_c", "z_c"))
A, B, P, Q = (symbol(name) for name in "ABPQ")
C0, C1, C2 = (symbol(name) for name in ("c0", "c1", "c2"))
GENERIC_CUBIC = LAMBDA**3 + C2 * LAMBDA**2 + C1 * LAMBDA + C0

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
class SymbolicCubic:
    """The coefficients of g(λ) = λ³ + c2 λ² + c1 λ + c0, and f, from which they are taken.

    f is det(λH + S) = (A + λ)·g(λ)/(A² B).
    """

    f: sympy.Expr
    c0: sympy.Expr
    c1: sympy.Expr
    c2: sympy.Expr

    @property
    def g(self) -> sympy.Expr:
        """The cubic in λ."""
        return LAMBDA**3 + self.c2 * LAMBDA**2 + self.c1 * LAMBDA + self.c0


def hyperboloid() -> sympy.Expr:
    """Return h(x, y, z), which is 0 on the hyperboloid: centred at the origin, waist radius α, asymptotic slope γ/α."""
    return (X**2 + Y**2) / ALPHA**2 - Z**2 / GAMMA**2 - 1


def spheroid() -> sympy.Expr:
    """Return e(x, y, z), which is 0 on the spheroid of semi-axes b, b, d about (x0, y0, z0)."""
    return ((X - X0) ** 2 + (Y - Y0) ** 2) / SMALL_B**2 + (Z - Z0) ** 2 / SMALL_D**2 - 1


def scaled(surface: sympy.Expr) -> sympy.Expr:
    """Return the surface's equation in the coordinates of Theorem 1, X̄ = (x/b, y/b, z/d): x becomes b x, and so on."""
    return surface.subs({X: SMALL_B * X, Y: SMALL_B * Y, Z: SMALL_D * Z}, simultaneous=True)


def quadric_matrix(surface: sympy.Expr) -> sympy.Matrix:
    """Return the symmetric 4×4 matrix M with (x, y, z, 1) M (x, y, z, 1)ᵀ equal to the surface's equation."""
    w = sympy.Dummy("w")
    homogeneous = sympy.expand(w**2 * surface.subs({v: v / w for v in (X, Y, Z)}, simultaneous=True))
    variables = (X, Y, Z, w)
    return sympy.Matrix(4, 4, lambda i, j: sympy.diff(homogeneous, variables[i], variables[j]) / 2)


@cache
def scaled_matrices() -> tuple[sympy.Matrix, sympy.Matrix]:
    """Return H and S: the 4×4 matrices of the hyperboloid and of the unit sphere, in a, c, x_c, y_c, z_c."""
    names = {ALPHA: SMALL_A * SMALL_B, GAMMA: SMALL_C * SMALL_D, X0: XC * SMALL_B, Y0: YC * SMALL_B, Z0: ZC * SMALL_D}
    surfaces = (scaled(surface).subs(names, simultaneous=True) for surface in (hyperboloid(), spheroid()))
    hyperboloid_matrix, sphere_matrix = (quadric_matrix(sympy.cancel(surface)) for surface in surfaces)
    return hyperboloid_matrix, sphere_matrix


@cache
def scaled_cubic() -> SymbolicCubic:
    """Derive the cubic in a, c, x_c, y_c, z_c."""
    return cubic_of(*scaled_matrices())


def cubic_of(hyperboloid_matrix: sympy.Matrix, sphere_matrix: sympy.Matrix) -> SymbolicCubic:
    """Derive the cubic of two matrices. Raises ArithmeticError if det(λH + S) does not have the factor A + λ."""
    f = (LAMBDA * hyperboloid_matrix + sphere_matrix).det(method="berkowitz")
    numerator, _ = sympy.fraction(sympy.cancel(f))
    quotient, remainder = sympy.div(sympy.Poly(numerator, LAMBDA), sympy.Poly(SMALL_A**2 + LAMBDA, LAMBDA))
    if remainder != 0 or quotient.degree() != 3:
        raise ArithmeticError("det(λH + S) is not (a² + λ) times a cubic")
    leading, *coefficients = quotient.all_coeffs()
    c2, c1, c0 = (sympy.expand(sympy.cancel(coefficient / leading)) for coefficient in coefficients)
    return SymbolicCubic(sympy.cancel(f), c0, c1, c2)


@cache
def cubic() -> SymbolicCubic:
    """Derive the cubic in A, B, P, Q."""
    return in_invariants(scaled_cubic())


def in_invariants(scaled_one: SymbolicCubic) -> SymbolicCubic:
    """Express a scaled cubic in A, B, P, Q. Raises ArithmeticError if it depends on more than these four."""
    roots = {SMALL_A: sympy.sqrt(A), SMALL_C: sympy.sqrt(B), ZC: sympy.sqrt(Q), XC: sympy.sqrt(P - YC**2)}
    derived = _substituted(scaled_one, roots)
    c0, c1, c2 = (sympy.expand(coefficient) for coefficient in (derived.c0, derived.c1, derived.c2))
    if any(not coefficient.free_symbols <= {A, B, P, Q} for coefficient in (c0, c1, c2)):
        raise ArithmeticError("the coefficients depend on more than A, B, P and Q")
    return SymbolicCubic(sympy.cancel(derived.f), c0, c1, c2)


@cache
def cubic_in_seven() -> SymbolicCubic:
    """Derive the cubic in α, γ, b, d, x0, y0, z0."""
    return _substituted(scaled_cubic(), SCALED)


@cache
def discriminant_of_cubic() -> sympy.Expr:
    """Return Δ of λ³ + c2 λ² + c1 λ + c0 in c2, c1, c0: minus the resultant of the cubic and its derivative.

    It is the product of the squared differences of the roots, so Δ > 0 means three distinct real roots.
    """
    return sympy.expand(-sympy.resultant(GENERIC_CUBIC, sympy.diff(GENERIC_CUBIC, LAMBDA), LAMBDA))


def _substituted(derived: SymbolicCubic, values: dict[sympy.Symbol, sympy.Expr]) -> SymbolicCubic:
    """Replace letters of a cubic by expressions, all at the same time."""
    fields = (derived.f, derived.c0, derived.c1, derived.c2)
    return SymbolicCubic(*(field.subs(values, simultaneous=True) for field in fields))


COSINE, SINE = symbol("cosine"), symbol("sine")
Meanings = dict[sympy.Symbol, sympy.Expr]


@dataclass(frozen=True)
class Repair:
    """The error of a printed formula, as the sentence `finding`, and the corrected formula.

    `one_place` is true if a change of one factor or one term in one place corrects the formula.
    """

    finding: str
    corrected: sympy.Expr
    one_place: bool


@cache
def difference(printed: sympy.Expr, derived: sympy.Expr) -> sympy.Expr:
    """Return printed − derived in lowest terms, given cosine² + sine² = 1.

    If it is 0, the two are equal. If two rational functions of the letters are equal, it is 0.
    """
    numerator, denominator = sympy.fraction(sympy.together(printed - derived))
    numerator = sympy.expand(numerator)
    if numerator.has(SINE) and numerator.is_polynomial(SINE, COSINE):
        numerator = sympy.rem(numerator, SINE**2 + COSINE**2 - 1, SINE)
    return sympy.cancel(numerator / denominator)


def repair(printed: sympy.Expr, derived: sympy.Expr, meanings: Meanings) -> Repair:
    """Find the smallest change that makes `printed` equal to `derived`, with its letters replaced by their `meanings`.

    The two must not be equal already.
    """
    gap = difference(printed.subs(meanings), derived)
    if derived != 0:
        factor = sympy.cancel(printed.subs(meanings) / derived)
        if _is_single_term(factor):
            return _repaired_factor(printed, factor)
    repairs = []
    for node, rebuilt in _sums(printed):
        change = _change(rebuilt, gap, meanings)
        # A coefficient stays free of λ: a power of λ is put right among the powers of λ.
        if change is not None and (node.has(LAMBDA) or not change.has(LAMBDA)):
            repairs.append((-change not in sympy.Add.make_args(node), sympy.count_ops(change), change, node, rebuilt))
    lacking, _, change, node, rebuilt = min(repairs, key=lambda repair: repair[:2])
    corrected = rebuilt(node + change)
    if not _is_single_term(change):
        return Repair(f"right − left = {plain(gap)}", corrected, one_place=False)
    trouble = f"lacks {_signed(change)}" if lacking else f"has a stray {_signed(-change)}"
    return Repair(f"right − left = {plain(gap)}: {_where(gap, node)} {trouble}", corrected, one_place=True)


def _repaired_factor(printed: sympy.Expr, factor: sympy.Expr) -> Repair:
    """Return the repair of a formula that is `factor` times the right one."""
    numerator, denominator = sympy.fraction(printed)
    roots = "" if factor.has(LAMBDA) else ", and the roots stay the same"
    finding = f"the right side is {plain(factor)} times the left"
    if denominator != 1:
        finding += f": the denominator {plain(denominator)} must be {plain(denominator * factor)}"
        return Repair(finding + roots, numerator / (denominator * factor), one_place=True)
    return Repair(finding + roots, printed / factor, one_place=True)


def _change(rebuilt: Callable[[sympy.Expr], sympy.Expr], gap: sympy.Expr, meanings: Meanings) -> sympy.Expr | None:
    """Find the term that corrects the formula if it is added to the sum in one place.

    `rebuilt` returns the formula with another expression in that place, and `gap` is printed − derived. The result is
    None if the formula is not linear in that place.
    """
    unknown = sympy.Dummy()
    slope = sympy.diff(rebuilt(unknown), unknown).subs(meanings)
    if slope == 0 or slope.has(unknown):
        return None
    return sympy.cancel(-gap / slope)


def _sums(expression: sympy.Expr) -> Iterator[tuple[sympy.Expr, Callable[[sympy.Expr], sympy.Expr]]]:
    """Yield the whole expression and every sum within it, each with a function that puts another expression there."""
    yield expression, lambda other: other
    for index, argument in enumerate(expression.args):
        for node, rebuilt in _sums(argument):
            if node.is_Add:
                yield node, _rebuilder(expression, index, rebuilt)


def _rebuilder(
    parent: sympy.Expr, index: int, rebuilt: Callable[[sympy.Expr], sympy.Expr]
) -> Callable[[sympy.Expr], sympy.Expr]:
    def put(other: sympy.Expr) -> sympy.Expr:
        return parent.func(*parent.args[:index], rebuilt(other), *parent.args[index + 1 :])

    return put


def _where(gap: sympy.Expr, node: sympy.Expr) -> str:
    """Return the words for the place of an error: the coefficient of a power of λ, or the sum `node`."""
    powers = sympy.Poly(sympy.fraction(gap)[0], LAMBDA).monoms() if gap.has(LAMBDA) else []
    if len(powers) == 1 and not node.has(LAMBDA):
        return f"the coefficient of {plain(LAMBDA ** powers[0][0])}"
    return f"the sum {plain(node)}"


def _is_single_term(expression: sympy.Expr) -> bool:
    """Decide whether the expression is one term: neither its numerator nor its denominator is a sum."""
    return all(not part.is_Add for part in sympy.fraction(sympy.factor_terms(expression)))


def _signed(term: sympy.Expr) -> str:
    """Return the term as text after its sign and a space."""
    return f"− {plain(-term)}" if term.could_extract_minus_sign() else f"+ {plain(term)}"


ARM, ROTOR_B, ROTOR_D = (symbol(name) for name in ("l", "b_s", "d_s"))


@cache
def rotor_centre() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """Return the rotor's centre: the end of an arm of length l on a body at (x0, y0, z0).

    The arm is turned by g_i and another eighth of a turn.
    """
    eighth = sympy.Matrix([[1, -1], [1, 1]]) / sympy.sqrt(2)
    turn = sympy.Matrix([[COSINE, -SINE], [SINE, COSINE]])
    along, across = eighth * turn * sympy.Matrix([ARM, 0])
    return X0 + along, Y0 + across, Z0


def next_rotor(expression: sympy.Expr) -> sympy.Expr:
    """Return the expression for the next rotor, a quarter of a turn further."""
    return expression.subs({COSINE: -SINE, SINE: COSINE}, simultaneous=True)


def mean_over_rotors(expression: sympy.Expr) -> sympy.Expr:
    """Return the mean of the expression over the four rotors."""
    second = next_rotor(expression)
    third = next_rotor(second)
    return sympy.expand((expression + second + third + next_rotor(third)) / 4)


@cache
def rotor_cubic() -> SymbolicCubic:
    """Derive the cubic of the rotor's spheroid, whose semi-axes are b_s, b_s, d_s."""
    x, y, z = rotor_centre()
    return _substituted(cubic_in_seven(), {SMALL_B: ROTOR_B, SMALL_D: ROTOR_D, X0: x, Y0: y, Z0: z})


SYMBOLIC = Arithmetic(
    name="symbolic",
    convert=sympy.sympify,
    operations={
        **OPERATORS,
        "sqrt": sympy.sqrt,
        "cos": sympy.cos,
        "arccos": sympy.acos,
        "eq": sympy.Equality,
        "ne": sympy.Unequality,
        "not": sympy.Not,
        "select": lambda condition, yes, no: sympy.Piecewise((yes, condition), (no, True)),
    },
)
"""Inputs may be expressions, integers or rationals; comparisons become relations, and a selection is a Piecewise."""


INPUTS = {
    **dict(zip(("alpha", "gamma", "b", "d", "x", "y", "z"), SEVEN, strict=True)),
    "b_s": ROTOR_B,
    "d_s": ROTOR_D,
    "l": ARM,
    "cosine": COSINE,
    "sine": SINE,
    "lambda_": LAMBDA,
}
"""The letter that each input of a program represents."""
