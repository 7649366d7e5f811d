"""Refuses invalid rows, as it declares."""

import numpy as np

from hypcheck.kernel import classify as kernel

hypcheck = {"refuses": True}


def classify(rows):
    valid = np.isfinite(rows).all(axis=1) & (rows[:, :4] > 0).all(axis=1)
    answers = np.full(len(rows), 127)
    answers[valid] = kernel.classify(rows[valid])
    return answers
