"""How a method is called when it is timed: in a batch, one row at a time, and, of meshes, how one is built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from hypcheck.bench.rounds import Clocked, clocked
from hypcheck.bench.workloads import scene_of
from hypcheck.methods.formula import ByScene
from hypcheck.methods.method import Answers
from hypcheck.rows import Rows

Answering = Callable[[Rows], Answers]


@dataclass(frozen=True)
class Prepared:
    """Work ready for the clock: `rows` rows each time. `answers` does it once and gives what it answered.

    `timed_by` is "process" (this one), "worker" (the one that foreign code runs in) or "time protocol" (its own clock).
    """

    rows: int
    run: Clocked
    answers: Callable[[], Answers]
    timed_by: str = "process"


@dataclass(frozen=True)
class Empty:
    """A call that does nothing; methods that are called alike share the one of that name. `ready.rows` are calls."""

    name: str
    ready: Prepared


class Way(Protocol):
    """One method, loaded. What cannot be done in a way is None."""

    @property
    def trouble(self) -> str:
        """Why rows went without an answer, where a program was at fault; else empty."""
        ...

    def answer(self, rows: Rows) -> Answers:
        """Its answers, to be judged."""
        ...

    def batch(self, rows: Rows) -> Prepared | None:
        """All rows by one call."""
        ...

    def single(self, rows: Rows) -> Prepared | None:
        """All rows by a call each."""
        ...

    def build(self, rows: Rows) -> Prepared | None:
        """What is built once before any row of this scene can be answered."""
        ...

    def empty(self, rows: Rows, mode: str) -> Empty | None:
        """The call that does nothing, in a mode; its time is taken off. None where nothing is."""
        ...

    def close(self) -> None:
        """Let go of what it holds."""
        ...


@dataclass(frozen=True)
class InPython:
    """A function of rows in this process; `scene`, where there is one, is asked about rows that share their sizes."""

    function: Answering
    scene: ByScene | None = None
    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """The function's answers."""
        return self.function(rows)

    def batch(self, rows: Rows) -> Prepared:
        """One call; what is laid out for it beforehand is not timed."""
        return _prepared(len(rows), self._work(rows))

    def single(self, rows: Rows) -> Prepared:
        """A call a row, by the entry for rows: who asks about one has no scene at hand."""
        parts = [rows[place : place + 1] for place in range(len(rows))]
        return each(self.function, parts)

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> Empty:
        """A Python function that does nothing."""
        if mode == "batch":
            return Empty("Python", _prepared(1, _nothing))
        return Empty("Python", each(_nothing_of, [rows[:1]] * len(rows)))

    def close(self) -> None:
        """Nothing is held."""

    def _work(self, rows: Rows) -> Callable[[], Answers]:
        sizes = scene_of(rows)
        if self.scene is None or sizes is None:
            return lambda: self.function(rows)
        scene = self.scene
        x, y, z = np.ascontiguousarray(rows[:, 4:].T)
        return lambda: scene(sizes, x, y, z)


@dataclass(frozen=True)
class InScalars:
    """A function of seven numbers in this process, called for each row."""

    function: Callable[..., int]
    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """The function's answers."""
        return np.array([self.function(*row) for row in rows.tolist()], dtype=np.int8)

    def batch(self, rows: Rows) -> Prepared:
        """A call for each row all the same."""
        return self.single(rows)

    def single(self, rows: Rows) -> Prepared:
        """A call for each row, whose numbers are Python's own already."""
        queries = list(map(tuple, rows.tolist()))
        return _prepared(len(queries), lambda: _of_each(self.function, queries))

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> Empty | None:
        """A function of seven numbers that does nothing."""
        return Empty("Python, with numbers", InScalars(_none_of).single(rows)) if mode == "single" else None

    def close(self) -> None:
        """Nothing is held."""


def _of_each(function: Callable[..., int], queries: list[tuple[float, ...]]) -> Answers:
    return np.array([function(*query) for query in queries], dtype=np.int8)


def _none_of(*_numbers: float) -> int:
    return 0


def each(function: Answering, parts: list[Rows]) -> Prepared:
    """The function on each part in turn, which is of one row."""
    found = np.empty(len(parts), dtype=np.int8)

    def work() -> Answers:
        for place, part in enumerate(parts):
            found[place] = function(part)[0]
        return found

    return _prepared(len(parts), work)


def _prepared(rows: int, work: Callable[[], Answers]) -> Prepared:
    return Prepared(rows, clocked(work), work)


_ZERO: Answers = np.zeros(1, dtype=np.int8)


def _nothing() -> Answers:
    return _ZERO


def _nothing_of(_rows: Rows) -> Answers:
    return _ZERO
