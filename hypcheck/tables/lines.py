"""UTF-8 text by lines, at a block's cost rather than a line's, with the line's number in every complaint."""

from __future__ import annotations

import io
from collections.abc import Iterator
from itertools import chain

from hypcheck.errors import InputError
from hypcheck.tables.streams import Reader

BLOCK = 1 << 20
LONGEST = 1 << 20
"""Bytes of a line: a longer one is no row of eleven cells, and memory stays flat."""

BYTE_ORDER_MARK = "\ufeff"


def text_lines(reader: Reader) -> Iterator[str]:
    """The lines, each with its end (LF or CRLF); a byte order mark stays at the start of the first.

    Raises InputError, naming the line, on bytes that are not UTF-8, on NUL and on a line beyond LONGEST.
    """
    return chain.from_iterable(_blocks(reader))


def _blocks(reader: Reader) -> Iterator[list[str]]:
    number, rest = 1, b""
    while block := reader.read(BLOCK):
        block = rest + block
        cut = block.rfind(b"\n") + 1
        rest = block[cut:]
        if len(rest) > LONGEST:
            line = number + block.count(b"\n", 0, cut)
            raise InputError(f"{reader.name}, line {line}: longer than {LONGEST} bytes; a row is one short line")
        if cut:
            lines = _lines(block[:cut], reader.name, number)
            number += len(lines)
            yield lines
    if rest:
        yield _lines(rest, reader.name, number)


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
