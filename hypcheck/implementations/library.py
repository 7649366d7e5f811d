"""A shared library with a C ABI, in the worker: its entries, and the guarded memory that they are given.

foreign.py lists the functions that a library exports. Its arguments are in memory between two pages that cannot be read
or written. Arrays are placed in turn at the one end of this memory and at the other, so that a library that reaches one
byte too far, before or behind, ends there. Arrays for reading are read-only. On a system without mprotect the memory is
ordinary.
"""

from __future__ import annotations

import ctypes
import json
import mmap
import os
import sys
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import PAIRS, Rows
from hypcheck.implementations.foreign import ContractError, LoadError
from hypcheck.implementations.frames import ENTRIES, UNWRITTEN, CallForm, GivenAnswers
from hypcheck.messages import counted

try:
    from hypcheck.implementations import _calls
except ImportError:  # not compiled: ctypes makes the calls, and a fault is not named
    _calls = None  # type: ignore[assignment]

_FENCE = 64
"""How many bytes on each side of an array are checked for writes."""

_HINTS = (
    (("wrong ELF class", "architecture"), "it is built for another machine"),
    (("invalid ELF header", "file too short", "not a mach-o", "slice is not valid"), "it is not a shared library"),
    (("undefined symbol", "symbol not found"), "it needs a symbol that no library it names has"),
)


class Library:
    """A library and its entries; each call has one for rows with an axis and one for others. Raises LoadError."""

    def __init__(self, path: str) -> None:
        library = _loaded(path)
        self._entries = {name: _entry(getattr(library, name), name) for name in ENTRIES if _has(library, name)}
        self.entries = tuple(self._entries)
        self.description = _description(library, path)
        self._memory = _Memory()

    def classify(self, rows: Rows, call: CallForm) -> GivenAnswers:
        """Return answers to rows; raises ContractError if it writes outside the memory for answers and times."""
        room = _AnswerRoom(self._memory, rows, call)
        self._entry(rows, call)(*self._words(rows, call, room))
        return room.written()

    def time(self, rows: Rows, repeat: int, call: CallForm, *, row_by_row: bool) -> tuple[int, int]:
        """Return the nanoseconds of `repeat` times the rows, and the sum of the last answers.

        All rows are in one call, or with `row_by_row` each in its own.
        """
        if row_by_row:
            return self._time_each(rows, repeat, call)
        room = _AnswerRoom(self._memory, rows, call)
        function, words = self._entry(rows, call), self._words(rows, call, room)
        start = time.perf_counter_ns()
        for _ in range(repeat):
            function(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    def _words(self, rows: Rows, call: CallForm, room: _AnswerRoom) -> tuple[int | None, ...]:
        """Return the arguments of a call."""
        if not call.scene:
            return len(rows), *self._width(rows, call), rows.ctypes.data, *room.words
        *fixed, x, y, z = self._memory.scene(rows)
        return *fixed, len(rows), x, y, z, *room.words

    def _time_each(self, rows: Rows, repeat: int, call: CallForm) -> tuple[int, int]:
        """Return nanoseconds of `repeat` times a call for each row, and the sum of the last answers.

        A compiled loop makes the calls if there is one, else ctypes. No rows mean a call that does nothing: of
        an empty function of hypcheck, or with ctypes of this library without rows.
        """
        room, n = _AnswerRoom(self._memory, rows, call), len(rows)
        if _calls is None or call.layout.has_end or call.columns:  # it calls functions of three arguments
            return self._time_by_ctypes(rows, repeat, call, room)
        address = ctypes.cast(self._entry(rows, call), ctypes.c_void_p).value or 0 if n else 0
        words = (address, rows.ctypes.data, rows.shape[1], room.answers.ctypes.data, max(1, n), repeat)
        start = time.perf_counter_ns()
        _calls.each(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    def _time_by_ctypes(self, rows: Rows, repeat: int, call: CallForm, room: _AnswerRoom) -> tuple[int, int]:
        """Return nanoseconds and sum as _time_each does, with a call by ctypes for each row."""
        function, begin, n = self._entry(rows, call), rows.ctypes.data, len(rows)
        width = self._width(rows, call)
        calls = [(1, *width, begin + 8 * rows.shape[1] * place, *room.words_at(place)) for place in range(n)]
        calls = calls or [(0, *width, begin, *room.words)]
        start = time.perf_counter_ns()
        for _ in range(repeat):
            for words in calls:
                function(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    @staticmethod
    def _width(rows: Rows, call: CallForm) -> tuple[int, ...]:
        """Return the argument that says how many numbers a row has, of an entry for rows of any width."""
        return (rows.shape[1],) if call.columns else ()

    def _entry(self, rows: Rows, call: CallForm) -> Any:  # noqa: ANN401 - ctypes' own is private
        """Return the function for this call and these rows."""
        return self._entries[call.entry_name(tilt=call.layout.has_axis(rows))]


_PAGE = mmap.PAGESIZE
_NONE, _READ, _WRITE = 0, 1, 2
"""PROT_NONE, PROT_READ, PROT_WRITE of sys/mman.h, the same on Linux and macOS."""


def _libc() -> ctypes.CDLL | None:
    """Return the C library, for mprotect; None on Windows."""
    if sys.platform == "win32":
        return None
    libc = ctypes.CDLL(None, use_errno=True)
    libc.mprotect.argtypes = (ctypes.c_void_p, ctypes.c_size_t, ctypes.c_int)
    return libc


class GuardedMemory:
    """Room for one array, which grows as it is needed. `what` names it in a message, such as "the rows".

    `turn` counts the places. It may begin with any number, so that two processes begin at different addresses.
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
        """Make room for at least so many bytes, between two guard pages."""
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
        """Return the place in `bytes` of an array of `size` bytes, which may be written.

        Its beginning varies by multiples of `step`.

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
        """Set how the memory may be used."""
        if self._libc is not None and self._size:
            self._libc.mprotect(self.bytes.ctypes.data, self._size, how)


class _Memory:
    """The guarded memory of a library's arguments, each with another address modulo 64."""

    def __init__(self) -> None:
        self.answers, self.times = GuardedMemory("the answers", 1), GuardedMemory("the times", 2)
        parts = ("the sizes", "the axis", "the x", "the y", "the z")
        self._parts = {name: GuardedMemory(name, 3 + 3 * place) for place, name in enumerate(parts)}

    def scene(self, rows: Rows) -> list[int]:
        """Return the addresses of sizes, the axis of rows of ten, x, y, z, which nothing can be written to."""
        x, y, z = rows[:, 4:7].T
        arguments = {"the sizes": rows[0, :4], "the axis": rows[0, 7:], "the x": x, "the y": y, "the z": z}
        if not PAIRS.has_axis(rows):
            del arguments["the axis"]
        return [self._placed(self._parts[name], part) for name, part in arguments.items()]

    @staticmethod
    def _placed(memory: GuardedMemory, part: NDArray[np.float64]) -> int:
        """Copy numbers into the memory, make it read-only, and return its address."""
        place = memory.place(8 * part.size)  # which may replace the bytes
        placed = memory.bytes[place].view(np.float64)
        placed[...] = part
        memory.read_only()
        return placed.ctypes.data


class _AnswerRoom:
    """Memory for answers, and for times if a call gives them, between fences.

    `words` are the arguments of the call behind the rows.
    """

    def __init__(self, memory: _Memory, rows: Rows, call: CallForm) -> None:
        self._call = call
        self._answers = _Fenced(memory.answers, len(rows), np.dtype(np.int8))
        self._times = _Fenced(memory.times, len(rows), np.dtype(np.float64)) if call.times else None
        self.words = self.words_at(0)

    def words_at(self, place: int) -> tuple[int | None, ...]:
        """Return the arguments for the row at that place."""
        answers = self._answers.address + place
        if not self._call.layout.has_end:
            return (answers,)
        return answers, None if self._times is None else self._times.address + 8 * place

    @property
    def answers(self) -> NDArray[np.int8]:
        """The memory for the answers."""
        answers: NDArray[np.int8] = self._answers.values
        return answers

    def written(self) -> GivenAnswers:
        """Return the values that were written. Raises ContractError if anything was written outside the memory."""
        self._answers.check("hit" if self._call.layout.has_end else "position")
        if self._times is not None:
            self._times.check("time")
        return GivenAnswers(self.answers, None if self._times is None else self._times.values)

    def total(self) -> int:
        """Return the sum of the answers that were written; raises ContractError as written does."""
        return int(self.written().integers.sum(dtype=np.int64))


class _Fenced:
    """Memory for n values of that type, between fences or guard pages."""

    def __init__(self, memory: GuardedMemory, n: int, kind: np.dtype[Any]) -> None:
        self._n = n
        place = memory.place(n * kind.itemsize, kind.itemsize)
        near = memory.bytes[max(0, place.start - _FENCE) : place.stop + _FENCE].view(np.int8)
        near.fill(UNWRITTEN)
        first = min(place.start, _FENCE)
        self._before, self._after = near[:first], near[first + n * kind.itemsize :]
        self.values: NDArray[Any] = memory.bytes[place].view(kind)
        self.address = self.values.ctypes.data

    def check(self, what: str) -> None:
        """Raise ContractError if a fence was written to."""
        if (self._before != UNWRITTEN).any() or (self._after != UNWRITTEN).any():
            raise ContractError(f"it wrote outside the {counted(self._n, what)} that it was given")


def _loaded(path: str) -> ctypes.CDLL:
    """Load a library. Raises LoadError with the likely reason."""
    if not os.path.exists(path):
        raise LoadError(f"there is no file {path!r}")
    try:
        return ctypes.CDLL(os.path.abspath(path))  # with a bare name the loader would search elsewhere
    except (OSError, UnicodeDecodeError) as error:  # the latter if the loader names a path that is not UTF-8
        reason = os.fsdecode(error.object) if isinstance(error, UnicodeDecodeError) else str(error)
        hints = [hint for signs, hint in _HINTS if any(sign in reason for sign in signs)]
        raise LoadError(f"{path!r} cannot be loaded: {'; '.join([*hints[:1], reason])}") from None


_POINTER = ctypes.c_void_p
_ARGUMENTS = dict(
    zip(
        ENTRIES,
        (
            (ctypes.c_size_t, _POINTER, _POINTER),
            (ctypes.c_size_t, _POINTER, _POINTER),
            (_POINTER, ctypes.c_size_t, *[_POINTER] * 4),
            (_POINTER, _POINTER, ctypes.c_size_t, *[_POINTER] * 4),
            (ctypes.c_size_t, *[_POINTER] * 3),
            (ctypes.c_size_t, *[_POINTER] * 3),
            (ctypes.c_size_t, ctypes.c_size_t, _POINTER, _POINTER),
            (ctypes.c_size_t, ctypes.c_size_t, *[_POINTER] * 3),
        ),
        strict=True,
    )
)


def _entry(function: Any, name: str) -> Any:  # noqa: ANN401 - ctypes' own is private
    function.argtypes, function.restype = _ARGUMENTS[name], None
    return function


def _has(library: ctypes.CDLL, name: str) -> bool:
    """Whether a library exports a name. The loader's error names the path, which may not be UTF-8."""
    try:
        return hasattr(library, name)
    except UnicodeDecodeError:
        return False


def _description(library: ctypes.CDLL, path: str) -> str:
    """Return the library's description of itself, a JSON text; empty if it has none. Raises LoadError."""
    if not _has(library, "hypcheck_describe"):
        return ""
    library.hypcheck_describe.argtypes, library.hypcheck_describe.restype = (), ctypes.c_char_p
    description: bytes | None = library.hypcheck_describe()
    if description is None:
        raise LoadError(f"{path!r}: hypcheck_describe returned a null pointer; it must be a JSON text")
    text = description.decode("utf-8", "replace")
    return text if text.strip() else json.dumps("")
