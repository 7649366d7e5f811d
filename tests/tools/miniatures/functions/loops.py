"""Never returns from the unlucky row."""

from hypcheck.kernel import classify as kernel


def classify(rows):
    while (rows[:, 1] == 13.0).any():
        pass
    return kernel.classify(rows)
