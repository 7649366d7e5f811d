"""The paper's displayed formulas (1) to (23) and those of its Appendix A as printed, and checks of them.

The statements are the paper's text in one-line notation, in the order printed. Each is compared with the derivation
(pencil.py) and with no other printed formula, unless it claims to follow from one. If a formula does not hold, its
check says what is wrong.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import groupby

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.pencil import mean_over_rotors, read, symbol


@dataclass(frozen=True)
class PrintedClaim:
    """One printed equality. `pairs` are pairs of a printed expression and the expression that it must equal.

    `meanings` has the expressions that the letters in the printed ones represent.
    """

    number: str
    statement: str
    pairs: tuple[tuple[sympy.Expr, sympy.Expr], ...]
    meanings: pencil.Meanings


@cache
def printed_claims() -> tuple[PrintedClaim, ...]:
    """Return every claim, in the paper's order; claims of one number follow each other."""
    return (*_surfaces(), *_theorem_1(), *_cubic(), *_rotors(), *_appendix())


def equality(number: str, statement: str, **meanings: sympy.Expr) -> PrintedClaim:
    """Make the claim "left = right": the printed right side must equal the meaning of the left side's letters."""
    left, _, right = statement.partition("=")
    values = {symbol(name): value for name, value in meanings.items()}
    return PrintedClaim(number, statement, ((read(right), read(left).subs(values)),), values)


def matrix(number: str, statement: str, derived: sympy.Matrix) -> PrintedClaim:
    """Make the claim "name = diag(…)", entry by entry."""
    return PrintedClaim(number, statement, tuple(zip(read(statement.partition("=")[2]), derived, strict=True)), {})


def surface(number: str, statement: str, derived: sympy.Expr) -> PrintedClaim:
    """Make the claim that left − right equals `derived`, which is 0 on the surface."""
    left, _, right = statement.partition("=")
    return PrintedClaim(number, statement, ((read(left) - read(right), derived),), {})


_X = sympy.Matrix([pencil.X, pencil.Y, pencil.Z])
_HYPERBOLOID_MATRIX = "H̄ = diag(1/α², 1/α², −1/γ²)"
_SPHEROID_MATRIX = "E = diag(1/b², 1/b², 1/d²)"
_VECTOR = "(x0/b², y0/b², z0/d²)"
_CONSTANT = "x0²/b² + y0²/b² + z0²/d² − 1"
_SCALING = "A = diag(1/b, 1/b, 1/d)"


def _right(statement: str) -> sympy.Expr:
    """Return the expression after the first "=" of the text."""
    return read(statement.partition("=")[2])


def _surfaces() -> Iterator[PrintedClaim]:
    """Yield the claims about the two surfaces and their matrices, from (1) on."""
    hyperboloid, spheroid = pencil.hyperboloid(), pencil.spheroid()
    yield surface("1", "x²/α² + y²/α² − z²/γ² = 1", hyperboloid)
    form = (_X.T * _right(_HYPERBOLOID_MATRIX) * _X)[0] - 1
    yield PrintedClaim("2", "Xᵀ·H̄·X − 1 = 0", ((form, hyperboloid),), {})
    yield matrix("3", _HYPERBOLOID_MATRIX, pencil.quadric_matrix(hyperboloid)[:3, :3])
    yield surface("4", "(x − x0)²/b² + (y − y0)²/b² + (z − z0)²/d² = 1", spheroid)
    form = (_X.T * _right(_SPHEROID_MATRIX) * _X)[0] - 2 * (_printed_row(_VECTOR) * _X)[0] + read(_CONSTANT)
    yield PrintedClaim("5", f"Xᵀ·E·X − 2·B·X + K = 0 with B = {_VECTOR}, K = {_CONSTANT}", ((form, spheroid),), {})
    yield matrix("6", _SPHEROID_MATRIX, pencil.quadric_matrix(spheroid)[:3, :3])


def _theorem_1() -> Iterator[PrintedClaim]:
    """Yield the claims of Theorem 1, the scaling."""
    hyperboloid, sphere = pencil.scaled(pencil.hyperboloid()), pencil.scaled(pencil.spheroid())
    yield surface("7", "x²/(α/b)² + y²/(α/b)² − z²/(γ/d)² = 1", hyperboloid)
    yield surface("8", "(x − x0/b)² + (y − y0/b)² + (z − z0/d)² = 1", sphere)
    # The proof of Theorem 1 also prints it in the matrices of (5) and (9).
    inverse = _right(_SCALING).inv()
    form = (_X.T * _X)[0] - 2 * (_printed_row(_VECTOR) * inverse * _X)[0] + read(_CONSTANT)
    yield PrintedClaim("8", "X̄ᵀ·X̄ − 2·B·A⁻¹·X̄ + K = 0", ((form, sphere),), {})
    # The scaling is the one that turns the spheroid's matrix into the unit matrix.
    axes = pencil.quadric_matrix(pencil.spheroid())[:3, :3].applyfunc(sympy.sqrt)
    yield matrix("9", _SCALING, axes)
    scaled = pencil.quadric_matrix(hyperboloid)[:3, :3]
    product = inverse * _right(_HYPERBOLOID_MATRIX) * inverse
    yield PrintedClaim("10", "H = A⁻¹·H̄·A⁻¹", tuple(zip(product, scaled, strict=True)), {})
    yield matrix("10", "H = diag(b²/α², b²/α², −d²/γ²)", scaled)


def _cubic() -> Iterator[PrintedClaim]:
    """Yield the claims about the cubic g and its discriminant."""
    scaled, seven = pencil.scaled_cubic(), pencil.cubic_in_seven()
    yield equality("11", "f(λ) = (a² + λ)·g(λ)/(a²·c²)", f=scaled.f, g=scaled.g)
    yield equality(
        "12",
        "g(λ) = λ³ + (a² − c² + 1 − x_c² − y_c²)·λ² − (a²·c² − a² + c² − c²·x_c² − c²·y_c² + a²·z_c²)·λ − a²·c²",
        g=scaled.g,
    )
    discriminant = "Δ = −4·c2³·c0 + c2²·c1² + 18·c2·c1·c0 − 4·c1³ − 27·c0²"
    yield equality("13", discriminant, delta=pencil.discriminant_of_cubic())
    yield equality("14", "c0 = −(α/b)²·(γ/d)²", c0=seven.c0)
    yield equality(
        "14",
        "c1 = −(α/b)²·(γ/d)² + (α/b)² − (γ/d)² + (γ/d)²·(x0/b)² + (γ/d)²·(y0/b)² − (α/b)²·(z0/d)²",
        c1=seven.c1,
    )
    yield equality("14", "c2 = (α/b)² − (γ/d)² + 1 − (x0/b)² − (y0/b)² − (z0/d)²", c2=seven.c2)


@cache
def rotor_meanings() -> dict[str, sympy.Expr]:
    """Return the meanings of the letters of section 3.2, by name.

    B2 is the mean of (x_i² + y_i²)/b_s² over the rotors, and C(g_i) is the difference of a rotor's value from it.
    """
    x, y, z = pencil.rotor_centre()
    cubic, reach = pencil.rotor_cubic(), (x**2 + y**2) / pencil.ROTOR_B**2
    size_part = sympy.diff(pencil.cubic().c1, pencil.A).subs(pencil.IN_SEVEN)
    size_part = size_part.subs({pencil.SMALL_B: pencil.ROTOR_B, pencil.SMALL_D: pencil.ROTOR_D})
    return {
        "T1": pencil.COSINE - pencil.SINE,
        "T2": pencil.COSINE + pencil.SINE,
        "x_i": x,
        "y_i": y,
        "z_i": z,
        "c0_s": cubic.c0,
        "c1": cubic.c1,
        "c2": cubic.c2,
        "C": reach - mean_over_rotors(reach),
        "B1": size_part,
        "B2": mean_over_rotors(reach),
        "A1": mean_over_rotors(cubic.c1),
        "A2": mean_over_rotors(cubic.c2),
    }


def _rotors() -> Iterator[PrintedClaim]:
    """Yield the claims of section 3.2 about the rotors."""
    means = rotor_meanings()
    for statement in (
        "x_i = x0 + l·√2/2·(cosine − sine)",
        "x_i = x0 + l·√2/2·T1(g_i)",
        "y_i = y0 + l·√2/2·(cosine + sine)",
        "y_i = y0 + l·√2/2·T2(g_i)",
        "z_i = z0",
    ):
        yield equality("15", statement, **means)
    rotor = {pencil.SMALL_B: pencil.ROTOR_B, pencil.SMALL_D: pencil.ROTOR_D}
    at_rotor = {pencil.X0: symbol("x_i"), pencil.Y0: symbol("y_i"), pencil.Z0: symbol("z_i")}
    hyperboloid, sphere = pencil.scaled(pencil.hyperboloid()), pencil.scaled(pencil.spheroid())
    yield surface("16", "x²/(α/b_s)² + y²/(α/b_s)² − z²/(γ/d_s)² = 1", hyperboloid.subs(rotor))
    yield surface("17", "(x − x_i/b_s)² + (y − y_i/b_s)² + (z − z_i/d_s)² = 1", sphere.subs({**rotor, **at_rotor}))
    yield equality("18", "T1(g_i)² + T2(g_i)² = 2", **means)
    yield equality("18", "x_i² + y_i² = (x0 + l·√2/2·T1(g_i))² + (y0 + l·√2/2·T2(g_i))²", **means)
    yield equality("18", "x_i² + y_i² = x0² + y0² + l² + l·√2·(T1(g_i)·x0 + T2(g_i)·y0)", **means)
    yield equality("19", "c0_s = −(α/b_s)²·(γ/d_s)²", **means)
    yield from _definitions("20", ("C", "B1", "B2"), means)
    yield from _coefficients("21", means)


def _definitions(number: str, names: tuple[str, ...], means: dict[str, sympy.Expr]) -> Iterator[PrintedClaim]:
    """Yield the claims that the definitions of C, B1 and B2 agree with the derivation, as printed under a number."""
    printed = {
        "C": "C(g_i) = l·√2·(T1(g_i)·x0 + T2(g_i)·y0)/b_s²",
        "B1": "B1 = 1 − (γ/d_s)² − (z0/d_s)²",
        "B2": "B2 = (x0² + y0² + l²)/b_s²",
    }
    for name in names:
        yield equality(number, printed[name], **means)


def _coefficients(number: str, means: dict[str, sympy.Expr]) -> Iterator[PrintedClaim]:
    """Yield the claims about c1(g_i) and c2(g_i), as printed under a number."""
    yield equality(number, "c1(g_i) = (α/b_s)²·B1 + (γ/d_s)²·(B2 − 1 + C(g_i))", **means)
    yield equality(number, "c2(g_i) = (α/b_s)² + B1 − B2 − C(g_i)", **means)


def _appendix() -> Iterator[PrintedClaim]:
    """Yield the claims of Appendix A: its displays A.1 to A.6, of which A.2 has two equalities, and (22) and (23)."""
    means = rotor_meanings()
    yield equality("A.1", "c1(g_i) = (α/b_s)²·(1 − (γ/d_s)² − (z_i/d_s)²) + (γ/d_s)²·((x_i² + y_i²)/b_s² − 1)", **means)
    size_part, arm = "(α/b_s)²·(1 − (γ/d_s)² − (z0/d_s)²)", "l·√2·(T1(g_i)·x0 + T2(g_i)·y0)"
    yield equality("A.2a", f"c1(g_i) = {size_part} + (γ/d_s)²·((x0² + y0² + l² + {arm})/b_s² − 1)", **means)
    yield equality(
        "A.2b", f"c1(g_i) = {size_part} + (γ/d_s)²·((x0² + y0² + l² + l)/b_s² − 1) + (γ/d_s)²·({arm}/b_s²)", **means
    )
    yield from _definitions("A.3", ("C",), means)
    yield equality("A.3", f"A1 = {size_part} + (γ/d_s)²·((x0² + y0² + l²)/b_s² − 1)", **means)
    yield equality("A.4", "c1(g_i) = A1 + (γ/d_s)²·C(g_i)", **means)
    yield equality("A.5", "c2(g_i) = A2 − C(g_i)", **means)
    yield equality("A.6", "A2 = (α/b_s)² + 1 − (γ/d_s)² − (z0/d_s)² − (x0² + y0² + l²)/b_s²", **means)
    yield from _definitions("22", ("B1", "B2"), means)
    yield from _coefficients("23", means)


def _printed_row(text: str) -> sympy.Matrix:
    """Return the row vector of a printed text in brackets, whose entries commas separate."""
    return sympy.Matrix([[read(entry) for entry in text.strip("()").split(",")]])


@dataclass(frozen=True)
class EquationCheck:
    """A numbered formula of the paper, compared with the derivation.

    `number` is the paper's, or "A.n" for the n-th unnumbered display of Appendix A (a, b: its first and second
    equality). `verdict` is "holds", "misprint" (one term or factor changed in one place makes it right) or "false".
    `statement` is the text as printed; `finding` is a sentence computed from the difference; `correction` is the
    formula put right, in sympy's order of terms, and empty where nothing is wrong.
    """

    number: str
    holds: bool
    verdict: str
    statement: str
    finding: str
    correction: str


@cache
def check_equations() -> tuple[EquationCheck, ...]:
    """Check every displayed formula, in the paper's order."""
    return tuple(check(tuple(claims)) for _, claims in groupby(printed_claims(), key=lambda claim: claim.number))


def check(claims: tuple[PrintedClaim, ...]) -> EquationCheck:
    """Check all claims that are printed under one equation number."""
    repairs = []
    for claim in claims:
        left = claim.statement.partition("=")[0].strip()
        for printed, derived in claim.pairs:
            if pencil.difference(printed.subs(claim.meanings), derived) != 0:
                repaired = pencil.repair(printed, derived, claim.meanings)
                repairs.append((left, repaired))
    statement = "; ".join(claim.statement for claim in claims)
    if not repairs:
        return EquationCheck(claims[0].number, True, "holds", statement, "right − left = 0", "")
    return EquationCheck(
        number=claims[0].number,
        holds=False,
        verdict="misprint" if all(repaired.one_place for _, repaired in repairs) else "false",
        statement=statement,
        finding="; ".join(repaired.finding for _, repaired in repairs),
        correction="; ".join(f"{left} = {pencil.plain(repaired.corrected)}" for left, repaired in repairs),
    )
