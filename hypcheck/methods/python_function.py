"""A Python function under test: `function(rows)`, C-contiguous float64 (n, 7) → n integers. Runs in the worker."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
import time
import traceback
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from hypcheck.methods.spec import is_file
from hypcheck.methods.subject import Answers, ContractError, LoadError, as_json
from hypcheck.rows import Rows

_INT64 = np.iinfo(np.int64)

_OURS = os.path.dirname(os.path.dirname(__file__)) + os.sep
_INSTALLED = os.path.dirname(os.path.dirname(np.__file__)) + os.sep
_NOT_UNDER_TEST = ("<frozen", os.path.dirname(os.__file__) + os.sep)
"""Where lines of a traceback lie: this package, installed packages, Python itself."""


class PythonFunction:
    """A function of a file or a module, and the module's optional attribute `hypcheck`, a mapping. Raises LoadError."""

    scene = False

    def __init__(self, target: str, name: str) -> None:
        try:
            module = _of_file(target) if is_file(target) else _of_name(target)
        except LoadError:
            raise
        except BaseException as error:  # noqa: BLE001 - foreign code raises anything, SystemExit too
            traceback.print_exc()
            raise LoadError(f"importing {target!r} {told(error)}") from None
        function = getattr(module, name, None)
        if not callable(function):
            has = "nothing of that name" if function is None else f"a {type(function).__name__}"
            raise LoadError(f"{target!r} has no function {name!r}; it has {has}")
        self._function: Callable[[Rows], Any] = function
        said = getattr(module, "hypcheck", None)  # `import hypcheck` puts a module there
        self.description = "" if said is None or isinstance(said, ModuleType) else as_json(said)

    def classify(self, rows: Rows) -> Answers:
        """Answers to rows; raises ContractError where the function returns something else."""
        return _integers(self._function(rows), len(rows))

    def classify_scene(self, rows: Rows) -> Answers:
        """Not offered by a Python function; raises ContractError."""
        raise ContractError(f"a Python function has no entry for scenes, and was asked for one with {len(rows)} rows")

    def seconds(self, rows: Rows, repeat: int, *, by_scene: bool) -> tuple[int, int]:
        """Nanoseconds of `repeat` calls, and the sum of the answers of the last."""
        if by_scene:
            self.classify_scene(rows)
        function, result = self._function, None
        start = time.perf_counter_ns()
        for _ in range(repeat):
            result = function(rows)
        took = time.perf_counter_ns() - start
        return took, int(_integers(result, len(rows)).sum(dtype=np.int64))

    def seconds_each(self, rows: Rows, repeat: int) -> tuple[int, int]:
        """Nanoseconds of `repeat` times a call for each row, and the sum of the last answers."""
        function, parts = self._function, [rows[place : place + 1] for place in range(len(rows))]
        results: list[Any] = []
        start = time.perf_counter_ns()
        for _ in range(repeat):
            results = [function(part) for part in parts]
        took = time.perf_counter_ns() - start
        return took, sum(int(_integers(result, 1)[0]) for result in results)


def told(error: BaseException) -> str:
    """What was raised, and where, as the end of a sentence."""
    text = traceback.format_exception_only(type(error), error)[-1].strip()
    if isinstance(error, SyntaxError):
        return f"raised {text} ({os.path.basename(error.filename or '?')}, line {error.lineno})"
    files = [(each.filename, each.lineno) for each in traceback.extract_tb(error.__traceback__)]
    foreign = [
        (file, line) for file, line in files if not file.startswith(_NOT_UNDER_TEST) or file.startswith(_INSTALLED)
    ]
    foreign = [(file, line) for file, line in foreign if not file.startswith(_OURS)]
    # The last line of theirs, and not of what they call: where numpy raises, its line tells them nothing.
    written = [each for each in foreign if not each[0].startswith(_INSTALLED)] or foreign[:1]
    return f"raised {text}" + (f" ({os.path.basename(written[-1][0])}, line {written[-1][1]})" if written else "")


def _of_name(name: str) -> ModuleType:
    sys.path.insert(0, os.getcwd())
    return importlib.import_module(name)


def _of_file(path: str) -> ModuleType:
    """The file run as a module, with its folder first on the path, as when Python runs it as a script."""
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


def _integers(result: object, n: int) -> Answers:
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
