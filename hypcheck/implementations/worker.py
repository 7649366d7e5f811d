"""The program of the worker: it loads a Python function or a shared library, and answers questions about rows.

Questions and answers use the pipes that were its standard input and output. Foreign code gets an empty standard input,
and its output goes to standard error, so that it cannot disturb the conversation.

A call must not change the rounding mode. libm knows the mode of one unit only (on x86 the old one), so the mode of the
arithmetic in use is measured too, by sums whose result depends on it.
"""

from __future__ import annotations

import ctypes
import faulthandler
import os
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from hypcheck.geometry.pair import TILTED_WAY_COLUMNS
from hypcheck.geometry.rows import Rows
from hypcheck.implementations import frames
from hypcheck.implementations.foreign import (
    ContractError,
    ForeignCode,
    Library,
    LoadError,
    PythonFunction,
    bytes_at,
    error_text,
)
from hypcheck.implementations.frames import WIDTH, Call, GivenAnswers
from hypcheck.messages import escaped

_ONE, _TINY = 1.0, 2.0**-60


def _libm() -> ctypes.CDLL | None:
    try:
        libm = ctypes.CDLL(None)
        libm.fegetround, libm.fesetround  # noqa: B018 - raises AttributeError without them
    except (OSError, TypeError, AttributeError):
        return None
    return libm


class RoundingMode:
    """The rounding mode at the start; restore() restores it, and raises if it was changed."""

    def __init__(self) -> None:
        self._libm = _libm()
        self._mode = self._by_libm()

    def _by_libm(self) -> int:
        return int(self._libm.fegetround()) if self._libm else 0

    def restore(self) -> None:
        """Raise ContractError if the mode is not to nearest, or not the one at the start by libm."""
        found = mode_in_use()
        if found == "to nearest" and self._by_libm() == self._mode:
            return
        if self._libm:
            self._libm.fesetround(self._mode)
        where = found if found != "to nearest" else "outside of the unit that computes float64"
        raise ContractError(f"it left the rounding mode changed: {where}; a call must leave it as it was")


def mode_in_use() -> str:
    """The rounding mode of float64 sums now."""
    if _ONE + _TINY > _ONE:
        return "upward"
    if -_ONE - _TINY < -_ONE:
        return "downward"
    return "towards zero" if _ONE - _TINY < _ONE else "to nearest"


KINDS: Mapping[str, Callable[..., ForeignCode]] = MappingProxyType({"python": PythonFunction, "library": Library})


class WorkerChannel:
    """The worker's end of the conversation."""

    def __init__(self) -> None:
        self._requests, self._replies = os.dup(0), os.dup(1)
        nothing, end = os.pipe()  # as the null device, which may be missing, it has nothing to read
        os.close(end)
        os.dup2(nothing, 0)
        os.dup2(2, 1)
        os.close(nothing)
        sys.stdout = open(1, "w", buffering=1, encoding="utf-8", errors="replace", closefd=False)  # noqa: SIM115
        self._mark = 0
        self._room = bytes_at(0, frames.LARGEST * 8 * len(TILTED_WAY_COLUMNS) + 56).data

    def request(self, count: int) -> tuple[bytes, Call, int, Rows] | None:
        """The next question: its kind, the call, the repetitions, and the rows; None at the end of input.

        The rows' address modulo 64 varies with `count`.
        """
        head = bytearray(frames.REQUEST.size)
        if not self._fill(memoryview(head)):
            return None
        asked, call, columns, n, repeat, self._mark = frames.REQUEST.unpack(head)
        shift = 8 * (count % 8)
        body = self._room[shift : shift + n * 8 * columns]
        if not self._fill(body):
            return None
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
    line = WorkerChannel()
    count, kind, *rest = words
    try:
        subject = KINDS[kind](*rest)
    except LoadError as error:
        line.reply(frames.ERROR, _sentence(str(error)))
        return
    line.reply(frames.READY, f"{' '.join(subject.entries)}\n{subject.description}".encode())
    serve(line, subject, int(count))


def serve(line: WorkerChannel, subject: ForeignCode, count: int) -> None:
    """Answer requests until the input ends."""
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
