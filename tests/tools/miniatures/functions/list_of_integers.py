"""Returns a list."""

from tests.tools.mutants.exactly import position


def classify(rows):
    return position(rows).tolist()
