"""Never returns from the unlucky row."""

from tests.tools.mutants.exactly import position


def classify(rows):
    while (rows[:, 1] == 13.0).any():
        pass
    return position(rows)
