"""Implementations that take tilted spheroids: a right one, and some with one fault each."""

from __future__ import annotations

import numpy as np

from hypcheck.truth.tilted.batch import positions

hypcheck = {"name": "leaning", "tilt": True, "refuses": True}


def exact(rows):
    """Right, by integers; a row that is none is refused."""
    return positions(rows, on_invalid="flag")


def upright(rows):
    """The answer about the spheroid that stands upright in its place."""
    return positions(np.column_stack([rows[:, :7], np.tile([0.0, 0.0, 1.0], (len(rows), 1))]), on_invalid="flag")


def raises_far_over(rows):
    """An error where the spheroid leans by more than 45° in the direction of x."""
    if (rows[:, 7] > np.abs(rows[:, 9])).any():
        raise ValueError("no heading")
    return exact(rows)
