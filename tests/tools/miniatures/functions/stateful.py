"""Right in its first three calls, and the other way round from then on."""

from hypcheck.kernel import classify as kernel

calls = []


def classify(rows):
    calls.append(1)
    return kernel.classify(rows) * (1 if len(calls) <= 3 else -1)
