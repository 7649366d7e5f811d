"""The steps of a run in their order, whoever performs them and whenever: chunks, asking again, the invalid rows.

Steps may be performed ahead of their turn and at the same time; their results are put together in order. What one may
cost depends on what those before it have cost, so that a step performed ahead of its turn is done anew where it turns
out that less was left for it than it was granted. The state after each step is therefore the same for any crew.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import Protocol

from hypcheck.gate.again import Round
from hypcheck.gate.chunks import SIZE, Chunk
from hypcheck.gate.refusing import Invalid
from hypcheck.gate.results import Performed, Result, merged
from hypcheck.gate.work import Task
from hypcheck.methods.runs import Allowance

ROUND = 64 * SIZE
"""Rows after which their open cases are asked again, so that no more than so many are ever kept.

Whoever asks them again holds them all at once; twice as many would cost each process some 8 MB more.
"""


@dataclass(frozen=True, slots=True)
class Again:
    """The step that asks the open cases of all chunks since the last such step again."""

    number: int


Step = Chunk | Again | Invalid


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
        before = replace(self.total, open=()) if isinstance(step, Again) else self.total
        return State(performed.after(self.left), self.done + 1, merged([before, performed.result]))


class Crew(Protocol):
    """Who performs tasks, some `ahead` at a time."""

    ahead: int

    def submit(self, task: Task, allowance: Allowance, *, first: bool = False) -> int:
        """Put a task in line, before all others if it is `first`; a number to ask for its result with."""
        ...

    def result(self, number: int) -> Performed:
        """Wait for a task's result."""
        ...


def steps(chunks: Iterable[Chunk], *, refuses: bool) -> Iterator[Step]:
    """The steps that ask these chunks; `refuses`: and the invalid rows."""
    rows, rounds = 0, 0
    for chunk in chunks:
        yield chunk
        rows += len(chunk)
        if rows >= ROUND:
            yield Again(rounds)
            rows, rounds = 0, rounds + 1
    if rows:
        yield Again(rounds)
    if refuses:
        yield Invalid()


def states(some: Iterable[Step], crew: Crew, state: State) -> Iterator[tuple[Step, State]]:
    """Perform the steps behind those that are done; each with the state after it."""
    coming = islice(some, state.done, None)
    line: deque[tuple[Step, int | None]] = deque()
    while True:
        while len(line) < crew.ahead and (step := next(coming, None)) is not None:
            line.append((step, None if isinstance(step, Again) else crew.submit(step, state.left)))
        if not line:
            return
        step, number = line.popleft()
        task = Round(step.number, state.total.open) if isinstance(step, Again) else step
        if number is None:  # only now all of its cases are there
            number = crew.submit(task, state.left, first=True)
        performed = crew.result(number)
        if not performed.fits(state.left):
            performed = crew.result(crew.submit(task, state.left, first=True))
        state = state.after(step, performed)
        yield step, state
