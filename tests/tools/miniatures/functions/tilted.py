"""Always right about spheroids whose axis may point anywhere, and refuses what is no row."""

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import invalid
from tests.support.tilted_fractions import exact_position

hypcheck = {"name": "tilted", "tilt": True, "refuses": True}


def classify(rows):
    assert rows.shape[1] == 10
    assert rows.flags.c_contiguous
    answers, valid = np.full(len(rows), REFUSED, dtype=np.int8), ~invalid(rows)
    answers[valid] = [exact_position(row) for row in rows[valid].tolist()]
    return answers
