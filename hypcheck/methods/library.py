"""A shared library under test, by its C ABI. Runs in the worker.

void hypcheck_classify(size_t n, const double *rows, int8_t *positions);

and optionally

const char *hypcheck_describe(void);
void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions);
"""

from __future__ import annotations

import ctypes
import json
import os
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hypcheck.kernel.choice import compiled
from hypcheck.methods.frames import UNWRITTEN
from hypcheck.methods.subject import Answers, ContractError, LoadError, room_at
from hypcheck.rows import Rows
from hypcheck.visible import counted

_FENCE = 64
_HINTS = (
    (("wrong ELF class", "architecture"), "it is built for another machine"),
    (("invalid ELF header", "file too short", "not a mach-o", "slice is not valid"), "it is not a shared library"),
    (("undefined symbol", "symbol not found"), "it needs a symbol that no library it names has"),
)


class Library:
    """A library and its entries. Raises LoadError."""

    def __init__(self, path: str) -> None:
        library = _loaded(path)
        if not _has(library, "hypcheck_classify"):
            raise LoadError(
                f"{path!r} has no symbol hypcheck_classify; it must export "
                'void hypcheck_classify(size_t n, const double *rows, int8_t *positions), in C++ as extern "C"'
            )
        self._classify = _entry(library.hypcheck_classify, (ctypes.c_size_t, *[ctypes.c_void_p] * 2))
        self._address = ctypes.cast(library.hypcheck_classify, ctypes.c_void_p).value
        self.scene = _has(library, "hypcheck_classify_scene")
        if self.scene:
            pointers = [ctypes.c_void_p] * 4
            self._classify_scene = _entry(
                library.hypcheck_classify_scene, (ctypes.c_void_p, ctypes.c_size_t, *pointers)
            )
        self.description = _description(library, path)

    def classify(self, rows: Rows) -> Answers:
        """Answers to rows; raises ContractError where it writes beside them."""
        positions = _Positions(rows)
        self._classify(len(rows), rows.ctypes.data, positions.address)
        return positions.written()

    def classify_scene(self, rows: Rows) -> Answers:
        """Answers to rows that share their sizes; raises ContractError where it writes beside them."""
        positions = _Positions(rows)
        parts = _scene(rows)
        sizes, *centers = (part.ctypes.data for part in parts)
        self._classify_scene(sizes, len(rows), *centers, positions.address)
        return positions.written()

    def seconds(self, rows: Rows, repeat: int, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        positions, n = _Positions(rows), len(rows)
        if by_scene:
            parts = _scene(rows)  # held, since the pointers do not hold it
            sizes, *centers = (part.ctypes.data for part in parts)
            function, words = self._classify_scene, (sizes, n, *centers, positions.address)
        else:
            function, words = self._classify, (n, rows.ctypes.data, positions.address)
        start = time.perf_counter_ns()
        for _ in range(repeat):
            function(*words)
        took = time.perf_counter_ns() - start
        return took, int(positions.written().sum(dtype=np.int64))

    def seconds_each(self, rows: Rows, repeat: int) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers.

        The calls are made by the compiled kernel where there is one. No rows stand for a call that does nothing: of a
        function of ours, or, where calls are made by ctypes, of this library about no rows.
        """
        positions = _Positions(rows)
        try:
            call_each = compiled().call_each
        except (ImportError, AttributeError):  # not built at install, or built before there was a call_each
            return self._seconds_by_ctypes(rows, repeat, positions)
        address = self._address if len(rows) else 0
        asked, answers = (rows, positions.room) if len(rows) else (np.zeros((1, 7)), np.zeros(1, dtype=np.int8))
        start = time.perf_counter_ns()
        call_each(address, asked, answers, repeat)
        took = time.perf_counter_ns() - start
        return took, int(positions.written().sum(dtype=np.int64))

    def _seconds_by_ctypes(self, rows: Rows, repeat: int, positions: _Positions) -> tuple[int, int]:
        function, begin, room, n = self._classify, rows.ctypes.data, positions.address, len(rows)
        calls = [(1, begin + 56 * place, room + place) for place in range(n)] or [(0, begin, room)]
        start = time.perf_counter_ns()
        for _ in range(repeat):
            for words in calls:
                function(*words)
        took = time.perf_counter_ns() - start
        return took, int(positions.written().sum(dtype=np.int64))


def _scene(rows: Rows) -> Sequence[NDArray[np.float64]]:
    """Sizes, x, y, z, each at an address of its own modulo 64, all of them others when the rows' is another."""
    parts = []
    for index, part in enumerate((rows[0, :4], *rows[:, 4:].T)):
        placed = room_at(rows.ctypes.data + 24 * index, part.size * 8).view(np.float64)
        placed[...] = part
        parts.append(placed)
    return parts


class _Positions:
    """Room for answers between two fences; its address modulo 64 is another when the rows' is."""

    def __init__(self, rows: Rows) -> None:
        self._n = len(rows)
        self._room = room_at(rows.ctypes.data // 8 * 5, self._n + 2 * _FENCE).view(np.int8)
        self._room.fill(UNWRITTEN)
        self.address = self._room.ctypes.data + _FENCE

    @property
    def room(self) -> NDArray[np.int8]:
        """Where the answers go."""
        return self._room[_FENCE:-_FENCE]

    def written(self) -> NDArray[np.int8]:
        if (self._room[:_FENCE] != UNWRITTEN).any() or (self._room[-_FENCE:] != UNWRITTEN).any():
            raise ContractError(f"it wrote outside of the {counted(self._n, 'position')} that it was given")
        return self.room


def _loaded(path: str) -> ctypes.CDLL:
    if not os.path.exists(path):
        raise LoadError(f"there is no file {path!r}")
    try:
        return ctypes.CDLL(os.path.abspath(path))  # with a bare name the loader would search elsewhere
    except (OSError, UnicodeDecodeError) as error:  # the latter where the loader names a path that is no UTF-8
        said = os.fsdecode(error.object) if isinstance(error, UnicodeDecodeError) else str(error)
        hints = [hint for signs, hint in _HINTS if any(sign in said for sign in signs)]
        raise LoadError(f"{path!r} cannot be loaded: {'; '.join([*hints[:1], said])}") from None


def _entry(function: Any, arguments: Sequence[Any]) -> Callable[..., None]:  # noqa: ANN401 - ctypes' own is private
    function.argtypes, function.restype = arguments, None
    entry: Callable[..., None] = function
    return entry


def _has(library: ctypes.CDLL, name: str) -> bool:
    """Whether it exports this. What the loader says where it does not names the path, which may be no UTF-8."""
    try:
        return hasattr(library, name)
    except UnicodeDecodeError:
        return False


def _description(library: ctypes.CDLL, path: str) -> str:
    if not _has(library, "hypcheck_describe"):
        return ""
    library.hypcheck_describe.argtypes, library.hypcheck_describe.restype = (), ctypes.c_char_p
    said: bytes | None = library.hypcheck_describe()
    if said is None:
        raise LoadError(f"{path!r}: hypcheck_describe returned a null pointer; it must be a JSON text")
    text = said.decode("utf-8", "replace")
    return text if text.strip() else json.dumps("")
