"""Methods that are loaded in a measuring process, and the work of one loop of each, ready to be timed.

A method is called in a batch and one row at a time; a mesh is also built. A method is a function in Python of rows or
of numbers, a collision engine with its meshes, or a SPEC that runs in a separate process and is timed by its own clock
if it offers one; c_library.py has methods in C.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

import numpy as np

from hypcheck.bench.workloads import scene_of
from hypcheck.geometry.pair import Sizes
from hypcheck.geometry.rows import CANNOT_SAY, PAIRS, Layout, Rows
from hypcheck.implementations.frames import LARGEST
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.meshes import height_of, rows_by_sizes
from hypcheck.implementations.method import Answers
from hypcheck.implementations.session import TimingError
from hypcheck.runs.timing import Clocked, TimingRefusedError, clocked

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
        """Return the method's answers, which are judged."""
        raise NotImplementedError

    def batch(self, rows: Rows) -> PreparedWork | None:
        """Prepare one call for all rows; its arguments are made before the timing."""
        raise NotImplementedError

    def single(self, rows: Rows) -> PreparedWork | None:
        """Prepare a call for each row."""
        raise NotImplementedError

    def build(self, rows: Rows) -> PreparedWork | None:
        """Return the work that must be done once before any row of this scene can be answered."""

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """Return the empty call in a mode, whose time is subtracted; None if no time is subtracted."""

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
        """Return the function's answers."""
        return self.function(rows)

    def batch(self, rows: Rows) -> PreparedWork:
        """Return a call for all rows: by the function for scenes if they share their sizes."""
        return prepared(len(rows), self._work(rows))

    def single(self, rows: Rows) -> PreparedWork:
        """Return a call for each row, by the entry for rows: a caller with one row has no scene."""
        parts = [rows[place : place + 1] for place in range(len(rows))]
        return one_by_one(self.function, parts)

    def empty(self, rows: Rows, mode: str) -> EmptyCall:
        """Return a Python function that does nothing."""
        if mode == "batch":
            return EmptyCall("Python", prepared(1, _nothing))
        return EmptyCall("Python", one_by_one(_nothing_of, [rows[:1]] * len(rows)))

    def _work(self, rows: Rows) -> Callable[[], Answers]:
        """Return the call for these rows; rows of one scene go to the function for scenes."""
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
        """Return the function's answers."""
        return np.array([self.function(*row) for row in rows.tolist()], dtype=np.int8)

    def batch(self, rows: Rows) -> PreparedWork:
        """Return a call for each row, as in `single`."""
        return self.single(rows)

    def single(self, rows: Rows) -> PreparedWork:
        """Return a call for each row, whose numbers are Python floats already."""
        queries = list(map(tuple, rows.tolist()))
        return prepared(len(queries), lambda: np.array([self.function(*query) for query in queries], dtype=np.int8))

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """Return a function of seven numbers that does nothing."""
        return EmptyCall("Python, with numbers", InScalars(_none_of).single(rows)) if mode == "single" else None


def _none_of(*_numbers: float) -> int:
    """Return 0: an empty function of seven numbers."""
    return 0


def one_by_one(function: Answering, parts: list[Rows]) -> PreparedWork:
    """Return the function called with each part, which is one row."""
    answers = np.empty(len(parts), dtype=np.int8)

    def work() -> Answers:
        for place, part in enumerate(parts):
            answers[place] = function(part)[0]
        return answers

    return prepared(len(parts), work)


def prepared(rows: int, work: Callable[[], Answers]) -> PreparedWork:
    """Return prepared work in this process that answers `rows` rows."""
    return PreparedWork(rows, clocked(work), work)


_ZERO: Answers = np.zeros(1, dtype=np.int8)


def _nothing() -> Answers:
    """Return no answers."""
    return _ZERO


def _nothing_of(_rows: Rows) -> Answers:
    """Return no answers: an empty function of rows."""
    return _ZERO


class BuiltMesh(Protocol):
    """A scene's mesh in an engine."""

    @property
    def triangles(self) -> int:
        """The number of its triangles."""
        ...

    def answers(self, rows: Rows) -> Answers:
        """Return the answers to rows with the mesh's sizes."""
        ...


@dataclass(frozen=True)
class InEngine(LoadedMethod):
    """An engine with meshes, each built once: `make` builds it from sizes and a height, which `high` finds for rows."""

    make: Callable[[Sizes, float], BuiltMesh]
    high: Callable[[Sizes, Rows], float] = height_of
    layout: Layout = PAIRS
    meshes: dict[tuple[Sizes, float], BuiltMesh] = field(default_factory=dict)

    def answer(self, rows: Rows) -> Answers:
        """Return the engine's answers, scene by scene; missing meshes are built and kept."""
        answers = np.full(len(rows), CANNOT_SAY, dtype=np.int8)
        for sizes, places in rows_by_sizes(rows):
            answers[places] = self.mesh(sizes, rows[places]).answers(rows[places])
        return answers

    def mesh(self, sizes: Sizes, rows: Rows) -> BuiltMesh:
        """Return the mesh of a scene."""
        key = sizes, self.high(sizes, rows)
        if key not in self.meshes:
            self.meshes[key] = self.make(*key)
        return self.meshes[key]

    def batch(self, rows: Rows) -> PreparedWork:
        """Return a call for all rows, with meshes that exist."""
        work = partial(self._ready(rows), rows)
        return prepared(len(rows), work)

    def single(self, rows: Rows) -> PreparedWork:
        """Return a call for each row, with meshes that exist."""
        return one_by_one(self._ready(rows), [rows[place : place + 1] for place in range(len(rows))])

    def _ready(self, rows: Rows) -> Callable[[Rows], Answers]:
        """Build the meshes of these rows; return the function that answers with them."""
        sizes = scene_of(rows, self.layout)
        if sizes is not None:
            return self.mesh(sizes, rows).answers
        self.answer(rows)  # builds them
        return self.answer

    def build(self, rows: Rows) -> PreparedWork | None:
        """Return the work of building a scene's mesh, from vertices to the engine's tree.

        Its answer is the triangle count.
        """
        sizes = scene_of(rows, self.layout)
        if sizes is None:
            return None
        known = np.array([self.mesh(sizes, rows).triangles])
        make = partial(self.make, sizes, self.high(sizes, rows))
        return PreparedWork(1, clocked(lambda: np.array([make().triangles])), lambda: known)

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """Return the empty call of a Python function."""
        return None if mode == "build" else InPython(self.answer).empty(rows, mode)

    def close(self) -> None:
        """Release the meshes."""
        self.meshes.clear()


@dataclass
class RunningForeign(LoadedMethod):
    """A running implementation; `kind` is that of its SPEC. `trouble` says why rows have no answer."""

    implementation: Implementation
    kind: str

    def answer(self, rows: Rows) -> Answers:
        """Return the implementation's answers; CANNOT_SAY for rows without one."""
        return self._asked(rows, by_scene=False)

    def batch(self, rows: Rows) -> PreparedWork:
        """Prepare one question with all rows; as a scene if it offers scenes and the rows share their sizes."""
        rows, by_scene = rows[:LARGEST], self.implementation.scene and scene_of(rows) is not None
        answers = partial(self._asked, rows, by_scene=by_scene)
        if self._clock is None:
            return PreparedWork(len(rows), self._round_trips(rows), answers, "process")
        return PreparedWork(len(rows), self._times(rows, answers, by_scene=by_scene), answers, self._clock)

    def single(self, rows: Rows) -> PreparedWork | None:
        """Prepare a question for each row.

        Return None for a command without a clock, since the time would be that of the pipe.
        """
        if self._clock is None:
            return None
        answers = partial(self._asked, rows, by_scene=False)
        return PreparedWork(len(rows), self._times(rows, answers, row_by_row=True), answers, self._clock)

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """Return the empty call: for a library one that does nothing, for a command without a clock one of one row."""
        name = f"of {self.implementation.spec}"
        if self._clock is None and mode == "batch":
            return EmptyCall(name, PreparedWork(1, self._round_trips(rows[:1]), partial(self.answer, rows[:1])))
        if self.kind == "library" and mode == "single":
            calls = self._times(rows[:0], _none, row_by_row=True)
            return EmptyCall(name, PreparedWork(1, calls, _none))
        return None

    def close(self) -> None:
        """End the program."""
        self.implementation.close()

    @property
    def _clock(self) -> str | None:
        """Whose clock times it; None if it offers none."""
        if self.kind == "command":
            return "time protocol" if self.implementation.declared.time else None
        return "worker"

    def _asked(self, rows: Rows, *, by_scene: bool) -> Answers:
        """Return the answers to rows, and note a row without an answer in `trouble`."""
        answered = self.implementation.classify(rows, by_scene=by_scene and len(rows) > 0)
        if answered.reasons:
            place, reason = next(iter(answered.reasons.items()))
            self.trouble = f"{reason}; the row is {', '.join(map(repr, rows[place].tolist()))}"
        return answered.answers

    def _times(
        self, rows: Rows, answers: Callable[[], Answers], *, by_scene: bool = False, row_by_row: bool = False
    ) -> Clocked:
        """Return the time by the clock of the implementation, whose checksum Implementation.time checks."""
        right = int(answers().sum(dtype=np.int64))

        def run(repeat: int) -> tuple[int, int]:
            try:
                took = self.implementation.time(rows, repeat, by_scene=by_scene, row_by_row=row_by_row)
            except TimingError as error:
                raise TimingRefusedError(str(error)) from None
            return took or 0, right

        return run

    def _round_trips(self, rows: Rows) -> Clocked:
        """Return the time of questions by our clock, with the transport."""

        def run(repeat: int) -> tuple[int, int]:
            started = time.perf_counter_ns()
            for _ in range(repeat):
                answers = self.implementation.classify(rows, batch=len(rows)).answers
            return time.perf_counter_ns() - started, int(answers.sum(dtype=np.int64))

        return run


def _none() -> Answers:
    """Return no answers."""
    return np.empty(0, dtype=np.int8)
