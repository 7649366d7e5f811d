"""Which formula is shown beside an implementation: its own, one that was asked for, or one that answers alike."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from hypcheck.derivation.formulas import FORMULAS, Formula
from hypcheck.errors import InputError
from hypcheck.methods.description import Description
from hypcheck.methods.spec import Spec
from hypcheck.pairs import Position
from hypcheck.replay.intermediates import Comparison, compare

SHOWN = tuple(name for name, formula in FORMULAS.items() if formula.classifies_pairs or name == "dual")
"""The formulas that can be shown: those that take a pair and nothing else, and the dual form at the λ it finds."""

PREFERRED = "table-2"

_MANTISSA = {"x87": 63, "binary128": 112}


@dataclass(frozen=True, slots=True)
class Choice:
    """A formula's values on the row, and why it is this one; `comparison` is None where it has none.

    `own` says that the implementation evaluates this formula. What another one gets wrong says nothing about it.
    """

    comparison: Comparison | None
    why: str
    own: bool = False


def require_formula(name: str | None) -> None:
    """Raise InputError where a formula of that name cannot be shown."""
    if name is not None and name not in SHOWN:
        raise InputError(f"there is no formula {name!r} that takes a pair; there are {', '.join(SHOWN)}")


@dataclass(frozen=True, slots=True)
class Subject:
    """Whose answer it is: the SPEC, its description as declared and as used, its answer (None: it gave none)."""

    spec: Spec
    declared: Description
    used: Description
    answer: int | None


def choose(subject: Subject, row: tuple[float, ...], truth: Position, name: str | None) -> Choice:
    """The formula to be shown on a valid row: the named one, or else the nearest to the implementation.

    A built-in formula is shown in its own precision; for all others the precision is that of the description in use.
    """
    own = _of_builtin(subject)
    format_name, instead = format_of(subject.declared.precision if own else subject.used.precision)
    formula = FORMULAS[name] if name is not None else own
    if formula is None:
        return _nearest(subject, row, truth, format_name, instead)
    comparison = compare(formula, format_name, row)
    if comparison is None:
        return Choice(None, f"the search of {formula.name} finds no finite λ in {format_name}", formula is own)
    why = "as --formula asks" if name is not None else f"which is what {subject.spec} evaluates"
    return Choice(comparison, why + instead, formula is own)


def format_of(precision: str) -> tuple[str, str]:
    """The format of numpy that stands for a declared precision, and what must be said of it where it is another."""
    if precision in ("float16", "float32", "float64"):
        return precision, ""
    if np.finfo(np.longdouble).nmant == _MANTISSA.get(precision):
        return "longdouble", ""
    instead = {"bfloat16": "float32", "exact": "float64"}.get(precision, "longdouble")
    return instead, f"; numpy has no {precision}, so {instead} stands for it"


def _of_builtin(subject: Subject) -> Formula | None:
    if subject.spec.kind != "builtin":
        return None
    return FORMULAS.get(subject.spec.words[0].removesuffix(f"-{subject.declared.precision}"))


def _nearest(subject: Subject, row: tuple[float, ...], truth: Position, format_name: str, instead: str) -> Choice:
    """Of the formulas with a comparable question, one that is right or wrong as the implementation is, table-2 first.

    A wrong answer is told by a formula that errs likewise; a "no" that leaves the truth open would tell nothing.
    """
    question, answer = subject.used.question, subject.answer
    found = [compared for formula in _comparable(question) if (compared := compare(formula, format_name, row))]
    if answer is None:
        return Choice(found[0], f"there being no answer to compare formulas with{instead}")
    meant = _positions(answer, question)
    errs = truth not in meant
    for compared in found:
        left = _positions(compared.answer, compared.formula.question)
        if meant & left and (truth not in left) is errs:
            return Choice(compared, f"which in {format_name} answers as {subject.used.name} does{instead}")
    return Choice(found[0], f"though no formula in {format_name} answers as {subject.used.name} does{instead}")


def _comparable(question: str) -> Iterator[Formula]:
    """Formulas whose answers say something of answers to the question; the preferred one first."""
    names = sorted(SHOWN, key=lambda name: name != PREFERRED)
    for formula in (FORMULAS[name] for name in names if FORMULAS[name].classifies_pairs):
        if formula.question == question or "position" in (formula.question, question):
            yield formula


def _positions(answer: int, question: str) -> set[Position]:
    """The positions of which the answer to the question is right."""
    if question == "position":
        return {Position(answer)}
    asked = Position[question.upper()]
    return {asked} if answer else set(Position) - {asked}
