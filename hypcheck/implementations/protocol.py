"""The protocol of commands: lines on standard input and output, rows in text or binary, and the errors of a reply.

← {"protocol":1,"name":"…", …}     the first line, unprompted
→ classify SEQ N text              then N lines of seven decimals
→ classify SEQ N binary            then N·56 bytes, little-endian
← SEQ N                            then N lines of one integer, or N bytes
→ time SEQ N REPEAT binary         then N·56 bytes
← SEQ NANOSECONDS CHECKSUM
← error TEXT                       in place of a reply

A program whose description has "tilt": true is asked tilted-text in place of text, lines of ten decimals, and
tilted-binary in place of binary, N·80 bytes.

A program whose description has "question": "passage" is asked passage-text and passage-binary: lines of ten decimals or
N·80 bytes, with "tilt": true thirteen decimals or N·104 bytes. With "times": true it replies lines such as "1 T" or
"0", or N bytes and N float64.

"takes": ["axis"] means the same as "tilt": true. With "heights" among what it takes, three numbers more come last, of
8 bytes each in binary: z_min, z_max and solid, in text as -inf, inf and 0.0 where the hyperboloid does not end.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.rows import Rows
from hypcheck.implementations.description import LONGEST, Description, described_by_json, foreign_text
from hypcheck.implementations.frames import LARGEST, GivenAnswers, integers, row_bytes
from hypcheck.implementations.process import ProcessSession, quoted
from hypcheck.implementations.session import FaultError, Limits, Outcome, StartError

_HEAD = re.compile(rb"(\d{1,19}) (\d{1,19})\r?\n")
_TIMES = re.compile(rb"(\d{1,19}) (\d{1,18}) ([+-]?\d{1,18})\r?\n")
_INTEGER = re.compile(rb"[ \t]*([+-]?\d{1,18})[ \t\r]*")
_HIT = re.compile(rb"[ \t]*\+?1[ \t]+([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,5})?|[+-]?nan|[+-]?inf)[ \t\r]*")
_USUAL = {b"0": 0, b"1": 1, b"-1": -1, b"2": 2, b"127": 127}
_LINE = 64
"""The most bytes of a line with one integer, with room for blanks."""
_FIRST_LINE = 4096
"""The most bytes of a reply's first line, which may be an error's text."""


def broken(reason: str) -> FaultError:
    """Return a fault that breaks the protocol, after which the process cannot be trusted."""
    return FaultError(Outcome.PROTOCOL, reason, fatal=True)


class Reply:
    """The expected reply to one question."""

    def __init__(self, sequence: int) -> None:
        self.sequence = sequence
        self.error: str | None = None
        """The text of `error TEXT`, if the reply is that."""

    def length(self, incoming: bytearray) -> int:
        """Return bytes of the complete reply that `incoming` begins with, 0 while it is incomplete.

        Raises FaultError where no reply to the question begins so.
        """
        end = incoming.find(b"\n") + 1
        if not end:
            if len(incoming) > _FIRST_LINE:
                raise broken(f"a line of its reply does not end within {_FIRST_LINE} bytes: {quoted(incoming)}")
            return 0
        if incoming.startswith((b"error ", b"error\n", b"error\r")):
            self.error = foreign_text(incoming[6:end].decode("utf-8", "replace")) or "(without a text)"
            return end
        return self._after(incoming, end)

    def _after(self, incoming: bytearray, end: int) -> int:
        """Return the length as in `length`, after the first line, which ends at `end`."""
        raise NotImplementedError

    def share(self, incoming: bytearray) -> float:  # noqa: ARG002 - of one line none is a share
        """Return the part of an incomplete reply's answers that have arrived, from 0 to 1."""
        return 0.0

    def progress(self, incoming: bytearray) -> str:
        """Return the state of an incomplete reply, in words."""
        return f"only {quoted(incoming)} of a reply" if incoming else "no reply"

    def _same_sequence(self, sequence: int) -> None:
        """Raise FaultError if a reply has the number of another question."""
        if sequence < self.sequence:
            raise broken(f"it replied to question {sequence} again, when {self.sequence} was asked")
        if sequence > self.sequence:
            raise broken(f"it replied to question {sequence} before question {self.sequence}")


class _Answers(Reply):
    """The answers to n rows, with times or without."""

    def __init__(self, sequence: int, n: int, *, times: bool = False) -> None:
        super().__init__(sequence)
        self._n = n
        self._times = times

    def _check_head(self, incoming: bytearray, end: int) -> None:
        """Raise FaultError if the first line is not the one expected."""
        head = _HEAD.fullmatch(incoming, 0, end)
        if not head:
            raise broken(f"it wrote {quoted(incoming[:end])} where '{self.sequence} {self._n}' had to come")
        self._same_sequence(int(head[1]))
        if int(head[2]) != self._n:
            raise broken(f"it announced {int(head[2])} answers to {self._n} rows")

    def _so_far(self, incoming: bytearray, end: int) -> int:
        """Return how many answers have arrived."""
        raise NotImplementedError

    def share(self, incoming: bytearray) -> float:
        """Return the part of the answers that has arrived, from 0 to 1."""
        end = incoming.find(b"\n") + 1
        return self._so_far(incoming, end) / self._n if end and self._n else 0.0

    def progress(self, incoming: bytearray) -> str:
        """Return how many answers have arrived, in words."""
        end = incoming.find(b"\n") + 1
        return f"{self._so_far(incoming, end)} of {self._n} answers" if end else super().progress(incoming)


class BinaryReply(_Answers):
    """`SEQ N` and N bytes, then N float64 if there are times."""

    @property
    def _size(self) -> int:
        """How many bytes follow the first line."""
        return self._n * (1 + 8 * self._times)

    def _after(self, incoming: bytearray, end: int) -> int:
        self._check_head(incoming, end)
        return end + self._size if len(incoming) >= end + self._size else 0

    def _so_far(self, incoming: bytearray, end: int) -> int:
        return (len(incoming) - end) * self._n // max(1, self._size)

    def answers(self, reply: bytes) -> GivenAnswers:
        """Return the answers of a complete reply."""
        if not self._times:
            return GivenAnswers(integers(reply[-self._n :], 1))
        body = reply[len(reply) - self._size :]
        return GivenAnswers(integers(body[: self._n], 1), np.frombuffer(body[self._n :], dtype="<f8"))


class TextReply(_Answers):
    """`SEQ N` and N lines with one integer each; if there are times, a time follows each 1."""

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

    def answers(self, reply: bytes) -> GivenAnswers:
        """Return the answers of a complete reply; raises FaultError naming the first line that is no integer."""
        lines = reply.split(b"\n")[1:-1]
        if self._times:
            timed = [self._timed(number, line) for number, line in enumerate(lines, start=1)]
            return GivenAnswers(np.array([answer for answer, _ in timed]), np.array([time for _, time in timed]))
        values = [_USUAL.get(line) for line in lines]
        if None in values:
            values = [self._integer(number, line) for number, line in enumerate(lines, start=1)]
        return GivenAnswers(np.array(values, dtype=np.int64))

    def _timed(self, number: int, line: bytes) -> tuple[int, float]:
        """Return an answer and its time, NaN unless the answer is 1. Raises FaultError."""
        hit = _HIT.fullmatch(line)
        answer = 1 if hit else self._integer(number, line)
        if answer == 1 and not hit:
            wanted = "it must be 1 and the time, one blank between"
            raise broken(f"answer {number} of {self._n} is {quoted(line)}; {wanted}")
        return answer, float(hit[1]) if hit else math.nan

    def _integer(self, number: int, line: bytes) -> int:
        """Return the integer of a line. Raises FaultError."""
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
        """Return nanoseconds and checksum of the complete reply."""
        _, nanoseconds, checksum = line.split()
        return int(nanoseconds), int(checksum)


LARGEST_TEXT = 4096
"""The most rows of a question in text."""

_DEFAULTS = Description(name="")
_REQUIRED = ("protocol", "name")
_LINES = 256
_STEPS = 16
"""The timeout starts again whenever one more part of so many of the question was read, or of the answers has arrived.
So a slow program has time, and a program that sends single bytes is stopped."""
_WIDEST_TEXT = 25
"""The most bytes of a number in text, with the blank or the end of line after it."""
_STALL = 4
"""After this part of the timeout without a byte, a second question follows. If its reply arrives, the first reply was
short or missing, and the program is not slow."""


class CommandSession(ProcessSession):
    """A session of a program that speaks the protocol. Raises StartError."""

    scene = False

    def __init__(self, words: Sequence[str], limits: Limits) -> None:
        super().__init__(words, limits)
        self._sequence = 0
        self._known: Rows | None = None
        """A row that this process has answered, for a question that it can answer again."""
        self.max_batch = LARGEST if self.description.binary else LARGEST_TEXT

    def _meet(self) -> Description:
        """Return the description in the program's first line. Raises StartError."""
        try:
            line = self._first_line()
        except FaultError as fault:
            self._process.kill()
            raise StartError(f"{fault.reason}{self.evidence}") from None
        try:
            return described_by_json(line, _DEFAULTS, _REQUIRED)
        except InputError as error:
            self._process.kill()
            raise StartError(f"its first line is not a description: {error}{self.evidence}") from None

    def _first_line(self) -> bytes:
        """Return the program's first line. Raises FaultError."""
        seconds = self._limits.startup_timeout
        until = self._process.now() + seconds
        incoming = self._process.incoming
        while b"\n" not in incoming:
            if len(incoming) > LONGEST:
                raise broken(f"its first line does not end within {LONGEST} bytes; it must be the description")
            if self._process.now() >= until:
                raise FaultError(Outcome.TIMEOUT, f"no description came within {seconds:g} s", fatal=True)
            try:
                self._process.pump(until)
            except FaultError as fault:
                raise FaultError(fault.outcome, f"{fault.reason} before it described itself", fatal=True) from None
        end = incoming.index(b"\n")
        line = bytes(incoming[:end])
        del incoming[: end + 1]
        return line

    def classify(self, rows: Rows, *, by_scene: bool = False) -> GivenAnswers:  # noqa: ARG002 - it has no entry for scenes
        """Return an integer for each row, and times if the description promises them."""
        n, rows = len(rows), self._columns(rows)
        self._sequence += 1
        question, reply = f"classify {self._sequence} {n} {self._how}", self._reply(n)
        again: Rows | None = rows[:1] if self._known is None else self._known
        if self.description.times and self.description.binary:
            again = None  # the bytes of a time may look like the first line of the second reply
        answers = reply.answers(self._ask(question, self._body(rows), reply, again, rows.size * self._widest))
        self._known = rows[-1:].copy()
        return answers

    def time(
        self,
        rows: Rows,
        repeat: int,
        *,
        by_scene: bool = False,  # noqa: ARG002
        row_by_row: bool = False,
    ) -> tuple[int, int] | None:
        """Return nanoseconds for `repeat` times the rows, and the sum of the answers; None if it does not offer timing.

        `row_by_row` asks a question for each row.
        """
        if not self.description.time:
            return None
        rows = self._columns(rows)
        parts = [rows[place : place + 1] for place in range(len(rows))] if row_by_row else [rows]
        nanoseconds, totals = zip(*(self._time(part, repeat) for part in parts), strict=True)
        return sum(nanoseconds), sum(totals)

    def _time(self, rows: Rows, repeat: int) -> tuple[int, int]:
        """Return nanoseconds and checksum of one question."""
        self._sequence += 1
        reply = TimeReply(self._sequence)
        question = f"time {self._sequence} {len(rows)} {repeat} {self._form}binary"
        return reply.times(self._ask(question, (row_bytes(rows),), reply))

    def _ask(
        self, question: str, body: Iterable[bytes | memoryview], reply: Reply, again: Rows | None = None, size: int = 0
    ) -> bytes:
        """Return the reply to a question of `size` bytes.

        `again` is a row for a second question, sent if the reply stalls: its reply shows that the first one was short.
        """
        process = self._process
        process.mark()
        process.pump(0)
        if process.incoming:
            raise broken(f"it wrote {quoted(process.incoming)} when nothing was asked")
        process.send(chain((f"{question}\n".encode(),), body))
        length, second = self._await(reply, again, size)
        answer = bytes(process.incoming[:length])
        del process.incoming[:length]
        if second:
            length, _ = self._await(second)
            del process.incoming[:length]
        if process.incoming:
            raise broken(f"it wrote {quoted(process.incoming)} behind a complete reply")
        if reply.error is not None:  # a program that did not read all rows will read the rest as questions
            raise FaultError(Outcome.ERROR, f"it reported an error: {reply.error}", fatal=process.sending)
        if process.sending:
            raise broken("it replied before it had read the rows")
        return answer

    def _await(self, reply: Reply, again: Rows | None = None, size: int = 0) -> tuple[int, Reply | None]:
        """Return the length of the reply once it is complete, and the second reply that is still to come."""
        process, seconds = self._process, self._limits.timeout
        second: Reply | None = None
        steps, read, heard = 0, 0.0, process.now()
        until = heard + seconds
        while True:
            length = reply.length(process.incoming)
            if second:
                _check_order(process.incoming, length, reply, second)
            if length:
                return length, second
            now = process.now()
            if now >= until:
                more = ", and hardly one more" if reply.share(process.incoming) else ""
                so_far = reply.progress(process.incoming) + more
                raise FaultError(Outcome.TIMEOUT, f"{so_far} within {seconds:g} s", fatal=True)
            if again is not None and not second and not process.sending and now >= heard + seconds / _STALL:
                second = self._ask_behind(again)
            if process.pump(until):
                heard = process.now()
            if size and not second:  # all bytes of the question were sent before the second one
                read = min(1.0, process.sent / size)
            come = int(_STEPS * read) + int(_STEPS * reply.share(process.incoming))
            if come > steps:
                steps, until = come, process.now() + seconds

    def _ask_behind(self, row: Rows) -> Reply:
        """Send a second question about one row; return the expected reply."""
        self._sequence += 1
        self._process.send(chain((f"classify {self._sequence} 1 {self._how}\n".encode(),), self._body(row)))
        return self._reply(1)

    @property
    def _how(self) -> str:
        """The word of a question that says how its rows are written, such as tilted-binary."""
        return self._form + ("binary" if self.description.binary else "text")

    @property
    def _form(self) -> str:
        """What comes before "text" or "binary" in that word."""
        return self.description.asked.forms[self.description.tilt]

    @property
    def _widest(self) -> int:
        """The most bytes of a number in a question."""
        return 8 if self.description.binary else _WIDEST_TEXT

    def _body(self, rows: Rows) -> Iterable[bytes | memoryview]:
        """Return rows as the body of a question, in parts."""
        return (row_bytes(rows),) if self.description.binary else row_text(rows)

    def _reply(self, n: int) -> BinaryReply | TextReply:
        """Return the expected reply about n rows."""
        kind = BinaryReply if self.description.binary else TextReply
        return kind(self._sequence, n, times=self.description.times)


def _check_order(incoming: bytearray, length: int, reply: Reply, second: Reply) -> None:
    """Raise FaultError if the second reply begins before the first, of `length` if complete, ends.

    No answer looks like its first line: in text, none has a blank in it, or it is a 1 with a time, while the second
    question is never the first; in binary, none is a digit.
    """
    began = re.search(rb"(?<!\d)%d 1\r?\n" % second.sequence, incoming)
    if began and (not length or began.start() < length):
        raise broken(f"its reply was short: the next one came after {reply.progress(incoming[: began.start()])}")


def row_text(rows: Rows) -> Iterator[bytes]:
    """Yield rows as lines of decimals, each the shortest that reads back as the same float64; some lines at a time."""
    line = " ".join(["%r"] * rows.shape[1]) + "\n"
    for start in range(0, len(rows), _LINES):
        part = rows[start : start + _LINES]
        yield (line * len(part) % tuple(part.ravel().tolist())).encode()
