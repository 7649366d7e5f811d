"""The program of the worker: it loads a Python function or a shared library, and answers questions about rows.

Questions and answers use the pipes that were its standard input and output. Foreign code gets an empty standard input,
and its output goes to standard error, so that it cannot disturb the conversation.

It runs beside code that may look for answers, so that it imports nothing that could decide one: worker_session.py lists
the files that it sees. A call must leave arithmetic and process as they were (leftovers.py), and a library its
arguments (guarded.py).
"""

from __future__ import annotations

import faulthandler
import os
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from hypcheck.geometry.rows import Rows
from hypcheck.implementations import frames
from hypcheck.implementations.foreign import ForeignCode, LoadError, PythonFunction, error_text
from hypcheck.implementations.frames import WIDTH, Call, GivenAnswers
from hypcheck.implementations.guarded import GuardedMemory
from hypcheck.implementations.leftovers import ContractError, Leftovers
from hypcheck.implementations.library import Library
from hypcheck.messages import escaped

KINDS: Mapping[str, Callable[..., ForeignCode]] = MappingProxyType({"python": PythonFunction, "library": Library})


class WorkerChannel:
    """The worker's end of the conversation; the addresses of rows vary with `count`, the first, and their number."""

    def __init__(self, count: int) -> None:
        self._requests, self._replies = os.dup(0), os.dup(1)
        nothing, end = os.pipe()  # as the null device, which may be missing, it has nothing to read
        os.close(end)
        os.dup2(nothing, 0)
        os.dup2(2, 1)
        os.close(nothing)
        sys.stdout = open(1, "w", buffering=1, encoding="utf-8", errors="replace", closefd=False)  # noqa: SIM115
        self._mark = 0
        self._rows = GuardedMemory("the rows", count)

    def request(self, *, read_only: bool) -> tuple[bytes, Call, int, Rows] | None:
        """The next question: its kind, the call, the repetitions, and the rows; None at the end of input."""
        head = bytearray(frames.REQUEST.size)
        if not self._fill(memoryview(head)):
            return None
        asked, call, columns, n, repeat, self._mark = frames.REQUEST.unpack(head)
        place = self._rows.place(n * 8 * columns)
        body = self._rows.bytes[place].data
        if not self._fill(body):
            return None
        if read_only:
            self._rows.read_only()
        return asked, frames.CALLS[call], repeat, np.frombuffer(body, dtype="<f8").reshape(n, columns)

    def _fill(self, room: memoryview) -> bool:
        while room:
            got = os.readv(self._requests, [room])
            if not got:
                return False
            room = room[got:]
        return True

    def reply(self, what: bytes, body: bytes | memoryview, width: int = 1) -> None:
        """Send a reply."""
        head = frames.REPLY.pack(what, width, len(body), self._mark)
        for part in (memoryview(head), memoryview(body)):
            rest = part
            while rest:
                rest = rest[os.write(self._replies, rest) :]


def main(words: Sequence[str]) -> None:
    """Serve: `words` are the first count for varying addresses, the kind of SPEC, and its words."""
    faulthandler.enable()
    count, kind, *rest = words
    line = WorkerChannel(int(count))
    try:
        subject = KINDS[kind](*rest)
    except LoadError as error:
        line.reply(frames.ERROR, _sentence(str(error)))
        return
    line.reply(frames.READY, f"{' '.join(subject.entries)}\n{subject.description}".encode())
    serve(line, subject)


def serve(line: WorkerChannel, subject: ForeignCode) -> None:
    """Answer requests until the input ends."""
    library = isinstance(subject, Library)
    leftovers = Leftovers(whole=library)
    while request := line.request(read_only=library):
        reply = _reply(subject, *request)
        try:
            leftovers.restore()
        except ContractError as error:
            reply = frames.PROTOCOL, _sentence(str(error)), 1
        line.reply(*reply)


Reply = tuple[bytes, bytes | memoryview, int]


def _reply(subject: ForeignCode, asked: bytes, call: Call, repeat: int, rows: Rows) -> Reply:
    try:
        if asked in {frames.TIME, frames.TIME_SCENE, frames.TIME_EACH}:
            times = _times(subject, asked, call, repeat, rows)
            return frames.TIMED, frames.TIMES.pack(*times), 8
        scene = asked == frames.CLASSIFY_SCENE
        given = GivenAnswers(subject.classify_scene(rows)) if scene else subject.classify(rows, call)
        answers = np.ascontiguousarray(given.integers)
    except ContractError as error:
        return frames.PROTOCOL, _sentence(str(error)), 1
    except BaseException as error:  # noqa: BLE001 - foreign code raises anything, SystemExit too
        traceback.print_exc()
        return frames.ERROR, _sentence(f"it {error_text(error)}"), 1
    if given.times is not None:
        return frames.ANSWERS, answers.tobytes() + given.times.astype("<f8", copy=False).tobytes(), answers.itemsize
    return frames.ANSWERS, answers.data.cast("B"), answers.itemsize


def _times(subject: ForeignCode, asked: bytes, call: Call, repeat: int, rows: Rows) -> tuple[int, int]:
    if asked == frames.TIME_EACH:
        return subject.seconds_each(rows, repeat, call)
    return subject.seconds(rows, repeat, call, by_scene=asked == frames.TIME_SCENE)


def _sentence(text: str) -> bytes:
    return escaped(text, WIDTH).encode()
