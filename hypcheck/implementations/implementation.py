"""An implementation under test in any language: opened from a SPEC, asked about rows, timed, restarted.

An implementation under test, whatever it is written in: asked about rows, timed, and begun afresh.

From a SPEC to an implementation that can be asked.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from types import MappingProxyType, TracebackType

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import CANNOT_SAY, Rows, as_rows, with_axis
from hypcheck.implementations.description import Description, Domain
from hypcheck.implementations.frames import LARGEST
from hypcheck.implementations.protocol import CommandSession
from hypcheck.implementations.questions import AllowedAnswers, Answered, RowQuestions
from hypcheck.implementations.session import (
    Allowance,
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
"""Rows of one implementation that may be at fault without ending it: who always fails is not asked for every row."""

_FIRST, _GROWTH = 64, 16
_SHARE = 10
"""Questions begin small and grow until one takes this part of the timeout: who is slow is asked less at once, and is
not taken for one that hangs."""

_SLACK_NS, _UNSEEN = 5_000_000_000, 20
"""What a timed question may take by our clock: seconds for the way there and a warming up, and so often what it says.

Whoever tells microseconds for nanoseconds would seem a thousand times as fast, and be asked for as much more work.
"""


class Implementation:
    """A context manager; its process is started again after a fault, as often as the limits allow.

    `declared` is what it says of itself, `description` that with what the caller says instead.
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
        self._batch = min(_FIRST, self._supervisor.max_batch)

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
    def max_batch(self) -> int:
        """Rows of one question, at most."""
        return self._supervisor.max_batch

    @property
    def max_rows(self) -> int | None:
        """Rows of a family that it is fast enough for; None where nothing is known of that."""
        return self._supervisor.max_rows

    @property
    def scene(self) -> bool:
        """Whether it can be asked by scene: one set of sizes, many centres."""
        return self._supervisor.scene

    @property
    def proven_batch(self) -> int:
        """Rows of one question that it has shown to answer well within its time."""
        return self._batch

    @property
    def allowance(self) -> Allowance:
        """What it may still cost."""
        return self._supervisor.left

    def allow(self, allowance: Allowance) -> None:
        """From here on it may cost so much, whatever it has cost before."""
        self._supervisor.left = allowance

    @property
    def restarts(self) -> int:
        """Restarts that faults have cost, of those that the limits allow."""
        return self._limits.restarts - self._supervisor.left.restarts

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines that the running process wrote on standard error, safe to print."""
        return self._supervisor.stderr

    def use_fresh_process(self) -> None:
        """Go on in a fresh process, which does not count as a restart."""
        self._supervisor.close()

    def close(self) -> None:
        """Let the process leave, or end it where it does not."""
        self._supervisor.close()

    def kill(self) -> None:
        """End the process now, whatever it is at."""
        self._supervisor.kill()

    def classify(self, rows: Rows, *, batch: int | None = None, by_scene: bool = False) -> Answered:
        """What becomes of rows, float64 (n, 7): asked in questions of `batch` rows, or of as many as it can stand.

        Where its description says tilt, rows may have ten numbers, and it is asked all of them in ten.

        `by_scene` asks through the entry for scenes; raises InputError where there is none, or sizes differ, and where
        rows are none.
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
        start = 0
        while start < n:
            size = min(batch or self._batch, self._supervisor.max_batch)
            stop = min(n, start + size)
            began = time.monotonic()
            asking.ask(start, stop)
            if batch is None:
                self._adapt(time.monotonic() - began, stop - start)
            start = stop

    def _adapt(self, seconds: float, rows: int) -> None:
        target = self._limits.timeout / _SHARE
        if seconds > target:
            self._batch = max(1, self._batch // 2)
        elif seconds < target / 2:
            growth = _GROWTH if seconds < target / _GROWTH else 2
            self._batch = max(self._batch, min(self._supervisor.max_batch, rows * growth))

    def time(self, rows: Rows, repeat: int, *, by_scene: bool = False, each: bool = False) -> int | None:
        """Nanoseconds, by its own clock, for `repeat` times the rows, 65,536 at most; None where it offers no timing.

        `each`: by a call for each row. Of a library no rows may be timed too: what a call takes.

        Raises TimingError where it fails, where it took far longer than it says, or where its checksum is not the sum
        of its answers, taken once or for each repetition.
        """
        rows = self._rows(rows)
        self._check_scene(rows, by_scene=by_scene)
        least = 0 if self.spec.kind == "library" else 1
        if not least <= len(rows) <= LARGEST or repeat < 1:
            asked = f"{counted(len(rows), 'row')} cannot be timed {counted(repeat, 'time')}"
            raise InputError(f"{asked}; {least} to {LARGEST} can, once or more")
        try:
            session = self._supervisor.session()
            began = time.monotonic_ns()
            times = session.time(rows, repeat, by_scene=by_scene, each=each)
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
        questions = len(rows) if each else 1
        if took > _SLACK_NS * max(1, questions) + _UNSEEN * times[0]:
            raise TimingError(f"{self.spec} says that it took {times[0]:,} ns for what took {took:,} ns by our clock")
        answered = self.classify(rows, by_scene=by_scene)
        total = int(answered.answers.sum(dtype=np.int64))
        if not answered.answered.all() or times[1] not in {total, total * repeat}:
            raise TimingError(f"{self.spec} was timed with the checksum {times[1]}, but its answers sum to {total}")
        return times[0]

    def _rows(self, rows: Rows) -> Rows:
        """The rows as it is asked them; raises InputError where they are none, or tilted and it does not take these."""
        rows = as_rows(rows, tilted=self.description.tilt)
        return with_axis(rows) if self.description.tilt else rows

    def _check_scene(self, rows: Rows, *, by_scene: bool) -> None:
        if by_scene and not self.scene:
            raise InputError(f"{self.spec} cannot be asked by scene")
        fixed = np.delete(rows, (4, 5, 6), axis=1)
        if by_scene and len(rows) and (fixed != fixed[0]).any():
            raise InputError(f"{self.spec} cannot be asked by scene about rows of several sizes")


class Crashed:
    """Stands for an implementation where asking it keeps ending our own processes: each row ends as CRASH.

    Of it a run uses what is here. It costs nothing of the allowance: no process of its own was lost that we know of.
    """

    proven_batch = 1

    def __init__(self, most: int | None, reason: str, allowance: Allowance) -> None:
        self.max_rows = most
        self.allowance = allowance
        self._reason = reason

    def allow(self, allowance: Allowance) -> None:
        """From here on it may cost so much."""
        self.allowance = allowance

    def use_fresh_process(self) -> None:
        """There is no process to begin afresh."""

    def classify(self, rows: Rows, *, batch: int | None = None) -> Answered:  # noqa: ARG002 - however it is asked
        """No row has an answer."""
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
    """The implementation that a SPEC names, running; `precision`, `question` and `domain` stand for what it declares.

    Raises InputError where the SPEC is none, and StartError where the implementation cannot be started.
    """
    spec = parse_spec(text)
    limits = limits or Limits()

    def start(run: int) -> Session:
        return STARTS[spec.kind](spec, limits, run)

    def instead(declared: Description) -> Description:
        return declared.overridden(precision, question, domain)

    try:
        return Implementation(spec, start, limits, instead)
    except StartError as error:
        raise StartError(f"{spec} could not be started: {error}") from None


def _start_builtin(spec: Spec, limits: Limits, run: int) -> Session:  # noqa: ARG001 - ours, so it is not limited
    from hypcheck.implementations.builtin import BuiltinSession  # noqa: PLC0415 - loads every formula

    return BuiltinSession(spec.words[0])


def _start_command(spec: Spec, limits: Limits, run: int) -> Session:  # noqa: ARG001 - nothing varies between runs
    return CommandSession(spec.words, limits)


STARTS: Mapping[str, Callable[[Spec, Limits, int], Session]] = MappingProxyType(
    {"builtin": _start_builtin, "python": WorkerSession, "library": WorkerSession, "command": _start_command}
)
"""How each kind of SPEC is started; spec.py says how each is written."""
