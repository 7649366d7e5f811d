"""Answers 256, which one byte would take for 0, to the unlucky row."""

import numpy as np

from hypcheck.kernel import classify as kernel


def classify(rows):
    return np.where(rows[:, 1] == 13.0, 256, kernel.classify(rows).astype(int))
