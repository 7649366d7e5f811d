"""The printed remedies of causes, read as code: formulas in the paper's signs become Python, and change a formula.

A formula is a mapping of names to Python expressions, evaluated in exact rationals. A remedy replaces some of them:
"A = (α/b)²" replaces one; "exterior is …" the condition; "exterior must also require: …" adds to it; "exterior also
where …" adds an alternative to it, whatever else is required; "read the columns as …" replaces their order.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.runs.causes import Cause

Formula = Mapping[str, str]

ROW = "alpha, gamma, b, d, x, y, z"

TABLE_2: Formula = {
    "columns": ROW,
    "A": "(alpha/b)**2",
    "B": "(gamma/d)**2",
    "P": "(x**2 + y**2)/b**2",
    "Q": "(z/d)**2",
    "c0": "-A*B",
    "c1": "-A*B + A - B + B*P - A*Q",
    "c2": "A - B + 1 - P - Q",
    "delta": "-4*c2**3*c0 + c2**2*c1**2 + 18*c2*c1*c0 - 4*c1**3 - 27*c0**2",
    "positive": "c2 < 0 and c1 > 0",
    "exterior": "delta > 0 and positive",
    "interior": "delta > 0 and not positive",
    "answers": "1, -1",
}
"""Table 2 with the signs of Propositions 3 and 5 for every row, which is right in neither direction."""

EVERYWHERE: Formula = {
    **TABLE_2,
    "E": "P - A - 1",
    "exterior": "delta > 0 and positive and not (c2 < -3*B and (3*B + 2*c2)*B + c1 > 0)",
    "exterior_also": "Q == 0 and A < B**2 and E > 0 and E**2 > 4*A",
    "interior": "delta > 0 and not positive and c2 < 3*A and (3*A - 2*c2)*A + c1 > 0",
}
"""The coefficient form for all regimes, which is right everywhere (docs/mathematics.md)."""

_CONDITIONS = ("exterior", "interior")


Rows = tuple[tuple[float, ...], ...]


def positions(formula: Formula, rows: Rows) -> list[int]:
    """The answers of a formula to rows, in exact rationals: its expressions are evaluated as they are written."""
    evaluation = _Evaluation(formula, rows)
    answers = np.zeros(len(rows), dtype=int)
    undecided = np.ones(len(rows), dtype=bool)
    for name, answer in zip(_CONDITIONS, map(int, formula["answers"].split(",")), strict=True):
        holds = np.zeros(len(rows), dtype=bool)
        for part in (name, f"{name}_also"):
            if part in formula:
                holds |= evaluation.holds(formula[part])
        answers[undecided & holds] = answer
        undecided &= ~holds
    return answers.tolist()


class _Evaluation:
    """Evaluates a formula for all rows at once; values that formulas have in common are computed once."""

    def __init__(self, formula: Formula, rows: Rows) -> None:
        self._formula = formula
        self._rows = rows
        self._known = _known(rows)
        self._full = {name: f"row[{place}]" for place, name in enumerate(formula["columns"].split(", "))}
        self._full |= {name: name for name in _FUNCTIONS}

    def holds(self, text: str) -> NDArray[np.bool_]:
        """Of which rows a condition holds."""
        return self._holds(text, _tree(text))

    def _holds(self, text: str, tree: ast.expr) -> NDArray[np.bool_]:
        match tree:
            case ast.BoolOp(op=ast.And()):
                return np.logical_and.reduce([self._holds(text, part) for part in tree.values])
            case ast.BoolOp(op=ast.Or()):
                return np.logical_or.reduce([self._holds(text, part) for part in tree.values])
            case ast.UnaryOp(op=ast.Not()):
                return ~self._holds(text, tree.operand)
            case ast.Constant():
                return np.full(len(self._rows), tree.value, dtype=bool)
            case ast.Name():
                return self.holds(self._formula[tree.id])
        return np.array(self._values(text[tree.col_offset : tree.end_col_offset]))

    def _values(self, text: str) -> list[Any]:
        key = self._in_full(text)
        if key not in self._known:
            if len(self._known) > _MOST:
                self._known.clear()
            names = [name for name in _names(text) if name not in _FUNCTIONS]
            columns = [self._column(name) for name in names]
            compute = eval(f"lambda {', '.join(names)}: {text}", dict(_FUNCTIONS))  # noqa: S307 - printed text and this file's
            self._known[key] = [compute(*values) for values in zip(*columns, strict=True)]
        return self._known[key]

    def _column(self, name: str) -> list[Any]:
        key = self._meaning(name)
        if name in self._formula:
            return self._values(self._formula[name])
        if key not in self._known:
            place = self._formula["columns"].split(", ").index(name)
            self._known[key] = [Fraction(row[place]) for row in self._rows]
        return self._known[key]

    def _meaning(self, name: str) -> str:
        if name not in self._full:
            self._full[name] = f"({self._in_full(self._formula[name])})"
        return self._full[name]

    def _in_full(self, text: str) -> str:
        """The expression with places in the row for all names, which means the same in every formula."""
        return _NAME.sub(lambda match: self._meaning(match[0]), text.replace(" ", ""))


_MOST = 300
"""Values of so many expressions are kept."""

_FUNCTIONS = {"abs": abs, "max": max, "min": min}
_NAME = re.compile(r"[A-Za-z_]\w*")


@cache
def _tree(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


@cache
def _names(text: str) -> list[str]:
    return sorted(set(_NAME.findall(text)))


@lru_cache(maxsize=2)
def _known(rows: Rows) -> dict[str, list[Any]]:
    """Values of these rows, by the expression in full."""
    return {}


_SIGNS = {"−": "-", "Δ": "delta", "α": "alpha", "γ": "gamma", "²": "**2", "³": "**3"}
_TOKEN = re.compile(r"\s*(\*\*\d|[A-Za-z_]+\d?|\d+|[<>=]=?|[-+/()*,])")
_WORDS = {"and", "or", "not", "either"}


def expression(text: str) -> str:
    """A formula in the paper's signs as Python: 4A is 4*A, EB is E*B, 2 c2 is 2*c2, = is ==, a comma is "and"."""
    for sign, plain in _SIGNS.items():
        text = text.replace(sign, plain)
    assert _TOKEN.sub("", text).strip() == "", text
    tokens: list[str] = []
    for token in _TOKEN.findall(text):
        tokens += list(token) if re.fullmatch(r"[A-Z]{2,}", token) else [token]
    found: list[str] = []
    for before, token in zip(["", *tokens], tokens, strict=False):
        if _ends_value(before) and (re.match(r"[A-Za-z_\d(]", token) and token not in _WORDS):
            found.append("*")
        found.append({"=": "==", ",": "and", "either": "("}.get(token, token))
    return " ".join(found) + " )" * tokens.count("either")


def _ends_value(token: str) -> bool:
    return token not in _WORDS and bool(re.fullmatch(r"\*\*\d|[A-Za-z_]+\d?|\d+|\)", token))


def applied(formula: Formula, remedy: str) -> Formula:
    """The formula after what a remedy says was done to it. A remedy that says nothing about a formula is an error."""
    changed = dict(formula)
    text, _, defined = remedy.partition(", with ")
    if defined:
        name, _, value = defined.partition(" = ")
        changed[name] = expression(value)
    found = False
    if match := re.search(r"read the columns as (.+)$", text):
        changed["columns"], found = match[1], True
    elif match := re.search(r"(exterior|interior) also(?:, [^,]*,)? where (.+)$", text):
        _also(changed, match[1], expression(match[2]))
        found = True
    elif match := re.search(r"((?:exterior|interior)(?: and interior)?) must also require: (.+)$", text):
        for name in match[1].split(" and "):
            changed[name] = f"({changed[name]}) and ({expression(match[2])})"
        found = True
    elif match := re.fullmatch(r"exterior is \+1, interior −1", text):
        changed["answers"], found = "1, -1", True
    elif match := re.search(r"three roots are positive exactly where (.+)$", text):
        changed["positive"], found = expression(match[1]), True
    elif match := re.fullmatch(r"(exterior|interior) is (.+)", text):
        changed[match[1]], found = expression(match[2]), True
    else:
        for name, value in re.findall(r"(?:^|[:,] )([ABPQ]|c[012]|Δ) = ([^,]+)", text):
            changed[_SIGNS.get(name, name)], found = expression(value), True
    assert found, f"nothing to apply in {remedy!r}"
    return changed


def _also(formula: dict[str, str], name: str, condition: str) -> None:
    before = formula.get(f"{name}_also")
    formula[f"{name}_also"] = f"({before}) or ({condition})" if before else condition


def mended(formula: Formula, causes: Iterable[Cause]) -> Formula:
    """The formula after the remedies of all these causes were applied, in this order."""
    for cause in causes:
        formula = applied(formula, cause.remedy)
    return formula
