"""Sessions of an implementation: its limits, how a question can fail, and restarts as faults allow.

What a foreign implementation may use before it is stopped.

How a question to a foreign implementation can end without an answer, as values and as exceptions.

One run of an implementation, from its start to its end, as the runner sees it.

The runs of an implementation: one process after another, as many as faults may cost.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import Exit, HypcheckError, InputError
from hypcheck.geometry.rows import Rows
from hypcheck.implementations.description import Description


@dataclass(frozen=True, slots=True)
class Limits:
    """Seconds until it is ready, seconds without progress, restarts after faults, bytes its process group may hold.

    Raises InputError where one of them leaves no room at all.
    """

    startup_timeout: float = 30.0
    timeout: float = 10.0
    restarts: int = 20
    memory: int = 4 << 30

    def __post_init__(self) -> None:
        for name in ("startup_timeout", "timeout", "memory"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InputError(f"the limit {name.replace('_', ' ')} is {value}; it must be more than 0")
        if self.restarts < 0:
            raise InputError(f"the limit restarts is {self.restarts}; it must be 0 or more")


class Outcome(IntEnum):
    """What became of a row: an answer, or one of the ways to fail; the labels are those of judge.Status."""

    ANSWERED = 0
    ERROR = 1
    CRASH = 2
    TIMEOUT = 3
    PROTOCOL = 4
    NOT_RUN = 5

    @property
    def label(self) -> str:
        """The outcome as records and reports name it."""
        return self.name.lower().replace("_", "-")


class FaultError(Exception):
    """A question that was not answered: how, why, and whether the process is lost with it (`fatal`).

    Raised by sessions and caught by the runner; a user never sees it.
    """

    def __init__(self, outcome: Outcome, reason: str, *, fatal: bool) -> None:
        super().__init__(reason)
        self.outcome = outcome
        self.reason = reason
        self.fatal = fatal


class StartError(HypcheckError):
    """An implementation could not be started; the sentence says which, why, and what it said itself."""

    exit_code = Exit.NOT_STARTED


class TimingError(HypcheckError):
    """An implementation failed while it was timed; the sentence says how."""

    exit_code = Exit.WRONG


IntegerAnswers = NDArray[np.signedinteger[Any]]


class Session(Protocol):
    """Questions raise FaultError; a fatal one leaves the session good for kill() alone. Beginning raises StartError."""

    description: Description
    max_batch: int
    """Rows of one question, at most."""

    max_rows: int | None
    """Rows of a family that it is fast enough for; None where nothing is known of that."""

    scene: bool
    """Whether questions can be asked by scene: one set of sizes, many centres."""

    def classify(self, rows: Rows, *, by_scene: bool = False) -> IntegerAnswers:
        """An integer for each row, not looked at."""
        ...

    def time(self, rows: Rows, repeat: int, *, by_scene: bool = False, each: bool = False) -> tuple[int, int] | None:
        """Nanoseconds for `repeat` times the rows and the sum of the answers; None where that is not offered.

        `each`: by a call for each row.
        """
        ...

    @property
    def evidence(self) -> str:
        """What it said on standard error since the last question, as the end of a sentence."""
        ...

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines of its standard error, safe to print."""
        ...

    def close(self) -> None:
        """Let it leave."""
        ...

    def kill(self) -> None:
        """End it now."""
        ...


class GivenUpError(Exception):
    """No further run is possible; the text says why. Raised by Supervisor and caught where questions are asked."""


MAX_HANGS = 3
"""Questions in a row that an implementation may leave without an answer before it has answered any."""


@dataclass(frozen=True, slots=True)
class Allowance:
    """What an implementation may still cost before it is asked no more.

    `restarts` after rows that ended its process; `faults`, rows that ended in one without ending the process. `over`
    says why it is asked no more already; empty while it is. `hangs` are questions that it may still leave without an
    answer; None once it has answered one, from when on restarts alone count. `last` is the reason of the last row that
    was charged.
    """

    restarts: int
    faults: int
    over: str = ""
    hangs: int | None = MAX_HANGS
    last: str = ""

    def after(self, task: Allowance, limits: Allowance) -> Allowance:
        """What is left for the run once a task is counted that began with all of the `limits` and left `task`.

        Where tasks have spent more than the limits together, the one that exceeds them is the last that counts.
        """
        restarts = self.restarts - (limits.restarts - task.restarts)
        faults = self.faults - (limits.faults - task.faults)
        over = self.over or task.over
        if not over and restarts < 0:
            over = f"not asked: {_used_up(limits.restarts)}; the last row at fault: {task.last}"
        if not over and faults < 1:
            over = f"not asked: {limits.faults - faults:,} rows before were at fault; the last: {task.last}"
        return Allowance(max(0, restarts), max(0, faults), over, None if self.hangs is None else task.hangs)


class Supervisor:
    """Holds the session that runs, and begins another where it was lost. Raises StartError where the first fails.

    `start` begins a session; it is given the number of sessions before. `left` is what is left of the allowance. A
    row at fault is charged when it is found, so that what some rows cost does not depend on what is asked after them.
    """

    def __init__(self, start: Callable[[int], Session], allowance: Allowance) -> None:
        self._start = start
        self._most = allowance
        self.left = allowance
        self._count = 1
        self._session: Session | None = start(0)
        self.declared = self._session.description
        self.scene = self._session.scene
        self.max_rows = self._session.max_rows
        self.max_batch = self._session.max_batch

    def session(self) -> Session:
        """The session that runs, begun anew if need be; raises GivenUpError where that is not possible any more."""
        if not self.left.over and self._session is None:
            self._session = self._begin()
        if self.left.over or self._session is None:
            raise GivenUpError(self.left.over)
        return self._session

    def _begin(self) -> Session | None:
        try:
            session = self._start(self._count)
        except StartError as error:
            self._end(f"not asked: it could not be started again: {error}")
            return None
        self._count += 1
        if session.description == self.declared:
            return session
        session.kill()
        self._end("not asked: started again, it describes itself otherwise than before")
        return None

    def _end(self, reason: str) -> None:
        self.left = replace(self.left, over=self.left.over or reason)

    def note_answer(self) -> None:
        """Take note that a question was answered."""
        if self.left.hangs is not None:
            self.left = replace(self.left, hangs=None)

    def note_fault(self, fault: FaultError) -> str:
        """End the session that runs where the fault is fatal: what happened, with what was said on standard error."""
        session = self._session
        if not fault.fatal or session is None:
            return fault.reason
        session.kill()
        self._session = None
        reason = fault.reason + session.evidence
        self._count_hang(fault, reason)
        return reason

    def _count_hang(self, fault: FaultError, reason: str) -> None:
        if self.left.hangs is None:
            return
        hangs = self.left.hangs - 1 if fault.outcome is Outcome.TIMEOUT else MAX_HANGS
        self.left = replace(self.left, hangs=hangs)
        if not hangs:
            self._end(
                f"not asked: it hung on {MAX_HANGS} questions in a row and never answered any; the last: {reason}"
            )

    def charge_fault(self, fault: FaultError, reason: str) -> None:
        """Take note of a row that was found to be at fault."""
        if fault.fatal and self.left.restarts:
            self.left = replace(self.left, restarts=self.left.restarts - 1, last=reason)
        elif fault.fatal:
            self._end(f"not asked: {_used_up(self._most.restarts)}; the last process: {reason}")
        elif self.left.faults > 1:
            self.left = replace(self.left, faults=self.left.faults - 1, last=reason)
        else:
            were = "row before was" if self._most.faults == 1 else "rows before were"
            self._end(f"not asked: {self._most.faults:,} {were} at fault; the last: {reason}")

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines that the running process wrote on standard error, safe to print."""
        return self._session.stderr if self._session else ()

    def close(self) -> None:
        """Let the process leave. Another begins should anything be asked, and does not count as a restart."""
        session, self._session = self._session, None
        if session:
            session.close()

    def kill(self) -> None:
        """As close(), without waiting: it may be in the middle of a question."""
        session, self._session = self._session, None
        if session:
            session.kill()


def _used_up(restarts: int) -> str:
    """That no restart is left of those that were allowed."""
    if not restarts:
        return "no restart is allowed"
    return "the one restart is used up" if restarts == 1 else f"{restarts} restarts are used up"
