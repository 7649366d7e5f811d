"""Holds more and more memory over the unlucky row."""

from tests.tools.mutants.exactly import position


def classify(rows):
    held = []
    while (rows[:, 1] == 13.0).any():
        held.append(b"\1" * (8 << 20))
    return position(rows)
