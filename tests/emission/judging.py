"""How far off the answers of an emitted kernel are, over all families of its own sizes."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction

import numpy as np

from hypcheck import judge
from hypcheck.casebook.fixed_sizes import families_for
from hypcheck.kernel.emission.kernel import description
from hypcheck.methods.domain import representable
from hypcheck.methods.domain_reading import domain_of
from hypcheck.truth import batch


def worst_error(asked_of, plan, count):
    """The largest backward error in units u of what `asked_of(rows)` answers, and how many rows were asked.

    All rows of one pair of sizes are asked at once: for some languages a question starts a process.
    """
    domain = domain_of(description(plan, "c")["domain"], "the domain")
    criterion = judge.Criterion(plan.question, plan.format.name, Fraction(8))
    tables = defaultdict(list)
    for family in families_for(domain.settings):
        rows = family.rows(0, count)
        rows = rows[domain.holds(rows) & representable(rows, plan.format.name)]
        if len(rows):
            tables[tuple(rows[0, :4])].append(rows)
    alike = [np.concatenate(parts) for parts in tables.values()]
    return max((worst_of(asked_of, rows, criterion) for rows in alike), default=0.0), sum(map(len, alike))


def worst_of(asked_of, rows, criterion):
    """The largest backward error in units u of what `asked_of` answers to these rows."""
    wrong = judge.wrong_cases(rows, batch.positions(rows), asked_of(rows), criterion)
    return max(
        (judge.in_units(judge.measured(case, criterion.question), criterion.unit) for case in wrong), default=0.0
    )
