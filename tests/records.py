"""Records made of any lines, with checksums as a Recorder would write them, whatever the lines are."""

from __future__ import annotations

from hypcheck.record.sealing import sealed


def resealed(lines):
    """The bytes of a record that has these lines."""
    data, check = b"", 0
    for line in lines:
        part, check = sealed({name: value for name, value in line.items() if name != "crc32"}, check)
        data += part
    return data
