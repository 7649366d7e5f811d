"""What a foreign program says about itself, kept short and made safe to print."""

from __future__ import annotations

from collections.abc import Sequence

from hypcheck.visible import visible

KEPT = 16_384
"""Bytes of standard error that are kept: the last ones, since what a program says before it ends tells the most."""

LINES, WIDTH = 3, 400
"""What a sentence quotes of them."""


def quoted(data: bytes | bytearray, width: int = 80) -> str:
    """Bytes that were not understood, as a sentence quotes them."""
    return f"'{visible(bytes(data[: 4 * width]).decode('utf-8', 'replace'), width)}'"


class Tail:
    """The end of a stream of bytes, however long the stream."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._fresh = 0

    def add(self, data: bytes) -> None:
        """Take what came, and forget what that pushes out."""
        self._bytes += data
        self._fresh += len(data)
        if len(self._bytes) > 2 * KEPT:
            del self._bytes[:-KEPT]

    def mark(self) -> None:
        """From here on `recent` speaks."""
        self._fresh = 0

    def lines(self) -> tuple[str, ...]:
        """All that is kept, line by line, safe to print."""
        return _lines(self._bytes[-KEPT:])

    def recent(self) -> tuple[str, ...]:
        """What of it came since the mark."""
        return _lines(self._bytes[-min(self._fresh, KEPT) :]) if self._fresh else ()


def last_words(lines: Sequence[str]) -> str:
    """The last lines of standard error as the end of a sentence; empty where there are none."""
    return f"; stderr: {visible(' | '.join(lines[-LINES:]), WIDTH)}" if lines else ""


def _lines(data: bytearray) -> tuple[str, ...]:
    shown = (visible(line, WIDTH) for line in data.decode("utf-8", "replace").splitlines())
    return tuple(line for line in shown if line)
