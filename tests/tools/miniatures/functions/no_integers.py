"""Returns what is not one integer for each row: the gamma of the first row says what."""

import numpy as np


def classify(rows):
    n = len(rows)
    masked = np.ma.masked_array(np.ones(n, np.int8), mask=rows[:, 0] > 0)  # as if the rows had no answers
    returned = [np.sign(rows[:, 4]), np.zeros(n + 1, dtype=np.int8), None, masked, [[1], [1, 0]] * n]
    return returned[int(rows[0, 1]) - 1]
