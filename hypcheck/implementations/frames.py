"""Data between hypcheck and its worker, rows and answers as bytes.

The frames between hypcheck and its worker have a fixed head, then bytes. Both sides run on one machine from one source.
"""

from __future__ import annotations

import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import PAIRS, SWEEPS, Floats, Layout, Rows

WIDTH = 400
"""The most characters of a text that is shown."""

LARGEST = 65_536
"""The most rows of a question."""

IntegerAnswers = NDArray[np.signedinteger[Any]]


class GivenAnswers(NamedTuple):
    """The unchecked answers of an implementation: an integer for each row, and times, float64 (n,), if requested.

    A time means something where the answer is 1.
    """

    integers: IntegerAnswers
    times: Floats | None = None


class CallForm(NamedTuple):
    """Which function of foreign code is called, and the columns of its rows.

    `entry` and the question's `layout` are those of description.Question. `times`: it gives times. `scene`: it is the
    function for many centres, whose rows have the same sizes and axis. `columns`: it is the function for rows of any
    width.
    """

    entry: str
    layout: Layout
    times: bool = False
    scene: bool = False
    columns: bool = False

    def entry_name(self, *, tilt: bool) -> str:
        """Return the one of ENTRIES that is called, with an axis or without."""
        if self.columns:
            return f"hypcheck_{self.entry}_columns"
        return f"hypcheck_{self.entry}{'_tilted' if tilt else ''}{'_scene' if self.scene else ''}"


CALLS = (
    CallForm("classify", PAIRS),
    CallForm("classify", PAIRS, scene=True),
    CallForm("classify", PAIRS, columns=True),
    CallForm("passage", SWEEPS),
    CallForm("passage", SWEEPS, times=True),
    CallForm("passage", SWEEPS, columns=True),
    CallForm("passage", SWEEPS, times=True, columns=True),
)

REQUEST = struct.Struct("=4sIIIQQ")
"""The kind of request, the place of its call in CALLS, the numbers of a row, the number of rows, the repetitions, and a
mark that nobody can guess; then the rows."""

REPLY = struct.Struct("=4sIQQ")
"""The kind of reply, the bytes of an answer (1 or 8), the bytes that follow, and the mark of the request.

Answers are followed by their times if these were requested.

Without the mark, bytes that foreign code writes into the pipe would look like a reply, and the true reply like that to
the next question. The first reply, which has no request, has the mark 0.
"""

CLASSIFY, TIME, TIME_EACH = b"clas", b"time", b"each"
"""The kinds of requests: answers, the time of all rows in one call, the time of a call for each row."""

READY, ANSWERS, TIMED, ERROR, PROTOCOL = b"here", b"answ", b"took", b"erro", b"prot"
"""The kinds of replies: loaded, answers, times, foreign code raised an error, it broke the contract of a call."""

ENTRIES = (
    "hypcheck_classify",
    "hypcheck_classify_tilted",
    "hypcheck_classify_scene",
    "hypcheck_classify_tilted_scene",
    "hypcheck_passage",
    "hypcheck_passage_tilted",
    "hypcheck_classify_columns",
    "hypcheck_passage_columns",
)
"""The functions of a library: of rows, of rows with an axis, of one scene, of sweeps, and of rows of any width.

READY says which it exports.
"""

TIMES = struct.Struct("=qq")
"""The body of TIMED: nanoseconds, and the sum of the answers."""

UNWRITTEN = -86
"""The value of a library's positions before it is called; no question has this answer."""


def row_bytes(rows: Rows) -> memoryview:
    """Return rows (n, as many columns) as little-endian bytes, without a copy if they have that layout."""
    return np.ascontiguousarray(rows, dtype="<f8").data.cast("B") if rows.size else memoryview(b"")


def integers(data: bytes | bytearray | memoryview, width: int) -> NDArray[np.signedinteger]:
    """Return answers from bytes."""
    return np.frombuffer(data, dtype=np.int8 if width == 1 else np.int64)
