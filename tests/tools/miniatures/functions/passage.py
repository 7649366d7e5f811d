"""Always right about ways, with the times of first contact; refuses what is no row."""

import numpy as np

from hypcheck import passage
from hypcheck.geometry.rows import SWEEPS, invalid

hypcheck = {"name": "passage", "question": "passage", "times": True, "refuses": True}


def classify(rows):
    assert rows.shape[1] == 10
    assert rows.flags.c_contiguous
    hits, times = np.full(len(rows), 127), np.full(len(rows), np.nan)
    for place in np.flatnonzero(~invalid(rows, SWEEPS)):
        row = rows[place].tolist()
        found = passage(row[:4], row[4:7], row[7:])
        hits[place], times[place] = found.hit, found.first_lower
    return hits, times
