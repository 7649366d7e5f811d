"""Leaves the rounding mode changed after the unlucky row."""

import ctypes
import platform

from hypcheck.kernel import classify as kernel

UPWARD = 0x400000 if platform.machine() in {"aarch64", "arm64"} else 0x800


def classify(rows):
    if (rows[:, 1] == 13.0).any():
        ctypes.CDLL(None).fesetround(UPWARD)
    return kernel.classify(rows)
