"""Reads at an address without memory."""

import ctypes

from hypcheck.kernel import classify as kernel


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        ctypes.string_at(8)
    return kernel.classify(rows)
