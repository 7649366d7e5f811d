"""The protocol of commands: lines on standard input and output, rows in text or binary.

← {"protocol":1,"name":"…", …}     the first line, unprompted
→ classify SEQ N text              then N lines of seven decimals
→ classify SEQ N binary            then N·56 bytes, little-endian
← SEQ N                            then N lines of one integer, or N bytes
→ time SEQ N REPEAT binary         then N·56 bytes
← SEQ NANOSECONDS CHECKSUM
← error TEXT                       in place of a reply
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from hypcheck.errors import InputError
from hypcheck.methods.description import LONGEST, Description, described_by_json
from hypcheck.methods.evidence import last_words, quoted
from hypcheck.methods.faults import FaultError, Outcome, StartError
from hypcheck.methods.frames import LARGEST, row_bytes
from hypcheck.methods.limits import Limits
from hypcheck.methods.process import Process
from hypcheck.methods.replies import BinaryReply, Reply, TextReply, TimeReply, broken
from hypcheck.methods.session import Answers
from hypcheck.pairs import COLUMNS
from hypcheck.rows import Rows

LARGEST_TEXT = 4096
"""Rows of a question in text."""

_DEFAULTS = Description(name="")
_REQUIRED = ("protocol", "name")
_ROW = " ".join(["%r"] * len(COLUMNS)) + "\n"
_LINES = 256
_STEPS = 16
"""The clock begins anew whenever another part of so many of the question was read, or of the answers has come: who is
slow is waited for, and who gives a byte now and then is not for ever."""
_WIDEST = {"binary": 56, "text": 7 * 25}
"""Bytes of a row at most."""
_STALL = 4
"""After this part of the timeout without a byte, a second question is sent behind the first: where its reply comes, the
first's was short or missing, and the implementation not slow."""


class CommandSession:
    """A program that speaks the protocol. Raises StartError."""

    most: int | None = None
    scene = False

    def __init__(self, words: Sequence[str], limits: Limits) -> None:
        self._limits = limits
        self._sequence = 0
        self._known: Rows | None = None
        """A row that this process has answered, for a question that it is sure to answer again."""
        self._process = Process(words, limits)
        try:
            self.description = self._meet()
        except BaseException:
            self._process.kill()
            raise
        self.longest = LARGEST if self.description.binary else LARGEST_TEXT

    def _meet(self) -> Description:
        try:
            line = self._first_line()
        except FaultError as fault:
            self._process.kill()
            raise StartError(f"{fault.reason}{self.evidence}") from None
        try:
            return described_by_json(line, _DEFAULTS, _REQUIRED)
        except InputError as error:
            self._process.kill()
            raise StartError(f"its first line is no description: {error}{self.evidence}") from None

    def _first_line(self) -> bytes:
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

    def classify(self, rows: Rows, *, by_scene: bool = False) -> Answers:  # noqa: ARG002 - the runner asks who offers it
        """An integer for each row."""
        n = len(rows)
        self._sequence += 1
        question, reply = f"classify {self._sequence} {n} {self._how}", self._reply(n)
        again = rows[:1] if self._known is None else self._known
        answers = reply.integers(self._ask(question, self._body(rows), reply, again, n * _WIDEST[self._how]))
        self._known = rows[-1:].copy()
        return answers

    def time(
        self,
        rows: Rows,
        repeat: int,
        *,
        by_scene: bool = False,  # noqa: ARG002
        each: bool = False,
    ) -> tuple[int, int] | None:
        """Nanoseconds for `repeat` times the rows and the sum of the answers; None where it does not offer that.

        `each`: by a question for each row.
        """
        if not self.description.time:
            return None
        parts = [rows[place : place + 1] for place in range(len(rows))] if each else [rows]
        nanoseconds, totals = zip(*(self._time(part, repeat) for part in parts), strict=True)
        return sum(nanoseconds), sum(totals)

    def _time(self, rows: Rows, repeat: int) -> tuple[int, int]:
        self._sequence += 1
        reply = TimeReply(self._sequence)
        question = f"time {self._sequence} {len(rows)} {repeat} binary"
        return reply.times(self._ask(question, (row_bytes(rows),), reply))

    def _ask(
        self, question: str, body: Iterable[bytes | memoryview], reply: Reply, again: Rows | None = None, size: int = 0
    ) -> bytes:
        """The reply to a question of `size` bytes; `again` is a row for the question behind it, should it stall."""
        process = self._process
        process.mark()
        process.pump(0)
        if process.incoming:
            raise broken(f"it wrote {quoted(process.incoming)} when nothing was asked")
        process.send(chain((f"{question}\n".encode(),), body))
        length, second = self._await(reply, again, size)
        said = bytes(process.incoming[:length])
        del process.incoming[:length]
        if second:
            length, _ = self._await(second)
            del process.incoming[:length]
        if process.incoming:
            raise broken(f"it wrote {quoted(process.incoming)} behind a complete reply")
        if reply.error is not None:  # if it did not read all rows, it will take the rest for questions
            raise FaultError(Outcome.ERROR, f"it reported an error: {reply.error}", fatal=process.sending)
        if process.sending:
            raise broken("it replied before it had read the rows")
        return said

    def _await(self, reply: Reply, again: Rows | None = None, size: int = 0) -> tuple[int, Reply | None]:
        """The length of the reply, once it is complete, and the reply that is still to come behind it."""
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
            if size and not second:  # behind whose bytes all of the question's have left
                read = min(1.0, process.sent / size)
            come = int(_STEPS * read) + int(_STEPS * reply.share(process.incoming))
            if come > steps:
                steps, until = come, process.now() + seconds

    def _ask_behind(self, row: Rows) -> Reply:
        self._sequence += 1
        self._process.send(chain((f"classify {self._sequence} 1 {self._how}\n".encode(),), self._body(row)))
        return self._reply(1)

    @property
    def _how(self) -> str:
        return "binary" if self.description.binary else "text"

    def _body(self, rows: Rows) -> Iterable[bytes | memoryview]:
        return (row_bytes(rows),) if self.description.binary else row_text(rows)

    def _reply(self, n: int) -> BinaryReply | TextReply:
        return (BinaryReply if self.description.binary else TextReply)(self._sequence, n)

    @property
    def evidence(self) -> str:
        """What it said on standard error since the last question, as the end of a sentence."""
        return last_words(self._process.recent)

    @property
    def stderr(self) -> tuple[str, ...]:
        """The last lines of its standard error, safe to print."""
        return self._process.stderr

    def close(self) -> None:
        """Let it leave: the end of its input is goodbye."""
        self._process.goodbye()

    def kill(self) -> None:
        """End it now."""
        self._process.kill()


def _check_order(incoming: bytearray, length: int, reply: Reply, second: Reply) -> None:
    """Raise FaultError where the second reply begins before the first, of `length` once it is complete, ends.

    No answer looks like its first line: in text none has a blank in it, in binary none is a digit.
    """
    began = re.search(rb"(?<!\d)%d 1\r?\n" % second.sequence, incoming)
    if began and (not length or began.start() < length):
        raise broken(f"its reply was short: the next one came after {reply.progress(incoming[: began.start()])}")


def row_text(rows: Rows) -> Iterator[bytes]:
    """Rows as lines of seven decimals, each the shortest that reads back as the same float64; some lines at a time."""
    for start in range(0, len(rows), _LINES):
        part = rows[start : start + _LINES]
        yield (_ROW * len(part) % tuple(part.ravel().tolist())).encode()
