"""Calls sys.exit over the unlucky row."""

import sys

from tests.tools.mutants.exactly import position


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        sys.exit(3)
    return position(rows)
