"""Right in its first three calls, and the other way round from then on."""

from tests.tools.mutants.exactly import position

calls = []


def classify(rows):
    calls.append(1)
    return position(rows) * (1 if len(calls) <= 3 else -1)
