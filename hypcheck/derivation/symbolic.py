"""Programs over sympy expressions. Sums and products are left as they are built; who compares expands them."""

from __future__ import annotations

import operator
from typing import Any

import sympy

from hypcheck.derivation.evaluation import Arithmetic


def _select(condition: Any, yes: Any, no: Any) -> Any:
    return sympy.Piecewise((yes, condition), (no, True))


SYMBOLIC = Arithmetic(
    name="symbolic",
    convert=sympy.sympify,
    operations={
        "add": operator.add,
        "sub": operator.sub,
        "mul": operator.mul,
        "div": operator.truediv,
        "neg": operator.neg,
        "abs": sympy.Abs,
        "sqrt": sympy.sqrt,
        "cos": sympy.cos,
        "arccos": sympy.acos,
        "gt": sympy.StrictGreaterThan,
        "lt": sympy.StrictLessThan,
        "ge": sympy.GreaterThan,
        "le": sympy.LessThan,
        "eq": sympy.Equality,
        "ne": sympy.Unequality,
        "and": sympy.And,
        "or": sympy.Or,
        "not": sympy.Not,
        "select": _select,
    },
)
"""Inputs may be expressions, integers or rationals; comparisons become relations, and a selection is a Piecewise."""
