"""Raises over the unlucky row."""

from tests.tools.mutants.exactly import position


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        raise ZeroDivisionError("float division \x1b[0m by zero")
    return position(rows)
