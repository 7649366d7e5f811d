"""What is attacked: each kernel at each instruction set, asked for rows and for scenes."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

from hypcheck.kernel import numpy_path
from hypcheck.kernel.choice import LEVELS, compiled


@dataclass(frozen=True)
class Subject:
    """`rows(rows)` and `scene(sizes, x, y, z)` answer positions."""

    name: str
    rows: Callable
    scene: Callable


def of_library(path: Path, name: str, level: str | None = None) -> Subject | None:
    """A shared library that was compiled from hypcheck.h; None where it does not have the level."""
    library = ctypes.CDLL(str(path))

    def chosen() -> bool:
        return level is None or bool(library.hypcheck_use_level(level.encode()))

    def pointer(array: np.ndarray) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    def rows(values: np.ndarray) -> np.ndarray:
        assert chosen()
        values, answers = np.ascontiguousarray(values), np.full(len(values), 99, np.int8)
        library.hypcheck_classify(ctypes.c_size_t(len(values)), pointer(values), pointer(answers))
        return answers

    def scene(sizes: tuple[float, ...], *columns: np.ndarray) -> np.ndarray:
        assert chosen()
        answers, four = np.full(len(columns[0]), 99, np.int8), np.array(sizes)
        pointers = [pointer(column) for column in columns]
        library.hypcheck_classify_scene(pointer(four), ctypes.c_size_t(len(answers)), *pointers, pointer(answers))
        return answers

    return Subject(name, rows, scene) if chosen() else None


def _numpy_scene(sizes: tuple[float, ...], *columns: np.ndarray) -> np.ndarray:
    with patch.object(numpy_path, "LINES_FROM", 1):  # its lines are attacked in small scenes too
        return numpy_path.positions_of_scene(sizes, *columns)


def subjects() -> list[Subject]:
    """The compiled kernel at every level of this machine, and numpy."""
    found = [Subject("numpy", numpy_path.positions, _numpy_scene)]
    try:
        path = Path(str(compiled().__file__))
    except ImportError:
        return found
    libraries = (of_library(path, level, level) for level in LEVELS)
    return found + [subject for subject in libraries if subject is not None]
