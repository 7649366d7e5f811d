"""What the formulas get wrong: in exact rationals, where only the mathematics is to blame, and in floats."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck import groups, judge
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.formulas import FORMULAS, Formula, answers
from hypcheck.judge import Criterion, Status
from hypcheck.methods.domain import EVERYWHERE, representable
from hypcheck.methods.method import Method
from hypcheck.pairs import COLUMNS, Pair
from hypcheck.record.lines import Group
from hypcheck.rows import CANNOT_SAY
from hypcheck.truth.exact import cubic
from hypcheck.truth.kinds import Kind
from hypcheck.verify.plan import Batch, Plan


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


def group(method: Method, batch: Batch, octaves: NDArray[np.float64], plan: Plan) -> Group:
    """The record's line about one method and one family; `octaves` as in groups.line, of all the batch's rows."""
    tolerance = Fraction(0) if method.exact else plan.tolerance
    criterion = Criterion(method.question, method.precision, tolerance)
    asked = method.domain.holds(batch.rows, extreme=batch.family.extreme) & representable(batch.rows, method.precision)
    places = np.flatnonzero(asked)[: method.most]
    rows = batch.rows[places]
    given = method.answer(rows)
    wrong = judge.wrong_cases(rows, batch.positions[places], given, criterion)
    status = np.where(given == CANNOT_SAY, groups.CODES[Status.ABSTAINED], groups.CODES[Status.RIGHT]).astype(np.int8)
    for case in wrong:
        status[case.index] = groups.CODES[case.status]
    ended = groups.Ended(
        rows=rows,
        status=status,
        wrong=wrong,
        octaves=octaves[places],
        name=lambda index: batch.case_id(int(places[index])),
        place=lambda index: (1, int(places[index])),
        skipped=int((~asked).sum()),
    )
    tallied = groups.tally(ended, criterion)
    return groups.line(
        tallied, batch.family.name, criterion, method=method.name, title=method.title, exact=method.exact
    )
