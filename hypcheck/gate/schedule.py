"""The steps of a run in their order, whoever performs them and whenever: chunks, asking again, the invalid rows.

Steps may be performed ahead of their turn and at the same time; their results are put together in order. What one may
cost depends on what those before it have cost, so that a step performed ahead of its turn is done anew where it turns
out that less was left for it than it was granted. The state after each step is therefore the same for any crew.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice, takewhile
from typing import Protocol

from hypcheck.gate.chunks import SIZE, Chunk
from hypcheck.gate.conformance import Invalid
from hypcheck.gate.results import Open, Performed, Result, merged
from hypcheck.gate.retest import RetestTask
from hypcheck.gate.work import Task
from hypcheck.methods.runs import Allowance

ROUND = 64 * SIZE
"""Rows after which their open cases are asked again, so that no more than so many are ever kept.

Whoever asks them again holds them all at once; twice as many would cost each process some 8 MB more.
"""


@dataclass(frozen=True, slots=True)
class Again:
    """A step that asks the open cases of the chunks since the last round again: those in one part of it.

    Part 0 is of the chunks that begin a family; with it everything is asked that is asked once a run. Parts 1 and 2 are
    of the others, so that two processes ask at the same time at the end, where nothing else is left to do.
    """

    number: int
    part: int = 0

    def of(self, some: tuple[Open, ...]) -> RetestTask:
        """Its task, where these are open."""
        return RetestTask(self.number, self.part, tuple(each for each in some if each.chunk.part == self.part))


Step = Chunk | Again | Invalid

_LATER = 0
"""The number of a step that was not submitted yet; those of a crew begin with 1."""


@dataclass(frozen=True)
class State:
    """A run so far: how many steps it has done, what came of them, and what the implementation may still cost.

    From a state and the same steps the run goes on as if it had never paused.
    """

    left: Allowance
    done: int = 0
    total: Result = field(default_factory=Result)

    def after(self, step: Step, performed: Performed) -> State:
        """The state after one more step."""
        before = self.total
        if isinstance(step, Again):
            before = replace(before, open=tuple(each for each in before.open if each.chunk.part != step.part))
        return State(performed.after(self.left), self.done + 1, merged([before, performed.result]))


class Crew(Protocol):
    """Who performs tasks, some `ahead` at a time."""

    ahead: int

    def submit(self, task: Task, allowance: Allowance, *, first: bool = False) -> int:
        """Put a task in line, before those that are not if it is `first`; a number to ask for its result with."""
        ...

    def result(self, number: int) -> Performed:
        """Wait for a task's result."""
        ...


def steps(chunks: Iterable[Chunk], *, refuses: bool) -> Iterator[Step]:
    """The steps that ask these chunks; `refuses`: and the invalid rows."""
    rows, rounds, parts = 0, 0, set[int]()
    for chunk in chunks:
        yield chunk
        rows += len(chunk)
        parts.add(chunk.part)
        if rows >= ROUND:
            yield from _round(rounds, parts)
            rows, rounds, parts = 0, rounds + 1, set()
    yield from _round(rounds, parts)
    if refuses:
        yield Invalid()


def _round(number: int, parts: set[int]) -> Iterator[Again]:
    """Part 0, which takes the longest in the first round, stands last, so that the others are asked together."""
    return (Again(number, part) for part in (1, 2, 0) if part in parts)


def states(some: Iterable[Step], crew: Crew, state: State) -> Iterator[tuple[Step, State]]:
    """Perform the steps behind those that are done; each with the state after it."""
    coming = islice(some, state.done, None)
    line: deque[tuple[Step, int]] = deque()
    while True:
        while len(line) < crew.ahead and (step := next(coming, None)) is not None:
            line.append((step, _LATER if isinstance(step, Again) else crew.submit(step, state.left)))
        if not line:
            return
        if line[0][1] == _LATER:
            _begin_round(line, crew, state)
        step, number = line.popleft()
        performed = crew.result(number)
        if not performed.fits(state.left):
            performed = crew.result(crew.submit(_task(step, state), state.left, first=True))
        state = state.after(step, performed)
        yield step, state


def _begin_round(line: deque[tuple[Step, int]], crew: Crew, state: State) -> None:
    """Submit the parts of a round, with which the line begins: only now all of its cases are there."""
    for place, (step, _) in enumerate(takewhile(lambda each: each[1] == _LATER, tuple(line))):
        line[place] = step, crew.submit(_task(step, state), state.left, first=True)


def _task(step: Step, state: State) -> Task:
    return step.of(state.total.open) if isinstance(step, Again) else step
