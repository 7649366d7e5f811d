"""Proofs as chains of small links: each has a reason, and parts that a machine checks.

What a link says in words follows from its parts and from the links before it. A slip of algebra would hide in the
parts, so those are checked anew whenever a chain is printed. A part is an identity, a sign that can be read off (every
term of the expanded expression has the same one), or a rule on finitely many cases.

`identities` are the derivation's own: the decision rules rest on them, and `known` takes one into a link.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import sympy

from hypcheck.derivation import pencil
from hypcheck.derivation.pencil import (
    ALPHA,
    C0,
    C1,
    C2,
    COSINE,
    GAMMA,
    GENERIC_CUBIC,
    LAMBDA,
    SINE,
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
    difference,
    read,
    symbol,
)
from hypcheck.derivation.printed_equations import printed_claims

RELATIONS = (">", "≥", "<", "≤")


def has_sign(
    expression: sympy.Expr, relation: str, positive: Collection[sympy.Symbol], nonnegative: Collection[sympy.Symbol]
) -> bool:
    """Decide whether the form of a rational expression shows that it stands in the `relation` to 0.

    `positive` are letters that are > 0, `nonnegative` those that are ≥ 0. Of a letter in neither list nothing is known:
    the form shows a sign only if the letter is in even powers. False means that the form does not show the relation.
    Raises ValueError for a relation that is not in RELATIONS.
    """
    if relation not in RELATIONS:
        raise ValueError(f"{relation!r} is not one of {', '.join(RELATIONS)}")
    if relation in {"<", "≤"}:
        return has_sign(-expression, ">" if relation == "<" else "≥", positive, nonnegative)
    known, above = {*positive, *nonnegative}, set(positive)
    numerator, denominator = sympy.fraction(sympy.cancel(expression))
    for sign in (1, -1):
        # At a zero of the denominator nothing is shown.
        if _terms_agree(sign * denominator, known, above, strictly=True):
            return _terms_agree(sign * numerator, known, above, strictly=relation == ">")
    return False


def _terms_agree(
    expression: sympy.Expr, known: set[sympy.Symbol], positive: set[sympy.Symbol], *, strictly: bool
) -> bool:
    """Decide whether no expanded term can be negative, and with `strictly` whether one has only letters > 0 in it."""
    terms = [term for term in sympy.Add.make_args(sympy.expand(expression)) if term != 0]
    parted = [term.as_independent(*term.free_symbols, as_Add=False) for term in terms]
    if any(not number.is_positive or not _is_nonnegative(letters, known) for number, letters in parted):
        return False
    return not strictly or any(letters.free_symbols <= positive for _, letters in parted)


def _is_nonnegative(letters: sympy.Expr, known: set[sympy.Symbol]) -> bool:
    """Decide whether `letters` is a product of powers that cannot be negative.

    The exponents must be whole and ≥ 0, and even if the sign of the letter is not known.
    """
    powers = (factor.as_base_exp() for factor in sympy.Mul.make_args(letters) if factor != 1)
    return all(
        base.is_Symbol and exponent.is_Integer and exponent >= 0 and (base in known or exponent % 2 == 0)
        for base, exponent in powers
    )


PHI = P * LAMBDA / (A + LAMBDA) - Q * LAMBDA / (B - LAMBDA) - 1 - LAMBDA


@cache
def hessian_coefficients() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """Return h1, h2 and h3, the coefficients of the Hessian of the cubic, in c2, c1 and c0.

    Minus a quarter of the Hessian determinant of the cubic made homogeneous is h1 λ² + h2 λμ + h3 μ².
    """
    mu = sympy.Dummy("mu")
    form = sympy.expand(mu**3 * GENERIC_CUBIC.subs(LAMBDA, LAMBDA / mu))
    covariant = -sympy.hessian(form, (LAMBDA, mu)).det() / 4
    h1, h2, h3 = sympy.Poly(covariant.subs(mu, 1), LAMBDA).all_coeffs()
    return h1, h2, h3


def local_maximum() -> sympy.Expr:
    """Return λm = (−c2 − √h1)/3, the place of the local maximum of g, in c1 and c2."""
    return (-C2 - sympy.sqrt(hessian_coefficients()[0])) / 3


@cache
def identities() -> dict[str, sympy.Expr]:
    """Return the left side minus the right side of each identity, by the sentence that states it."""
    return dict((*_surface_identities(), *_cubic_identities(), *_generic_identities()))


def vanishes(expression: sympy.Expr) -> bool:
    """Decide whether the expression is 0 for all values of its letters (with cosine² + sine² = 1)."""
    return bool(difference(expression, sympy.Integer(0)) == 0)


def _surface_identities() -> tuple[tuple[str, sympy.Expr], ...]:
    """Return the sentence and the difference of each identity about points and lines of the two surfaces."""
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
    """Return the sentence and the difference of each identity about the cubic g of a pair."""
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
    """Return the sentence and the difference of each identity about any cubic."""
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


REASONS = ("identity", "sign", "case split", "cited theorem")
"""The reasons of links. A link with parts of several reasons states the last of these, unless it names another."""


@dataclass(frozen=True)
class Identity:
    """The claim that two expressions, or matrices, are equal. `text` shows it as "left = right"."""

    text: str
    left: sympy.Expr | sympy.Matrix
    right: sympy.Expr | sympy.Matrix

    @cached_property
    def holds(self) -> bool:
        """Whether the difference vanishes for all values of the letters."""
        left, right = sympy.Matrix([self.left]), sympy.Matrix([self.right])
        return left.shape == right.shape and all(difference(*entries) == 0 for entries in zip(left, right, strict=True))


@dataclass(frozen=True)
class Sign:
    """The claim that the form of an expression shows that it stands in the `relation` to 0.

    `positive` names the letters that are > 0, `nonnegative` those that are ≥ 0; the others have any sign.
    """

    text: str
    expression: sympy.Expr
    relation: str
    positive: tuple[str, ...]
    nonnegative: tuple[str, ...]

    @cached_property
    def holds(self) -> bool:
        """Whether every term of the expanded expression has the sign that is claimed."""
        positive, nonnegative = (tuple(map(symbol, names)) for names in (self.positive, self.nonnegative))
        return has_sign(self.expression, self.relation, positive, nonnegative)


@dataclass(frozen=True)
class FiniteCases:
    """A rule checked on finitely many `cases` that represent all cases."""

    text: str
    cases: tuple[tuple[Any, ...], ...]
    rule: Callable[..., bool]

    @cached_property
    def holds(self) -> bool:
        """Whether there is at least one case and the rule is true of each."""
        return bool(self.cases) and all(self.rule(*case) for case in self.cases)


Part = Identity | Sign | FiniteCases


@dataclass(frozen=True)
class Link:
    """One step of a proof.

    `statement` is its sentence, `reason` one of REASONS, `parts` is what a machine checks of it, `cites` the theorem
    that it cites, "" if none.
    """

    statement: str
    reason: str
    parts: tuple[Part, ...]
    cites: str = ""

    @property
    def because(self) -> str:
        """The kind of the reason, with the theorem that it cites."""
        return f"{self.reason}: {self.cites}" if self.cites else self.reason

    @property
    def holds(self) -> bool:
        """Whether there is at least one part to check, and all parts hold."""
        return bool(self.parts) and all(part.holds for part in self.parts)


@dataclass(frozen=True)
class Chain:
    """A statement and the links that lead to it; `needs` names the chains whose results it uses."""

    name: str
    statement: str
    links: tuple[Link, ...]
    needs: tuple[str, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether every link holds; the chains that it needs are checked separately."""
        return bool(self.links) and all(link.holds for link in self.links)


def link(statement: str, *parts: Part, reason: str = "", cites: str = "") -> Link:
    """Make a link of these parts. Without `reason` its reason is the last of REASONS that its parts have."""
    reasons = [_REASON_OF[type(part)] for part in parts] + ["cited theorem"] * bool(cites)
    return Link(statement, reason or max(reasons, key=REASONS.index), parts, cites)


_REASON_OF = {Identity: "identity", Sign: "sign", FiniteCases: "case split"}


def chain(name: str, statement: str, *links: Link, needs: tuple[str, ...] = ()) -> Chain:
    """Make a chain of these links."""
    return Chain(name, statement, links, needs)


def identity(text: str, left: sympy.Expr, **meanings: sympy.Expr) -> Identity:
    """Make the claim that `left` equals the expression in the text after its last "=".

    `meanings` has the expressions that letters of the text represent.
    """
    right = read(text.rpartition(" = ")[2])
    return Identity(text, left, right.subs({symbol(name): value for name, value in meanings.items()}))


def known(text: str) -> Identity:
    """Return one of the derivation's own identities, by its sentence. Raises KeyError where there is none."""
    return Identity(text, identities()[text], sympy.Integer(0))


def matrix_identity(text: str, left: sympy.Matrix) -> Identity:
    """Make the claim that the matrix equals the matrix in the text after "=".

    In the text semicolons separate rows, and commas separate entries.
    """
    rows = text.partition(" = ")[2].strip("[]").split("; ")
    return Identity(text, left, sympy.Matrix([[read(entry) for entry in row.split(", ")] for row in rows]))


def printed(*numbers: str) -> tuple[Identity, ...]:
    """Return the formulas that the paper prints under these numbers as claims that they equal the derived ones.

    The formulas are those of printed_equations.py.
    """
    return tuple(
        Identity(
            claim.statement,
            sympy.Matrix([printed.subs(claim.meanings) for printed, _ in claim.pairs]),
            sympy.Matrix([derived for _, derived in claim.pairs]),
        )
        for claim in printed_claims()
        if claim.number in numbers
    )


def sign(text: str, positive: str = "", nonnegative: str = "") -> Sign:
    """Make the claim of the inequality in the text, which the signs of its terms prove.

    `positive` and `nonnegative` name the letters with these signs, separated by spaces.
    Raises ValueError where the text has none of RELATIONS.
    """
    for relation in RELATIONS:
        left, shown, right = text.partition(f" {relation} ")
        if shown:
            expression = read(left) - read(right)
            return Sign(text, expression, relation, tuple(positive.split()), tuple(nonnegative.split()))
    raise ValueError(f"{text!r} states no sign")
