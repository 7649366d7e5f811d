"""A contender: a method, its language, how it is loaded in a measuring process, and how one loop of it is called.

How a method is called when it is timed: in a batch, one row at a time, and, of meshes, how one is built.

What is compared: a method, what it is written in, and how it is loaded in a process that measures.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.plan import scene_of
from hypcheck.bench.timing import Clocked, clocked
from hypcheck.geometry.rows import Rows
from hypcheck.implementations.description import Domain, claimed
from hypcheck.implementations.method import Answers, ByScene, Method

Answering = Callable[[Rows], Answers]


@dataclass(frozen=True)
class PreparedWork:
    """Work ready for the clock: `rows` rows each time. `answers` does it once and gives what it answered.

    `timed_by` is "process" (this one), "worker" (the one that foreign code runs in) or "time protocol" (its own clock).
    """

    rows: int
    run: Clocked
    answers: Callable[[], Answers]
    timed_by: str = "process"


@dataclass(frozen=True)
class EmptyCall:
    """A call that does nothing; methods that are called alike share the one of that name. `ready.rows` are calls."""

    name: str
    ready: PreparedWork


class LoadedMethod(Protocol):
    """One method, loaded. What cannot be done in a way is None."""

    @property
    def trouble(self) -> str:
        """Why rows went without an answer, where a program was at fault; else empty."""
        ...

    def answer(self, rows: Rows) -> Answers:
        """Its answers, to be judged."""
        ...

    def batch(self, rows: Rows) -> PreparedWork | None:
        """All rows by one call."""
        ...

    def single(self, rows: Rows) -> PreparedWork | None:
        """All rows by a call each."""
        ...

    def build(self, rows: Rows) -> PreparedWork | None:
        """What is built once before any row of this scene can be answered."""
        ...

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
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

    def batch(self, rows: Rows) -> PreparedWork:
        """One call; what is laid out for it beforehand is not timed."""
        return _prepared(len(rows), self._work(rows))

    def single(self, rows: Rows) -> PreparedWork:
        """A call a row, by the entry for rows: who asks about one has no scene at hand."""
        parts = [rows[place : place + 1] for place in range(len(rows))]
        return one_by_one(self.function, parts)

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> EmptyCall:
        """A Python function that does nothing."""
        if mode == "batch":
            return EmptyCall("Python", _prepared(1, _nothing))
        return EmptyCall("Python", one_by_one(_nothing_of, [rows[:1]] * len(rows)))

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

    def batch(self, rows: Rows) -> PreparedWork:
        """A call for each row all the same."""
        return self.single(rows)

    def single(self, rows: Rows) -> PreparedWork:
        """A call for each row, whose numbers are Python's own already."""
        queries = list(map(tuple, rows.tolist()))
        return _prepared(len(queries), lambda: _of_each(self.function, queries))

    def build(self, rows: Rows) -> None:
        """Nothing is built."""

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """A function of seven numbers that does nothing."""
        return EmptyCall("Python, with numbers", InScalars(_none_of).single(rows)) if mode == "single" else None

    def close(self) -> None:
        """Nothing is held."""


def _of_each(function: Callable[..., int], queries: list[tuple[float, ...]]) -> Answers:
    return np.array([function(*query) for query in queries], dtype=np.int8)


def _none_of(*_numbers: float) -> int:
    return 0


def one_by_one(function: Answering, parts: list[Rows]) -> PreparedWork:
    """The function on each part in turn, which is of one row."""
    found = np.empty(len(parts), dtype=np.int8)

    def work() -> Answers:
        for place, part in enumerate(parts):
            found[place] = function(part)[0]
        return found

    return _prepared(len(parts), work)


def _prepared(rows: int, work: Callable[[], Answers]) -> PreparedWork:
    return PreparedWork(rows, clocked(work), work)


_ZERO: Answers = np.zeros(1, dtype=np.int8)


def _nothing() -> Answers:
    return _ZERO


def _nothing_of(_rows: Rows) -> Answers:
    return _ZERO


@dataclass(frozen=True)
class Contender:
    """A method as it is compared.

    `name`, `title`, `question`, `precision`, `exact` and `domain` are as a Method has them. `tier` is what it is
    written in, and kin are compared inside one: "C", "numpy", "python", "FCL" or "foreign"; `kind` what it does.
    `judged` rows of a workload are asked of it at most, and `timed` rows make a timed batch, of which the first
    `singles` are asked one by one, enough that a branch predictor does not learn them. `amortised` says of a mesh
    whether it is built once for a scene or for each row. `load` makes the way to call it; it `needs` what may be absent
    here, or nothing (""). It is asked about `scenes` pairs of sizes at most, and timed on one, where that is not None.
    A `quick` run leaves those out that are too slow for it, unless they are named.
    """

    name: str
    title: str
    tier: str
    kind: str
    precision: str
    question: str
    domain: Domain
    load: Callable[[], LoadedMethod]
    exact: bool = False
    judged: int | None = None
    timed: int | None = None
    singles: int = 32
    amortised: str | None = None
    accuracy_only: bool = False
    note: str = ""
    needs: str = ""
    scenes: int | None = None
    quick: bool = True

    def asked(self, rows: Rows) -> NDArray[np.intp]:
        """The places of the rows it is asked to be right about: inside its domain, and numbers of its format."""
        if self.scenes is not None and len(np.unique(rows[:, :4], axis=0)) > self.scenes:
            return np.empty(0, dtype=np.intp)
        return claimed(rows, self.domain, self.precision)[: self.judged]


def of_method(
    method: Method,
    tier: str,
    kind: str,
    *,
    name: str = "",
    scene: ByScene | None = None,
    judged: int | None = None,
    timed: int | None = None,
    singles: int = 32,
    accuracy_only: bool = False,
    note: str = "",
) -> Contender:
    """A built-in method as a contender."""
    return Contender(
        name=name or method.name,
        title=method.title,
        tier=tier,
        kind=kind,
        precision=method.precision,
        question=method.question,
        domain=method.domain,
        load=partial(InPython, method.answer, scene),
        exact=method.exact,
        judged=judged,
        timed=timed,
        singles=singles,
        accuracy_only=accuracy_only,
        note=note,
    )
