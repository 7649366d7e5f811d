"""Right, after half a second."""

import time

from tests.tools.mutants.exactly import position


def classify(rows):
    time.sleep(0.5)
    return position(rows)
