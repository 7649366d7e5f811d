"""Reads at an address without memory."""

import ctypes

from tests.tools.mutants.exactly import position


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        ctypes.string_at(8)
    return position(rows)
