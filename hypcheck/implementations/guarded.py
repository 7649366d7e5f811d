"""Memory for the arguments of a library, between pages that nothing can be read from or written to.

An array stands at the one end or at the other in turn, so that a library that reaches one byte too far, before or
behind, ends there. What is given to be read is read-only. On a system without mprotect the memory is ordinary.
"""

from __future__ import annotations

import ctypes
import mmap
import sys

import numpy as np
from numpy.typing import NDArray

try:
    from hypcheck.implementations import _calls
except ImportError:  # not compiled: a fault is not named
    _calls = None  # type: ignore[assignment]

_PAGE = mmap.PAGESIZE
_NONE, _READ, _WRITE = 0, 1, 2
"""PROT_NONE, PROT_READ, PROT_WRITE of sys/mman.h, the same on Linux and macOS."""


def _libc() -> ctypes.CDLL | None:
    if sys.platform == "win32":
        return None
    libc = ctypes.CDLL(None, use_errno=True)
    libc.mprotect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    return libc


class GuardedMemory:
    """Room for one array, which grows as it is needed. `what` names it in a message, such as "the rows".

    `turn` counts the places, and may begin with any number, so that two processes begin with others.
    """

    def __init__(self, what: str, turn: int = 0) -> None:
        self._what, self._turn = what, turn
        self._libc = _libc()
        self._size = 0
        self._readable_only = False
        self.bytes: NDArray[np.uint8] = np.empty(0, dtype=np.uint8)
        """All bytes between the two guard pages."""
        self._grow(_PAGE)

    def _grow(self, size: int) -> None:
        pages = -(-max(size, 1) // _PAGE)
        pages = max(pages, 2 * self._size // _PAGE)
        size = (pages + 2) * _PAGE
        private = {} if sys.platform == "win32" else {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS}
        whole = np.frombuffer(mmap.mmap(-1, size, **private), dtype=np.uint8)
        self._size, self._readable_only = pages * _PAGE, False
        self.bytes = whole[_PAGE : _PAGE + self._size]
        begin = self.bytes.ctypes.data
        end = begin + self._size
        if self._libc is None:
            return
        for start, where in ((begin - _PAGE, "before"), (end, "behind")):
            self._libc.mprotect(start, _PAGE, _NONE)
            if _calls:
                _calls.watch(start, start + _PAGE, f"it reached {where} {self._what}")
        if _calls:
            _calls.watch(begin, end, f"it wrote into {self._what}, which are read-only")

    def place(self, size: int, step: int = 8) -> slice:
        """The place among `bytes` of an array of that many, which may be written; it begins a multiple of `step` on.

        It is the last place, or near the first, so that its address modulo 64 varies: code that depends on that fails
        the tests.
        """
        self._turn += 1
        shift = self._turn // 2 * step % 64
        if size + shift > self._size:
            self._grow(size + shift)
        if self._readable_only:
            self._protect(_READ | _WRITE)
            self._readable_only = False
        start = self._size - size if self._turn % 2 else shift
        return slice(start, start + size)

    def read_only(self) -> None:
        """Let nothing be written to it until the next place()."""
        self._protect(_READ)
        self._readable_only = True

    def _protect(self, how: int) -> None:
        if self._libc is not None and self._size:
            self._libc.mprotect(self.bytes.ctypes.data, self._size, how)
