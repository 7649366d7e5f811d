"""Leaves the rounding mode changed after the unlucky row."""

import ctypes
import platform

from tests.tools.mutants.exactly import position

UPWARD = 0x400000 if platform.machine() in {"aarch64", "arm64"} else 0x800


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        ctypes.CDLL(None).fesetround(UPWARD)
    return position(rows)
