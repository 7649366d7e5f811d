"""Implementations that take tilted spheroids: a right one, and some with one fault each."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import invalid, with_axis
from hypcheck.vectors import frozen
from tests.support.inside import positions

hypcheck = {"name": "leaning", "tilt": True, "refuses": True}


def exact(rows):
    """Right, by integers; a row that is none is refused."""
    answers, valid = np.full(len(rows), REFUSED, dtype=np.int8), ~invalid(rows)
    answers[valid] = positions(rows[valid])
    return answers


def upright(rows):
    """The answer about the spheroid that stands upright in its place."""
    answers = exact(with_axis(rows[:, :7]))
    answers[invalid(rows)] = REFUSED
    return answers


def refuses_upright_rows_alone(rows):
    """A row without a direction is answered as contact, as if it were any other."""
    answers = exact(rows)
    answers[invalid(rows) & ~invalid(with_axis(rows[:, :7])) & (rows[:, 7:] == 0).all(axis=1)] = 0
    return answers


UNDECIDED = "tilted-twins-0078"
"""Interior. Contact is wrong by about 2⁻³⁸, as derivatives tell, but no proof of that is found: λ lies at a pole."""


def wrong_where_no_proof_is_found(rows):
    """Contact in that one case, right in all others."""
    (case,) = (case for case in frozen.load("tilted-twins").cases if case.id == UNDECIDED)
    return np.where((rows == case.row).all(axis=1), 0, exact(rows))


def raises_far_over(rows):
    """An error where the spheroid leans by more than 45° in the direction of x."""
    if (rows[:, 7] > np.abs(rows[:, 9])).any():
        raise ValueError("no heading")
    return exact(rows)
