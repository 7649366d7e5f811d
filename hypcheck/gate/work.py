"""The units of work of a run, and what performs one wherever an implementation is held."""

from __future__ import annotations

from dataclasses import dataclass

from hypcheck.gate.again import Round, ask_again
from hypcheck.gate.chunks import Chunk
from hypcheck.gate.refusing import Invalid, ask_invalid
from hypcheck.gate.results import Performed, Result
from hypcheck.gate.rules import Rules
from hypcheck.gate.subject import Subject
from hypcheck.gate.trial import ask
from hypcheck.methods.domain import Domain
from hypcheck.methods.implementation import Implementation
from hypcheck.methods.limits import Limits
from hypcheck.methods.opening import open_implementation
from hypcheck.methods.runs import Allowance

Task = Chunk | Round | Invalid


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


def perform(task: Task, implementation: Subject, rules: Rules, allowance: Allowance) -> Performed:
    """Do it; the result depends on nothing but these, as far as the implementation's answers do not."""
    implementation.allow(allowance)
    result = _result(task, implementation, rules)
    return Performed(result, allowance, implementation.allowance)


def _result(task: Task, implementation: Subject, rules: Rules) -> Result:
    if isinstance(task, Chunk):
        return ask(task, implementation, rules)
    if isinstance(task, Round):
        return ask_again(task, implementation, rules)
    return ask_invalid(implementation)
