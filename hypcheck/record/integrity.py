"""The integrity of a record: the checksum of each line, reading up to the first damage, and repair.

Each line ends in a checksum: the CRC-32 of everything from the first byte of the file up to it. It guards against
accidents: a bit that flipped, a line that was lost, doubled or moved, two runs that wrote into one file. Each checksum
continues the one before, so a misplaced line does not fit, whatever is in it. A CRC finds every change within 32
neighbouring bits, and any other except for one in 2³². It does not guard against people, who can compute it again.
Every language has a CRC-32, and it costs next to nothing (1 GB/s and more).

Lines are read one at a time: none that is too long is loaded, and nothing after damage is believed.
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
from hypcheck.messages import json_trouble
from hypcheck.tables.numbers import shown, shown_json
from hypcheck.tables.streams import Reader, open_input, replace_output, same_file

Raw = dict[str, Any]
"""A line as decoded from JSON, before it becomes a struct."""

FIELD = "crc32"

_SEAL = re.compile(rb', "%s": "([0-9a-f]{8})"\}\Z' % FIELD.encode())
_LENGTH = len(f', "{FIELD}": "01234567"}}')


def sealed(line: Raw, before: int) -> tuple[bytes, int]:
    """Return the bytes of a line with its line end, and their checksum.

    `before` is the checksum of the previous line, 0 for the first. The checksum, eight hexadecimal digits, is the last
    field, and covers everything before its comma.
    """
    text = json.dumps(line, ensure_ascii=False, allow_nan=False)
    # A lone surrogate becomes its escape, which means the same within a text of JSON.
    body = text.encode("utf-8", "backslashreplace")[:-1]
    check = zlib.crc32(body, before)
    return b'%s, "%s": "%08x"}\n' % (body, FIELD.encode(), check), check


def seal_of(line: bytes) -> int | None:
    """Return the checksum at the end of a line (given without its line end); None if there is none."""
    seal = _SEAL.search(line, max(0, len(line) - _LENGTH))
    return int(seal[1], 16) if seal else None


def body_of(line: bytes) -> bytes:
    """Return the JSON text of a line without its checksum."""
    return line[:-_LENGTH] + b"}"


def checksum(line: bytes, before: int) -> int:
    """Compute the checksum that the line must have; `before` is the checksum of the previous line."""
    return zlib.crc32(memoryview(line)[:-_LENGTH], before)


READABLE = "1"
"""The major version of the schema that this program reads."""

SEALED_SINCE = 2
"""The minor version since which every line has a checksum."""

LONGEST = 1 << 24
"""The most bytes of a line; the longest ever written had 62,000. A longer line is refused before it is loaded."""

_VERSION = re.compile(r"([0-9]{1,6})\.([0-9]{1,6})\.[0-9]{1,6}", re.ASCII)
_BEGINNING = b'{"type": "header"'
_MAY_BE_HUGE = re.compile(rb"[0-9]{20}|[eE][+]?[0-9]{3}")


def _no_constant(text: str) -> NoReturn:
    """Refuse NaN and the infinities, which JSON does not have."""
    raise ValueError(f"{text} is not a number of JSON")


def _finite(text: str) -> float:
    """Read a number. Raises ValueError if it is too large for float64."""
    number = float(text)
    if math.isinf(number):
        raise ValueError(f"{shown(text, quoted=False)} is too large for float64")
    return number


def _integer(text: str) -> int:
    """Read a whole number. Raises ValueError if it is too large for float64."""
    _finite(text)
    return int(text)


_DECODER = json.JSONDecoder(parse_constant=_no_constant)
_FINITE_DECODER = json.JSONDecoder(parse_constant=_no_constant, parse_float=_finite, parse_int=_integer)
"""Refuses numbers beyond float64; slower, so it decodes only lines that may hold one."""


def _version_of(header: Raw) -> tuple[str | None, int]:
    """Return the major and the minor version of a header's schema; None and 0 if it names none."""
    version = header.get("schema")
    match = _VERSION.fullmatch(version) if isinstance(version, str) else None
    return (match[1], int(match[2])) if match else (None, 0)


class DamagedError(InputError):
    """A record that is not as it was written; `at` is the byte, from 0, where the first damaged line begins."""

    def __init__(self, sentence: str, at: int = 0) -> None:
        super().__init__(sentence)
        self.at = at


class RecordScan:
    """An iterator over the whole lines of a record, header and footer included, each without its checksum.

    A line is whole if it has its line end. The iterator ends with the file, which may be cut off within a line. It
    raises DamagedError if anything else is wrong, and InputError if the file is not a record that this program reads.
    """

    def __init__(self, reader: Reader, longest: int = LONGEST) -> None:
        self._reader, self._longest = reader, longest
        self._check = 0
        self.sealed = False
        """Whether the record has checksums, known from its first line on."""
        self.header: Raw = {}
        self.footer: Raw | None = None
        self.lines = 0
        """Whole lines so far."""
        self.end = 0
        """The byte after the last whole line."""
        self.written = b""
        """The bytes that were read last: a whole line, or those where reading ended."""

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
        """Read the next line; b"" at the end of the file."""
        self.written = self._reader.line(self._longest + 1)
        return self.written

    def _check_cut(self, written: bytes) -> None:
        """Refuse bytes without a line end, unless they can be the beginning of a line that was cut off."""
        if len(written) > self._longest:
            self._refuse(f"it is longer than {self._longest} bytes, which no line of a record is")
        if self.footer is not None:
            self._refuse("it comes after the footer, which ends a record")
        if self.lines == 0:
            if written.startswith(_BEGINNING[: len(written)]):
                raise InputError(f"{self._reader.name} is cut off within its first line; nothing of it can be used")
            self._no_record("it has no whole line")

    def _first(self, text: bytes) -> Raw:
        """Read the header. If it has a checksum, all lines must have one, whatever its schema says."""
        self.sealed = seal_of(text) is not None
        line = self._parsed(body_of(text) if self.sealed else text)
        major, minor = _version_of(line)
        if major not in (None, READABLE):
            raise InputError(f"{self._reader.name} has schema {line['schema']}; this program reads {READABLE}.x")
        if self.sealed:
            self._check_seal(text)
        if line["type"] != "header" or major is None:
            self._no_record(f"its first line is not a header with a schema such as {READABLE}.0.0")
        if minor >= SEALED_SINCE and not self.sealed:
            self.sealed = True
            self._refuse(f"it has no checksum at its end, which it must have since schema {READABLE}.{SEALED_SINCE}.0")
        self.header = line
        return line

    def _line(self, text: bytes) -> Raw:
        """Read a line after the header, and check its checksum."""
        if self.sealed:
            self._check_seal(text)
            text = body_of(text)
        return self._parsed(text)

    def _parsed(self, text: bytes) -> Raw:
        """Decode a line without its checksum; refuse it if it is not an object with a type."""
        try:
            line = (_FINITE_DECODER if _MAY_BE_HUGE.search(text) else _DECODER).decode(text.decode())
        except UnicodeDecodeError as error:
            self._refuse(f"its byte {error.start} is not UTF-8")
        except RecursionError:
            self._refuse("it is nested too deeply")
        except json.JSONDecodeError as error:
            self._refuse(f"it is not valid JSON at character {error.pos + 1}: {json_trouble(error)}")
        except ValueError as error:
            self._refuse(str(error))
        if not isinstance(line, dict) or not isinstance(line.get("type"), str):
            self._refuse("it is not an object with a type")
        return line

    def _check_seal(self, text: bytes) -> None:
        """Refuse a line whose checksum is missing or wrong; else remember the checksum for the next line."""
        seal = seal_of(text)
        if seal is None:
            self._refuse("it does not end in a checksum: its end is lost, or was changed")
        right = checksum(text, self._check)
        if seal != right:
            self._refuse(
                f"its checksum is {seal:08x}, but must be {right:08x} for these bytes: it was changed, or a line "
                "before it was lost, doubled or moved"
            )
        self._check = seal

    def _check_place(self, line: Raw) -> None:
        """Refuse a line after the footer, a second header, or a footer that counts other lines; keep the footer."""
        if self.footer is not None:
            self._refuse("it comes after the footer, which ends a record")
        if line["type"] == "header" and self.lines:
            self._refuse("it is a second header; a file holds one record")
        if line["type"] == "footer":
            counted, number = line.get("lines"), self.lines + 1
            if counted != number:
                self._refuse(f"it is a footer that counts {shown_json(counted)} lines, but it is line {number}")
            self.footer = line

    def _refuse(self, what: str) -> NoReturn:
        """Raise DamagedError for the line that was read; InputError if it is a first line that is not a header."""
        if self.lines == 0 and not self.sealed:
            self._no_record(f"its first line is not a header ({what})")
        raise DamagedError(
            f"{self._reader.name} is damaged in line {self.lines + 1}, at byte {self.end}: {what}", self.end
        )

    def _no_record(self, why: str) -> NoReturn:
        """Raise InputError: the file is not a record."""
        raise InputError(f"{self._reader.name} is not a record: {why}; a record begins with a header")


_BLOCK = 1 << 20


@dataclass(frozen=True, slots=True)
class FileCondition:
    """The condition of the file of a record.

    schema: the version in its header.
    sealed: whether its lines have checksums.
    lines, size: its good lines, and their bytes.
    exit_code: that of the footer; None without a footer.
    complete: whether it has a footer.
    lost_bytes, lost_lines: what follows the good lines.
    why: the reason why that is lost; empty if the file is only cut off.
    """

    schema: str
    sealed: bool
    lines: int
    size: int
    exit_code: object
    complete: bool
    lost_bytes: int
    lost_lines: int
    why: str = ""


def check(path: Path) -> FileCondition:
    """Return the condition of a file, complete or cut off. Raises DamagedError and InputError as RecordScan does."""
    with open_input(str(path)) as reader:
        scan = RecordScan(reader)
        for _ in scan:
            pass
        return _condition(scan, reader, "")


def repair(path: Path, target: Path) -> FileCondition:
    """Write everything up to the last good line to `target`; return the condition, which says what was lost.

    Raises InputError if not even the header is good, or if both paths are one file.
    """
    if same_file(str(path), str(target)):
        raise InputError(f"--out {target} is the record itself; name another file, to keep what is lost")
    with open_input(str(path)) as reader, replace_output(str(target)) as writer:
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
    """Return the condition of the file after the scan; the bytes that the scan did not read are counted."""
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
