"""Implementations that take tilted spheroids: a right one, and some with one fault each."""

from __future__ import annotations

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import invalid, with_axis
from hypcheck.truth.tilted.batch import positions

hypcheck = {"name": "leaning", "tilt": True, "refuses": True}


def exact(rows):
    """Right, by integers; a row that is none is refused."""
    return positions(rows, on_invalid="flag")


def upright(rows):
    """The answer about the spheroid that stands upright in its place."""
    answers = positions(with_axis(rows[:, :7]), on_invalid="flag")
    answers[invalid(rows)] = REFUSED
    return answers


def refuses_upright_rows_alone(rows):
    """A row without a direction is answered as contact, as if it were any other."""
    answers = exact(rows)
    answers[invalid(rows) & ~invalid(with_axis(rows[:, :7])) & ~rows[:, 7:].any(axis=1)] = 0
    return answers


def raises_far_over(rows):
    """An error where the spheroid leans by more than 45° in the direction of x."""
    if (rows[:, 7] > np.abs(rows[:, 9])).any():
        raise ValueError("no heading")
    return exact(rows)
