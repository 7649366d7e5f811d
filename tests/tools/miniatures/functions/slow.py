"""Takes 5 ms for each row, which is no fault."""

import time

from hypcheck.kernel import classify as kernel


def classify(rows):
    time.sleep(0.005 * len(rows))
    return kernel.classify(rows)
