"""Right only if the rows begin at a multiple of 64 bytes, like vectorised code with a bug."""

from hypcheck.kernel import classify as kernel


def classify(rows):
    return kernel.classify(rows) if rows.ctypes.data % 64 == 0 else [1] * len(rows)
