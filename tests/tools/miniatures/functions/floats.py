"""Returns floats."""

import numpy as np


def classify(rows):
    return np.sign(rows[:, 4])
