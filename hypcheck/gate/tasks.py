"""The tasks of a run, and the function that performs one wherever an implementation is open."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.gate.chunks import Chunk
from hypcheck.gate.conformance import Invalid, Rules, ask_chunk, ask_invalid
from hypcheck.gate.results import Result
from hypcheck.gate.retest import RetestTask, retest
from hypcheck.methods.domain import Domain
from hypcheck.methods.implementation import Crashed, Implementation
from hypcheck.methods.limits import Limits
from hypcheck.methods.opening import open_implementation
from hypcheck.methods.runs import Allowance

Task = Chunk | RetestTask | Invalid


@dataclass(frozen=True, slots=True)
class Opening:
    """How an implementation is opened: its SPEC, limits, and what stands for what it declares."""

    spec: str
    limits: Limits
    precision: str | None = None
    question: str | None = None
    domain: Domain | None = None

    def open(self) -> Implementation:
        """It, running. Raises InputError and StartError as open_implementation does."""
        return open_implementation(
            self.spec, self.limits, precision=self.precision, question=self.question, domain=self.domain
        )


@dataclass(frozen=True)
class TaskResult:
    """The result of a task, and what is left of the allowance with which it began."""

    result: Result
    left: Allowance


def perform(task: Task, implementation: Implementation | Crashed, rules: Rules, allowance: Allowance) -> TaskResult:
    """Perform a task, which may spend the allowance; the result depends on nothing else but the answers."""
    implementation.allow(allowance)
    if isinstance(task, Chunk):
        result = ask_chunk(task, implementation, rules)
    elif isinstance(task, RetestTask):
        result = retest(task, implementation, rules)
    else:
        result = ask_invalid(task, implementation)
    return TaskResult(result, implementation.allowance)
