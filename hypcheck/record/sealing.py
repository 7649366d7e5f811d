"""The checksum at the end of each line of a record: a CRC-32 of everything from the first byte of the file up to it.

It is there against accidents: a bit that flipped, a line that was lost, doubled or moved, two runs that wrote into one
file. Each checksum goes on from the one before, so that such a line does not fit where it stands, whatever is in it.
A CRC finds every change within 32 neighbouring bits for certain, and any other but for one in 2³². Whoever changes a
record on purpose can compute any checksum anew: a cryptographic one would promise no more. This one is in every
language's reach and costs next to nothing (1 GB/s and more).
"""

from __future__ import annotations

import json
import re
import zlib
from typing import Any

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
