"""The subjects of an attack: each kernel at each instruction set, for rows and scenes, and the functions of a pair."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

from tests.support.inside import LEVELS, NUMBER_OF, POSITION_OF, compiled, exact_position, numpy_kernel


@dataclass(frozen=True)
class Subject:
    """`rows(rows)` and `scene(sizes, x, y, z, axis=None)` answer positions; only each `every`-th row is asked.

    In scenes every question has its own lines: a position that another question does not agree with is answered 99.
    """

    name: str
    rows: Callable
    scene: Callable
    every: int = 1


def of_library(path: Path, name: str, level: str | None = None) -> Subject | None:
    """A shared library that was compiled from hypcheck.h; None where it does not have the level."""
    library = ctypes.CDLL(str(path))

    library.hypcheck_level.restype = ctypes.c_char_p

    @contextmanager
    def chosen() -> Iterator[bool]:
        """The level, as long as it lasts: the library may be the extension that others in this process use."""
        before = library.hypcheck_level()
        try:
            yield level is None or bool(library.hypcheck_use_level(level.encode()))
        finally:
            library.hypcheck_use_level(before)

    def pointer(array: np.ndarray) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    def rows(values: np.ndarray) -> np.ndarray:
        values, answers = np.ascontiguousarray(values), np.full(len(values), 99, np.int8)
        with chosen() as there:
            assert there
            classify = library.hypcheck_classify if values.shape[1] == 7 else library.hypcheck_classify_tilted
            classify(ctypes.c_size_t(len(values)), pointer(values), pointer(answers))
        return answers

    def scene(sizes: tuple[float, ...], *columns: np.ndarray, axis: tuple[float, ...] | None = None) -> np.ndarray:
        four, count = np.array(sizes), ctypes.c_size_t(len(columns[0]))
        pointers = [pointer(column) for column in columns]

        def ask(question: str) -> np.ndarray:
            answers = np.full(len(columns[0]), 99, np.int8)
            begin, rest = (NUMBER_OF[question], pointer(four)), (count, *pointers, pointer(answers))
            if axis is None:
                library.hypcheck_ask_scene(*begin, *rest)
            else:
                library.hypcheck_ask_tilted_scene(*begin, pointer(np.array(axis)), *rest)
            return answers

        with chosen() as there:
            assert there
            return _agreed(ask)

    with chosen() as there:
        return Subject(name, rows, scene) if there else None


def _agreed(ask: Callable[[str], np.ndarray]) -> np.ndarray:
    positions = ask("position")
    wrong = np.zeros(len(positions), dtype=bool)
    for question, position in POSITION_OF.items():
        wrong |= ask(question) != (positions == position)
    positions[wrong] = 99
    return positions


def _numpy_scene(sizes: tuple[float, ...], *columns: np.ndarray, axis: tuple[float, ...] | None = None) -> np.ndarray:
    with patch.object(numpy_kernel, "LINES_FROM", 1):  # its lines are attacked in small scenes too
        return numpy_kernel.positions_of_scene(sizes, *columns, axis)


def one_by_one(position: Callable[..., int], name: str, every: int) -> Subject:
    """A function of one pair."""

    def rows(values: np.ndarray) -> np.ndarray:
        if values.shape[1] == 10:
            return np.array([position(*row[:7], axis=row[7:]) for row in values.tolist()], dtype=np.int8)
        return np.array([position(*row) for row in values.tolist()], dtype=np.int8)

    def scene(sizes: tuple[float, ...], *columns: np.ndarray, axis: tuple[float, ...] | None = None) -> np.ndarray:
        centres = zip(*(column.tolist() for column in columns), strict=True)
        leaning = {} if axis is None else {"axis": axis}
        return np.array([position(*sizes, *centre, **leaning) for centre in centres], dtype=np.int8)

    return Subject(name, rows, scene, every)


def subjects() -> list[Subject]:
    """The compiled kernel at every level of this machine, numpy, and the functions of one pair."""
    found = [
        Subject("numpy", numpy_kernel.positions, _numpy_scene),
        one_by_one(exact_position, "pair, Python", every=16),
    ]
    try:
        module = compiled()
    except ImportError:
        return found
    libraries = (of_library(Path(str(module.__file__)), level, level) for level in LEVELS)
    found += [subject for subject in libraries if subject is not None]
    return [*found, one_by_one(module.position, "pair, C", every=1)]
