"""Claims to refuse invalid rows."""

from __future__ import annotations

import numpy as np

from tests.tools.mutants.exactly import position
from tests.tools.mutants.expectation import NO_TOLERANCE, right, wrong

hypcheck = {"refuses": True}


def _valid(rows):
    return np.isfinite(rows).all(axis=1) & (rows[:, :4] > 0).all(axis=1)


def _where(valid, rows):
    """The positions of rows where the mask holds, 127 elsewhere."""
    answers = np.full(len(rows), 127, dtype=np.int8)
    answers[valid] = position(rows[valid])
    return answers


@right(asked=NO_TOLERANCE)
def refuses_what_is_invalid(rows):
    """Refuses exactly the invalid rows."""
    return _where(_valid(rows), rows)


@wrong()
def answers_invalid_rows(rows):
    """Calls invalid rows contact."""
    answers = _where(_valid(rows), rows)
    answers[answers == 127] = 0
    return answers


@wrong()
def forgets_nan(rows):
    """Refuses sizes ≤ 0 and infinities, and calls NaN contact."""
    answers = _where(_valid(rows), rows)
    answers[np.isnan(rows).any(axis=1)] = 0
    return answers


@wrong()
def forgets_negative_sizes(rows):
    """Refuses 0, infinities and NaN, and squares a negative size."""
    valid = np.isfinite(rows).all(axis=1) & (rows[:, :4] != 0).all(axis=1)
    return _where(valid, rows)


@wrong()
def refuses_the_origin(rows):
    """Refuses a centre at the origin too, which is valid."""
    return _where(_valid(rows) & (rows[:, 4:] != 0).any(axis=1), rows)


@wrong()
def refuses_what_is_hard(rows):
    """Refuses contact too, which is valid."""
    answers = _where(_valid(rows), rows)
    answers[answers == 0] = 127
    return answers
