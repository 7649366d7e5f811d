"""Replies of implementations, read by their sessions: a pipe of given bytes replaces the process.

Everything else is real: the sessions, the questions, the search for a row at fault, restarts.
"""

from __future__ import annotations

import time
from random import Random

from hypcheck.geometry.rows import as_rows
from hypcheck.implementations import frames
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.protocol import CommandSession
from hypcheck.implementations.session import FaultError, Limits, Outcome, TimingError
from hypcheck.implementations.spec import parse_spec
from hypcheck.implementations.worker_session import WorkerSession
from tests.tools.fuzz import seeds
from tests.tools.fuzz.judging import require_sentence

LIMITS = Limits(startup_timeout=0.002, timeout=0.002, restarts=2)
QUESTIONS = as_rows(seeds.ROWS)


class Pipe:
    """A process that says given bytes, a part at each question, in pieces as they may come."""

    def __init__(self, data: bytes, random: Random) -> None:
        self.incoming = bytearray()
        self.sending, self.sent = False, 0
        self.stderr = ()
        self._parts, self._random = data.split(seeds.SEPARATOR)[::-1], random
        self._said = self._parts.pop()

    def now(self) -> float:
        """The time, for it is always looked at."""
        return time.monotonic()

    def mark(self) -> None:
        """A question begins."""
        self.sent = 0

    def send(self, parts) -> None:
        """Take a question; what it is does not matter."""
        head, *rows = [bytes(part) for part in parts]
        self.sent += len(head) + sum(map(len, rows))
        reply = self._parts.pop() if self._parts else b""
        self._said += marked(reply, head) if self._random.random() < 0.9 else reply

    def pump(self, until: float) -> bool:
        """The next piece, if there is one."""
        if not self._said:
            if not self._parts and until:
                raise FaultError(Outcome.CRASH, "it ended by itself with exit status 0", fatal=True)
            return False
        size = self._random.choice((1, 7, 65536))
        self.incoming += self._said[:size]
        self._said = self._said[size:]
        return True

    def kill(self) -> None:
        """It has no end."""

    goodbye = kill


def marked(reply: bytes, request: bytes) -> bytes:
    """The reply of a worker with the mark of its request, as a real one has it."""
    if len(request) != frames.REQUEST.size or len(reply) < frames.REPLY.size:
        return reply
    return reply[: frames.REPLY.size - 8] + request[-8:] + reply[frames.REPLY.size :]


def _command(data: bytes, random: Random) -> CommandSession:
    session = object.__new__(CommandSession)
    session._words, session._limits, session._sequence, session._known = ("program",), LIMITS, 0, None
    session._process = Pipe(data, random)
    session.description = session._meet()
    session.max_batch = 65536
    return session


def _worker(data: bytes, random: Random) -> WorkerSession:
    session = object.__new__(WorkerSession)
    session._words, session._limits, session._spec = ("program",), LIMITS, SPEC
    session._process = Pipe(data, random)
    session.description = session._meet()
    return session


SPEC = parse_spec("python:package.module:function")


def _asked(data: bytes, begin) -> None:
    """Ask a few rows, once more, and time it; every reason that is given must be a sentence."""
    random = Random(len(data))  # noqa: S311 - nothing secret
    with Implementation(SPEC, lambda _: begin(data, random), LIMITS, lambda declared: declared) as implementation:
        for rows in (QUESTIONS, QUESTIONS[:1]):
            answered = implementation.classify(rows)
            for reason in answered.reasons.values():
                require_sentence(reason)
        try:
            implementation.time(QUESTIONS, 2)
        except TimingError as error:
            require_sentence(str(error))


def command(data: bytes) -> None:
    """The bytes are what a command says."""
    _asked(data, _command)


def worker(data: bytes) -> None:
    """The bytes are what came from our own worker, into whose pipe foreign code may have written."""
    _asked(data, _worker)
