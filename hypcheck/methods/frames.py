"""The frames between us and our own worker: a fixed head, then bytes. Both sides run on one machine from one source."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from hypcheck.rows import Rows

LARGEST = 65_536
"""Rows of a question."""

REQUEST = struct.Struct("=4sIQQ")
"""What is asked, the number of rows, how often to repeat, and a mark that nobody can guess; then the rows."""

REPLY = struct.Struct("=4sIQQ")
"""What it is, the bytes that an answer takes (1 or 8), the bytes that follow, and the mark of the request.

Without the mark, what foreign code wrote into our pipe would be taken for a reply, and the reply for that to the next
question. The first reply, which comes unasked, has the mark 0.
"""

CLASSIFY, CLASSIFY_SCENE, TIME, TIME_SCENE, TIME_EACH = b"clas", b"scen", b"time", b"tims", b"each"
READY, ANSWERS, TIMED, ERROR, PROTOCOL = b"here", b"answ", b"took", b"erro", b"prot"

TIMES = struct.Struct("=qq")
"""Nanoseconds and the sum of the answers."""

UNWRITTEN = -86
"""What a library's positions hold before it is called; no question has this answer."""


def row_bytes(rows: Rows) -> memoryview:
    """Rows (n, 7) as little-endian bytes, not copied where they already are."""
    return np.ascontiguousarray(rows, dtype="<f8").data.cast("B") if rows.size else memoryview(b"")


def integers(data: bytes | bytearray | memoryview, width: int) -> NDArray[np.signedinteger]:
    """Answers from bytes."""
    return np.frombuffer(data, dtype=np.int8 if width == 1 else np.int64)
