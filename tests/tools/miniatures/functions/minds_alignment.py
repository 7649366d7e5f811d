"""Right only if the rows begin at a multiple of 64 bytes, like vectorised code with a bug."""

from tests.tools.mutants.exactly import position


def classify(rows):
    return position(rows) if rows.ctypes.data % 64 == 0 else [1] * len(rows)
