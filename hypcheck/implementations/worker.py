"""The program of the worker: it loads a Python function or a shared library, and answers questions about rows.

Questions and answers use the pipes that were its standard input and output. Foreign code gets an empty standard input,
and its output goes to standard error, so that it cannot disturb the conversation.

It runs beside code that may look for answers, so that it imports nothing that could decide one: worker_session.py lists
the files that it sees. A call must leave the process as it was: rounding, floating point, signals, locale, working
directory, descriptors; and a library its arguments (library.py). libm knows the rounding mode of one unit only (on x86
the old one), so the mode of the arithmetic in use is measured too, by sums whose result depends on it.
"""

from __future__ import annotations

import ctypes
import faulthandler
import locale
import os
import signal
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from hypcheck.geometry.rows import Rows
from hypcheck.implementations import frames
from hypcheck.implementations.foreign import ContractError, ForeignCode, LoadError, PythonFunction, error_text
from hypcheck.implementations.frames import WIDTH, CallForm
from hypcheck.implementations.library import GuardedMemory, Library
from hypcheck.messages import escaped

try:
    from hypcheck.implementations import _calls
except ImportError:  # not compiled: handlers and control words are not looked at
    _calls = None  # type: ignore[assignment]

KINDS: Mapping[str, Callable[..., ForeignCode]] = MappingProxyType({"python": PythonFunction, "library": Library})


class WorkerChannel:
    """The worker's end of the conversation. Addresses of rows vary with their number, which begins with `count`."""

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

    def request(self, *, read_only: bool) -> tuple[bytes, CallForm, int, Rows] | None:
        """Return the next question: its kind, the call, the repetitions, and the rows; None at the end of input."""
        head = bytearray(frames.REQUEST.size)
        if not self._fill(memoryview(head)):
            return None
        kind, call, columns, n, repeat, self._mark = frames.REQUEST.unpack(head)
        place = self._rows.place(n * 8 * columns)
        body = self._rows.bytes[place].data
        if not self._fill(body):
            return None
        if read_only:
            self._rows.read_only()
        return kind, frames.CALLS[call], repeat, np.frombuffer(body, dtype="<f8").reshape(n, columns)

    def _fill(self, room: memoryview) -> bool:
        """Fill the room from the pipe; false if the input ended before."""
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


def _reply(subject: ForeignCode, kind: bytes, call: CallForm, repeat: int, rows: Rows) -> Reply:
    """Return the reply to a request: its kind, its body, and the bytes of an answer."""
    try:
        if kind != frames.CLASSIFY:
            times = subject.time(rows, repeat, call, row_by_row=kind == frames.TIME_EACH)
            return frames.TIMED, frames.TIMES.pack(*times), 8
        reply = subject.classify(rows, call)
        answers = np.ascontiguousarray(reply.integers)
    except ContractError as error:
        return frames.PROTOCOL, _sentence(str(error)), 1
    except BaseException as error:  # noqa: BLE001 - foreign code raises anything, SystemExit too
        traceback.print_exc()
        return frames.ERROR, _sentence(f"it {error_text(error)}"), 1
    if reply.times is not None:
        return frames.ANSWERS, answers.tobytes() + reply.times.astype("<f8", copy=False).tobytes(), answers.itemsize
    return frames.ANSWERS, answers.data.cast("B"), answers.itemsize


def _sentence(text: str) -> bytes:
    """Return a text as bytes, on one line and short."""
    return escaped(text, WIDTH).encode()


_ONE, _TINY = 1.0, 2.0**-60


def mode_in_use() -> str:
    """Return the rounding mode of float64 sums now."""
    if _ONE + _TINY > _ONE:
        return "upward"
    if -_ONE - _TINY < -_ONE:
        return "downward"
    return "towards zero" if _ONE - _TINY < _ONE else "to nearest"


def _libm() -> ctypes.CDLL | None:
    """Return the C library with the functions of the rounding mode, or None."""
    try:
        libm = ctypes.CDLL(None)
        libm.fegetround, libm.fesetround  # noqa: B018 - raises AttributeError without them
    except (OSError, TypeError, AttributeError):
        return None
    return libm


_SSE = {
    "flushing results to zero (FTZ)": 1 << 15,
    "denormals are zero (DAZ)": 1 << 6,
    "the mask of floating point exceptions": 0x3F << 7,
}
_X87 = {"the mask of the x87 unit's exceptions": 0x3F, "the precision of the x87 unit": 3 << 8}
"""The bits of the control words of x86 by their meaning; Intel's manual, volume 1, 8.1.5 and 10.2.3."""


class _State(NamedTuple):
    """The state that only libraries must restore: a Python function may open a file in its first call and keep it."""

    directory: str
    language: str
    handlers: bytes
    free: int
    streams: tuple[tuple[int, int], ...]


class Leftovers:
    """The state before a call; restore() restores it, and raises if a call changed it.

    With `whole`, for libraries, all of the state is checked; without, for Python functions, only rounding and floating
    point.
    """

    def __init__(self, *, whole: bool) -> None:
        self._libm = _libm()
        self._mode = self._by_libm()
        self._control = _calls.control() if _calls else (0, 0)
        self._state = _state() if whole else None

    def _by_libm(self) -> int:
        """Return the rounding mode that libm knows; 0 without libm."""
        return int(self._libm.fegetround()) if self._libm else 0

    def restore(self) -> None:
        """Raise ContractError about the first thing that is not as it was."""
        mode, by_libm = mode_in_use(), self._by_libm()
        control = _calls.control() if _calls else (0, 0)
        if mode != "to nearest" or by_libm != self._mode:
            self._restore_arithmetic()
            where = mode if mode != "to nearest" else "outside of the unit that computes float64"
            raise ContractError(f"it left the rounding mode changed: {where}; a call must leave it as it was")
        if control != self._control:
            self._restore_arithmetic()
            raise ContractError(f"it left changed: {_control_change(self._control, control)}; {_MUST}")
        if self._state is not None and (now := _state()) != self._state:
            before, self._state = self._state, now
            raise ContractError(f"it left changed: {', '.join(_changes(before, now))}; {_MUST}")

    def _restore_arithmetic(self) -> None:
        """Restore the rounding mode and the control words."""
        if self._libm:
            self._libm.fesetround(self._mode)
        if _calls:
            _calls.set_control(*self._control)


_MUST = "a call must leave it as it was"


def _control_change(before: tuple[int, int], now: tuple[int, int]) -> str:
    """Return what changed in the control words, in words."""
    changed = [name for name, bits in _SSE.items() if (before[0] ^ now[0]) & bits]
    changed += [name for name, bits in _X87.items() if (before[1] ^ now[1]) & bits]
    return ", ".join(changed) or "the control word of floating point"


def _state() -> _State:
    """Return the state of the process now."""
    return _State(
        os.getcwd(),
        locale.setlocale(locale.LC_ALL),
        _calls.handlers() if _calls else b"",
        _lowest_free_descriptor(),
        tuple((status.st_dev, status.st_ino) for status in map(os.fstat, range(3))),
    )


def _lowest_free_descriptor() -> int:
    """Return the number that the next opened file gets: greater if a file was left open, less if one was closed."""
    with suppress(OSError):
        number = os.dup(2)
        os.close(number)
        return number
    return -1


def _changes(before: _State, now: _State) -> Iterator[str]:
    """Yield what differs between two states, in words."""
    if before.directory != now.directory:
        yield f"the working directory, which is {now.directory!r} now"
    if before.language != now.language:
        yield f"the locale, which is {now.language!r} now"
    if before.handlers != now.handlers:
        pointers = (memoryview(content).cast("P") for content in (before.handlers, now.handlers))
        names = [_name(number) for number, (old, new) in enumerate(zip(*pointers, strict=True)) if old != new]
        yield f"the handler of {', '.join(names)}"
    if before.free != now.free:
        yield "the open descriptors"
    if before.streams != now.streams:
        yield "the files behind the standard descriptors"


def _name(number: int) -> str:
    """Return the name of a signal."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
