"""The output of foreign programs as reports quote it: safe to print, and with secrets masked."""

from __future__ import annotations

from collections.abc import Sequence

from hypcheck.implementations.frames import WIDTH
from hypcheck.isolation.launch import masked
from hypcheck.messages import escaped, printable, shortened

KEPT = 16_384
"""The number of last bytes of standard error that are kept: the output before a program's end says the most."""

LINES = 3
"""Lines of standard error in a sentence."""


def foreign_text(text: object, width: int = WIDTH) -> str:
    """A text of a foreign program on one line, as messages.escaped, without the secrets of our environment."""
    return escaped(masked(str(text)), width)


def quoted(data: bytes | bytearray) -> str:
    """The bytes as text in quotation marks for a message. Blanks are kept, because an extra blank may be the fault."""
    lines = masked(bytes(data[:320]).decode("utf-8", "replace")).splitlines()
    return f"'{shortened(printable(' '.join(lines)), 80)}'"


class OutputTail:
    """The end of a stream of bytes since a mark, however long the stream."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def add(self, data: bytes) -> None:
        """Append data, and drop the oldest bytes."""
        self._bytes += data
        if len(self._bytes) > 2 * KEPT:
            del self._bytes[:-KEPT]

    def mark(self) -> None:
        """Discard the bytes so far: lines() then returns only later ones."""
        self._bytes.clear()

    def lines(self) -> tuple[str, ...]:
        """The lines since the mark that are kept, safe to print."""
        text = masked(self._bytes[-KEPT:].decode("utf-8", "replace"))
        shown = (escaped(line, WIDTH) for line in text.splitlines())
        return tuple(line for line in shown if line)


def stderr_excerpt(lines: Sequence[str]) -> str:
    """The last lines of standard error as the end of a sentence; empty if there are none."""
    return f"; stderr: {escaped(' | '.join(lines[-LINES:]), WIDTH)}" if lines else ""
