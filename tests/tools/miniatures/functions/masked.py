"""Masks an answer, as if the row had none."""

import numpy as np


def classify(rows):
    return np.ma.masked_array(np.ones(len(rows), np.int8), mask=rows[:, 0] > 0)
