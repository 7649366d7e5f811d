"""A contender: a method, its language, how a measuring process loads it, and how one loop of it is called.

A method is called in a batch and one row at a time; a mesh is also built.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.workloads import scene_of
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, Layout, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import claimed
from hypcheck.implementations.meshes import height_of, rows_by_sizes
from hypcheck.implementations.method import Answers, Method, MethodClaims
from hypcheck.runs.timing import Clocked, clocked

Answering = Callable[[Rows], Answers]


@dataclass(frozen=True)
class PreparedWork:
    """Work ready to be timed: `rows` rows each time. `answers` does the work once and returns the answers.

    `timed_by` names the clock's owner: "process" (this process), "worker" (the worker of foreign code) or "time
    protocol" (the implementation's own clock).
    """

    rows: int
    run: Clocked
    answers: Callable[[], Answers]
    timed_by: str = "process"


@dataclass(frozen=True)
class EmptyCall:
    """A call that does nothing; methods with the same kind of call share its `name`. `ready.rows` are calls."""

    name: str
    ready: PreparedWork


class LoadedMethod:
    """A loaded method. A kind of call that the method does not offer is None.

    `trouble` says why rows have no answer, if a program failed; else it is empty.
    """

    trouble: str = ""

    def answer(self, rows: Rows) -> Answers:
        """The method's answers, which are judged."""
        raise NotImplementedError

    def batch(self, rows: Rows) -> PreparedWork | None:
        """All rows by one call; its arguments are prepared before the timing."""
        raise NotImplementedError

    def single(self, rows: Rows) -> PreparedWork | None:
        """All rows by one call each."""
        raise NotImplementedError

    def build(self, rows: Rows) -> PreparedWork | None:
        """The work that must be done once before any row of this scene can be answered."""

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """The empty call in a mode, whose time is subtracted; None if no time is subtracted."""

    def close(self) -> None:
        """Release the meshes or the process that it holds."""


@dataclass(frozen=True)
class InPython(LoadedMethod):
    """A function of rows in this process; rows that share their sizes go to the function `scene`, if there is one.

    If rows of ten also share their axis, `scene` gets the axis too.
    """

    function: Answering
    scene: Callable[..., Answers] | None = None

    def answer(self, rows: Rows) -> Answers:
        """The function's answers."""
        return self.function(rows)

    def batch(self, rows: Rows) -> PreparedWork:
        """A call for all rows: by the function for scenes if they share their sizes."""
        return prepared(len(rows), self._work(rows))

    def single(self, rows: Rows) -> PreparedWork:
        """A call for each row, by the entry for rows: a caller with one row has no scene."""
        parts = [rows[place : place + 1] for place in range(len(rows))]
        return one_by_one(self.function, parts)

    def empty(self, rows: Rows, mode: str) -> EmptyCall:
        """A Python function that does nothing."""
        if mode == "batch":
            return EmptyCall("Python", prepared(1, _nothing))
        return EmptyCall("Python", one_by_one(_nothing_of, [rows[:1]] * len(rows)))

    def _work(self, rows: Rows) -> Callable[[], Answers]:
        sizes = scene_of(rows)
        if self.scene is None or sizes is None:
            return lambda: self.function(rows)
        scene = self.scene
        x, y, z = np.ascontiguousarray(rows[:, 4:7].T)
        axes = [tuple(axis) for axis in rows[:1, 7:].tolist() if axis]
        return lambda: scene(sizes, x, y, z, *axes)


@dataclass(frozen=True)
class InScalars(LoadedMethod):
    """A function of seven numbers in this process, called for each row."""

    function: Callable[..., int]

    def answer(self, rows: Rows) -> Answers:
        """The function's answers."""
        return np.array([self.function(*row) for row in rows.tolist()], dtype=np.int8)

    def batch(self, rows: Rows) -> PreparedWork:
        """A call for each row, as in `single`."""
        return self.single(rows)

    def single(self, rows: Rows) -> PreparedWork:
        """A call for each row, whose numbers are Python floats already."""
        queries = list(map(tuple, rows.tolist()))
        return prepared(len(queries), lambda: np.array([self.function(*query) for query in queries], dtype=np.int8))

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """A function of seven numbers that does nothing."""
        return EmptyCall("Python, with numbers", InScalars(_none_of).single(rows)) if mode == "single" else None


def _none_of(*_numbers: float) -> int:
    return 0


def one_by_one(function: Answering, parts: list[Rows]) -> PreparedWork:
    """The function called with each part, which is one row."""
    answers = np.empty(len(parts), dtype=np.int8)

    def work() -> Answers:
        for place, part in enumerate(parts):
            answers[place] = function(part)[0]
        return answers

    return prepared(len(parts), work)


def prepared(rows: int, work: Callable[[], Answers]) -> PreparedWork:
    """Prepared work in this process that answers `rows` rows."""
    return PreparedWork(rows, clocked(work), work)


_ZERO: Answers = np.zeros(1, dtype=np.int8)


def _nothing() -> Answers:
    return _ZERO


def _nothing_of(_rows: Rows) -> Answers:
    return _ZERO


class BuiltMesh(Protocol):
    """A scene's mesh in an engine."""

    @property
    def triangles(self) -> int:
        """The number of its triangles."""
        ...

    def answers(self, rows: Rows) -> Answers:
        """The answers to rows with the mesh's sizes."""
        ...


@dataclass(frozen=True)
class InEngine(LoadedMethod):
    """An engine with meshes, each built once: `make` builds it from sizes and a height, which `high` finds for rows."""

    make: Callable[[Sizes, float], BuiltMesh]
    high: Callable[[Sizes, Rows], float] = height_of
    layout: Layout = PAIRS
    meshes: dict[tuple[Sizes, float], BuiltMesh] = field(default_factory=dict)

    def answer(self, rows: Rows) -> Answers:
        """The engine's answers, scene by scene; missing meshes are built and kept."""
        answers = np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        for sizes, places in rows_by_sizes(rows):
            answers[places] = self.mesh(sizes, rows[places]).answers(rows[places])
        return answers

    def mesh(self, sizes: Sizes, rows: Rows) -> BuiltMesh:
        """The mesh of a scene."""
        key = sizes, self.high(sizes, rows)
        if key not in self.meshes:
            self.meshes[key] = self.make(*key)
        return self.meshes[key]

    def batch(self, rows: Rows) -> PreparedWork:
        """A call for all rows, with meshes that exist."""
        work = partial(self._ready(rows), rows)
        return prepared(len(rows), work)

    def single(self, rows: Rows) -> PreparedWork:
        """A call for each row, with meshes that exist."""
        return one_by_one(self._ready(rows), [rows[place : place + 1] for place in range(len(rows))])

    def _ready(self, rows: Rows) -> Callable[[Rows], Answers]:
        sizes = scene_of(rows, self.layout)
        if sizes is not None:
            return self.mesh(sizes, rows).answers
        self.answer(rows)  # builds them
        return self.answer

    def build(self, rows: Rows) -> PreparedWork | None:
        """The work of building a scene's mesh, from vertices to the engine's tree; its answer is the triangle count."""
        sizes = scene_of(rows, self.layout)
        if sizes is None:
            return None
        known = np.array([self.mesh(sizes, rows).triangles])
        make = partial(self.make, sizes, self.high(sizes, rows))
        return PreparedWork(1, clocked(lambda: np.array([make().triangles])), lambda: known)

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """The empty call of a Python function."""
        return None if mode == "build" else InPython(self.answer).empty(rows, mode)

    def close(self) -> None:
        """Release the meshes."""
        self.meshes.clear()


@dataclass(frozen=True, kw_only=True)
class Contender(MethodClaims):
    """A method, with the settings of its comparison.

    `tier` is its language or engine: "C", "numpy", "python", "FCL" or "foreign"; `kind` is its kind of algorithm. At
    most `judged` rows of a workload are judged; in a quick run `quick_judged`, or a quarter if `judged` is small.
    `timed` rows make a timed batch. Its first `singles` rows are also timed one by one; they are enough that a branch
    predictor does not learn them. `amortised` says whether a mesh is built once for a scene or for each row. `load`
    loads the method. `scenes`, if not None, is the
    largest number of different sizes in a workload that it can take. `quick` says whether it is fast enough for a quick
    run; a quick run includes slower methods only if they are named.
    """

    tier: str
    kind: str
    load: Callable[[], LoadedMethod]
    judged: int | None = None
    timed: int | None = None
    singles: int = 32
    amortised: str | None = None
    accuracy_only: bool = False
    note: str = ""
    scenes: int | None = None
    quick: bool = True
    quick_judged: int | None = None

    def asked(self, rows: Rows) -> NDArray[np.intp]:
        """The indices of the rows that it must answer: inside its domain, with numbers of its format."""
        if self.scenes is not None and len(np.unique(rows[:, :4], axis=0)) > self.scenes:
            return np.empty(0, dtype=np.intp)
        return claimed(rows, self.domain, self.precision, layout=QUESTIONS[self.question].layout)[: self.judged]


def of_method(method: Method, tier: str, kind: str, **fields: Any) -> Contender:  # noqa: ANN401 - of a contender
    """A built-in method as a contender; `fields` replace the method's values and the defaults."""
    claims: dict[str, Any] = {claim.name: getattr(method, claim.name) for claim in dataclasses.fields(MethodClaims)}
    return Contender(tier=tier, kind=kind, **{"load": partial(in_python, method), **claims, **fields})


def in_python(method: Method) -> InPython:
    """A built-in method, loaded."""
    return InPython(method.answer, None if method.scene is None else method.scene())
