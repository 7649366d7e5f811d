"""A SPEC as a contender: it runs in a separate process, and is timed by its own clock if it offers one."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from hypcheck.bench.contender import Contender, EmptyCall, LoadedMethod, PreparedWork, of_method
from hypcheck.bench.plan import PASSAGE
from hypcheck.bench.workloads import NEAR_SCENES, WORKLOADS, listed, scene_of
from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, Layout, Rows
from hypcheck.implementations.builtin import builtin
from hypcheck.implementations.description import Description
from hypcheck.implementations.frames import LARGEST
from hypcheck.implementations.implementation import Implementation, open_implementation
from hypcheck.implementations.method import Answers
from hypcheck.implementations.session import Limits, Outcome, StartError, TimingError
from hypcheck.implementations.spec import parse_spec
from hypcheck.runs.timing import Clocked, TimingRefusedError

SINGLES = {"library": 256, "python": 64, "command": 16}
"""Rows that are asked one by one, by the kind of SPEC. The worker repeats them in order, and there are enough that a
branch predictor does not learn them; a command gets one question for each."""

_TRIED = 64
_TRIES, _TRYING_S = 5, 0.2
"""A batch is timed so often, unless that takes longer, and the fastest time counts: after one interruption the method
would get few rows."""
_JUDGED_S, _TIMED_S = 4.0, 0.01
"""Seconds for judging one workload, and for a timed batch."""


@dataclass(frozen=True)
class ForeignMethod:
    """A SPEC that was started, its description, and the number of rows that it can answer in reasonable time."""

    spec: str
    name: str
    description: Description
    judged: int
    timed: int


def foreign_method(
    spec: str, limits: Limits, taken: Sequence[str], *, tilted: bool = False, layout: Layout = PAIRS
) -> ForeignMethod:
    """The method of a SPEC. Raises StartError if it cannot be started, and InputError if it is not a SPEC.

    It also raises InputError if the run is about tilted spheroids and the description does not take tilt, or if its
    question has rows of another layout.
    """
    with open_implementation(spec, limits) as implementation:
        description = implementation.description
        if tilted and not description.tilt:
            raise InputError(f'{spec} answers rows of seven numbers alone: its description has no "tilt": true')
        if description.asked.layout != layout:
            other = "without" if layout.has_end else "with"
            raise InputError(
                f"{spec} answers the question {description.question}; it is measured {other} --question passage"
            )
        took = _seconds_a_row(implementation)
    name = description.name if description.name not in taken else f"{description.name} ({spec})"
    return ForeignMethod(
        spec, name, description, max(200, int(_JUDGED_S / took)), min(LARGEST, max(1, int(_TIMED_S / took)))
    )


def _seconds_a_row(implementation: Implementation) -> float:
    """The seconds per row of a batch; batches grow until one takes long enough to measure."""
    layout = implementation.description.asked.layout
    some = (listed(PASSAGE)["tower"] if layout.has_end else WORKLOADS["uniform"]).rows(1, _TRIED)
    inside = some[implementation.description.domain.holds(some, layout=layout)]
    usual = [*NEAR_SCENES[0], 1.0, 0.5, 2.0, 1.0, 0.5, -2.0][: len(layout.upright)]
    some = inside if len(inside) else np.array([usual])
    first = implementation.classify(some[:1])
    if Outcome.TIMEOUT in first.outcomes:  # each larger batch would time out again
        raise StartError(f"{implementation.spec} does not answer its first question, about one row: {first.reasons[0]}")
    implementation.classify(some)  # a warm-up
    while True:
        took = _fastest(implementation, some)
        if took > _TIMED_S or len(some) * 8 > LARGEST:
            return max(took / len(some), 1e-9)
        some = np.repeat(some, 8, axis=0)


def _fastest(implementation: Implementation, rows: Rows) -> float:
    tries = [_seconds(implementation, rows)]
    while len(tries) < _TRIES and sum(tries) < _TRYING_S:
        tries.append(_seconds(implementation, rows))
    return min(tries)


def _seconds(implementation: Implementation, rows: Rows) -> float:
    started = time.perf_counter()
    implementation.classify(rows)
    return time.perf_counter() - started


def foreign_contenders(methods: Iterable[ForeignMethod], limits: Limits) -> Iterable[Contender]:
    """A contender for each SPEC; a built-in method runs in this process."""
    for method in methods:
        description = method.description
        kind, words = parse_spec(method.spec).kind, parse_spec(method.spec).words
        if kind == "builtin":
            own = builtin(words[0])
            yield of_method(own, "numpy", "algebraic", judged=own.max_rows, timed=min(8192, method.timed))
            continue
        yield Contender(
            name=method.name,
            title=" ".join(filter(None, (description.name, description.version, description.language))),
            tier="foreign",
            kind="foreign",
            precision=description.precision,
            question=description.question,
            domain=description.domain,
            load=partial(_opened, method.spec, limits),
            exact=description.precision == "exact",
            judged=method.judged,
            timed=method.timed,
            singles=SINGLES[kind],
            note=f"as {method.spec}",
        )


def _opened(spec: str, limits: Limits) -> RunningForeign:
    return RunningForeign(open_implementation(spec, limits), parse_spec(spec).kind)


@dataclass
class RunningForeign(LoadedMethod):
    """A running implementation; `kind` is that of its SPEC. `trouble` says why rows have no answer."""

    implementation: Implementation
    kind: str

    def answer(self, rows: Rows) -> Answers:
        """The implementation's answers; CANNOT_SAY for rows without one."""
        return self._asked(rows, by_scene=False)

    def batch(self, rows: Rows) -> PreparedWork:
        """All rows in one question; as a scene if the implementation offers scenes and the rows share their sizes."""
        rows, by_scene = rows[:LARGEST], self.implementation.scene and scene_of(rows) is not None
        answers = partial(self._asked, rows, by_scene=by_scene)
        if self._clock is None:
            return PreparedWork(len(rows), self._round_trips(rows), answers, "process")
        return PreparedWork(len(rows), self._times(rows, answers, by_scene=by_scene), answers, self._clock)

    def single(self, rows: Rows) -> PreparedWork | None:
        """A question for each row; None for a command without a clock, since the time would be that of the pipe."""
        if self._clock is None:
            return None
        answers = partial(self._asked, rows, by_scene=False)
        return PreparedWork(len(rows), self._times(rows, answers, row_by_row=True), answers, self._clock)

    def empty(self, rows: Rows, mode: str) -> EmptyCall | None:
        """The empty call: of a library one that does nothing, of a command without a clock a question about one row."""
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
        if self.kind == "command":
            return "time protocol" if self.implementation.declared.time else None
        return "worker"

    def _asked(self, rows: Rows, *, by_scene: bool) -> Answers:
        answered = self.implementation.classify(rows, by_scene=by_scene and len(rows) > 0)
        if answered.reasons:
            place, reason = next(iter(answered.reasons.items()))
            self.trouble = f"{reason}; the row is {', '.join(map(repr, rows[place].tolist()))}"
        return answered.answers

    def _times(
        self, rows: Rows, answers: Callable[[], Answers], *, by_scene: bool = False, row_by_row: bool = False
    ) -> Clocked:
        """The time by the clock of the implementation, whose checksum Implementation.time checks."""
        right = int(answers().sum(dtype=np.int64))

        def run(repeat: int) -> tuple[int, int]:
            try:
                took = self.implementation.time(rows, repeat, by_scene=by_scene, row_by_row=row_by_row)
            except TimingError as error:
                raise TimingRefusedError(str(error)) from None
            return took or 0, right

        return run

    def _round_trips(self, rows: Rows) -> Clocked:
        def run(repeat: int) -> tuple[int, int]:
            started = time.perf_counter_ns()
            for _ in range(repeat):
                answers = self.implementation.classify(rows, batch=len(rows)).answers
            return time.perf_counter_ns() - started, int(answers.sum(dtype=np.int64))

        return run


def _none() -> Answers:
    return np.empty(0, dtype=np.int8)
