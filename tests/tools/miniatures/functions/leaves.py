"""Ends its process over the unlucky row."""

import os

from tests.tools.mutants.exactly import position


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        os._exit(3)
    return position(rows)
