"""Foreign code in the worker, behind one interface: a Python function, or a shared library with a C ABI.

A Python function is `function(rows)`: C-contiguous float64 (n, 7) → n integers. A library exports

void hypcheck_classify(size_t n, const double *rows, int8_t *positions);

and optionally

const char *hypcheck_describe(void);
void hypcheck_classify_scene(const double sizes[4], size_t n, const double *x, const double *y, const double *z,
                             int8_t *positions);

If the description has "tilt": true, rows are (n, 10), and the functions of a library are

void hypcheck_classify_tilted(size_t n, const double *rows10, int8_t *positions);
void hypcheck_classify_tilted_scene(const double sizes[4], const double axis[3], size_t n, const double *x,
                                    const double *y, const double *z, int8_t *positions);    (optional)

If the question is "passage", rows are (n, 10), with "tilt" (n, 13), and the functions of a library are

void hypcheck_passage(size_t n, const double *rows, int8_t *hits, double *times);
void hypcheck_passage_tilted(size_t n, const double *rows13, int8_t *hits, double *times);

With "times": true the function of Python returns hits and times; without, `times` is a null pointer.
"""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import json
import os
import sys
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.rows import PAIRS, Floats, Rows
from hypcheck.implementations.frames import CALLS, ENTRIES, UNWRITTEN, Call, GivenAnswers, IntegerAnswers, entry_name
from hypcheck.implementations.guarded import GuardedMemory
from hypcheck.implementations.leftovers import ContractError
from hypcheck.implementations.spec import is_file
from hypcheck.messages import counted

try:
    from hypcheck.implementations import _calls
except ImportError:  # not compiled: ctypes makes the calls
    _calls = None  # type: ignore[assignment]


class LoadError(Exception):
    """Foreign code that cannot be loaded; the text is a sentence about it."""


class ForeignCode(Protocol):
    """Foreign code that can be asked. Calls raise ContractError, or whatever foreign code raises."""

    description: str
    """JSON; empty if it has no description."""

    entries: tuple[str, ...]
    """Those of frames.ENTRIES that a library exports."""

    def classify(self, rows: Rows, call: Call) -> GivenAnswers:
        """Answers to rows, by that call."""
        ...

    def classify_scene(self, rows: Rows) -> IntegerAnswers:
        """Answers to rows with the same sizes and axis, by the entry for many centres."""
        ...

    def seconds(self, rows: Rows, repeat: int, call: Call, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        ...

    def seconds_each(self, rows: Rows, repeat: int, call: Call) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers.

        For a library, no rows mean a call that does nothing.
        """
        ...


def description_as_json(description: object) -> str:
    """A module's description as JSON; raises LoadError."""
    try:
        return json.dumps(dict(description) if isinstance(description, Mapping) else description)
    except (TypeError, ValueError, RecursionError):
        raise LoadError(
            "its description holds a value that JSON cannot express; it must be a mapping of texts and numbers"
        ) from None


_INT64 = np.iinfo(np.int64)

_OURS = os.path.dirname(os.path.dirname(__file__)) + os.sep
_INSTALLED = os.path.dirname(os.path.dirname(np.__file__)) + os.sep
_NOT_UNDER_TEST = ("<frozen", os.path.dirname(os.__file__) + os.sep)
"""The folders of lines of a traceback: this package, installed packages, Python itself."""


class PythonFunction:
    """A function of a file or a module; the module's attribute `hypcheck` may be its description. Raises LoadError."""

    entries: tuple[str, ...] = ()

    def __init__(self, target: str, name: str) -> None:
        try:
            module = _of_file(target) if is_file(target) else _of_name(target)
        except LoadError:
            raise
        except BaseException as error:  # noqa: BLE001 - foreign code raises anything, SystemExit too
            traceback.print_exc()
            raise LoadError(f"importing {target!r} {error_text(error)}") from None
        function = getattr(module, name, None)
        if not callable(function):
            has = "nothing with that name" if function is None else f"a {type(function).__name__}"
            raise LoadError(f"{target!r} has no function {name!r}; it has {has}")
        self._function: Callable[[Rows], Any] = function
        found = getattr(module, "hypcheck", None)  # a module after `import hypcheck`
        self.description = "" if found is None or isinstance(found, ModuleType) else description_as_json(found)

    def classify(self, rows: Rows, call: Call) -> GivenAnswers:
        """Answers to rows; raises ContractError if the function returns no array of n integers, or no times beside."""
        return _given(self._function(rows), len(rows), call)

    def classify_scene(self, rows: Rows) -> IntegerAnswers:
        """Raises ContractError, because a Python function has no entry for scenes."""
        raise ContractError(f"a Python function has no entry for scenes, and was asked for one with {len(rows)} rows")

    def seconds(self, rows: Rows, repeat: int, call: Call, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        if by_scene:
            self.classify_scene(rows)
        function, result = self._function, None
        start = time.perf_counter_ns()
        for _ in range(repeat):
            result = function(rows)
        took = time.perf_counter_ns() - start
        return took, int(_given(result, len(rows), call).integers.sum(dtype=np.int64))

    def seconds_each(self, rows: Rows, repeat: int, call: Call) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers."""
        function, parts = self._function, [rows[place : place + 1] for place in range(len(rows))]
        results: list[Any] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            results = [function(part) for part in parts]
        took = time.perf_counter_ns() - start
        return took, sum(int(_given(result, 1, call).integers[0]) for result in results)


def error_text(error: BaseException) -> str:
    """The exception and its line, as the end of a sentence."""
    text = traceback.format_exception_only(type(error), error)[-1].strip()
    if isinstance(error, SyntaxError):
        return f"raised {text} ({os.path.basename(error.filename or '?')}, line {error.lineno})"
    files = [(each.filename, each.lineno) for each in traceback.extract_tb(error.__traceback__)]
    foreign = [
        (file, line) for file, line in files if not file.startswith(_NOT_UNDER_TEST) or file.startswith(_INSTALLED)
    ]
    foreign = [(file, line) for file, line in foreign if not file.startswith(_OURS)]
    # The last line of the code under test, not of packages that it calls: a line of numpy would not help.
    written = [each for each in foreign if not each[0].startswith(_INSTALLED)] or foreign[:1]
    return f"raised {text}" + (f" ({os.path.basename(written[-1][0])}, line {written[-1][1]})" if written else "")


def _of_name(name: str) -> ModuleType:
    sys.path.insert(0, os.getcwd())
    return importlib.import_module(name)


def _of_file(path: str) -> ModuleType:
    """The file as a module, with its folder first on the path, as when Python runs it as a script."""
    if not os.path.isfile(path):
        raise LoadError(f"there is no file {path!r}")
    path = os.path.abspath(path)
    sys.path.insert(0, os.path.dirname(path))
    name = os.path.basename(path).removesuffix(".py")
    if name in sys.modules:
        name = f"_under_test_{name}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError("it is not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _given(result: object, n: int, call: Call) -> GivenAnswers:
    if not call.times:
        return GivenAnswers(_integers(result, n))
    if not isinstance(result, (tuple, list)) or len(result) != 2:
        raise ContractError(f"it returned {_kind(result)}; with times it must return two arrays, hits and times")
    hits, times = result
    return GivenAnswers(_integers(hits, n), _times(times, n))


def _times(result: object, n: int) -> Floats:
    try:
        array = np.asarray(result)
    except ValueError:  # of several lengths
        array = np.empty(0, dtype=np.object_)
    if array.shape != (n,) or array.dtype.kind not in "iuf":
        shown = f"{_kind(result)} of shape {array.shape} and of {array.dtype}"
        raise ContractError(f"it returned as times {shown} for {n} rows; it must be ({n},) of float64")
    return array.astype(np.float64)


def _integers(result: object, n: int) -> IntegerAnswers:
    if isinstance(result, np.ma.MaskedArray) and np.any(result.mask):
        raise ContractError("it returned a masked array with masked answers; it must answer every row")
    try:
        array = np.asarray(result)
    except ValueError:  # of several lengths, or an array that numpy cannot take
        raise ContractError(f"it returned {_kind(result)} that is no array of one integer a row") from None
    if array.shape != (n,):
        raise ContractError(f"it returned {_kind(result)} of shape {array.shape} for {n} rows; it must be ({n},)")
    if array.dtype.kind not in "iub":
        raise ContractError(f"it returned {_kind(result)} of {array.dtype}; it must be integers, such as int8")
    if array.dtype == np.int8:
        return array
    if array.dtype.kind == "u":
        array = np.minimum(array, np.uint64(_INT64.max))
    wide = array.astype(np.int64)
    return wide.astype(np.int8) if ((wide >= -128) & (wide <= 127)).all() else wide


def _kind(result: object) -> str:
    return "an array" if isinstance(result, np.ndarray) else f"a {type(result).__name__}"


_FENCE = 64
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

    def classify(self, rows: Rows, call: Call) -> GivenAnswers:
        """Answers to rows; raises ContractError if it writes outside the memory for answers and times."""
        room = _AnswerRoom(self._memory, rows, call)
        self._entry(rows, call)(len(rows), rows.ctypes.data, *room.words)
        return room.written()

    def classify_scene(self, rows: Rows) -> IntegerAnswers:
        """Answers to rows that share sizes and axis; raises ContractError if it writes outside the positions."""
        room = _AnswerRoom(self._memory, rows)
        parts = self._memory.scene(rows)
        self._entry(rows, scene=True)(*_scene_words(parts, len(rows)), *room.words)
        return room.written().integers

    def seconds(self, rows: Rows, repeat: int, call: Call, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        room, n = _AnswerRoom(self._memory, rows, call), len(rows)
        if by_scene:
            parts = self._memory.scene(rows)  # kept alive, because the pointers do not do that
            words: tuple[int | None, ...] = (*_scene_words(parts, n), *room.words)
        else:
            words = (n, rows.ctypes.data, *room.words)
        function = self._entry(rows, call, scene=by_scene)
        start = time.perf_counter_ns()
        for _ in range(repeat):
            function(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    def seconds_each(self, rows: Rows, repeat: int, call: Call) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers.

        A compiled loop makes the calls if there is one, else ctypes. No rows mean a call that does nothing: of a
        function of ours, or with ctypes of this library without rows.
        """
        room, n = _AnswerRoom(self._memory, rows, call), len(rows)
        if _calls is None or call.layout is not PAIRS:  # it calls functions of three arguments
            return self._seconds_by_ctypes(rows, repeat, call, room)
        address = ctypes.cast(self._entry(rows), ctypes.c_void_p).value or 0 if n else 0
        words = (address, rows.ctypes.data, rows.shape[1], room.answers.ctypes.data, max(1, n), repeat)
        start = time.perf_counter_ns()
        _calls.each(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    def _seconds_by_ctypes(self, rows: Rows, repeat: int, call: Call, room: _AnswerRoom) -> tuple[int, int]:
        function, begin, n = self._entry(rows, call), rows.ctypes.data, len(rows)
        calls = [(1, begin + 8 * rows.shape[1] * place, *room.words_at(place)) for place in range(n)]
        calls = calls or [(0, begin, *room.words)]
        start = time.perf_counter_ns()
        for _ in range(repeat):
            for words in calls:
                function(*words)
        took = time.perf_counter_ns() - start
        return took, room.total()

    def _entry(self, rows: Rows, call: Call = CALLS[0], *, scene: bool = False) -> Any:  # noqa: ANN401 - ctypes' own is private
        return self._entries[entry_name(call.entry, tilt=call.layout.lean(rows), scene=scene)]


def _scene_words(parts: Sequence[NDArray[np.float64]], n: int) -> tuple[int, ...]:
    """The addresses of the parts of a scene, and n before those of x, y, z."""
    *fixed, x, y, z = (part.ctypes.data for part in parts)
    return (*fixed, n, x, y, z)


class _Memory:
    """The guarded memory of a library's arguments, each with another address modulo 64."""

    def __init__(self) -> None:
        self.answers, self.times = GuardedMemory("the answers", 1), GuardedMemory("the times", 2)
        parts = ("the sizes", "the axis", "the x", "the y", "the z")
        self._parts = {name: GuardedMemory(name, 3 + 3 * place) for place, name in enumerate(parts)}

    def scene(self, rows: Rows) -> Sequence[NDArray[np.float64]]:
        """Sizes, the axis of rows of ten, x, y, z, which nothing can be written to."""
        x, y, z = rows[:, 4:7].T
        given = {"the sizes": rows[0, :4], "the axis": rows[0, 7:], "the x": x, "the y": y, "the z": z}
        if not PAIRS.lean(rows):
            del given["the axis"]
        return [self._placed(self._parts[name], part) for name, part in given.items()]

    @staticmethod
    def _placed(memory: GuardedMemory, part: NDArray[np.float64]) -> NDArray[np.float64]:
        place = memory.place(8 * part.size)
        placed = memory.bytes[place].view(np.float64)
        placed[...] = part
        memory.read_only()
        return placed


class _AnswerRoom:
    """Memory for answers, and for times if a call gives them, between fences.

    `words` are the arguments of the call behind the rows.
    """

    def __init__(self, memory: _Memory, rows: Rows, call: Call = CALLS[0]) -> None:
        self._call = call
        self._answers = _Fenced(memory.answers, len(rows), np.dtype(np.int8))
        self._times = _Fenced(memory.times, len(rows), np.dtype(np.float64)) if call.times else None
        self.words = self.words_at(0)

    def words_at(self, place: int) -> tuple[int | None, ...]:
        """The arguments for the row at that place."""
        answers = self._answers.address + place
        if self._call.layout is PAIRS:
            return (answers,)
        return answers, None if self._times is None else self._times.address + 8 * place

    @property
    def answers(self) -> NDArray[np.int8]:
        """The memory for the answers."""
        answers: NDArray[np.int8] = self._answers.values
        return answers

    def written(self) -> GivenAnswers:
        """What was written; raises ContractError if anything was written outside."""
        self._answers.check("position" if self._call.layout is PAIRS else "hit")
        if self._times is not None:
            self._times.check("time")
        return GivenAnswers(self.answers, None if self._times is None else self._times.values)

    def total(self) -> int:
        """The sum of the answers that were written; raises ContractError as written does."""
        return int(self.written().integers.sum(dtype=np.int64))


class _Fenced:
    """Memory for n values of that type; what is beside them is a fence, or a guard page."""

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
    if not _has(library, "hypcheck_describe"):
        return ""
    library.hypcheck_describe.argtypes, library.hypcheck_describe.restype = (), ctypes.c_char_p
    description: bytes | None = library.hypcheck_describe()
    if description is None:
        raise LoadError(f"{path!r}: hypcheck_describe returned a null pointer; it must be a JSON text")
    text = description.decode("utf-8", "replace")
    return text if text.strip() else json.dumps("")
