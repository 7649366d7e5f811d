"""Holds more and more memory over the unlucky row."""

from hypcheck.kernel import classify as kernel


def classify(rows):
    held = []
    while (rows[:, 1] == 13.0).any():
        held.append(b"\1" * (8 << 20))
    return kernel.classify(rows)
