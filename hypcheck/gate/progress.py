"""How far a run has come, as a line of its record: kept while it goes on, and what `--resume` goes on from."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from hypcheck.errors import InputError
from hypcheck.gate.fingerprint import files_of, sha256
from hypcheck.gate.lines import GateOutcome
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.saved import restored, saved
from hypcheck.gate.schedule import State
from hypcheck.gate.work import Opening
from hypcheck.record import Line, Recorder

EVERY = 10.0
"""Seconds between two lines of progress, at least: what a killed run may lose."""

SHARE = 100
"""Of the time of a run, what keeping its progress may take: one part of so many."""


@dataclass(frozen=True)
class Progress:
    """What a line of progress says.

    `number` is the place, from 0, of the implementation that is asked among those of the plan, and `declared` what it
    says of itself; `files` are sha256 by path, `cases` those that it is asked in all. `outcome` is that of the
    implementations before it, whose lines stand before this one. `state` is None where nothing was asked yet.
    """

    number: int
    declared: Mapping[str, Any]
    files: Mapping[str, str]
    cases: int
    outcome: GateOutcome
    state: State | None = None

    @classmethod
    def of_line(cls, line: Line, name: str) -> Progress:
        """What the line of a record says. Raises InputError naming the record where it cannot be read."""
        try:
            return cls(
                line["number"],
                line["declared"],
                line["files"],
                line["cases"],
                GateOutcome(**line["outcome"]),
                restored(line["state"]),
            )
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise InputError(f"{name}: its line of progress says nothing to go on from: {error!r}") from None


class Keeper:
    """Keeps in a record how far one implementation has come; `beginning` is its progress without a state."""

    def __init__(self, recorder: Recorder, beginning: Progress) -> None:
        self._recorder = recorder
        self._beginning = beginning
        self._due = time.monotonic() + EVERY

    def begin(self, state: State) -> None:
        """Keep the lines of those before it, so that they are not asked again."""
        if self._beginning.number:
            self.keep(state)

    def offer(self, state: State) -> None:
        """Keep the state if it is time to."""
        if time.monotonic() >= self._due:
            began = time.monotonic()
            self.keep(state)
            now = time.monotonic()
            self._due = now + max(EVERY, SHARE * (now - began))

    def keep(self, state: State) -> None:
        """Keep the state. Raises OSError where it cannot be written; the record is then as it was."""
        found = self._beginning
        self._recorder.keep(
            number=found.number,
            declared=found.declared,
            files=found.files,
            cases=found.cases,
            outcome=asdict(found.outcome),
            state=saved(state),
        )


def opening_of(plan: GatePlan, number: int) -> Opening:
    """How an implementation of the plan is opened."""
    return Opening(plan.specs[number], plan.limits, plan.precision, plan.question, plan.domain)


def fingerprints(plan: GatePlan, number: int) -> dict[str, str]:
    """The sha256 of the files that its SPEC names, and of the known failures; of those that can be read."""
    paths = (*files_of(plan.specs[number]), *([plan.known_failures] if plan.known_failures else []))
    return {str(path): sha256(path) for path in paths}
