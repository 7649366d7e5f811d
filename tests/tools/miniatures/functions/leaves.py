"""Ends its process over the unlucky row."""

import os

from hypcheck.kernel import classify as kernel


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        os._exit(3)
    return kernel.classify(rows)
