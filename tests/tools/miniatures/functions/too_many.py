"""Returns one answer too many."""

import numpy as np


def classify(rows):
    return np.zeros(len(rows) + 1, dtype=np.int8)
