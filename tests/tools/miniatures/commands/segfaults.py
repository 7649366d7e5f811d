"""Reads at an address without memory."""

import ctypes

from base import serve


def on_unlucky(sequence, rows):
    ctypes.string_at(8)


serve(on_unlucky=on_unlucky)
