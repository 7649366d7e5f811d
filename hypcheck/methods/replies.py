"""Replies of a command: when one is complete, what it says, and what is wrong with it."""

from __future__ import annotations

import re

import numpy as np

from hypcheck.methods.evidence import WIDTH, quoted
from hypcheck.methods.faults import FaultError, Outcome
from hypcheck.methods.frames import integers
from hypcheck.methods.session import Answers
from hypcheck.visible import visible

_HEAD = re.compile(rb"(\d{1,19}) (\d{1,19})\r?\n")
_TIMES = re.compile(rb"(\d{1,19}) (\d{1,18}) ([+-]?\d{1,18})\r?\n")
_INTEGER = re.compile(rb"[ \t]*([+-]?\d{1,18})[ \t\r]*")
_USUAL = {b"0": 0, b"1": 1, b"-1": -1, b"2": 2, b"127": 127}
_LINE = 64
"""Bytes of a line that holds one integer, with room for blanks."""
_FIRST_LINE = 4096
"""Bytes of a reply's first line, which may be an error's text."""


def broken(reason: str) -> FaultError:
    """The protocol was broken in a way after which nothing that follows can be trusted."""
    return FaultError(Outcome.PROTOCOL, reason, fatal=True)


class Reply:
    """The reply to one question: what is expected of it."""

    def __init__(self, sequence: int) -> None:
        self.sequence = sequence
        self.error: str | None = None
        """The text of `error TEXT`, once the reply is found to be that."""

    def length(self, incoming: bytearray) -> int:
        """Bytes of the complete reply that `incoming` begins with, 0 while it is incomplete.

        Raises FaultError where no reply to the question begins so.
        """
        end = incoming.find(b"\n") + 1
        if not end:
            if len(incoming) > _FIRST_LINE:
                raise broken(f"a line of its reply does not end within {_FIRST_LINE} bytes: {quoted(incoming)}")
            return 0
        if incoming.startswith((b"error ", b"error\n", b"error\r")):
            self.error = visible(incoming[6:end].decode("utf-8", "replace"), WIDTH) or "(without a text)"
            return end
        return self._after(incoming, end)

    def _after(self, incoming: bytearray, end: int) -> int:
        """The same for what follows the first line, which ends at `end`."""
        raise NotImplementedError

    def share(self, incoming: bytearray) -> float:  # noqa: ARG002 - of one line none is a share
        """The part of an incomplete reply's answers that have come, from 0 to 1."""
        return 0.0

    def progress(self, incoming: bytearray) -> str:
        """How far an incomplete reply has come."""
        return f"only {quoted(incoming)} of a reply" if incoming else "no reply"

    def _same_sequence(self, sequence: int) -> None:
        if sequence < self.sequence:
            raise broken(f"it replied to question {sequence} again, when {self.sequence} was asked")
        if sequence > self.sequence:
            raise broken(f"it replied to question {sequence}, when {self.sequence} had got no reply")


class _Answers(Reply):
    def __init__(self, sequence: int, n: int) -> None:
        super().__init__(sequence)
        self._n = n

    def _check_head(self, incoming: bytearray, end: int) -> None:
        head = _HEAD.fullmatch(incoming, 0, end)
        if not head:
            raise broken(f"it wrote {quoted(incoming[:end])} where '{self.sequence} {self._n}' had to come")
        self._same_sequence(int(head[1]))
        if int(head[2]) != self._n:
            raise broken(f"it announced {int(head[2])} answers to {self._n} rows")

    def _so_far(self, incoming: bytearray, end: int) -> int:
        raise NotImplementedError

    def share(self, incoming: bytearray) -> float:
        end = incoming.find(b"\n") + 1
        return self._so_far(incoming, end) / self._n if end and self._n else 0.0

    def progress(self, incoming: bytearray) -> str:
        end = incoming.find(b"\n") + 1
        return f"{self._so_far(incoming, end)} of {self._n} answers" if end else super().progress(incoming)


class BinaryReply(_Answers):
    """`SEQ N` and N bytes."""

    def _after(self, incoming: bytearray, end: int) -> int:
        self._check_head(incoming, end)
        return end + self._n if len(incoming) >= end + self._n else 0

    def _so_far(self, incoming: bytearray, end: int) -> int:
        return len(incoming) - end

    def integers(self, reply: bytes) -> Answers:
        """The answers of a complete reply."""
        return integers(reply[-self._n :], 1)


class TextReply(_Answers):
    """`SEQ N` and N lines of one integer."""

    def _after(self, incoming: bytearray, end: int) -> int:
        self._check_head(incoming, end)
        missing = self._n - incoming.count(b"\n", end)
        if missing > 0:
            if len(incoming) > end + _LINE * (self._n + 1):
                raise broken(f"its lines of one integer are longer than {_LINE} bytes: {quoted(incoming[-_LINE:])}")
            return 0
        length = len(incoming)
        for _ in range(1 - missing):
            length = incoming.rfind(b"\n", 0, length)
        return length + 1

    def _so_far(self, incoming: bytearray, end: int) -> int:
        return incoming.count(b"\n", end)

    def integers(self, reply: bytes) -> Answers:
        """The answers of a complete reply; raises FaultError naming the first line that is none."""
        lines = reply.split(b"\n")[1:-1]
        values = [_USUAL.get(line) for line in lines]
        if None in values:
            values = [self._integer(number, line) for number, line in enumerate(lines, start=1)]
        return np.array(values, dtype=np.int64)

    def _integer(self, number: int, line: bytes) -> int:
        match = _INTEGER.fullmatch(line)
        if not match:
            raise broken(f"answer {number} of {self._n} is {quoted(line)}; it must be an integer on a line of its own")
        return int(match[1])


class TimeReply(Reply):
    """`SEQ NANOSECONDS CHECKSUM`."""

    def _after(self, incoming: bytearray, end: int) -> int:
        match = _TIMES.fullmatch(incoming, 0, end)
        if not match:
            raise broken(f"it wrote {quoted(incoming[:end])} where '{self.sequence} NANOSECONDS CHECKSUM' had to come")
        self._same_sequence(int(match[1]))
        return end

    def times(self, line: bytes) -> tuple[int, int]:
        """Nanoseconds and checksum of the complete reply."""
        _, nanoseconds, checksum = line.split()
        return int(nanoseconds), int(checksum)
