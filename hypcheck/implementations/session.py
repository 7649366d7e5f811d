"""Sessions of an implementation: interface, limits, answers and faults, and the supervisor that restarts them.

A session is one run of an implementation, usually in a process of its own. A fault is a question without an answer. A
fault that ends the process costs a restart; the supervisor starts sessions until the allowance is used up.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import IntEnum
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from hypcheck.errors import Exit, HypcheckError, InputError
from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Mask, Rows, invalid
from hypcheck.implementations.description import Description
from hypcheck.implementations.frames import UNWRITTEN, GivenAnswers
from hypcheck.isolation.launch import Isolation


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits of an implementation. Raises InputError if one of them is 0 or less (`restarts` may be 0).

    `startup_timeout` are seconds until it is ready, `timeout` seconds without progress; `restarts` are allowed after
    faults, and its processes may use `memory` bytes together. `isolation` says what its processes may touch.
    """

    startup_timeout: float = 30.0
    timeout: float = 10.0
    restarts: int = 20
    memory: int = 4 << 30
    isolation: Isolation = field(default_factory=Isolation)

    def __post_init__(self) -> None:
        for name in ("startup_timeout", "timeout", "memory"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise InputError(f"the limit {name.replace('_', ' ')} is {value}; it must be more than 0")
        if self.restarts < 0:
            raise InputError(f"the limit restarts is {self.restarts}; it must be 0 or more")


class Outcome(IntEnum):
    """The outcome of a question about a row: an answer or a fault. The labels are those of judge.Status."""

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
    """A question without an answer: its outcome, the reason, and whether the process is lost (`fatal`).

    Sessions raise it and the implementation catches it; a user never sees it.
    """

    def __init__(self, outcome: Outcome, reason: str, *, fatal: bool) -> None:
        super().__init__(reason)
        self.outcome = outcome
        self.reason = reason
        self.fatal = fatal


class StartError(HypcheckError):
    """An implementation that could not be started; the sentence says which, why, and what it printed."""

    exit_code = Exit.NOT_STARTED


class TimingError(HypcheckError):
    """An implementation failed while it was timed; the sentence says how."""

    exit_code = Exit.WRONG


class Session(Protocol):
    """One run of an implementation. Questions raise FaultError; after a fatal one only kill() may be called.

    Its constructor raises StartError. The fields have docstrings of their own.
    """

    description: Description
    max_batch: int
    """The most rows of one question."""

    max_rows: int | None
    """The most rows of a family that it answers in reasonable time; None if that is not known."""

    scene: bool
    """Whether it has an entry for scenes: one set of sizes, many centres."""

    def classify(self, rows: Rows, *, by_scene: bool = False) -> GivenAnswers:
        """Send rows; return an unchecked integer for each and, if the description promises them, unchecked times."""
        ...

    def time(
        self, rows: Rows, repeat: int, *, by_scene: bool = False, row_by_row: bool = False
    ) -> tuple[int, int] | None:
        """Return nanoseconds for `repeat` times the rows, and the sum of the answers; None if it does not offer timing.

        `row_by_row` makes a call for each row.
        """
        ...

    @property
    def evidence(self) -> str:
        """The implementation's standard error since the last question, as the end of a sentence."""
        ...

    def advice(self, reason: str) -> str:
        """Return the advice if isolation caused a fault, as the end of a sentence."""
        ...

    def close(self) -> None:
        """End the program."""
        ...

    def kill(self) -> None:
        """End it now."""
        ...


@dataclass(frozen=True, slots=True)
class Answered:
    """The answers to n rows: `answers` int8 (n,), CANNOT_SAY for rows without one; `status` int8 (n,), an Outcome each.

    `reasons` has a sentence, safe to print, for every row whose status is not ANSWERED. `times` (n,) are those of the
    answers 1, and NaN elsewhere; None if the implementation gives none.
    """

    answers: NDArray[np.int8]
    status: NDArray[np.int8]
    reasons: dict[int, str]
    times: Floats | None = None

    @classmethod
    def of(cls, answers: NDArray[np.int8], times: Floats | None = None) -> Answered:
        """Return a result in which every row is answered."""
        return cls(answers, np.full(len(answers), Outcome.ANSWERED, dtype=np.int8), {}, times)

    @property
    def answered(self) -> NDArray[np.bool_]:
        """A mask (n,) of the rows that have an answer."""
        return np.asarray(self.status == Outcome.ANSWERED)

    @property
    def outcomes(self) -> frozenset[Outcome]:
        """The outcomes of the rows, each once."""
        if not self.reasons:
            return frozenset({Outcome.ANSWERED}) if len(self.status) else frozenset()
        return frozenset(map(Outcome, np.unique(self.status).tolist()))

    def count(self, outcome: Outcome) -> int:
        """Return the number of rows with this outcome."""
        return int(np.count_nonzero(self.status == outcome))


class AllowedAnswers:
    """The allowed answers of an implementation: those to its question, CANNOT_SAY, and REFUSED if it refuses rows."""

    def __init__(self, description: Description) -> None:
        self._refuses = description.refuses
        self._layout = description.asked.layout
        self.times = description.times
        self.answers = description.asked.answers
        self._usable = np.zeros(256, dtype=np.bool_)
        self._usable[[answer % 256 for answer in (*self.answers, CANNOT_SAY, *[REFUSED] * self._refuses)]] = True

    def understood(self, reply: GivenAnswers, rows: Rows) -> Mask:
        """Return a mask (n,) of the allowed answers.

        REFUSED is allowed for invalid rows only; a time is from 0 to 1.
        """
        answers, times = reply
        short = answers.astype(np.int8, copy=False)
        usable = self._usable.take(short.view(np.uint8))
        if answers.dtype != np.int8:
            usable &= short == answers
        if self._refuses:
            refused = np.flatnonzero(short == REFUSED)
            usable[refused] &= invalid(rows[refused], self._layout)
        if times is not None:
            usable &= (short != 1) | ((times >= 0) & (times <= 1))
        return np.asarray(usable)

    def trouble_with(self, answer: int, time: float | None = None) -> str:
        """Return the reason why an answer with this time is not allowed."""
        if answer == 1 and time is not None:
            return f"it answered 1 with the time {time!r}; it must be a number from 0 to 1"
        if answer == REFUSED and self._refuses:
            return f"it answered {REFUSED}, which refuses the row, but the row is valid"
        hint = ", the value of positions that a library did not write" if answer == UNWRITTEN else ""
        return f"it answered {answer}{hint}; it must be one of {', '.join(map(str, self.answers))} or {CANNOT_SAY}"


class GivenUpError(Exception):
    """The implementation gets no more questions; the text says why. Raised by Supervisor, caught by Implementation."""


MAX_HANGS = 3
"""An implementation that has never answered is given up after so many timeouts in a row."""

MAX_UNANSWERED = 1024
"""An implementation that has never answered is given up after so many rows at fault: it fails alike on all of them."""


@dataclass(frozen=True, slots=True)
class Allowance:
    """The faults that an implementation may still have before it is given up.

    `restarts` are left for rows that end its process, and `faults` for rows that fail without ending it. `over` says
    why it was given up, and is empty before that. `hangs` are the timeouts that are left while it has never answered;
    None after its first answer. `last` is the reason of the last fault that was charged.
    """

    restarts: int
    faults: int
    over: str = ""
    hangs: int | None = MAX_HANGS
    last: str = ""

    def after(self, task: Allowance, limits: Allowance) -> Allowance:
        """Return the allowance of the run after one more task, which started with the full `limits` and left `task`.

        If tasks together exceed the limits, the task that exceeds them is the last that counts.
        """
        restarts = self.restarts - (limits.restarts - task.restarts)
        faults = self.faults - (limits.faults - task.faults)
        hangs = None if self.hangs is None else task.hangs
        over = self.over or task.over
        if not over and restarts < 0:
            over = f"not asked: {_used_up(limits.restarts)}; the last row at fault: {task.last}"
        if not over and faults <= limits.faults - limits.most_faults(answered=hangs is None):
            over = _too_many_faults(limits.faults - faults, task.last, answered=hangs is None)
        return Allowance(max(0, restarts), max(0, faults), over, hangs)

    def most_faults(self, *, answered: bool) -> int:
        """Return at how many rows at fault it is given up, if these are the limits: fewer if it has never answered."""
        return self.faults if answered else min(self.faults, MAX_UNANSWERED)


def _too_many_faults(faults: int, last: str, *, answered: bool) -> str:
    """Return the sentence that too many rows were at fault."""
    were = "row before was" if faults == 1 else "rows before were"
    return f"not asked: {faults:,} {were} at fault{'' if answered else ' and none was answered'}; the last: {last}"


class Supervisor:
    """Holds the running session, and starts another if it was lost. Raises StartError if the first cannot start.

    `start` makes a session from the number of sessions before it. `left` is what is left of the allowance. A row at
    fault is charged when it is found, so that the cost of some rows does not depend on later rows.
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
        """Return the running session, started if necessary; raises GivenUpError if the implementation was given up."""
        if not self.left.over and self._session is None:
            self._session = self._begin()
        if self.left.over or self._session is None:
            raise GivenUpError(self.left.over)
        return self._session

    def _begin(self) -> Session | None:
        """Start another session, or give the implementation up and return None."""
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
        """Give the implementation up, for this reason if it is the first."""
        self.left = replace(self.left, over=self.left.over or reason)

    def note_answer(self) -> None:
        """Note that a question was answered."""
        if self.left.hangs is not None:
            self.left = replace(self.left, hangs=None)

    def note_fault(self, fault: FaultError) -> str:
        """End the session if the fault is fatal; the reason of the fault, with the session's standard error.

        Where isolation is the reason, it ends with what to do.
        """
        session = self._session
        if session is None:
            return fault.reason
        if not fault.fatal:
            return fault.reason + session.advice(fault.reason)
        session.kill()
        self._session = None
        reason = fault.reason + session.evidence
        reason += session.advice(reason)
        self._count_hang(fault, reason)
        return reason

    def _count_hang(self, fault: FaultError, reason: str) -> None:
        """Count a timeout of an implementation that has never answered, and give it up after MAX_HANGS in a row."""
        if self.left.hangs is None:
            return
        hangs = self.left.hangs - 1 if fault.outcome is Outcome.TIMEOUT else MAX_HANGS
        self.left = replace(self.left, hangs=hangs)
        if not hangs:
            self._end(
                f"not asked: it hung on {MAX_HANGS} questions in a row and never answered any; the last: {reason}"
            )

    def charge_fault(self, fault: FaultError, reason: str) -> None:
        """Charge a row that was found to be at fault to the allowance."""
        if fault.fatal and self.left.restarts:
            self.left = replace(self.left, restarts=self.left.restarts - 1, last=reason)
        elif fault.fatal:
            self._end(f"not asked: {_used_up(self._most.restarts)}; the last process: {reason}")
        else:
            self._count_fault(reason)

    def _count_fault(self, reason: str) -> None:
        """Charge a row at fault that did not end the process, and give the implementation up if there are too many."""
        answered = self.left.hangs is None
        self.left = replace(self.left, faults=max(0, self.left.faults - 1), last=reason)
        faults = self._most.faults - self.left.faults
        if faults >= self._most.most_faults(answered=answered):
            self._end(_too_many_faults(faults, reason, answered=answered))

    def close(self) -> None:
        """Let the process end. The next question starts another, which does not count as a restart."""
        session, self._session = self._session, None
        if session:
            session.close()

    def kill(self) -> None:
        """End the process at once, though it may be working on a question."""
        session, self._session = self._session, None
        if session:
            session.kill()


def _used_up(restarts: int) -> str:
    """Return the part of a sentence about restarts that are used up."""
    if not restarts:
        return "no restart is allowed"
    return "the one restart is used up" if restarts == 1 else f"{restarts} restarts are used up"
