"""Questions about rows: a fault costs only the row that causes it, which is found by asking smaller parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import CANNOT_SAY, Floats, Mask, Rows, invalid
from hypcheck.implementations.description import Description
from hypcheck.implementations.frames import UNWRITTEN, GivenAnswers
from hypcheck.implementations.session import FaultError, GivenUpError, Outcome, Supervisor

ALONE = 4096
"""Rows that are asked one by one to find the one that ends the process; more rows are first asked in such parts.

Thus the search costs at most two more processes, and one for each further such row. Rows that end no process are found
by halving.
"""


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
        """These answers, one for every row."""
        return cls(answers, np.full(len(answers), Outcome.ANSWERED, dtype=np.int8), {}, times)

    @property
    def answered(self) -> NDArray[np.bool_]:
        """A mask (n,) of the rows that have an answer."""
        return np.asarray(self.status == Outcome.ANSWERED)

    @property
    def outcomes(self) -> frozenset[Outcome]:
        """All ways in which rows ended."""
        if not self.reasons:
            return frozenset({Outcome.ANSWERED}) if len(self.status) else frozenset()
        return frozenset(map(Outcome, np.unique(self.status).tolist()))

    def count(self, outcome: Outcome) -> int:
        """The number of rows with this outcome."""
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

    def understood(self, given: GivenAnswers, rows: Rows) -> Mask:
        """A mask (n,) of the allowed answers. REFUSED is allowed for invalid rows only; a time is from 0 to 1."""
        answers, times = given
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
        """Why an answer with this time is not allowed."""
        if answer == 1 and time is not None:
            return f"it answered 1 with the time {time!r}; it must be a number from 0 to 1"
        if answer == REFUSED and self._refuses:
            return f"it answered {REFUSED}, which refuses the row, but the row is valid"
        hint = ", the value of positions that a library did not write" if answer == UNWRITTEN else ""
        return f"it answered {answer}{hint}; it must be one of {', '.join(map(str, self.answers))} or {CANNOT_SAY}"


class RowQuestions:
    """The rows of one call of classify, and their answers so far."""

    def __init__(self, rows: Rows, supervisor: Supervisor, allowed_answers: AllowedAnswers, *, by_scene: bool) -> None:
        n = len(rows)
        self._rows = rows
        self._supervisor = supervisor
        self._allowed = allowed_answers
        self._by_scene = by_scene
        times = np.full(n, np.nan) if allowed_answers.times else None
        self.result = Answered(np.full(n, CANNOT_SAY, np.int8), np.full(n, Outcome.NOT_RUN, np.int8), {}, times)

    def ask(self, start: int, stop: int) -> None:
        """Ask rows [start, stop), together if possible; raises GivenUpError if the implementation is given up."""
        try:
            self._question(start, stop)
        except FaultError as fault:
            self._search(start, stop, fault, self._supervisor.note_fault(fault))

    def leave(self, reason: str) -> None:
        """Set the reason of all rows that were not asked."""
        left = np.flatnonzero(self.result.status == Outcome.NOT_RUN)
        self.result.reasons.update(dict.fromkeys(left.tolist(), reason))

    def _question(self, start: int, stop: int) -> None:
        rows = self._rows[start:stop]
        given = self._supervisor.session().classify(rows, by_scene=self._by_scene)
        self._supervisor.note_answer()
        answers, times = given
        understood = self._allowed.understood(given, rows)
        self.result.answers[start:stop] = np.where(understood, answers, CANNOT_SAY)
        self.result.status[start:stop] = Outcome.ANSWERED
        if self.result.times is not None and times is not None:
            self.result.times[start:stop] = np.where(understood & (answers == 1), times, np.nan)
        for index in np.flatnonzero(~understood).tolist():
            time = None if times is None else float(times[index])
            self._mark(start + index, Outcome.PROTOCOL, self._allowed.trouble_with(int(answers[index]), time))

    def _search(self, start: int, stop: int, fault: FaultError, reason: str) -> None:
        """Find the rows at fault by asking parts, and parts of the parts that fail.

        Only the rows at fault are charged, because the cost of the search depends on how many rows were asked at once.
        """
        if stop - start == 1:
            self._charge(start, fault, reason)
            return
        among = f"in a question of {stop - start} rows"
        found, restarts = False, self._supervisor.left.restarts
        size = _part(stop - start, fatal=fault.fatal)
        for first in range(start, stop, size):
            last = min(first + size, stop)
            try:
                self._question(first, last)
            except FaultError as part:
                found = True
                self._search(first, last, part, self._supervisor.note_fault(part))
            except GivenUpError:
                if not found:
                    unknown = f"{among}, and it could not be asked further to find which: {reason}"
                    self._mark(first, fault.outcome, unknown)
                raise
        if not found:
            self._charge(start, fault, f"{among} from this one on, though not in smaller ones: {reason}")
        elif fault.fatal and self._supervisor.left.restarts == restarts:  # its parts failed, but ended no process
            self._supervisor.charge_fault(fault, reason)

    def _charge(self, index: int, fault: FaultError, reason: str) -> None:
        self._mark(index, fault.outcome, reason)
        self._supervisor.charge_fault(fault, reason)

    def _mark(self, index: int, outcome: Outcome, reason: str) -> None:
        self.result.answers[index] = CANNOT_SAY
        self.result.status[index] = outcome
        self.result.reasons[index] = reason


def _part(n: int, *, fatal: bool) -> int:
    """The size of the parts of n rows that failed: halves; if failing ends the process, ALONE rows, then one."""
    if not fatal:
        return (n + 1) // 2
    return ALONE if n > ALONE else 1
