"""The integrity of a record: the checksum of each line, reading up to the first damage, and repair.

The checksum at the end of each line of a record: a CRC-32 of everything from the first byte of the file up to it.

It is there against accidents: a bit that flipped, a line that was lost, doubled or moved, two runs that wrote into one
file. Each checksum goes on from the one before, so that such a line does not fit where it stands, whatever is in it.
A CRC finds every change within 32 neighbouring bits for certain, and any other but for one in 2³². Whoever changes a
record on purpose can compute any checksum anew: a cryptographic one would promise no more. This one is in every
language's reach and costs next to nothing (1 GB/s and more).

The whole lines of a record, one at a time: none that is too long is loaded, nothing behind damage is believed.

Whether the file of a record is whole, and what of it can be saved where it is not.
"""

from __future__ import annotations

import json
import math
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from hypcheck.errors import InputError
from hypcheck.tables.numbers import shown, shown_json
from hypcheck.tables.streams import Reader, reading, same_file, writing

Raw = dict[str, Any]
"""A line as JSON has it."""

FIELD = "crc32"

_SEAL = re.compile(rb', "%s": "([0-9a-f]{8})"\}\Z' % FIELD.encode())
_LENGTH = len(f', "{FIELD}": "01234567"}}')


def sealed(line: Raw, before: int) -> tuple[bytes, int]:
    """The bytes of a line, its end included, and their checksum; `before` is that of the line before, 0 for the first.

    The checksum, eight hexadecimal digits, is the last field: it covers what stands before its comma.
    """
    text = json.dumps(line, ensure_ascii=False, allow_nan=False)
    # A lone surrogate becomes its escape, which within a text of JSON stands for the same.
    body = text.encode("utf-8", "backslashreplace")[:-1]
    check = zlib.crc32(body, before)
    return b'%s, "%s": "%08x"}\n' % (body, FIELD.encode(), check), check


def seal_of(line: bytes) -> int | None:
    """The checksum that a line, without its end, says it has; None where it ends in none."""
    seal = _SEAL.search(line, max(0, len(line) - _LENGTH))
    return int(seal[1], 16) if seal else None


def body_of(line: bytes) -> bytes:
    """The JSON text of a line that has a checksum, without it."""
    return line[:-_LENGTH] + b"}"


def checksum(line: bytes, before: int) -> int:
    """The checksum that a line with one must have."""
    return zlib.crc32(memoryview(line)[:-_LENGTH], before)


READABLE = "1"
"""The major version of the schema that is read here."""

SEALED_SINCE = 2
"""The minor version since which every line has a checksum."""

LONGEST = 1 << 24
"""Bytes of a line, of which the longest ever written had 62,000: a longer one is refused before it is loaded."""

_VERSION = re.compile(r"([0-9]{1,6})\.([0-9]{1,6})\.[0-9]{1,6}", re.ASCII)
_BEGINNING = b'{"type": "header"'
_MAY_BE_HUGE = re.compile(rb"[0-9]{20}|[eE][+]?[0-9]{3}")


def _no_constant(text: str) -> NoReturn:
    raise ValueError(f"{text} is no number of JSON")


def _finite(text: str) -> float:
    number = float(text)
    if math.isinf(number):
        raise ValueError(f"{shown(text, quoted=False)} is too large for float64")
    return number


def _integer(text: str) -> int:
    _finite(text)
    return int(text)


_QUICK = json.JSONDecoder(parse_constant=_no_constant)
_CAREFUL = json.JSONDecoder(parse_constant=_no_constant, parse_float=_finite, parse_int=_integer)
"""As the quick one, but for numbers beyond float64, which nothing that reads a record expects."""


def _version_of(header: Raw) -> tuple[str | None, int]:
    """The major and the minor version that a header tells; None and 0 where it tells none."""
    version = header.get("schema")
    found = _VERSION.fullmatch(version) if isinstance(version, str) else None
    return (found[1], int(found[2])) if found else (None, 0)


class DamagedError(InputError):
    """A record that is not as it was written. `at` is the byte, from 0, where the first line begins that is not."""

    def __init__(self, sentence: str, at: int = 0) -> None:
        super().__init__(sentence)
        self.at = at


class RecordScan:
    """An iterator over the whole lines of a record, header and footer included, each without its checksum.

    A line is whole when its line end is there. The iterator ends with the file, which may be cut off within a line. It
    raises DamagedError where anything else is wrong, and InputError where the file is no record that can be read.
    """

    def __init__(self, reader: Reader) -> None:
        self._reader = reader
        self._check = 0
        self.sealed = False
        """Whether the record has checksums, known from its first line on."""
        self.header: Raw = {}
        self.footer: Raw | None = None
        self.lines = 0
        """Whole lines so far."""
        self.end = 0
        """The byte behind the last of them."""
        self.written = b""
        """What was read last: the bytes of a whole line, or those at which reading came to its end."""

    def __iter__(self) -> Iterator[Raw]:
        while written := self._next():
            if not written.endswith(b"\n"):
                self._check_cut(written)
                return
            text = written[: -2 if written.endswith(b"\r\n") else -1]
            line = self._line(text) if self.lines else self._first(text)
            self._check_place(line)
            self.lines += 1
            self.end += len(written)
            yield line
        if not self.lines:
            raise InputError(f"{self._reader.name} is empty; a record begins with a header")

    def _next(self) -> bytes:
        self.written = self._reader.line(LONGEST + 1)
        return self.written

    def _check_cut(self, written: bytes) -> None:
        if len(written) > LONGEST:
            self._refuse(f"it is longer than {LONGEST} bytes, which no line of a record is")
        if self.footer is not None:
            self._refuse("it stands behind the footer, which ends a record")
        if self.lines == 0:
            if written.startswith(_BEGINNING[: len(written)]):
                raise InputError(f"{self._reader.name} is cut off within its first line; nothing of it can be used")
            self._no_record("it has no whole line")

    def _first(self, text: bytes) -> Raw:
        """The header. It alone decides whether there are checksums, so one that it has counts whatever it says."""
        self.sealed = seal_of(text) is not None
        line = self._parsed(body_of(text) if self.sealed else text)
        major, minor = _version_of(line)
        if major not in (None, READABLE):
            raise InputError(f"{self._reader.name} has schema {line['schema']}; this program reads {READABLE}.x")
        if self.sealed:
            self._check_seal(text)
        if line["type"] != "header" or major is None:
            self._no_record(f"its first line is no header with a schema such as {READABLE}.0.0")
        if minor >= SEALED_SINCE and not self.sealed:
            self.sealed = True
            self._refuse(f"it has no checksum at its end, which it must have since schema {READABLE}.{SEALED_SINCE}.0")
        self.header = line
        return line

    def _line(self, text: bytes) -> Raw:
        if self.sealed:
            self._check_seal(text)
            text = body_of(text)
        return self._parsed(text)

    def _parsed(self, text: bytes) -> Raw:
        try:
            line = (_CAREFUL if _MAY_BE_HUGE.search(text) else _QUICK).decode(text.decode())
        except UnicodeDecodeError as error:
            self._refuse(f"its byte {error.start} is no UTF-8")
        except RecursionError:
            self._refuse("it is nested too deeply")
        except json.JSONDecodeError as error:
            self._refuse(f"it is no JSON at character {error.pos + 1}: {error.msg.lower()}")
        except ValueError as error:
            self._refuse(str(error))
        if not isinstance(line, dict) or not isinstance(line.get("type"), str):
            self._refuse("it is no object with a type")
        return line

    def _check_seal(self, text: bytes) -> None:
        seal = seal_of(text)
        if seal is None:
            self._refuse("it does not end in a checksum: its end is lost, or was changed")
        right = checksum(text, self._check)
        if seal != right:
            self._refuse(
                f"its checksum is {seal:08x}, but of what stands here it is {right:08x}: it was changed, or a line "
                "before it was lost, doubled or moved"
            )
        self._check = seal

    def _check_place(self, line: Raw) -> None:
        if self.footer is not None:
            self._refuse("it stands behind the footer, which ends a record")
        if line["type"] == "header" and self.lines:
            self._refuse("it is a second header; a file holds one record")
        if line["type"] == "footer":
            counted, number = line.get("lines"), self.lines + 1
            if counted != number:
                self._refuse(f"it is a footer that counts {shown_json(counted)} lines, but it is line {number}")
            self.footer = line

    def _refuse(self, what: str) -> NoReturn:
        if self.lines == 0 and not self.sealed:
            self._no_record(f"its first line is no header ({what})")
        raise DamagedError(
            f"{self._reader.name} is damaged in line {self.lines + 1}, at byte {self.end}: {what}", self.end
        )

    def _no_record(self, why: str) -> NoReturn:
        raise InputError(f"{self._reader.name} is no record: {why}; a record begins with a header")


_BLOCK = 1 << 20


@dataclass(frozen=True, slots=True)
class FileCondition:
    """What is in a file: its good lines and their bytes, what is lost behind them, and why (empty: it is cut off)."""

    schema: str
    sealed: bool
    lines: int
    size: int
    exit_code: object
    """As the footer has it, None without one."""

    complete: bool
    lost_bytes: int
    lost_lines: int
    why: str = ""


def check(path: Path) -> FileCondition:
    """The condition of a file that is whole, or cut off. Raises DamagedError and InputError as Scan does."""
    with reading(str(path)) as reader:
        scan = RecordScan(reader)
        for _ in scan:
            pass
        return _condition(scan, reader, "")


def repair(path: Path, target: Path) -> FileCondition:
    """Write everything up to the last good line to `target`, and say what was lost.

    Raises InputError where not even the header is good, and where the two are one file.
    """
    if same_file(str(path), str(target)):
        raise InputError(
            f"--out {target} is the record itself; name another file, so that what is lost can be looked at"
        )
    with reading(str(path)) as reader, writing(str(target)) as writer:
        scan, why = RecordScan(reader), ""
        try:
            for _ in scan:
                writer.write(scan.written)
        except DamagedError as error:
            if not scan.lines:
                raise
            why = str(error)
        return _condition(scan, reader, why)


def _condition(scan: RecordScan, reader: Reader, why: str) -> FileCondition:
    """The condition once the scan has ended; what it did not read is counted."""
    last = scan.written
    size, ends = len(last), last.count(b"\n")
    while block := reader.read(_BLOCK):
        size, ends, last = size + len(block), ends + block.count(b"\n"), block
    return FileCondition(
        schema=scan.header["schema"],
        sealed=scan.sealed,
        lines=scan.lines,
        size=scan.end,
        exit_code=scan.footer and scan.footer.get("exit_code"),
        complete=scan.footer is not None,
        lost_bytes=size,
        lost_lines=ends + (last != b"" and not last.endswith(b"\n")),
        why=why,
    )
