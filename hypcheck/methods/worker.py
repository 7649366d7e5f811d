"""The program of our own worker: loads one Python function or one shared library and answers questions about rows.

Questions and answers go through the pipes that were its standard input and output; whatever the foreign code reads or
prints goes to nothing and to standard error instead, so that it cannot break the conversation.
"""

from __future__ import annotations

import faulthandler
import os
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from hypcheck.methods import frames
from hypcheck.methods.environment import RoundingMode
from hypcheck.methods.evidence import WIDTH
from hypcheck.methods.library import Library
from hypcheck.methods.python_function import PythonFunction, told
from hypcheck.methods.subject import Answers, ContractError, LoadError, Subject, room_at
from hypcheck.rows import Rows
from hypcheck.visible import visible

KINDS: Mapping[str, Callable[..., Subject]] = MappingProxyType({"python": PythonFunction, "library": Library})


class Line:
    """Our end of the conversation."""

    def __init__(self) -> None:
        self._requests, self._replies = os.dup(0), os.dup(1)
        nothing, end = os.pipe()  # as the null device, which may be missing, it has nothing to read
        os.close(end)
        os.dup2(nothing, 0)
        os.dup2(2, 1)
        os.close(nothing)
        sys.stdout = open(1, "w", buffering=1, encoding="utf-8", errors="replace", closefd=False)  # noqa: SIM115
        self._mark = 0
        self._room = room_at(0, frames.LARGEST * 56 + 56).data

    def request(self, count: int) -> tuple[bytes, int, Rows] | None:
        """The next question: what is asked, how often, of which rows; None at the end of input.

        The rows' address modulo 64 goes with `count`.
        """
        head = bytearray(frames.REQUEST.size)
        if not self._fill(memoryview(head)):
            return None
        asked, n, repeat, self._mark = frames.REQUEST.unpack(head)
        shift = 8 * (count % 8)
        body = self._room[shift : shift + n * 56]
        if not self._fill(body):
            return None
        return asked, repeat, np.frombuffer(body, dtype="<f8").reshape(n, 7)

    def _fill(self, room: memoryview) -> bool:
        while room:
            got = os.readv(self._requests, [room])
            if not got:
                return False
            room = room[got:]
        return True

    def reply(self, what: bytes, body: bytes | memoryview, width: int = 1) -> None:
        """Answer."""
        head = frames.REPLY.pack(what, width, len(body), self._mark)
        for part in (memoryview(head), memoryview(body)):
            rest = part
            while rest:
                rest = rest[os.write(self._replies, rest) :]


def main(words: Sequence[str]) -> None:
    """Serve: `words` is where to begin varying addresses, the kind, and what the kind needs."""
    faulthandler.enable()
    line = Line()
    count, kind, *rest = words
    try:
        subject = KINDS[kind](*rest)
    except LoadError as error:
        line.reply(frames.ERROR, _sentence(str(error)))
        return
    line.reply(frames.READY, (b"1" if subject.scene else b"0") + subject.description.encode())
    serve(line, subject, int(count))


def serve(line: Line, subject: Subject, count: int) -> None:
    """Answer until the input ends."""
    rounding = RoundingMode()
    while request := line.request(count):
        count += 1
        reply = _reply(subject, *request)
        try:
            rounding.restore()
        except ContractError as error:
            reply = frames.PROTOCOL, _sentence(str(error)), 1
        line.reply(*reply)


Reply = tuple[bytes, bytes | memoryview, int]


def _reply(subject: Subject, asked: bytes, repeat: int, rows: Rows) -> Reply:
    try:
        if asked in {frames.TIME, frames.TIME_SCENE, frames.TIME_EACH}:
            times = _times(subject, asked, repeat, rows)
            return frames.TIMED, frames.TIMES.pack(*times), 8
        classify = subject.classify_scene if asked == frames.CLASSIFY_SCENE else subject.classify
        answers: Answers = np.ascontiguousarray(classify(rows))
    except ContractError as error:
        return frames.PROTOCOL, _sentence(str(error)), 1
    except BaseException as error:  # noqa: BLE001 - foreign code raises anything, SystemExit too
        traceback.print_exc()
        return frames.ERROR, _sentence(f"it {told(error)}"), 1
    return frames.ANSWERS, answers.data.cast("B"), answers.itemsize


def _times(subject: Subject, asked: bytes, repeat: int, rows: Rows) -> tuple[int, int]:
    if asked == frames.TIME_EACH:
        return subject.seconds_each(rows, repeat)
    return subject.seconds(rows, repeat, by_scene=asked == frames.TIME_SCENE)


def _sentence(text: str) -> bytes:
    return visible(text, WIDTH).encode()
