"""Takes 5 ms for each row, which is no fault."""

import time

from tests.tools.mutants.exactly import position


def classify(rows):
    time.sleep(0.005 * len(rows))
    return position(rows)
