"""Calls sys.exit over the unlucky row."""

import sys

from hypcheck.kernel import classify as kernel


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        sys.exit(3)
    return kernel.classify(rows)
