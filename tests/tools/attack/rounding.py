"""The rounding modes of this machine, set for a while in this thread."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

from hypcheck.implementations.worker import mode_in_use

TO_NEAREST = "to nearest"
DIRECTED = ("upward", "downward", "towards zero")

_NUMBERS = (0, 0x400, 0x800, 0xC00, 0x400000, 0x800000, 0xC00000, 1, 2, 3)
"""What <fenv.h> calls the modes on x86, ARM, s390x and RISC-V; which is which is found out by a sum."""


@cache
def _modes() -> dict[str, int]:
    """The number of each mode by its name, as the machine that runs rounds."""
    libm, found = ctypes.CDLL(None), {}
    for number in _NUMBERS:
        if libm.fesetround(number) == 0:
            found.setdefault(mode_in_use(), number)
    libm.fesetround(found[TO_NEAREST])
    return found


@contextmanager
def rounded(mode: str) -> Iterator[None]:
    """float64 arithmetic of this thread rounds so, as long as it lasts."""
    modes = _modes()
    libm = ctypes.CDLL(None)
    assert libm.fesetround(modes[mode]) == 0
    try:
        yield
    finally:
        libm.fesetround(modes[TO_NEAREST])
