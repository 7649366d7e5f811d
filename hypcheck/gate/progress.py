"""How far an implementation has been asked, as a line of the record: what `--resume` goes on from."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hypcheck.errors import InputError
from hypcheck.gate.ourselves import own_sha256
from hypcheck.gate.saved import restored, saved
from hypcheck.gate.schedule import State
from hypcheck.record import Recorder, lines, plain
from hypcheck.record.fields import as_json

EVERY = 10.0
"""Seconds between two lines of progress, at least: what a killed run may lose."""

SHARE = 100
"""Of the time of a run, what keeping its progress may take: one part of so many."""


@dataclass(frozen=True)
class Progress:
    """What a line of progress says.

    `number` is the place, from 0, of the implementation that is asked among those of the plan, `declared` what it says
    of itself, and `cases` how many it is asked in all. `program` is the sha256 of our own files: what a step is, and so
    what a number of them comes to, may change between two commits.
    """

    number: int
    declared: Mapping[str, Any]
    cases: int
    state: State
    program: str | None

    @classmethod
    def of_line(cls, line: lines.Progress, name: str) -> Progress:
        """What the line of a record says. Raises InputError naming the record where it cannot be read."""
        try:
            return cls(line.number, as_json(line.declared), line.cases, restored(line.state), line.program)
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            raise InputError(f"{name}: its line of progress says nothing to go on from: {error!r}") from None


class Keeper:
    """Keeps in a record how far one implementation has been asked; `about` are the fields of the line but its state."""

    def __init__(self, recorder: Recorder, **about: Any) -> None:  # noqa: ANN401  whatever the line holds
        self.recorder = recorder
        self._about = about
        self._due = time.monotonic() + EVERY

    def offer(self, state: State) -> None:
        """Keep the state if it is time to."""
        if time.monotonic() >= self._due:
            began = time.monotonic()
            self.keep(state)
            now = time.monotonic()
            self._due = now + max(EVERY, SHARE * (now - began))

    def keep(self, state: State) -> None:
        """Keep the state. Raises OSError where it cannot be written; the record is then as it was."""
        self.recorder.keep(lines.Progress(**self._about, state=plain(saved(state)), program=own_sha256()))
