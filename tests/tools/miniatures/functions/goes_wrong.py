"""Goes wrong over four rows, in as many ways: the gamma of each says which."""

import ctypes
import platform
import sys

import numpy as np

from tests.tools.mutants.exactly import position

UPWARD = 0x400000 if platform.machine() in {"aarch64", "arm64"} else 0x800


def classify(rows):
    gammas = rows[:, 1].tolist()
    if 13.0 in gammas:
        raise ZeroDivisionError("float division \x1b[0m by zero")
    if 14.0 in gammas:
        sys.exit(3)
    if 15.0 in gammas:
        ctypes.CDLL(None).fesetround(UPWARD)
    return np.where(rows[:, 1] == 16.0, 256, position(rows).astype(int))  # one byte would take 256 for 0
