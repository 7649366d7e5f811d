"""Raises over the unlucky row."""

from hypcheck.kernel import classify as kernel


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        raise ZeroDivisionError("float division \x1b[0m by zero")
    return kernel.classify(rows)
