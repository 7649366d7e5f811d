"""Proofs as chains of small links, each with a reason and with parts that a machine checks.

What a link says in words follows from its parts and from the links before it; the parts are where a slip of algebra
would hide, and those are checked anew whenever a chain is printed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import sympy

from hypcheck.derivation.differences import difference
from hypcheck.derivation.identities import identities
from hypcheck.derivation.plain_text import read, symbol
from hypcheck.derivation.printed_equations import printed_claims
from hypcheck.derivation.signs import RELATIONS, has_sign

REASONS = ("identity", "sign", "case split", "cited theorem")
"""Of several reasons a link gives the one that carries it."""


@dataclass(frozen=True)
class Identity:
    """Two expressions, or matrices, that are one. `text` shows it as "left = right"."""

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
    """An expression whose sign its form shows, for letters > 0 (`positive`), ≥ 0 (`nonnegative`) and of any sign."""

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
class Cases:
    """A rule of a few values, asked for each of finitely many `cases` that stand for all."""

    text: str
    cases: tuple[tuple[Any, ...], ...]
    rule: Callable[..., bool]

    @cached_property
    def holds(self) -> bool:
        """Whether there are cases and the rule is true of each."""
        return bool(self.cases) and all(self.rule(*case) for case in self.cases)


Part = Identity | Sign | Cases


@dataclass(frozen=True)
class Link:
    """One step of a proof: a sentence, the kind of its reason, what a machine checks of it, a theorem that it cites."""

    statement: str
    reason: str
    parts: tuple[Part, ...]
    cites: str = ""

    @property
    def holds(self) -> bool:
        """Whether there is something to check and all of it holds."""
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
        """Whether every link holds. The chains that it needs are asked on their own."""
        return bool(self.links) and all(link.holds for link in self.links)


def identity(text: str, left: sympy.Expr, **meanings: sympy.Expr) -> Identity:
    """That `left` equals what the text says right of its last "="; `meanings` are what letters there stand for."""
    right = read(text.rpartition(" = ")[2])
    return Identity(text, left, right.subs({symbol(name): value for name, value in meanings.items()}))


def known(text: str) -> Identity:
    """One of the derivation's own identities (identities.py), by its sentence. Raises KeyError where it has none."""
    return Identity(text, _identities()[text], sympy.Integer(0))


@cache
def _identities() -> dict[str, sympy.Expr]:
    return dict(identities())


def matrix_identity(text: str, left: sympy.Matrix) -> Identity:
    """That the matrix is what the text says right of "=": rows parted by semicolons, entries by commas."""
    rows = text.partition(" = ")[2].strip("[]").split("; ")
    return Identity(text, left, sympy.Matrix([[read(entry) for entry in row.split(", ")] for row in rows]))


def printed(number: str) -> tuple[Identity, ...]:
    """What the paper prints under that number (printed_equations.py), held against the derivation."""
    return tuple(
        Identity(
            claim.statement,
            sympy.Matrix([printed.subs(claim.meanings) for printed, _ in claim.pairs]),
            sympy.Matrix([derived for _, derived in claim.pairs]),
        )
        for claim in printed_claims()
        if claim.number == number
    )


def sign(text: str, positive: str = "", nonnegative: str = "") -> Sign:
    """That what the text says is true by its form; `positive` and `nonnegative` name letters, parted by spaces.

    Raises ValueError where the text has none of RELATIONS.
    """
    for relation in RELATIONS:
        left, found, right = text.partition(f" {relation} ")
        if found:
            expression = read(left) - read(right)
            return Sign(text, expression, relation, tuple(positive.split()), tuple(nonnegative.split()))
    raise ValueError(f"{text!r} states no sign")
