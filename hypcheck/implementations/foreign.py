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

"takes": ["axis"] means the same as "tilt": true. With "heights" among these, the last numbers of a row are z_min,
z_max and solid: −inf, inf and 0 where the hyperboloid has no ends. A library then exports, in place of the others,

void hypcheck_classify_columns(size_t n, size_t width, const double *rows, int8_t *positions);
void hypcheck_passage_columns(size_t n, size_t width, const double *rows, int8_t *hits, double *times);

A library that exports one of these alone is called by it in any case. With "times": true the function of Python returns
hits and times; without, `times` is a null pointer.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import json
import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping
from types import ModuleType
from typing import Any, Protocol

import numpy as np

from hypcheck.geometry.rows import Floats, Rows
from hypcheck.implementations.frames import CallForm, GivenAnswers, IntegerAnswers
from hypcheck.implementations.spec import is_file


class LoadError(Exception):
    """Foreign code that cannot be loaded; the text is a sentence about it."""


class ContractError(Exception):
    """Foreign code that did not keep the contract of a call; the text is a sentence about it."""


class ForeignCode(Protocol):
    """Foreign code that answers rows. Calls raise ContractError, or the foreign code's own exceptions."""

    description: str
    """JSON; empty if it has no description."""

    entries: tuple[str, ...]
    """The functions of frames.ENTRIES that a library exports."""

    def classify(self, rows: Rows, call: CallForm) -> GivenAnswers:
        """Return answers to rows, by that call."""
        ...

    def time(self, rows: Rows, repeat: int, call: CallForm, *, row_by_row: bool) -> tuple[int, int]:
        """Return the nanoseconds of `repeat` times the rows, and the sum of the last answers.

        All rows are in one call, or with `row_by_row` each in its own. For a library, no rows with `row_by_row` mean a
        call that does nothing.
        """
        ...


def description_as_json(description: object) -> str:
    """Return a module's description as JSON; raises LoadError."""
    try:
        return json.dumps(dict(description) if isinstance(description, Mapping) else description)
    except (TypeError, ValueError, RecursionError):
        raise LoadError(
            "its description holds a value that JSON cannot express; it must be a mapping of texts and numbers"
        ) from None


_INT64 = np.iinfo(np.int64)

_OURS = os.path.dirname(os.path.dirname(__file__)) + os.sep
_INSTALLED = os.path.dirname(os.path.dirname(np.__file__)) + os.sep
_SEARCHED = frozenset(sys.path)
_NOT_UNDER_TEST = ("<frozen", os.path.dirname(os.__file__) + os.sep)
"""Beginnings of file names in a traceback: this package, installed packages, the path at the start, Python itself."""


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
        _require_one_argument(function, target, name)
        self._function: Callable[[Rows], Any] = function
        description = getattr(module, "hypcheck", None)  # a module after `import hypcheck`
        self.description = (
            "" if description is None or isinstance(description, ModuleType) else description_as_json(description)
        )

    def classify(self, rows: Rows, call: CallForm) -> GivenAnswers:
        """Return answers to rows.

        Raises ContractError if the function does not return an array of n integers, or not the times that it promises.
        """
        return _given(self._function(rows), len(rows), call)

    def time(self, rows: Rows, repeat: int, call: CallForm, *, row_by_row: bool) -> tuple[int, int]:
        """Return the nanoseconds of `repeat` times the rows, and the sum of the last answers.

        All rows are in one call, or with `row_by_row` each in its own.
        """
        function, parts = self._function, [rows]
        if row_by_row:
            parts = [rows[place : place + 1] for place in range(len(rows))]
        results: list[Any] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            results = [function(part) for part in parts]
        took = time.perf_counter_ns() - start
        answers = (_given(result, len(part), call) for result, part in zip(results, parts, strict=True))
        return took, sum(int(given.integers.sum(dtype=np.int64)) for given in answers)


def error_text(error: BaseException) -> str:
    """Return the exception and its line, as the end of a sentence."""
    text = traceback.format_exception_only(type(error), error)[-1].strip()
    if isinstance(error, ModuleNotFoundError):
        text += "".join(f"; sys.path has {folder!r}, which is not there" for folder in _missing_folders())
    if isinstance(error, SyntaxError):
        return f"raised {text} ({os.path.basename(error.filename or '?')}, line {error.lineno})"
    files = [(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__)]
    foreign = [
        (file, line) for file, line in files if not file.startswith(_NOT_UNDER_TEST) or file.startswith(_INSTALLED)
    ]
    foreign = [(file, line) for file, line in foreign if not file.startswith(_OURS)]
    # The last line of the code under test, not of packages that it calls: a line of numpy would not help.
    written = [place for place in foreign if not place[0].startswith(_INSTALLED)] or foreign[:1]
    return f"raised {text}" + (f" ({os.path.basename(written[-1][0])}, line {written[-1][1]})" if written else "")


def _missing_folders() -> Iterator[str]:
    """Yield the folders that foreign code added to the path of modules, and that cannot be listed."""
    for folder in sys.path:
        if folder not in _SEARCHED and os.path.isabs(folder):
            try:
                os.listdir(folder)
            except NotADirectoryError:
                continue
            except OSError:
                yield folder


def _of_name(name: str) -> ModuleType:
    """Import a module by its name, from the working directory first."""
    sys.path.insert(0, os.getcwd())
    return importlib.import_module(name)


def _require_one_argument(function: Callable[..., Any], target: str, name: str) -> None:
    """Raise LoadError if the function's parameters show that it cannot be called with the rows and nothing else."""
    try:
        signature = inspect.signature(function)
        parameters = ", ".join(signature.parameters)
    except BaseException:  # noqa: BLE001 - a builtin has no signature, and foreign code may raise anything
        return
    try:
        signature.bind(None)
    except TypeError:
        raise LoadError(
            f"{target!r} has {name}({parameters}), which cannot be called with one argument; it must be {name}(rows) "
            "for all rows at once, a float64 array (n, 7) unless its description asks for more columns"
        ) from None


def _of_file(path: str) -> ModuleType:
    """Return the file as a module, with its folder first on the path, as when Python runs it as a script."""
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


def _given(result: object, n: int, call: CallForm) -> GivenAnswers:
    """Return what a function returned as answers, with times if the call has them. Raises ContractError."""
    if not call.times:
        return GivenAnswers(_integers(result, n))
    if not isinstance(result, (tuple, list)) or len(result) != 2:
        raise ContractError(f"it returned {_kind(result)}; with times it must return two arrays, hits and times")
    hits, times = result
    return GivenAnswers(_integers(hits, n), _times(times, n))


def _times(result: object, n: int) -> Floats:
    """Return n times as float64. Raises ContractError for anything else."""
    try:
        array = np.asarray(result)
    except ValueError:  # of several lengths
        array = np.empty(0, dtype=np.object_)
    if array.shape != (n,) or array.dtype.kind not in "iuf":
        shown = f"{_kind(result)} of shape {array.shape} and of {array.dtype}"
        raise ContractError(f"it returned as times {shown} for {n} rows; it must be ({n},) of float64")
    return array.astype(np.float64)


def _integers(result: object, n: int) -> IntegerAnswers:
    """Return n answers as int8, or int64 if one does not fit. Raises ContractError for anything else."""
    if isinstance(result, np.ma.MaskedArray) and np.any(result.mask):
        raise ContractError("it returned a masked array with masked answers; it must answer every row")
    try:
        array = np.asarray(result)
    except ValueError:  # of several lengths, or an array that numpy cannot take
        raise ContractError(f"it returned {_kind(result)} that is not an array of one integer a row") from None
    if array.shape != (n,):
        times = '; to return times of sweeps too, its description must say "times": True'
        hint = times if isinstance(result, tuple) and array.shape == (2, n) else ""
        raise ContractError(f"it returned {_kind(result)} of shape {array.shape} for {n} rows; it must be ({n},){hint}")
    if array.dtype.kind not in "iub":
        raise ContractError(f"it returned {_kind(result)} of {array.dtype}; it must be integers, such as int8")
    if array.dtype == np.int8:
        return array
    if array.dtype.kind == "u":
        array = np.minimum(array, np.uint64(_INT64.max))
    wide = array.astype(np.int64)
    return wide.astype(np.int8) if ((wide >= -128) & (wide <= 127)).all() else wide


def _kind(result: object) -> str:
    """Return the kind of a value in words."""
    return "an array" if isinstance(result, np.ndarray) else f"a {type(result).__name__}"
