"""A foreign program in a process group of its own: its three pipes, its end, and the clock for its timeouts.

One loop writes, reads, and reads standard error, so that neither a large question nor much output on standard error can
make both sides wait for each other. The whole group is killed at the end, with processes that have left it. If hypcheck
itself is killed, a guard notices that and kills the group. Where the program is isolated, the launcher does both.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import select
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from typing import IO, cast

import numpy as np

from hypcheck.errors import limit_reached, system_reason
from hypcheck.geometry.pair import HEIGHTS
from hypcheck.geometry.rows import Rows, with_heights
from hypcheck.implementations.description import Description
from hypcheck.implementations.frames import WIDTH
from hypcheck.implementations.memory import GUARD, LOOK, MemoryWatch, end_marked, new_environment_mark
from hypcheck.implementations.session import FaultError, Limits, Outcome, StartError
from hypcheck.isolation.advice import isolation_advice
from hypcheck.isolation.launch import IsolationError, Launched, masked
from hypcheck.messages import escaped, printable, shortened

STEP = 0.25
"""The most seconds that count between two readings of the clock: during a longer time this process did not run."""


_WAITS = 0.05
"""Every so many seconds the system is asked how long the program waited. A wait after that counts as its own time."""

_OTHERS = 0.9
"""At most this share of a time counts as waiting for a processor: so a program cannot stop the clock by waiting."""


class Clock:
    """Counts the seconds in which the program could work and this process could read; it is read many times a second.

    It stops while this process is stopped (Ctrl-Z, a debugger, a machine that sleeps or is overloaded): a reply that
    arrives meanwhile cannot be read. It slows down while the program waits for a processor that others use. `waited`
    returns how many seconds the program waited so since the last call. Neither is a delay of the implementation.
    """

    def __init__(self, waited: Callable[[], float] = lambda: 0.0) -> None:
        self._counted, self._looked = 0.0, time.monotonic()
        self._waited, self._asked, self._off = waited, self._looked, 0.0

    def now(self) -> float:
        """Return seconds since the start."""
        looked = time.monotonic()
        if looked - self._asked >= _WAITS:
            self._off += min(self._waited(), looked - self._asked)
            self._asked = looked
        passed = min(looked - self._looked, STEP)
        off = min(self._off, _OTHERS * passed)
        self._counted += passed - off
        self._off -= off
        self._looked = looked
        return self._counted


KEPT = 16_384
"""The number of last bytes of standard error that are kept: the output before a program's end says the most."""

LINES = 3
"""The most lines of standard error in a sentence."""


def quoted(data: bytes | bytearray) -> str:
    """Return the bytes as text in quotation marks for a message, with all blanks, as one too many may be the fault."""
    lines = masked(bytes(data[:320]).decode("utf-8", "replace")).splitlines()
    return f"'{shortened(printable(' '.join(lines)), 80)}'"


class OutputTail:
    """The end of a stream of bytes since a mark, however long the stream."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def add(self, data: bytes) -> None:
        """Append data, and drop the oldest bytes."""
        self._bytes += data
        if len(self._bytes) > 2 * KEPT:
            del self._bytes[:-KEPT]

    def mark(self) -> None:
        """Discard the bytes so far: lines() then returns only later ones."""
        self._bytes.clear()

    def lines(self) -> tuple[str, ...]:
        """Return the lines since the mark that are kept, safe to print."""
        text = masked(self._bytes[-KEPT:].decode("utf-8", "replace"))
        shown = (escaped(line, WIDTH) for line in text.splitlines())
        return tuple(line for line in shown if line)


def stderr_excerpt(lines: Sequence[str]) -> str:
    """Return the last lines of standard error as the end of a sentence; empty if there are none."""
    return f"; stderr: {escaped(' | '.join(lines[-LINES:]), WIDTH)}" if lines else ""


ONE_THREAD = dict.fromkeys(
    (
        "BLIS_NUM_THREADS",
        "GOMAXPROCS",
        "JULIA_NUM_THREADS",
        "MKL_NUM_THREADS",
        "NUMBA_NUM_THREADS",
        "NUMEXPR_NUM_THREADS",
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "RAYON_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
    ),
    "1",
)
"""Environment variables that limit libraries to one thread."""

_TICK = 0.05
"""The most seconds that one call of pump() waits."""
_CHUNK = 1 << 16
_ROOM = 1 << 18
"""Bytes of a pipe's buffer if the system allows it: both sides wait for each other less often than with 64 KiB."""
_TOGETHER = 1 << 12
"""The number of bytes of a question that are written at once, even if they come in several parts."""

_SOON = 1e-4
"""A busy loop waits so many seconds for the answer to a question of _TOGETHER bytes or less: sleeping takes as long."""

_GOODBYE = 1.0
"""Seconds in which a program may end by itself after its input has ended."""

_LAST_WORDS = 0.5
"""Seconds in which a program may end after it closed its standard output."""


class Process:
    """One run of a program. Raises StartError if the system cannot run it."""

    def __init__(self, words: Sequence[str], limits: Limits, revealed: Sequence[str] = ()) -> None:
        """Start the program. If it is isolated, it sees only the `revealed` files of this package."""
        self._mark = new_environment_mark()
        environment = {**os.environ, **ONE_THREAD, self._mark: "1"}
        try:
            self._launched = Launched(words, environment, limits.isolation, revealed)
        except OSError as error:
            raise limit_reached(error) or StartError(_not_run(words[0], error)) from None
        except IsolationError as error:
            raise StartError(f"it could not be isolated: {error}; --isolate off starts it without") from None
        self._popen = self._launched.process
        self._guard = None if self._launched.isolated else _guard(self._popen.pid, self._mark)
        self._memory = MemoryWatch(self._popen.pid, self._mark, limits.memory)
        self._tail = OutputTail()
        self._outgoing: Iterator[bytes | memoryview] = iter(())
        self._part = memoryview(b"")
        self.sending = False
        """Whether the program has not read all of the question."""
        self.sent = 0
        """Bytes of the question that were written."""
        self._soon = 0.0
        self.now = Clock(self._memory.waited).now
        self._ended = False
        self._closed = False
        self._listen()
        self.incoming = bytearray()
        """Bytes of standard output that were not taken yet."""

    def _listen(self) -> None:
        self._pipes = [cast("IO[bytes]", pipe) for pipe in (self._popen.stdin, self._popen.stdout, self._popen.stderr)]
        self._in, self._out, self._err = (pipe.fileno() for pipe in self._pipes)
        self._poll = select.poll()
        for pipe in (self._in, self._out, self._err):
            os.set_blocking(pipe, False)
        for pipe in (self._in, self._out):
            _widen(pipe)
        for pipe in (self._out, self._err):
            self._poll.register(pipe, select.POLLIN)

    def send(self, parts: Iterable[bytes | memoryview]) -> None:
        """Queue bytes for its standard input; pump() writes them, and makes each part only when it writes it.

        So the program can work on the first part while the second is made.
        """
        self._outgoing = chain(self._outgoing, parts)
        self.sending = True
        self._poll.register(self._in, select.POLLOUT)

    def pump(self, until: float) -> bool:
        """Read and write once, waiting at most a moment and not beyond `until` of now(); true if `incoming` grew.

        Raises FaultError if the process ended, closed its standard output, or uses too much memory.
        """
        if self._ended:
            raise self._ending()
        self._memory.look(time.monotonic())
        grew = False
        events = self._events(until - self.now())
        for pipe, _ in events:
            if pipe == self._in:
                self._write()
            elif pipe == self._out:
                grew = self._read()
            else:
                self._hear()
        if not events and self._popen.poll() is not None:
            self._ended = True  # though one of its children holds the pipe open
        return grew

    def _events(self, seconds: float) -> list[tuple[int, int]]:
        """Wait at most so many seconds, and return the pipes that are ready, with what they are ready for."""
        while seconds > 0 and time.monotonic() < self._soon:
            if events := self._poll.poll(0):
                return events
        return self._poll.poll(1000 * min(max(seconds, 0.0), _TICK))

    def _write(self) -> None:
        try:
            while self._part or self._next_part():
                written = os.write(self._in, self._part)
                self._part = self._part[written:]
                self.sent += written
        except BlockingIOError:
            return
        except BrokenPipeError:  # it reads no more; the other pipes show whether it ended or still writes
            self._outgoing, self._part = iter(()), memoryview(b"")
        self.sending = False
        self._soon = time.monotonic() + _SOON if self.sent <= _TOGETHER else 0.0
        self._poll.unregister(self._in)

    def _next_part(self) -> bool:
        """Take the next bytes to write; the start of a question in one piece, so that the program wakes once."""
        together = bytearray()
        for some in self._outgoing:
            part = memoryview(some)
            if not together and len(part) >= _TOGETHER:
                self._part = part
                return True
            room = _TOGETHER - len(together)
            together += part[:room]
            if len(part) > room:
                self._outgoing = chain((part[room:],), self._outgoing)
                break
        self._part = memoryview(together)
        return bool(together)

    def _read(self) -> bool:
        """Read standard output into `incoming`; true if there was something."""
        data = os.read(self._out, _CHUNK)
        if not data:
            self._poll.unregister(self._out)
            self._ended = True
        self.incoming += data
        return bool(data)

    def _hear(self) -> None:
        data = os.read(self._err, _CHUNK)
        if not data:
            self._poll.unregister(self._err)
        self._tail.add(data)

    def _ending(self) -> FaultError:
        """Return the fault of a program that ended, or closed its standard output."""
        try:
            code = self._popen.wait(_LAST_WORDS)
        except subprocess.TimeoutExpired:
            return FaultError(Outcome.PROTOCOL, "it closed its standard output and did not end", fatal=True)
        return FaultError(Outcome.CRASH, _end_of(code, isolated=self._launched.isolated), fatal=True)

    def mark(self) -> None:
        """Begin a question: `stderr` returns only later output."""
        self._tail.mark()
        self.sent = 0

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines of its standard error since the mark, safe to print."""
        return self._tail.lines()

    def goodbye(self) -> None:
        """End its input and give it a moment to end by itself; then kill()."""
        if not self._closed:
            with contextlib.suppress(KeyError):
                self._poll.unregister(self._in)
            self._pipes[0].close()
            until = self.now() + _GOODBYE
            with contextlib.suppress(FaultError):
                while self.now() < until:
                    self.pump(until)
                    self.incoming.clear()
        self.kill()

    def kill(self) -> None:
        """Kill the whole group now, and processes that left it; leave neither a zombie nor an open pipe.

        A second call does nothing.
        """
        if self._closed:
            return
        self._closed = True
        self._launched.end()
        with contextlib.suppress(ProcessLookupError, PermissionError):  # the latter for a zombie on macOS
            os.killpg(self._popen.pid, signal.SIGKILL)
        if not self._launched.isolated:
            end_marked(self._mark)
        if self._guard:
            _dismiss(self._guard)
        with contextlib.suppress(subprocess.TimeoutExpired):  # it hangs in the system, and ends after that
            self._popen.wait(5)
        self._hear_the_rest()
        for pipe in self._pipes:
            pipe.close()

    def _hear_the_rest(self) -> None:
        for _ in range(64):  # a process that left the group may still be writing
            try:
                data = os.read(self._err, _CHUNK)
            except OSError:
                return
            if not data:
                return
            self._tail.add(data)


class ProcessSession:
    """The common part of all sessions of a program. Raises StartError.

    `revealed` is as in Process. A subclass reads the program's description (`_meet`), and sends questions to it.
    """

    max_rows: int | None = None

    def __init__(self, words: Sequence[str], limits: Limits, revealed: Sequence[str] = ()) -> None:
        self._limits = limits
        self._words = words
        try:
            self._begin(revealed)
        except StartError as error:
            raise StartError(f"{error}{self.advice(str(error))}") from None

    def _begin(self, revealed: Sequence[str]) -> None:
        """Start the program and read its description. Raises StartError."""
        self._process = Process(self._words, self._limits, revealed)
        try:
            self.description = self._meet()
        except BaseException:
            self._process.kill()
            raise

    def _meet(self) -> Description:
        """Return the description of the program, which has just started; raises StartError."""
        raise NotImplementedError

    def _columns(self, rows: Rows) -> Rows:
        """Return the rows with exactly the columns that the description takes."""
        layout = self.description.asked.layout
        if not self.description.heights:
            return rows
        rows = with_heights(rows, layout)
        return rows if self.description.tilt else np.hstack([rows[:, : len(layout.upright)], rows[:, -len(HEIGHTS) :]])

    @property
    def evidence(self) -> str:
        """The program's standard error since the last question, as the end of a sentence."""
        return stderr_excerpt(self._process.stderr)

    def advice(self, reason: str) -> str:
        """Return the advice if isolation caused a fault, as the end of a sentence."""
        return isolation_advice(reason, self._words, self._limits.isolation)

    def close(self) -> None:
        """End the program by ending its input."""
        self._process.goodbye()

    def kill(self) -> None:
        """Kill it now."""
        self._process.kill()


def _widen(pipe: int) -> None:
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # the user's limit for pipes may be reached
            fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, _ROOM)


def _guard(group: int, mark: str) -> subprocess.Popen[bytes] | None:
    """Return the guard of a group; None if the system has no shell."""
    try:
        return subprocess.Popen(  # noqa: S603 - the words are ours, and a number
            ("/bin/sh", "-c", GUARD, "hypcheck-guard", str(group), mark, str(LOOK), str(int(signal.SIGSTOP))),
            stdin=subprocess.PIPE,  # the guard closes the others itself: the null device may be missing
            start_new_session=True,
        )
    except OSError:
        return None


def _dismiss(guard: subprocess.Popen[bytes]) -> None:
    """End a guard, which must not see its input end first."""
    os.killpg(guard.pid, signal.SIGKILL)  # before its input ends, the sign that hypcheck was killed
    guard.communicate()


def _not_run(program: str, error: OSError) -> str:
    """Return the reason why the system could not run a program, as a sentence."""
    if isinstance(error, FileNotFoundError):
        if shutil.which(program):
            return f"the interpreter that {program!r} names in its first line was not found"
        return f"the program {program!r} was not found; it must be on the PATH, or a path from the working directory"
    if isinstance(error, PermissionError):
        return f"the program {program!r} is not executable"
    if error.errno == errno.ENOEXEC:
        return f"{program!r} is not a program for this machine: another architecture, or a script without a #! line"
    return f"the system could not run the program {program!r}: {system_reason(error)}"


_OTHER_CAUSES = {int(signal.SIGKILL): "; the system does that too when memory runs out"}
_BY_ISOLATION = {
    31: "; isolation does that when it makes a system call that only an attack makes",
    25: "; isolation does that when it writes more than fits the scratch folder",
}
"""Other causes of a signal than the program, by its number; 31 and 25 are SIGSYS and SIGXFSZ."""


def _end_of(code: int, *, isolated: bool) -> str:
    """Return the end of a process with this return code, in words."""
    if code < 0:
        others = _OTHER_CAUSES | (_BY_ISOLATION if isolated else {})
        return f"it was ended by {_signal_name(-code)}{others.get(-code, '')}"
    by_shell = f", as a shell reports {_signal_name(code - 128)}" if code > 128 and _signal_name(code - 128) else ""
    return f"it ended by itself with exit status {code}{by_shell}"


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}" if number < 65 else ""
