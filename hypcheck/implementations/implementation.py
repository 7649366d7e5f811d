"""An implementation under test in any language: opened from a SPEC, tested on rows, timed, restarted.

A fault costs only the row that causes it, which is found by sending smaller parts of a question.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from functools import partial
from types import TracebackType

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY, Rows, as_rows, parts_of, scenes_of, with_axis
from hypcheck.implementations.description import Description
from hypcheck.implementations.domain import Domain
from hypcheck.implementations.frames import LARGEST
from hypcheck.implementations.protocol import CommandSession
from hypcheck.implementations.session import (
    Allowance,
    AllowedAnswers,
    Answered,
    FaultError,
    GivenUpError,
    Limits,
    Outcome,
    Session,
    StartError,
    Supervisor,
    TimingError,
)
from hypcheck.implementations.spec import Spec, parse_spec
from hypcheck.implementations.worker_session import WorkerSession
from hypcheck.messages import counted

MAX_FAULTS = 1 << 14
"""The number of rows that may fail without ending the process: it spares testing every row of a broken one."""

_FIRST, _GROWTH = 64, 16
_SHARE = 10
"""The first batch has _FIRST rows. Batches grow by up to _GROWTH times, until one takes the timeout divided by _SHARE,
so that a slow implementation gets small batches, and does not look like one that hangs."""

_SLACK_NS, _MAX_RATIO = 5_000_000_000, 20
"""A timed question may take this time by our clock for transport and warm-up, and so many times the reported time.

An implementation that reports microseconds as nanoseconds would look a thousand times as fast, and get that much more
work.
"""


class Implementation:
    """An implementation under test, a context manager. Its process is restarted after faults, as the limits allow.

    `declared` is its own description; `description` is the same with the values that the caller replaces.
    """

    def __init__(
        self,
        spec: Spec,
        start: Callable[[int], Session],
        limits: Limits,
        instead: Callable[[Description], Description],
    ) -> None:
        self.spec = spec
        self._supervisor = Supervisor(start, Allowance(limits.restarts, MAX_FAULTS))
        try:
            self.declared = self._supervisor.declared
            self.description = instead(self.declared)
        except BaseException:
            self._supervisor.kill()
            raise
        self._allowed = AllowedAnswers(self.description)
        self._limits = limits
        self.max_rows = self._supervisor.max_rows
        """The most rows of a family that it answers in reasonable time; None if that is not known."""
        self.scene = self._supervisor.scene
        """Whether it has a function for scenes: one set of sizes, many centres."""
        self.proven_batch = min(_FIRST, self._supervisor.max_batch)
        """Largest batch that it has answered well within the timeout so far."""

    def __enter__(self) -> Implementation:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self._supervisor.kill()

    @property
    def allowance(self) -> Allowance:
        """The faults that it may still have."""
        return self._supervisor.left

    @allowance.setter
    def allowance(self, allowance: Allowance) -> None:
        self._supervisor.left = allowance

    def close(self) -> None:
        """End the process; kill it if it does not end in time. The next question starts another: that is no restart."""
        self._supervisor.close()

    def kill(self) -> None:
        """Kill the process now."""
        self._supervisor.kill()

    def classify(self, rows: Rows, *, batch: int | None = None, by_scene: bool = False) -> Answered:
        """Return the answers to rows, float64 (n, 7), and the faults of rows without an answer.

        Sweeps have rows (n, 10). If the description says tilt, rows may also have the three numbers of an axis; the
        implementation then gets all rows with an axis. A question has `batch` rows; by default it has as many as the
        implementation has shown to answer in time.

        `by_scene` uses the entry for scenes. Raises InputError if there is no such entry, if the sizes differ, or if
        the values are not rows.
        """
        rows = self._rows(rows)
        self._check_scene(rows, by_scene=by_scene)
        asking = RowQuestions(rows, self._supervisor, self._allowed, by_scene=by_scene)
        try:
            self._ask_all(asking, len(rows), batch)
        except GivenUpError as error:
            asking.leave(str(error))
        except BaseException:  # an interrupt leaves a question without its answer
            self._supervisor.kill()
            raise
        return asking.result

    def _ask_all(self, asking: RowQuestions, n: int, batch: int | None) -> None:
        """Send all rows in batches, whose size follows the time that they take unless `batch` is given."""
        start = 0
        while start < n:
            size = min(batch or self.proven_batch, self._supervisor.max_batch)
            stop = min(n, start + size)
            began = time.monotonic()
            asking.ask(start, stop)
            if batch is None:
                self._adapt(time.monotonic() - began, stop - start)
            start = stop

    def _adapt(self, seconds: float, rows: int) -> None:
        """Adapt the size of batches to the time that a batch of so many rows took."""
        target = self._limits.timeout / _SHARE
        if seconds > target:
            self.proven_batch = max(1, self.proven_batch // 2)
        elif seconds < target / 2:
            growth = _GROWTH if seconds < target / _GROWTH else 2
            self.proven_batch = max(self.proven_batch, min(self._supervisor.max_batch, rows * growth))

    def time(self, rows: Rows, repeat: int, *, by_scene: bool = False, row_by_row: bool = False) -> int | None:
        """Return nanoseconds, by its own clock, for `repeat` times the rows, 65,536 at most.

        Return None if it offers no timing.

        `row_by_row` makes one call for each row. A library may be timed on no rows too: that is the cost of a call.

        Raises TimingError where it fails, where it took far longer than it says, or where its checksum is not the sum
        of its answers, taken once or for each repetition.
        """
        rows = self._rows(rows)
        self._check_scene(rows, by_scene=by_scene)
        least = 0 if self.spec.kind == "library" else 1
        if not least <= len(rows) <= LARGEST or repeat < 1:
            request = f"{counted(len(rows), 'row')} cannot be timed {counted(repeat, 'time')}"
            raise InputError(f"{request}; {least} to {LARGEST} rows can be timed, once or more")
        try:
            session = self._supervisor.session()
            began = time.monotonic_ns()
            times = session.time(rows, repeat, by_scene=by_scene, row_by_row=row_by_row)
            took = time.monotonic_ns() - began
        except FaultError as fault:
            reason = self._supervisor.note_fault(fault)
            self._supervisor.charge_fault(fault, reason)
            raise TimingError(f"{self.spec} could not be timed: {reason}") from None
        except GivenUpError as error:
            raise TimingError(f"{self.spec} could not be timed: {error}") from None
        except BaseException:
            self._supervisor.kill()
            raise
        if times is None:
            return None
        questions = len(rows) if row_by_row else 1
        if took > _SLACK_NS * max(1, questions) + _MAX_RATIO * times[0]:
            raise TimingError(f"{self.spec} says that it took {times[0]:,} ns for what took {took:,} ns by our clock")
        answered = self.classify(rows, by_scene=by_scene)
        total = int(answered.answers.sum(dtype=np.int64))
        if not answered.answered.all() or times[1] not in {total, total * repeat}:
            raise TimingError(f"{self.spec} was timed with the checksum {times[1]}, but its answers sum to {total}")
        return times[0]

    def _rows(self, rows: Rows) -> Rows:
        """Return the rows in the layout of the implementation. Raises InputError if they are not rows that it takes."""
        tilt, layout = self.description.tilt, self.description.asked.layout
        rows = as_rows(rows, self.description.groups, layout)
        if not tilt and layout.has_heights(rows) and parts_of(rows, layout)[1][:, :2].any():  # the length is free
            raise InputError(f"{self.spec} takes no axis, and not all of the rows are upright")
        return with_axis(rows, layout) if tilt else rows

    def _check_scene(self, rows: Rows, *, by_scene: bool) -> None:
        """Raise InputError if the rows cannot be answered by the function for scenes."""
        if by_scene and not self.scene:
            raise InputError(f"{self.spec} has no function for scenes")
        if by_scene and len(scenes_of(rows)) > 1:
            raise InputError(f"{self.spec} cannot answer rows of several sizes by its function for scenes")


ALONE = 4096
"""Rows that are tested one by one to find the one that ends the process; more rows are first tested in such parts.

Thus the search costs at most two more processes, and one for each further such row. Rows that end no process are found
by halving.
"""


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
        """Send rows [start, stop), together if possible. Raises GivenUpError if the implementation is given up."""
        try:
            self._question(start, stop)
        except FaultError as fault:
            self._search(start, stop, fault, self._supervisor.note_fault(fault))

    def leave(self, reason: str) -> None:
        """Set the reason of all rows that were not sent to the implementation."""
        left = np.flatnonzero(self.result.status == Outcome.NOT_RUN)
        self.result.reasons.update(dict.fromkeys(left.tolist(), reason))

    def _question(self, start: int, stop: int) -> None:
        """Send rows [start, stop) in one question and keep the answers. Raises FaultError and GivenUpError."""
        rows = self._rows[start:stop]
        reply = self._supervisor.session().classify(rows, by_scene=self._by_scene)
        self._supervisor.note_answer()
        answers, times = reply
        understood = self._allowed.understood(reply, rows)
        self.result.answers[start:stop] = np.where(understood, answers, CANNOT_SAY)
        self.result.status[start:stop] = Outcome.ANSWERED
        if self.result.times is not None and times is not None:
            self.result.times[start:stop] = np.where(understood & (answers == 1), times, np.nan)
        for index in np.flatnonzero(~understood).tolist():
            time = None if times is None else float(times[index])
            self._mark(start + index, Outcome.PROTOCOL, self._allowed.trouble_with(int(answers[index]), time))

    def _search(self, start: int, stop: int, fault: FaultError, reason: str) -> None:
        """Find the rows at fault by sending parts, and parts of the parts that fail.

        Only the rows at fault are charged, because the cost of the search depends on the size of the question.
        """
        if stop - start == 1:
            self._charge(start, fault, reason)
            return
        among = f"in a question of {stop - start} rows"
        part_failed, restarts = False, self._supervisor.left.restarts
        size = _part(stop - start, fatal=fault.fatal)
        for first in range(start, stop, size):
            last = min(first + size, stop)
            try:
                self._question(first, last)
            except FaultError as part:
                part_failed = True
                self._search(first, last, part, self._supervisor.note_fault(part))
            except GivenUpError:
                if not part_failed:
                    unknown = f"{among}, and it could not be asked further to find which: {reason}"
                    self._mark(first, fault.outcome, unknown)
                raise
        if not part_failed:
            self._charge(start, fault, f"{among} from this one on, though not in smaller ones: {reason}")
        elif fault.fatal and self._supervisor.left.restarts == restarts:  # its parts failed, but ended no process
            self._supervisor.charge_fault(fault, reason)

    def _charge(self, index: int, fault: FaultError, reason: str) -> None:
        """Mark a row as at fault, and charge it to the allowance."""
        self._mark(index, fault.outcome, reason)
        self._supervisor.charge_fault(fault, reason)

    def _mark(self, index: int, outcome: Outcome, reason: str) -> None:
        """Set the outcome of a row without a valid answer, and the reason."""
        self.result.answers[index] = CANNOT_SAY
        self.result.status[index] = outcome
        self.result.reasons[index] = reason


def _part(n: int, *, fatal: bool) -> int:
    """Return the size of the parts of n rows that failed: halves; if failing ends the process, ALONE rows, then one."""
    if not fatal:
        return (n + 1) // 2
    return ALONE if n > ALONE else 1


class Crashed:
    """A stand-in that reports CRASH for every row, for an implementation that keeps killing our workers.

    It has the members that a run uses. It spends nothing of the allowance, since no process of its own is known to be
    lost.
    """

    proven_batch = 1
    scene = False

    def __init__(self, most: int | None, reason: str, allowance: Allowance) -> None:
        self.max_rows = most
        self.allowance = allowance
        self._reason = reason

    def close(self) -> None:
        """Do nothing: there is no process."""

    def classify(self, rows: Rows, *, batch: int | None = None, by_scene: bool = False) -> Answered:  # noqa: ARG002 - however it is asked
        """Return CRASH for every row."""
        n = len(rows)
        status = np.full(n, Outcome.CRASH, dtype=np.int8)
        return Answered(np.full(n, CANNOT_SAY, dtype=np.int8), status, dict.fromkeys(range(n), self._reason))


def open_implementation(
    text: str,
    limits: Limits | None = None,
    *,
    precision: str | None = None,
    question: str | None = None,
    domain: Domain | None = None,
) -> Implementation:
    """Return the implementation that a SPEC names, running.

    `precision`, `question` and `domain` replace what it declares.

    Raises InputError if the text is not a SPEC, and StartError if the implementation cannot be started.
    """
    spec = parse_spec(text)
    limits = limits or Limits()
    instead = partial(Description.overridden, precision=precision, question=question, domain=domain)
    try:
        return Implementation(spec, partial(_session, spec, limits), limits, instead)
    except StartError as error:
        raise StartError(f"{spec} could not be started: {error}") from None


def require_named(specs: Iterable[str]) -> None:
    """Raise InputError if one of these texts is not a SPEC, or names a built-in method that does not exist."""
    for spec in map(parse_spec, specs):
        if spec.kind == "builtin":
            _builtin_session(spec)


def _session(spec: Spec, limits: Limits, run: int) -> Session:
    """Return a session of what a SPEC names; `run` counts those before it."""
    if spec.kind == "builtin":
        return _builtin_session(spec)
    if spec.kind == "command":
        return CommandSession(spec.words, limits)
    return WorkerSession(spec, limits, run)


def _builtin_session(spec: Spec) -> Session:
    """Return the session of a built-in method. Raises InputError if there is none of that name."""
    from hypcheck.implementations.builtin import BuiltinSession  # noqa: PLC0415 - loads every formula

    return BuiltinSession(spec.words[0])
