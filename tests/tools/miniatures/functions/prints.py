"""Prints on standard output, from Python and from below it."""

import os
import sys

from tests.tools.mutants.exactly import position


def classify(rows):
    sys.stdout.write("computing\n" * 1000)
    os.write(1, b"\xff\x00 from C\n")
    return position(rows)
