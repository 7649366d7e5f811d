"""What the formulas get wrong: in exact rationals, where only the mathematics is to blame, and in floats."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge, tally
from hypcheck.derivation.exact_arithmetic import EXACT
from hypcheck.derivation.formulas import FORMULAS, Formula, answers
from hypcheck.judge import Criterion
from hypcheck.methods.asking import Answered
from hypcheck.methods.domain import EVERYWHERE, claimed
from hypcheck.methods.method import Method
from hypcheck.pairs import COLUMNS, Pair
from hypcheck.record.lines import Finding, Group
from hypcheck.score import score
from hypcheck.truth.exact import cubic
from hypcheck.truth.kinds import Kind
from hypcheck.verify.plan import Batch, Plan


def mathematical(formula: Formula, batch: Batch, plan: Plan) -> list[Finding]:
    """What the formula gets wrong in exact rationals on the first rows of a family, by side of its regimes and cause.

    No reason is given yet. `asked` counts the rows on that side.
    """
    head = batch.head(plan.exact_formulas)
    given = [int(answers(formula, EXACT, dict(zip(COLUMNS, row, strict=True)))) for row in head.rows.tolist()]
    inside = replace(EVERYWHERE, regimes=formula.regimes).holds(head.rows)
    wrong: dict[tuple[bool, str], list[int]] = {}
    for place in np.flatnonzero(judge.is_wrong(head.positions, np.array(given), formula.question)).tolist():
        wrong.setdefault((bool(inside[place]), cause(batch, place)), []).append(place)
    return [
        Finding(
            formula=formula.name,
            family=batch.family.name,
            inside=side,
            cause=why,
            asked=int((inside == side).sum()),
            wrong=len(places),
            first_case=batch.name(places[0]),
            first_row=tuple(value.hex() for value in batch.rows[places[0]].tolist()),
            reason=None,
        )
        for (side, why), places in sorted(wrong.items())
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


def group(method: Method, batch: Batch, exponents: NDArray[np.float64], plan: Plan) -> Group:
    """The record's line about one method and one family; `exponents` as in Score.tally, of all the batch's rows."""
    tolerance = Fraction(0) if method.exact else plan.tolerance
    criterion = Criterion(method.question, method.precision, tolerance)
    inside = claimed(batch.rows, method.domain, method.precision, extreme=batch.family.extreme)
    places = inside[: method.most]
    rows = batch.rows[places]
    scored = score(rows, batch.positions[places], Answered.of(method.answer(rows)), criterion)
    tallied = scored.tally(batch, places, exponents[places], skipped=len(batch.rows) - len(inside))
    return tally.line(tallied, batch.family.name, criterion, method=method.name, title=method.title, exact=method.exact)
