"""Refuses invalid rows, as it declares."""

import numpy as np

from tests.tools.mutants.exactly import position

hypcheck = {"refuses": True}


def classify(rows):
    valid = np.isfinite(rows).all(axis=1) & (rows[:, :4] > 0).all(axis=1)
    answers = np.full(len(rows), 127)
    answers[valid] = position(rows[valid])
    return answers
