"""Signs that can be read off: every term of the expanded expression has the same one."""

from __future__ import annotations

from collections.abc import Collection

import sympy

RELATIONS = (">", "≥", "<", "≤")


def has_sign(
    expression: sympy.Expr, relation: str, positive: Collection[sympy.Symbol], nonnegative: Collection[sympy.Symbol]
) -> bool:
    """Whether the form of a rational expression shows that it is `relation` 0, its letters being > 0 or ≥ 0 as said.

    False where the form does not tell, or where the expression has a letter that is in neither list. Raises ValueError
    for a relation that is none of RELATIONS.
    """
    if relation not in RELATIONS:
        raise ValueError(f"{relation!r} is none of {', '.join(RELATIONS)}")
    if relation in {"<", "≤"}:
        return has_sign(-expression, ">" if relation == "<" else "≥", positive, nonnegative)
    if not expression.free_symbols <= {*positive, *nonnegative}:
        return False
    numerator, denominator = sympy.fraction(sympy.cancel(expression))
    for sign in (1, -1):
        # At a zero of the denominator nothing is shown.
        if _terms_agree(sign * denominator, positive, strictly=True):
            return _terms_agree(sign * numerator, positive, strictly=relation == ">")
    return False


def _terms_agree(expression: sympy.Expr, positive: Collection[sympy.Symbol], *, strictly: bool) -> bool:
    """Whether no expanded term has a negative factor; `strictly`: and one has nothing but letters > 0 in it."""
    terms = sympy.Add.make_args(sympy.expand(expression))
    coefficients = [term.as_independent(*term.free_symbols, as_Add=False) for term in terms if term != 0]
    if any(not number.is_positive or not _is_product(letters) for number, letters in coefficients):
        return False
    return not strictly or any(letters.free_symbols <= set(positive) for _, letters in coefficients)


def _is_product(letters: sympy.Expr) -> bool:
    """Whether it is a product of powers of letters with whole exponents ≥ 0."""
    return all(
        base.is_Symbol and exponent.is_Integer and exponent >= 0
        for base, exponent in (factor.as_base_exp() for factor in sympy.Mul.make_args(letters) if factor != 1)
    )
