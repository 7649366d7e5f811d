"""Formulas in plain text, both ways: "(α/b)²·B1 − λ" to sympy and back.

A product is written with a dot, never by juxtaposition; raised digits are powers; √2 is a root; diag(…) is a diagonal
matrix. Greek letters stand for the symbols of their names. Arguments that say no more than what a letter depends on, as
in f(λ) and c1(g_i), are read over.
"""

from __future__ import annotations

import re

import sympy
from sympy.parsing.sympy_parser import parse_expr

_GREEK = {"α": "alpha", "γ": "gamma", "λ": "lambda", "φ": "phi", "Δ": "delta"}
_SPELLED = {name: letter for letter, name in _GREEK.items()}
_RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_TO_DIGITS = str.maketrans(_RAISED, "0123456789")
_TO_RAISED = str.maketrans("0123456789", _RAISED)
_NAME = re.compile(r"[^\W\d]\w*")
_LENGTHS = frozenset({"alpha", "gamma", "b", "d", "b_s", "d_s", "a", "c", "l"})


def symbol(name: str) -> sympy.Symbol:
    """The one symbol of that name: positive where it is a semi-axis or an arm, real where it is not."""
    return sympy.Symbol(name, positive=True) if name in _LENGTHS else sympy.Symbol(name, real=True)


def read(text: str) -> sympy.Expr:
    """The formula that the text says; a matrix where it says diag(…)."""
    code = text.replace("(λ)", "").replace("(g_i)", "").replace("−", "-").replace("·", "*")
    code = re.sub(f"[{_RAISED}]+", lambda digits: f"**{digits[0].translate(_TO_DIGITS)}", code)
    code = re.sub(r"√(\d+)", r"sqrt(\1)", code)
    letters = {_in_code(name): symbol(_GREEK.get(name, name)) for name in _NAME.findall(code)}
    code = _NAME.sub(lambda name: _in_code(name[0]), code)
    return parse_expr(code, local_dict={**letters, "sqrt": sympy.sqrt, "diag": sympy.diag})


def plain(expression: sympy.Expr) -> str:
    """The formula as text, in sympy's order of terms."""
    text = sympy.sstr(expression).replace("sqrt(2)", "√2")
    text = _NAME.sub(lambda name: _SPELLED.get(name[0], name[0]), text)
    text = re.sub(r"\*\*(\d+)", lambda power: power[1].translate(_TO_RAISED), text)
    return text.replace("*", "·").replace("-", "−")


def _in_code(name: str) -> str:
    return f"{_GREEK[name]}_" if name in _GREEK else name  # lambda is a word of Python's, lambda_ is not
