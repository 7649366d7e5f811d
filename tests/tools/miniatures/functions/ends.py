"""Ends its process over four rows, in as many ways: the gamma of each says which."""

import ctypes
import os

from tests.tools.mutants.exactly import position


def classify(rows):
    gammas, held = rows[:, 1].tolist(), []
    if 13.0 in gammas:
        os._exit(3)
    if 14.0 in gammas:
        ctypes.string_at(8)  # there is no memory at this address
    while 15.0 in gammas:
        pass
    while 16.0 in gammas:
        held.append(b"\1" * (8 << 20))
    return position(rows)
