"""What is wrong with a printed formula, found from its difference to the derived one.

A misprint is one place where one term changed makes the formula right: a factor, a term too many or a term that lacks.
The place is searched for, not known beforehand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

import sympy

from hypcheck.derivation.pencil import LAMBDA
from hypcheck.derivation.plain_text import plain, symbol

COSINE, SINE = symbol("cosine"), symbol("sine")
Meanings = dict[sympy.Symbol, sympy.Expr]


@dataclass(frozen=True)
class Repair:
    """How a printed formula fails, in one sentence, and the formula put right.

    `one_place` is true where one factor or one term, changed in one place, is all it takes.
    """

    finding: str
    corrected: sympy.Expr
    one_place: bool


@cache
def difference(printed: sympy.Expr, derived: sympy.Expr) -> sympy.Expr:
    """printed − derived in lowest terms, given cosine² + sine² = 1.

    It is 0 only where the two are equal, and for rational functions of the letters it then always is.
    """
    numerator, denominator = sympy.fraction(sympy.together(printed - derived))
    numerator = sympy.expand(numerator)
    if numerator.has(SINE) and numerator.is_polynomial(SINE, COSINE):
        numerator = sympy.rem(numerator, SINE**2 + COSINE**2 - 1, SINE)
    return sympy.cancel(numerator / denominator)


def repair(printed: sympy.Expr, derived: sympy.Expr, meanings: Meanings) -> Repair:
    """The smallest change that makes `printed` equal to `derived`, once its letters stand for what `meanings` says.

    The two must not be equal.
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
    numerator, denominator = sympy.fraction(printed)
    roots = "" if factor.has(LAMBDA) else ", and the roots stay the same"
    finding = f"the right side is {plain(factor)} times the left"
    if denominator != 1:
        finding += f": the denominator {plain(denominator)} must be {plain(denominator * factor)}"
        return Repair(finding + roots, numerator / (denominator * factor), one_place=True)
    return Repair(finding + roots, printed / factor, one_place=True)


def _change(rebuilt: Callable[[sympy.Expr], sympy.Expr], gap: sympy.Expr, meanings: Meanings) -> sympy.Expr | None:
    """What closes the gap when added to the sum in this place; None where the formula is not linear in that sum."""
    unknown = sympy.Dummy()
    slope = sympy.diff(rebuilt(unknown), unknown).subs(meanings)
    if slope == 0 or slope.has(unknown):
        return None
    return sympy.cancel(-gap / slope)


def _sums(expression: sympy.Expr) -> Iterator[tuple[sympy.Expr, Callable[[sympy.Expr], sympy.Expr]]]:
    """The whole, and every sum within, each with a function that puts another expression in its place."""
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
    powers = sympy.Poly(sympy.fraction(gap)[0], LAMBDA).monoms() if gap.has(LAMBDA) else []
    if len(powers) == 1 and not node.has(LAMBDA):
        return f"the coefficient of {plain(LAMBDA ** powers[0][0])}"
    return f"the sum {plain(node)}"


def _is_single_term(expression: sympy.Expr) -> bool:
    return all(not part.is_Add for part in sympy.fraction(sympy.factor_terms(expression)))


def _signed(term: sympy.Expr) -> str:
    return f"− {plain(-term)}" if term.could_extract_minus_sign() else f"+ {plain(term)}"
