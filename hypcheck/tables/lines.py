"""UTF-8 text by lines, at a block's cost rather than a line's, with the line's number in every complaint."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

from hypcheck.errors import InputError
from hypcheck.tables.streams import Reader

BLOCK = 1 << 20
LONGEST = 1 << 20
"""Bytes of a line: a longer one is no row of eleven cells, and memory stays flat."""

BYTE_ORDER_MARK = "\ufeff"

_LONGEST_PLAIN = 1 << 16


@dataclass(frozen=True, slots=True)
class Block:
    """Some whole lines of a text, the first of which has this number."""

    first: int
    data: bytes

    @property
    def count(self) -> int:
        """How many lines they are; the last of a text may have no end."""
        return self.data.count(b"\n") + (not self.data.endswith(b"\n"))

    def is_plain(self, avoiding: bytes) -> bool:
        """Whether every line is short, ASCII, and does not begin as a blank one, and none of these bytes is in them."""
        data = self.data
        if not data.isascii() or b"\0" in data or (avoiding and avoiding in data):
            return False
        if b"\r" in data and data.count(b"\r") != data.count(b"\r\n"):
            return False
        lines = data.removesuffix(b"\n").split(b"\n")
        return max(map(len, lines)) <= _LONGEST_PLAIN and all(line[:1] > b" " for line in lines)

    def plain_lines(self) -> list[str]:
        """The lines of a plain block without their ends."""
        text = self.data.decode("ascii").replace("\r\n", "\n")
        return text.removesuffix("\n").split("\n")


class Lines:
    """A text by lines: one after the other, or where a block begins, if it is plain, the block as a whole."""

    def __init__(self, reader: Reader) -> None:
        self._name = reader.name
        self._blocks = _blocks(reader)
        self._ahead: Block | None = None
        self._given = 0
        self.each: Iterator[str] = chain.from_iterable(self._opened())
        """The lines, each with its end (LF or CRLF); a byte order mark stays at the start of the first.

        Raises InputError, naming the line, on bytes that are not UTF-8, on NUL and on a line beyond LONGEST.
        """

    def at_block(self, taken: int) -> bool:
        """Whether a block begins, or the text ends, behind the first `taken` lines."""
        return taken == self._given

    def block(self, taken: int, avoiding: bytes = b"") -> Block | None:
        """The next block, if `taken` lines are all before it, and it is plain. Raises InputError as `each` does."""
        if not self.at_block(taken):
            return None
        if self._ahead is None:
            self._ahead = next(self._blocks, None)
        if self._ahead is None or not self._ahead.is_plain(avoiding):
            return None
        block, self._ahead = self._ahead, None
        self._given += block.count
        return block

    def _opened(self) -> Iterator[list[str]]:
        while (block := self._ahead or next(self._blocks, None)) is not None:
            self._ahead = None
            self._given += block.count
            yield _lines(block.data, self._name, block.first)


def text_lines(reader: Reader) -> Iterator[str]:
    """The lines of a text, as Lines has each."""
    return Lines(reader).each


def _blocks(reader: Reader) -> Iterator[Block]:
    number, rest = 1, b""
    while data := reader.read(BLOCK):
        data = rest + data
        cut = data.rfind(b"\n") + 1
        rest = data[cut:]
        if len(rest) > LONGEST:
            line = number + data.count(b"\n", 0, cut)
            where = f"{reader.name}, line {line}"
            raise InputError(f"{where}: longer than {LONGEST} bytes; a row, or a case, is one short line")
        if cut:
            block = Block(number, data[:cut])
            number += block.count
            yield block
    if rest:
        yield Block(number, rest)


def _lines(block: bytes, name: str, first: int) -> list[str]:
    try:
        text = block.decode("utf-8")
    except UnicodeDecodeError as error:
        line = first + block.count(b"\n", 0, error.start)
        byte = block[error.start]
        raise InputError(f"{name}, line {line}: byte 0x{byte:02x} is not UTF-8; it must be UTF-8 text") from None
    if "\0" in text:
        line = first + text.count("\n", 0, text.index("\0"))
        raise InputError(f"{name}, line {line}: a NUL byte; it must be UTF-8 text")
    return list(io.StringIO(text, newline="\n"))
