"""What the formulas get wrong: in exact rationals, where only the mathematics is to blame, and in floats."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from hypcheck import judge
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.formulas import FORMULAS, Formula, answers
from hypcheck.judge import Criterion, Status, WrongCase
from hypcheck.methods.domain import EVERYWHERE, representable
from hypcheck.methods.method import Method
from hypcheck.pairs import COLUMNS, Pair
from hypcheck.rows import CANNOT_SAY, Rows
from hypcheck.truth.exact import cubic
from hypcheck.truth.kinds import Kind
from hypcheck.verify.plan import Batch, Plan

WORST_KEPT = 3
"""Worst cases a group keeps with their rows; its counts are always exact."""


@dataclass(frozen=True, slots=True)
class Mathematical:
    """A formula's wrong answers about one family in exact arithmetic, for one cause.

    `inside`: whether they lie inside the regimes in which the formula is stated. `asked` counts the cases on that side.
    """

    formula: str
    family: str
    inside: bool
    cause: str
    asked: int
    wrong: int
    first_case: str
    first_row: tuple[float, ...]


def mathematical(formula: Formula, batch: Batch, plan: Plan) -> list[Mathematical]:
    """The formula in exact rationals on the first rows of a family: what it gets wrong, by side and cause."""
    rows = batch.rows[: plan.exact_formulas]
    claimed = replace(EVERYWHERE, regimes=formula.regimes).holds(rows)
    right = judge.expected(batch.positions, formula.question)
    wrong: dict[tuple[bool, str], list[int]] = {}
    for place, row in enumerate(rows.tolist()):
        if int(answers(formula, EXACT, dict(zip(COLUMNS, row, strict=True)))) != right[place]:
            wrong.setdefault((bool(claimed[place]), cause(batch, place)), []).append(place)
    return [
        Mathematical(
            formula.name,
            batch.family.name,
            inside,
            why,
            int((claimed == inside).sum()),
            len(places),
            batch.case_id(places[0]),
            tuple(rows[places[0]].tolist()),
        )
        for (inside, why), places in sorted(wrong.items())
    ]


def cause(batch: Batch, place: int) -> str:
    """What is special about a case, among the things that printed statements are known to forget."""
    if batch.decisions[place].kind is Kind.EXTERIOR_RING:
        return "ring"
    g = cubic(Pair.from_row(batch.rows[place].tolist()).lengths)
    if g.n2 == 0 or g.n1 == 0:
        return "zero-coefficient"
    return "none known"


def exact_formulas() -> list[Formula]:
    """The formulas that answer from a pair alone, so that exact arithmetic can run them."""
    return [formula for formula in FORMULAS.values() if formula.classifies_pairs]


def group(method: Method, batch: Batch, octaves: np.ndarray[Any, np.dtype[np.float64]], plan: Plan) -> dict[str, Any]:
    """The record's line about one method and one family."""
    tolerance = Fraction(0) if method.exact else plan.tolerance
    criterion = Criterion(method.question, method.precision, tolerance)
    asked = method.domain.holds(batch.rows) & representable(batch.rows, method.precision)
    places = np.flatnonzero(asked)[: method.most]
    rows = batch.rows[places]
    given = method.answer(rows)
    wrong = judge.wrong_cases(rows, batch.positions[places], given, criterion)
    status = np.where(given == CANNOT_SAY, Status.ABSTAINED.value, Status.RIGHT.value).astype(object)
    for case in wrong:
        status[case.index] = case.status.value
    counts = Counter(status.tolist())
    counts[Status.SKIPPED.value] = int((~asked).sum())
    return {
        "method": method.name,
        "question": method.question,
        "precision": method.precision,
        "family": batch.family.name,
        "asked": len(rows),
        "counts": {name: number for name, number in sorted(counts.items()) if number},
        "mistakes": dict(sorted(Counter(case.mistake.value for case in wrong).items())),
        "octaves": _by_octave(octaves[places], status),
        "size_bins": _size_bins(rows, status),
        "place_bins": _place_bins(rows, status),
        "worst": [
            _worst(case, error, batch.case_id(int(places[case.index])), criterion)
            for case, error in _worst_first(wrong, criterion)
        ],
    }


def _worst_first(cases: Sequence[WrongCase], criterion: Criterion) -> list[tuple[WrongCase, float]]:
    """The worst cases with their backward errors: wrong before tolerated, then the largest error, then the first."""
    ranked = sorted(cases, key=lambda case: (case.status is not Status.WRONG, -case.exponent, case.index))
    kept = ranked[:WORST_KEPT]
    # Inside the last octave that is kept only the numbers themselves tell which cases are the worst.
    rivals = [
        case for case in ranked[WORST_KEPT:] if (case.status, case.exponent) == (kept[-1].status, kept[-1].exponent)
    ]
    if kept and math.isfinite(kept[-1].exponent):
        kept = [*kept, *rivals]
    with_errors = [(case, judge.measured(case, criterion.question)) for case in kept]
    with_errors.sort(key=lambda pair: (pair[0].status is not Status.WRONG, -pair[1], pair[0].index))
    return with_errors[:WORST_KEPT]


def _worst(case: WrongCase, error: float, name: str, criterion: Criterion) -> dict[str, Any]:
    return {
        "case": name,
        "row": [value.hex() for value in case.row],
        "truth": int(case.truth),
        "answer": case.answer,
        "mistake": case.mistake.value,
        "status": case.status.value,
        "backward_error": error,
        "backward_error_u": judge.in_units(error, criterion.unit),
    }


def _by_octave(
    octaves: np.ndarray[Any, np.dtype[np.float64]], status: np.ndarray[Any, Any]
) -> dict[str, dict[str, int]]:
    """Counts by status for each octave of the case's own distance to the nearest other position."""
    table: dict[str, Counter[str]] = {}
    for octave, name in zip(map(float, octaves), status.tolist(), strict=True):
        key = str(int(octave)) if math.isfinite(octave) else str(octave)
        table.setdefault(key, Counter())[name] += 1
    return {key: dict(sorted(table[key].items())) for key in sorted(table, key=float)}


def _size_bins(rows: Rows, status: np.ndarray[Any, Any]) -> list[list[int]]:
    """Rows [⌊log2 α/b⌋, ⌊log2 γ/d⌋, asked, wrong or tolerated], one for each bin that has cases."""
    with np.errstate(all="ignore"):
        return _bins(np.frexp(rows[:, 0] / rows[:, 2])[1] - 1, np.frexp(rows[:, 1] / rows[:, 3])[1] - 1, status)


def _place_bins(rows: Rows, status: np.ndarray[Any, Any]) -> list[list[int]]:
    """Rows [⌊8 r/α⌋, ⌊8 |z|/γ⌋, asked, wrong or tolerated], both clipped to 0 … 63."""
    with np.errstate(all="ignore"):
        r, z = np.hypot(rows[:, 4], rows[:, 5]) / rows[:, 0], np.abs(rows[:, 6]) / rows[:, 1]
        across, along = (np.nan_to_num(np.clip(8 * value, 0, 63)).astype(int) for value in (r, z))
    return _bins(across, along, status)


def _bins(first: np.ndarray[Any, Any], second: np.ndarray[Any, Any], status: np.ndarray[Any, Any]) -> list[list[int]]:
    asked: Counter[tuple[int, int]] = Counter()
    wrong: Counter[tuple[int, int]] = Counter()
    for key, name in zip(zip(first.tolist(), second.tolist(), strict=True), status.tolist(), strict=True):
        asked[key] += 1
        wrong[key] += name != Status.RIGHT.value
    return [[*key, asked[key], wrong[key]] for key in sorted(asked)]
