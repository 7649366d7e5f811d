"""What a foreign program sends us: rows and answers as bytes, and its own words, shortened and escaped.

What a foreign program says about itself, kept short and made safe to print.

The frames between us and our own worker: a fixed head, then bytes. Both sides run on one machine from one source.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import Rows
from hypcheck.messages import escaped

KEPT = 16_384
"""Bytes of standard error that are kept: the last ones, since what a program says before it ends tells the most."""

LINES, WIDTH = 3, 400
"""What a sentence quotes of them."""


def quoted(data: bytes | bytearray, width: int = 80) -> str:
    """Bytes that were not understood, as a sentence quotes them."""
    return f"'{escaped(bytes(data[: 4 * width]).decode('utf-8', 'replace'), width)}'"


class OutputTail:
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


def stderr_excerpt(lines: Sequence[str]) -> str:
    """The last lines of standard error as the end of a sentence; empty where there are none."""
    return f"; stderr: {escaped(' | '.join(lines[-LINES:]), WIDTH)}" if lines else ""


def _lines(data: bytearray) -> tuple[str, ...]:
    shown = (escaped(line, WIDTH) for line in data.decode("utf-8", "replace").splitlines())
    return tuple(line for line in shown if line)


LARGEST = 65_536
"""Rows of a question."""

REQUEST = struct.Struct("=4sIIQQ")
"""What is asked, the numbers of a row, the number of rows, how often to repeat, and a mark that nobody can guess; then
the rows."""

REPLY = struct.Struct("=4sIQQ")
"""What it is, the bytes that an answer takes (1 or 8), the bytes that follow, and the mark of the request.

Without the mark, what foreign code wrote into our pipe would be taken for a reply, and the reply for that to the next
question. The first reply, which comes unasked, has the mark 0.
"""

CLASSIFY, CLASSIFY_SCENE, TIME, TIME_SCENE, TIME_EACH = b"clas", b"scen", b"time", b"tims", b"each"
READY, ANSWERS, TIMED, ERROR, PROTOCOL = b"here", b"answ", b"took", b"erro", b"prot"

ENTRIES = (
    "hypcheck_classify",
    "hypcheck_classify_tilted",
    "hypcheck_classify_scene",
    "hypcheck_classify_tilted_scene",
)
"""The functions of a library: of rows, of rows with an axis, and of one scene; READY says which of them it exports."""


def entry_name(*, tilt: bool, scene: bool = False) -> str:
    """The one of ENTRIES that is called: with an axis or without, of rows or of one scene."""
    return ENTRIES[2 * scene + tilt]


TIMES = struct.Struct("=qq")
"""Nanoseconds and the sum of the answers."""

UNWRITTEN = -86
"""What a library's positions hold before it is called; no question has this answer."""


def row_bytes(rows: Rows) -> memoryview:
    """Rows (n, 7 or 10) as little-endian bytes, not copied where they already are."""
    return np.ascontiguousarray(rows, dtype="<f8").data.cast("B") if rows.size else memoryview(b"")


def integers(data: bytes | bytearray | memoryview, width: int) -> NDArray[np.signedinteger]:
    """Answers from bytes."""
    return np.frombuffer(data, dtype=np.int8 if width == 1 else np.int64)
