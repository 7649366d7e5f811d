"""Signs that can be read off: every term of the expanded expression has the same one."""

from __future__ import annotations

from collections.abc import Collection

import sympy

RELATIONS = (">", "≥", "<", "≤")


def has_sign(
    expression: sympy.Expr, relation: str, positive: Collection[sympy.Symbol], nonnegative: Collection[sympy.Symbol]
) -> bool:
    """Whether the form of a rational expression shows that it is `relation` 0, its letters being > 0 or ≥ 0 as said.

    Of a letter that is in neither list nothing is known: it may be in even powers only. False where the form does not
    tell. Raises ValueError for a relation that is none of RELATIONS.
    """
    if relation not in RELATIONS:
        raise ValueError(f"{relation!r} is none of {', '.join(RELATIONS)}")
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
    """Whether no expanded term can be negative; `strictly`: and one of them has nothing but letters > 0 in it."""
    terms = [term for term in sympy.Add.make_args(sympy.expand(expression)) if term != 0]
    parted = [term.as_independent(*term.free_symbols, as_Add=False) for term in terms]
    if any(not number.is_positive or not _is_nonnegative(letters, known) for number, letters in parted):
        return False
    return not strictly or any(letters.free_symbols <= positive for _, letters in parted)


def _is_nonnegative(letters: sympy.Expr, known: set[sympy.Symbol]) -> bool:
    """Whether it is a product of powers with whole exponents ≥ 0, even ones where the letter's sign is not known."""
    powers = (factor.as_base_exp() for factor in sympy.Mul.make_args(letters) if factor != 1)
    return all(
        base.is_Symbol and exponent.is_Integer and exponent >= 0 and (base in known or exponent % 2 == 0)
        for base, exponent in powers
    )
